"""Positions in which a mechanism stays under its loads: all that are found from many starts, and how stable they are.

Along the free directions N of the closures (G N = 0) the generalised force N' F vanishes there. With one degree of
freedom it is looked at along the whole curve of positions. With more, positions that are walked to from the initial one
are starts of Newton's method with the exact stiffness, at once and behind steps down in energy along all but some
directions. Each step is short and closed again, so what is found can be reached without taking the mechanism apart.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.equilibria.configuration_curve import (
    ConfigurationCurve,
    configuration_curve,
    coordinate_values,
    position_distance,
    uncounted_angles,
)
from centrode.dynamics.equilibria.linear_equations import LinearEquations, LoadedMechanism
from centrode.dynamics.forward_dynamics.contacts import StopPush, stop_coordinate
from centrode.dynamics.loads import Situation
from centrode.errors import InputError, MotionError
from centrode.locale import _, ngettext
from centrode.numerics.arrays import ARRAYS

Array: TypeAlias = npt.NDArray[np.float64]

LANES, PACES, PACE = 60, 20, 0.5
"""Walks from the initial position, positions of each, and how far these are apart [rad, or of the greatest length]."""
ITERATIONS = 80
APPROACHES = 40
MOST_UNSTABLE = 4
"""Unstable directions of equilibria that are sought on purpose; with more they are found by Newton's method alone."""
LONGEST = 0.2
"""A step [rad, or of the greatest length]."""
SETTLED = 1e-11
"""Newton's method has come to its end where a step is shorter than this."""
NEARLY = 1e-7
"""So short steps count too where rounding keeps them from becoming shorter."""
BALANCED = 1e-9
"""Share of the forces that may be left at an equilibrium."""
SAME = 1e-6
"""Equilibria nearer than this are one."""
HALVINGS = 45
"""Of a pace along the curve, down to rounding."""
STATES_EVERY, STATE_STEPS = 5, 3
"""Every so many places of a curve are starts where controllers have states, and corrections of these states."""
IDLE = 1e-12
"""Forces below this share of weights and springs are none."""


@dataclass(frozen=True)
class Equilibria:
    """Equilibria of a mechanism.

    Attributes
    ----------
    loaded : of which mechanism
    places : (n, coordinates) [rad or m], from the nearest to the initial position to the farthest
    starts : positions from which they were sought
    curve : all positions of a mechanism with one degree of freedom; None with more
    """

    loaded: LoadedMechanism
    places: Array
    starts: int
    curve: ConfigurationCurve | None


def find_equilibria(loaded: LoadedMechanism) -> Equilibria:
    """All equilibria that are found from the initial position and many others that it can be brought to.

    Raises
    ------
    InputError
        Nothing can move, or nothing acts.
    MotionError
        No equilibrium is found, and there is neither a stop on which one could rest nor friction that holds.
    """
    if not loaded.mobility:
        what = _("nothing can move: all drives are held, or it has no degree of freedom")
        raise InputError("hold", what, _("hold fewer drives"))
    curve = configuration_curve(loaded) if loaded.mobility == 1 else None
    if curve is None:
        starts = walked_positions(loaded)
    else:
        starts = curve.places[::STATES_EVERY] if loaded.states else _starts_on(curve)
    _check_forces(loaded, curve.places if curve is not None else starts)
    if curve is not None and not loaded.states:
        _check_gap(curve)
    if loaded.states:
        # force and position say nothing without the states of controllers
        curve, starts = None, with_states(loaded, starts)
    found = settled_equilibria(loaded, starts)
    if curve is None and not loaded.states:
        found = np.concatenate([found, settled_equilibria(loaded, approached_positions(loaded, starts[::2]))])
    round_trip = np.zeros(loaded.size) if curve is None else curve.round_trip
    places = within_stops(loaded, _distinct(loaded, found[np.isfinite(found[:, 0])], round_trip))
    if not len(places) and not loaded.mechanism.stops and not loaded.has_friction:
        raise no_equilibrium(loaded, len(starts) if curve is None else len(curve.places))
    count = len(curve.places) if curve is not None else len(starts)
    return Equilibria(loaded, places, count, curve)


def no_equilibrium(loaded: LoadedMechanism, count: int) -> MotionError:
    """The error of a mechanism that stays nowhere, from so many positions."""
    what = ngettext(
        "no equilibrium is found from {n} position", "no equilibrium is found from {n} positions", count
    )
    repair = _("let springs, weights or friction hold it, or hold a drive (hold: DRIVE=VALUE)")
    if loaded.states:
        what = ngettext(
            "no equilibrium is found from {n} position in which the states of controllers rest too",
            "no equilibrium is found from {n} positions in which the states of controllers rest too",
            count,
        )
        repair = _(
            "let the controllers reach their targets: see most, and what is between the drive and its target"
        )
    return MotionError("", what.format(n=count), repair)


def walked_positions(loaded: LoadedMechanism) -> Array:
    """Positions (n, coordinates) that random walks from the initial one reach, the initial one first."""
    generator = np.random.default_rng(30)
    lanes = np.tile(loaded.start, (LANES, 1))
    found = [loaded.start[None]]
    way = np.zeros((LANES, loaded.mobility))
    for _pace in range(PACES):
        _left, rows = loaded.closures_at(lanes)
        free = loaded.free_directions(rows)[:, :, : loaded.mobility]
        # walks go on as they did, more or less, so that they come far
        way = 0.7 * way + generator.normal(size=way.shape)
        moved = np.einsum("ncm,nm->nc", free, way)
        longest = np.max(np.abs(moved / loaded.units), axis=1)
        ahead = loaded.closed_coordinates(lanes + moved * (PACE / longest)[:, None])
        far = np.max(np.abs((ahead - lanes) / loaded.units), axis=1)
        reached = far < 2.0 * PACE
        lanes = np.where(reached[:, None], ahead, lanes)
        way = np.where(reached[:, None], way, -way)
        found.append(lanes[reached])
    return np.concatenate(found)


def _starts_on(curve: ConfigurationCurve | None) -> Array:
    """Positions at which the force along the curve changes its sign, or is least in size."""
    assert curve is not None
    force = curve.force
    size = np.abs(force)
    starts = [curve.loaded.start]
    here, there = force[:-1], force[1:]
    turns = np.flatnonzero((here < 0.0) != (there < 0.0))
    if has_kinks(curve.loaded):
        # from beside a kink Newton's method sees another stiffness than that where the force vanishes
        starts += list(_places_by_halving(curve, turns))
    else:
        share = (here / np.where(here == there, 1.0, here - there))[turns, None]
        starts += list(curve.places[turns] + share * (curve.places[turns + 1] - curve.places[turns]))
    least = np.flatnonzero((size[1:-1] <= size[:-2]) & (size[1:-1] <= size[2:])) + 1
    starts += list(curve.places[least])
    return np.array(starts)


def _check_gap(curve: ConfigurationCurve) -> None:
    """Refuse a stretch in which nothing acts, as between two buffers: each of its positions is an equilibrium."""
    loaded = curve.loaded
    idle = np.flatnonzero(np.abs(curve.force) <= IDLE * np.max(np.abs(curve.force), initial=0.0))
    runs = [run for run in np.split(idle, np.flatnonzero(np.diff(idle) > 1) + 1) if len(run) > 2]
    if not runs:
        return
    first, last = sorted(float(curve.places[k, 0]) for k in (runs[0][0], runs[0][-1]))
    what = _(
        "nothing acts from about {first:.3g} to {last:.3g} {unit} of {name}: every position there is an equilibrium"
    )
    one = loaded.coordinates[0]
    text = what.format(first=first, last=last, unit=one.unit, name=one.name)
    raise InputError("[[loads]]", text, _("add gravity, springs or other loads"))


def has_kinks(loaded: LoadedMechanism) -> bool:
    """Whether the stiffness jumps where a compliant stop closes, or a controller reaches its bound."""
    stops, controls = loaded.mechanism.stops, loaded.equations.controls
    return any(not stop.is_rigid for stop in stops) or any("most" in one.gains for one in controls)


def _places_by_halving(curve: ConfigurationCurve, turns: npt.NDArray[np.intp]) -> Array:
    """Positions (turns, coordinates) of a curve where the force behind each of some places vanishes, by halving."""
    first, last = curve.places[turns], curve.places[turns + 1]
    sign = np.sign(curve.force[turns])
    for _halving in range(HALVINGS if len(turns) else 0):
        middle = curve.loaded.closed_coordinates(0.5 * (first + last))
        force = np.einsum("nc,nc->n", curve.loaded.at(middle).force, curve.tangents[turns])
        same = (np.sign(force) == sign)[:, None]
        first, last = np.where(same, middle, first), np.where(same, last, middle)
    return 0.5 * (first + last)


def force_scale(loaded: LoadedMechanism, places: Array) -> float:
    """What generalised forces are compared with [J]: the greatest at some positions, or a unit away from them."""
    found, joints = loaded.at(places), loaded.joints
    force = np.abs(found.force * loaded.units)[:, :joints]
    stiffness = np.abs(found.stiffness * np.outer(loaded.units, loaded.units))[:, :joints, :joints]
    sizes = [np.max(one[np.isfinite(one)], initial=0.0) for one in (force, stiffness)]
    return float(max(sizes))


def _check_forces(loaded: LoadedMechanism, places: Array) -> None:
    """Refuse what stays everywhere, because nothing acts along what can move."""
    found, joints = loaded.at(places), loaded.joints
    force = np.einsum("nc,ncm->nm", found.force[:, :joints], loaded.free_directions(found.rows)[:, :joints])
    # a spring of no length has no direction there
    scale = float(np.nanmax(np.abs(found.force * loaded.units)[:, :joints], initial=0.0))
    if not np.nanmax(np.abs(force), initial=0.0) > IDLE * scale:
        what = _("no load acts along what can move: every position is an equilibrium")
        raise InputError("[[loads]]", what, _("add gravity, springs or other loads"))


def approached_positions(loaded: LoadedMechanism, starts: Array) -> Array:
    """Positions behind steps towards equilibria with no, one, two... unstable directions, by turns.

    Steps go down along all directions but so many of the least stiffness, along which they go up (the gentlest ascent:
    W. E and X. Zhou, Nonlinearity 24, 2011).
    """
    places, count = starts.copy(), loaded.mobility
    unstable = np.arange(len(starts)) % (min(count, MOST_UNSTABLE) + 1)
    senses = np.where(np.arange(count) < unstable[:, None], -1.0, 1.0)
    for _step in range(APPROACHES):
        found = loaded.at(places)
        free = loaded.free_directions(found.rows)
        force, stiffness = _reduced_system(found.residual, found.stiffness, free)
        sizes, vectors = np.linalg.eigh(np.nan_to_num(0.5 * (stiffness + stiffness.transpose(0, 2, 1))))
        floor = 1e-6 * np.max(np.abs(sizes), axis=1, initial=1e-300)[:, None]
        along = senses * np.einsum("nij,ni->nj", vectors, force) / np.maximum(np.abs(sizes), floor)
        places = _moved_positions(loaded, places, free, np.einsum("nij,nj->ni", vectors, along), None)[0]
    return places


def settled_equilibria(
    loaded: LoadedMechanism, starts: Array, numbers: Mapping[str, float] | None = None
) -> Array:
    """Equilibria (n, coordinates) that Newton's method reaches from positions; NaN where it reaches none."""
    scale = force_scale(loaded, loaded.closed_coordinates(starts, numbers)) or 1.0
    places = loaded.closed_coordinates(starts, numbers)
    longest = np.full(len(places), np.inf)
    left = np.flatnonzero(np.isfinite(places[:, 0]))
    for _step in range(ITERATIONS):
        if not len(left):
            break
        found = loaded.at(places[left], numbers=numbers)
        free = loaded.free_directions(found.rows)
        force, stiffness = _reduced_system(found.residual, found.stiffness, free)
        along = np.einsum("nij,nj->ni", np.linalg.pinv(np.nan_to_num(stiffness), 1e-12), force)
        places[left], longest[left] = _moved_positions(loaded, places[left], free, along, numbers)
        left = left[~(longest[left] < SETTLED)]
    settling = np.flatnonzero(longest < NEARLY)
    if len(settling):
        found = loaded.at(places[settling], numbers=numbers)
        free = loaded.free_directions(found.rows)
        force = np.abs(np.einsum("nc,ncm->nm", found.residual, free))[:, : loaded.mobility]
        settling = settling[
            (np.max(force, axis=1, initial=0.0) <= BALANCED * scale) & _states_rest(loaded, found)
        ]
    found_ones = np.zeros(len(places), dtype=bool)
    found_ones[settling] = True
    places[~found_ones] = np.nan
    return places


def _states_rest(loaded: LoadedMechanism, found: LinearEquations) -> npt.NDArray[np.bool_]:
    """Whether the states of controllers change (n) by no more than by rounding of what they depend on."""
    joints = loaded.joints
    bent = np.abs(found.stiffness[:, joints:] * loaded.units)
    return np.asarray(
        np.all(np.abs(found.residual[:, joints:]) <= BALANCED * np.max(bent, axis=2, initial=0.0), axis=1)
    )


def with_states(loaded: LoadedMechanism, places: Array) -> Array:
    """Positions (n, coordinates) with states of controllers that come nearest to rest there, and to balance."""
    joints, places = loaded.joints, places.copy()
    for _step in range(STATE_STEPS):
        found = loaded.at(places)
        free = loaded.free_directions(found.rows)
        force, stiffness = _reduced_system(found.residual, found.stiffness, free)
        change = np.linalg.pinv(np.nan_to_num(stiffness[:, :, loaded.mobility :]), 1e-9)
        moved = np.einsum("nij,nj->ni", change, np.nan_to_num(force))
        places[:, joints:] += moved * loaded.units[joints:]
    return places


def _reduced_system(residual: Array, stiffness: Array, free: Array) -> tuple[Array, Array]:
    """Force and stiffness along the free directions."""
    return (
        np.einsum("nc,ncm->nm", residual, free),
        np.einsum("ncm,ncd,nde->nme", free, stiffness, free),
    )


def _moved_positions(
    loaded: LoadedMechanism, places: Array, free: Array, along: Array, numbers: Mapping[str, float] | None
) -> tuple[Array, Array]:
    """Positions behind a step, closed, and how long the step is; a long one is cut."""
    step = np.einsum("ncm,nm->nc", free, along)
    sizes = np.abs(step / loaded.units)
    # states of controllers may be far away, and are compared with their own size
    sizes[:, loaded.joints :] /= np.maximum(1.0, np.abs(places / loaded.units)[:, loaded.joints :])
    whole = np.max(sizes, axis=1, initial=0.0)
    longest = np.max(sizes[:, : loaded.joints], axis=1, initial=0.0)
    with np.errstate(all="ignore"):
        step = step * np.minimum(1.0, LONGEST / np.maximum(longest, 1e-300))[:, None]
    ahead = loaded.closed_coordinates(places + step, numbers)
    # where it does not close it stays, and tries the other side
    lost = ~np.isfinite(ahead[:, 0])
    ahead[lost] = places[lost]
    return ahead, np.where(lost, np.inf, whole)


def stop_values(loaded: LoadedMechanism, places: Array) -> Array:
    """Coordinates of all stops (n, stops) [rad or m] at positions (n, coordinates)."""
    stops = loaded.mechanism.stops
    return coordinate_values(loaded, [stop_coordinate(loaded.mechanism, stop) for stop in stops], places)


def stop_pushes(loaded: LoadedMechanism, places: Array) -> Array:
    """Forces of compliant stops along their coordinates (n, stops) [N m or N] at rest; zero of rigid ones."""
    stops, values = loaded.mechanism.stops, stop_values(loaded, places)
    found = np.zeros_like(values)
    for k, stop in enumerate(stops):
        if not stop.is_rigid:
            law = StopPush(stop.least, stop.most, stop.stiffness, stop.damping or 0.0)
            found[:, k] = law(Situation(0.0, np.nan, values[:, k], 0.0, 0.0, ARRAYS))
    return found


def within_stops(loaded: LoadedMechanism, places: Array) -> Array:
    """Those of some positions (n, coordinates) that no rigid stop forbids."""
    if not loaded.mechanism.stops or not len(places):
        return places
    low, high = (
        np.array([away if bound is None else float(bound) for bound in bounds])
        for away, bounds in (
            (-np.inf, [stop.least if stop.is_rigid else None for stop in loaded.mechanism.stops]),
            (np.inf, [stop.most if stop.is_rigid else None for stop in loaded.mechanism.stops]),
        )
    )
    values = stop_values(loaded, places)
    return places[np.all((low <= values) & (values <= high), axis=1)]


def _distinct(loaded: LoadedMechanism, places: Array, round_trip: Array) -> Array:
    """Equilibria without repetitions, in the turns nearest to the initial position, the nearest first.

    `round_trip` has whole turns that change nothing together: wheels that mesh come back to their teeth after several
    turns of each.
    """
    if not len(places):
        return places
    begin = loaded.start
    turns = 2.0 * np.pi * np.round((places - begin) / (2.0 * np.pi))
    places = np.where(uncounted_angles(loaded), places - turns, places)
    if round_trip.any():
        rounds = np.round((places - begin) @ round_trip / (round_trip @ round_trip))
        places = places - np.outer(rounds, round_trip)
    # links may turn together with nothing changed too: of positions that are one the nearest is kept
    apart = np.max(np.abs((places - begin) / loaded.units), axis=1)
    places = places[np.argsort(apart, kind="stable")]
    kept: list[int] = []
    for k in range(len(places)):
        if not kept or np.min(position_distance(loaded, places[kept], places[k])) > SAME:
            kept.append(k)
    places = places[kept]
    return np.asarray(places[np.argsort(position_distance(loaded, places, begin), kind="stable")])
