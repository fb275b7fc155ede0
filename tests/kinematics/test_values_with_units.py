"""Values of the drive, times and dimensions as texts with units: bit for bit what their numbers in SI give."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
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
        ct.reactions(PRESS, at="60 deg", motion="real"),
        ct.reactions(PRESS, at=[60 * DEGREE], motion="real"),
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


@pytest.mark.parametrize("at", [2.0, "2 rad", ["2 rad"], [2.0], (np.float64(2.0),), np.array([2.0])])
def test_one_instant_alone_or_in_a_list(at: Any) -> None:
    same(ct.reduce(PRESS, at=at), ct.reduce(PRESS, at=[2.0]))
    assert ct.force_polygons(PRESS, at=at).balancing == POLYGONS.balancing


POLYGONS = ct.force_polygons(PRESS, 2.0)


def test_angles_of_cams() -> None:
    same(
        ct.cam("cam-from-curvature", at=["10 deg", 0.5]), ct.cam("cam-from-curvature", at=[10 * DEGREE, 0.5])
    )
    same(ct.cam_forces("valve-cam", at="100 deg"), ct.cam_forces("valve-cam", at=[100 * DEGREE]))
    with pytest.raises(ct.InputError, match=r'at: "10" is an angle without a unit'):
        ct.cam("cam-from-curvature", at=["10"])


def test_places_and_scales() -> None:
    engine = "single-cylinder-engine"
    same(ct.shaking(engine, 5, about=("0 mm", "10 mm")), ct.shaking(engine, 5, about=(0.0, 0.01)))
    same(
        ct.curvature(ROCKER, "AB", [1.0], points={"Q": ("10 mm", 0.2)}),
        ct.curvature(ROCKER, "AB", [1.0], points={"Q": (0.01, 0.2)}),
    )
    texts = {"length": "50 mm", "velocity": "20 mm/s", "acceleration": "2 cm/s^2"}
    numbers = {"length": 0.05, "velocity": 0.02, "acceleration": 0.02}
    drawn = (ct.graphic_analysis(ROCKER, instants="1 rad", scales=scales) for scales in (texts, numbers))
    assert len({ct.summary(found) for found in drawn}) == 1


def test_reports() -> None:
    """What a report shows at an instant, by its options and by `at`."""
    plain = ct.ReportOptions(chapters=("structure",))
    chosen = replace(plain, instants=("60 deg", 2.0))
    for options, at, instants in (
        (chosen, None, (60 * DEGREE, 2.0)),
        (chosen, "1 rad", (1.0,)),
        (plain, 1.0, (1.0,)),
        (plain, ["60 deg", np.float64(1.0)], (60 * DEGREE, 1.0)),
        (replace(plain, instants="60 deg"), None, (60 * DEGREE,)),
    ):
        made = ct.report(ROCKER, options, at=at)
        assert made.description is not None and made.description.instants == instants
    cam = ct.report("valve-cam", ct.ReportOptions(chapters=("data",)), at=["100 deg"])
    assert cam.description is not None and cam.description.instants == (100 * DEGREE,)
    with pytest.raises(ct.InputError, match="at: expected an angle"):
        ct.report(ROCKER, at=["60 mm"])


def test_vary_takes_texts_in_arrays_and_alone() -> None:
    wanted = ct.motion(ROCKER, 5, vary={"links.AB.length": [3.4]})
    for values in (["3400 mm"], "3400 mm", np.array(["3400 mm"])):
        same(ct.motion(ROCKER, 5, vary={"links.AB.length": values}), wanted)


@pytest.mark.parametrize(
    "compute",
    [
        lambda: ct.motion(PRESS, at=[["60 deg"]]),
        lambda: ct.motion(PRESS, at=[]),
        lambda: ct.motion(PRESS, at=[None, "60 deg"]),
        lambda: ct.motion(PRESS, start=["60 deg"]),
        lambda: ct.motion(PRESS, stop={}),
        lambda: ct.cam("cam-from-curvature", at=[["10 deg"]]),
        lambda: ct.force_polygons(PRESS, ["60 deg", "70 deg"]),
        lambda: ct.force_polygons(PRESS, []),
        lambda: ct.graphic_analysis(ROCKER, instants=["1 rad"], scales={"length": "1 s"}),
        lambda: ct.curvature(ROCKER, "AB", [1.0], points={"Q": "10 mm"}),
        lambda: ct.variants(ROCKER, {"links.AB.length": ["3.4 m"]}),
    ],
)
def test_what_is_no_value_is_refused(compute: Callable[[], object]) -> None:
    with pytest.raises(ct.InputError) as refused:
        compute()
    assert refused.value.where and refused.value.what
