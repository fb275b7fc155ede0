"""Integration of Cauchy's form: order of the method, control of errors, and the end where the determinant is zero."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt
import pytest

import centrode as ct
from centrode.equations import integration
from centrode.equations.integration import LOST, adaptive_steps, determinant, fixed_steps
from centrode.errors import InputError
from worked_form import L2, L3, L4, Worked

Array = npt.NDArray[np.float64]

TURNING = Worked((0.5, 1.9, 3.5))
LOCKING = Worked((0.5, 4.7, 5.7))
LIMIT = 1.79991241652444
"""Where CB and BD are collinear: |CD| = 2 (computed to 30 digits beside the example)."""


def turn(steps: int) -> Array:
    return np.linspace(0.0, 2 * np.pi, steps + 1)


def plain_runge_kutta(form: Worked, steps: int) -> Array:
    """The method as textbooks print it, with nothing around it."""
    h = 2 * np.pi / steps
    states = [form.initial]
    for i in range(steps):
        t, x = i * h, states[-1]
        k1 = form.rates(t, x)
        k2 = form.rates(t + h / 2, x + h / 2 * k1)
        k3 = form.rates(t + h / 2, x + h / 2 * k2)
        k4 = form.rates(t + h, x + h * k3)
        states.append(x + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4))
    return np.array(states)


def test_fixed_steps_are_the_textbooks() -> None:
    found = fixed_steps(TURNING, turn(100))
    # times i h and those of linspace differ by a rounding of 2 pi, rates are near 1
    assert np.abs(found.state - plain_runge_kutta(TURNING, 100)).max() <= 100 * 2**-52 * 2 * np.pi
    assert (found.stop, found.lost, found.steps) == (None, None, 100)
    assert np.array_equal(found.rates, TURNING.rates(turn(100), found.state))


def test_fixed_steps_are_of_fourth_order() -> None:
    exact = adaptive_steps(TURNING, turn(100), 1e-13).state
    errors = [np.abs(fixed_steps(TURNING, turn(n)).state[:: n // 100] - exact).max() for n in (400, 800)]
    # halving the step divides the error by 16, to the next order of the step: 800 steps of 1/120 rad
    assert errors[0] / errors[1] == pytest.approx(16, rel=0.1)


@pytest.mark.parametrize("tolerance", [1e-5, 1e-8, 1e-11])
def test_adaptive_steps_keep_to_their_tolerance(tolerance: float) -> None:
    found = adaptive_steps(TURNING, turn(50), tolerance)
    # a step may err by tolerance (1 + |x|) in each of three unknowns; the exact flow keeps what has drifted, and the
    # constraints change by at most the links' lengths a radian
    each = np.sqrt(3) * tolerance * (1 + np.abs(found.state).max())
    drift = np.abs(TURNING.constraints(turn(50), found.state)).max()
    assert drift <= found.steps * each * (L2 + L3 + L4) / L3


def test_backwards() -> None:
    times = -turn(40)
    there = adaptive_steps(TURNING, times, 1e-10)
    # the crank's motion is periodic: a turn backwards ends where a turn forwards does
    assert np.abs(there.state[-1] - TURNING.initial).max() <= there.steps * 1e-10 * 10
    assert np.abs(fixed_steps(TURNING, times).state - there.state).max() < 1e-3


@pytest.mark.parametrize("tolerance", [1e-6, 1e-9, 1e-12])
def test_a_limit_is_told_and_nothing_beyond(tolerance: float) -> None:
    times = turn(100)
    found = adaptive_steps(LOCKING, times, tolerance)
    assert found.stop is not None
    # the limit moves with |CD|, which drifts by at most that of the steps; |CD| changes at some 0.4 m/s there
    slip = found.steps * np.sqrt(3) * tolerance * (1 + 5.7) * (L2 + L3 + L4)
    assert abs(found.stop - LIMIT) <= slip / 0.4
    known = np.isfinite(found.state).all(axis=1)
    assert np.array_equal(known, times <= found.stop)


def test_fixed_steps_stop_at_a_limit_too() -> None:
    times = turn(100)
    found = fixed_steps(LOCKING, times)
    assert found.stop == pytest.approx(LIMIT, abs=1e-8)
    assert np.isfinite(found.state[times < LIMIT]).all()
    assert np.isnan(found.state[times > LIMIT]).all()
    # without the judge they would run on through it, and come out as numbers
    assert np.isfinite(plain_runge_kutta(LOCKING, 100)).all()


def test_states_that_left_the_mechanism_are_lost() -> None:
    times = turn(5)
    plain = plain_runge_kutta(TURNING, 5)
    drift = np.abs(TURNING.constraints(times, plain)).max(axis=1)
    signs = np.sign(determinant(TURNING, times, plain))
    wrong = (drift > LOST) | (signs != signs[0])
    assert wrong.any()
    found = fixed_steps(TURNING, times)
    assert found.stop is None
    assert found.lost == times[np.argmax(wrong)]
    assert np.isnan(found.state[np.argmax(wrong) :]).all()
    assert np.isfinite(found.state[: np.argmax(wrong)]).all()


def test_the_determinant_is_cramers() -> None:
    times = turn(48)
    states = fixed_steps(TURNING, times).state
    _two, three, four = states.T
    # (2.7) with its second row's sign turned round: -l2 l3 l4 sin(phi3 - phi4) cos phi2, lengths over l3
    cramer = -L2 * L3 * L4 * np.sin(three - four) * np.cos(states[:, 0]) / L3**3
    # differences of 1e-6: their error is 1e-12 by the third derivative and 1e-10 by rounding, in each of three rows
    assert determinant(TURNING, times, states) == pytest.approx(cramer, abs=1e-9)


def test_a_start_at_a_dead_point() -> None:
    found = adaptive_steps(Worked((np.pi / 2, 1.0, 2.0)), turn(4), 1e-8)
    assert found.stop == 0.0
    assert np.isnan(found.state[1:]).all()


def test_one_row() -> None:
    found = fixed_steps(TURNING, np.zeros(1))
    assert np.array_equal(found.state, TURNING.initial[None])


def test_too_many_steps_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(integration, "MOST_ADAPTIVE_STEPS", 10)
    with pytest.raises(InputError, match="more than 10 steps"):
        adaptive_steps(TURNING, turn(4), 1e-10)


@pytest.mark.parametrize("stop", [95.0, 150.0])
def test_towards_infinity_the_integration_ends_soon(stop: float) -> None:
    """A slide driven by a slotted lever goes as the tangent: to infinity at 90 degrees, in a few steps a decade."""
    found = ct.integrate(ct.example("tangent-mechanism"), "adaptive", stop=math.radians(stop))
    assert found.attrs["stop_time"] == pytest.approx(math.pi / 2, abs=1e-9)
    assert found.attrs["steps_taken"] < 300
