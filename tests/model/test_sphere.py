"""The sphere: places against complex rotations by hand, angles against the law of cosines, what is refused."""

import math
from collections.abc import Callable

import pytest
from hypothesis import given
from hypothesis import strategies as st

from centrode.errors import InputError
from centrode.model.files import mechanism_text, parse_mechanism, value_at, with_value
from centrode.model.mechanism import Mechanism
from centrode.model.placement import replace_placed
from centrode.model.values import angle_between, arc, dot, longitude_latitude, unit_vector

Complaint = Callable[[str], str]
EPS = 2.0**-52
LONGITUDE = st.floats(-math.pi, math.pi)
LATITUDE = st.floats(-1.5, 1.5)
"""Away from the poles, where a longitude means nothing."""

CRANK = """
space = "sphere"
[frame.points]
A = [1, 0, 0]
D = [0, 1, 0]
Z = [0, 0, 1]
[links.AB]
length = "15 deg"
reference = ["A", "D"]
[links.BC]
length = "45 deg"
[links.rocker]
points = { D = [0, 0], C = ["90 deg", 0], P = [0.3, -0.2] }
reference = ["D", "Z"]
angle = "47 deg"
[[guides]]
point = "P"
on = "AB"
pole = [0.1, 0.2]
[[drives]]
link = "AB"
start = 0
speed = 1
"""


@given(LONGITUDE, LATITUDE)
def test_places_come_back(longitude: float, latitude: float) -> None:
    vector = unit_vector((longitude, latitude))
    assert abs(math.hypot(*vector) - 1) <= 4 * EPS
    again = longitude_latitude(vector)
    # four roundings of the vector, seen from the axis at the distance cos(latitude)
    bound = 8 * EPS * math.pi / math.cos(latitude)
    assert again == pytest.approx((longitude, latitude), abs=bound)


def test_axes_and_poles() -> None:
    assert unit_vector((0, 0)) == (1, 0, 0)
    assert unit_vector((math.pi / 2, 0)) == pytest.approx((0, 1, 0), abs=EPS)
    assert unit_vector((3, math.pi / 2)) == pytest.approx((0, 0, 1), abs=EPS)
    assert longitude_latitude((0, 0, 2)) == (0, math.pi / 2)
    assert arc((1, 0, 0), unit_vector((1e-8, 0))) == pytest.approx(1e-8, rel=4 * EPS)


@given(LONGITUDE, LATITUDE, LONGITUDE, LATITUDE)
def test_angles_obey_the_spherical_law_of_cosines(a: float, b: float, c: float, d: float) -> None:
    pivot, one, other = (0.0, 0.0, 1.0), unit_vector((a, b)), unit_vector((c, d))
    angle = angle_between(pivot, one, other)
    # seen from the pole the angle is the difference of the longitudes; points near it tell it less well
    bound = 16 * EPS / min(math.cos(b), math.cos(d))
    assert math.cos(angle) == pytest.approx(math.cos(c - a), abs=bound)
    assert math.sin(angle) == pytest.approx(math.sin(c - a), abs=bound)
    between = math.sin(b) * math.sin(d) + math.cos(b) * math.cos(d) * math.cos(angle)
    assert dot(one, other) == pytest.approx(between, abs=bound)


@given(st.floats(0.1, 3), st.floats(-3, 3))
def test_a_placed_point_of_a_crank(length: float, beta: float) -> None:
    """B = (cos AB, sin AB cos beta, sin AB sin beta): crank about the x axis, measured from the y axis."""
    m = Mechanism(
        space="sphere",
        frame={"points": {"A": (1, 0, 0), "D": (0, 1, 0), "B": "placed"}},
        links={"AB": {"length": length, "reference": ["A", "D"]}},
        drives=[{"link": "AB", "start": beta, "speed": 1}],
    )
    there = math.cos(length), math.sin(length) * math.cos(beta), math.sin(length) * math.sin(beta)
    assert unit_vector(m.frame.coordinates["B"]) == pytest.approx(there, abs=32 * EPS)
    assert parse_mechanism(mechanism_text(m)) == m
    assert replace_placed(m) == m


def test_a_chain_of_links_is_placed() -> None:
    """An octant: three arcs of 90 deg, each turned by 90 deg, lead back to the start."""
    right = "90 deg"
    m = Mechanism(
        space="sphere",
        frame={"points": {"A": (1, 0, 0), "D": (0, 1, 0), "E": "placed", "F": "placed"}},
        links={
            "AB": {"length": right, "angle": right, "reference": ["A", "D"]},
            "plate": {
                "points": {"B": (0, 0, 1), "E": (0, 1, 0), "F": (1, 0, 0)},
                "angle": right,
                "reference": ["B", "A"],
            },
        },
    )
    # B is the north pole; from the arc BA, a quarter turn on, the arc BE meets D; F lies a quarter turn back from E
    assert unit_vector(m.frame.coordinates["E"]) == pytest.approx((0, 1, 0), abs=8 * EPS)
    assert unit_vector(m.frame.coordinates["F"]) == pytest.approx((1, 0, 0), abs=8 * EPS)


@pytest.mark.parametrize(
    ("links", "repair"),
    [
        (
            {"AB": {"length": 1, "angle": 0, "reference": ["A", "D"]}, "BC": {"length": 1}},
            "initial angle of BC",
        ),
        ({"CA": {"length": 1, "angle": 0, "reference": ["C", "D"]}}, "give its coordinates"),
    ],
)
def test_what_the_chain_does_not_reach(links: dict[str, dict[str, object]], repair: str) -> None:
    """A missing angle; a link that is known at its second point only."""
    points = {"A": (1, 0, 0), "D": (0, 1, 0), "C": "placed"}
    with pytest.raises(InputError, match=f'"C" cannot be placed.*{repair}'):
        Mechanism(space="sphere", frame={"points": points}, links=links)


def test_values_by_path() -> None:
    m = parse_mechanism(CRANK)
    assert value_at(m, "frame.points.D.longitude") == math.pi / 2
    assert value_at(m, "links.AB.length") == pytest.approx(math.pi / 12, rel=EPS)
    assert value_at(m, "links.rocker.points.P.latitude") == -0.2
    assert value_at(m, "guides.P.radius") == math.pi / 2
    assert value_at(m, "guides.P.pole.latitude") == 0.2
    assert value_at(with_value(m, "guides.P.radius", "30 deg"), "guides.P.radius") == math.radians(30)
    assert value_at(with_value(m, "guides.P.pole.longitude", 1), "guides.P.pole.longitude") == 1
    with pytest.raises(InputError, match='there is no "x"'):
        value_at(m, "frame.points.D.x")
    with pytest.raises(InputError, match="shorter than half a great circle"):
        with_value(m, "links.AB.length", 4)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            '"45 deg"',
            '"180 deg"',
            '[links.BC]: length must be shorter than half a great circle, got "180 deg"',
        ),
        ('"45 deg"', "0", "[links.BC]: length must be positive, got 0"),
        ("pole = [0.1, 0.2]", "pole = [0.1, 0.2]\nradius = 3.2", "radius must be shorter than half a great"),
        (
            "A = [1, 0, 0]",
            "A = [1, 0.1, 0]",
            "[frame.points] A: expected a unit vector, got one of length 1.00",
        ),
        ("A = [1, 0, 0]", 'A = [0, "91 deg"]', "a latitude must lie between -90 and 90 deg, got 91 deg"),
        ("A = [1, 0, 0]", 'A = ["1 m", 0]', "expected an arc (rad)"),
        ("P = [0.3, -0.2]", "P = [0.3, -0.2, 1]", "expected a unit vector"),
        (
            "pole = [0.1, 0.2]",
            "pole = [0.1, 0.2]\ndirection = 0",
            "direction is used in the plane only; on the sphere",
        ),
        ("pole = [0.1, 0.2]", "pole = [0.1, 0.2]\nthrough = [0, 0]", "through is used in the plane only"),
        ("pole = [0.1, 0.2]", 'pole = "placed"', "[[guides]] 1, pole: a pole cannot be placed; give its"),
        ("pole = [0.1, 0.2]", 'pole = "C"', "[[guides]] 1, pole: AB has no point"),
        (
            "[frame.points]",
            "gravity = [0, -10]\n[frame.points]",
            "gravity: expected [x, y, z], got a list of 2 values",
        ),
        (
            '"45 deg"',
            '"45 deg"\nshape = "rod"',
            "[links.BC] shape: rod is used in the plane only; write arc, disc or ring",
        ),
        (
            "[[drives]]",
            '[assembly]\nsides = { C = "ahead" }\n[[drives]]',
            "sides] C: ahead is used in the plane only",
        ),
        (
            "[[drives]]",
            '[[loads]]\nkind = "force"\npoint = "C"\nvector = [1, 0]\n[[drives]]',
            "[[loads]] 1, vector: expected [x, y, z], got a list of 2 values",
        ),
        (
            'reference = ["A", "D"]',
            "",
            '[links.AB]: reference is missing: on the sphere the angle is measured from an arc; add reference = ["A"',
        ),
        ('reference = ["D", "Z"]', "", "[links.rocker]: reference is missing"),
        (
            'reference = ["A", "D"]',
            'reference = ["D", "A"]',
            '[links.AB] reference: the reference starts at "D", the link\'s first point is "A"',
        ),
        ('reference = ["A", "D"]', 'reference = ["A", "A"]', "two different points are needed"),
        ('reference = ["A", "D"]', 'reference = ["A"]', "two different points are needed"),
        ('reference = ["A", "D"]', 'reference = ["A", "Q"]', '[links.AB] reference: unknown point "Q"'),
        (
            "Z = [0, 0, 1]",
            "Z = [0, -1, 0]",
            "coincide or are diametrically opposite define no arc from which to measure an angle",
        ),
        (
            'C = ["90 deg", 0]',
            "C = [0, 0]",
            "[links.rocker] reference: two points that coincide or are diametrically opposite",
        ),
        (
            "start = 0",
            'start = 0\nrelative_to = "rocker"',
            'the drive is relative to rocker, but "A" of the reference is not a point of it; name two points',
        ),
        ('space = "sphere"', 'space = "plane"', "expected a length (m)"),
    ],
)
def test_what_is_refused(complaint: Complaint, old: str, new: str, message: str) -> None:
    assert old in CRANK
    assert message in complaint(CRANK.replace(old, new, 1))


def test_a_link_of_one_point_has_no_angle(complaint: Complaint) -> None:
    text = CRANK + '[links.pin]\npoints = ["C"]\nangle = 0\nreference = ["C", "D"]\n'
    assert "a link of one point has no angle on the sphere" in complaint(text)


def test_a_reference_in_the_plane(complaint: Complaint) -> None:
    text = '[frame.points]\nO = [0, 0]\nD = [1, 0]\n[links.OA]\nlength = 1\nreference = ["O", "D"]\n'
    assert "[links.OA] reference: reference is used on the sphere only; remove it" in complaint(text)


@pytest.mark.parametrize(
    "more",
    [
        '[[gears]]\nlinks = ["AB", "rocker"]\nratio = 2\n',
        '[[rolling]]\nlink = "rocker"\ncentre = "C"\nradius = 0.1\nalong = { centre = "A", radius = 1 }\n',
        '[[guides]]\npoint = "C"\nname = "c"\npole = "A"\nlink = "BC"\n',
        '[[drives]]\ndistance = ["A", "C"]\nstart = 1\nspeed = 1\n',
    ],
)
def test_what_is_left_to_the_structure_is_read(more: str) -> None:
    mechanism = parse_mechanism(CRANK + more)
    assert parse_mechanism(mechanism_text(mechanism)) == mechanism
