"""Memory of a sweep does not grow with its mechanisms: measured as the peak of processes of their own."""

from __future__ import annotations

import subprocess
import sys

import pytest

from centrode.numerics import machine_code
from centrode.sweeps import designs
from samples import few

COMPILED = pytest.mark.skipif(not machine_code.PRESENT, reason="machine code needs the extra fast")
PROBE = """
import resource, sys
import centrode as ct
def peak():
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
def run(count):
    mechanism = ct.example(sys.argv[3])
    own = ct.value_at(mechanism, "links.OA.length")
    ranges = {"links.OA.length": (0.98 * own, 1.02 * own, count)}
    return ct.sweep(mechanism, ct.grid(ranges), "position", int(sys.argv[2]), reduce="range", executor=sys.argv[4])
run(2)
before = peak()
data = run(int(sys.argv[1]))
print(peak() - before, sum(v.nbytes for v in data.variables.values()))
"""


def grown(mechanisms: int, samples: int, name: str, executor: str) -> tuple[int, int]:
    """Bytes by which the peak grew, and those of the result."""
    done = subprocess.run(
        [sys.executable, "-c", PROBE, str(mechanisms), str(samples), name, executor],
        capture_output=True,
        encoding="utf-8",
        check=True,
    )
    unit = 1 if sys.platform == "darwin" else 1024
    kilobytes, result = map(int, done.stdout.split())
    return kilobytes * unit, result


SWEEPS = [
    (6_000, 37, "crank-rocker", "arrays"),
    (400, 2_000, "crank-rocker", "arrays"),
    (400, 37, "third-class-triad", "arrays"),
    pytest.param(few(200_000, 500_000), 37, "six-bar-press", "machine code", marks=COMPILED),
]


@pytest.mark.skipif(sys.platform == "win32", reason="peak memory is asked of resource, which Windows lacks")
@pytest.mark.parametrize(
    ("mechanisms", "samples", "name", "executor"),
    few(SWEEPS[::3], SWEEPS),
)
def test_memory_is_bounded(mechanisms: int, samples: int, name: str, executor: str) -> None:
    """Chunks are full: with more mechanisms there are more of them, not greater ones."""
    more, result = grown(mechanisms, samples, name, executor)
    assert more < designs.WORKING_SET + designs.BLOCK_BYTES + result
