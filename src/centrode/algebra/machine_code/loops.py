"""A scan as one function in LLVM's language: two loops around the operations of its graph.

With the steps inside, a block of lanes is taken through all steps and the state stays in registers. With the
lanes inside, every step runs along all lanes, so that each output is written as one stream; there is no state
then. What depends on the outer loop alone is computed there. The last block of lanes overlaps the one before,
so that no lane needs a mask; the caller sees to it that there are as many lanes as a vector has.
"""

from __future__ import annotations

from dataclasses import dataclass

from centrode.algebra.expressions import Node, variable
from centrode.algebra.machine_code.language import Block, Code, Value, Vector
from centrode.algebra.machine_code.operating import Operating
from centrode.algebra.machine_code.relaxing import behind_decisions
from centrode.algebra.scans import Scan

FUNCTION = "centrode_scan"
ARGUMENTS = (
    "i64 %lanes", "i64 %steps",
    "ptr noalias %parameters", "i64 %parameter_row", "ptr noalias %inputs", "i64 %input_row",
    "ptr noalias %state", "i64 %state_row", "ptr noalias %new_state", "i64 %new_state_row",
    "ptr noalias %outputs", "i64 %output", "i64 %output_row",
)  # fmt: skip
"""Rows are distances, in numbers, of one row from the next; `output` is that of one output from the next."""


@dataclass(frozen=True)
class Shape:
    """How a scan is carried out.

    Attributes
    ----------
    vector : the type of its vectors
    has_fma : whether the machine rounds a product and a sum at once
    lanes_inside : whether the inner loop runs over lanes, else over steps
    relaxed : whether operations behind all decisions may be rounded otherwise
    """

    vector: Vector
    has_fma: bool
    lanes_inside: bool
    relaxed: bool


def function_text(scan: Scan, shape: Shape) -> str:
    """The scan as a module in LLVM's language, with the function `FUNCTION`."""
    return _Writer(scan, shape).text()


class _Writer:
    def __init__(self, scan: Scan, shape: Shape) -> None:
        self.scan, self.shape, self.block = scan, shape, Block()
        self.code = Code(self.block, shape.vector, shape.has_fma)
        fused = behind_decisions(scan.graph) if shape.relaxed else frozenset()
        self.operating = Operating(self.code, fused)

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
                '!0 = !{!"branch_weights", i32 1, i32 1000000}',
                "",
            ]
        )

    def _loops(self) -> None:
        block, inside = self.block, self.shape.lanes_inside
        bases = [self._row("%outputs", i, "%output") for i in range(len(self.scan.outputs))]
        block.line("br label %outer")
        block.begin("outer")
        outer_head = len(block.lines)
        outer = "%step" if inside else "%lane"
        self._axis(outer)
        self._take(outer)
        early = self._independent_of(
            self.scan.parameters if inside else (*self.scan.inputs, *self.scan.state)
        )
        self._compute([node for node in self.scan.graph.order if node in early])
        before_inner = block.label
        block.line("br label %inner")
        block.begin("inner")
        inner_head = len(block.lines)
        inner = "%lane" if inside else "%step"
        self._axis(inner)
        self._take(inner)
        places = self._places(bases)
        self._write([node for node in places if node in early], places)
        for node in self.scan.graph.order:
            if node not in early:
                self.operating.compute(node)
                # at once: a number that waits to be written takes a register
                self._write([node] if node in places else [], places)
        after_inner = block.label
        self._next(inner, "inner", "outer_end")
        block.begin("outer_end")
        self._write_state()
        self._next(outer, "outer", "end")
        block.begin("end")
        block.line("ret void")
        # what the loops carry is known only now; the inner head stands further down, so it comes first
        block.lines[inner_head:inner_head] = [
            self._carried(inner, before_inner, after_inner), *self._carried_state(before_inner, after_inner),
        ]  # fmt: skip
        block.lines[outer_head:outer_head] = [self._carried(outer, "entry", "outer_end")]

    def _independent_of(self, names: tuple[str, ...]) -> set[Node]:
        """Nodes that depend on none of the variables of the inner loop."""
        inner = {variable(name) for name in names}
        found: set[Node] = set()
        for node in self.scan.graph.order:
            if node not in inner and all(x in found for x in node.arguments):
                found.add(node)
        return found

    def _compute(self, nodes: list[Node]) -> None:
        for node in nodes:
            self.operating.compute(node)

    def _axis(self, axis: str) -> None:
        """Where the loop stands: the first lane of a block, moved back at the end."""
        if axis == "%lane":
            width, block = self.shape.vector.width, self.block
            last = block.put(f"sub i64 %lanes, {width}")
            beyond = block.put(f"icmp sgt i64 %lane, {last}")
            block.line(f"%at = select i1 {beyond}, i64 {last}, i64 %lane")

    def _take(self, axis: str) -> None:
        """Load what belongs to a place of the loop."""
        scan, values = self.scan, self.operating.values
        if axis == "%step":
            for i, name in enumerate(scan.inputs):
                values[variable(name)] = self._everywhere(self._row("%inputs", i, "%input_row"))
            if not self.shape.lanes_inside:
                values.update({variable(name): f"%s{i}" for i, name in enumerate(scan.state)})
            return
        for i, name in enumerate(scan.parameters):
            values[variable(name)] = self._load(self._row("%parameters", i, "%parameter_row"))
        self._first = [self._load(self._row("%state", i, "%state_row")) for i in range(len(scan.state))]

    def _row(self, array: str, i: int, stride: str) -> Value:
        offset = self.block.put(f"mul i64 {i}, {stride}")
        return self._at(array, offset)

    def _at(self, row: Value, index: Value) -> Value:
        return self.block.put(f"getelementptr {self.shape.vector.number}, ptr {row}, i64 {index}")

    def _load(self, row: Value) -> Value:
        vector = self.shape.vector
        return self.block.put(f"load {vector.name}, ptr {self._at(row, '%at')}, align {vector.bits // 8}")

    def _store(self, value: Value, place: Value) -> None:
        vector = self.shape.vector
        self.block.line(f"store {vector.name} {value}, ptr {place}, align {vector.bits // 8}")

    def _everywhere(self, row: Value) -> Value:
        """One number of this step in every lane."""
        vector, block = self.shape.vector, self.block
        one = block.put(f"load {vector.number}, ptr {self._at(row, '%step')}, align {vector.bits // 8}")
        first = block.put(f"insertelement {vector.name} poison, {vector.number} {one}, i32 0")
        lanes = f"<{vector.width} x i32> zeroinitializer"
        return block.put(f"shufflevector {vector.name} {first}, {vector.name} poison, {lanes}")

    def _places(self, bases: list[Value]) -> dict[Node, list[Value]]:
        """Where outputs are written."""
        found: dict[Node, list[Value]] = {}
        if bases:
            of_step = self.block.put("mul i64 %step, %output_row")
            index = self.block.put(f"add i64 {of_step}, %at")
            for base, node in zip(bases, self.scan.outputs.values(), strict=True):
                found.setdefault(node, []).append(self._at(base, index))
        return found

    def _write(self, nodes: list[Node], places: dict[Node, list[Value]]) -> None:
        for node in nodes:
            for place in places[node]:
                self._store(self.operating.value(node), place)

    def _write_state(self) -> None:
        for i, node in enumerate(self.scan.state.values()):
            place = self._at(self._row("%new_state", i, "%new_state_row"), "%at")
            self._store(self.operating.value(node), place)

    def _next(self, axis: str, again: str, done: str) -> None:
        width, end = (self.shape.vector.width, "%lanes") if axis == "%lane" else (1, "%steps")
        self.block.line(f"{axis}.next = add i64 {axis}, {width}")
        more = self.block.put(f"icmp slt i64 {axis}.next, {end}")
        self.block.line(f"br i1 {more}, label %{again}, label %{done}")

    def _carried(self, axis: str, before: str, after: str) -> str:
        return f"  {axis} = phi i64 [ 0, %{before} ], [ {axis}.next, %{after} ]"

    def _carried_state(self, before: str, after: str) -> list[str]:
        type_ = self.shape.vector.name
        return [
            f"  %s{i} = phi {type_} [ {self._first[i]}, %{before} ], [ {self.operating.value(node)}, %{after} ]"
            for i, node in enumerate(self.scan.state.values())
        ]
