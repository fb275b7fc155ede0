"""What loads work along: a coordinate's derivative by the drive's value, times the load, is its reduced moment."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import hypot
from typing import Any, TypeAlias

from centrode.dynamics.state import Centre, Place, Radial, State
from centrode.dynamics.wrenches import Vector, Wrench, couple, on_link, on_point
from centrode.errors import InputError
from centrode.geometry.plane import rotate_vector
from centrode.geometry.sphere import cross, unit, unit_vector
from centrode.locale import _
from centrode.model.loads import TurningLoad
from centrode.model.mechanism import FRAME, Mechanism
from centrode.model.values import Placed
from centrode.numerics.jets import Jet
from centrode.structure.constraints import Entity

Number: TypeAlias = Any


# A coordinate answers for itself: `value` is the number itself [m or rad]; `slope` its derivative by the parameter, at
# held directions, as a jet with its own derivative; `pulls` what a load of one unit along it does to points and
# links, its derivatives by their coordinates.


@dataclass(frozen=True)
class Turn:
    """Angle of a link from another."""

    link: str
    base: str = FRAME

    def value(self, state: State) -> Number:
        return state.angle(self.link).value - state.angle(self.base).value

    def slope(self, state: State) -> Jet:
        return (state.angle(self.link) - state.angle(self.base)).slope()

    def pulls(self, state: State) -> tuple[Wrench, ...]:
        return couple(self.link, 1.0), couple(self.base, -1.0)


@dataclass(frozen=True)
class Slide:
    """Displacement along a guide."""

    guide: str

    def value(self, state: State) -> Number:
        return state.slide(self.guide).value

    def slope(self, state: State) -> Jet:
        return state.slide(self.guide).slope()

    def pulls(self, state: State) -> tuple[Wrench, ...]:
        guide = state.mechanism.guide(self.guide)
        at, along = place_of(state.point(guide.point)), self._along(state)
        # a slider that is a link of its own is what is pushed, and not the pin in it
        slider = on_point(guide.point, along, at) if guide.link is None else on_link(guide.link, along, at)
        return slider, on_link(guide.on, tuple(-x for x in along), at)

    def _along(self, state: State) -> Vector:
        """Unit vector along which the displacement grows: of the line, or of the circle at the point."""
        guide = state.mechanism.guide(self.guide)
        if not state.on_sphere:
            (x, y), (cosine, sine) = guide.unit, place_of(state.rotor(guide.on))
            return rotate_vector((x, y), (cosine, sine))
        spot = guide.pole.at if isinstance(guide.pole, Placed) else guide.pole
        assert spot is not None
        pole = (
            state.point(spot)
            if isinstance(spot, str)
            else state.heading(guide.on, unit_vector(state.m.base, spot))
        )
        (x, y, z), (u, v, w) = place_of(pole), place_of(state.point(guide.point))
        # square to the pole and to the point: the tangent of the circle, counter-clockwise about the pole
        return unit(state.m.base, cross((x, y, z), (u, v, w)))


@dataclass(frozen=True)
class Distance:
    """Distance of two points."""

    first: str
    second: str

    def value(self, state: State) -> Number:
        return self._length(state).value

    def slope(self, state: State) -> Jet:
        return self._length(state).slope()

    def pulls(self, state: State) -> tuple[Wrench, ...]:
        return _apart(state, self.first, self.second, self._length(state).value)

    def _length(self, state: State) -> Jet:
        length: Jet = state.m.sqrt(_squared_distance(state, self.first, self.second))
        return length


@dataclass(frozen=True)
class HalfSquare:
    """Half the squared distance of two points: unlike the distance it has a derivative where they meet."""

    first: str
    second: str

    def value(self, state: State) -> Number:
        return self._half(state).value

    def slope(self, state: State) -> Jet:
        return self._half(state).slope()

    def pulls(self, state: State) -> tuple[Wrench, ...]:
        return _apart(state, self.first, self.second, 1.0)

    def _half(self, state: State) -> Jet:
        return _squared_distance(state, self.first, self.second) * 0.5


def _squared_distance(state: State, first: str, second: str) -> Jet:
    """Squared straight distance of two points [m^2], on the sphere too."""
    parts = [(v - u) * (v - u) for u, v in zip(state.point(first), state.point(second), strict=True)]
    return sum(parts[1:], parts[0])


@dataclass(frozen=True)
class Component:
    """Component of a point's place, or of a link's centre of mass, along a direction fixed in a link or the frame."""

    at: str | Centre | Radial
    direction: tuple[float, ...]
    axes: str = FRAME

    def value(self, state: State) -> Number:
        parts = [u * x for u, x in zip(self._direction(state), self._place(state), strict=True)]
        return sum(parts[1:], parts[0]).value

    def slope(self, state: State) -> Jet:
        pairs = zip(self._direction(state), self._place(state), strict=True)
        # the direction's own derivative is left out: a force does no work when its direction turns
        parts = [u.lower_order() * x.slope() for u, x in pairs]
        return sum(parts[1:], parts[0])

    def pulls(self, state: State) -> tuple[Wrench, ...]:
        force, at = place_of(self._direction(state)), place_of(self._place(state))
        body = self.at
        return (on_point(body, force, at) if isinstance(body, str) else on_link(body.link, force, at),)

    def _place(self, state: State) -> Place:
        return state.point(self.at) if isinstance(self.at, str) else state.centre(self.at)

    def _direction(self, state: State) -> Place:
        size = hypot(*self.direction)
        unit = tuple(x / size for x in self.direction)
        if self.axes == FRAME:
            return tuple(state.constant(x) for x in unit)
        if state.on_sphere:
            return state.heading(self.axes, unit)  # type: ignore[arg-type]
        x, y = unit
        cosine, sine = state.rotor(self.axes)
        return cosine * x - sine * y, sine * x + cosine * y


def place_of(place: Place) -> Vector:
    """Coordinates without their derivatives."""
    return tuple(x.value for x in place)


def _apart(state: State, first: str, second: str, size: Number) -> tuple[Wrench, ...]:
    """Two points pushed apart, each with a force of their distance over `size`."""
    one, other = place_of(state.point(first)), place_of(state.point(second))
    # for a distance the force is of unit size; for half its square it is the distance itself
    force = tuple((u - x) / size for x, u in zip(one, other, strict=True))
    return on_point(second, force, other), on_point(first, tuple(-x for x in force), one)


# What moments work along: the angle between two links, in the plane, in a hinge of the sphere, about an axis.


@dataclass(frozen=True)
class Spin:
    """On the sphere: turning of a link against another about an axis, a hinge or a direction of the frame.

    Attributes
    ----------
    axis : a point's name, or components in the frame's axes
    joint : str or None
        The link whose joint angle this is, where one is measured in this hinge; `sense` tells which way.
    """

    link: str
    base: str
    axis: str | tuple[float, ...]
    joint: str | None = None
    sense: float = 1.0

    def value(self, state: State) -> Number:
        if self.joint is None:
            return float("nan")
        return self.sense * state.angle(self.joint).value

    def slope(self, state: State) -> Jet:
        along = [x.lower_order() for x in self._axis(state)]
        # spins differ by the relative angular velocity; along the axis it is the rate of the joint's angle
        pairs = zip(state.spin(self.link), state.spin(self.base), along, strict=True)
        parts = [(own - other) * axis for own, other, axis in pairs]
        return sum(parts[1:], parts[0])

    def pulls(self, state: State) -> tuple[Wrench, ...]:
        axis = place_of(self._axis(state))
        return couple(self.link, axis), couple(self.base, tuple(-x for x in axis))

    def _axis(self, state: State) -> Place:
        if isinstance(self.axis, str):
            unit = 1.0 / state.mechanism.sphere_radius
            return tuple(x * unit for x in state.point(self.axis))
        size = hypot(*self.axis)
        return tuple(state.constant(x / size) for x in self.axis)


@dataclass(frozen=True)
class HingeTurn:
    """On the sphere: angle of a link against another in their hinge, between -pi and pi, by a second point of each.

    A joint's own angle is counted over full turns, but not each hinge has one.

    Attributes
    ----------
    spin : the turning
    own, other : points of the link and of the base beside the hinge
    """

    spin: Spin
    own: str
    other: str

    def value(self, state: State) -> Number:
        axis = place_of(self.spin._axis(state))
        own, other = (place_of(state.point(name)) for name in (self.own, self.other))
        along = _dot(axis, own) * _dot(axis, other)
        return state.m.base.atan2(_dot(axis, cross(other, own)), _dot(other, own) - along)

    def slope(self, state: State) -> Jet:
        return self.spin.slope(state)

    def pulls(self, state: State) -> tuple[Wrench, ...]:
        return self.spin.pulls(state)


@dataclass(frozen=True)
class GuideArc:
    """On the sphere: displacement along a guide as an angle about the centre [rad]."""

    guide: str

    def value(self, state: State) -> Number:
        return Slide(self.guide).value(state) * (1.0 / state.mechanism.sphere_radius)

    def slope(self, state: State) -> Jet:
        return Slide(self.guide).slope(state) * (1.0 / state.mechanism.sphere_radius)

    def pulls(self, state: State) -> tuple[Wrench, ...]:
        share = 1.0 / state.mechanism.sphere_radius
        return tuple(wrench.times(share) for wrench in Slide(self.guide).pulls(state))


@dataclass(frozen=True)
class AngularDistance:
    """On the sphere: angle between two points at the centre [rad], 0 to pi."""

    first: str
    second: str

    def value(self, state: State) -> Number:
        return self._angle(state).value

    def slope(self, state: State) -> Jet:
        return self._angle(state).slope()

    def pulls(self, state: State) -> tuple[Wrench, ...]:
        one, other = place_of(state.point(self.first)), place_of(state.point(self.second))
        radius = state.mechanism.sphere_radius
        axis = unit(state.m.base, cross(one, other))
        # tangents of the great circle, away from the other point, for a moment of one unit
        away = tuple(x / radius**2 for x in cross(axis, other))
        back = tuple(-x / radius**2 for x in cross(axis, one))
        return on_point(self.second, away, other), on_point(self.first, back, one)

    def _angle(self, state: State) -> Jet:
        # half the angle by difference and sum: without loss from 0 to pi
        pairs = list(zip(state.point(self.first), state.point(self.second), strict=True))
        apart, together = ([sign * u + v for u, v in pairs] for sign in (-1.0, 1.0))
        sizes = [state.m.sqrt(_sum_of_squares(parts)) for parts in (apart, together)]
        angle: Jet = state.m.atan2(*sizes) * 2.0
        return angle


def _sum_of_squares(parts: Sequence[Jet]) -> Jet:
    squares = [x * x for x in parts]
    return sum(squares[1:], squares[0])


def _dot(one: Vector, other: Vector) -> Number:
    return sum((u * v for u, v in zip(one[1:], other[1:], strict=True)), one[0] * other[0])


@dataclass(frozen=True)
class Travel:
    """Way of the drive, whichever its sense: what works along it resists the drive itself."""

    def value(self, state: State) -> Number:
        return float("nan")

    def slope(self, state: State) -> Jet:
        # the distance gone grows whichever way the drive runs, so its slope is the sense of the rate
        return Jet((state.m.base.sign(state.rate), 0.0))

    def pulls(self, state: State) -> tuple[Wrench, ...]:
        raise NotImplementedError("no force on a link works along it")


Coordinate: TypeAlias = (
    Turn | Slide | Distance | HalfSquare | Component | Spin | HingeTurn | GuideArc | AngularDistance | Travel
)
"""What a load or a contact works along."""


def is_angular(coordinate: Coordinate) -> bool:
    """Whether it is an angle [rad], along which a moment works."""
    return isinstance(coordinate, Turn | Spin | HingeTurn | GuideArc | AngularDistance)


def force_unit(coordinate: Coordinate) -> str:
    """Unit of what acts along a coordinate: of a moment or of a force."""
    return "N m" if is_angular(coordinate) else "N"


def is_periodic(coordinate: Coordinate) -> bool:
    """Whether it comes back to the same value after a full turn."""
    return isinstance(coordinate, HingeTurn)


def bodies_of(mechanism: Mechanism, coordinate: Coordinate) -> tuple[Entity, ...]:
    """Points and links on whose places a coordinate depends, the frame included."""
    match coordinate:
        case Turn(link=link, base=base):
            return Entity("link", link), Entity("link", base)
        case Spin(link=link, base=base, axis=axis, joint=joint):
            links = [Entity("link", name) for name in (link, base, joint) if name is not None]
            return (*links, Entity("point", axis)) if isinstance(axis, str) else tuple(links)
        case HingeTurn(spin=spin, own=own, other=other):
            return (*bodies_of(mechanism, spin), Entity("point", own), Entity("point", other))
        case Slide(guide=name) | GuideArc(guide=name):
            guide = mechanism.guide(name)
            return Entity("point", guide.point), Entity("link", guide.on)
        case (
            Distance(first=first, second=second)
            | HalfSquare(first=first, second=second)
            | AngularDistance(first=first, second=second)
        ):
            return Entity("point", first), Entity("point", second)
        case Component(at=at, axes=axes):
            body = Entity("point", at) if isinstance(at, str) else Entity("link", at.link)
            return body, Entity("link", axes)
        case Travel():
            return ()


def turning_of(mechanism: Mechanism, load: TurningLoad, where: str, measured: bool) -> Turn | Spin:
    """The turning of a load's link against another; `measured` where the load asks for the angle itself.

    Raises InputError on the sphere where nothing tells the axis, or nothing measures an angle that is requested.
    """
    if mechanism.space != "sphere":
        return Turn(load.link, load.relative_to)
    axis = hinge_of(mechanism, load.link, load.relative_to, where) if load.axis is None else load.axis
    joint, sense = joint_of_hinge(mechanism, load.link, load.relative_to, axis)
    if measured and joint is None:
        what = _("the angle between {link} and {other} is not measured there, and the load depends on it")
        repair = _("let the first point of one of them be the hinge, and give it a reference on the other")
        raise InputError(where, what.format(link=load.link, other=load.relative_to), repair)
    return Spin(load.link, load.relative_to, axis, joint, sense)


def hinge_of(mechanism: Mechanism, link: str, other: str, where: str, repair: str = "") -> str:
    """The point that two links share; raises InputError where there is none or more than one.

    `repair` is that of the errors; one that names keys of loads if left out.
    """
    shared = [point for point in points_of(mechanism, link) if point in points_of(mechanism, other)]
    if len(shared) == 1:
        return shared[0]
    if shared:
        what = _("{link} and {other} share the points {points}")
        choose = repair or _("choose one: axis = a point")
        raise InputError(where, what.format(link=link, other=other, points=", ".join(shared)), choose)
    what = _("{link} and {other} have no hinge in common").format(link=link, other=other)
    name = repair or _("give relative_to, or axis: a point, or [x, y, z] in the axes of the frame")
    raise InputError(where, what, name)


def points_of(mechanism: Mechanism, link: str) -> list[str]:
    """Names of the points of a link or of the frame."""
    return list(mechanism.frame.points if link == FRAME else mechanism.links[link].coordinates)


def joint_of_hinge(
    mechanism: Mechanism, link: str, other: str, axis: str | tuple[float, ...]
) -> tuple[str | None, float]:
    """The link whose joint angle is that of one against the other about a point, and which way it counts."""
    for body, base, sense in ((link, other, 1.0), (other, link, -1.0)):
        reference = None if body == FRAME else mechanism.links[body].reference
        # a reference starts in the first point of its link, which is the axis of the angle
        if (
            reference is not None
            and reference[0] == axis
            and set(reference) <= set(points_of(mechanism, base))
        ):
            return body, sense
    return None, 1.0
