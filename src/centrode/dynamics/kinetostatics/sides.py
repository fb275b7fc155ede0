"""Sides of hinges: the force of each pin on each link that it joins, the frame included."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np

from centrode.dynamics.kinetostatics.solution import Forces
from centrode.dynamics.pulls import Pull
from centrode.model.mechanism import FRAME, Mechanism
from centrode.structure.constraints import PointInLink

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


def side_forces(forces: Forces, sides: Iterable[Side]) -> dict[Side, tuple[Number, Number]]:
    """Force of the pin on the body at each side [N], in the frame's axes."""
    found: dict[Side, tuple[Number, Number]] = {}
    for side in sides:
        if side.body == FRAME:
            found[side] = _on_frame(forces, side.point)
        else:
            parts = [_multiplier(forces, PointInLink(side.point, side.body), row) for row in range(2)]
            found[side] = -parts[0], -parts[1]
    return found


def _multiplier(forces: Forces, constraint: PointInLink, row: int) -> Number:
    return forces.multipliers.get((constraint, row), 0.0)


def _on_frame(forces: Forces, point: str) -> tuple[Number, Number]:
    """What a pin passes on to the frame: everything that acts on it."""
    x: Number = np.zeros(forces.system.shape)
    y: Number = np.zeros(forces.system.shape)
    for pull in pulls_on_point(forces, point):
        x, y = x + pull.force[0], y + pull.force[1]
    return x, y


def pulls_on_point(forces: Forces, point: str) -> list[Pull]:
    """All forces on a pin: of links, guides, cylinders and loads."""
    return [pull for pull in forces.all_pulls if pull.body.kind == "point" and pull.body.name == point]
