"""Formulas in typst's notation are those that `centrode equations` prints: both are read back to the same numbers."""

from __future__ import annotations

import re
import zlib
from collections.abc import Sequence
from typing import Any

import mpmath
import pytest

import centrode as ct
from centrode.equations.spelling import FormulaSpelling
from centrode.equations.symbols import Letter, Parts, Wave
from centrode.locale import speaking
from centrode.model.settings import Display
from centrode.render.document.numbers import Numbers
from centrode.render.document.spelling import DocumentSpelling
from centrode.render.document.typst import TypstSpelling, decimal, quote, word
from centrode.sheets.texts import Expression, Number
from equation_pages import formulas

from .typst_reading import read

EXAMPLES = [
    *("slider-between-cranks", "six-bar-press", "whitworth-quick-return", "geared-five-bar", "jansen-leg"),
    *(
        "excavator-arm",
        "third-class-triad",
        "spherical-four-bar",
        "rolling-wheel-rod",
        "oscillating-cylinder",
    ),
]


class Written(FormulaSpelling):
    """Every formula as Python code, which Python itself evaluates: no reader of ours is the judge of a printer."""

    def letter(self, letter: Letter) -> str:
        return f"V[{letter.name!r}]"

    def power(self, base: str, power: int) -> str:
        return base if power == 1 else f"{base}**{power}"

    def wave(self, one: Wave, power: int) -> str:
        return self.power(f"{one.kind}({self.angle(one.parts)})", power)

    def angle(self, parts: Parts) -> str:
        return "+".join(f"({count}*{self.letter(letter)})" for letter, count in parts)

    def bars(self, text: str) -> str:
        return f"abs({text})"

    def join(self, factors: Sequence[str]) -> str:
        return "*".join(factors)

    def fraction(self, above: Sequence[str], below: Sequence[str]) -> str:
        return f"(({self.join(above) or '1'})/({self.join(below)}))"

    def root(self, text: str) -> str:
        return f"sqrt({text})"

    def function(self, name: str, text: str) -> str:
        return f"{name}({text})"

    def function_of(self, name: str, letter: Letter) -> str:
        return f"{name}({self.letter(letter)})"

    def product(self, factors: Sequence[str]) -> str:
        return "*".join(factors)

    def minor(self, rows: Sequence[Sequence[str]]) -> str:
        return "det([" + ",".join(f"[{','.join(row)}]" for row in rows) + "])"

    def derivative(self, letter: Letter) -> str:
        return "None"

    def decimal(self, number: float) -> str:
        return f"mpf('{number:.6g}')"


def number_of(name: str) -> Any:
    """A number of its own for every letter, from 0.3 to 1.3, exact in binary."""
    return mpmath.mpf(300 + zlib.crc32(name.encode()) % 1024) / 1024


class Values(dict[str, Any]):
    def __missing__(self, name: str) -> Any:
        return number_of(name)


KNOWN = {
    "sin": mpmath.sin, "cos": mpmath.cos, "tan": mpmath.tan, "arcsin": mpmath.asin, "arccos": mpmath.acos,
    "sqrt": mpmath.sqrt, "atan2": mpmath.atan2, "det": lambda rows: mpmath.det(mpmath.matrix(rows)),
    "mpf": mpmath.mpf, "V": Values(), "t": number_of("t"),
}  # fmt: skip
DIGITS, KEPT = 60, 40
"""Digits that are computed with, and those that must agree: no formula here loses twenty."""


class Noting(TypstSpelling):
    """Keeps which letter each name stands for."""

    def __init__(self) -> None:
        self.names: dict[str, str] = {}

    def letter(self, letter: Letter) -> str:
        told = super().letter(letter)
        self.names[told.replace(" ", "")] = letter.name
        return told


@pytest.mark.parametrize("language", ["en", "uk"])
@pytest.mark.parametrize("name", EXAMPLES)
def test_both_spellings_are_the_same_formulas(name: str, language: str) -> None:
    mechanism = ct.example(name)
    equations = ct.equations(mechanism)
    if not equations.points:
        equations = ct.equations(mechanism, mechanism.moving_points[:2])
    noting = Noting()
    with speaking(language):
        spelled = list(formulas(equations, noting))
        written = list(formulas(equations, Written()))
    assert len(spelled) == len(written)
    derivatives = 0
    with mpmath.workdps(DIGITS):
        for typst, python in zip(spelled, written, strict=True):
            if python == "None":
                assert re.fullmatch(r"frac\(d .+, d t\)", typst)
                derivatives += 1
                continue
            expected = eval(python, dict(KNOWN))
            found = read(typst, lambda told: number_of(noting.names.get(told, told)))
            assert abs(found - expected) <= mpmath.mpf(10) ** -KEPT * max(1, abs(expected)), typst
    assert len(spelled) > derivatives > 0


@pytest.mark.parametrize(
    ("name", "spelled"),
    [
        ("phi2", "phi_(2)"),
        ("phi2_dot", "dot(phi)_(2)"),
        ("l_CA_ddot", 'dot.double(l)_(italic("CA"))'),
        ("x_B", "x_(B)"),
        ("x_B'", 'x_("B\'")'),
        ("Delta_s_A", "Delta_(s_(A))"),
        ("AB", 'italic("AB")'),
        ("x_точка 1", 'x_("точка 1")'),
        ("x_$#a", 'x_("\\u{24}#a")'),
        ("t", "t"),
    ],
)
def test_letters(name: str, spelled: str) -> None:
    assert TypstSpelling().letter(Letter(0, name)) == spelled


@pytest.mark.parametrize(
    ("printed", "english", "russian"),
    [
        ("0.5", "0.5", '"0,5"'),
        ("-0.25", "-0.25", '-"0,25"'),
        ("3", "3", "3"),
        ("1e-07", "1 dot.op 10^(-7)", "1 dot.op 10^(-7)"),
        ("-1.5e+20", "-1.5 dot.op 10^(20)", '-"1,5" dot.op 10^(20)'),
    ],
)
def test_decimals(printed: str, english: str, russian: str) -> None:
    with speaking("en"):
        assert decimal(printed) == english
    with speaking("ru"):
        assert decimal(printed) == russian


def test_what_is_quoted_ends_where_it_should() -> None:
    assert quote('a"b\\c') == '"a\\"b\\\\c"'
    assert quote("a$b") == '"a\\u{24}b"'  # mathematics stands between dollar signs
    assert quote("a\nb\u200e") == '"a b "'
    assert word("x") == "x"
    assert word("12") == "12"


def test_the_sign_of_degrees_stands_close_behind_a_number_with_a_comma() -> None:
    """Typst sets blanks around a string, and a number with a comma is one."""
    spelling = DocumentSpelling(Numbers(Display()))
    formula = Expression("phi = {angle} degree + {whole} degree", angle=Number(12.5), whole=Number(3.0))
    for language, spelled in (
        ("en", "phi = 12.5 degree + 3 degree"),
        ("ru", 'phi = "12,5°" + 3 degree'),
        ("uk", 'phi = "12,5°" + 3 degree'),
    ):
        with speaking(language):
            assert spelling.mathematics(formula) == spelled
