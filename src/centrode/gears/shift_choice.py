"""Shifts by their purpose: no undercut, equal sliding, least sliding, strength, the standard, a centre distance."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import minimize

from centrode.errors import InputError, MotionError
from centrode.gears.blocking_contour import (
    BLOCKING,
    margins_at,
    margins_of,
    sliding_difference,
    sliding_size,
    with_shifts,
)
from centrode.gears.involutes import Array
from centrode.gears.pair_geometry import PairGeometry
from centrode.gears.recommended_shifts import recommended_row
from centrode.gears.shift_fields import ShiftFields, shift_fields
from centrode.geometry.involute import involute
from centrode.locale import _, mark
from centrode.model.gear_pairs import Application
from centrode.numerics.search import interpolated_roots

_NO_SHIFTS = mark("no shifts of these wheels keep contact ratio, tips and flanks within their bounds")
GRID = 41
"""Nodes along each shift, or along their sum, from which a search begins."""
LEAST_SHIFT, MOST_SHIFT = -1.0, 2.0
"""Between them shifts are sought."""


def shift_sum_at(pair: PairGeometry, centre_distance: float) -> float:
    """x_1 + x_2 (internal: x_2 - x_1) with which wheels mesh without play at a centre distance [m].

    Raises InputError where the base circles do not allow the distance.
    """
    cosine = pair.pitch_distance * math.cos(pair.transverse.pressure_angle) / centre_distance
    if not 0 < cosine <= 1:
        least = pair.pitch_distance * math.cos(pair.transverse.pressure_angle)
        what = _("at this centre distance the flanks do not touch: it has to be greater than {least:.9g} m")
        raise InputError(
            "centre_distance",
            what.format(least=least),
            _("without shift it is {a:.9g} m").format(a=pair.pitch_distance),
        )
    difference = involute(math.acos(cosine)) - involute(pair.transverse.pressure_angle)
    return difference * pair.teeth_sum / (2 * math.tan(pair.rack.pressure_angle))


def chosen_shifts(
    pair: PairGeometry,
    purpose: str,
    centre_distance: float | None = None,
    application: Application = "power",
) -> tuple[float, float]:
    """Both shifts for a purpose.

    Parameters
    ----------
    pair : whose shifts are chosen; those it has are ignored
    purpose : one of `model.gear_pairs.PURPOSES`
        "no undercut": the least shift of the pinion that avoids it (zero where none is needed), taken back on the
        wheel where that allows it, so that the centre distance stays. "equal sliding": the greatest specific sliding is
        equal on both wheels, on the line of the centre distance, or of the sum that "no undercut" has. "least sliding":
        the greater one of both is least. "strength": the relative radius of curvature at the pitch point is greatest.
        These two keep a contact ratio of 1.2, tips of 0.25 m, no undercut and no interference. "standard": as
        GOST 16532-70 recommends for spur external pairs of its rack, the pinion first; the bounds of the numbers of
        teeth are those of textbooks and were not compared with the printed standard.
    centre_distance : [m]; the sum of the shifts follows from it
    application : what the pair is for; of "standard" alone

    Raises
    ------
    MotionError
        No shifts keep these bounds.
    InputError
        A centre distance that cannot be; a pair of which the recommendation says nothing.
    """
    total = None if centre_distance is None else shift_sum_at(pair, centre_distance)
    if purpose == "no undercut":
        return _without_undercut(pair, total)
    if purpose == "standard":
        return recommended_row(pair.teeth, application, total).shifts(total or 0.0)
    if purpose == "equal sliding":
        if total is None:
            plain = _without_undercut(pair, None)
            total = plain[1] + pair.sign * plain[0]
        return _equal_sliding(pair, total)
    goal = _greatest_sliding if purpose == "least sliding" else _curvature
    return _best(pair, goal, total)


def shifts_of_sum(pair: PairGeometry, first: float, total: float) -> tuple[float, float]:
    """Both shifts by that of the pinion and their sum, which is a difference where the wheel is internal."""
    return first, total - pair.sign * first


def _least(pair: PairGeometry, number: int) -> float:
    value = pair.wheels[number].least_shift
    return -math.inf if math.isnan(value) else value


def _without_undercut(pair: PairGeometry, total: float | None) -> tuple[float, float]:
    bare = with_shifts(pair, 0.0, 0.0)
    least, other = _least(bare, 0), _least(bare, 1)
    first = max(0.0, least)
    if total is None:
        # An internal wheel and a rack follow the pinion; another wheel gives back as far as its own teeth allow.
        second = first if pair.kind == "internal" else max(-first, other)
        return first, second
    shifts = shifts_of_sum(pair, first, total)
    if shifts[1] < other:
        what = _(
            "at this centre distance a wheel is undercut: the sum of shifts is {total:.6g}, {least:.6g} is needed"
        )
        raise InputError("centre_distance", what.format(total=total, least=first + other), _("enlarge it"))
    return shifts


def _equal_sliding(pair: PairGeometry, total: float) -> tuple[float, float]:
    """On the line of a sum: sliding of the pinion falls with its own shift, that of the wheel rises."""

    def difference(first: Array) -> Array:
        return sliding_difference(shift_fields(pair, first, total - pair.sign * first))

    nodes = np.linspace(-MOST_SHIFT, MOST_SHIFT, 4 * GRID)
    values = difference(nodes)
    falls = np.flatnonzero((values[:-1] > 0) & (values[1:] <= 0) & np.isfinite(values[:-1] + values[1:]))
    roots = interpolated_roots(difference, nodes[falls], nodes[falls + 1])
    for first in roots[np.abs(difference(roots)) < 1e-9].tolist():
        shifts = shifts_of_sum(pair, first, total)
        if _is_possible(with_shifts(pair, *shifts)):
            return shifts
    what = _("no shifts of this sum, {total:.6g}, slide equally and can work")
    raise MotionError("shifts", what.format(total=total))


def _is_possible(pair: PairGeometry) -> bool:
    margins = margins_of(pair)
    return all(margins[name] > -1e-9 for name in BLOCKING)


def _greatest_sliding(fields: ShiftFields) -> Array:
    return np.asarray(np.maximum(*(sliding_size(sliding) for sliding in fields.sliding)))


def _curvature(fields: ShiftFields) -> Array:
    """Minus the relative radius of curvature at the pitch point, in modules."""
    return -fields.flatness


BOUNDS = (
    "undercut_1",
    "undercut_2",
    "interference_1",
    "interference_2",
    "tip_0.25_1",
    "tip_0.25_2",
    "contact_ratio_1.2",
)
"""Margins that a chosen pair keeps."""


def _bounds(pair: PairGeometry, first: ArrayLike, second: ArrayLike) -> Array:
    """Those margins (k, ...) over shifts (...): at least zero."""
    margins = margins_at(pair, first, second)
    return np.stack([np.nan_to_num(margins[name], nan=-1.0) for name in BOUNDS])


def _best(
    pair: PairGeometry, goal: Callable[[ShiftFields], Array], total: float | None
) -> tuple[float, float]:
    """The best shifts within the bounds: the best node of a grid, polished."""

    def shifts_at(free: Array) -> tuple[Array, Array]:
        """Both shifts (...) by what is free of them, (1, ...) or (2, ...)."""
        return (free[0], free[1]) if total is None else (free[0], total - pair.sign * free[0])

    def value_at(free: Array) -> Array:
        return goal(shift_fields(pair, *shifts_at(free)))

    line = np.linspace(LEAST_SHIFT, MOST_SHIFT, GRID)
    mesh = np.meshgrid(line, line, indexing="ij") if total is None else (line,)
    nodes = np.stack([axis.ravel() for axis in mesh])
    kept = nodes[:, (_bounds(pair, *shifts_at(nodes)) >= 0).all(axis=0)]
    if not kept.size:
        raise MotionError("shifts", _(_NO_SHIFTS))
    values = value_at(kept)
    start = kept[:, np.argmin(values)]
    step = float(line[1] - line[0])
    polished = minimize(
        lambda free: float(value_at(free)),
        start,
        method="SLSQP",
        bounds=[
            (max(LEAST_SHIFT, entry - 1.5 * step), min(MOST_SHIFT, entry + 1.5 * step)) for entry in start
        ],
        constraints={"type": "ineq", "fun": lambda free: _bounds(pair, *shifts_at(free))},
        options={"maxiter": 200, "ftol": 1e-13},
    )
    good = _bounds(pair, *shifts_at(polished.x)).min() >= -1e-9 and polished.fun <= values.min()
    first, second = shifts_at(polished.x if good else start)
    return float(first), float(second)
