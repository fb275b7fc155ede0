"""Equilibria and modes with controllers, against closed forms and characteristic polynomials."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

import centrode as ct

G, MASS, LENGTH = 9.81, 2.0, 0.6
INERTIA, WEIGHT = MASS * LENGTH**2 / 3, 0.5 * MASS * G * LENGTH


def arm(*controllers: dict[str, Any], **parts: Any) -> ct.Mechanism:
    return ct.Mechanism(
        gravity=[0, -G],
        frame={"points": {"O": [0, 0]}},
        links={"OA": {"length": LENGTH, "mass": MASS, "shape": "rod", "angle": 0}},
        drives=[{"link": "OA", "start": 0}],
        controllers=[{"name": "hold", "drive": "OA", **one} for one in controllers],
        **parts,
    )


def eigenvalues(found: Any) -> np.ndarray:
    values = found.growth_rate.values[0] + 1j * found.damped_frequency.values[0]
    return np.sort_complex(values[np.isfinite(values)])


def roots(*polynomial: float) -> np.ndarray:
    found = np.roots(polynomial)
    return np.sort_complex(found[found.imag >= 0])


def test_a_proportional_controller_is_a_spring() -> None:
    found = ct.equilibrium(arm({"target": 0.5, "proportional": 60, "derivative": 12}))
    exact = brentq(lambda a: 60 * (0.5 - a) - WEIGHT * math.cos(a), 0, 1, xtol=1e-15)
    assert np.allclose(found.drive_value, exact, rtol=0, atol=1e-13)
    assert np.allclose(found.controller_output, WEIGHT * math.cos(exact))
    stiffness = 60 - WEIGHT * math.sin(exact)
    assert np.allclose(eigenvalues(found), roots(INERTIA, 12, stiffness), rtol=1e-12)
    # its moment is bounded: the arm falls to where the bound bears it
    bounded = ct.equilibrium(arm({"target": 0.5, "proportional": 60, "most": 5.0}))
    places = bounded.drive_value.values[:, 0]
    assert np.min(np.abs(places + math.acos(5.0 / WEIGHT))) < 1e-12


def test_an_integral_leaves_no_deviation_and_adds_a_root() -> None:
    gains = {"target": 0.5, "proportional": 60, "integral": 40, "derivative": 12}
    found = ct.equilibrium(arm(gains))
    assert np.allclose(found.drive_value, 0.5, rtol=0, atol=1e-13)
    assert np.allclose(found.controller_output, WEIGHT * math.cos(0.5))
    stiffness = 60 - WEIGHT * math.sin(0.5)
    assert np.allclose(eigenvalues(found), roots(INERTIA, 12, stiffness, 40), rtol=1e-11)
    modes = ct.modes(arm(gains))
    assert np.allclose(np.sort(-modes.growth_rate), np.sort(-roots(INERTIA, 12, stiffness, 40).real))
    # Routh and Hurwitz: oscillations grow from I = d k / J on
    followed = ct.equilibrium(arm(gains), vary={"controllers.hold.integral": (10, 4000)})
    assert math.isclose(float(followed.critical_value[0]), 12 * stiffness / INERTIA, rel_tol=1e-8)
    assert math.isclose(float(followed.critical_frequency[0]) ** 2, stiffness / INERTIA, rel_tol=1e-6)


def test_states_of_a_formula_rest_where_their_rates_vanish() -> None:
    # a filter between the deviation and the moment
    found = ct.equilibrium(arm({"value": "x - 12*v", "states": {"x": "(60*(0.5 - q) - x)/0.02"}}))
    exact = brentq(lambda a: 60 * (0.5 - a) - WEIGHT * math.cos(a), 0, 1, xtol=1e-15)
    assert np.allclose(found.drive_value, exact, rtol=0, atol=1e-12)
    polynomial = np.polyadd(np.polymul([INERTIA, 12, -WEIGHT * math.sin(exact)], [0.02, 1]), [60])
    assert np.allclose(eigenvalues(found), roots(*polynomial), rtol=1e-10)


def test_what_holds_a_speed_at_zero_is_a_spring_about_the_initial_position() -> None:
    found = ct.equilibrium(arm({"target": 0, "of": "speed", "proportional": 6, "integral": 40}))
    exact = brentq(lambda a: -40 * a - WEIGHT * math.cos(a), -1, 0, xtol=1e-15)
    assert np.allclose(found.drive_value, exact, rtol=0, atol=1e-13)


def test_two_joints_with_integrals_have_the_roots_of_their_state_matrix() -> None:
    """Point masses at the ends of rods of length 1, by absolute angles a, b = drives a and b - a."""
    first, second = 0.4, -0.7
    gains = {"proportional": 80, "integral": 90, "derivative": 15}
    robot = ct.Mechanism(
        gravity=[0, -G],
        frame={"points": {"O": [0, 0]}},
        links={
            "OA": {"length": 1, "mass": 1, "inertia": 0, "centre": [1, 0], "angle": 0.2},
            "AB": {"length": 1, "mass": 1, "inertia": 0, "centre": [1, 0], "angle": -0.2},
        },
        drives=[{"link": "OA", "start": 0.2}, {"link": "AB", "relative_to": "OA", "start": -0.4}],
        controllers=[
            {"name": "shoulder", "drive": "OA", "target": first, **gains},
            {"name": "elbow", "drive": "AB", "target": second, **gains},
        ],
    )
    found = ct.equilibrium(robot)
    assert np.allclose(found.drive_value, [[first, second]], rtol=0, atol=1e-12)
    a, b = first, first + second
    mass = np.array([[2, math.cos(a - b)], [math.cos(a - b), 1]])
    weight = np.diag([-2 * G * math.sin(a), -G * math.sin(b)])
    drives = np.array([[1.0, 0.0], [-1.0, 1.0]])
    turned = {name: x * drives.T @ drives for name, x in (("k", 80), ("d", 15))}
    zero, one = np.zeros((2, 2)), np.eye(2)
    inverse = np.linalg.inv(mass)
    matrix = np.block(
        [
            [zero, one, zero],
            [-inverse @ (turned["k"] + weight), -inverse @ turned["d"], 90 * inverse @ drives.T],
            [-drives, zero, zero],
        ]
    )
    exact = np.linalg.eigvals(matrix)
    assert np.allclose(eigenvalues(found), np.sort_complex(exact[exact.imag >= 0]), rtol=1e-9)


@pytest.mark.parametrize(
    ("controller", "word"),
    [
        ({"target": 1, "of": "speed", "proportional": 6, "integral": 40}, "its integral grows"),
        ({"target": "sin(t)", "proportional": 6}, "depends on time"),
        ({"value": "x", "states": {"x": "1"}}, "its state x changes by 1"),
        ({"value": "x", "states": {"x": "v"}}, "may have any value"),
    ],
)
def test_what_never_rests_is_named(controller: dict[str, Any], word: str) -> None:
    with pytest.raises(ct.InputError, match=word):
        ct.equilibrium(arm(controller))


def test_an_integral_whose_bound_does_not_bear_the_load_has_no_rest() -> None:
    with pytest.raises(ct.MotionError, match="states of controllers"):
        ct.equilibrium(arm({"target": 0.5, "proportional": 60, "integral": 40, "most": 5}))


def test_states_that_matter_to_no_moment_count_for_nothing() -> None:
    found = ct.equilibrium(arm({"value": "60*(0.5 - q)", "states": {"x": "q - 3"}}))
    assert found.sizes["equilibrium"] == 1


def test_the_controller_of_a_held_drive_gives_others_its_output() -> None:
    robot = ct.Mechanism(
        gravity=[0, -G],
        frame={"points": {"O": [0, 0], "Q": [2, 0]}},
        links={
            "OA": {"length": 1, "mass": 1, "shape": "rod", "angle": 0.2},
            "QB": {"length": 1, "mass": 1, "shape": "rod", "angle": 0.0},
        },
        drives=[{"link": "OA", "start": 0.2}, {"link": "QB", "start": 0}],
        controllers=[
            {"name": "wish", "drive": "OA", "target": 1.2, "proportional": 1},
            {"name": "follow", "drive": "QB", "value": "50*(wish - q)"},
        ],
    )
    found = ct.equilibrium(robot, hold={"OA": 0.5})
    # the first gives 1.2 - 0.5
    exact = brentq(lambda a: 50 * (0.7 - a) - 0.5 * G * math.cos(a), 0, 1, xtol=1e-15)
    assert np.min(np.abs(found.drive_value.values[:, 1] - exact)) < 1e-12


def test_a_cart_whose_controller_presses_it_into_a_buffer() -> None:
    cart = ct.Mechanism(
        gravity=[-G, 0],
        frame={"points": {"O": [0, 0]}},
        links={"cart": {"points": {"P": [0, 0]}, "mass": 3}},
        guides=[{"point": "P", "on": "frame", "through": "O", "direction": [1, 0], "link": "cart"}],
        drives=[{"guide": "P", "start": 0}],
        controllers=[
            {"name": "c", "drive": "P", "target": 0.3, "proportional": 500, "integral": 200, "derivative": 30}
        ],
        stops=[{"guide": "P", "most": 0.25, "stiffness": 1000}],
        loads=[{"kind": "friction", "guide": "P", "coefficient": 0.1}],
    )  # fmt: skip
    found = ct.equilibrium(cart)
    assert np.allclose(found.drive_value, 0.3, rtol=0, atol=1e-13)
    assert np.allclose(found.controller_output, 3 * G + 1000 * 0.05)
    assert np.allclose(found.restraint_force, -1000 * 0.05)
    assert np.allclose(eigenvalues(found), roots(3, 30, 1500, 200), rtol=1e-11)
    # whatever friction does, an integral comes to its target
    assert np.all(np.abs(found.friction_reach) < 1e-12)


def test_derivatives_of_a_motion_go_by_gains_too() -> None:
    moved = arm(
        {"target": 0.5, "proportional": 60, "integral": 40, "derivative": 12},
        simulation={"duration": 0.5, "tolerance": 1e-11},
    )
    path = "controllers.hold.integral"
    exact = ct.simulate(moved, at=[0.5], gradients=[path]).coordinate_gradient.values[0, 0, 0]
    ends = [
        float(ct.simulate(ct.with_value(moved, path, 40 + h), at=[0.5]).drive_value[0, 0])
        for h in (1e-2, -1e-2)
    ]
    assert math.isclose(exact, (ends[0] - ends[1]) / 2e-2, rel_tol=1e-6)
