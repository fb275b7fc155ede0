"""Scans along the path of plans that have groups of higher class: each place is found from the one before."""

from __future__ import annotations

import functools
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.kinematics.higher_class.evaluation import starts
from centrode.kinematics.higher_class.newton import newton
from centrode.kinematics.higher_class.system import (
    GroupSystem,
    Surroundings,
    add_in_shape,
    flatten_positions,
    needed_positions,
)
from centrode.kinematics.machine_code.newton import Names, numbers_of
from centrode.kinematics.machine_code.trace import Traced, chains_of
from centrode.kinematics.machine_code.variables import (
    ALONG,
    AWAY,
    FIRST,
    MOST,
    PARAMETER,
    SAMPLE,
    SHARE,
    STEP,
    TURN,
    before_of,
)
from centrode.kinematics.path import Path
from centrode.kinematics.plan_evaluation import EvaluationPolicy
from centrode.kinematics.preparation import Ready
from centrode.kinematics.solve import of_batch
from centrode.numerics.executors import runner
from centrode.numerics.expressions import EXPRESSIONS, Node, Operand, as_node, variable
from centrode.numerics.graphs import Graph
from centrode.numerics.scans import Reduction, Scan
from centrode.structure.constraints import Positions
from centrode.structure.dimensions import Dimensions

# Where walks of a batch begin: groups of higher class in the initial position, found as the arrays find them.

Array: TypeAlias = npt.NDArray[np.float64]
Lanes: TypeAlias = npt.NDArray[np.intp]
Number: TypeAlias = Any
Namespace: TypeAlias = Any

AT_ONCE = 4096
"""Mechanisms that are begun together: their numbers stay in the cache."""


def beginnings(ready: Ready, numbers: Dimensions, lanes: int) -> dict[str, Array]:
    """Free coordinates in the initial position of every mechanism of a batch, name -> (lanes,).

    NaN where a mechanism is not reached from the description's own dimensions.
    """
    parts = []
    for first in range(0, lanes, AT_ONCE):
        rows = slice(first, min(first + AT_ONCE, lanes))
        some = numbers.map_numbers(lambda x, rows=rows: x if isinstance(x, float) else x[rows])  # type: ignore[misc]
        parts.append(_of_some(ready, some, rows.stop - first))
    return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]} if parts else {}


def _of_some(ready: Ready, numbers: Dimensions, lanes: int) -> dict[str, Array]:
    kinematics = of_batch(ready.kinematics, numbers)
    initial, columns = kinematics.path.initial, dict[str, Array]()
    everyone = np.arange(lanes)
    hooks = _Beginning(ready)
    for group, chain in chains_of(ready, kinematics.take(everyone).numbers).items():
        around = Surroundings(kinematics, group, hooks.at_lanes)
        state = starts(around, ready.kinematics.numbers, ready.assembled.positions, initial, lanes)
        hooks.states[group] = around, state
        blank = around.blank(everyone)
        at = blank.at(np, Positions({}, {}, {}, {}), state)
        posture = chain.posture(at)
        labels = Names(group, chain).labels
        for name, values in zip(numbers_of(labels), numbers_of(posture), strict=True):
            columns[name] = np.array(np.broadcast_to(values, lanes), dtype=np.float64)
    return columns


class _Beginning:
    """Policy of the initial position, with the groups of higher class that are begun so far."""

    def __init__(self, ready: Ready) -> None:
        self.signs = ready.assembled.signs
        self.states: dict[int, tuple[Surroundings, Array]] = {}

    def at_lanes(self, m: Namespace, parameter: Array, lanes: Lanes) -> EvaluationPolicy:
        return _OfLanes(m, self.signs, self.states, lanes)


class _OfLanes(EvaluationPolicy):
    def __init__(
        self,
        m: Namespace,
        signs: Mapping[int, float],
        states: Mapping[int, tuple[Surroundings, Array]],
        lanes: Lanes,
    ) -> None:
        self.m, self.signs, self.states, self.lanes = m, signs, states, lanes

    def root(self, group: int, radicand: Number) -> Number:
        return self.m.sqrt(radicand) * self.signs[group]

    def higher(self, group: int, m: Namespace, at: Positions) -> None:
        around, states = self.states[group]
        equations, shape = around.equations, self.lanes.shape
        known = flatten_positions(needed_positions(equations, at), shape)
        system = GroupSystem(equations, around.kinematics.take(self.lanes).numbers, known, len(self.lanes))
        converged = newton(system, states[self.lanes])
        # NaN goes on into all that stands on the group, so that the mechanism is not clear
        state = np.where(converged.found[:, None], converged.state, np.nan)
        add_in_shape(system.at(m, known, state), equations, shape, at)


# The order in which a walk passes places of the path: from the initial position onwards, then from there
# back.
#
# Samples may be few, or lie anywhere; so many other places are put between them that no step is long.

Places: TypeAlias = npt.NDArray[np.intp]

NODES = 2
"""Longest step, in nodes of the mesh of events: 1 degree of an angle drive."""
MOST_SHARE = 1e6
"""Steps shorter than this part of the longest one tell nothing of rates."""


@dataclass(frozen=True)
class PathLeg:
    """The places in one sense of the path, the initial position first.

    Attributes
    ----------
    inputs : name -> (places,)
    places : (k,), numbers of the samples among the places of this leg
    asked : (k,), numbers of the same samples in the whole motion
    """

    inputs: Mapping[str, Array]
    places: Places
    asked: Places

    @property
    def steps(self) -> int:
        """Number of places."""
        return len(self.inputs[PARAMETER])

    def parts(self, steps: int) -> Iterator[PathLeg]:
        """The leg in parts of at most so many places."""
        for first in range(0, self.steps, steps):
            inputs = {name: row[first : first + steps] for name, row in self.inputs.items()}
            here = (self.places >= first) & (self.places < first + steps)
            yield PathLeg(inputs, self.places[here] - first, self.asked[here])


@dataclass(frozen=True)
class Way:
    """Both legs."""

    legs: tuple[PathLeg, PathLeg]


def way_of(path: Path, inputs: Mapping[str, Array]) -> Way:
    """The way past all that is requested, name -> (samples,)."""
    off = inputs[PARAMETER] - path.initial
    order = np.argsort(off, kind="stable")
    # both legs lead away from the initial position, where the state is known
    ahead, behind = order[off[order] >= 0.0], order[off[order] < 0.0][::-1]
    longest = NODES * path.step
    return Way((_leg(path.initial, longest, inputs, ahead), _leg(path.initial, -longest, inputs, behind)))


def _leg(initial: float, longest: float, inputs: Mapping[str, Array], asked: Places) -> PathLeg:
    parameter, places = _fill_places(initial, longest, inputs[PARAMETER][asked])
    rows = {name: np.zeros(len(parameter)) for name in (*inputs, STEP, SHARE, FIRST, SAMPLE)}
    for name, values in inputs.items():
        rows[name][places] = values[asked]
    rows[PARAMETER] = parameter
    rows[STEP][1:] = np.diff(parameter)
    with np.errstate(divide="ignore"):
        # differences of the matrix are scaled as if every step were the longest; those of very short steps
        # are rounding alone
        share = longest / rows[STEP]
    rows[SHARE][:] = np.where(np.abs(share) < MOST_SHARE, share, 0.0)
    rows[FIRST][0] = 1.0
    rows[SAMPLE][places] = 1.0
    return PathLeg(rows, places, asked)


def _fill_places(initial: float, longest: float, asked: Array) -> tuple[Array, Places]:
    """Places with no longer steps than that, and which of them are those requested."""
    if not len(asked):
        return np.array([initial]), np.zeros(0, dtype=np.intp)
    stops = np.concatenate([[initial], asked])
    # a stretch of just so many longest steps does not get one more by rounding
    counts = np.maximum(1, np.ceil(np.diff(stops) / longest * (1.0 - 1e-9)).astype(np.intp))
    parts = [
        start + (stop - start) * np.arange(1, count + 1) / count if count > 1 else [stop]
        for start, stop, count in zip(stops[:-1], stops[1:], counts, strict=True)
    ]
    parameter = np.concatenate([[initial], *parts])
    places = np.cumsum(counts)
    parameter[places] = asked  # to the last bit
    return parameter, places.astype(np.intp)


Values: TypeAlias = Mapping[str, Array]

m = EXPRESSIONS
SURE = "sure"
"""State of a walk: the least slack of all steps so far."""
NOTHING = Reduction({}, {})
BUFFER = 4_000_000
"""Bytes of what is written on the way before the samples are taken from it: it should stay in the cache."""
LEAST_LANES = 64
"""Mechanisms that are taken together at least."""


@dataclass(frozen=True)
class Walk:
    """States handed on from place to place.

    Attributes
    ----------
    traced : the plan
    links : whose turns are counted from place to place
    """

    traced: Traced
    links: Sequence[str] = ()

    @cached_property
    def state(self) -> dict[str, Node]:
        """Name -> its next value."""
        states: dict[str, Node] = {}
        slacks = [step.slack for step in self.traced.steps.values()]
        for step in self.traced.steps.values():
            states |= step.state
        for name, angle in self._angles.items():
            # at the initial position the angle before is that of the description's own dimensions, from which
            # those of a mechanism may differ by more than in a step
            most = m.where(m.equal(variable(FIRST), 1.0), np.pi - AWAY, MOST)
            slacks.append(as_node(most - m.abs(angle - variable(name))))
            states[name] = angle
        least: Operand = variable(SURE)
        states[SURE] = as_node(functools.reduce(m.min, slacks, least))
        return states

    @property
    def _angles(self) -> dict[str, Node]:
        """Angles whose turns are counted, by the names of what they were at the place before."""
        angles = {before_of(f"counted {key}"): angle for key, (_turns, angle) in self.traced.counted.items()}
        for link in self.links:
            angle = m.atan2(*reversed(self.traced.turning[link]))
            angles[before_of(link)] = as_node(angle + TURN * self.traced.turns[link])
        return angles

    @cached_property
    def start(self) -> dict[str, float]:
        """Name -> its first value, where that is the same for all mechanisms and known here."""
        angles = self.traced.solved.ready.assembled.angles
        states = dict.fromkeys(self.state, 0.0) | {before_of(link): angles[link] for link in self.links}
        states |= {before_of(f"counted {key}"): angles.get(key, 0.0) for key in self.traced.counted}
        return states | {SURE: np.inf}

    def moves(self, nodes: Sequence[Node]) -> bool:
        """Whether nodes depend on what is handed on."""
        return any(name in self.state for name in Graph({str(k): x for k, x in enumerate(nodes)}).variables)


@dataclass(frozen=True)
class Walking:
    """A walk that reduces or writes something on its way.

    Attributes
    ----------
    reduction : over the samples alone
    outputs : name -> node; written at every place
    further : names of numbers that each sample has besides those of the path
    """

    walk: Walk
    reduction: Reduction = NOTHING
    outputs: Mapping[str, Node] = field(default_factory=dict)
    further: tuple[str, ...] = ()

    @cached_property
    def scan(self) -> Scan:
        # places between samples move the state along and leave what is reduced as it is
        """The scan of either leg."""
        at_sample = m.equal(variable(SAMPLE), 1.0)
        kept = {
            name: as_node(m.where(at_sample, node, variable(name)))
            for name, node in self.reduction.state.items()
        }
        states = {**self.walk.state, **kept}
        used = Graph({**self.outputs, **{f"next {name}": node for name, node in states.items()}}).variables
        along = (*ALONG, *self.further)
        return Scan(
            tuple(name for name in used if name not in states and name not in along),
            tuple(name for name in along if name in used),
            self.outputs,
            states,
        )

    def reduce(self, way: Way, values: Values, kernels: str, threads: int) -> dict[str, Array]:
        """Reductions over all samples, and the margin by which they are sure: name -> (lanes,)."""
        state: dict[str, Array] = {}
        for leg in way.legs:
            state = self._run(leg, values, self._begun(values, state), kernels, threads, None)
        return self._end_states(state)

    def write_samples(
        self, way: Way, values: Values, kernels: str, threads: int, out: Array
    ) -> dict[str, Array]:
        """Write outputs at the samples into `out` (outputs, lanes, samples); returns what is left at the end."""
        lanes, each = out.shape[1], out.itemsize * len(self.outputs)
        longest = max(leg.steps for leg in way.legs)
        # as many mechanisms as fill the buffer with their longest leg, but enough to fill vectors and threads
        together = min(lanes, max(LEAST_LANES * threads, BUFFER // (each * longest)))
        steps = min(longest, max(1, BUFFER // (each * together)))
        room = np.empty(len(self.outputs) * together * steps)
        parts: list[dict[str, Array]] = []
        for first in range(0, lanes, together):
            rows = slice(first, min(first + together, lanes))
            some = {name: row[rows] for name, row in values.items()}
            state: dict[str, Array] = {}
            for leg in way.legs:
                state = self._begun(some, state)
                for part in leg.parts(steps):
                    shape = len(self.outputs), part.steps, rows.stop - first
                    buffer = room[: math.prod(shape)].reshape(shape)
                    state = self._run(part, some, state, kernels, threads, buffer)
                    out[:, rows, part.asked] = np.moveaxis(buffer[:, part.places], 1, 2)
            parts.append(self._end_states(state))
        return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}

    def _begun(self, values: Values, before: Values) -> dict[str, Array]:
        """All states in the initial position; what is kept goes on from where it stood before."""
        lanes = len(next(iter(values.values())))
        # the second leg begins in the initial position again; the slack and what is reduced go on from the
        # first
        start = self.walk.start | dict(self.reduction.start)
        kept = self._end_states(before)
        return {
            name: kept[name]
            if name in kept
            else values[name]
            if name in values
            else np.full(lanes, start[name])
            for name in self.scan.state
        }

    def _end_states(self, state: Values) -> dict[str, Array]:
        """Of all states what does not tell of a place."""
        return {name: state[name] for name in (*self.reduction.state, SURE) if name in state}

    def _run(
        self, leg: PathLeg, values: Values, state: Values, kernels: str, threads: int, out: Array | None
    ) -> dict[str, Array]:
        """All states behind a leg."""
        scan = self.scan
        parameters = np.stack([values[name] for name in scan.parameters]) if scan.parameters else None
        inputs = np.stack([leg.inputs[name] for name in scan.inputs])
        run = runner(scan, kernels, threads=threads)
        results = run(parameters, inputs, np.stack([state[name] for name in scan.state]), out=out).state
        return dict(zip(scan.state, results, strict=True))
