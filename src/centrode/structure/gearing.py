"""The numbers of gears and rolling wheels: ratios, radii, tracks, and how the wheels mesh."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Protocol, TypeAlias

from centrode.errors import InputError
from centrode.geometry.plane import Vector
from centrode.locale import _
from centrode.model.mechanism import Mechanism, Rolling

Number: TypeAlias = Any
Places: TypeAlias = Callable[[str], Mapping[str, Vector]]


@dataclass(frozen=True)
class Straight:
    """A track along a line: a point of it and its unit vector, in the axes of the body that carries it."""

    through: Vector
    direction: Vector


@dataclass(frozen=True)
class Round:
    """A track around a circle, in the axes of the body that carries it; the wheel rolls outside or inside."""

    centre: Vector
    radius: Number
    inside: bool


Track: TypeAlias = Straight | Round


@dataclass(frozen=True)
class Gearing:
    """Numbers of gears and rolling wheels, by their ids.

    Attributes
    ----------
    ratio : gear -> turn of the second link over turn of the first, against the carrier
    radius : rolling -> radius of the wheel [m]
    track : rolling -> what it rolls on
    phase : gear or rolling -> the constant [rad] of its equation between angles: how the wheels mesh
    shares : gear -> how many times the carrier's angle is taken off that of the first and of the second wheel:
        once in the plane; on the sphere not at all where a wheel's angle is measured on the carrier itself
    measured : link -> the body that its angle is measured on, where that is not the frame
    """

    ratio: Mapping[str, Number] = field(default_factory=dict)
    radius: Mapping[str, Number] = field(default_factory=dict)
    track: Mapping[str, Track] = field(default_factory=dict)
    phase: Mapping[str, Number] = field(default_factory=dict)
    shares: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    measured: Mapping[str, str] = field(default_factory=dict)

    def mapped(self, function: Callable[[Number], Number]) -> Gearing:
        """The same with every number replaced by function(number)."""
        return replace(
            self.resized(function),
            ratio={name: function(x) for name, x in self.ratio.items()},
            track={name: _track(track, function, function) for name, track in self.track.items()},
            phase={name: function(x) for name, x in self.phase.items()},
        )

    def resized(self, function: Callable[[Number], Number]) -> Gearing:
        """The same with every length replaced by function(length); ratios, directions and phases stay."""
        return replace(
            self,
            radius={name: function(x) for name, x in self.radius.items()},
            track={name: _track(track, function, lambda x: x) for name, track in self.track.items()},
        )

    def with_phases(self, phases: Mapping[str, Number]) -> Gearing:
        """The same with these phases added."""
        return replace(self, phase={**self.phase, **phases})

    def reach(self, rolling: str) -> Number:
        """Distance [m] of a wheel's centre from its track: from the line, or from the circle's centre."""
        track, radius = self.track[rolling], self.radius[rolling]
        if isinstance(track, Straight):
            return radius
        return abs(track.radius - radius) if track.inside else track.radius + radius

    def spin(self, rolling: str) -> Number:
        """Turn of a wheel over the turn of its centre about the circle's, both against the body that carries it."""
        track, radius = self.track[rolling], self.radius[rolling]
        assert isinstance(track, Round)
        return (radius - track.radius if track.inside else track.radius + radius) / radius


def _track(track: Track, length: Callable[[Number], Number], component: Callable[[Number], Number]) -> Track:
    if isinstance(track, Straight):
        return Straight(_vector(track.through, length), _vector(track.direction, component))
    return Round(_vector(track.centre, length), length(track.radius), track.inside)


def _vector(v: Vector, function: Callable[[Number], Number]) -> Vector:
    return function(v[0]), function(v[1])


class Values(Protocol):
    """Numbers by path, those that vary replaced."""

    def number(self, path: str, own: float) -> Number:
        """A number."""

    def length(self, path: str, own: float) -> Number:
        """A length; InputError unless it is positive."""

    def vector(self, path: str, own: Any) -> Vector:
        """Coordinates."""

    def direction(self, path: str, own: Vector) -> Vector:
        """A unit vector, varied by its angle."""


def gearing_of(mechanism: Mechanism, places: Places, values: Values) -> Gearing:
    """Numbers of a description's gears and rolling wheels; `places` gives the points of a body in its axes."""
    ratio = {gear.id: _ratio(f"gears.{gear.id}.ratio", gear.ratio, values) for gear in mechanism.gears}
    radius = {
        wheel.id: values.length(f"rolling.{wheel.id}.radius", wheel.radius) for wheel in mechanism.rolling
    }
    track = {wheel.id: _track_of(wheel, places, values) for wheel in mechanism.rolling}
    for wheel in mechanism.rolling:
        _check_room(wheel, radius[wheel.id], track[wheel.id])
    return Gearing(ratio, radius, track)


def _ratio(path: str, own: float, values: Values) -> Number:
    ratio = values.number(path, own)
    if not (ratio != 0.0 if isinstance(ratio, float) else (ratio != 0.0).all()):
        raise InputError(path, _("a ratio must not be zero"))
    return ratio


def _track_of(wheel: Rolling, places: Places, values: Values) -> Track:
    along, path = wheel.along, f"rolling.{wheel.id}.along"
    if along.radius is None:
        through = values.vector(f"{path}.through", along.through)
        return Straight(through, values.direction(f"{path}.direction", along.unit))
    if isinstance(along.centre, str):
        centre = places(wheel.on)[along.centre]
    else:
        centre = values.vector(f"{path}.centre", along.centre)
    return Round(centre, values.length(f"{path}.radius", along.radius), along.inside)


def _check_room(wheel: Rolling, radius: Number, track: Track) -> None:
    if not isinstance(track, Round) or not track.inside:
        return
    apart = radius - track.radius
    if not (apart != 0.0 if isinstance(apart, float) else (apart != 0.0).all()):
        raise InputError(
            f"[[rolling]] {wheel.id}",
            _("a wheel as large as the circle fills it and cannot roll inside"),
            _("change one of the radii, or take inside out"),
        )
