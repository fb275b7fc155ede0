"""Extreme positions and transmission angles against the triangles of textbooks."""

from __future__ import annotations

import math

import numpy as np
import pytest

import centrode as ct
from centrode.analysis.transmission import transmission_results

EPS = 2.0**-52
A, B, C, D = 1.0, 3.5, 3.0, 4.0


@pytest.fixture
def crank_rocker() -> ct.Mechanism:
    return ct.four_bar(crank=A, coupler=B, rocker=C, ground=D)


def test_extreme_positions_of_a_rocker(crank_rocker: ct.Mechanism) -> None:
    """Crank and coupler in line: triangles with sides a + b or b - a, c, d."""
    plan = ct.plan_of_positions(crank_rocker, link="rocker")
    wanted = []
    for side, shift in ((A + B, 0.0), (B - A, math.pi)):
        cosine = (D**2 + side**2 - C**2) / (2 * D * side)
        wanted.append(math.acos(cosine) + shift)
    assert plan.link == "rocker"
    turns = sorted(value % math.tau for value in plan.extremes)
    assert turns == pytest.approx(sorted(value % math.tau for value in wanted), abs=64 * EPS)
    assert plan.zero == plan.extremes[0]


@pytest.mark.parametrize("count", [2, 12, 24])
def test_positions_are_evenly_spaced(crank_rocker: ct.Mechanism, count: int) -> None:
    plan = ct.plan_of_positions(crank_rocker, count)
    values = plan.positions.drive_value.values[:, 0]
    assert plan.closed
    assert len(values) == count
    slack = 8 * EPS * np.abs(values).max()
    # in the range of the run, where the turn begins again once
    assert (values >= 0.0).all()
    assert (values < math.tau).all()
    steps = np.diff(values)
    again = steps < 0.0
    assert np.count_nonzero(again) <= 1
    assert np.allclose(steps + math.tau * again, math.tau / count, rtol=0, atol=slack)


def test_a_slider_comes_first() -> None:
    plan = ct.plan_of_positions(ct.example("six-bar-press"))
    assert plan.link == "H"
    at_rest = ct.motion(ct.example("six-bar-press"), at=plan.extremes)
    rate = at_rest.slide_velocity_coefficient.sel(guide="H").values
    second = at_rest.slide_acceleration_coefficient.sel(guide="H").values
    # exact to rounding of the drive's value
    assert (np.abs(rate) <= 16 * EPS * math.tau * np.abs(second)).all()


def test_the_scotch_yoke_rests_at_its_ends() -> None:
    plan = ct.plan_of_positions(ct.example("scotch-yoke"))
    turns = sorted(abs(math.sin(value)) for value in plan.extremes)
    assert len(turns) == 2
    assert max(turns) <= 16 * EPS


def test_where_it_locks_positions_run_between_the_ends() -> None:
    locked = ct.example("slider-between-cranks-locked")
    plan = ct.plan_of_positions(locked, 6)
    values = plan.positions.drive_value.values[:, 0]
    limits = ct.motion(locked).event_value.values
    assert not plan.closed
    assert plan.link == ""
    assert (plan.positions.status.values == ct.Status.OK).all()
    assert values.min() >= 0.0
    assert values.max() < limits.min()


@pytest.mark.parametrize("count", [1, 0, -3, 37, True])
def test_numbers_of_positions_out_of_range(crank_rocker: ct.Mechanism, count: int) -> None:
    with pytest.raises(ct.InputError, match="2 to 36"):
        ct.plan_of_positions(crank_rocker, count)


def test_links_that_have_no_extreme_position(crank_rocker: ct.Mechanism) -> None:
    with pytest.raises(ct.InputError, match="no extreme position"):
        ct.plan_of_positions(crank_rocker, link="crank")
    with pytest.raises(ct.InputError, match="neither a link nor a guide"):
        ct.plan_of_positions(crank_rocker, link="piston")
    with pytest.raises(ct.InputError, match="plane only"):
        ct.plan_of_positions(ct.example("spherical-four-bar"))


def test_transmission_angle_of_a_four_bar(crank_rocker: ct.Mechanism) -> None:
    """Law of cosines in the triangle of coupler and rocker."""
    angles = ct.transmission_angles(crank_rocker, samples=91)
    phi = angles.drive_value.values[:, 0]
    cosine = (B**2 + C**2 - A**2 - D**2 + 2 * A * D * np.cos(phi)) / (2 * B * C)
    wanted = np.arccos(cosine)
    found = angles.transmission_angle.sel(group="coupler-rocker").values
    # the arc of a cosine loses digits as its sine does
    assert (np.abs(found - wanted) <= 64 * EPS / np.sin(wanted)).all()
    assert np.array_equal(angles.pressure_angle.values[:, 0], np.abs(np.pi / 2 - found))
    assert angles.transmission_angle.attrs["units"] == "rad"


def test_pressure_angle_of_a_slider_crank() -> None:
    """sin of it is the height of the crank pin over the guide, over the rod."""
    mechanism = ct.slider_crank(crank=1, coupler=3, offset=0.4)
    angles = ct.transmission_angles(mechanism, samples=73)
    data = ct.motion(mechanism, samples=73)
    pin, slider = (data.position.sel(point=name, axis="y").values for name in ("A", "B"))
    wanted = np.arcsin(np.abs(pin - slider) / 3)
    found = angles.pressure_angle.values[:, 0]
    assert (np.abs(found - wanted) <= 64 * EPS / np.cos(wanted)).all()


def test_a_lever_with_its_slot_through_the_pivot_is_pressed_squarely() -> None:
    angles = ct.transmission_angles(ct.example("whitworth-quick-return"), samples=37).sel(group="lever")
    assert np.abs(angles.pressure_angle.values).max() <= 16 * EPS


def test_a_slot_beside_the_pivot_presses_askew() -> None:
    """sin of it is the slot's distance from the pivot over that of the pin."""
    mechanism = ct.example("inverted-slider-crank")
    data = ct.motion(mechanism, samples=37)
    arm = data.position.sel(point="A").values - data.position.sel(point="D").values
    wanted = np.arcsin(0.2 / np.hypot(*arm.T))
    found = ct.transmission_angles(mechanism, samples=37).pressure_angle.values[:, 0]
    assert (np.abs(found - wanted) <= 64 * EPS / np.cos(wanted)).all()


def test_two_guides_keep_their_angle() -> None:
    angles = ct.transmission_angles(ct.example("scotch-yoke"), samples=19)
    assert np.allclose(angles.transmission_angle, math.pi / 2, rtol=0, atol=8 * EPS)


def test_the_transmission_angle_is_flat_at_a_limit() -> None:
    locked = ct.example("slider-between-cranks-locked")
    limit = float(ct.motion(locked).event_value.values.min())
    near = ct.transmission_angles(locked, at=[limit - 1e-8])
    least = min(float(np.sin(near.transmission_angle.sel(group="CB-BD")[0])), 1.0)
    # the sine grows as the root of the distance from the limit
    assert least <= 8 * math.sqrt(1e-8)


def test_absence_and_refusals() -> None:
    locked = ct.transmission_angles(ct.example("slider-between-cranks-locked"), samples=7)
    assert np.isnan(locked.transmission_angle.values[2]).all()
    with pytest.raises(ct.InputError, match="no group"):
        ct.transmission_angles(ct.example("two-link-arm"))


def acute(angle: float) -> float:
    return min(angle, math.pi - angle)


def extremes(mechanism: ct.Mechanism, group: str, **asked: object) -> tuple[float, float]:
    """Least and greatest transmission angle, of very few samples: they do not depend on them."""
    angles = ct.transmission_angles(mechanism, **{"samples": 4, **asked}).sel(group=group)  # type: ignore[arg-type]
    return float(angles.least_transmission_angle), float(angles.greatest_transmission_angle)


def test_the_least_transmission_angle_of_a_four_bar_is_that_of_its_triangles() -> None:
    """Crank in line with the frame: sides d -+ a, b, c; between them the links stand square to each other."""
    least, greatest = extremes(ct.four_bar(crank=A, coupler=B, rocker=C, ground=D), "coupler-rocker")
    ends = [math.acos((B**2 + C**2 - (D + sign * A) ** 2) / (2 * B * C)) for sign in (-1, 1)]
    assert ends[0] < math.pi / 2 < ends[1]
    assert least == pytest.approx(min(map(acute, ends)), abs=64 * EPS)
    assert greatest == pytest.approx(math.pi / 2, abs=EPS)


def test_extremes_of_a_slider_crank_and_of_a_part_of_its_turn() -> None:
    """The rod's lean to the guide is asin((r sin q - e) / l), q the angle of the crank."""
    mechanism = ct.slider_crank(crank=1, coupler=3, offset=0.4)
    group = "coupler"
    assert extremes(mechanism, group) == pytest.approx((math.acos(1.4 / 3), math.pi / 2), abs=64 * EPS)
    part = extremes(mechanism, group, start=0.7, stop=1.0)
    exact = sorted(math.acos(abs(math.sin(q) - 0.4) / 3) for q in (0.7, 1.0))
    assert part == pytest.approx(exact, abs=64 * EPS)


def test_where_it_locks_the_least_is_nothing_and_the_pressure_is_square() -> None:
    locked = ct.example("slider-between-cranks-locked")
    least, greatest = extremes(locked, "CB-BD")
    assert least == 0.0
    told = next(one for one in ct.rotatability(locked).one.transmissions if "CB-BD" in one.group)
    assert least == told.least
    # the range begins at 0: the stationary value at 18.6 deg, folded, lies in it
    assert greatest == pytest.approx(acute(told.extremes[0][1]), abs=1e-12)
    rows = {row[0]: row[1:] for row in map(str.split, ct.summary(transmission_results(locked)).splitlines())}
    assert rows["CB-BD"] == ["0.0000", f"{math.degrees(greatest):.4f}", "90.0000"]


@pytest.mark.parametrize(
    "name",
    ["crank-rocker", "drag-link", "six-bar-press", "slider-between-cranks", "whitworth-quick-return",
     "klann-leg", "parallelogram", "spherical-four-bar", "spherical-crank-guide"],
)  # fmt: skip
def test_over_a_turn_the_least_angle_is_that_of_rotatability(name: str) -> None:
    mechanism = ct.example(name)
    angles = ct.transmission_angles(mechanism, samples=3)
    told = [one.least for one in ct.rotatability(mechanism).one.transmissions]
    assert angles.least_transmission_angle.values == pytest.approx(told, abs=1e-12)


@pytest.mark.parametrize(
    "name", ["crank-rocker", "scott-russell", "watt-six-bar", "tangent-mechanism", "hookes-joint"]
)
def test_extremes_bound_every_sample_and_are_reached_between_them(name: str) -> None:
    angles = ct.transmission_angles(ct.example(name), samples=2001)
    between = angles.transmission_angle.values[angles.status.values == ct.Status.OK]
    values = np.minimum(between, np.pi - between)
    least, greatest = angles.least_transmission_angle.values, angles.greatest_transmission_angle.values
    assert (least <= values.min(axis=0) + 64 * EPS).all()
    assert (greatest >= values.max(axis=0) - 64 * EPS).all()
    steps = np.abs(np.diff(values, axis=0)).max(axis=0)
    assert (values.min(axis=0) - least <= steps).all()
    assert (greatest - values.max(axis=0) <= steps).all()


def test_two_drives_have_extremes_over_the_time() -> None:
    """A five-bar: cosine of the angle between the rods by the distance of the pins, looked at finely."""
    mechanism = ct.example("five-bar-two-drives")
    fine = ct.transmission_angles(mechanism, samples=4001)
    between = fine.transmission_angle.values[fine.status.values == ct.Status.OK, 0]
    values = np.minimum(between, np.pi - between)
    few = ct.transmission_angles(mechanism, samples=3)
    step = np.abs(np.diff(values)).max()
    assert -64 * EPS <= values.min() - float(few.least_transmission_angle[0]) <= step
    assert -64 * EPS <= float(few.greatest_transmission_angle[0]) - values.max() <= step
