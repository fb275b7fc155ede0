"""Reactions as expressions: what kinetostatics gives at one sample of a traced motion, for any dimensions.

The equations are those of the arrays (`equations`), with nodes in place of numbers. Their pattern is known beforehand,
so they are solved as by hand: forces that stand in an equation with a plain factor are eliminated first, what is left
comes apart into the groups of the plan, of a dyad two moments.
"""

from __future__ import annotations

import functools
import threading
import weakref
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import combinations
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.kinetostatics.applied_forces import inertia_forces_of, input_motion_of
from centrode.dynamics.kinetostatics.equations import (
    ForceSystem,
    InPlane,
    Kinetostatics,
    MomentCentre,
    Scheme,
    Teeth,
    Unknown,
    wrenches_of,
)
from centrode.dynamics.kinetostatics.friction import contacts_of
from centrode.dynamics.kinetostatics.joints import reactions_of, sides_of
from centrode.dynamics.kinetostatics.reactions import frame_totals, reactions_at
from centrode.dynamics.load_coordinates import Slide
from centrode.dynamics.loads import MassesAndLoads
from centrode.dynamics.reduction import Values, motion_of_batch, refuse_drive_in_formulas, state_of_nodes
from centrode.dynamics.state import DriveMotion, State
from centrode.dynamics.wrenches import Wrench
from centrode.errors import InputError
from centrode.geometry.plane import is_literal_zero
from centrode.kinematics.machine_code.newton import inverse, minus, plus, sizes, times, total
from centrode.kinematics.machine_code.trace import Untraceable
from centrode.kinematics.solve import Solved
from centrode.locale import mark
from centrode.model.files import with_values
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.expressions import EXPRESSIONS, Node, Operand, as_node
from centrode.numerics.jets import Jet
from centrode.structure.constraints import (
    Constraint,
    DisplacementDrive,
    PointInLink,
    PointOnGuide,
    Positions,
    Row,
    TrackContact,
)
from centrode.structure.dimensions import dimensions_of

Array: TypeAlias = npt.NDArray[Any]
Number: TypeAlias = Any

REACTIONS = (
    "joint_force", "centre_force", "guide_force", "guide_normal", "guide_moment", "gear_moment", "tooth_force",
    "rolling_force", "rolling_normal", "rolling_tangential", "balancing", "frame_force", "frame_moment",
    "shaking_force", "shaking_moment",
)  # fmt: skip
"""Quantities of `reactions` that are known at every sample."""
LARGEST_GAIN = 1e6
"""Greatest norm of an inverse up to which expressions are trusted: the arrays judge what lies beyond."""


# Linear equations whose pattern is known, over expressions.


@dataclass
class SparseEquations:
    """Linear equations as rows of nodes and numbers: what is not in a row is zero.

    Attributes
    ----------
    rows : of each equation the factors by the number of the unknown
    right : right sides
    found : unknown -> its value
    gains : norms of the inverses of the groups that were solved at once
    """

    rows: list[dict[int, Operand]]
    right: list[Operand]
    found: dict[int, Operand] = field(default_factory=dict)
    gains: list[Operand] = field(default_factory=list)

    def solve(self) -> dict[int, Operand]:
        """The unknowns. Raises Untraceable where the pattern alone makes the equations singular."""
        left = list(range(len(self.rows)))
        pivots: list[tuple[int, int]] = []
        while (pivot := self._plain_pivot(left)) is not None:
            left.remove(pivot[0])
            self._eliminate(*pivot, left)
            pivots.append(pivot)
        while left:
            left = self._solve_group(left)
        for row, unknown in reversed(pivots):
            known = total([times(x, self.found[k]) for k, x in self.rows[row].items() if k != unknown])
            self.found[unknown] = _over(minus(self.right[row], known), self.rows[row][unknown])
        return self.found

    def _plain_pivot(self, left: Sequence[int]) -> tuple[int, int] | None:
        """A factor that is a plain number of the size of one, where elimination adds the fewest terms."""
        counts: dict[int, int] = {}
        for row in left:
            for unknown in self.rows[row]:
                counts[unknown] = counts.get(unknown, 0) + 1
        pivots = [
            ((len(self.rows[row]) - 1) * (counts[unknown] - 1), row, unknown)
            for row in left
            for unknown, x in self.rows[row].items()
            if isinstance(x, float) and abs(x) >= 0.5
        ]
        return min(pivots)[1:] if pivots else None

    def _eliminate(self, row: int, unknown: int, left: Sequence[int]) -> None:
        own = self.rows[row]
        for other in left:
            if unknown not in self.rows[other]:
                continue
            factor = _over(self.rows[other].pop(unknown), own[unknown])
            for k, x in own.items():
                if k != unknown:
                    self._put(other, k, minus(self.rows[other].get(k, 0.0), times(factor, x)))
            self.right[other] = minus(self.right[other], times(factor, self.right[row]))

    def _put(self, row: int, unknown: int, value: Operand) -> None:
        if is_literal_zero(value):
            self.rows[row].pop(unknown, None)
        else:
            self.rows[row][unknown] = value

    def _solve_group(self, left: Sequence[int]) -> list[int]:
        """Solve the fewest equations that have as many unknowns; returns what is left."""
        for size in range(1, len(left) + 1):
            for rows in combinations(left, size):
                unknowns = sorted({k for row in rows for k in self.rows[row]})
                if len(unknowns) == size:
                    self._solve_at_once(rows, unknowns)
                    rest = [row for row in left if row not in rows]
                    self._insert(rest, unknowns)
                    return rest
        raise Untraceable(mark("reactions that the constraints do not determine"))

    def _solve_at_once(self, rows: Sequence[int], unknowns: Sequence[int]) -> None:
        matrix = [[self.rows[row].get(k, 0.0) for k in unknowns] for row in rows]
        found = inverse(matrix)
        for k, factors in zip(unknowns, found, strict=True):
            self.found[k] = total([times(x, self.right[row]) for x, row in zip(factors, rows, strict=True)])
        self.gains += [total(row) for row in sizes(found)]

    def _insert(self, rows: Sequence[int], unknowns: Sequence[int]) -> None:
        for row in rows:
            for k in unknowns:
                factor = self.rows[row].pop(k, 0.0)
                self.right[row] = minus(self.right[row], times(factor, self.found[k]))


def _over(x: Operand, divisor: Operand) -> Operand:
    return x if is_literal_zero(x) or divisor == 1.0 else -x if divisor == -1.0 else x / divisor


# The equations of kinetostatics over nodes.


class NodeWrench(Wrench):
    """A wrench of nodes: components that are plainly zero cost nothing."""

    @classmethod
    def of(cls, wrench: Wrench) -> NodeWrench:
        """The same wrench."""
        return cls(wrench.body, wrench.force, wrench.at, wrench.moment)

    def times(self, factor: Number) -> Wrench:
        force = tuple(times(x, factor) for x in self.force)
        return NodeWrench(self.body, force, self.at, times(self.moment, factor))


class InPlaneOfNodes(InPlane):
    """Equilibrium in the plane over nodes, where forces act so that zeros stay plain zeros."""

    def of_row(self, constraint: Constraint, row: Row, at: Positions, link: str | None) -> tuple[Wrench, ...]:
        wrenches = super().of_row(constraint, row, at, link)
        # what ties a point to a body pushes both at one place, with opposite forces
        if isinstance(constraint, PointInLink | PointOnGuide | DisplacementDrive | TrackContact):
            first, *others = wrenches
            back = tuple(minus(0.0, x) for x in first.force)
            wrenches = (first, *(Wrench(other.body, back, first.at) for other in others))
        return tuple(NodeWrench.of(wrench) for wrench in wrenches)

    def on_link(self, pull: Wrench, foot: MomentCentre, scale: float) -> tuple[Number, Number, Number]:
        x, y = (_difference(a, b) for a, b in zip(pull.at, foot[0], strict=True))
        moment = minus(times(x, pull.force[1]), times(y, pull.force[0]))
        return pull.force[0], pull.force[1], times(plus(moment, pull.moment), 1.0 / scale)


def _difference(a: Operand, b: Operand) -> Operand:
    return 0.0 if a is b else minus(a, b)


@dataclass(frozen=True)
class ReactionNodes:
    """Reactions of a traced motion.

    Attributes
    ----------
    parts : name of REACTIONS -> nodes (1, ...), as the dataset has them at one sample
    gain : the greatest norm of the inverses on the way; where it exceeds LARGEST_GAIN nothing is said
    """

    parts: Mapping[str, Array]
    gain: Node


def reaction_nodes(solved: Solved, values: Values) -> ReactionNodes:
    """Reactions at the one sample of a traced motion; `values` are those that vary, by their paths.

    Raises Untraceable for what expressions cannot say, InputError for masses and loads that are not complete.
    """
    prepared, mechanism = solved.ready, solved.ready.mechanism
    _refuse_untraceable(solved, tuple(values))
    given = {path: np.asarray(x).item() for path, x in values.items()}
    burden = MassesAndLoads.for_reactions(mechanism, given, EXPRESSIONS)
    state, acceleration = _state(solved, burden, values)
    scheme, teeth = Scheme.of(prepared.structure), Teeth.of(mechanism)
    if scheme.repeating:
        raise Untraceable(mark("reactions that the constraints do not determine"))
    system = _system(solved, scheme, teeth, state)
    pulls = [
        NodeWrench.of(pull).times(effort.strength(state))
        for load in burden.loads
        for effort in load.efforts
        for pull in effort.pulls(state)
    ]
    inertia = inertia_forces_of(state, burden.masses, acceleration)
    outer = [*pulls, *(pull for action in inertia for pull in action.pulls)]
    forces, gain = _forces(system, outer)
    parts = reactions_of(forces, sides_of(mechanism)) | frame_totals(forces, inertia)
    return ReactionNodes(parts, gain)


def _refuse_untraceable(solved: Solved, paths: Sequence[str]) -> None:
    mechanism = solved.ready.mechanism
    if mechanism.space == "sphere":
        raise Untraceable(mark("reactions on the sphere"))
    if any(gear.pair for gear in mechanism.gears):
        raise Untraceable(mark("radial forces of teeth"))
    if contacts_of(mechanism):
        raise Untraceable(mark("friction that depends on reactions"))
    burden = MassesAndLoads.for_reactions(mechanism)
    slid = {
        effort.coordinate.guide
        for load in burden.loads
        for effort in load.efforts
        if isinstance(effort.coordinate, Slide)
    }
    # a force along a guide takes its direction from the description
    if any(path == f"guides.{guide}.direction" for guide in slid for path in paths):
        raise Untraceable(mark("a force along a guide whose direction varies"))


def _state(solved: Solved, burden: MassesAndLoads, paths: Iterable[str]) -> tuple[State, Operand | None]:
    """The state of nodes, and the acceleration of the parameter; None where there is none."""
    prepared, path, span = solved.ready, solved.ready.kinematics.path, solved.span
    own = path.by_time or not prepared.mechanism.runs_at_mean_speed or not path.parameter.is_uniform
    if path.by_time:
        refuse_drive_in_formulas(burden)
    boxes = DriveMotion(span.time, span.parameter, span.rate) if own else motion_of_batch(solved, burden)
    numbers: list[Any] = [_operand(x) for x in (boxes.time, boxes.parameter, boxes.rate)]
    moving = DriveMotion(*numbers)
    state = state_of_nodes(solved, burden, moving)
    state.know_varied_frame(solved, paths)
    for link in solved.layout.angles:
        rotor = _rotor(state.angle(link))
        if rotor is not None:
            state.known[f"rotor {link}"] = rotor
    acceleration = _operand(span.second_rate) if own else 0.0
    return state, None if is_literal_zero(acceleration) else acceleration


def _operand(values: Any) -> Operand:
    value = np.asarray(values).ravel()[0]
    return value if isinstance(value, Node) else float(value)


def _rotor(angle: Jet) -> tuple[Jet, Jet] | None:
    """Cosine and sine of an angle that is an arc tangent and whole turns: what the arc tangent was taken of."""
    value, first, half_second = angle.coefficients
    if not isinstance(value, Node):
        return None
    tangent = next((x for x in (value, *value.arguments) if x.operation == "atan2"), None)
    if tangent is None or value.operation not in ("add", "atan2"):
        return None
    sine, cosine = tangent.arguments
    # by time c' = -s w, c''/2 = -s w'/2 - c w^2/2
    bend = times(0.5, times(first, first))
    return (
        Jet((cosine, times(minus(0.0, sine), first), _bent(minus(0.0, sine), cosine, half_second, bend))),
        Jet((sine, times(cosine, first), _bent(cosine, sine, half_second, bend))),
    )


def _bent(across: Operand, along: Operand, half_second: Operand, bend: Operand) -> Operand:
    return minus(times(across, half_second), times(along, bend))


def _system(solved: Solved, scheme: Scheme, teeth: Teeth, state: State) -> Kinetostatics:
    mechanism, numbers = solved.ready.mechanism, solved.ready.kinematics.numbers
    space = InPlaneOfNodes()
    at = space.positions(state, numbers)
    pulls: dict[Unknown, tuple[Wrench, ...]] = {}
    for constraint in scheme.structure.constraints:
        wrenches = wrenches_of(constraint, mechanism, numbers, at, teeth, space)
        pulls |= {(constraint, row): tuple(map(NodeWrench.of, each)) for row, each in enumerate(wrenches)}
    # moments are measured by the description's own greatest length: any number of its size will do
    scale = float(solved.ready.kinematics.path.scale)
    return Kinetostatics(scheme, numbers, teeth, space, scale, at, pulls, (1, 1))


def _forces(system: Kinetostatics, outer: Sequence[Wrench]) -> tuple[ForceSystem, Node]:
    """Constraint forces that balance what acts, and the greatest gain on the way."""
    scheme, space = system.scheme, system.equilibrium
    rows: list[dict[int, Operand]] = [{} for _row in range(scheme.size)]
    right: list[Operand] = [0.0] * scheme.size
    for column, unknown in enumerate(scheme.solved):
        factor = system.scale if space.by_moment(unknown[0]) else 1.0
        for pull in system.pulls[unknown]:
            for row, value in system.entries(pull):
                entry = plus(rows[row].get(column, 0.0), times(value, factor))
                if not is_literal_zero(entry):
                    rows[row][column] = entry
    for pull in outer:
        for row, value in system.entries(pull):
            right[row] = minus(right[row], value)
    equations = SparseEquations(rows, right)
    solution = equations.solve()
    multipliers: dict[Unknown, Number] = {}
    for column, unknown in enumerate(scheme.solved):
        factor = system.scale if space.by_moment(unknown[0]) else 1.0
        multipliers[unknown] = times(solution[column], factor)
    multipliers |= system.at_hosts(multipliers, outer, 0.0)
    least: Operand = 0.0
    gain = functools.reduce(EXPRESSIONS.max, equations.gains, least)
    return ForceSystem(system, multipliers, tuple(outer)), as_node(gain)


# Reactions of one changed mechanism by the arrays.


def reaction_arrays(solved: Solved, values: Values) -> dict[str, npt.NDArray[np.float64]]:
    """Reactions at the samples of the motion of one mechanism, (samples, ...), as `reactions` has them.

    `values` are those that vary, by their paths. NaN where a load has no finite amount.
    """
    prepared = solved.ready
    changed = with_values(prepared.mechanism, {path: float(np.ravel(x)[0]) for path, x in values.items()})
    structure = replace(prepared.structure, mechanism=changed)
    numbers = dimensions_of(changed, {}, ARRAYS)
    kinematics = replace(prepared.kinematics, structure=structure, numbers=numbers)
    own = replace(solved, ready=replace(prepared, kinematics=kinematics))
    burden = MassesAndLoads.for_reactions(changed)
    found = reactions_at(own, burden, input_motion_of(own, burden), contacts_of(changed))
    return {name: found[name].values for name in REACTIONS if name in found}


# An output asks for one reaction after the other of the same motion.


class _Last(threading.local):
    motion: weakref.ref[Solved] | None = None
    found: ReactionNodes | Mapping[str, Array] | None = None


_last = _Last()


def reaction_gain(solved: Solved, values: Values) -> Node:
    """The `gain` of the reactions of a traced motion."""
    found = _found(solved, values)
    assert isinstance(found, ReactionNodes)
    return found.gain


def reaction_number(name: str, solved: Solved, values: Values) -> Array:
    """One of REACTIONS of one mechanism, (1, samples, ...); of a traced motion its nodes (1, 1, ...).

    Raises Untraceable for what expressions cannot say; without a finite load there is NaN.
    """
    found = _found(solved, values)
    return (found.parts if isinstance(found, ReactionNodes) else found)[name][None]


def _found(solved: Solved, values: Values) -> ReactionNodes | Mapping[str, Array]:
    """All reactions of a motion; those of the last one are kept."""
    if _last.motion is None or _last.motion() is not solved or _last.found is None:
        traced = solved.points.dtype == object
        _last.found = reaction_nodes(solved, values) if traced else _arrays_or_nothing(solved, values)
        _last.motion = weakref.ref(solved)
    return _last.found


def _arrays_or_nothing(solved: Solved, values: Values) -> Mapping[str, Array]:
    try:
        return reaction_arrays(solved, values)
    except InputError:
        # the description's own reactions exist: with these numbers a load has no finite amount
        own = reaction_arrays(solved, {})
        return {name: np.full_like(array, np.nan) for name, array in own.items()}
