"""Frames, frames a second, duration and speed: completed, and refused where they do not go together."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from centrode.animation.video_files import (
    FASTEST,
    LEAST_RATE,
    MOST_FRAMES,
    MOST_PIXELS,
    Timing,
    kind_of,
    size_of,
    timing_of,
)
from centrode.errors import InputError


@pytest.mark.parametrize(
    ("asked", "frames", "per_second"),
    [
        ({}, 60, 20.0),
        ({"frames": 24}, 24, 20.0),
        ({"fps": 10.0}, 60, 10.0),
        ({"frames": 30, "fps": 15.0}, 30, 15.0),
        ({"duration": 4.0}, 80, 20.0),
        ({"duration": 4.0, "fps": 12.5}, 50, 12.5),
        ({"duration": 4.0, "frames": 10}, 10, 2.5),
        ({"speed": 2.0}, 60, 20.0),  # a period of 6 s in 3 s
        ({"speed": 0.5, "frames": 24}, 24, 2.0),
    ],
)
def test_what_is_left_out_is_completed(asked: dict[str, Any], frames: int, per_second: float) -> None:
    found = timing_of(".gif", 6.0, **asked)
    assert (found.frames, found.per_second) == (frames, per_second)


@pytest.mark.parametrize("per_second", [20.0, 30.0, 23.976, 12.5, 7.0])
def test_delays_do_not_drift(per_second: float) -> None:
    """Whole hundredths of a second; after any number of frames at most half of one off."""
    timing = Timing(97, per_second)
    total = 0
    for number, delay in enumerate(timing.delays, start=1):
        assert delay % 10 == 0
        total += delay
        assert abs(total - 1000.0 * number / per_second) <= 5.0 + 1e-9


@pytest.mark.parametrize(
    ("asked", "told"),
    [
        ({"frames": 1}, "give 2 to 3000 frames"),
        ({"frames": MOST_FRAMES + 1}, "give 2 to 3000 frames"),
        ({"frames": True}, "give 2 to 3000 frames"),
        ({"fps": 0.0}, "give 0.1 to 50 frames per second"),
        ({"fps": 51.0}, "give 0.1 to 50 frames per second"),
        ({"fps": float("nan")}, "give 0.1 to 50 frames per second"),
        (
            {"duration": 0.0},
            "duration: it must be a finite number greater than zero, and 0 is given; give seconds",
        ),
        ({"duration": float("inf")}, "greater than zero, and inf is given"),
        (
            {"speed": -1.0},
            "speed: it must be a finite number greater than zero, and -1 is given; give a multiple",
        ),
        ({"speed": 0.0}, "greater than zero, and 0 is given"),
        ({"speed": float("inf")}, "greater than zero, and inf is given; give a multiple"),
        ({"speed": float("nan")}, "greater than zero, and nan is given"),
        ({"speed": 1.0, "duration": 1.0}, "remove one of the two"),
        ({"frames": 10, "fps": 10.0, "duration": 1.0}, "remove one of the three"),
        ({"frames": 100, "duration": 1.0}, "100 frames in 1 s are 100 per second"),
        ({"duration": 1e6}, "frames; give 2 to 3000 frames"),
        ({"duration": 0.05}, "1 frame; give 2 to 3000 frames"),
    ],
)
def test_what_does_not_go_together_is_refused(asked: dict[str, Any], told: str) -> None:
    with pytest.raises(InputError) as refusal:
        timing_of(".gif", 6.0, **asked)
    assert told in str(refusal.value)


def test_a_motion_without_a_time_has_no_speed() -> None:
    with pytest.raises(InputError, match="the motion has no duration of its own"):
        timing_of(".gif", 0.0, speed=1.0)


def test_an_mp4_may_be_faster() -> None:
    assert FASTEST[".mp4"] > FASTEST[".gif"] > LEAST_RATE
    assert timing_of(".mp4", 1.0, fps=100.0).per_second == 100.0


@pytest.mark.parametrize(
    ("size", "kind", "found"),
    [
        ("800x600", ".gif", (800, 600)),
        ("801X601", ".mp4", (802, 602)),
        ((640, 480), ".mp4", (640, 480)),
        (" 64x64 ", ".gif", (64, 64)),
    ],
)
def test_sizes(size: Any, kind: str, found: tuple[int, int]) -> None:
    assert size_of(size, kind, 60) == found


@pytest.mark.parametrize(
    ("size", "frames", "told"),
    [
        ("800", 60, 'expected WIDTHxHEIGHT, got "800"'),
        ("800x-600", 60, "expected WIDTHxHEIGHT"),
        ("63x600", 60, "give 64 to 4096 pixels in each direction"),
        ("800x99999", 60, "give 64 to 4096 pixels in each direction"),
        ("4000x4000", MOST_PIXELS // 16_000_000 + 1, "give at most 62 frames of this size"),
    ],
)
def test_sizes_out_of_bounds_are_refused(size: str, frames: int, told: str) -> None:
    with pytest.raises(InputError) as refusal:
        size_of(size, ".gif", frames)
    assert told in str(refusal.value)


def test_the_ending_decides() -> None:
    assert kind_of(Path("a.GIF")) == ".gif"
    with pytest.raises(InputError, match=r"an animation is a \.gif or a \.mp4"):
        kind_of(Path("a.avi"))
