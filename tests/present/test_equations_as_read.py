"""The printed equations read back: what a student copies, with the numbers of the list of symbols, moves."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator

import numpy as np
import pytest

import centrode as ct
from centrode.equations.derivation import Equations
from centrode.kinematics.motion import initial_place
from equation_pages import rows
from mechanisms import EPS

LETTER = r"[^\W\d_₀-₉⁰-⁹²³¹]\u0307?\u0308?(?:[₀-₉]+|_[^\s()+*/=|²³]+)?'*"
TOKEN = re.compile(rf"\s*(?:(\d+\.?\d*)|(sin|cos)([²³⁴]?)(?=[ (])|({LETTER})([²³⁴]?)|([-+/()]))")
POWERS = {"": 1, "²": 2, "³": 3, "⁴": 4}
PRINTED = 0.5e-5
"""Relative error of numbers printed with six digits."""


class Reader:
    """Value of a printed formula: products by standing side by side, one factor behind a stroke."""

    def __init__(self, text: str, value: Callable[[str], float]) -> None:
        self.tokens: list[tuple[str, ...]] = []
        end = 0
        while end < len(text.rstrip()):
            found = TOKEN.match(text, end)
            assert found is not None, text[end:]
            self.tokens.append(tuple(part or "" for part in found.groups()))
            end = found.end()
        self.value, self.place = value, 0

    def sign(self) -> str:
        return self.tokens[self.place][5] if self.place < len(self.tokens) else ")"

    def sum(self) -> float:
        total, sign = 0.0, 1.0
        if self.sign() == "-":
            sign, self.place = -1.0, self.place + 1
        while True:
            total += sign * self.product()
            if self.sign() not in ("+", "-"):
                return total
            sign, self.place = (1.0 if self.sign() == "+" else -1.0), self.place + 1

    def product(self) -> float:
        value = self.factor()
        while self.sign() in ("", "(", "/"):
            if self.sign() == "/":
                self.place += 1
                value /= self.factor()
            else:
                value *= self.factor()
        return value

    def factor(self) -> float:
        number, wave, wave_power, letter, power, sign = self.tokens[self.place]
        self.place += 1
        if number:
            return float(number)
        if wave:
            return float(getattr(math, wave)(self.factor()) ** POWERS[wave_power])
        if letter:
            return float(self.value(letter) ** POWERS[power])
        assert sign == "("
        value = self.sum()
        assert self.sign() == ")"
        self.place += 1
        return value


def read(text: str, values: dict[str, float]) -> float:
    reader = Reader(text, values.__getitem__)
    value = reader.sum()
    assert reader.place == len(reader.tokens), text
    return value


def symbols(every: list[tuple[str, str, str]]) -> dict[str, float]:
    """Numbers of the list of symbols; of what moves, in the initial position."""
    units = {"deg": math.pi / 180, "mm": 1e-3}
    found = {}
    for heading, name, text in every:
        if heading == "Symbols":
            number, _comma, _words = text.partition(",")
            size, _space, unit = number.partition(" ")
            found[name.removesuffix("(0)")] = float(size) * units.get(unit, 1.0)
    return found


def formulas(every: list[tuple[str, str, str]]) -> Iterator[tuple[str, str]]:
    """Letter and formula of the normal form and of what explains it, in the order of the page."""
    for heading, left, right in every:
        if heading == "Cauchy normal form":
            name, sign, formula = right.partition(" = ")
            yield (name, formula) if sign and left.startswith("d") else (left, right)


LEVER_AND_GEAR = """
[frame.points]
A = [0.5, -0.5]
D = [0.1, -1.5]
K = [-2, 2]
[links.crank]
points = { A = [0, 0], B = [1, 0] }
[links.lever]
points = { D = [0, 0], G = [1, 0.5] }
[links.wheel]
points = ["K", "L"]
length = 3
angle = 0.4
[[guides]]
point = "B"
on = "lever"
through = [-1.8, 1]
direction = 0
[[gears]]
links = ["crank", "wheel"]
ratio = -2
[[drives]]
link = "crank"
start = 0
speed = 1
[assembly]
sides = { B = "ahead" }
"""
"""Three unknowns in two groups, and a determinant of two terms in the first: a + s."""


@pytest.mark.parametrize(
    "name",
    ["slider-between-cranks", "six-bar-press", "whitworth-quick-return", "geared-five-bar", "jansen-leg", ""],
)
def test_what_is_printed_moves_as_the_mechanism_does(name: str) -> None:
    mechanism = ct.example(name) if name else ct.parse_mechanism(LEVER_AND_GEAR)
    found = ct.equations(mechanism)
    every = rows(found)
    values = symbols(every)
    for heading, left, right in every:
        if heading == "Given by the drives (SI)":
            values[left] = read(right, {"t": 0.0})
    values["t"] = 0.0
    for letter, formula in formulas(every):
        values[letter] = read(formula, values)
    motion = ct.motion(mechanism, at=[initial_place(mechanism)])
    worst = max(float(np.linalg.cond(np.array(matrix, dtype=float))) for matrix in matrices(found))
    fastest = float(np.max(np.abs(motion.angular_velocity.values)))
    # each of a group's numbers is off by its last digit, at most a dozen stand in a rate, and groups pass errors on
    allowed = 12 * (PRINTED + EPS) * worst * fastest * (1 + fastest) * len(found.groups)
    for number, link in enumerate(mechanism.links, 1):
        letter = "ω" + str(number).translate(str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉"))
        if letter in values:
            assert abs(values[letter] - float(motion.angular_velocity.sel(link=link)[0])) <= allowed, link


def matrices(found: Equations) -> list[object]:
    """Matrices of the groups in the initial position, rows and columns brought to the size 1."""
    numbers = {key: value for key, value in found.values.items()} | {"t": 0.0}
    made = []
    for group in found.groups:
        matrix = np.array(group.matrix.subs(numbers).tolist(), dtype=float)
        made.append(matrix / np.linalg.norm(matrix, axis=0))
    return made
