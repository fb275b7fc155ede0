"""Segments of a cam by shares of the cycle and by times, beside the same by angles."""

from __future__ import annotations

import math
import sys
from typing import Any

import pytest

import centrode as ct
from centrode.model.schema import cam_schema

EPS = sys.float_info.epsilon
LIFTS: list[dict[str, Any]] = [
    {"to": "20 mm", "curve": "modified sine"},
    {"curve": "dwell"},
    {"to": 0, "curve": "parabolic"},
    {"curve": "dwell"},
]


def cam(lengths: list[dict[str, Any]], **body: Any) -> ct.PlateCam:
    segments = [{**length, **lift} for length, lift in zip(lengths, LIFTS, strict=True)]
    return ct.PlateCam(kind="cam", cam=body, follower={"contact": "knife"}, segments=segments)


ANGLES = [{"angle": f"{angle} deg"} for angle in (120, 60, 141, 39)]


def angles_of(read: ct.PlateCam) -> list[float]:
    return [math.degrees(segment.angle) for segment in read.segments]


def test_shares_of_the_cycle() -> None:
    read = cam([{"share": "1/3"}, {"share": "1/6"}, {"angle": "141 deg"}, {"share": 39 / 360}])
    assert angles_of(read) == pytest.approx([120, 60, 141, 39], rel=8 * EPS)
    expected, found = ct.cam(cam(ANGLES), 37), ct.cam(read, 37)
    assert found.lift.values == pytest.approx(expected.lift.values, rel=0, abs=64 * EPS * 0.02)
    assert ct.parse_cam(ct.cam_text(read)) == read


def test_times_with_the_speed_of_the_cam() -> None:
    """60 rpm: a turn a second."""
    lengths = [{"time": "1/3 s"}, {"share": "1/6"}, {"time": 141 / 360}, {"angle": "39 deg"}]
    assert angles_of(cam(lengths, speed="60 rpm")) == pytest.approx([120, 60, 141, 39], rel=8 * EPS)


def test_times_of_all_segments_give_the_speed() -> None:
    read = cam([{"time": time} for time in (0.2, 0.1, 0.235, 0.065)], base_radius="30 mm")
    assert angles_of(read) == pytest.approx([120, 60, 141, 39], rel=8 * EPS)
    assert read.body.speed == pytest.approx(math.tau / 0.6, rel=4 * EPS) and read.body.base_radius == 0.03


def test_a_file_that_displays_degrees() -> None:
    text = """
kind = "cam"
display = { angle = "deg" }
[follower]
contact = "knife"
[[segments]]
share = "1/2"
to = "10 mm"
curve = "3-4-5"
[[segments]]
share = 0.5
to = 0
curve = "3-4-5"
"""
    assert angles_of(ct.parse_cam(text)) == [180.0, 180.0]


@pytest.mark.parametrize(
    ("lengths", "message"),
    [
        ([{"share": 0.5, "angle": 1}, *ANGLES[1:]], "angle, share are given together"),
        ([{"share": 1.5}, *ANGLES[1:]], "a share of the cycle is at most 1"),
        ([{"share": -0.5}, *ANGLES[1:]], "segment"),
        ([{"time": "0.1 s"}, *ANGLES[1:]], "the cam has no speed"),
        ([{"time": "0.1 m"}, *ANGLES[1:]], "time"),
        ([{"share": "1/3"}, {"share": "1/3"}, *ANGLES[2:]], "overlap"),
        ([{}, *ANGLES[1:]], "angle"),
    ],
)
def test_lengths_that_cannot_be(lengths: list[dict[str, Any]], message: str) -> None:
    with pytest.raises(ct.InputError, match=message):
        cam(lengths)


def test_the_schema_has_them() -> None:
    (segment,) = [part for name, part in cam_schema()["$defs"].items() if name == "LiftSegment"]
    assert {"angle", "share", "time"} <= set(segment["properties"])
