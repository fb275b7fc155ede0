"""Tolerances: a million drawn presses, and what an analysis of one mechanism takes."""

from __future__ import annotations

from collections.abc import Iterator
from statistics import median

import centrode as ct
from benchmarks.table import Promise, Row
from benchmarks.timing import paired_times

PATHS = (
    "links.OA.length", "links.AB.points.B.x", "links.CD.points.B.x",
    "frame.points.C.x", "links.CD.points.D.x", "links.DH.points.H.x",
)  # fmt: skip
STROKE = {"stroke": "range(position_H_x)"}
SAMPLES, DRAWS = 91, 1_000_000
MOST = 2.0
"""Seconds of one core that a million presses may take."""


def tolerances() -> Iterator[Row]:
    """All rows."""
    limits = dict.fromkeys(PATHS, (-1e-3, 1e-3))

    def analysed(draws: int) -> object:
        return ct.tolerances("six-bar-press", STROKE, limits, samples=SAMPLES, draws=draws)

    times = paired_times({"many": lambda: analysed(DRAWS), "few": lambda: analysed(1000)}, rounds=3)
    many, few = median(times["many"]), median(times["few"])
    yield Row(
        "six-bar-press",
        {"1e6 drawn [s]": many, "1000 drawn [s]": few},
        promises=[
            Promise("1e6 presses of 91 samples with one output, tolerances in all [s]", many, at_most=MOST)
        ],
    )
