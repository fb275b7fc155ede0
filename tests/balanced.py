"""A four-bar with masses for tests of counterweights, and what of it stays at rest."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

import centrode as ct
from centrode.kinematics.preparation import ready
from mechanisms import rounding, solve_evenly

SPEED = 12.0


def body(points: dict[str, list[float]], random: np.random.Generator, *, in_line: bool = False) -> Any:
    """A link with random mass and inertia, its centre anywhere near it or on its line."""
    reach = max(x for x, _y in points.values())
    across = 0.0 if in_line else float(random.uniform(-0.3, 0.3)) * reach
    return {
        "points": points,
        "mass": float(random.uniform(0.5, 4.0)),
        "centre": [float(random.uniform(0.1, 0.9)) * reach, across],
        "inertia": float(random.uniform(0.05, 0.2)) * reach**2,
    }


def four_bar(seed: int, *, in_line: bool = False, pendulum: float | None = None) -> ct.Mechanism:
    """A crank-rocker with random masses, in any place; the coupler's inertia as that of two masses, times a factor."""
    random = np.random.default_rng(seed)
    crank, coupler, rocker, ground = 1.0, *random.uniform(2.6, 3.4, 2).tolist(), 3.2
    turn, x, y = random.uniform(-2.0, 2.0, 3).tolist()
    links = {
        "OA": body({"O": [0, 0], "A": [crank, 0]}, random, in_line=in_line),
        "AB": body({"A": [0, 0], "B": [coupler, 0]}, random, in_line=in_line),
        "DB": body({"D": [0, 0], "B": [rocker, 0]}, random, in_line=in_line),
    }
    if pendulum is not None:
        r = links["AB"]["centre"][0]
        links["AB"]["inertia"] = pendulum * links["AB"]["mass"] * r * (coupler - r)
    return ct.Mechanism(
        frame={"points": {"O": [x, y], "D": [x + ground * math.cos(turn), y + ground * math.sin(turn)]}},
        links=links,
        drives=[{"link": "OA", "start": float(random.uniform(-3, 3)), "speed": SPEED}],
        assembly={"sides": {"B": "left" if seed % 2 else "right"}},
    )


def rest_of(mechanism: ct.Mechanism, samples: int = 73) -> float:
    """What rounding may leave of the shaking force: accelerations as far as their digits reach, times all masses."""
    solved = solve_evenly(ready(mechanism), samples)
    scale = solved.ready.kinematics.path.scale
    reach = scale + max(
        (math.hypot(*one.centre) for one in mechanism.links.values() if isinstance(one.centre, tuple)),
        default=0.0,
    )
    mass = sum(one.mass or 0.0 for one in mechanism.links.values())
    rate = max(
        mechanism.machine.mean_speed if mechanism.machine else 0.0, abs(mechanism.drives[0].speed or 0.0)
    )
    return 4 * float(np.max(np.sum(rounding(solved), axis=0))) * reach * mass * rate**2
