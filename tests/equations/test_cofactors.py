"""Cofactor expansions: every step has the value of the determinant, and is written as by hand."""

from __future__ import annotations

import numpy as np
import pytest

import centrode as ct
from centrode.equations.cofactors import CofactorExpansion
from centrode.equations.spelling import FormulaSpelling
from centrode.equations.symbols import ZERO, Letter, Sum
from mechanisms import EPS
from samples import spread
from worked_out import planar_examples

PLAIN = FormulaSpelling()


def lettered(rows: list[str]) -> CofactorExpansion:
    """A matrix of letters, zeros as dots."""
    entries = [[ZERO if name == "." else Sum.letter(Letter(ord(name), name)) for name in row] for row in rows]
    return CofactorExpansion(tuple(map(tuple, entries)))


def texts(rows: list[str]) -> list[str]:
    return [step.text(PLAIN) for step in lettered(rows).steps]


def test_two_rows_are_multiplied_out() -> None:
    assert texts(["ab", "cd"]) == ["a · d - b · c"]
    assert texts(["ab", ".d"]) == ["a · d"]


def test_three_rows_along_the_line_with_most_zeros() -> None:
    assert texts(["ab.", "cdf", "gh."]) == ["-f |a, b; g, h|", "-f (a · h - b · g)"]
    assert texts(["abc", "dfg", "hkm"]) == [
        "a |f, g; k, m| - b |d, g; h, m| + c |d, f; h, k|",
        "a (f · m - g · k) - b (d · m - g · h) + c (d · k - f · h)",
    ]


def test_four_rows_take_two_steps() -> None:
    first, second, last = texts(["ab..", "cdf.", "gh.k", "..mn"])
    assert first == "a |d, f, 0; h, 0, k; 0, m, n| - b |c, f, 0; g, 0, k; 0, m, n|"
    assert second.count("|") == 8 and "|" not in last


@pytest.mark.parametrize("size", [2, 3, 4])
@pytest.mark.parametrize("zeros", [0, 1, 3])
def test_every_step_is_the_determinant(size: int, zeros: int) -> None:
    random = np.random.default_rng(size + 10 * zeros)
    names = "abcdfghkmnpqrstu"[: size * size]
    for place in random.choice(size * size, zeros, replace=False).tolist():
        names = names[:place] + "." + names[place + 1 :]
    expansion = lettered([names[size * i : size * (i + 1)] for i in range(size)])
    numbers = {Letter(ord(name), name): random.uniform(-2.0, 2.0) for name in names if name != "."}
    matrix = [[one.value(np, numbers.__getitem__) for one in row] for row in expansion.matrix]
    allowed = 64 * EPS * float(np.prod(np.linalg.norm(matrix, axis=1) + 1.0))
    for step in expansion.steps:
        assert abs(step.value(numbers.__getitem__) - np.linalg.det(np.array(matrix))) <= allowed


@pytest.mark.parametrize("name", spread(planar_examples(), 12))
def test_expansions_of_examples(name: str) -> None:
    """At random numbers for all letters every step is the determinant of the system's numbers."""
    found = ct.equations(ct.example(name))
    random = np.random.default_rng(3)
    solutions = [group.velocities for group in found.groups]
    for solution in [*solutions, *([found.together] if found.together is not None else [])]:
        system = solution.system
        if not 1 < len(system.unknowns) <= 4:
            continue
        sums = [*system.right, *(entry for row in system.matrix for entry in row)]
        letters = sorted({letter for one in sums for letter in one.letters})
        values = {letter: random.uniform(0.5, 2.0) for letter in letters}
        for column in (None, *range(len(system.unknowns))):
            expansion = system.expansion(column)
            matrix = np.array(
                [[one.value(np, values.__getitem__) for one in row] for row in expansion.matrix]
            )
            allowed = 256 * EPS * float(np.prod(np.linalg.norm(matrix, axis=1) + 1.0))
            for step in expansion.steps:
                assert abs(step.value(values.__getitem__) - np.linalg.det(matrix)) <= allowed


def test_the_source_s_determinant() -> None:
    text = ct.summary(ct.equations(ct.example("slider-between-cranks")))
    assert "Δ = l₂ cos φ₂ |l₃ sin φ₃, l₄ sin φ₄; l₃ cos φ₃, l₄ cos φ₄|\n" in text
    assert "= l₂ cos φ₂ (l₃ sin φ₃ · l₄ cos φ₄ - l₄ sin φ₄ · l₃ cos φ₃)\n" in text
