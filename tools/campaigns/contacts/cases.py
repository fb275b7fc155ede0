"""Random mechanisms with walls and friction by events, against time steps of three lengths."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

import centrode as ct
from centrode.dynamics.forward_dynamics.free_motion import FreeMotion, free_motion_of
from centrode.dynamics.forward_dynamics.motion_steps import Event
from centrode.dynamics.forward_dynamics.trajectory import Trajectory
from tools.campaigns.campaign import Campaign, Outcome, random_of
from tools.campaigns.contacts.time_steps import NEARLY_STILL, Rubbing, Run, Wall, run_steps
from tools.campaigns.free_motions.cases import GRAVITY, hung, rods, weight_times_length, with_rollers
from tools.campaigns.free_motions.dense_equations import DenseMechanism
from tools.campaigns.grown.plane import KINDS, grown

Parts = dict[str, Any]
DURATION, COARSE = 0.5, 80
"""Seconds, and equal steps of the longest kind."""
TOLERANCE = 1e-11
RESTED = 0.05
"""By how much [s] times at rest may differ."""
BOOKS, GAINED, SUNK = 1e-9, 1e-12, 1e-11
NEAR, FALLS = 2e-2, 0.75
"""How near the shortest steps come to ours, of the length, and to which share of the longest ones' distance."""
FINE = 2e-4
"""Below this distance errors of time steps need not fall: they cancel by chance."""
CLEAR = 0.15
"""Impacts slower than this [m/s] may be several of ours, or none: flights shorter than a step are none to the steps."""
WINDOW = 2e-2
"""Time [s] by which an impact of the time steps may be late; as near to the end one way alone may have it."""
USUAL, FINER = (1, 2, 4), (16, 64, 256, 1024)
"""Steps over those of the longest kind: for all cases, and one after the other where these do not decide.

Static friction of a step has an impulse of at most the static force times the step. It stops what an impact sets in
motion with less momentum than that impulse has over the load's, although kinetic friction would not: the step
has to be shorter. Near a change point or a limit it has to be short against the time in which the mechanism passes:
longer ones lose the energy of the link that turns fast there."""


def drawn(random: np.random.Generator) -> tuple[str, Parts]:
    """A planar mechanism of rods that falls, with pendulums in half of all cases."""
    seed = int(random.integers(2**32))
    parts = grown(random.choice(KINDS, int(random.integers(1, 4))).tolist(), seed)
    with_rollers(parts)
    row = "dyads"
    if random.random() < 0.5:
        hung(parts, random, 1)
        row = "several"
    rods(parts)
    parts["gravity"] = [0.0, -GRAVITY]
    return row, parts


def with_contacts(
    parts: Parts, random: np.random.Generator, free: FreeMotion
) -> tuple[Parts, list[Wall], list[Rubbing]]:
    """The mechanism with one or two walls that its points fall against, and friction of one or two links."""
    swung = free.integrate(free.initial(), DURATION, 1e-8, samples=26)
    walls: list[Wall] = []
    stops: list[Any] = []
    moving = [name for name in free.points if name not in parts["frame"]["points"]]
    for _wall in range(int(random.integers(1, 3))):
        name = str(random.choice(moving))
        way = swung.places[:, free.points.index(name)]
        if len(way) < 5:
            continue
        there = way[int(random.integers(3, len(way)))] - way[0]
        size = float(np.hypot(*there))
        if size < 1e-2:
            continue
        direction = (float(there[0] / size), float(there[1] / size))
        most = float(direction @ way[0]) + size * float(random.uniform(0.3, 0.8))
        restitution = round(float(random.uniform(0.0, 0.9)), 2)
        stops.append(
            {
                # walls are counted as they stand in the list: some of those that were drawn are none
                "name": f"wall {len(walls)}",
                "point": name,
                "direction": list(direction),
                "most": most,
                "restitution": restitution,
            }
        )
        walls.append(Wall(name, direction, most, restitution))
    rubbing, loads = [], []
    for body in random.permutation(list(parts["links"]))[: int(random.integers(1, 3))].tolist():
        kinetic = weight_times_length(free) * float(random.uniform(0.0005, 0.02))
        static = kinetic * float(random.choice([1.0, 1.3]))
        rubbing.append(Rubbing(body, "frame", kinetic, static))
        loads.append({"kind": "friction", "link": body, "value": kinetic, "static": static})
    return parts | {"stops": stops, "loads": loads}, walls, rubbing


def run(seed: int, number: int) -> Outcome:
    """One mechanism by events, and by time steps of three lengths."""
    random = random_of(seed, number)
    row, plain = drawn(random)
    free = free_motion_of(ct.Mechanism(**plain))
    parts, walls, rubbing = with_contacts(plain, random, free)
    outcome = Outcome(subject=repr(parts))
    watched = free_motion_of(ct.Mechanism(**parts))
    course = watched.integrate(watched.initial(), DURATION, TOLERANCE, at=np.linspace(0.0, DURATION, 201))
    if course.ended != "duration":
        outcome.count(f"ended by {course.ended}")
        return outcome
    scale = weight_times_length(free)
    outcome.hold(row, "books", float(np.max(np.abs(course.energy_residual))) / scale, BOOKS)
    gains = [-event.lost for event in course.events if event.kind == "impact"]
    outcome.hold(row, "gain", max(gains, default=0.0) / scale, GAINED)
    outcome.hold(row, "sunk", sunk(watched, course, walls), SUNK)
    for kind in ("impact", "comes to rest", "sticks", "slips", "opens"):
        outcome.count(kind, sum(event.kind == kind for event in course.events))
    compare(outcome, row, watched, course, parts, walls, rubbing)
    return outcome


def sunk(free: FreeMotion, course: Trajectory, walls: list[Wall]) -> float:
    """How far a point has sunk into its wall, of the greatest length."""
    deepest = 0.0
    for wall in walls:
        way = course.places[:, free.points.index(wall.point)] @ np.array(wall.direction)
        deepest = max(deepest, float(np.max(way - wall.most)))
    return deepest / max(1.0, float(free.equations.numbers.scale))


def compare(
    outcome: Outcome,
    row: str,
    free: FreeMotion,
    course: Trajectory,
    parts: Parts,
    walls: list[Wall],
    rubbing: list[Rubbing],
) -> None:
    """Distances of time steps from the motion by events, and what happened in both."""
    dense = DenseMechanism(
        parts,
        dict(zip(free.points, course.places[0], strict=True)),
        dict(zip(free.links, course.angles[0], strict=True)),
    )
    length = max(1.0, float(free.equations.numbers.scale))
    runs: list[Run] = []
    apart: list[float] = []
    for times in (*USUAL, *FINER):
        if times in FINER:
            if decides(apart) and rest_gap(free, course, runs[-1], rubbing) <= RESTED:
                break
            outcome.count(f"looked at with {times} times as many steps")
        runs.append(run_steps(dense, walls, rubbing, DURATION, COARSE * times))
        apart.append(distance(dense, free, course, runs[-1]) / length)
    outcome.count("compared with time steps")
    if not comes_nearer(apart):
        outcome.fault(f"{row}: time steps do not come nearer: {apart}")
    outcome.hold(row, "apart", apart[-1], NEAR)
    if apart[0] > FINE:
        outcome.measure(row, "order", math.log2(max(apart[0], 1e-12) / max(apart[2], 1e-12)) / 2.0)
    agree(outcome, row, dense, course, runs[len(USUAL) - 1], walls, rubbing)
    outcome.hold(row, "rest", rest_gap(free, course, runs[-1], rubbing), RESTED)
    outcome.count(
        "links with friction that rest",
        sum(rest_time(free, course, one) > RESTED for one in rubbing),
    )


def comes_nearer(apart: Sequence[float]) -> bool:
    """Whether the shortest of the steps are nearer to the motion by events than the longest, or as near as can be."""
    # the greatest step of the distance is that of an impact which the steps have had, and the motion not yet
    return apart[-1] <= max(FINE, FALLS * apart[0])


def decides(apart: Sequence[float]) -> bool:
    """Whether shorter steps are not needed to tell that they come to the motion by events."""
    return comes_nearer(apart) and apart[-1] <= NEAR


def agree(
    outcome: Outcome,
    row: str,
    dense: DenseMechanism,
    course: Trajectory,
    found: Run,
    walls: list[Wall],
    rubbing: list[Rubbing],
) -> None:
    """Clear impacts of each belong to impacts of the other; where they do not, shorter steps are asked."""
    own = own_impacts(course, walls)
    outcome.count("clear impacts", sum(one.is_clear for one in own))
    lonely = alone(own, steps_impacts(found))
    for times in FINER:
        if not lonely:
            break
        outcome.count(f"impacts looked for with {times} times as many steps")
        lonely = alone(own, steps_impacts(run_steps(dense, walls, rubbing, DURATION, COARSE * times)))
    for one in lonely:
        outcome.fault(f"{row}: an impact without its like: {one}")


class SeenImpact(NamedTuple):
    """An impact as one of the two ways saw it: instant [s], number of the wall, speed [m/s]."""

    time: float
    wall: int
    speed: float

    @property
    def is_clear(self) -> bool:
        """Whether it is so fast that the other way has to see it."""
        return self.speed > CLEAR


def own_impacts(course: Trajectory, walls: list[Wall]) -> list[SeenImpact]:
    """Impacts of the motion by events."""
    numbers = {f"wall {k}": k for k in range(len(walls))}
    return [
        SeenImpact(event.time, numbers[event.part], speed_of_impact(event, walls[numbers[event.part]]))
        for event in course.events
        if event.kind == "impact"
    ]


def steps_impacts(found: Run) -> list[SeenImpact]:
    """Impacts of time steps."""
    return [SeenImpact(time, wall, -speed) for time, wall, speed in found.impacts]


def alone(own: list[SeenImpact], other: list[SeenImpact]) -> list[SeenImpact]:
    """Clear impacts of either list to which none of the other belongs, but for those at the end of the time."""
    lonely = []
    for mine, theirs in ((own, other), (other, own)):
        left = list(theirs)
        for one in sorted(mine, key=lambda impact: -impact.speed):
            near = [its for its in left if its.wall == one.wall and abs(its.time - one.time) <= WINDOW]
            if near:
                left.remove(min(near, key=lambda its: abs(its.time - one.time) + abs(its.speed - one.speed)))
            elif one.is_clear and one.time < DURATION - WINDOW:
                lonely.append(one)
    return lonely


def rest_time(free: FreeMotion, course: Trajectory, one: Rubbing) -> float:
    """For how long [s] a link with friction is at rest in the motion by events."""
    still = np.abs(course.angular_velocities[:, free.links.index(one.body)]) <= NEARLY_STILL
    return DURATION * float(np.mean(still))


def rest_gap(free: FreeMotion, course: Trajectory, steps: Run, rubbing: list[Rubbing]) -> float:
    """Greatest difference [s] of times at rest of links with friction."""
    pairs = zip(rubbing, steps.rests, strict=True)
    return max((abs(rest_time(free, course, one) - theirs) for one, theirs in pairs), default=0.0)


def speed_of_impact(event: Event, wall: Wall) -> float:
    """Speed [m/s] before an impact: what it lost is its impulse times half of what is left of the speed's change."""
    return 2.0 * event.lost / event.impulse / (1.0 - wall.restitution) if event.impulse > 0.0 else 0.0


def distance(dense: DenseMechanism, free: FreeMotion, course: Trajectory, one: Run) -> float:
    """Greatest distance of points at the end [m]."""
    return max(
        float(np.max(np.abs(dense.point(one.q[:, None], point)[:, 0] - place)))
        for point, place in zip(free.points, course.places[-1], strict=True)
    )


CAMPAIGN = Campaign(
    name="contacts",
    title="Stops and friction",
    about=(
        "Random planar mechanisms of rods of 1 kg/m (dyads with gears and rolling wheels, pendulums on half of them) "
        "fall from rest against one or two walls with restitutions from 0 to 0.9, with dry friction of one or two "
        "links, the static one in half of all cases greater. The motion by events is compared with Moreau's time "
        "steps in absolute coordinates (`tools/campaigns/contacts/time_steps.py`), which seek no event and share no "
        "formula with the program: with half and a quarter of the step they come nearer at their first order. Where "
        "they do not, or stay apart, or rest for another time, a sixteenth of the step decides, then a 64th, a 256th "
        "and a 1024th. Steps can be too long in two ways: the impulse of static friction in a step stops a link that "
        "an impact has set in motion slowly, although kinetic friction would let it go on; and near a change point or "
        "a limit a link turns fast for no more than a few steps, which lose its energy. Each "
        f"impact faster than {CLEAR:g} m/s of either has one of the other within {WINDOW:g} s, but for those as near "
        "to the end; slower ones are merged by steps that are longer than their flights."
    ),
    columns={
        "books": f"greatest gap of the energy balance over m g l; at most {BOOKS:g}",
        "gain": f"greatest gain of energy in an impact over m g l; at most {GAINED:g}",
        "sunk": f"how far a point sinks into its wall, of the greatest length; at most {SUNK:g}",
        "apart": f"distance of points from the time steps with the shortest step, over the length; at most {NEAR:g}",
        "rest": f"difference of times at rest of links with friction [s]; at most {RESTED:g}",
        "order": "greatest order at which time steps come nearer",
    },
    run=run,
    cases=500,
)
