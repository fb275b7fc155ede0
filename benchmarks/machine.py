"""What the machine and NumPy allow: speed of single operations, and the operations that a motion cannot do without."""

from __future__ import annotations

import functools
from collections import Counter
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

import centrode as ct
from benchmarks.motions import BATCH, BATCHES, SAMPLES
from benchmarks.table import Row
from benchmarks.timing import best_times
from centrode.kinematics.plan_evaluation import FixedSigns
from centrode.kinematics.preparation import Ready, ready
from centrode.numerics.jets import Jet, JetFunctions

CACHED = 8192
"""Numbers in an array of which several stay in the cache nearest to the processor."""
LARGE = 1 << 24
"""Numbers in an array that fits in no cache."""
OUTPUTS = 8
"""Bytes of a number that is written out."""


def bounds() -> Iterator[Row]:
    """Single operations in the time of a multiplication, then batches in the time of their operations alone."""
    costs = _costs()
    unit = costs["multiply"]
    yield Row("one operation", {name: cost / unit for name, cost in costs.items()}, "in multiplications")
    for name, paths in BATCHES.items():
        yield _batch(name, paths, costs)


def _costs() -> dict[str, float]:
    """Time of each operation for one number [s], in cache, into an array that exists; `write` is to memory."""
    random = np.random.default_rng(0)
    a, b = random.uniform(0.5, 1.5, CACHED), random.uniform(0.5, 1.5, CACHED)
    out, large = np.empty(CACHED), np.zeros(LARGE)
    tasks: dict[str, Callable[[], object]] = {
        "multiply": functools.partial(np.multiply, a, b, out=out),
        "add": functools.partial(np.add, a, b, out=out),
        "divide": functools.partial(np.divide, a, b, out=out),
        "sqrt": functools.partial(np.sqrt, a, out=out),
        "sin": functools.partial(np.sin, a, out=out),
        "arctan2": functools.partial(np.arctan2, a, b, out=out),
        "write": functools.partial(large.fill, 1.0),
    }
    times = best_times(tasks)
    return {name: time / (LARGE if name == "write" else CACHED) for name, time in times.items()}


def _batch(name: str, paths: tuple[str, ...], costs: dict[str, float]) -> Row:
    mechanism = ct.example(name)
    vary = {path: float(ct.value_at(mechanism, path)) * np.linspace(0.98, 1.02, BATCH) for path in paths}
    motion = functools.partial(ct.motion, mechanism, SAMPLES, vary=vary)
    took = best_times({"motion": motion}, rounds=5)["motion"] / (BATCH * SAMPLES)
    counted = operations(ready(mechanism))
    arithmetic = sum(costs[operation] * count for operation, count in counted.items())
    written = sum(variable.nbytes for variable in motion().data_vars.values()) / (BATCH * SAMPLES) / OUTPUTS
    return Row(
        f"{name} x {BATCH}, a position",
        {
            "operations": float(sum(counted.values())),
            "numbers written": written,
            "motion / arithmetic": took / arithmetic,
            "motion / (arithmetic + writing)": took / (arithmetic + written * costs["write"]),
        },
    )


def operations(prepared: Ready) -> Counter[str]:
    """Operations of the closed forms and of the angles at one position, with two derivatives."""
    counter: Counter[str] = Counter()
    functions = JetFunctions(_Counting(counter))
    parameter = Jet.variable(_Counted(prepared.kinematics.path.initial + 0.1, counter), 2)

    prepared.kinematics.positions(functions, parameter, FixedSigns(functions, prepared.assembled.signs))
    del counter["sin"]  # those of the drive's value are taken once for a whole batch
    links = len(prepared.mechanism.links)
    return counter + Counter({"arctan2": links, "multiply": 4 * links, "add": 2 * links})


class _Counted:
    """A number that counts what is done with it."""

    def __init__(self, value: float, counter: Counter[str]) -> None:
        self.value = value
        self.counter = counter

    def _made(self, operation: str, value: float) -> _Counted:
        self.counter[operation] += 1
        return _Counted(value, self.counter)

    def __add__(self, other: Any) -> _Counted:
        return self._made("add", self.value + _plain(other))

    __radd__ = __add__

    def __sub__(self, other: Any) -> _Counted:
        return self._made("add", self.value - _plain(other))

    def __rsub__(self, other: Any) -> _Counted:
        return self._made("add", _plain(other) - self.value)

    def __neg__(self) -> _Counted:
        return _Counted(-self.value, self.counter)

    def __mul__(self, other: Any) -> _Counted:
        return self._made("multiply", self.value * _plain(other))

    __rmul__ = __mul__

    def __truediv__(self, other: Any) -> _Counted:
        return self._made("divide", self.value / _plain(other))

    def __rtruediv__(self, other: Any) -> _Counted:
        return self._made("divide", _plain(other) / self.value)


class _Counting:
    """The functions of a formula on counted numbers."""

    def __init__(self, counter: Counter[str]) -> None:
        self.counter = counter

    def __getattr__(self, name: str) -> Callable[[Any], Any]:
        def function(x: Any) -> Any:
            value = float(getattr(np, name)(_plain(x)))
            if not isinstance(x, _Counted):
                return value
            self.counter["sin" if name == "cos" else name] += 1
            return _Counted(value, self.counter)

        return function


def _plain(x: Any) -> float:
    return x.value if isinstance(x, _Counted) else float(x)
