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


ON_THE_SPHERE = [
    "spherical-four-bar",
    "spherical-crank-rocker",
    "spherical-crank-guide",
    "hookes-joint",
    "wobble-plate",
]


@pytest.mark.parametrize("name", ON_THE_SPHERE)
def test_points_on_the_sphere_give_the_mechanism_of_arcs(name: str) -> None:
    """Longitudes and latitudes in place of arcs, angles and sides; the circle of a guide goes through its point."""
    mechanism = ct.example(name)
    tables = by_points(mechanism)
    for point, place in tables["points"].items():
        longitude_latitude = place
        if len(place) == 3:
            x, y, z = place
            longitude_latitude = [math.atan2(y, x), math.atan2(z, math.hypot(x, y))]
        tables["points"][point] = [f"{value!r} rad" for value in longitude_latitude]
    for guide in tables.get("guides", ()):
        guide.pop("radius", None)
    for drive in tables["drives"]:
        drive.pop("start", None)
    read = ct.Mechanism(**tables)
    for link, part in mechanism.links.items():
        if part.length is not None:
            assert read.links[link].length == pytest.approx(part.length, abs=1e3 * EPS)
    expected, found = ct.motion(mechanism, 25), ct.motion(read, 25)
    assert found.position.values == pytest.approx(expected.position.values, rel=0, abs=1e5 * EPS)
    assert (found.status.values == expected.status.values).all()
    assert ct.parse_mechanism(ct.mechanism_text(read)) == read


SPHERE: dict[str, Any] = {
    "space": "sphere",
    "display": {"angle": "deg"},
    "points": {
        "A": [0, 0],
        "B": ["0 deg", "30 deg"],
        "C": ["60 deg", "45 deg"],
        "D": ["90 deg", 0],
        "P": ["0 deg", "50 deg"],
    },
    "frame": {"points": ["A", "D"]},
    "links": {"AB": {}, "coupler": {"points": ["B", "C", "P"]}, "DC": {}},
    "drives": [{"link": "AB", "speed": 1}],
}


def test_arcs_and_angles_by_hand() -> None:
    """AB is a piece of a meridian: 30 deg long, at right angles to the equator that joins A and D."""
    read = ct.Mechanism(**SPHERE)
    assert read.links["AB"].length == pytest.approx(math.pi / 6, rel=4 * EPS)
    assert read.links["AB"].reference == ("A", "D")
    assert read.drives[0].start == pytest.approx(math.pi / 2, rel=4 * EPS)
    # P goes on along the meridian: 20 deg from B; cos BC = sin 30 sin 45 + cos 30 cos 45 cos 60
    arcs = read.links["coupler"].points
    cosine = 0.5 * math.sqrt(0.5) + math.sqrt(0.75) * math.sqrt(0.5) * 0.5
    assert arcs["C"] == pytest.approx((math.acos(cosine), 0.0), rel=8 * EPS)
    longitude, latitude = arcs["P"]
    assert math.cos(latitude) * math.cos(longitude) == pytest.approx(math.cos(math.pi / 9), rel=8 * EPS)
    closed = ct.motion(read, at=["90 deg"]).position.sel(point="P").values[0]
    assert closed == pytest.approx([math.cos(math.radians(50)), 0, math.sin(math.radians(50))], abs=1e-13)


def test_a_drive_on_the_sphere_counts_from_the_link_that_carries_it() -> None:
    """An arm of two links: the second angle is measured from the first link, on from A."""
    arm = {
        **SPHERE,
        "points": {**SPHERE["points"], "B": ["30 deg", 0], "C": ["30 deg", "20 deg"]},
        "links": {"AB": {}, "BC": {}},
        "drives": [{"link": "AB", "speed": 1}, {"link": "BC", "relative_to": "AB", "speed": 1}],
    }
    read = ct.Mechanism(**arm)
    assert read.links["BC"].reference == ("B", "A")
    assert [drive.start for drive in read.drives] == pytest.approx([0.0, -math.pi / 2], abs=4 * EPS)
    place = ct.motion(read, at=[0.0]).position.sel(point="C").values[0]
    latitude, longitude = math.radians(20), math.radians(30)
    assert place == pytest.approx(
        [
            math.cos(latitude) * math.cos(longitude),
            math.cos(latitude) * math.sin(longitude),
            math.sin(latitude),
        ],
        abs=1e-14,
    )


def on_sphere(**changes: Any) -> dict[str, Any]:
    return {**SPHERE, **changes}


@pytest.mark.parametrize(
    ("parts", "message"),
    [
        (on_sphere(points={**SPHERE["points"], "B": ["180 deg", 0]}), "coincide, or lie opposite"),
        (on_sphere(points={**SPHERE["points"], "B": ["0 deg", "95 deg"]}), "a latitude must lie between"),
        (on_sphere(frame={"points": {"A": [0, "1 deg"], "D": ["90 deg", 0]}}), 'point "A" is given twice'),
        (
            on_sphere(links={"AB": {"length": "30 deg", "points": ["A", "B"]}}),
            "length follows from its points",
        ),
        (on_sphere(drives=[{"link": "AB", "speed": 1, "start": "30 deg"}]), 'the points put "AB" at 90 deg'),
        (on_sphere(frame={"points": ["A"]}, links={"AB": {}}), "reference is missing"),
    ],
)
def test_points_on_the_sphere_that_cannot_be(parts: dict[str, Any], message: str) -> None:
    with pytest.raises(ct.InputError) as refused:
        ct.Mechanism(**parts)
    assert message in str(refused.value)


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
