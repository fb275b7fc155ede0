"""Sides of hinges: the force of each pin on each link that it joins, the frame included."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, TypeAlias

from centrode.dynamics.kinetostatics.solution import Forces
from centrode.dynamics.pulls import Pull, Vector
from centrode.model.mechanism import FRAME, Mechanism
from centrode.structure.constraints import Entity, PointInLink

Number: TypeAlias = Any


@dataclass(frozen=True)
class Side:
    """A point and a body that is hinged there."""

    point: str
    body: str

    @property
    def label(self) -> str:
        """Its name in results."""
        return f"{self.point}/{self.body}"


def sides_of(mechanism: Mechanism) -> tuple[Side, ...]:
    """Sides of all hinges, in the order in which links name the points; of each its links, then the frame.

    A moving point in one link is a hinge if a guide or a cylinder holds it as well; so is a fixed one in none.
    """
    held = {guide.point for guide in mechanism.guides}
    held |= {point for drive in mechanism.drives for point in drive.distance or ()}
    found = []
    named = [point for link in mechanism.links.values() for point in link.coordinates]
    for point in dict.fromkeys([*named, *mechanism.moving_points, *mechanism.frame.points]):
        links = [name for name, link in mechanism.links.items() if point in link.coordinates]
        fixed = point in mechanism.frame.points
        if len(links) > 1 or (links and fixed) or (point in held and (links or fixed)):
            found += [Side(point, link) for link in links]
            found += [Side(point, FRAME)] if fixed else []
    return tuple(found)


def side_forces(forces: Forces, sides: Iterable[Side]) -> dict[Side, Vector]:
    """Force of the pin on the body at each side [N], in the frame's axes."""
    origin = forces.system.equilibrium.origin
    return {
        side: _sum(
            pulls_on_point(forces, side.point) if side.body == FRAME else _on_body(forces, side), origin
        )
        for side in sides
    }


def _on_body(forces: Forces, side: Side) -> list[Pull]:
    """What the pin does to a link: by being its point, and on the sphere by being pressed against it alone."""
    tie = PointInLink(side.point, side.body)
    known = [(tie, row) for row in range(tie.size) if (tie, row) in forces.multipliers]
    tied = [pull for unknown in known for pull in forces.pulls(unknown) if pull.body.kind == "link"]
    pressed = [pull for one in forces.pressing if one.point == side.point for pull in one.pulls]
    return [*tied, *(pull for pull in pressed if pull.body == Entity("link", side.body))]


def _sum(pulls: Iterable[Pull], origin: Vector) -> Vector:
    """Sum of forces; of none, nothing."""
    found = origin
    for pull in pulls:
        found = tuple(x + y for x, y in zip(found, pull.force, strict=True))
    return found


def pulls_on_point(forces: Forces, point: str) -> list[Pull]:
    """All forces on a pin: of links, guides, cylinders and loads."""
    return [pull for pull in forces.all_pulls if pull.body.kind == "point" and pull.body.name == point]
