"""Values of the drive, times and dimensions as texts with units: bit for bit what their numbers in SI give."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import xarray as xr

import centrode as ct

DEGREE = math.pi / 180
PRESS = ct.example("six-bar-press")
ROCKER = ct.example("crank-rocker")
"""It displays radians: a text without a unit is a number in SI."""


def same(texts: xr.Dataset, numbers: xr.Dataset) -> None:
    xr.testing.assert_identical(texts, numbers)


@pytest.mark.parametrize(
    "compute",
    [ct.motion, ct.kinematic_coefficients, ct.transmission_angles, ct.reduce, ct.reactions, ct.shaking],
)
def test_places_and_ends_of_a_motion(compute: Callable[..., xr.Dataset]) -> None:
    same(
        compute(PRESS, at=["60 deg", 1.5, "1/4 turn"]),
        compute(PRESS, at=[60 * DEGREE, 1.5, math.tau / 4]),
    )
    same(compute(PRESS, at="60 deg"), compute(PRESS, at=[60 * DEGREE]))
    same(compute(PRESS, at=np.array(["60 deg"])), compute(PRESS, at=[60 * DEGREE]))
    same(compute(PRESS, 5, "30 deg", "60 deg"), compute(PRESS, 5, 30 * DEGREE, 60 * DEGREE))


def test_places_in_steady_motion() -> None:
    same(ct.steady_motion(PRESS, at=["60 deg"]), ct.steady_motion(PRESS, at=[60 * DEGREE]))
    same(
        ct.reactions(PRESS, at="60 deg", speed="steady"),
        ct.reactions(PRESS, at=[60 * DEGREE], speed="steady"),
    )


def test_times_of_laws_and_of_simulations() -> None:
    feed = ct.example("cam-driven-linkage")
    same(ct.motion(feed, at=["100 ms"]), ct.motion(feed, at=[0.1]))
    run = ct.example("six-bar-press-run-up")
    settings = ct.Simulation(driving="2000", duration="0.2 s")
    same(ct.simulate(run, settings, at=["50 ms", "0.1 s"]), ct.simulate(run, settings, at=[0.05, 0.1]))


def test_other_analyses() -> None:
    same(ct.curvature(ROCKER, "AB", ["60 deg"]), ct.curvature(ROCKER, "AB", [60 * DEGREE]))
    same(ct.integrate(ROCKER, steps=20, stop="60 deg"), ct.integrate(ROCKER, steps=20, stop=60 * DEGREE))
    text, number = (ct.force_polygons(PRESS, at) for at in ("60 deg", 60 * DEGREE))
    assert text.balancing == number.balancing
    drawn = (ct.graphic_analysis(ROCKER, instants=[at]) for at in ("60 deg", 60 * DEGREE))
    assert len({ct.summary(found) for found in drawn}) == 1
    vary = {"links.AB.length": [3.4, 3.6]}
    swept: tuple[Any, ...] = tuple(
        ct.sweep(ROCKER, vary, "angle.DB", 5, first, last)
        for first, last in (("0 deg", "60 deg"), (0.0, 60 * DEGREE))
    )
    same(*swept)


def test_dimensions_that_vary() -> None:
    same(
        ct.motion(ROCKER, 5, vary={"links.AB.length": ["3400 mm", 3.6]}),
        ct.motion(ROCKER, 5, vary={"links.AB.length": [3400 * 1e-3, 3.6]}),
    )
    with pytest.raises(ct.InputError, match=r"links\.AB\.length.*expected a length"):
        ct.motion(ROCKER, 5, vary={"links.AB.length": ["30 deg", 3.6]})


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        ({"at": ["60 mm"]}, "at: expected an angle"),
        ({"start": "60 mm"}, "start: expected an angle"),
        ({"stop": "soon"}, "stop: "),
        # the press displays degrees
        ({"at": ["60"]}, "an angle without a unit"),
    ],
)
def test_texts_that_are_no_values(arguments: dict[str, Any], told: str) -> None:
    with pytest.raises(ct.InputError, match=told):
        ct.motion(PRESS, **arguments)
