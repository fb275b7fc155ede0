"""In which order the unknowns of a group of higher class follow from a few free coordinates.

A link that hangs on a known point has one free coordinate, its turn about that point; a point of such a link has
none. Only the equations that are left over have to be solved together (tearing; Cellier and Kofman, Continuous
System Simulation, 2006, section 7). The order of elimination follows from the group alone.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

from centrode.structure.constraints import Entity, PointInLink
from centrode.structure.groups import Newton


class Follow(NamedTuple):
    """An unknown, the hinge from which it follows, and the first of its free coordinates.

    A link that hangs on a point is free to turn; without a hinge all coordinates of the unknown are free.
    """

    entity: Entity
    by: PointInLink | None
    first: int

    @property
    def turn(self) -> int:
        """The free coordinate that is the turn of a link."""
        return self.first if self.by is not None else self.first + 2


@dataclass(frozen=True)
class Pattern:
    """The unknowns of a group in the order in which they follow, and the equations left over."""

    follows: tuple[Follow, ...]
    kept: tuple[int, ...]

    @property
    def free(self) -> int:
        """Number of free coordinates."""
        return len(self.kept)


@lru_cache(maxsize=256)
def pattern_of(group: Newton) -> Pattern:
    """In which order the unknowns of a group follow."""
    # hinges whose two rows both belong to the group tie all that a point has
    whole = [
        c
        for c, row in group.equations
        if row == 1 and isinstance(c, PointInLink) and (c, 0) in group.equations
    ]
    left = [Entity("link", name) for name in group.links] + [Entity("point", name) for name in group.points]
    follows: list[Follow] = []
    used: set[PointInLink] = set()
    free = 0
    while left:
        # what follows from something known goes first; without such, the coordinates of the next unknown are
        # free
        hinge = next((f for entity in left if (f := _hinge(entity, whole, left))), None)
        entity = left[0] if hinge is None else hinge[0]
        by = None if hinge is None else hinge[1]
        follows.append(Follow(entity, by, free))
        left.remove(entity)
        if by is None:
            free += entity.unknowns
        else:
            used.add(by)
            free += entity.kind == "link"
    # both rows of a hinge that an unknown follows from hold by construction, and are not solved
    kept = tuple(i for i, (c, _row) in enumerate(group.equations) if c not in used)
    return Pattern(tuple(follows), kept)


def _hinge(
    entity: Entity, whole: Sequence[PointInLink], left: Sequence[Entity]
) -> tuple[Entity, PointInLink] | None:
    """A hinge that ties an unknown to what is known already."""
    for constraint in whole:
        point, link = constraint.bodies
        if entity in (point, link) and not (point in left and link in left):
            return entity, constraint
    return None
