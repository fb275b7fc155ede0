"""What loads work along: a coordinate's derivative by the drive's value, times the load, is its reduced moment."""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot
from typing import Any, Protocol, TypeAlias

from centrode.algebra.jets import Jet
from centrode.dynamics.bodies import Centre, Radial
from centrode.dynamics.pulls import Pull, Vector, couple, on_link, on_point
from centrode.dynamics.states import Place, State
from centrode.geometry.plane import turned
from centrode.geometry.sphere import cross, unit, unit_vector
from centrode.model.mechanism import FRAME
from centrode.model.values import Placed

Number: TypeAlias = Any


class Coordinate(Protocol):
    """A number that a load works along."""

    def value(self, state: State) -> Number:
        """The number itself [m or rad]."""

    def slope(self, state: State) -> Jet:
        """Its derivative by the parameter, at held directions, and the derivative of that."""

    def pulls(self, state: State) -> tuple[Pull, ...]:
        """What a load of one unit along it does to points and links: its derivatives by their coordinates."""


@dataclass(frozen=True)
class Turn:
    """Angle of a link from another."""

    link: str
    base: str = FRAME

    def value(self, state: State) -> Number:
        return state.angle(self.link).value - state.angle(self.base).value

    def slope(self, state: State) -> Jet:
        return (state.angle(self.link) - state.angle(self.base)).slope()

    def pulls(self, state: State) -> tuple[Pull, ...]:
        return couple(self.link, 1.0), couple(self.base, -1.0)


@dataclass(frozen=True)
class Slide:
    """Displacement along a guide."""

    guide: str

    def value(self, state: State) -> Number:
        return state.slide(self.guide).value

    def slope(self, state: State) -> Jet:
        return state.slide(self.guide).slope()

    def pulls(self, state: State) -> tuple[Pull, ...]:
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
            return turned((x, y), (cosine, sine))
        spot = guide.pole.at if isinstance(guide.pole, Placed) else guide.pole
        assert spot is not None
        pole = (
            state.point(spot)
            if isinstance(spot, str)
            else state.heading(guide.on, unit_vector(state.m.base, spot))
        )
        (x, y, z), (u, v, w) = place_of(pole), place_of(state.point(guide.point))
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

    def pulls(self, state: State) -> tuple[Pull, ...]:
        return _apart(state, self.first, self.second, self._length(state).value)

    def _length(self, state: State) -> Jet:
        length: Jet = state.m.sqrt(_squared(state, self.first, self.second))
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

    def pulls(self, state: State) -> tuple[Pull, ...]:
        return _apart(state, self.first, self.second, 1.0)

    def _half(self, state: State) -> Jet:
        return _squared(state, self.first, self.second) * 0.5


def _squared(state: State, first: str, second: str) -> Jet:
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
        parts = [u.lowered() * x.slope() for u, x in pairs]
        return sum(parts[1:], parts[0])

    def pulls(self, state: State) -> tuple[Pull, ...]:
        force, at = place_of(self._direction(state)), place_of(self._place(state))
        body = self.at
        return (on_point(body, force, at) if isinstance(body, str) else on_link(body.link, force, at),)

    def _place(self, state: State) -> Place:
        return state.point(self.at) if isinstance(self.at, str) else state.centre(self.at)

    def _direction(self, state: State) -> Place:
        size = hypot(*self.direction)
        unit = tuple(x / size for x in self.direction)
        if self.axes == FRAME:
            return tuple(Jet((x, 0.0, 0.0)) for x in unit)
        if state.on_sphere:
            return state.heading(self.axes, unit)  # type: ignore[arg-type]
        x, y = unit
        cosine, sine = state.rotor(self.axes)
        return cosine * x - sine * y, sine * x + cosine * y


def place_of(place: Place) -> Vector:
    """Coordinates without their derivatives."""
    return tuple(x.value for x in place)


def _apart(state: State, first: str, second: str, size: Number) -> tuple[Pull, ...]:
    """Two points pushed apart, each with a force of their distance over `size`."""
    one, other = place_of(state.point(first)), place_of(state.point(second))
    force = tuple((u - x) / size for x, u in zip(one, other, strict=True))
    return on_point(second, force, other), on_point(first, tuple(-x for x in force), one)
