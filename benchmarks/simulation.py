"""Fixed-step simulation: time by the clock for ten thousand steps."""

from __future__ import annotations

import functools
from collections.abc import Iterator

import centrode as ct
from benchmarks.table import Promise, Row
from benchmarks.timing import best_times
from centrode.dynamics.simulation.fixed_steps import fixed_steps
from centrode.dynamics.simulation.reduced_motion import reduced_setting

STEPS = 10_000
NAMES = ("spherical-crank-rocker", "spherical-crank-rocker-rigid", "six-bar-press-run-up")
MOST = 200.0
"""Milliseconds that so many steps may take."""


def simulations() -> Iterator[Row]:
    """The steps alone, and the whole call with its labelled result of 1001 instants."""
    for name in NAMES:
        mechanism = ct.example(name)
        assert mechanism.simulation is not None
        fixed = {"scheme": "runge-kutta-4", "steps": STEPS, "samples": 1001}
        settings = mechanism.simulation.model_copy(update=fixed)
        setting = reduced_setting(mechanism, settings)
        assert settings.duration is not None
        times = best_times(
            {
                "steps": functools.partial(
                    fixed_steps, setting.field, setting.start, setting.rate, settings.duration, STEPS
                ),
                "simulate": functools.partial(ct.simulate, mechanism, settings),
                "adaptive": functools.partial(ct.simulate, mechanism, mechanism.simulation),
            },
            rounds=3,
        )
        steps = 1e3 * times["steps"]
        yield Row(
            name,
            {
                "steps [ms]": steps,
                "ct.simulate [ms]": 1e3 * times["simulate"],
                "adaptive [ms]": 1e3 * times["adaptive"],
            },
            promises=[Promise(f"{name}, {STEPS} fixed steps [ms]", steps, at_most=MOST)],
        )
