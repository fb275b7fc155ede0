"""Machine code against NumPy: arithmetic, roots, comparisons and selection bit for bit, at every width."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from centrode.numerics.expressions import EXPRESSIONS, Node, variable
from centrode.numerics.scans import Scan, run_on_arrays

NEEDS = "machine code needs llvmlite: pip install 'centrode[fast]'"
kernels = pytest.importorskip("centrode.numerics.machine_code.kernels", reason=NEEDS)
targets = pytest.importorskip("centrode.numerics.machine_code.compile", reason=NEEDS)

m = EXPRESSIONS
NAMES = ("x", "y", "z")
SPECIAL = (
    0.0,
    -0.0,
    1.0,
    -1.0,
    0.5,
    3.0,
    -0.1,
    math.inf,
    -math.inf,
    math.nan,
    5e-324,
    1e308,
    -1e-308,
    1e-160,
)
LANES = np.concatenate(
    [
        np.array(np.meshgrid(SPECIAL, SPECIAL, SPECIAL)).reshape(3, -1),
        np.random.default_rng(0).normal(size=(3, 1001)),
    ],
    axis=1,
)
WHOLE = {"float64": np.int64, "float32": np.int32}


def differing(a: np.ndarray, b: np.ndarray) -> int:
    """How many numbers are not equal to the last bit; one NaN is as good as another."""
    whole = WHOLE[a.dtype.name]
    equal = (a.view(whole) == b.view(whole)) | (np.isnan(a) & np.isnan(b))
    return int(np.sum(~equal))


def random_formula(seed: int, size: int = 60) -> Node:
    """Operations drawn at random, of operations drawn before."""
    draw = np.random.default_rng(seed)
    known: list[Any] = [variable(name) for name in NAMES] + [2.5, -0.3, 0.0]

    def one() -> Any:
        return known[draw.integers(len(known))]

    for _ in range(size):
        p, q, r, s = (one() + 0.0 * variable("x") if draw.random() < 0.1 else one() for _ in range(4))
        node = variable(NAMES[draw.integers(3)])
        match draw.integers(11):
            case 0 | 1:
                known.append(p + (q - node))
            case 2 | 3:
                known.append(node * p * q)
            case 4:
                known.append(p / (node + q))
            case 5:
                known.append(m.sqrt(m.abs(node - p)) - m.sqrt(node + q))
            case 6:
                # the sign of a zero is not told, so it is made positive
                known.append(m.min(p, node) + 0.0)
            case 7:
                known.append(m.greatest(p, node) + (0.0 - q))
            case 8:
                known.append(m.where(m.less(p, node), q, -(node + r)))
            case 9:
                known.append(m.where(m.both(m.equal(node, p), m.opposite(m.less_equal(q, node))), r, node))
            case _:
                known.append(m.where(m.either(m.not_equal(node, p), m.is_number(node - q)), s * node, r))
    total = known[6]
    for node in known[7:]:
        total = m.where(m.is_number(node), total + 0.125 * node, total)
    return total


@pytest.mark.parametrize("number", ["float64", "float32"])
@pytest.mark.parametrize("seed", range(6))
def test_random_formulas_bit_for_bit(seed: int, number: str) -> None:
    node = random_formula(seed)
    scan = Scan(NAMES, (), {"value": node, "tail": node * variable("x")})
    with np.errstate(over="ignore"):
        lanes = LANES.astype(number)
    expected = run_on_arrays(scan, lanes, None, number=number).outputs
    found = kernels.kernel_of(scan, number).run(lanes, None).outputs
    assert found.dtype == np.dtype(number)
    assert np.isfinite(expected).mean() > 0.1
    assert differing(found, expected) == 0


@pytest.mark.parametrize("width", [1, 2, 3, 4, 8, 16])
def test_widths_change_nothing(width: int) -> None:
    scan = Scan(NAMES, ("t",), {"value": random_formula(7) * variable("t")}, {})
    steps = np.array([[1.0, -2.0, math.nan]])
    expected = run_on_arrays(scan, LANES, steps).outputs
    for lanes in (1, width - 1, width, width + 1, 3 * width - 1, LANES.shape[1]):
        for inside in (False, True):
            kernel = kernels.kernel_of(scan, width=width, lanes_inside=inside)
            found = kernel.run(LANES[:, :lanes], steps).outputs
            assert differing(found, expected[:, :, :lanes]) == 0, (lanes, inside)


def test_an_old_machine_gives_the_same() -> None:
    """SSE2 alone, no fused multiplication: what is left of the host's machine without its newer features."""
    host = targets.host()
    if not host.triple.startswith("x86_64"):
        pytest.skip("the old machine is an x86")
    old = targets.target_of(host.triple, "x86-64", {})
    assert (old.register, old.has_fma) == (128, False)
    scan = Scan(NAMES, (), {"value": random_formula(3)})
    found = kernels.kernel_of(scan, target=old).run(LANES, None).outputs
    assert differing(found, run_on_arrays(scan, LANES, None).outputs) == 0


@pytest.mark.parametrize(
    ("features", "register", "has_fma"),
    [
        ({"avx512f": True, "avx2": True, "fma": True}, 512, True),
        ({"avx512f": False, "avx2": True, "fma": True}, 256, True),
        ({"avx": True}, 128, False),
    ],
)
def test_width_by_features(features: dict[str, bool], register: int, has_fma: bool) -> None:
    target = targets.target_of("x86_64-unknown-linux-gnu", "some", features)
    assert (target.register, target.has_fma) == (register, has_fma)
    assert ("-prefer-256-bit" in target.features) is (register == 512)
    assert (target.width(64), target.width(32)) == (register // 64, register // 32)


def test_machines_that_are_no_x86() -> None:
    target = targets.target_of("aarch64-apple-darwin", "apple-m1", {"neon": True})
    assert (target.width(64), target.has_fma, target.features) == (2, True, "+neon")


def test_masks_with_a_fifth_open() -> None:
    """A dyad of which a fifth of the samples do not close: the same NaN, the same numbers."""
    a, x = variable("a"), variable("x")
    squared = 5.0 - 4.0 * m.cos(x)
    scan = Scan(("a",), ("x",), {"y": m.sqrt((a * a - squared) * (squared - 0.25)) / squared})
    lanes, steps = np.linspace(2.2, 3.1, 101)[None], np.linspace(0, 2 * math.pi, 361)[None]
    expected = run_on_arrays(scan, lanes, steps).outputs
    assert 0.2 < np.isnan(expected).mean() < 0.3
    for inside in (False, True):
        assert (
            differing(kernels.kernel_of(scan, lanes_inside=inside).run(lanes, steps).outputs, expected) == 0
        )


def test_a_state_wants_steps_inside() -> None:
    x = variable("x")
    with pytest.raises(ValueError, match="steps inside"):
        kernels.kernel_of(Scan((), (), {}, {"x": x + 1.0}), lanes_inside=True)


def test_other_numbers_are_refused() -> None:
    with pytest.raises(ValueError, match="float64 or float32"):
        kernels.kernel_of(Scan(("x",), (), {"y": variable("x")}), "int32")


def test_relaxed_rounding_keeps_masks_and_nearly_the_numbers() -> None:
    a, x = variable("a"), variable("x")
    squared = 5.0 - 4.0 * m.cos(x)
    root = m.sqrt((a * a - squared) * (squared - 0.25))
    outputs = {"y": root / squared * x + a * x, "z": (x + a) / squared + x / (a * 3.0)}
    scan = Scan(("a",), ("x",), outputs)
    lanes, steps = np.linspace(2.0, 2.9, 101)[None], np.linspace(0, 2 * math.pi, 361)[None]
    expected = run_on_arrays(scan, lanes, steps).outputs
    kernel = kernels.kernel_of(scan, relaxed=True)
    found = kernel.run(lanes, steps).outputs
    assert kernel.rest.graph.counts["divide"] < kernels.kernel_of(scan).rest.graph.counts["divide"]
    assert np.array_equal(np.isnan(found), np.isnan(expected))
    assert np.array_equal(found[1] == 0, expected[1] == 0)
    # six roundings of numbers below 30 at the most, once in each
    assert np.nanmax(np.abs(found - expected)) <= 12 * 2.0**-53 * 30
    assert differing(found, expected) > 0


def test_radicands_stay_exact_when_relaxed() -> None:
    """a a - b is zero to the last bit where a product rounded by itself makes it so; fused it would not be."""
    a, b = variable("a"), variable("b")
    scan = Scan(("a", "b"), (), {"root": m.sqrt(a * a - b), "rest": a * b + a})
    at = np.random.default_rng(5).uniform(1, 2, 999)
    found = kernels.kernel_of(scan, relaxed=True).run([at, at * at], None).outputs[:, 0]
    assert (found[0] == 0.0).all()


def test_fields_of_a_target_decide() -> None:
    host = targets.host()
    narrow = replace(host, register=128)
    kernel = kernels.kernel_of(Scan(("x",), (), {"y": variable("x") + 1.0}), target=narrow)
    assert kernel.shape.vector.width == 2
