"""Reactions of one description by machine code: equations at one sample, traced, with numbers of the motion as inputs.

One kernel writes the matrix, what acts and its moment; the matrix is inverted as by the arrays; a second kernel makes
reactions, totals and checks of the solution. They are the operations of the arrays in their order, so the bits are too.
"""

from __future__ import annotations

import functools
import operator
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.kinetostatics.applied_forces import InertiaForce, InputMotion, inertia_forces_of
from centrode.dynamics.kinetostatics.equations import (
    ForceSystem,
    InPlane,
    Kinetostatics,
    Scheme,
    Teeth,
    Unknown,
    inverse_of,
    wrenches_of,
)
from centrode.dynamics.kinetostatics.joints import JointSide, reaction_status, reactions_of, sides_of
from centrode.dynamics.kinetostatics.reactions import BALANCES, ReactionNumbers, balances_of, totals_of
from centrode.dynamics.loads import LoadDiagram, LoadTable, MassesAndLoads
from centrode.dynamics.masses import share
from centrode.dynamics.reduction import NODE_JETS
from centrode.dynamics.state import State
from centrode.dynamics.wrenches import Wrench
from centrode.kinematics.preparation import Ready
from centrode.kinematics.solve import Solved
from centrode.model.kept_values import KeptValues
from centrode.numerics.executors import MACHINE_CODE, Run, runner
from centrode.numerics.expressions import Operand, as_node, variable
from centrode.numerics.graphs import Graph
from centrode.numerics.scans import Scan, room_of

Array: TypeAlias = npt.NDArray[np.float64]
Nodes: TypeAlias = npt.NDArray[Any]
Number: TypeAlias = Any
ORDERS = 3
MOST_KEPT = 16
TIME, PARAMETER, RATE, ACCELERATION = "time", "parameter", "rate", "acceleration"
SOLUTION = "solution"
MOTION = {"point": "points", "angle": "angles", "slide": "slides"}
"""Kind of numbers of a motion -> where it has them."""
MATRIX, RIGHT, STRENGTHS, MOMENT = "matrix", "right", "strengths", "moment"


def reactions_by_kernels(solved: Solved, burden: MassesAndLoads, pace: InputMotion) -> ReactionNumbers | None:
    """The reactions of a motion without limits; None of what only the arrays compute, or where a load has no amount."""
    accelerates = bool(pace.acceleration.any())

    def make() -> ReactionKernels | None:
        return ReactionKernels.of(solved, burden, accelerates)

    kernels = _kept.get(solved.ready.mechanism, accelerates, make)
    return None if kernels is None else kernels.solve(solved, pace)


# Numbers at every sample as machine code.


class NumberPlace(NamedTuple):
    """Which number of a motion, of its drive or of a solution a variable stands for."""

    kind: str
    number: int = 0
    order: int = 0

    @classmethod
    def of(cls, name: str) -> NumberPlace:
        """That of a variable of this name."""
        kind, *numbers = name.split()
        return cls(kind, *map(int, numbers))

    @property
    def name(self) -> str:
        """Name of the variable."""
        return f"{self.kind} {self.number} {self.order}"


@dataclass(frozen=True)
class SampleKernel:
    """Arrays of nodes of one sample, each under its name, from numbers that are known at every sample."""

    nodes: Mapping[str, Nodes]
    scan: Scan

    @classmethod
    def of(cls, nodes: Mapping[str, Any]) -> SampleKernel:
        """The kernel of some arrays of nodes and numbers."""
        arrays = {name: np.asarray(array, dtype=object) for name, array in nodes.items()}
        flat = [as_node(x) for array in arrays.values() for x in array.ravel()]
        outputs = {f"output {k}": node for k, node in enumerate(flat)}
        return cls(arrays, Scan(tuple(Graph(outputs).variables), (), outputs))

    @cached_property
    def inputs(self) -> list[NumberPlace]:
        """What has to be known."""
        return [NumberPlace.of(name) for name in self.scan.parameters]

    @cached_property
    def _run(self) -> Run:
        return runner(self.scan, MACHINE_CODE, lanes_inside=True)

    def run(self, known: Sequence[Array]) -> dict[str, Array]:
        """The arrays, samples behind, from numbers (n) in the order of the inputs."""
        rows = np.stack(known)
        room = room_of(len(self.scan.outputs), 1, rows.shape[1])
        self._run(rows, None, out=room, steps=1)
        found, first = {}, 0
        for name, array in self.nodes.items():
            found[name] = room[first : first + array.size, 0].reshape(*array.shape, rows.shape[1])
            first += array.size
        return found


# The equations at one sample.


@dataclass(frozen=True)
class TracedEquations:
    """What acts at one sample, and the equations, over variables for the numbers of the motion.

    Attributes
    ----------
    strengths : how great each effort of a load is
    moment : of loads and inertia along the path's parameter by virtual work
    """

    system: Kinetostatics
    loads: tuple[Wrench, ...]
    inertia: tuple[InertiaForce, ...]
    strengths: tuple[Operand, ...]
    moment: Operand

    @classmethod
    def of(cls, solved: Solved, burden: MassesAndLoads, accelerates: bool) -> TracedEquations:
        """The equations of a description, a motion of which tells where its numbers stand."""
        state = _state(solved)
        strengths, pulls, done = [], [], []
        for load in burden.loads:
            own = [effort.strength(state) for effort in load.efforts]
            strengths += own
            done.append(load.along(state, own))
            for effort, strength in zip(load.efforts, own, strict=True):
                pulls += [pull.times(strength) for pull in effort.pulls(state)]
        acceleration = variable(ACCELERATION) if accelerates else None
        sums = [share(state, mass) for mass in burden.masses]
        inertia, slope = _sum(x for x, _y in sums), _sum(y for _x, y in sums)
        moment = _sum(done) - 0.5 * slope * state.rate**2
        if acceleration is not None:
            moment = _sum(done) - inertia * acceleration - 0.5 * slope * state.rate**2
        inertia_forces = inertia_forces_of(state, burden.masses, acceleration)
        return cls(_system(solved.ready, state), tuple(pulls), inertia_forces, tuple(strengths), moment)

    @property
    def outer(self) -> tuple[Wrench, ...]:
        """Wrenches of loads and inertia."""
        return (*self.loads, *(pull for action in self.inertia for pull in action.pulls))

    def forces(self) -> ForceSystem:
        """The solved equations, with variables for the solution."""
        system, solution = self.system, {}
        for k, unknown in enumerate(system.scheme.unknowns):
            value = variable(NumberPlace(SOLUTION, k).name)
            solution[unknown] = value * system.scale if system.equilibrium.by_moment(unknown[0]) else value
        return ForceSystem(system, solution | system.at_hosts(solution, self.outer, 0.0), self.outer)


def _sum(values: Iterable[Number]) -> Number:
    return functools.reduce(operator.add, values, 0.0)


def _system(ready: Ready, state: State) -> Kinetostatics:
    """The equations over nodes, as `Kinetostatics.of` has them over arrays."""
    mechanism, numbers, space = ready.mechanism, ready.kinematics.numbers, InPlane()
    scheme, teeth = Scheme.of(ready.structure), Teeth.of(mechanism)
    at = space.positions(state, numbers)
    pulls: dict[Unknown, tuple[Wrench, ...]] = {}
    for constraint in scheme.structure.constraints:
        wrenches = wrenches_of(constraint, mechanism, numbers, at, teeth, space)
        pulls |= {(constraint, row): each for row, each in enumerate(wrenches)}
    return Kinetostatics(scheme, numbers, teeth, space, space.scale(numbers), at, pulls, (1, 1))


def _state(solved: Solved) -> State:
    """The state at one sample, with variables for its numbers."""

    def of_kind(kind: str) -> Any:
        return lambda k: [variable(NumberPlace(kind, k, order).name) for order in range(ORDERS)]

    kinds = {kind: of_kind(kind) for kind in MOTION}
    time, parameter, rate = (variable(name) for name in (TIME, PARAMETER, RATE))
    mechanism, scale = solved.ready.mechanism, solved.ready.kinematics.path.scale
    return State(mechanism, solved.layout, time, parameter, rate, 0, scale, kinds, m=NODE_JETS)  # type: ignore[arg-type]


# The kernels of one description.


@dataclass(frozen=True)
class KnownNumbers:
    """Numbers (n) of a motion, of its drive and of a solution (unknowns, n), by the names of variables."""

    solved: Solved
    pace: InputMotion
    solution: Array | None = None

    def rows(self, places: Iterable[NumberPlace]) -> list[Array]:
        """The numbers at places."""
        return [self._row(*place) for place in places]

    def _row(self, kind: str, k: int, order: int) -> Array:
        axes, moving = self.solved.layout.axes, self.pace.moving
        if kind == SOLUTION:
            assert self.solution is not None
            row: Array = self.solution[k]
            return row
        if kind in MOTION:
            of_kind: Array = getattr(self.solved, MOTION[kind])[order, 0]
            return of_kind[:, k // axes, k % axes] if kind == "point" else of_kind[:, k]
        drive = {TIME: moving.time, PARAMETER: moving.parameter, RATE: moving.rate}
        return drive.get(kind, self.pace.acceleration)


@dataclass(frozen=True)
class ReactionKernels:
    """Kernels of the equations of one description, and of what follows from their solution.

    Attributes
    ----------
    places : equation and unknown of each number of the matrix
    """

    sides: tuple[JointSide, ...]
    scheme: Scheme
    places: tuple[tuple[int, int], ...]
    equations: SampleKernel
    results: SampleKernel

    @classmethod
    def of(cls, solved: Solved, burden: MassesAndLoads, accelerates: bool) -> ReactionKernels | None:
        """The kernels; None of what only the arrays compute."""
        mechanism, scheme = solved.ready.mechanism, Scheme.of(solved.ready.structure)
        amounts = [effort.amount for load in burden.loads for effort in load.efforts]
        if (
            mechanism.space == "sphere"
            or scheme.repeating
            or any(isinstance(amount, LoadDiagram | LoadTable) for amount in amounts)
            or any(gear.pair for gear in mechanism.gears)
        ):
            return None
        traced = TracedEquations.of(solved, burden, accelerates)
        matrix, forces, sides = traced.system.matrix(), traced.forces(), sides_of(mechanism)
        equations = {
            MATRIX: [*matrix.values()],
            RIGHT: traced.system.right_side(traced.outer),
            STRENGTHS: traced.strengths,
            MOMENT: [traced.moment],
        }
        parts = reactions_of(forces, sides) | totals_of(forces, traced.inertia)
        balances = balances_of(forces, traced.outer)
        results = {name: array[0] for name, array in parts.items()}
        results |= {f"{name} {k}": sizes for name, pair in balances.items() for k, sizes in enumerate(pair)}
        return cls(sides, scheme, tuple(matrix), SampleKernel.of(equations), SampleKernel.of(results))

    def solve(self, solved: Solved, pace: InputMotion) -> ReactionNumbers | None:
        """The reactions at the samples of a motion; None where a load has no finite amount there."""
        known = KnownNumbers(solved, pace)
        found = self.equations.run(known.rows(self.equations.inputs))
        if not np.isfinite(found[STRENGTHS]).all():
            return None
        matrix = dict(zip(self.places, found[MATRIX][:, None], strict=True))
        scheme, shape = self.scheme, (1, len(pace.acceleration))
        inverse = inverse_of(matrix, scheme.size, len(scheme.unknowns), shape)
        solution = inverse.times(list(-found[RIGHT][:, None]))[:, 0]
        made = self.results.run(replace(known, solution=solution).rows(self.results.inputs))
        balances = {name: (made.pop(f"{name} 0")[0], made.pop(f"{name} 1")[0]) for name in BALANCES}
        parts = {name: np.ascontiguousarray(np.moveaxis(array, -1, 0)) for name, array in made.items()}
        status = reaction_status(inverse, solved.status[0])
        return ReactionNumbers(
            pace, self.sides, (), parts, balances, found[MOMENT][0], {}, status, inverse.loss[0]
        )


_kept = KeptValues["ReactionKernels | None"](MOST_KEPT)
