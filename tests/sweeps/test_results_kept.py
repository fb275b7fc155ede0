"""Results that somebody still has are not overwritten by later calls, whatever part of them it is."""

from __future__ import annotations

import gc
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np
import pytest

import centrode as ct
from centrode.numerics import machine_code, rooms
from centrode.sweeps.solver import MEMORIES, MotionFrame

COMPILED = pytest.mark.skipif(not machine_code.PRESENT, reason="machine code needs the extra fast")
PARTS: dict[str, Callable[[MotionFrame], Any]] = {
    "the frame": lambda frame: frame,
    "its arrays": lambda frame: frame.arrays,
    "an array": lambda frame: frame.position,
    "the residual": lambda frame: frame.residual,
    "a slice": lambda frame: frame.velocity[3:5],
    "a transposed view": lambda frame: frame.acceleration.T,
    "a view of another type": lambda frame: frame.angle.view(np.int64),
    "its bytes": lambda frame: memoryview(frame.position),
    "a label": lambda frame: (frame.position, frame.values),
}
NAMES = {
    "crank-rocker": "links.AB.length",
    "third-class-triad": "links.AB.length",
    "spherical-four-bar": "links.BC.length",
}


def numbers(part: Any) -> list[np.ndarray]:
    """All numbers of a part, copied."""
    if isinstance(part, MotionFrame):
        return [x.copy() for x in part.arrays.values()]
    if isinstance(part, dict):
        return [x.copy() for x in part.values()]
    return [np.array(part[0] if isinstance(part, tuple) else part)]


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("what", PARTS)
def test_a_frame_stays_what_it_is(what: str, name: str) -> None:
    lever = ct.solver(name, [NAMES[name]], 19)
    own = lever.own[0]
    kept, expected = [], []
    # more frames than memories that are looked at, so that some of these are given up
    for k in range(MEMORIES + 3):
        kept.append(PARTS[what](lever.move([own * (1.0 + 0.001 * k)])))
        expected.append(numbers(kept[-1]))
    for k in range(3):
        lever.move([own * (0.99 - 0.001 * k)])
    for part, own_numbers in zip(kept, expected, strict=True):
        for found, there in zip(numbers(part), own_numbers, strict=True):
            np.testing.assert_array_equal(found, there)
    assert not np.array_equal(expected[0][0], expected[1][0]) or what == "the residual"


def test_derivatives_leave_a_frame_as_it_is() -> None:
    lever = ct.solver("crank-rocker", ["links.AB.length"], 19, outputs="range(position_B_x)")
    frame = lever.move([3.5])
    expected = numbers(frame)
    lever.gradient([3.6]), lever.outputs([3.7])
    for found, there in zip(numbers(frame), expected, strict=True):
        np.testing.assert_array_equal(found, there)


def test_memory_that_nobody_has_is_used_again() -> None:
    lever = ct.solver("crank-rocker", ["links.AB.length"], 19)

    def place(length: float) -> int:
        return int(lever.move([length]).position.__array_interface__["data"][0])

    first = place(3.5)
    assert place(3.6) == first
    # a loop that keeps the last frame alone needs two memories
    places = set()
    for k in range(10):
        frame = lever.move([3.5 + 0.01 * k])
        places.add(frame.position.__array_interface__["data"][0])
    assert len(places) == 2


def test_frames_of_threads() -> None:
    """Frames that were handed to another thread stay while the first one moves on."""
    lever = ct.solver("crank-rocker", ["links.AB.length"], 37)
    lengths = np.linspace(3.2, 3.8, 60)
    expected = [lever.move([x]).position.copy() for x in lengths.tolist()]

    def moved(some: list[int]) -> list[tuple[int, np.ndarray]]:
        return [(k, lever.move([float(lengths[k])]).position) for k in some]

    with ThreadPoolExecutor(4) as pool:
        parts = [list(range(first, len(lengths), 4)) for first in range(4)]
        for found in pool.map(moved, parts):
            for k, position in found:
                np.testing.assert_array_equal(position, expected[k])


SHARES: dict[str, Callable[[Any], Any]] = {
    "a variable": lambda data: data["velocity.B"],
    "a slice": lambda data: data["velocity.B"].values[3, ::2],
    "a transposed view": lambda data: data["velocity.B"].values.T,
    "its bytes": lambda data: memoryview(data["velocity.B"].values),
    "a selection": lambda data: data.isel(sample=slice(3, 9))["velocity.B"].values,
    "the memory of an array": lambda data: data["velocity.B"].values.base,
}


@COMPILED
@pytest.mark.parametrize("what", SHARES)
def test_a_part_of_a_sweep_stays_what_it_is(what: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Memory is handed out again once nothing refers to it: that of small results here too."""
    monkeypatch.setattr(rooms, "BLANK", 1000)

    def swept(first: float) -> Any:
        vary = {"links.AB.length": np.linspace(first, first + 0.2, 20)}
        return ct.sweep("crank-rocker", vary, ["position.B", "velocity.B"], 37, executor="machine code")

    data = swept(3.3)
    part = SHARES[what](data)
    place, expected = data["position.B"].values.__array_interface__["data"][0], np.array(part)
    del data
    gc.collect()
    for first in (3.1, 3.5):
        assert swept(first)["position.B"].values.__array_interface__["data"][0] != place
        np.testing.assert_array_equal(np.array(part), expected)
