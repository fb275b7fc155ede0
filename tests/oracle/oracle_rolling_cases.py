"""Wheels that roll on lines and circles of the frame and of moving links."""

from __future__ import annotations

from oracle_designs import driven, frame, plate, rods
from oracle_solving import Higher

FLOOR = {"through": [0.0, -0.5], "direction": [1.0, 0.0]}
PULLED_AT = {"C": (2.0, 0), "M": (2.3, 0.1)}
PULLED = Higher(
    "rolling: a wheel on a line, its axle driven along a guide",
    {
        "frame": {"points": {"O": [0.0, 0.0]}},
        "links": {"wheel": {"points": {"C": [0, 0], "M": [0.3, 0.1]}}},
        "guides": [{"point": "C", "through": [0.25, 0.0], "direction": [1.0, 0.0]}],
        "rolling": [{"link": "wheel", "centre": "C", "radius": 0.5, "along": FLOOR}],
        "drives": [{"guide": "C", "start": 1.75, "speed": 1.0}],
    },
    PULLED_AT,
    meshing={"wheel wheel": ("angle:wheel", 0.0)},
    dropped=("wheel",),
    width=3.0,
)

SLOPE = {"through": [0.5, -1.0], "direction": [2.0, 0.3]}
ROD_AT = {"O": (-1.5, 0.3), "A": (-0.9, 1.0), "C": (1.9, 0.03), "M": (1.6, 0.6), "N": (2.2, -0.4)}
ROD = Higher(
    "rolling: a crank moves a wheel on a line by a rod to its rim",
    {
        "frame": frame(ROD_AT, "O"),
        "links": {**rods(ROD_AT, "OA AM"), "wheel": plate(ROD_AT, "CMN", 0.1)},
        "rolling": [{"link": "wheel", "centre": "C", "radius": 0.8, "along": SLOPE}],
        "drives": driven(ROD_AT, "OA"),
    },
    ROD_AT,
    meshing={"wheel wheel": ("angle:wheel", 0.1)},
    exact=True,
    width=2.0,
)

ARM_AT = {"O": (0.3, 0.2), "C": (2.3, 0.2), "M": (2.6, 0.6)}
ROUND = {
    "frame": frame(ARM_AT, "O"),
    "links": {"arm": plate(ARM_AT, "OC"), "wheel": plate(ARM_AT, "CM")},
    "drives": [{"link": "arm", "start": 0.0, "speed": 1.0}],
}
OUTSIDE = Higher(
    "rolling: a wheel on an arm, outside a circle",
    {
        **ROUND,
        "rolling": [{"link": "wheel", "centre": "C", "radius": 0.5, "along": {"centre": "O", "radius": 1.5}}],
    },
    ARM_AT,
    meshing={"wheel wheel": ("angle:wheel", 0.0)},
    dropped=("wheel",),
    width=12.0,
)
INSIDE = Higher(
    "rolling: a wheel on an arm, inside a circle",
    {
        **ROUND,
        "rolling": [
            {
                "link": "wheel",
                "centre": "C",
                "radius": 1.0,
                "along": {"centre": [0.3, 0.2], "radius": 3.0, "inside": True},
            }
        ],
    },
    ARM_AT,
    meshing={"wheel wheel": ("angle:wheel", 0.4)},
    angles={"wheel": 0.4},
    dropped=("wheel",),
    width=12.0,
)
RING = Higher(
    "rolling: a ring on an arm, round a pin",
    {
        **ROUND,
        "rolling": [
            {
                "link": "wheel",
                "centre": "C",
                "radius": 3.25,
                "along": {"centre": "O", "radius": 1.25, "inside": True},
            }
        ],
    },
    ARM_AT,
    meshing={"wheel wheel": ("angle:wheel", 0.4)},
    angles={"wheel": 0.4},
    dropped=("wheel",),
    width=12.0,
)

TOUCH_AT = {"O": (0, 0), "A": (0.5, 0.7), "Q": (3.5, 0.4), "C": (2.7, 1.97), "M": (2.9, 2.2)}
TOUCHING = Higher(
    "rolling: a rod holds a wheel to the outside of a circle",
    {
        "frame": frame(TOUCH_AT, "OQ"),
        "links": {**rods(TOUCH_AT, "OA AC"), "wheel": plate(TOUCH_AT, "CM")},
        "rolling": [
            {"link": "wheel", "centre": "C", "radius": 0.6, "along": {"centre": "Q", "radius": 1.16}}
        ],
        "drives": driven(TOUCH_AT, "OA"),
    },
    TOUCH_AT,
    meshing={"wheel wheel": ("angle:wheel", 0.0)},
    width=2.0,
)

SWING_AT = {
    "O": (0, 0), "A": (0.2, 1), "B": (3.2, 1.7), "D": (4.1, 0.2), "C": (0.9, 2.1), "F": (1.2, 4.4), "M": (1.2, 2.4),
}  # fmt: skip
SWING = Higher(
    "rolling: a wheel on a line of a coupler, hung from a rod",
    {
        "frame": frame(SWING_AT, "ODF"),
        "links": {
            **rods(SWING_AT, "OA AB DB FC"),
            "wheel": plate(SWING_AT, "CM"),
        },
        "rolling": [
            {
                "link": "wheel",
                "centre": "C",
                "radius": 0.4,
                "on": "AB",
                "along": {"through": [0.2, 0.487], "direction": [1.0, 0.0]},
            }
        ],
        "drives": driven(SWING_AT, "OA"),
    },
    SWING_AT,
    meshing={"wheel wheel": ("angle:wheel", 0.5)},
    angles={"wheel": 0.5},
    width=2.0,
)

INNER_AT = {
    "O": (0, 0), "A": (0.5, 0.6), "B": (2.6, 1.6), "D": (3.4, -0.3), "Q": (2.2, 3.0), "C": (2.6, 3.6), "F": (4.6, 4.2),
    "M": (2.8, 3.9),
}  # fmt: skip
INNER = Higher(
    "rolling: a wheel inside a ring of a moving link, on a rod",
    {
        "frame": frame(INNER_AT, "ODF"),
        "links": {
            **rods(INNER_AT, "OA"),
            "K": plate(INNER_AT, "ABQ", 0.2),
            **rods(INNER_AT, "DB FC"),
            "wheel": plate(INNER_AT, "CM"),
        },
        "rolling": [
            {
                "link": "wheel",
                "centre": "C",
                "radius": 0.3,
                "on": "K",
                "along": {"centre": "Q", "radius": 1.02, "inside": True},
            }
        ],
        "drives": driven(INNER_AT, "OA"),
    },
    INNER_AT,
    meshing={"wheel wheel": ("angle:wheel", 0.0)},
    width=2.0,
)

RACK_AT = {"O": (0, 0), "M": (0.3, 0), "H": (0, -0.75), "T": (1.0, -0.75)}
RACK = Higher(
    "rolling: a pinion drives a rack",
    {
        "frame": frame(RACK_AT, "O"),
        "links": {"pinion": plate(RACK_AT, "OM"), "rack": plate(RACK_AT, "HT")},
        "guides": [
            {"point": "H", "through": [0.0, -0.75], "direction": [1.0, 0.0], "link": "rack", "angle": 0.0}
        ],
        "rolling": [
            {
                "link": "pinion",
                "centre": "O",
                "radius": 0.5,
                "on": "rack",
                "along": {"through": [0.0, 0.25], "direction": [1.0, 0.0]},
            }
        ],
        "drives": [{"link": "pinion", "start": 0.0, "speed": 1.0}],
    },
    RACK_AT,
    meshing={"wheel pinion": ("slide:H", 0.0)},
    dropped=("pinion",),
    width=4.0,
)

ROLLING = (PULLED, ROD, OUTSIDE, INSIDE, RING, TOUCHING, SWING, INNER, RACK)
