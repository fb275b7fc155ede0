"""Which bodies are in equilibrium by themselves, group by group, the last of the plan first.

A perfect matching of the unknowns of the joints with the equations of equilibrium, then the strong components of
"its equations hold unknowns of" (Dulmage and Mendelsohn): these are Assur's groups and the input links.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from centrode.dynamics.force_polygons.bodies import Bodies
from centrode.dynamics.force_polygons.joints import Joint
from centrode.errors import NotComputedYet
from centrode.locale import _
from centrode.model.mechanism import FRAME
from centrode.structure.constraints import Contact
from centrode.structure.plan import Structure
from centrode.structure.rank import in_order, match, strong_components

Equation: TypeAlias = tuple[str, int]


@dataclass(frozen=True)
class Cell:
    """Bodies whose joints get known together, with these joints."""

    bodies: tuple[str, ...]
    joints: tuple[Joint, ...]

    @property
    def inner(self) -> tuple[Joint, ...]:
        """Joints between its own bodies."""
        return tuple(j for j in self.joints if set(j.bodies) <= set(self.bodies))

    def of(self, body: str) -> tuple[Joint, ...]:
        """Joints of one of its bodies."""
        return tuple(joint for joint in self.joints if body in joint.shares)


def cells_of(structure: Structure, bodies: Bodies, joints: Sequence[Joint]) -> tuple[Cell, ...]:
    """Groups in the order in which reactions get known.

    Raises NotComputedYet where constraints repeat each other, so that equilibrium does not determine the reactions.
    """
    repeated = [one.label for one in structure.redundant if not isinstance(one, Contact)]
    if repeated:
        _refuse(repeated)
    names = [name for name in reversed(bodies.names) if name != FRAME]
    names.sort(key=lambda name: -bodies.order[name])
    unknowns = [(joint, k) for joint in joints for k in range(len(joint.bases))]
    owner = match({number: _equations(bodies, *unknown) for number, unknown in enumerate(unknowns)})
    loose = set(range(len(unknowns))) - set(owner.values())
    if loose or len(owner) != sum(_size(bodies, name) for name in names):
        _refuse(sorted({unknowns[number][0].name for number in loose}))
    home = {number: body for (body, _row), number in owner.items()}
    depends: dict[str, list[str]] = {name: [] for name in names}
    for number, (joint, _basis) in enumerate(unknowns):
        for body in joint.bodies:
            if body not in (FRAME, home[number]):
                depends[body].append(home[number])
    components = in_order(strong_components(depends), depends)
    return tuple(_cell(bodies, component, unknowns, home) for component in components)


def _size(bodies: Bodies, body: str) -> int:
    """Equations of a body: two of a bare pin."""
    return 2 if body in bodies.pins else 3


def _equations(bodies: Bodies, joint: Joint, basis: int) -> list[Equation]:
    """Equations in which an unknown stands: of a force all three, of a moment the last."""
    force, _moment = joint.bases[basis]
    rows = range(3) if force else (2,)
    return [
        (body, row) for body in joint.bodies if body != FRAME for row in rows if row < _size(bodies, body)
    ]


def _cell(
    bodies: Bodies, component: Sequence[str], unknowns: Sequence[tuple[Joint, int]], home: Mapping[int, str]
) -> Cell:
    own = tuple(name for name in bodies.names if name in component)
    found: list[Joint] = []
    for number in sorted(home):
        joint = unknowns[number][0]
        if home[number] in own and not any(joint is other for other in found):
            found.append(joint)
    return Cell(own, tuple(found))


def _refuse(names: Sequence[str]) -> None:
    raise NotComputedYet(
        ", ".join(names),
        _("constraints repeat each other: equilibrium does not determine the reactions"),
        _("take the redundant ones out of the description"),
    )
