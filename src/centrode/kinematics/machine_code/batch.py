"""The motions of many mechanisms as machine code where that pays, to the bits of `solve`.

What is not rounded alike everywhere, the arc tangent, stays with NumPy. So a result does not tell how many
mechanisms were computed with it; only what groups of higher class give, and what stands on them, is rounded otherwise.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.errors import Status
from centrode.kinematics.machine_code.event_free_mechanisms import EventScreening, ScreenedEvents
from centrode.kinematics.machine_code.events import Eventful
from centrode.kinematics.machine_code.outputs import (
    RESIDUAL,
    ROOMS,
    SINES,
    Writer,
    nodes_of,
    solved_of,
    streams_of,
)
from centrode.kinematics.machine_code.path_continuation import SURE, Walking, Way, beginnings, way_of
from centrode.kinematics.machine_code.trace import Traced, Untraceable, trace_motion
from centrode.kinematics.machine_code.variables import (
    SCALE,
    TURN,
    Varied,
    box_array,
    centre_of,
    inputs_of,
    take_lanes,
    varied_of,
    whole_turns,
    winding_of,
)
from centrode.kinematics.mesh import mesh_of
from centrode.kinematics.path import SampleGrid
from centrode.kinematics.plan_evaluation import Branches, branches_at_start
from centrode.kinematics.preparation import Ready
from centrode.kinematics.samples import CLOSED, Kept
from centrode.kinematics.solve import CHUNK, Progress, Solved, check_size, solve
from centrode.numerics import machine_code
from centrode.numerics.executors import MACHINE_CODE
from centrode.numerics.expressions import as_node
from centrode.numerics.graphs import Graph
from centrode.numerics.rooms import GivenRoom
from centrode.numerics.scans import LaneExtreme, evaluate
from centrode.structure.dimensions import Dimensions

Array: TypeAlias = npt.NDArray[np.float64]
Nodes: TypeAlias = npt.NDArray[Any]
Lanes: TypeAlias = npt.NDArray[np.intp]
Mask: TypeAlias = npt.NDArray[np.bool_]

WORTH_COMPILING = 200_000
"""Samples, or nodes of the mesh if they are more, of all mechanisms from which on compiling pays."""
WORTH_WALKING = 0.5
"""Share of mechanisms with groups of higher class that have to be clear: arrays compute the others anyway."""
AT_ONCE = 256
"""Mechanisms between two reports of progress."""
SLACK = "slack"


def solve_many(
    ready: Ready,
    span: SampleGrid,
    numbers: Dimensions,
    lanes: int,
    progress: Progress | None = None,
    room: GivenRoom | None = None,
) -> Solved:
    """Motion of a batch at the samples of a span: what `solve` gives, but for angles at hinges on the sphere."""
    # the search for events looks at the mesh, the motion at the samples: the longer of the two says what the
    # work is
    places = max(len(span.parameter), len(mesh_of(ready.kinematics.path, span.parameter)))
    if lanes * places < WORTH_COMPILING or not machine_code.PRESENT:
        return solve(ready, span, numbers, lanes, progress, room)
    varied = varied_of(numbers, {})
    try:
        plan = trace_motion(ready, span, varied)
    except Untraceable:
        return solve(ready, span, numbers, lanes, progress, room)
    check_size(plan.solved.layout, lanes, len(span.parameter))
    names = tuple(dict.fromkeys([*varied.names, SCALE]))
    judging = EventScreening(plan, span.parameter, names, tuple(plan.turning), MACHINE_CODE)
    values = varied.values(numbers)
    writer = Writer(nodes_of(plan), inputs_of(ready.kinematics.path, span), MACHINE_CODE)
    # without varied numbers there is one mechanism; and a plan whose functions a kernel would round must not
    # change bits, save in groups of higher class, where bits hang on Newton's method anyway
    if not values or not (plan.steps or writer.alike):
        return solve(ready, span, numbers, lanes, progress, room)
    if plan.steps:
        values |= beginnings(ready, numbers, lanes)
    judged = judging.judge(values)
    if plan.steps and np.mean(judged.clear) < WORTH_WALKING:
        return solve(ready, span, numbers, lanes, progress, room)
    many = _Many(ready, span, numbers, lanes, varied, values | judged.values, plan, judging, judged)
    return many.solve(progress, room)


@dataclass(frozen=True)
class _Many:
    ready: Ready
    span: SampleGrid
    numbers: Dimensions
    lanes: int
    varied: Varied
    values: Mapping[str, Array]
    plan: Traced
    judging: EventScreening
    judged: ScreenedEvents

    def solve(self, progress: Progress | None, given: GivenRoom | None) -> Solved:
        writer = Writer(
            self._outputs(),
            self._inputs,
            MACHINE_CODE,
            sparing=not self.plan.steps,
            judged=self._lane_extremes,
        )
        room = self._room(writer, given)
        clear = self._write(writer, room, progress)
        arrays = writer.views(room)
        residual = arrays["residual"]
        if SINES in arrays:
            # the arc tangent is NumPy's, so that angles have the bits of `solve`
            self._angles(arrays["angles"], arrays[SINES])
        status = np.full(residual.shape, Status.OK, dtype=np.int8)
        branches = self._branches()
        left = np.nonzero(~clear)[0]
        if len(left):
            self._fill(left, arrays, status, branches)
        solved = solved_of(
            self.plan.solved, arrays, status, ready=self.ready, span=self.span, branches=branches
        )
        return replace(solved, worst_constraint=self._worst(residual))

    def _room(self, writer: Writer, given: GivenRoom | None) -> Array:
        """Memory for what is written; sines stand behind what the result keeps, where room is given for more."""
        room = writer.room(self.lanes, None if given is None else given.left)
        if given is not None:
            kept = sum(nodes.size for name, nodes in writer.outputs.items() if name in ROOMS)
            given.take((kept, *room.shape[1:]))
        return room

    def _outputs(self) -> dict[str, Nodes]:
        nodes, slack = nodes_of(self.plan), self._slack
        # a walk has no extremes over its places
        return nodes if slack is None or not self.plan.steps else {**nodes, SLACK: slack}

    @property
    def _slack(self) -> Nodes | None:
        slack = self.judging.slack_at_samples
        return None if slack is None else box_array([slack]).reshape(1, 1)

    @property
    def _lane_extremes(self) -> dict[str, LaneExtreme]:
        """Extremes over samples, taken while these are written: greatest residual, least slack of radicands."""
        if self.plan.steps:
            return {}
        found = {RESIDUAL: LaneExtreme("maximum", as_node(self.plan.solved.residual[0, 0]), 0.0)}
        if self._slack is not None:
            found[SLACK] = LaneExtreme("minimum", as_node(self._slack[0, 0]), np.inf)
        return found

    @cached_property
    def _inputs(self) -> dict[str, Array]:
        return inputs_of(self.ready.kinematics.path, self.span)

    def _write(self, writer: Writer, room: Array, progress: Progress | None) -> Mask:
        """All samples of all mechanisms, but where none of some is clear; which of them are clear."""
        sure = self.judged.clear.copy()
        walking = Walking(self.judging.walk, outputs=writer.graph.outputs) if self.plan.steps else None
        for rows in self._parts():
            # a part without any clear mechanism is computed with the others that have events
            if sure[rows].any():
                some = {name: row[rows] for name, row in self.values.items()}
                if walking is None:
                    judged = writer.write(some, room[:, rows])
                else:
                    at_end = walking.write_samples(self._way, some, MACHINE_CODE, 1, room[:, rows])
                    sure[rows] &= at_end[SURE] > 0.0
                    judged = self._judge(writer.streams(room[:, rows]))
                # a kernel may round a residual otherwise: half of the bound is kept free, and what lies in it goes
                # to the arrays
                sure[rows] &= judged[RESIDUAL] <= 0.5 * CLOSED
                if SLACK in judged:
                    # any radicand this near to zero has to be compared with its rounding error, which is the arrays'
                    # work
                    sure[rows] &= judged[SLACK] > 0.0
            if progress is not None:
                progress(rows.stop, self.lanes)
        return sure

    def _judge(self, streams: Mapping[str, Array]) -> dict[str, Array]:
        judged = {RESIDUAL: streams[RESIDUAL][0].max(axis=1)}
        return judged if SLACK not in streams else {**judged, SLACK: streams[SLACK][0].min(axis=1)}

    @cached_property
    def _way(self) -> Way:
        return way_of(self.ready.kinematics.path, self._inputs)

    def _parts(self) -> Iterator[slice]:
        for first in range(0, self.lanes, AT_ONCE):
            yield slice(first, min(first + AT_ONCE, self.lanes))

    def _angles(self, angles: Array, sines: Array) -> None:
        """Angles with their turns where their cosines stand."""
        layout, values = self.plan.solved.layout, self.judged.values
        drives = evaluate(Graph.of(self.plan.winders), self._inputs)
        for k, link in enumerate(self.plan.turning):
            for rows in self._parts():
                if not self.judged.clear[rows].any():
                    continue
                angle = angles[0, rows, :, layout.angles.index(link)]
                # the cosines stand in the place of the angles, and are overwritten
                np.arctan2(sines[rows, :, k], angle, out=angle)
                middle = values[centre_of(link)][rows, None]
                for drive, value in drives.items():
                    middle = middle + values[winding_of(link, drive)][rows, None] * value
                turns = whole_turns(middle, angle)
                angle += TURN * turns

    def _branches(self) -> Branches:
        start = self.ready.assembled
        smooth = self.ready.mechanism.assembly.continuation == "smooth"
        return branches_at_start(self.ready.kinematics.path, start.signs, start.angles, smooth, self.lanes)

    def _some(self, lanes: Lanes) -> Solved:
        """Motion of some mechanisms by arrays, (lanes,) their numbers."""
        return solve(self.ready, self.span, take_lanes(self.numbers, lanes), len(lanes))

    def _fill(
        self, left: Lanes, found: dict[str, Array], status: npt.NDArray[np.int8], branches: Branches
    ) -> None:
        """Fill in the mechanisms that have events."""
        for lanes, some in self._with_events(left):
            for name in ROOMS:
                if name in found:
                    streams_of(name, found[name])[..., lanes, :] = streams_of(name, getattr(some, name))
            status[lanes] = some.status
            branches.events += [replace(event, lane=int(lanes[event.lane])) for event in some.branches.events]

    def _with_events(self, left: Lanes) -> Iterator[tuple[Lanes, Solved]]:
        if self.plan.steps or len(left) * self._places < WORTH_COMPILING:
            some = self._some(left)
            opened = (some.status == Status.OPEN).any(axis=1)
            self._events.unclosed.update(left[opened].tolist())  # nobody has looked
            yield left, some
        else:
            yield from self._events.solve_lanes(self.numbers, left)

    @cached_property
    def _events(self) -> Eventful:
        return Eventful(self.ready, self.span, self.varied, self.plan, MACHINE_CODE)

    @property
    def _places(self) -> int:
        return max(len(self.span.parameter), len(self.judging.mesh))

    def _worst(self, residual: Array) -> Kept:
        """The constraint that is worst of all, as `solve` finds it: in the first of its parts that has the worst."""
        # `solve` goes through the batch in parts and reports the constraint of the first part that has the
        # worst residual; here the same part has to be found
        size = max(1, CHUNK // self._places)
        worst = np.fmax.reduce(residual, axis=1)
        lanes = np.nonzero(worst == np.fmax.reduce(worst))[0]
        # Newton's method leaves many at the same last bit; bits are not promised there, so one of them will do
        lanes = lanes[:1] if self.plan.steps else lanes
        first = int(lanes[0]) // size * size if len(lanes) else 0
        # what does not close counts as well, though it has no residual any more
        chosen = np.union1d(lanes, sorted(self._events.unclosed)).astype(np.intp)
        chosen = chosen[(chosen >= first) & (chosen < first + size)]
        return self._some(chosen if len(chosen) else np.zeros(1, dtype=np.intp)).worst_constraint
