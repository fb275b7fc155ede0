"""Motions with limits and change points: the mesh of the search and most samples as machine code.

The bits are those of `solve`. Signs take the change points as numbers of the mechanism; a sample is open where
a radicand lies below zero by more than rounding. What is left to the arrays are the samples that hang on
rounding and those on power series: they are computed one by one, and put into their places (`patches`).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.expression_functions import EXPRESSIONS
from centrode.algebra.expressions import Node, Operand, as_node, variable
from centrode.algebra.jets import Jet
from centrode.errors import Status
from centrode.kinematics.angles import NodeTurns
from centrode.kinematics.compiled.drives import inputs_of, places_of
from centrode.kinematics.compiled.events.patches import Patches
from centrode.kinematics.compiled.events.searching import Search, of_mesh
from centrode.kinematics.compiled.events.signs import counts_of, signs_of, values_of
from centrode.kinematics.compiled.traced import Traced, traced
from centrode.kinematics.compiled.turns import TURN
from centrode.kinematics.compiled.variables import Varied, boxed, taken
from centrode.kinematics.compiled.writing import JUDGED, ORDERED, ROOMS, SINES, Writer, nodes_of, solved_of
from centrode.kinematics.continuation import Continuation
from centrode.kinematics.mending import inside
from centrode.kinematics.mesh import mesh_of
from centrode.kinematics.pace import nearest_node
from centrode.kinematics.places import start_of
from centrode.kinematics.ready import Ready
from centrode.kinematics.residuals import CLOSED
from centrode.kinematics.sampling import ORDERS, SUSPECT, beyond_limits
from centrode.kinematics.solve import Solved, fit_for, lanes_at_once, of_batch, of_lanes, solve
from centrode.kinematics.spans import Span
from centrode.structure.dimensions import Dimensions

Array: TypeAlias = npt.NDArray[np.float64]
Lanes: TypeAlias = npt.NDArray[np.intp]
Mask: TypeAlias = npt.NDArray[np.bool_]
Nodes: TypeAlias = npt.NDArray[Any]

m = EXPRESSIONS
FINE, OPEN, DOUBTFUL = 0.0, 1.0, 2.0
"""What machine code says of a sample: doubtful are those that hang on rounding, or are not finite."""
NEARLY = 1e-3
"""Residuals that lie this close to the greatest that counts as closed are left to the arrays."""
AT_ONCE = 2
"""How many times as many mechanisms are computed together as by arrays."""


@dataclass(frozen=True)
class Eventful:
    """Computes motions that have events.

    Attributes
    ----------
    varied : the numbers of the batch as variables
    plan : the same with constant signs
    kernels : what runs scans, see `algebra.executors`
    unclosed : filled with mechanisms that have a sample which does not close
    """

    ready: Ready
    span: Span
    varied: Varied
    plan: Traced
    kernels: str
    threads: int = 1
    unclosed: set[int] = field(default_factory=set)
    _writers: dict[tuple[tuple[int, int], ...], tuple[Traced, Writer, Writer]] = field(default_factory=dict)
    _memory: tuple[list[Array], list[Array]] = field(default_factory=lambda: ([], []))

    def solved(self, numbers: Dimensions, lanes: Lanes) -> Iterator[tuple[Lanes, Solved]]:
        """The motions of some mechanisms of a batch, part by part; arrays stay as they are until the next part."""
        ready = fit_for(self.ready, self.span)
        kinematics = of_batch(ready.kinematics, numbers)
        values = self.varied.values(numbers)
        size = AT_ONCE * lanes_at_once(kinematics, self.span)
        for first in range(0, len(lanes), size):
            some = lanes[first : first + size]
            continuation = start_of(ready, of_lanes(kinematics, some), len(some))
            of_some = {name: row[some] for name, row in values.items()}
            search = Search(continuation, self.mesh, of_some, lambda counts: self._writer(counts)[:2])
            if search.run():
                yield some, self._part(search, some)
            else:
                self.unclosed.update(some.tolist())  # nobody has looked
                yield some, solve(self.ready, self.span, taken(numbers, some), len(some))

    @cached_property
    def possible(self) -> bool:
        """Whether the bits will be those of the arrays: where the plan leaves no function to a kernel.

        Groups of higher class, whose places hang on one another, are not for this.
        """
        return not self.plan.steps and all(writer.alike for writer in self._writer({})[1:])

    @cached_property
    def mesh(self) -> Array:
        """The nodes on which events are looked for."""
        return mesh_of(fit_for(self.ready, self.span).kinematics.path, self.span.parameter)

    def _part(self, search: Search, some: Lanes) -> Solved:
        continuation = search.continuation
        branches = continuation.branches
        counts = counts_of(branches)
        plan, _of_mesh, writer = self._writer(counts)
        room = writer.same_room(branches.lanes)
        values = {**search.values, **values_of(branches, counts)}
        values |= {largest_of(group): largest for group, largest in branches.largest.items()}
        writer.write(values, room)
        found = writer.placed(room)
        turns = self._turns(plan, search, found)
        status, doubtful = self._judged(continuation, found[JUDGED], found["residual"])
        broken = (status == Status.OPEN) & (found[JUDGED] != OPEN)
        if broken.any():
            self.unclosed.update(some[broken.any(axis=1)].tolist())
            for name in ROOMS:
                if name in found:
                    found[name][(slice(None), broken) if name in ORDERED else broken] = np.nan
        lanes, places = np.nonzero(doubtful)
        if len(lanes):
            patches = Patches(continuation, self.span, plan.solved, turns, self.mesh)
            self.unclosed.update(some[patches.put(lanes, places, found, status)].tolist())
        return solved_of(plan.solved, found, status, ready=self.ready, span=self.span, branches=branches)

    def _writer(self, counts: Mapping[int, int]) -> tuple[Traced, Writer, Writer]:
        key = tuple(sorted(counts.items()))
        if key not in self._writers:
            signs = signs_of(self.ready, counts)
            plan = traced(self.ready, self.span, self.varied, signs) if counts else self.plan
            nodes = plan
            if not all(isinstance(radicand, Jet) for radicand in plan.radicands.values()):
                nodes = traced(self.ready, self.span, self.varied, signs, on_mesh=True)
            path = self.ready.kinematics.path
            mesh, samples = places_of(path, self.mesh, ORDERS - 1), inputs_of(path, self.span)
            self._writers[key] = (
                plan,
                Writer(of_mesh(nodes), mesh, self.kernels, self.threads, self._memory[0]),
                Writer(_outputs(plan), samples, self.kernels, self.threads, self._memory[1]),
            )
        return self._writers[key]

    def _turns(self, plan: Traced, search: Search, found: dict[str, Array]) -> dict[str, NodeTurns]:
        """Put angles with their turns where their cosines stand; returns their turns on the mesh."""
        layout, nearest = plan.solved.layout, nearest_node(self.mesh, self.span.parameter)
        known = {}
        for k, link in enumerate(plan.turning):
            known[link] = nodes = search.turns(link, self.ready.assembled.angles[link])
            angle, sine = found["angles"][0, :, :, layout.angles.index(link)], found[SINES][:, :, k]
            turns = nodes.at(nearest, angle, sine, self.span.parameter)
            np.arctan2(sine, angle, out=angle)
            if turns.any():
                angle += TURN * turns
        return known

    def _judged(self, continuation: Continuation, judged: Array, residual: Array) -> tuple[Any, Mask]:
        """Statuses of the samples, and which of them the arrays have to look at."""
        status = np.full(judged.shape, Status.OK, dtype=np.int8)
        status[beyond_limits(continuation.branches, self.span.parameter)] = Status.CUT_OFF
        with np.errstate(invalid="ignore"):
            status[(judged == OPEN) | (residual > CLOSED)] = Status.OPEN
            doubtful = (judged == DOUBTFUL) | (np.abs(residual - CLOSED) <= NEARLY * CLOSED)
        for group in continuation.branches.largest:
            windows = continuation.windows_of(group)
            if windows is not None:
                doubtful[inside(windows, self.span.parameter, None)[0]] = True
        return status, doubtful


def largest_of(group: int) -> str:
    """Name of the greatest radicand of a group on the mesh."""
    return f"greatest {group}"


def _outputs(plan: Traced) -> dict[str, Nodes]:
    """What is written: nothing where a group is open, and what is to be said of the sample."""
    found = nodes_of(plan)
    lowest: Operand | None = None
    near: Node | None = None
    for group, radicand in plan.radicands.items():
        value = radicand.value if isinstance(radicand, Jet) else radicand
        lowest = value if lowest is None else m.least(lowest, value)
        close = m.less_equal(m.abs(value), SUSPECT * variable(largest_of(group)))
        near = close if near is None else m.either(near, close)
    total: Operand = 0.0
    for nodes in found.values():
        for node in nodes.ravel():
            total = total + node
    judged: Operand = m.where(m.equal(as_node(total) * 0.0, 0.0), FINE, DOUBTFUL)
    if lowest is not None and near is not None:
        opened = m.less(lowest, 0.0)
        judged = m.where(near, DOUBTFUL, m.where(opened, OPEN, judged))
        found = {
            name: boxed([m.where(opened, np.nan, node) for node in nodes.ravel()]).reshape(nodes.shape)
            for name, nodes in found.items()
        }
    return {**found, JUDGED: boxed([judged]).reshape(1, 1)}
