"""The motions of many mechanisms: those without events as machine code where that pays, to the bits of `solve`.

What is not rounded alike everywhere, the arc tangent, stays with NumPy. So a result does not tell how many
mechanisms were computed with it; only what groups of higher class give, and what stands on them, is rounded otherwise.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra import machine_code
from centrode.algebra.executors import MACHINE_CODE, runner
from centrode.algebra.expressions import as_node
from centrode.algebra.graphs import Graph
from centrode.algebra.scans import Scan
from centrode.errors import Status
from centrode.kinematics.branches import Branches, branches_at_start
from centrode.kinematics.compiled.beginnings import beginnings
from centrode.kinematics.compiled.judging import SLACK, Judging
from centrode.kinematics.compiled.signs import Untraceable
from centrode.kinematics.compiled.traced import Traced, traced
from centrode.kinematics.compiled.turns import TURN, centre_of, whole_turns, winding_of
from centrode.kinematics.compiled.variables import PARAMETER, SCALE, boxed, inputs_of, varied_of
from centrode.kinematics.compiled.walks import SURE, Walking
from centrode.kinematics.compiled.ways import way_of
from centrode.kinematics.mesh import mesh_of
from centrode.kinematics.ready import Ready
from centrode.kinematics.residuals import CLOSED, Kept
from centrode.kinematics.solve import CHUNK, Progress, Solved, check_size, solve
from centrode.kinematics.spans import Span
from centrode.structure.dimensions import Dimensions

Array: TypeAlias = npt.NDArray[np.float64]
Nodes: TypeAlias = npt.NDArray[Any]
Lanes: TypeAlias = npt.NDArray[np.intp]
Mask: TypeAlias = npt.NDArray[np.bool_]

WORTH_COMPILING = 200_000
"""Samples, or nodes of the mesh if they are more, of all mechanisms from which on compiling pays."""
AT_ONCE = 256
"""Mechanisms between two reports of progress."""
ORDERED = frozenset({"all_points", "angles", "slides", "spins"})
"""Arrays with the derivatives in front."""
SINES = "sines"
ROOMS = ("all_points", "angles", "slides", "spins", "contacts", "residual")


def solve_many(
    ready: Ready, span: Span, numbers: Dimensions, lanes: int, progress: Progress | None = None
) -> Solved:
    """Motion of a batch at the samples of a span: what `solve` gives."""
    places = max(len(span.parameter), len(mesh_of(ready.kinematics.path, span.parameter)))
    if lanes * places < WORTH_COMPILING or not machine_code.PRESENT:
        return solve(ready, span, numbers, lanes, progress)
    varied = varied_of(numbers, {})
    try:
        plan = traced(ready, span, varied)
    except Untraceable:
        return solve(ready, span, numbers, lanes, progress)
    check_size(plan.solved.layout, lanes, len(span.parameter))
    names = tuple(dict.fromkeys([*varied.names, SCALE]))
    judging = Judging(plan, span.parameter, names, tuple(plan.turning), MACHINE_CODE)
    values = varied.values(numbers)
    if not values:
        return solve(ready, span, numbers, lanes, progress)
    if plan.steps:
        values |= beginnings(ready, numbers, lanes)
    judged = judging.judge(values)
    if np.mean(judged.clear) < 0.5:
        return solve(ready, span, numbers, lanes, progress)
    return _Many(ready, span, numbers, lanes, values | judged.values, plan, judging, judged.clear).solved(
        progress
    )


@dataclass(frozen=True)
class _Many:
    ready: Ready
    span: Span
    numbers: Dimensions
    lanes: int
    values: Mapping[str, Array]
    plan: Traced
    judging: Judging
    clear: Mask

    def solved(self, progress: Progress | None) -> Solved:
        rooms, sure = self._walked(progress) if self.plan.steps else self._written(progress)
        if SINES in rooms:
            self._angles(rooms["angles"], rooms[SINES])
        residual = rooms["residual"]
        clear = self.clear & sure & (residual.max(axis=1) <= 0.5 * CLOSED)
        if SLACK in rooms:
            clear &= rooms[SLACK].min(axis=1) > 0.0
        status = np.full(residual.shape, Status.OK, dtype=np.int8)
        branches = self._branches()
        left = np.nonzero(~clear)[0]
        if len(left):
            self._filled(left, rooms, status, branches)
        points = rooms["all_points"]
        moving = points[:, :, :, len(self.numbers.frame) :]
        return replace(
            self.plan.solved,
            ready=self.ready,
            span=self.span,
            branches=branches,
            all_points=points,
            points=moving,
            angles=rooms["angles"],
            slides=rooms["slides"],
            spins=rooms.get("spins"),
            status=status,
            residual=residual,
            worst_constraint=self._worst(residual),
            contacts=rooms["contacts"],
        )

    def _outputs(self) -> dict[str, Nodes]:
        """What is written: arrays of a Solved of one lane and one sample; cosines stand where angles will."""
        solved = self.plan.solved
        found: dict[str, Nodes | None] = {name: getattr(solved, name) for name in ROOMS}
        if not self.plan.steps:
            angles: Nodes = solved.angles.copy()
            for k, link in enumerate(solved.layout.angles):
                if link in self.plan.turning:
                    angles[0, 0, 0, k] = self.plan.turning[link][0]
            found["angles"] = angles
            found[SINES] = boxed([sine for _cosine, sine in self.plan.turning.values()]).reshape(1, 1, -1)
        slack = self.judging.slack_at_samples
        if slack is not None:
            found[SLACK] = boxed([slack]).reshape(1, 1)
        return {name: nodes for name, nodes in found.items() if nodes is not None}

    def _written(self, progress: Progress | None) -> tuple[dict[str, Array], Mask]:
        """All samples of all mechanisms, each number one stream; arrays as `Solved` has them are views of that."""
        outputs = self._outputs()
        flat = [as_node(x) for nodes in outputs.values() for x in nodes.ravel()]
        graph = Graph({str(k): node for k, node in enumerate(flat)})
        inputs = inputs_of(self.span)
        along = tuple(name for name in inputs if name in graph.variables or name == PARAMETER)
        scan = Scan(along, tuple(name for name in graph.variables if name not in along), graph.outputs)
        run = runner(scan, MACHINE_CODE, lanes_inside=True)
        room = np.empty((len(flat), self.lanes, len(self.span.parameter)))
        of_samples = np.stack([inputs[name] for name in along])
        for rows in self._parts():
            of_lanes = np.stack([self.values[name][rows] for name in scan.inputs]) if scan.inputs else None
            run(of_samples, of_lanes, out=room[:, rows], steps=rows.stop - rows.start)
            if progress is not None:
                progress(rows.stop, self.lanes)
        return _rooms(outputs, room), np.ones(self.lanes, dtype=bool)

    def _walked(self, progress: Progress | None) -> tuple[dict[str, Array], Mask]:
        """The same where every place is found from the one before; and which mechanisms are sure to be right."""
        outputs = self._outputs()
        flat = [as_node(x) for nodes in outputs.values() for x in nodes.ravel()]
        walking = Walking(
            self.judging.walk, outputs=Graph({str(k): node for k, node in enumerate(flat)}).outputs
        )
        way = way_of(self.ready.kinematics.path, inputs_of(self.span))
        room = np.empty((len(flat), self.lanes, len(self.span.parameter)))
        sure = np.empty(self.lanes, dtype=bool)
        for rows in self._parts():
            some = {name: row[rows] for name, row in self.values.items()}
            sure[rows] = walking.written(way, some, MACHINE_CODE, 1, room[:, rows])[SURE] > 0.0
            if progress is not None:
                progress(rows.stop, self.lanes)
        return _rooms(outputs, room), sure

    def _parts(self) -> Iterator[slice]:
        for first in range(0, self.lanes, AT_ONCE):
            yield slice(first, min(first + AT_ONCE, self.lanes))

    def _angles(self, angles: Array, sines: Array) -> None:
        """Angles with their turns where their cosines stand."""
        layout, parameter = self.plan.solved.layout, self.span.parameter
        for k, link in enumerate(self.plan.turning):
            centre, winding = (self.values[of(link)][:, None] for of in (centre_of, winding_of))
            for rows in self._parts():
                angle = angles[0, rows, :, layout.angles.index(link)]
                np.arctan2(sines[rows, :, k], angle, out=angle)
                middle = centre[rows] + winding[rows] * parameter
                turns = whole_turns(middle, angle)
                angle += TURN * turns

    def _branches(self) -> Branches:
        start = self.ready.assembled
        smooth = self.ready.mechanism.assembly.continuation == "smooth"
        return branches_at_start(self.ready.kinematics.path, start.signs, start.angles, smooth, self.lanes)

    def _some(self, lanes: Lanes) -> Solved:
        """Some mechanisms by arrays."""
        numbers = self.numbers.mapped(lambda x: x if isinstance(x, float) else x[lanes])
        return solve(self.ready, self.span, numbers, len(lanes))

    def _filled(
        self, left: Lanes, rooms: dict[str, Array], status: npt.NDArray[np.int8], branches: Branches
    ) -> None:
        """Fill in the mechanisms that are left to the arrays."""
        some = self._some(left)
        for name in ROOMS:
            if name in rooms:
                rooms[name][(slice(None), left) if name in ORDERED else left] = getattr(some, name)
        status[left] = some.status
        branches.events += [replace(event, lane=int(left[event.lane])) for event in some.branches.events]

    def _worst(self, residual: Array) -> Kept:
        """The constraint that is worst of all, as `solve` finds it: in the first of its parts that has the worst."""
        places = max(len(self.span.parameter), len(self.judging.mesh))
        size = max(1, CHUNK // places)
        worst = np.fmax.reduce(residual, axis=1)
        lanes = np.nonzero(worst == np.fmax.reduce(worst))[0]
        first = lanes[:1] if len(lanes) else np.zeros(1, dtype=np.intp)
        return self._some(
            lanes[lanes < (first[0] // size + 1) * size] if len(lanes) else first
        ).worst_constraint


def _rooms(outputs: Mapping[str, Nodes], room: Array) -> dict[str, Array]:
    """Numbers (numbers, lanes, samples) by the names of what they are."""
    found, first = {}, 0
    for name, nodes in outputs.items():
        found[name] = _placed(name, room[first : first + nodes.size], nodes.shape)
        first += nodes.size
    return found


def _placed(name: str, room: Array, shape: tuple[int, ...]) -> Array:
    """Numbers (numbers, lanes, samples) as an array of a shape that has one lane and one sample."""
    lane = 1 if name in ORDERED else 0
    whole = room.reshape(*shape[:lane], *shape[lane + 2 :], *room.shape[1:])
    return np.moveaxis(whole, (-2, -1), (lane, lane + 1))
