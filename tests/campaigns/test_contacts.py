"""A fixed sample of the campaign of stops and friction, and motions that last."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from scipy.integrate import solve_ivp
from tools.campaigns.campaign import random_of
from tools.campaigns.contacts.cases import CAMPAIGN, COARSE, DURATION, decides, distance, drawn, with_contacts
from tools.campaigns.contacts.time_steps import Rubbing, Run, Wall, run_steps
from tools.campaigns.free_motions.dense_equations import DenseMechanism

import centrode as ct
from centrode.dynamics.forward_dynamics.free_motion import free_motion_of


@pytest.mark.parametrize("number", (6,))
def test_a_fixed_sample(number: int) -> None:
    outcome = CAMPAIGN.outcome(1, number)
    assert outcome.faults == []
    assert outcome.counts["impact"] > 0


def test_an_impact_lets_slip_what_static_friction_would_hold() -> None:
    """A cart stops at a wall; its pendulum, nearly along the guide, gets a small speed that gravity makes greater.

    The momentum about the hinge and a scalar equation say what happens. Time steps hold the pendulum until the impulse
    of static friction in a step, less that of the load, is smaller than the momentum; behind that they converge.
    """
    g, slope, delta, way = 9.81, math.radians(-60.0), 5e-3, 0.05
    mass, length, angle = 1.0, 0.5, math.radians(-60.0) + delta
    arm, inertia, kinetic, static = 0.5 * length, mass * length**2 / 12, 1.1, 1.6
    direction = (math.cos(slope), math.sin(slope))
    parts: dict[str, Any] = {
        "frame": {"points": {"O": [0, 0]}},
        "links": {
            "cart": {
                "points": {"P": [0, 0], "Q": [0, 1]},
                "mass": 1,
                "centre": [0, 0],
                "inertia": 1,
                "angle": 0.0,
            },
            "arm": {
                "points": {"P": [0, 0], "E": [length, 0]},
                "angle": angle,
                "mass": mass,
                "centre": [arm, 0],
                "inertia": inertia,
            },
        },
        "guides": [
            {
                "name": "way",
                "point": "P",
                "on": "frame",
                "through": [0, 0],
                "direction": slope,
                "link": "cart",
                "angle": 0.0,
            }
        ],
        "gravity": [0.0, -g],
        "stops": [
            {"name": "wall 0", "point": "P", "direction": list(direction), "most": way, "restitution": 0.0}
        ],
        "loads": [{"kind": "friction", "link": "arm", "value": kinetic, "static": static}],
    }
    free = free_motion_of(ct.Mechanism(**parts))
    course = free.integrate(free.initial(), DURATION, 1e-11, at=np.linspace(0.0, DURATION, 201))

    # the pendulum is held up to the wall, behind which its momentum about the hinge is what the hinge had given
    instant = math.sqrt(2.0 * way / (g * math.sin(-slope)))
    momentum = -mass * arm * math.sin(delta) * g * math.sin(-slope) * instant
    whole = inertia + mass * arm**2

    def slope_of(_time: float, y: npt.NDArray[np.float64]) -> list[float]:
        return [y[1], (kinetic - mass * g * arm * math.cos(y[0])) / whole]

    after = solve_ivp(
        slope_of, (instant, DURATION), [angle, momentum / whole], method="DOP853", rtol=1e-12, atol=1e-13
    )
    slips = [event.time for event in course.events if event.kind == "slips"]
    assert slips == pytest.approx([instant], abs=1e-9)
    assert course.angles[-1, free.links.index("arm")] == pytest.approx(after.y[0, -1], abs=1e-9)
    assert after.y[0, -1] < angle - 0.05

    # time steps on either side of the step that is too long
    dense = DenseMechanism(
        parts,
        dict(zip(free.points, course.places[0], strict=True)),
        dict(zip(free.links, course.angles[0], strict=True)),
    )
    walls = [Wall("P", direction, way, 0.0)]
    rubbing = [Rubbing("arm", "frame", kinetic, static)]
    longest = -momentum / (static - mass * g * arm * math.cos(angle))
    held = run_steps(dense, walls, rubbing, DURATION, round(DURATION / (2.0 * longest)))
    assert held.rests == pytest.approx([DURATION])
    errors = []
    for times in (2, 16):
        run = run_steps(dense, walls, rubbing, DURATION, round(times * DURATION / longest))
        errors.append(distance(dense, free, course, run))
    assert 4.0 * errors[1] < errors[0] < 2e-3


def test_steps_that_stay_apart_near_a_change_point_are_too_long() -> None:
    """Links with friction only translate: the motion is smooth, but a link passes a change point at 33 rad/s."""
    random = random_of(1, 254)
    _row, plain = drawn(random)
    parts, walls, rubbing = with_contacts(plain, random, free_motion_of(ct.Mechanism(**plain)))
    free = free_motion_of(ct.Mechanism(**parts))
    course = free.integrate(free.initial(), DURATION, 1e-11, at=np.linspace(0.0, DURATION, 201))
    assert not walls
    assert np.max(np.abs(course.angular_velocities)) > 30.0
    dense = DenseMechanism(
        parts,
        dict(zip(free.points, course.places[0], strict=True)),
        dict(zip(free.links, course.angles[0], strict=True)),
    )
    start = dense.start
    smooth = Run(*dense.equations.state_at(start, np.zeros_like(start), DURATION, 1e-11))
    assert distance(dense, free, course, smooth) < 1e-10
    apart = [
        distance(dense, free, course, run_steps(dense, walls, rubbing, DURATION, COARSE * times))
        / float(free.equations.numbers.scale)
        for times in (4, 16)
    ]
    assert not decides(apart)  # so that shorter ones are asked
    assert apart[1] < 0.5 * apart[0]


def test_over_long_times_nothing_creeps_or_sinks_or_gains_energy() -> None:
    """A driven block between walls, on friction, for minutes: it rests, bounces, sticks again and again."""
    block = ct.Mechanism(
        frame={"points": {"O": [0, 0], "Q": [0, 1]}},
        links={
            "block": {"points": {"P": [0, 0]}, "mass": 2},
            "idle": {"points": {"R": [0, 0]}, "mass": 1},
        },
        guides=[
            {"point": "P", "on": "frame", "through": "O", "direction": [1, 0], "link": "block"},
            {"point": "R", "on": "frame", "through": "Q", "direction": [1, 0], "link": "idle"},
        ],
        loads=[
            {"kind": "friction", "guide": "P", "value": 1, "static": 1.5},
            {"kind": "force", "guide": "P", "value": "6*sin(0.7*t)"},
            {"kind": "friction", "guide": "R", "value": 3},
            {"kind": "force", "guide": "R", "value": "2.9*sin(t)"},
        ],
        stops=[{"guide": "P", "least": -1, "most": 1, "restitution": 0.6}],
    )
    run = ct.simulate(block, ct.Simulation(duration=300, samples=1501))
    x = run.slide.sel(guide="P").values
    assert np.all(np.abs(x) <= 1.0 + 1e-12)
    assert np.all(run.slide.sel(guide="R").values == 0.0)
    lost = run.occasion_loss.values
    assert np.all(lost[np.isfinite(lost)] >= 0.0)
    assert np.sum(np.isfinite(lost)) > 150
    turned_over = float(np.abs(run.work_of_friction[-1]))
    assert run.attrs["worst_energy_residual"] < 1e-9 * turned_over
