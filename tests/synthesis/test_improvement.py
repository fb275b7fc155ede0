"""Improvement: measures against closed forms and differences, optima against scans of the engine's motion."""

from __future__ import annotations

import math

import numpy as np
import pytest

import centrode as ct
from centrode.synthesis.measures import measure_of

PRESS_FREE = ["links.OA.length", "links.AB.points.B.x", "frame.points.C.x"]
MEASURES = [
    "stroke(slide_H)", "time_ratio(slide_H)", "dwell(slide_H, 90 deg, 150 deg)", "reaction(B/AB)", "shaking_force",
    "unevenness", "max(abs(slide_velocity_H))",
]  # fmt: skip


def measured(mechanism, free, texts, samples=181):
    """Values and derivatives of measures as a function of the free numbers."""
    measures = [measure_of(mechanism, text, "test", number) for number, text in enumerate(texts)]
    outputs = {name: formula for one in measures for name, formula in one.outputs.items()}
    moved = ct.solver(mechanism, free, samples, outputs=outputs)

    def at(values):
        numbers, slopes = moved.split(np.asarray(moved.outputs(values))), moved.split(moved.gradient(values))
        return [one.compute(moved.parameter, moved.time, numbers, slopes) for one in measures]

    return moved, at


def test_measures_have_the_derivatives_of_their_differences() -> None:
    moved, at = measured(ct.example("six-bar-press"), PRESS_FREE, MEASURES)
    own, step = np.array(moved.own), 1e-6
    here = at(own)
    for k in range(3):
        ahead, behind = at(own + step * np.eye(3)[k]), at(own - step * np.eye(3)[k])
        for text, (_value, slope), (more, _s), (less, _t) in zip(MEASURES, here, ahead, behind, strict=True):
            # central differences of numbers with rounding 1e-16/1e-6, and curvature over the step
            assert slope[k] == pytest.approx((more - less) / (2 * step), rel=2e-6), text


def test_time_ratio_and_stroke_of_a_slider_crank_by_its_closed_form() -> None:
    crank, coupler, offset = 0.05, 0.2, 0.03
    lever = ct.slider_crank(crank, coupler, offset=offset)
    name = lever.guides[0].point
    _moved, at = measured(
        lever, ["links.crank.length"], [f"time_ratio(slide_{name})", f"stroke(slide_{name})"], 361
    )
    (ratio, _slope), (stroke, _by) = at([crank])
    far, near = math.asin(offset / (coupler + crank)), math.asin(offset / (coupler - crank))
    theta = abs(near - far)
    assert ratio == pytest.approx((math.pi + theta) / (math.pi - theta), rel=1e-7)
    ends = math.sqrt((coupler + crank) ** 2 - offset**2) - math.sqrt((coupler - crank) ** 2 - offset**2)
    # the nearest samples miss the ends by half a step at most
    assert stroke == pytest.approx(ends, rel=(math.pi / 360) ** 2)


def test_unevenness_is_that_of_the_steady_motion() -> None:
    press = ct.example("six-bar-press")
    _moved, at = measured(press, PRESS_FREE[:1], ["unevenness"], 721)
    speed = np.abs(ct.steady_motion(press, 721).drive_speed.to_numpy())
    least, most = speed.min(), speed.max()
    # the trapezoidal rule has kinks where the load sets in
    assert at([0.347])[0][0] == pytest.approx(2 * (most - least) / (most + least), rel=1e-3)


def test_an_improved_press_keeps_its_stroke_and_is_at_the_optimum() -> None:
    press = ct.example("six-bar-press")
    own = dict(zip(PRESS_FREE, ct.solver(press, PRESS_FREE, 37).own, strict=True))
    box = {path: [0.9 * value, 1.1 * value] for path, value in own.items()}
    better = ct.improve(press, "reaction(B/AB)", box, {"stroke(slide_H)": [1.579, 1.581]}, samples=91)
    forces = ct.reactions(better.mechanism, 361).joint_force.sel(side="B/AB").to_numpy()
    greatest = float(np.hypot(*forces.T).max())
    assert greatest == pytest.approx(better.after, rel=1e-9)
    assert better.after < 0.935 * better.before
    slide = ct.motion(better.mechanism, 361).slide.to_numpy()[:, 0]
    assert 1.579 * (1 - 1e-3) < np.ptp(slide) < 1.581 * (1 + 1e-3)
    # nothing near that keeps the stroke is better: random places within the ranges
    _moved, at = measured(press, PRESS_FREE, ["reaction(B/AB)", "stroke(slide_H)"], 91)
    low, high = np.array(list(box.values())).T
    best, _stroke = (value for value, _by in at([one.after for one in better.free]))
    for values in np.random.default_rng(4).uniform(low, high, (150, 3)):
        (force, _slope), (stroke, _by) = at(values)
        assert not (force < best * (1 - 1e-6) and 1.579 <= stroke <= 1.581)


@pytest.mark.parametrize(
    ("objective", "free", "constraints", "said"),
    [
        ("stroke(angle_DB)", {}, {}, "no dimension is free"),
        ("stroke(angle_DB)", {"links.AB.length": [9, 10]}, {}, "the own value 3.5 lies outside 9 to 10"),
        ("stroke(angle_DB)", {"links.AB.length": [4, 3]}, {}, "the range goes from 4 to 3"),
        ("strok(angle_DB)", {"links.AB.length": [3, 4]}, {}, "objective: unknown name"),
        ("stroke(angle_DB)", {"links.XY.length": [3, 4]}, {}, "XY"),
        ("stroke(angle_DB)", {"links.AB.length": [3, 4]}, {"mean(": [0, 1]}, "constraints mean("),
        ("stroke(angle_DB)", {"links.AB.length": [3, 4]}, {"mean(angle_DB)": [None, None]}, "the range goes"),
        ("dwell(angle_DB, 1)", {"links.AB.length": [3, 4]}, {}, "dwell is not written so"),
        ("time_ratio(DB)", {"links.AB.length": [3, 4]}, {}, "no angle, slide or position"),
        ("unevenness", {"links.AB.length": [3, 4]}, {}, "add [machine]"),
        (7, {"links.AB.length": [3, 4]}, {}, "expected a formula"),
    ],
)  # fmt: skip
def test_refusals(objective, free, constraints, said: str) -> None:
    with pytest.raises(ct.InputError, match=r".*") as refusal:
        ct.improve("crank-rocker", objective, free, constraints, samples=19)
    assert said in str(refusal.value)


def test_nothing_better_is_said() -> None:
    lever = ct.with_value(ct.example("crank-rocker"), "links.AB.length", 3.4)
    with pytest.raises(ct.MotionError, match="no dimensions within the ranges are better"):
        ct.improve(lever, "stroke(angle_DB)", {"links.AB.length": [3.4, 3.6]}, samples=37)
