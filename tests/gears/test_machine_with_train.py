"""The press of the coursework with its train: speeds, reduced inertia and reactions against the press driven alone."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import centrode as ct
from centrode.errors import InputError
from centrode.model.gear_trains import GEAR_TRAINS

TRAIN = """kind = "gear train"
scheme = "single planets"
module = "6 mm"
input_speed = "1300 rpm"
output_speed = "65 rpm"
pair_behind = [17, 68]
tolerance = 0.001
"""


@pytest.fixture(scope="module")
def results() -> Any:
    return ct.gear_train(GEAR_TRAINS.parse(TRAIN))


def test_speeds_inertia_and_reactions_close(results: Any) -> None:
    """The motor turns 20 times as fast; inertia divides by the square of that, the moment by it; powers balance."""
    press = ct.example("six-bar-press")
    whole = ct.train_mechanism(results, press)
    ratio = results.whole_ratio(results.chosen)
    assert ratio == pytest.approx(-20, rel=1e-12)
    alone, driven = ct.motion(press, samples=25), ct.motion(whole, samples=25)
    motor = driven.angular_velocity.sel(link="wheel-1")
    crank = driven.angular_velocity.sel(link="OA")
    assert np.allclose(motor, 1300 * math.pi / 30, rtol=1e-12)
    assert np.allclose(crank, -65 * math.pi / 30, rtol=1e-12)
    # The press turns once while its motor turns twenty times: the same places at the same samples.
    for point in ("A", "B", "D", "H"):
        places = [one.position.sel(point=point).to_numpy() for one in (alone, driven)]
        assert np.abs(places[0] - places[1]).max() < 1e-11
    reduced = [ct.reduce(mechanism, samples=25).reduced_inertia.to_numpy() for mechanism in (press, whole)]
    assert np.allclose(reduced[1] * ratio**2, reduced[0], rtol=1e-10)


def test_reactions_of_the_press_are_those_without_the_train(results: Any) -> None:
    press = ct.example("six-bar-press")
    whole = ct.train_mechanism(results, press)
    # At the same speed of the crank; the wheels have no masses, so the moments have the ratio.
    speed = -65 * math.pi / 30
    alone = ct.with_value(press, "drives.OA.speed", speed)
    first, second = ct.reactions(alone, samples=9), ct.reactions(whole, samples=9)
    moments = [one.balancing.to_numpy().ravel() for one in (first, second)]
    assert np.allclose(moments[1] * results.whole_ratio(results.chosen), moments[0], rtol=1e-9)
    sides = [side for side in first.side.to_numpy().tolist() if not side.startswith("O/")]
    assert len(sides) == 10
    for side in sides:
        one, two = (reactions.joint_force.sel(side=side).to_numpy() for reactions in (first, second))
        assert np.abs(one - two).max() < 1e-8 * np.abs(one).max()
    # In the crank's hinge the force between the teeth of the pair comes in, across the line of both axes.
    change = (second.joint_force - first.joint_force).sel(side="O/OA").to_numpy()
    teeth = second.tooth_force.sel(gear="carrier-1-OA").to_numpy()
    assert np.abs(np.hypot(*change.T) - np.hypot(*teeth.T)).max() < 1e-8 * np.abs(teeth).max()
    assert np.allclose(np.abs(moments[0]), np.abs(teeth[:, 1]) * 68 * 0.003, rtol=1e-9)


def test_the_machine_is_kept_and_its_flywheel_reduces_to_the_motor(results: Any) -> None:
    """Mean speed by the ratio, inertia by its inverse square; a cycle is twenty turns of the motor."""
    press = ct.example("six-bar-press")
    whole = ct.train_mechanism(results, press)
    assert whole.machine is not None
    assert whole.machine.mean_speed == pytest.approx(1300 * math.pi / 30, rel=1e-12)
    # The machine alone has a crank that turns at the same mean speed.
    alone, driven = ct.flywheel(press), ct.flywheel(whole)
    assert driven.turns == 20 * alone.turns
    assert driven.inertia is not None
    assert alone.inertia is not None
    assert driven.inertia * 400 == pytest.approx(alone.inertia, rel=1e-9)
    # The flywheel stays on the shaft of the crank.
    assert driven.added == pytest.approx(alone.added, rel=1e-9)
    for name in ("obtained", "time_of_cycle", "fluctuation"):
        assert getattr(driven, name) == pytest.approx(getattr(alone, name), rel=1e-9), name
    assert driven.greatest_speed == pytest.approx(20 * alone.greatest_speed, rel=1e-9)


def test_loads_by_the_angle_of_the_crank_are_those_of_the_motor(results: Any) -> None:
    text = ct.mechanism_text(ct.example("six-bar-press")).replace(
        "vector = [-9000.0, 0.0]", 'vector = ["-9000*(1 + 0.3*cos(q))", 0.0]'
    )
    press = ct.parse_mechanism(text)
    whole = ct.train_mechanism(results, press)
    first, second = (
        ct.reduce(mechanism, samples=25).reduced_moment.to_numpy() for mechanism in (press, whole)
    )
    assert np.abs(first).max() > 100
    ratio = results.whole_ratio(results.chosen)
    assert np.allclose(second * ratio, first, rtol=1e-9, atol=1e-9 * np.abs(first).max())
    by_table = text.replace(
        "[[guides]]",
        '[[loads]]\nkind = "torque"\nlink = "CD"\ntable = [["0 deg", 0], ["355 deg", 3]]\n\n[[guides]]',
        1,
    )
    with pytest.raises(InputError, match="table over the angle of its crank"):
        ct.train_mechanism(results, ct.parse_mechanism(by_table))


def test_a_machine_whose_motor_never_returns_with_its_crank_is_omitted() -> None:
    train = ct.gear_train(GEAR_TRAINS.parse(TRAIN.replace("[17, 68]", "[17, 67]").replace("0.001", "0.02")))
    assert ct.train_mechanism(train, "six-bar-press").machine is None


def test_machines_that_no_train_can_drive(results: Any) -> None:
    bare = ct.gear_train(
        GEAR_TRAINS.parse('kind = "gear train"\nscheme = "one pair"\nratio = 3\nmodule = 0.002\n')
    )
    with pytest.raises(InputError, match="no pair behind"):
        ct.train_mechanism(bare, "six-bar-press")
    for machine in ("five-bar-two-drives", "spherical-four-bar"):
        with pytest.raises(InputError, match="plane machine with one drive that turns a link"):
            ct.train_mechanism(results, machine)
    with pytest.raises(InputError, match="both have"):
        ct.train_mechanism(results, ct.train_mechanism(results, "six-bar-press"))
