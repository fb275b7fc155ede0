"""Forces at a given speed and acceleration of the drive, and at rest, beside virtual work and beside steady motion."""

from __future__ import annotations

import sys
from typing import Any

import numpy as np
import pytest

import centrode as ct

EPS = sys.float_info.epsilon
AT = np.radians([219.1, 120.0, 30.0, -77.0])


@pytest.fixture(scope="module")
def press() -> ct.Mechanism:
    return ct.example("six-bar-press")


@pytest.fixture(scope="module")
def engine() -> ct.Mechanism:
    return ct.example("single-cylinder-engine").model_copy(update={"gravity": (0.0, -9.81)})


def at_rest(mechanism: ct.Mechanism) -> ct.Mechanism:
    drives = (mechanism.drives[0].model_copy(update={"speed": 0.0}),)
    return mechanism.model_copy(update={"drives": drives, "machine": None})


@pytest.mark.parametrize("name", ["press", "engine"])
@pytest.mark.parametrize(("speed", "acceleration"), [(6.8, -2.77), (3.0, None), (0.0, 5.0), (0.0, None)])
def test_the_balancing_moment_is_that_of_virtual_work(
    name: str, speed: float, acceleration: float | None, request: pytest.FixtureRequest
) -> None:
    """M + J eps + J' omega^2/2 from the reduction, which knows no joint force; omega and eps in the drive's sense."""
    mechanism = request.getfixturevalue(name)
    sense = np.sign(mechanism.drives[0].speed)
    # at rest a load that acts while its point moves acts wherever that may be
    reduced = ct.reduce(mechanism if speed else at_rest(mechanism), at=AT)
    found = ct.reactions(mechanism, at=AT, speed=speed, acceleration=acceleration).balancing.values[:, 0]
    inertia, slope = reduced.reduced_inertia.values, reduced.reduced_inertia_slope.values
    parts = [inertia * sense * (acceleration or 0.0), 0.5 * slope * speed**2, -reduced.reduced_moment.values]
    size = np.max(np.abs(parts))
    assert found == pytest.approx(sum(parts), rel=0, abs=1e3 * EPS * size)


def test_units_and_the_mean_speed(press: ct.Mechanism) -> None:
    """65 rpm without acceleration is the mean speed of the machine."""
    mean, given = (
        ct.reactions(press, at=AT),
        ct.reactions(press, at=AT, speed="65 rpm", acceleration="0 rad/s^2"),
    )
    assert given.joint_force.values == pytest.approx(mean.joint_force.values, rel=64 * EPS)
    assert given.attrs["rate_from"] == "given"


def test_the_source_s_own_instant(press: ct.Mechanism) -> None:
    """The coursework at 120 deg: -6310.25 N m of the links, at the real speed and -2.7735 rad/s^2."""
    speed = abs(float(ct.steady_motion(press, at=[AT[1]]).drive_speed.values.ravel()[0]))
    found = ct.reactions(press, at="120 deg", speed=speed, acceleration="-2.7735 rad/s^2")
    # half a unit of the acceleration's last place, times the inertia of 15.457 kg m^2 there
    assert found.balancing.item() == pytest.approx(-6310.25, abs=0.5e-4 * 15.5 + 0.5e-2)


def test_real_speed_and_acceleration_give_the_forces_of_the_steady_motion(press: ct.Mechanism) -> None:
    steady = ct.steady_motion(press, at=[AT[1]])
    # what is given counts in the drive's own sense, which is clockwise here, what is shown along its value
    speed = -float(steady.drive_speed.values.ravel()[0])
    acceleration = -float(steady.drive_acceleration.values.ravel()[0])
    real = ct.reactions(press, at=[AT[1]], motion="real").balancing.values
    given = ct.reactions(press, at=[AT[1]], speed=speed, acceleration=acceleration).balancing.values
    assert given == pytest.approx(real, rel=1e-9)


def test_a_drive_at_rest(press: ct.Mechanism) -> None:
    """Static equilibrium in every position: no velocity, no inertia force, and the loads are what the drive holds."""
    still = at_rest(press)
    motion = ct.motion(still, 37)
    assert not motion.velocity.values.any() and not motion.time.values.any()
    found = ct.reactions(still, 37)
    assert not np.nan_to_num(found.inertia_force.values).any()
    reduced = ct.reduce(still, 37)
    size = np.abs(reduced.reduced_moment.values).max()
    assert found.balancing.values[:, 0] == pytest.approx(
        -reduced.reduced_moment.values, rel=0, abs=1e3 * EPS * size
    )
    assert "at rest in each position" in ct.summary(motion)
    with pytest.raises(ct.InputError, match="its speed is zero"):
        ct.integrate(still)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"speed": "3 m"}, "angular speed"),
        ({"speed": "fast"}, "fast"),
        ({"speed": 3, "acceleration": "1 m"}, "rad/s\\^2"),
        ({"acceleration": 3}, "an acceleration is given without a speed"),
        ({"speed": 3, "motion": "real"}, "choose one of them"),
    ],
)
def test_motions_that_cannot_be(press: ct.Mechanism, given: dict[str, Any], message: str) -> None:
    with pytest.raises(ct.InputError, match=message):
        ct.reactions(press, at=AT, **given)


def test_a_range_has_no_given_speed(press: ct.Mechanism) -> None:
    with pytest.raises(ct.InputError, match="a speed is given for a whole range"):
        ct.reactions(press, speed=3.0)
