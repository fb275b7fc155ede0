"""The return arc of a cam, designed: the smoothest curve within bounds of size and curvature that joins both ends."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize

from centrode.cams.bounded import MOST, Bounds, Margins, bends, sizes
from centrode.cams.closing import Arc, ClosedPath
from centrode.cams.frames import Array, frames
from centrode.cams.return_curves import Ends, ReturnCurve, derivatives, roughness
from centrode.cams.searching import Extremes
from centrode.errors import InputError, MotionError
from centrode.locale import _

__all__ = ["Bounds", "Returned", "designed"]

NODES = 181
ROUNDS = 6
"""Times that the worst places between the nodes are added to them."""
SLACK = 1e-9
"""Share of a bound by which it may be passed: what is left of the search."""
ITERATIONS = 300


@dataclass(frozen=True)
class Returned:
    """A designed return arc and what it keeps.

    Attributes
    ----------
    curve : ReturnCurve
    closed : ClosedPath
    radius, curvature : Extremes
        Of the arc: polar radius [m] and curvature [1/m] of the roller's path.
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
    Joins are exact to rounding; bounds are kept over the whole arc to 1e-9 of themselves. The family has 16
    functions besides the smoothest curve, found by sequential quadratic programming from it: the best of the
    family near it, which is not a proof that no other curve exists.
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
    nodes = np.linspace(ends.start, ends.stop, NODES)
    weights = np.zeros(MOST)
    for _round in range(ROUNDS):
        search = _Search(ends, bounds, basis, nodes, scale)
        weights = search.smoothest(search.feasible(weights))
        curve = ReturnCurve(ends, tuple((scale * basis @ weights).tolist()))
        margins = Margins.along(curve, bounds)
        if not margins.broken():
            return curve.weights, float(weights @ weights)
        nodes = np.sort(np.concatenate([nodes, margins.places]))
    raise MotionError(
        "[return]",
        _("no return arc was found that keeps the bounds; the best one misses them: {broken}").format(
            broken=margins.broken()
        ),
        _("loosen them"),
    )


class _Search:
    """Constraints at nodes over the weights of the additions, in units of the size of the path."""

    def __init__(self, ends: Ends, bounds: Bounds, basis: Array, nodes: Array, scale: float) -> None:
        self.bounds, self.scale = bounds, scale
        self.still = ReturnCurve(ends).radius(nodes, 2) / scale
        rows = derivatives(ends, nodes, 2, MOST)[-MOST:]
        self.moving = np.tensordot(basis.T, rows, axes=1)

    def margins(self, weights: Array) -> tuple[Array, Array]:
        """Margins (m) of all bounds at the nodes and their gradients (m, weights)."""
        rho = self.still + np.tensordot(weights, self.moving, axes=1)
        return self.bounds.margins(rho, self.moving, self.scale)

    def feasible(self, weights: Array) -> Array:
        """Weights whose least margin is positive, else the greatest that is found."""
        margin = float(self.margins(weights)[0].min())
        if margin >= SLACK:
            return weights
        found = minimize(
            lambda x: (-x[-1], np.append(np.zeros(MOST), -1.0)),
            np.append(weights, margin),
            jac=True,
            method="SLSQP",
            bounds=[(None, None)] * MOST + [(None, 1e-3)],
            constraints={
                "type": "ineq",
                "fun": lambda x: self.margins(x[:-1])[0] - x[-1],
                "jac": lambda x: np.pad(self.margins(x[:-1])[1], ((0, 0), (0, 1)), constant_values=-1.0),
            },
            options={"maxiter": ITERATIONS, "ftol": 1e-10},
        )
        return np.asarray(found.x[:-1])

    def smoothest(self, weights: Array) -> Array:
        """From weights that keep the bounds, those with the least sum of squares that do."""
        if self.margins(weights)[0].min() < 0.0:
            return weights
        found = minimize(
            lambda x: (float(x @ x), 2.0 * x),
            weights,
            jac=True,
            method="SLSQP",
            constraints={
                "type": "ineq",
                "fun": lambda x: self.margins(x)[0] - SLACK,
                "jac": lambda x: self.margins(x)[1],
            },
            options={"maxiter": ITERATIONS, "ftol": 1e-12},
        )
        return np.asarray(found.x) if self.margins(found.x)[0].min() > 0.0 else weights


def _returned(working: Arc, curve: ReturnCurve, size: float) -> Returned:
    closed = ClosedPath((working, Arc("return", curve, curve.ends.start, curve.ends.stop)))
    return Returned(curve, closed, sizes(curve), bends(curve), len(curve.weights), size)
