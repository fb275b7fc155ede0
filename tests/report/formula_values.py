"""The value of a formula as it is spelled for typst: sums, products without a sign, fractions, powers, roots, waves."""

from __future__ import annotations

import re
from collections.abc import Mapping

import mpmath

TOKEN = re.compile(r'\s*("[^"]*"|\d+(?:\.\d+)?|dot\.op|[A-Za-z]+(?:_\w+)?\'*|[-+(),^/])')
FUNCTIONS = {
    "sqrt": mpmath.sqrt, "sin": mpmath.sin, "cos": mpmath.cos, "arcsin": mpmath.asin, "arccos": mpmath.acos,
    "arctan": mpmath.atan,
}  # fmt: skip


def value_of(formula: str, letters: Mapping[str, float] | None = None) -> float:
    """The number that a formula stands for; a unit behind it does not count."""
    return float(_Reader(formula.split(" thin ")[0], letters or {}).whole())


class _Reader:
    def __init__(self, text: str, letters: Mapping[str, float]) -> None:
        self.tokens: list[str] = []
        end = 0
        while end < len(text.rstrip()):
            found = TOKEN.match(text, end)
            assert found is not None, text[end:]
            self.tokens.append(found[1])
            end = found.end()
        self.letters, self.place = letters, 0

    def whole(self) -> mpmath.mpf:
        value = self.sum()
        assert self.next() == "", self.tokens[self.place :]
        return value

    def next(self) -> str:
        return self.tokens[self.place] if self.place < len(self.tokens) else ""

    def take(self, wanted: str = "") -> str:
        token = self.next()
        assert token and (not wanted or token == wanted), (wanted, token, self.tokens)
        self.place += 1
        return token

    def sum(self) -> mpmath.mpf:
        sign = -1 if self.next() == "-" and self.take() else 1
        value = sign * self.product()
        while self.next() in ("+", "-"):
            value += (1 if self.take() == "+" else -1) * self.product()
        return value

    def product(self) -> mpmath.mpf:
        value = self.power()
        while self.next() not in ("", "+", "-", ")", ","):
            if self.next() == "dot.op":
                self.take()
                value *= self.power()
            elif self.next() == "/":
                self.take()
                value /= self.power()
            else:
                value *= self.power()
        return value

    def power(self) -> mpmath.mpf:
        value = self.factor()
        if self.next() == "^":
            self.take()
            value = value ** self.factor()
        return value

    def factor(self) -> mpmath.mpf:
        token = self.take()
        if token == "-":
            return -self.factor()
        if token == "(":
            value = self.sum()
            self.take(")")
            return value
        if token == "frac":
            self.take("(")
            above = self.sum()
            self.take(",")
            below = self.sum()
            self.take(")")
            return above / below
        if token in FUNCTIONS:
            return FUNCTIONS[token](self.factor())
        if token == "pi":
            return +mpmath.pi
        if token == "degree":
            return mpmath.pi / 180
        if token[0].isdigit():
            return mpmath.mpf(token)
        return mpmath.mpf(self.letters[token])
