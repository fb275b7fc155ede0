"""Numbers of reports: digits, signs, units, the decimal mark."""

from __future__ import annotations

import math
import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from centrode.locale import speaking
from centrode.model.settings import Display
from centrode.quantities import spelled_unit
from centrode.render.document.numbers import MINUS, Numbers
from centrode.render.document.spelling import DocumentSpelling
from centrode.sheets.texts import Number

FINITE = st.floats(-1e9, 1e9, allow_subnormal=False)
RAISED = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")
POWER = re.compile(r"(.*)·10([⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)")


def value_of(text: str) -> float:
    """The number that a reader sees."""
    found = POWER.fullmatch(text)
    digits, power = (found[1], int(found[2].translate(RAISED))) if found else (text, 0)
    return float(f"{digits.replace(MINUS, '-').replace(',', '.')}e{power}")


def numbers(digits: int = 5, **display: str) -> Numbers:
    return Numbers(Display(**display), digits)


@given(FINITE, st.integers(2, 12), st.sampled_from(["en", "ru", "uk"]))
def test_a_number_keeps_its_digits(value: float, digits: int, language: str) -> None:
    with speaking(language):
        text = numbers(digits).plain(value)
    # half a unit of the last digit, of which the first may be a one
    assert abs(value_of(text) - value) <= 0.5 * 10.0 ** (1 - digits) * abs(value) * (1 + 1e-9)
    assert "-" not in text
    assert ("," in text) <= (language != "en")
    assert ("." in text) <= (language == "en")


@given(st.lists(FINITE, min_size=1, max_size=8), st.integers(2, 12))
def test_a_column_has_the_digits_of_its_greatest(values: list[float], digits: int) -> None:
    column = numbers(digits).column(values)
    greatest = max(map(abs, values))
    for value, text in zip(values, column, strict=True):
        assert abs(value_of(text) - value) <= 0.5 * 10.0 ** (1 - digits) * greatest * (1 + 1e-9)
        assert not (text.startswith(MINUS) and value_of(text) == 0.0)
    fixed = [text for text in column if not POWER.fullmatch(text)]
    assert len({len(text.partition(".")[2]) for text in fixed}) <= 1 or len(fixed) < len(column)


@pytest.mark.parametrize(
    ("values", "told"),
    [
        ([1.0, -0.00001, 0.25], ("1.0000", "0.0000", "0.2500")),
        ([0.0, -0.0], ("0", "0")),
        ([120.5, math.nan, math.inf], ("120.50", "—", "∞")),
        ([12345.678, 1.0], ("12346", "1")),
        ([2e-12, 0.0], ("2·10⁻¹²", "0")),
        ([-3e9], (f"{MINUS}3·10⁹",)),
    ],
)
def test_columns(values: list[float], told: tuple[str, ...]) -> None:
    assert numbers().column(values) == told


def test_what_is_rounding_is_zero() -> None:
    assert numbers().column([1e-17, 2e-17], least=1e-15) == ("0", "0")


def test_units_of_the_display() -> None:
    small = numbers(length="mm", angle="deg")
    assert small.with_unit(0.5, "m") == "500\u202fmm"
    assert small.with_unit(math.pi, "rad") == "180°"
    assert small.with_unit(math.pi, "rad/s^2") == "180\u202f°/s²"
    assert small.with_unit(2.0, "m/rad^2") == "2000\u202fmm/rad²"  # analogs stay by radian
    assert small.with_unit(-2.0, "N m") == f"{MINUS}2\u202fN·m"
    assert small.head("$v$", "m/s") == "$v$, mm/s"
    assert small.head("$φ$", "rad") == "$φ$,\u00a0°"
    assert small.head("n", "1") == "n"
    assert small.math(-0.5, "m") == "-500"


def test_the_decimal_mark_is_the_language_s() -> None:
    with speaking("uk"):
        assert numbers().with_unit(0.5, "m") == "0,5\u202fм"
        assert numbers().math(0.5) == '"0,5"'
        assert numbers().column([0.5]) == ("0,50000",)


def test_names_of_units() -> None:
    assert [spelled_unit(unit) for unit in ("kg m^2", "deg/s", "1", "", "um")] == [
        *("kg·m²", "°/s", "", "", "µm"),
    ]


@given(st.floats(1.0, 9.9), st.integers(2, 5))
def test_one_number_is_rounded_once_wherever_it_stands(value: float, digits: int) -> None:
    spelling = DocumentSpelling(numbers(digits))
    told = spelling.number(Number(value, "1", digits=".7f"))  # more digits than the document has
    assert told == spelling.number(Number(value, "1", digits=""))


def test_an_angle_on_the_edge_of_two_roundings_is_the_same_everywhere() -> None:
    place = 114.84500001  # 114.845 to six digits, which as a float is rounded down
    spelling = DocumentSpelling(numbers(5))
    assert spelling.number(Number(place, "1", digits=".6g")) == spelling.number(Number(place, "1", digits=""))
    assert spelling.number(Number(place, "1", digits=".6g")) == "114.85"
