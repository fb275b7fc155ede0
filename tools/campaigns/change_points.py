"""Linkages that pass change points, against closed forms in which the passage is a factor, at 80 digits.

A parallelogram and its like have a coupler curve that falls apart into two factors. To pass a change point
smoothly is to stay on one of them, so the truth needs no decision. Dimensions and values of the drive are taken as
the very doubles that the program has.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any

import mpmath
import numpy as np
import numpy.typing as npt

import centrode as ct
from centrode.algebra import machine_code
from tools.campaigns.campaign import Campaign, Outcome, random_of

Array = npt.NDArray[np.float64]
Place = tuple[Any, ...]
"""Coordinates of a point as numbers of mpmath."""
Places = dict[str, Place]

DIGITS = 80
STEP = mpmath.mpf(10) ** -20
"""Step of difference quotients: at `DIGITS` their errors are below 1e-28 of the derivative, however sharp the bend."""
NUDGE = mpmath.mpf(10) ** -30
"""Relative change of a dimension by which the answer to its rounding is measured."""
ULP = 2.0**-53
"""Relative error of a rounded number."""
ORDERS = ("position", "velocity", "acceleration")
BOUNDS = (1e-12, 1e-10, 1e-8)
"""Errors in units of the size, per rad and per rad^2, where |1 - ratio| is `WIDE` or more."""
WIDE = 1e-2
TIMES = 100.0
"""Errors nearer to ratio 1, in units of what rounding of the dimensions and of the drive's value makes there.

The bounds of wide ratios hold where this is less."""
LANES = 4


@dataclass(frozen=True)
class Linkage:
    """A linkage with change points whose motion is known.

    `dimensions` are the doubles by their paths; `places` gives the points' places from them and the drive's value
    (numbers of mpmath, all equal dimensions equal), `closures` the conditions that hold of them if each dimension is a
    number of its own. `spots` are the change points and sharp bends within a turn, with the width of the bend [rad].
    """

    kind: str
    ratio: float
    parts: dict[str, Any]
    dimensions: dict[str, float]
    places: Callable[[Mapping[str, Any], Any], Places]
    closures: Callable[[Mapping[str, Any], Any, Places], list[Any]]
    free: tuple[str, ...]
    spots: list[tuple[float, float]]
    size: float
    vary: dict[str, str] = field(default_factory=dict)
    reach: float = math.inf

    @property
    def gap(self) -> float:
        """How far the ratio is from 1."""
        return abs(1.0 - self.ratio)

    @property
    def chained(self) -> bool:
        """Whether groups stand on one another, so that their conditions multiply."""
        return len(self.free) > 1

    @property
    def row(self) -> str:
        """The row of the table that the linkage belongs to."""
        return f"{self.kind}, {decade(self.gap)}"

    def exact(self, value: float) -> list[Places]:
        """Places of the points with two derivatives by the drive's value."""
        with mpmath.workdps(DIGITS):
            numbers = {path: mpmath.mpf(x) for path, x in self.dimensions.items()}
            at = mpmath.mpf(value)
            return differenced(lambda q: self.places(numbers, q), at)

    def answer(self, value: float) -> list[float]:
        """What rounding of each dimension and of the drive's value makes of the places and their derivatives."""
        with mpmath.workdps(DIGITS + 20):
            numbers = {path: mpmath.mpf(x) for path, x in self.dimensions.items()}
            at = mpmath.mpf(value)
            base = differenced(lambda q: self.places(numbers, q), at)
            total = [mpmath.mpf(0)] * 3
            for path, x in [*numbers.items(), ("", at)]:
                by = abs(x) * NUDGE
                changed = {**numbers, path: x + by} if path else numbers
                shift = mpmath.mpf(0) if path else by
                moved = differenced(partial(self.shifted, changed, shift), at)
                for order in range(3):
                    total[order] += distance(moved[order], base[order], self.free) / NUDGE * ULP
            return [float(x) / self.size for x in total]

    def shifted(self, numbers: Mapping[str, Any], shift: Any, q: Any) -> Places:
        """The places at a value of the drive a little off."""
        return self.solved(numbers, q + shift)

    def solved(self, numbers: Mapping[str, Any], q: Any) -> Places:
        """The places that close with dimensions a little off, by Newton's method from those without."""
        exact = self.places({path: mpmath.mpf(x) for path, x in self.dimensions.items()}, q)
        labels = [(name, k) for name in self.free for k in range(len(exact[name]))]
        places = dict(exact)
        for _ in range(3):
            residual = self.closures(numbers, q, places)
            rows = mpmath.matrix(len(residual), len(labels))
            for column, (name, k) in enumerate(labels):
                nudged = dict(places)
                by = NUDGE * self.size
                nudged[name] = tuple(x + by if i == k else x for i, x in enumerate(places[name]))
                for row, (after, before) in enumerate(
                    zip(self.closures(numbers, q, nudged), residual, strict=True)
                ):
                    rows[row, column] = (after - before) / by
            step = mpmath.lu_solve(rows, mpmath.matrix([-x for x in residual]))
            for column, (name, k) in enumerate(labels):
                places[name] = tuple(x + step[column] if i == k else x for i, x in enumerate(places[name]))
        return places


def differenced(places: Callable[[Any], Places], at: Any) -> list[Places]:
    """A curve with its first and second derivative, by difference quotients."""
    before, here, after = places(at - STEP), places(at), places(at + STEP)
    first, second = {}, {}
    for name in here:
        ends = list(zip(before[name], here[name], after[name], strict=True))
        first[name] = tuple((c - a) / (2 * STEP) for a, _b, c in ends)
        second[name] = tuple((a - 2 * b + c) / STEP**2 for a, b, c in ends)
    return [here, first, second]


def distance(one: Places, other: Places, names: tuple[str, ...]) -> Any:
    """Greatest difference of two sets of places."""
    return max(abs(x - y) for name in names for x, y in zip(one[name], other[name], strict=True))


def decade(gap: float) -> str:
    """The decade of |1 - ratio| in words."""
    if gap == 0.0:
        return "no ratio"
    power = math.floor(math.log10(gap) + 1e-9)
    return "|1 - ratio| from 0.1" if power >= -1 else f"|1 - ratio| from 1e{power}"


# --- in the plane: the frame lies along one of the axes, so that its length is the double given


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


# --- on the sphere: the first pivot on the x axis, the second on the equator


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


X, Y = (mpmath.mpf(1), mpmath.mpf(0), mpmath.mpf(0)), (mpmath.mpf(0), mpmath.mpf(1), mpmath.mpf(0))


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


def bend(one: float, other: float) -> float:
    """Width of the bend of a linkage whose pin passes close by the other pivot [rad]."""
    return min(0.5, abs(one - other) / (one + other))


def dyadic(x: float) -> float:
    """The nearest number with few digits, so that sums of such are exact."""
    return math.ldexp(round(math.ldexp(float(x), 40)), -40)


def axis_of(random: np.random.Generator) -> int:
    """Which axis the frame lies along."""
    return int(random.integers(4))


def beginning(random: np.random.Generator) -> float:
    """A start of the drive away from change points at 0 and pi."""
    return float(random.choice([-1.0, 1.0]) * random.uniform(0.6, 2.5))


def ratio_of(random: np.random.Generator) -> float:
    """A ratio from 0.05 to 20; half of them near 1, all decades down to 1e-6 alike."""
    if random.random() < 0.5:
        return float(1.0 + random.choice([-1.0, 1.0]) * 10.0 ** -random.uniform(1.0, 6.0))
    return float(np.exp(random.uniform(math.log(0.05), math.log(20.0))))


KINDS: tuple[Callable[[np.random.Generator, float], Linkage], ...] = (
    lambda random, ratio: parallelogram(random, ratio, crossed=False),
    lambda random, ratio: parallelogram(random, ratio, crossed=True),
    lambda random, ratio: parallelogram(random, ratio, crossed=True),
    kite,
    galloway,
    in_line,
    aligned_slider_crank,
    chain,
    lambda random, ratio: spherical_parallelogram(random, ratio, crossed=False),
    lambda random, ratio: spherical_parallelogram(random, ratio, crossed=True),
    spherical_kite,
    spherical_slider_crank,
)
WAYS = ("alone", "alone", "alone", "alone", "batch", "machine code")


def drawn(seed: int, number: int) -> tuple[Linkage, str, np.random.Generator]:
    """The linkage of a case, and how it is computed."""
    random = random_of(seed, number)
    kind = KINDS[int(random.integers(len(KINDS)))]
    linkage = kind(random, ratio_of(random))
    way = str(random.choice(WAYS))
    if (way != "alone" and not linkage.vary) or (way == "machine code" and not machine_code.PRESENT):
        way = "alone"
    return linkage, way, random


def values_of(linkage: Linkage, random: np.random.Generator) -> Array:
    """Values of the drive: two turns evenly, and on, beside and far nearer to each spot than its width."""
    begun = linkage.parts["drives"][0]["start"]
    if math.isinf(linkage.reach):
        found = list(np.linspace(begun - 2.0 * math.pi, begun + 2.0 * math.pi, 33))
    else:
        found = list(linkage.spots[0][0] + np.linspace(-0.9, 0.9, 33) * linkage.reach)
    for spot, width in linkage.spots:
        shifts = (-2, 0, 2) if math.isinf(linkage.reach) else (0,)
        at = spot + math.pi * float(random.choice(shifts))
        found.append(at)
        for power in range(7):
            found += [at + sign * width * 10.0 ** -(power * random.uniform(0.9, 1.1)) for sign in (-1.0, 1.0)]
        found += list(at + random.uniform(-2.0, 2.0, 4) * width)
    return np.array(found)


def compare(
    outcome: Outcome, linkage: Linkage, found: Mapping[str, Array], values: Array, row: str
) -> list[float]:
    """Keep the errors of a motion: `found` has (samples, orders, axes) for each point; returns the worst ones."""
    worst = [0.0] * 3
    for k, value in enumerate(values):
        exact = linkage.exact(float(value))
        for name in linkage.free:
            for order in range(3):
                truth = exact[order][name]
                error = max(
                    abs(float(mpmath.mpf(float(x)) - y))
                    for x, y in zip(found[name][k, order], truth, strict=True)
                )
                worst[order] = max(worst[order], error / linkage.size)
    answers = [linkage.answer(at) for at in places_of_rounding(linkage)]
    rounding = [max(one[order] for one in answers) for order in range(3)]
    for order, name in enumerate(ORDERS):
        outcome.measure(row, name, worst[order])
        outcome.measure(row, "times rounding", worst[order] / rounding[order])
        bound = BOUNDS[order]
        if 0.0 < linkage.gap < WIDE or linkage.chained:
            bound = max(bound, TIMES * rounding[order])
        if not worst[order] <= bound:
            outcome.fault(
                f"{row} ({linkage.ratio!r}): {name} off by {worst[order]:.2g} of the size, bound {bound:.2g}"
            )
    return worst


def places_of_rounding(linkage: Linkage) -> list[float]:
    """Where the answer to rounding is measured: about each spot at half its width and more, and along the turn.

    At a change point itself it is infinite, for the least change of one dimension makes limits of it.
    """
    begun = linkage.parts["drives"][0]["start"]
    around = [spot + times * width for spot, width in linkage.spots for times in (-2.0, -0.5, 0.5, 1.0)]
    if math.isinf(linkage.reach):
        return [*around, begun, begun + 1.6, begun + 3.0]
    return [at for at in around if abs(at - linkage.spots[0][0]) < 0.9 * linkage.reach] + [begun]


def alone(outcome: Outcome, linkage: Linkage, random: np.random.Generator) -> None:
    """One motion at values on and about the change points."""
    values = values_of(linkage, random)
    data = ct.motion(ct.Mechanism(**linkage.parts), at=values)
    status = data.status.to_numpy()
    outcome.count("samples", len(values))
    if (status != 0).any():
        outcome.fault(f"{linkage.row} ({linkage.ratio!r}): {told(status)}")
        return
    found = {
        name: np.stack([data[order].sel(point=name).to_numpy() for order in ORDERS], axis=1)
        for name in linkage.free
    }
    compare(outcome, linkage, found, values, linkage.row)


def told(status: npt.NDArray[Any]) -> str:
    """How many samples have each status."""
    codes, counts = np.unique(status, return_counts=True)
    return ", ".join(
        f"{ct.Status(int(code)).word} {count}" for code, count in zip(codes, counts, strict=True)
    )


def lanes_of(linkage: Linkage, random: np.random.Generator) -> list[Linkage]:
    """The linkage with other ratios on the same side of 1, one a lane: the first keeps its own."""
    (one, *_rest) = linkage.vary
    own = linkage.dimensions[one]
    base = own / linkage.ratio
    lanes = []
    for lane in range(LANES):
        near = 1.0 + math.copysign(10.0 ** -random.uniform(0.5, 6.0), linkage.ratio - 1.0)
        length = own if lane == 0 else float(base * near)
        dimensions = {path: length if path in linkage.vary else x for path, x in linkage.dimensions.items()}
        spots = [
            (at, bend(length, base) if width != 0.5 or at != linkage.spots[1][0] else width)
            for at, width in linkage.spots
        ]
        if linkage.kind == "kite, coupler as rocker":
            spots = [
                (linkage.spots[0][0], 0.5),
                (linkage.spots[1][0], min(0.5, math.sqrt(2.0 * (length / base - 1.0)))),
            ]
        size = max(length, *linkage.dimensions.values())
        lanes.append(replace(linkage, ratio=length / base, dimensions=dimensions, spots=spots, size=size))
    return lanes


def batch(outcome: Outcome, linkage: Linkage, random: np.random.Generator) -> None:
    """Several mechanisms in one motion."""
    lanes = lanes_of(linkage, random)
    values = values_of(linkage, random)
    vary = {path: np.array([lane.dimensions[path] for lane in lanes]) for path in linkage.vary}
    data = ct.motion(ct.Mechanism(**linkage.parts), at=values, vary=vary)
    for k, lane in enumerate(lanes):
        own = data.isel(mechanism=k)
        outcome.count("samples", len(values))
        if (own.status != 0).any():
            outcome.fault(
                f"{lane.row} ({lane.ratio!r}), mechanism {k} of a batch: {told(own.status.to_numpy())}"
            )
            continue
        found = {"B": np.stack([own[order].sel(point="B").to_numpy() for order in ORDERS], axis=1)}
        compare(outcome, lane, found, values, lane.row)


def compiled(outcome: Outcome, linkage: Linkage, random: np.random.Generator) -> None:
    """Several mechanisms in a sweep by machine code, over a narrow range about a change point or over two turns."""
    lanes = lanes_of(linkage, random)
    spot, width = linkage.spots[int(random.integers(len(linkage.spots)))]
    about = 5.0 * width if random.random() < 0.5 else 2.0 * math.pi
    span: dict[str, Any] = {"samples": 41, "start": spot - about, "stop": spot + about}
    mechanism = ct.Mechanism(**linkage.parts)
    vary = {path: np.array([lane.dimensions[path] for lane in lanes]) for path in linkage.vary}
    outputs = [f"{order}.B" for order in ORDERS]
    data = ct.sweep(mechanism, vary, outputs, executor="machine code", **span)
    values = ct.motion(mechanism, **span).drive_value.to_numpy()[:, 0]
    for k, lane in enumerate(lanes):
        own = data.isel(mechanism=k)
        outcome.count("samples", len(values))
        if (own.status != 0).any():
            outcome.fault(
                f"{lane.row} ({lane.ratio!r}), mechanism {k} of a sweep: {told(own.status.to_numpy())}"
            )
            continue
        found = {"B": np.stack([own[name].to_numpy() for name in outputs], axis=1)}
        compare(outcome, lane, found, values, lane.row)


def run(seed: int, number: int) -> Outcome:
    """One linkage, alone, in a batch or in a sweep by machine code."""
    linkage, way, random = drawn(seed, number)
    outcome = Outcome(
        f"# {way}, ratio {linkage.ratio!r}\n" + ct.mechanism_text(ct.Mechanism(**linkage.parts))
    )
    outcome.count(way)
    {"alone": alone, "batch": batch, "machine code": compiled}[way](outcome, linkage, random)
    return outcome


CAMPAIGN = Campaign(
    name="change-points",
    title="Change points",
    about="""Parallelograms, antiparallelograms, kites, in-line four-bars and aligned slider-cranks, in the plane and
on the sphere, alone, in chains, in batches and in sweeps by machine code. The ratio of crank to frame (of coupler to
rocker, or of coupler to crank, where these make the bend) goes from 0.05 to 20. Half of the cases lie within 0.1 of
ratio 1, down to 1e-6.

The truth is a closed form in which the passage of the change point is a factor, computed with 80 digits from the very
doubles that the program is given; derivatives are difference quotients at 80 digits. What rounding makes is the answer
of the closure equations to one rounding of each dimension and of the drive's value, the greatest along the turn and
about the bends, not nearer to a change point than half the width of its bend.""",
    columns={
        "position": "greatest error of a place in the size of the mechanism; bound 1e-12 where |1 - ratio| >= 0.01",
        "velocity": "of its first derivative by the drive's value; bound 1e-10",
        "acceleration": "of its second derivative; bound 1e-8",
        "times rounding": (
            "the greatest of these three over what rounding alone makes; below 0.01 the bound is 100, or the bounds "
            "above where these are greater"
        ),
    },
    run=run,
    cases=2000,
)
