"""Parallelograms and antiparallelograms inside a longer chain."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import mpmath
import numpy as np

from tools.campaigns.change_points.linkage import DIGITS, Linkage, Places, beginning, bend, dyadic
from tools.campaigns.change_points.plane import number, plane, rocker


def chain(random: np.random.Generator, ratio: float) -> Linkage:
    """Two parallelograms or antiparallelograms in a row, the rocker of one the crank of the other, and a dyad."""
    d = dyadic(random.uniform(0.5, 2.0))
    r, e = dyadic(d * ratio), dyadic(d * random.uniform(0.3, 3.0))
    crossed = (bool(random.random() < 0.5), bool(random.random() < 0.5))
    if abs(e - r) < 0.1 * r:
        e = dyadic(1.5 * r)
    far = 3.0 * (r + d + e)
    base = [d + e, -far]
    dimensions = {
        "links.OA.length": r, "links.AB.length": d, "links.DB.length": r, "frame.D": d,
        "links.BC.length": e, "links.EC.length": r, "frame.E": e, "links.CP.length": far, "links.FP.length": far,
    }  # fmt: skip

    def frame_of(numbers: Mapping[str, Any]) -> tuple[Any, Any, Any]:
        end = numbers["frame.D"] + numbers["frame.E"]
        return numbers["frame.D"], end, mpmath.mpc(base[0], base[1])

    def places(numbers: Mapping[str, Any], q: Any) -> Places:
        first, end, away = frame_of(numbers)
        r_, e_ = numbers["links.OA.length"], numbers["frame.E"]
        turn = rocker(numbers, q, crossed[0])
        second = turn
        if crossed[1]:
            c, s = mpmath.cos(q / 2), mpmath.sin(q / 2)
            if crossed[0]:
                c, s = c * (r_ - first), s * (r_ + first)
            c, s = c * (r_ - e_), s * (r_ + e_)
            second = mpmath.mpc(c, s) / mpmath.mpc(c, -s)
        b, c_ = first + r_ * turn, end + r_ * second
        between = away - c_
        span = abs(between)
        height = mpmath.sqrt(numbers["links.CP.length"] ** 2 / span**2 - mpmath.mpf(1) / 4)
        p = c_ + between * mpmath.mpc(mpmath.mpf(1) / 2, height)
        return {"A": plane(r_ * mpmath.expj(q)), "B": plane(b), "C": plane(c_), "P": plane(p)}

    def closures(numbers: Mapping[str, Any], q: Any, at: Places) -> list[Any]:
        first, end, away = frame_of(numbers)
        pin = numbers["links.OA.length"] * mpmath.expj(q)
        b, c, p = (number(at[name]) for name in "BCP")
        return [
            abs(b - pin) - numbers["links.AB.length"], abs(b - first) - numbers["links.DB.length"],
            abs(c - b) - numbers["links.BC.length"], abs(c - end) - numbers["links.EC.length"],
            abs(p - c) - numbers["links.CP.length"], abs(p - away) - numbers["links.FP.length"],
        ]  # fmt: skip

    start = beginning(random)
    with mpmath.workdps(DIGITS):
        at = places({path: mpmath.mpf(x) for path, x in dimensions.items()}, mpmath.mpf(start))
        a, b, c, p = (number(at[name]) for name in "ABCP")
    sides = {
        "B": mpmath.im(mpmath.conj(d - a) * (b - a)) > 0,
        "C": mpmath.im(mpmath.conj(d + e - b) * (c - b)) > 0,
        "P": mpmath.im(mpmath.conj(mpmath.mpc(base[0], base[1]) - c) * (p - c)) > 0,
    }
    links = {path.split(".")[1]: {"length": x} for path, x in dimensions.items() if path.startswith("links")}
    parts = {
        "frame": {"points": {"O": [0.0, 0.0], "D": [d, 0.0], "E": [d + e, 0.0], "F": base}},
        "links": links,
        "drives": [{"link": "OA", "start": start, "speed": 1.0}],
        "assembly": {"sides": {name: "left" if left else "right" for name, left in sides.items()}},
    }
    first = bend(r, d) if crossed[0] else 0.5
    spots = [(0.0, first * (bend(r, e) if crossed[1] else 1.0)), (math.pi, first)]
    return Linkage(
        "chain of two", r / d, parts, dimensions, places, closures, ("B", "C", "P"), spots, 2.0 * far
    )
