"""Extreme positions and transmission angles against the triangles of textbooks."""

from __future__ import annotations

import math

import numpy as np
import pytest

import centrode as ct

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
    assert np.allclose(np.diff(values), math.tau / count, rtol=0, atol=8 * EPS * np.abs(values).max())


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
    with pytest.raises(ct.InputError, match="no link and no guide"):
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
