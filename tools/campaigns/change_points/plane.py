"""Four-bars and slider-cranks of the plane; the frame lies along an axis, so that its length is the double given."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import mpmath
import numpy as np

from tools.campaigns.change_points.linkage import DIGITS, Linkage, Place, Places, beginning, bend, dyadic


def plane(u: Any) -> Place:
    """A complex number as coordinates."""
    return (mpmath.re(u), mpmath.im(u))


def number(place: Place) -> Any:
    """Coordinates as a complex number."""
    return mpmath.mpc(*place)


def rocker(numbers: Mapping[str, Any], q: Any, crossed: bool) -> Any:
    """Direction of the rocker of a parallelogram, or of an antiparallelogram: tan(psi/2) = k tan(q/2)."""
    if not crossed:
        return mpmath.expj(q)
    r, d = numbers["links.OA.length"], numbers["frame.D"]
    c, s = mpmath.cos(q / 2) * (r - d), mpmath.sin(q / 2) * (r + d)
    return mpmath.mpc(c, s) / mpmath.mpc(c, -s)


def four_bar(
    kind: str, ratio: float, lengths: tuple[float, float, float, float], curve: Any, spots: Any, axis: int,
    start: float, **more: Any,
) -> Linkage:  # fmt: skip
    """A four-bar O-A-B-D with its frame along an axis; `curve` gives B from the dimensions and q from the axis."""
    a, b, c, d = lengths
    turn = (1, 1j, -1, -1j)[axis]
    frame = {"O": [0.0, 0.0], "D": [d * turn.real, d * turn.imag]}
    dimensions = {"links.OA.length": a, "links.AB.length": b, "links.DB.length": c, "frame.D": d}

    def places(numbers: Mapping[str, Any], q: Any) -> Places:
        own = q - axis * mpmath.pi / 2
        crank = numbers["links.OA.length"] * mpmath.expj(own)
        return {"A": plane(turn * crank), "B": plane(turn * curve(numbers, own))}

    def closures(numbers: Mapping[str, Any], q: Any, at: Places) -> list[Any]:
        pin = turn * numbers["links.OA.length"] * mpmath.expj(q - axis * mpmath.pi / 2)
        b_, d_ = number(at["B"]), turn * numbers["frame.D"]
        return [
            abs(b_ - pin) - numbers["links.AB.length"],
            abs(b_ - d_) - numbers["links.DB.length"],
        ]

    begun = start + axis * math.pi / 2
    with mpmath.workdps(DIGITS):
        at = places({path: mpmath.mpf(x) for path, x in dimensions.items()}, mpmath.mpf(begun))
        pin, b_ = number(at["A"]), number(at["B"])
        left = mpmath.im(mpmath.conj(turn * d - pin) * (b_ - pin)) > 0
    parts = {
        "frame": {"points": frame},
        "links": {"OA": {"length": a}, "AB": {"length": b}, "DB": {"length": c}},
        "drives": [{"link": "OA", "start": begun, "speed": 1.0}],
        "assembly": {"sides": {"B": "left" if left else "right"}},
    }
    spots = [(q + axis * math.pi / 2, width) for q, width in spots]
    return Linkage(kind, ratio, parts, dimensions, places, closures, ("B",), spots, max(lengths), **more)


def parallelogram(random: np.random.Generator, ratio: float, crossed: bool) -> Linkage:
    """Crank and rocker alike, coupler and frame alike."""
    d = float(random.uniform(0.5, 2.0))
    r = d * ratio
    width = bend(r, d)

    def curve(numbers: Mapping[str, Any], q: Any) -> Any:
        return numbers["frame.D"] + numbers["links.OA.length"] * rocker(numbers, q, crossed)

    return four_bar(
        "antiparallelogram" if crossed else "parallelogram", r / d, (r, d, r, d), curve,
        [(0.0, width), (math.pi, 0.5)], axis_of(random), beginning(random),
        vary={"links.OA.length": "r", "links.DB.length": "r"},
    )  # fmt: skip


def kite(random: np.random.Generator, ratio: float) -> Linkage:
    """Coupler and crank alike, rocker and frame alike: B is the mirror image of O in the line AD."""
    d = float(random.uniform(0.5, 2.0))
    a = d * ratio

    def curve(numbers: Mapping[str, Any], q: Any) -> Any:
        along = numbers["links.OA.length"] * mpmath.expj(q) - numbers["frame.D"]
        return numbers["frame.D"] - along / mpmath.conj(along) * numbers["frame.D"]

    return four_bar(
        "kite, coupler as crank", a / d, (a, a, d, d), curve, [(0.0, bend(a, d)), (math.pi, 0.5)],
        axis_of(random), beginning(random), vary={"links.OA.length": "r", "links.AB.length": "r"},
    )  # fmt: skip


def galloway(random: np.random.Generator, ratio: float) -> Linkage:
    """Crank and frame alike, coupler and rocker alike: B stays on the bisector of the angle AOD."""
    a = float(random.uniform(0.5, 2.0))
    b = a * ratio
    reach = math.inf if b >= a else 2.0 * math.asin(b / a)

    def curve(numbers: Mapping[str, Any], q: Any) -> Any:
        crank, coupler = numbers["links.OA.length"], numbers["links.AB.length"]
        s, c = mpmath.sin(q / 2) * crank, mpmath.cos(q / 2) * crank
        return (c + mpmath.sqrt((coupler - s) * (coupler + s))) * mpmath.expj(q / 2)

    spots = [(0.0, min(0.5, reach / 2))]
    if reach == math.inf:
        spots.append((math.pi, min(0.5, math.sqrt(2.0 * (b - a) / a))))
    start = 0.4 * float(random.choice([-1.0, 1.0])) * min(reach, 2.0)
    return four_bar(
        "kite, coupler as rocker", b / a, (a, b, b, a), curve, spots, axis_of(random), start, reach=reach,
        vary={"links.AB.length": "r", "links.DB.length": "r"} if b > 1.5 * a else {},
    )  # fmt: skip


def in_line(random: np.random.Generator, ratio: float) -> Linkage:
    """Crank and frame together as long as coupler and rocker together: all lie in one line once a turn.

    The ratio is that of the coupler to the frame less its part, so that at 1 another change point comes in.
    """
    gap = min(0.45, abs(1.0 - ratio))
    d, a = dyadic(random.uniform(0.8, 2.0)), dyadic(random.uniform(0.1, 0.5))
    by = dyadic(gap * (d - a))
    b, c = d - by, a + by
    assert a + d == b + c and by > 0.0

    def curve(numbers: Mapping[str, Any], q: Any) -> Any:
        a_, b_, c_, d_ = (
            numbers[path] for path in ("links.OA.length", "links.AB.length", "links.DB.length", "frame.D")
        )
        pin = a_ * mpmath.expj(q)
        u = d_ - pin
        square = abs(u) ** 2
        along = (square + b_**2 - c_**2) / (2 * square)
        height = mpmath.sqrt(a_ * d_ * (square - (b_ - c_) ** 2)) * mpmath.cos(q / 2) / square
        return pin + u * mpmath.mpc(along, height)

    width = min(0.5, math.sqrt(2.0 * by / (d - a)))
    return four_bar(
        "in-line four-bar", 1.0 - by / (d - a), (a, b, c, d), curve, [(math.pi, 0.5), (0.0, width)],
        axis_of(random), beginning(random),
    )  # fmt: skip


def aligned_slider_crank(random: np.random.Generator, ratio: float) -> Linkage:
    """A slider whose line lies as far off the crank's pivot as the coupler is longer than the crank.

    With sin q = -1 the coupler is square to the line. Without an offset it is so twice a turn.
    """
    a = dyadic(random.uniform(0.5, 2.0))
    e = 0.0 if random.random() < 0.25 else dyadic(a * (ratio - 1.0))
    b = a + e
    reach = math.pi if e >= 0.0 else math.acos(max(-1.0, -(1.0 + 2.0 * e / a)))
    dimensions = {"links.OA.length": a, "links.AB.length": b, "offset": e}

    def places(numbers: Mapping[str, Any], q: Any) -> Places:
        crank, off = numbers["links.OA.length"], numbers["offset"]
        height = (crank * mpmath.sin(q), crank * mpmath.cos(q))
        if e == 0.0:
            return {"A": (height[1], height[0]), "B": (2 * height[1], mpmath.mpf(0))}
        root = mpmath.sqrt(2 * crank * (crank + 2 * off - height[0])) * mpmath.sin(q / 2 + mpmath.pi / 4)
        return {"A": (height[1], height[0]), "B": (height[1] + root, off)}

    def closures(numbers: Mapping[str, Any], q: Any, at: Places) -> list[Any]:
        x, y = at["B"]
        crank = numbers["links.OA.length"]
        span = mpmath.hypot(x - crank * mpmath.cos(q), y - crank * mpmath.sin(q))
        return [span - numbers["links.AB.length"], y - numbers["offset"]]

    start = -math.pi / 2 + float(random.choice([-1.0, 1.0])) * 0.4 * min(reach, 2.0)
    with mpmath.workdps(DIGITS):
        at = places({path: mpmath.mpf(x) for path, x in dimensions.items()}, mpmath.mpf(start))
        ahead = at["B"][0] > at["A"][0]
    parts = {
        "frame": {"points": {"O": [0.0, 0.0]}},
        "links": {"OA": {"length": a}, "AB": {"length": b}},
        "guides": [{"point": "B", "on": "frame", "through": [0.0, e], "direction": [1.0, 0.0]}],
        "drives": [{"link": "OA", "start": start, "speed": 1.0}],
        "assembly": {"sides": {"B": "ahead" if ahead else "behind"}},
    }
    spots = [(-math.pi / 2, min(0.5, reach / 2))]
    if e >= 0.0:
        spots.append((math.pi / 2, 0.5 if e == 0.0 else min(0.5, 2.0 * math.sqrt(e / a))))
    return Linkage(
        "aligned slider-crank", 1.0 if e == 0.0 else b / a, parts, dimensions, places, closures, ("B",), spots,
        max(a, b), reach=reach if e < 0.0 else math.inf,
    )  # fmt: skip


def axis_of(random: np.random.Generator) -> int:
    """Which axis the frame lies along."""
    return int(random.integers(4))
