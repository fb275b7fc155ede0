"""Gears, rolling wheels and cylinders: what they are called, what is read, what is refused with its repair."""

import math
from collections.abc import Callable

import pytest

from centrode.model.files import mechanism_text, parse_mechanism
from centrode.model.gears import Gear
from centrode.model.links import Rolling, Track
from centrode.model.mechanism import Mechanism

Complaint = Callable[[str], str]

PLANETARY = """
[frame.points]
O = [0, 0]
E = [5, 0]
[links.OA]
length = 2
[links.planet]
points = { A = [0, 0], P = [1, 0] }
[links.rod]
points = ["P", "Q"]
length = 4
[[gears]]
links = ["frame", "planet"]
carrier = "OA"
ratio = 3
[[rolling]]
link = "planet"
centre = "A"
radius = 1
along = { centre = "O", radius = 3, inside = true }
[[drives]]
distance = ["E", "Q"]
start = 1.5
speed = 0.1
"""


def test_what_is_read() -> None:
    m = parse_mechanism(PLANETARY)
    assert m.gears[0].links == ("frame", "planet")
    assert m.rolling[0].along.inside is True
    assert [m.gears[0].id, m.rolling[0].id, m.drives[0].id] == ["frame-planet", "planet", "E-Q"]
    assert parse_mechanism(mechanism_text(m)) == m
    assert "inside = true" in mechanism_text(m)
    outside = parse_mechanism(PLANETARY.replace(", inside = true", ""))
    assert outside.rolling[0].along.inside is False
    assert "inside" not in mechanism_text(outside)


def test_names_go_before_links() -> None:
    assert Gear(links=["OA", "wheel"], ratio=-2).id == "OA-wheel"
    assert Gear(links=["OA", "wheel"], ratio=-2, name="first").id == "first"
    along = {"through": (0, 0), "direction": (3, 4)}
    assert Rolling(link="wheel", centre="C", radius=1, along=along, name="road").id == "road"
    assert Track(**along).unit == pytest.approx((0.6, 0.8), abs=1e-15)
    assert Track(through=(0, 0), direction="90 deg").unit == pytest.approx((0, 1), abs=1e-15)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            '"frame", "planet"',
            '"planet", "planet"',
            '[[gears]] 1: a gear needs two different links; name them: links = ["OA", "wheel"]',
        ),
        ('"frame", "planet"', '"planet"', "a gear needs two different links"),
        (
            'carrier = "OA"',
            "",
            "[[gears]] 1: a gear with the frame as one of its wheels needs a carrier that moves; "
            "name the link that holds both axes",
        ),
        (
            'carrier = "OA"',
            'carrier = "planet"',
            "link planet cannot be a wheel and the carrier of one gear",
        ),
        ('carrier = "OA"', 'carrier = "AO"', '[[gears]] 1, carrier: unknown link "AO"; did you mean "OA"?'),
        ('"frame", "planet"', '"frame", "plant"', '[[gears]] 1, links: unknown link "plant"'),
        ("ratio = 3", "ratio = 0", "[[gears]] 1: ratio must not be zero"),
        ("ratio = 3", 'ratio = 3\nname = "planet"', 'there are two gears or rolling wheels "planet"; give'),
        ("radius = 1", "radius = 0", "[[rolling]] 1: radius must be positive, got 0"),
        ("radius = 1", "radius = -1", "[[rolling]] 1: radius must be positive, got -1"),
        ("radius = 1", "radius = 3", "[[rolling]] 1, radius: a wheel as large as the circle fills it"),
        ("radius = 1", "radius = 2.9999999999", "fills it and cannot roll inside; change one of the radii"),
        ("radius = 3", "radius = 0", "[[rolling]] 1: along.radius must be positive, got 0"),
        ("inside = true", "inside = 1", "[[rolling]] 1, along.inside: expected true or false, got 1"),
        (
            'centre = "O", radius = 3, inside',
            "through = [0, 0], direction = 0, inside",
            "inside is used with a circle only; remove it; reverse the direction",
        ),
        (
            'centre = "O", radius = 3, inside = true',
            "through = [0, 0]",
            "one of direction, radius is missing",
        ),
        ('centre = "O", radius', "radius", "radius and centre must be given together"),
        ('centre = "O", radius', 'centre = "Z", radius', "along.centre: the frame has no point"),
        ('centre = "A"', 'centre = "Q"', "[[rolling]] 1, centre: planet has no point"),
        ('link = "planet"', 'link = "frame"', '[[rolling]] 1, link: unknown link "frame"'),
        ("along", 'on = "planet"\nalong', "link planet cannot roll on itself"),
        (
            "along",
            'on = "OA"\nalong',
            'point "A" already belongs to OA, so the wheel cannot roll on this link',
        ),
        ("along", 'on = "AO"\nalong', '[[rolling]] 1, on: unknown link "AO"'),
        (
            '"E", "Q"',
            '"E", "O"',
            'distance: points "E" and "O" both belong to the frame: their distance cannot change',
        ),
        ('"E", "Q"', '"P", "Q"', 'points "P" and "Q" both belong to rod: their distance cannot change; name'),
        ('"E", "Q"', '"Q", "Q"', "two different points are needed"),
        ('"E", "Q"', '"Q"', "two different points are needed"),
        ('"E", "Q"', '"E", "Z"', '[[drives]] 1, distance: unknown point "Z"'),
        (
            "start = 1.5",
            "start = 0",
            "[[drives]] 1: a cylinder shorter than zero: its length at t = 0 is 0 m",
        ),
        (
            "start = 1.5",
            'start = "-2 mm"',
            "its length at t = 0 is -0.002 m; give the distance of the points",
        ),
        ("speed = 0.1", 'law = "t - 2"', "its length at t = 0 is -0.5 m"),
        ("speed = 0.1", 'speed = "1 rad/s"', "expected a speed"),
    ],
)
def test_what_is_refused(complaint: Complaint, old: str, new: str, message: str) -> None:
    assert old in PLANETARY
    assert message in complaint(PLANETARY.replace(old, new, 1))


def test_a_law_may_bring_the_length() -> None:
    """The length at t = 0 counts, not `start` alone."""
    text = PLANETARY.replace("start = 1.5", "start = 0").replace("speed = 0.1", 'law = "1.5 + 0.2*sin(t)"')
    assert parse_mechanism(text).drives[0].start == 0
    assert parse_mechanism(PLANETARY.replace("start = 1.5", "")).drives[0].start is None


def test_a_wheel_outside_may_be_as_large_as_its_circle() -> None:
    text = PLANETARY.replace("radius = 1", "radius = 3").replace(", inside = true", "")
    assert parse_mechanism(text).rolling[0].radius == 3


def test_two_of_a_kind_need_names() -> None:
    gears = [{"links": ["OA", "BC"], "ratio": 2, "name": name} for name in ("first", "second")]
    links = {"OA": {"length": 1}, "BC": {"points": ["O", "C"], "length": math.pi}}
    m = Mechanism(frame={"points": {"O": (0, 0)}}, links=links, gears=gears)
    assert [gear.id for gear in m.gears] == ["first", "second"]
