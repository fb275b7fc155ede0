"""Where gears mesh: the pitch point, where it follows from the axes of both wheels."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from centrode.algebra.arrays import ARRAYS
from centrode.dynamics.pulls import Pull, Vector, couple, on_link
from centrode.geometry import sphere as space
from centrode.geometry.plane import dot, subtract
from centrode.geometry.sphere import unit
from centrode.model.mechanism import FRAME, Gear, Mechanism
from centrode.structure.constraints import GearRatio, Positions
from centrode.structure.dimensions import Dimensions


@dataclass(frozen=True)
class Teeth:
    """Axes of gears: gear -> points about which its first and its second wheel turn in the carrier.

    A gear is in it if each wheel has exactly one point in common with the carrier, and the wheels do not turn
    alike. Its radii follow from the distance of the axes and the ratio.

    `radius` is that of the sphere [m], None in the plane.
    """

    axes: Mapping[str, tuple[str, str]]
    radius: float | None = None

    @classmethod
    def of(cls, mechanism: Mechanism) -> Teeth:
        """The gears of a mechanism whose pitch points follow."""
        found = {}
        for gear in mechanism.gears:
            first, second = (_common(mechanism, wheel, gear.carrier) for wheel in gear.links)
            if len(first) == len(second) == 1 and first != second and gear.ratio != 1.0:
                found[gear.id] = (first[0], second[0])
        return cls(found, mechanism.sphere_radius if mechanism.space == "sphere" else None)

    def pulls(self, constraint: GearRatio, at: Positions, numbers: Dimensions) -> tuple[Pull, ...]:
        """The force between the teeth, square to the line of centres, with a moment of one on the second wheel.

        Its radial part, which presses the wheels apart, is left out: nothing tells the pressure angle.
        """
        ratio = numbers.gearing.ratio[constraint.gear]
        first, second = (at.points[name] for name in self.axes[constraint.gear])
        if self.radius is not None:
            return _on_sphere(constraint, ratio, first, second, self.radius)
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


def _on_sphere(
    gear: GearRatio, ratio: float, first: Vector, second: Vector, radius: float
) -> tuple[Pull, ...]:
    """The same of bevel gears, whose pitch cones touch along the axis of their relative turning.

    Wheels that turn against each other mesh between their axes. Of others nothing tells on which side of the centre,
    and so which way the force points: then its moment about the centre alone is put on the wheels.
    """
    a, b = (first[0], first[1], first[2]), (second[0], second[1], second[2])
    pitch = unit(ARRAYS, space.subtract(a, space.times(ratio, b)))
    along = space.cross(b, pitch)
    square = space.dot(along, along)
    if ratio < 0.0:
        force, place = space.times(1.0 / (radius * square), along), space.times(radius, pitch)
        return on_link(gear.second, force, place), on_link(gear.first, space.times(-1.0, force), place)
    moment = space.times(1.0 / square, space.cross(pitch, along))
    return couple(gear.second, moment), couple(gear.first, space.times(-1.0, moment))


def _common(mechanism: Mechanism, wheel: str, carrier: str) -> list[str]:
    """Points in which a wheel is hinged to its carrier."""

    def points(body: str) -> set[str]:
        return set(mechanism.frame.points if body == FRAME else mechanism.links[body].coordinates)

    return sorted(points(wheel) & points(carrier))
