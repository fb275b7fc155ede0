"""Events of free motions: a double pendulum that bounces at a wall beside one that swings freely."""

from __future__ import annotations

from collections.abc import Iterator

import centrode as ct
from benchmarks.table import Promise, Row
from benchmarks.timing import best_clock_times
from centrode.dynamics.forward_dynamics.free_motion import FreeMotion, free_motion_of

ROD = {"length": 1, "mass": 1, "shape": "rod"}
DURATION = 2400.0
"""Seconds, in which there are some thousand impacts."""


def _pendulum(**parts: object) -> FreeMotion:
    mechanism = ct.Mechanism(
        gravity=[0, -9.81],
        frame={"points": {"O": [0, 0]}},
        links={"OA": {**ROD, "angle": -1.8}, "AB": {**ROD, "angle": -2.4}},
        **parts,
    )
    return free_motion_of(mechanism)


def events() -> Iterator[Row]:
    """The run with a thousand events over that without."""
    free = _pendulum()
    wall = _pendulum(stops=[{"point": "B", "direction": [1, 0], "most": 0.6, "restitution": 1}])
    start = free.initial()
    count = len(wall.integration.explicit_steps(start, DURATION, 1e-9).events)
    times = best_clock_times(
        {
            "without": lambda: free.integration.explicit_steps(start, DURATION, 1e-9),
            "with": lambda: wall.integration.explicit_steps(start, DURATION, 1e-9),
        },
        rounds=3,
    )
    share = times["with"] / times["without"]
    yield Row(
        "double pendulum at a wall",
        {"without [s]": times["without"], "with [s]": times["with"], "events": count},
        promises=[Promise("a run with a thousand events over that without", share, at_most=5.0)],
    )
