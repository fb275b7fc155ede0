"""Motors and controllers of free motions against closed forms: exponentials, quadratures, linear systems."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.linalg import expm

import centrode as ct
from centrode.errors import InputError

INERTIA = 0.5


def wheel(**parts: object) -> ct.Mechanism:
    """A wheel of 0.5 kg m^2 about a fixed axis, with a drive of its angle."""
    given: dict[str, object] = {
        "frame": {"points": {"O": [0, 0]}},
        "links": {"OA": {"length": 1, "mass": 1, "centre": [0, 0], "inertia": INERTIA, "angle": 0}},
        "drives": [{"link": "OA", "start": 0}],
    }
    return ct.Mechanism(**(given | parts))


def turned(mechanism: ct.Mechanism, duration: float, at=None, **settings: object):
    return ct.simulate(mechanism, ct.Simulation(duration=duration, tolerance=1e-12, **settings), at=at)


def test_a_direct_current_motor_runs_up_exponentially():
    voltage, resistance, constant, ratio = 24.0, 0.8, 0.3, 2.0
    motor = {
        "drive": "OA",
        "kind": "direct current",
        "voltage": voltage,
        "resistance": resistance,
        "constant": constant,
        "ratio": ratio,
    }
    run = turned(wheel(motors=[motor]), 2.0)
    idle = voltage / constant / ratio
    rate = (constant * ratio) ** 2 / resistance / INERTIA
    assert np.allclose(run.drive_speed[:, 0], idle * (1 - np.exp(-rate * run.time)), rtol=1e-10, atol=1e-10)
    assert run.attrs["worst_energy_residual"] < 1e-9 * float(run.work_of_drive[-1])


def test_an_asynchronous_motor_takes_the_time_of_kloss_formula():
    synchronous, breakdown, slip = 100.0, 20.0, 0.2
    motor = {
        "drive": "OA",
        "kind": "asynchronous",
        "idle_speed": synchronous,
        "breakdown_moment": breakdown,
        "breakdown_slip": slip,
    }

    def moment(speed: float) -> float:
        s = 1 - speed / synchronous
        return 2 * breakdown / (s / slip + slip / s)

    time, _error = quad(lambda speed: INERTIA / moment(speed), 0.0, 90.0, epsabs=1e-13, epsrel=1e-13)
    run = turned(wheel(motors=[motor]), time)
    assert abs(float(run.drive_speed[-1, 0]) - 90.0) < 1e-8


def test_a_table_is_straight_between_its_rows_and_two_drives_have_a_motor_each():
    two = ct.Mechanism(
        frame={"points": {"O": [0, 0], "Q": [2, 0]}},
        links={
            name: {"length": 1, "mass": 1, "centre": [0, 0], "inertia": INERTIA, "angle": 0}
            for name in ("OA", "QB")
        },
        drives=[{"link": "OA", "start": 0}, {"link": "QB", "start": 0}],
        motors=[
            {"drive": "OA", "kind": "table", "table": [[0, 4], [10, 0]]},
            {"drive": "QB", "kind": "linear", "idle_speed": 10, "starting_moment": 4},
        ],
    )
    run = turned(two, 3.0)
    expected = 10 * (1 - np.exp(-4 / 10 / INERTIA * run.time))
    assert np.allclose(run.drive_speed[:, 0], expected, atol=1e-9)
    assert np.allclose(run.drive_speed[:, 1], expected, atol=1e-9)


@pytest.mark.parametrize("of", ["value", "speed"])
def test_pid_is_the_linear_system_of_its_gains(of: str):
    gains = {"proportional": 8.0, "integral": 6.0}
    gains |= {"derivative": 3.0} if of == "value" else {}
    controller = {"name": "hold", "drive": "OA", "target": "1 + 0.5*t", "of": of, **gains}
    run = turned(wheel(controllers=[controller]), 4.0, at=np.linspace(0, 4, 9))
    kp, ki, kd = 8.0, 6.0, gains.get("derivative", 0.0)
    # q, v, integral of the deviation, target, its slope
    matrix = np.zeros((5, 5))
    matrix[0, 1] = matrix[3, 4] = 1.0
    deviation = np.array([-1.0, 0, 0, 1, 0]) if of == "value" else np.array([0, -1.0, 0, 1, 0])
    matrix[2] = deviation
    matrix[1] = kp * deviation + ki * np.array([0, 0, 1.0, 0, 0])
    matrix[1] += kd * np.array([0, -1.0, 0, 0, 1])
    matrix[1] /= INERTIA
    start = np.array([0.0, 0, 0, 1.0, 0.5])
    expected = np.array([(expm(matrix * time) @ start)[:2] for time in run.time.values])
    assert np.allclose(run.drive_value[:, 0], expected[:, 0], atol=1e-9)
    assert np.allclose(run.drive_speed[:, 0], expected[:, 1], atol=1e-9)
    assert run.attrs["worst_energy_residual"] < 1e-9


def test_a_formula_with_a_state_filters_what_another_controller_asks_for():
    signals = [
        {"name": "wanted", "measures": "OA", "value": "3*sin(t) - v"},
        {
            "name": "late",
            "drive": "OA",
            "value": "z",
            "states": {"z": {"rate": "(wanted - z)/0.2", "start": 0.5}},
            "most": 100,
        },
    ]
    run = turned(wheel(controllers=signals), 3.0, at=[3.0])
    # v' = z / J, z' = (3 sin t - v - z) / 0.2, by the oscillator (s, c)
    matrix = np.zeros((4, 4))
    matrix[0, 1] = 1 / INERTIA
    matrix[1] = np.array([-1.0, -1.0, 3.0, 0.0]) / 0.2
    matrix[2, 3], matrix[3, 2] = 1.0, -1.0
    speed, state = (expm(3.0 * matrix) @ np.array([0.0, 0.5, 0.0, 1.0]))[:2]
    assert abs(float(run.drive_speed[0, 0]) - speed) < 1e-9
    assert abs(float(run.controller_output.sel(controller="late")[0]) - state) < 1e-9


def test_one_drive_keeps_its_law_while_a_controller_moves_another():
    arm = ct.Mechanism(
        gravity=[0, -9.81],
        frame={"points": {"O": [0, 0]}},
        links={
            "OA": {"length": 1, "mass": 1, "shape": "rod", "angle": 0},
            "AB": {"length": 1, "mass": 1, "shape": "rod", "angle": 0},
        },
        drives=[{"link": "OA", "start": 0, "speed": 0.5}, {"link": "AB", "relative_to": "OA", "start": 0}],
        controllers=[
            {
                "name": "hold",
                "drive": "AB",
                "target": 0,
                "proportional": 400,
                "derivative": 60,
                "integral": 50,
            }
        ],
    )
    run = turned(arm, 3.0, keeps=["OA"])
    assert np.allclose(run.drive_value[:, 0], 0.5 * run.time, atol=1e-12)
    assert abs(float(run.drive_value[-1, 1])) < 0.02
    assert run.attrs["worst_energy_residual"] < 1e-8


def test_a_limit_of_the_output_is_kept():
    controller = {"name": "far", "drive": "OA", "target": 100, "proportional": 50, "most": 2}
    run = turned(wheel(controllers=[controller]), 1.0)
    assert np.allclose(run.drive_speed[:, 0], 2 / INERTIA * run.time, atol=1e-11)


@pytest.mark.parametrize(
    ("parts", "named"),
    [
        (
            {
                "controllers": [
                    {"name": "a", "drive": "OA", "value": "b - v"},
                    {"name": "b", "measures": "OA", "value": "2*a"},
                ]
            },
            "algebraic loop",
        ),
        ({"controllers": [{"name": "a", "drive": "OA", "value": "a - v"}]}, "algebraic loop"),
        (
            {
                "controllers": [
                    {
                        "name": "a",
                        "drive": "OA",
                        "of": "speed",
                        "target": 1,
                        "derivative": 1,
                        "proportional": 1,
                    }
                ]
            },
            "algebraic loop",
        ),
        ({"controllers": [{"name": "a", "drive": "OA", "proportional": 1}]}, "target"),
        ({"controllers": [{"name": "a", "drive": "OA", "value": "u"}]}, "u"),
        ({"controllers": [{"name": "a", "drive": "X", "value": "v"}]}, "X"),
        ({"controllers": [{"name": "a", "drive": "OA"}]}, "gains"),
        ({"motors": [{"drive": "X", "kind": "linear", "idle_speed": 1, "starting_moment": 1}]}, "X"),
        ({"motors": [{"drive": "OA", "kind": "linear", "idle_speed": 1}]}, "starting_moment"),
        ({"motors": [{"drive": "OA", "kind": "direct current", "voltage": 1}]}, "resistance"),
        ({"motors": [{"drive": "OA", "kind": "table", "table": [[1, 1], [0, 2]]}]}, "increase"),
    ],
)
def test_wrong_motors_and_controllers_are_named(parts: dict[str, object], named: str):
    with pytest.raises(InputError) as caught:
        wheel(**parts)
    assert named in str(caught.value)


def test_a_motor_of_a_drive_is_that_of_the_simulation_on_the_reduced_equation():
    """A four-bar runs up by the same motor on both routes."""
    motor = {"kind": "linear", "idle_speed": 8, "starting_moment": 3}
    parts = {
        "frame": {"points": {"O": [0, 0], "C": [1, 0]}},
        "links": {
            "OA": {"length": 0.2, "mass": 3, "shape": "rod"},
            "AB": {"length": 0.9, "mass": 2, "shape": "rod"},
            "CB": {"length": 0.6, "mass": 2, "shape": "rod"},
        },
        "drives": [{"link": "OA", "start": "40 deg", "speed": 1}],
        "assembly": {"sides": {"B": "left"}},
    }
    reduced = ct.simulate(ct.Mechanism(**parts), ct.Simulation(motor=motor, duration=2, tolerance=1e-11))
    both = ct.Mechanism(**parts, motors=[{**motor, "drive": "OA"}])
    whole = ct.simulate(both, ct.Simulation(duration=2, tolerance=1e-11))
    assert math.isclose(float(whole.drive_speed[-1, 0]), float(reduced.drive_speed[-1]), rel_tol=1e-8)
