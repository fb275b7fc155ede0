"""A choice proved along the path itself: its bounds on many angles, and that no neighbour is better.

The search uses its own paths (`tried`); here stand those that everything else is computed from.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.stats import qmc

from centrode.cams.choosing.families import contact_of, given_value, working_arc
from centrode.cams.choosing.measures import ALWAYS, MEASURES
from centrode.cams.choosing.tried import Tried
from centrode.cams.described import path_of
from centrode.errors import InputError
from centrode.model.cams.description import Cam, varied

Array = NDArray[np.float64]

ANGLES = 7201
NEAR_ANGLES = 721
DISTANCES = (1e-1, 1e-2, 1e-3, 1e-4, 1e-5)
"""Of neighbours, as parts of the ranges of the parameters."""
EACH = 24
"""Neighbours at each distance."""
ROUNDING = 1e-8
"""A neighbour is better where it is so by more than this part: bounds are kept to 1e-9, and multiplied."""


@dataclass(frozen=True)
class Proof:
    """What was found along the path.

    Attributes
    ----------
    values : mapping of name -> float
        Worst values in SI.
    excess : float
        Greatest miss of a bound, as a part of it; not positive where all are kept to rounding.
    neighbours, admissible : int
        Designs near by that were looked at, and how many of them keep the bounds.
    gain : float
        By which part the best of them is better than the chosen one; not positive at an optimum.
    better : Cam or None
        That neighbour, where it is better.
    """

    values: Mapping[str, float]
    excess: float
    neighbours: int
    admissible: int
    gain: float
    better: Cam | None = None


def prove(cam: Cam, bounds: Mapping[str, float], best: str) -> Proof:
    """Look at a chosen cam and its neighbours, along their paths."""
    assert cam.choose is not None
    values = measures_of(cam, ANGLES)
    own = MEASURES[best].sign * values[best]
    near = _neighbours(cam)
    gain, better, admissible = -math.inf, None, 0
    for one in near:
        found = measures_of(one, NEAR_ANGLES)
        if excess_of(found, bounds) <= 0:
            admissible += 1
            by = (own - MEASURES[best].sign * found[best]) / (abs(own) or 1.0)
            gain, better = (by, one) if by > gain else (gain, better)
    kept = better if gain > ROUNDING else None
    return Proof(values, excess_of(values, bounds), len(near), admissible, gain, kept)


def measures_of(cam: Cam, angles: int) -> dict[str, float]:
    """Worst values in SI of all measures of a cam over its working arc; NaN where it has no such path."""
    contact = contact_of(cam)
    names = [name for name in (*MEASURES, *ALWAYS) if name != "stress" or contact is not None]
    low, high = working_arc(cam)
    mirrored = cam.curvature.symmetric
    try:
        path = path_of(cam)
    except InputError:
        return dict.fromkeys(names, math.nan)
    phi = np.unique(np.append(np.linspace(0.0 if mirrored else low, high, angles), 0.0))
    radius = cam.roller.radius if cam.roller is not None else 0.0
    rho, gamma, curvature = (
        one[:, None] for one in (path.radius(phi)[0], path.pressure_angle(phi), path.curvature(phi)[0])
    )
    tried = Tried(phi, rho, gamma, curvature, np.array([radius]), mirrored)
    if not np.isfinite(rho * gamma * curvature).all():
        return dict.fromkeys(names, math.nan)
    every = {**MEASURES, **{name: measure for name, (measure, _bound) in ALWAYS.items()}}
    return {name: every[name].sign * float(every[name].of(tried, contact).max()) for name in names}


def excess_of(values: Mapping[str, float], bounds: Mapping[str, float]) -> float:
    """Greatest miss of a bound, as a part of it; infinite where there is no path."""
    limits = dict(ALWAYS) | {name: (MEASURES[name], bound) for name, bound in bounds.items()}
    missed = [
        measure.sign * (values[name] - bound) / (abs(bound) or 1.0)
        for name, (measure, bound) in limits.items()
    ]
    return max(math.inf if math.isnan(one) else one for one in missed)


def _neighbours(cam: Cam) -> list[Cam]:
    """Designs at growing distances in all directions, inside the ranges of the parameters."""
    assert cam.choose is not None
    names = tuple(cam.choose.parameters)
    ends = np.array([cam.choose.parameters[name] for name in names], dtype=float)
    low, width = ends[:, 0], ends[:, 1] - ends[:, 0]
    share = (np.array([given_value(cam, name) for name in names]) - low) / width
    directions = 2 * qmc.Halton(len(names), scramble=False).random(EACH + 1)[1:] - 1
    found = []
    for distance in DISTANCES:
        for place in np.clip(share + distance * directions, 0.0, 1.0):
            values = dict(zip(names, (low + place * width).tolist(), strict=True))
            try:
                found.append(varied(cam, values))
            except InputError:
                continue
    return found
