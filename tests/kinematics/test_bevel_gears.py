"""Bevel gears: turns by Willis's formula, contact without slip along the common generator, and what is refused."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import centrode as ct
from mechanisms import EPS


def pair(first: float, second: float, shafts: float, start: float = 0.0, stand: float = 0.0) -> ct.Mechanism:
    """Two wheels of so many teeth in the frame, on shafts at an angle."""
    return ct.parse_mechanism(
        f"""
space = "sphere"
[frame.points]
A = [0.3, 0.2]
B = [{0.3 + shafts}, 0.2]
[links.AE]
length = 0.4
reference = ["A", "B"]
[links.BF]
length = 0.5
reference = ["B", "A"]
angle = {stand}
[[gears]]
links = ["AE", "BF"]
ratio = {-first / second}
[[drives]]
link = "AE"
start = {start}
speed = 1.0
"""
    )


@settings(max_examples=25, deadline=None)
@given(st.floats(10, 80), st.floats(10, 80), st.floats(0.5, 2.5), st.floats(-2, 2), st.floats(-3, 3))
def test_wheels_turn_in_their_ratio_and_do_not_slip(
    first: float, second: float, shafts: float, start: float, stand: float
) -> None:
    """The angle of the second follows over turns; both move alike at every place of their common generator."""
    motion = ct.motion(pair(first, second, shafts, start, stand), samples=31, start=start, stop=start + 20.0)
    x = motion.drive_value.to_numpy()[:, 0]
    turned = motion.joint_angle.sel(joint="BF").to_numpy()
    ratio = first / second
    assert np.abs(turned - (stand - ratio * (x - start))).max() <= 64 * EPS * 30.0 * (1.0 + ratio)
    a, b = (motion.position.sel(point=name).to_numpy()[0] for name in "AB")
    # on the pitch cones: sines of the distances from the shafts are as the teeth
    generator = first * b + second * a
    spins = [motion.angular_velocity.sel(link=name).to_numpy() for name in ("AE", "BF")]
    slip = np.cross(spins[0], generator) - np.cross(spins[1], generator)
    assert np.linalg.norm(slip, axis=1).max() <= 64 * EPS * (first + second) * (1.0 + ratio)


def test_a_planet_on_a_fixed_wheel_rolls_on_it() -> None:
    """The arm carries a wheel around a fixed one: its axis relative to the frame is the common generator."""
    mechanism = ct.parse_mechanism(
        """
space = "sphere"
[frame.points]
A = [0, "90 deg"]
X = [0, 0]
[links.arm]
points = { A = [0, "90 deg"], P = [0, "10 deg"] }
reference = ["A", "X"]
[links.planet]
points = { P = [0, 0], Q = [0.3, 0] }
reference = ["P", "A"]
[[gears]]
links = ["frame", "planet"]
carrier = "arm"
ratio = "-30/20"
[[drives]]
link = "arm"
start = 0.0
speed = 2.0
"""
    )
    motion = ct.motion(mechanism, samples=41, stop=15.0)
    # seen from the arm the frame turns by -x, the planet by 30/20 x
    x = motion.drive_value.to_numpy()[:, 0]
    planet = motion.joint_angle.sel(joint="planet").to_numpy()
    assert np.abs(planet - 1.5 * x).max() <= 64 * EPS * 25.0
    found = ct.instant_centres(motion, [("planet", "frame")])
    a, p = (motion.position.sel(point=name).to_numpy() for name in "AP")
    generator = 20.0 * a + 30.0 * p
    off = np.linalg.norm(np.cross(found.centre.to_numpy()[:, 0], generator), axis=1)
    assert off.max() <= 64 * EPS * 50.0
    rolled = ct.centrodes(motion, "planet")
    cone = np.arccos((a[0] @ generator[0]) / np.linalg.norm(generator[0]))
    # the generator turns about A with the arm
    length = 15.0 * np.sin(cone)
    step = x[1]
    for name in ("fixed_arc", "moving_arc"):
        assert abs(float(rolled[name][-1]) - length) <= length * (2.5 * step) ** 4


def test_the_carrier_of_a_differential_turns_at_the_mean() -> None:
    motion = ct.motion(ct.example("bevel-differential"), samples=31, stop=12.0)
    t = motion.time.to_numpy()
    left, right, carrier, planet = (
        motion.joint_angle.sel(joint=name).to_numpy() for name in ("left", "right", "AP", "planet")
    )
    tolerance = 64 * EPS * 24.0
    assert np.abs(left - t).max() <= tolerance and np.abs(right - 2.0 * t).max() <= tolerance
    assert np.abs(carrier - 1.5 * t).max() <= tolerance
    assert np.abs(planet - 0.5 * t * 20 / 16).max() <= tolerance
    assert np.abs(motion.residual).max() <= tolerance


def test_a_gear_drives_a_linkage() -> None:
    """A spherical four-bar driven through a bevel pair moves as one driven with the geared angle."""
    text = """
space = "sphere"
[frame.points]
A = [1, 0, 0]
D = [0, 1, 0]
Z = [0, 0, 1]
S = [0, -1, 0]
[links.shaft]
points = { S = [0, 0], T = [0.4, 0] }
reference = ["S", "A"]
[links.AB]
length = "15 deg"
reference = ["A", "D"]
[links.BC]
length = "45 deg"
[links.DC]
length = "90 deg"
reference = ["D", "Z"]
[[gears]]
links = ["shaft", "AB"]
ratio = -2
[[drives]]
link = "shaft"
start = 0.0
speed = 1.0
[assembly]
sides = { C = "left" }
"""
    x = np.linspace(0.0, 2.0, 9)
    geared = ct.motion(ct.parse_mechanism(text), at=x)
    straight = ct.motion(ct.example("spherical-four-bar"), at=-2.0 * x)
    for name in "BC":
        apart = geared.position.sel(point=name) - straight.position.sel(point=name).to_numpy()
        assert np.abs(apart).max() <= 64 * EPS / 0.1


def without(text: str, *lines: str) -> str:
    for line in lines:
        assert line in text
        text = text.replace(line, "")
    return text


REFUSED: dict[str, tuple[Any, str]] = {
    "no reference": (
        lambda: without(ct.mechanism_text(pair(20, 40, 1.0)), 'reference = ["B", "A"]\n', "angle = 0.0\n"),
        "on the sphere BF needs an arc that its angle is measured from",
    ),
    "measured elsewhere": (
        lambda: ct.mechanism_text(ct.example("bevel-differential")).replace(
            'reference = ["P", "A"]', 'reference = ["P", "L"]'
        ),
        "the angle of planet is measured neither on AP nor on the frame",
    ),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_is_refused(name: str) -> None:
    make, message = REFUSED[name]
    with pytest.raises(ct.InputError, match=message):
        ct.motion(ct.parse_mechanism(make()), samples=3)
