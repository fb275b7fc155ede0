"""Standard tolerances against the formulas of ISO 286-1 that the table rounds, and against printed values."""

from __future__ import annotations

import math
from itertools import pairwise

import pytest

from centrode.errors import InputError
from centrode.model.limits_and_fits import STEPS, standard_tolerance, tolerance_class, widest_grade

FACTORS = {
    5: 7,
    6: 10,
    7: 16,
    8: 25,
    9: 40,
    10: 64,
    11: 100,
    12: 160,
    13: 250,
    14: 400,
    15: 640,
    16: 1000,
    17: 1600,
    18: 2500,
}
"""Tolerances of grades in units of the tolerance factor (ISO 286-1, Annex A)."""


@pytest.mark.parametrize("grade", FACTORS)
def test_table_rounds_the_formula_of_the_standard(grade: int) -> None:
    for low, high in pairwise((1, *STEPS)):
        mean = math.sqrt(low * high)
        factor = 0.45 * mean ** (1 / 3) + 0.001 * mean if high <= 500 else 0.004 * mean + 2.1
        exact = FACTORS[grade] * factor
        # the standard rounds the smallest sizes up, others to preferred numbers
        rounding = 0.16 if high <= 6 else 0.06
        assert standard_tolerance(high / 1e3, grade) * 1e6 == pytest.approx(exact, rel=rounding), (
            grade,
            high,
        )


def test_printed_values() -> None:
    """ISO 286-1:2010, Table 1, and limits of H7, h6 and js9 that every handbook prints."""
    assert standard_tolerance(0.040, 7) == 25e-6
    assert standard_tolerance(0.003, 1) == 0.8e-6
    assert standard_tolerance(3.150, 18) == 33e-3
    assert standard_tolerance(0.0300001, 6) == 16e-6
    assert tolerance_class("H7").deviations(0.025) == (0.0, 21e-6)
    assert tolerance_class("h6").deviations(0.1) == (-22e-6, 0.0)
    assert tolerance_class("js9").deviations(0.06) == (-37e-6, 37e-6)
    assert tolerance_class("IT7").deviations(0.040) == (-12.5e-6, 12.5e-6)


def test_steps_end_with_their_upper_size() -> None:
    for end in STEPS:
        # the size itself may come from a text in millimetres
        assert standard_tolerance(end / 1000, 7) == standard_tolerance(end / 1000 - 1e-6, 7)
        if end < STEPS[-1]:
            assert standard_tolerance(end / 1000 + 1e-6, 7) > standard_tolerance(end / 1000, 7)


def test_widest_grade() -> None:
    assert widest_grade(0.040, 25e-6) == 7
    assert widest_grade(0.040, 24.9e-6) == 6
    assert widest_grade(0.040, 1e-6) is None


@pytest.mark.parametrize("size", [0.0, -1.0, 3.1501, 10.0])
def test_sizes_beyond_the_table_are_refused(size: float) -> None:
    with pytest.raises(InputError, match="3150"):
        standard_tolerance(size, 7)


@pytest.mark.parametrize("text", ["g6", "IT0", "IT19", "H", "7", "k 6", "HH7"])
def test_unknown_classes_are_refused(text: str) -> None:
    with pytest.raises(InputError):
        tolerance_class(text)
