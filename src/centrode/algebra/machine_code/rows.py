"""Rows of numbers in memory, and loops along them, in LLVM's language."""

from __future__ import annotations

from centrode.algebra.machine_code.language import Block, Value, Vector

LANE = "%lane"
"""Names of lanes' loop variables begin so; `%lanes` is how many there are."""


class Rows:
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
        return self.block.put(f"load {self.vector.name}, ptr {place}, align {self.vector.bits // 8}")

    def write(self, value: Value, place: Value) -> None:
        """Write a vector to a place."""
        self.block.line(f"store {self.vector.name} {value}, ptr {place}, align {self.vector.bits // 8}")

    def everywhere(self, place: Value) -> Value:
        """One number in every lane."""
        vector, block = self.vector, self.block
        one = block.put(f"load {vector.number}, ptr {place}, align {vector.bits // 8}")
        first = block.put(f"insertelement {vector.name} poison, {vector.number} {one}, i32 0")
        lanes = f"<{vector.width} x i32> zeroinitializer"
        return block.put(f"shufflevector {vector.name} {first}, {vector.name} poison, {lanes}")

    def stand(self, axis: str) -> None:
        """Where the loop stands: the first lane of a block, moved back at the end."""
        if axis.startswith(LANE):
            last = self.block.put(f"sub i64 %lanes, {self.vector.width}")
            beyond = self.block.put(f"icmp sgt i64 {axis}, {last}")
            self.at = self.block.put(f"select i1 {beyond}, i64 {last}, i64 {axis}")

    def advance(self, axis: str, end: Value, again: str, done: str) -> None:
        """The end of a loop: on to the next lanes, or to the next step."""
        stride = self.vector.width if axis.startswith(LANE) else 1
        self.block.line(f"{axis}.next = add i64 {axis}, {stride}")
        more = self.block.put(f"icmp slt i64 {axis}.next, {end}")
        self.block.line(f"br i1 {more}, label %{again}, label %{done}")

    def carried(self, axis: str, first: Value, before: str, after: str) -> str:
        """The line at a loop's head that says where it stands."""
        return f"  {axis} = phi i64 [ {first}, %{before} ], [ {axis}.next, %{after} ]"
