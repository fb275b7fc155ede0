"""The motions of many mechanisms: those without events as machine code where that pays, to the bits of `solve`.

What is not rounded alike everywhere, the arc tangent, stays with NumPy. So a result does not tell how many
mechanisms were computed with it.
"""

from __future__ import annotations

from collections.abc import Iterator
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
from centrode.kinematics.compiled.judging import Judged, Judging
from centrode.kinematics.compiled.traced import (
    TURN,
    WHOLE,
    Traced,
    Untraceable,
    centre_of,
    traced,
    winding_of,
)
from centrode.kinematics.compiled.variables import PARAMETER, SCALE, Varied, boxed, inputs_of, varied_of
from centrode.kinematics.mesh import mesh_of
from centrode.kinematics.ready import Ready
from centrode.kinematics.residuals import CLOSED, Kept
from centrode.kinematics.solve import CHUNK, Progress, Solved, check_size, solve
from centrode.kinematics.spans import Span
from centrode.structure.dimensions import Dimensions

Array: TypeAlias = npt.NDArray[np.float64]
Nodes: TypeAlias = npt.NDArray[Any]
Lanes: TypeAlias = npt.NDArray[np.intp]

WORTH_COMPILING = 200_000
"""Samples, or nodes of the mesh if they are more, of all mechanisms from which on compiling pays."""
AT_ONCE = 256
"""Mechanisms between two reports of progress."""
ORDERED = frozenset({"all_points", "angles", "slides", "spins"})
"""Arrays with the derivatives in front."""
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
    judged = judging.judge(values)
    if np.mean(judged.clear) < 0.5:
        return solve(ready, span, numbers, lanes, progress)
    return _Many(ready, span, numbers, lanes, varied, plan, judging, judged).solved(progress)


@dataclass(frozen=True)
class _Many:
    ready: Ready
    span: Span
    numbers: Dimensions
    lanes: int
    varied: Varied
    plan: Traced
    judging: Judging
    judged: Judged

    def solved(self, progress: Progress | None) -> Solved:
        rooms, sines, slack = self._written(progress)
        self._angles(rooms["angles"], sines)
        residual = rooms["residual"]
        clear = self.judged.clear & (residual.max(axis=1) <= 0.5 * CLOSED)
        if slack is not None:
            clear &= slack.min(axis=1) > 0.0
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
        angles: Nodes = solved.angles.copy()
        for k, link in enumerate(solved.layout.angles):
            if link in self.plan.turning:
                angles[0, 0, 0, k] = self.plan.turning[link][0]
        found: dict[str, Nodes | None] = {name: getattr(solved, name) for name in ROOMS}
        found["angles"] = angles
        found["sines"] = boxed([sine for _cosine, sine in self.plan.turning.values()]).reshape(1, 1, -1)
        slack = self.judging.slack_at_samples
        if slack is not None:
            found["slack"] = boxed([slack]).reshape(1, 1)
        return {name: nodes for name, nodes in found.items() if nodes is not None}

    def _written(self, progress: Progress | None) -> tuple[dict[str, Array], Array, Array | None]:
        """All samples of all mechanisms, each number one stream; arrays as `Solved` has them are views of that."""
        outputs = self._outputs()
        flat = [as_node(x) for nodes in outputs.values() for x in nodes.ravel()]
        graph = Graph({str(k): node for k, node in enumerate(flat)})
        inputs = inputs_of(self.span)
        along = tuple(name for name in inputs if name in graph.variables or name == PARAMETER)
        scan = Scan(along, tuple(name for name in graph.variables if name not in along), graph.outputs)
        run = runner(scan, MACHINE_CODE, lanes_inside=True)
        room = np.empty((len(flat), self.lanes, len(self.span.parameter)))
        values = self.varied.values(self.numbers) | self.judged.values
        of_samples = np.stack([inputs[name] for name in along])
        for rows in self._parts():
            of_lanes = np.stack([values[name][rows] for name in scan.inputs]) if scan.inputs else None
            run(of_samples, of_lanes, out=room[:, rows], steps=rows.stop - rows.start)
            if progress is not None:
                progress(rows.stop, self.lanes)
        found, first = {}, 0
        for name, nodes in outputs.items():
            found[name] = _placed(name, room[first : first + nodes.size], nodes.shape)
            first += nodes.size
        return found, found["sines"], found.get("slack")

    def _parts(self) -> Iterator[slice]:
        for first in range(0, self.lanes, AT_ONCE):
            yield slice(first, min(first + AT_ONCE, self.lanes))

    def _angles(self, angles: Array, sines: Array) -> None:
        """Angles with their turns where their cosines stand."""
        layout, parameter = self.plan.solved.layout, self.span.parameter
        for k, link in enumerate(self.plan.turning):
            centre, winding = (self.judged.values[of(link)][:, None] for of in (centre_of, winding_of))
            for rows in self._parts():
                angle = angles[0, rows, :, layout.angles.index(link)]
                np.arctan2(sines[rows, :, k], angle, out=angle)
                middle = centre[rows] + winding[rows] * parameter
                turns = ((middle - angle) * (1.0 / TURN) + WHOLE) - WHOLE
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


def _placed(name: str, room: Array, shape: tuple[int, ...]) -> Array:
    """Numbers (numbers, lanes, samples) as an array of a shape that has one lane and one sample."""
    lane = 1 if name in ORDERED else 0
    whole = room.reshape(*shape[:lane], *shape[lane + 2 :], *room.shape[1:])
    return np.moveaxis(whole, (-2, -1), (lane, lane + 1))
