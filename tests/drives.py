"""Mechanisms with several drives for tests, and when they close."""

from __future__ import annotations

from typing import Any

import numpy as np

import centrode as ct


def five_bar(
    a: float = 0.5,
    rods: tuple[float, float] = (0.7, 0.4),
    c: float = 0.5,
    d: float = 1.0,
    start: tuple[float, float] = (1.0, 1.8),
    **more: Any,
) -> ct.Mechanism:
    """Cranks OA and EC, rods AB and CB: it closes where |AC| lies between the difference and the sum of the rods."""
    parts: dict[str, Any] = {
        "frame": {"points": {"O": [0.0, 0.0], "E": [d, 0.0]}},
        "links": {
            "OA": {"length": a},
            "AB": {"length": rods[0]},
            "CB": {"length": rods[1]},
            "EC": {"length": c},
        },
        "drives": [
            {"link": "OA", "start": start[0], "speed": 1.0},
            {"link": "EC", "start": start[1], "speed": -2.0},
        ],
        "assembly": {"sides": {"B": "left"}},
    }
    return ct.Mechanism(**{**parts, **more})


def apart(mechanism: ct.Mechanism, first: Any, second: Any) -> Any:
    """|AC| of a five-bar by the angles of its cranks."""
    lengths = {name: link.length for name, link in mechanism.links.items()}
    d = mechanism.frame.points["E"][0]
    return np.abs(lengths["OA"] * np.exp(1j * first) - d - lengths["EC"] * np.exp(1j * second))


def least_and_greatest(mechanism: ct.Mechanism) -> tuple[float, float]:
    rods = [mechanism.links[name].length for name in ("AB", "CB")]
    return abs(rods[0] - rods[1]), rods[0] + rods[1]


def three_cranks() -> ct.Mechanism:
    """A third motor turns the arm on which the second crank stands."""
    return ct.Mechanism(
        frame={"points": {"O": [0.0, 0.0], "H": [1.5, 0.0]}},
        links={
            "HE": {"length": 0.5},
            "OA": {"length": 0.5},
            "AB": {"length": 0.7},
            "CB": {"length": 0.4},
            "EC": {"length": 0.5},
        },
        drives=[
            {"link": "OA", "start": 1.0, "speed": 1.0},
            {"link": "HE", "start": np.pi, "speed": 0.1},
            {"link": "EC", "start": 1.8, "speed": -2.0},
        ],
        assembly={"sides": {"B": "left"}},
    )
