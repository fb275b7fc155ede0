"""Spherical linkages: four-bars, cranks with guides, six-bars, two drives."""

from __future__ import annotations

import math
from typing import Any

import mpmath as mp
from oracle_designs import Parts, Places, frame
from oracle_fields import FLOATS
from oracle_solving import Higher
from oracle_sphere import Sphere, dot

NOWHERE = Sphere({"space": "sphere", "frame": {"points": {}}, "links": {}}, FLOATS)


def vectors(at: Places) -> dict[str, Any]:
    """Places of longitude and latitude (or unit vectors) as unit vectors."""
    return {name: NOWHERE.vector(v) for name, v in at.items()}


def arcs(at: Places, names: str, **references: str) -> Parts:
    """Links by two points, with the arcs their angles are measured from."""
    v = vectors(at)
    found = {}
    for name in names.split():
        found[name] = {"length": round(math.acos(dot(v[name[0]], v[name[1]])), 3)}
        if name in references:
            found[name]["reference"] = list(references[name])
    return found


def cap(at: Places, names: str) -> Parts:
    """A link by coordinates: its axes are the frame's in the initial position."""
    return {"points": {name: list(at[name]) for name in names}}


def turning(at: Places, link: str, reference: str, **more: Any) -> Parts:
    """The drive of a link's angle from that of the places, to two decimals; at one radian a second by default."""
    parts = {
        "frame": {"points": {name: at[name] for name in reference}},
        "links": {link: {"length": 1.0, "reference": list(reference)}},
    }
    angle = Sphere(parts, FLOATS).roughly(link, vectors(at))
    return {"link": link, "start": round(angle, 2), **(more or {"speed": 1.0})}


ROCKER_AT = {"A": [1, 0, 0], "D": [0, 1, 0], "B": [0.966, 0.183, 0.183], "C": [0.52, 0, 0.854]}
ROCKER = Higher(
    "sphere: slider-rocker of a table, its ground and rocker of a quarter turn",
    {
        "space": "sphere",
        "frame": {"points": {"A": [1, 0, 0], "D": [0, 1, 0]}},
        "links": {
            "AB": {"length": math.pi / 12, "reference": ["A", "D"]},
            "BC": {"length": math.pi / 4},
            "DC": {"length": math.pi / 2, "reference": ["D", "A"]},
        },
        "drives": [{"link": "AB", "start": math.pi / 4, "speed": 1.0}],
    },
    ROCKER_AT,
    width=7.0,
)

FOUR_AT = {"A": [0.2, -0.3], "B": [0.5, -0.15], "C": [1.1, 0.65], "D": [1.4, -0.2]}
FOUR_BAR = Higher(
    "sphere: four-bar with a turning crank",
    {
        "space": "sphere",
        "frame": frame(FOUR_AT, "AD"),
        "links": arcs(FOUR_AT, "AB BC DC", AB="AD", DC="DA", BC="BA"),
        "drives": [turning(FOUR_AT, "AB", "AD")],
    },
    FOUR_AT,
    width=5.0,
)

WIDE_AT = {"A": [-0.4, 0.1], "B": [0.3, 1.1], "C": [2.2, 0.9], "D": [1.9, -0.4]}
WIDE = Higher(
    "sphere: four-bar of long arcs",
    {
        "space": "sphere",
        "frame": frame(WIDE_AT, "AD"),
        "links": arcs(WIDE_AT, "AB BC DC", AB="AD", DC="DA"),
        "drives": [turning(WIDE_AT, "AB", "AD")],
    },
    WIDE_AT,
)

GREAT_AT = {"A": [0.1, -0.2], "B": [0.4, 0.05], "C": [1.2, 0.3], "D": [1.7, 0.4]}
GREAT = Higher(
    "sphere: crank, coupler and a guide along a great circle",
    {
        "space": "sphere",
        "frame": frame(GREAT_AT, "AD"),
        "links": arcs(GREAT_AT, "AB BC", AB="AD", BC="BA"),
        "guides": [{"point": "C", "pole": [1.27, -1.25]}],
        "drives": [turning(GREAT_AT, "AB", "AD")],
    },
    GREAT_AT,
    width=3.0,
)

SMALL = Higher(
    "sphere: crank, coupler and a guide along a small circle",
    {
        **GREAT.parts,
        "guides": [{"point": "C", "pole": "D", "radius": 0.49}],
    },
    GREAT_AT,
    width=3.0,
)

SIX_AT = {**FOUR_AT, "P": [0.9, 0.3], "E": [0.75, 1.05], "F": [0.1, 0.85]}
SIX = Higher(
    "sphere: six-bar on a point of the coupler",
    {
        "space": "sphere",
        "frame": frame(SIX_AT, "ADF"),
        "links": {
            **arcs(SIX_AT, "AB", AB="AD"),
            "K": cap(SIX_AT, "BCP"),
            **arcs(SIX_AT, "DC PE FE", DC="DA", FE="FA"),
        },
        "drives": [turning(SIX_AT, "AB", "AD")],
    },
    SIX_AT,
    width=2.0,
)

SLOT_AT = {**FOUR_AT, "P": [0.9, 0.3], "E": [0.6, 0.75], "F": [0.1, 0.55]}
SLOT = Higher(
    "sphere: a guide on a moving coupler",
    {
        "space": "sphere",
        "frame": frame(SLOT_AT, "ADF"),
        "links": {
            **arcs(SLOT_AT, "AB", AB="AD"),
            "K": cap(SLOT_AT, "BCP"),
            **arcs(SLOT_AT, "DC FE", DC="DA", FE="FA"),
        },
        "guides": [{"point": "E", "on": "K", "pole": [0.9, 0.05], "radius": 0.75}],
        "drives": [turning(SLOT_AT, "AB", "AD")],
    },
    SLOT_AT,
)

FIVE_AT = {"A": [0.1, -0.2], "B": [0.4, 0.3], "C": [0.9, 0.8], "E": [1.9, 0.5], "D": [1.6, -0.3]}
FIVE_BAR = Higher(
    "sphere: five-bar, its second drive in a moving hinge",
    {
        "space": "sphere",
        "frame": frame(FIVE_AT, "AD"),
        "links": arcs(FIVE_AT, "AB BC CE DE", AB="AD", BC="BA", DE="DA"),
        "drives": [
            turning(FIVE_AT, "AB", "AD", law="0.25*sin(3*t)"),
            turning(FIVE_AT, "BC", "BA", relative_to="AB", law="0.25*sin(2*t)"),
        ],
    },
    FIVE_AT,
    laws=(lambda t: mp.sin(3 * t) / 4, lambda t: mp.sin(2 * t) / 4),
    width=1.5,
)

TRIAD_AT = {
    "A": [0.0, -0.6], "B": [0.15, -0.45], "K": [-0.2, 0.1], "L": [0.5, 0.05], "M": [0.1, 0.6],
    "D": [0.85, 0.55], "G": [-0.55, 0.65],
}  # fmt: skip
TRIAD = Higher(
    "sphere: third class, a platform on three arcs",
    {
        "space": "sphere",
        "frame": frame(TRIAD_AT, "ADG"),
        "links": {
            **arcs(TRIAD_AT, "AB BK", AB="AD"),
            "plate": cap(TRIAD_AT, "KLM"),
            **arcs(TRIAD_AT, "DL GM", DL="DA", GM="GA"),
        },
        "drives": [turning(TRIAD_AT, "AB", "AD")],
    },
    TRIAD_AT,
)

SPHERE = (ROCKER, FOUR_BAR, WIDE, GREAT, SMALL, SIX, SLOT, FIVE_BAR, TRIAD)
