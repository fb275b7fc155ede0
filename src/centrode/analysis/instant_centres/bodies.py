"""The bodies of a motion whose instant centres are looked for: the frame, the links, and the sliders of guides.

Places are complex numbers x + i y; velocities are derivatives by the drive's value, with several drives by time.
A point on a guide without a link of its own is a slider (conventions, 28): hinged to what has the point, and
sliding on what carries the guide.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.errors import InputError
from centrode.kinematics.dataset import BATCH
from centrode.locale import _
from centrode.model.files import parse_mechanism
from centrode.model.mechanism import FRAME, Guide, Mechanism
from centrode.model.paths import with_value
from centrode.model.problems import nearest, shown
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
        what = _("there is no link {name}").format(name=shown(name))
        raise InputError("pair", what, nearest(name, self.names))


@dataclass(frozen=True)
class Bodies(Named):
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
        arm = self.place[..., first] - self.place[..., second]
        carried = self.velocity[..., second] + 1j * self.spin[..., second] * arm
        return self.velocity[..., first] - carried, self.spin[..., first] - self.spin[..., second]

    def second_place(self, body: int) -> Places:
        """Another point of a body: its second named one, or one on its x axis."""
        name = self.names[body]
        at = self.place[..., body]
        points = [] if name in self.sliders else list(self.mechanism.points_of(name).values())
        arm = complex(*np.subtract(points[1], points[0])) if len(points) > 1 else self.scale
        return np.asarray(at + arm * np.exp(1j * self.turn[..., body]))

    def sample(self, number: int) -> Bodies:
        """One sample of a motion that is no batch."""
        return replace(self, **{name: getattr(self, name)[number] for name in ORDERS})

    def carried(self, body: int, local: Sequence[float]) -> complex:
        """Where a place in a body's axes is, at one sample."""
        name = self.names[body]
        own = (0.0, 0.0)
        if name not in self.sliders and name != FRAME:
            own = next(iter(self.mechanism.points_of(name).values()))
        arm = complex(*np.subtract(local, own))
        return complex(self.place[body] + arm * np.exp(1j * self.turn[body]))


def described(motion: xr.Dataset) -> Mechanism:
    """The mechanism of a motion; of one taken out of a batch, with the dimensions that it was given."""
    mechanism = parse_mechanism(str(motion.attrs["mechanism"]))
    for path in map(str, motion.coords):
        if "." in path and motion[path].ndim == 0:
            mechanism = with_value(mechanism, path, float(motion[path]))
    return mechanism


def is_spherical(motion: xr.Dataset) -> bool:
    """Whether a motion is one on the sphere."""
    return "angle" not in motion


def bodies_of(motion: xr.Dataset) -> Bodies:
    """The bodies of a planar motion."""
    mechanism = described(motion)
    sliders = sliders_of(mechanism)
    names = (FRAME, *mechanism.link_names, *sliders)
    values = {
        name: _column(motion, variable) for name, variable in zip(ORDERS, _variables(motion), strict=True)
    }
    front = motion["status"].shape
    kinds = dict.fromkeys(ORDERS[:3], np.complex128) | dict.fromkeys(ORDERS[3:], np.float64)
    found: dict[str, npt.NDArray[Any]]
    found = {name: np.zeros((*front, len(names)), dtype=kind) for name, kind in kinds.items()}
    columns = {dimension: [str(name) for name in motion[dimension].values] for dimension in ("point", "link")}
    for number, name in enumerate(names[1:], start=1):
        carrier = sliders[name].on if name in sliders else name
        point = sliders[name].point if name in sliders else next(iter(mechanism.links[name].coordinates))
        for order in ORDERS[:3]:
            found[order][..., number] = values[order][..., columns["point"].index(point)]
        for order in ORDERS[3:] if carrier != FRAME else ():
            found[order][..., number] = values[order][..., columns["link"].index(carrier)]
    absent = ~np.isfinite(found["velocity"] + found["spin"]).all(axis=-1)
    found["velocity"][absent] = found["spin"][absent] = np.nan  # the frame's too, in a singular position
    return Bodies(mechanism, names, sliders, scale=float(dimensions_of(mechanism).scale), **found)


def _variables(motion: xr.Dataset) -> tuple[str, ...]:
    """Variables of the orders: kinematic coefficients, with several drives derivatives by time."""
    if "velocity_coefficient" not in motion:
        return ("position", "velocity", "acceleration", "angle", "angular_velocity", "angular_acceleration")
    first, second = "velocity_coefficient", "acceleration_coefficient"
    return ("position", first, second, "angle", f"angular_{first}", f"angular_{second}")


def _column(motion: xr.Dataset, variable: str) -> Array | Places:
    values = np.asarray(motion[variable].to_numpy(), dtype=np.float64)
    return np.asarray(values[..., 0] + 1j * values[..., 1]) if "axis" in motion[variable].dims else values


def body_names(mechanism: Mechanism) -> tuple[str, ...]:
    """Bodies by number: the frame, links and sliders ("slider C": a point on a guide without a link of its own)."""
    return (FRAME, *mechanism.link_names, *sliders_of(mechanism))


def sliders_of(mechanism: Mechanism) -> dict[str, Guide]:
    """Name -> guide of the sliders that a description does not name as links."""
    found: dict[str, Guide] = {}
    for guide in mechanism.guides:
        if guide.link is None:
            name = f"slider {guide.id}"
            while name in mechanism.links or name in found:
                name += "'"
            found[name] = guide
    return found


def vectors(places: Places) -> Array:
    """Places as pairs of coordinates; NaN in both where one is not there."""
    known = np.isfinite(places)
    return np.stack([np.where(known, places.real, np.nan), np.where(known, places.imag, np.nan)], axis=-1)


def refuse_batch(motion: xr.Dataset) -> None:
    """Refuse several mechanisms where one is meant."""
    if BATCH in motion.dims:
        raise InputError(
            "vary", _("this is asked of one mechanism"), _("select one: motion.isel(mechanism=0)")
        )
