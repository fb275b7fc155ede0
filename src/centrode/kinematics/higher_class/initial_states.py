"""The initial position of a group of higher class: the description's initial angles say which of many is meant."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import cos, radians, remainder, sin, tau
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.errors import InputError
from centrode.geometry.in_plane import PLANE
from centrode.kinematics.assembly_mode import is_measured
from centrode.kinematics.higher_class.loop_closure import LoopClosure
from centrode.kinematics.higher_class.newton import newton
from centrode.kinematics.higher_class.system import GroupSystem, needed_positions, within
from centrode.kinematics.plan_evaluation import rotor_of_angle
from centrode.locale import _
from centrode.model.mechanism import Mechanism
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.rounding_bounds import ROUNDED, Rounded
from centrode.structure.assur import name_of
from centrode.structure.constraints import Positions
from centrode.structure.dimensions import Dimensions
from centrode.structure.groups import Newton

# Starting places for groups that no chain of initial angles reaches, such as a platform on three cylinders.
#
# Their links know their angles and no place. So the first of them is tried at many places about what is
# known; of what closes, the positions count that have the angles given.

Array: TypeAlias = npt.NDArray[np.float64]

RINGS, SPOKES = (0.25, 0.6, 1.0), 12
"""Places are tried on rings about every known point, in the greatest length."""
POINTS = 8
"""Known points about which places are tried."""
NEAR = radians(5.0)
"""How far the angles of a position may be from those given."""
CLEARLY = 0.2
"""A position is meant if its angles are off by less than this share of what the next position's are."""
SAME = 1e-6
"""Positions closer than this, in the greatest length and in rad, are the same."""


def scatter_places(numbers: Dimensions, at: Positions, origin: Sequence[float]) -> Iterator[Any]:
    """Places on rings about the known points; about the origin where only guides hold the group."""
    for known in list(at.points.values())[:POINTS] or [origin]:
        for ring in RINGS:
            for k in range(SPOKES):
                reach, turn = ring * numbers.scale, tau * k / SPOKES
                yield numbers.space.moved_point(ARRAYS, known, (reach * cos(turn), reach * sin(turn)))


def closing_states(
    mechanism: Mechanism, system: GroupSystem, starts: Sequence[Array], steps: int
) -> list[Array]:
    """The states near the initial angles to which Newton's method leads from the starts.

    One if its angles are much nearer to those given than the angles of all others.
    """
    # all starts are places of one system, so that Newton's method runs once
    many = GroupSystem(system.group, system.numbers, system.known, len(starts), system.closure)
    with np.errstate(all="ignore"):
        converged = newton(many, np.concatenate(starts), steps)
    states: list[Array] = []
    for k in np.nonzero(converged.found)[0]:
        state = converged.state[k : k + 1]
        # several starts lead to the same position
        if all(_apart(system, state, other) > SAME for other in states):
            states.append(state)
    near = [(_misfit(mechanism, system, state), state) for state in states]
    near = sorted((pair for pair in near if pair[0] <= NEAR), key=lambda pair: pair[0])
    # a position much nearer to the angles given than any other is the one meant
    if len(near) > 1 and near[0][0] < CLEARLY * near[1][0]:
        near = near[:1]
    return [state for _off, state in near]


def _apart(system: GroupSystem, one: Array, other: Array) -> float:
    return float(np.max(np.abs(one - other))) / max(1.0, float(system.numbers.scale))


def _misfit(mechanism: Mechanism, system: GroupSystem, state: Array) -> float:
    """Greatest difference of a link's angle from the one given [rad]."""
    at = system.at(ARRAYS, system.known, state)
    given = {link: mechanism.links[link].angle for link in system.group.links if link in at.angles}
    angles = {link: float(np.reshape(at.angles[link], -1)[0]) for link in given}
    return max(
        (abs(angles[link] - angle) for link, angle in given.items() if angle is not None),
        default=0.0,
    )


Number: TypeAlias = Any

STEPS = 30
"""Newton steps from the initial angles to the initial position."""
SINGULAR = 1e-9
"""Smallest over greatest singular value of a group that stands at a limit or a change point."""


def start_higher(mechanism: Mechanism, numbers: Dimensions, group: Newton, at: Positions) -> GroupSystem:
    """Add a group's initial position to what is known before it; returns the system it solves.

    Raises InputError where an initial angle is missing, where nothing closes near the angles given, and where
    the group is singular.
    """
    loops = None
    if numbers.space is PLANE and numbers.alone:
        loops = LoopClosure(group, numbers, needed_positions(group, at))
    system = GroupSystem(group, numbers, at.copy(), 1, loops)
    start = _start(mechanism, system, at)
    with np.errstate(all="ignore"):
        converged = newton(system, start, STEPS)
        if not converged.found[0]:
            raise _does_not_close(system, start)
        closed = system.at(ARRAYS, at, converged.state)
        values = np.linalg.svd(_matrix(system, closed, converged.state)[0], compute_uv=False)
    if values[-1] <= SINGULAR * values[0]:
        raise InputError(
            name_of(group),
            _("its initial position is a limit or a change point"),
            _("start the drive elsewhere"),
        )
    closed = closed.map_numbers(_as_float)
    for name in group.points:
        at.points[name] = closed.points[name]
    for name in group.links:
        at.poses[name] = closed.poses[name]
        if name in closed.angles:
            at.angles[name] = closed.angles[name]
    return system


def _matrix(system: GroupSystem, at: Positions, state: Array) -> Array:
    """Derivatives of the equations left over at a state and its positions."""
    loops = system.closure
    if loops is None:
        return system.linear(at).matrix
    known = loops.known(system.known, len(state))[0]
    return loops.matrix(loops.numbers(*loops.free_of(state), known))


def bound_higher(system: GroupSystem, at: Positions, bounded: Positions) -> None:
    """Add a group's initial position to what is known before it with bounds of rounding errors."""
    state = system.state_of(at)
    linear = system.linear(system.at(ARRAYS, system.known, state))
    known = bounded.map_numbers(
        lambda x: Rounded(np.reshape(x.value, 1), np.reshape(x.bound, 1)) if isinstance(x, Rounded) else x
    )
    with_bounds = system.at(ROUNDED, known, state, system.bounds(known, state, linear)).map_numbers(
        within(_single)
    )
    bounded.points.update(with_bounds.points)
    bounded.poses.update(with_bounds.poses)
    bounded.angles.update(with_bounds.angles)


def _as_float(x: Number) -> float:
    return float(x if np.ndim(x) == 0 else x[0])


def _single(x: Number) -> Number:
    """The only number of an array; plain numbers unchanged."""
    return x if np.ndim(x) == 0 else x[0]


def _start(mechanism: Mechanism, system: GroupSystem, at: Positions) -> Array:
    """The state from which Newton's method starts."""
    starts = [system.state_of(guess) for guess in guesses(mechanism, system.numbers, system.group, at)]
    if len(starts) == 1:
        return starts[0]
    states = closing_states(mechanism, system, starts, STEPS)
    if len(states) > 1:
        raise InputError(
            name_of(system.group),
            _("{n} positions that close lie near the initial angles").format(n=len(states)),
            _("hinge a link of known angle to it, or start the drives elsewhere"),
        )
    return states[0] if states else starts[0]


def guesses(mechanism: Mechanism, numbers: Dimensions, group: Newton, at: Positions) -> list[Positions]:
    """Where the initial angles put the group's links: in one way, or in many where they know angles and no place."""
    guess, left = _chain_links(mechanism, numbers, group.links, at.copy())
    if not left and all(point in guess.points for point in group.points):
        return [guess]
    if _adrift(mechanism, left) is None:
        raise _missing_angle_error(mechanism, group, left or list(group.links))
    trials = []
    origin = (0.0, 0.0) if mechanism.space == "plane" else (1.0, 0.0, 0.0)
    for place in scatter_places(numbers, at, origin):
        trial, rest = guess.copy(), left
        while (link := _adrift(mechanism, rest)) is not None:  # several, where guides alone join them
            trial.points[next(iter(numbers.local[link]))] = place
            trial, after = _chain_links(mechanism, numbers, rest, trial)
            if after == rest:
                break
            rest = after
        carried = {point for link in group.links for point in numbers.local[link]}
        for point in group.points:
            if point not in carried:  # of a slider that only guides hold
                trial.points.setdefault(point, place)
        if rest or any(point not in trial.points for point in group.points):
            raise _missing_angle_error(mechanism, group, rest or left)
        trials.append(trial)
    return trials


def _adrift(mechanism: Mechanism, links: Sequence[str]) -> str | None:
    """The first of links whose initial angle is known; None where there is none."""
    return next((link for link in links if mechanism.initial_angle(link) is not None), None)


def _chain_links(
    mechanism: Mechanism, numbers: Dimensions, links: Sequence[str], guess: Positions
) -> tuple[Positions, list[str]]:
    """A guess with links put by their initial angles, link by link from what is known; and those left over."""
    left = list(links)
    while ready := [link for link in left if _pose_link(mechanism, numbers, link, guess)]:
        left = [link for link in left if link not in ready]
    return guess, left


def _pose_link(mechanism: Mechanism, numbers: Dimensions, link: str, guess: Positions) -> bool:
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
        pose = space.normalise(ARRAYS, space.pose_by_two_points(ARRAYS, *ends))
    if pose is None:
        return False
    guess.poses[link] = pose
    if link in numbers.ends and is_measured(numbers, guess, link):
        cosine, sine = rotor_of_angle(ARRAYS, numbers, guess, link)
        near = angle or 0.0
        # the angle keeps the turn of the initial angle that was given
        guess.angles[link] = near + remainder(float(np.arctan2(sine, cosine)) - near, tau)
    for point, at_rest in local.items():
        if point not in guess.points:
            guess.points[point] = space.place(ARRAYS, pose, at_rest)
    return True


def _missing_angle_error(mechanism: Mechanism, group: Newton, left: list[str]) -> InputError:
    without = [link for link in left if mechanism.initial_angle(link) is None]
    return InputError(
        name_of(group),
        _("it is a group of higher class: its initial angles select one of its positions"),
        _("give the initial angle of {links}").format(links=", ".join(without or left)),
    )


def _does_not_close(system: GroupSystem, start: Array) -> InputError:
    gap = system.gap(start)[0] * system.numbers.scale
    return InputError(
        name_of(system.group),
        _("no closed position is near the initial angles: a gap of {gap} remains").format(
            gap=f"{float(gap):.3g} {system.numbers.space.unit}"
        ),
        _("correct the initial angles, a length, or the start of the drive"),
    )
