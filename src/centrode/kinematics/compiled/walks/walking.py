"""Scans along the path of plans that have groups of higher class: each place is found from the one before."""

from __future__ import annotations

import functools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.executors import runner
from centrode.algebra.expression_functions import EXPRESSIONS
from centrode.algebra.expressions import Node, Operand, as_node, variable
from centrode.algebra.graphs import Graph
from centrode.algebra.reductions import Reduction
from centrode.algebra.scans import Scan
from centrode.kinematics.compiled.traced import Traced
from centrode.kinematics.compiled.turns import AWAY, MOST, TURN, before_of
from centrode.kinematics.compiled.variables import ALONG, FIRST, SAMPLE
from centrode.kinematics.compiled.walks.ways import Leg, Way

Array: TypeAlias = npt.NDArray[np.float64]
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
    """What is handed on from place to place.

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
        found: dict[str, Node] = {}
        slacks = [step.slack for step in self.traced.steps.values()]
        for step in self.traced.steps.values():
            found |= step.state
        for name, angle in self._angles.items():
            most = m.where(m.equal(variable(FIRST), 1.0), np.pi - AWAY, MOST)
            slacks.append(as_node(most - m.abs(angle - variable(name))))
            found[name] = angle
        least: Operand = variable(SURE)
        found[SURE] = as_node(functools.reduce(m.min, slacks, least))
        return found

    @property
    def _angles(self) -> dict[str, Node]:
        """Angles whose turns are counted, by the names of what they were at the place before."""
        found = {before_of(f"counted {key}"): angle for key, (_turns, angle) in self.traced.counted.items()}
        for link in self.links:
            angle = m.atan2(*reversed(self.traced.turning[link]))
            found[before_of(link)] = as_node(angle + TURN * self.traced.turns[link])
        return found

    @cached_property
    def start(self) -> dict[str, float]:
        """Name -> its first value, where that is the same for all mechanisms and known here."""
        angles = self.traced.solved.ready.assembled.angles
        found = dict.fromkeys(self.state, 0.0) | {before_of(link): angles[link] for link in self.links}
        found |= {before_of(f"counted {key}"): angles.get(key, 0.0) for key in self.traced.counted}
        return found | {SURE: np.inf}

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
    """

    walk: Walk
    reduction: Reduction = NOTHING
    outputs: Mapping[str, Node] = field(default_factory=dict)

    @cached_property
    def scan(self) -> Scan:
        """The scan of either leg."""
        at_sample = m.equal(variable(SAMPLE), 1.0)
        kept = {
            name: as_node(m.where(at_sample, node, variable(name)))
            for name, node in self.reduction.state.items()
        }
        states = {**self.walk.state, **kept}
        used = Graph({**self.outputs, **{f"next {name}": node for name, node in states.items()}}).variables
        return Scan(
            tuple(name for name in used if name not in states and name not in ALONG),
            tuple(name for name in ALONG if name in used),
            self.outputs,
            states,
        )

    def reduced(self, way: Way, values: Values, kernels: str, threads: int) -> dict[str, Array]:
        """What is left of all samples at the end, and how sure that is: name -> (lanes,)."""
        state: dict[str, Array] = {}
        for leg in way.legs:
            state = self._run(leg, values, self._begun(values, state), kernels, threads, None)
        return self._left(state)

    def written(self, way: Way, values: Values, kernels: str, threads: int, out: Array) -> dict[str, Array]:
        """Write outputs at the samples into `out` (outputs, lanes, samples); returns what is left at the end."""
        lanes, each = out.shape[1], out.itemsize * len(self.outputs)
        longest = max(leg.steps for leg in way.legs)
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
            parts.append(self._left(state))
        return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}

    def _begun(self, values: Values, before: Values) -> dict[str, Array]:
        """All states in the initial position; what is kept goes on from where it stood before."""
        lanes = len(next(iter(values.values())))
        start = self.walk.start | dict(self.reduction.start)
        kept = self._left(before)
        return {
            name: kept[name]
            if name in kept
            else values[name]
            if name in values
            else np.full(lanes, start[name])
            for name in self.scan.state
        }

    def _left(self, state: Values) -> dict[str, Array]:
        """Of all states what does not tell of a place."""
        return {name: state[name] for name in (*self.reduction.state, SURE) if name in state}

    def _run(
        self, leg: Leg, values: Values, state: Values, kernels: str, threads: int, out: Array | None
    ) -> dict[str, Array]:
        """All states behind a leg."""
        scan = self.scan
        parameters = np.stack([values[name] for name in scan.parameters]) if scan.parameters else None
        inputs = np.stack([leg.inputs[name] for name in scan.inputs])
        run = runner(scan, kernels, threads=threads)
        found = run(parameters, inputs, np.stack([state[name] for name in scan.state]), out=out).state
        return dict(zip(scan.state, found, strict=True))
