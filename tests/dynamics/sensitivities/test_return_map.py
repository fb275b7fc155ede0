"""Regimes of machines by their return maps: against the reduced equation, closed forms and Liouville's formula."""

from __future__ import annotations

import math

import numpy as np
import pytest

import centrode as ct
from centrode.dynamics.forward_dynamics.free_motion import free_motion_of
from centrode.dynamics.sensitivities.return_map import PeriodicMotion, periodic_motion
from centrode.dynamics.simulation.multibody_motion import multibody_setting
from centrode.dynamics.simulation.results import simulation_results
from centrode.dynamics.simulation.steady_state import steady_regime


def machine(**simulation: object) -> ct.Mechanism:
    """A four-bar with a motor and a damper."""
    rods = {name: {"length": length, "mass": mass, "shape": "rod"} for name, length, mass in
            (("AB", 0.3, 3.0), ("BC", 0.8, 0.8), ("DC", 0.6, 0.6))}  # fmt: skip
    return ct.Mechanism(
        gravity=[0, -9.81],
        frame={"points": {"A": [0, 0], "D": [0.9, 0]}},
        links=rods,
        drives=[{"link": "AB", "start": 1.0, "speed": 1}],
        assembly={"sides": {"C": "left"}},
        loads=[{"kind": "damper", "link": "DC", "damping": 0.05}],
        simulation={"driving": "4 - 0.2*v", "speed": 18, "duration": "5 s", **simulation},
    )


def regime_of(mechanism: ct.Mechanism, run_in: float) -> PeriodicMotion:
    assert mechanism.simulation is not None
    setting = multibody_setting(mechanism, mechanism.simulation)
    return periodic_motion(setting.free, setting.free.initial(setting.speeds, setting.start), run_in)


def test_machine_of_one_drive_has_the_regime_of_the_reduced_equation() -> None:
    reduced, whole = steady_regime(machine()), regime_of(machine(), 5.0)
    assert math.isclose(whole.period, reduced.time, rel_tol=1e-8)
    assert math.isclose(whole.mean_speed, reduced.mean_speed, rel_tol=1e-8)
    # that of the reduced equation is a difference of 1e-5
    assert math.isclose(float(whole.multipliers[0].real), reduced.multiplier, rel_tol=1e-4)
    assert whole.stable


def test_pendulum_on_a_crank_follows_it_and_its_multipliers_obey_liouville() -> None:
    crank = ct.Mechanism(
        gravity=[0, -9.81],
        frame={"points": {"O": [0, 0]}},
        links={
            "OA": {"length": 0.1, "mass": 1, "shape": "rod", "angle": 0},
            "AB": {"length": 1.0, "mass": 1, "shape": "rod", "angle": "-90 deg"},
        },
        drives=[{"link": "OA", "start": 0, "speed": 7.0}],
        loads=[{"kind": "damper", "link": "AB", "damping": 0.5}],
        simulation={"keeps": ["OA"], "duration": "20 s"},
    )
    found = regime_of(crank, 20.0)
    assert math.isclose(found.period, 2 * math.pi / 7.0, rel_tol=1e-14)
    # J x'' + c x' + ... = 0: what is left of an area of states after a period is exp(-c T / J)
    left = math.exp(-0.5 * found.period / (1 / 3))
    assert math.isclose(float(np.prod(found.multipliers).real), left, rel_tol=1e-8)
    assert found.stable and found.turns.tolist() == [1.0, 0.0]
    # it does come back
    free = found.free
    run = free.integrate(found.start, found.period, 1e-11, at=[found.period])
    apart = run.coordinates[0] - found.start.coordinates - 2 * math.pi * found.turns
    assert np.abs(apart).max() < 1e-8


def test_a_ball_on_a_vibrating_table_has_the_multipliers_of_its_closed_form() -> None:
    # one impact in a period T: it leaves with g T / 2, the table moves with (g T / 2) (1 - e) / (1 + e) then;
    # departures of instant and speed: dt' = dt + c dw, dw' = (1 + e) a dt' - e dw + e g (dt' - dt), c = (1 + e) / g
    g, e, omega, size = 9.81, 0.5, 4 * math.pi, 0.07
    period = 2 * math.pi / omega
    leaves = g * period / 2
    phase = math.acos(leaves * (1 - e) / (1 + e) / (size * omega))
    a, c = -size * omega**2 * math.sin(phase), (1 + e) / g
    exact = np.linalg.eigvals(np.array([[1, c], [(1 + e) * a, (1 + e) * a * c - e + e * g * c]]))
    # half a period behind the impact the ball is at its greatest height
    here = phase + math.pi
    height = size * math.sin(phase) + leaves * period / 4 - size * math.sin(here)
    table = ct.Mechanism(
        gravity=[0, -g],
        frame={"points": {"O": [0, 0], "Q": [1, 0]}},
        links={
            "OA": {"length": size, "mass": 0.1, "shape": "rod"},
            "table": {"points": {"T": [0, 0], "U": [1, 0]}, "mass": 1},
            "ball": {"points": {"B": [0, 0]}, "mass": 0.2},
        },
        guides=[
            {"point": "U", "on": "frame", "through": "Q", "direction": [0, 1], "link": "table"},
            {"point": "A", "on": "table", "through": [0, 0], "direction": [1, 0]},
            {"point": "B", "on": "table", "through": [0, 0], "direction": [0, 1], "link": "ball"},
        ],
        drives=[{"link": "OA", "start": here, "speed": omega}, {"guide": "B", "start": height * 1.01}],
        stops=[{"guide": "B", "least": 0, "restitution": e}],
        simulation={
            "keeps": ["OA"],
            "duration": 10,
            "speeds": {"drives.B": -size * omega * math.cos(here)},
        },
    )
    found = regime_of(table, 10.0)
    assert math.isclose(found.period, period, rel_tol=1e-12)
    assert np.allclose(np.sort_complex(found.multipliers), np.sort_complex(exact), atol=1e-8)
    free = found.free
    run = free.integrate(found.start, found.period, 1e-11, at=[found.period])
    (impact,) = [event for event in run.events if event.kind == "impact"]
    assert abs(impact.time - period / 2) < 1e-8


def test_a_block_on_a_belt_has_the_period_of_its_closed_form_and_forgets_departures() -> None:
    # it sticks over 2 a at the belt's speed, and slips about F / k until it is as fast as the belt again
    mass, stiffness, static, kinetic, belt = 1.0, 40.0, 5.0, 3.0, 0.2
    omega, a = math.sqrt(stiffness / mass), (static - kinetic) / stiffness
    period = 2 * a / belt + 2 / omega * (math.pi - math.atan(a * omega / belt))
    block = ct.Mechanism(
        frame={"points": {"O": [0, 0], "W": [-1, 0]}},
        links={"block": {"points": {"P": [0, 0]}, "mass": mass}},
        guides=[{"point": "P", "on": "frame", "through": "O", "direction": [1, 0], "link": "block"}],
        drives=[{"guide": "P", "start": 0}],
        loads=[
            {"kind": "spring", "points": ["W", "P"], "stiffness": stiffness, "free_length": 1},
            {
                "kind": "friction",
                "guide": "P",
                "value": kinetic,
                "static": static,
                "surface_speed": belt,
            },
        ],
        simulation={"duration": 8.0, "equations": "multibody"},
    )
    found = regime_of(block, 8.0)
    assert math.isclose(found.period, period, rel_tol=1e-9)
    assert np.abs(found.multipliers).max() < 1e-7
    assert found.stable


def shaken_block(start: float) -> ct.Mechanism:
    """A block on a table that a crank shakes; it sticks during about half of a period."""
    return ct.Mechanism(
        frame={"points": {"O": [0, 0], "Q": [1, 0]}},
        links={
            "OA": {"length": 0.1, "mass": 0.1, "shape": "rod"},
            "table": {"points": {"T": [0, 0]}, "mass": 1},
            "block": {"points": {"B": [0, 0]}, "mass": 1},
        },
        guides=[
            {"point": "T", "on": "frame", "through": "Q", "direction": [1, 0], "link": "table"},
            {"point": "A", "on": "table", "through": [0, 0], "direction": [0, 1]},
            {"point": "B", "on": "table", "through": [0, 0], "direction": [1, 0], "link": "block"},
        ],
        drives=[{"link": "OA", "start": start, "speed": 8.0}, {"guide": "B", "start": 0}],
        loads=[
            {"kind": "friction", "guide": "B", "value": 5.5},
            {"kind": "spring", "points": ["B", "T"], "stiffness": 4, "free_length": 0},
        ],
        simulation={"keeps": ["OA"], "duration": 4},
    )


def test_a_regime_is_the_same_whether_something_sticks_where_its_period_begins_or_not() -> None:
    slips, sticks = regime_of(shaken_block(0.5), 4.0), regime_of(shaken_block(2.2), 4.0)
    for found, held in ((slips, False), (sticks, True)):
        run = found.free.integrate(found.start, found.period, 1e-11, at=[1e-6, found.period])
        assert bool(run.contact_modes[0, 0]) is held
        apart = run.coordinates[1] - found.start.coordinates - 2 * math.pi * found.turns
        assert np.abs(apart).max() < 1e-8
    assert np.allclose(slips.multipliers, sticks.multipliers, rtol=0, atol=1e-6)


def test_what_is_held_all_the_time_does_not_hide_a_regime() -> None:
    # the block on a belt of the test above, beside an arm that rests on a stop for good
    mass, stiffness, static, kinetic, belt = 1.0, 40.0, 5.0, 3.0, 0.2
    omega, a = math.sqrt(stiffness / mass), (static - kinetic) / stiffness
    period = 2 * a / belt + 2 / omega * (math.pi - math.atan(a * omega / belt))
    both = ct.Mechanism(
        gravity=[0, -9.81],
        frame={"points": {"O": [0, 0], "W": [-1, 0], "H": [3, 0]}},
        links={
            "block": {"points": {"P": [0, 0]}, "mass": mass},
            "arm": {"points": {"H": [0, 0], "E": [1, 0]}, "mass": 1, "shape": "rod", "angle": -0.3},
        },
        guides=[{"point": "P", "on": "frame", "through": "O", "direction": [1, 0], "link": "block"}],
        drives=[{"guide": "P", "start": 0}],
        loads=[
            {"kind": "spring", "points": ["W", "P"], "stiffness": stiffness, "free_length": 1},
            {
                "kind": "friction",
                "guide": "P",
                "value": kinetic,
                "static": static,
                "surface_speed": belt,
            },
        ],
        stops=[{"link": "arm", "least": -0.3}],
        simulation={"duration": 8.0, "equations": "multibody"},
    )
    assert math.isclose(regime_of(both, 8.0).period, period, rel_tol=1e-9)


def test_a_rod_that_swings_back_has_no_regime() -> None:
    rod = ct.Mechanism(
        gravity=[0, -9.81],
        frame={"points": {"O": [0, 0]}},
        links={"OA": {"length": 1, "mass": 1, "shape": "rod", "angle": 0}},
        loads=[{"kind": "damper", "link": "OA", "damping": 0.1}],
    )
    free = free_motion_of(rod)
    with pytest.raises(ct.MotionError, match="nothing turns all the way round"):
        periodic_motion(free, free.initial(), 3.0)


def test_simulation_tells_its_regime_and_how_long_it_takes_to_run_up() -> None:
    results = simulation_results(machine(speed=2, duration="8 s", equations="multibody", samples=2001))
    assert results.periodic is not None
    time = results.run_up_time
    assert time is not None
    # deviations of the speed die away by the multiplier each period: from nine tenths to a hundredth
    periods = math.log(0.01 / 0.9) / math.log(float(results.periodic.multipliers[0].real))
    assert abs(time / results.periodic.period - periods) < 4
    text = ct.summary(results)
    assert "steady regime" in text and "run-up" in text
