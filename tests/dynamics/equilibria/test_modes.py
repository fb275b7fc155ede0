"""Modes against references and closed forms: at rest, with damping, about a steady rotation."""

from __future__ import annotations

import math

import numpy as np
import pytest

import centrode as ct
from sprung import five_bar, pendulum, sprung_four_bar

# mpmath, 30 digits
FOUR_BAR_UNDAMPED = 14.0054161912752131
FOUR_BAR_DAMPED = -0.0290953555274524096 + 14.0053859693733763j
FIVE_BAR = (4.81170006786152, 7.71726917099389)
FIVE_BAR_AT = (-0.234679831669363, 0.940758482527631)
ADVISED = 1e-9


def test_four_bar_oscillates_as_the_reference_does() -> None:
    found = ct.modes(sprung_four_bar())
    eigenvalue = complex(found.growth_rate[0], found.damped_frequency[0])
    assert abs(eigenvalue - FOUR_BAR_DAMPED) < ADVISED * abs(FOUR_BAR_DAMPED)
    assert abs(float(found.natural_frequency[0]) - FOUR_BAR_UNDAMPED) < ADVISED * FOUR_BAR_UNDAMPED
    assert abs(float(found.undamped_frequency[0]) - FOUR_BAR_UNDAMPED) < ADVISED * FOUR_BAR_UNDAMPED
    assert math.isclose(
        float(found.damping_ratio[0]), -FOUR_BAR_DAMPED.real / abs(FOUR_BAR_DAMPED), rel_tol=1e-9
    )


def test_five_bar_oscillates_as_the_reference_does() -> None:
    start = {f"drives.{name}.start": value for name, value in zip(("AB", "ED"), FIVE_BAR_AT, strict=True)}
    mechanism = five_bar()
    for path, value in start.items():
        mechanism = ct.with_value(mechanism, path, value)
    found = ct.modes(mechanism)
    assert np.allclose(found.drive_value.values, FIVE_BAR_AT, atol=1e-9)
    assert np.allclose(found.natural_frequency.values, FIVE_BAR, rtol=ADVISED, atol=0)
    assert found.damping_ratio.values.tolist() == [0.0, 0.0]
    # without damping all coordinates pass the equilibrium together
    assert np.allclose(np.sin(found.mode_phase.values), 0, atol=1e-9)
    assert np.allclose(found.mode_amplitude.values.max(axis=1), 1)


def test_a_simulation_of_a_small_departure_swings_at_the_frequency() -> None:
    found = ct.modes(pendulum())
    frequency = float(found.natural_frequency[0])
    assert math.isclose(frequency, math.sqrt(1.5 * 9.81), rel_tol=1e-14)
    hanging = ct.with_value(pendulum(), "links.OA.angle", -math.pi / 2 + 1e-5)
    period = 2 * math.pi / frequency
    run = ct.simulate(hanging, ct.Simulation(duration=period, tolerance=1e-12), at=[period / 2, period])
    apart = run.generalised_coordinate.values[:, 0] + math.pi / 2
    assert np.allclose(apart, [-1e-5, 1e-5], atol=1e-13)


def test_heavy_damping_creeps_without_oscillating() -> None:
    found = ct.modes(pendulum(loads=[{"kind": "damper", "link": "OA", "damping": 10.0}]))
    inertia, stiffness = 1 / 3, 9.81 / 2
    roots = np.sort(np.roots([inertia, 10.0, stiffness]))
    assert np.allclose(np.sort(found.growth_rate.values), roots, rtol=1e-12)
    assert found.damped_frequency.values.tolist() == [0.0, 0.0]


def test_arms_of_a_rotor_swing_with_the_centrifugal_force() -> None:
    rotor = ct.Mechanism(
        frame={"points": {"O": [0, 0]}},
        links={
            "OA": {"length": 0.3, "mass": 1, "shape": "rod", "angle": 0},
            "AB": {"length": 0.2, "mass": 1, "shape": "rod", "angle": 0.3},
        },
        drives=[{"link": "OA", "start": 0}],
    )
    found = ct.modes(rotor, speed={"OA": "10 rad/s"})
    # w = W sqrt(r m s / J) of a rod hinged at a distance r from the axis
    assert math.isclose(
        float(found.natural_frequency[0]), 10 * math.sqrt(0.3 * 0.1 / (0.2**2 / 3)), rel_tol=1e-9
    )
    assert found.attrs["stability"] == "stable"


def test_what_does_not_turn_steadily_says_so() -> None:
    # weight pulls the second rod now outwards, now inwards
    upright = ct.Mechanism(
        gravity=[0, -9.81],
        frame={"points": {"O": [0, 0]}},
        links={
            "OA": {"length": 0.3, "mass": 1, "shape": "rod", "angle": 0},
            "AB": {"length": 0.2, "mass": 1, "shape": "rod", "angle": 0.3},
        },
        drives=[{"link": "OA", "start": 0}],
    )
    with pytest.raises(ct.MotionError, match="constant speeds"):
        ct.modes(upright, speed={"OA": "10 rad/s"})


def test_unstable_equilibria_have_modes_that_grow() -> None:
    found = ct.modes(pendulum(), equilibrium=2)
    assert np.allclose(np.sort(found.growth_rate.values), [-math.sqrt(1.5 * 9.81), math.sqrt(1.5 * 9.81)])
    assert found.attrs["stability"] == "unstable"
