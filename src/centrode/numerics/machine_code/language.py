"""LLVM's language: vector types, and a text that grows by one operation at a time.

A value is its name in that text ("%v7") or a constant; every method that computes adds a line and gives the
name of the result. Nothing is marked as fast: what is written is what is rounded, save where `fused` lets a
product and the sum behind it be rounded once.
"""

from __future__ import annotations

import struct
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TypeAlias

Value: TypeAlias = str
MAGNITUDES = {"float": 32, "double": 64}


@dataclass(frozen=True)
class Vector:
    """A vector type: `width` numbers ("double" or "float")."""

    number: str
    width: int

    @property
    def bits(self) -> int:
        """Bits of one number."""
        return MAGNITUDES[self.number]

    @property
    def name(self) -> str:
        """The type as LLVM writes it."""
        return f"<{self.width} x {self.number}>"

    @property
    def whole(self) -> str:
        """The type of whole numbers of the same size."""
        return f"<{self.width} x i{self.bits}>"

    @property
    def truth(self) -> str:
        """The type of conditions on it."""
        return f"<{self.width} x i1>"

    @property
    def suffix(self) -> str:
        """Ending of the names of LLVM's own functions."""
        return f"v{self.width}f{self.bits}"

    def constant(self, x: float) -> Value:
        """A number in every lane."""
        if self.number == "float":
            x = _as_single(x)
        # LLVM writes a single-precision constant with the bits of the equal double
        bits = struct.unpack("<Q", struct.pack("<d", x))[0]
        return self._everywhere(f"{self.number} 0x{bits:016X}")

    def whole_constant(self, x: int) -> Value:
        """A whole number in every lane."""
        return self._everywhere(f"i{self.bits} {x}")

    def _everywhere(self, one: str) -> Value:
        return "<" + ", ".join([one] * self.width) + ">"


def _as_single(x: float) -> float:
    try:
        return float(struct.unpack("<f", struct.pack("<f", x))[0])
    except OverflowError:
        return float("inf") if x > 0 else -float("inf")


@dataclass
class Block:
    """Lines of a function's body, the label of the block they are in, and the functions they call."""

    lines: list[str] = field(default_factory=list)
    label: str = "entry"
    declared: dict[str, None] = field(default_factory=dict)
    names: int = 0

    def name(self, prefix: str = "%v") -> str:
        """A name that is not taken."""
        self.names += 1
        return f"{prefix}{self.names}"

    def begin(self, label: str) -> None:
        """Begin a block."""
        self.lines.append(f"{label}:")
        self.label = label

    def line(self, text: str) -> None:
        """An instruction without a result."""
        self.lines.append(f"  {text}")

    def put(self, text: str) -> Value:
        """An instruction with a result."""
        name = self.name()
        self.line(f"{name} = {text}")
        return name


@dataclass(frozen=True)
class Code:
    """Operations on vectors of one type, written into a block."""

    block: Block
    vector: Vector
    has_fma: bool

    def of_doubles(self) -> Code:
        """Code for the same block and number of lanes, in double precision."""
        return Code(self.block, Vector("double", self.vector.width), self.has_fma)

    def constant(self, x: float) -> Value:
        """A number in every lane."""
        return self.vector.constant(x)

    def binary(self, instruction: str, a: Value, b: Value, flags: str = "") -> Value:
        """fadd, fsub, fmul or fdiv."""
        return self.block.put(f"{instruction} {flags}{self.vector.name} {a}, {b}")

    def add(self, a: Value, b: Value) -> Value:
        return self.binary("fadd", a, b)

    def subtract(self, a: Value, b: Value) -> Value:
        return self.binary("fsub", a, b)

    def multiply(self, a: Value, b: Value) -> Value:
        return self.binary("fmul", a, b)

    def divide(self, a: Value, b: Value) -> Value:
        return self.binary("fdiv", a, b)

    def negate(self, a: Value) -> Value:
        return self.block.put(f"fneg {self.vector.name} {a}")

    def intrinsic(self, name: str, *arguments: Value) -> Value:
        """Call of a vector function of LLVM: sqrt, fabs, copysign, fma or fmuladd."""
        v = self.vector
        full = f"@llvm.{name}.{v.suffix}"
        types = ", ".join([v.name] * len(arguments))
        self.block.declared[f"declare {v.name} {full}({types})"] = None
        return self.block.put(f"call {v.name} {full}({', '.join(f'{v.name} {x}' for x in arguments)})")

    def multiply_add(self, a: Value, b: Value, c: Value) -> Value:
        """The sum a b + c, rounded once where the machine does that as fast."""
        return self.intrinsic("fmuladd", a, b, c)

    def fma(self, a: Value, b: Value, c: Value) -> Value:
        """The sum a b + c, rounded once in any case."""
        return self.intrinsic("fma", a, b, c)

    def compare(self, predicate: str, a: Value, b: Value) -> Value:
        """A condition: oeq, olt, ole, une, uno ... (o: false with NaN, u: true with NaN)."""
        return self.block.put(f"fcmp {predicate} {self.vector.name} {a}, {b}")

    def logical(self, instruction: str, p: Value, q: Value) -> Value:
        """And, or, xor of conditions."""
        return self.block.put(f"{instruction} {self.vector.truth} {p}, {q}")

    def select(self, condition: Value, a: Value, b: Value) -> Value:
        """The one or the other, lane by lane."""
        v = self.vector
        return self.block.put(f"select {v.truth} {condition}, {v.name} {a}, {v.name} {b}")

    def bits_of(self, a: Value) -> Value:
        """The bits of numbers, read as whole numbers."""
        return self.block.put(f"bitcast {self.vector.name} {a} to {self.vector.whole}")

    def from_bits(self, a: Value) -> Value:
        """The bits of whole numbers, read as numbers."""
        return self.block.put(f"bitcast {self.vector.whole} {a} to {self.vector.name}")

    def whole(self, instruction: str, a: Value, constant: int) -> Value:
        """An operation of whole numbers with a constant."""
        return self.block.put(
            f"{instruction} {self.vector.whole} {a}, {self.vector.whole_constant(constant)}"
        )

    def polynomial(self, coefficients: Sequence[float], z: Value) -> Value:
        """Value of a polynomial by Horner's rule; the constant term comes first."""
        # Horner from the highest coefficient: each step is one fused product and sum
        value = self.constant(coefficients[-1])
        for coefficient in reversed(coefficients[:-1]):
            value = self.multiply_add(value, z, self.constant(coefficient))
        return value

    def polynomial_in_halves(self, coefficients: Sequence[float], z: Value) -> Value:
        """Value of a polynomial, even and odd powers apart: two chains of half the length run side by side."""
        squared = self.multiply(z, z)
        even, odd = (self.polynomial(coefficients[k::2], squared) for k in (0, 1))
        return self.multiply_add(odd, z, even)


# The C library's functions on vectors, one lane after the other: for what is rare and for what has no vector
# form.

FUNCTIONS = {"exp": "exp", "log": "log", "power": "pow"}
"""Operations that are always left to the C library, by its names."""


def by_library(code: Code, name: str, *arguments: Value) -> Value:
    """A function of the C library on every lane of vectors of doubles."""
    assert code.vector.number == "double"
    block, vector = code.block, code.vector
    block.declared[f"declare double @{name}({', '.join(['double'] * len(arguments))})"] = None
    result = "poison"
    for lane in range(vector.width):
        ones = [block.put(f"extractelement {vector.name} {x}, i32 {lane}") for x in arguments]
        value = block.put(f"call double @{name}({', '.join(f'double {argument}' for argument in ones)})")
        result = block.put(f"insertelement {vector.name} {result}, double {value}, i32 {lane}")
    return result


def by_library_where(
    code: Code, condition: Value, names: Sequence[str], arguments: Sequence[Value], near: Sequence[Value]
) -> list[Value]:
    """Functions by the C library in the lanes where a condition holds, else what is given; seldom costs nothing."""
    block, vector = code.block, code.vector
    before, far, after = block.label, block.name("far"), block.name("after")
    truth = f"i{vector.width}"
    # one comparison of all lanes at once: a vector without a lane beyond skips the calls
    some = block.put(f"icmp ne {truth} {block.put(f'bitcast {vector.truth} {condition} to {truth}')}, 0")
    block.line(f"br i1 {some}, label %{far}, label %{after}, !prof !0")
    block.begin(far)
    lanes = [
        code.select(condition, by_library(code, name, *arguments), value)
        for name, value in zip(names, near, strict=True)
    ]
    block.line(f"br label %{after}")
    block.begin(after)
    return [
        block.put(f"phi {vector.name} [ {value}, %{before} ], [ {other}, %{far} ]")
        for value, other in zip(near, lanes, strict=True)
    ]
