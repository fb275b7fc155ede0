"""Dyads on a turning crank: descriptions, dimensions near the borders of closing, and what closing means for each.

In every kind one number x(q) = c + r cos(q - g) of the crank's angle q decides: the squared distance of two centres,
a height above a line, the squared sine of half an arc. The dyad closes where a few numbers linear in x are positive.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

import centrode as ct

Array = npt.NDArray[np.float64]
Values = dict[str, Array]
START = 0.3
"""Of the crank in descriptions."""


@dataclass(frozen=True)
class Wave:
    """x(q) = middle + reach cos(q - crest), its parts over any numbers; `bounds` are (a, b) of factors a + b x."""

    middle: Any
    reach: Any
    crest: Any
    factors: list[tuple[Any, Any]]


@dataclass(frozen=True)
class Kind:
    """A kind of dyad: its description, its wave over a namespace of functions, and how dimensions are drawn.

    `wave` takes the values by path and a namespace with `sin`, `cos`, `atan2` and `sqrt`. `border` changes one
    dimension so that the dyad all but fails where x is greatest or least: it gets the extreme of x and the factor by
    which the border is missed.
    """

    name: str
    mechanism: ct.Mechanism
    draw: Callable[[np.random.Generator, int], Values]
    wave: Callable[[Values, Any], Wave]
    border: Callable[[Values, Array, Array, Array], None]


def _four_bar() -> Kind:
    paths = ("links.OA.length", "links.AB.length", "links.DB.length", "frame.points.D.x", "frame.points.D.y")
    crank, coupler, rocker, x, y = paths
    mechanism = ct.Mechanism(
        frame={"points": {"O": [0.0, 0.0], "D": [4.0, 0.5]}},
        links={
            "OA": {"length": 1.0},
            "AB": {"points": ["A", "B"], "length": 3.5},
            "DB": {"points": ["D", "B"], "length": 3.0},
        },
        drives=[{"link": "OA", "start": START, "speed": 1.0}],
        assembly={"sides": {"B": "left"}},
    )

    def draw(random: np.random.Generator, lanes: int) -> Values:
        values = {path: random.uniform(0.3, 3.0, lanes) for path in paths[:3]}
        values |= {x: random.uniform(-3.0, 3.0, lanes), y: random.uniform(-3.0, 3.0, lanes)}
        # pivots in one place, equal sides, kites
        same = random.random(lanes) < 0.1
        values[coupler] = np.where(same, np.hypot(values[x], values[y]), values[coupler])
        values[rocker] = np.where(same & (random.random(lanes) < 0.5), values[crank], values[rocker])
        flat = random.random(lanes) < 0.2
        values[y] = np.where(flat, 0.0, values[y])
        return values

    def wave(values: Values, m: Any) -> Wave:
        a, b, c, u, v = (values[path] for path in paths)
        way = m.sqrt(u * u + v * v)
        # |D - A|^2 is greatest where the crank points away from D
        middle, reach, crest = u * u + v * v + a * a, 2 * a * way, m.atan2(-v, -u)
        return Wave(middle, reach, crest, [((b + c) * (b + c), -1), (-((b - c) * (b - c)), 1)])

    def border(values: Values, least: Array, greatest: Array, by: Array) -> None:
        far = by > 0.0
        b = values[coupler]
        stretched = np.sqrt(greatest) * (1.0 + np.abs(by) * np.sign(np.sin(1e3 * b)))
        folded = np.sqrt(np.maximum(least, 0.0)) * (1.0 + np.abs(by) * np.sign(np.sin(1e3 * b)))
        share = 0.25 + 0.5 * (b / 3.0)
        values[coupler] = np.where(far, stretched * share, b)
        values[rocker] = np.where(far, stretched - stretched * share, b + folded)

    return Kind("four-bar", mechanism, draw, wave, border)


def _slider_crank() -> Kind:
    crank, rod, offset = "links.OA.length", "links.AB.length", "guides.B.through.y"
    mechanism = ct.Mechanism(
        frame={"points": {"O": [0.0, 0.0]}},
        links={"OA": {"length": 1.0}, "AB": {"points": ["A", "B"], "length": 3.0}},
        guides=[{"point": "B", "on": "frame", "through": [0.0, 0.3], "direction": [1.0, 0.0]}],
        drives=[{"link": "OA", "start": START, "speed": 1.0}],
        assembly={"sides": {"B": "ahead"}},
    )

    def draw(random: np.random.Generator, lanes: int) -> Values:
        values = {crank: random.uniform(0.3, 2.0, lanes), rod: random.uniform(0.3, 4.0, lanes)}
        values[offset] = np.where(random.random(lanes) < 0.3, 0.0, random.uniform(-1.5, 1.5, lanes))
        # a rod as long as the crank reaches its limit where the guide touches its circle
        same = random.random(lanes) < 0.1
        values[rod] = np.where(same, values[crank] + np.abs(values[offset]), values[rod])
        return values

    def wave(values: Values, m: Any) -> Wave:
        a, length, y = values[crank], values[rod], values[offset]
        # the height of A above the guide, a sin q - y
        return Wave(-y, a, m.atan2(1.0 + 0 * a, 0 * a), [(length, -1), (length, 1)])

    def border(values: Values, least: Array, greatest: Array, by: Array) -> None:
        height = np.where(by > 0.0, np.maximum(greatest, -least), np.maximum(-least, greatest))
        values[rod] = np.abs(height) * (1.0 + np.abs(by) * np.sign(np.sin(1e3 * values[rod])))

    return Kind("slider-crank", mechanism, draw, wave, border)


def _inverted() -> Kind:
    crank, x, y, offset = "links.OA.length", "frame.points.D.x", "frame.points.D.y", "guides.A.through.y"
    mechanism = ct.Mechanism(
        frame={"points": {"O": [0.0, 0.0], "D": [3.0, 0.5]}},
        links={"OA": {"length": 1.0}, "DE": {"points": {"D": [0.0, 0.0], "E": [4.5, 0.0]}, "angle": 3.143}},
        guides=[{"point": "A", "on": "DE", "through": [0.0, 0.2], "direction": [1.0, 0.0]}],
        drives=[{"link": "OA", "start": START, "speed": 1.0}],
    )

    def draw(random: np.random.Generator, lanes: int) -> Values:
        values = {crank: random.uniform(0.3, 3.0, lanes)}
        values |= {x: random.uniform(-3.0, 3.0, lanes), y: random.uniform(-3.0, 3.0, lanes)}
        values[offset] = random.uniform(-1.0, 1.0, lanes)
        values[y] = np.where(random.random(lanes) < 0.2, 0.0, values[y])
        return values

    def wave(values: Values, m: Any) -> Wave:
        a, u, v, e = values[crank], values[x], values[y], values[offset]
        way = m.sqrt(u * u + v * v)
        return Wave(u * u + v * v + a * a, 2 * a * way, m.atan2(-v, -u), [(-(e * e), 1)])

    def border(values: Values, least: Array, greatest: Array, by: Array) -> None:
        off = np.sqrt(np.maximum(least, 0.0)) * (1.0 + np.abs(by) * np.sign(np.sin(1e3 * values[offset])))
        values[offset] = np.where(by > 0.0, off, -off)

    return Kind("inverted slider-crank", mechanism, draw, wave, border)


def _spherical() -> Kind:
    crank, coupler, rocker, frame = (
        "links.AB.length", "links.BC.length", "links.DC.length", "frame.points.D.longitude",
    )  # fmt: skip
    mechanism = ct.Mechanism(
        space="sphere",
        frame={"points": {"A": [1.0, 0.0, 0.0], "D": [np.cos(1.2), np.sin(1.2), 0.0]}},
        links={
            "AB": {"length": 0.4, "reference": ["A", "D"]},
            "BC": {"points": ["B", "C"], "length": 0.9},
            "DC": {"points": ["D", "C"], "length": 1.0, "reference": ["D", "A"]},
        },
        drives=[{"link": "AB", "start": START, "speed": 1.0}],
        assembly={"sides": {"C": "left"}},
    )

    def draw(random: np.random.Generator, lanes: int) -> Values:
        values = {path: random.uniform(0.1, 1.5, lanes) for path in (crank, coupler, rocker)}
        values[frame] = random.uniform(0.1, 2.5, lanes)
        same = random.random(lanes) < 0.1
        values[coupler] = np.where(same, values[frame], values[coupler])
        values[rocker] = np.where(same, values[crank], values[rocker])
        return values

    def wave(values: Values, m: Any) -> Wave:
        a, b, c, d = values[crank], values[coupler], values[rocker], values[frame]
        total, apart = m.sin((b + c) / 2), m.sin((b - c) / 2)
        # the squared sine of half the arc from B to D, whose cosine is cos a cos d + sin a sin d cos q
        middle, reach = (1 - m.cos(a) * m.cos(d)) / 2, m.sin(a) * m.sin(d) / 2
        return Wave(middle, reach, m.atan2(0 * a, -1.0 + 0 * a), [(total * total, -1), (-(apart * apart), 1)])

    def border(values: Values, least: Array, greatest: Array, by: Array) -> None:
        far = by > 0.0
        b = values[coupler]
        aside = 1.0 + np.abs(by) * np.sign(np.sin(1e3 * b))
        stretched = 2.0 * np.arcsin(np.sqrt(np.minimum(greatest, 1.0))) * aside
        folded = 2.0 * np.arcsin(np.sqrt(np.maximum(least, 0.0))) * aside
        share = 0.25 + 0.3 * b
        values[coupler] = np.where(far, stretched * share, b)
        values[rocker] = np.where(far, stretched - stretched * share, b + folded)

    return Kind("spherical four-bar", mechanism, draw, wave, border)


KINDS = (_four_bar(), _slider_crank(), _inverted(), _spherical())
