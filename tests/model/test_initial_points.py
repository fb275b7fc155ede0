"""Mechanisms by the coordinates of their points in one position, beside the same by lengths and angles."""

from __future__ import annotations

import math
import sys
from typing import Any

import numpy as np
import pytest

import centrode as ct
from centrode.model.files import document

EPS = sys.float_info.epsilon
BY_LENGTHS = [
    "crank-rocker",
    "six-bar-press",
    "klann-leg",
    "jansen-leg",
    "slider-crank-offset",
    "whitworth-quick-return",
]


def by_points(mechanism: ct.Mechanism) -> dict[str, Any]:
    """The tables of a mechanism with its points in the initial position in place of lengths and angles."""
    drive = mechanism.drives[0]
    start = ct.motion(mechanism, at=[drive.start])
    points = {str(name): start.position.sel(point=name).values[0].tolist() for name in start.point.values}
    points |= {name: list(at) for name, at in mechanism.frame.coordinates.items()}
    tables = document(mechanism)
    tables["frame"]["points"] = list(mechanism.frame.points)
    tables["points"] = points
    for name, link in tables["links"].items():
        for key in ("length", "angle"):
            link.pop(key, None)
        link["points"] = list(mechanism.links[name].coordinates)
    tables.pop("assembly", None)
    return tables


@pytest.mark.parametrize("name", BY_LENGTHS)
def test_points_give_the_mechanism_of_lengths_and_angles(name: str) -> None:
    mechanism = ct.example(name)
    read = ct.Mechanism(**by_points(mechanism))
    expected, found = ct.motion(mechanism, 25), ct.motion(read, 25)
    size = np.nanmax(np.abs(expected.position.values))
    # a place is known to the rounding of the points, and a chain of dyads passes that on
    assert found.position.values == pytest.approx(expected.position.values, rel=0, abs=1e5 * EPS * size)
    assert (found.status.values == expected.status.values).all()
    assert ct.parse_mechanism(ct.mechanism_text(read)) == read


FOUR_BAR: dict[str, Any] = {
    "points": {"O": [0, 0], "A": [1, 1], "B": [4, 3], "D": [5, 0], "P": [3, 4]},
    "frame": {"points": ["O", "D"]},
    "links": {"OA": {}, "coupler": {"points": ["A", "B", "P"]}, "DB": {}},
    "drives": [{"link": "OA", "speed": 1}],
}


def test_lengths_and_angles_by_hand() -> None:
    read = ct.Mechanism(**FOUR_BAR)
    assert read.links["OA"].length == pytest.approx(math.sqrt(2), rel=EPS)
    assert read.drives[0].start == pytest.approx(math.pi / 4, rel=EPS)
    assert read.links["DB"].angle == pytest.approx(math.atan2(3, -1), rel=EPS)
    # P in the axes from A towards B: along (3, 2), across (-2, 3), each over the length 13^0.5
    assert read.links["coupler"].points["P"] == pytest.approx((12 / 13**0.5, 5 / 13**0.5), rel=8 * EPS)
    assert read.links["coupler"].points["B"] == (13**0.5, 0.0)
    closed = ct.motion(read, at=[math.pi / 4])
    assert closed.position.sel(point="P").values[0] == pytest.approx([3, 4], rel=64 * EPS)


def test_a_drive_counts_as_it_says() -> None:
    """The start, a turn on, is the zero of the drive: the same position."""
    read = ct.Mechanism(**{**FOUR_BAR, "drives": [{"link": "OA", "speed": -1, "start": "405 deg"}]})
    assert read.drives[0].start == pytest.approx(math.radians(405), rel=EPS)
    place = ct.motion(read, at=["405 deg"]).position.sel(point="B").values[0]
    assert place == pytest.approx([4, 3], rel=64 * EPS)


def test_a_guide_passes_through_its_point() -> None:
    parts = {
        "points": {"O": ["0 mm", 0], "A": ["30 mm", "40 mm"], "B": ["150 mm", "10 mm"]},
        "frame": {"points": ["O"]},
        "links": {"OA": {}, "AB": {}},
        "guides": [{"point": "B", "direction": [1, 0]}],
        "drives": [{"link": "OA", "speed": 1}],
    }
    read = ct.Mechanism(**parts)
    assert read.guides[0].through == pytest.approx((0.15, 0.01), rel=EPS)
    assert read.links["OA"].length == pytest.approx(0.05, rel=2 * EPS)


def changed(**changes: Any) -> dict[str, Any]:
    return {**FOUR_BAR, **changes}


@pytest.mark.parametrize(
    ("parts", "message"),
    [
        (changed(space="sphere"), "in the plane only"),
        (
            changed(frame={"points": {"O": [0, 0.1], "D": [5, 0]}}),
            'point "O" is given twice, in different places',
        ),
        (changed(frame={"points": ["O", "E"]}), 'the coordinates of point "E" are not given'),
        (changed(links={**FOUR_BAR["links"], "DB": {"points": ["D", "Q"]}}), 'of point "Q" are not given'),
        (
            changed(links={**FOUR_BAR["links"], "DB": {"points": ["D", "B"], "length": 3}}),
            "length follows from its",
        ),
        (changed(links={**FOUR_BAR["links"], "DB": {"angle": 3}}), "angle follows from its points"),
        (changed(points={**FOUR_BAR["points"], "A": [0, 0]}), "its points O and A coincide"),
        (changed(points={**FOUR_BAR["points"], "A": [0]}), "points"),
        (changed(points=[1]), "expected a table"),
        (changed(drives=[{"link": "OA", "speed": 1, "start": "30 deg"}]), 'the points put "OA" at 45 deg'),
        # what is no name at all
        (changed(frame={"points": [["O"], "D"]}), "expected a name (text), got a list of 1 value"),
        (changed(links={**FOUR_BAR["links"], "DB": {"points": [["D"], "B"]}}), "expected a name (text)"),
        (changed(drives=[{"link": ["OA"], "speed": 1, "start": "45 deg"}]), "expected a name (text)"),
        (changed(drives=[{"link": "OA", "speed": 1, "relative_to": ["DB"]}]), "expected a name (text)"),
        (changed(guides=[{"point": "P", "on": ["OA"], "direction": [1, 0]}]), '"through" is missing'),
    ],
)
def test_points_that_cannot_be(parts: dict[str, Any], message: str) -> None:
    with pytest.raises(ct.InputError) as refused:
        ct.Mechanism(**parts)
    assert message in str(refused.value)


def test_names_are_one_name_in_every_form_of_unicode() -> None:
    composed, apart = "\N{CYRILLIC SMALL LETTER SHORT I}", "\N{CYRILLIC SMALL LETTER I}\N{COMBINING BREVE}"
    tables = changed(
        points={**{key: at for key, at in FOUR_BAR["points"].items() if key != "P"}, composed: [3, 4]},
        links={**FOUR_BAR["links"], "coupler": {"points": ["A", "B", apart]}},
    )
    assert ct.Mechanism(**tables).links["coupler"].coordinates.keys() == {"A", "B", composed}
