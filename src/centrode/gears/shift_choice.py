"""Shifts by their purpose: no undercut, equal sliding, least sliding, strength, a centre distance."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from scipy.optimize import brentq, minimize

from centrode.errors import InputError, MotionError
from centrode.gears.blocking_contour import (
    BLOCKING,
    margins_of,
    sliding_difference,
    with_shifts,
)
from centrode.gears.pair_geometry import PairGeometry
from centrode.geometry.involute import involute
from centrode.locale import _, mark

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
    pair: PairGeometry, purpose: str, centre_distance: float | None = None
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
        The last two keep a contact ratio of 1.2, tips of 0.25 m, no undercut and no interference.
    centre_distance : [m]; the sum of the shifts follows from it

    Raises
    ------
    MotionError
        No shifts keep these bounds.
    InputError
        A centre distance that cannot be.
    """
    total = None if centre_distance is None else shift_sum_at(pair, centre_distance)
    if purpose == "no undercut":
        return _without_undercut(pair, total)
    if purpose == "equal sliding":
        if total is None:
            plain = _without_undercut(pair, None)
            total = plain[1] + pair.sign * plain[0]
        return _equal_sliding(pair, total)
    goal = _greatest_sliding if purpose == "least sliding" else _flatness
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

    def difference(first: float) -> float:
        return sliding_difference(with_shifts(pair, *shifts_of_sum(pair, first, total)))

    nodes = np.linspace(-MOST_SHIFT, MOST_SHIFT, 4 * GRID)
    values = [difference(float(node)) for node in nodes]
    for low, high, left, right in zip(nodes, nodes[1:], values, values[1:], strict=False):
        if math.isfinite(left) and math.isfinite(right) and left > 0 >= right:
            first = float(brentq(difference, float(low), float(high), xtol=1e-14))
            shifts = shifts_of_sum(pair, first, total)
            if abs(difference(first)) < 1e-9 and _is_possible(with_shifts(pair, *shifts)):
                return shifts
    what = _("no shifts of this sum, {total:.6g}, slide equally and can work")
    raise MotionError("shifts", what.format(total=total))


def _is_possible(pair: PairGeometry) -> bool:
    margins = margins_of(pair)
    return all(margins[name] > -1e-9 for name in BLOCKING)


def _greatest_sliding(pair: PairGeometry) -> float:
    sizes = [abs(wheel.sliding) if wheel.sliding <= 0 else math.inf for wheel in pair.wheels]
    return max(sizes)


def _flatness(pair: PairGeometry) -> float:
    """Minus the relative radius of curvature at the pitch point, in modules."""
    radius = pair.pitch_curvature_radius
    return -float(1 / (1 / radius + pair.sign / pair.other_curvature_radius(radius))) / pair.module


def _bounds(pair: PairGeometry) -> list[float]:
    """Margins that a chosen pair keeps: at least zero."""
    margins = margins_of(pair)
    names = (
        "undercut_1",
        "undercut_2",
        "interference_1",
        "interference_2",
        "tip_0.25_1",
        "tip_0.25_2",
        "contact_ratio_1.2",
    )
    return [margins[name] if math.isfinite(margins[name]) else -1.0 for name in names]


def _best(
    pair: PairGeometry, goal: Callable[[PairGeometry], float], total: float | None
) -> tuple[float, float]:
    """The best shifts within the bounds: the best node of a grid, polished."""

    def shifts_at(free: np.ndarray[tuple[int], np.dtype[np.float64]]) -> tuple[float, float]:
        return (
            shifts_of_sum(pair, float(free[0]), total)
            if total is not None
            else (float(free[0]), float(free[1]))
        )

    line = np.linspace(LEAST_SHIFT, MOST_SHIFT, GRID)
    nodes = (
        [np.array([x]) for x in line] if total is not None else [np.array([x, y]) for x in line for y in line]
    )
    kept = [
        (goal(at), node) for node in nodes if min(_bounds(at := with_shifts(pair, *shifts_at(node)))) >= 0
    ]
    if not kept:
        raise MotionError("shifts", _(_NO_SHIFTS))
    value, start = min(kept, key=lambda one: one[0])
    step = float(line[1] - line[0])
    polished = minimize(
        lambda free: goal(with_shifts(pair, *shifts_at(free))),
        start,
        method="SLSQP",
        bounds=[
            (max(LEAST_SHIFT, entry - 1.5 * step), min(MOST_SHIFT, entry + 1.5 * step)) for entry in start
        ],
        constraints={"type": "ineq", "fun": lambda free: _bounds(with_shifts(pair, *shifts_at(free)))},
        options={"maxiter": 200, "ftol": 1e-13},
    )
    if min(_bounds(with_shifts(pair, *shifts_at(polished.x)))) >= -1e-9 and polished.fun <= value:
        return shifts_at(polished.x)
    return shifts_at(start)
