"""Extremes over the lanes of a step, and outputs that stand in some rows of a room only."""

import itertools

import numpy as np
import pytest

from centrode.numerics import machine_code
from centrode.numerics.executors import ARRAYS, MACHINE_CODE, runner, streamer
from centrode.numerics.expressions import EXPRESSIONS, as_node, constant, variable
from centrode.numerics.scans import LaneExtreme, Scan

EXECUTORS = [
    ARRAYS,
    pytest.param(
        MACHINE_CODE, marks=pytest.mark.skipif(not machine_code.PRESENT, reason="llvmlite is absent")
    ),
]
STEPS = np.random.default_rng(1).uniform(0.5, 2.0, (1, 50))
m, x, y, step = EXPRESSIONS, variable("x"), variable("y"), variable("step")
TURN = m.atan2(y * step, x)  # a stage of its own
NUMBERS = {
    "product": as_node(x * step - y),
    "turn": as_node(TURN * step),
    "of the step": as_node(step * step),
    "of the lane": as_node(x + y),
    "constant": constant(3.0),
}


def scan_of(places: tuple[int, ...] = ()) -> Scan:
    extremes = {f"least {name}": LaneExtreme("minimum", node, np.inf) for name, node in NUMBERS.items()}
    extremes |= {f"most {name}": LaneExtreme("maximum", node, -np.inf) for name, node in NUMBERS.items()}
    outputs = {"sum": as_node(x + y * step), "angle": as_node(TURN)}
    return Scan(("x", "y"), ("step",), outputs, extremes=extremes, places=places)


def lanes(count: int) -> np.ndarray:
    return np.random.default_rng(2).uniform(-1.0, 1.0, (2, count))


def numbers_of(own: np.ndarray) -> dict[str, np.ndarray]:
    """The same numbers, written out by the executor itself: what extremes are taken of."""
    whole = runner(Scan(("x", "y"), ("step",), NUMBERS), ARRAYS)(own, STEPS).outputs
    return dict(zip(NUMBERS, whole, strict=True))


@pytest.fixture(params=EXECUTORS)
def executor(request: pytest.FixtureRequest) -> str:
    return str(request.param)


@pytest.mark.parametrize("threads", [1, 2])
@pytest.mark.parametrize("count", [1, 3, 8, 63, 64, 65, 361])
def test_extremes_are_those_of_the_numbers(executor: str, count: int, threads: int) -> None:
    """Lanes fewer than a vector, a last vector that overlaps, several pieces of a stage; parts of the steps."""
    own, scan = lanes(count), scan_of()
    expected = numbers_of(own)
    take = streamer(scan, own, executor, threads)
    found, out = np.full((len(scan.extremes), 50), np.nan), np.empty((2, 50, count))
    for first, last in itertools.pairwise([0, 1, 8, 50]):
        take(STEPS[:, first:last], out[:, first:last], found[:, first:last])
    for name, row in zip(scan.extremes, found, strict=True):
        kind, _, number = name.partition(" ")
        of_lanes = expected[number].min(axis=1) if kind == "least" else expected[number].max(axis=1)
        # an arc tangent of machine code is rounded otherwise than NumPy's
        assert np.allclose(row, of_lanes, rtol=1e-15 if "turn" in name else 0.0, atol=0.0), name


@pytest.mark.parametrize("kind", ["minimum", "maximum"])
@pytest.mark.parametrize("at", [0, 7, 8, 16])
def test_nan_wins(executor: str, kind: str, at: int) -> None:
    """Wherever it stands: what has no number is not the least or the greatest of those that are there."""
    own = np.ones((1, 17))
    own[0, at] = -1.0
    scan = Scan(("x",), ("step",), {}, extremes={"root": LaneExtreme(kind, m.sqrt(x * step), 0.5)})
    found = np.empty((1, 2))
    streamer(scan, own, executor)(np.array([[4.0, -4.0]]), np.empty((0, 2, 17)), found)
    assert np.isnan(found).all()
    own[0, at] = 1.0
    streamer(scan, own, executor)(np.array([[4.0, 9.0]]), np.empty((0, 2, 17)), found)
    assert found.tolist() == ([[0.5, 0.5]] if kind == "minimum" else [[2.0, 3.0]])


@pytest.mark.parametrize("count", [3, 20])
def test_rows_between_stay_as_they_are(executor: str, count: int) -> None:
    out = np.full((5, 50, count), 7.0)
    streamer(scan_of(places=(1, 4)), lanes(count), executor)(STEPS, out, np.empty((10, 50)))
    dense = runner(Scan(("x", "y"), ("step",), scan_of().outputs), executor, lanes_inside=True)
    assert np.array_equal(out[[1, 4]], dense(lanes(count), STEPS).outputs)
    assert (out[[0, 2, 3]] == 7.0).all()


def test_refusals(executor: str) -> None:
    with pytest.raises(ValueError, match="has no extremes"):
        Scan((), (), {}, {"x": x + 1.0}, {"most": LaneExtreme("maximum", x, 0.0)})
    with pytest.raises(ValueError, match="2 outputs have 1 places"):
        scan_of(places=(3,))
    with pytest.raises(ValueError, match=r"out has to be \(5, 50, 20\)"):
        streamer(scan_of(places=(1, 4)), lanes(20), executor)(STEPS, np.empty((4, 50, 20)))
    if executor == MACHINE_CODE:
        with pytest.raises(ValueError, match="with the lanes inside"):
            runner(scan_of(), executor)(lanes(20), STEPS)
