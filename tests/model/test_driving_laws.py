"""Drives by segments: what a file may say, what it means, and what is refused."""

import math
import tomllib
from collections.abc import Callable

import pytest

import centrode as ct
from centrode.errors import InputError
from centrode.laws import LawSegment, SegmentedLaw
from centrode.model.files import mechanism_text, parse_mechanism
from centrode.model.schema import mechanism_schema
from centrode.model.segments import rate

from .conftest import FOUR_BAR
from .test_schema import fits

EVERY_KEY = """segments = [
  { to = "120 deg", time = "2 s", curve = "cycloidal" },
  { time = "500 ms", curve = "dwell" },
  { to = -1, time = 1, curve = "polynomial", speed_at_start = 0, acceleration_at_start = "9 deg/s^2", \
jerk_at_start = "3", speed_at_end = "-10 rpm", acceleration_at_end = "1 turn/s/s", jerk_at_end = "1 deg/s^3", \
through = [["250 ms", "30 deg"], [0.5, 0]] },
]
repeat = true"""
DEGREE = math.radians(1)


def driven(lines: str) -> str:
    """The four-bar with its crank driven by other lines than `speed`."""
    return FOUR_BAR.replace("speed = 1", lines)


def segment(keys: str) -> str:
    return driven(f"segments = [{{ {keys} }}]")


def test_every_key_is_read_with_its_unit() -> None:
    law = parse_mechanism(driven(EVERY_KEY)).drives[0].motion_law
    assert isinstance(law, SegmentedLaw)
    assert law.repeat
    rise, dwell, back = law.segments
    assert (rise.time, rise.to, rise.curve) == (2.0, pytest.approx(120 * DEGREE), "cycloidal")
    assert dwell == LawSegment(0.5, None, "dwell")
    assert (back.time, back.to, back.curve) == (1.0, -1.0, "polynomial")
    assert back.at_start == pytest.approx((0.0, 9 * DEGREE, 3.0))
    assert back.at_end == pytest.approx((-math.pi / 3, 2 * math.pi, DEGREE))
    assert back.through == ((0.25, pytest.approx(30 * DEGREE)), (0.5, 0.0))


def test_numbers_of_a_displacement_are_lengths() -> None:
    drive = ct.Drive(
        guide="C",
        segments=[{"to": "120 mm", "time": 2, "curve": "polynomial", "speed_at_start": "5 mm/s"}],  # type: ignore[list-item]
    )
    assert drive.motion_law == SegmentedLaw((LawSegment(2.0, 0.12, "polynomial", (0.005,)),))
    with pytest.raises(InputError, match=r"segment 1, to: expected a length \(m\), got \"3 deg\""):
        ct.Drive(guide="C", segments=[{"to": "3 deg", "time": 2, "curve": "uniform"}])  # type: ignore[list-item]


@pytest.mark.parametrize(
    ("value", "kind", "order", "expected"),
    [
        ("60 rpm", "angle", 1, 2 * math.pi),
        ("20 mm/s", "length", 1, 0.02),
        ("20 mm/s^2", "length", 2, 0.02),
        ("20 mm/s/s", "length", 2, 0.02),
        (" 30 deg/s**2 ", "angle", 2, math.pi / 6),
        ("60 rpm/s", "angle", 2, 2 * math.pi),
        ("2 mm/ms^3", "length", 3, 2e6),
        ("1/2", "length", 3, 0.5),
        (7, "angle", 3, 7.0),
    ],
)
def test_rates(value: object, kind: str, order: int, expected: float) -> None:
    assert rate(value, kind, order) == pytest.approx(expected, rel=1e-15)


def test_it_is_written_back_exactly() -> None:
    mechanism = parse_mechanism(driven(EVERY_KEY))
    assert parse_mechanism(mechanism_text(mechanism)) == mechanism
    assert ct.with_value(mechanism, "drives.OA.start", 2).drives[0].segments == mechanism.drives[0].segments


def test_the_schema_knows_the_keys() -> None:
    schema = mechanism_schema()
    assert fits(tomllib.loads(driven(EVERY_KEY)), schema, schema)
    assert fits(tomllib.loads(mechanism_text(parse_mechanism(driven(EVERY_KEY)))), schema, schema)
    for keys in ('to = 1, time = 0, curve = "uniform"', 'to = 1, time = 1, curve = "cycloid"', "to = 1"):
        assert not fits(tomllib.loads(segment(keys)), schema, schema)


def test_it_is_a_law_of_time() -> None:
    """Ends of the study are times, and the range is that of the segments."""
    lines = 'segments = [{ to = "90 deg", time = "3 s", curve = "3-4-5" }]'
    mechanism = parse_mechanism(driven(lines) + '[study]\nto = "1500 ms"\n[assembly]\nsides = { B = "left" }')
    assert mechanism.study.stop == 1.5
    motion = ct.motion(mechanism, samples=3, stop=3)
    assert motion.time.values.tolist() == [0.0, 1.5, 3.0]
    turned = motion.angle.sel(link="OA").values - 1
    assert turned.tolist() == pytest.approx([0, math.pi / 4, math.pi / 2], abs=1e-15)
    speed = 1.875 * (math.pi / 2) / 3
    assert motion.angular_velocity.sel(link="OA").values.tolist() == pytest.approx([0, speed, 0], rel=1e-14)
    free = parse_mechanism(driven(lines) + '[assembly]\nsides = { B = "left" }')
    assert ct.motion(free, samples=2).time.values.tolist() == [0.0, 3.0]


def test_a_drive_may_follow_a_b_spline() -> None:
    """Values at the points, rest at the ends; what is written reads back the same."""
    rest = "speed_at_start = 0, acceleration_at_start = 0, speed_at_end = 0, acceleration_at_end = 0"
    points = 'through = [[0.5, "20 deg"], [1.5, "70 deg"]]'
    lines = f'segments = [{{ to = "90 deg", time = 2, curve = "b-spline", {points}, {rest} }}]'
    mechanism = parse_mechanism(driven(lines) + '[assembly]\nsides = { B = "left" }')
    motion = ct.motion(mechanism, samples=5)
    turned = motion.angle.sel(link="OA").values - 1
    assert turned.tolist() == pytest.approx(
        [math.radians(x) for x in (0, 20, turned[2] * 180 / math.pi, 70, 90)]
    )
    assert motion.angular_velocity.sel(link="OA").values[[0, 4]].tolist() == [0, 0]
    assert motion.angular_acceleration.sel(link="OA").values[[0, 4]].tolist() == [0, 0]
    assert parse_mechanism(mechanism_text(mechanism)) == mechanism


def test_repeated_segments_need_a_time_to_run() -> None:
    lines = 'segments = [{ to = "1 turn", time = "3 s", curve = "cycloidal" }]\nrepeat = true'
    mechanism = parse_mechanism(driven(lines) + '[assembly]\nsides = { B = "left" }')
    with pytest.raises(InputError, match="duration is not given"):
        ct.motion(mechanism, samples=3)
    motion = ct.motion(mechanism, samples=3, stop=9)
    assert motion.angle.sel(link="OA").values[-1] == pytest.approx(1 + 6 * math.pi, rel=1e-15)


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ("", 'segment 1: "time" is missing'),
        ('to = 1, time = 0, curve = "uniform"', "segment 1: time must be positive, got 0"),
        ('to = 1, time = "-2 s", curve = "uniform"', 'segment 1: time must be positive, got "-2 s"'),
        ('to = 1, time = "2 m", curve = "uniform"', "segment 1, time: expected a time (s)"),
        ('to = 1, time = 1, curve = "cycloid"', 'got "cycloid"; did you mean "cycloidal"?'),
        (
            "to = 1, time = 1, curve = 3",
            'segment 1, curve: expected one of "uniform", "parabolic", "harmonic"',
        ),
        ('time = 1, curve = "3-4-5"', 'segment 1: "to" is missing'),
        (
            'to = 1, time = 1, curve = "dwell"',
            "segment 1: the lift stays constant in a dwell, so it has no `to`",
        ),
        ('to = 1, tme = 1, time = 1, curve = "uniform"', 'unknown key "tme"; did you mean "time"?'),
        ('to = "1 mm", time = 1, curve = "uniform"', "segment 1, to: expected an angle (rad)"),
        (
            'to = 1, time = 1, curve = "uniform", speed_at_start = 0',
            'speed_at_start is used with a polynomial or a B-spline only; remove it, or write curve = "polynomial" or',
        ),
        (
            'to = 1, time = 1, curve = "polynomial", jerk_at_end = 1, speed_at_end = 1',
            "jerk_at_end needs acceleration_at_end as well",
        ),
        (
            'to = 1, time = 1, curve = "polynomial", speed_at_end = 1, acceleration_at_end = "3 mm/s^2"',
            'acceleration_at_end: expected a rate (rad/s^2), got "3 mm/s^2"; write a number in rad/s^2',
        ),
        (
            'to = 1, time = 1, curve = "polynomial", through = [[0.5, 1], [1.5, 2]]',
            "the times of `through` must increase and lie inside the segment",
        ),
        ('to = 1, time = 1, curve = "polynomial", through = [0.5]', "expected [time, value], got 0.5"),
        (
            'to = 1, time = 1, curve = "polynomial", degree = 3',
            "degree is used with a B-spline only; remove it; the degree of a polynomial follows from its conditions",
        ),
        (
            'to = 1, time = 1, curve = "b-spline", degree = 99',
            "degree must be a whole number from 1 to 15, got 99",
        ),
        (
            'to = 1, time = 1, curve = "b-spline", degree = 2, speed_at_end = 0, acceleration_at_end = 0',
            "a B-spline of degree 2 admits fewer derivatives at an end than its degree, got 2",
        ),
        (
            f'to = 1, time = 1, curve = "polynomial", through = {[[k / 20, 0] for k in range(1, 12)]}',
            "at most 10 entries are allowed, got 11",
        ),
    ],
)
def test_bad_segments_are_refused(complaint: Callable[[str], str], keys: str, message: str) -> None:
    told = complaint(segment(keys))
    assert told.startswith("press.toml, [[drives]] 1, segments: segment 1")
    assert message in told


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        ("segments = []", "a law of segments needs at least one"),
        ("segments = 3", "segments: expected a list, got 3"),
        ("segments = [3]", "segment 1: expected a table, got 3"),
        ('segments = [{ time = 1, curve = "dwell" }]\nspeed = 1', "speed, segments are given together"),
        ("speed = 1\nrepeat = true", "repeat is used with segments only; remove it, or give segments"),
        ('segments = [{ time = 1, curve = "dwell" }]\nrepeat = 1', "repeat: expected true or false, got 1"),
        (
            'segments = [{ time = 1e20, curve = "dwell" }, { time = 1, curve = "dwell" }]',
            "segment 2 is too short compared with those before it",
        ),
        (f"segments = [{'3, ' * 501}]", "at most 500 entries are allowed, got 501"),
    ],
)
def test_bad_drives_are_refused(complaint: Callable[[str], str], lines: str, message: str) -> None:
    assert message in complaint(driven(lines))


def test_several_wrong_segments_are_told_together(complaint: Callable[[str], str]) -> None:
    told = complaint(
        driven('segments = [{ to = 1 }, { time = 1, curve = "dwell" }, { time = -1, curve = "dwell" }]')
    )
    assert 'segment 1: "time" is missing' in told
    assert "segment 2" not in told
    assert "segment 3: time must be positive" in told
