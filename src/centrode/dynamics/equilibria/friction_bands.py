"""Where dry friction holds a mechanism: intervals of positions with one degree of freedom, bounds with more.

Friction of at most R along s holds against a generalised force Q while |Q| <= sum of R |ds/dq| over all contacts.
With more degrees of freedom a departure x from an equilibrium that forces f of friction keep up has k x = N' S f with
|f| <= R: to the first order each coordinate departs by at most the sum of what the contacts give it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt
from scipy.optimize import brentq

from centrode.dynamics.equilibria.configuration_curve import STEP, ConfigurationCurve, same_position
from centrode.dynamics.equilibria.equilibrium_search import Equilibria
from centrode.dynamics.equilibria.linear_equations import LoadedMechanism
from centrode.dynamics.equilibria.pressed_friction import held_by_friction, pressed_joints

Array: TypeAlias = npt.NDArray[np.float64]

FIRST = 1e-6
"""The first step from an equilibrium [rad, or of the greatest length]; steps double up to those of the curve."""
MOST_STEPS = 4000


@dataclass(frozen=True)
class FrictionBand:
    """An interval of positions in which dry friction holds.

    Attributes
    ----------
    ends : (2, coordinates) [rad or m], in the sense of the curve
    whole : friction holds in every position
    feeds_itself : frictions could make one another grow, so that slip may be possible there as well as rest
    """

    ends: Array
    whole: bool = False
    feeds_itself: bool = False


def friction_bands(equilibria: Equilibria) -> tuple[FrictionBand, ...]:
    """The intervals in which dry friction holds a mechanism with one degree of freedom; none without friction."""
    curve, loaded = equilibria.curve, equilibria.loaded
    if curve is None or not loaded.has_friction:
        return ()
    spare = curve.friction - np.abs(curve.force)
    if np.all(spare >= 0.0):
        return (FrictionBand(curve.places[[0, -1]], True, _feeds_itself(loaded, curve.places)),)
    seeds = [*equilibria.places, *(curve.places[run[len(run) // 2]] for run in _runs(spare >= 0.0))]
    bands: list[FrictionBand] = []
    for seed in seeds:
        if not _spare(loaded, seed) >= 0.0 or any(_same_as_seed(loaded, band, seed, curve) for band in bands):
            continue
        tangent = _tangent(loaded, seed, curve)
        ends = np.array([_end(loaded, seed, -tangent), _end(loaded, seed, tangent)])
        if not any(np.max(same_position(loaded, band.ends, ends[0])[:1]) < 1e-7 for band in bands):
            within = curve.places[_numbers_within(curve, ends)]
            bands.append(FrictionBand(ends, False, _feeds_itself(loaded, np.concatenate([ends, within]))))
    return tuple(bands)


def friction_reach(loaded: LoadedMechanism, places: Array) -> Array:
    """How far each coordinate may depart (n, coordinates) from equilibria before friction no longer holds, linearised.

    Infinite where the stiffness vanishes.
    """
    found = loaded.at(places)
    free = loaded.free_directions(found.rows)
    stiffness = np.einsum("ncm,ncd,nde->nme", free, found.stiffness, free)
    along, sizes = found.along, np.abs(found.friction)
    if loaded.equations.contacts:
        # friction that the reactions without it make: it changes them in the second order alone
        joints = pressed_joints(loaded, places, found)
        along, sizes = joints.along, joints.greatest(np.zeros_like(joints.sizes), np.zeros(len(places)))
    contacts = np.einsum("ncm,nfc->nmf", free, along)
    with np.errstate(all="ignore"):
        moved = free @ np.linalg.pinv(stiffness, 1e-12) @ contacts
    return np.asarray(np.einsum("ncf,nf->nc", np.abs(moved), sizes))


def _feeds_itself(loaded: LoadedMechanism, places: Array) -> bool:
    """Whether friction by coefficients could make itself grow at one of some positions (n, coordinates)."""
    if not loaded.equations.contacts:
        return False
    return bool(np.any(pressed_joints(loaded, places, loaded.at(places)).feedback() >= 1.0))


def _numbers_within(curve: ConfigurationCurve, ends: Array) -> npt.NDArray[np.intp]:
    """Numbers of the places of a curve from one end of a band to the other."""
    first, last = (int(np.argmin(same_position(curve.loaded, curve.places, one))) for one in ends)
    count = len(curve.places)
    return np.arange(first, last + 1 if first <= last else last + 1 + count) % count


def friction_share(equilibria: Equilibria) -> float:
    """Share of the friction that keeps the initial position, with one degree of freedom; above 1 it does not hold."""
    curve = equilibria.curve
    if curve is None or not equilibria.loaded.has_friction:
        return float("nan")
    load, most = abs(float(curve.force[curve.start])), float(curve.friction[curve.start])
    return load / most if most > 0.0 else float("inf") if load else 0.0


def _runs(holds: npt.NDArray[np.bool_]) -> list[Array]:
    """Numbers of neighbours for which something holds, run by run."""
    numbers = np.flatnonzero(holds)
    if not len(numbers):
        return []
    return list(np.split(numbers, np.flatnonzero(np.diff(numbers) > 1) + 1))


def _tangent(loaded: LoadedMechanism, place: Array, curve: ConfigurationCurve) -> Array:
    """The free direction at a place of a curve, in its sense."""
    _left, rows = loaded.closures_at(place[None])
    along = loaded.free_directions(rows)[0, :, 0]
    nearest = int(np.argmin(same_position(loaded, curve.places, place)))
    same = np.dot(along / loaded.units, curve.tangents[nearest] / loaded.units) > 0.0
    return np.asarray(along if same else -along)


def _spare(loaded: LoadedMechanism, place: Array) -> float:
    """How much more friction could hold [J per unit along the free direction]; below zero it does not."""
    found = loaded.at(place[None])
    free = loaded.free_directions(found.rows)[:, :, 0]
    friction = float(held_by_friction(loaded, place[None], found, free)[0])
    return friction - abs(float(found.force[0] @ free[0]))


def _end(loaded: LoadedMechanism, seed: Array, tangent: Array) -> Array:
    """The position along a sense beyond which friction no longer holds."""
    place, along, step = seed, tangent, FIRST
    for _step in range(MOST_STEPS):
        ahead = _ahead(loaded, place, along)
        if _spare(loaded, ahead(step)) < 0.0:
            least = brentq(lambda far: _spare(loaded, ahead(far)), 0.0, step, xtol=1e-16, rtol=1e-14)  # noqa: B023
            return ahead(float(least))
        moved = ahead(step)
        _left, rows = loaded.closures_at(moved[None])
        turned = loaded.free_directions(rows)[0, :, 0]
        same = np.dot(turned / loaded.units, along / loaded.units) > 0.0
        place, along, step = moved, turned if same else -turned, min(STEP, 2.0 * step)
    return place


def _ahead(loaded: LoadedMechanism, place: Array, along: Array) -> Callable[[float], Array]:
    unit = along / np.max(np.abs(along / loaded.units))
    return lambda far: loaded.closed_coordinates(place + far * unit)


def _same_as_seed(
    loaded: LoadedMechanism, band: FrictionBand, seed: Array, curve: ConfigurationCurve
) -> bool:
    """Whether a position lies within a band: between the numbers of its ends on the curve."""
    numbers = [int(np.argmin(same_position(loaded, curve.places, one))) for one in (*band.ends, seed)]
    first, last, own = numbers
    return first <= own <= last if first <= last else (own >= first or own <= last)
