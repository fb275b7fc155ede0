"""The numbers of gears and rolling wheels: ratios, radii, tracks, and how the wheels mesh."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Protocol, TypeAlias

from centrode.errors import InputError
from centrode.geometry.plane import Vector
from centrode.locale import _
from centrode.model.mechanism import FRAME, Gear, Mechanism, Rolling

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

    def map_numbers(self, function: Callable[[Number], Number]) -> Gearing:
        """The numbers with each replaced by function(number)."""
        return replace(
            self.scale_lengths(function),
            ratio={name: function(x) for name, x in self.ratio.items()},
            track={name: _track(track, function, function) for name, track in self.track.items()},
            phase={name: function(x) for name, x in self.phase.items()},
        )

    def scale_lengths(self, function: Callable[[Number], Number]) -> Gearing:
        """The numbers with every length replaced by function(length); ratios, directions and phases stay."""
        return replace(
            self,
            radius={name: function(x) for name, x in self.radius.items()},
            track={name: _track(track, function, lambda x: x) for name, track in self.track.items()},
        )

    def with_phases(self, phases: Mapping[str, Number]) -> Gearing:
        """The numbers with these phases [rad] added, gear or rolling -> constant of its equation."""
        return replace(self, phase={**self.phase, **phases})

    def reach(self, rolling: str) -> Number:
        """Distance [m] of a wheel's centre from its track: from the line, or from the circle's centre."""
        track, radius = self.track[rolling], self.radius[rolling]
        if isinstance(track, Straight):
            return radius
        # inside, a ring around its pin is larger than the circle: hence the size of the difference
        return abs(track.radius - radius) if track.inside else track.radius + radius

    def spin(self, rolling: str) -> Number:
        """Turn of a wheel over the turn of its centre about the circle's, both against the body that carries it."""
        track, radius = self.track[rolling], self.radius[rolling]
        assert isinstance(track, Round)
        # rolling inside, a wheel smaller than the circle turns against the sense of its centre
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
            _("change one of the radii, or remove inside"),
        )


# Bevel gears: what the angles of wheels on the sphere are measured on, and what of the carrier's angle they
# hold.
#
# A wheel's turn against the carrier is its own angle where that is measured from an arc of the carrier. Where
# it is measured from an arc of the frame, about the point about which the carrier turns too, the carrier's
# angle is taken off.


def shares_of(mechanism: Mechanism, gear: str) -> tuple[float, float]:
    """Multiples of the carrier's angle that are subtracted from those of the first and the second wheel of a gear."""
    if mechanism.space != "sphere":
        return 1.0, 1.0
    meshing = next(other for other in mechanism.gears if other.id == gear)
    first, second = (_share(mechanism, meshing, wheel) for wheel in meshing.links)
    return first, second


def measured_on(mechanism: Mechanism) -> dict[str, str]:
    """Link -> the body that its reference arc lies on, of the links of gears on the sphere."""
    if mechanism.space != "sphere":
        return {}
    bases: dict[str, str] = {}
    for gear in mechanism.gears:
        for link in (*gear.links, gear.carrier):
            if link != FRAME and link not in bases:
                bases[link] = _base(mechanism, gear, link)
    return bases


def _share(mechanism: Mechanism, gear: Gear, wheel: str) -> float:
    carrier = gear.carrier
    # measured on the carrier, the angle is the turn against the carrier already
    if carrier == FRAME or (wheel != FRAME and _base(mechanism, gear, wheel) == carrier):
        return 0.0
    # measured on the frame about the carrier's own pivot, the carrier's angle has to be taken off once
    if _base(mechanism, gear, carrier) == FRAME and wheel in (FRAME, *_about(mechanism, carrier)):
        return 1.0
    raise InputError(
        f"[[gears]] {gear.id}",
        _("the angle of {link} is measured on the frame, and not where {carrier} turns").format(
            link=wheel, carrier=carrier
        ),
        _("measure it from two points of {carrier}: reference = [...]").format(carrier=carrier),
    )


def _about(mechanism: Mechanism, carrier: str) -> list[str]:
    """Links whose angle is measured in the same point as the carrier's."""
    pivots = {name: next(iter(link.coordinates), None) for name, link in mechanism.links.items()}
    return [name for name, pivot in pivots.items() if pivot == pivots[carrier]]


def _base(mechanism: Mechanism, gear: Gear, link: str) -> str:
    """The body that the angle of a gear's link is measured on: what it is driven against, the carrier, the frame."""
    where = f"[[gears]] {gear.id}"
    reference = mechanism.links[link].reference
    if reference is None:
        pivot = next(iter(mechanism.links[link].coordinates), "")
        repair = _('add to it: reference = ["{pivot}", ...], two points of {carrier}')
        if gear.carrier == FRAME:
            repair = _('add to it: reference = ["{pivot}", ...], two points of the frame')
        raise InputError(
            where,
            _("on the sphere {link} needs an arc that its angle is measured from").format(link=link),
            repair.format(pivot=pivot, carrier=gear.carrier),
        )
    driven = {drive.link: drive.relative_to for drive in mechanism.drives if drive.link}
    # a driven link's angle is measured where its drive's is
    bodies = [driven[link]] if link in driven else [gear.carrier, FRAME]
    for body in bodies:
        if (
            body in (gear.carrier, FRAME)
            and body != link
            and set(reference) <= set(mechanism.points_of(body))
        ):
            return body
    what = _("the angle of {link} is measured neither on {carrier} nor on the frame")
    if gear.carrier == FRAME:
        what = _("the angle of {link} is not measured on the frame")
    raise InputError(
        where,
        what.format(link=link, carrier=gear.carrier),
        _("name two points of one of them: reference = [...]"),
    )
