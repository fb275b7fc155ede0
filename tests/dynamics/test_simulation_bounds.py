"""What would take too much time or memory is refused before it begins, or broken off where it runs away."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import centrode as ct
from centrode.dynamics.simulation import equation_of_motion
from centrode.dynamics.simulation.integrator import Stepper
from centrode.kinematics.solve import BYTES, GREATEST_RESULT
from centrode.model.simulation import MOST_TURNS
from simulated import crank_rocker, rotor


@pytest.mark.parametrize("scheme", ["adaptive", "stiff", "runge-kutta-4"])
def test_ten_thousand_turns_a_second_are_refused_before_they_begin(scheme: Any) -> None:
    def stop(_share: float) -> None:
        raise AssertionError("it has begun")

    settings = ct.Simulation(speed=6.3e4, duration=1, scheme=scheme)
    with pytest.raises(
        ct.InputError, match=r"at its speed at the start it makes 1e.04 turns in 1 s, and at most 5000"
    ):
        ct.simulate(crank_rocker(), settings, progress=stop)


def test_turns_that_are_asked_for_end_it() -> None:
    """A duration that is too long does no harm where turns end the motion."""
    found = ct.simulate(rotor(), ct.Simulation(speed=6.3e4, duration=1, turns=3))
    assert found.attrs["ended"] == "turns"


def test_fixed_steps_that_run_away_are_broken_off() -> None:
    """A hundred steps over 50 s under a growing moment: some 1e6 turns, over which no mesh is laid."""
    settings = ct.Simulation(driving="500*t", duration=50, scheme="runge-kutta-4", steps=100)
    with pytest.raises(ct.MotionError, match="more than 5000 turns"):
        ct.simulate(rotor(), settings)


def test_a_drive_that_runs_away_is_broken_off(monkeypatch: pytest.MonkeyPatch) -> None:
    """J q'' = 5 N m: 20 turns after sqrt(2 * 40 pi / 10) = 5.01 s; there, within a step, it ends."""
    monkeypatch.setattr(equation_of_motion, "MOST_TURNS", 20)
    with pytest.raises(ct.MotionError, match=r"turns at t = 5\."):
        ct.simulate(rotor(), ct.Simulation(driving="5", duration=100))


def test_steps_are_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    """A swing of 10 kHz over a second takes more than a thousand steps."""
    monkeypatch.setattr(Stepper.__init__, "__defaults__", (False, None, 1000))
    with pytest.raises(ct.MotionError, match="1000 steps were taken up to t = 0"):
        ct.simulate(rotor(), ct.Simulation(driving="sin(6e4*t)*6e4", duration=1, speed=1))


def test_samples_are_weighed_before_anything_is_integrated() -> None:
    def stop(_share: float) -> None:
        raise AssertionError("it has begun")

    with pytest.raises(ct.InputError, match="GB of memory"):
        ct.simulate(ct.example("six-bar-press-run-up"), at=np.linspace(0, 1, 900_000), progress=stop)
    assert GREATEST_RESULT * BYTES <= 1e9


@pytest.mark.parametrize("keys", ["steps = 1000001", f"turns = {MOST_TURNS + 1}", "samples = 1000001"])
def test_numbers_beyond_the_bounds(keys: str) -> None:
    with pytest.raises(ct.InputError, match=keys.partition(" ")[0]):
        ct.parse_mechanism(ct.mechanism_text(rotor()) + f"\n[simulation]\n{keys}\n")
