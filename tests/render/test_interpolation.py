"""Curves between their samples: exact cubics, the order of the error, gaps, corners and jumps."""

from __future__ import annotations

import numpy as np
import pytest

from centrode.render.figures.interpolation import akima_slopes, interpolated_curve, jumps

EPS = 2.0**-52


def test_a_cubic_is_drawn_exactly_with_its_slopes() -> None:
    x = np.linspace(-1.0, 2.0, 9)
    across, drawn = interpolated_curve(x, x**3 - x, 3.0 * x**2 - 1.0)
    assert len(across) > 300
    assert np.max(np.abs(drawn - (across**3 - across))) <= 32 * EPS * 6.0


@pytest.mark.parametrize("count", [37, 73])
def test_the_error_with_slopes_is_that_of_hermite(count: int) -> None:
    x = np.linspace(0.0, 2.0 * np.pi, count)
    across, drawn = interpolated_curve(x, np.sin(x), np.cos(x))
    # the fourth derivative is at most one: h^4 / 384
    assert np.max(np.abs(drawn - np.sin(across))) <= (x[1] - x[0]) ** 4 / 384 * (1.0 + 1e-9)


def test_samples_are_kept_and_gaps_stay() -> None:
    x = np.linspace(0.0, 1.0, 21)
    y = x**2
    y[7:9] = np.nan
    across, drawn = interpolated_curve(x, y)
    np.testing.assert_array_equal(drawn[np.isin(across, x)], y)
    inside = (across > x[6]) & (across < x[9])
    assert np.isnan(drawn[inside]).all()
    assert np.isfinite(drawn[(across < x[6]) | (across > x[9])]).all()


def test_akima_follows_parabolas_and_does_not_swing_beside_a_corner() -> None:
    x = np.linspace(0.0, 1.0, 11)
    assert akima_slopes(x, x**2) == pytest.approx(2.0 * x, abs=32 * EPS)
    across, drawn = interpolated_curve(x, np.abs(x - 0.5))
    wrong = np.abs(drawn - np.abs(across - 0.5))
    # in the corner the slope is the mean of both sides: the steps beside it are round, no other one
    beside = np.abs(across - 0.5) < 0.1 * (1.0 - 1e-9)
    assert np.max(wrong[~beside]) <= 8 * EPS
    assert np.max(wrong[beside]) <= 0.1 * 4 / 27 * (1.0 + 1e-9)


def test_a_jump_is_found_and_a_steep_slope_is_none() -> None:
    x = np.linspace(0.0, 1.0, 101)
    assert jumps(x, np.where(x < 0.305, x, x - 2.0)).tolist() == [30]
    assert jumps(x, np.tanh(40.0 * (x - 0.5))).size == 0
    assert jumps(x, np.full(101, 3.0)).size == 0


def test_a_curve_that_turns_back_follows_its_samples() -> None:
    turn = np.linspace(0.0, 2.0 * np.pi, 73)
    x, y = interpolated_curve(np.cos(turn), np.sin(turn))
    assert len(x) == len(y) > 300
    # a circle between its samples, to the fourth power of the step
    assert np.max(np.abs(np.hypot(x, y) - 1.0)) <= (turn[1] - turn[0]) ** 3
