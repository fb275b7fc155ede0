"""The description of a cam by its follower's lift: read, written, refused."""

from __future__ import annotations

import math
import tomllib

import pytest

import centrode as ct
from centrode.cams.followers.motion import cam_laws, follower_motion
from centrode.errors import InputError
from centrode.model.cam import vary_cam
from centrode.model.cam_files import cam_text, parse_cam
from centrode.model.schema import PLATE_PROPERTIES, cam_schema

from .test_schema import fits

FULL = """\
kind = "cam"
title = "Valve cam"
display = { length = "mm", angle = "deg" }

[cam]
base_radius = "4 cm"
turn = "clockwise"
speed = "600 rpm"
thickness = "12 mm"
material = { elasticity = "210 GPa" }

[follower]
kind = "translating"
contact = "roller"
roller_radius = "10 mm"
offset = "-6 mm"
mass = "500 g"
spring = { stiffness = "5 N/mm", preload = "100 N" }
load = "20 N"
friction = 0.05
material = { elasticity = "2e5 N/mm^2", poisson = 0.28 }

[[segments]]
angle = "90 deg"
to = "25 mm"
curve = "cycloidal"

[[segments]]
from = "90 deg"
angle = "pi/4 rad"
curve = "dwell"

[[segments]]
angle = "135 deg"
to = "5 mm"
curve = "polynomial"
at_start = [0, "0 mm/rad^2"]
at_end = ["2 mm/rad", "1 mm/deg^2", 0.003]
through = [["60 deg", "15 mm"]]

[[segments]]
angle = "90 deg"
to = 0
curve = "b-spline"
degree = 4
at_end = [0, 0]
through = [["30 deg", "3 mm"], ["60 deg", 0.001]]

[bounds]
pressure_angle = "30 deg"
curvature_radius = "5 mm"
stress = "600 MPa"

[tool]
radius = "20 mm"

[study]
samples = 73
instants = ["0 deg", "45 deg"]
"""

SWINGING = """\
kind = "cam"
[cam]
base_radius = 0.04
[follower]
kind = "oscillating"
contact = "roller"
roller_radius = 0.008
arm = "90 mm"
pivot_distance = "110 mm"
inertia = "800 kg*mm^2"
spring = { stiffness = "2 N*m/deg", preload = "3 N*m" }
load = "0.5 N*m"
[[segments]]
angle = "180 deg"
to = "20 deg"
curve = "polynomial"
at_start = [0, "1 deg/rad^2"]
at_end = ["0.1 deg/deg", 0]
[[segments]]
angle = "180 deg"
to = 0
curve = "harmonic"
"""


def test_units_become_si() -> None:
    cam = parse_cam(FULL)
    assert isinstance(cam, ct.PlateCam)
    assert (cam.body.base_radius, cam.body.turn, cam.body.thickness) == (0.04, "clockwise", 0.012)
    assert cam.body.speed == pytest.approx(20 * math.pi, rel=1e-15)
    assert cam.follower.spring is not None and cam.follower.spring.stiffness == pytest.approx(5000, rel=1e-15)
    assert (cam.follower.mass, cam.follower.offset, cam.follower.load) == (0.5, -0.006, 20.0)
    first, second, third, fourth = cam.segments
    assert (first.angle, first.to) == (math.pi / 2, 0.025)
    assert (second.start, second.angle, second.to) == (math.pi / 2, math.pi / 4, None)
    per_square = 1e-3 * (180 / math.pi) ** 2
    assert third.at_end == (pytest.approx(0.002), pytest.approx(per_square, rel=1e-14), 0.003)
    assert fourth.through == ((pytest.approx(math.pi / 6), 0.003), (pytest.approx(math.pi / 3), 0.001))
    assert (third.degree, fourth.degree) == (None, 4)
    assert cam.bounds.stress == 6e8 and cam.tool is not None and cam.tool.radius == 0.02


def test_an_oscillating_follower_has_angles_and_moments() -> None:
    cam = parse_cam(SWINGING)
    assert isinstance(cam, ct.PlateCam) and cam.swings
    assert cam.segments[0].to == pytest.approx(math.pi / 9, rel=1e-15)
    assert cam.segments[0].at_start == (0.0, pytest.approx(math.pi / 180, rel=1e-14))
    assert cam.segments[0].at_end == (pytest.approx(0.1, rel=1e-14), 0.0)
    assert cam.follower.spring is not None
    assert cam.follower.spring.stiffness == pytest.approx(360 / math.pi, rel=1e-14)


@pytest.mark.parametrize("text", [FULL, SWINGING])
def test_what_is_written_reads_back_the_same(text: str) -> None:
    cam = parse_cam(text)
    assert parse_cam(cam_text(cam)) == cam
    schema = cam_schema()
    assert fits(tomllib.loads(text), schema, schema)
    assert fits(tomllib.loads(cam_text(cam)), schema, schema)


def test_keys_of_the_schema_are_those_of_the_parts() -> None:
    for part, properties in PLATE_PROPERTIES.items():
        assert list(properties) == list(part.keys()), part


def test_a_turn_written_to_ten_digits_is_one() -> None:
    """What is missing after the tenth digit goes to the last segment; the law's period is a turn."""
    third = "'2.0943951024 rad'"
    segments = "\n".join(
        f"[[segments]]\nangle = {third}\nto = {to}\ncurve = '3-4-5'" for to in ("0.01", "0.02", "0")
    )
    text = FULL[: FULL.index("[[segments]]")] + segments
    cam = parse_cam(text)
    assert isinstance(cam, ct.PlateCam)
    assert cam.lift_law.period == pytest.approx(math.tau, rel=4e-16)


def lessened(old: str, new: str, text: str = FULL) -> str:
    assert old in text
    return text.replace(old, new, 1)


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        (
            'angle = "135 deg"',
            'angle = "140 deg"',
            "segments: the segments overlap: together they take 365 deg",
        ),
        ('angle = "135 deg"', 'angle = "140 deg"', "shorten one by 5 deg"),
        ('angle = "135 deg"', 'angle = "120 deg"', "the segments leave a gap: together they take 345 deg"),
        ('angle = "135 deg"', 'angle = "120 deg"', "add a dwell of 15 deg"),
        (
            'from = "90 deg"',
            'from = "80 deg"',
            "[[segments]] 2: it begins at 80 deg, but the one before ends at 90 deg",
        ),
        ('from = "90 deg"', 'from = "100 deg"', "ends at 90 deg: a gap"),
        ('to = 0\ncurve = "b-spline"', 'to = "1 mm"\ncurve = "b-spline"', "the lift does not return"),
        (
            'to = "25 mm"',
            'to = "-25 mm"',
            "[[segments]] 1, to: the lift is measured from its lowest position",
        ),
        ('to = "25 mm"', 'to = "25 deg"', 'expected a length (m), got "25 deg"'),
        ('to = "25 mm"\n', "", '[[segments]] 1: "to" is missing'),
        (
            'angle = "90 deg"\nto = "25 mm"',
            'angle = "90 mm"\nto = "25 mm"',
            'expected an angle (rad), got "90 mm"',
        ),
        ('angle = "90 deg"\nto = "25 mm"', 'angle = 0\nto = "25 mm"', "angle must be positive, got 0"),
        ('curve = "cycloidal"', 'curve = "cyclodal"', 'did you mean "cycloidal"?'),
        (
            'curve = "cycloidal"',
            'curve = "cycloidal"\nat_end = [0]',
            "at_end is used with a polynomial or a B-spline only",
        ),
        ('curve = "cycloidal"', 'curve = "cycloidal"\ndegree = 3', "degree is used with a B-spline only"),
        (
            'curve = "dwell"',
            'curve = "dwell"\nto = 0.01',
            "the lift stays constant in a dwell, so it has no `to`",
        ),
        ('at_start = [0, "0 mm/rad^2"]', 'at_start = [0, "1 mm/s^2"]', "expected a rate (m/rad^2), got"),
        ('at_start = [0, "0 mm/rad^2"]', 'at_start = ["fast"]', "expected a rate (m/rad), got"),
        ('at_start = [0, "0 mm/rad^2"]', f"at_start = {[0] * 9}", "at most 8 entries are allowed, got 9"),
        (
            'through = [["60 deg", "15 mm"]]',
            'through = [["160 deg", 0]]',
            "the angles of `through` must increase",
        ),
        ('through = [["60 deg", "15 mm"]]', "through = [0.5]", "expected [angle, lift], got 0.5"),
        (
            "degree = 4",
            "degree = 2",
            "a B-spline of degree 2 admits fewer derivatives at an end than its degree, got 2",
        ),
        (
            'to = "25 mm"',
            "to = 1e30",
            "[[segments]] 1: the lift grows too large: with these conditions it may reach 1e+30 m",
        ),
        ("at_start = [0,", "at_start = [1e20,", "[[segments]] 3: the lift grows too large"),
        (
            'through = [["60 deg", "15 mm"]]',
            'through = [["1e-30 rad", 0.015]]',
            "[[segments]] 3: the lift grows too large",
        ),
        (
            'from = "90 deg"\nangle = "pi/4 rad"',
            'angle = "1e-7 rad"',
            '"1e-7 rad" is outside the range that can be computed; stay above',
        ),
        ("degree = 4", "degree = 40", "degree must be a whole number from 1 to 15, got 40"),
        ('contact = "roller"\nroller_radius = "10 mm"', 'contact = "roller"', '"roller_radius" is missing'),
        ('contact = "roller"', 'contact = "knife"', '"roller_radius" is used with a roller only; remove it'),
        ('contact = "roller"', 'contact = "ball"', 'expected one of "knife", "roller", "flat"'),
        ('offset = "-6 mm"', 'arm = "6 mm"', '"arm" is used with an oscillating follower'),
        ('mass = "500 g"', 'inertia = "500 kg*mm^2"', '"inertia" is used with an oscillating follower only'),
        (
            'stiffness = "5 N/mm"',
            'stiffness = "5 N*m/deg"',
            "[follower.spring] stiffness: expected a stiffness (N/m)",
        ),
        ("to = 0", "to = 1e-60", "stay above 1e-50"),
        ('load = "20 N"', 'load = "20 N*m"', "[follower] load: expected a force (N)"),
        ('base_radius = "4 cm"', 'base_radius = "-4 cm"', "[cam]: base_radius must be positive"),
        ('turn = "clockwise"', 'turn = "left"', 'expected one of "counter-clockwise", "clockwise"'),
        ('speed = "600 rpm"', 'speed = "10 Hz"', "does not distinguish turns from radians"),
        ('pressure_angle = "30 deg"', 'pressure_angle = "90 deg"', "smaller than 90 deg"),
        ("samples = 73", "terms = 73", 'unknown key "terms"'),
        ("[tool]", "[tols]", 'unknown key "tols"'),
        (
            "[bounds]",
            '[curvature]\nlaw = "constant"\n[bounds]',
            "[curvature] and [follower] exclude each other",
        ),
    ],
)
def test_what_is_wrong_is_told_with_its_place(old: str, new: str, told: str) -> None:
    with pytest.raises(InputError) as refusal:
        parse_cam(lessened(old, new), "cam.toml")
    assert told in str(refusal.value)
    assert str(refusal.value).startswith("cam.toml")


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ('arm = "90 mm"\n', "", '"arm" is missing'),
        ('to = "20 deg"', 'to = "20 mm"', 'expected an angle (rad), got "20 mm"'),
        ('preload = "3 N*m"', 'preload = "3 N"', "expected a torque (N*m)"),
        ('inertia = "800 kg*mm^2"', 'mass = "1 kg"', '"mass" is used with a translating follower only'),
        (
            'pivot_distance = "110 mm"',
            'pivot_distance = "110 mm"\noffset = "3 mm"',
            '"offset" is used with a translating',
        ),
        ('kind = "oscillating"', 'kind = "swinging"', 'expected one of "translating", "oscillating"'),
    ],
)
def test_what_an_oscillating_follower_is_not_is_told(old: str, new: str, told: str) -> None:
    with pytest.raises(InputError) as refusal:
        parse_cam(lessened(old, new, SWINGING), "cam.toml")
    assert told in str(refusal.value)


def test_a_segment_may_move_on_its_way_only() -> None:
    """One polynomial or spline all round, from 0 to 0."""
    head = FULL[: FULL.index("[[segments]]")] + '[[segments]]\nangle = "360 deg"\nto = 0\n'
    way = 'through = [["90 deg", "8 mm"], ["180 deg", "20 mm"], ["270 deg", "8 mm"]]\n'
    cam = parse_cam(head + 'curve = "b-spline"\nat_start = [0, 0]\nat_end = [0, 0]\n' + way)
    assert follower_motion(cam).lift(math.pi)[0] == pytest.approx(0.02, rel=1e-14)
    with pytest.raises(InputError, match="there is no rise for which to compare laws"):
        cam_laws(cam)
    with pytest.raises(InputError, match="nothing moves"):
        parse_cam(head + 'curve = "polynomial"\n')


def test_nothing_that_moves_is_refused() -> None:
    still = FULL[: FULL.index("[[segments]]")] + '[[segments]]\nangle = "360 deg"\ncurve = "dwell"\n'
    with pytest.raises(InputError, match="nothing moves"):
        parse_cam(still)
    with pytest.raises(InputError, match='"follower" is missing'):
        parse_cam(FULL[: FULL.index("[follower]")] + FULL[FULL.index("[[segments]]") :])
    with pytest.raises(InputError, match='"segments" is missing'):
        parse_cam(FULL[: FULL.index("[[segments]]")])
    with pytest.raises(InputError, match="no segments are given"):
        ct.PlateCam(kind="cam", follower={"contact": "knife"}, segments=[])


def test_other_numbers_may_be_put_in() -> None:
    cam = parse_cam(FULL)
    other = vary_cam(cam, {"cam.base_radius": 0.05, "follower.offset": 0.0})
    assert isinstance(other, ct.PlateCam)
    assert (other.body.base_radius, other.follower.offset) == (0.05, 0.0)
    assert vary_cam(cam, {}) == cam
    with pytest.raises(InputError, match="the cam has no"):
        vary_cam(cam, {"curvature.k0": 1.0})
