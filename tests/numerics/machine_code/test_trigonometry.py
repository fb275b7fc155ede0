"""Sine, cosine and the angle of a vector against mpmath, on machines with and without fused multiplication."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable
from typing import Any

import mpmath as mp
import numpy as np
import pytest

from centrode.numerics.expressions import EXPRESSIONS, variable
from centrode.numerics.scans import Scan
from samples import few

NEEDS = "machine code needs llvmlite: pip install 'centrode[fast]'"
kernels = pytest.importorskip("centrode.numerics.machine_code.kernels", reason=NEEDS)
targets = pytest.importorskip("centrode.numerics.machine_code.compile", reason=NEEDS)

m = EXPRESSIONS
x, y = variable("x"), variable("y")
OF_SINE, OF_ANGLE = 1.0, 2.0
"""The bounds that docs/engine.md states [ULP]."""
OF_LIBRARY = 1.0
"""C libraries differ; those in use stay below."""
DIGITS = 60
REDUCED = 1e5
SPECIAL = np.array(
    [0.0, -0.0, 1.0, -1.0, math.inf, -math.inf, math.nan, 5e-324, -5e-324, 1e308, -1e308, 1e-300, 1e6, 1e22]
)


def old_x86() -> Any:
    host = targets.host()
    if not host.triple.startswith("x86_64"):
        pytest.skip("the old machine is an x86")
    return targets.target_of(host.triple, "x86-64", {})


MACHINES = {"host": targets.host, "old": old_x86}


@pytest.fixture(params=MACHINES)
def machine(request: pytest.FixtureRequest) -> Any:
    return MACHINES[request.param]()


def worst(found: np.ndarray, exact: Callable[[int], Any]) -> tuple[float, int]:
    """The greatest distance from the exact value, in units of its last place, and where."""
    distances = []
    with mp.workdps(DIGITS):
        for i, value in enumerate(found):
            true = exact(i)
            place = mp.mpf(float(np.spacing(abs(float(true)))))
            distances.append(float(abs(mp.mpf(float(value)) - true) / place))
    where = int(np.argmax(distances))
    return distances[where], where


@functools.cache
def near_quarter_turns() -> np.ndarray:
    """The doubles nearest to multiples of pi/2, those that leave the least first."""
    with mp.workdps(DIGITS):
        half = mp.pi / 2
        turns = [(k * half, float(k * half)) for k in range(1, int(REDUCED / (math.pi / 2)))]
        return np.array(
            [at for _exact, at in sorted(turns, key=lambda pair: abs(pair[0] - pair[1]) / pair[1])]
        )


def arguments() -> np.ndarray:
    random = np.random.default_rng(0)
    multiples = near_quarter_turns()
    borders = np.arange(1, 60) * math.pi / 4
    parts = [
        random.uniform(-10, 10, few(800, 3000)), random.uniform(-REDUCED, REDUCED, few(800, 3000)),
        np.exp(random.uniform(-700, math.log(REDUCED), few(300, 1000))),
        multiples[: few(500, 1500)], -multiples[:100],
        np.nextafter(multiples[:100], 0), np.nextafter(multiples[:100], 1e9),
        borders, np.nextafter(borders, 0), np.nextafter(borders, 1e9), [REDUCED, -REDUCED],
    ]  # fmt: skip
    return np.concatenate(parts)


def test_sine_and_cosine(machine: Any) -> None:
    at = arguments()
    kernel = kernels.kernel_of(Scan(("x",), (), {"sin": m.sin(x), "cos": m.cos(x)}), target=machine)
    sine, cosine = kernel.run(at[None], None).outputs[:, 0]
    for found, true in ((sine, mp.sin), (cosine, mp.cos)):
        error, where = worst(found, lambda i, true=true: true(mp.mpf(at[i])))
        assert error <= OF_SINE, (true, at[where])


def test_beyond_the_reduction_the_library_is_asked(machine: Any) -> None:
    random = np.random.default_rng(1)
    far = np.concatenate([[np.nextafter(REDUCED, 1e9), 1e6, 1e22, 1e300], 10 ** random.uniform(5, 300, 200)])
    at = np.concatenate([far, -far, random.uniform(-1, 1, 500)])
    random.shuffle(at)  # lanes of one vector go both ways
    kernel = kernels.kernel_of(Scan(("x",), (), {"sin": m.sin(x), "cos": m.cos(x)}), target=machine)
    sine, cosine = kernel.run(at[None], None).outputs[:, 0]
    with mp.workdps(400):
        for found, true in ((sine, mp.sin), (cosine, mp.cos)):
            for value, argument in zip(found, at, strict=True):
                exact = true(mp.mpf(argument))
                assert abs(value - exact) <= OF_LIBRARY * np.spacing(abs(float(exact))), argument


def test_what_a_lane_gets_does_not_depend_on_its_neighbours(machine: Any) -> None:
    near = np.random.default_rng(2).uniform(-100, 100, 64)
    kernel = kernels.kernel_of(Scan(("x",), (), {"sin": m.sin(x)}), target=machine)
    alone = kernel.run(near[None], None).outputs
    mixed = near.copy()
    mixed[::3] = 1e7
    assert np.array_equal(
        np.delete(kernel.run(mixed[None], None).outputs, np.s_[::3]), np.delete(alone, np.s_[::3])
    )


def test_sine_and_cosine_of_special_numbers(machine: Any) -> None:
    kernel = kernels.kernel_of(Scan(("x",), (), {"sin": m.sin(x), "cos": m.cos(x)}), target=machine)
    sine, cosine = kernel.run(SPECIAL[None], None).outputs[:, 0]
    tiny = np.abs(SPECIAL) <= 1e-300
    assert np.array_equal(sine[tiny], SPECIAL[tiny])
    assert np.array_equal(np.signbit(sine[tiny]), np.signbit(SPECIAL[tiny]))
    assert (cosine[tiny] == 1.0).all()
    lost = ~np.isfinite(SPECIAL)
    assert np.isnan(sine[lost]).all()
    assert np.isnan(cosine[lost]).all()
    assert np.isfinite(sine[~lost]).all()


def test_angles(machine: Any) -> None:
    random = np.random.default_rng(3)
    n = 2500
    turn = random.uniform(-math.pi, math.pi, n)
    slopes = np.repeat([1.0, 0.5, 2.0, 1e-8, 1e8], 50)
    ys = [random.normal(size=n), np.exp(random.uniform(-300, 300, n)), np.sin(turn), slopes * (1 + 1e-15)]
    xs = [
        random.normal(size=n),
        np.exp(random.uniform(-300, 300, n)),
        np.cos(turn),
        random.choice([-1.0, 1.0], 250),
    ]
    sides, heights = np.concatenate(xs), np.concatenate(ys)
    kernel = kernels.kernel_of(Scan(("y", "x"), (), {"angle": m.atan2(y, x)}), target=machine)
    found = kernel.run([heights, sides], None).outputs[0, 0]
    error, where = worst(found, lambda i: mp.atan2(mp.mpf(heights[i]), mp.mpf(sides[i])))
    assert error <= OF_ANGLE, (heights[where], sides[where])


def test_angles_where_vectors_are_turned(machine: Any) -> None:
    """Next to the steepest slope that is not turned back, of every length there is, subnormal ones too."""
    random = np.random.default_rng(6)
    steepest = pytest.importorskip("centrode.numerics.machine_code.polynomials", reason=NEEDS).SLOPE
    slopes = steepest * (1.0 + 2.0**-52 * np.arange(-40, 41))
    lengths = 2.0 ** random.uniform(-1040, 1022.9, slopes.size)
    few, many = (part.ravel() for part in np.meshgrid(np.arange(1, 41), np.arange(1, 41)))
    low = np.concatenate([slopes, slopes * lengths, few * 5e-324, random.uniform(0.4, 0.6, 3000)])
    high = np.concatenate([np.ones(slopes.size), lengths, many * 5e-324, np.ones(3000)])
    swapped = random.uniform(size=low.size) < 0.5
    heights = np.where(swapped, low, high) * random.choice([-1.0, 1.0], low.size)
    sides = np.where(swapped, high, low) * random.choice([-1.0, 1.0], low.size)
    kernel = kernels.kernel_of(Scan(("y", "x"), (), {"angle": m.atan2(y, x)}), target=machine)
    found = kernel.run([heights, sides], None).outputs[0, 0]
    error, where = worst(found, lambda i: mp.atan2(mp.mpf(heights[i]), mp.mpf(sides[i])))
    assert error <= OF_ANGLE, (heights[where], sides[where])


def test_angles_of_special_numbers(machine: Any) -> None:
    """Zeros, infinities, subnormal numbers and NaN by the rules of C, Annex F."""
    heights, sides = (part.ravel() for part in np.meshgrid(SPECIAL, SPECIAL))
    kernel = kernels.kernel_of(Scan(("y", "x"), (), {"angle": m.atan2(y, x)}), target=machine)
    found = kernel.run([heights, sides], None).outputs[0, 0]
    expected = np.array([math.atan2(one, other) for one, other in zip(heights, sides, strict=True)])
    assert np.array_equal(np.isnan(found), np.isnan(expected))
    there = ~np.isnan(expected)
    assert np.array_equal(np.signbit(found[there]), np.signbit(expected[there]))
    plain = (
        ~(np.isfinite(heights) & np.isfinite(sides))
        | (heights == 0)
        | (sides == 0)
        | (abs(heights) == abs(sides))
    )
    exact = there & plain
    assert np.array_equal(found[exact], expected[exact])
    distance = np.abs(found[there] - expected[there])
    # half a unit for the one we compare with
    assert (distance <= (OF_ANGLE + 1.0) * np.spacing(np.abs(expected[there]))).all()


@pytest.mark.parametrize("number", ["float32"])
def test_single_numbers_are_rounded_once(number: str, machine: Any) -> None:
    """Functions of single numbers are computed in doubles: the rounding to a single is nearly all of the error."""
    random = np.random.default_rng(4)
    at = random.uniform(-REDUCED, REDUCED, (2, 2001)).astype(number)
    outputs = {"sin": m.sin(x), "cos": m.cos(x), "angle": m.atan2(y, x), "exp": m.exp(0.0005 * x)}
    found = (
        kernels.kernel_of(Scan(("x", "y"), (), outputs), number, target=machine).run(at, None).outputs[:, 0]
    )
    doubles = at.astype(np.float64)
    single = np.float32(0.0005) * at[0]
    expected = [
        np.sin(doubles[0]),
        np.cos(doubles[0]),
        np.arctan2(doubles[1], doubles[0]),
        np.exp(single.astype(float)),
    ]
    for one, true in zip(found, expected, strict=True):
        assert (np.abs(one - true) <= (0.5 + 1e-6) * np.spacing(np.abs(true.astype(number)))).all()


def test_functions_of_the_library(machine: Any) -> None:
    at = np.random.default_rng(5).uniform(0.1, 20, (2, 1001))
    outputs = {"exp": m.exp(x), "log": m.log(x), "power": x**y}
    found = kernels.kernel_of(Scan(("x", "y"), (), outputs), target=machine).run(at, None).outputs[:, 0]
    truths = [lambda a, b: mp.exp(a), lambda a, b: mp.log(a), lambda a, b: a**b]
    for values, true in zip(found, truths, strict=True):
        error, where = worst(values, lambda i, true=true: true(mp.mpf(at[0, i]), mp.mpf(at[1, i])))
        assert error <= OF_LIBRARY, at[:, where]


def test_what_is_stated_is_what_is_tested() -> None:
    trigonometry = pytest.importorskip("centrode.numerics.machine_code.functions", reason=NEEDS)
    assert trigonometry.REDUCED == REDUCED
