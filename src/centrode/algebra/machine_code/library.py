"""The C library's functions on vectors, one lane after the other: for what is rare and for what has no vector form."""

from __future__ import annotations

from collections.abc import Sequence

from centrode.algebra.machine_code.language import Code, Value

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
        value = block.put(f"call double @{name}({', '.join(f'double {one}' for one in ones)})")
        result = block.put(f"insertelement {vector.name} {result}, double {value}, i32 {lane}")
    return result


def by_library_where(
    code: Code, condition: Value, names: Sequence[str], arguments: Sequence[Value], near: Sequence[Value]
) -> list[Value]:
    """Functions by the C library in the lanes where a condition holds, else what is given; seldom costs nothing."""
    block, vector = code.block, code.vector
    before, far, after = block.label, block.name("far"), block.name("after")
    truth = f"i{vector.width}"
    some = block.put(f"icmp ne {truth} {block.put(f'bitcast {vector.truth} {condition} to {truth}')}, 0")
    block.line(f"br i1 {some}, label %{far}, label %{after}, !prof !0")
    block.begin(far)
    found = [
        code.select(condition, by_library(code, name, *arguments), value)
        for name, value in zip(names, near, strict=True)
    ]
    block.line(f"br label %{after}")
    block.begin(after)
    return [
        block.put(f"phi {vector.name} [ {value}, %{before} ], [ {other}, %{far} ]")
        for value, other in zip(near, found, strict=True)
    ]
