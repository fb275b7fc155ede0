"""Mechanisms left to themselves, for the tests of forward dynamics."""

from __future__ import annotations

import math
from typing import Any

import centrode as ct

Parts = dict[str, Any]
GRAVITY = [0.0, -9.81]


def rod(
    first: str, second: str, length: float, angle: float | None = None, mass: float | None = None
) -> Parts:
    """A thin rod of 1 kg/m, or of a mass."""
    points = {first: [0.0, 0.0], second: [length, 0.0]}
    return {"points": points, "mass": length if mass is None else mass, "shape": "rod", "angle": angle}


def four_bar(
    crank: float = 0.3, coupler: float = 0.8, rocker: float = 0.6, base: float = 0.9, **more: Any
) -> Parts:
    """A four-bar linkage of rods with its crank at 60 degrees."""
    return {
        "gravity": GRAVITY,
        "frame": {"points": {"A": [0.0, 0.0], "D": [base, 0.0]}},
        "links": {
            "AB": rod("A", "B", crank),
            "BC": rod("B", "C", coupler),
            "DC": rod("D", "C", rocker),
        },
        "drives": [{"link": "AB", "start": math.pi / 3, "speed": 1.0}],
        "assembly": {"sides": {"C": "left"}},
        **more,
    }


def parallelogram(cranks: int) -> Parts:
    """A bar on parallel cranks: with three of them one closure repeats the others."""
    points = {f"B{k}": [float(k), 0.0] for k in range(cranks)}
    links: Parts = {"bar": {"points": points, "mass": 2.0, "shape": "rod"}}
    links |= {f"crank{k}": rod(f"A{k}", f"B{k}", 0.5, 0.7) for k in range(cranks)}
    return {
        "gravity": GRAVITY,
        "frame": {"points": {f"A{k}": [float(k), 0.0] for k in range(cranks)}},
        "links": dict(reversed(links.items())) | {"bar": {**links["bar"], "angle": 0.0}},
    }


def slider_crank(**more: Any) -> Parts:
    """A slider-crank with a heavy piston; crank at 40 degrees."""
    return {
        "gravity": GRAVITY,
        "frame": {"points": {"O": [0.0, 0.0]}},
        "links": {
            "OA": rod("O", "A", 0.2),
            "AB": rod("A", "B", 0.7),
            "piston": {"points": {"B": [0.0, 0.0]}, "mass": 1.5},
        },
        "guides": [
            {
                "name": "B",
                "point": "B",
                "on": "frame",
                "through": "O",
                "direction": [1.0, 0.0],
                "link": "piston",
            }
        ],
        "drives": [{"link": "OA", "start": 0.7, "speed": 1.0}],
        "assembly": {"sides": {"B": "ahead"}},
        **more,
    }


def mechanism(parts: Parts) -> ct.Mechanism:
    """The mechanism of a description."""
    return ct.Mechanism(**parts)
