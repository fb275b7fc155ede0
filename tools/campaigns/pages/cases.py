"""Every built-in linkage with random numbers: what a page computes of them in Node, beside motions of the program."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cache
from typing import Any

import numpy as np
import xarray as xr

import centrode as ct
from centrode.errors import NotComputedYet, Status
from centrode.kinematics.events import Guards
from centrode.kinematics.path import SampleGrid
from centrode.kinematics.preparation import ready
from centrode.kinematics.samples import MotionOnPath
from centrode.kinematics.solve import grid_of, of_batch
from centrode.numerics.arrays import ARRAYS
from centrode.page.program import PageProgram, page_program
from centrode.structure.dimensions import dimensions_of
from centrode.structure.groups import Newton
from tools.campaigns.campaign import Campaign, Outcome, random_of
from tools.node import MISSING, NODE, PageFrame, page_frames

SETS = 20
"""Sets of numbers of each linkage."""
SPREADS = (0.0, 0.02, 0.1, 0.3)
"""How far numbers are drawn from those of the description, in turn."""
EXACT = 1e-13
"""Error of positions in the size of the linkage; of rates times the condition of its groups, and its square."""
BESIDE = 0.02
"""Places beside change points [in units of the path], where both engines take smooth functions, each its own."""
SMOOTH = 1e-9
"""Error of rates there, in units of the greatest one."""
ORDERS = {"position": 0, "velocity": 1, "acceleration": 2, "angle": 0, "angular_velocity": 1,
          "angular_acceleration": 2, "joint_angle": 0, "joint_velocity": 1, "joint_acceleration": 2,
          "hinge_angle": 0, "hinge_velocity": 1, "hinge_acceleration": 2,
          "slide": 0, "slide_velocity": 1, "slide_acceleration": 2}  # fmt: skip
WORDS = ("position", "velocity", "acceleration")
COLUMNS = {
    "statuses": "samples whose status or absence differs; bound 0",
    "position": f"greatest error in the size of the linkage, angles in rad; bound {EXACT:g} times the condition",
    "velocity": f"error in the greatest rate, over the condition of the groups; bound {EXACT:g}",
    "acceleration": f"error in the greatest second derivative, over the square of the condition; bound {EXACT:g}",
    "beside change points": f"greatest error of any of them in the greatest value; bound {SMOOTH:g}",
}


@cache
def names() -> tuple[str, ...]:
    """The linkages, each a case."""
    return ct.example_names()


def run(seed: int, number: int) -> Outcome:
    """One linkage with its sets of numbers."""
    outcome = Outcome(subject=names()[number])
    if NODE is None:
        outcome.count(MISSING)
        return outcome
    mechanism = ct.example(names()[number])
    higher = any(isinstance(group, Newton) for group in ready(mechanism).structure.groups)
    try:
        program = page_program(mechanism)
    except NotComputedYet as refusal:
        outcome.count("refused")
        if not higher:
            outcome.fault(f"refused: {refusal}")
        return outcome
    if higher:
        outcome.fault("not refused")
    compare(outcome, program, sets_of(program, random_of(seed, number), SETS))
    return outcome


def sets_of(program: PageProgram, random: np.random.Generator, count: int) -> list[list[float]]:
    """Sets of numbers; every other one moves what is zero too."""
    own = np.array([parameter.value for parameter in program.parameters])
    lengths = np.array([parameter.positive for parameter in program.parameters], dtype=bool)
    scale = float(ready(program.mechanism).kinematics.numbers.scale)
    found = []
    for k in range(count):
        spread = SPREADS[k % len(SPREADS)] * random.uniform(-1.0, 1.0, len(own))
        around = scale if k % 2 else np.abs(own)
        found.append(np.where(lengths, own * (1.0 + spread), own + around * spread).tolist())
    return found


def compare(outcome: Outcome, program: PageProgram, sets: list[list[float]]) -> None:
    """Judge the frames of a page by the motions of the program."""
    paths = [parameter.path for parameter in program.parameters]
    frames = page_frames(program, sets)
    if paths:
        vary = {path: [one[k] for one in sets] for k, path in enumerate(paths)}
        motions = ct.motion(program.mechanism, vary=vary)
    else:
        motions = xr.concat([ct.motion(program.mechanism)] * len(sets), "mechanism", join="override")
    conditions = conditions_of(program, paths, sets)
    size = float(ready(program.mechanism).kinematics.numbers.scale)
    for k, frame in enumerate(frames):
        outcome.count("sets")
        compare_frame(outcome, program, frame, motions.isel(mechanism=k), conditions[k], size)


def conditions_of(program: PageProgram, paths: list[str], sets: list[list[float]]) -> np.ndarray:
    """How much every sample of a page answers to rounding."""
    span = grid_of(ready(program.mechanism), None, None, None, None)
    return conditions_at(program.mechanism, span, program.data["guards"], paths, sets)


def conditions_at(
    mechanism: ct.Mechanism,
    span: SampleGrid,
    guards: Iterable[tuple[str, int]],
    paths: list[str],
    sets: list[list[float]],
) -> np.ndarray:
    """How much every sample answers to rounding: products over the groups of greatest root over own root."""
    prepared = ready(mechanism)
    numbers = {path: np.array([one[k] for one in sets]) for k, path in enumerate(paths)}
    kinematics = prepared.kinematics
    if paths:
        kinematics = of_batch(kinematics, dimensions_of(mechanism, numbers, ARRAYS))
    lanes = len(sets) if paths else 1
    continuation = MotionOnPath.along(prepared, kinematics, span.parameter, lanes).continuation
    each, at = np.repeat(np.arange(lanes), len(span.parameter)), np.tile(span.parameter, lanes)
    condition = np.ones((lanes, len(span.parameter)))
    for kind, group in guards:
        with np.errstate(all="ignore"):
            value = np.abs(Guards(continuation).jets(group, each, at, 1).value).reshape(lanes, -1)
            share = np.nanmax(value, axis=1, keepdims=True, initial=0.0) / value
        condition *= np.maximum(1.0, np.sqrt(share) if kind == "radicand" else share)
    return np.broadcast_to(condition, (len(sets), len(span.parameter)))


def compare_frame(
    outcome: Outcome,
    program: PageProgram,
    frame: PageFrame,
    motion: xr.Dataset,
    condition: np.ndarray,
    size: float,
) -> None:
    """Judge one set of numbers."""
    row, status = outcome.subject, motion.status.values
    outcome.count("samples", len(status))
    for kind in Status:
        if (status == kind).any():
            outcome.count(f"samples {kind.word}", int((status == kind).sum()))
    differ = status != frame.status
    outcome.hold(row, "statuses", int(differ.sum()), 0.0)
    beside = np.zeros(len(status), dtype=bool)
    unit = program.data["parameter"]["scale"]
    for event in frame.events:
        if event["kind"] == "change point":
            beside |= np.abs(np.asarray(_parameter(program)) - event["drive"]) < BESIDE * unit
    for name, order in ORDERS.items():
        if name not in frame.quantities or name not in motion or not frame.quantities[name].size:
            continue
        ours, theirs = (
            frame.quantities[name].reshape(len(status), -1),
            motion[name].values.reshape(len(status), -1),
        )
        outcome.hold(row, "statuses", int((np.isnan(ours) != np.isnan(theirs)).any(axis=1).sum()), 0.0)
        good = (status == Status.OK) & ~differ & np.isfinite(theirs).all(axis=1)
        if not good.any():
            continue
        scale = _scale(motion, name, good, size, program)
        error = np.max(np.abs(ours - theirs), axis=1) / scale
        if (good & beside).any():
            outcome.hold(row, "beside change points", float(error[good & beside].max()), SMOOTH)
        good &= ~beside
        if good.any():
            share = error[good] / condition[good] ** max(order, 1)
            outcome.hold(row, WORDS[order], float(share.max()), EXACT)


def _parameter(program: PageProgram) -> Any:
    return program.data["places"]["parameter"]


def _scale(motion: xr.Dataset, name: str, good: np.ndarray, size: float, program: PageProgram) -> float:
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
    rate = float(np.max(np.abs(program.data["places"]["rate"])))
    return max(greatest, *(rate * float(np.max(np.abs(motion[other].values[good]))) for other in before))


CAMPAIGN = Campaign(
    "pages",
    "Pages of mechanisms",
    "What a page computes in Node, from its printed formulas and its own search for events, against motions of "
    "the program with the same numbers: all built-in linkages, each with 20 sets of lengths and places of fixed "
    "points that are drawn at random. How long a recompute takes is measured by `python -m benchmarks page`: 0.2 "
    "ms are promised while no limit and no change point lies within the motion. Where some do, it takes up to 1 "
    "ms, and up to some 15 ms in chains of four or five dyads: beside the limit of one group second derivatives "
    "of those behind it have no bound, as positions run like square roots there, and cells have to be divided "
    "until they are places.",
    COLUMNS,
    run,
    len(names()),
    1,
)
