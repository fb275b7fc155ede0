"""Random mechanisms left to gravity by forward dynamics: what of their energy stays, and whether they come back."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

import centrode as ct
from centrode.dynamics.forward_dynamics.free_motion import FreeMotion, free_motion_of
from centrode.dynamics.forward_dynamics.initial_state import InitialState
from centrode.dynamics.forward_dynamics.trajectory import Trajectory
from tools.campaigns.campaign import Campaign, Outcome, random_of
from tools.campaigns.grown.higher import grown_higher
from tools.campaigns.grown.plane import KINDS, grown
from tools.campaigns.grown.sphere import KINDS as SPHERE_KINDS
from tools.campaigns.grown.sphere import grown as grown_on_sphere

Parts = dict[str, Any]
DURATION, BACK = 10.0, 1.0
"""Seconds that it is left to itself, and that it goes back."""
TOLERANCE = 1e-11
DRIFT, GAP = 1e-8, 1e-11
"""Bounds: of the energy over the greatest kinetic energy or m g l, of closures over lengths."""
GRAVITY = 9.81


def rods(parts: Parts) -> None:
    """Every link a rod of 1 kg/m between its farthest points, in the plane."""
    for body in parts["links"].values():
        places = np.array(list(body["points"].values()), dtype=np.float64)
        span = max((float(np.linalg.norm(a - b)) for a in places for b in places), default=0.0) or 0.5
        body |= {
            "mass": span,
            "centre": np.mean(places, axis=0).tolist(),
            "inertia": span**3 / 12.0,
        }


def hung(parts: Parts, random: np.random.Generator, count: int) -> None:
    """Pendulums on points that move: degrees of freedom that no drive has."""
    points = [point for body in parts["links"].values() for point in body["points"]]
    for number in range(count):
        name = f"pendulum{number}"
        pivot, end = str(random.choice(points)), f"{name} end"
        length = float(random.uniform(0.3, 1.0))
        angle = float(random.uniform(-math.pi, math.pi))
        parts["links"][name] = {"points": {pivot: [0.0, 0.0], end: [length, 0.0]}, "angle": angle}
        points.append(end)


def parallel(random: np.random.Generator) -> Parts:
    """A bar on two to four parallel cranks: all but two closures repeat others."""
    count = int(random.integers(2, 5))
    places = np.sort(random.uniform(0.0, 3.0, count)) + np.arange(count)
    crank, turn = float(random.uniform(0.3, 1.0)), float(random.uniform(0.4, 1.2))
    links: Parts = {
        f"crank{k}": {"points": {f"A{k}": [0.0, 0.0], f"B{k}": [crank, 0.0]}, "angle": turn}
        for k in range(count)
    }
    links["bar"] = {"points": {f"B{k}": [float(x), 0.0] for k, x in enumerate(places)}, "angle": 0.0}
    return {"frame": {"points": {f"A{k}": [float(x), 0.0] for k, x in enumerate(places)}}, "links": links}


def drawn(random: np.random.Generator) -> tuple[str, Parts]:
    """A mechanism and the row it belongs to."""
    seed = int(random.integers(2**32))
    row = str(
        random.choice(["dyads", "several", "higher", "parallel", "sphere"], p=[0.4, 0.2, 0.1, 0.1, 0.2])
    )
    if row == "parallel":
        parts = parallel(random)
    elif row == "sphere":
        kinds = random.choice(SPHERE_KINDS, int(random.integers(1, 4))).tolist()
        parts = grown_on_sphere(kinds, seed).parts()
        for body in parts["links"].values():
            mass = float(random.uniform(0.3, 1.0))
            body |= {
                "mass": mass,
                "centre": [0.2, 0.1],
                "centre_radius": 0.8,
                "inertia": [0.2 * mass, 0.25 * mass, 0.3 * mass],
            }
        parts |= {"gravity": [0.0, 0.0, -GRAVITY], "radius": 1.0}
        return row, parts
    elif row == "higher":
        parts = grown_higher(random.choice(["triad", "guided triad", "four sides"], 1).tolist(), seed)
    else:
        parts = grown(random.choice(KINDS, int(random.integers(1, 5))).tolist(), seed)
    if row == "several":
        hung(parts, random, int(random.integers(1, 3)))
    rods(parts)
    parts["gravity"] = [0.0, -GRAVITY]
    return row, parts


def scale_of(free: FreeMotion, course: Trajectory) -> float:
    """What energies are compared with [J]: m g l, or what moves."""
    weight = GRAVITY * sum(float(mass.mass) for mass in free.equations.masses)
    return max(
        weight * float(free.equations.numbers.scale), float(np.max(course.kinetic_energy, initial=0.0))
    )


def run(seed: int, number: int) -> Outcome:
    """One mechanism: ten seconds from rest, and a second there and back."""
    random = random_of(seed, number)
    row, parts = drawn(random)
    outcome = Outcome(subject=repr(parts))
    free = free_motion_of(ct.Mechanism(**parts))
    start = free.initial()
    course = free.integrate(start, DURATION, TOLERANCE, samples=101)
    outcome.count(f"{row}: {free.mobility} degrees of freedom, {free.redundant} redundant")
    for event in course.events:
        outcome.count(event.kind)
    outcome.count(f"ended: {course.ended}")
    # two slots that become parallel send the pin in both to infinity
    if course.ended not in ("duration", "change point", "blow-up"):
        outcome.fault(f"{row}: ended by {course.ended}: {course.cause}")
    if len(course.time) < 2:
        return outcome
    outcome.hold(row, "drift", float(np.max(np.abs(course.energy_residual))) / scale_of(free, course), DRIFT)
    length = float(free.equations.numbers.scale)
    outcome.hold(row, "gap", float(np.max(course.position_residual)) / max(1.0, length), GAP)
    if course.time[-1] >= BACK and not course.events:
        there = free.integrate(start, BACK, TOLERANCE, at=[BACK])
        if there.ended != "duration":
            return outcome
        back = free.integrate(
            InitialState(there.coordinates[0], -there.speeds[0]), BACK, TOLERANCE, at=[BACK]
        )
        outcome.measure(row, "way back", float(np.max(np.abs(back.coordinates[0] - start.coordinates))))
    return outcome


CAMPAIGN = Campaign(
    name="free-motions",
    title="Mechanisms left to gravity",
    about=(
        "Random mechanisms of rods (dyads with gears and rolling wheels, pendulums hung on them, higher groups, "
        "parallel cranks, spherical ones) fall from rest for ten seconds by forward dynamics."
    ),
    columns={
        "drift": f"greatest change of the energy over m g l or the kinetic energy; at most {DRIFT:g}",
        "gap": f"greatest gap of a cut loop over 1 m or the greatest length; at most {GAP:g}",
        "way back": "how far from its start it is after a second there and a second back [rad or m]",
    },
    run=run,
    cases=1200,
)
