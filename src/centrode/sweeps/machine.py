"""Sweeps as machine code: what has no events is computed in one go, the rest as motions with events.

A mechanism is judged on the mesh first, and again at its samples. Those that are clear have the status ok everywhere
and the formulas of `trace_motion`. The motions of all others have the bits of the arrays (`machine_code.events`; with
groups of higher class they are computed by arrays), and what is requested is taken from them as `ArraysExecutor` does.
"""

from __future__ import annotations

import math
import threading
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, Protocol, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.errors import InputError, Status
from centrode.kinematics.machine_code.event_screening import EventScreening
from centrode.kinematics.machine_code.events import Eventful
from centrode.kinematics.machine_code.path_continuation import SURE, Walk, Walking, Way, beginnings, way_of
from centrode.kinematics.machine_code.trace import Traced, Untraceable, trace_motion
from centrode.kinematics.machine_code.variables import (
    ALONG,
    PARAMETER,
    SCALE,
    LaneRows,
    Pass,
    Varied,
    before_of,
    box_array,
    centre_of,
    greatest,
    inputs_of,
    least,
    take_lanes,
    varied_of,
    winding_of,
)
from centrode.kinematics.samples import CLOSED
from centrode.locale import _, mark
from centrode.numerics import machine_code
from centrode.numerics.executors import MACHINE_CODE, streamer
from centrode.numerics.expressions import EXPRESSIONS, Node, Operand, as_node, variable
from centrode.numerics.graphs import Graph
from centrode.numerics.operations import CONSTANT, VARIABLE
from centrode.numerics.rooms import check_room, fresh_room, is_blank
from centrode.numerics.scans import LINE, LaneExtreme, Reduction, Scan, evaluate, room_of, together
from centrode.structure.dimensions import Dimensions
from centrode.sweeps import designs
from centrode.sweeps.arrays import NUMBER, ArraysExecutor, SweepTask, fill_columns
from centrode.sweeps.designs import Rows
from centrode.sweeps.folds import Folds, Known, Slopes
from centrode.sweeps.outputs import OutputFormula, SweepColumn, table_variable

# Outputs of a sweep as expressions: columns of a sample, or of folds over samples, and derivatives.

Array: TypeAlias = npt.NDArray[np.float64]
Values: TypeAlias = dict[str, Array]

m = EXPRESSIONS
RESIDUAL, LENGTHS, SLACK = "worst residual", "worst length", "slack at samples"
CHECKED = 3
"""Samples at which residuals are looked at where closed forms say that a mechanism closes at all of them."""


@dataclass(frozen=True)
class Expressed:
    """A task as expressions.

    Attributes
    ----------
    varied : the numbers that vary as variables
    traced : the motion at one sample
    kernels : what runs scans, see `numerics.executors`
    threads : that share the mechanisms
    """

    task: SweepTask
    varied: Varied
    traced: Traced
    kernels: str
    threads: int

    @cached_property
    def folds(self) -> Folds:
        """Folds over samples, filled when `columns` are first computed."""
        return Folds(len(self.task.span.parameter))

    @cached_property
    def columns(self) -> dict[str, list[Node]]:
        """Column -> its numbers: of a sample, or reduced."""
        asked, solved = self.task.asked, self.traced.solved
        given = {path: box_array([variable(path)]) for path in self.task.paths}
        if asked.formulas:
            given |= {name: box_array([variable(name)]) for name in map(table_variable, asked.tables)}
            before: dict[str, Any] = {}
            return {formula.name: [self._formula(formula, given, before)] for formula in asked.formulas}
        columns = {output.name: output.of(solved, given).ravel().tolist() for output in asked.outputs}
        if asked.reduction is None:
            return {name: [as_node(x) for x in nodes] for name, nodes in columns.items()}
        return {
            name: [as_node(self.folds.fold(asked.reduction, x)) for x in nodes]
            for name, nodes in columns.items()
        }

    def _formula(self, formula: OutputFormula, given: Mapping[str, Any], before: dict[str, Any]) -> Node:
        known = _known_of(formula)
        value = formula.trace(self.folds.within(known), self.traced.solved, given, before)
        # at a sample where a table has no number there is none
        return as_node(known.only(value, math.nan) if known is not None and formula.at_samples else value)

    @cached_property
    def outputs(self) -> dict[str, Node]:
        """All numbers of a sample, column by column as the result has them."""
        return {f"{name} {k}": node for name, nodes in self.written.items() for k, node in enumerate(nodes)}

    @cached_property
    def written(self) -> dict[str, list[Node]]:
        """Column -> its numbers, of those that have a number of every sample."""
        every = self._with_slopes
        return {column.name: every[column.name] for column in streamed_columns(self.task.asked.columns)}

    @cached_property
    def fixed(self) -> dict[int, float]:
        """Of `outputs`: place -> the number that every sample of every mechanism has, as those of fixed points."""
        nodes = enumerate(self.outputs.values())
        return {place: float(node.detail) for place, node in nodes if node.operation == CONSTANT}

    @cached_property
    def slopes(self) -> Slopes:
        """Derivatives of the columns by the varied values; raises Untraceable."""
        return Slopes.of(self.task.paths, self.varied, self.traced, self.folds, self._moving)

    @property
    def _moving(self) -> frozenset[str]:
        """Variables that differ from sample to sample."""
        walked = Walk(self.traced, tuple(self.traced.turning)).state if self.traced.steps else ()
        return frozenset([*self.inputs, *ALONG, *walked])

    @cached_property
    def final(self) -> dict[str, list[Node]]:
        """Reduced columns, and those of derivatives, from the folds."""
        return {name: nodes for name, nodes in self._with_slopes.items() if name not in self.written}

    @cached_property
    def _with_slopes(self) -> dict[str, list[Node]]:
        columns, formulas = (
            dict(self.columns),
            {formula.name: formula for formula in self.task.asked.formulas},
        )
        for name, slope in self.task.asked.slopes.items():
            slopes = [x for node in columns[name] for x in self.slopes.of_node(node).values()]
            known = _known_of(formulas[name]) if name in formulas and formulas[name].at_samples else None
            # where a formula has no number it has no derivative either
            columns[slope] = [x if known is None else as_node(known.only(x, math.nan)) for x in slopes]
        return columns

    @cached_property
    def judging(self) -> EventScreening:
        """Kernels that judge mechanisms before they are computed."""
        residual = as_node(self.traced.solved.residual[0, 0])
        nodes = [node for column in self.columns.values() for node in column]
        nodes += [fold.value for fold in self.folds.found.values()]
        used = frozenset(Graph({str(k): node for k, node in enumerate([*nodes, residual])}).variables)
        # turns follow from the place before on a walk, else by a centre
        told_by = before_of if self.traced.steps else centre_of
        links = tuple(link for link in self.traced.turning if told_by(link) in used)
        names = tuple(dict.fromkeys([*self.varied.names, SCALE]))
        return EventScreening(self.traced, self.task.span.parameter, names, links, self.kernels, self.threads)

    @cached_property
    def judges(self) -> dict[str, Node]:
        """Numbers that are reduced over all samples: greatest residual, least slack of radicands."""
        judges = {RESIDUAL: as_node(self.traced.solved.residual[0, 0])}
        slack = self.judging.slack_at_samples
        return judges if slack is None else {**judges, SLACK: slack}

    @cached_property
    def names(self) -> tuple[str, ...]:
        """All that may be known of mechanisms: their numbers, where angles stand, and what samples left behind."""
        known = [*self.judging.names, *self.task.paths, RESIDUAL]
        known += self._of_angles
        known += [f"largest {group}" for group in self.traced.radicands]
        for fold in self.folds.found.values():
            known.append(fold.name)
            if self.task.asked.slopes:
                known += self.slopes.states_of(fold.name).parts
        return tuple(dict.fromkeys(known))

    @property
    def _of_angles(self) -> list[str]:
        """What is known of angles with their turns: where they stand, and how they wind."""
        return [
            name
            for link in self.judging.links
            for name in (centre_of(link), *(winding_of(link, drive) for drive in self.traced.winders))
        ]

    def functions(self, rows: Mapping[str, Array]) -> Values:
        """Functions of the numbers of mechanisms, which all passes over their samples have in common."""
        return {} if self.traced.steps else self._standing.functions(rows)

    @cached_property
    def _standing(self) -> Pass:
        """What is folded, or where nothing is, the residual: its functions are those that passes have in common."""
        folded = [fold.value for fold in self.folds.found.values()] if self.columns else []
        nodes = folded or [as_node(self.traced.solved.residual[0, 0])]
        state = {f"{END}{k}": node for k, node in enumerate(nodes)}
        names = (*self.judging.names, *self.task.paths)
        return Pass(Reduction(state, dict.fromkeys(state, 0.0)), names, {})

    def check_some(self, rows: Mapping[str, Array]) -> Values:
        """The greatest residual of a few samples, of mechanisms that are certain to close at all of them."""
        return self._checked.run(rows, self.kernels, self.threads)

    @cached_property
    def _checked(self) -> Pass:
        # residuals of gears and wheels have angles with their turns, which are known when samples are checked
        # a residual is no more than rounding, so functions of its own need not be those of NumPy
        names = (*self._over_some.names, *self._of_angles, *self._standing.function_names)
        return replace(self._over_some, names=names, compiled=True)

    @cached_property
    def _over_some(self) -> Pass:
        # the last sample of a whole turn is the first one again, so thirds count from the first
        chosen = np.unique(self.samples * np.arange(CHECKED) // CHECKED)
        residual = greatest(RESIDUAL, as_node(self.traced.solved.residual[0, 0]), 0.0)
        names = (*self.judging.names, *self.task.paths)
        return Pass(residual, names, {name: x[chosen] for name, x in self.inputs.items()})

    @property
    def samples(self) -> int:
        """Number of samples."""
        return len(self.task.span.parameter)

    @cached_property
    def inputs(self) -> Values:
        """Values of the variables of a place at the samples, tables among them: name -> (samples,)."""
        return inputs_of(self.task.ready.kinematics.path, self.task.span) | self._tables

    @property
    def further(self) -> tuple[str, ...]:
        """Names of the inputs that tables give."""
        return tuple(self._tables)

    @cached_property
    def _tables(self) -> Values:
        asked = self.task.asked
        values = {table_variable(name): table.values for name, table in asked.tables.items()}
        for formula in asked.formulas:
            known = _known_of(formula)
            if known is not None and formula.known is not None:
                values[known.name] = formula.known.astype(np.float64)
        return values

    @cached_property
    def way(self) -> Way:
        """The way past all samples, where there are groups of higher class."""
        return way_of(self.task.ready.kinematics.path, self.inputs)

    @property
    def states(self) -> int:
        """Numbers of one mechanism while samples are passed."""
        folds = len(self.folds.found) if self.columns else 0
        if self.task.asked.slopes:
            folds += sum(len(self.slopes.states_of(fold.name).parts) for fold in self.folds.found.values())
        angles = 10 * len(self.judging.links)
        walked = 2 * len(self.judging.walk.state) if self.traced.steps else 0
        # With one drive a link's angle has nine numbers: itself, at the start, its greatest jump, the highest and the
        # lowest of three windings; a further drive adds four. A state of a walk has two, before and after a step; a
        # radicand two at most. The last two are the judges over all samples. Only the number of lanes follows from
        # this, and that is `KERNEL_LANES` up to some 120 numbers.
        return len(self.varied.names) + folds + angles + walked + 2 * len(self.traced.radicands) + 2


def _known_of(formula: OutputFormula) -> Known | None:
    """The samples at which the tables of a formula have numbers; None where that is everywhere."""
    known = formula.known
    # formulas of the same tables share what they fold
    return None if known is None else Known(f"known {' '.join(sorted(formula.tables))}", int(known.sum()))


# How machine code passes samples: each for itself, or along the path where groups of higher class ask for it.

Rooms: TypeAlias = Iterable[tuple[slice, Array]]
"""Some mechanisms after the other, and where their samples go: (numbers, lanes, samples)."""


Reducing: TypeAlias = Callable[[LaneRows], LaneRows]
"""Adds the states when all samples are passed to what is known of mechanisms."""


class Passing(Protocol):
    """Way to pass the samples of mechanisms without events."""

    def reducing(self, reduction: Reduction) -> Reducing:
        """A pass over all samples, for any number of batches."""

    @property
    def fixed(self) -> Mapping[int, float]:
        """Numbers that are not written, as they are the same everywhere: place among all -> number."""

    def write_samples(self, rows: LaneRows, rooms: Rooms) -> Mapping[str, Array]:
        """Write every sample but what is fixed; returns what mechanisms are judged by."""


def passing_of(asked: Expressed) -> Passing:
    """Way to pass the samples of a task: along the path with groups of higher class, else each for itself."""
    return Along(asked) if asked.traced.steps else EachForItself(asked)


@dataclass(frozen=True)
class ResidualParts:
    """The greatest residual of a sample in two parts, so that lengths are divided by the scale once a mechanism.

    A greater number has no lesser quotient, to the last bit: the greatest quotient is that of the greatest length.

    Attributes
    ----------
    without_unit : the greatest of the parts that are not divided
    lengths, scale : dividend and divisor of the part that is; none where there is none
    """

    without_unit: Node
    lengths: Node | None = None
    scale: Node | None = None

    @classmethod
    def of(cls, residual: Node) -> ResidualParts:
        """The parts of a node that is a maximum of some."""
        parts = list(_parts_of_maximum(residual))
        divided = [x for x in parts if x.operation == "divide" and _is_scale(x.arguments[1])]
        if len(divided) != 1:
            return cls(residual)
        without_unit: Operand = 0.0
        for part in parts:
            without_unit = without_unit if part is divided[0] else m.max(without_unit, part)
        return cls(as_node(without_unit), *divided[0].arguments)

    def scale_of(self, rows: Mapping[str, Array]) -> Array | float:
        """The divisor of mechanisms."""
        assert self.scale is not None
        return rows[SCALE] if self.scale.operation == VARIABLE else float(self.scale.detail)


def _parts_of_maximum(node: Node) -> Iterator[Node]:
    if node.operation == "maximum":
        for x in node.arguments:
            yield from _parts_of_maximum(x)
    else:
        yield node


def _is_scale(node: Node) -> bool:
    """Whether it is the greatest length of mechanisms, or a constant above zero as that is."""
    if node.operation == VARIABLE:
        return node.detail == SCALE
    return node.operation == CONSTANT and float(node.detail) > 0.0


@dataclass(frozen=True)
class EachForItself:
    """Nothing is handed on but what is reduced. Every number that is written is one stream."""

    asked: Expressed

    def reducing(self, reduction: Reduction) -> Reducing:
        asked = self.asked
        over_samples = Pass(reduction, asked.names, asked.inputs)

        def reduce(rows: LaneRows) -> LaneRows:
            # where nothing moves the samples are counted all the same
            return over_samples.onto(rows, asked.kernels, asked.threads, steps=asked.samples)

        return reduce

    @property
    def fixed(self) -> Mapping[int, float]:
        return self.asked.fixed

    def write_samples(self, rows: LaneRows, rooms: Rooms) -> Mapping[str, Array]:
        scan = self._scan
        along = np.stack([self.asked.inputs[name] for name in scan.parameters])
        take = streamer(scan, along, self.asked.kernels, self.asked.threads)
        of_mechanisms = np.stack([rows[name] for name in scan.inputs]) if scan.inputs else None
        judged = np.empty((len(scan.extremes), len(next(iter(rows.values())))))
        for part, room in rooms:
            take(None if of_mechanisms is None else of_mechanisms[:, part], room, judged[:, part])
        found = dict(zip(scan.extremes, judged, strict=True))
        if LENGTHS in found:
            with np.errstate(invalid="ignore"):
                lengths = found.pop(LENGTHS) / self._residual.scale_of(rows)
            found[RESIDUAL] = np.maximum(found[RESIDUAL], lengths)
        return found

    @cached_property
    def _residual(self) -> ResidualParts:
        return ResidualParts.of(self.asked.judges[RESIDUAL])

    @cached_property
    def _scan(self) -> Scan:
        """Lanes are samples, steps are mechanisms; judged by extremes over the samples while these are written."""
        asked = self.asked
        written = [(place, x) for place, x in enumerate(asked.outputs.items()) if place not in asked.fixed]
        outputs = dict(x for _place, x in written)
        extremes = {RESIDUAL: LaneExtreme("maximum", self._residual.without_unit, 0.0)}
        if self._residual.lengths is not None:
            extremes[LENGTHS] = LaneExtreme("maximum", self._residual.lengths, 0.0)
        if SLACK in asked.judges:
            extremes[SLACK] = LaneExtreme("minimum", asked.judges[SLACK], math.inf)
        used = Graph({**outputs, **{name: x.value for name, x in extremes.items()}}).variables
        # the parameter stays an input in any case: something has to say how many samples there are
        along = tuple(name for name in asked.inputs if name in used or name == PARAMETER)
        of_mechanisms = tuple(name for name in used if name not in along)
        places = tuple(place for place, _x in written)
        return Scan(along, of_mechanisms, outputs, extremes=extremes, places=places)


@dataclass(frozen=True)
class Along:
    """Every place is found from the one before: what is written is judged on the same way."""

    asked: Expressed
    fixed: Mapping[int, float] = field(default_factory=dict)

    def reducing(self, reduction: Reduction) -> Reducing:
        asked = self.asked
        walking = Walking(asked.judging.walk, reduction, further=asked.further)

        def reduce(rows: LaneRows) -> LaneRows:
            return rows | walking.reduce(asked.way, rows, asked.kernels, asked.threads)

        return reduce

    def write_samples(self, rows: LaneRows, rooms: Rooms) -> Mapping[str, Array]:
        asked = self.asked
        walking = Walking(asked.judging.walk, judging_states(asked), asked.outputs, asked.further)
        parts = []
        for part, room in rooms:
            some = {name: row[part] for name, row in rows.items()}
            parts.append(walking.write_samples(asked.way, some, asked.kernels, asked.threads, room))
        return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}


def judging_states(asked: Expressed) -> Reduction:
    """Greatest residual, least slack of radicands; NaN where one is."""
    judges = asked.judges
    parts = [greatest(RESIDUAL, judges[RESIDUAL], 0.0)]
    if SLACK in judges:
        parts.append(least(SLACK, judges[SLACK]))
    return together(*parts)


# The arrays of a result in memory: what is kept of every sample stands there number by number, as it is
# computed.
#
# A number of a mechanism is one stream of its samples. The result's arrays are views that have the samples in
# front of the numbers; nothing is put in another order.

AnyArray: TypeAlias = npt.NDArray[Any]


class StreamedColumns(dict[str, AnyArray]):
    """Arrays of some mechanisms by name: (mechanisms, ...).

    `streams` is what is kept of every sample, in the order of the columns, where it stands like that in memory:
    (numbers, mechanisms, samples). `blank` says that it is all zeros, which take no pages until they are written to.
    """

    streams: npt.NDArray[np.float64] | None = None
    blank: bool = False

    def part(self, rows: slice) -> StreamedColumns:
        """A view of some mechanisms."""
        chosen = StreamedColumns({name: array[rows] for name, array in self.items()})
        chosen.streams = None if self.streams is None else self.streams[:, rows]
        chosen.blank = self.blank
        return chosen


def streamed_columns(columns: Sequence[SweepColumn]) -> list[SweepColumn]:
    """The columns that have a float64 of every sample."""
    return [column for column in columns if column.at_samples and column.kind == np.float64]


def columns_for(
    columns: Sequence[SweepColumn], mechanisms: int, out: npt.NDArray[np.float64] | None = None
) -> StreamedColumns:
    """Memory for columns, with streams where there is any: fresh, or that of `out`.

    Raises InputError where `out` has too little room, or is no array that numbers can be written to.
    """
    kept = streamed_columns(columns)
    streamed = StreamedColumns(
        # what has no sample dimension is an array of its own, in the order of the result
        {x.name: np.empty((mechanisms, *x.shape), dtype=x.kind) for x in columns if x not in kept}
    )
    if out is not None:
        numbers = mechanisms * sum(math.prod(column.shape) for column in kept)
        if not numbers:
            what = _("nothing is kept of every sample")
            raise InputError("out", what, _("omit it, or request outputs that are not reduced"))
        check_room(out, numbers)
    if kept:
        counts = [math.prod(column.shape[1:]) for column in kept]
        streamed.streams, streamed.blank = _streams((sum(counts), mechanisms, kept[0].shape[0]), out)
        first = 0
        for column, count in zip(kept, counts, strict=True):
            streams = streamed.streams[first : first + count].reshape(
                *column.shape[1:], *streamed.streams.shape[1:]
            )
            # a view with mechanisms and samples in front: nothing is copied
            streamed[column.name] = np.moveaxis(streams, (-2, -1), (0, 1))
            first += count
    return streamed


def _streams(
    shape: tuple[int, int, int], out: npt.NDArray[np.float64] | None
) -> tuple[npt.NDArray[np.float64], bool]:
    """Room for streams, and whether it is blank; fresh memory begins where a line of the cache does."""
    numbers = math.prod(shape)
    if out is not None:
        return out.reshape(-1)[:numbers].reshape(shape), False
    spare = LINE // NUMBER
    whole, blank = fresh_room(numbers + spare)
    first = (-whole.ctypes.data % LINE) // NUMBER
    return whole[first : first + numbers].reshape(shape), blank


HUGE_PAGE = (1 << 21) // NUMBER
"""Numbers on a huge page of most processors."""


# Where every sample of mechanisms without events goes: straight to its place in a result, or by way of a
# buffer.


@dataclass(frozen=True)
class EverySample:
    """The columns of a result that have every sample.

    Attributes
    ----------
    columns : column -> its numbers
    results : column -> (mechanisms, ...)
    at : the mechanisms among these that are written: a whole slice, or their numbers
    samples : how many there are
    fixed : place among all numbers -> number of every sample, which is not filled into rooms
    """

    columns: Mapping[str, Sequence[Node]]
    results: Mapping[str, AnyArray]
    at: Any
    samples: int
    fixed: Mapping[int, float]

    def rooms(self) -> Iterator[tuple[slice, Array]]:
        """Mechanisms and where their samples go, (numbers, lanes, samples); filled before the next is requested."""
        results = self.results
        streams, blank = (
            (results.streams, results.blank) if isinstance(results, StreamedColumns) else (None, False)
        )
        # a whole slice has its place in the result, and is written straight there
        if streams is not None and isinstance(self.at, slice):
            for place, number in self.fixed.items():
                if not (blank and is_blank(number)):
                    streams[place] = number
            for place in range(len(streams)):
                # huge pages that are cleared one stream after the other are cleared faster than in turns
                if blank and place not in self.fixed:
                    streams[place].reshape(-1)[::HUGE_PAGE] = 0.0
            yield slice(0, streams.shape[1]), streams
            return
        numbers = sum(map(len, self.columns.values()))
        places = np.arange(len(self.results["samples_ok"]))[self.at]
        size = max(1, designs.KERNEL_BUFFER // (NUMBER * numbers * self.samples))
        buffer = room_of(numbers, min(size, len(places)), self.samples)
        # as many mechanisms as the buffer holds, which stays in the cache
        for first in range(0, len(places), size):
            where = places[first : first + size]
            room = buffer[:, : len(where)]
            yield slice(first, first + size), room
            self._put(room, where)

    def _put(self, room: Array, where: npt.NDArray[np.intp]) -> None:
        place = 0
        for name, nodes in self.columns.items():
            target = self.results[name].reshape(*self.results[name].shape[:2], len(nodes))
            for k in range(len(nodes)):
                # number by number, as streams come; the target has them side by side
                target[where, :, k] = self.fixed.get(place, room[place])
                place += 1


Mask: TypeAlias = npt.NDArray[np.bool_]
Lanes: TypeAlias = npt.NDArray[np.intp]

END = "end of "
"""Before the name of a number of a column: what the last states make of it."""
WORTH_A_KERNEL = 2_000_000
"""Operations on numbers from which on what is left to do at the end is worth compiling."""
COPIES = 4
"""Of what a mechanism has while samples are passed: before, after, as kernels are given it."""


@dataclass(frozen=True)
class MachineCodeExecutor:
    """Compiled kernels of one task.

    Attributes
    ----------
    task : what is computed
    asked : the outputs as expressions
    threads : that share the mechanisms
    kernels : "machine code"; "arrays" runs the same scans on NumPy
    """

    task: SweepTask
    asked: Expressed
    threads: int
    kernels: str
    _foldings: dict[tuple[int, bool], Reducing] = field(default_factory=dict)
    _one_at_a_time: threading.Lock = field(default_factory=threading.Lock)
    blocks = designs.BLOCKS_OF_KERNELS
    arrays = ArraysExecutor()

    @property
    def name(self) -> str:
        return self.kernels

    @classmethod
    def of(
        cls, task: SweepTask, numbers: Dimensions, values: Rows, threads: int = 1, kernels: str = MACHINE_CODE
    ) -> MachineCodeExecutor:
        """The executor of a task; the numbers of one mechanism or more say what varies.

        Raises Untraceable, with a reason for the user.
        """
        # reported before anything is traced
        check_present(kernels)
        varied = varied_of(numbers, values).with_traced_scale()
        asked = Expressed(
            task,
            varied,
            trace_motion(task.ready, task.span, varied, differentiable=bool(task.asked.slopes)),
            kernels,
            threads,
        )
        if task.asked.slopes:
            _ = asked.slopes  # what cannot be differentiated is told before anything is computed
        return cls(task, asked, threads, kernels)

    def lanes(self, task: SweepTask) -> int:
        """Number of mechanisms computed together."""
        # a mechanism that is written takes the room of its columns beside its states
        written = 0 if task.asked.is_reduced else sum(column.bytes for column in task.asked.columns)
        return max(
            1,
            min(designs.KERNEL_LANES, designs.WORKING_SET // (COPIES * NUMBER * self.asked.states + written)),
        )

    def run(
        self, task: SweepTask, numbers: Dimensions, values: Rows, results: Mapping[str, AnyArray]
    ) -> None:
        """Fill in all columns for the mechanisms of these dimensions."""
        known = self.asked.varied.values(numbers) | {path: np.asarray(x) for path, x in values.items()}
        if self.asked.traced.steps:
            known |= beginnings(task.ready, numbers, len(next(iter(known.values()))))
        rows = LaneRows.of(known | self.asked.functions(known), self._spare)
        judged = self.asked.judging.judge(rows)
        rows = rows | judged.values
        # mechanisms that turn out doubtful at a sample are taken out again below
        clear = judged.clear.copy()
        # every sample that is kept has its residual judged; of reduced ones that are certain a few do
        certain = judged.certain if self.task.asked.is_reduced else np.zeros_like(clear)
        for which, sure in ((certain, True), (judged.clear & ~certain, False)):
            if which.any():
                everywhere = bool(which.all())
                at: Any = slice(None) if everywhere else np.nonzero(which)[0]
                some = rows if everywhere else rows.take(at)
                clear[at] = self._without_events(some, at, results, sure)
        left = np.nonzero(~clear)[0]
        if not len(left):
            return
        # few mechanisms with events are not worth a kernel of their own
        worth = len(left) * task.places >= designs.WORTH_COMPILING and self.kernels == MACHINE_CODE
        if worth and self._eventful.possible:
            self._with_events(left, numbers, values, results)
        else:
            self._on_arrays(left, numbers, values, results)

    @cached_property
    def _eventful(self) -> Eventful:
        task, asked = self.task, self.asked
        return Eventful(task.ready, task.span, asked.varied, asked.traced, self.kernels, self.threads)

    def _with_events(
        self, left: Lanes, numbers: Dimensions, values: Rows, results: Mapping[str, AnyArray]
    ) -> None:
        """Fill in the mechanisms that have events: their motions as machine code, columns as by arrays."""
        # an executor is kept, so two sweeps may share it; what is written for one part is overwritten by the next
        with self._one_at_a_time:
            for lanes, solved in self._eventful.solve_lanes(numbers, left):
                parts = self._room(len(lanes))
                fill_columns(self.task, solved, _rows_at(values, lanes), parts)
                _put_columns(parts, lanes, results)

    def _on_arrays(
        self, left: Lanes, numbers: Dimensions, values: Rows, results: Mapping[str, AnyArray]
    ) -> None:
        """Fill in mechanisms that have events by arrays alone: for a few of them nothing is compiled."""
        most = self.arrays.lanes(self.task)
        for first in range(0, len(left), most):
            lanes = left[first : first + most]
            parts = self._room(len(lanes))
            self.arrays.run(self.task, take_lanes(numbers, lanes), _rows_at(values, lanes), parts)
            _put_columns(parts, lanes, results)

    def _room(self, lanes: int) -> StreamedColumns:
        """Columns of mechanisms that do not stand side by side."""
        return columns_for(self.task.asked.columns, lanes)

    # without events

    @cached_property
    def _passing(self) -> Passing:
        return passing_of(self.asked)

    def _without_events(
        self, rows: LaneRows, at: Any, results: Mapping[str, AnyArray], certain: bool
    ) -> Mask:
        """Fill in clear mechanisms; returns which of them stay clear at their samples too."""
        states = (
            self._fill_reductions(rows, at, results, certain)
            if self.task.asked.is_reduced
            else self._fill_samples(rows, at, results)
        )
        results["samples_ok"][at] = self.asked.samples
        results["worst_residual"][at] = states[RESIDUAL]
        # a kernel may round a residual otherwise: half of the bound is kept free, and what lies in it goes to
        # the arrays
        clear: Mask = states[RESIDUAL] <= 0.5 * CLOSED
        for slack in {SLACK, SURE} & states.keys():
            clear &= states[slack] > 0.0
        return clear

    def _fill_reductions(
        self, rows: LaneRows, at: Any, results: Mapping[str, AnyArray], certain: bool
    ) -> LaneRows:
        """Fill in one number, or a few, of each motion; returns what is known of mechanisms then."""
        columns = self.asked.final
        # folds of folds: each pass knows the results of those before
        for depth in range(self.asked.folds.passes):
            rows = self._folding(depth, certain)(rows)
        if certain:
            rows = rows | self.asked.check_some(rows)
        values = self._at_end(rows)
        for name, numbers in columns.items():
            flat = results[name].reshape(len(results[name]), len(numbers))
            for k in range(len(numbers)):
                flat[at, k] = values[f"{END}{name} {k}"]
        return rows

    def _at_end(self, rows: LaneRows) -> Values:
        """The numbers of all columns from the last states; by a kernel where that is worth compiling."""
        graph, lanes = self._ends, len(next(iter(rows.values())))
        if lanes * len(graph.order) < WORTH_A_KERNEL:
            return evaluate(graph, rows)
        return self._at_once.run(rows, self.kernels, self.threads)

    @cached_property
    def _at_once(self) -> Pass:
        outputs = self._ends.outputs
        return Pass(Reduction(outputs, dict.fromkeys(outputs, 0.0)), self.asked.names, {})

    @cached_property
    def _ends(self) -> Graph:
        columns = self.asked.final.items()
        return Graph({f"{END}{name} {k}": node for name, nodes in columns for k, node in enumerate(nodes)})

    def _folding(self, depth: int, certain: bool) -> Reducing:
        """One of the passes over the samples; the same for all batches."""
        key = depth, certain
        if key not in self._foldings:
            self._foldings[key] = self._passing.reducing(self._states(depth, certain))
        return self._foldings[key]

    @cached_property
    def _spare(self) -> int:
        """Rows that passes over the samples add to what is known of mechanisms."""
        if not self.asked.columns:
            return 0
        return sum(len(self._states(depth, False).state) for depth in range(self.asked.folds.passes))

    def _states(self, depth: int, certain: bool) -> Reduction:
        """States handed on in a pass over the samples."""
        folds = self.asked.folds.at_depth(depth)
        parts = [fold.state for fold in folds]
        if self.task.asked.slopes:
            parts += [self.asked.slopes.of_fold(fold) for fold in folds]
        # judging is done with the first pass; what is certain has no sample to be judged
        if depth == 0 and not certain:
            parts.append(judging_states(self.asked))
        return together(*parts)

    def _fill_samples(self, rows: LaneRows, at: Any, results: Mapping[str, AnyArray]) -> Mapping[str, Array]:
        """Fill in every sample of the motions; returns what mechanisms are judged by."""
        results["status"][at] = Status.OK
        # formulas of every sample may name what is folded
        if self.asked.final or self.asked.folds.found:
            rows = self._fill_reductions(rows, at, results, certain=False)
            # what is written is judged as it is written
            judged = {RESIDUAL, SLACK, SURE}
            rows = replace(rows, more={name: row for name, row in rows.more.items() if name not in judged})
        every = EverySample(self.asked.written, results, at, self.asked.samples, self._passing.fixed)
        return self._passing.write_samples(rows, every.rooms())


def check_present(kernels: str) -> None:
    """Raise Untraceable where machine code is requested and llvmlite is not installed."""
    if kernels == MACHINE_CODE and not machine_code.PRESENT:
        raise Untraceable(mark("llvmlite is not installed"))


def _rows_at(values: Rows, lanes: Lanes) -> Rows:
    return {path: np.asarray(x)[lanes] for path, x in values.items()}


def _put_columns(parts: StreamedColumns, lanes: Lanes, results: Mapping[str, AnyArray]) -> None:
    for name, part in parts.items():
        results[name][lanes] = part
