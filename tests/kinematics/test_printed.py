"""The numbers that the source documents print, all of them, through the built-in examples."""

from __future__ import annotations

import numpy as np
import pytest
from tools.validation import kinematics, literature
from tools.validation.rows import Column, Row

import centrode as ct
from mechanisms import EPS, link, statuses

ASSIGNMENT, EXCERPT, PRESS = kinematics.assignment(), kinematics.excerpt(), kinematics.coursework()


@pytest.mark.parametrize("column", ASSIGNMENT.columns, ids=lambda column: column.quantity)
def test_assignments_table(column: Column) -> None:
    assert column.agreeing == len(column.printed) == 50, column.worst


def test_all_columns_of_the_assignment_are_there() -> None:
    assert len(ASSIGNMENT.columns) == 8


def test_assignments_last_row_repeats_the_first() -> None:
    data = ct.motion(ct.example("slider-between-cranks"), 101)
    assert set(statuses(data)) == {"ok"}
    for name in ("AC", "CB", "BD"):
        angle = link(data, name)
        # the drive's last value is 2 pi rounded: half a unit of it turns into position errors of the same order
        assert abs(angle[-1] - angle[0]) <= 16 * EPS * 2 * np.pi


@pytest.mark.parametrize("column", EXCERPT.columns, ids=lambda column: column.quantity)
def test_excerpts_table(column: Column) -> None:
    assert column.agreeing == len(column.printed) == 16, column.worst


@pytest.mark.parametrize("row", PRESS.rows, ids=lambda row: f"{row.quantity} {row.symbol}")
def test_courseworks_numbers(row: Row) -> None:
    assert row.agrees, row


def test_all_kinematic_rows_of_the_coursework_are_there() -> None:
    assert len(PRESS.rows) == 47


@pytest.mark.parametrize("row", literature.squeezer().rows, ids=lambda row: row.symbol)
def test_andrews_reference_solution(row: Row) -> None:
    """The integrated solution drifts off its constraints: it is published to about ten digits."""
    assert row.agrees, row
