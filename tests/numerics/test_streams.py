"""Streams: lanes that stay, steps part by part, the numbers of a scan that is run at once."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import pytest

from centrode.numerics.executors import runner, streamer
from centrode.numerics.expressions import EXPRESSIONS, as_node, variable
from centrode.numerics.machine_code import PRESENT
from centrode.numerics.scans import Scan, room_of

EXECUTORS = ("arrays", "machine code") if PRESENT else ("arrays",)
m = EXPRESSIONS
x, u, v = variable("x"), variable("u"), variable("v")
SCAN = Scan(
    ("x",),
    ("u", "v"),
    {"turned": as_node(x * m.cos(u) - v), "angle": m.atan2(x, u), "steps": as_node(m.sin(v))},
)
STEPS = np.random.default_rng(0).uniform(-3.0, 3.0, (2, 50))


def lanes(count: int) -> np.ndarray:
    return np.linspace(-2.0, 5.0, count)[None]


@pytest.fixture(params=EXECUTORS)
def executor(request: pytest.FixtureRequest) -> str:
    return str(request.param)


@pytest.mark.parametrize("threads", [1, 2])
@pytest.mark.parametrize("count", [1, 3, 8, 361])
def test_parts_are_the_whole(executor: str, count: int, threads: int) -> None:
    """Parts of every size, the buffer used again, rows of a larger array, arrays that may not be written."""
    whole = runner(SCAN, executor, lanes_inside=True)(lanes(count), STEPS).outputs
    take, room = streamer(SCAN, lanes(count), executor, threads), room_of(3, 20, count)
    given = STEPS.copy()
    given.flags.writeable = False
    for first, last in itertools.pairwise([0, 1, 8, 8, 28, 47, 50]):
        part = room[:, : last - first]
        part[...] = np.nan
        assert take(given[:, first:last], part) is part
        assert np.array_equal(part, whole[:, first:last])


def test_lanes_are_those_of_the_beginning(executor: str) -> None:
    """What is handed over once may be written over afterwards."""
    mine = lanes(20)
    take, out = streamer(SCAN, mine, executor), np.empty((3, 50, 20))
    expected = take(STEPS, out).copy()
    mine[...] = 0.0
    assert np.array_equal(take(STEPS, out), expected)


def test_steps_without_numbers(executor: str) -> None:
    """Steps that differ in nothing are counted by the room."""
    scan = Scan(("x",), (), {"double": as_node(x * 2.0)})
    out = streamer(scan, lanes(9), executor)(None, np.empty((1, 4, 9)))
    assert np.array_equal(out, np.broadcast_to(2.0 * lanes(9), (1, 4, 9)))


@pytest.mark.parametrize(
    ("inputs", "shape"),
    [
        (STEPS[:1], (3, 50, 20)),
        (STEPS[0], (3, 50, 20)),
        (STEPS, (3, 49, 20)),
        (STEPS, (3, 50, 21)),
        (STEPS, (2, 50, 20)),
    ],
)
def test_sizes_that_do_not_fit_are_refused(executor: str, inputs: Any, shape: tuple[int, ...]) -> None:
    """Nothing is written beyond a buffer's end."""
    take, out = streamer(SCAN, lanes(20), executor), np.zeros(shape)
    with pytest.raises(ValueError, match=r"expected|has to be|differ|steps"):
        take(inputs, out)
    assert not out.any()


def test_a_buffer_of_another_kind_is_refused(executor: str) -> None:
    take = streamer(SCAN, lanes(20), executor)
    with pytest.raises(ValueError, match="out has to be"):
        take(STEPS, np.zeros((3, 50, 20), np.float32))
    with pytest.raises(ValueError, match="out has to be"):
        take(STEPS, np.zeros((3, 50, 40))[:, :, ::2])


def test_too_few_parameters_are_refused(executor: str) -> None:
    with pytest.raises(ValueError, match="expected"):
        streamer(SCAN, np.ones((2, 20)), executor)(STEPS, np.empty((3, 50, 20)))
