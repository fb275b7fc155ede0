"""A scan as one function in LLVM's language: two loops around the operations of its graph.

With the steps inside, a block of lanes is taken through all steps and the state stays in registers. With the
lanes inside, every step runs along all lanes, so that each output is written as one stream; there is no state
then, and a graph may be computed in stages, one loop behind the other over a piece of the lanes. What depends on
the outer loop alone is computed there. The last block of lanes overlaps the one before, so that no lane needs a
mask; the caller sees to it that there are as many lanes as a vector has.
"""

from __future__ import annotations

from dataclasses import dataclass

from centrode.algebra.expressions import Node, variable
from centrode.algebra.machine_code.language import Block, Code, Value, Vector
from centrode.algebra.machine_code.operating import Operating
from centrode.algebra.machine_code.relaxing import behind_decisions
from centrode.algebra.machine_code.rows import LANE, Rows
from centrode.algebra.machine_code.stages import Stage, stages_of
from centrode.algebra.scans import Scan

FUNCTION = "centrode_scan"
ARGUMENTS = (
    "i64 %lanes", "i64 %steps",
    "ptr noalias %parameters", "i64 %parameter_row", "ptr noalias %inputs", "i64 %input_row",
    "ptr noalias %state", "i64 %state_row", "ptr noalias %new_state", "i64 %new_state_row",
    "ptr noalias %outputs", "i64 %output", "i64 %output_row",
)  # fmt: skip
"""Rows are distances, in numbers, of one row from the next; `output` is that of one output from the next."""
PIECE = 64
"""Lanes that a stage goes through before the next one: what waits in between stays in the nearest cache."""


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
        self.rows = Rows(self.block, shape.vector)

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
        outer = "%step" if inside else "%lane"
        of_inner = self.scan.parameters if inside else (*self.scan.inputs, *self.scan.state)
        early = self._independent_of(of_inner)
        rest = [node for node in self.scan.graph.order if node not in early]
        stages = stages_of(rest) if inside else [Stage(tuple(rest), ())]
        left = self._room(stages)
        bases = self._begin_rows()
        block.line("br label %outer")
        block.begin("outer")
        head = len(block.lines)
        self.rows.stand(outer)
        self._take(outer)
        self._compute([node for node in self.scan.graph.order if node in early])
        if len(stages) == 1:
            self._loop("%lane" if inside else "%step", rest, bases, early)
        else:
            self._pieces(stages, bases, early, left)
        block.begin("outer_end")
        self._write_state()
        self.rows.advance(outer, "%lanes" if outer == "%lane" else "%steps", "outer", "end")
        block.begin("end")
        block.line("ret void")
        # what a loop carries is known only at its end
        block.lines[head:head] = [self.rows.carried(outer, "0", "entry", "outer_end")]

    def _begin_rows(self) -> list[Value]:
        """Where rows begin, known before the loops; returns that of the outputs."""
        scan, row = self.scan, self.rows.row
        self._parameters = [row("%parameters", i, "%parameter_row") for i in range(len(scan.parameters))]
        self._inputs = [row("%inputs", i, "%input_row") for i in range(len(scan.inputs))]
        self._states = [row("%state", i, "%state_row") for i in range(len(scan.state))]
        return [row("%outputs", i, "%output") for i in range(len(scan.outputs))]

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
        self._write([node for node in places if node in early], places)
        self._compute(nodes, places)
        after = block.label
        self.rows.advance(axis, "%lanes" if axis == "%lane" else "%steps", "inner", "outer_end")
        block.lines[head:head] = [
            self.rows.carried(axis, "0", before, after), *self._carried_state(before, after)
        ]  # fmt: skip

    def _room(self, stages: list[Stage]) -> dict[Node, int]:
        """Where on the stack the numbers wait that stages leave for later ones."""
        left = [node for stage in stages for node in stage.left]
        if left:
            self.block.line(f"%waiting = alloca [{PIECE * len(left)} x {self.shape.vector.number}], align 64")
        return {node: PIECE * i for i, node in enumerate(left)}

    def _pieces(
        self, stages: list[Stage], bases: list[Value], early: set[Node], left: dict[Node, int]
    ) -> None:
        """Lanes piece by piece, with a loop for each stage."""
        block = self.block
        before = block.label
        block.line("br label %piece")
        block.begin("piece")
        head = len(block.lines)
        block.line(f"%piece.next = add i64 %first, {PIECE}")
        more = block.put("icmp slt i64 %piece.next, %lanes")
        end = block.put(f"select i1 {more}, i64 %piece.next, i64 %lanes")
        known = dict(self.operating.values)
        for i, stage in enumerate(stages):
            self.operating = self.operating.with_values(known)
            done = early if i == 0 else set()
            self._stage(i, stage, end, bases, done, left)
        block.line(f"br i1 {more}, label %piece, label %outer_end")
        block.lines[head:head] = [
            f"  %first = phi i64 [ 0, %{before} ], [ %piece.next, %{block.label} ]"
        ]  # fmt: skip

    def _stage(
        self, i: int, stage: Stage, end: Value, bases: list[Value], early: set[Node], left: dict[Node, int]
    ) -> None:
        """One stage over one piece of the lanes."""
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
        block.lines[head:head] = [self.rows.carried(lane, "%first", before, after)]

    def _waiting(self, place: int, from_first: Value) -> Value:
        index = self.block.put(f"add i64 {from_first}, {place}")
        return self.rows.place("%waiting", index)

    def _independent_of(self, names: tuple[str, ...]) -> set[Node]:
        """Nodes that depend on none of the variables of the inner loop."""
        inner = {variable(name) for name in names}
        found: set[Node] = set()
        for node in self.scan.graph.order:
            if node not in inner and all(x in found for x in node.arguments):
                found.add(node)
        return found

    def _compute(self, nodes: list[Node], places: dict[Node, list[Value]] | None = None) -> None:
        """Nodes in order; outputs are written at once: a number that waits to be written takes a register."""
        for node in nodes:
            self.operating.compute(node)
            if places is not None and node in places:
                self._write([node], places)

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
        found: dict[Node, list[Value]] = {}
        if bases:
            of_step = self.block.put("mul i64 %step, %output_row")
            index = self.block.put(f"add i64 {of_step}, {self.rows.at}")
            for base, node in zip(bases, self.scan.outputs.values(), strict=True):
                found.setdefault(node, []).append(self.rows.place(base, index))
        return found

    def _write(self, nodes: list[Node], places: dict[Node, list[Value]]) -> None:
        for node in nodes:
            for place in places[node]:
                self.rows.write(self.operating.value(node), place)

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
