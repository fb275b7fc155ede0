"""Positions at values of the joint coordinates, as the state that loads and masses are computed from."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from centrode.dynamics.forward_dynamics.elimination import is_zero
from centrode.dynamics.state import Centre, Radial, State, length_unit
from centrode.errors import NotComputedYet
from centrode.geometry.plane import dot, rotate_vector, subtract
from centrode.geometry.sphere import Attitude
from centrode.locale import _
from centrode.model.mechanism import Drive
from centrode.numerics.jets import Jet
from centrode.structure.constraints import Positions
from centrode.structure.dimensions import Dimensions

Number = Any


def _sum(a: Number, b: Number) -> Number:
    return b if is_zero(a) else a if is_zero(b) else a + b


def _negative(a: Number) -> Number:
    return a if is_zero(a) else -a


@dataclass(frozen=True)
class JointState(State):
    """A mechanism at values of its joint coordinates, along time or along one of them.

    Its jets run along time where all coordinates change by their speeds, and along a coordinate where this one alone
    changes, by 1: the derivative of what a load works along is then a velocity, or a column of its Jacobian. In place
    of columns of samples it has positions.

    Attributes
    ----------
    at : positions whose numbers are jets where they change, plain numbers where they do not
    numbers : dimensions
    pivots : link -> the point of the tree in which it hangs
    """

    at: Positions = field(default_factory=lambda: Positions({}, {}, {}))
    numbers: Dimensions | None = None
    pivots: Mapping[str, str] = field(default_factory=dict)

    def point(self, name: str) -> tuple[Jet, ...]:
        """Coordinates of a point [m]."""
        place = self.known.get(f"point {name}")
        if place is None:
            unit = length_unit(self.mechanism)
            place = tuple(self._scaled_jet(x, unit) for x in self.at.points[name])
            self.known[f"point {name}"] = place
        assert isinstance(place, tuple)
        return place

    def attitude(self, link: str) -> Attitude:
        """On the sphere: the axes of a link in those of the frame."""
        attitude = self.attitudes.get(link)
        if attitude is None:
            axes = self.at.poses[link]
            attitude = Attitude(*(tuple(map(self.as_jet, axis)) for axis in axes))  # type: ignore[arg-type]
            self.attitudes[link] = attitude
        return attitude

    def angle(self, link: str) -> Jet:
        """Angle of a link or of the frame [rad]; on the sphere that from its reference."""
        if link not in self.at.angles:
            what = _("the angle of link {link} is not a coordinate of the motion").format(link=link)
            raise NotComputedYet(
                f"[links.{link}]", what, _("let its first point be the hinge of its reference")
            )
        return self.as_jet(self.at.angles[link])

    def rotor(self, link: str) -> tuple[Jet, ...]:
        """Cosine and sine of a link's angle, in the plane."""
        return tuple(map(self.as_jet, self.at.poses[link].rotor))

    def centre(self, centre: Centre | Radial) -> tuple[Jet, ...]:
        """Centre of mass of a link [m], from the point in which the link hangs: others may belong to another chain."""
        if isinstance(centre, Radial):
            return super().centre(centre)
        assert self.numbers is not None
        local, pivot = self.numbers.local[centre.link], self.pivots[centre.link]
        (u, v), (x, y) = local[centre.base], local[pivot]
        offset = (_sum(_sum(u, _negative(x)), centre.along), _sum(_sum(v, _negative(y)), centre.across))
        along, across = self.point(pivot)
        if is_zero(offset[0]) and is_zero(offset[1]):
            return along, across
        cosine, sine = self.rotor(centre.link)
        turned = rotate_vector(offset, (cosine, sine))
        return along + turned[0], across + turned[1]

    def slide(self, guide: str) -> Jet:
        """Displacement along a guide [m]."""
        assert self.numbers is not None
        described = self.mechanism.guide(guide)
        slid = self.numbers.space.slide(
            self.m, self.at.points[described.point], self.at.poses[described.on], self.numbers.curve(guide)
        )
        return self._scaled_jet(slid, length_unit(self.mechanism))

    def drive(self, drive: Drive) -> Jet:
        """Value of what a drive moves [rad or m], whether it has a law or not."""
        if drive.kind == "angle":
            assert drive.link is not None
            if self.on_sphere:
                return self.angle(drive.link)
            return self.angle(drive.link) - self.angle(drive.relative_to)
        if drive.distance is not None:
            apart = subtract(*(self.point(name)[:2] for name in reversed(drive.distance)))  # type: ignore[arg-type]
            length: Jet = self.m.sqrt(dot(apart, apart))
            return length
        return self.slide(drive.guide or "")

    def as_jet(self, number: Number) -> Jet:
        """A number as a jet of the state's order."""
        return number if isinstance(number, Jet) else self.constant(number)

    def _scaled_jet(self, number: Number, unit: float) -> Jet:
        jet = self.as_jet(number)
        return jet if unit == 1.0 else jet * unit
