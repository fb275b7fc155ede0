"""What chains manage besides dyads: telescopes, cylinders to sliders, wheels that other links keep on their tracks."""

from __future__ import annotations

import math

import numpy as np
import pytest

import centrode as ct
from centrode.equations.integration import cauchy_form
from centrode.topics.presentation import page

EPS = np.finfo(float).eps

TELESCOPE = """
[frame.points]
O = [1, 2]
[links.boom]
points = { O = [0, 0], K = [1, 0.25] }
[[guides]]
point = "P"
on = "boom"
through = [0.5, 0.1]
direction = "20 deg"
[[drives]]
link = "boom"
start = 0.3
speed = 0.7
[[drives]]
guide = "P"
start = 0.4
law = "0.1*sin(t)"
"""

CYLINDER_TO_A_SLIDER = """
[frame.points]
O = [0, 1]
[links.AB]
length = 2
[[guides]]
point = "A"
through = [0, 0]
direction = "10 deg"
[[guides]]
point = "B"
through = [0, 0]
direction = "75 deg"
[[drives]]
distance = ["O", "A"]
start = 1.6
speed = 0.1
[assembly]
sides = { A = "ahead", B = "ahead" }
"""

WHEEL_ON_A_FLOOR = """
[links.wheel]
points = { C = [0, 0], P = [0.3, 0] }
angle = 0.2
[[rolling]]
link = "wheel"
centre = "C"
radius = 0.3
along = { through = [0, 0], direction = "5 deg" }
[[drives]]
link = "wheel"
start = 0.2
speed = -1
"""

WHEEL_ROUND_A_PIN = """
[frame.points]
Z = [0, 0]
O = [3, 0]
[links.OA]
length = 0.4
[links.AC]
length = 2.9
[links.wheel]
points = { C = [0, 0], P = [0.2, 0] }
[[rolling]]
link = "wheel"
centre = "C"
radius = 0.25
along = { centre = [0, 0], radius = 0.5 }
[[drives]]
link = "OA"
start = 0.4
speed = 1
[assembly]
sides = { C = "left" }
"""

WHEEL_KEPT_BY_A_PARALLELOGRAM = """
[frame.points]
O = [0, 0]
D = [2, 0]
[links.OA]
length = 1
[links.coupler]
points = { A = [0, 0], B = [2, 0], C = [0.7, 0] }
angle = 0
[links.DB]
length = 1
angle = 1
[links.wheel]
points = { C = [0, 0], P = [0.2, 0] }
[[rolling]]
link = "wheel"
centre = "C"
radius = 0.25
along = { centre = [0.7, 0], radius = 0.75 }
[[drives]]
link = "OA"
start = 1
speed = 1
"""

MOTOR_BETWEEN_MOVING_LINKS = """
[frame.points]
O = [0, 0]
D = [4, 0]
[links.OA]
length = 1.5
angle = 1.3676
[links.AB]
length = 3.0
angle = 0.4676
[links.DB]
length = 3
[[drives]]
link = "AB"
relative_to = "OA"
start = -0.9
speed = 0.2
"""

TOPOLOGIES = {
    "telescope": (TELESCOPE, ()),
    "cylinder to a slider": (CYLINDER_TO_A_SLIDER, ("angle.AB", "angle.O-A", "slide.A")),
    "wheel on a floor": (WHEEL_ON_A_FLOOR, ("slide.wheel",)),
    "wheel round a pin": (WHEEL_ROUND_A_PIN, ("angle.AC", "angle.wheel", "bearing.wheel")),
    "wheel kept by a parallelogram": (
        WHEEL_KEPT_BY_A_PARALLELOGRAM, ("angle.DB", "angle.coupler", "angle.wheel", "bearing.wheel"),
    ),
    "motor between moving links": (MOTOR_BETWEEN_MOVING_LINKS, ("angle.DB", "angle.OA")),
}  # fmt: skip


@pytest.mark.parametrize("name", TOPOLOGIES)
def test_rates_and_places_are_those_of_the_motion(name: str) -> None:
    text, unknowns = TOPOLOGIES[name]
    mechanism = ct.parse_mechanism(text)
    form = cauchy_form(mechanism)
    assert tuple(sorted(form.names)) == unknowns
    by_time = len(mechanism.drives) > 1
    start = 0.0 if by_time else form.drives[0][2].initial
    motion = ct.motion(mechanism, at=[start])
    state, rates = form.initial, form.rates(0.0, form.initial)
    scale = 1.0 + max(map(abs, state), default=0.0)
    assert np.max(np.abs(form.constraints(0.0, state)), initial=0.0) <= 64 * EPS * scale
    for full, rate in zip(form.names, rates, strict=True):
        kind, _dot, of = full.partition(".")
        if kind == "angle" and of in motion.link.values:
            known = float(motion.angular_velocity.sel(link=of)[0])
            # the groups are far from dead points: conditions of a few tens
            assert abs(rate - known) <= 4096 * EPS * (1.0 + abs(known))
    places = form.positions(0.0, state)
    for point in motion.point.values:
        assert np.max(np.abs(places[point] - motion.position.sel(point=point)[0].values)) <= 256 * EPS * scale


@pytest.mark.parametrize("name", TOPOLOGIES)
def test_velocities_of_points_are_those_of_the_motion(name: str) -> None:
    mechanism = ct.parse_mechanism(TOPOLOGIES[name][0])
    found = ct.equations(mechanism)
    form = cauchy_form(mechanism)
    values = dict(found.values)
    for one, rate in zip(form.unknowns, form.rates(0.0, form.initial), strict=True):
        values[one.rate.name] = float(rate)
    speeds = {
        "telescope": {"omega1": 0.7, "s_P_dot": 0.1}, "cylinder to a slider": {"l_OA_dot": 0.1},
        "wheel on a floor": {"omega1": -1.0}, "motor between moving links": {"theta2_dot": 0.2},
    }  # fmt: skip
    values |= speeds.get(name, {"omega1": 1.0})
    by_time = len(mechanism.drives) > 1
    motion = ct.motion(mechanism, at=[0.0 if by_time else form.drives[0][2].initial])
    for point in found.board.moving:
        velocity = found.velocity(point)
        known = motion.velocity.sel(point=point)[0].values
        for formula, one in zip((velocity.x, velocity.y), known, strict=True):
            number = formula.total.value(math, lambda letter: values[letter.name])
            assert abs(number - float(one)) <= 4096 * EPS * (1.0 + abs(float(one)))


def test_names_of_any_alphabet_are_letters() -> None:
    text = TELESCOPE.replace("[links.boom]", '[links."стрела 1_"]').replace('"boom"', '"стрела 1_"')
    mechanism = ct.parse_mechanism(text.replace('"P"', '"B’ x"').replace("K =", '"К1_" ='))
    found = ct.equations(mechanism)
    assert "B’ x" in ct.summary(found)
    document = page(ct.equations(mechanism, ["К1_", "B’ x"]), "tex")
    assert r"К1\_" in document


def test_drives_without_unknowns_leave_velocities_only() -> None:
    found = ct.equations(ct.example("two-link-arm"))
    assert found.groups == ()
    assert found.rates == {}
    text = ct.summary(found)
    assert "x_B = l₁ cos φ₁ + l₂ cos(φ₁ + θ₂)" in text
    assert "Constraints" not in text
