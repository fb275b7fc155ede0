"""Reduction to the drive against the motion it rests on."""

from __future__ import annotations

import functools
from collections.abc import Iterator

import centrode as ct
from benchmarks.table import Promise, Row
from benchmarks.timing import paired_times, ratio
from centrode.dynamics.reducer import Reducer
from centrode.dynamics.reduction import reduction_of
from centrode.kinematics.ready import ready
from centrode.kinematics.solve import asked_span, solve

SAMPLES = 361
NAME = "six-bar-press"
MOST = 5.0
"""Times its kinematics that a reduction may take."""


def reductions() -> Iterator[Row]:
    """The six-bar press: from the description, and where the motion is there already."""
    mechanism = ct.example(NAME)
    prepared = ready(mechanism)
    span = asked_span(prepared, SAMPLES, None, None)
    solved = solve(prepared, span)
    reducer = Reducer.of(mechanism)
    times = paired_times(
        {
            "motion": functools.partial(ct.motion, mechanism, SAMPLES),
            "reduce": functools.partial(ct.reduce, mechanism, SAMPLES),
            "solve": functools.partial(solve, prepared, span),
            "reduction": functools.partial(reduction_of, solved),
            "at": functools.partial(reducer.at, span.parameter),
        }
    )
    whole = ratio(times, "reduce", "motion")
    yield Row(
        NAME,
        {
            "reduce / motion": whole,
            "its own part / solve": ratio(times, "reduction", "solve"),
            "any values again / solve": ratio(times, "at", "solve"),
        },
        note="its own part finds the jumps and labels the result",
        promises=[Promise(f"reduction of {SAMPLES} samples, times the motion", whole, at_most=MOST)],
    )
