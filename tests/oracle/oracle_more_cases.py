"""Mechanisms with the dyads RPR, PRP, RPP and parallel links, each with its loop equations."""

from __future__ import annotations

from typing import Any

import mpmath as mp
from oracle_parts import (
    LOW,
    RAIL,
    SLOT,
    Case,
    along,
    angles,
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

SLIT = ((0.1, 0.35), (1.0, -0.2))
PIVOT = (2.8, -0.4)
TIP = (3.5, 0.6)


def in_lever(point: Any, psi: Any) -> Any:
    """A place in the axes of a lever about PIVOT."""
    return (point - z(PIVOT)) * e(-psi)


LEVER = {"lever": {"points": {"D": [0, 0], "E": list(TIP)}}}
RPR = Case(
    "RPR",
    one_crank(
        LEVER,
        [{"point": "A", "on": "lever", "through": list(SLIT[0]), "direction": list(SLIT[1])}],
        0.9,
        D=list(PIVOT),
    ),
    0.9,
    (2.6,),
    lambda q, x: [off(in_lever(pin(q), x[0]), *SLIT)],
    lambda q, x: {
        **xy(E=z(PIVOT) + z(TIP) * e(x[0])),
        **angles(lever=x[0]),
        "slide:A": along(in_lever(pin(q), x[0]), *SLIT),
    },
)

ARM = (0.3, -0.2)
SHOE = (-0.5, 0.15)
BLOCK = {"block": {"points": {"A": list(ARM), "G": list(SHOE)}}}


def shoe(q: Any, psi: Any) -> Any:
    """G of a block hinged to the crank pin, turned by 0.4 against the lever."""
    return pin(q) + (z(SHOE) - z(ARM)) * e(psi + mp.mpf(0.4))


RPR_BLOCK = Case(
    "RPR with a block",
    one_crank(
        {**LEVER, **BLOCK},
        [
            {
                "point": "G", "on": "lever", "through": list(SLIT[0]), "direction": list(SLIT[1]),
                "link": "block", "angle": 0.4,
            }
        ],
        0.9,
        D=list(PIVOT),
    ),
    0.9,
    (2.6,),
    lambda q, x: [off(in_lever(shoe(q, x[0]), x[0]), *SLIT)],
    lambda q, x: {
        **xy(E=z(PIVOT) + z(TIP) * e(x[0]), G=shoe(q, x[0])),
        **angles(lever=x[0], block=x[0] + mp.mpf(0.4)),
        "slide:G": along(in_lever(shoe(q, x[0]), x[0]), *SLIT),
    },
)  # fmt: skip

FIXED = ((2.0, 0.0), (0.3, 1.0))
BAR = ((0.0, 0.3), (1.0, 0.1))
PRP = Case(
    "PRP",
    {
        "frame": {"points": {"O": [0.1, 0.2]}},
        "links": {"OA": {"length": 1.0}},
        "guides": [
            {"name": "rail", "point": "X", "through": list(FIXED[0]), "direction": list(FIXED[1])},
            {"name": "bar", "point": "X", "on": "OA", "through": list(BAR[0]), "direction": list(BAR[1])},
        ],
        "drives": [{"link": "OA", "start": 0.4, "speed": 1.0}],
    },
    0.4,
    (2.2, 1.0),
    lambda q, x: [off(mp.mpc(*x), *FIXED), off((mp.mpc(*x) - mp.mpc(0.1, 0.2)) * e(-q), *BAR)],
    lambda q, x: {
        **xy(X=mp.mpc(*x)),
        "slide:rail": along(mp.mpc(*x), *FIXED),
        "slide:bar": along((mp.mpc(*x) - mp.mpc(0.1, 0.2)) * e(-q), *BAR),
    },
)


def in_rocker(psi: Any, point: Any) -> Any:
    return (point - mp.mpc(3.9, 0.3)) * e(-psi)


PRP_MOVING = Case(
    "PRP between moving links",
    on_four_bar(
        {},
        [
            {"name": "slot", "point": "X", "on": "K", "through": list(SLOT[0]), "direction": list(SLOT[1])},
            {"name": "slit", "point": "X", "on": "DB", "through": list(SLIT[0]), "direction": list(SLIT[1])},
        ],
    ),
    0.7,
    (0.6, 1.9, 2.0, 4.0),
    lambda q, x: [
        *loop(q, x[0], x[1]),
        off(in_coupler(q, x[0], mp.mpc(x[2], x[3])), *SLOT),
        off(in_rocker(x[1], mp.mpc(x[2], x[3])), *SLIT),
    ],
    lambda q, x: {
        **xy(X=mp.mpc(x[2], x[3])),
        **angles(K=x[0]),
        "slide:slot": along(in_coupler(q, x[0], mp.mpc(x[2], x[3])), *SLOT),
        "slide:slit": along(in_rocker(x[1], mp.mpc(x[2], x[3])), *SLIT),
    },
)

YOKE = ((0.2, -0.3), (0.2, 1.0))


def yoke(s: Any) -> Any:
    d = z(RAIL[1])
    return z(RAIL[0]) + s * d / abs(d)


RPP = Case(
    "RPP",
    one_crank(
        {"yoke": {"points": {"H": [0, 0], "T": list(TIP)}, "angle": 0.25}},
        [
            {
                "point": "H",
                "through": list(RAIL[0]),
                "direction": list(RAIL[1]),
                "link": "yoke",
                "angle": 0.25,
            },
            {"point": "A", "on": "yoke", "through": list(YOKE[0]), "direction": list(YOKE[1])},
        ],
        0.8,
    ),
    0.8,
    (0.5,),
    lambda q, x: [off((pin(q) - yoke(x[0])) * e(-mp.mpf(0.25)), *YOKE)],
    lambda q, x: {
        **xy(T=yoke(x[0]) + z(TIP) * e(mp.mpf(0.25))),
        "slide:H": x[0],
        "slide:A": along((pin(q) - yoke(x[0])) * e(-mp.mpf(0.25)), *YOKE),
    },
)


def rider(q: Any, theta: Any, s: Any) -> Any:
    d = z(SLOT[1])
    return pin(q) + (z(SLOT[0]) + s * d / abs(d)) * e(theta)


def from_rider(q: Any, x: Any) -> Any:
    return (z(LOW) - rider(q, x[0], x[2])) * e(-x[0] - mp.mpf(0.25))


RPP_MOVING = Case(
    "RPP, its carriage on a moving link",
    on_four_bar(
        {"rider": {"points": {"H": [0, 0], "T": list(TIP)}}},
        [
            {
                "point": "H", "on": "K", "through": list(SLOT[0]), "direction": list(SLOT[1]),
                "link": "rider", "angle": 0.25,
            },
            {"point": "F", "on": "rider", "through": list(YOKE[0]), "direction": list(YOKE[1])},
        ],
        F=list(LOW),
    ),
    0.7,
    (0.6, 1.9, 0.5),
    lambda q, x: [*loop(q, x[0], x[1]), off(from_rider(q, x), *YOKE)],
    lambda q, x: {
        **xy(T=rider(q, x[0], x[2]) + z(TIP) * e(x[0] + mp.mpf(0.25))),
        **angles(K=x[0], rider=x[0] + mp.mpf(0.25)),
        "slide:H": x[2],
        "slide:F": along(from_rider(q, x), *YOKE),
    },
)  # fmt: skip

PARALLEL = Case(
    "parallel link",
    on_four_bar(
        {"shoe": {"points": {"X": [0, 0], "T": list(TIP)}}},
        [
            {
                "name": "slot", "point": "X", "on": "K", "through": list(SLOT[0]), "direction": list(SLOT[1]),
                "link": "shoe", "angle": -0.5,
            },
            {"name": "rail", "point": "X", "through": list(FIXED[0]), "direction": list(FIXED[1])},
        ],
    ),
    0.7,
    (0.6, 1.9, 2.5, 1.9),
    lambda q, x: [
        *loop(q, x[0], x[1]),
        off(in_coupler(q, x[0], mp.mpc(x[2], x[3])), *SLOT),
        off(mp.mpc(x[2], x[3]), *FIXED),
    ],
    lambda q, x: {
        **xy(T=mp.mpc(x[2], x[3]) + z(TIP) * e(x[0] - mp.mpf(0.5))),
        **angles(K=x[0], shoe=x[0] - mp.mpf(0.5)),
    },
)  # fmt: skip


MORE = (RPR, RPR_BLOCK, PRP, PRP_MOVING, RPP, RPP_MOVING, PARALLEL)
