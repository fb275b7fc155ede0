"""Following groups of higher class along the path, from the initial position outwards.

Steps choose themselves: the Taylor polynomial of an anchor foretells the next, Newton's method confirms it, and
the sign of the determinant must stay. Where it does not, or where steps become small, the group is followed by
the arc of its curve instead (`arcs`), which tells limits from change points.
"""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.kinematics.anchors import Anchor, Anchors, Trail
from centrode.kinematics.arcs import follow
from centrode.kinematics.branches import Event
from centrode.kinematics.newton import newton
from centrode.kinematics.surroundings import Surroundings
from centrode.kinematics.walkers import ORDER, Walkers, foretell, taylor

Array: TypeAlias = npt.NDArray[np.float64]
Lanes: TypeAlias = npt.NDArray[np.intp]

FIRST, GREATEST, LEAST = 0.02, 0.2, 0.004
"""Steps in the path's units: the first, the greatest, and the one below which the curve's arc is followed."""
TARGET, TRUST = 1e-4, 1e-2
"""Corrections that a foretold state should need, and the greatest that it may."""
CONTRACTION = 0.1
"""By how much the second Newton step must be smaller than the first."""


def trace(
    around: Surroundings, start: Array, initial: float, extent: tuple[float, float], smooth: bool
) -> tuple[Anchors, list[Event]]:
    """Anchors of a group from the states (lanes, width) in the initial position, and the events on the way."""
    lanes = len(start)
    both = np.tile(np.arange(lanes), 2)
    sense = np.repeat([-1.0, 1.0], lanes)
    trails = [Trail() for _ in both]
    ends = np.where(sense < 0.0, *extent)
    active = np.ones(2 * lanes, dtype=bool)
    walkers = Walkers(both, sense, ends, np.full(2 * lanes, FIRST), trails, active, smooth)
    everywhere = np.arange(2 * lanes)
    walkers.plant(around, everywhere, np.full(2 * lanes, initial), np.tile(start, (2, 1)))
    events: list[Event] = []
    while len(walkers.walking):
        stuck = _stride(around, walkers, walkers.walking)
        if len(stuck):
            events += follow(around, walkers, stuck)
    return Anchors(tuple(trails[:lanes]), tuple(trails[lanes:]), 2.0 * LEAST * around.unit), events


def _stride(around: Surroundings, walkers: Walkers, who: Lanes) -> Lanes:
    """One step of every walker; returns those that have to follow the arc of the curve."""
    last = walkers.last(who)
    offset = walkers.sense[who] * walkers.step[who] * around.unit
    parameter = np.array([anchor.parameter for anchor in last]) + offset
    known = around.known(parameter, walkers.lane[who], ORDER)
    system = around.system(known, walkers.lane[who])
    foretold = system.moved(np.array([anchor.state for anchor in last]), foretell(last, offset))
    found = newton(system, foretold)
    first, second = found.sizes[0], found.sizes[1]
    good = found.found & (first <= TRUST) & (second <= CONTRACTION * first + 1e-12)
    same = found.sense == np.array([anchor.sense for anchor in last])
    series = taylor(system, known, np.where(found.found[:, None], found.state, np.nan))
    good &= np.isfinite(series).all(axis=(1, 2))
    for k in np.nonzero(good & same)[0]:
        walker = who[k]
        walkers.set_anchor(
            walker, Anchor(float(parameter[k]), found.state[k], series[k], float(found.sense[k]))
        )
        longer = (TARGET / max(float(first[k]), 1e-300)) ** (1.0 / (ORDER + 1))
        walkers.step[walker] = min(walkers.step[walker] * np.clip(longer, 0.3, 2.0), GREATEST)
    crossed = good & ~same
    rest = who[~(good & same) & ~crossed]
    walkers.step[rest] *= 0.5
    return np.concatenate([who[crossed], rest[walkers.step[rest] < LEAST]])
