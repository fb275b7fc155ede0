"""Where gears mesh: the pitch point, where it follows from the axes of both wheels."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from centrode.dynamics.pulls import Pull, on_link
from centrode.geometry.plane import dot, subtract
from centrode.model.mechanism import FRAME, Gear, Mechanism
from centrode.structure.dimensions import Dimensions
from centrode.structure.positions import Positions
from centrode.structure.wheels import GearRatio


@dataclass(frozen=True)
class Teeth:
    """Axes of gears: gear -> points about which its first and its second wheel turn in the carrier.

    A gear is in it if each wheel has exactly one point in common with the carrier, and the wheels do not turn
    alike. Its radii follow from the distance of the axes and the ratio.
    """

    axes: Mapping[str, tuple[str, str]]

    @classmethod
    def of(cls, mechanism: Mechanism) -> Teeth:
        """The gears of a mechanism whose pitch points follow."""
        found = {}
        for gear in mechanism.gears:
            first, second = (_common(mechanism, wheel, gear.carrier) for wheel in gear.links)
            if len(first) == len(second) == 1 and first != second and gear.ratio != 1.0:
                found[gear.id] = (first[0], second[0])
        return cls(found)

    def pulls(self, constraint: GearRatio, at: Positions, numbers: Dimensions) -> tuple[Pull, ...]:
        """The force between the teeth, square to the line of centres, with a moment of one on the second wheel.

        Its radial part, which presses the wheels apart, is left out: nothing tells the pressure angle.
        """
        ratio = numbers.gearing.ratio[constraint.gear]
        first, second = (at.points[name] for name in self.axes[constraint.gear])
        pitch = tuple((a - ratio * b) / (1.0 - ratio) for a, b in zip(first, second, strict=True))
        place = pitch[0], pitch[1]
        x, y = subtract(place, second)
        square = dot((x, y), (x, y))
        force = -y / square, x / square
        return (
            on_link(constraint.second, force, place),
            on_link(constraint.first, (-force[0], -force[1]), place),
        )

    def without(self, gears: tuple[Gear, ...]) -> tuple[str, ...]:
        """Gears whose tooth forces are not known: their moments are."""
        return tuple(gear.id for gear in gears if gear.id not in self.axes)


def _common(mechanism: Mechanism, wheel: str, carrier: str) -> list[str]:
    """Points in which a wheel is hinged to its carrier."""

    def points(body: str) -> set[str]:
        return set(mechanism.frame.points if body == FRAME else mechanism.links[body].coordinates)

    return sorted(points(wheel) & points(carrier))
