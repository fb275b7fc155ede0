"""Scans on every executor: sweeps, reductions, fixed-step schemes, Newton; shapes, what is refused."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from centrode.numerics import executors
from centrode.numerics.expressions import EXPRESSIONS, Node, variable
from centrode.numerics.machine_code import PRESENT
from centrode.numerics.scans import (
    LINE,
    Scan,
    end_of,
    greatest,
    greatest_with_gradient,
    least,
    number_of,
    room_of,
    run_on_arrays,
    together,
    total,
    total_with_gradient,
)

EPS = 2.0**-52
m = EXPRESSIONS
a, b, t, x, v = (variable(name) for name in "abtxv")
NEEDS = pytest.mark.skipif(not PRESENT, reason="machine code needs llvmlite: pip install 'centrode[fast]'")
Runner = Callable[..., Any]


@pytest.fixture(params=["arrays", pytest.param("machine code", marks=NEEDS)])
def run(request: pytest.FixtureRequest) -> Runner:
    def runner(scan: Scan, *arguments: Any, **words: Any) -> Any:
        return executors.runner(scan, request.param)(*arguments, **words)

    return runner


@pytest.fixture(autouse=True)
def own_cache(tmp_path: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CENTRODE_CACHE", str(tmp_path / "kernels"))


def test_a_sweep(run: Runner) -> None:
    lanes, steps = np.linspace(1, 2, 13), np.linspace(0, 6, 7)
    found = run(Scan(("a",), ("t",), {"y": a * t, "z": a - t}), lanes[None], steps[None])
    assert found.outputs.shape == (2, 7, 13)
    assert np.array_equal(found.outputs[0], steps[:, None] * lanes)
    assert np.array_equal(found.outputs[1], lanes - steps[:, None])
    assert found.state.shape == (0, 13)


@pytest.mark.parametrize("lanes", [3, 40])
def test_states_go_where_they_are_wanted(run: Runner, lanes: int) -> None:
    """Rows of a greater array may be given; what the scan starts with stays as it is."""
    numbers, steps = np.linspace(1, 2, lanes)[None], np.linspace(0, 6, 7)[None]
    scan, start = Scan(("a",), ("t",), {}, {"x": x + a * t, "v": v - t}), np.ones((2, lanes))
    memory = np.full((4, lanes), 7.0)
    found = run(scan, numbers, steps, start, new_state=memory[1:3])
    assert np.shares_memory(found.state, memory)
    np.testing.assert_array_equal(memory[1:3], run(scan, numbers, steps, start).state)
    assert (memory[[0, 3]] == 7.0).all() and (start == 1.0).all()


@NEEDS
def test_functions_of_lanes_are_those_of_numpy_or_the_kernel() -> None:
    """By themselves they have the bits of NumPy; the kernel's own are right to a unit of the last place."""
    scan = Scan(("a",), ("t",), {}, {"x": x + m.sin(a) * t})
    numbers, steps = np.linspace(0.1, 3.0, 1000)[None], np.ones((1, 1))
    alike, own = (
        executors.runner(scan, "machine code", own_functions=own)(numbers, steps, [[0.0]]).state[0]
        for own in (False, True)
    )
    np.testing.assert_array_equal(alike, np.sin(numbers[0]))
    assert 0 < np.count_nonzero(own != alike) < 500
    assert np.abs(own - alike).max() <= 2.0 * EPS


def test_outputs_go_where_they_are_wanted(run: Runner) -> None:
    scan = Scan(("a",), ("t",), {"y": a * t})
    room = np.zeros((1, 4, 40))
    found = run(scan, np.ones((1, 20)), np.ones((1, 4)), out=room[:, :, 7:27])
    assert np.shares_memory(found.outputs, room)
    assert room.sum() == 80
    assert room[:, :, 7:27].sum() == 80


@pytest.mark.parametrize(("lanes", "steps"), [(0, 3), (3, 0), (0, 0), (1, 1), (1, 5), (5, 1)])
def test_sizes_down_to_nothing(run: Runner, lanes: int, steps: int) -> None:
    scan = Scan(("a",), ("t",), {"y": a * t}, {"x": x + a})
    found = run(scan, np.full((1, lanes), 2.0), np.full((1, steps), 3.0), np.full((1, lanes), 1.0))
    assert found.outputs.tolist() == [[[6.0] * lanes] * steps]
    assert found.state.tolist() == [[1.0 + 2.0 * steps] * lanes]


def test_outputs_see_the_state_before_the_step(run: Runner) -> None:
    found = run(Scan((), (), {"y": x}, {"x": 2.0 * x}), None, None, [[1.0]], steps=4)
    assert found.outputs[0, :, 0].tolist() == [1.0, 2.0, 4.0, 8.0]
    assert found.state.tolist() == [[16.0]]


def test_the_first_state_is_left_as_it_is(run: Runner) -> None:
    start = np.ones((1, 9))
    found = run(Scan((), (), {}, {"x": 2.0 * x}), None, None, start, steps=3)
    assert (start == 1.0).all()
    assert (found.state == 8.0).all()


def test_constants_and_variables_as_outputs(run: Runner) -> None:
    scan = Scan(("a",), ("t",), {"one": m.where(a < a, a, 1.5), "two": t, "three": a})
    found = run(scan, np.arange(10.0)[None], np.arange(3.0)[None]).outputs
    assert (found[0] == 1.5).all()
    assert (found[1] == np.arange(3.0)[:, None]).all()
    assert (found[2] == np.arange(10.0)).all()


def test_reductions_leave_nan_out(run: Runner) -> None:
    value = a * m.sqrt(t)  # NaN at t = -1
    red = together(
        greatest("hi", value), least("lo", value), total("sum", value), number_of("count", value),
    )  # fmt: skip
    lanes = np.array([[1.0, -2.0, math.nan]])
    start = [[one] for one in red.start.values()]
    found = run(Scan(("a",), ("t",), {}, red.state), lanes, [[-1.0, 4.0, 9.0, -1.0]], start).state
    hi, lo, summed, count = found
    assert hi[:2].tolist() == [3.0, -4.0]
    assert lo[:2].tolist() == [2.0, -6.0]
    assert np.isnan([hi[2], lo[2]]).all()
    assert summed.tolist() == [5.0, -10.0, 0.0]
    assert count.tolist() == [2.0, 2.0, 0.0]


def test_reductions_with_gradients(run: Runner) -> None:
    value = m.sqrt(t - b) * a * a  # NaN at t = 0, greatest at t = 5, of several there the first
    summed = total_with_gradient("sum", value, [a, b], ["t"])
    red = together(summed, greatest_with_gradient("hi", value, [a, b]))
    start = [[one] for one in red.start.values()]
    lanes = [[3.0], [1.0]]
    last = run(Scan(("a", "b"), ("t",), {}, red.state), lanes, [[0.0, 2.0, 5.0, 5.0]], start).state
    ends = run(end_of(red, ("a", "b")), np.concatenate([lanes, last]), None).outputs[:, 0]
    found = np.concatenate([ends, last[len(summed.state) :]])[:, 0]
    roots = np.array([1.0, 2.0, 2.0])
    expected = [9 * roots.sum(), 6 * roots.sum(), -4.5 * (1 / roots).sum(), 18.0, 12.0, -2.25]
    assert np.abs(found - expected).max() <= 16 * EPS * 45


def runge_kutta(rate: Callable[[Node, Node], tuple[Node, Node]], h: float) -> Scan:
    """The classical scheme for x' = v, v' = rate."""
    x1, v1 = rate(x, v)
    x2, v2 = rate(x + h / 2 * x1, v + h / 2 * v1)
    x3, v3 = rate(x + h / 2 * x2, v + h / 2 * v2)
    x4, v4 = rate(x + h * x3, v + h * v3)
    state = {
        "x": x + h / 6 * (x1 + 2.0 * x2 + 2.0 * x3 + x4),
        "v": v + h / 6 * (v1 + 2.0 * v2 + 2.0 * v3 + v4),
    }
    return Scan(("a",), (), {"x at": x}, state)


def test_a_fixed_step_scheme(run: Runner) -> None:
    """Oscillators of several frequencies over a time of 2: the error is that of the fourth order."""
    steps, frequency = 200, np.linspace(0.5, 3, 21)
    h = 2.0 / steps
    scan = runge_kutta(lambda x, v: (v, -(a * a) * x), h)
    found = run(scan, frequency[None], None, [[1.0], [0.0]], steps=steps)
    # local error (wh)^5/120 in either unknown at every step, and roundings
    bound = steps * (frequency * h) ** 5 / 60 * frequency + steps * 16 * EPS
    assert (np.abs(found.state[0] - np.cos(frequency * 2.0)) <= bound).all()
    assert found.outputs.shape == (1, steps, 21)
    assert (found.outputs[0, 0] == 1.0).all()


def test_newton(run: Runner) -> None:
    """Kepler's equation x - a sin x = t for many eccentricities and anomalies."""
    scan = Scan(("a", "t"), (), {}, {"x": x - (x - a * m.sin(x) - t) / (1.0 - a * m.cos(x))})
    eccentricity, anomaly = np.linspace(0, 0.5, 37), np.linspace(0, 3, 37)
    found = run(scan, [eccentricity, anomaly], None, anomaly[None], steps=8).state[0]
    # the residual is rounded in numbers below 4, its slope is at least 1/2
    assert np.abs(found - eccentricity * np.sin(found) - anomaly).max() <= 8 * EPS * 4


@pytest.mark.parametrize(
    ("arguments", "words", "told"),
    [
        ((None, [[1.0]], [[1.0]]), {}, "missing: a"),
        (([[1.0, 2.0]], [[1.0]], [[1.0, 2.0, 3.0]]), {}, "lanes differ"),
        (([1.0], [[1.0]], [[1.0]]), {}, "expected"),
        (([[1.0]], [[1.0, 2.0]], [[1.0]]), {"steps": 3}, "steps"),
        (([[1.0]], [[1.0]], [[1.0]]), {"out": np.empty((1, 2, 2))}, "out"),
        (([[1.0]], [[1.0]], [[1.0]]), {"out": np.empty((1, 1, 1), np.float32)}, "out"),
    ],
)
def test_arrays_that_do_not_fit(run: Runner, arguments: Any, words: Any, told: str) -> None:
    with pytest.raises(ValueError, match=told):
        run(Scan(("a",), ("t",), {"y": a * t}, {"x": x + a}), *arguments, **words)


def test_names_that_do_not_fit() -> None:
    with pytest.raises(ValueError, match="different names"):
        Scan(("a",), ("a",), {"y": a})
    with pytest.raises(ValueError, match="neither parameter, input nor state: b"):
        Scan(("a",), ("t",), {"y": a * b})


def test_chunks_of_steps_change_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    scan = Scan(("a",), ("t",), {"y": a * m.sin(t)})
    lanes, steps = np.linspace(1, 2, 10)[None], np.linspace(0, 6, 57)[None]
    whole = run_on_arrays(scan, lanes, steps).outputs
    monkeypatch.setattr("centrode.numerics.scans.CHUNK", 40)
    assert np.array_equal(run_on_arrays(scan, lanes, steps).outputs, whole)


def test_executors_by_name(monkeypatch: pytest.MonkeyPatch) -> None:
    assert executors.choose_executor("arrays") == "arrays"
    assert executors.choose_executor("auto") == ("machine code" if PRESENT else "arrays")
    monkeypatch.setattr(executors, "PRESENT", False)
    assert executors.choose_executor("auto") == "arrays"
    with pytest.raises(ValueError, match="no such executor"):
        executors.choose_executor("abacus")


@pytest.mark.parametrize("number", [np.float64, np.float32])
@pytest.mark.parametrize("lanes", [1, 8, 361])
def test_rows_of_a_room_begin_at_lines_of_the_cache(lanes: int, number: type[np.floating]) -> None:
    room = room_of(2, 3, lanes, number)
    assert room.shape == (2, 3, lanes)
    assert room.dtype == number
    room[...] = np.arange(6 * lanes).reshape(room.shape)
    assert (room.ravel() == np.arange(6 * lanes)).all()
    assert {room[i, j].ctypes.data % LINE for i in range(2) for j in range(3)} == {0}


def test_a_scan_writes_into_a_room() -> None:
    double = Scan(("x",), ("u",), {"product": variable("x") * variable("u")})
    room = room_of(1, 2, 5)
    found = executors.runner(double)([[1.0, 2.0, 3.0, 4.0, 5.0]], [[2.0, 3.0]], out=room)
    assert found.outputs is room
    assert room[0].tolist() == [[2.0, 4.0, 6.0, 8.0, 10.0], [3.0, 6.0, 9.0, 12.0, 15.0]]
