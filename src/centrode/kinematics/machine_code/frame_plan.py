"""The plan of one mechanism whose numbers at free paths change, traced and compiled once."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Protocol, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.kinematics.machine_code.event_free_mechanisms import EventScreening
from centrode.kinematics.machine_code.frame_calls import CalledFrames, CalledMemory
from centrode.kinematics.machine_code.frame_kernels import (
    COSINES,
    RESIDUAL,
    SINES,
    SLACK_AT_SAMPLES,
    FrameKernels,
    FrameLayout,
    FrameMemory,
    FreeNumbers,
    Known,
    PlaceScan,
    RoomQuantity,
    closes,
    frame_kernels,
    frame_outputs,
    frame_places,
    frame_scans,
    place_scan,
    room_view,
    sample_places,
)
from centrode.kinematics.machine_code.path_continuation import SURE, Walking, Way, beginnings, way_of
from centrode.kinematics.machine_code.trace import Traced
from centrode.kinematics.machine_code.variables import SCALE, Varied, varied_of
from centrode.kinematics.path import SampleGrid
from centrode.kinematics.preparation import Ready
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.executors import MACHINE_CODE
from centrode.numerics.expressions import Node
from centrode.numerics.graphs import Graph
from centrode.numerics.scans import room_of
from centrode.structure.dimensions import Dimensions, dimensions_of

Array: TypeAlias = npt.NDArray[np.float64]
Given: TypeAlias = Sequence[float]
"""The numbers at the free paths, in their order."""


@dataclass(frozen=True)
class FreeMechanism:
    """A mechanism made ready, its samples, and the paths whose numbers change."""

    ready: Ready
    span: SampleGrid
    paths: tuple[str, ...]

    def dimensions(self, given: Given) -> Dimensions:
        """The numbers of one mechanism as a batch of one. Raises InputError for what no description can have."""
        return dimensions_of(self.ready.mechanism, self._arrays(given), ARRAYS)

    def varied_numbers(self, given: Given) -> Varied:
        """The numbers that change as variables; `given` show which these are."""
        values = self._arrays(given)
        return varied_of(dimensions_of(self.ready.mechanism, values, ARRAYS), values)

    def _arrays(self, given: Given) -> dict[str, Array]:
        return {path: np.array([x]) for path, x in zip(self.paths, given, strict=True)}


class SampleScan(Protocol):
    """Way to compute numbers at all samples of one mechanism."""

    def room(self) -> Array:
        """Memory for the numbers: (numbers, 1, samples)."""

    def fill(self, known: Known, room: Array) -> bool:
        """Fill a room; whether the numbers are certain."""


class FramePlan(Protocol):
    """A plan that moves one mechanism after the other."""

    def memory(self) -> Any:
        """Memory for one thread."""

    def judged_variables(self, given: Given, memory: Any) -> Known | None:
        """The variables of a mechanism that is clear; None of another."""

    def move(self, given: Given, memory: Any) -> bool:
        """Write the motion of a mechanism into the memory; False where it is not clear."""

    def samples_of(self, outputs: Mapping[str, Node]) -> SampleScan:
        """Numbers at the samples, of what `judged_variables` gives."""


# Plans whose samples have nothing to do with one another.


@dataclass(frozen=True)
class DirectPlan:
    """A plan of dyads: every sample is computed for itself."""

    free: FreeMechanism
    numbers: FreeNumbers
    layout: FrameLayout
    kernels: FrameKernels
    executor: str

    @cached_property
    def called_frames(self) -> CalledFrames | None:
        """The calls of machine code; None where kernels are called one by one."""
        return CalledFrames.of(self.numbers, self.kernels) if self.executor == MACHINE_CODE else None

    def memory(self) -> FrameMemory:
        return self.kernels.memory() if self.called_frames is None else self.called_frames.memory()

    def judged_variables(self, given: Given, memory: FrameMemory) -> Known | None:
        known = dict(zip(self.free.paths, given, strict=True))
        if isinstance(memory, CalledMemory):
            assert self.called_frames is not None
            judged = self.called_frames.judged_variables(given, memory)
            return None if judged is None else known | judged
        known |= self.numbers.known(given)
        further = self.kernels.judge.judge(known, memory)
        return None if further is None else known | further

    def move(self, given: Given, memory: FrameMemory) -> bool:
        if isinstance(memory, CalledMemory):
            assert self.called_frames is not None
            return self.called_frames.move(given, memory)
        return self.kernels.move(self.numbers.known(given), memory)

    def samples_of(self, outputs: Mapping[str, Node]) -> SampleScan:
        places, scale = sample_places(self.free.ready, self.free.span), self.numbers.scale
        if scale is not None:
            outputs = Graph(outputs).substitute(scale.outputs).outputs
        return PlaceScan.of(place_scan(outputs, places), places, self.executor)


# Plans whose samples are found from one another, with groups of higher class.


class WalkedMemory:
    """Memory of one thread."""

    def __init__(self, quantities: Sequence[RoomQuantity], count: int, samples: int) -> None:
        self.room = room_of(count, 1, samples)
        self.quantities = {
            quantity.name: room_view(self.room, quantity)
            for quantity in quantities
            if quantity.name not in (COSINES, SINES, SLACK_AT_SAMPLES)
        }
        self.rows = {quantity.name: self.room[quantity.rows, 0] for quantity in quantities}


@dataclass(frozen=True)
class WalkedSamples:
    """Numbers at the samples along the path."""

    plan: WalkedPlan
    walking: Walking
    count: int

    def room(self) -> Array:
        return room_of(self.count, 1, len(self.plan.free.span.parameter))

    def fill(self, known: Known, room: Array) -> bool:
        values = {name: np.asarray([x]) for name, x in known.items()}
        left = self.walking.write_samples(self.plan.way, values, self.plan.executor, 1, room)
        return bool(left[SURE][0] > 0.0)


@dataclass(frozen=True)
class WalkedPlan:
    """A plan with groups of higher class: every sample is found from the one before."""

    free: FreeMechanism
    varied_numbers: Varied
    screening: EventScreening
    executor: str

    @cached_property
    def way(self) -> Way:
        """The way past all samples."""
        return way_of(self.free.ready.kinematics.path, sample_places(self.free.ready, self.free.span))

    @cached_property
    def _written(self) -> tuple[tuple[RoomQuantity, ...], SampleScan, int]:
        quantities, _angles, rows = frame_outputs(self.screening.traced, self.screening.slack_at_samples)
        return quantities, self.samples_of({str(k): node for k, node in enumerate(rows)}), len(rows)

    def memory(self) -> WalkedMemory:
        quantities, _samples, count = self._written
        return WalkedMemory(quantities, count, len(self.free.span.parameter))

    def judged_variables(self, given: Given, memory: WalkedMemory) -> Known | None:
        numbers = self.free.dimensions(given)
        values = self.varied_numbers.values(numbers)
        values |= {path: np.array([x]) for path, x in zip(self.free.paths, given, strict=True)}
        values |= beginnings(self.free.ready, numbers, 1)
        screened = self.screening.judge(values)
        if not screened.clear[0]:
            return None
        return {name: float(x[0]) for name, x in (values | screened.values).items()}

    def move(self, given: Given, memory: WalkedMemory) -> bool:
        known = self.judged_variables(given, memory)
        if known is None or not self._written[1].fill(known, memory.room):
            return False
        rows = memory.rows
        return closes(
            rows[RESIDUAL].max(), rows[SLACK_AT_SAMPLES].min() if SLACK_AT_SAMPLES in rows else None
        )

    def samples_of(self, outputs: Mapping[str, Node]) -> SampleScan:
        return WalkedSamples(self, Walking(self.screening.walk, outputs=outputs), len(outputs))


def screening_of(free: FreeMechanism, traced: Traced, varied: Varied, executor: str) -> EventScreening:
    """What judges mechanisms of a traced plan."""
    names = tuple(dict.fromkeys([*varied.names, *free.paths, SCALE]))
    return EventScreening(traced, free.span.parameter, names, tuple(traced.turning), executor)


def traced_plan(free: FreeMechanism, varied: Varied, traced: Traced, executor: str) -> FramePlan | None:
    """The plan of a trace; None where numbers at a path act on it in a way that is not known."""
    screening = screening_of(free, traced, varied, executor)
    if traced.steps:
        return WalkedPlan(free, varied, screening, executor)
    numbers = FreeNumbers.of(free.paths, varied)
    if numbers is None:
        return None
    places = frame_places(free.ready, free.span)
    scans = frame_scans(screening, places, numbers.scale)
    found = [PlaceScan.of(scan, at, executor) for scan, at in zip(scans.all, places.all, strict=True)]
    kernels = frame_kernels(free.ready, free.span, scans.layout, found)
    return DirectPlan(free, numbers, scans.layout, kernels, executor)
