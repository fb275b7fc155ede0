"""Initial value problems as machine code: loops over lanes, steps and stages around the problem's expressions.

The derivatives stand in the code once, whatever the number of stages, so it is built fast; the sums over stages are
loops over vectors of whatever is followed. Lanes of a vector take their steps each with its own size, and wait where
they have arrived. One mechanism alone is a vector of one lane; then the sums run over several things followed at
once.
"""

from __future__ import annotations

import threading
from collections import OrderedDict
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from centrode.numerics.dormand_prince import FIFTH, STAGES, THIRD, A, B, C
from centrode.numerics.expressions import Node, variable
from centrode.numerics.graphs import Graph
from centrode.numerics.initial_value_problems import (
    BEFORE,
    END,
    HEADER,
    OF_FIFTH,
    OF_THIRD,
    SIZE,
    SMALLEST,
    STEP,
    TAKEN,
    TIME,
    InitialValueProblem,
)
from centrode.numerics.machine_code.compile import Loaded, in_haste, standing
from centrode.numerics.machine_code.functions import Operating
from centrode.numerics.machine_code.kernels import address, compiled_function
from centrode.numerics.machine_code.language import Block, Code, Value, Vector
from centrode.numerics.machine_code.loops import ARGUMENTS, FUNCTION
from centrode.numerics.operations import VARIABLE

Array = npt.NDArray[np.float64]

REMEMBERED = 64
"""Integrations kept in memory; the one that was longest not requested goes first."""
_remembered: OrderedDict[tuple[Any, ...], Integration] = OrderedDict()
_one_at_a_time = threading.Lock()


"""Rows of a state before what is carried: time, size of the next step, attempts, rows that were written."""


@dataclass(frozen=True)
class Integration:
    """A problem as machine code.

    Attributes
    ----------
    problem : what it integrates
    width : lanes of a vector
    """

    problem: InitialValueProblem
    width: int
    function: Loaded

    def run(self, parameters: Array, state: Array, attempts: int, rows: Array | None = None) -> Array:
        """Attempts from a state, lane by lane, until the end of each.

        Parameters
        ----------
        parameters : (parameters, lanes)
        state : (HEADER + carried, lanes): time, size of the next step, two counts, and what is carried
        attempts : how many at most
        rows : (n, 1 + carried), written with the times and what is carried after each step; of one lane alone

        Returns
        -------
        The state after these attempts; with `rows` no more than that many steps are taken.
        """
        count, lanes = len(self.problem.carried_names) + HEADER, state.shape[1]
        if state.shape[0] != count or len(parameters) != len(self.problem.parameters):
            raise ValueError(
                f"expected {len(self.problem.parameters)} parameters and {count} rows of a state"
            )
        if rows is not None and (lanes != 1 or self.width != 1 or rows.shape[1] != count - HEADER + 1):
            raise ValueError("rows are written of one lane alone")
        short = max(0, self.width - lanes)
        given = np.ascontiguousarray(parameters, np.float64)
        before = np.ascontiguousarray(state, np.float64)
        if short:
            given, before = (np.pad(one, ((0, 0), (0, short)), mode="edge") for one in (given, before))
        if given.shape[1] != before.shape[1]:
            given = np.ascontiguousarray(np.broadcast_to(given[:, :1], (len(given), before.shape[1])))
        after = np.empty_like(before)
        written = rows if rows is not None else np.empty((0, 1))
        self.function.call(
            before.shape[1], attempts, address(given), given.strides[0] // 8, 0, 0,
            address(before), before.strides[0] // 8, address(after), after.strides[0] // 8,
            address(written), len(written), written.shape[1],
        )  # fmt: skip
        return after[:, :lanes]

    def attempt_of(self, parameters: Array, before: Array, after: Array) -> Callable[[], None]:
        """A function that takes one attempt from a state into another: each call reads all three arrays anew.

        Parameters
        ----------
        parameters : (parameters, 1)
        before, after : (HEADER + carried, 1)

        All are contiguous, and stay where they are. Nothing is checked or copied, as events try many ends of a step.
        """
        if self.width != 1 or not all(one.flags.c_contiguous for one in (parameters, before, after)):
            raise ValueError("one attempt is that of one lane, in contiguous arrays")
        none = np.empty((0, 1))
        places = [address(one) for one in (parameters, before, after, none)]
        call = self.function.call

        def attempt(_kept: tuple[Array, ...] = (parameters, before, after, none)) -> None:
            call(1, 1, places[0], 1, 0, 0, places[1], 1, places[2], 1, places[3], 0, 1)

        return attempt


def integration_of(
    problem: InitialValueProblem, width: int | None = None, hasty: bool = False
) -> Integration:
    """The machine code of a problem, from memory or disk if it has been compiled before; `width` lanes at once.

    `hasty` code is waited for: built in half the time, somewhat slower.
    """
    machine = in_haste(standing()) if hasty else standing()
    lanes = machine.width(64) if width is None else width
    key = (problem.key, lanes, machine)
    with _one_at_a_time:
        if key in _remembered:
            _remembered.move_to_end(key)
            return _remembered[key]
    text = _IntegrationWriter(problem, lanes, machine.width(64), machine.has_fma).text()
    made = Integration(problem, lanes, compiled_function(text, machine))
    with _one_at_a_time:
        _remembered[key] = made
        while len(_remembered) > REMEMBERED:
            _remembered.popitem(last=False)
    return made


class _IntegrationWriter:
    def __init__(self, problem: InitialValueProblem, width: int, chunk: int, has_fma: bool) -> None:
        self.problem, self.width, self.block = problem, width, Block()
        self.code = Code(self.block, Vector("double", width), has_fma)
        # the sums over stages take as many numbers at once as a register holds
        self.wide = Code(self.block, Vector("double", width if width > 1 else chunk), has_fma)
        numbers = len(problem.unknowns) * width
        self.length = -(-numbers // self.wide.vector.width) * self.wide.vector.width
        graphs = (problem.of_rates, problem.of_closing, problem.of_control)
        # everything may be rounded once where a product is summed: nothing is decided by a last bit
        self.fused = frozenset(node for graph in graphs for node in graph.order)
        self.known: dict[Node, Value] = {}
        self.single = width == 1

    def text(self) -> str:
        self._body()
        tables = {"c": C}
        return "\n".join(
            [
                *self.block.declared,
                *(_table(name, numbers) for name, numbers in tables.items()),
                f"define void @{FUNCTION}({', '.join(ARGUMENTS)}) {{",
                "entry:",
                *self.block.lines,
                "}",
                '!0 = !{!"branch_weights", i32 1, i32 1000000}',
                "",
            ]
        )

    # memory

    def _room(self, name: str, numbers: int) -> None:
        self.block.line(f"%{name} = alloca [{numbers} x double], align 64")

    def _at(self, array: Value, index: Value | int) -> Value:
        return self.block.put(f"getelementptr double, ptr {array}, i64 {index}")

    def _load(self, place: Value, code: Code | None = None) -> Value:
        vector = (code or self.code).vector
        return self.block.put(f"load {vector.name}, ptr {place}, align 8")

    def _store(self, value: Value, place: Value, code: Code | None = None) -> None:
        self.block.line(f"store {(code or self.code).vector.name} {value}, ptr {place}, align 8")

    def _splat(self, scalar: Value, vector: Vector) -> Value:
        one = self.block.put(f"insertelement {vector.name} poison, double {scalar}, i32 0")
        return self.block.put(
            f"shufflevector {vector.name} {one}, {vector.name} poison, <{vector.width} x i32> zeroinitializer"
        )

    def _entry(self, table: str, index: Value) -> Value:
        return self.block.put(f"load double, ptr {self._at(f'@{table}', index)}, align 8")

    def _widened_value(self, value: Value) -> Value:
        """A number of the lanes as the sums take it."""
        if not self.single:
            return value
        return self._splat(
            self.block.put(f"extractelement {self.code.vector.name} {value}, i32 0"), self.wide.vector
        )

    @contextmanager
    def _loop(self, name: str, count: Value | int) -> Iterator[Value]:
        """A loop from 0 to a count that may be zero; gives the counter."""
        block, before = self.block, self.block.label
        head, body, done = (block.name(f"{name}.{part}") for part in ("head", "body", "done"))
        counter = block.name(f"%{name}")
        block.line(f"br label %{head}")
        block.begin(head)
        place = len(block.lines)
        more = block.put(f"icmp slt i64 {counter}, {count}")
        block.line(f"br i1 {more}, label %{body}, label %{done}")
        block.begin(body)
        yield counter
        following = block.put(f"add i64 {counter}, 1")
        block.line(f"br label %{head}")
        block.lines.insert(place, f"  {counter} = phi i64 [ 0, %{before} ], [ {following}, %{block.label} ]")
        block.begin(done)

    # the loops

    def _body(self) -> None:
        block, problem, width = self.block, self.problem, self.width
        for name in ("now", "stage", "fifth", "third"):
            self._room(name, self.length)
        self._room("rates", STAGES * self.length)
        self._room("fixed", max(1, len(problem.fixed_names) * width))
        self._room("time", width)
        self._room("size", width)
        for name in ("now", "rates"):
            size = (STAGES if name == "rates" else 1) * self.length
            with self._loop("zero", size) as k:
                block.line(f"store double 0.0, ptr {self._at(f'%{name}', k)}, align 8")
        blocks = block.put(f"add i64 %lanes, {width - 1}")
        blocks = block.put(f"sdiv i64 {blocks}, {width}")
        with self._loop("lanes", blocks) as number:
            first = block.put(f"mul i64 {number}, {width}")
            last = block.put(f"sub i64 %lanes, {width}")
            beyond = block.put(f"icmp sgt i64 {first}, {last}")
            # the last block is moved back until it ends with the lanes
            lane = block.put(f"select i1 {beyond}, i64 {last}, i64 {first}")
            self._lanes(lane)
        block.line("ret void")

    def _row(self, array: str, number: int, lane: Value) -> Value:
        offset = self.block.put(f"mul i64 {number}, %{array.removesuffix('s')}_row")
        return self._at(f"%{array}", self.block.put(f"add i64 {offset}, {lane}"))

    def _lanes(self, lane: Value) -> None:
        block, problem, width = self.block, self.problem, self.width
        self.known = {
            variable(name): self._load(self._row("parameters", k, lane))
            for k, name in enumerate(problem.parameters)
        }
        self._compute_early()
        self._store(self._load(self._row("state", 0, lane)), "%time")
        self._store(self._load(self._row("state", 1, lane)), "%size")
        followed = len(problem.unknowns)
        for k in range(len(problem.carried_names)):
            value = self._load(self._row("state", HEADER + k, lane))
            array, place = ("%now", k) if k < followed else ("%fixed", k - followed)
            self._store(value, self._at(array, place * width))
        attempts, rows = self._attempts()
        self._store(self._load("%time"), self._row("new_state", 0, lane))
        self._store(self._load("%size"), self._row("new_state", 1, lane))
        for k, count in ((2, attempts), (3, rows)):
            number = block.put(f"sitofp i64 {count} to double")
            self._store(self._splat(number, self.code.vector), self._row("new_state", k, lane))
        for k in range(len(problem.carried_names)):
            array, place = ("%now", k) if k < followed else ("%fixed", k - followed)
            self._store(self._load(self._at(array, place * width)), self._row("new_state", HEADER + k, lane))

    def _attempts(self) -> tuple[Value, Value]:
        """The loop over attempts; returns how many there were, and how many rows were written."""
        block, code, problem = self.block, self.code, self.problem
        before = block.label
        head, body, done = (block.name(f"attempt.{part}") for part in ("head", "body", "done"))
        attempt, written = block.name("%attempt"), block.name("%written")
        block.line(f"br label %{head}")
        block.begin(head)
        place = len(block.lines)
        time, size = self._load("%time"), self._load("%size")
        left = code.subtract(self.known[variable(END)], time)
        if problem.limit:
            limit = self._load(self._fixed_value(problem.limit))
            size = code.select(code.compare("olt", limit, size), limit, size)
        cut = code.compare("olt", left, size)
        step = code.select(cut, left, size)
        under_way = code.logical(
            "and",
            code.compare("ogt", left, code.constant(0.0)),
            code.compare("ogt", size, self.known[variable(SMALLEST)]),
        )
        if problem.guard:
            free = code.compare("oeq", self._load(self._fixed_value(problem.guard)), code.constant(0.0))
            under_way = code.logical("and", under_way, free)
        # a lane that waits takes steps of no length
        step = code.select(under_way, step, code.constant(0.0))
        going = block.put(f"icmp slt i64 {attempt}, %steps")
        some = self._any(under_way)
        more = block.put(f"and i1 {going}, {some}")
        if self.single:
            room = block.put(f"icmp slt i64 {written}, %output")
            unwritten = block.put("icmp eq i64 %output, 0")
            more = block.put(f"and i1 {more}, {block.put(f'or i1 {room}, {unwritten}')}")
        block.line(f"br i1 {more}, label %{body}, label %{done}")
        block.begin(body)
        self._stages(time, step)
        taken, further = self._control(step, size)
        self._store(further, "%size")
        then, after = block.name("closing"), block.name("closed")
        some = self._any(taken)
        stay = block.label
        block.line(f"br i1 {some}, label %{then}, label %{after}")
        block.begin(then)
        # at the end itself the time is that of the end, not what sums of rounded steps make of it
        later = code.select(cut, self.known[variable(END)], code.add(time, step))
        reached = code.select(taken, later, time)
        self._store(reached, "%time")
        self._close(later, step, taken)
        total = self._write(reached, written) if self.single else written
        took = block.label
        block.line(f"br label %{after}")
        block.begin(after)
        rows = block.put(f"phi i64 [ {written}, %{stay} ], [ {total}, %{took} ]")
        following = block.put(f"add i64 {attempt}, 1")
        block.line(f"br label %{head}")
        block.lines[place:place] = [
            f"  {attempt} = phi i64 [ 0, %{before} ], [ {following}, %{block.label} ]",
            f"  {written} = phi i64 [ 0, %{before} ], [ {rows}, %{block.label} ]",
        ]
        block.begin(done)
        return attempt, written

    def _any(self, condition: Value) -> Value:
        truth = f"i{self.width}"
        bits = self.block.put(f"bitcast {self.code.vector.truth} {condition} to {truth}")
        return self.block.put(f"icmp ne {truth} {bits}, 0")

    def _stages(self, time: Value, step: Value) -> None:
        """Rates of all stages, then the values behind the step and the estimates of its error."""
        wide = self._widened_value(step)
        with self._loop("stages", STAGES) as stage:
            self._sum_of_stage(stage, wide)
            share = self._splat(self._entry("c", stage), self.code.vector)
            at = self.code.multiply_add(share, step, time)
            values = {variable(TIME): at, **self._read("%stage")}
            operating = self._operating(values)
            first = self.block.put(f"mul i64 {stage}, {self.length}")
            base = self._at("%rates", first)
            self._compute(operating, self.problem.of_rates, base)
        self._step_sum(B, wide)
        with self._chunks() as place:
            rates = self._used_rates(place, FIFTH, THIRD)
            for weights, array in ((FIFTH, "%fifth"), (THIRD, "%third")):
                self._store(self._weighted_sum(weights, rates), self._at(array, place), self.wide)

    def _sum_of_stage(self, stage: Value, step: Value) -> None:
        """Values at which a stage has its rates: code of its own for each, without weights that are zero."""
        block = self.block
        names = [block.name("sum.stage") for _stage in range(STAGES)]
        done = block.name("sum.done")
        cases = " ".join(f"i64 {k}, label %{name}" for k, name in enumerate(names[:-1]))
        block.line(f"switch i64 {stage}, label %{names[-1]} [ {cases} ]")
        for name, weights in zip(names, A, strict=True):
            block.begin(name)
            self._step_sum(weights, step)
            block.line(f"br label %{done}")
        block.begin(done)

    def _step_sum(self, weights: Sequence[float], step: Value) -> None:
        """Put now + step times the sum of weights times rates of stages into the values of a stage."""
        wide = self.wide
        with self._chunks() as place:
            total = self._load(self._at("%now", place), wide)
            rates = self._used_rates(place, weights)
            if rates:
                total = wide.multiply_add(step, self._weighted_sum(weights, rates), total)
            self._store(total, self._at("%stage", place), wide)

    @contextmanager
    def _chunks(self) -> Iterator[Value]:
        """A loop over whatever is followed, as much at once as a register holds; gives the place in an array."""
        width = self.wide.vector.width
        with self._loop("chunk", self.length // width) as chunk:
            yield self.block.put(f"mul i64 {chunk}, {width}")

    def _used_rates(self, place: Value, *weights: Sequence[float]) -> dict[int, Value]:
        """Rates at a place of the stages that have a weight."""
        found = {}
        for stage in range(STAGES):
            if any(stage < len(row) and row[stage] for row in weights):
                at = self._at("%rates", self.block.put(f"add i64 {place}, {stage * self.length}"))
                found[stage] = self._load(at, self.wide)
        return found

    def _weighted_sum(self, weights: Sequence[float], rates: Mapping[int, Value]) -> Value:
        """The sum over stages of weights times rates."""
        wide = self.wide
        total: Value | None = None
        for stage, rate in rates.items():
            if weights[stage]:
                weight = wide.constant(weights[stage])
                total = (
                    wide.multiply(weight, rate) if total is None else wide.multiply_add(weight, rate, total)
                )
        assert total is not None
        return total

    def _control(self, step: Value, size: Value) -> tuple[Value, Value]:
        """Whether the step is taken, and the size of the next."""
        values = {variable(STEP): step, variable(SIZE): size, **self._read("%stage")}
        wanted = set(self.problem.of_control.variables)
        for prefix, array in ((OF_FIFTH, "%fifth"), (OF_THIRD, "%third"), (BEFORE, "%now")):
            for k, name in enumerate(self.problem.unknowns):
                if prefix + name in wanted:
                    values[variable(prefix + name)] = self._load(self._at(array, k * self.width))
        operating = self._operating(values)
        graph = self.problem.of_control
        for node in graph.order:
            if node not in operating.values:
                operating.compute(node)
        taken = operating.value(graph.outputs[TAKEN])
        condition = self.code.compare("ogt", taken, self.code.constant(0.5))
        return condition, operating.value(graph.outputs[SIZE])

    def _fixed_value(self, name: str) -> Value:
        return self._at("%fixed", self.problem.fixed_names.index(name) * self.width)

    def _close(self, time: Value, step: Value, taken: Value) -> None:
        """What the step ends with, in the lanes that took it."""
        values = {variable(TIME): time, variable(STEP): step, **self._read("%stage")}
        operating = self._operating(values)
        graph, followed = self.problem.of_closing, len(self.problem.unknowns)
        for node in graph.order:
            if node not in operating.values:
                operating.compute(node)
        for k, name in enumerate(self.problem.carried_names):
            array, place = ("%now", k) if k < followed else ("%fixed", k - followed)
            at = self._at(array, place * self.width)
            value = operating.value(graph.outputs[name])
            if not self.single:
                value = self.code.select(taken, value, self._load(at))
            self._store(value, at)

    def _write(self, time: Value, written: Value) -> Value:
        """A row of the time and what is carried, if rows are wanted."""
        block = self.block
        wanted = block.put("icmp sgt i64 %output, 0")
        before, then, after = block.label, block.name("write"), block.name("written")
        block.line(f"br i1 {wanted}, label %{then}, label %{after}")
        block.begin(then)
        first = block.put(f"mul i64 {written}, %output_row")
        row = self._at("%outputs", first)
        self._store(time, row)
        followed = len(self.problem.unknowns)
        for k in range(len(self.problem.carried_names)):
            array, place = ("%now", k) if k < followed else ("%fixed", k - followed)
            self._store(self._load(self._at(array, place)), self._at(row, k + 1))
        total = block.put(f"add i64 {written}, 1")
        block.line(f"br label %{after}")
        block.begin(after)
        return block.put(f"phi i64 [ {written}, %{before} ], [ {total}, %{then} ]")

    # expressions

    def _read(self, array: Value) -> dict[Node, Value]:
        values = {
            variable(name): self._load(self._at(array, k * self.width))
            for k, name in enumerate(self.problem.unknowns)
        }
        for k, name in enumerate(self.problem.fixed_names):
            values[variable(name)] = self._load(self._at("%fixed", k * self.width))
        return values

    def _operating(self, values: Mapping[Node, Value]) -> Operating:
        operating = Operating(self.code, self.fused)
        operating.values.update(self.known)
        operating.values.update(values)
        return operating

    def _compute(self, operating: Operating, graph: Graph, base: Value) -> None:
        """The outputs of a graph, each stored as soon as it is known."""
        places: dict[Node, list[int]] = {}
        for k, name in enumerate(self.problem.unknowns):
            places.setdefault(graph.outputs[name], []).append(k)
        for node in graph.order:
            if node not in operating.values:
                operating.compute(node)
            for k in places.get(node, ()):
                self._store(operating.value(node), self._at(base, k * self.width))

    def _compute_early(self) -> None:
        """What depends on parameters alone, once for the lanes."""
        operating = Operating(self.code, self.fused)
        operating.values.update(self.known)
        graphs = (self.problem.of_rates, self.problem.of_closing, self.problem.of_control)
        for node in _independent(graphs, set(self.problem.parameters)):
            if node not in operating.values:
                operating.compute(node)
        self.known = dict(operating.values)


def _independent(graphs: Sequence[Graph], names: set[str]) -> list[Node]:
    """Nodes that depend on parameters alone, conditions left out."""
    found: dict[Node, None] = {}
    for graph in graphs:
        for node in graph.order:
            if node.operation == VARIABLE:
                if node.detail in names:
                    found[node] = None
            elif all(x in found or not (x.arguments or x.operation == VARIABLE) for x in node.arguments):
                found[node] = None
    return list(found)


def _table(name: str, numbers: Sequence[float]) -> str:
    words = ", ".join(Vector("double", 1).constant(x)[1:-1] for x in numbers)
    return f"@{name} = private unnamed_addr constant [{len(numbers)} x double] [{words}], align 64"
