"""Motions of ten thousand seconds: nothing sinks through a stop, creeps, drifts apart or gains energy at impacts."""

from __future__ import annotations

import resource
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

import centrode as ct
from centrode.dynamics.forward_dynamics.free_motion import FreeMotion
from centrode.dynamics.forward_dynamics.trajectory import Trajectory
from centrode.dynamics.simulation.multibody_motion import multibody_setting
from tools.campaigns.campaign import Campaign, Outcome
from tools.campaigns.free_motions.cases import GRAVITY, weight_times_length

Array = npt.NDArray[np.float64]

DURATION, SAMPLES = 1e4, 20001
TOLERANCE = 1e-12
SUNK, CREPT, APART, GAINED = 1e-11, 1e-12, 1e-11, 1e-12
BOOKS = 1e-9
MEMORY = 1500.0
"""Greatest increase of the memory in use [MB]."""
ROD = {"shape": "rod"}


@dataclass(frozen=True)
class LongRun:
    """A mechanism that is followed for long.

    Attributes
    ----------
    gaps : of its stops over time [m or rad], positive where they are open
    stuck : number of a friction among the contacts -> its coordinate over time [m or rad]
    """

    mechanism: ct.Mechanism
    gaps: Callable[[FreeMotion, Trajectory], Array]
    stuck: Callable[[FreeMotion, Trajectory], dict[int, Array]]


def on_axis(
    name: str, body: str, on: str = "frame", direction: tuple[float, float] = (1, 0)
) -> dict[str, object]:
    """A guide of a point of a body that does not turn."""
    return {"point": name, "on": on, "through": [0, 0], "direction": list(direction), "link": body}


def simulation(**more: object) -> dict[str, object]:
    """Settings of all of them."""
    return {"duration": DURATION, "tolerance": TOLERANCE, "equations": "multibody", **more}


def bouncing_block() -> LongRun:
    """A block on friction, pushed to and fro between two stops; another one that the same friction holds."""
    block = ct.Mechanism(
        frame={"points": {"O": [0, 0], "Q": [0, 1]}},
        links={
            "block": {"points": {"P": [0, 0]}, "mass": 2},
            "idle": {"points": {"R": [0, 0]}, "mass": 1},
        },
        guides=[on_axis("P", "block"), on_axis("R", "idle") | {"through": "Q"}],
        loads=[
            {"kind": "friction", "guide": "P", "value": 1, "static": 1.5},
            {"kind": "force", "guide": "P", "value": "6*sin(0.7*t)"},
            {"kind": "friction", "guide": "R", "value": 3},
            {"kind": "force", "guide": "R", "value": "2.9*sin(t)"},
        ],
        stops=[{"guide": "P", "least": -1, "most": 1, "restitution": 0.6}],
        simulation=simulation(),
    )
    return LongRun(
        block,
        lambda free, course: 1.0 - np.abs(course.slides[:, free.guides.index("P")]),
        lambda free, course: {
            1: course.slides[:, free.guides.index("P")],
            2: course.slides[:, free.guides.index("R")],
        },
    )


def hanging_chain() -> LongRun:
    """Three rods that hang and are pushed against a wall again and again, with dry friction in the upper hinge."""
    chain = ct.Mechanism(
        gravity=[0, -GRAVITY],
        frame={"points": {"O": [0, 0]}},
        links={
            name: {"length": 0.4, "mass": 0.4, "angle": -1.4, **ROD} for name in ("OA", "AB", "BC")
        },
        stops=[{"point": "C", "direction": [1, 0], "most": 0.25, "restitution": 0.5}],
        loads=[
            {"kind": "friction", "link": "OA", "value": 0.1, "static": 0.15},
            {"kind": "damper", "link": "AB", "relative_to": "OA", "damping": 0.02},
            {"kind": "damper", "link": "BC", "relative_to": "AB", "damping": 0.02},
            {"kind": "force", "point": "C", "vector": [0.1, 0]},
            {"kind": "torque", "link": "OA", "value": "1.5*sin(2*t)"},
        ],
        simulation=simulation(),
    )  # fmt: skip
    return LongRun(
        chain,
        lambda free, course: 0.25 - course.places[:, free.points.index("C"), 0],
        lambda free, course: {1: course.angles[:, free.links.index("OA")]},
    )


def stuck_slider_crank() -> LongRun:
    """A slider-crank that friction in its guide holds against weight and a moment that goes to and fro."""
    machine = ct.Mechanism(
        gravity=[0, -GRAVITY],
        frame={"points": {"O": [0, 0]}},
        links={
            "OA": {"length": 0.1, "mass": 0.2, **ROD},
            "AB": {"length": 0.3, "mass": 0.5, **ROD},
            "slider": {"points": ["B"], "mass": 1},
        },
        guides=[{"point": "B", "on": "frame", "through": "O", "direction": [1, 0], "link": "slider"}],
        drives=[{"link": "OA", "start": "60 deg", "speed": 1}],
        assembly={"sides": {"B": "ahead"}},
        loads=[
            {"kind": "friction", "guide": "B", "value": 8, "static": 12},
            {"kind": "torque", "link": "OA", "value": "0.4*sin(3*t)"},
        ],
        simulation=simulation(),
    )
    return LongRun(
        machine,
        lambda _free, course: np.zeros(len(course.time)),
        lambda free, course: {0: course.slides[:, free.guides.index("B")]},
    )


def rope_pendulum() -> LongRun:
    """A mass on a rope that gets taut without restitution, and swings on without a loss; the rope never slackens."""
    pendulum = ct.Mechanism(
        gravity=[0, -GRAVITY],
        frame={"points": {"O": [0, 0]}},
        links={"mass": {"points": {"S": [0, 0]}, "mass": 1}, "cross": {"points": {"X": [0, 0]}}},
        guides=[on_axis("X", "cross"), on_axis("S", "mass", "cross", (0, 1))],
        drives=[{"guide": "X", "start": 0.8}, {"guide": "S", "start": -0.4}],
        stops=[{"points": ["O", "S"], "most": 1}],
        simulation=simulation(),
    )
    return LongRun(
        pendulum,
        lambda free, course: 1.0 - np.hypot(*course.places[:, free.points.index("S")].T),
        lambda _free, _course: {},
    )


def crank_against_a_stop() -> LongRun:
    """A four-bar linkage whose crank a moment drives to and fro between stops, with a damper."""
    machine = ct.Mechanism(
        gravity=[0, -GRAVITY],
        frame={"points": {"A": [0, 0], "D": [0.9, 0]}},
        links={
            "AB": {"length": 0.3, "mass": 0.3, **ROD},
            "BC": {"length": 0.8, "mass": 0.8, **ROD},
            "DC": {"length": 0.6, "mass": 0.6, **ROD},
        },
        drives=[{"link": "AB", "start": "60 deg", "speed": 1}],
        assembly={"sides": {"C": "left"}},
        stops=[{"link": "AB", "least": -0.5, "most": 1.8, "restitution": 0.7}],
        loads=[
            {"kind": "damper", "link": "AB", "damping": 0.05},
            {"kind": "torque", "link": "AB", "value": "2*sin(1.3*t)"},
        ],
        simulation=simulation(),
    )
    return LongRun(
        machine,
        lambda free, course: 1.15 - np.abs(course.angles[:, free.links.index("AB")] - 0.65),
        lambda _free, _course: {},
    )


CASES: dict[str, Callable[[], LongRun]] = {
    "block between stops": bouncing_block,
    "chain at a wall": hanging_chain,
    "stuck slider-crank": stuck_slider_crank,
    "pendulum on a rope": rope_pendulum,
    "four-bar at a stop": crank_against_a_stop,
}


def run(_seed: int, number: int) -> Outcome:
    """One mechanism for ten thousand seconds."""
    name = list(CASES)[number]
    case, outcome = CASES[name](), Outcome(subject=name)
    assert case.mechanism.simulation is not None
    setting = multibody_setting(case.mechanism, case.mechanism.simulation)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    course = setting.run(np.linspace(0.0, DURATION, SAMPLES))
    outcome.hold(
        name, "memory", (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) / 1024.0, MEMORY
    )
    judge(outcome, name, setting.free, course, case)
    return outcome


def judge(outcome: Outcome, name: str, free: FreeMotion, course: Trajectory, case: LongRun) -> None:
    """Hold what a course shows to the bounds."""
    if course.ended != "duration":
        outcome.fault(f"{name}: ended by {course.ended}, {course.cause}")
    length = max(1.0, float(free.equations.numbers.scale))
    weight = weight_times_length(free) or GRAVITY
    turned_over = max(weight, *(float(np.max(np.abs(work), initial=0.0)) for work in course.works.values()))
    outcome.hold(name, "books", float(np.max(np.abs(course.energy_residual))) / turned_over, BOOKS)
    outcome.hold(name, "sunk", max(0.0, float(np.max(-case.gaps(free, course)))) / length, SUNK)
    outcome.hold(name, "apart", float(np.max(course.position_residual, initial=0.0)) / length, APART)
    lost = [event.lost for event in course.events if event.kind == "impact"]
    outcome.hold(name, "gain", -min(lost, default=0.0) / weight, GAINED)
    for number, way in case.stuck(free, course).items():
        outcome.hold(name, "crept", crept(course.contact_modes[:, number], way) / length, CREPT)
    for kind in ("impact", "comes to rest", "sticks", "slips", "opens"):
        outcome.count(kind, sum(event.kind == kind for event in course.events))


def crept(modes: Array, way: Array) -> float:
    """Greatest way within a stretch in which a friction sticks at every sample."""
    sticks = modes != 0.0
    ends = np.flatnonzero(np.diff(sticks.astype(int)))
    greatest = 0.0
    for piece, holds in zip(np.split(way, ends + 1), np.split(sticks, ends + 1), strict=True):
        if holds[0]:
            greatest = max(greatest, float(np.ptp(piece)))
    return greatest


CAMPAIGN = Campaign(
    name="long-runs",
    title="Stops and friction for long",
    about=(
        f"Five mechanisms move for {DURATION:g} s: a block between stops that is pushed to and fro on friction beside "
        "one that friction holds; a chain that is pushed against a wall; a slider-crank that friction holds; a mass on "
        "a rope; a four-bar linkage between stops. What may not happen is measured at twenty thousand instants "
        "and at all events."
    ),
    columns={
        "books": f"greatest gap of the energy balance over the greatest work, or m g l; at most {BOOKS:g}",
        "gain": f"greatest gain of energy in an impact over m g l; at most {GAINED:g}",
        "sunk": f"how far a part sinks into a stop, of the greatest length, or rad; at most {SUNK:g}",
        "crept": f"way within a stretch in which friction sticks, of the greatest length, or rad; at most {CREPT:g}",
        "apart": f"distance of the ends of a loop, of the greatest length; at most {APART:g}",
        "memory": f"increase of the memory in use [MB]; at most {MEMORY:g}",
    },
    run=run,
    cases=len(CASES),
    block=1,
)
