"""From a description to its structure and its plan: what is solved, in which order, by which closed form."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from typing import Protocol, assert_never

from centrode.errors import InputError, NotComputedYet
from centrode.geometry.space import Space
from centrode.locale import _, ngettext
from centrode.model.mechanism import Mechanism, Rolling
from centrode.structure.constraints import (
    FRAME,
    AngleDrive,
    Constraint,
    DisplacementDrive,
    DistanceDrive,
    Entity,
    GearRatio,
    NoSlip,
    NoTurning,
    PointInLink,
    PointOnGuide,
    TrackContact,
    constraints_of,
    is_drive,
    unknowns_of,
)
from centrode.structure.dimensions import SPACES, Dimensions, dimensions_of
from centrode.structure.gearing import shares_of
from centrode.structure.groups import (
    Aim,
    AngleEquation,
    AngleGiven,
    Arm,
    CylinderCircle,
    Following,
    Group,
    GuideStop,
    Locus,
    Meet,
    Meshed,
    Newton,
    Rail,
    RigidPoint,
    Rod,
    Rolled,
    Rolloff,
    Slot,
    Touch,
    Train,
    TurnedLink,
    Turning,
    TwoPointLink,
    angles_in,
)
from centrode.structure.loose_points import look_alike_error, loose_points_repair
from centrode.structure.rank import (
    Matrix,
    generic_jacobian,
    in_order,
    independent_rows,
    match,
    strong_components,
)

# Finding what gears and rolling wheels form in a group: angles that follow one another, loci, trains.

SINGULAR = 1e-9
"""A pivot smaller than this, beside ratios of the order of one, means that the angles do not follow."""
COINCIDE = 1e-12
"""Coordinates closer than this part of their size are those of one place."""


class GroupToSolve(Protocol):
    """A group before it is classified."""

    @property
    def mechanism(self) -> Mechanism: ...
    @property
    def points(self) -> tuple[str, ...]: ...
    @property
    def links(self) -> tuple[str, ...]: ...
    @property
    def constraints(self) -> tuple[Constraint, ...]: ...
    def ends(self, link: str) -> tuple[str, ...]: ...
    def knows_point(self, point: str) -> bool: ...
    def knows_link(self, link: str) -> bool: ...


def relation_to_known(group: GroupToSolve, constraint: Constraint, link: str) -> Following | None:
    """Gear or rolling contact as the source of a link's angle from known angles; None if it is none."""
    if isinstance(constraint, GearRatio) and link in constraint.links:
        if not all(group.knows_link(other) for other in constraint.links if other != link):
            return None
        first, second = shares_of(group.mechanism, constraint.gear)
        # the carrier's factor ratio * first - second vanishes: it turns freely
        if link == constraint.carrier and _ratio(group.mechanism, constraint) * first == second:
            raise _singular((link,))
        return Meshed(constraint)
    if isinstance(constraint, NoSlip) and link == constraint.link:
        known = group.knows_point(constraint.centre) and group.knows_link(constraint.on)
        return Rolled(constraint) if known else None
    return None


def wheel_locus(group: GroupToSolve, constraint: Constraint, carriage: str | None) -> Touch | Rolloff | None:
    """The locus that a contact or a rolling contact is for the unknown vector of a group; None if it is none."""
    if not isinstance(constraint, (TrackContact, NoSlip)):
        return None
    straight = _description(group.mechanism, constraint.rolling).along.radius is None
    centre_known = group.knows_point(constraint.centre)
    carried = constraint.on == carriage
    # either the unknown carries the track past a known wheel, or the wheel is unknown at a known track
    if carried != centre_known or not (carried or group.knows_link(constraint.on)):
        return None
    if isinstance(constraint, TrackContact):
        return Touch(constraint.centre, constraint, carried, "P" if straight else "R")
    turns_known = constraint.link == carriage or group.knows_link(constraint.link)
    # on a line the wheel's turn gives the place along it; on a circle the bearing, which is an angle
    return Rolloff(constraint.centre, constraint, carried) if straight and turns_known else None


def train(group: GroupToSolve) -> Train | None:
    """A group whose angles follow from equations between them alone; its links then only have to be placed."""
    hinges = [c for c in group.constraints if isinstance(c, PointInLink)]
    others = [c for c in group.constraints if not isinstance(c, PointInLink)]
    equations = [equation_of(group, c) for c in others]
    # as many equations as angles, and every one of them between angles alone
    if len(equations) != len(group.links) or len(equations) < 2 or None in equations:
        return None
    chosen = tuple(equation for equation in equations if equation is not None)
    placed = _placing_order(group, hinges)
    if placed is None:
        return None
    return Train(chosen, _pivots(group, chosen), *placed)


def equation_of(group: GroupToSolve, constraint: Constraint) -> AngleEquation | None:
    """The equation between angles that a constraint of a group is; None if it is none."""
    if isinstance(constraint, AngleDrive):
        return AngleGiven(constraint.link, constraint.relative_to, drive=constraint.drive)
    if isinstance(constraint, NoTurning):
        return AngleGiven(constraint.link, constraint.on, guide=constraint.guide)
    if isinstance(constraint, GearRatio):
        return constraint
    if isinstance(constraint, NoSlip):
        if group.knows_point(constraint.centre) and group.knows_link(constraint.on):
            return constraint
        return _arm(group.mechanism, constraint)
    return None


def _arm(mechanism: Mechanism, rolling: NoSlip) -> Arm | None:
    """The link that carries a wheel around the circle it rolls on, if one turns about the circle's centre."""
    pivot = _named_centre(mechanism, _description(mechanism, rolling.rolling))
    for name, link in mechanism.links.items():
        if pivot in link.coordinates and rolling.centre in link.coordinates and name != rolling.on:
            return Arm(rolling, name, pivot or "")
    return None


def _named_centre(mechanism: Mechanism, wheel: Rolling) -> str | None:
    """The point of the wheel's track that is its circle's centre, where one has a name."""
    along = wheel.along
    if along.radius is None or isinstance(along.centre, str):
        return along.centre if isinstance(along.centre, str) else None
    x, y = along.centre or (0.0, 0.0)
    near = COINCIDE * (abs(x) + abs(y) + along.radius)
    for name, (px, py) in mechanism.points_of(wheel.on).items():
        if abs(px - x) <= near and abs(py - y) <= near:
            return name
    return None


def _placing_order(
    group: GroupToSolve, hinges: Sequence[PointInLink]
) -> tuple[tuple[tuple[str, str], ...], tuple[tuple[str, str], ...]] | None:
    """Each link with its known point in an order of placing, and each point with the link that brings it."""
    places: list[tuple[str, str]] = []
    brought: dict[str, str] = {}
    waiting = list(group.links)
    while waiting:
        for link in waiting:
            own = [c.point for c in hinges if c.link == link]
            known = [point for point in own if group.knows_point(point) or point in brought]
            # two known points would fix the link's angle, which the equations give already
            if len(known) > 1:
                return None
            if known:
                places.append((link, known[0]))
                brought |= {point: link for point in own if point != known[0]}
                waiting.remove(link)
                break
        else:
            return None
    # points that no link of the group brings would hang on something else
    if set(brought) != set(group.points) or any(c.link not in group.links for c in hinges):
        return None
    return tuple(places), tuple(brought.items())


def _pivots(group: GroupToSolve, equations: Sequence[AngleEquation]) -> tuple[tuple[int, str], ...]:
    """Order of elimination by the description's own ratios: the greatest factor first."""
    rows = [_weights(group.mechanism, equation) for equation in equations]
    table = [{link: row.get(link, 0.0) for link in group.links} for row in rows]
    pivots: list[tuple[int, str]] = []
    for _step in group.links:
        # what is left of rows and columns; of equal sizes the first row counts, hence -i
        rest = [
            (abs(table[i][link]), -i, link)
            for i in range(len(table))
            for link in group.links
            if all(i != row and link != column for row, column in pivots)
        ]
        size, k, link = max(rest, key=lambda entry: entry[:2])
        # what is left is rounding beside factors of the order of one
        if size < SINGULAR:
            raise _singular(group.links)
        pivots.append((-k, link))
        # eliminated in all rows left, as the formula does it over any algebra
        for i in range(len(table)):
            if all(i != row for row, _column in pivots):
                share = table[i][link] / table[-k][link]
                table[i] = {name: x - share * table[-k][name] for name, x in table[i].items()}
    return tuple(pivots)


def _weights(mechanism: Mechanism, equation: AngleEquation) -> Mapping[str, float]:
    """Link -> factor of its angle, with the numbers of the description."""
    match equation:
        case GearRatio():
            ratio = _ratio(mechanism, equation)
            first, second = shares_of(mechanism, equation.gear)
            return {equation.first: -ratio, equation.second: 1.0, equation.carrier: ratio * first - second}
        case Arm(rolling=rolling):
            spin = _spin(_description(mechanism, rolling.rolling))
            return {rolling.link: 1.0, rolling.on: spin - 1.0, equation.link: -spin}
        case NoSlip() | AngleGiven():
            # on the sphere the angle is the one that is given, measured on the body it is against
            if mechanism.space == "sphere":
                return {equation.link: 1.0}
            return dict(zip(angles_in(equation), (1.0, -1.0), strict=True))
        case _:
            assert_never(equation)


def _ratio(mechanism: Mechanism, gear: GearRatio) -> float:
    return next(other.ratio for other in mechanism.gears if other.id == gear.gear)


def _description(mechanism: Mechanism, rolling: str) -> Rolling:
    return next(wheel for wheel in mechanism.rolling if wheel.id == rolling)


def _spin(wheel: Rolling) -> float:
    circle = wheel.along.radius or 0.0
    return (wheel.radius - circle if wheel.along.inside else wheel.radius + circle) / wheel.radius


def _singular(links: Sequence[str]) -> InputError:
    return InputError(
        _("gears of {links}").format(links=", ".join(link for link in links if link != FRAME)),
        _("they block each other or leave an angle undetermined: their equations do not give every angle"),
        _("change a ratio, or drive another link"),
    )


# Which closed form solves a group: rigid point, link by two points, crank, parallel link, a dyad, or none.


@dataclass(frozen=True)
class Unsolved:
    """A group before it is classified: its unknowns and the constraints matched to them, in description order."""

    mechanism: Mechanism
    points: tuple[str, ...]
    links: tuple[str, ...]
    constraints: tuple[Constraint, ...]
    crosses_once: bool = True

    def ends(self, link: str) -> tuple[str, ...]:
        """Points that the group's constraints fix in a link."""
        return tuple(c.point for c in self.constraints if isinstance(c, PointInLink) and c.link == link)

    def knows_point(self, point: str) -> bool:
        return point not in self.points

    def knows_link(self, link: str) -> bool:
        return link not in self.links

    def turning(self, link: str) -> tuple[Constraint, Turning | Following] | None:
        """The constraint that gives the angle of a link from known ones, if there is one."""
        for c in self.constraints:
            follows = relation_to_known(self, c, link)
            if follows is not None:
                return c, follows
            turning = _turning_of(c)
            if turning is None or link not in (turning.link, turning.relative_to):
                continue
            other = turning.relative_to if turning.link == link else turning.link
            if self.knows_link(other):
                return c, turning
        return None


def _turning_of(constraint: Constraint) -> Turning | None:
    if isinstance(constraint, AngleDrive):
        return Turning(constraint.link, constraint.relative_to, drive=constraint.drive)
    if isinstance(constraint, NoTurning):
        return Turning(constraint.link, constraint.on, guide=constraint.guide)
    return None


def classify(
    mechanism: Mechanism,
    unknowns: Sequence[Entity],
    equations: Sequence[tuple[Constraint, int]],
    crosses_once: bool = True,
) -> Group:
    """The group that unknowns form under the equations (constraint and row) matched to them.

    `crosses_once` says whether the curves of two guides meet in one place, as lines do.
    """
    group = Unsolved(
        mechanism,
        tuple(e.name for e in unknowns if e.kind == "point"),
        tuple(e.name for e in unknowns if e.kind == "link"),
        tuple(dict.fromkeys(constraint for constraint, _row in equations)),
        crosses_once,
    )
    # from the simplest on: a group that one form fits is not looked at by the next
    for attempt in (_rigid_point, _single_link, _aim_with_block, _meet, train):
        classified = attempt(group)
        if classified is not None:
            return classified
    return Newton(group.points, group.links, tuple(equations))


def _rigid_point(group: Unsolved) -> Group | None:
    if group.links or len(group.points) != 1 or len(group.constraints) != 1:
        return None
    (constraint,) = group.constraints
    return RigidPoint(constraint.point, constraint.link) if isinstance(constraint, PointInLink) else None


def _single_link(group: Unsolved) -> Group | None:
    if group.points or len(group.links) != 1:
        return None
    (link,) = group.links
    ends = group.ends(link)
    if len(ends) == 2:
        return TwoPointLink(link, *ends)
    if len(ends) != 1:
        return None
    turning = group.turning(link)
    if turning is not None:
        return TurnedLink(link, ends[0], turning[1])
    for c in group.constraints:
        if isinstance(c, PointOnGuide) and c.on == link:
            return Aim(link, ends[0], c.guide, c.point)
        if isinstance(c, TrackContact) and c.on == link:
            touch = wheel_locus(group, c, link)
            # a link resting on a straight track of its own is aimed at the wheel; a round one has no such
            # line
            return Aim(link, ends[0], "", c.centre, contact=c) if touch and touch.letter == "P" else None
    return None


def _aim_with_block(group: Unsolved) -> Group | None:
    """RPR whose guide's point is not the hinge of the block: two links on known pivots, a prismatic pair between."""
    if len(group.links) != 2 or len(group.points) != 1 or len(group.constraints) != 5:
        return None
    (sliding,) = group.points
    guides = [c for c in group.constraints if isinstance(c, PointOnGuide) and c.point == sliding]
    fixed = [c for c in group.constraints if isinstance(c, NoTurning)]
    if len(guides) != 1 or len(fixed) != 1 or fixed[0].guide != guides[0].guide:
        return None
    link, block = fixed[0].on, fixed[0].link
    pivots = group.ends(link)
    targets = tuple(point for point in group.ends(block) if point != sliding)
    known = all(group.knows_point(point) for point in pivots + targets)
    if len(pivots) != 1 or len(targets) != 1 or not known or {link, block} != set(group.links):
        return None
    return Aim(link, pivots[0], guides[0].guide, targets[0], block, sliding)


def _meet(group: Unsolved) -> Group | None:
    """Group of one unknown vector with two loci, on which all else in it hangs; None if it is of another kind."""
    # a link whose angle is known beforehand carries its points with it
    carriages = [link for link in group.links if group.turning(link) is not None]
    # two of them are a group of higher class
    if len(carriages) > 1:
        return None
    carriage = carriages[0] if carriages else None
    used: set[Constraint] = set()
    turning = None
    if carriage is None:
        if len(group.points) != 1:
            return None
    else:
        pair = group.turning(carriage)
        if pair is None or not _carries_all(group, carriage):
            return None
        used.add(pair[0])
        turning = pair[1]
        # the carriage's own points are its part of the unknown vector
        used |= {c for c in group.constraints if isinstance(c, PointInLink) and c.link == carriage}
    loci: list[Locus] = []
    for link in group.links:
        if link != carriage:
            rod = _rod(group, link)
            if rod is None:
                return None
            loci.append(rod)
            used |= {c for c in group.constraints if isinstance(c, PointInLink) and c.link == link}
    for c in group.constraints:
        locus = _line(group, c, carriage) or wheel_locus(group, c, carriage)
        if isinstance(c, DistanceDrive):
            locus = _stroke(group, c)
        if locus is not None:
            loci.append(locus)
            used.add(c)
    # circles first, so that the sign has one meaning whatever the description's order
    loci.sort(key=lambda locus: locus.letter != "R")  # circles first
    # whatever no locus uses would not be fulfilled: the group is another one then
    if len(loci) != 2 or used != set(group.constraints):
        return None
    return Meet(group.points, (loci[0], loci[1]), carriage, turning, group.crosses_once)


def _carries_all(group: Unsolved, carriage: str) -> bool:
    """Whether the unknown points of the group are exactly the points its carriage brings along."""
    return set(group.ends(carriage)) == set(group.points)


def _rod(group: Unsolved, link: str) -> Rod | None:
    ends = group.ends(link)
    unknown = [point for point in ends if not group.knows_point(point)]
    known = [point for point in ends if group.knows_point(point)]
    if len(ends) != 2 or len(unknown) != 1:
        return None
    return Rod(unknown[0], known[0], link)


def _stroke(group: Unsolved, drive: DistanceDrive) -> CylinderCircle | None:
    unknown = [point for point in (drive.first, drive.second) if not group.knows_point(point)]
    if len(unknown) != 1:
        return None
    known = drive.second if unknown[0] == drive.first else drive.first
    return CylinderCircle(unknown[0], known, drive.drive)


def _line(group: Unsolved, constraint: Constraint, carriage: str | None) -> Locus | None:
    if isinstance(constraint, PointOnGuide):
        if constraint.on == carriage:
            return Slot(constraint.point, constraint.guide) if group.knows_point(constraint.point) else None
        known = group.knows_link(constraint.on) and not group.knows_point(constraint.point)
        return Rail(constraint.point, constraint.guide, constraint.on) if known else None
    if isinstance(constraint, DisplacementDrive):
        known = group.knows_link(constraint.on) and not group.knows_point(constraint.point)
        return (
            GuideStop(constraint.point, constraint.guide, constraint.on, constraint.drive) if known else None
        )
    return None


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
    def counted_links(self) -> tuple[tuple[str, ...], ...]:
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
        return tuple(tuple(link for link in group.links if link in wanted) for group in self.groups)

    @property
    def drives(self) -> int:
        """Number of drives."""
        return len(self.mechanism.drives)


def structure_of(mechanism: Mechanism) -> Structure:
    """Structure and plan of a mechanism.

    Raises
    ------
    InputError
        No drive, a drive without a law, or fewer or more drives than the mobility (rank) has.
    NotComputedYet
        The description names what this version does not compute.
    """
    for drive in mechanism.drives:
        drive.check_law()
    dimensions = dimensions_of(mechanism)
    refuse_what_the_space_lacks(mechanism)
    constraints = constraints_of(mechanism)
    unknowns = unknowns_of(mechanism)
    form = Form(
        constraints, unknowns, tuple(dimensions.frame), tuple(mechanism.points), dimensions.space.name,
        mechanism, dimensions,
    )  # fmt: skip
    # the numbers of teeth and radii of wheels are not random: a plan with these is not kept
    plan = _new_plan(form) if mechanism.gears or mechanism.rolling else _plan_of(form)
    # a constraint is redundant if any of its equations is
    redundant = tuple(dict.fromkeys(constraint for constraint, _row in plan.repeating))
    return Structure(
        mechanism, dimensions, constraints, redundant, plan.repeating, unknowns, plan.groups, plan.mobility
    )


@dataclass(frozen=True)
class Form:
    """What a plan depends on: everything of a mechanism but its numbers, where it has no gears and wheels.

    Lengths are random where independence is asked for, so mechanisms of one form have one plan.
    """

    constraints: tuple[Constraint, ...]
    unknowns: tuple[Entity, ...]
    frame: tuple[str, ...]
    points: tuple[str, ...]
    space: str
    mechanism: Mechanism = field(compare=False)
    """One of this form."""
    dimensions: Dimensions = field(compare=False)


@dataclass(frozen=True)
class Plan:
    """Groups in their order, equations that repeat others, and the generic mobility."""

    groups: tuple[Group, ...]
    repeating: tuple[tuple[Constraint, int], ...]
    mobility: int


# thousands of mechanisms of one form, one after the other, have one plan
@lru_cache(maxsize=64)
def _plan_of(form: Form) -> Plan:
    return _new_plan(form)


def _new_plan(form: Form) -> Plan:
    mechanism, constraints, unknowns = form.mechanism, form.constraints, form.unknowns
    matrix = generic_jacobian(mechanism, constraints, unknowns, form.dimensions)
    owners = [c for c in constraints for _row in range(c.size)]
    kept = _independent(mechanism, matrix, owners)
    drive_rows = sum(is_drive(c) for c in constraints)
    # with all rows independent, so are those without the drives
    # if nothing is redundant no second elimination is needed
    free_rank = len(kept) - drive_rows if all(kept) else int(independent_rows(matrix[drive_rows:]).sum())
    mobility = matrix.shape[1] - free_rank
    _check_drives(mechanism, matrix, kept, owners, mobility, unknowns)
    groups = _groups(mechanism, form.dimensions.space, unknowns, kept, owners)
    return Plan(groups, _left_out(owners, kept), mobility)


def generic_mobility(mechanism: Mechanism) -> int:
    """Mobility by rank at a random realisation, drives left out; it needs no drives."""
    dimensions, unknowns = dimensions_of(mechanism), unknowns_of(mechanism)
    free = [constraint for constraint in constraints_of(mechanism) if not is_drive(constraint)]
    matrix = generic_jacobian(mechanism, free, unknowns, dimensions)
    return int(matrix.shape[1] - independent_rows(matrix).sum())


def _independent(mechanism: Mechanism, matrix: Matrix, owners: Sequence[Constraint]) -> list[bool]:
    """Which rows are kept: drives first, links with few points last, and contacts of wheels behind them.

    Which of several constraints that repeat each other is left out is a choice. A link of two points that is
    left out still lies through both; a plate would have to be solved together with its neighbours. An arm or
    a guide that keeps a wheel at its track does so better than the contact, which says nothing of the wheel.
    """

    # drives first, then plates with many points, as these are kept while independent
    def rank(row: int) -> int:
        owner = owners[row]
        if is_drive(owner):
            return -len(mechanism.points) - 1
        if isinstance(owner, TrackContact):
            return 1
        return -len(mechanism.links[owner.link].coordinates) if isinstance(owner, PointInLink) else 0

    order = sorted(range(len(owners)), key=rank)
    kept = [False] * len(owners)
    for row, keep in zip(order, independent_rows(matrix[order]), strict=True):
        kept[row] = bool(keep)
    return kept


def refuse_what_the_space_lacks(mechanism: Mechanism) -> None:
    """Raise NotComputedYet for guides with a link of their own, rolling and cylinders on the sphere."""
    space = SPACES[mechanism.space]
    guided = next((guide.id for guide in mechanism.guides if guide.link is not None), None)
    distance = any(drive.kind == "distance" for drive in mechanism.drives)
    asked = [
        ("guided links", guided is not None, f"[[guides]] {guided}, link", _("place a hinge at the pole")),
        ("rolling", bool(mechanism.rolling), "[[rolling]]", _("remove it, or work in the plane")),
        ("distance", distance, "[[drives]] distance", _("drive the angle of a link")),
    ]
    for what, present, where, repair in asked:
        if present and what in space.lacks:
            raise NotComputedYet(where, _("it is not computed on the sphere"), repair)


def _check_drives(
    mechanism: Mechanism,
    matrix: Matrix,
    kept: Sequence[bool],
    owners: Sequence[Constraint],
    mobility: int,
    unknowns: Sequence[Entity],
) -> None:
    """Refuse drives that repeat each other, drive what is locked, or leave something loose."""
    drives = len(mechanism.drives)
    if drives == 0:
        raise InputError(
            "[[drives]]",
            _("the mechanism has no drive"),
            _("give one drive per degree of freedom; centrode simulate alone needs none"),
        )
    repeated = [c.label for c, keep in zip(owners, kept, strict=True) if is_drive(c) and not keep]
    numbers = drives_against_mobility(drives, mobility)
    if repeated:
        raise InputError("[[drives]]", numbers, _("remove: {drives}").format(drives="; ".join(repeated)))
    # as many independent rows as unknowns: everything is fixed once the drives are
    if sum(kept) == matrix.shape[1]:
        return
    locked = _locked_drives(matrix, owners)
    if locked and drives == mobility:
        raise InputError(
            "; ".join(locked),
            _("it cannot move: the rest of the mechanism holds it"),
            _("drive a part that can move, or remove constraints"),
        )
    alike = look_alike_error(mechanism, numbers)
    if alike:
        raise alike
    loose = loose_points_repair(mechanism, matrix, unknowns)
    raise InputError("[[drives]]", numbers, loose or _("add drives, or constrain what moves freely"))


def _locked_drives(matrix: Matrix, owners: Sequence[Constraint]) -> list[str]:
    """Drives of what the other constraints hold already."""
    rows = [row for row, owner in enumerate(owners) if not is_drive(owner)]
    drives = [row for row, owner in enumerate(owners) if is_drive(owner)]
    # drives behind all others: one that is not independent of these drives nothing
    free = independent_rows(matrix[rows + drives])[len(rows) :]
    return [owners[row].label for row, moves in zip(drives, free, strict=True) if not moves]


def drives_against_mobility(drives: int, mobility: int) -> str:
    """The sentence that compares the number of drives with the mobility."""
    return ngettext("{n} drive is given", "{n} drives are given", drives).format(n=drives) + _(
        ", but the mobility (by rank) is {mobility}"
    ).format(mobility=mobility)


def _left_out(owners: Sequence[Constraint], kept: Sequence[bool]) -> tuple[tuple[Constraint, int], ...]:
    """Equations that are not kept, each as its constraint and its row there."""
    # reversed, so that the first row of a constraint is the one that stays
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
    # the frame and its points are no unknowns
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
        # what an unknown's own equations speak of beside it has to be known before, or together with it
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
    # each component is solved as a whole, and stands behind all that it depends on
    for component in in_order(strong_components(depends), depends):
        # in the order of the description, so that signs do not depend on the matching
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
