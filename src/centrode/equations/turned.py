"""Attitudes on the sphere in symbols: three axes, turned about the first by angles and about the third by arcs."""

from __future__ import annotations

from typing import NamedTuple

from centrode.equations.letters import Angle
from centrode.equations.merging import merged
from centrode.equations.sums import ZERO, Sum


class SpherePlace(NamedTuple):
    """A place on the unit sphere: its coordinates, each a sum."""

    x: Sum
    y: Sum
    z: Sum

    def dot(self, other: SpherePlace) -> Sum:
        """Cosine of the arc to another place."""
        return merged(self.x * other.x + self.y * other.y + self.z * other.z)


class Axes(NamedTuple):
    """A place, the direction of an arc that starts there, and the one to the left of it, seen from outside."""

    at: SpherePlace
    along: SpherePlace
    left: SpherePlace

    def turned(self, angle: Angle) -> Axes:
        """Turned in its place, counter-clockwise seen from outside."""
        cosine, sine = Sum.wave("cos", angle), Sum.wave("sin", angle)
        return Axes(
            self.at,
            _mixed(cosine, self.along, sine, self.left),
            _mixed(-sine, self.along, cosine, self.left),
        )

    def moved(self, arc: Angle) -> Axes:
        """Moved on along the arc."""
        cosine, sine = Sum.wave("cos", arc), Sum.wave("sin", arc)
        return Axes(
            _mixed(cosine, self.at, sine, self.along), _mixed(-sine, self.at, cosine, self.along), self.left
        )

    def leaning(self, angle: Angle, side: int) -> Axes:
        """Directed to where it came from, then turned to the side by a right angle less `angle`."""
        cosine, sine = Sum.wave("cos", angle).scaled(side), Sum.wave("sin", angle)
        return Axes(
            self.at,
            _mixed(-sine, self.along, cosine, self.left),
            _mixed(-cosine, self.along, -sine, self.left),
        )


def _mixed(a: Sum, one: SpherePlace, b: Sum, other: SpherePlace) -> SpherePlace:
    return SpherePlace(*(merged(a * x + b * y) for x, y in zip(one, other, strict=True)))


NOUGHT, UNIT = ZERO, Sum.number(1)
AXES = Axes(
    SpherePlace(UNIT, NOUGHT, NOUGHT), SpherePlace(NOUGHT, UNIT, NOUGHT), SpherePlace(NOUGHT, NOUGHT, UNIT)
)
"""Those in which everything is written."""
BACK = Angle((), 2)
