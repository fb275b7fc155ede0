"""Positions of a mechanism with their derivatives by the path's parameter, as jets, at many samples."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.geometry.sphere import Attitude, cross, dot, unit_vector, vector_in_frame
from centrode.kinematics.path import JETS
from centrode.model.links import Link
from centrode.model.mechanism import FRAME, Mechanism
from centrode.numerics.jets import Jet, JetFunctions, integral

if TYPE_CHECKING:
    from centrode.kinematics.plan_evaluation import PlanLayout
    from centrode.kinematics.samples import Samples
    from centrode.kinematics.solve import Solved

# What a mass is to the computation: centre of mass and inertia about it, in the plane and on the sphere.

Number: TypeAlias = Any
Local: TypeAlias = Mapping[str, tuple[Number, Number]]
Given: TypeAlias = Mapping[str, Number]
"""Numbers by their paths ("links.AB.mass") in place of the description's own."""
Vector3: TypeAlias = tuple[Number, Number, Number]


@dataclass(frozen=True)
class Centre:
    """A centre of mass in the plane: a point of the link, and the way from there in the link's own axes [m]."""

    link: str
    base: str
    along: Number
    across: Number


@dataclass(frozen=True)
class Radial:
    """A centre of mass of a spherical link: a direction in the link's own axes, and how far from the centre [m]."""

    link: str
    direction: Vector3
    distance: Number


@dataclass(frozen=True)
class Spread:
    """Mass spread about the centre of mass along a direction of the link's axes: the sum of m x^2 [kg m^2].

    Three of them, square to each other, are a tensor of inertia: about the axis k it is the sum of the two others.
    """

    moment: Number
    direction: Vector3


@dataclass(frozen=True)
class About:
    """Inertia [kg m^2] about one axis of the link alone, the ring of "ring and point mass"."""

    moment: Number
    direction: Vector3


@dataclass(frozen=True)
class Mass:
    """Mass [kg], centre, and inertia about it of one link; numbers may be those of a batch.

    In the plane the inertia is a moment [kg m^2], on the sphere it has parts.
    """

    link: str
    mass: Number
    centre: Centre | Radial
    inertia: Number | tuple[Spread | About, ...]

    @property
    def weighs(self) -> bool:
        """Whether it has mass, and not only inertia."""
        return not is_none(self.mass)

    @property
    def planar_centre(self) -> Centre:
        """The centre of mass of a planar link."""
        assert isinstance(self.centre, Centre)
        return self.centre

    @property
    def moment_of_inertia(self) -> Number:
        """The inertia of a planar link [kg m^2]."""
        assert not isinstance(self.inertia, tuple)
        return self.inertia

    @property
    def resists(self) -> bool:
        """Whether it has a moment of inertia."""
        return self.inertia != () if isinstance(self.inertia, tuple) else not is_none(self.inertia)


@dataclass(frozen=True)
class LinkNumbers:
    """The numbers of one link, those of a batch (by their paths in `given`) where they vary."""

    name: str
    link: Link
    given: Given

    @property
    def where(self) -> str:
        """Place of the link in the description, for messages."""
        return f"[links.{self.name}]"

    def number(self, key: str, own: float) -> Number:
        """The number under a key, `own` where it does not vary."""
        return self.given.get(f"links.{self.name}.{key}", float(own))


def is_none(value: Number) -> bool:
    """Whether a number is a plain zero, and not one that may vary."""
    return isinstance(value, float) and value == 0.0


Array: TypeAlias = npt.NDArray[np.float64]
Place: TypeAlias = tuple[Jet, ...]
"""Coordinates along the axes of the space."""
Getter: TypeAlias = Callable[[int], Array]


FRAME_POINTS = "frame.points."
"""Before the path of a coordinate of a point of the frame."""


@dataclass(frozen=True)
class State:
    """A mechanism at samples of one path.

    Arrays have shape (lanes, n): lanes are mechanisms of a batch. Jets are of second order, by the path's
    parameter; velocities are first derivatives times `rate`.

    Attributes
    ----------
    mechanism : the description, for local coordinates
    time [s], parameter [rad, m or s] : (n)
    rate : (n)
        Derivative of the parameter by time.
    side : -1, 0 or 1
        At a jump: the side of the parameter that counts; 0 where a one-sided load counts as acting.
    scale : float [m]
        The greatest length, by which velocities of zero are distinguished from rounding.
    columns : kind -> what gives value and two derivatives of its k-th number
    m : functions of jets, over arrays or over expressions
    order : of the jets
    """

    mechanism: Mechanism
    layout: PlanLayout
    time: Array
    parameter: Array
    rate: Array
    side: int
    scale: float
    columns: Mapping[str, Getter]
    m: JetFunctions = JETS
    known: dict[str, Place | Jet] = field(default_factory=dict)
    attitudes: dict[str, Attitude] = field(default_factory=dict)
    order: int = 2

    @classmethod
    def of_samples(
        cls, mechanism: Mechanism, samples: Samples, moving: DriveMotion, scale: float, side: int = 0
    ) -> State:
        """The state that columns of samples hold."""
        layout, columns = samples.layout, samples.columns
        getters: dict[str, Getter] = {
            "point": lambda k: columns[:, k],
            "angle": lambda k: samples.angles[:, k],
            "slide": lambda k: columns[:, layout.first_slide + k],
            "attitude": lambda k: columns[:, layout.first_attitude + k],
        }
        scale = scale * length_unit(mechanism)
        return cls(mechanism, layout, moving.time, moving.parameter, moving.rate, side, scale, getters)

    @classmethod
    def of(cls, solved: Solved, moving: DriveMotion, side: int = 0) -> State:
        """The state of a motion."""
        mechanism = solved.ready.mechanism
        getters = getters_of(solved, lambda array: array)
        scale = solved.ready.kinematics.path.scale * length_unit(mechanism)
        return cls(mechanism, solved.layout, moving.time, moving.parameter, moving.rate, side, scale, getters)

    def know_varied_frame(self, solved: Solved, paths: Iterable[str]) -> None:
        """Take the points of the frame whose coordinates vary, by their paths, from a motion or from its trace."""
        unit, names = length_unit(self.mechanism), list(self.mechanism.frame.points)
        for path in paths:
            name = path.removeprefix(FRAME_POINTS).rpartition(".")[0]
            if path.startswith(FRAME_POINTS) and name in names:
                place = solved.all_points[0][:, :, names.index(name)]
                numbers = [place[..., axis] for axis in range(place.shape[-1])]
                if solved.points.dtype == object:
                    numbers = [x.item() for x in numbers]
                self.known[f"point {name}"] = tuple(
                    Jet((x if unit == 1.0 else x * unit, 0.0, 0.0)) for x in numbers
                )

    def constant(self, value: Number) -> Jet:
        """A number without derivatives."""
        return Jet((value, *([0.0] * self.order)))

    @property
    def on_sphere(self) -> bool:
        """Whether places have three coordinates, and links axes in place of one angle."""
        return self.mechanism.space == "sphere"

    @property
    def exists(self) -> npt.NDArray[np.bool_]:
        """Where there are derivatives: nothing is reduced at limits."""
        # any link will do: at a limit the derivatives of all are absent
        first = self.columns["attitude" if self.on_sphere else "angle"](0)[1]
        return np.asarray(np.isfinite(first))

    def point(self, name: str) -> Place:
        """Coordinates of a point [m]."""
        place = self.known.get(f"point {name}")
        if place is None and name in self.mechanism.frame.points:
            fixed = self.mechanism.frame.coordinates[name]
            if self.on_sphere:
                radius = self.mechanism.sphere_radius
                # over plain numbers: a point of the frame has no derivatives
                return tuple(self.constant(radius * float(x)) for x in unit_vector(self.m.base, fixed))
            return tuple(self.constant(x) for x in fixed)
        if place is None:
            axes = self.layout.axes
            first, unit = axes * self.layout.points.index(name), length_unit(self.mechanism)
            place = tuple(_scale_jet(_jet(self.columns["point"](first + k)), unit) for k in range(axes))
            self.known[f"point {name}"] = place
        assert isinstance(place, tuple)
        return place

    def attitude(self, link: str) -> Attitude:
        """On the sphere: the axes of a link in those of the frame."""
        attitude = self.attitudes.get(link)
        if attitude is None:
            first = 9 * self.layout.links.index(link)
            jets = [_jet(self.columns["attitude"](first + k)) for k in range(9)]
            attitude = Attitude(*((jets[k], jets[k + 1], jets[k + 2]) for k in (0, 3, 6)))
            self.attitudes[link] = attitude
        return attitude

    def heading(self, link: str, direction: Vector3) -> Place:
        """On the sphere: a direction of a link's own axes, or of the frame's, as it stands in the frame."""
        if link == FRAME:
            return tuple(self.constant(float(x)) for x in direction)
        x, y, z = vector_in_frame(self.attitude(link), direction)
        return x, y, z

    def spin(self, link: str) -> Place:
        """On the sphere: angular velocity of a link by the parameter, with its derivative; of first order."""
        if link == FRAME:
            return tuple(self.constant(0.0).slope() for _axis in range(3))
        spin = self.known.get(f"spin {link}")
        if spin is None:
            # half the sum of a x a' over the axes
            turns = [
                cross(tuple(x.lower_order() for x in axis), tuple(x.slope() for x in axis))
                for axis in self.attitude(link)
            ]
            spin = tuple((a + b + c) * 0.5 for a, b, c in zip(*turns, strict=True))
            self.known[f"spin {link}"] = spin
        assert isinstance(spin, tuple)
        return spin

    def turned_about(self, link: str, direction: Vector3) -> Jet:
        """On the sphere: the turning of a link about one of its own directions; it has derivatives, but no value."""
        axis = tuple(x.lower_order() for x in self.heading(link, direction))
        along = dot(self.spin(link), axis)  # type: ignore[arg-type]
        # the turning is the integral of its rate
        return integral(along.coefficients, 0.0)

    def angle(self, link: str) -> Jet:
        """Angle of a link or of the frame [rad]; on the sphere that from its reference."""
        if link == FRAME:
            return self.constant(0.0)
        return self._jet("angle", link, self.layout.angles)

    def slide(self, guide: str) -> Jet:
        """Displacement along a guide [m]."""
        return _scale_jet(self._jet("slide", guide, self.layout.guides), length_unit(self.mechanism))

    def rotor(self, link: str) -> Place:
        """Cosine and sine of a link's angle."""
        rotor = self.known.get(f"rotor {link}")
        if rotor is None:
            sine, cosine = self.m.sine_and_cosine(self.angle(link))
            rotor = cosine, sine
            self.known[f"rotor {link}"] = rotor
        assert isinstance(rotor, tuple)
        return rotor

    def centre(self, centre: Centre | Radial) -> Place:
        """Centre of mass of a link [m]."""
        if isinstance(centre, Radial):
            return tuple(x * centre.distance for x in self.heading(centre.link, centre.direction))
        x, y = self.point(centre.base)
        along, across = centre.along, centre.across
        # the base itself: no sine or cosine is taken for nothing
        if isinstance(along, float) and isinstance(across, float) and along == across == 0.0:
            return x, y
        cosine, sine = self.rotor(centre.link)
        return x + cosine * along - sine * across, y + sine * along + cosine * across

    def _jet(self, kind: str, name: str, names: tuple[str, ...]) -> Jet:
        jet = self.known.get(f"{kind} {name}")
        if jet is None:
            jet = _jet(self.columns[kind](names.index(name)))
            self.known[f"{kind} {name}"] = jet
        assert isinstance(jet, Jet)
        return jet


@dataclass(frozen=True)
class DriveMotion:
    """Motion of the drive at samples: time [s], the path's parameter, and its derivative by time, each (n)."""

    time: Array
    parameter: Array
    rate: Array


def getters_of(solved: Solved, one: Callable[[Any], Any]) -> dict[str, Getter]:
    """Functions that give the numbers of a motion by kind, of its arrays seen through the function `one`."""
    axes = solved.layout.axes
    points, angles, slides = one(solved.points), one(solved.angles), one(solved.slides)
    attitudes = None if solved.attitudes is None else one(solved.attitudes)

    def attitude(k: int) -> Array:
        assert attitudes is not None
        return np.asarray(attitudes[..., k // 9, k // 3 % 3, k % 3])

    return {
        "point": lambda k: points[..., k // axes, k % axes],
        "angle": lambda k: angles[..., k],
        "slide": lambda k: slides[..., k],
        "attitude": attitude,
    }


def length_unit(mechanism: Mechanism) -> float:
    """Metres of one unit of length in the description: on the sphere, where lengths are arcs, its radius."""
    return mechanism.sphere_radius if mechanism.space == "sphere" else 1.0


def _scale_jet(jet: Jet, unit: float) -> Jet:
    return jet if unit == 1.0 else jet * unit


def _jet(orders: Array) -> Jet:
    # second derivatives to second Taylor coefficients
    return Jet((orders[0], orders[1], 0.5 * orders[2]))
