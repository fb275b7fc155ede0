"""Fixed steps: their order and their right sides; what is refused."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import centrode as ct
from centrode.dynamics.simulation.fixed_steps import StepSlopes
from centrode.dynamics.simulation.reduced_motion import reduced_setting
from centrode.dynamics.simulation.steady_state import steady_regime
from centrode.numerics.machine_code import PRESENT
from simulated import PENDULUM, crank_rocker, pendulum, rotor, sledge, spherical

SMOOTH = """
[[loads]]
kind = "friction"
link = "DB"
viscous = 0.4
[[loads]]
kind = "spring"
link = "DB"
stiffness = 2
free_angle = 1.5
[[loads]]
kind = "torque"
link = "OA"
value = "cos(2*t) - 0.1*v + 0.3*sin(x)"
"""


@pytest.mark.parametrize("name", ["plane", "sphere"])
def test_fixed_steps_are_of_order_four(name: str) -> None:
    """Half the step, a sixteenth of the error: log2 of the ratio is 4 within a tenth, over the whole motion."""
    mechanism = crank_rocker(SMOOTH) if name == "plane" else spherical(math.pi / 12, math.pi / 4)
    settings = ct.Simulation(driving="2 - 0.2*v", speed=3, duration=2, tolerance=1e-13, samples=41)
    at = np.linspace(0.0, 2.0, 41)
    exact = ct.simulate(mechanism, settings, at=at).drive_speed.values
    errors = []
    for steps in (400, 800, 1600):
        fixed = settings.model_copy(update={"scheme": "runge-kutta-4", "steps": steps})
        found = ct.simulate(mechanism, fixed, at=at)
        errors.append(float(np.linalg.norm(found.drive_speed.values - exact)))
    orders = [math.log2(errors[k] / errors[k + 1]) for k in range(2)]
    assert orders == pytest.approx([4, 4], abs=0.1)


@pytest.mark.parametrize("mechanism", [crank_rocker(SMOOTH), spherical(0.3, 0.8), pendulum()])
def test_right_sides_of_steps_are_those_of_the_field(mechanism: ct.Mechanism) -> None:
    """Series by Horner's rule in plain numbers, and by arrays: the same forces at the same states."""
    setting = reduced_setting(mechanism, ct.Simulation(driving="2 - 0.2*v + q", speed=3, duration=1))
    field, slopes = setting.field, StepSlopes(setting.field)
    random = np.random.default_rng(5)
    for value, rate, t in random.uniform((-3.0, -4.0, 0.0), (3.0, 4.0, 2.0), (200, 3)).tolist():
        forces = field.forces(field.leg_at(value, math.copysign(1.0, rate)), t, value, rate)
        expected = (
            forces.acceleration(rate),
            forces.driving * rate,
            forces.friction * rate,
            forces.other * rate,
        )
        size = max(1.0, *map(abs, expected))
        assert slopes.at(t, value, rate) == pytest.approx(expected, rel=1e-11, abs=1e-11 * size)


def test_the_reduced_equation_has_no_machine_code() -> None:
    settings = ct.Simulation(driving="2", speed=0.5, duration=0.2, scheme="runge-kutta-4", steps=50)
    assert ct.simulate(crank_rocker(), settings).attrs["executor"] == "arrays"
    with pytest.raises(ct.InputError, match="no machine code"):
        ct.simulate(crank_rocker(), settings, executor="machine code")


@pytest.mark.skipif(not PRESENT, reason="needs llvmlite")
@pytest.mark.parametrize("name", ["plane", "pendulum"])
def test_by_all_links_machine_code_gives_what_arrays_give(name: str) -> None:
    """The same steps, taken by Python and by machine code: apart by rounding, which the motion carries on."""
    mechanism = {"plane": crank_rocker(), "pendulum": pendulum()}[name]
    settings = ct.Simulation(
        driving=None if name == "pendulum" else "2 - 0.2*v", speed=3, duration=1, equations="multibody"
    )
    one, other = (
        ct.simulate(mechanism, settings, executor=executor) for executor in ("machine code", "arrays")
    )
    assert (one.attrs["executor"], other.attrs["executor"]) == ("machine code", "arrays")
    for quantity in ("position", "velocity", "angle", "angular_velocity"):
        if quantity in one:
            a, b = one[quantity].values, other[quantity].values
            assert np.max(np.abs(a - b)) <= 1e6 * 2.0**-52 * max(1.0, float(np.max(np.abs(a))))


def test_fixed_steps_end_at_a_limit() -> None:
    settings = ct.Simulation(driving="200", speed=1, duration=20, scheme="runge-kutta-4", steps=20_000)
    found = ct.simulate(crank_rocker(rocker=1.0), settings)
    assert found.attrs["ended"] == "limit"
    assert found.time.values[-1] < 20


def test_a_step_that_is_shown_is_a_step() -> None:
    settings = ct.Simulation(driving="1", duration=1, scheme="runge-kutta-4", steps=10, samples=4)
    found = ct.simulate(rotor(), settings)
    assert found.time.values == pytest.approx([0.0, 0.3, 0.7, 1.0], abs=1e-15)
    assert found.drive_speed.values == pytest.approx(2 * found.time.values, rel=1e-14)


def settings(**values: Any) -> ct.Simulation:
    return ct.Simulation(**{"duration": 1, "speed": 1, **values})


@pytest.mark.parametrize(
    ("mechanism", "given", "message"),
    [
        (pendulum(), ct.Simulation(speed=1), "the duration is not given"),
        (pendulum(), ct.Simulation(turns=1, driving="sin(t)"), "give duration too"),
        (sledge(), settings(turns=2), "does not turn"),
        (rotor(), settings(turns=1, scheme="runge-kutta-4"), "fixed steps"),
        (ct.example("crank-rocker"), settings(), "neither masses nor loads"),
    ],
)
def test_what_is_refused(mechanism: ct.Mechanism, given: ct.Simulation, message: str) -> None:
    with pytest.raises(ct.InputError, match=message):
        ct.simulate(mechanism, given)


def test_without_settings() -> None:
    with pytest.raises(ct.InputError, match="it is missing"):
        ct.simulate(pendulum())


def test_several_drives_are_refused() -> None:
    with pytest.raises(ct.InputError, match="one drive"):
        ct.simulate(ct.example("two-link-arm"), settings(equations="reduced"))


def test_a_start_at_a_dead_point() -> None:
    """At the limit itself, a little before it, and beyond."""
    mechanism = crank_rocker(rocker=1.0)
    limit = ct.limits(mechanism).interval[1]
    for start in (limit, limit - 1e-8):
        with pytest.raises(ct.InputError, match="dead position"):
            ct.simulate(mechanism, settings(start=start))
    with pytest.raises(ct.InputError, match=r"does not reach|dead position"):
        ct.simulate(mechanism, settings(start=limit + 0.3))


def test_nothing_that_moves_it() -> None:
    """At rest where nothing pulls: shown at rest for the time asked for, refused where only turns are."""
    found = ct.simulate(rotor(), ct.Simulation(duration=2, samples=3))
    assert found.attrs["ended"] == "standstill"
    assert found.drive_speed.values.tolist() == [0, 0, 0]
    with pytest.raises(ct.MotionError, match="no force sets the mechanism in motion"):
        ct.simulate(rotor(), ct.Simulation(turns=2))


def test_inertia_that_vanishes() -> None:
    """A slider on a massless crank: at its dead points nothing carries the motion."""
    text = """
[frame.points]
O = [0, 0]
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
start = 0.5
speed = 1
[assembly]
sides = { B = "ahead" }
"""
    with pytest.raises(ct.InputError, match="the reduced moment of inertia is zero"):
        ct.simulate(ct.parse_mechanism(text), settings(speed=3))
    assert (
        ct.simulate(
            ct.parse_mechanism(text.replace("length = 0.1", "length = 0.1\nmass = 1\nshape = 'rod'")),
            settings(speed=3),
        ).attrs["ended"]
        == "duration"
    )


@pytest.mark.parametrize(
    "keys",
    [
        'driving = "3*w"',
        'driving = "3*("',
        "duration = -1",
        "duration = 0",
        'duration = "3 m"',
        "turns = 0",
        "turns = 1e9",
        "steps = 0",
        "steps = 2.5",
        "steps = 99999999999",
        "samples = 1",
        "tolerance = 1",
        "tolerance = 1e-20",
        'scheme = "euler"',
        "speed = true",
        'driving = "1"\n[simulation.motor]\nkind = "linear"\nidle_speed = 3\nstarting_moment = 2',
        '[simulation.motor]\nkind = "linear"\nidle_speed = 3',
        '[simulation.motor]\nkind = "linear"\nidle_speed = 3\nbreakdown_slip = 1\nstarting_moment = 2',
        '[simulation.motor]\nkind = "asynchronous"\nidle_speed = 3\nbreakdown_moment = 2',
        '[simulation.motor]\nkind = "linear"\nidle_speed = 0\nstarting_moment = 2',
        '[simulation.motor]\nkind = "steam"\nidle_speed = 3\nstarting_moment = 2',
        "power = 3",
    ],
)
def test_descriptions_that_are_refused(keys: str) -> None:
    with pytest.raises(ct.InputError, match="simulation"):
        ct.parse_mechanism(PENDULUM + "[simulation]\n" + keys + "\n")


def test_formulas_without_a_value() -> None:
    """log(1 - t) ends at 1 s."""
    with pytest.raises(ct.MotionError, match=r"finite value|no step is small enough"):
        ct.simulate(rotor(), ct.Simulation(driving="log(1 - t)", duration=2, speed=1))


@pytest.mark.parametrize("at", [[], [1.0, 0.5], [-1.0], [math.nan], [[0.0]]])
def test_instants_that_are_refused(at: Any) -> None:
    with pytest.raises(ct.InputError, match="at: "):
        ct.simulate(rotor(), settings(), at=at)


@pytest.mark.parametrize(
    ("mechanism", "given", "message"),
    [
        (rotor(), ct.Simulation(driving="sin(t)", duration=1), "depend on time"),
        (rotor(), ct.Simulation(driving="1", speed=1), "does not settle"),
        (rotor(), ct.Simulation(driving="1 - q", speed=1), "do not repeat"),
        (rotor(), ct.Simulation(driving="-1", speed=1), "machine stops|does not settle"),
        (crank_rocker(rocker=1.0), ct.Simulation(driving="1 - v", speed=1), "turns all the way round"),
    ],
)
def test_regimes_that_are_not_there(mechanism: ct.Mechanism, given: ct.Simulation, message: str) -> None:
    with pytest.raises(ct.CentrodeError, match=message):
        steady_regime(mechanism, given)


def test_settings_are_written_back() -> None:
    press = ct.example("six-bar-press-run-up")
    assert ct.parse_mechanism(ct.mechanism_text(press)) == press
