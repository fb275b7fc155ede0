"""Fields over arrays of shifts against the geometry of each pair alone, and the time that a contour takes."""

from __future__ import annotations

import math
import time

import numpy as np
import pytest

from centrode.gears.blocking_contour import blocking_contour, with_shifts
from centrode.gears.involutes import involutes, pressure_angles_of
from centrode.gears.pair_geometry import PairGeometry
from centrode.gears.shift_fields import shift_fields
from centrode.geometry.involute import involute, pressure_angle_of

PAIRS = {
    "spur": PairGeometry("external", 3.0, (12, 24), (0.6, 0.36)),
    "helical": PairGeometry("external", 2.0, (17, 40), (0.1, -0.2), math.radians(25)),
    "internal": PairGeometry("internal", 4.0, (19, 60), (0.2, 0.4)),
    "rack": PairGeometry("rack", 5.0, (14, math.inf), (0.3, 0.0)),
}


@pytest.mark.parametrize("name", PAIRS)
def test_fields_are_those_of_single_pairs(name: str) -> None:
    pair = PAIRS[name]
    random = np.random.default_rng(3)
    first, second = random.uniform(-0.6, 1.4, (2, 40))
    if name == "rack":
        second = np.zeros(40)
    fields = shift_fields(pair, first, second)
    compared = 0
    for place in range(40):
        one = with_shifts(pair, float(first[place]), float(second[place]))
        wheels = one.wheels
        radius = one.pitch_curvature_radius
        expected = {
            "mesh": one.working_involute,
            "contact_ratio": one.contact_ratio,
            "tips": min(one.tips_clear, 1.0) if name == "internal" else 1.0,
            "flatness": float(1 / (1 / radius + one.sign / one.other_curvature_radius(radius))) / one.module,
        }
        for number, wheel in enumerate(wheels):
            expected[f"tip_thickness {number}"] = wheel.tip_thickness / one.module
            expected[f"sliding {number}"] = wheel.sliding
            if wheel.is_generated:
                expected[f"above_undercut {number}"] = wheel.shift - wheel.least_shift
                gap = math.tan(wheel.active_pressure) - math.tan(wheel.flank_pressure)
                expected[f"above_fillet {number}"] = gap
        for key, value in expected.items():
            field, _blank, wheel_number = key.partition(" ")
            array = getattr(fields, field)
            got = float((array[int(wheel_number)] if wheel_number else array)[place])
            if math.isnan(value) or math.isnan(one.working_angle):
                assert math.isnan(got) or field in ("mesh", "above_undercut", "tip_thickness", "tips"), key
            else:
                assert got == pytest.approx(value, rel=1e-9, abs=1e-9), (key, first[place], second[place])
                compared += 1
    assert compared > 200


def test_involutes_of_arrays() -> None:
    angles = np.concatenate([np.geomspace(1e-6, 0.06, 50), np.linspace(0.06, 1.4, 200)])
    values = involutes(angles)
    alone = np.array([involute(float(angle)) for angle in angles])
    # Tangents of arrays may differ in their last bit, which is what the difference tan(a) - a then holds.
    rounding = np.finfo(float).eps * np.where(angles < 0.05, alone, np.tan(angles))
    assert (np.abs(values - alone) <= 2 * rounding).all()
    back = pressure_angles_of(values)
    expected = np.array([pressure_angle_of(float(value)) for value in values])
    assert (np.abs(back - expected) <= 4 * (rounding / np.tan(angles) ** 2 + np.spacing(angles))).all()
    assert math.isnan(pressure_angles_of(np.array([-1e-9]))[0])
    assert pressure_angles_of(np.array([0.0]))[0] == 0.0


def test_a_contour_follows_a_hand_on_a_slider() -> None:
    pair = PAIRS["spur"]
    blocking_contour(pair)
    best = math.inf
    for _try in range(3):
        begin = time.process_time()
        blocking_contour(pair)
        best = min(best, time.process_time() - begin)
    assert best < 0.1
