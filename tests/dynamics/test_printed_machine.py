"""The coursework's flywheel and real motion: all of its printed numbers, and the right ones beside them."""

from __future__ import annotations

import numpy as np
import pytest
from tools.validation import machines
from tools.validation.rows import Row

import centrode as ct

ROWS = machines.coursework().rows


@pytest.mark.parametrize("row", ROWS, ids=lambda row: f"{row.quantity} {row.symbol}")
def test_the_printed_numbers(row: Row) -> None:
    assert row.agrees, row


def test_all_rows_of_the_dynamics_are_there() -> None:
    assert len(ROWS) == 101 - 47


@pytest.mark.parametrize("row", machines.thesis().rows, ids=lambda row: row.quantity)
def test_the_steady_speeds_of_the_thesis(row: Row) -> None:
    assert row.agrees, row


def test_the_right_numbers() -> None:
    """With m3 and the slider: J_II = 15.457, J_I = 1462.0, epsilon = -2.768, T1_max by exact integration.

    The source counts its angle as the crank turns, this description against it, so that epsilon has the other sign.
    """
    assert abs(machines.flywheel().energy_greatest - 599.813) <= 0.0005
    right = ct.example("six-bar-press")
    found, data = ct.flywheel(right), ct.steady_motion(right, at=[machines.AT], method="first-order")
    assert abs(float(data["inertia_of_links"][0]) - 15.457) <= 0.0005
    assert found.inertia_first_order is not None
    assert abs(found.inertia_first_order - 1462.0) <= 0.05
    assert abs(float(data["drive_acceleration_first_order"][0]) - 2.768) <= 0.0005
    assert found.rim is not None
    assert abs(found.rim.outer - 1.744) <= 0.001
    assert abs(found.rim.mass - 2340) <= 3


def test_the_exact_speed_differs_by_the_second_order() -> None:
    """What the first-order formula leaves out: squares of the fluctuation, and the energy of the links."""
    mechanism = ct.example("six-bar-press")
    data = ct.steady_motion(mechanism, 181)
    apart = np.abs(data["drive_speed"] - data["drive_speed_first_order"]).max()
    links = float(data["inertia_of_links"].max()) / data.attrs["inertia"]
    assert 0.0 < apart <= 6.807 * (0.11**2 / 2 + 0.11 * links)
