"""Gears on the frame and on moving carriers, in chains that follow and in groups that have to be solved at once."""

from __future__ import annotations

import mpmath as mp
from oracle_designs import driven, frame, plate, rods
from oracle_solving import Higher

FIVE_AT = {"O": (0, 0), "A": (0.7, 0.9), "B": (2.4, 2.6), "C": (3.4, 0.7), "D": (3.1, 0)}
FIVE_BAR = Higher(
    "gears: five-bar with geared cranks",
    {
        "frame": frame(FIVE_AT, "OD"),
        "links": rods(FIVE_AT, "OA AB DC CB"),
        "gears": [{"links": ["OA", "DC"], "ratio": -1.5}],
        "drives": driven(FIVE_AT, "OA"),
    },
    FIVE_AT,
    meshing={"gear 0": ("angle:DC", 1.2)},
    width=4.0,
)

BAR_AT = {"O": (0, 0), "A": (0.5, 1.0), "B": (3.5, 2.2), "D": (4.0, -0.2), "W": (0.3, 0)}
BAR = {
    "frame": frame(BAR_AT, "OD"),
    "links": {**rods(BAR_AT, "OA AB DB"), "wheel": {"points": {"O": [0, 0], "W": [0.3, 0]}}},
    "gears": [{"links": ["AB", "wheel"], "carrier": "OA", "ratio": -2.0}],
}
COUPLER = Higher(
    "gears: the coupler turns a wheel about the crank's axis",
    {**BAR, "drives": driven(BAR_AT, "OA")},
    BAR_AT,
    meshing={"gear 0": ("angle:wheel", 0.0)},
    width=3.0,
)
COUPLER_DRIVEN = Higher(
    "gears: a wheel about the crank's axis drives the coupler",
    {**BAR, "drives": [{"link": "wheel", "start": 0.5, "speed": 1.0}]},
    {**BAR_AT, "W": (0.263, 0.144)},
    meshing={"gear 0": ("angle:AB", 0.3805)},
    exact=True,
)

TRAIN_AT = {"O": (0, 0), "A": (0.75, 0), "P": (1.0, 0), "S": (0.5, 0), "R": (0, 1.0)}
TRAIN = {
    "frame": frame(TRAIN_AT, "O"),
    "links": {
        "sun": plate(TRAIN_AT, "OS"),
        "arm": plate(TRAIN_AT, "OA"),
        "planet": plate(TRAIN_AT, "AP"),
        "ring": plate(TRAIN_AT, "OR"),
    },
    "gears": [
        {"links": ["sun", "planet"], "carrier": "arm", "ratio": -2.25},
        {"links": ["planet", "ring"], "carrier": "arm", "ratio": 0.28125},
    ],
}
TRAIN_AT_START = {**TRAIN_AT, "S": (0.478, 0.146)}
PLANETARY = Higher(
    "gears: planetary train, its ring held",
    {
        **TRAIN,
        "links": {name: link for name, link in TRAIN["links"].items() if name != "ring"},
        "gears": [TRAIN["gears"][0], {"links": ["planet", "frame"], "carrier": "arm", "ratio": 0.28125}],
        "drives": [{"link": "sun", "start": 0.3, "speed": 1.0}],
    },
    TRAIN_AT_START,
    meshing={"gear 0": ("angle:planet", 0.0), "gear 1": ("angle:arm", 0.0)},
    width=20.0,
)
DIFFERENTIAL = Higher(
    "gears: planetary train with two drives",
    {
        **TRAIN,
        "drives": [
            {"link": "sun", "start": 0.0, "law": "3*sin(1.5*t)"},
            {"link": "arm", "start": 0.0, "law": "0.5*t + t^2/4"},
        ],
    },
    TRAIN_AT,
    angles={"ring": 0.0},
    meshing={"gear 0": ("angle:planet", 0.0), "gear 1": ("angle:ring", 0.0)},
    laws=(lambda t: 3 * mp.sin(mp.mpf(1.5) * t), lambda t: t / 2 + t**2 / 4),
    width=4.0,
)

CARDAN_AT = {"O": (0, 0), "A": (0.5, 0), "P": (1.0, 0), "Q": (0.5, 0.3)}
CARDAN = Higher(
    "gears: a planet half as large as its fixed ring",
    {
        "frame": frame(CARDAN_AT, "O"),
        "links": {"OA": {"length": 0.5}, "planet": plate(CARDAN_AT, "APQ")},
        "gears": [{"links": ["frame", "planet"], "carrier": "OA", "ratio": 2.0}],
        "drives": [{"link": "OA", "start": 0.0, "speed": 1.0}],
    },
    CARDAN_AT,
    meshing={"gear 0": ("angle:planet", 0.0)},
    width=15.0,
)

SEVEN_AT = {
    "O": (0, 0), "A": (0.5, 0.9), "B": (2.1, 2.4), "C": (3.7, 1.1), "D": (3.3, 0), "E": (1.0, 3.6), "F": (-0.9, 2.2),
    "P": (1.7, 3.2),
}  # fmt: skip
SEVEN = Higher(
    "gears: a crank geared to a rocker that its own coupler moves",
    {
        "frame": frame(SEVEN_AT, "ODF"),
        "links": {
            **rods(SEVEN_AT, "OA"),
            "K": plate(SEVEN_AT, "ABP"),
            **rods(SEVEN_AT, "CB DC PE FE"),
        },
        "gears": [{"links": ["FE", "DC"], "ratio": -0.8}],
        "drives": driven(SEVEN_AT, "OA"),
    },
    SEVEN_AT,
    meshing={"gear 0": ("angle:DC", 1.22)},
    exact=True,
)

GEARS = (FIVE_BAR, COUPLER, COUPLER_DRIVEN, PLANETARY, DIFFERENTIAL, CARDAN, SEVEN)
