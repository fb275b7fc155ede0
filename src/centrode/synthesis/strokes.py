"""Mechanisms from strokes: closed forms for a stroke or swing, a time ratio and a transmission angle.

With the time ratio K of the slow to the fast stroke the crank turns by 180 deg + theta and 180 deg - theta,
theta = 180 deg (K - 1)/(K + 1). In the two limit positions crank and coupler lie in one line, so that the fixed hinge O
of the crank sees both ends of the stroke at the angle theta, at the distances b + a and b - a (H. Alt, VDI-Z 85, 1941,
69-72; VDI 2130). What is left free is one angle, beta at the outer end of the stroke:
b + a = s sin(beta + theta)/sin theta and b - a = s sin beta/sin theta.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.optimize import brentq

from centrode.synthesis.four_bars import Array, Complex, crank_margins, least_transmission

FAMILY = 2000
"""Angles beta at which a family is looked at."""
LONGEST = 5.0
"""Of a coupler beyond half the stroke, in strokes, where the time ratio is one and leaves it free."""
EQUAL = 1e-9
"""A time ratio nearer to one is one."""


@dataclass(frozen=True)
class SliderCrank:
    """Offset slider-crank: crank, coupler, offset of the guide [m], least transmission angle [rad]."""

    crank: float
    coupler: float
    offset: float
    transmission: float


@dataclass(frozen=True)
class CrankRocker:
    """Crank-rocker with D in the origin and the limit positions of B symmetric about the y axis.

    Attributes
    ----------
    fixed : O as a complex number [m]
    crank, coupler, rocker : [m]
    side : of B from the line AD
    transmission : least transmission angle [rad]
    """

    fixed: complex
    crank: float
    coupler: float
    rocker: float
    side: float
    transmission: float


def limit_angle(time_ratio: float) -> float:
    """Angle theta [rad] by which the crank misses half a turn between the limit positions."""
    return math.pi * (time_ratio - 1) / (time_ratio + 1)


def _arms(stroke: float, theta: float, beta: Array) -> tuple[Array, Array]:
    """Crank and coupler [m] of the triangle over a stroke with theta at O and beta at its outer end."""
    far = stroke * np.sin(beta + theta) / math.sin(theta)
    near = stroke * np.sin(beta) / math.sin(theta)
    return (far - near) / 2, (far + near) / 2


def slider_crank(stroke: float, time_ratio: float, transmission: float | None) -> SliderCrank | None:
    """The slider-crank of a stroke [m], a time ratio and a least transmission angle [rad], or the best one.

    Of the two with a given angle that with the shorter coupler. None where the time ratio allows no such angle.
    """
    if time_ratio - 1 < EQUAL:
        # the crank stands in the line of the guide
        crank = stroke / 2
        angle = math.radians(70) if transmission is None else transmission
        return SliderCrank(crank, crank / math.cos(angle), 0.0, angle)
    theta = limit_angle(time_ratio)

    def of(beta: Array) -> tuple[Array, Array, Array, Array]:
        crank, coupler = _arms(stroke, theta, beta)
        offset = (crank + coupler) * np.sin(beta)
        with np.errstate(invalid="ignore"):
            return crank, coupler, offset, np.arccos((crank + offset) / coupler)

    # the crank is the shorter one and turns fully past the guide
    beta = np.linspace(0.0, (math.pi - theta) / 2, FAMILY + 2)[1:-1]
    angles = np.nan_to_num(of(beta)[3], nan=-1.0)
    best = int(np.argmax(angles))
    if transmission is None:
        chosen = _refine(lambda at: float(of(np.array([at]))[3][0]), beta, best)
    else:
        ascending = angles[: best + 1]
        if angles[best] < transmission:
            return None
        k = int(np.argmax(ascending >= transmission))
        chosen = float(beta[k])
        if k and angles[k - 1] >= 0:
            chosen = brentq(
                lambda at: float(of(np.array([at]))[3][0]) - transmission, beta[k - 1], beta[k], xtol=1e-15
            )
    crank, coupler, offset, angle = (float(part[0]) for part in of(np.array([chosen])))
    return SliderCrank(crank, coupler, offset, angle)


def _refine(value: Callable[[float], float], places: Array, best: int) -> float:
    """The place of the greatest value, by golden sections between the neighbours of the best one of a grid."""
    low, high = float(places[max(best - 1, 0)]), float(places[min(best + 1, len(places) - 1)])
    golden = (math.sqrt(5) - 1) / 2
    for _iteration in range(70):
        first, second = high - golden * (high - low), low + golden * (high - low)
        one, two = value(first), value(second)
        if not two >= one:
            high = second
        else:
            low = first
    return (low + high) / 2


def crank_rockers(swing: float, time_ratio: float, rocker: float) -> list[CrankRocker]:
    """Crank-rockers of a swing [rad], a time ratio and a length of the rocker [m], by their least transmission angle.

    The first is the best of its family (Alt); the others stand evenly along it.
    """
    theta = limit_angle(time_ratio)
    chord = 2 * rocker * math.sin(swing / 2)
    ends = [rocker * 1j * np.exp(sign * 0.5j * swing) for sign in (1.0, -1.0)]
    found: list[CrankRocker] = []
    for outer, inner in (ends, ends[::-1]):
        along = (inner - outer) / abs(inner - outer)
        for sign in (1.0, -1.0):
            found += _family(chord, theta, outer, along, sign, rocker)
    found.sort(key=lambda one: -one.transmission)
    return found


def _family(
    chord: float,
    theta: float,
    outer: complex,
    along: complex,
    sign: float,
    rocker: float,
) -> list[CrankRocker]:
    """Crank-rockers with O on one side of the chord."""
    if theta < EQUAL:
        crank = np.full(FAMILY, chord / 2)
        coupler = chord / 2 + chord * np.geomspace(0.02, LONGEST, FAMILY)
        fixed = outer + along * (crank + coupler)
    else:
        beta = np.linspace(0.0, math.pi - theta, FAMILY + 2)[1:-1]
        crank, coupler = _arms(chord, theta, beta)
        fixed = outer + along * np.exp(1j * sign * beta) * (crank + coupler)
    linkages = np.zeros((FAMILY, 9))
    linkages[:, 0], linkages[:, 1] = fixed.real, fixed.imag
    linkages[:, 4], linkages[:, 5], linkages[:, 6] = np.abs(crank), np.abs(coupler), rocker
    angle = least_transmission(linkages)
    good = (crank > 0) & (crank_margins(linkages) > 1e-9).all(axis=1) & np.isfinite(angle)
    # in the limit positions B has to lie on the same side: else the linkage swings between other ends
    sides = [
        np.sign((np.conj(0.0 - _joint(fixed, end, arm)) * (end - _joint(fixed, end, arm))).imag)
        for end, arm in ((outer, crank), (outer + along * chord, -crank))
    ]
    good &= sides[0] == sides[1]
    chosen = np.flatnonzero(good)
    if not len(chosen):
        return []
    best = chosen[int(np.argmax(angle[chosen]))]
    picks = [int(best), *chosen[:: max(1, len(chosen) // 12)].tolist()]
    return [
        CrankRocker(
            complex(fixed[k]),
            float(crank[k]),
            float(coupler[k]),
            rocker,
            float(sides[0][k]),
            float(angle[k]),
        )
        for k in dict.fromkeys(picks)
    ]


def _joint(fixed: Any, end: complex, arm: Array) -> Complex:
    """A in a limit position: the crank lies along the line from O to B, or against it where `arm` is negative."""
    away = end - fixed
    joint: Complex = fixed + arm * away / np.abs(away)
    return joint


@dataclass(frozen=True)
class SlottedLever:
    """A crank whose pin slides along a lever, which moves a slider: a shaper, or Whitworth's quick return.

    Attributes
    ----------
    crank, frame : OA and OD [m]
    lever : DB [m]
    link : BE [m]
    height : of the guide above D [m]
    transmission : least angle between the link and the normal of the guide [rad]
    """

    crank: float
    frame: float
    lever: float
    link: float
    height: float
    transmission: float


def shaper(stroke: float, time_ratio: float, frame: float | None, transmission: float | None) -> SlottedLever:
    """A shaper of a stroke [m]: the lever swings by theta, so a = d sin(theta/2) and DB = H/(2 sin(theta/2)).

    The guide lies midway between the highest and the lowest place of B.
    """
    half = limit_angle(time_ratio) / 2
    lever = stroke / (2 * math.sin(half))
    sagitta = lever * (1 - math.cos(half)) / 2
    link = 0.4 * lever if transmission is None else max(sagitta / math.cos(transmission), 1.05 * sagitta)
    distance = frame if frame is not None else 0.55 * lever
    return SlottedLever(
        distance * math.sin(half), distance, lever, link, lever - sagitta, math.acos(sagitta / link)
    )


def whitworth(
    stroke: float, time_ratio: float, crank: float | None, transmission: float | None
) -> SlottedLever:
    """Whitworth's quick return of a stroke [m]: DB = H/2, and d = a sin(theta/2), because the lever turns fully."""
    half = limit_angle(time_ratio) / 2
    arm = crank if crank is not None else stroke
    lever = stroke / 2
    angle = math.radians(70) if transmission is None else transmission
    return SlottedLever(arm, arm * math.sin(half), lever, lever / math.cos(angle), 0.0, angle)


def evenly(values: list[CrankRocker], count: int) -> Iterator[CrankRocker]:
    """The first of a list and others evenly behind it, at most so many."""
    if len(values) <= count:
        yield from values
        return
    for k in range(count):
        yield values[round(k * (len(values) - 1) / (count - 1))] if count > 1 else values[0]
