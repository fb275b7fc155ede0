"""From a description to its structure and its plan: what is solved, in which order, by which closed form."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

from centrode.errors import InputError, NotComputedYet
from centrode.geometry.space import Space
from centrode.locale import _, ngettext
from centrode.model.mechanism import Mechanism
from centrode.structure.classify import classify
from centrode.structure.constraints import Constraint, PointInLink, constraints_of, is_drive, unknowns_of
from centrode.structure.dimensions import Dimensions, dimensions_of
from centrode.structure.gear_ratios import GearRatio
from centrode.structure.groups import Group, Newton, links_of
from centrode.structure.matching import in_order, match, strong_components
from centrode.structure.positions import Entity
from centrode.structure.rank import Matrix, generic_jacobian, independent_rows
from centrode.structure.wheel_groups import Train, angles_in
from centrode.structure.wheels import Contact, NoSlip


@dataclass(frozen=True)
class Structure:
    """What follows from the description alone, before any position is known.

    Attributes
    ----------
    constraints : all of them, drives first; `redundant` those that repeat others at a generic position
    repeating : (constraint, row), the single equations of these that are left out
    unknowns : moving points and links
    groups : the plan, each group needing only what stands before it
    generic_mobility : unknowns less the rank without drives at a generic position; a mechanism of special
        dimensions (three parallel cranks) can move although this is 0
    """

    mechanism: Mechanism
    dimensions: Dimensions
    constraints: tuple[Constraint, ...]
    redundant: tuple[Constraint, ...]
    repeating: tuple[tuple[Constraint, int], ...]
    unknowns: tuple[Entity, ...]
    groups: tuple[Group, ...]
    generic_mobility: int

    @cached_property
    def counted(self) -> tuple[tuple[str, ...], ...]:
        """Links of each group whose angles matter with their turns: those of gears and rolling wheels."""
        wanted: set[str] = set()
        for constraint in self.constraints:
            if isinstance(constraint, GearRatio):
                wanted.update(constraint.links)
            elif isinstance(constraint, NoSlip):
                wanted.update((constraint.link, constraint.on))
        for group in self.groups:
            if isinstance(group, Train):
                wanted.update(link for equation in group.equations for link in angles_in(equation))
        return tuple(tuple(link for link in links_of(group) if link in wanted) for group in self.groups)

    @property
    def drives(self) -> int:
        """Number of drives."""
        return len(self.mechanism.drives)


def structure_of(mechanism: Mechanism) -> Structure:
    """Structure and plan of a mechanism.

    Raises
    ------
    InputError
        No drive, or fewer or more drives than the mobility (rank) has.
    NotComputedYet
        The description names what this version does not compute.
    """
    dimensions = dimensions_of(mechanism)
    _refuse_what_the_space_lacks(mechanism, dimensions.space)
    constraints = constraints_of(mechanism)
    unknowns = unknowns_of(mechanism)
    matrix = generic_jacobian(mechanism, constraints, unknowns, dimensions)
    owners = [c for c in constraints for _row in range(c.size)]
    kept = _independent(mechanism, matrix, owners)
    drive_rows = sum(is_drive(c) for c in constraints)
    # with all rows independent, so are those without the drives
    free_rank = len(kept) - drive_rows if all(kept) else int(independent_rows(matrix[drive_rows:]).sum())
    mobility = matrix.shape[1] - free_rank
    _check_drives(mechanism, matrix, kept, owners, mobility)
    groups = _groups(mechanism, dimensions.space, unknowns, kept, owners)
    repeating = _left_out(owners, kept)
    redundant = tuple(dict.fromkeys(constraint for constraint, _row in repeating))
    return Structure(mechanism, dimensions, constraints, redundant, repeating, unknowns, groups, mobility)


def _independent(mechanism: Mechanism, matrix: Matrix, owners: Sequence[Constraint]) -> list[bool]:
    """Which rows are kept: drives first, links with few points last, and contacts of wheels behind them.

    Which of several constraints that repeat each other is left out is a choice. A link of two points that is
    left out still lies through both; a plate would have to be solved together with its neighbours. An arm or
    a guide that keeps a wheel at its track does so better than the contact, which says nothing of the wheel.
    """

    def rank(row: int) -> int:
        owner = owners[row]
        if is_drive(owner):
            return -len(mechanism.points) - 1
        if isinstance(owner, Contact):
            return 1
        return -len(mechanism.links[owner.link].coordinates) if isinstance(owner, PointInLink) else 0

    order = sorted(range(len(owners)), key=rank)
    kept = [False] * len(owners)
    for row, keep in zip(order, independent_rows(matrix[order]), strict=True):
        kept[row] = bool(keep)
    return kept


def _refuse_what_the_space_lacks(mechanism: Mechanism, space: Space) -> None:
    guided = next((guide.id for guide in mechanism.guides if guide.link is not None), None)
    distance = any(drive.kind == "distance" for drive in mechanism.drives)
    asked = [
        ("guided links", guided is not None, f"[[guides]] {guided}, link", _("hinge the link at the pole")),
        ("rolling", bool(mechanism.rolling), "[[rolling]]", _("take it out, or work in the plane")),
        ("distance", distance, "[[drives]] distance", _("drive the angle of a link")),
    ]
    for what, found, where, repair in asked:
        if found and what in space.lacks:
            raise NotComputedYet(where, _("it is not computed on the sphere"), repair)


def _check_drives(
    mechanism: Mechanism, matrix: Matrix, kept: Sequence[bool], owners: Sequence[Constraint], mobility: int
) -> None:
    """Refuse drives that repeat each other, drive what is locked, or leave something loose."""
    drives = len(mechanism.drives)
    if drives == 0:
        raise InputError(
            "[[drives]]", _("the mechanism has no drive"), _("give one drive per degree of freedom")
        )
    repeated = [c.label for c, keep in zip(owners, kept, strict=True) if is_drive(c) and not keep]
    numbers = drives_against_mobility(drives, mobility)
    if repeated:
        raise InputError("[[drives]]", numbers, _("take away: {drives}").format(drives="; ".join(repeated)))
    if sum(kept) == matrix.shape[1]:
        return
    locked = _locked_drives(matrix, owners)
    if locked and drives == mobility:
        raise InputError(
            "; ".join(locked),
            _("it cannot move: the rest of the mechanism holds it"),
            _("drive what can move, or take constraints away"),
        )
    raise InputError("[[drives]]", numbers, _("add drives, or constrain what moves freely"))


def _locked_drives(matrix: Matrix, owners: Sequence[Constraint]) -> list[str]:
    """Drives of what the other constraints hold already."""
    rows = [row for row, owner in enumerate(owners) if not is_drive(owner)]
    drives = [row for row, owner in enumerate(owners) if is_drive(owner)]
    free = independent_rows(matrix[rows + drives])[len(rows) :]
    return [owners[row].label for row, moves in zip(drives, free, strict=True) if not moves]


def drives_against_mobility(drives: int, mobility: int) -> str:
    """The sentence that compares the number of drives with the mobility."""
    return ngettext("{n} drive is given", "{n} drives are given", drives).format(n=drives) + _(
        ", but the mobility (by rank) is {mobility}"
    ).format(mobility=mobility)


def _left_out(owners: Sequence[Constraint], kept: Sequence[bool]) -> tuple[tuple[Constraint, int], ...]:
    """Equations that are not kept, each as its constraint and its row there."""
    first = {constraint: row for row, constraint in reversed([*enumerate(owners)])}
    return tuple(
        (owner, row - first[owner])
        for row, (owner, keep) in enumerate(zip(owners, kept, strict=True))
        if not keep
    )


def _groups(
    mechanism: Mechanism,
    space: Space,
    unknowns: Sequence[Entity],
    kept: Sequence[bool],
    owners: Sequence[Constraint],
) -> tuple[Group, ...]:
    """Groups in an order in which each needs only what stands before it."""
    inside = set(unknowns)
    neighbours = {
        (row, owners[row]): [
            (entity, k) for entity in owners[row].bodies if entity in inside for k in range(entity.unknowns)
        ]
        for row in range(len(owners))
        if kept[row]
    }
    owner = match(neighbours)
    matched: dict[Entity, list[int]] = {entity: [] for entity in unknowns}
    for (entity, _k), (row, _constraint) in owner.items():
        matched[entity].append(row)
    depends = {
        entity: list(
            dict.fromkeys(
                other for row in own for other in owners[row].bodies if other != entity and other in inside
            )
        )
        for entity, own in matched.items()
    }
    first: dict[Constraint, int] = {}
    for row, constraint in enumerate(owners):
        first.setdefault(constraint, row)
    groups = []
    for component in in_order(strong_components(depends), depends):
        rows = sorted(row for entity in component for row in matched[entity])
        equations = [(owners[row], row - first[owners[row]]) for row in rows]
        groups.append(classify(mechanism, component, equations, space.crosses_once))
        _refuse_unfollowed(mechanism, groups[-1])
    return tuple(groups)


def _refuse_unfollowed(mechanism: Mechanism, group: Group) -> None:
    """On the sphere no turns are counted inside groups of higher class, so gears there have no equation."""
    if mechanism.space != "sphere" or not isinstance(group, Newton):
        return
    gear = next((c.gear for c, _row in group.equations if isinstance(c, GearRatio)), None)
    if gear is not None:
        raise NotComputedYet(
            f"[[gears]] {gear}",
            _("on the sphere a gear inside a group of higher class is not computed"),
            _("drive one of its wheels"),
        )
