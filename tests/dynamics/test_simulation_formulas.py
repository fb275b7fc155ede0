"""Formulas of what drives and loads: every function of the text, everything that has no value, the smallest powers."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import centrode as ct
from simulated import rotor, spherical

SCHEMES = ["adaptive", "stiff", "runge-kutta-4"]
ONES = [
    "sign(v + 1)", "sign(t + 1)", "abs(-1)", "abs(v)/(abs(v) + 1e-300)", "min(v + 5, 1)", "max(q - 99, 1)",
    "max(0, 1, t - 9)", "cos(0*v)", "1 + sin(0*q)", "tan(pi/4 + 0*t)", "sqrt(1 + 0*v)", "exp(0*v)",
    "log(e + 0*q)", "asin(1 + 0*t)*2/pi", "acos(0*v)*2/pi", "atan(1 + 0*q)*4/pi", "atan2(v + 1, v + 1)*4/pi",
    "(v + 1)**0", "(v + 1)^-1*(v + 1)", "(v + 1)**0.5/(v + 1)^0.5",
]  # fmt: skip
"""Formulas that are 1 wherever the drive goes forwards."""
TORQUE = """
[[loads]]
kind = "torque"
link = "LINK"
value = "AMOUNT"
"""


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("formula", ONES)
def test_every_function_drives_and_loads(formula: str, scheme: Any) -> None:
    """A disc of 0.5 kg m^2 under 2 N m and a load of 1 N m: 2 rad/s^2."""
    settings = ct.Simulation(
        driving=f"2*({formula})", duration=0.25, speed=1, scheme=scheme, steps=10, samples=3
    )
    load = TORQUE.replace("LINK", "OA").replace("AMOUNT", f"-({formula})")
    found = ct.simulate(rotor(load), settings)
    assert found.drive_speed.values == pytest.approx([1.0, 1.25, 1.5], rel=1e-9)


@pytest.mark.parametrize("formula", ["sign(v)", "min(sign(t + 1), 2)", "abs(sign(-v))"])
def test_the_same_on_the_sphere(formula: str) -> None:
    """A formula that is 1 moves it as the number 1 does."""
    one, other = (
        ct.simulate(
            ct.parse_mechanism(
                ct.mechanism_text(spherical(0.3, 0.8))
                + TORQUE.replace("LINK", "AB").replace("AMOUNT", amount)
            ),
            ct.Simulation(driving=amount, speed=2, duration=0.5, scheme="runge-kutta-4", steps=40, samples=5),
        ).drive_speed.values
        for amount in (formula, "1 + 0*t")
    )
    assert one == pytest.approx(other, rel=1e-12)


@pytest.mark.parametrize("power", [7, 100])
def test_a_moment_that_begins_below_every_number(power: int) -> None:
    """t^n drives a disc of 0.5 kg m^2 from rest: v = 2 t^(n + 1) / (n + 1)."""
    found = ct.simulate(rotor(), ct.Simulation(driving=f"t**{power}", duration=1, samples=41))
    speed = 2 * found.time.values ** (power + 1) / (power + 1)
    assert found.drive_speed.values == pytest.approx(speed, abs=1e-9 * speed[-1])
    assert found.evaluations < 5000


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize(
    ("formula", "speed"),
    [
        ("exp(1000 + t)", 0.0),
        ("log(t)", 0.0),
        ("1/(t - t)", 1.0),
        ("log(0.5 - t)", 1.0),
        ("sqrt(v) - 1", 0.0),
    ],
)
def test_no_value_is_no_rest_and_no_limit(formula: str, speed: float, scheme: Any) -> None:
    """What has no value is told as that: the machine neither stands still nor stops at a limit."""
    settings = ct.Simulation(driving=formula, duration=1, speed=speed, scheme=scheme, steps=100)
    with pytest.raises(ct.MotionError, match=r"finite value|no step is small enough"):
        ct.simulate(rotor(), settings)


def test_fixed_steps_tell_where_a_formula_ends() -> None:
    """log(0.5 - t) ends at 0.5 s."""
    settings = ct.Simulation(driving="log(0.5 - t)", duration=1, speed=1, scheme="runge-kutta-4", steps=100)
    with pytest.raises(ct.MotionError, match="no finite value at t = 0\\.5 s"):
        ct.simulate(rotor(), settings)


def test_a_brake_of_the_sign_stops_it() -> None:
    """5 rad/s against 4 N m by sign(v) on 0.5 kg m^2: at rest after 0.625 s, and held there."""
    found = ct.simulate(rotor(), ct.Simulation(driving="-4*sign(v)", duration=1, speed=5, samples=9))
    expected = np.maximum(5 - 8 * found.time.values, 0.0)
    assert found.drive_speed.values == pytest.approx(expected, abs=1e-9)
    assert math.isclose(float(found.occasion_time[-1]), 0.625, abs_tol=1e-9)
