"""Dyads as they are taught: tangential parts by moments of one link, the rest where two directions close the polygon.

A dyad has two bodies, a and b, an outer joint of each and one inner joint, each a hinge (R; or a rolling contact)
or a guide (P). Kinds are named outer, inner, outer: RRR, RRP, RPR, PRP, RPP.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from itertools import combinations
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.analysis.graphic.stage import cross, dot
from centrode.dynamics.force_polygons.statics import (
    SINGULAR,
    Action,
    Cell,
    Dyad,
    ForceSide,
    Ledger,
    MomentTerm,
    StaticJoint,
    across,
    dead_point,
    total,
)
from centrode.dynamics.force_polygons.steps import (
    Assumption,
    AssurPoint,
    ClosedAlong,
    ClosedPolygon,
    EquationOutcome,
    ForceLine,
    ForcesAlongGuide,
    JointReaction,
    MomentsOfBase,
    MomentsOfGroup,
    MomentsOfLink,
    MomentUnknown,
    Neglect,
    SolvedTogether,
    Step,
)

# The steps of a group: equations of moments with their terms, equations of forces, what follows.

NONE = 1e-14
"""Arms and moments smaller than this part of what they are made of are rounding of none."""


@dataclass
class WorkedSteps:
    """Steps of a group so far."""

    steps: list[Step] = field(default_factory=list)

    def add(self, step: Step) -> None:
        """Go on with a step."""
        self.steps.append(step)

    def tangential(
        self, side: ForceSide, inner: StaticJoint, ledger: Ledger, arm: float, size: float
    ) -> None:
        """Moments of a link about the inner hinge give the part of the outer reaction square to the arm."""
        symbol = ledger.symbol(side.joint, side.body) + "ᵗ"
        terms = ledger.terms([side.body], inner.place)
        outcome = EquationOutcome(symbol, size if terms else 0.0)
        self.add(
            MomentsOfLink(ledger.bodies.number(side.body), inner, MomentUnknown(symbol, arm), terms, outcome)
        )

    def polygon(self, dyad: Dyad, ledger: Ledger) -> None:
        """The forces of the group, and along what the unknown ones lie."""
        first, second = dyad.first, dyad.second
        one, other = (ledger.symbol(side.joint, side.body) for side in (first, second))
        known = names([*ledger.actions[first.body], *ledger.actions[second.body]])
        if dyad.inner.letter == "P":
            before, after = [f"{one}ⁿ", f"{one}ᵗ"], [other]
            lines = [ForceLine(f"{one}ⁿ", dyad.inner.name)]
            if second.joint.letter == "P":
                lines.append(ForceLine(other, second.joint.name))
        else:
            before = [f"{one}ⁿ", f"{one}ᵗ"] if first.joint.letter == "R" else [one]
            after = [f"{other}ᵗ", f"{other}ⁿ"] if second.joint.letter == "R" else [other]
            lines = [
                ForceLine(f"{symbol}ⁿ", through=(side.joint, dyad.inner))
                if side.joint.letter == "R"
                else ForceLine(symbol, side.joint.name)
                for side, symbol in ((first, one), (second, other))
            ]
        self.add(ClosedPolygon(numbers_of(dyad, ledger), (*before, *known, *after), tuple(lines)))

    def closing(self, body: str, ledger: Ledger, outer: StaticJoint | None, last: Action) -> None:
        """The polygon of one link gives the reaction that is left."""
        known = names(ledger.actions[body])
        if outer is not None:
            known = [ledger.symbol(outer, body), *known]
        outcome = EquationOutcome(last.symbol, abs(last.force), magnitude=True)
        self.add(ClosedPolygon((ledger.bodies.number(body),), (*known, last.symbol), outcome=outcome))

    def along_guide(self, side: ForceSide, inner: StaticJoint, ledger: Ledger, part: float) -> None:
        """A link that slides is in equilibrium along its guide without the other link."""
        symbol = ledger.symbol(side.joint, side.body) + "ᵗ"
        forces = (symbol, *names(ledger.actions[side.body]))
        number = ledger.bodies.number(side.body)
        self.add(ForcesAlongGuide(number, inner.name, forces, EquationOutcome(symbol, part + 0.0)))

    def about_far_hinge(
        self, dyad: Dyad, ledger: Ledger, part: float, lever: float, reach: float, left: float
    ) -> None:
        """Moments of the whole group about the second outer hinge."""
        symbol = ledger.symbol(dyad.first.joint, dyad.first.body)
        terms = ledger.terms([dyad.first.body, dyad.second.body], dyad.second.joint.place)
        if abs(lever) > NONE * ledger.scale:
            terms = (MomentTerm(f"{symbol}ᵗ", part * lever), *terms)
        self.add(
            MomentsOfGroup(
                numbers_of(dyad, ledger),
                dyad.second.joint,
                MomentUnknown(f"{symbol}ⁿ", reach),
                terms,
                EquationOutcome(f"{symbol}ⁿ", left),
            )
        )

    def guide_moment(
        self, joint: StaticJoint, body: str, ledger: Ledger, moment: float, force: complex
    ) -> None:
        """Moment of a guide on a link, and by how much its force therefore passes beside."""
        symbol = ledger.symbol(joint, body)
        loads = sum(abs(action.force) for action in ledger.actions[body]) + abs(force)
        some = abs(moment) > NONE * ledger.scale * loads
        outcome = EquationOutcome(f"M{symbol.removeprefix('R')}", moment if some else 0.0, "N m")
        beside = (symbol, abs(moment) / abs(force)) if force and some else None
        self.add(MomentsOfLink(ledger.bodies.number(body), joint, None, (), outcome, beside))

    def assumptions(self, joints: Sequence[StaticJoint]) -> None:
        """Add what is left out of meshes, and of contacts that something else keeps."""
        for joint in joints:
            if joint.kind == "mesh" and not joint.inclined:
                self.add(
                    Assumption(joint, Neglect.TOOTH_PRESSURE if joint.has_force else Neglect.PITCH_POINT)
                )
            elif joint.kind == "rolling" and len(joint.bases) == 1:
                self.add(Assumption(joint, Neglect.NORMAL_FORCE))


def numbers_of(dyad: Dyad, ledger: Ledger) -> tuple[int, ...]:
    """Numbers of the bodies of a dyad, in order."""
    return tuple(sorted(ledger.bodies.number(side.body) for side in (dyad.first, dyad.second)))


def names(actions: Sequence[Action]) -> list[str]:
    """Symbols of what has a force."""
    return [action.symbol for action in actions if action.force != 0]


KINDS = ("RRR", "RRP", "RPR", "PRP", "RPP")


@dataclass(frozen=True)
class DyadReactions:
    """Reactions of a group.

    Attributes
    ----------
    forces : joint, force and moment on a body of share 1
    chain : forces on the group in the order of its polygon, reactions in parts where they were found in parts
    marks : special points of the construction, by name
    """

    forces: tuple[tuple[StaticJoint, complex, float], ...]
    chain: tuple[Action, ...]
    marks: tuple[tuple[str, complex], ...] = ()


def dyad_of(cell: Cell) -> Dyad | None:
    """The dyad that two bodies make, or nothing."""
    if len(cell.bodies) != 2 or len(cell.joints) != 3 or len(cell.inner) != 1:
        return None
    (inner,) = cell.inner
    outer = [joint for joint in cell.joints if joint is not inner]
    sides = [ForceSide(body, joint) for body in cell.bodies for joint in outer if body in joint.shares]
    if {side.body for side in sides} != set(cell.bodies) or len(sides) != 2:
        return None
    # the outer hinge first: PRR is RRP and PPR is RPP, and PPP is no dyad
    sides.sort(key=lambda side: "RP".find(side.joint.letter))
    dyad = Dyad(sides[0], sides[1], inner)
    return dyad if dyad.kind in KINDS else None


def solve_dyad(dyad: Dyad, ledger: Ledger, worked: WorkedSteps) -> DyadReactions:
    """Reactions of a dyad; MotionError at its dead points."""
    solver = _by_hinge if dyad.inner.letter == "R" else _by_guide
    first, second, chain = solver(dyad, ledger, worked)
    inner = -(dyad.first.known(ledger) + first)
    share = dyad.inner.shares[dyad.first.body]
    on_inner = ledger.reaction(dyad.inner, dyad.first.body, share * inner)
    worked.closing(dyad.first.body, ledger, dyad.first.joint, on_inner)
    turning = _moments(dyad, ledger, worked, first, second, inner)
    ends = ((dyad.first, first), (dyad.second, second))
    forces = [(side.joint, side.joint.shares[side.body] * force) for side, force in ends]
    forces.append((dyad.inner, share * inner))
    return DyadReactions(
        tuple((joint, force, turning.get(id(joint), 0.0)) for joint, force in forces), tuple(chain)
    )


def _by_hinge(dyad: Dyad, ledger: Ledger, worked: WorkedSteps) -> tuple[complex, complex, list[Action]]:
    """RRR, RRP, PRP: the unknown parts of both outer reactions close the polygon of the group."""
    parts = [split_reaction(side, dyad.inner, ledger, worked) for side in (dyad.first, dyad.second)]
    (one, along), (other, beside) = parts
    known = dyad.first.known(ledger) + dyad.second.known(ledger) + one + other
    sine = across(along, beside)
    # known + x along + y beside = 0 by Cramer
    normal, thrust = -cross(known, beside) / sine * along, cross(known, along) / sine * beside
    worked.polygon(dyad, ledger)
    chain = [
        *parts_of(dyad.first, ledger, normal, one, last=True),
        *forces_on(ledger, dyad.first.body),
        *forces_on(ledger, dyad.second.body),
        *parts_of(dyad.second, ledger, thrust, other, last=False),
    ]
    return one + normal, other + thrust, chain


def split_reaction(
    side: ForceSide, inner: StaticJoint, ledger: Ledger, worked: WorkedSteps
) -> tuple[complex, complex]:
    """The known part of an outer reaction and the unit vector of what is left of it."""
    if side.joint.letter == "P":
        # without friction a guide presses square to itself, with a place that is unknown as well: no part is
        # known
        return 0j, 1j * side.joint.along
    arm = side.joint.place - inner.place
    if abs(arm) <= SINGULAR * ledger.scale:
        dead_point()
    radial = arm / abs(arm)
    size = -ledger.moment([side.body], inner.place) / abs(arm)
    worked.tangential(side, inner, ledger, abs(arm), size)
    return size * 1j * radial, radial


def _by_guide(dyad: Dyad, ledger: Ledger, worked: WorkedSteps) -> tuple[complex, complex, list[Action]]:
    """RPR, RPP: along the inner guide each link is in equilibrium by itself."""
    along, normal = dyad.inner.along, 1j * dyad.inner.along
    first, second = dyad.first, dyad.second
    w1, w2 = first.known(ledger), second.known(ledger)
    part = -dot(w1, along)
    worked.along_guide(first, dyad.inner, ledger, part)
    if second.joint.letter == "P":
        thrust_along = 1j * second.joint.along
        sine = across(normal, thrust_along)
        known = w1 + w2 + part * along
        left, thrust = (
            -cross(known, thrust_along) / sine * normal,
            cross(known, normal) / sine * thrust_along,
        )
        worked.polygon(dyad, ledger)
    else:
        arm = first.joint.place - second.joint.place
        # the arm of a force square to the guide: cross(arm, i along)
        reach = dot(arm, along)
        if abs(reach) <= SINGULAR * max(abs(arm), SINGULAR * ledger.scale):
            dead_point()
        turning = ledger.moment([first.body, second.body], second.joint.place)
        left = -(turning + part * cross(arm, along)) / reach * normal
        worked.about_far_hinge(dyad, ledger, part, cross(arm, along), reach, dot(left, normal))
        thrust = -(w1 + w2 + part * along + left)
        worked.polygon(dyad, ledger)
    chain = [
        *parts_of(first, ledger, left, part * along, last=True),
        *forces_on(ledger, first.body),
        *forces_on(ledger, second.body),
        ledger.reaction(second.joint, second.body, second.joint.shares[second.body] * thrust),
    ]
    return part * along + left, thrust, chain


def forces_on(ledger: Ledger, body: str) -> list[Action]:
    """The known forces on a body that are more than moments."""
    return [action for action in ledger.actions[body] if action.force != 0]


def parts_of(
    side: ForceSide, ledger: Ledger, normal: complex, tangential: complex, last: bool
) -> list[Action]:
    """An outer reaction in its two parts, or whole where it has one; the normal part at the polygon's end."""
    share = side.joint.shares[side.body]
    if side.joint.letter == "P":
        return [ledger.reaction(side.joint, side.body, share * normal)]
    found = []
    for mark, part in (("ⁿ", normal), ("ᵗ", tangential)):
        whole = ledger.reaction(side.joint, side.body, share * part)
        symbol = ledger.symbol(side.joint, side.body) + mark
        found.append(Action(symbol, whole.label, side.body, "reaction", part, side.joint.place))
    return found if last else found[::-1]


def _moments(
    dyad: Dyad, ledger: Ledger, worked: WorkedSteps, first: complex, second: complex, inner: complex
) -> dict[int, float]:
    """Moments of guides on bodies of share 1, by the joint's identity: about the place of the guide."""
    found: dict[int, float] = {}
    if dyad.inner.letter == "P":
        at = dyad.inner.place
        arm = dyad.first.joint.place - at
        moment = -(ledger.moment([dyad.first.body], at) + cross(arm, first))
        found[id(dyad.inner)] = dyad.inner.shares[dyad.first.body] * moment
        worked.guide_moment(dyad.inner, dyad.first.body, ledger, moment, inner)
    for side, force in ((dyad.first, first), (dyad.second, second)):
        if side.joint.letter != "P":
            continue
        at = side.joint.place
        # the inner reaction is that on the first link: on the second it is opposite
        hold = -inner if side is dyad.second else inner
        inside = dyad.inner.shares[side.body] * found.get(id(dyad.inner), 0.0)
        moment = -(ledger.moment([side.body], at) + cross(dyad.inner.place - at, hold) + inside)
        found[id(side.joint)] = side.joint.shares[side.body] * moment
        worked.guide_moment(side.joint, side.body, ledger, moment, force)
    return found


# Triads of the third class: a base link on three links with one outer joint each, by an Assur point.
#
# The tangential part of each outer reaction follows from moments of its link about the inner hinge. What is
# left acts on the base along three known lines. About the point where two of them meet, an Assur point,
# moments give the third; then the polygon closes along two directions.


@dataclass(frozen=True)
class TriadLeg:
    """A link between the base and its outer joint: what is known of its reaction, and along what the rest lies."""

    side: ForceSide
    inner: StaticJoint
    part: complex = 0j
    along: complex = 0j

    @property
    def hinge(self) -> complex:
        """Place of the inner hinge."""
        return self.inner.place


@dataclass(frozen=True)
class Triad:
    """The base link and its three legs."""

    base: str
    legs: tuple[TriadLeg, TriadLeg, TriadLeg]


def triad_of(cell: Cell) -> Triad | None:
    """The triad that four bodies make, or nothing."""
    if len(cell.bodies) != 4 or len(cell.joints) != 6 or len(cell.inner) != 3:
        return None
    base = next((body for body in cell.bodies if all(body in joint.shares for joint in cell.inner)), None)
    if base is None or any(joint.letter != "R" for joint in cell.inner):
        return None
    legs = []
    for inner in cell.inner:
        body = inner.other(base)
        outer = [joint for joint in cell.of(body) if joint is not inner]
        if len(outer) != 1 or not outer[0].letter:
            return None
        legs.append(TriadLeg(ForceSide(body, outer[0]), inner))
    return Triad(base, (legs[0], legs[1], legs[2]))


def solve_triad(triad: Triad, ledger: Ledger, worked: WorkedSteps) -> DyadReactions | None:
    """Reactions of a triad; nothing where its three lines have no Assur point to use."""
    parts = WorkedSteps()
    legs = []
    for leg in triad.legs:
        part, along = split_reaction(leg.side, leg.inner, ledger, parts)
        legs.append(TriadLeg(leg.side, leg.inner, part, along))
    # the two lines that cross most steeply: their point is the best determined
    first, second = max(
        combinations(range(3), 2), key=lambda pair: abs(cross(legs[pair[0]].along, legs[pair[1]].along))
    )
    third = 3 - first - second
    one, other, last = legs[first], legs[second], legs[third]
    sine = cross(one.along, other.along)
    if abs(sine) <= SINGULAR:
        return None
    point = one.hinge + cross(other.hinge - one.hinge, other.along) / sine * one.along
    reach = cross(last.hinge - point, last.along)
    if abs(reach) <= SINGULAR * max(ledger.scale, abs(last.hinge - point)):
        return None
    carried = [leg.side.known(ledger) + leg.part for leg in legs]
    turning = ledger.moment([triad.base], point)
    # the base feels its legs at the inner hinges, with what is known of them
    turning += sum(cross(leg.hinge - point, force) for leg, force in zip(legs, carried, strict=True))
    sizes = [0.0, 0.0, 0.0]
    sizes[third] = -turning / reach
    known = total(ledger.actions[triad.base]) + sum(carried, 0j) + sizes[third] * last.along
    sizes[first] = -cross(known, other.along) / sine
    sizes[second] = cross(known, one.along) / sine
    # only now: where the point is of no use the group is solved another way, with other steps
    worked.steps += parts.steps
    _add_triad(triad, ledger, worked, (one, other, last), (turning, reach, sizes[third]))
    return replace(_triad_reactions(triad, ledger, legs, sizes), marks=(("S", point),))


def _add_triad(
    triad: Triad,
    ledger: Ledger,
    worked: WorkedSteps,
    legs: tuple[TriadLeg, TriadLeg, TriadLeg],
    numbers: tuple[float, float, float],
) -> None:
    """The moments about the Assur point, and the polygon."""
    turning, reach, size = numbers
    one, other, last = (
        ledger.symbol(leg.side.joint, leg.side.body) + ("ⁿ" if leg.side.joint.letter == "R" else "")
        for leg in legs
    )
    base = ledger.bodies.number(triad.base)
    worked.add(AssurPoint(((one, legs[0].inner), (other, legs[1].inner))))
    worked.add(MomentsOfBase(base, MomentUnknown(last, reach), turning, EquationOutcome(last, size)))
    worked.add(ClosedAlong((one, other)))


def _triad_reactions(triad: Triad, ledger: Ledger, legs: list[TriadLeg], sizes: list[float]) -> DyadReactions:
    """Reactions of all joints, and the polygon of the group."""
    forces: list[tuple[StaticJoint, complex, float]] = []
    chain: list[Action] = []
    for number, (leg, size) in enumerate(zip(legs, sizes, strict=True)):
        body, joint, inner = leg.side.body, leg.side.joint, leg.inner
        held = leg.part + size * leg.along
        carried = leg.side.known(ledger) + held
        moment = 0.0
        if joint.letter == "P":
            moment = -(ledger.moment([body], joint.place) - cross(inner.place - joint.place, carried))
        forces.append((joint, joint.shares[body] * held, joint.shares[body] * moment))
        forces.append((inner, inner.shares[triad.base] * carried, 0.0))
        parts = parts_of(leg.side, ledger, size * leg.along, leg.part, last=number == 0)
        chain += [*parts, *forces_on(ledger, body)] if number == 0 else [*forces_on(ledger, body), *parts]
        if number == 0:
            chain += forces_on(ledger, triad.base)
    return DyadReactions(tuple(forces), tuple(chain))


# Groups that are no dyads: input links with what drives them, single links, and groups solved together.

Array: TypeAlias = npt.NDArray[np.float64]


def solve_single(cell: Cell, ledger: Ledger, worked: WorkedSteps) -> DyadReactions | None:
    """A link by itself: on a hinge with one more unknown, or on a guide along which it is driven; else nothing."""
    if len(cell.bodies) != 1 or len(cell.joints) != 2:
        return None
    pivot = next((joint for joint in cell.joints if len(joint.bases) == 2), None)
    other = next((joint for joint in cell.joints if len(joint.bases) == 1), None)
    if pivot is None or other is None:
        return None
    if pivot.letter == "R":
        return _on_hinge(cell.bodies[0], pivot, other, ledger, worked)
    if abs(dot(other.bases[0][0], pivot.along)) > SINGULAR:
        return _on_guide(cell.bodies[0], pivot, other, ledger, worked)
    return None


def _on_hinge(
    body: str, pivot: StaticJoint, other: StaticJoint, ledger: Ledger, worked: WorkedSteps
) -> DyadReactions:
    """Moments about the hinge give the other unknown, the link's polygon then the reaction of the hinge."""
    (unit, turn) = other.bases[0]
    share = other.shares[body]
    # moment about the pivot of one unit of the unknown
    factor = turn + cross(other.place - pivot.place, unit)
    arm = abs(other.place - pivot.place)
    if abs(factor) <= SINGULAR * max(turn, arm):
        dead_point()
    turning = ledger.moment([body], pivot.place)
    size = -turning / (share * factor)
    acts = ledger.reaction(other, body, size * unit, size * turn)
    symbol = acts.symbol if share > 0 else acts.symbol.removeprefix("−")
    if other.kind != "drive":
        unknown = MomentUnknown(acts.symbol, factor if unit else None)
    elif unit:
        unknown = MomentUnknown(acts.symbol, share * factor)
    else:
        unknown = MomentUnknown(symbol if share > 0 else f"−{symbol}")
    outcome = EquationOutcome(symbol, size if other.kind == "drive" else share * size, "N" if unit else "N m")
    terms = ledger.terms([body], pivot.place)
    worked.add(MomentsOfLink(ledger.bodies.number(body), pivot, unknown, terms, outcome))
    force = -(total(ledger.actions[body]) + acts.force)
    hold = ledger.reaction(pivot, body, pivot.shares[body] * force)
    chain = [action for action in [*ledger.actions[body], acts, hold] if action.force != 0]
    worked.closing(body, ledger, other if unit else None, hold)
    return DyadReactions(
        ((other, size * unit, size * turn), (pivot, pivot.shares[body] * force, 0.0)), tuple(chain)
    )


def _on_guide(
    body: str, guide: StaticJoint, other: StaticJoint, ledger: Ledger, worked: WorkedSteps
) -> DyadReactions:
    """A slider: what pushes it along the guide is the other unknown, square to it the guide holds."""
    known, along = total(ledger.actions[body]), guide.along
    unit = other.bases[0][0]
    size = -dot(known, along) / (other.shares[body] * dot(unit, along))
    push = ledger.reaction(other, body, size * unit)
    # what is square to the guide: cross with its direction, along the normal
    thrust = -cross(along, known + push.force) * 1j * along
    moment = -(ledger.moment([body], guide.place) + push.about(guide.place))
    share = guide.shares[body]
    hold = ledger.reaction(guide, body, share * thrust, share * moment)
    pushed = EquationOutcome(push.symbol, abs(push.force), magnitude=True)
    worked.add(ForcesAlongGuide(ledger.bodies.number(body), guide.name, (), pushed))
    worked.closing(body, ledger, other, hold)
    worked.guide_moment(guide, body, ledger, moment, thrust)
    chain = [action for action in [*ledger.actions[body], push, hold] if action.force != 0]
    forces = ((other, size * unit, 0.0), (guide, share * thrust, share * moment))
    return DyadReactions(forces, tuple(chain))


def solve_together(cell: Cell, ledger: Ledger, worked: WorkedSteps) -> DyadReactions:
    """All equations of equilibrium of a group at once; MotionError where they are singular to rounding."""
    unknowns = [(joint, *basis) for joint in cell.joints for basis in joint.bases]
    scale = ledger.scale
    rows: list[list[float]] = []
    right: list[float] = []
    for body in cell.bodies:
        # about a place of the body itself, so that far origins cost no digits
        centre = next((j.place for j in cell.of(body) if j.kind not in ("mesh", "drive")), 0j)
        columns = [_column(joint, unit, turn, body, centre, scale) for joint, unit, turn in unknowns]
        known = total(ledger.actions[body])
        sides = [-known.real, -known.imag, -ledger.moment([body], centre) / scale]
        count = 2 if body in ledger.bodies.pins else 3
        rows += [[column[row] for column in columns] for row in range(count)]
        right += sides[:count]
    values = _solve_scaled(np.array(rows), np.array(right))
    worked.add(SolvedTogether(len(rows), tuple(ledger.bodies.number(body) for body in cell.bodies)))
    forces = []
    for joint in cell.joints:
        force, moment = 0j, 0.0
        for (owner, unit, turn), value in zip(unknowns, values, strict=True):
            if owner is joint:
                force, moment = force + value * unit, moment + value * scale * turn
        forces.append((joint, force, moment))
        _add_reaction(joint, force, moment, cell, ledger, worked)
    known_ones = [action for action in ledger.on(cell.bodies) if action.force != 0]
    outer = [
        ledger.reaction(joint, body, force, moment)
        for joint, force, moment in forces
        for body in cell.bodies
        if body in joint.shares and not any(joint is inner for inner in cell.inner)
    ]
    return DyadReactions(tuple(forces), tuple([*known_ones, *(one for one in outer if one.force != 0)]))


def _column(
    joint: StaticJoint, unit: complex, turn: float, body: str, centre: complex, scale: float
) -> tuple[float, float, float]:
    """Column of one unknown in the equations of a body: force, and moment over the scale; moments count in scales."""
    share = joint.shares.get(body, 0.0)
    moment = cross(joint.place - centre, unit) / scale + turn if share else 0.0
    return share * unit.real, share * unit.imag, share * moment


def _solve_scaled(matrix: Array, right: Array) -> Array:
    """The solution, with columns and rows of one size; refuses what is singular to rounding."""
    # forces and moments, long and short arms: equilibrated, the singular values tell the conditioning alone
    across = np.abs(matrix).max(axis=0)
    if not (across > 0).all():
        dead_point()
    scaled = matrix / across
    down = np.abs(scaled).max(axis=1)
    if not (down > 0).all():
        dead_point()
    scaled = scaled / down[:, None]
    sizes = np.linalg.svd(scaled, compute_uv=False)
    if sizes[-1] <= SINGULAR * sizes[0]:
        dead_point()
    return np.asarray(np.linalg.solve(scaled, right / down) / across)


def _add_reaction(
    joint: StaticJoint, force: complex, moment: float, cell: Cell, ledger: Ledger, worked: WorkedSteps
) -> None:
    """Add the step of one reaction that was solved together with others."""
    bodies = [name for name in cell.bodies if name in joint.shares]
    body = max(bodies, key=lambda name: joint.shares[name])
    action = ledger.reaction(joint, body, force, moment)
    parts = [EquationOutcome(action.symbol, abs(action.force), magnitude=True)] if action.force else []
    if joint.kind == "guide":
        parts.append(EquationOutcome(f"M{action.symbol.removeprefix('R')}", action.moment, "N m"))
    elif joint.kind in ("mesh", "drive") and not joint.has_force:
        parts = [EquationOutcome(action.symbol, action.moment, "N m")]
    if parts:
        worked.add(JointReaction(joint, tuple(parts)))
