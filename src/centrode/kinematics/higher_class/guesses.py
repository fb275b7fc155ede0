"""The initial position of a group of higher class: the description's initial angles say which of many is meant."""

from __future__ import annotations

from collections.abc import Sequence
from math import remainder, tau
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.arrays import ARRAYS
from centrode.algebra.rounding import ROUNDED, Rounded
from centrode.errors import InputError
from centrode.kinematics.higher_class.newton import newton
from centrode.kinematics.higher_class.seeking import closing, scattered
from centrode.kinematics.higher_class.surroundings import within
from centrode.kinematics.higher_class.system import System
from centrode.kinematics.layout import rotor_of_angle
from centrode.kinematics.sides import is_measured
from centrode.locale import _
from centrode.model.mechanism import Mechanism
from centrode.structure.assur import name_of
from centrode.structure.constraints import Positions
from centrode.structure.dimensions import Dimensions
from centrode.structure.groups import Newton

Array: TypeAlias = npt.NDArray[np.float64]
Number: TypeAlias = Any

STEPS = 30
"""Newton steps from the initial angles to the initial position."""
SINGULAR = 1e-9
"""Smallest over greatest singular value of a group that stands at a limit or a change point."""


def start_higher(mechanism: Mechanism, numbers: Dimensions, group: Newton, at: Positions) -> System:
    """Add a group's initial position to what is known before it; returns the system it solves.

    Raises InputError where an initial angle is missing, where nothing closes near the angles given, and where
    the group is singular.
    """
    system = System(group, numbers, at.copied(), 1)
    start = _start(mechanism, system, at)
    with np.errstate(all="ignore"):
        found = newton(system, start, STEPS)
        if not found.found[0]:
            raise _does_not_close(system, start)
        closed = system.at(ARRAYS, at, found.state)
        values = np.linalg.svd(system.linear(closed).matrix[0], compute_uv=False)
    if values[-1] <= SINGULAR * values[0]:
        raise InputError(
            name_of(group),
            _("it stands at a limit or a change point in the initial position"),
            _("start the drive elsewhere"),
        )
    closed = closed.mapped(_floating)
    for name in group.points:
        at.points[name] = closed.points[name]
    for name in group.links:
        at.poses[name] = closed.poses[name]
        if name in closed.angles:
            at.angles[name] = closed.angles[name]
    return system


def bound_higher(system: System, at: Positions, bounded: Positions) -> None:
    """Add a group's initial position to what is known before it with bounds of rounding errors."""
    state = system.state_of(at)
    linear = system.linear(system.at(ARRAYS, system.known, state))
    known = bounded.mapped(
        lambda x: Rounded(np.reshape(x.value, 1), np.reshape(x.bound, 1)) if isinstance(x, Rounded) else x
    )
    found = system.at(ROUNDED, known, state, system.bounds(known, state, linear)).mapped(within(_single))
    bounded.points.update(found.points)
    bounded.poses.update(found.poses)
    bounded.angles.update(found.angles)


def _floating(x: Number) -> float:
    return float(x if np.ndim(x) == 0 else x[0])


def _single(x: Number) -> Number:
    """One number from an array of one."""
    return x if np.ndim(x) == 0 else x[0]


def _start(mechanism: Mechanism, system: System, at: Positions) -> Array:
    """The state from which Newton's method starts."""
    starts = [system.state_of(guess) for guess in guesses(mechanism, system.numbers, system.group, at)]
    if len(starts) == 1:
        return starts[0]
    states = closing(mechanism, system, starts, STEPS)
    if len(states) > 1:
        raise InputError(
            name_of(system.group),
            _("{n} positions that close lie near the initial angles").format(n=len(states)),
            _("hinge a link of known angle to it, or start the drives elsewhere"),
        )
    return states[0] if states else starts[0]


def guesses(mechanism: Mechanism, numbers: Dimensions, group: Newton, at: Positions) -> list[Positions]:
    """Where the initial angles put the group's links: in one way, or in many where they know angles and no place."""
    guess, left = _chained(mechanism, numbers, group.links, at.copied())
    if not left and all(point in guess.points for point in group.points):
        return [guess]
    if _adrift(mechanism, left) is None:
        raise _missing(mechanism, group, left or list(group.links))
    found = []
    origin = (0.0, 0.0) if mechanism.space == "plane" else (1.0, 0.0, 0.0)
    for place in scattered(numbers, at, origin):
        trial, rest = guess.copied(), left
        while (link := _adrift(mechanism, rest)) is not None:  # several, where guides alone join them
            trial.points[next(iter(numbers.local[link]))] = place
            trial, after = _chained(mechanism, numbers, rest, trial)
            if after == rest:
                break
            rest = after
        carried = {point for link in group.links for point in numbers.local[link]}
        for point in group.points:
            if point not in carried:  # of a slider that only guides hold
                trial.points.setdefault(point, place)
        if rest or any(point not in trial.points for point in group.points):
            raise _missing(mechanism, group, rest or left)
        found.append(trial)
    return found


def _adrift(mechanism: Mechanism, links: Sequence[str]) -> str | None:
    """The first of links whose initial angle is known; None where there is none."""
    return next((link for link in links if mechanism.initial_angle(link) is not None), None)


def _chained(
    mechanism: Mechanism, numbers: Dimensions, links: Sequence[str], guess: Positions
) -> tuple[Positions, list[str]]:
    """A guess with links put by their initial angles, link by link from what is known; and those left over."""
    left = list(links)
    while ready := [link for link in left if _put(mechanism, numbers, link, guess)]:
        left = [link for link in left if link not in ready]
    return guess, left


def _put(mechanism: Mechanism, numbers: Dimensions, link: str, guess: Positions) -> bool:
    """Pose a link by its initial angle and a known point, or by two known points."""
    local, space = numbers.local[link], numbers.space
    known = [point for point in local if point in guess.points]
    angle, pose = mechanism.initial_angle(link), None
    if angle is not None and is_measured(numbers, guess, link):
        towards = [guess.points[point] for point in numbers.ends[link]]
        at = [guess.points.get(point) for point in local]
        pose = space.pose_at_angle(ARRAYS, angle, list(local.values()), at, towards)
    elif angle is None and len(known) > 1:
        first, second = known[:2]
        ends = local[first], local[second], guess.points[first], guess.points[second]
        pose = space.righted(ARRAYS, space.pose_by_two_points(ARRAYS, *ends))
    if pose is None:
        return False
    guess.poses[link] = pose
    if link in numbers.ends and is_measured(numbers, guess, link):
        cosine, sine = rotor_of_angle(ARRAYS, numbers, guess, link)
        near = angle or 0.0
        guess.angles[link] = near + remainder(float(np.arctan2(sine, cosine)) - near, tau)
    for point, at_rest in local.items():
        if point not in guess.points:
            guess.points[point] = space.place(ARRAYS, pose, at_rest)
    return True


def _missing(mechanism: Mechanism, group: Newton, left: list[str]) -> InputError:
    without = [link for link in left if mechanism.initial_angle(link) is None]
    return InputError(
        name_of(group),
        _("it is of higher class: its initial angles say which of its positions is meant"),
        _("give the initial angle of {links}").format(links=", ".join(without or left)),
    )


def _does_not_close(system: System, start: Array) -> InputError:
    gap = system.gap(start)[0] * system.numbers.scale
    return InputError(
        name_of(system.group),
        _("no position that closes lies near the initial angles: they leave a gap of {gap}").format(
            gap=f"{float(gap):.3g} {system.numbers.space.unit}"
        ),
        _("correct the initial angles, a length, or the start of the drive"),
    )
