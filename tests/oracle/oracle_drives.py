"""Mechanisms driven otherwise: two drives, a displacement, the coupler, a law of time; each with its loop equations."""

from __future__ import annotations

from typing import Any

import mpmath as mp
from oracle_parts import RAIL, Case, angles, both, e, loop, on_four_bar, pin, xy, z


def slider(s: Any) -> Any:
    """A point at a displacement along the rail."""
    d = z(RAIL[1])
    return z(RAIL[0]) + s * d / abs(d)


def elbow(t: Any) -> Any:
    first = mp.mpf(0.3) + t
    return mp.mpf(1.2) * e(first) + mp.mpf(0.9) * e(first + mp.mpf(0.9) + mp.sin(2 * t) / 2)


RELATIVE = Case(
    "drives of two links, one relative to the other",
    {
        "frame": {"points": {"O": [0, 0], "D": [3.0, 0.5]}},
        "links": {"OA": {"length": 1.2}, "AB": {"length": 0.9}, "BC": {"length": 2.2}, "DC": {"length": 1.8}},
        "drives": [
            {"link": "OA", "start": 0.3, "speed": 1.0},
            {"link": "AB", "relative_to": "OA", "start": 0.9, "law": "0.5*sin(2*t)"},
        ],
    },
    0.0,
    (0.8, 2.0),
    lambda t, x: both(elbow(t) + mp.mpf(2.2) * e(x[0]) - mp.mpc(3.0, 0.5) - mp.mpf(1.8) * e(x[1])),
    lambda t, x: {**xy(B=elbow(t), C=mp.mpc(3.0, 0.5) + mp.mpf(1.8) * e(x[1])), **angles(BC=x[0], DC=x[1])},
    driven=("OA", "AB"),
    unit=0.5,
)

DISPLACEMENT = Case(
    "displacement drive",
    {
        "frame": {"points": {"O": [0, 0]}},
        "links": {"OA": {"length": 1.1}, "AB": {"length": 2.9}},
        "guides": [{"point": "B", "through": list(RAIL[0]), "direction": list(RAIL[1])}],
        "drives": [{"guide": "B", "start": 2.6, "speed": 1.0}],
    },
    2.6,
    (0.9, -0.4),
    lambda s, x: both(mp.mpf(1.1) * e(x[0]) + mp.mpf(2.9) * e(x[1]) - slider(s)),
    lambda s, x: {**xy(B=slider(s), A=mp.mpf(1.1) * e(x[0])), **angles(OA=x[0], AB=x[1])},
    driven=(),
    unit=0.5,
)

COUPLER = Case(
    "RRR with a carriage: the coupler is driven",
    {
        "frame": {"points": {"O": [0, 0], "D": [4.0, 0.2]}},
        "links": {"OA": {"length": 4.6}, "AB": {"length": 2.0}, "DB": {"length": 5.1}},
        "drives": [{"link": "AB", "start": 2.9, "speed": 1.0}],
    },
    2.9,
    (0.9, 2.2),
    lambda q, x: both(mp.mpf(4.6) * e(x[0]) + 2 * e(q) - mp.mpc(4.0, 0.2) - mp.mpf(5.1) * e(x[1])),
    lambda q, x: {**xy(A=mp.mpf(4.6) * e(x[0])), **angles(OA=x[0], DB=x[1])},
    driven=("AB",),
)


def law(t: Any) -> Any:
    return mp.mpf(0.5) + mp.mpf(0.7) * mp.sin(mp.mpf(1.3) * t) + t * t / 4


LAW = Case(
    "drive by a law of time",
    {
        **on_four_bar({}),
        "drives": [{"link": "OA", "start": 0.5, "law": "0.7*sin(1.3*t) + t^2/4"}],
    },
    0.0,
    (0.6, 1.9),
    lambda t, x: loop(law(t), x[0], x[1]),
    lambda t, x: {**xy(A=pin(law(t))), **angles(OA=law(t), K=x[0], DB=x[1])},
    unit=0.8,
)

DRIVES = (RELATIVE, DISPLACEMENT, COUPLER, LAW)
