"""The path by Taylor series that are expanded anew step by step, until the follower stalls or the range ends."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from centrode.cams.asked import MOST_GROWTH, check_bend, check_start, no_series, runs_away
from centrode.cams.curvature_laws import CurvatureLaw
from centrode.cams.lawful import check_span, lawful, refusal, unlawful_place
from centrode.cams.path import StatePath
from centrode.cams.recursions import Series, system_series
from centrode.cams.stalling import State, stall_behind
from centrode.errors import InputError
from centrode.locale import _

Array = NDArray[np.float64]

TOLERANCE = 1e-13
"""Share of rho and of cos(gamma) that a step may leave out."""

LEAST_TOLERANCE, GREATEST_TOLERANCE = 1e-15, 1e-3
MOST_STEPS = 5000

NEAR_STALL = 0.6
"""Cosine of the pressure angle below which a stall is looked for, each time that the steps have become half as long."""

LAST_STRETCH = 1e-11
"""Share of the angle before a stall in which nothing is expanded: cos(gamma) runs as the root of what is left."""

LEAST_STEP = 1e-15
"""Share of the angle below which a step leads nowhere."""


class Step(NamedTuple):
    """Series of rho, sin(gamma), cos(gamma) about `centre` that hold up to `end`, on either side of it."""

    centre: float
    end: float
    series: tuple[Series, Series, Series]


class Ending(NamedTuple):
    """The last stretch before a stall: the state where it begins, and the stall."""

    place: State
    stall: State


@dataclass(frozen=True)
class ExpandedPath(StatePath):
    """A roller path by series of rho, sin(gamma) and cos(gamma), each about the end of the step before it.

    Made by `expanded_path`.

    Attributes
    ----------
    law : CurvatureLaw
    start, stop : float [rad]
        Ends of the path: of the asked range, or where the follower stalls.
    edges : (steps + 1), growing [rad]
    centres : (steps) [rad]
        One of the two edges of each step.
    coefficients : (3, steps, order + 1)
        Of rho [m], sin(gamma), cos(gamma).
    endings : tuple of Ending
        Last stretches before stalls.
    """

    law: CurvatureLaw
    start: float
    stop: float
    edges: Array
    centres: Array
    coefficients: Array
    endings: tuple[Ending, ...] = ()

    @property
    def stall(self) -> float | None:  # type: ignore[override]
        """Where cos(gamma) = 0 ends the path forwards [rad]; else backwards; None where it does not."""
        ends = [ending.stall.phi for ending in self.endings]
        return float(max(ends)) if ends else None

    @property
    def order(self) -> int:
        """Degree of the series."""
        return int(self.coefficients.shape[-1]) - 1

    def state(self, phi: Array) -> tuple[Array, Array, Array]:
        """Radius [m], sin(gamma), cos(gamma) at places inside the path."""
        steps = np.clip(np.searchsorted(self.edges, phi, side="right") - 1, 0, len(self.centres) - 1)
        offset = phi - self.centres[steps]
        found = np.zeros((3, *np.shape(phi)))
        for k in range(self.order, -1, -1):
            found = found * offset + self.coefficients[:, steps, k]
        for ending in self.endings:
            _end(found, phi, ending)
        return found[0], found[1], found[2]


def _end(found: Array, phi: Array, ending: Ending) -> None:
    """Put the state of a last stretch in place."""
    place, stall = ending
    share = (stall.phi - phi) / (stall.phi - place.phi)
    here = (share >= 0) & (share < 1)
    root = np.sqrt(share[here])
    cosine = place.cosine * root
    found[0, here] = stall.rho + (place.rho - stall.rho) * root
    found[1, here] = stall.sine * np.sqrt(1.0 - cosine**2)
    found[2, here] = cosine


def expanded_path(
    law: CurvatureLaw,
    rho0: float,
    gamma0: float = 0.0,
    start: float = 0.0,
    stop: float = math.pi / 2,
    tolerance: float = TOLERANCE,
) -> ExpandedPath:
    """The path of a roller's centre from its curvature.

    Parameters
    ----------
    law : CurvatureLaw
        K(phi) [1/m], positive over the range.
    rho0, gamma0 : float [m], [rad]
        Radius and pressure angle at phi = 0.
    start, stop : float [rad]
        The range; 0 lies in it. The path ends earlier where the follower stalls.
    tolerance : float
        Share of rho and cos(gamma) that a step may leave out.

    Returns
    -------
    ExpandedPath

    Raises
    ------
    InputError
        A range without 0, a tolerance out of bounds, or a curvature that is not positive and finite.

    Notes
    -----
    The degree is `2 - ln(tolerance)/2` and the step such that the last two terms stay below the tolerance (A. Jorba,
    M. Zou, A software package for the numerical integration of ODEs by means of high-order Taylor methods, 2005).
    """
    check_start(rho0, gamma0, start, stop)
    if not LEAST_TOLERANCE <= tolerance <= GREATEST_TOLERANCE:
        what = _("the tolerance lies between {least:g} and {most:g}, got {value:g}")
        told = what.format(least=LEAST_TOLERANCE, most=GREATEST_TOLERANCE, value=tolerance)
        raise InputError("tolerance", told)
    check_span(law, start, stop)
    if not lawful(law, 0.0):
        raise refusal(law, 0.0)
    check_bend(rho0, float(law.series(0.0, 0)[0]))
    first = State(0.0, rho0, math.sin(gamma0), math.cos(gamma0))
    with np.errstate(all="ignore"):
        ahead, stalled = _march(law, first, stop, 1, tolerance)
        behind, stuck = _march(law, first, start, -1, tolerance)
    steps = [*reversed(behind), *ahead]
    low, high = (behind[-1].end if behind else 0.0), (ahead[-1].end if ahead else 0.0)
    edges = sorted({low, high, *(step.centre for step in steps)})
    return ExpandedPath(
        law,
        low,
        high,
        np.asarray(edges),
        np.asarray([step.centre for step in steps]),
        np.asarray([step.series for step in steps]).swapaxes(0, 1),
        tuple(ending for ending in (stalled, stuck) if ending is not None),
    )


def _march(
    law: CurvatureLaw, place: State, stop: float, sense: int, tolerance: float
) -> tuple[list[Step], Ending | None]:
    """Steps from a place towards `stop`, and the last stretch where the follower stalls before it."""
    if stop == place.phi:
        return [], None
    wrong = unlawful_place(law, stop)
    end = stop if wrong is None else wrong
    order = math.ceil(2.0 - 0.5 * math.log(tolerance))
    steps: list[Step] = []
    stall: State | None = None
    looked, rho0 = math.inf, place.rho
    while len(steps) < MOST_STEPS:
        series = system_series(*place[1:], law.series(place.phi, order - 1, sense))
        reach = _reach(series, tolerance)
        if not reach > LEAST_STEP * abs(place.phi):
            raise no_series(place.phi)
        if place.rho > MOST_GROWTH * rho0:
            raise runs_away(place.phi)
        if stall is None and place.cosine < NEAR_STALL and reach < 0.5 * looked:
            looked = reach
            stall = stall_behind(law, place, sense, end)
            end = end if stall is None else stall.phi
        to = _nearest(sense, place.phi + sense * reach, end, law.breaks, place.phi)
        if stall is not None and sense * (stall.phi - to) <= LAST_STRETCH * abs(stall.phi):
            steps.append(Step(place.phi, stall.phi, series))
            return steps, Ending(place, stall)
        steps.append(Step(place.phi, to, series))
        place = _moved(series, place.phi, to)
        if to == end:
            if wrong is not None and stall is None:
                raise refusal(law, wrong)
            return steps, None
    what = _("the path takes more than {most} steps").format(most=MOST_STEPS)
    raise InputError("[curvature]", what, _("ask for a shorter range, or a coarser tolerance"))


def _reach(series: tuple[Series, Series, Series], tolerance: float) -> float:
    """An angle over which the last two terms of each series stay below the tolerance; NaN where they are no numbers."""
    reach = math.inf
    if not all(math.isfinite(c) for coefficients in series for c in coefficients):
        return math.nan
    scales = (series[0][0], series[2][0], series[2][0])
    for coefficients, scale in zip(series, scales, strict=True):
        for k in (len(coefficients) - 2, len(coefficients) - 1):
            size = abs(coefficients[k]) / scale
            if size > 0:
                reach = min(reach, (tolerance / size) ** (1.0 / k))
    return reach


def _nearest(sense: int, reach: float, end: float, breaks: tuple[float, ...], start: float) -> float:
    """The first of what a step may reach, the end, and the next break of the law."""
    ahead = [b for b in breaks if sense * (b - start) > 0]
    return sense * min(sense * place for place in (reach, end, *ahead))


def _moved(series: tuple[Series, Series, Series], centre: float, to: float) -> State:
    offset = to - centre
    values = []
    for coefficients in series:
        total = 0.0
        for c in reversed(coefficients):
            total = total * offset + c
        values.append(float(total))
    rho, sine, cosine = values
    unit = math.hypot(sine, cosine)
    return State(to, rho, sine / unit, cosine / unit)
