"""The initial position of a group of higher class: the description's initial angles say which of many is meant."""

from __future__ import annotations

from math import remainder, tau
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.arrays import ARRAYS
from centrode.algebra.rounding import ROUNDED, Rounded
from centrode.errors import InputError
from centrode.kinematics.layout import rotor_of_angle
from centrode.kinematics.newton import System, newton
from centrode.kinematics.sides import is_measured
from centrode.locale import _
from centrode.model.mechanism import Mechanism
from centrode.structure.constraints import DisplacementDrive, PointInLink, PointOnGuide
from centrode.structure.dimensions import Dimensions
from centrode.structure.groups import Newton
from centrode.structure.positions import Entity, Positions
from centrode.structure.steps import name_of

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
    guess = guessed(mechanism, numbers, group, at)
    system = System(group, numbers, at.copied(), 1)
    with np.errstate(all="ignore"):
        found = newton(system, system.state_of(guess), STEPS)
        if not found.found[0]:
            raise _does_not_close(system, found.sizes[0, 0], guess)
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
    found = system.at(ROUNDED, known, state, system.bounds(known, state, linear)).mapped(_single)
    bounded.points.update(found.points)
    bounded.poses.update(found.poses)
    bounded.angles.update(found.angles)


def _floating(x: Number) -> float:
    return float(x if np.ndim(x) == 0 else x[0])


def _single(x: Number) -> Number:
    """One number from an array of one."""
    if isinstance(x, Rounded):
        return Rounded(_single(x.value), _single(x.bound))
    return x if np.ndim(x) == 0 else x[0]


def guessed(mechanism: Mechanism, numbers: Dimensions, group: Newton, at: Positions) -> Positions:
    """Where the initial angles put the group's links, link by link from what is known."""
    guess = at.copied()
    left = list(group.links)
    while left:
        ready = [link for link in left if _put(mechanism, numbers, link, guess)]
        if not ready:
            if not _put_on_guides(mechanism, numbers, group, left, guess):
                raise _missing(mechanism, group, left)
            break
        left = [link for link in left if link not in ready]
    for point in group.points:
        if point not in guess.points:
            raise _missing(mechanism, group, list(group.links))
    return guess


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


def _put_on_guides(
    mechanism: Mechanism, numbers: Dimensions, group: Newton, left: list[str], guess: Positions
) -> bool:
    """Put links of known angles that are hinged to nothing known where their guides leave the least gaps.

    With angles given everything left is linear in the places: links are put anywhere, then all are moved together.
    """
    if len(numbers.space.axes) > 2 or any(mechanism.initial_angle(link) is None for link in left):
        return False
    points = [point for point in group.points if point not in guess.points]
    for link in left:
        near = next((point for point in numbers.local[link] if point in guess.points), None)
        if near is None:
            near = next(iter(numbers.local[link]))
            guess.points[near] = (0.0, 0.0)
        _put(mechanism, numbers, link, guess)
    for point in points:
        guess.points.setdefault(point, (0.0, 0.0))
    moving = [Entity("point", point) for point in points] + [Entity("link", link) for link in left]
    rows, gaps = [], []
    for constraint, number in group.equations:
        if isinstance(constraint, (PointInLink, PointOnGuide, DisplacementDrive)):
            row = constraint.rows(numbers, guess)[number]
            rows.append([x for entity in moving for x in list(row.get(entity, (0.0,) * 3))[:2]])
            gaps.append(constraint.residual(ARRAYS, numbers, guess)[number])
    shifts = np.linalg.lstsq(np.array(rows, dtype=float), -np.array(gaps, dtype=float), rcond=None)[0]
    for entity, (x, y) in zip(moving, shifts.reshape(-1, 2), strict=True):
        if entity.kind == "point":
            place = guess.points[entity.name]
            guess.points[entity.name] = (place[0] + x, place[1] + y)
        else:
            pose = guess.poses[entity.name]
            guess.poses[entity.name] = type(pose)((pose[0][0] + x, pose[0][1] + y), *pose[1:])
    return True


def _missing(mechanism: Mechanism, group: Newton, left: list[str]) -> InputError:
    without = [link for link in left if mechanism.initial_angle(link) is None]
    return InputError(
        name_of(group),
        _("it is of higher class: its initial angles say which of its positions is meant"),
        _("give the initial angle of {links}").format(links=", ".join(without or left)),
    )


def _does_not_close(system: System, first: float, guess: Positions) -> InputError:
    gap = system.gap(system.state_of(guess))[0] * system.numbers.scale
    return InputError(
        name_of(system.group),
        _("no position that closes lies near the initial angles: they leave a gap of {gap}").format(
            gap=f"{float(gap):.3g} {system.numbers.space.unit}"
        ),
        _("correct the initial angles, a length, or the start of the drive"),
    )
