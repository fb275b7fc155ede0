"""Linkages of the sphere: the first pivot on the x axis, the second on the equator."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import mpmath
import numpy as np

from tools.campaigns.change_points.linkage import DIGITS, Linkage, Place, Places, beginning, bend

X, Y = (mpmath.mpf(1), mpmath.mpf(0), mpmath.mpf(0)), (mpmath.mpf(0), mpmath.mpf(1), mpmath.mpf(0))


def turned(pole: Place, tangent: Place, arc: Any, c: Any, s: Any) -> Place:
    """The place at an arc from a pole, in the direction that has cosine c and sine s from a tangent."""
    square = cross(pole, tangent)
    return tuple(
        mpmath.cos(arc) * p + mpmath.sin(arc) * (c * t + s * n)
        for p, t, n in zip(pole, tangent, square, strict=True)
    )


def cross(u: Place, v: Place) -> Place:
    """Vector product."""
    return (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])


def dot(u: Place, v: Place) -> Any:
    """Scalar product."""
    return sum(a * b for a, b in zip(u, v, strict=True))


def spherical(
    kind: str, ratio: float, arcs: tuple[float, float, float, float], curve: Any, spots: Any, start: float,
    **more: Any,
) -> Linkage:  # fmt: skip
    """A four-bar O-A-B-D of the sphere; `curve` gives B from the dimensions, q, A and D."""
    a, b, c, d = arcs
    dimensions = {"links.OA.length": a, "links.AB.length": b, "links.DB.length": c, "frame.D": d}

    def known(numbers: Mapping[str, Any], q: Any) -> tuple[Place, Place]:
        pin = turned(X, Y, numbers["links.OA.length"], mpmath.cos(q), mpmath.sin(q))
        return pin, (mpmath.cos(numbers["frame.D"]), mpmath.sin(numbers["frame.D"]), mpmath.mpf(0))

    def places(numbers: Mapping[str, Any], q: Any) -> Places:
        pin, pivot = known(numbers, q)
        return {"A": pin, "B": curve(numbers, q, pin, pivot)}

    def closures(numbers: Mapping[str, Any], q: Any, at: Places) -> list[Any]:
        pin, pivot = known(numbers, q)
        return [
            dot(at["B"], pin) - mpmath.cos(numbers["links.AB.length"]),
            dot(at["B"], pivot) - mpmath.cos(numbers["links.DB.length"]),
            dot(at["B"], at["B"]) - 1,
        ]

    with mpmath.workdps(DIGITS):
        numbers = {path: mpmath.mpf(x) for path, x in dimensions.items()}
        q = mpmath.mpf(start)
        pin, pivot = known(numbers, q)
        left = dot(cross(pin, pivot), places(numbers, q)["B"]) > 0
    parts = {
        "space": "sphere",
        "frame": {"points": {"O": [0.0, 0.0], "D": [d, 0.0]}},
        "links": {
            "OA": {"length": a, "reference": ["O", "D"]},
            "AB": {"length": b, "reference": ["A", "O"]},
            "DB": {"length": c, "reference": ["D", "O"]},
        },
        "drives": [{"link": "OA", "start": start, "speed": 1.0}],
        "assembly": {"sides": {"B": "left" if left else "right"}},
    }
    return Linkage(
        f"spherical {kind}", ratio, parts, dimensions, places, closures, ("B",), spots, max(arcs), **more
    )


def arcs_of(random: np.random.Generator, ratio: float) -> tuple[float, float]:
    """Two arcs of a ratio, the greater one up to 1.3 rad."""
    greater = float(random.uniform(0.2, 1.3))
    return (greater, greater / ratio) if ratio > 1.0 else (greater * ratio, greater)


def spherical_parallelogram(random: np.random.Generator, ratio: float, crossed: bool) -> Linkage:
    """Opposite arcs alike: tan(psi/2) = k tan(q/2) on either factor (isogram)."""
    a, d = arcs_of(random, ratio)

    def curve(numbers: Mapping[str, Any], q: Any, pin: Place, pivot: Place) -> Place:
        crank, frame = numbers["links.OA.length"], numbers["frame.D"]
        if crossed:
            over, under = mpmath.sin((crank + frame) / 2), mpmath.sin((crank - frame) / 2)
        else:
            over, under = mpmath.cos((crank + frame) / 2), mpmath.cos((crank - frame) / 2)
        c, s = under * mpmath.cos(q / 2), over * mpmath.sin(q / 2)
        tangent = (-mpmath.sin(frame), mpmath.cos(frame), mpmath.mpf(0))
        norm = c**2 + s**2
        return turned(pivot, tangent, crank, (c**2 - s**2) / norm, 2 * c * s / norm)

    return spherical(
        "antiparallelogram" if crossed else "parallelogram", a / d, (a, d, a, d), curve,
        [(0.0, bend(a, d)), (math.pi, 0.5)], beginning(random),
        vary={"links.OA.length": "r", "links.DB.length": "r"},
    )  # fmt: skip


def spherical_kite(random: np.random.Generator, ratio: float) -> Linkage:
    """Coupler and crank alike, rocker and frame alike: B is the mirror image of O in the great circle AD."""
    a, d = arcs_of(random, ratio)

    def curve(numbers: Mapping[str, Any], q: Any, pin: Place, pivot: Place) -> Place:
        normal = cross(pin, pivot)
        times = 2 * dot(X, normal) / dot(normal, normal)
        return tuple(x - times * n for x, n in zip(X, normal, strict=True))

    return spherical(
        "kite", a / d, (a, a, d, d), curve, [(0.0, bend(a, d)), (math.pi, 0.5)], beginning(random),
        vary={"links.OA.length": "r", "links.AB.length": "r"},
    )  # fmt: skip


def spherical_slider_crank(random: np.random.Generator, _ratio: float) -> Linkage:
    """Crank and coupler alike, the slider on a great circle through the pivot: tan(t/2) = tan a cos q."""
    a = float(random.uniform(0.1, 1.2))
    dimensions = {"links.OA.length": a, "links.AB.length": a}

    def places(numbers: Mapping[str, Any], q: Any) -> Places:
        pin = turned(X, Y, numbers["links.OA.length"], mpmath.cos(q), mpmath.sin(q))
        t = 2 * mpmath.atan(mpmath.tan(numbers["links.OA.length"]) * mpmath.cos(q))
        return {"A": pin, "B": (mpmath.cos(t), mpmath.sin(t), mpmath.mpf(0))}

    def closures(numbers: Mapping[str, Any], q: Any, at: Places) -> list[Any]:
        pin = turned(X, Y, numbers["links.OA.length"], mpmath.cos(q), mpmath.sin(q))
        return [
            dot(at["B"], pin) - mpmath.cos(numbers["links.AB.length"]),
            at["B"][2],
            dot(at["B"], at["B"]) - 1,
        ]

    start = float(random.uniform(-0.9, 0.9))
    pole = (mpmath.mpf(0), mpmath.mpf(0), mpmath.mpf(1))
    with mpmath.workdps(DIGITS):
        at = places({path: mpmath.mpf(x) for path, x in dimensions.items()}, mpmath.mpf(start))
        left = dot(cross(at["A"], pole), at["B"]) > 0
    parts = {
        "space": "sphere",
        "frame": {"points": {"O": [0.0, 0.0], "D": [1.0, 0.0]}},
        "links": {"OA": {"length": a, "reference": ["O", "D"]}, "AB": {"length": a}},
        "guides": [{"point": "B", "pole": [0.0, math.pi / 2]}],
        "drives": [{"link": "OA", "start": start, "speed": 1.0}],
        "assembly": {"sides": {"B": "left" if left else "right"}},
    }
    spots = [(-math.pi / 2, 0.5), (math.pi / 2, 0.5)]
    return Linkage(
        "spherical aligned slider-crank", 1.0, parts, dimensions, places, closures, ("B",), spots,
        math.pi / 2,
    )  # fmt: skip
