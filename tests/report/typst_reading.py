"""A small reader of the typst mathematics that formulas are spelled in: the value of a formula, its letters given."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

import mpmath

TOKEN = re.compile(r'\s*("(?:[^"\\]|\\.)*"|\d+(?:\.\d+)?|[A-Za-z]+(?:\.[a-z]+)*|[-+(),;:/_^])')
WAVES = {
    "sin": mpmath.sin,
    "cos": mpmath.cos,
    "tan": mpmath.tan,
    "arcsin": mpmath.asin,
    "arccos": mpmath.acos,
}
ENDS = ("", "+", "-", ")", ",", ";")
NUMBER = re.compile(r'"?\d+[.,]?\d*"?')


class TypstReader:
    """Value of a formula; letters are looked up by all that belongs to them, blanks left out."""

    def __init__(self, text: str, value: Callable[[str], Any]) -> None:
        self.tokens: list[str] = []
        end = 0
        while end < len(text.rstrip()):
            found = TOKEN.match(text, end)
            assert found is not None, text[end:]
            self.tokens.append(found[1])
            end = found.end()
        self.value, self.place = value, 0

    def next(self) -> str:
        return self.tokens[self.place] if self.place < len(self.tokens) else ""

    def take(self, wanted: str = "") -> str:
        token = self.next()
        assert not wanted or token == wanted, (wanted, token, self.tokens)
        self.place += 1
        return token

    def sum(self) -> Any:
        total, sign = mpmath.mpf(0), 1
        if self.next() == "-":
            sign = -1
            self.take()
        while True:
            total += sign * self.product()
            if self.next() not in ("+", "-"):
                return total
            sign = 1 if self.take() == "+" else -1

    def product(self) -> Any:
        value = self.factor()
        while self.next() not in ENDS:
            if self.next() == "dot.op":
                self.take()
            value *= self.factor()
        return value

    def inside(self) -> str:
        """What stands in brackets, as it is."""
        self.take("(")
        depth, told = 1, ""
        while True:
            token = self.take()
            depth += (token == "(") - (token == ")")
            if not depth:
                return told
            told += token

    def power(self) -> int:
        if self.next() != "^":
            return 1
        self.take()
        return int(self.inside())

    def determinant(self) -> Any:
        """Determinant of a matrix between bars."""
        for token in ("(", "delim", ":", '"|"'):
            self.take(token)
        rows: list[list[Any]] = []
        sign = self.take(",")
        while sign != ")":
            if sign == ";" or not rows:
                rows.append([])
            rows[-1].append(self.sum())
            sign = self.take()
        return mpmath.det(mpmath.matrix(rows))

    def factor(self) -> Any:
        token = self.take()
        if token == "(":
            value = self.sum()
            self.take(")")
            return value ** self.power()
        if token == "frac":
            self.take("(")
            above = self.sum()
            self.take(",")
            below = self.sum()
            self.take(")")
            return above / below
        if token == "sqrt":
            self.take("(")
            value = mpmath.sqrt(self.sum())
            self.take(")")
            return value
        if token == '"atan2"':
            self.take("(")
            y = self.sum()
            self.take()
            x = self.sum()
            self.take(")")
            return mpmath.atan2(y, x)
        if token == "mat":
            return self.determinant()
        if token == "op":  # tangent of other languages
            assert self.inside() == '"tg"'
            return mpmath.tan(self.factor())
        if token == "pi" and self.next() == "/":
            return self.value(token + self.take() + self.take())
        if token == "abs":
            self.take("(")
            value = abs(self.sum())
            self.take(")")
            return value
        if token in WAVES:
            power = self.power()
            return WAVES[token](self.factor()) ** power
        if NUMBER.fullmatch(token):
            return mpmath.mpf(token.strip('"').replace(",", ".")) ** self.power()
        name = token
        if token in ("dot", "dot.double", "italic"):
            name += f"({self.inside()})"
        if self.next() == "_":
            name += self.take() + f"({self.inside()})"
        return self.value(name) ** self.power()


def read(text: str, value: Callable[[str], Any]) -> Any:
    reader = TypstReader(text, value)
    found = reader.sum()
    assert reader.place == len(reader.tokens), text
    return found
