"""Where a follower stalls: the arc of the path, by which everything stays regular, leads there."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.polynomial import polynomial

from centrode.cams.curvature_laws import CurvatureLaw
from centrode.cams.recursions import Series, arc_series
from centrode.numerics.search import Array, newton_roots

ORDER = 24
MOST_ARCS = 30


class State(NamedTuple):
    """A place of the path: angle [rad], rho [m], sin(gamma), cos(gamma)."""

    phi: float
    rho: float
    sine: float
    cosine: float


def stall_behind(law: CurvatureLaw, place: State, sense: int, end: float) -> State | None:
    """The place with cos(gamma) = 0 behind one before it, in a sense of phi, up to an end.

    Taylor series by the arc; None where the cosine grows again, or the end or a break of the law comes first: a
    stall behind a break is found from there.
    """
    here = place
    for _arc in range(MOST_ARCS):
        series = arc_series(*here, lambda angles: law.along(angles, sense), ORDER)
        arc = sense * _reach(series, here.rho)
        there = _normal([_value(s, arc) for s in series])
        if there.cosine <= 0:
            stall = _normal([_value(s, _root(series[3], arc)) for s in series])
            found = stall._replace(sine=math.copysign(1.0, stall.sine), cosine=0.0)
            return None if sense * (found.phi - end) > 0 else found
        crossed = any(sense * (here.phi - b) < 0 < sense * (there.phi - b) for b in law.breaks)
        if crossed or sense * (there.phi - end) > 0 or there.cosine > 1.5 * place.cosine:
            return None
        here = there
    return None


def _reach(series: tuple[Series, ...], rho: float) -> float:
    """An arc over which the series hold to rounding."""
    reach = math.inf
    for coefficients, scale in zip(series, (1.0, rho, 1.0, 1.0), strict=True):
        for k in (ORDER - 1, ORDER):
            size = abs(coefficients[k]) / scale
            if size > 0:
                reach = min(reach, (1e-17 / size) ** (1.0 / k))
    return min(reach, rho)


def _root(coefficients: Series, arc: float) -> float:
    """The root of a series between 0, where it is positive, and `arc`, where it is not."""
    powers = np.array(coefficients)
    slopes = polynomial.polyder(powers)

    def cosine(x: Array) -> tuple[Array, Array]:
        return np.asarray(polynomial.polyval(x, powers)), np.asarray(polynomial.polyval(x, slopes))

    low, high = np.sort([[0.0], [arc]], axis=0)
    return float(newton_roots(cosine, low, high)[0])


def _value(coefficients: Series, x: float) -> float:
    total = 0.0
    for c in reversed(coefficients):
        total = total * x + c
    return total


def _normal(values: list[float]) -> State:
    """The state with sine and cosine brought back to one."""
    phi, rho, sine, cosine = values
    unit = math.hypot(sine, cosine)
    return State(phi, rho, sine / unit, cosine / unit)
