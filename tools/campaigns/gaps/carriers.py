"""What carries the dyad: points that move as the crank turns, by formulas of their own over whole arrays.

A point on two guides runs to infinity where these are parallel; the pins of four-bars and slider-cranks stay near.
"""

from __future__ import annotations

import cmath
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from tools.campaigns.gaps.scan import minima

Array = npt.NDArray[np.float64]
Complex = npt.NDArray[np.complex128]


@dataclass(frozen=True)
class Carrier:
    """A point P of a chain driven at OA: where it is, and what vanishes where it runs to infinity."""

    kind: str
    parts: dict[str, Any]
    place: Callable[[Array], Complex]
    divisor: Callable[[Array], Array] | None = None


def crank(random: np.random.Generator, start: float) -> tuple[dict[str, Any], float]:
    """The description of a crank alone, and its length."""
    length = float(random.uniform(0.3, 1.0))
    parts = {
        "frame": {"points": {"O": [0.0, 0.0]}},
        "links": {"OA": {"length": length}},
        "guides": [],
        "drives": [{"link": "OA", "start": start, "speed": 1.0}],
        "assembly": {"sides": {}},
    }
    return parts, length


def crossing_lines(random: np.random.Generator, start: float) -> Carrier:
    """P on a line of the frame and on a line of the crank."""
    parts, _length = crank(random, start)
    through = complex(*random.uniform(-1.5, 1.5, 2))
    heading = float(random.uniform(-np.pi, np.pi))
    local = complex(*random.uniform(-1.0, 1.0, 2))
    # the crank's line meets the frame's at a wide angle in the initial position
    own = heading + float(random.choice([-1.0, 1.0])) * float(random.uniform(0.4, 2.7)) - start
    parts["guides"] = [guide("still", "frame", through, heading), guide("turning", "OA", local, own)]
    along = cmath.exp(1j * heading)

    def divisor(q: Array) -> Array:
        return np.sin(q + own - heading)

    def place(q: Array) -> Complex:
        unit, foot = np.exp(1j * (q + own)), local * np.exp(1j * q)
        # through + s along on the crank's line: Im((through + s along - foot) conj(unit)) = 0
        s = np.imag((foot - through) * np.conj(unit)) / np.imag(along * np.conj(unit))
        return np.asarray(through + s * along)

    return Carrier("point on two guides", parts, place, divisor)


def coupler(random: np.random.Generator, start: float) -> Carrier:
    """P the pin between coupler and rocker of a crank-rocker."""
    parts, a = crank(random, start)
    d = a + float(random.uniform(0.5, 2.0))
    b = d * float(random.uniform(0.9, 1.5))
    c = float(random.uniform(max(d + a - b, b - (d - a)) * 1.1, b + d - a)) if b < 2 * d else d
    side = float(random.choice([-1.0, 1.0]))
    parts["frame"]["points"]["D"] = [d, 0.0]
    parts["links"] |= {
        "AP": {"points": ["A", "P"], "length": b},
        "DP": {"points": ["D", "P"], "length": c},
    }
    parts["assembly"]["sides"]["P"] = "left" if side > 0.0 else "right"

    def place(q: Array) -> Complex:
        pin = a * np.exp(1j * q)
        return meeting(pin, b, np.full_like(pin, d), c, side)

    return Carrier("pin of a four-bar", parts, place)


def swinging_line(random: np.random.Generator, start: float) -> Carrier:
    """P on lines of frame and rocker that are all but parallel, or just past it, where the rocker turns back."""
    carried = coupler(random, start)
    parts, place = carried.parts, carried.place
    d = parts["frame"]["points"]["D"][0]
    parts["links"] = {
        name.replace("P", "B"): {**link, "points": [x.replace("P", "B") for x in link["points"]]}
        if "points" in link
        else link
        for name, link in parts["links"].items()
    }
    parts["assembly"]["sides"] = {"B": parts["assembly"]["sides"]["P"]}

    middle = float(np.angle(place(np.array([start]))[0] - d))

    def angle(q: Array) -> Array:
        return np.asarray(np.angle((place(q) - d) * np.exp(-1j * middle)))

    nodes = np.linspace(start - np.pi, start + np.pi, 2001)
    side = float(random.choice([-1.0, 1.0]))
    ends = minima(lambda q: side * angle(q), nodes)
    if not len(ends):  # it turns back next to the end of the turn
        ends = nodes[[np.argmin(side * angle(nodes))]]
    past = side * float(random.choice([1.0, 1.0, -1.0])) * 10.0 ** -float(random.uniform(3.0, 9.0))
    extreme = float(np.min(side * angle(ends))) * side + past
    through, local = complex(*random.uniform(-1.5, 1.5, 2)), complex(*random.uniform(-1.0, 1.0, 2))
    heading = float(random.uniform(-np.pi, np.pi))
    # parallel where the rocker's angle, counted from its first one, is the extreme
    own = heading - extreme - middle
    along = cmath.exp(1j * heading)
    parts["guides"] = [
        guide("still", "frame", through, heading),
        guide("turning", "DB", local, own),
    ]

    def divisor(q: Array) -> Array:
        return np.asarray(np.sin(angle(q) - extreme))

    def meeting_place(q: Array) -> Complex:
        turn = np.exp(1j * (angle(q) + middle))
        unit, foot = turn * cmath.exp(1j * own), d + local * turn
        s = np.imag((foot - through) * np.conj(unit)) / np.imag(along * np.conj(unit))
        return np.asarray(through + s * along)

    return Carrier("point on guides of rocker and frame", parts, meeting_place, divisor)


def guide(name: str, on: str, through: complex, direction: float) -> dict[str, Any]:
    """A guide of P."""
    return {
        "name": name,
        "point": "P",
        "on": on,
        "through": [through.real, through.imag],
        "direction": direction,
    }


def slider(random: np.random.Generator, start: float) -> Carrier:
    """P the slider of a slider-crank."""
    parts, a = crank(random, start)
    e = float(random.uniform(-0.5, 0.5))
    b = (a + abs(e)) * float(random.uniform(1.1, 3.0))
    sense = float(random.choice([-1.0, 1.0]))
    parts["links"]["AP"] = {"points": ["A", "P"], "length": b}
    parts["guides"] = [{"point": "P", "on": "frame", "through": [0.0, e], "direction": [1.0, 0.0]}]
    parts["assembly"]["sides"]["P"] = "ahead" if sense > 0.0 else "behind"

    def place(q: Array) -> Complex:
        x, y = a * np.cos(q), a * np.sin(q)
        return np.asarray(x + sense * np.sqrt(b**2 - (e - y) ** 2) + 1j * e)

    return Carrier("slider of a slider-crank", parts, place)


def meeting(first: Complex, b: float, second: Complex, c: float, side: float) -> Complex:
    """Where circles about two places meet, left (side 1) or right (-1) of the line from the first to the second."""
    between = second - first
    square = np.abs(between) ** 2
    along = (square + b**2 - c**2) / (2.0 * square)
    height = np.sqrt(np.maximum(b**2 / square - along**2, 0.0))
    return np.asarray(first + between * (along + 1j * side * height))


CARRIERS: tuple[Callable[[np.random.Generator, float], Carrier], ...] = (
    crossing_lines, crossing_lines, swinging_line, swinging_line, coupler, slider,
)  # fmt: skip
