"""A scan as one function in LLVM's language: two loops around the operations of its graph.

With the steps inside, a block of lanes is taken through all steps and the state stays in registers. With the
lanes inside, every step runs along all lanes, so that each output is written as one stream; there is no state
then, and a graph may be computed in stages, one loop behind the other over a piece of the lanes. What depends on
the outer loop alone is computed there. The last block of lanes overlaps the one before, so that no lane needs a
mask; the caller sees to it that there are as many lanes as a vector has.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from centrode.numerics.expressions import Node, Operand, variable
from centrode.numerics.graphs import Graph, rebuilt, split_graph
from centrode.numerics.machine_code.functions import Operating
from centrode.numerics.machine_code.language import Block, Code, Value, Vector
from centrode.numerics.operations import CONSTANT, VARIABLE
from centrode.numerics.scans import Array, Call, Scan, evaluate, room_of

# Rows of numbers in memory, and loops along them, in LLVM's language.

LANE = "%lane"
"""Names of lanes' loop variables begin so; `%lanes` is how many there are."""


class ColumnRows:
    """Reads and writes rows at the place where a loop stands.

    Attributes
    ----------
    block : where to
    vector : the type of what is read and written
    at : the first lane of the vector
    """

    def __init__(self, block: Block, vector: Vector) -> None:
        self.block, self.vector = block, vector
        self.at: Value = ""

    def row(self, array: str, i: int, stride: str) -> Value:
        """Where the i-th row of an array begins."""
        return self.place(array, self.block.put(f"mul i64 {i}, {stride}"))

    def place(self, row: Value, index: Value) -> Value:
        """Where a number of a row is."""
        return self.block.put(f"getelementptr {self.vector.number}, ptr {row}, i64 {index}")

    def read(self, place: Value) -> Value:
        """The vector that begins at a place."""
        # aligned as one number only: the last block of lanes begins wherever its end demands
        return self.block.put(f"load {self.vector.name}, ptr {place}, align {self.vector.bits // 8}")

    def write(self, value: Value, place: Value) -> None:
        """Write a vector to a place."""
        self.block.line(f"store {self.vector.name} {value}, ptr {place}, align {self.vector.bits // 8}")

    def fetch(self, place: Value, ahead: int) -> None:
        """Have memory so many bytes behind a place brought near, as it is written to soon."""
        index = str(8 * ahead // self.vector.bits)
        self.block.declared["declare void @llvm.prefetch.p0(ptr, i32, i32, i32)"] = None
        # for a write, kept in all caches, data
        self.block.line(f"call void @llvm.prefetch.p0(ptr {self.place(place, index)}, i32 1, i32 3, i32 1)")

    def everywhere(self, place: Value) -> Value:
        """Vector with one number of memory in every lane."""
        vector, block = self.vector, self.block
        # one load and a shuffle: the number of a step is the same for all lanes
        scalar = block.put(f"load {vector.number}, ptr {place}, align {vector.bits // 8}")
        first = block.put(f"insertelement {vector.name} poison, {vector.number} {scalar}, i32 0")
        lanes = f"<{vector.width} x i32> zeroinitializer"
        return block.put(f"shufflevector {vector.name} {first}, {vector.name} poison, {lanes}")

    def stand(self, axis: str) -> None:
        """Where the loop stands: the first lane of a block, moved back at the end."""
        if axis.startswith(LANE):
            # the last block is moved back until it ends with the lanes: some are computed twice, to the same
            # bits
            last = self.block.put(f"sub i64 %lanes, {self.vector.width}")
            beyond = self.block.put(f"icmp sgt i64 {axis}, {last}")
            self.at = self.block.put(f"select i1 {beyond}, i64 {last}, i64 {axis}")

    def advance(self, axis: str, end: Value, again: str, done: str) -> None:
        """The end of a loop: on to the next lanes, or to the next step."""
        stride = self.vector.width if axis.startswith(LANE) else 1
        self.block.line(f"{axis}.next = add i64 {axis}, {stride}")
        more = self.block.put(f"icmp slt i64 {axis}.next, {end}")
        self.block.line(f"br i1 {more}, label %{again}, label %{done}")

    def counter_line(self, axis: str, first: Value, before: str, after: str) -> str:
        """The line at a loop's head that says where it stands."""
        return f"  {axis} = phi i64 [ {first}, %{before} ], [ {axis}.next, %{after} ]"


# A graph in stages, each of which gets a loop over the lanes of its own.
#
# An arc tangent is a long chain of operations. Beside all others it takes registers and hides how little the
# numbers of two vectors have to wait for each other; in a loop of its own the processor has several under
# way.

LONG = frozenset({"atan2"})
MOST_LEFT = 32
"""Numbers that stages may leave for later ones; more, and waiting for memory costs what the loops gain."""


@dataclass(frozen=True)
class LoopStage:
    """Nodes that one loop computes.

    Attributes
    ----------
    nodes : in order, variables included
    left : of these, what later stages take
    """

    nodes: tuple[Node, ...]
    left: tuple[Node, ...]


def stages_of(order: Sequence[Node]) -> list[LoopStage]:
    """Nodes in stages: each arc tangent, and what hangs on it, behind all that hangs on none."""
    numbers = _numbers(order)
    count = max(numbers.values(), default=0) + 1
    # sorted by stage, so that the last stage that takes a node is what stays in the dictionary
    last_use = {x: numbers[node] for node in sorted(order, key=numbers.__getitem__) for x in node.arguments}
    waiting = [x for x in order if x.arguments and last_use.get(x, 0) > numbers[x]]
    # what waits is written as a number, and a condition is none
    if count == 1 or len(waiting) > MOST_LEFT or any(x.is_condition for x in waiting):
        return [LoopStage(tuple(order), ())]
    stages = []
    for number in range(count):
        nodes = tuple(node for node in order if numbers[node] == number)
        stages.append(LoopStage(nodes, tuple(x for x in waiting if numbers[x] == number)))
    return stages


def _numbers(order: Sequence[Node]) -> dict[Node, int]:
    """Which stage a node belongs to."""
    numbers: dict[Node, int] = {}
    longs = 0
    for node in order:
        number = max((numbers[x] for x in node.arguments if x in numbers), default=0)
        if node.operation in LONG:
            # each arc tangent begins a stage of its own; what is computed from it follows there
            longs += 1
            number = longs
        numbers[node] = number
    return numbers


# What may be rounded otherwise than on NumPy: operations that no status depends on.
#
# Whether something closes, which branch is taken and which side is chosen hangs on the last bit of radicands,
# divisors and compared numbers; all that these are computed from stays as it is. Of the rest, products and the
# sums behind them may be rounded once, and quotients by a common divisor become products with its reciprocal
# (which is infinite for a subnormal divisor: there, and only there, NaN may come out for a quotient of zeros).

DECISIVE = {
    "sqrt": slice(None), "log": slice(None), "power": slice(None), "atan2": slice(None),
    "divide": slice(1, None), "less": slice(None), "less_equal": slice(None),
    "equal": slice(None), "not_equal": slice(None),
}  # fmt: skip
"""Arguments whose last bit may decide; minimum, maximum and the like are continuous in theirs."""


def behind_decisions(graph: Graph) -> frozenset[Node]:
    """Nodes that no decision depends on: a last bit of theirs changes values, never statuses."""
    exact: set[Node] = set()
    # backwards: whatever is computed towards an exact number has to be exact as well
    for node in reversed(graph.order):
        exact.update(node.arguments if node in exact else _decisive(node))
    return frozenset(node for node in graph.order if node not in exact)


def _decisive(node: Node) -> tuple[Node, ...]:
    if node.operation not in DECISIVE or (node.is_condition and node.arguments[0] is node.arguments[1]):
        return ()  # a number compared with itself tells only whether it is one
    return node.arguments[DECISIVE[node.operation]]


def with_reciprocals(scan: Scan, inner: Sequence[str]) -> Scan:
    """The scan with products in the place of quotients, where one reciprocal serves several.

    `inner` are the variables of the inner loop: a reciprocal that does not depend on them serves all its turns.
    """
    free = behind_decisions(scan.graph)
    quotients = [x for x in scan.graph.order if x.operation == "divide" and x in free]
    times = Counter(node.arguments[1] for node in quotients)
    changing = _inner_loop_nodes(scan.graph, {*inner, *scan.state})

    def product(node: Node, arguments: tuple[Node, ...]) -> Operand | None:
        if node.operation != "divide" or node not in free:
            return None
        divisor = node.arguments[1]
        # a reciprocal that serves one quotient pays only where the inner loop repeats it; of a constant over
        # what stands still the whole quotient is computed outside that loop
        alone = times[divisor] == 1 and (divisor in changing or node.arguments[0].operation == CONSTANT)
        return None if alone else arguments[0] * (1.0 / arguments[1])

    return scan.with_graph(Graph(rebuilt(scan.graph.outputs, product)), scan.parameters, scan.inputs)


def _inner_loop_nodes(graph: Graph, names: set[str]) -> set[Node]:
    """Nodes that depend on variables of the inner loop."""
    inner: set[Node] = set()
    for node in graph.order:
        if (node.operation == VARIABLE and node.detail in names) or any(x in inner for x in node.arguments):
            inner.add(node)
    return inner


FUNCTION = "centrode_scan"
ARGUMENTS = (
    "i64 %lanes", "i64 %steps",
    "ptr noalias %parameters", "i64 %parameter_row", "ptr noalias %inputs", "i64 %input_row",
    "ptr noalias %state", "i64 %state_row", "ptr noalias %new_state", "i64 %new_state_row",
    "ptr noalias %outputs", "i64 %output", "i64 %output_row",
)  # fmt: skip
"""Rows are distances, in numbers, of one row from the next; `output` is that of one output from the next."""
AHEAD = 512
"""Bytes by which streams of outputs are fetched before they are written: with many of them that saves waiting."""
PIECE = 64
"""Lanes that a stage goes through before the next one: what waits in between stays in the nearest cache."""


@dataclass(frozen=True)
class LoopShape:
    """Order of the loops that carry out a scan.

    Attributes
    ----------
    vector : the type of its vectors
    has_fma : whether the machine rounds a product and a sum at once
    lanes_inside : whether the inner loop runs over lanes, else over steps
    relaxed : whether operations behind all decisions may be rounded otherwise
    own_functions : whether functions of lanes' numbers are computed here, not on NumPy
    """

    vector: Vector
    has_fma: bool
    lanes_inside: bool
    relaxed: bool
    own_functions: bool = False


def function_text(scan: Scan, shape: LoopShape) -> str:
    """The scan as a module in LLVM's language, with the function `FUNCTION`."""
    return _LoopWriter(scan, shape).text()


class _LoopWriter:
    def __init__(self, scan: Scan, shape: LoopShape) -> None:
        self.scan, self.shape, self.block = scan, shape, Block()
        self.code = Code(self.block, shape.vector, shape.has_fma)
        fused = behind_decisions(scan.graph) if shape.relaxed else frozenset()
        self.operating = Operating(self.code, fused)
        self.rows = ColumnRows(self.block, shape.vector)

    def text(self) -> str:
        self._loops()
        block = self.block
        return "\n".join(
            [
                *block.declared,
                f"define void @{FUNCTION}({', '.join(ARGUMENTS)}) {{",
                "entry:",
                *block.lines,
                "}",
                # weights say that lanes beyond the own reduction are rare, so that the common way is laid out
                # straight
                '!0 = !{!"branch_weights", i32 1, i32 1000000}',
                "",
            ]
        )

    def _loops(self) -> None:
        block, inside = self.block, self.shape.lanes_inside
        outer = "%step" if inside else "%lane"
        of_inner = self.scan.parameters if inside else (*self.scan.inputs, *self.scan.state)
        # the outer loop computes all that does not change inside; outputs among it are written inside all the
        # same
        early = self._independent_of(of_inner)
        rest = [node for node in self.scan.graph.order if node not in early]
        stages = stages_of(rest) if inside else [LoopStage(tuple(rest), ())]
        left = self._room(stages)
        self._extremes = self._room_of_extremes()
        bases = self._begin_rows()
        block.line("br label %outer")
        block.begin("outer")
        # phi instructions have to stand first in a block, and what they carry has no name yet: they are put
        # in afterwards
        head = len(block.lines)
        self.rows.stand(outer)
        self._begin_extremes()
        self._take(outer)
        self._compute([node for node in self.scan.graph.order if node in early])
        if len(stages) == 1:
            self._loop("%lane" if inside else "%step", rest, bases, early)
        else:
            self._pieces(stages, bases, early, left)
        block.begin("outer_end")
        self._write_state()
        self._write_extremes()
        self.rows.advance(outer, "%lanes" if outer == "%lane" else "%steps", "outer", "end")
        block.begin("end")
        block.line("ret void")
        # what a loop carries is known only at its end
        block.lines[head:head] = [self.rows.counter_line(outer, "0", "entry", "outer_end")]

    def _begin_rows(self) -> list[Value]:
        """Where rows begin, known before the loops; returns that of the outputs."""
        scan, row = self.scan, self.rows.row
        self._parameters = [row("%parameters", i, "%parameter_row") for i in range(len(scan.parameters))]
        self._inputs = [row("%inputs", i, "%input_row") for i in range(len(scan.inputs))]
        self._states = [row("%state", i, "%state_row") for i in range(len(scan.state))]
        return [row("%outputs", i, "%output") for i in scan.rows]

    def _loop(self, axis: str, nodes: list[Node], bases: list[Value], early: set[Node]) -> None:
        """The inner loop, with all that is left to compute."""
        block = self.block
        before = block.label
        block.line("br label %inner")
        block.begin("inner")
        head = len(block.lines)
        self.rows.stand(axis)
        self._take(axis)
        places = self._places(bases)
        # an output that stands still over the inner loop has its number in every lane
        self._write([node for node in places if node in early], places)
        self._compute(nodes, places)
        after = block.label
        self.rows.advance(axis, "%lanes" if axis == "%lane" else "%steps", "inner", "outer_end")
        block.lines[head:head] = [
            self.rows.counter_line(axis, "0", before, after), *self._carried_state(before, after)
        ]  # fmt: skip

    def _room(self, stages: list[LoopStage]) -> dict[Node, int]:
        """Where on the stack the numbers wait that stages leave for later ones."""
        left = [node for stage in stages for node in stage.left]
        if left:
            self.block.line(f"%waiting = alloca [{PIECE * len(left)} x {self.shape.vector.number}], align 64")
        return {node: PIECE * i for i, node in enumerate(left)}

    def _pieces(
        self, stages: list[LoopStage], bases: list[Value], early: set[Node], left: dict[Node, int]
    ) -> None:
        """Lanes piece by piece, with a loop for each stage."""
        block = self.block
        before = block.label
        block.line("br label %piece")
        block.begin("piece")
        head = len(block.lines)
        block.line(f"%piece.next = add i64 %first, {PIECE}")
        more = block.put("icmp slt i64 %piece.next, %lanes")
        # the last piece ends with the lanes
        end = block.put(f"select i1 {more}, i64 %piece.next, i64 %lanes")
        known = dict(self.operating.values)
        for i, stage in enumerate(stages):
            # vectors of one stage are gone in the next: it knows what the outer loop computed, and reads what
            # waits
            self.operating = self.operating.with_values(known)
            # outputs of the outer loop are written once, with the first stage
            done = early if i == 0 else set()
            self._stage(i, stage, end, bases, done, left)
        block.line(f"br i1 {more}, label %piece, label %outer_end")
        block.lines[head:head] = [
            f"  %first = phi i64 [ 0, %{before} ], [ %piece.next, %{block.label} ]"
        ]  # fmt: skip

    def _stage(
        self,
        i: int,
        stage: LoopStage,
        end: Value,
        bases: list[Value],
        early: set[Node],
        left: dict[Node, int],
    ) -> None:
        """Write the loop of one stage over one piece of the lanes."""
        block, lane = self.block, f"%lane{i}"
        before = block.label
        block.line(f"br label %stage{i}")
        block.begin(f"stage{i}")
        head = len(block.lines)
        self.rows.stand(lane)
        self._take(lane)
        from_first = block.put(f"sub i64 {lane}, %first")
        own = set(stage.nodes)
        taken = {x for node in stage.nodes for x in node.arguments}
        for node, place in left.items():
            if node in taken and node not in own:
                self.operating.values[node] = self.rows.read(self._waiting(place, from_first))
        places = self._places(bases)
        self._write([node for node in places if node in early], places)
        self._compute(list(stage.nodes), places)
        for node in stage.left:
            self.rows.write(self.operating.value(node), self._waiting(left[node], from_first))
        after = block.label
        self.rows.advance(lane, end, f"stage{i}", f"behind{i}")
        block.begin(f"behind{i}")
        block.lines[head:head] = [self.rows.counter_line(lane, "%first", before, after)]

    def _waiting(self, place: int, from_first: Value) -> Value:
        index = self.block.put(f"add i64 {from_first}, {place}")
        return self.rows.place("%waiting", index)

    def _independent_of(self, names: tuple[str, ...]) -> set[Node]:
        """Nodes that depend on none of the variables of the inner loop."""
        inner = {variable(name) for name in names}
        independent: set[Node] = set()
        for node in self.scan.graph.order:
            if node not in inner and all(x in independent for x in node.arguments):
                independent.add(node)
        return independent

    def _compute(self, nodes: list[Node], places: dict[Node, list[Value]] | None = None) -> None:
        """Nodes in order; outputs are written at once: a number that waits to be written takes a register."""
        # in the graph's order; an output leaves its register as soon as it is known
        for node in nodes:
            self.operating.compute(node)
            if places is not None and node in places:
                self._write([node], places)
            self._fold(node)

    def _take(self, axis: str) -> None:
        """Load what belongs to a place of the loop."""
        scan, values = self.scan, self.operating.values
        if not axis.startswith(LANE):
            for row, name in zip(self._inputs, scan.inputs, strict=True):
                values[variable(name)] = self.rows.everywhere(self.rows.place(row, "%step"))
            if not self.shape.lanes_inside:
                values.update({variable(name): f"%s{i}" for i, name in enumerate(scan.state)})
            return
        for row, name in zip(self._parameters, scan.parameters, strict=True):
            values[variable(name)] = self._here(row)
        self._first = [self._here(row) for row in self._states]

    def _here(self, row: Value) -> Value:
        return self.rows.read(self.rows.place(row, self.rows.at))

    def _places(self, bases: list[Value]) -> dict[Node, list[Value]]:
        """Where outputs are written."""
        places: dict[Node, list[Value]] = {}
        if bases:
            of_step = self.block.put("mul i64 %step, %output_row")
            index = self.block.put(f"add i64 {of_step}, {self.rows.at}")
            # one node may be several outputs, each with a place of its own
            for base, node in zip(bases, self.scan.outputs.values(), strict=True):
                places.setdefault(node, []).append(self.rows.place(base, index))
        return places

    def _write(self, nodes: list[Node], places: dict[Node, list[Value]]) -> None:
        for node in nodes:
            for place in places[node]:
                self.rows.write(self.operating.value(node), place)
                if self.shape.lanes_inside:
                    self.rows.fetch(place, AHEAD)

    # extremes over lanes stand on the stack, a vector of them: loops of several stages add to it, and the last vector,
    # which has some lanes twice, changes nothing

    def _room_of_extremes(self) -> dict[Node, list[tuple[str, Value]]]:
        """Node -> the extremes that it belongs to, each with its place."""
        found: dict[Node, list[tuple[str, Value]]] = {}
        for i, extreme in enumerate(self.scan.extremes.values()):
            self.block.line(f"%extreme{i} = alloca {self.shape.vector.name}, align 64")
            found.setdefault(extreme.value, []).append((extreme.operation, f"%extreme{i}"))
        return found

    def _begin_extremes(self) -> None:
        for i, extreme in enumerate(self.scan.extremes.values()):
            self.rows.write(self.code.constant(extreme.start), f"%extreme{i}")

    def _fold(self, node: Node) -> None:
        """Add the number of a node that is known to the extremes that it belongs to."""
        for operation, place in self._extremes.get(node, ()):
            so_far = self.rows.read(place)
            self.rows.write(self.operating.extreme(operation, self.operating.value(node), so_far), place)

    def _write_extremes(self) -> None:
        """One number in every lane of a vector: the caller takes the extreme of these."""
        for i in range(len(self.scan.extremes)):
            index = self.block.put(f"mul i64 %step, {self.shape.vector.width}")
            place = self.rows.place(self.rows.row("%new_state", i, "%new_state_row"), index)
            self.rows.write(self.rows.read(f"%extreme{i}"), place)

    def _write_state(self) -> None:
        for i, node in enumerate(self.scan.state.values()):
            place = self.rows.place(self.rows.row("%new_state", i, "%new_state_row"), self.rows.at)
            self.rows.write(self.operating.value(node), place)

    def _carried_state(self, before: str, after: str) -> list[str]:
        type_ = self.shape.vector.name
        return [
            f"  %s{i} = phi {type_} [ {self._first[i]}, %{before} ], [ {self.operating.value(node)}, %{after} ]"
            for i, node in enumerate(self.scan.state.values())
        ]


# What is computed before a kernel runs, on NumPy: expressions that all lanes, or all steps, have in common.

FUNCTIONS = frozenset({"sin", "cos", "atan2", "exp", "log", "power"})
"""Operations that are not rounded alike everywhere."""
KEPT = 1 << 20
"""Bytes of the arrays whose table is kept for the next call."""


class ConstantTable:
    """Expressions of some variables alone, computed for arrays of these.

    Calls in turn often have the same samples: the last table is kept.
    """

    def __init__(self, names: tuple[str, ...], graph: Graph) -> None:
        self.names = names
        self.graph = graph
        self._last: tuple[bytes, Array] | None = None

    def below(self, rows: Array) -> Array:
        """The rows of the variables, (variables, n), with those of the expressions below them."""
        if not self.graph.outputs:
            return rows
        if rows.nbytes > KEPT:
            return self._compute_rows(rows)
        # the bytes themselves: samples that differ in one bit need another table
        key, last = rows.tobytes() + rows.dtype.char.encode(), self._last
        if last is None or last[0] != key:
            self._last = last = key, self._compute_rows(rows)
        return last[1]

    # laid out as outputs are, so that vectors of a table do not lie across two lines of the cache
    def _compute_rows(self, rows: Array) -> Array:
        whole = room_of(len(rows) + len(self.graph.outputs), 1, rows.shape[1], rows.dtype)[:, 0]
        whole[: len(rows)] = rows
        constants = evaluate(self.graph, dict(zip(self.names, rows, strict=True)), rows.dtype)
        for i, values in enumerate(constants.values(), len(rows)):
            whole[i] = values
        return whole


@dataclass(frozen=True)
class Tables:
    """A scan with what is computed beforehand taken out of it.

    What depends on the inner loop's variables alone would be computed again at every turn of the outer loop.
    Functions of inputs or parameters alone are taken out in any case: so sine and cosine of the drive, and of arcs
    on the sphere, and the statuses that hang on them, are NumPy's whichever loop is inside.

    Attributes
    ----------
    of_steps, of_lanes : what is computed from inputs alone, and from parameters alone
    rest : the scan with that as further inputs and parameters
    """

    of_steps: ConstantTable
    of_lanes: ConstantTable
    rest: Scan

    @classmethod
    def of(cls, scan: Scan, lanes_inside: bool, own_functions: bool = False) -> Tables:
        """The tables of a scan."""
        # with the lanes inside, steps are turns of the outer loop, which computes anything once a step by
        # itself; only functions that libraries round differently are taken out there. The other way round for
        # lanes
        steps, graph = split_graph(scan.graph, scan.inputs, "of step", FUNCTIONS if lanes_inside else None)
        # of one step that hands nothing on nothing is computed twice
        repeated = lanes_inside or ((scan.inputs or scan.state) and not own_functions)
        known = scan.parameters if repeated else ()
        lanes, graph = split_graph(graph, known, "of lane", None if lanes_inside else FUNCTIONS)
        rest = scan.with_graph(graph, (*scan.parameters, *lanes.outputs), (*scan.inputs, *steps.outputs))
        return cls(ConstantTable(scan.inputs, steps), ConstantTable(scan.parameters, lanes), rest)

    def split_call(self, call: Call) -> Call:
        """The arrays of a call of the scan as those of the rest."""
        parameters, inputs = self.of_lanes.below(call.parameters), self.of_steps.below(call.inputs)
        return Call(parameters, inputs, call.state, call.outputs)
