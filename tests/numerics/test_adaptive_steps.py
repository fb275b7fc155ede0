"""Adaptive steps, against SciPy's solver of the same scheme and against closed forms."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt
import pytest
from scipy.integrate import DOP853

from centrode.numerics.adaptive_steps import AdaptiveSteps

Array = npt.NDArray[np.float64]


def pendulum(_time: float, state: Array) -> Array:
    return np.array([state[1], -9.81 * np.sin(state[0])])


def orbit(_time: float, state: Array) -> Array:
    x, y, u, v = state
    return np.array([u, v, *(-np.array([x, y]) / np.hypot(x, y) ** 3)])


@pytest.mark.parametrize("end", [7.0, -3.0])
@pytest.mark.parametrize("tolerance", [1e-4, 1e-10])
@pytest.mark.parametrize(("rates", "initial"), [(pendulum, [2.5, 0.0]), (orbit, [0.5, 0.0, 0.0, 1.7])])
def test_steps_and_polynomials_are_those_of_scipy(
    rates: Callable[[float, Array], Array], initial: list[float], tolerance: float, end: float
) -> None:
    """The same operations in the same order: every step ends at the same place, up to the last bits."""
    start, absolute = np.array(initial), np.full(len(initial), tolerance)
    own = AdaptiveSteps(rates, 0.0, start, end, tolerance, absolute, 0.5)
    theirs = DOP853(rates, 0.0, start, end, rtol=tolerance, atol=absolute, max_step=0.5)
    while not own.is_finished:
        assert own.step()
        assert theirs.step() is None
        assert abs(own.t - theirs.t) <= 1e-12 * abs(end)
        assert np.allclose(own.y, theirs.y, rtol=1e-11, atol=1e-12)
        places = np.linspace(own.dense_output().t_old, own.t, 5)
        assert np.allclose(own.dense_output()(places), theirs.dense_output()(places), rtol=1e-11, atol=1e-12)
        assert np.array_equal(own.dense_output()(places[2]), own.dense_output()(places)[:, 2])
    assert theirs.status == "finished"


def test_a_polynomial_keeps_to_the_solution_between_the_ends() -> None:
    """x'' = -x: the polynomial is of order seven."""
    steps = AdaptiveSteps(
        lambda _t, x: np.array([x[1], -x[0]]), 0.0, np.array([0.0, 1.0]), 10.0, 1e-9, np.full(2, 1e-9), 9.0
    )
    while not steps.is_finished:
        assert steps.step()
        course = steps.dense_output()
        places = np.linspace(course.t_old, course.t, 9)
        assert np.abs(course(places) - [np.sin(places), np.cos(places)]).max() <= 1e-7


def test_no_step_is_left_where_the_solution_goes_to_infinity() -> None:
    """x' = x^2 from 1 has a pole at t = 1."""
    steps = AdaptiveSteps(lambda _t, x: x**2, 0.0, np.ones(1), 2.0, 1e-8, np.full(1, 1e-8), 1.0)
    with np.errstate(all="ignore"):
        for _step in range(10_000):
            if not steps.step() or not np.isfinite(steps.y).all():
                break
    assert abs(steps.t - 1.0) <= 1e-6
