"""Pages: how long Node takes from changed numbers to a whole motion, its search for events included."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from tools.node import recompute_times

import centrode as ct
from benchmarks.table import Promise, Row
from centrode.errors import NotComputedYet
from centrode.page.program import PageProgram, page_program

SAMPLES = 361
MOST = 0.2
"""Milliseconds that a recompute may take on the machine of docs/benchmarks.md."""
WARM, BLOCKS, ROUNDS = 400, 10, 100
TRIES = 4
"""Processes that may measure: a core is slow for seconds while its neighbour works."""
NOT_PROMISED = {
    "excavator-arm": "three laws of time that are looked at in cells of the mesh, four groups behind each other"
}
"""Linkage -> why its recompute may take longer."""


def recomputes() -> Iterator[Row]:
    """A row for each built-in linkage that has a page; each recompute has other numbers."""
    for name in ct.example_names("linkage"):
        try:
            program = page_program(name, samples=SAMPLES)
        except NotComputedYet:
            continue
        own = np.array([parameter.value for parameter in program.parameters])
        random = np.random.default_rng(1)
        cases = (own * (1.0 + 0.01 * random.uniform(-1.0, 1.0, (100, len(own))))).tolist()
        took, slow = _typical(program, cases)
        numbers = {
            "recompute [ms]": took,
            "slowest of 20 [ms]": slow,
            "program [kB]": len(program.javascript.encode()) / 1000,
        }
        if program.data["reactions"]:
            numbers["with reactions [ms]"] = _typical(program, cases, acting=True)[0]
        promise = Promise(f"{name}: recompute in Node [ms]", took, at_most=MOST)
        why = NOT_PROMISED.get(name, "")
        yield Row(name, numbers, why, promises=[] if why else [promise])


def _typical(program: PageProgram, cases: list[list[float]], acting: bool = False) -> tuple[float, float]:
    """Median [ms] of the quietest of some blocks, as others use the cores too, and the slowest of 20 there."""
    best = np.inf, np.inf
    for _ in range(TRIES):
        times = recompute_times(program, cases, WARM + BLOCKS * ROUNDS, acting)[WARM:].reshape(BLOCKS, ROUNDS)
        quietest = times[np.argmin(np.median(times, axis=1))]
        best = min(best, (float(np.median(quietest)), float(np.quantile(quietest, 0.95))))
        if best[0] <= MOST:
            break
    return best
