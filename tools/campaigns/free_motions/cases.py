"""Random mechanisms left to gravity by forward dynamics: their energy, their states by a second way, their way back."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

import centrode as ct
from centrode.dynamics.forward_dynamics.free_motion import FreeMotion, free_motion_of
from centrode.dynamics.forward_dynamics.initial_state import InitialState
from centrode.dynamics.forward_dynamics.solvability import closure_rank
from centrode.dynamics.forward_dynamics.trajectory import Trajectory
from tools.campaigns.campaign import Campaign, Outcome, random_of
from tools.campaigns.free_motions.dense_equations import DenseMechanism, TooManySteps
from tools.campaigns.grown.higher import grown_higher
from tools.campaigns.grown.plane import KINDS, grown
from tools.campaigns.grown.sphere import KINDS as SPHERE_KINDS
from tools.campaigns.grown.sphere import grown as grown_on_sphere

Parts = dict[str, Any]
DURATION, SOON = 10.0, 1.0
"""Seconds that it is left to itself, and after which its state is compared."""
TOLERANCE = 1e-11
DRIFT, GAP, APART = 1e-8, 1e-11, 1e-8
"""Bounds: of the energy over m g l, of closures and of places over lengths."""
LOST = 2
"""Closures lost at once in a change point that may be refused."""
ON_SPHERE = 6
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


def with_rollers(parts: Parts) -> None:
    """A roller on every point that no link carries: a pin in two slots has a mass like everything else."""
    carried = {point for body in parts["links"].values() for point in body["points"]}
    pins = dict.fromkeys(
        guide["point"]
        for guide in parts.get("guides", ())
        if guide["point"] not in carried and guide["point"] not in parts["frame"]["points"]
    )
    for number, pin in enumerate(pins):
        parts["links"][f"roller{number}"] = {"points": {pin: [0.0, 0.0]}, "angle": 0.0}


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


def drawn(random: np.random.Generator, number: int) -> tuple[str, Parts]:
    """The mechanism of a number and the row it belongs to: every sixth is on the sphere."""
    seed = int(random.integers(2**32))
    row = str(random.choice(["dyads", "several", "higher", "parallel"], p=[0.5, 0.25, 0.12, 0.13]))
    if number % ON_SPHERE == ON_SPHERE - 1:
        return "sphere", spherical(random, seed)
    if row == "parallel":
        parts = parallel(random)
    elif row == "higher":
        parts = grown_higher(random.choice(["triad", "guided triad", "four sides"], 1).tolist(), seed)
    else:
        parts = grown(random.choice(KINDS, int(random.integers(1, 5))).tolist(), seed)
    with_rollers(parts)
    if row == "several":
        hung(parts, random, int(random.integers(1, 3)))
    rods(parts)
    parts["gravity"] = [0.0, -GRAVITY]
    return row, parts


def spherical(random: np.random.Generator, seed: int) -> Parts:
    """A mechanism on the unit sphere whose links have masses off their arcs."""
    # a pin in two slots, which no link carries, would have no mass
    known = [kind for kind in SPHERE_KINDS if kind != "PRP"]
    parts = grown_on_sphere(random.choice(known, int(random.integers(1, 4))).tolist(), seed).parts()
    for body in parts["links"].values():
        mass = float(random.uniform(0.3, 1.0))
        body |= {
            "mass": mass,
            "centre": [0.2, 0.1],
            "centre_radius": 0.8,
            "inertia": [0.2 * mass, 0.25 * mass, 0.3 * mass],
        }
    return parts | {"gravity": [0.0, 0.0, -GRAVITY], "radius": 1.0}


def weight_times_length(free: FreeMotion) -> float:
    """What energies are compared with [J]: m g l."""
    weight = GRAVITY * sum(float(mass.mass) for mass in free.equations.masses)
    return weight * float(free.equations.numbers.scale)


def run(seed: int, number: int) -> Outcome:
    """One mechanism: ten seconds from rest, the state after one by dense equations, and the way back from there."""
    row, parts = drawn(random_of(seed, number), number)
    outcome = Outcome(subject=repr(parts))
    free = free_motion_of(ct.Mechanism(**parts))
    start = free.initial()
    course = free.integrate(start, DURATION, TOLERANCE, samples=101)
    outcome.count(f"of mobility {free.mobility}")
    if free.redundant:
        outcome.count("with redundant closures")
    for kind in sorted({event.kind for event in course.events}):
        outcome.count(f"motions with a {kind}")
    if course.ended != "duration":
        refuse(outcome, free, course, f"case {number} ({row})")
    outcome.hold(
        row, "drift", float(np.max(np.abs(course.energy_residual))) / weight_times_length(free), DRIFT
    )
    length = max(1.0, float(free.equations.numbers.scale))
    outcome.hold(row, "gap", float(np.max(course.position_residual)) / length, GAP)
    if course.time[-1] >= SOON:
        compare(outcome, row, free, start, parts)
    return outcome


def refuse(outcome: Outcome, free: FreeMotion, course: Trajectory, name: str) -> None:
    """A motion that did not get to its end: no fault in a change point in which two or more closures are lost."""
    lost = free.equations.equations - free.redundant - closure_rank(free.equations, course.coordinates[-1])
    if course.ended == "change point" and lost >= LOST:
        outcome.count(f"refused: {name}, {lost} closures lost at once")
        return
    outcome.fault(f"{name}: ended by {course.ended}: {course.cause}")


def compare(outcome: Outcome, row: str, free: FreeMotion, start: InitialState, parts: Parts) -> None:
    """The state after a second against dense equations, and how far from its start the way back ends."""
    there = free.integrate(start, SOON, TOLERANCE, at=[0.0, SOON])
    length = max(1.0, float(free.equations.numbers.scale))
    turns = there.angles if there.attitudes is None else there.attitudes
    dense = DenseMechanism(
        parts,
        dict(zip(free.points, there.places[0], strict=True)),
        dict(zip(free.links, turns[0], strict=True)),
    )
    apart = distance_from_dense(dense, free, there.places[1])
    if isinstance(apart, str):
        outcome.count(f"not compared with dense equations: {apart}")
    else:
        outcome.count("compared with dense equations")
        outcome.hold(row, "states", apart / length, APART)
    back = free.integrate(InitialState(there.coordinates[1], -there.speeds[1]), SOON, TOLERANCE, at=[SOON])
    outcome.hold(row, "way back", float(np.max(np.abs(back.places[0] - there.places[0]))) / length, APART)


def distance_from_dense(dense: DenseMechanism, free: FreeMotion, places: Any) -> float | str:
    """Greatest distance of points after a second, or why dense equations have no motion to compare with."""
    equations = dense.equations
    try:
        q, v = equations.state_at(dense.start, np.zeros_like(dense.start), SOON)
    except TooManySteps:
        return "too many steps"
    energy = equations.energy_of_motion(v) - float(equations.force @ (q - dense.start))
    if not abs(energy) <= DRIFT * weight_times_length(free):
        # nothing leads them through change points: they may come out on another branch, with another energy
        return "they lose energy in a change point"
    return max(
        float(np.max(np.abs(dense.point(q[:, None], point)[:, 0] - place)))
        for point, place in zip(free.points, places, strict=True)
    )


COLUMNS = {
    "drift": f"greatest change of the energy over m g l; at most {DRIFT:g}",
    "gap": f"greatest gap of a cut loop over 1 m or the greatest length; at most {GAP:g}",
    "states": f"distance of points from dense equations after 1 s, over the same length; at most {APART:g}",
    "way back": f"distance of points from the start after 1 s there and 1 s back; at most {APART:g}",
}

CAMPAIGN = Campaign(
    name="free-motions",
    title="Mechanisms left to gravity",
    about=(
        "Random mechanisms of rods of 1 kg/m (dyads with gears and rolling wheels, pendulums hung on them, higher "
        "groups, parallel cranks; every sixth is spherical) fall from rest for ten seconds by forward dynamics. Pins "
        "that no link carries have a roller in the plane, and are left out on the sphere. After a second all points "
        "are compared with those by dense equations in absolute coordinates, which SciPy integrates and which share "
        "no formula with the program (`tools/campaigns/free_motions/dense_equations.py`); from there each motion runs "
        "backwards to its start. A motion that ends early is a fault, but for change points in which two or more "
        "closures are lost at once: those are counted as refused, each by name."
    ),
    columns=COLUMNS,
    run=run,
    cases=1200,
)
