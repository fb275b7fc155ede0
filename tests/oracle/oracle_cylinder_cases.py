"""Cylinders between any two links, drives in moving hinges and guides, and several drives at once."""

from __future__ import annotations

import math

import mpmath as mp
from oracle_designs import Places, driven, frame, plate, rods
from oracle_solving import Higher


def cylinder(at: Places, ends: str) -> float:
    """Distance of two places, to two decimals."""
    return round(math.dist(at[ends[0]], at[ends[1]]), 2)


BOOM_AT = {"O": (0, 0), "F": (0.9, -0.6), "P": (1.6, 1.3), "T": (3.2, 1.7)}
BOOM = Higher(
    "cylinder between the frame and a boom",
    {
        "frame": frame(BOOM_AT, "OF"),
        "links": {"boom": plate(BOOM_AT, "OPT", 0.5)},
        "drives": [{"distance": ["F", "P"], "start": cylinder(BOOM_AT, "FP"), "speed": 1.0}],
    },
    BOOM_AT,
    width=0.15,
)

BAR_AT = {"O": (0, 0), "A": (1.8, 0.3), "B": (3.6, 2.6), "D": (4.1, -0.2), "P": (0.7, 0.8), "Q": (4.5, 1.6)}
BAR = Higher(
    "cylinder between two links of a four-bar",
    {
        "frame": frame(BAR_AT, "OD"),
        "links": {"left": plate(BAR_AT, "OAP"), **rods(BAR_AT, "AB"), "right": plate(BAR_AT, "DBQ", 1.0)},
        "drives": [{"distance": ["P", "B"], "start": cylinder(BAR_AT, "PB"), "speed": 1.0}],
    },
    BAR_AT,
    width=0.2,
)
DIAGONAL = Higher(
    "cylinder between opposite links of a four-bar",
    {
        **BAR.parts,
        "drives": [{"distance": ["Q", "P"], "start": cylinder(BAR_AT, "QP"), "speed": 1.0}],
    },
    BAR_AT,
    width=0.2,
)

ARM_AT = {
    "O": (0, 0), "F": (0.8, -0.5), "P": (1.5, 1.4), "R": (1.9, 2.2), "S": (3.4, 1.6), "T": (3.1, 2.3), "U": (4.6, 0.4),
    "V": (4.0, 1.3), "X": (4.9, 0.9), "W": (5.1, -0.4),
}  # fmt: skip
ARM = Higher(
    "cylinders: boom, stick and bucket",
    {
        "frame": frame(ARM_AT, "OF"),
        "links": {
            "boom": plate(ARM_AT, "OPRS"),
            "stick": plate(ARM_AT, "STVU", -0.8),
            "bucket": plate(ARM_AT, "UXW", -1.1),
        },
        "drives": [
            {"distance": ["F", "P"], "start": cylinder(ARM_AT, "FP"), "law": "0.25*sin(t)"},
            {"distance": ["R", "T"], "start": cylinder(ARM_AT, "RT"), "law": "-0.125*t"},
            {"distance": ["V", "X"], "start": cylinder(ARM_AT, "VX"), "law": "0.125*sin(2*t)"},
        ],
    },
    ARM_AT,
    angles={"stick": -0.8, "bucket": -1.1},
    laws=(lambda t: mp.sin(t) / 4, lambda t: -t / 8, lambda t: mp.sin(2 * t) / 8),
    width=1.2,
)

PLATFORM_AT = {
    "B": (1, 1.5), "C": (3, 1.5), "E": (2, 3), "P": (2.2, 2.1), "F": (1.8, -0.5), "D": (4.2, 3.2), "G": (0, 3.3),
}  # fmt: skip
PLATFORM = Higher(
    "cylinders: a platform on three of them",
    {
        "frame": frame(PLATFORM_AT, "FDG"),
        "links": {"K": plate(PLATFORM_AT, "BCEP", 0.3)},
        "drives": [
            {"distance": ["F", "B"], "start": cylinder(PLATFORM_AT, "FB"), "law": "0.25*sin(t)"},
            {"distance": ["D", "C"], "start": cylinder(PLATFORM_AT, "DC"), "law": "0.125*t"},
            {"distance": ["E", "G"], "start": cylinder(PLATFORM_AT, "EG"), "law": "0.25*sin(2*t)"},
        ],
    },
    PLATFORM_AT,
    angles={"K": 0.3},
    laws=(lambda t: mp.sin(t) / 4, lambda t: t / 8, lambda t: mp.sin(2 * t) / 4),
    width=0.9,
)

FIVE_AT = {"O": (0, 0), "A": (0.5, 1.0), "B": (2.2, 2.7), "C": (3.9, 1.1), "D": (3.4, 0)}
FIVE_BAR = Higher(
    "two drives: five-bar",
    {
        "frame": frame(FIVE_AT, "OD"),
        "links": rods(FIVE_AT, "OA AB DC CB"),
        "drives": [
            *driven(FIVE_AT, "OA"),
            {"link": "DC", "start": 1.14, "law": "0.7*sin(1.3*t)"},
        ],
    },
    FIVE_AT,
    laws=(lambda t: t, lambda t: mp.mpf(0.7) * mp.sin(mp.mpf(1.3) * t)),
    width=1.5,
)

TWO_AT = {**PLATFORM_AT, "O": (1.5, -0.7)}
TWO = Higher(
    "two drives: a crank and a cylinder move a platform on a rod",
    {
        "frame": frame(TWO_AT, "ODG"),
        "links": {**rods(TWO_AT, "OF FB"), "K": plate(TWO_AT, "BCEP", 0.3), **rods(TWO_AT, "DC")},
        "drives": [
            *driven(TWO_AT, "OF"),
            {"distance": ["E", "G"], "start": cylinder(TWO_AT, "EG"), "law": "0.25*sin(2*t)"},
        ],
    },
    TWO_AT,
    laws=(lambda t: t, lambda t: mp.sin(2 * t) / 4),
    width=0.9,
)

SLOT_AT = {"O": (0, 0), "A": (0.8, 0.9), "D": (2.6, -0.5), "E": (3.5, 1.9)}
SLOT = Higher(
    "displacement along a guide of a moving link",
    {
        "frame": frame(SLOT_AT, "OD"),
        "links": {**rods(SLOT_AT, "OA"), "lever": plate(SLOT_AT, "DE")},
        "guides": [{"point": "A", "on": "lever", "through": [0.2, 0.5], "direction": [-0.975, 0.45]}],
        "drives": [{"guide": "A", "start": 2.19, "speed": 1.0}],
    },
    SLOT_AT,
    width=0.3,
)

CYLINDERS = (BOOM, BAR, DIAGONAL, ARM, PLATFORM, FIVE_BAR, TWO, SLOT)
