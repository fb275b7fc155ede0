"""States between the steps of a scheme: of its order, against closed forms and the scheme's own states at its steps."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
import scipy.special

import centrode as ct
from simulated import crank_rocker, pendulum, rotor, sledge, spherical

EPS = 2.0**-52
FIRST_AND_LAST = [1e-6, 1.0 - 1e-6]
"""Shares of the duration within the first and the last step."""


def swinging(times: np.ndarray) -> np.ndarray:
    """A pendulum of 0.7 m released from the horizontal: theta = 2 asin(k sn(w t + K, k)), from the vertical."""
    k, w = math.sin(math.pi / 4), math.sqrt(9.81 / 0.7)
    sn = scipy.special.ellipj(w * times + scipy.special.ellipk(k * k), k * k)[0]
    return 2 * np.arcsin(k * sn) - math.pi / 2


def test_the_order_between_steps_against_elliptic_functions() -> None:
    """Half the step, a sixteenth of the error, wherever in a step; the nearest step would miss by half a step."""
    shares = np.sort([*FIRST_AND_LAST, *np.random.default_rng(3).uniform(size=30)])
    expected = swinging(2.0 * shares)
    errors = []
    for steps in (200, 400, 800):
        settings = ct.Simulation(duration=2, scheme="runge-kutta-4", steps=steps)
        found = ct.simulate(pendulum(), settings, at=2.0 * shares)
        errors.append(float(np.linalg.norm(found.drive_value.values[:, 0] - expected)))
    orders = [math.log2(errors[k] / errors[k + 1]) for k in range(2)]
    assert orders == pytest.approx([4, 4], abs=0.15)


@pytest.mark.parametrize("name", ["plane", "sphere"])
def test_the_order_of_all_states_between_steps(name: str) -> None:
    """Speed, value, works and acceleration of linkages, no worse between the steps than at them but by half."""
    mechanism = crank_rocker() if name == "plane" else spherical(math.pi / 12, math.pi / 4)
    settings = ct.Simulation(driving="2 - 0.2*v", speed=3, duration=1, tolerance=1e-13)
    shares = np.sort([*FIRST_AND_LAST, *np.random.default_rng(4).uniform(size=30)])
    names = ("drive_speed", "turned", "work_of_drive", "work_of_friction", "drive_acceleration")

    def missed(at: np.ndarray, steps: int) -> dict[str, float]:
        exact = ct.simulate(mechanism, settings, at=at)
        fixed = settings.model_copy(update={"scheme": "runge-kutta-4", "steps": steps})
        found = ct.simulate(mechanism, fixed, at=at)
        return {name: float(np.sqrt(np.mean((found[name] - exact[name]).values ** 2))) for name in names}

    between = [missed(shares, steps) for steps in (200, 400)]
    at_steps = missed(np.linspace(0.0, 1.0, 51), 400)
    for one in names:
        if at_steps[one] == 0.0:  # without friction its work is none
            continue
        assert math.log2(between[0][one] / between[1][one]) == pytest.approx(4, abs=0.6)
        assert between[1][one] <= 2.0 * at_steps[one]


def test_at_its_steps_a_scheme_gives_its_states() -> None:
    """Straight speeds and parabolas of the angle come out to rounding at every time, steps as the scheme finds them."""
    settings = ct.Simulation(driving="1", duration=1, scheme="runge-kutta-4", steps=10, samples=11)
    at = np.linspace(0.0, 1.0, 101)
    found = ct.simulate(rotor(), settings, at=at)
    assert found.drive_speed.values == pytest.approx(2 * at, abs=32 * EPS)
    assert found.turned.values == pytest.approx(at**2, abs=32 * EPS)
    steps = ct.simulate(rotor(), settings)
    again = ct.simulate(rotor(), settings, at=steps.time.values)
    assert again.drive_speed.values.tolist() == steps.drive_speed.values.tolist()


def test_a_jump_is_felt_on_its_own_step_alone() -> None:
    """The moment jumps at 0.55 s within the step from 0.5 s to 0.6 s: on all others the speed is straight."""
    settings = ct.Simulation(driving="2 + sign(t - 0.55)", duration=1, scheme="runge-kutta-4", steps=10)
    times = np.array([0.0, 0.1, 0.13, 0.2, 0.4, 0.47, 0.5, 0.6, 0.61, 0.69, 0.7, 0.9, 0.99, 1.0])
    found = ct.simulate(rotor(), settings, at=times).drive_speed.values
    before = times <= 0.5
    assert found[before] == pytest.approx(2 * times[before], abs=64 * EPS)
    after = found[7] + 6 * (times - 0.6)
    assert found[~before] == pytest.approx(after[~before], abs=64 * EPS)


@pytest.mark.parametrize("scheme", ["adaptive", "stiff"])
def test_between_steps_of_their_own_choice(scheme: Any) -> None:
    """Errors follow the tolerance wherever in a step: local ones of its size, as many as there are steps."""
    times = np.sort(np.random.default_rng(5).uniform(0.0, 2.0, 60))
    for tolerance in (1e-6, 1e-9):
        settings = ct.Simulation(duration=2, scheme=scheme, tolerance=tolerance)
        found = ct.simulate(pendulum(), settings, at=times)
        missed = np.abs(found.drive_value.values[:, 0] - swinging(times))
        assert np.max(missed) <= tolerance * found.evaluations


@pytest.mark.parametrize("scheme", ["adaptive", "stiff"])
def test_right_beside_an_event(scheme: Any) -> None:
    """A sledge of 2 kg under friction of 3 N comes to rest from 3 m/s at 2 s: v = 3 - 1.5 t, then nothing."""
    times = np.array([1e-9, 1.0, 2.0 - 1e-6, 2.0, 2.0 + 1e-9, 2.5])
    settings = ct.Simulation(speed=3, duration=3, scheme=scheme)
    found = ct.simulate(sledge(), settings, at=times).drive_speed.values
    assert found == pytest.approx(np.maximum(3.0 - 1.5 * times, 0.0), abs=1e-9)
