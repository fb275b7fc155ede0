"""Groups of third and fourth class, six-bars driven at other links, and groups of higher class one behind another."""

from __future__ import annotations

from oracle_designs import Parts, Places, driven, frame, plate, rods
from oracle_solving import Higher

TRIAD_AT = {
    "O": (0, 0), "A": (0.62, 0.78), "B": (1.3, 2.4), "C": (3.1, 1.7), "E": (2.5, 3.1), "P": (2.0, 1.9),
    "D": (4.2, -0.3), "G": (4.6, 4.1),
}  # fmt: skip
TRIAD = Higher(
    "third class: a platform on three rods",
    {
        "frame": frame(TRIAD_AT, "ODG"),
        "links": {**rods(TRIAD_AT, "OA AB"), "K": plate(TRIAD_AT, "BCEP", 0.4), **rods(TRIAD_AT, "DC GE")},
        "drives": driven(TRIAD_AT, "OA"),
    },
    TRIAD_AT,
)

SMALL_AT = {
    "O": (1.4, 0), "A": (1.75, 0.1), "B": (1, 1.5), "C": (3, 1.5), "E": (2, 3), "D": (3.75, 3), "G": (0.2, 3.1),
}  # fmt: skip
TURNING = Higher(
    "third class: a platform that a small crank moves over whole turns",
    {
        "frame": frame(SMALL_AT, "ODG"),
        "links": {**rods(SMALL_AT, "OA AB"), "K": plate(SMALL_AT, "BCE"), **rods(SMALL_AT, "DC GE")},
        "drives": driven(SMALL_AT, "OA"),
    },
    SMALL_AT,
    width=8.0,
)

TRIAD_RAIL = Higher(
    "third class: a platform on two rods and a rail",
    {
        "frame": frame(SMALL_AT, "OD"),
        "links": {**rods(SMALL_AT, "OA AB"), "K": plate(SMALL_AT, "BCE", -0.2), **rods(SMALL_AT, "DC")},
        "guides": [{"point": "E", "through": [1.9, 2.5], "direction": [0.2, 1.0]}],
        "drives": driven(SMALL_AT, "OA"),
    },
    SMALL_AT,
)

PIN_AT = {**TRIAD_AT, "A": (0.3, 0.5), "G": (2.1, 3.3)}
TRIAD_SLOT = Higher(
    "third class: a platform on two rods and a fixed pin in its slot",
    {
        "frame": frame(PIN_AT, "ODG"),
        "links": {**rods(PIN_AT, "OA AB"), "K": plate(PIN_AT, "BCP", 0.0), **rods(PIN_AT, "DC")},
        "guides": [{"point": "G", "on": "K", "through": [0.95, 0.4], "direction": [-0.3, 1.0]}],
        "drives": driven(PIN_AT, "OA"),
    },
    PIN_AT,
)

CONTOUR_AT = {
    "O": (0, 0), "A": (0.9, 0.5), "P": (1.9, 1.5), "Q": (2.5, 0), "R": (3.4, 2.9), "S": (3.9, 1.3), "D": (5, 1.6),
}  # fmt: skip
FOURTH = Higher(
    "fourth class: a contour of four links on two outer hinges",
    {
        "frame": frame(CONTOUR_AT, "OD"),
        "links": {
            **rods(CONTOUR_AT, "OA"),
            "left": plate(CONTOUR_AT, "APQ", 0.3),
            "right": plate(CONTOUR_AT, "DRS", -2.8),
            **rods(CONTOUR_AT, "PR QS"),
        },
        "drives": driven(CONTOUR_AT, "OA"),
    },
    CONTOUR_AT,
    angles={"left": 0.3, "right": -2.8},
)

WATT_AT = {
    "O": (0, 0), "A": (-0.9, 0.7), "B": (2, 1.2), "D": (3.8, -0.4), "P": (0.9, 2.4), "Q": (3.3, 1.7), "E": (2.7, 4.2),
}  # fmt: skip
WATT = Higher(
    "Watt's six-bar driven at a link of its second loop",
    {
        "frame": frame(WATT_AT, "OD"),
        "links": {
            **rods(WATT_AT, "OA"),
            "K": plate(WATT_AT, "ABP"),
            "L": plate(WATT_AT, "DBQ"),
            **rods(WATT_AT, "PE QE"),
        },
        "drives": driven(WATT_AT, "PE"),
    },
    WATT_AT,
)

STEPHENSON_AT = {
    "O": (0, 0), "A": (-1.2, -0.1), "B": (1.6, 0.8), "D": (3.8, -0.4), "P": (0.6, 2), "E": (3, 1.2), "G": (6, 1.4),
}  # fmt: skip
HINGE_AT = {
    "O": (0, 0), "A": (0.4, 1.1), "B": (3.2, 2), "D": (3.8, -0.4), "P": (2.2, 3.2), "E": (4.6, 4), "G": (6, 1.4),
}  # fmt: skip


def stephenson(at: Places) -> Parts:
    """Stephenson's six-bar, without a drive."""
    return {
        "frame": frame(at, "ODG"),
        "links": {**rods(at, "OA"), "K": plate(at, "ABP"), **rods(at, "DB PE GE")},
    }


STEPHENSON = Higher(
    "Stephenson's six-bar driven at its second coupler",
    {**stephenson(STEPHENSON_AT), "drives": driven(STEPHENSON_AT, "PE")},
    STEPHENSON_AT,
)

HINGE = Higher(
    "Stephenson's six-bar with a motor in a moving hinge",
    {
        **stephenson(HINGE_AT),
        "drives": [{"link": "K", "relative_to": "OA", "start": -1.222, "speed": 1.0}],
    },
    HINGE_AT,
)

SERIES_AT = {
    **TRIAD_AT, "A": (0.36, 0.48),
    "H": (3, 5.2), "J": (4.7, 5.3), "M": (3.6, 6.7), "N": (5.6, 3), "S": (0.7, 6.2), "T": (3.8, 5.7),
}  # fmt: skip
SERIES = Higher(
    "two groups of third class in series",
    {
        "frame": frame(SERIES_AT, "ODGNS"),
        "links": {
            **rods(SERIES_AT, "OA AB"),
            "K": plate(SERIES_AT, "BCEP", 0.4),
            **rods(SERIES_AT, "DC GE PH"),
            "L": plate(SERIES_AT, "HJMT", 0.1),
            **rods(SERIES_AT, "NJ SM"),
        },
        "drives": driven(SERIES_AT, "OA"),
    },
    SERIES_AT,
)

BETWEEN_AT = {
    "O": (0, 0), "A": (0.62, 0.78), "U": (3.0, 2.1), "W": (3.9, -0.4), "V": (1.5, 2.6),
    "B": (1.9, 4.3), "C": (3.7, 3.9), "E": (2.9, 5.3), "P": (3.3, 4.8), "D": (5.4, 2.6), "G": (1.0, 6.3),
    "X": (4.9, 6.4), "Y": (6.6, 5.2),
}  # fmt: skip
BETWEEN = Higher(
    "third class between two dyads",
    {
        "frame": frame(BETWEEN_AT, "OWDGY"),
        "links": {
            **rods(BETWEEN_AT, "OA"),
            "K": plate(BETWEEN_AT, "AUV"),
            **rods(BETWEEN_AT, "WU VB"),
            "L": plate(BETWEEN_AT, "BCEP"),
            **rods(BETWEEN_AT, "DC GE PX YX"),
        },
        "drives": driven(BETWEEN_AT, "OA"),
    },
    BETWEEN_AT,
)

HIGHER = (TRIAD, TURNING, TRIAD_RAIL, TRIAD_SLOT, FOURTH, WATT, STEPHENSON, HINGE, SERIES, BETWEEN)
