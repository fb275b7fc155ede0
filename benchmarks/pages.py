"""Pages: how long Node takes from changed numbers to a whole motion, its search for events included."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from tools.node import recompute_times

from benchmarks.table import Promise, Row
from centrode.page.program import page_program

SAMPLES = 361
MOST = 0.2
"""Milliseconds that a recompute of a six-bar may take on the machine of docs/benchmarks.md."""
MECHANISMS = {"crank-rocker": None, "watt-six-bar": MOST, "stephenson-six-bar": MOST, "six-bar-press": MOST,
              "double-rocker": None,
              "jansen-leg": None, "spherical-four-bar": None}  # fmt: skip
WARM, ROUNDS = 400, 1000


def recomputes() -> Iterator[Row]:
    """All rows; each recompute has other numbers."""
    for name, most in MECHANISMS.items():
        program = page_program(name, samples=SAMPLES)
        own = np.array([parameter.value for parameter in program.parameters])
        random = np.random.default_rng(1)
        cases = (own * (1.0 + 0.01 * random.uniform(-1.0, 1.0, (100, len(own))))).tolist()
        times = recompute_times(program, cases, WARM + ROUNDS)[WARM:]
        took = float(np.median(times))
        numbers = {
            "recompute [ms]": took,
            "slowest of 20 [ms]": float(np.quantile(times, 0.95)),
            "program [kB]": len(program.javascript.encode()) / 1000,
        }
        if program.data["reactions"]:
            acting = recompute_times(program, cases, WARM + ROUNDS, acting=True)[WARM:]
            numbers["with reactions [ms]"] = float(np.median(acting))
        promises = [] if most is None else [Promise(f"{name}: recompute in Node [ms]", took, at_most=most)]
        yield Row(name, numbers, promises=promises)
