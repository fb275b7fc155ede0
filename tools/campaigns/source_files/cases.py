"""Built-in linkages with random dimensions: printed source files, compiled and run, beside motions of the program."""

from __future__ import annotations

import tempfile
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

import centrode as ct
from centrode.errors import NotComputedYet, Status
from centrode.export.motion_program import MotionProgram, traced_program
from centrode.kinematics.motion import EVENT_KINDS
from tools.campaigns.campaign import Campaign, Outcome, random_of
from tools.campaigns.pages.cases import BESIDE, EXACT, ORDERS, SMOOTH, SPREADS, WORDS, conditions_at
from tools.source_programs import PROGRAMS, Answers, Places, answers_of

Array = npt.NDArray[np.float64]
SETS = 20
"""Sets of dimensions of each linkage."""
EVERY = {"python": 4, "matlab": 12}
"""In the languages that are interpreted, every how manieth place is looked at."""
COLUMNS = {
    "statuses": "places whose status or absence differs; bound 0",
    "position": f"greatest error in the size of the linkage, angles in rad; bound {EXACT:g} times the condition",
    "velocity": f"error in the greatest rate, over the condition of the groups; bound {EXACT:g}",
    "acceleration": f"error in the greatest second derivative, over the square of the condition; bound {EXACT:g}",
    "beside change points": f"greatest error of any of them in the greatest value; bound {SMOOTH:g}",
}
LANGUAGES = ("c", "javascript", "python", "matlab")


TWENTY = (
    "antiparallelogram", "bevel-differential", "cam-driven-linkage", "crank-rocker", "excavator-arm", "geared-five-bar",
    "inverted-slider-crank", "jansen-leg", "kite", "oscillating-cylinder", "parallelogram", "peaucellier",
    "planetary-gear-train", "rack-and-pinion", "scotch-yoke", "shaper", "six-bar-press", "slider-between-cranks-locked",
    "spherical-crank-guide", "wiper",
)  # fmt: skip
"""Linkages whose source files are run in every language; in C all are."""


@cache
def cases() -> tuple[tuple[str, str], ...]:
    """Linkage and language of each case."""
    others = ((name, language) for name in TWENTY for language in LANGUAGES if language != "c")
    return (*((name, "c") for name in ct.example_names()), *others)


def run(seed: int, number: int) -> Outcome:
    """One linkage in one language with its sets of dimensions."""
    name, language = cases()[number]
    outcome = Outcome(subject=f"{name} in {language}")
    if PROGRAMS[language] is None:
        outcome.count(f"{language} is not installed")
        return outcome
    try:
        program = traced_program(name, None)
    except NotComputedYet:
        outcome.count("refused")
        return outcome
    sets = sets_of(program, random_of(seed, number), SETS)
    compare(outcome, program, language, sets, EVERY.get(language, 1))
    return outcome


def sets_of(program: MotionProgram, random: np.random.Generator, count: int) -> list[list[float]]:
    """Sets of dimensions; every other one moves what is zero too."""
    own = np.array(program.values)
    lengths = np.array(program.tables["is_length"], dtype=bool)
    scale = float(program.ready.kinematics.numbers.scale)
    found = []
    for k in range(count):
        spread = SPREADS[k % len(SPREADS)] * random.uniform(-1.0, 1.0, len(own))
        around = scale if k % 2 else np.abs(own)
        found.append(np.where(lengths, own * (1.0 + spread), own + around * spread).tolist())
    return found


def compare(
    outcome: Outcome, program: MotionProgram, language: str, sets: list[list[float]], every: int = 1
) -> None:
    """Judge a source file by the motions of the program."""
    span, chosen = program.span, slice(None, None, every)
    rates = (
        [np.ones_like(span.time), np.zeros_like(span.time)]
        if program.by_time
        else [span.rate, span.second_rate]
    )
    places = np.stack([span.parameter, *rates], axis=1)[chosen]
    with tempfile.TemporaryDirectory() as folder:
        answers = answers_of(program, language, Places(sets, places), Path(folder))
    if program.paths:
        vary = {path: [one[k] for one in sets] for k, path in enumerate(program.paths)}
        motions = ct.motion(program.mechanism, vary=vary)
    else:
        motions = xr.concat([ct.motion(program.mechanism)] * len(sets), "mechanism", join="override")
    unit = float(program.numbers["unit"])
    changes = _change_points(program)
    conditions = conditions_at(program.mechanism, span, program.traced.guards, list(program.paths), sets)
    for k in range(len(sets)):
        outcome.count("sets")
        one = Answers(answers.status[k], answers.result[k])
        motion = motions.isel(mechanism=k, sample=chosen)
        # sets that are drawn have no change points, the description's own may have some
        beside = np.abs(places[:, :1] - (changes if sets[k] == program.values else [])) < BESIDE * unit
        _compare_set(outcome, program, one, motion, conditions[k][chosen], beside.any(axis=1), places)


def _change_points(program: MotionProgram) -> Array:
    """Places of the change points of the description's own motion."""
    motion = ct.motion(program.mechanism)
    kinds = motion.event_kind.values
    return np.asarray(motion.event_value.values[kinds == EVENT_KINDS.index("change point")], dtype=np.float64)


def _compare_set(
    outcome: Outcome,
    program: MotionProgram,
    answers: Answers,
    motion: xr.Dataset,
    condition: Array,
    beside: Array,
    places: Array,
) -> None:
    row, status = outcome.subject, motion.status.values
    outcome.count("places", len(status))
    differ = status != answers.status
    outcome.hold(row, "statuses", int(differ.sum()), 0.0)
    first = 0
    size = float(program.ready.kinematics.numbers.scale)
    for quantity in program.quantities:
        width = quantity.rows.size
        ours = answers.result[:, first : first + width]
        first += width
        if quantity.name not in ORDERS or quantity.name not in motion:
            continue
        theirs = motion[quantity.name].values.reshape(len(status), -1)
        outcome.hold(row, "statuses", int((np.isnan(ours) != np.isnan(theirs)).any(axis=1).sum()), 0.0)
        good = (status == Status.OK) & ~differ & np.isfinite(theirs).all(axis=1)
        if not good.any():
            continue
        order, scale = ORDERS[quantity.name], _scale(motion, quantity.name, good, size, places)
        error = np.max(np.abs(ours - theirs), axis=1) / scale
        near = good & beside
        if near.any():
            outcome.hold(row, "beside change points", float(error[near].max()), SMOOTH)
        good &= ~near
        if good.any():
            outcome.hold(
                row, WORDS[order], float((error[good] / condition[good] ** max(order, 1)).max()), EXACT
            )


def _scale(motion: xr.Dataset, name: str, good: Any, size: float, places: Array) -> float:
    """What errors of a quantity are compared with: its greatest value, or what the drive's rate makes of its rate."""
    greatest = float(np.max(np.abs(motion[name].values[good]), initial=0.0))
    order = ORDERS[name]
    if order == 0:
        return max(greatest, size if name in ("position", "slide") else 1.0)
    before = [
        other
        for other in motion
        if ORDERS.get(str(other)) == order - 1 and motion[other].dims == motion[name].dims
    ]
    if order == 1 or not before:
        return max(greatest, 1e-9)
    rate = float(np.max(np.abs(places[:, 1])))
    return max(greatest, *(rate * float(np.max(np.abs(motion[other].values[good]))) for other in before))


CAMPAIGN = Campaign(
    "source-files",
    "Source files of mechanisms",
    "What printed source files compute, in C by gcc, in JavaScript by Node, in Python and in Octave, against motions "
    "of the program with the same numbers: in C all built-in linkages, in the others twenty, each with 20 sets of "
    "lengths and places of fixed points that are drawn at random; Python looks at every fourth place and Octave at "
    "every twelfth.",
    COLUMNS,
    run,
    len(cases()),
    1,
)
