"""The return arc of a cam, designed: the smoothest curve within bounds of size and curvature that joins both ends."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from centrode.cams.closed.arcs import Arc, ClosedPath
from centrode.cams.closed.bounds import MOST, Bounds, Margins, bends, sizes, slants
from centrode.cams.closed.curves import Ends, ReturnCurve, roughness
from centrode.cams.closed.search import Search
from centrode.cams.frames import frames
from centrode.errors import InputError, MotionError
from centrode.locale import _
from centrode.numerics.search import Extremes

__all__ = ["Bounds", "Returned", "designed"]

ROUNDS = 8
"""Times that the bounds are tightened by what is missed between the nodes of the search."""


@dataclass(frozen=True)
class Returned:
    """A designed return arc and what it keeps.

    Attributes
    ----------
    curve : ReturnCurve
    closed : ClosedPath
    radius, curvature, pressure_angle : Extremes
        Of the arc: polar radius [m] and curvature [1/m] of the roller's path, pressure angle [rad].
    additions : int
        Functions added to the smoothest curve to keep the bounds; 0 where it keeps them by itself.
    roughness : float
        Integral of (rho''' + rho')^2 of the additions over the square of the radius at the joints; with contact 3 one
        derivative higher.
    """

    curve: ReturnCurve
    closed: ClosedPath
    radius: Extremes
    curvature: Extremes
    pressure_angle: Extremes
    additions: int
    roughness: float


def designed(working: Arc, bounds: Bounds | None = None, *, contact: int = 2) -> Returned:
    """Close a working arc by the smoothest return arc within bounds.

    Parameters
    ----------
    contact : 2 or 3
        Up to which derivative the arc joins: curvature, or the slope of the curvature as well.

    Raises
    ------
    InputError
        The working arc itself breaks a bound at its ends; `contact` is another number.
    MotionError
        No curve of the family keeps the bounds: the message says by how much the best one misses them.

    Notes
    -----
    Joins are exact to rounding; bounds are kept over the whole arc to 1e-9 of the size. The family has 16 functions
    besides the smoothest curve, found by sequential quadratic programming from it: the best near it, which is no
    proof that no other curve exists.
    """
    if contact not in (2, 3):
        raise InputError("", _("a return arc joins in curvature (2) or in its slope as well (3)"))
    bounds = bounds or Bounds()
    ends = _ends(working, contact)
    _ends_keep(ends, bounds)
    found = ReturnCurve(ends)
    if not Margins.along(found, bounds).broken():
        return _returned(working, found, 0.0)
    weights, size = _searched(ends, bounds)
    return _returned(working, ReturnCurve(ends, weights), size)


def _ends(working: Arc, contact: int) -> Ends:
    """Derivatives of the radius at both ends of the gap, from inside the working arc."""
    stop, start = (
        working.curve.radius(np.array([at]), contact)[:, 0] for at in (working.stop, working.start)
    )
    return Ends(working.stop, working.start + math.tau, tuple(stop.tolist()), tuple(start.tolist()))


def _ends_keep(ends: Ends, bounds: Bounds) -> None:
    """Raise InputError where the joints alone break a bound."""
    curve = ReturnCurve(ends)
    for at in (ends.start, ends.stop):
        broken = Margins.at(frames(curve, np.array([at])), bounds).broken()
        if broken:
            what = _(
                "the working arc breaks a bound of the return arc where they join, at {at:.6g} deg:"
            ).format(at=math.degrees(at))
            raise InputError("[return]", f"{what} {broken}", _("loosen the bound"))


def _searched(ends: Ends, bounds: Bounds) -> tuple[tuple[float, ...], float]:
    """Weights of additions that keep the bounds, with the least roughness; and that roughness."""
    scale = math.sqrt(ends.at_start[0] * ends.at_stop[0])
    # in these weights, roughness is the sum of squares
    basis = np.linalg.inv(np.linalg.cholesky(roughness(ends, MOST)).T)
    search = Search(ends, bounds, basis, scale)
    weights = np.zeros(MOST)
    for _round in range(ROUNDS):
        weights = search.feasible(weights)
        possible = search.least(weights) >= 0.0
        weights = search.smoothest(weights) if possible else weights
        curve = ReturnCurve(ends, tuple((scale * basis @ weights).tolist()))
        margins = Margins.along(curve, bounds)
        if not margins.broken():
            return curve.weights, float(weights @ weights)
        if not possible:
            break
        search.between(curve)
    raise MotionError(
        "[return]",
        _("no return arc was found that keeps the bounds; the best one misses them: {broken}").format(
            broken=margins.broken()
        ),
        _("loosen them"),
    )


def _returned(working: Arc, curve: ReturnCurve, size: float) -> Returned:
    closed = ClosedPath((working, Arc("return", curve, curve.ends.start, curve.ends.stop)))
    return Returned(curve, closed, sizes(curve), bends(curve), slants(curve), len(curve.weights), size)
