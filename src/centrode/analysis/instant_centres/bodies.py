"""The bodies of a motion whose instant centres are looked for: the frame, the links, and the sliders of guides.

Places are complex numbers x + i y; velocities are derivatives by the drive's value, with several drives by time.
A point on a guide without a link of its own is a slider (conventions, 28): hinged to what has the point, and
sliding on what carries the guide.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import combinations
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.errors import InputError
from centrode.kinematics.motion import BATCH
from centrode.locale import _
from centrode.model.files import parse_mechanism, with_value
from centrode.model.labels import sliders_of
from centrode.model.mechanism import FRAME, Guide, Mechanism
from centrode.model.reading import nearest, value_text
from centrode.model.values import unit_vector
from centrode.structure.dimensions import dimensions_of

Array: TypeAlias = npt.NDArray[np.float64]
Places: TypeAlias = npt.NDArray[np.complex128]
Pair: TypeAlias = tuple[int, int]

ORDERS = ("place", "velocity", "acceleration", "turn", "spin", "spin_rate")
ROUNDED = float(np.finfo(np.float64).eps) ** (2.0 / 3.0)
"""What rounding may leave of a velocity that is zero, in the greatest of the motion: the unit roundoff with a third
of its digits given to the conditioning."""


@dataclass(frozen=True)
class Named:
    """Frame, links and sliders by number, in the plane and on the sphere.

    Attributes
    ----------
    names : the frame first, links and sliders in description order
    sliders : name of a slider -> its guide
    """

    mechanism: Mechanism
    names: tuple[str, ...]
    sliders: Mapping[str, Guide]

    @property
    def rate(self) -> Array:
        """Greatest rate of the motion at each sample; NaN where there is none."""
        raise NotImplementedError

    def number(self, name: str) -> int:
        """Number of a body; raises InputError for a name that is none."""
        if name in self.names:
            return self.names.index(name)
        what = _("there is no link {name}").format(name=value_text(name))
        raise InputError("pair", what, nearest(name, self.names))


@dataclass(frozen=True)
class BodyMotions(Named):
    """Frame, links and sliders over a planar motion; a batch has its dimension in front.

    Attributes
    ----------
    place, velocity, acceleration : (..., samples, bodies) of one point of each body [m, m by unit of the drive]
    turn, spin, spin_rate : (..., samples, bodies) of its axes [rad, rad by unit of the drive]
    scale : greatest length of the mechanism [m]
    """

    place: Places
    velocity: Places
    acceleration: Places
    turn: Array
    spin: Array
    spin_rate: Array
    scale: float

    @cached_property
    def rate(self) -> Array:
        """Greatest velocity of the motion at each sample [m by unit of the drive]; zero where all is at rest."""
        speeds = np.maximum(np.abs(self.velocity), np.abs(self.spin) * self.scale)
        return np.asarray(np.max(speeds, axis=-1))

    def relative(self, pair: Pair) -> tuple[Places, Array]:
        """Velocity of the first body's own point against the second body, and the relative spin."""
        first, second = pair
        # the velocity at which the second body passes the first one's point is not relative motion
        arm = self.place[..., first] - self.place[..., second]
        carried = self.velocity[..., second] + 1j * self.spin[..., second] * arm
        return self.velocity[..., first] - carried, self.spin[..., first] - self.spin[..., second]

    def second_place(self, body: int) -> Places:
        """Another point of a body: its second named one, or one on its x axis."""
        name = self.names[body]
        at = self.place[..., body]
        points = [] if name in self.sliders else list(self.mechanism.points_of(name).values())
        # a body with one point, or a slider, has an arm of the mechanism's length: of its own size there is
        # nothing
        arm = complex(*np.subtract(points[1], points[0])) if len(points) > 1 else self.scale
        return np.asarray(at + arm * np.exp(1j * self.turn[..., body]))

    def sample(self, number: int) -> BodyMotions:
        """One sample of a motion that is no batch."""
        return replace(self, **{name: getattr(self, name)[number] for name in ORDERS})

    def place_in_frame(self, body: int, local: Sequence[float]) -> complex:
        """Where a place in a body's axes is, at one sample."""
        name = self.names[body]
        # place is that of the body's first named point, so the arm is measured from it
        own = (0.0, 0.0)
        if name not in self.sliders and name != FRAME:
            own = next(iter(self.mechanism.points_of(name).values()))
        arm = complex(*np.subtract(local, own))
        return complex(self.place[body] + arm * np.exp(1j * self.turn[body]))


def mechanism_of_motion(motion: xr.Dataset) -> Mechanism:
    """The mechanism of a motion; of one taken out of a batch, with the dimensions that it was given."""
    mechanism = parse_mechanism(str(motion.attrs["mechanism"]))
    # a lane taken out of a batch keeps its numbers as coordinates without a dimension, named by their paths
    for path in map(str, motion.coords):
        if "." in path and motion[path].ndim == 0:
            mechanism = with_value(mechanism, path, float(motion[path]))
    return mechanism


def is_spherical(motion: xr.Dataset) -> bool:
    """Whether a motion is one on the sphere."""
    return "angle" not in motion


def bodies_of(motion: xr.Dataset) -> BodyMotions:
    """The bodies of a planar motion."""
    mechanism = mechanism_of_motion(motion)
    sliders = sliders_of(mechanism)
    names = (FRAME, *mechanism.link_names, *sliders)
    values = {
        name: _column(motion, variable) for name, variable in zip(ORDERS, _variables(motion), strict=True)
    }
    front = motion["status"].shape
    kinds = dict.fromkeys(ORDERS[:3], np.complex128) | dict.fromkeys(ORDERS[3:], np.float64)
    orders: dict[str, npt.NDArray[Any]]
    orders = {name: np.zeros((*front, len(names)), dtype=kind) for name, kind in kinds.items()}
    columns = {dimension: [str(name) for name in motion[dimension].values] for dimension in ("point", "link")}
    for number, name in enumerate(names[1:], start=1):
        carrier = sliders[name].on if name in sliders else name
        point = sliders[name].point if name in sliders else next(iter(mechanism.links[name].coordinates))
        for order in ORDERS[:3]:
            orders[order][..., number] = values[order][..., columns["point"].index(point)]
        # a slider on the frame keeps the zeros: it does not turn
        for order in ORDERS[3:] if carrier != FRAME else ():
            orders[order][..., number] = values[order][..., columns["link"].index(carrier)]
    absent = ~np.isfinite(orders["velocity"] + orders["spin"]).all(axis=-1)
    orders["velocity"][absent] = orders["spin"][absent] = np.nan  # the frame's too, in a singular position
    return BodyMotions(mechanism, names, sliders, scale=float(dimensions_of(mechanism).scale), **orders)


def _variables(motion: xr.Dataset) -> tuple[str, ...]:
    """Variables of the orders: kinematic coefficients, with several drives derivatives by time."""
    if "velocity_coefficient" not in motion:
        return ("position", "velocity", "acceleration", "angle", "angular_velocity", "angular_acceleration")
    first, second = "velocity_coefficient", "acceleration_coefficient"
    return ("position", first, second, "angle", f"angular_{first}", f"angular_{second}")


def _column(motion: xr.Dataset, variable: str) -> Array | Places:
    values = np.asarray(motion[variable].values, dtype=np.float64)
    return np.asarray(values[..., 0] + 1j * values[..., 1]) if "axis" in motion[variable].dims else values


def body_names(mechanism: Mechanism) -> tuple[str, ...]:
    """Bodies by number: the frame, links and sliders ("slider C": a point on a guide without a link of its own)."""
    return (FRAME, *mechanism.link_names, *sliders_of(mechanism))


def vectors(places: Places) -> Array:
    """Places as pairs of coordinates; NaN in both where one is not there."""
    # a product with i turns infinity in one part into NaN in the other alone: both are said to be absent
    known = np.isfinite(places)
    return np.stack([np.where(known, places.real, np.nan), np.where(known, places.imag, np.nan)], axis=-1)


def refuse_batch(motion: xr.Dataset) -> None:
    """Refuse several mechanisms where one is meant."""
    if BATCH in motion.dims:
        raise InputError(
            "vary", _("this is computed for one mechanism only"), _("select one: motion.isel(mechanism=0)")
        )


# The bodies of a motion on the sphere: all turn about its centre, so angular velocities tell everything.
#
# Attitudes are matrices whose columns are a body's axes in those of the frame; they follow from the places of
# two of its points. The slider of a guide turns about the pole of its circle against what carries the guide,
# and its axes are those of that body, turned by the displacement.

TURNING_ORDERS = ("axes", "spin", "spin_rate", "speed")
BY_DRIVE = ("velocity_coefficient", "acceleration_coefficient")
IN_TIME = ("velocity", "acceleration")


@dataclass(frozen=True)
class TurningBodies(Named):
    """Frame, links and sliders over a motion on the sphere; a batch has its dimension in front.

    Attributes
    ----------
    axes : (..., samples, bodies, 3, 3) own axes of each body as columns; NaN of a link of one point
    spin, spin_rate : (..., samples, bodies, 3) angular velocity and acceleration [1 by unit of the drive; with
        several drives rad/s, rad/s^2]
    speed : (..., samples, bodies, 3) angular velocity [rad/s]
    points : point -> (..., samples, 3) its places
    """

    axes: Array
    spin: Array
    spin_rate: Array
    speed: Array
    points: dict[str, Array]

    @cached_property
    def rate(self) -> Array:
        """Greatest angular velocity of the motion at each sample [by unit of the drive]."""
        return np.asarray(np.max(np.linalg.norm(self.spin, axis=-1), axis=-1))

    def relative(self, pair: Pair) -> Array:
        """Angular velocity of the first body against the second (..., samples, 3)."""
        return np.asarray(self.spin[..., pair[0], :] - self.spin[..., pair[1], :])

    def two_places(self, body: int) -> tuple[Array, Array]:
        """Two places of a body that neither coincide nor lie opposite."""
        name = self.names[body]
        named = [] if name in self.sliders else list(self.mechanism.points_of(name))
        if len(named) > 1:
            first, second = _best(self.mechanism, name, named)
            return self.points[first], self.points[second]
        place = self.points[self.sliders[name].point] if name in self.sliders else self._any(named)
        # across the axis to which the place is nearest to square: there the product is longest and never zero
        least = np.argmin(np.abs(place), axis=-1)[..., None]
        across = np.cross(place, np.where(least == np.arange(3), 1.0, 0.0))
        return place, np.asarray(across / np.linalg.norm(across, axis=-1, keepdims=True))

    def _any(self, named: list[str]) -> Array:
        return self.points[named[0]] if named else np.broadcast_to([1.0, 0.0, 0.0], (*self.rate.shape, 3))

    def sample(self, number: int) -> TurningBodies:
        """One sample of a motion that is no batch."""
        points = {name: place[number] for name, place in self.points.items()}
        return replace(self, points=points, **{name: getattr(self, name)[number] for name in TURNING_ORDERS})


def turning_bodies_of(motion: xr.Dataset) -> TurningBodies:
    """The bodies of a motion on the sphere."""
    if BATCH not in motion.dims:
        return _of_one(motion)
    lanes = [_of_one(motion.isel({BATCH: k})) for k in range(motion.sizes[BATCH])]
    arrays: dict[str, Any] = {
        name: np.stack([getattr(lane, name) for lane in lanes]) for name in TURNING_ORDERS
    }
    points = {name: np.stack([lane.points[name] for lane in lanes]) for name in lanes[0].points}
    return replace(lanes[0], points=points, **arrays)


def _of_one(motion: xr.Dataset) -> TurningBodies:
    mechanism = mechanism_of_motion(motion)
    sliders = sliders_of(mechanism)
    names = (FRAME, *mechanism.link_names, *sliders)
    samples = motion.sizes["sample"]
    points = {str(name): motion["position"].sel(point=name).values for name in motion["point"].values}
    axes = np.tile(np.eye(3), (samples, len(names), 1, 1))
    for number, name in enumerate(mechanism.link_names, start=1):
        axes[:, number] = _attitudes(mechanism, name, points, samples)
    orders = BY_DRIVE if "velocity_coefficient" in motion else IN_TIME
    spin, spin_rate, speed = (
        _angular(motion, f"angular_{order}", len(names)) for order in (*orders, "velocity")
    )
    for number, guide in enumerate(sliders.values(), start=len(names) - len(sliders)):
        base = names.index(guide.on)
        # displacements are arcs of a small circle of radius sin(arc): over it they are the slider's angle
        # about the pole
        slides = [motion[v].sel(guide=guide.id).values / math.sin(guide.arc) for v in _slides(orders)]
        pole = axes[:, base] @ np.array(unit_vector(pole_of(mechanism, guide)))
        axes[:, number] = _rotations_about(pole, slides[0]) @ axes[:, base]
        spin[:, number] = spin[:, base] + slides[1][:, None] * pole
        # the pole is carried round by the body with the guide: its own derivative is what `cross` adds
        carried = slides[2][:, None] * pole + slides[1][:, None] * np.cross(spin[:, base], pole)
        spin_rate[:, number] = spin_rate[:, base] + carried
        speed[:, number] = speed[:, base] + slides[3][:, None] * pole
    absent = ~np.isfinite(spin).all(axis=(1, 2))
    for rates in (spin, spin_rate, speed):
        rates[absent] = np.nan  # the frame's too, in a singular position
    return TurningBodies(mechanism, names, sliders, axes, spin, spin_rate, speed, points)


def _slides(orders: tuple[str, str]) -> tuple[str, ...]:
    return "slide", f"slide_{orders[0]}", f"slide_{orders[1]}", "slide_velocity"


def _angular(motion: xr.Dataset, variable: str, count: int) -> Array:
    """A vector of every link, with zeros for the frame and room for the sliders."""
    values = motion[variable].values
    rates = np.zeros((len(values), count, 3))
    rates[:, 1 : 1 + values.shape[1]] = values
    return rates


def _attitudes(mechanism: Mechanism, name: str, points: dict[str, Array], samples: int) -> Array:
    """Axes of a link over the samples, from the two of its points that tell them best."""
    own = mechanism.points_of(name)
    if len(own) < 2:
        return np.full((samples, 3, 3), np.nan)
    chosen = _best(mechanism, name, list(own))
    inside = _triad(*(np.array(unit_vector(own[point])) for point in chosen))
    return np.asarray(_triad(*(points[point] for point in chosen)) @ inside.T)


def _best(mechanism: Mechanism, name: str, named: list[str]) -> tuple[str, str]:
    """The two points of a body that lie least in line with the centre of the sphere."""
    own = {point: np.array(unit_vector(at)) for point, at in mechanism.points_of(name).items()}

    def sine(two: tuple[str, str]) -> float:
        return float(np.linalg.norm(np.cross(own[two[0]], own[two[1]])))

    # the greater the sine, the less an error of the places turns the axes
    return max(combinations(named, 2), key=sine)


def _triad(first: Array, second: Array) -> Array:
    """Right-handed axes as columns: a place, towards another, and square to both."""
    normal = np.cross(first, second)
    normal = normal / np.linalg.norm(normal, axis=-1, keepdims=True)
    return np.stack([first, np.cross(normal, first), normal], axis=-1)


def pole_of(mechanism: Mechanism, guide: Guide) -> tuple[float, float]:
    """Pole of a guide's circle (longitude, latitude) in the axes of what carries it."""
    pole = guide.pole
    if isinstance(pole, str):
        return mechanism.points_of(guide.on)[pole]
    assert isinstance(pole, tuple)  # a pole cannot be placed
    return pole


def _rotations_about(axis: Array, angle: Array) -> Array:
    """Rotations about unit vectors (samples, 3) by angles (samples)."""
    # Rodrigues: with N the matrix of the cross product, R = 1 + sin N + (1 - cos) N^2
    x, y, z = np.moveaxis(axis, -1, 0)
    zero = np.zeros_like(x)
    around = np.stack([zero, -z, y, z, zero, -x, -y, x, zero], axis=-1).reshape(*x.shape, 3, 3)
    sine, versine = np.sin(angle)[..., None, None], (1.0 - np.cos(angle))[..., None, None]
    return np.asarray(np.eye(3) + sine * around + versine * (around @ around))


# The motion of one body as another one sees it: derivatives of its pose, and what follows for the pole.
#
# Complex numbers z = c + s, s a place of the body turned with it, in the axes of the other body. By the
# relative angle: pole P = c + i c', where z' = 0; A = c'' - i c' leads from it to the inflection pole; B =
# c''' + c' (Bottema and Roth, Theoretical Kinematics, 1979, chapter 8, write them as instantaneous
# invariants).


@dataclass(frozen=True)
class Seen:
    """Derivatives by one parameter: of the origin of a body's axes `c`, and of its angle `w` (first, second, ...).

    All are in the axes of the body that looks on, whose own origin and rotor are `origin` and `rotor`; `turned`
    is the rotor of the body looked at, in these axes.
    """

    c: tuple[Places, ...]
    w: tuple[Array, ...]
    turned: Places
    origin: Places
    rotor: Places

    @property
    def pole(self) -> Places:
        """Place whose velocity is zero."""
        return np.asarray(self.c[0] + 1j * self.c[1] / self.w[0])

    @property
    def pole_in_body(self) -> Places:
        """Place whose velocity is zero, in the axes of the body looked at."""
        return np.asarray(np.conj(self.turned) * 1j * self.c[1] / self.w[0])

    @property
    def pole_velocity(self) -> Places:
        """Velocity of the pole along the fixed centrode, by the parameter."""
        w, w1 = self.w[:2]
        return np.asarray(self.c[1] + 1j * (self.c[2] * w - self.c[1] * w1) / w**2)

    def by_angle(self) -> tuple[Places, ...]:
        """Derivatives of `c` by the relative angle, first to third where there are so many."""
        w = self.w[0]
        first = self.c[1] / w
        # the chain rule, solved for the highest derivative: c'' = w^2 second + w' first, and so on
        second = (self.c[2] - self.w[1] * first) / w**2
        if len(self.c) < 4:
            return first, second
        third = (self.c[3] - 3.0 * w * self.w[1] * second - self.w[2] * first) / w**3
        return first, second, third

    def outside(self, place: Places) -> Places:
        """A place in the frame's axes."""
        return np.asarray(self.origin + self.rotor * place)


def seen_by(bodies: BodyMotions, pair: Pair) -> Seen:
    """The first body as the second sees it, over a motion: two derivatives."""
    first, second = pair
    rotor = np.exp(1j * bodies.turn[..., second])
    place, velocity, acceleration = (
        np.asarray(x[..., first] - x[..., second])
        for x in (bodies.place, bodies.velocity, bodies.acceleration)
    )
    w, w1 = bodies.spin[..., second], bodies.spin_rate[..., second]
    back = np.conj(rotor)
    # derivatives in axes that turn with w: each one brings a term -i w, which makes the Coriolis and the
    # normal part
    c = (
        back * place,
        back * (velocity - 1j * w * place),
        back * (acceleration - 2j * w * velocity - (1j * w1 + w * w) * place),
    )
    spins = tuple(np.asarray(x[..., first] - x[..., second]) for x in (bodies.spin, bodies.spin_rate))
    turned = np.exp(1j * (bodies.turn[..., first] - bodies.turn[..., second]))
    return Seen(c, spins, turned, np.asarray(bodies.place[..., second]), rotor)
