"""Memory of a sweep does not grow with its mechanisms: measured as the peak of processes of their own."""

from __future__ import annotations

import subprocess
import sys

import pytest

from centrode.sweeps import limits

PROBE = """
import resource, sys
import centrode as ct
def peak():
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
def run(count):
    ranges = {"links.AB.length": (3.2, 3.8, count // 10), "frame.points.D.x": (3.9, 4.1, 10)}
    return ct.sweep(ct.example("crank-rocker"), ct.grid(ranges), "position.B", int(sys.argv[2]), reduce="range")
run(20)
before = peak()
data = run(int(sys.argv[1]))
print(peak() - before, sum(v.nbytes for v in data.variables.values()))
"""


def grown(mechanisms: int, samples: int) -> tuple[int, int]:
    """Bytes by which the peak grew, and those of the result."""
    done = subprocess.run(
        [sys.executable, "-c", PROBE, str(mechanisms), str(samples)],
        capture_output=True,
        encoding="utf-8",
        check=True,
        timeout=300,
    )
    unit = 1 if sys.platform == "darwin" else 1024
    kilobytes, result = map(int, done.stdout.split())
    return kilobytes * unit, result


@pytest.mark.skipif(sys.platform == "win32", reason="peak memory is asked of resource, which Windows lacks")
def test_memory_is_bounded() -> None:
    for mechanisms, samples in ((6_000, 37), (400, 2_000)):
        more, result = grown(mechanisms, samples)
        assert more < limits.WORKING_SET + limits.BLOCK_BYTES + result
