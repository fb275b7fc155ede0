"""Places in symbols: two coordinates, each a sum."""

from __future__ import annotations

from typing import NamedTuple

from centrode.equations.letters import Angle
from centrode.equations.merging import merged
from centrode.equations.sums import ZERO, Sum


class Place(NamedTuple):
    """A vector in the frame's axes."""

    x: Sum
    y: Sum

    def plus(self, other: Place, factor: int = 1) -> Place:
        """The vector and `factor` times the other."""
        return Place(self.x + other.x.scaled(factor), self.y + other.y.scaled(factor))

    def along(self, angle: Angle) -> Sum:
        """Component in a direction."""
        return merged(Sum.wave("cos", angle) * self.x + Sum.wave("sin", angle) * self.y)

    def across(self, angle: Angle) -> Sum:
        """Component to the left of a direction."""
        return self.along(angle.turned(1))


ORIGIN = Place(ZERO, ZERO)


def polar(size: Sum, angle: Angle) -> Place:
    """A vector by its size and direction."""
    return Place(size * Sum.wave("cos", angle), size * Sum.wave("sin", angle))
