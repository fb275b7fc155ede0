"""The algebra of sums against SymPy, and pairs of waves taken together as the textbooks do."""

from __future__ import annotations

import math
import sys
from fractions import Fraction

import pytest
import sympy
from hypothesis import given, settings
from hypothesis import strategies as st

from centrode.equations.spelling import FormulaSpelling, formula_of, parts_of, spell_formula, spelled_sum
from centrode.equations.symbols import Angle, Letter, Sum, SumTerm, expression, merge_waves

ANGLES = [Letter(i, f"phi{i}") for i in range(1, 4)]
LENGTHS = [Letter(100 + i, f"l{i}") for i in range(1, 4)]
EPS = 2.0**-52


def sin(*parts: tuple[int, int]) -> Sum:
    return Sum.wave("sin", angle(*parts))


def cos(*parts: tuple[int, int]) -> Sum:
    return Sum.wave("cos", angle(*parts))


def angle(*parts: tuple[int, int]) -> Angle:
    total = Angle()
    for i, count in parts:
        total = total.plus(Angle.of(ANGLES[i - 1]), count)
    return total


def length(i: int) -> Sum:
    return Sum.letter(LENGTHS[i - 1])


def simple_sums() -> st.SearchStrategy[Sum]:
    small = st.integers(-2, 2)
    waves = st.builds(
        lambda kind, a, b, quarters: Sum.wave(kind, angle((1, a), (2, b)).turned_by(quarters)),
        st.sampled_from(("sin", "cos")), small, small, st.integers(0, 3),
    )  # fmt: skip
    letters = st.builds(length, st.integers(1, 3))
    numbers = st.builds(Sum.number, st.integers(-3, 3))
    factors = st.lists(st.one_of(waves, letters, numbers), min_size=1, max_size=4)

    def product(parts: list[Sum]) -> Sum:
        total = Sum.number(1)
        for one in parts:
            total = total * one
        return total

    return st.builds(
        lambda products: sum((product(one) for one in products), Sum({})), st.lists(factors, max_size=4)
    )


NUMBERS = dict(zip([*ANGLES, *LENGTHS], (0.3, 1.1, 2.7, 0.5, 1.7, 0.9), strict=True))


def number(total: Sum) -> float:
    return float(total.value(math, NUMBERS.__getitem__))


def size(total: Sum) -> float:
    """Sum of the sizes of the terms: what rounding is compared with."""
    return sum(abs(number(Sum({term: x}))) for term, x in total.terms.items())


def allowed(*totals: Sum) -> float:
    return 64 * EPS * (1.0 + sum(map(size, totals)))


@given(simple_sums(), simple_sums())
def test_sums_add_and_multiply_as_numbers_do(one: Sum, other: Sum) -> None:
    assert abs(number(one + other) - (number(one) + number(other))) <= allowed(one, other)
    assert abs(number(one - other) - (number(one) - number(other))) <= allowed(one, other)
    assert abs(number(one * other) - number(one) * number(other)) <= allowed(one * other)


@given(simple_sums())
def test_taken_together_a_sum_stays_what_it_is(total: Sum) -> None:
    assert abs(number(merge_waves(total)) - number(total)) <= allowed(total)
    assert len(merge_waves(total).terms) <= len(total.terms)
    found = formula_of(total)
    assert abs(number(found.total) - number(total)) <= allowed(total, found.total)


@settings(max_examples=25)
@given(simple_sums())
def test_slopes_are_those_of_sympy(total: Sum) -> None:
    for letter in (ANGLES[0], LENGTHS[0]):
        by_sympy = sympy.diff(expression(total), sympy.Symbol(letter.name))
        here = by_sympy.subs({sympy.Symbol(x.name): value for x, value in NUMBERS.items()})
        slope = total.slope(letter)
        assert abs(number(slope) - float(here)) <= allowed(slope)


PAIRS = {
    "sine of a difference": (sin((1, 1)) * cos((2, 1)) - cos((1, 1)) * sin((2, 1)), "sin(φ₁ - φ₂)"),
    "turned round": (cos((1, 1)) * sin((2, 1)) - sin((1, 1)) * cos((2, 1)), "-sin(φ₁ - φ₂)"),
    "cosine of a difference": (cos((1, 1)) * cos((2, 1)) + sin((1, 1)) * sin((2, 1)), "cos(φ₁ - φ₂)"),
    "sine of a sum": (sin((1, 1)) * cos((2, 1)) + cos((1, 1)) * sin((2, 1)), "sin(φ₁ + φ₂)"),
    "cosine of a sum": (cos((1, 1)) * cos((2, 1)) - sin((1, 1)) * sin((2, 1)), "cos(φ₁ + φ₂)"),
    "one": (sin((1, 1)) * sin((1, 1)) + cos((1, 1)) * cos((1, 1)), "1"),
    "double angle": (cos((1, 1)) * cos((1, 1)) - sin((1, 1)) * sin((1, 1)), "cos(2 φ₁)"),
    "three angles": (
        length(1) * (sin((1, 1), (2, -1)) * cos((3, 1)) - cos((1, 1), (2, -1)) * sin((3, 1))),
        "l₁ sin(φ₁ - φ₂ - φ₃)",
    ),
    "no pair": (sin((1, 1)) * cos((2, 1)) - length(1) * cos((1, 1)) * sin((2, 1)), None),
}


@pytest.mark.parametrize("name", PAIRS)
def test_pairs_become_one_wave(name: str) -> None:
    total, text = PAIRS[name]
    found = merge_waves(total)
    if text is None:
        assert found == total
    else:
        assert spelled_sum(found, FormulaSpelling()) == text


def test_right_angles_are_signs_and_other_functions() -> None:
    for quarters in range(4):
        for kind in ("sin", "cos"):
            turned = Sum.wave(kind, angle((1, 1)).turned_by(quarters))
            function = math.sin if kind == "sin" else math.cos
            assert number(turned) == pytest.approx(function(0.3 + quarters * math.pi / 2), abs=4 * EPS)
    assert Sum.wave("cos", Angle((), 2)) == Sum.number(-1)
    assert Sum.wave("sin", Angle((), 2)) == Sum({})


def test_formulas_are_written_as_in_textbooks() -> None:
    l1, l2, phi = LENGTHS[0], LENGTHS[1], sin((2, 1)).terms
    under = SumTerm(((l2, 1),), next(iter(phi)).waves)
    single = formula_of((length(1) * cos((1, 1))).divide(under).scale(-1))
    assert str(single) == "-(l₁/l₂) cos φ₁/sin φ₂"
    several = formula_of((length(1) * cos((1, 1)) + length(3) * cos((2, 1))).divide(under))
    assert str(several) == "(l₁ cos φ₁ + l₃ cos φ₂)/(l₂ sin φ₂)"
    assert str(formula_of(Sum({}))) == "0"
    assert str(formula_of(Sum.number(Fraction(-1, 2)))) == "-1/2"
    assert str(formula_of(Sum({SumTerm(((l1, -1),)): 3}))) == "3/l₁"
    assert str(formula_of(Sum({SumTerm(((l1, 2),)): 1}))) == "l₁²"
    difference = formula_of(-sin((1, 1), (2, -1)) * cos((3, 1)))
    assert spell_formula(difference, FormulaSpelling(), turned=True) == "cos φ₃ sin(φ₂ - φ₁)"
    assert spell_formula(difference, FormulaSpelling(), differences_first=True) == "-sin(φ₁ - φ₂) cos φ₃"


@pytest.mark.parametrize(
    ("name", "parts"),
    [
        ("phi12", ("phi", "12", "")),
        ("l_A1P", ("l", "A1P", "")),
        ("s_A_dot", ("s", "A", "dot")),
        ("phi2_dot", ("phi", "2", "dot")),
        ("s_my_dots_ddot", ("s", "my_dots", "ddot")),
        ("x_B’ x", ("x", "B’ x", "")),
        ("Delta_II", ("Delta", "II", "")),
    ],
)
def test_names_fall_into_letter_index_and_dots(name: str, parts: tuple[str, str, str]) -> None:
    assert parts_of(name) == parts


def test_without_sympy_the_repair_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys.modules[expression.__module__], "find_spec", lambda _name: None)
    with pytest.raises(Exception, match=r"need SymPy.*pip install.*\[symbols\]"):
        expression(length(1))
