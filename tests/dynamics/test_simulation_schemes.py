"""Fixed steps: their order, machine code beside arrays; what is refused."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import centrode as ct
from centrode.dynamics.simulation.integrator import compile_scan
from centrode.dynamics.simulation.simulate import setting_of
from centrode.dynamics.simulation.steady_state import steady_regime
from centrode.numerics.machine_code import PRESENT
from simulated import PENDULUM, crank_rocker, pendulum, rotor, sledge, spherical

EXECUTORS = ["arrays", *(["machine code"] if PRESENT else [])]
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


@pytest.mark.parametrize("executor", EXECUTORS)
@pytest.mark.parametrize("name", ["plane", "sphere"])
def test_fixed_steps_are_of_order_four(executor: Any, name: str) -> None:
    """Half the step, a sixteenth of the error: log2 of the ratio is 4 within a tenth, over the whole motion."""
    mechanism = crank_rocker(SMOOTH) if name == "plane" else spherical(math.pi / 12, math.pi / 4)
    settings = ct.Simulation(driving="2 - 0.2*v", speed=3, duration=2, tolerance=1e-13, samples=41)
    at = np.linspace(0.0, 2.0, 41)
    exact = ct.simulate(mechanism, settings, at=at).drive_speed.values
    errors = []
    for steps in (400, 800, 1600):
        fixed = settings.model_copy(update={"scheme": "runge-kutta-4", "steps": steps})
        found = ct.simulate(mechanism, fixed, at=at, executor=executor)
        assert found.attrs["executor"] == executor
        errors.append(float(np.linalg.norm(found.drive_speed.values - exact)))
    orders = [math.log2(errors[k] / errors[k + 1]) for k in range(2)]
    assert orders == pytest.approx([4, 4], abs=0.1)


@pytest.mark.skipif(not PRESENT, reason="needs llvmlite")
@pytest.mark.parametrize("mechanism", [crank_rocker(SMOOTH), spherical(0.3, 0.8), pendulum()])
def test_machine_code_gives_what_arrays_give(mechanism: ct.Mechanism) -> None:
    """Formulas traced, and series of the reduction: apart by what the series leave out, which is told."""
    settings = ct.Simulation(driving="2 - 0.2*v", speed=3, duration=3, scheme="runge-kutta-4", steps=600)
    one = ct.simulate(mechanism, settings, executor="machine code")
    other = ct.simulate(mechanism, settings, executor="arrays")
    for name in ("drive_speed", "turned", "work_of_drive", "work_of_friction"):
        a, b = one[name].values, other[name].values
        size = max(1.0, float(np.max(np.abs(a))))
        assert np.max(np.abs(a - b)) <= 1e3 * (other.attrs["representation_error"] + 2.0**-52) * size


@pytest.mark.skipif(not PRESENT, reason="needs llvmlite")
def test_the_scan_runs_on_numpy_too() -> None:
    """The same scan, the same numbers but for the last bits of sine and cosine."""
    setting = setting_of(crank_rocker(SMOOTH), ct.Simulation(driving="2", speed=3, duration=1))
    states = [
        compile_scan(setting.rows, setting.driving, kind).states(0.3, 3.0, 0.2, 40)
        for kind in ("arrays", "machine code")
    ]
    assert np.max(np.abs(states[0] - states[1])) <= 1e4 * 2.0**-52 * np.max(np.abs(states[0]))


def test_what_cannot_be_compiled_runs_on_arrays() -> None:
    mechanism = crank_rocker(rocker=1.0)  # it has limits
    settings = ct.Simulation(driving="2", speed=0.5, duration=0.2, scheme="runge-kutta-4", steps=50)
    assert ct.simulate(mechanism, settings).attrs["executor"] == "arrays"
    if PRESENT:
        with pytest.raises(ct.InputError, match="limits or change points"):
            ct.simulate(mechanism, settings, executor="machine code")


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
        ct.simulate(ct.example("two-link-arm"), settings())


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
