"""Mechanisms with cranks and the dyads RRR and RRP, each with the loop equations that define its motion."""

from __future__ import annotations

from typing import Any

import mpmath as mp
from oracle_parts import (
    FOUR_BAR,
    LOW,
    RAIL,
    SLOT,
    Case,
    P,
    along,
    angles,
    both,
    drive,
    e,
    in_coupler,
    loop,
    off,
    on_four_bar,
    one_crank,
    pin,
    xy,
    z,
)  # fmt: skip

E_LOCAL = (0.6, -0.35)
CRANK = Case(
    "crank and rigid point",
    {
        "frame": {"points": {"O": [0.2, -0.1]}},
        "links": {"OA": {"points": {"O": [0, 0], "A": [1.1, 0], "E": list(E_LOCAL)}}},
        "drives": drive(0.4),
    },
    0.4,
    (),
    lambda q, x: [],
    lambda q, x: xy(E=mp.mpc(0.2, -0.1) + z(E_LOCAL) * e(q)),
)

RRR = Case(
    "RRR with a rigid point",
    FOUR_BAR,
    0.7,
    (0.6, 1.9),
    lambda q, x: loop(q, x[0], x[1]),
    lambda q, x: {**xy(P=pin(q) + z(P) * e(x[0])), **angles(K=x[0], DB=x[1])},
)

F = (0.4, 3.6)
RRR_MOVING = Case(
    "RRR between moving links",
    on_four_bar({"PR": {"length": 1.9}, "FR": {"length": 2.1}}, F=list(F)),
    0.7,
    (0.6, 1.9, 2.0, 0.2),
    lambda q, x: [
        *loop(q, x[0], x[1]),
        *both(pin(q) + z(P) * e(x[0]) + mp.mpf(1.9) * e(x[2]) - z(F) - mp.mpf(2.1) * e(x[3])),
    ],
    lambda q, x: {**xy(R=z(F) + mp.mpf(2.1) * e(x[3])), **angles(K=x[0], PR=x[2], FR=x[3])},
)

RRP = Case(
    "RRP",
    one_crank(
        {"AB": {"length": 2.9}}, [{"point": "B", "through": list(RAIL[0]), "direction": list(RAIL[1])}], 0.8
    ),
    0.8,
    (-0.4,),
    lambda q, x: [off(pin(q) + mp.mpf(2.9) * e(x[0]), *RAIL)],
    lambda q, x: {
        **xy(B=pin(q) + mp.mpf(2.9) * e(x[0])),
        **angles(AB=x[0]),
        "slide:B": along(pin(q) + mp.mpf(2.9) * e(x[0]), *RAIL),
    },
)


RRP_MOVING = Case(
    "RRP, its guide on a moving link",
    on_four_bar(
        {"FG": {"length": 4.1}},
        [{"point": "G", "on": "K", "through": list(SLOT[0]), "direction": list(SLOT[1])}],
        F=list(LOW),
    ),
    0.7,
    (0.6, 1.9, 1.6),
    lambda q, x: [*loop(q, x[0], x[1]), off(in_coupler(q, x[0], z(LOW) + mp.mpf(4.1) * e(x[2])), *SLOT)],
    lambda q, x: {
        **xy(G=z(LOW) + mp.mpf(4.1) * e(x[2])),
        **angles(K=x[0], FG=x[2]),
        "slide:G": along(in_coupler(q, x[0], z(LOW) + mp.mpf(4.1) * e(x[2])), *SLOT),
    },
)

HINGE = (0.25, 0.4)


def carriage_hinge(s: Any) -> Any:
    d = z(RAIL[1])
    return z(RAIL[0]) + s * d / abs(d) + z(HINGE) * e(mp.mpf(0.3))


RRP_CARRIAGE = Case(
    "RRP with a carriage",
    one_crank(
        {"AH": {"length": 2.9}, "block": {"points": {"G": [0, 0], "H": list(HINGE)}, "angle": 0.3}},
        [{"point": "G", "through": list(RAIL[0]), "direction": list(RAIL[1]), "link": "block", "angle": 0.3}],
        0.8,
    ),
    0.8,
    (-0.4, 3.0),
    lambda q, x: both(pin(q) + mp.mpf(2.9) * e(x[0]) - carriage_hinge(x[1])),
    lambda q, x: {**xy(H=carriage_hinge(x[1])), **angles(AH=x[0]), "slide:G": x[1]},
)


def moving_hinge(q: Any, theta: Any, s: Any) -> Any:
    d = z(SLOT[1])
    return pin(q) + (z(SLOT[0]) + s * d / abs(d) + z(HINGE) * e(mp.mpf(0.3))) * e(theta)


RRP_CARRIAGE_MOVING = Case(
    "RRP with a carriage on a moving link",
    on_four_bar(
        {"FH": {"length": 4.1}, "block": {"points": {"G": [0, 0], "H": list(HINGE)}}},
        [
            {
                "point": "G", "on": "K", "through": list(SLOT[0]), "direction": list(SLOT[1]),
                "link": "block", "angle": 0.3,
            }
        ],
        F=list(LOW),
    ),
    0.7,
    (0.6, 1.9, 1.6, 1.0),
    lambda q, x: [
        *loop(q, x[0], x[1]),
        *both(z(LOW) + mp.mpf(4.1) * e(x[2]) - moving_hinge(q, x[0], x[3])),
    ],
    lambda q, x: {
        **xy(H=moving_hinge(q, x[0], x[3])),
        **angles(K=x[0], FH=x[2], block=x[0] + mp.mpf(0.3)),
        "slide:G": x[3],
    },
)  # fmt: skip

CASES = (CRANK, RRR, RRR_MOVING, RRP, RRP_MOVING, RRP_CARRIAGE, RRP_CARRIAGE_MOVING)
