"""How links turn and sliders run over a tour: extreme positions, strokes, time ratios, dwells."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import tau
from typing import Literal, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.arrays import ARRAYS
from centrode.analysis.turning.alignments import Pairs, in_line
from centrode.analysis.turning.dwells import Dwell, dwells_of
from centrode.analysis.turning.tours import Tour
from centrode.analysis.turning.watched import STILL, Course, Watched
from centrode.kinematics.path import JETS
from centrode.kinematics.plan_evaluation import rotor_of_angle, slide_of
from centrode.structure.groups import Meet

Array: TypeAlias = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Extreme:
    """A value [rad or m] at which a link or a slider turns back, or stops with the drive at a limit.

    Attributes
    ----------
    at : value of the drive [rad or m]
    in_line : pairs of links that fall in line there
    at_limit : whether it is the end of the drive's range
    """

    value: float
    at: float
    in_line: tuple[tuple[str, str], ...] = ()
    at_limit: bool = False


@dataclass(frozen=True)
class Swing:
    """How one link, or one slider along its guide, moves over a tour.

    Attributes
    ----------
    name : of the link or the guide
    kind : "turns" (a slider: runs on), "swings" (runs to and fro), "still" (keeps its angle or place)
    unit : "rad" or "m"
    turns : net turns over the tour; None where the drive is limited
    least, greatest : Extreme or None
    stroke : greatest less least value; None where it turns, or where a limit leaves the value undetermined
    time_ratio : time of the longer way over that of the shorter one at constant speed of the drive; None
        unless it has two extreme positions in one turn of the drive
    extremes : all of them, in the drive's order
    """

    name: str
    member: Literal["link", "guide"]
    kind: Literal["turns", "swings", "still"]
    unit: str
    turns: int | None
    least: Extreme | None
    greatest: Extreme | None
    stroke: float | None
    time_ratio: float | None
    extremes: tuple[Extreme, ...]
    dwells: tuple[Dwell, ...]


def watched_members(tour: Tour) -> list[tuple[Watched, Literal["link", "guide"]]]:
    """Angles of links that are measured, and displacements along guides; what is driven left out."""
    kinematics = tour.continuation.kinematics
    numbers, drives = kinematics.numbers, kinematics.structure.mechanism.drives
    driven = {drive.link if drive.relative_to == "frame" else None for drive in drives}
    sliding = {drive.guide for drive in drives}

    def angle(link: str) -> Watched:
        return Watched(link, "rad", lambda at: rotor_of_angle(JETS, numbers, at, link))

    def slide(guide: str, point: str) -> Watched:
        return Watched(guide, numbers.space.unit, lambda at: slide_of(JETS, numbers, at, guide, point))

    links = [angle(link) for link in numbers.ends if link not in driven]
    guides = [slide(g.id, g.point) for g in kinematics.structure.mechanism.guides if g.id not in sliding]
    return [*((one, "link") for one in links), *((one, "guide") for one in guides)]


def swings_of(course: Course, members: Sequence[Literal["link", "guide"]], first: int = 0) -> list[Swing]:
    """The swings of the watched numbers from number `first` on, one for each kind of member."""
    chosen = range(first, first + len(members))
    places = [course.turned[k][0] for k in chosen]
    lined = iter(in_line(course.tour, np.concatenate([np.zeros(0), *places])))
    pairs = [[next(lined) for _place in some] for some in places]
    return [_swing(course, k, member, mine) for k, member, mine in zip(chosen, members, pairs, strict=True)]


def _swing(course: Course, k: int, member: Literal["link", "guide"], lined: Sequence[Pairs]) -> Swing:
    tour, one = course.tour, course.watched[k]
    values = course.values[k]
    shift = _shift(course, k, member)
    finite = np.isfinite(values)
    moved = float(np.ptp(values[finite])) if finite.any() else 0.0
    scale = 1.0 if one.unit == "rad" else float(tour.continuation.kinematics.numbers.scale)
    turns = round((values[-1] - values[0]) / tau) if tour.comes_round and one.unit == "rad" else None
    if tour.comes_round and one.unit != "rad":
        turns = 0
    if moved <= STILL * scale:
        return Swing(one.name, member, "still", one.unit, turns, None, None, 0.0, None, (), ())
    extremes = [
        Extreme(float(value) + shift, float(place), pairs)
        for place, value, pairs in zip(*course.turned[k], lined, strict=True)
    ]
    ends = [] if tour.comes_round else _ends(course, k, shift)
    extremes = sorted([*extremes, *(end for end in ends if end is not None)], key=lambda extreme: extreme.at)
    if turns or None in ends or not extremes:
        kind: Literal["turns", "swings"] = "swings" if None in ends else "turns"
        return Swing(one.name, member, kind, one.unit, turns, None, None, None, None, tuple(extremes), ())
    least, greatest = (pick(extremes, key=lambda e: e.value) for pick in (min, max))
    stroke = greatest.value - least.value
    return Swing(
        one.name,
        member,
        "swings",
        one.unit,
        turns,
        least,
        greatest,
        stroke,
        _time_ratio(tour, extremes),
        tuple(extremes),
        tuple(dwells_of(course, k, shift, stroke)),
    )


def _shift(course: Course, k: int, member: str) -> float:
    """What brings an angle into the turn of the initial position."""
    if member == "guide":
        return 0.0
    tour = course.tour
    given = tour.prepared.assembled.angles[course.watched[k].name]
    node = int(np.argmin(np.abs(course.nodes - tour.initial)))
    return tau * float(np.round((given - course.values[k][node]) / tau))


def _ends(course: Course, k: int, shift: float) -> list[Extreme | None]:
    """The values at the ends of the drive's range, where the member stops with it; None where they are undetermined."""
    tour, one = course.tour, course.watched[k]
    found: list[Extreme | None] = []
    for limit, node in ((tour.low, 0), (tour.high, -1)):
        if not np.isfinite(limit):
            continue
        value = float(one.value(tour.stopped(limit, ARRAYS), 1)[0])
        near = float(course.values[k][node])
        if _goes_to_infinity(tour, limit) or not (np.isfinite(value) and np.isfinite(near)):
            found.append(None)
            continue
        value += tau * round((near - value) / tau) if one.unit == "rad" else 0.0
        found.append(Extreme(value + shift, limit, (), True))
    return found


def _goes_to_infinity(tour: Tour, limit: float) -> bool:
    """Whether two lines are parallel at a limit."""
    groups = tour.prepared.structure.groups
    events = tour.continuation.branches.events
    at_limit = [groups[event.group] for event in events if event.kind == "limit" and event.at == limit]
    return any(isinstance(group, Meet) and not group.signed for group in at_limit)


def _time_ratio(tour: Tour, extremes: Sequence[Extreme]) -> float | None:
    if tour.turns != 1 or len(extremes) != 2:
        return None
    way = abs(extremes[1].at - extremes[0].at)
    return max(way, tau - way) / min(way, tau - way)
