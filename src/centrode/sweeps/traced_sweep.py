"""A sweep as expressions, and passes over its samples.

Outputs are columns of a sample, or of folds over samples, and derivatives. Machine code passes samples each for
itself, or along the path where groups of higher class ask for it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, Protocol, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.kinematics.machine_code.event_free_mechanisms import EventScreening
from centrode.kinematics.machine_code.path_continuation import Walk, Walking, Way, way_of
from centrode.kinematics.machine_code.trace import Traced
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
    winding_of,
)
from centrode.numerics.executors import streamer
from centrode.numerics.expressions import EXPRESSIONS, Node, Operand, as_node, variable
from centrode.numerics.graphs import Graph
from centrode.numerics.operations import CONSTANT
from centrode.numerics.scans import LaneExtreme, Reduction, Scan, evaluate, together
from centrode.sweeps.arrays import SweepTask
from centrode.sweeps.folds import NUMBER_OF_SAMPLE, Folds, Known, Slopes
from centrode.sweeps.outputs import OutputFormula, table_variable
from centrode.sweeps.result_columns import streamed_columns

Array: TypeAlias = npt.NDArray[np.float64]
Values: TypeAlias = dict[str, Array]

m = EXPRESSIONS
RESIDUAL, LENGTHS, SLACK = "worst residual", "worst length", "slack at samples"
END = "end of "
"""Before the name of a number of a column: what the last states make of it."""
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
        return {
            f"{name} {k}": node
            for name, nodes in self.written_columns.items()
            for k, node in enumerate(nodes)
        }

    @cached_property
    def written_columns(self) -> dict[str, list[Node]]:
        """Column -> its numbers, of those that have a number of every sample."""
        every = self._with_slopes
        return {column.name: every[column.name] for column in streamed_columns(self.task.asked.columns)}

    @cached_property
    def fixed_numbers(self) -> dict[int, float]:
        """Of `outputs`: place -> the number that every sample of every mechanism has, as those of fixed points."""
        nodes = enumerate(self.outputs.values())
        return {place: float(node.detail) for place, node in nodes if node.operation == CONSTANT}

    @cached_property
    def slopes(self) -> Slopes:
        """Derivatives of the columns by the varied values; raises Untraceable."""
        # along a path more than inputs moves, and places of a walk are no samples
        inputs = frozenset() if self.traced.steps else frozenset(self.inputs)
        return Slopes.of(self.task.paths, self.varied, self.traced, self.folds, self._moving, inputs)

    @property
    def _moving(self) -> frozenset[str]:
        """Variables that differ from sample to sample."""
        walked = Walk(self.traced, tuple(self.traced.turning)).state if self.traced.steps else ()
        return frozenset([*self.inputs, *ALONG, *walked])

    @cached_property
    def final(self) -> dict[str, list[Node]]:
        """Reduced columns, and those of derivatives, from the folds."""
        return {name: nodes for name, nodes in self._with_slopes.items() if name not in self.written_columns}

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
                states = self.slopes.states_of(fold.name)
                known += [*states.parts, *states.there]
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
        return self._check_pass.run(rows, self.kernels, self.threads)

    @cached_property
    def _check_pass(self) -> Pass:
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
        numbers = {NUMBER_OF_SAMPLE: np.arange(float(self.samples))} if self.task.asked.slopes else {}
        return inputs_of(self.task.ready.kinematics.path, self.task.span) | numbers | self._tables

    def inputs_at_extremes(self, rows: Mapping[str, Array], depth: int) -> Values:
        """Inputs of the samples at which the extremes of a pass are, by the names that derivatives have them under."""
        found: Values = {}
        for fold in self.folds.at_depth(depth) if self.task.asked.slopes else ():
            states = self.slopes.states_of(fold.name)
            if states.there:
                sample = rows[states.sample].astype(np.intp)
                found |= {own: self.inputs[name][sample] for own, name in states.there.items()}
        return found

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


Rooms: TypeAlias = Iterable[tuple[slice, Array]]
"""Some mechanisms after the other, and where their samples go: (numbers, lanes, samples)."""


Reducing: TypeAlias = Callable[[LaneRows], LaneRows]
"""Adds the states when all samples are passed to what is known of mechanisms."""


class Passing(Protocol):
    """Way to pass the samples of mechanisms without events."""

    def reducer_of(self, reduction: Reduction) -> Reducing:
        """A pass over all samples, for any number of batches."""

    @property
    def fixed_numbers(self) -> Mapping[int, float]:
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
    def of(cls, residual: Node, scale: Operand) -> ResidualParts:
        """The parts of a node that is a maximum of some; `scale` is the greatest length of mechanisms."""
        parts = list(_parts_of_maximum(residual))
        divided = [x for x in parts if x.operation == "divide" and x.arguments[1] is as_node(scale)]
        if len(divided) != 1:
            return cls(residual)
        rest = _greatest_of(_without_zeros([part for part in parts if part is not divided[0]]))
        lengths, by = divided[0].arguments
        return cls(rest, _greatest_of(_without_zeros(list(_parts_of_maximum(lengths)))), by)

    def scale_of(self, rows: Mapping[str, Array]) -> Array | float:
        """The divisor of mechanisms."""
        assert self.scale is not None
        found: Array | float = evaluate(Graph({SCALE: self.scale}), rows)[SCALE]
        return found


def _parts_of_maximum(node: Node) -> Iterator[Node]:
    if node.operation == "maximum":
        for x in node.arguments:
            yield from _parts_of_maximum(x)
    else:
        yield node


def _greatest_of(parts: Sequence[Node]) -> Node:
    greatest: Operand = 0.0
    for part in parts:
        greatest = m.max(greatest, part)
    return as_node(greatest)


CARRYING = frozenset({"add", "subtract", "multiply", "negate", "abs"})
"""Operations whose result is not finite where an argument is not."""


def _without_zeros(parts: Sequence[Node]) -> list[Node]:
    """The parts of a greatest residual but those that are zero by construction, as those of the crank's own end.

    Such a part tells only whether its number is finite. It is left out where another part is not finite either then.
    """
    own = {part: _taken_from_itself(part) for part in parts}
    stack = [part for part, number in own.items() if number is None]
    carried = set(stack)
    while stack:
        node = stack.pop()
        below = [x for x in node.arguments if x not in carried] if node.operation in CARRYING else []
        carried.update(below)
        stack += below
    return [part for part, number in own.items() if number is None or number not in carried]


def _taken_from_itself(part: Node) -> Node | None:
    """The number x of |x - x| or |x - (0 + x)|; None of any other part."""
    if part.operation != "abs" or part.arguments[0].operation != "subtract":
        return None
    x, y = part.arguments[0].arguments
    if y.operation == "add":
        zeros = [z for z in y.arguments if z.operation == CONSTANT and float(z.detail) == 0.0]
        y = next((z for z in y.arguments if zeros and z is not zeros[0]), y)
    return x if x is y else None


@dataclass(frozen=True)
class EachForItself:
    """Nothing is handed on but what is reduced. Every number that is written is one stream."""

    asked: Expressed

    def reducer_of(self, reduction: Reduction) -> Reducing:
        asked = self.asked
        over_samples = Pass(reduction, asked.names, asked.inputs)

        def reduce(rows: LaneRows) -> LaneRows:
            # where nothing moves the samples are counted all the same
            return over_samples.onto(rows, asked.kernels, asked.threads, steps=asked.samples)

        return reduce

    @property
    def fixed_numbers(self) -> Mapping[int, float]:
        return self.asked.fixed_numbers

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
        return ResidualParts.of(self.asked.judges[RESIDUAL], self.asked.varied.scale)

    @cached_property
    def _scan(self) -> Scan:
        """Lanes are samples, steps are mechanisms; judged by extremes over the samples while these are written."""
        asked = self.asked
        written = [
            (place, x) for place, x in enumerate(asked.outputs.items()) if place not in asked.fixed_numbers
        ]
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
    fixed_numbers: Mapping[int, float] = field(default_factory=dict)

    def reducer_of(self, reduction: Reduction) -> Reducing:
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
