"""Extremes of a motion between its samples, beside roots of the next derivative."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import brentq

import centrode as ct
from centrode.dynamics.motion_extremes import extremes_of_motion
from centrode.dynamics.motion_results import study


def test_the_fastest_place_of_a_slider_is_where_its_acceleration_vanishes() -> None:
    mechanism = ct.example("single-cylinder-engine")
    guide = mechanism.guides[0].id

    def acceleration(at: float) -> float:
        return float(ct.motion(mechanism, at=[at]).slide_acceleration.sel(guide=guide)[0])

    # few samples: without the search places would be wrong by some degrees
    results = study(mechanism, 37)
    found = extremes_of_motion(results, results.motion)
    velocity = found["slide_velocity", guide]
    for value, place in ((velocity.least, velocity.at_least), (velocity.greatest, velocity.at_greatest)):
        root = brentq(acceleration, place - 0.1, place + 0.1, xtol=1e-12)
        exact = float(ct.motion(mechanism, at=[root]).slide_velocity.sel(guide=guide)[0])
        # a step of ten degrees is divided by 256, and a top is flat
        step = np.radians(10) / 256
        assert abs(place - root) <= step
        assert abs(value - exact) <= step**2 * abs(exact)
    samples = results.motion.slide_velocity.sel(guide=guide)
    assert velocity.greatest > float(samples.max()) and velocity.least < float(samples.min())


@pytest.mark.parametrize(
    "name", ["six-bar-press", "crank-rocker", "spherical-crank-rocker", "elliptic-trammel"]
)
def test_extremes_do_not_depend_on_samples(name: str) -> None:
    few, many = (study(ct.example(name), count) for count in (73, 361))
    (one, other) = (
        extremes_of_motion(results, results.motion if results.machine is None else results.machine.steady)
        for results in (few, many)
    )
    assert one.keys() == other.keys() and one
    for key, value in one.items():
        size = max(abs(other[key].least), abs(other[key].greatest), 1e-12)
        for mine, theirs in ((value.least, other[key].least), (value.greatest, other[key].greatest)):
            assert abs(mine - theirs) <= 1e-5 * size, key
