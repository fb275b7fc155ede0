"""Batches of mechanisms on a turning crank: what closed forms, the arrays' search and 50 digits say of closing."""

from __future__ import annotations

from typing import Any
from unittest.mock import patch

import mpmath
import numpy as np
import numpy.typing as npt

from centrode.errors import Status
from centrode.kinematics import solve as solving
from centrode.kinematics.machine_code.event_free_mechanisms import EventScreening
from centrode.kinematics.machine_code.link_rotation import LinkRotation
from centrode.kinematics.machine_code.trace import trace_motion
from centrode.kinematics.machine_code.variables import SCALE, centre_of, varied_of, winding_of
from centrode.kinematics.path import SampleGrid
from centrode.kinematics.preparation import ready
from centrode.kinematics.samples import SUSPECT
from centrode.kinematics.solve import Solved, requested_grid
from centrode.numerics.arrays import ARRAYS
from centrode.structure.dimensions import dimensions_of
from tools.campaigns.campaign import Campaign, Outcome, random_of
from tools.campaigns.rotatability.kinds import KINDS, START, Kind, Values, Wave

Array = npt.NDArray[np.float64]
LANES = 1000
SAMPLES = 7
DIGITS = 50
ONE_PART = 10_000
"""Nodes of a mesh, more than there are."""
DOUBTFUL = 1e-6
"""Reserve above which a mechanism of one wave must not be in doubt; margins are 2e-8 of it."""


class Digits:
    """Functions of 50 digits, over single numbers."""

    sin, cos, atan2, sqrt = mpmath.sin, mpmath.cos, mpmath.atan2, mpmath.sqrt


class Doubles:
    """Functions of doubles, over arrays."""

    sin, cos, atan2, sqrt = np.sin, np.cos, np.arctan2, np.sqrt


def extremes(wave: Wave, low: Any, high: Any, m: Any, pi: Any) -> tuple[Any, Any]:
    """Least and greatest x over a range of single numbers: at its ends, and where the crank reaches crest or trough."""
    places = [low, high]
    for side in (0, 1):
        # the first crest or trough from the beginning of the range on
        first = wave.crest + side * pi
        first += 2 * pi * mpmath.ceil((low - first) / (2 * pi))
        places += [first] if first <= high else []
    heights = [wave.middle + wave.reach * m.cos(q - wave.crest) for q in places]
    return min(heights), max(heights)


def extremes_of_many(wave: Wave, low: float, high: float) -> tuple[Array, Array]:
    """The same of doubles for many mechanisms."""
    heights = [wave.middle + wave.reach * np.cos(q - wave.crest) for q in (low, high)]
    least, greatest = np.minimum(*heights), np.maximum(*heights)
    for side in (0, 1):
        first = wave.crest + side * np.pi
        first = first + 2.0 * np.pi * np.ceil((low - first) / (2.0 * np.pi))
        height = wave.middle + (wave.reach if side == 0 else -wave.reach)
        least = np.where(first <= high, np.minimum(least, height), least)
        greatest = np.where(first <= high, np.maximum(greatest, height), greatest)
    return least, greatest


def reserve(kind: Kind, values: Values, lane: int, low: float, high: float) -> tuple[float, float]:
    """To 50 digits: the least factor, and the product of the least ones over that of the greatest ones."""
    with mpmath.workdps(DIGITS):
        own = {path: mpmath.mpf(float(x[lane])) for path, x in values.items()}
        wave = kind.wave(own, Digits)
        least, greatest = extremes(wave, mpmath.mpf(low), mpmath.mpf(high), mpmath, mpmath.pi)
        ends = [sorted((a + b * least, a + b * greatest)) for a, b in wave.factors]
        share = mpmath.fprod(one for one, _other in ends) / mpmath.fprod(abs(other) for _one, other in ends)
        return float(min(one / abs(other) for one, other in ends)), float(share)


def shares(kind: Kind, values: Values, low: float, high: float) -> Array:
    """How far mechanisms are from the border by doubles, as shares of the greatest values."""
    wave = kind.wave(values, Doubles)
    least, greatest = extremes_of_many(wave, low, high)
    ends = [np.sort(np.stack([a + b * least, a + b * greatest]), axis=0) for a, b in wave.factors]
    each = np.stack([one / np.abs(other) for one, other in ends])
    worst = each.min(axis=0)
    found: Array = np.where(worst > 0.0, each.prod(axis=0), np.abs(worst))
    return found


def drawn(seed: int, number: int) -> tuple[Kind, Values, tuple[float, float], EventScreening, Any]:
    """The batch of a case: its kind, values, range of the mesh, and what screens it."""
    random = random_of(seed, number)
    kind = KINDS[number % len(KINDS)]
    whole = random.random() < 0.5
    ends = (None, None) if whole else np.sort(random.uniform(-6.0, 6.0, 2) + START)
    prepared = ready(kind.mechanism)
    span = requested_grid(prepared, SAMPLES, *(None if x is None else float(x) for x in ends))
    values = kind.draw(random, LANES)
    numbers = dimensions_of(prepared.mechanism, values, ARRAYS)
    varied = varied_of(numbers, values)
    names = tuple(dict.fromkeys([*varied.names, SCALE]))
    screening = EventScreening(trace_motion(prepared, span, varied), span.parameter, names, (), "arrays")
    mesh = screening.covered_range
    # two fifths all but fail, by 1e-1 to 1e-16
    near = random.random(LANES) < 0.4
    by = np.where(random.random(LANES) < 0.5, 1.0, -1.0) * 10.0 ** -random.uniform(1.0, 16.0, LANES)
    moved = {path: x.copy() for path, x in values.items()}
    kind.border(moved, *extremes_of_many(kind.wave(values, Doubles), *mesh), by)
    values = {path: np.where(near, moved[path], x) for path, x in values.items()}
    numbers = dimensions_of(prepared.mechanism, values, ARRAYS)
    return kind, values, mesh, screening, (prepared, span, numbers, varied.values(numbers) | values)


def run(seed: int, number: int) -> Outcome:
    """A batch: every difference between closed form and search is judged at 50 digits."""
    kind, values, mesh, screening, (prepared, span, numbers, rows) = drawn(seed, number)
    row = f"{kind.name}, {'a turn' if mesh[1] - mesh[0] > 2.0 * np.pi else 'a part of a turn'}"
    found = Outcome(subject=f"{LANES} of {row}; {kind.mechanism}")
    closure = screening.closure
    if closure is None:
        found.fault("no closed form was found")
        return found
    judged = closure.judge(rows, "arrays", 1)
    # all mechanisms in one part: it takes two thirds of the time, and no number hangs on the part it is in
    with np.errstate(all="ignore"), patch.object(solving, "CHUNK", LANES * ONE_PART):
        solved = solving.solve(prepared, span, numbers, LANES)
    eventful = np.zeros(LANES, dtype=bool)
    eventful[[event.lane for event in solved.branches.events]] = True
    clear = (solved.status == Status.OK).all(axis=1) & ~eventful
    doubtful = ~judged.clear & ~judged.opens
    found.count("mechanisms", LANES)
    for what, lanes in (("clear", judged.clear), ("open", judged.opens), ("doubtful", doubtful)):
        found.count(what, int(np.count_nonzero(lanes)))
    found.measure(row, "doubtful", np.count_nonzero(doubtful) / LANES)
    _compare_angles(found, row, screening, rows, span, solved, judged.clear & clear)
    for lane in np.nonzero(judged.clear & ~clear)[0]:
        least, share = reserve(kind, values, int(lane), *mesh)
        found.count("clear, and the search finds an event")
        found.measure(row, "event found", share)
        if not (least > 0.0 and share > SUSPECT):
            found.fault(f"lane {lane} is called clear, reserve {least:.3g}, share {share:.3g}")
    for lane in np.nonzero(judged.opens & clear)[0]:
        least, _share = reserve(kind, values, int(lane), *mesh)
        found.count("open, and the search finds no event")
        found.measure(row, "no event found", -least)
        if not least < 0.0:
            found.fault(f"lane {lane} is called open, reserve {least:.3g}")
    if doubtful.any():
        # the bound is far above the rounding of doubles
        some = {path: x[doubtful] for path, x in values.items()}
        found.hold(row, "doubt", float(shares(kind, some, *mesh).max()), DOUBTFUL)
    return found


def _compare_angles(
    found: Outcome,
    row: str,
    screening: EventScreening,
    rows: Values,
    span: SampleGrid,
    solved: Solved,
    clear: npt.NDArray[np.bool_],
) -> None:
    """Angles of links with the turns that the arrays count on the mesh, from where closed forms say that they stand."""
    traced = screening.traced
    rotation = LinkRotation.of(traced, tuple(traced.turning), screening.names)
    (drive,) = traced.winders
    if not rotation.headings.keys() >= traced.turning.keys():
        found.fault("no closed form of an angle was found")
        return
    stands = rotation.judge(rows, "arrays", 1)
    told, where = clear & stands.told, stands.values
    found.count("clear, and angles told", int(np.count_nonzero(told)))
    found.measure(
        row, "angles not told", int(np.count_nonzero(clear & ~told)) / (int(np.count_nonzero(clear)) or 1)
    )
    # of angles that begin half a turn off those of the description the arrays alone count turns
    lanes = np.nonzero(told & stands.near)[0]
    for link in traced.turning if len(lanes) else ():
        angle = solved.angles[0, lanes][:, :, solved.layout.angles.index(link)]
        turning = where[winding_of(link, drive)][lanes, None] * span.parameter
        off = np.abs(angle - turning - where[centre_of(link)][lanes, None]).max()
        found.hold(row, "angle", float(off / np.pi), 1.0)


CAMPAIGN = Campaign(
    "rotatability",
    "Conditions of closure in closed form",
    """Dyads on a turning crank, a thousand random mechanisms a case: four-bars, slider-cranks, inverted
    slider-cranks and spherical four-bars, over a turn and over a part of one; among them equal sides, kites, collinear
    pivots, guides that pass the crank's axis, and two fifths that miss the border between closing and opening
    by a share of 1e-1 to 1e-16 of a length.

    Closed forms call a mechanism clear, open or doubtful; the arrays' search looks for limits and change points
    on the mesh. Where clear mechanisms have an event or a sample that is not ok, and where open ones have none,
    the extremes of what decides are computed by other formulas to 50 digits from the same doubles: a fault is a
    clear mechanism that does not close by its margin, and an open one that closes. Doubtful ones lie next to
    the border, or are a fault. Of the clear ones the angles of all links, with the turns that the arrays count
    on the mesh, stay within half a turn of where closed forms say that they stand.""",
    {
        "doubtful": "share of the mechanisms of a case that are left to the mesh",
        "event found": "where the search finds an event of a clear mechanism: the radicand's least value over "
        "the bound of its greatest one, to 50 digits; below 1e-8 it is a fault",
        "no event found": "where the search finds no event of an open mechanism: how far below zero a factor falls, "
        "over its greatest value",
        "doubt": f"how far from the border, as a share of the greatest value, a doubtful mechanism is; "
        f"bound {DOUBTFUL:g}",
        "angle": "greatest distance of a link's angle from where closed forms say that it stands, in half turns; "
        "bound 1",
        "angles not told": "share of the clear mechanisms whose angles are followed on the mesh",
    },
    run,
    1000,
)
