"""Loads over the motion and over what they depend on, beside their laws written down; moments of loads and drive."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import centrode as ct
from centrode.dynamics.load_courses import LoadCourse, load_courses
from centrode.dynamics.masses import link_masses
from centrode.dynamics.reduction_results import ReductionResults, reduction_results
from centrode.sheets.plots import CurveDiagram, CurveRole, Plot
from centrode.sheets.sheet import Illustration
from centrode.topics.presentation import sheet_of
from centrode.views import masses_and_loads
from machines import engine

EPS = float(np.finfo(float).eps)
LOADED = """\
title = "Loaded slider-crank"
[frame.points]
O = [0, 0]
C = [0.9, 0]
[links.OA]
length = 0.1
[links.AB]
length = 0.4
[links.piston]
points = ["B"]
mass = 2
[[guides]]
point = "B"
on = "frame"
through = "O"
direction = [1, 0]
link = "piston"
[[drives]]
link = "OA"
start = 0.3
speed = 10
[[loads]]
kind = "force"
name = "gas"
guide = "B"
table = [[0.3, -2000, 0], [0.32, -1500, -50], [0.5, -100, -100]]
[[loads]]
kind = "force"
name = "cut"
point = "B"
vector = [-700, 0]
while_moving = [1, 0]
[[loads]]
kind = "spring"
name = "return"
points = ["B", "C"]
stiffness = 3000
free_length = 0.2
[[loads]]
kind = "spring"
name = "twist"
link = "AB"
stiffness = 4
free_angle = 0.1
[[loads]]
kind = "damper"
name = "oil"
points = ["B", "C"]
damping = 12
[[loads]]
kind = "friction"
name = "seal"
guide = "B"
value = 30
[[loads]]
kind = "torque"
name = "brake"
link = "OA"
value = "-5*sin(q)"
[assembly]
sides = { B = "ahead" }
"""


@pytest.fixture(scope="module")
def loaded() -> ct.Mechanism:
    return ct.parse_mechanism(LOADED)


@pytest.fixture(scope="module")
def results(loaded: ct.Mechanism) -> ReductionResults:
    return reduction_results(loaded, 73)


def course(results: ReductionResults, label: str) -> LoadCourse:
    (found,) = (one for one in results.courses if one.label == label)
    return found


def test_every_load_follows_its_law(loaded: ct.Mechanism, results: ReductionResults) -> None:
    """Amounts by the laws as the description has them, of places and velocities of the motion."""
    motion = ct.motion(loaded, 73)
    slide, speed = motion.slide.sel(guide="B").values, motion.slide_velocity.sel(guide="B").values
    turning = motion.angle.sel(link="AB").values
    at = [0.3, 0.32, 0.5]
    laws = {
        "gas": np.where(
            speed >= 0, np.interp(slide, at, [-2000, -1500, -100]), np.interp(slide, at, [0, -50, -100])
        ),
        "cut": np.where(speed >= 0, -700.0, 0.0),
        "return": -3000 * ((0.9 - slide) - 0.2),
        "twist": -4 * (turning - 0.1),
        "oil": -12 * -speed,
        "seal": -30 * np.sign(speed),
        "brake": -5 * np.sin(motion.drive_value.values[:, 0]),
    }
    for label, law in laws.items():
        found = course(results, label)
        assert np.abs(found.strength - law).max() <= 1e3 * EPS * np.abs(law).max(), label
        assert found.unit == ("N m" if label in ("twist", "brake") else "N")
    places = {"gas": slide, "cut": slide, "return": 0.9 - slide, "twist": turning, "oil": 0.9 - slide}
    for label, place in places.items():
        assert np.abs(course(results, label).place - place).max() <= 64 * EPS
    rates = {"gas": speed, "cut": speed, "return": -speed, "oil": -speed, "seal": speed}
    for label, rate in rates.items():
        assert np.abs(course(results, label).speed - rate).max() <= 1e3 * EPS


def test_forces_times_speeds_are_the_power_of_each_load(
    loaded: ct.Mechanism, results: ReductionResults
) -> None:
    data = results.reduction
    for one in results.courses:
        power = one.strength * one.speed
        reduced = data.reduced_moment_part.sel(load=one.label).values * data.drive_rate.values
        assert np.abs(power - reduced).max() <= 1e3 * EPS * max(np.abs(reduced).max(), 1.0), one.label


def test_what_a_load_is_drawn_over(results: ReductionResults) -> None:
    drawn = {one.label: one.depends_on for one in results.courses}
    assert drawn == {
        "gas": "place", "cut": "place", "return": "place", "twist": "place", "oil": "speed", "seal": "speed",
        "brake": "",
    }  # fmt: skip


def test_figures_and_file_of_the_loads(results: ReductionResults) -> None:
    sheet = sheet_of(results)
    diagrams = [name for name in sheet.pictures if name.startswith("load-diagram")]
    assert diagrams == [f"load-diagram-{number}" for number in range(1, 7)]
    loads = sheet.pictures["loads"]
    assert isinstance(loads, Plot)
    assert [len(panel.curves) for row in loads.rows for panel in row] == [5, 2]
    gas = sheet.pictures["load-diagram-1"]
    assert isinstance(gas, CurveDiagram)
    assert np.array_equal(gas.traces[0].y, course(results, "gas").strength)
    columns = {column.name: column for column in sheet.tables["loads"].columns}
    assert {"load_gas", "coordinate_gas", "speed_gas", "load_cut_x", "load_brake"} <= columns.keys()
    assert columns["load_brake"].unit == "N m" and columns["coordinate_twist"].unit == "rad"
    assert "sum_of_moments" not in columns  # there is no machine


def test_the_sum_of_moments_of_a_machine() -> None:
    """Loads and drive at the mean speed: their works over the cycle cancel, as the flywheel has them."""
    machine = engine()
    results = reduction_results(machine, 361)
    assert results.driving is not None
    wheel = ct.flywheel(machine)
    assert results.driving == pytest.approx(wheel.driving_moment, rel=1e3 * EPS)
    picture = sheet_of(results).pictures["moment-sum"]
    assert isinstance(picture, Plot)
    ((panel,),) = picture.rows
    total = next(curve for curve in panel.curves if curve.role is CurveRole.SUM)
    assert np.array_equal(total.values, results.reduction.reduced_moment.values + results.driving)
    turned = results.reduction.drive_value.values[:, 0]
    # the trapezoid rule, one step of which has a jump
    assert abs(np.trapezoid(total.values, turned)) <= np.abs(total.values).max() * (turned[1] - turned[0])


def test_a_drive_that_turns_backwards_has_a_negative_driving_moment() -> None:
    results = reduction_results(ct.example("six-bar-press"), 5)
    assert results.driving == pytest.approx(-2263.03, abs=0.005)


def test_what_does_not_change_is_not_drawn() -> None:
    weightless = ct.parse_mechanism(
        LOADED.partition("[[loads]]")[0] + '[assembly]\nsides = { B = "ahead" }\n'
    )
    bare = sheet_of(reduction_results(weightless, 13))
    assert not any(name.startswith(("load", "moment-sum")) for name in bare.pictures)
    assert "loads" not in bare.tables


def test_loads_at_single_places_and_with_several_drives() -> None:
    text = ct.mechanism_text(ct.example("two-link-arm"))
    loads = '[[loads]]\nkind = "damper"\nlink = "AB"\ndamping = 2\nrelative_to = "OA"\n'
    arm = ct.parse_mechanism(text + loads)
    reduction = ct.reduce(arm, 7)
    (damper,) = load_courses(arm, reduction)
    turning = ct.motion(arm, 7).angular_velocity
    relative = (turning.sel(link="AB") - turning.sel(link="OA")).values
    assert np.abs(damper.strength + 2 * relative).max() <= 64 * EPS * np.abs(relative).max()
    one = load_courses(ct.parse_mechanism(LOADED), ct.reduce(ct.parse_mechanism(LOADED), at=[1.0]))
    assert all(found.strength.shape == (1,) for found in one)


def test_tables_are_drawn_with_their_points(loaded: ct.Mechanism) -> None:
    sheet: Any = masses_and_loads.sheet(link_masses(loaded))
    blocks = [block for section in sheet.chapters["masses-and-loads"].sections for block in section.blocks]
    (figure,) = (block for block in blocks if isinstance(block, Illustration))
    assert isinstance(figure.picture, CurveDiagram)
    out, back = figure.picture.traces
    assert out.marks.tolist() == [[0.3, -2000.0], [0.32, -1500.0], [0.5, -100.0]]
    assert back.y.tolist() == [0.0, -50.0, -100.0]
