"""Synthesis: the published paths and functions, by the clock on one core, atlas and search together."""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping
from pathlib import Path

import numpy as np

import centrode as ct
from benchmarks.table import Promise, Row
from centrode.synthesis.answers import Answer

PATHS = Path(__file__).parents[1] / "tests" / "reference" / "paths"
LIMIT = 10.0
"""Seconds that a case may take."""
CLOSED: Mapping[str, tuple[float, dict[str, object]]] = {
    "mcgarva": (2.839, {"crank": "OA"}),
    "yu1": (0.8543, {"crank": "OA"}),
    "yu2": (7.764, {"crank": "OA"}),
    "mkh1": (3.143e-3, {"crank": "OA"}),
    "mkh2": (7.609e-5, {"crank": "OA"}),
    "mkh3": (3.873e-2, {"crank": "OA"}),
}
"""Path -> the least known sum of squares, and what is asked; of mkh3 the published one."""
FIVE = ((3, 3), (2.759, 3.363), (2.372, 3.663), (1.890, 3.862), (1.355, 3.943))
"""Points at 30, 45, 60, 75 and 90 deg of a crank whose pivot is the origin, the frame along x."""
FIVE_FREE = {
    "frame.points.D.x": [-10, 10], "links.OA.length": [0.05, 10], "links.AB.length": [0.05, 10],
    "links.DB.length": [0.05, 10], "links.AB.points.P.x": [-10, 10], "links.AB.points.P.y": [-10, 10],
}  # fmt: skip
FIVE_SUMS = {"given": 7.416e-7, "phase": 4.083e-7}
EIGHTEEN_SUM = 9.0289e-3
"""The 18-point case with 20 deg of the crank from point to point, phase and place free."""
FUNCTIONS: Mapping[str, tuple[float, dict[str, object]]] = {
    "log10 x on 1..2, 60 and 90 deg": (
        0.00697, {"formula": "log(x)/log(10)", "x": [1, 2], "swings": ["60 deg", "90 deg"]},
    ),
    "sin x on 0..90 deg, 90 and 90 deg": (
        0.190, {"formula": "sin(x*pi/180)", "x": [0, 90], "swings": ["90 deg", "90 deg"]},
    ),
}  # fmt: skip
"""Function -> the least known greatest error [deg], and the request."""


def synthesis() -> Iterator[Row]:
    """Time of each case and how near it comes."""
    for name, (known, constraints) in CLOSED.items():
        wanted = {"kind": "path", "targets": _points(name), "constraints": constraints}
        took, best = _search(wanted)
        yield _row(f"path {name}", took, best.sum_of_squares, known)
    table = [[*row, f"{20 * k} deg"] for k, row in enumerate(_points("mkh1"))]
    wanted = {"kind": "path", "targets": table, "timing": "phase", "constraints": {"crank": "OA"}}
    took, best = _search(wanted)
    yield _row("18 points at 20 deg", took, best.sum_of_squares, EIGHTEEN_SUM)
    table = [[*place, f"{30 + 15 * k} deg"] for k, place in enumerate(FIVE)]
    for timing, known in FIVE_SUMS.items():
        timed = {"kind": "path", "targets": table, "timing": timing, "place": "given", "free": FIVE_FREE}
        took, best = _search(timed)
        yield _row(f"five points, timing {timing}", took, best.sum_of_squares, known)
    for name, (known, function) in FUNCTIONS.items():
        took, best = _search({"kind": "function", **function})
        yield _row(f"function {name}", took, float(np.degrees(best.greatest)), known)


def _points(name: str) -> list[list[float]]:
    points: list[list[float]] = np.loadtxt(PATHS / f"{name}.csv", delimiter=",", skiprows=1).tolist()
    return points


def _search(wanted: Mapping[str, object]) -> tuple[float, Answer]:
    begin = time.perf_counter()
    found = ct.synthesise({"synthesis": {"topology": "crank-rocker", **wanted}})
    return time.perf_counter() - begin, found.answers[0]


def _row(subject: str, took: float, error: float, known: float) -> Row:
    return Row(
        subject,
        {"time [s]": took, "error": error, "over the known": error / known},
        promises=[
            Promise(f"{subject}: seconds", took, at_most=LIMIT),
            Promise(f"{subject}: error over the least known", error / known, at_most=1.01),
        ],
    )
