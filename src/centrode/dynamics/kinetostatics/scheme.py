"""What the equations of kinetostatics are solved for: one unknown for each scalar constraint.

Unknowns are the multipliers of J' lambda = -Q: the force of a constraint is its multiplier times its row. A
pin has no mass, so a link of each pin, its host, bears whatever else acts on the pin: the force between pin and
host is left to the pin's own balance, and three equations a link remain. The host's own two rows are the axes
of that balance, along the sphere as in the plane.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TypeAlias

from centrode.structure.constraints import Constraint, PointInLink
from centrode.structure.plan import Structure

Unknown: TypeAlias = tuple[Constraint, int]
"""One scalar equation: a constraint and its row there."""
Axis: TypeAlias = tuple[str, int]
"""A point and one of its two coordinates."""


@dataclass(frozen=True)
class Scheme:
    """Unknowns and equations of one structure.

    Attributes
    ----------
    solved : as many unknowns as there are equations
    hosts : (point, axis) -> unknown that follows from the pin's balance
    loose : (point, axis) of points without a link to bear them: they keep their own equations
    repeating : unknowns of the equations that repeat others; nothing tells how great they are
    """

    structure: Structure
    solved: tuple[Unknown, ...]
    hosts: Mapping[Axis, Unknown]
    loose: tuple[Axis, ...]
    repeating: tuple[Unknown, ...]

    @classmethod
    def of(cls, structure: Structure) -> Scheme:
        """The scheme of a structure."""
        left_out = set(structure.repeating)
        kept = [
            (constraint, row)
            for constraint in structure.constraints
            for row in range(constraint.size)
            if (constraint, row) not in left_out
        ]
        points = [entity.name for entity in structure.unknowns if entity.kind == "point"]
        hosts = _hosts(points, kept)
        taken = set(hosts.values())
        loose = tuple((point, axis) for point in points for axis in range(2) if (point, axis) not in hosts)
        solved = tuple(unknown for unknown in kept if unknown not in taken)
        return cls(structure, solved, hosts, loose, structure.repeating)

    @property
    def links(self) -> tuple[str, ...]:
        """Links, each with three equations."""
        return tuple(self.structure.mechanism.links)

    @property
    def unknowns(self) -> tuple[Unknown, ...]:
        """Unknowns of the linear system, those of repeating equations behind the others."""
        return (*self.solved, *self.repeating)

    @property
    def size(self) -> int:
        """Number of equations."""
        return 3 * len(self.links) + len(self.loose)

    def first_row(self, link: str) -> int:
        """Row of a link's first force equation; the other and that of moments follow."""
        return 3 * self.links.index(link)


def _hosts(points: list[str], kept: list[Unknown]) -> dict[Axis, Unknown]:
    """The unknowns that bear each pin: both rows of the first link that has both."""
    found: dict[Axis, Unknown] = {}
    whole = set(kept)
    for constraint, row in kept:
        if (
            isinstance(constraint, PointInLink)
            and constraint.point in points
            and (constraint, 1 - row) in whole
        ):
            found.setdefault((constraint.point, row), (constraint, row))
    return found
