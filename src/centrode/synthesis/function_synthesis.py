"""Function synthesis of four-bar linkages: from a request to answers."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from centrode.errors import InputError, MotionError
from centrode.locale import _
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.text_formula import compile_formula
from centrode.synthesis.answers import SynthesisResults, four_bar_answer
from centrode.synthesis.four_bars import Array, cosines_of_transmission, crank_margins, lengths
from centrode.synthesis.function_generation import (
    GRID,
    KEPT_WITHIN,
    SAMPLES,
    FunctionLinkages,
    Margins,
    angle_errors,
    five_points,
    four_points,
    keeps,
    least_errors,
    three_points,
)
from centrode.synthesis.requests import Synthesis, SynthesisTask


def function_answers(
    task: SynthesisTask,
    progress: Callable[[float], None] = lambda share: None,
    stop: Callable[[], bool] = lambda: False,
) -> SynthesisResults:
    """Four-bar linkages whose rocker follows a function of the crank.

    With a formula the greatest error is least, unless so many precision points are exact; a table of three to five rows
    is met exactly, a longer one with the least greatest error.

    Raises
    ------
    InputError
        A formula that has no value somewhere, or an output that is no angle of a rocker.
    MotionError
        No linkage keeps what is required.
    """
    wanted = task.synthesis
    if wanted.of != "angle.DB":
        what = _("the output of a four-bar linkage is angle.DB, got {name}").format(name=wanted.of)
        raise InputError("[synthesis] of", what)
    crank, rocker = wanted_angles(wanted)
    crank, rocker = crank - crank[0], rocker - rocker[0]
    exact = wanted.exact
    if wanted.targets is not None and len(crank) <= 5:
        exact = len(crank)
    margins = _margins(wanted, crank)
    if exact is None:
        found = least_errors(crank, rocker, margins, progress, stop)
    else:
        found = _exact(wanted, crank, rocker, exact, margins)
    progress(1.0)
    if not len(found.side):
        raise MotionError(
            "[synthesis]", _("no linkage keeps everything that is required"), _("loosen a constraint")
        )
    answers = []
    seen: list[tuple[float, ...]] = []
    base = wanted.length or 1.0
    for k in range(len(found.side)):
        a, b, c = found.lengths[k] * base
        linkage = np.array([0.0, 0.0, base, 0.0, a, b, c, 0.0, 0.0])
        # starts that differ by whole turns are the same
        first = float(np.angle(np.exp(1j * found.starts[k, 0])))
        angles = crank + first
        row = (first, *found.lengths[k])
        if any(np.allclose(row, other, rtol=1e-5, atol=1e-5) for other in seen):
            continue
        seen.append(row)
        sense = 1.0 if crank[-1] > 0 else -1.0
        answer = four_bar_answer(
            task, linkage, float(found.side[k]), angles, sense, found.errors[k], closed=False
        )
        if wanted.constraints.order and not answer.defects.none:
            continue
        answers.append(answer)
        if len(answers) == wanted.answers:
            break
    if not answers:
        raise MotionError(
            "[synthesis]", _("every linkage that was found has a defect"), _("reduce the swings")
        )
    return SynthesisResults(
        task,
        tuple(answers),
        examined=GRID * GRID // 2,
        complete=not stop(),
        values=np.column_stack([crank, rocker]),
    )


def wanted_angles(wanted: Synthesis, shares: Array | None = None) -> tuple[Array, Array]:
    """Angles of crank and rocker (n,) [rad] that a request gives: its table, or its formula at shares of its range.

    Both count from the beginning of the range of a formula.
    """
    if wanted.formula is None:
        rows = np.array(sorted(wanted.rows), dtype=np.float64)
        return rows[:, 0], rows[:, 1]
    assert wanted.x is not None and wanted.swings is not None
    formula = compile_formula(wanted.formula, ("x",), "[synthesis] formula")
    low, high = wanted.x
    even = np.linspace(0.0, 1.0, SAMPLES)
    if not high > low:
        raise InputError("[synthesis] x", _("the range is empty"), _("give [first, last]"))
    x = low + (high - low) * even

    def value(places: Array) -> Array:
        with np.errstate(all="ignore"):
            return np.array(np.broadcast_to(formula(ARRAYS, x=places), places.shape), dtype=float)

    y = value(x)
    if not np.isfinite(y).all():
        at = float(x[~np.isfinite(y)][0])
        what = _("the formula has no value at x = {x:g}").format(x=at)
        raise InputError("[synthesis] formula", what, _("change the range of x"))
    if not np.ptp(y) > 0:
        raise InputError("[synthesis] formula", _("the formula is constant"), _("give one that changes"))
    share = even if shares is None else shares
    chosen = y if shares is None else value(low + (high - low) * shares)
    return wanted.swings[0] * share, wanted.swings[1] * (chosen - y[0]) / np.ptp(y)


def _margins(wanted: Synthesis, crank: Array) -> Margins:
    """By how much linkages with the frame 1 keep each constraint; the crank's angles count from its start [rad]."""
    constraints = wanted.constraints

    def margins(starts: Array, sizes: Array) -> Array:
        linkages = _with_unit_frame(sizes)
        columns = [np.empty((len(sizes), 0))]
        if constraints.crank is not None:
            # a crank at its change point does not turn fully, so it stays away from it by what counts as kept
            columns.append(crank_margins(linkages) - 2 * KEPT_WITHIN)
        if constraints.transmission is not None:
            # by cosines, as an angle has no slope where the linkage is stretched; near the bound it is that of angles
            greatest, slope = math.cos(constraints.transmission), math.sin(constraints.transmission)
            columns.append((greatest - np.abs(_cosines(linkages, starts, crank))) / (slope or 1.0))
        if constraints.length_ratio is not None:
            all_lengths = lengths(linkages)
            columns.append(
                (constraints.length_ratio * all_lengths.min(axis=1) - all_lengths.max(axis=1))[:, None]
            )
        return np.column_stack(columns)

    return margins


def _cosines(linkages: Array, starts: Array, crank: Array) -> Array:
    """Cosines that bound the transmission angle (lanes, 2): over a full turn, or where the crank is used."""
    turns = (crank_margins(linkages) > 0).all(axis=1)
    first = np.where(turns, 0.0, starts[:, 0] + crank.min())
    last = np.where(turns, 2 * np.pi, starts[:, 0] + crank.max())
    return cosines_of_transmission(linkages, first, last)


def _with_unit_frame(sizes: Array) -> Array:
    """Linkages from O = 0 to D = 1 of crank, coupler and rocker (lanes, 3)."""
    linkages = np.zeros((len(sizes), 9))
    linkages[:, 2], linkages[:, 4:7] = 1.0, sizes
    return linkages


def _exact(wanted: Synthesis, crank: Array, rocker: Array, exact: int, margins: Margins) -> FunctionLinkages:
    """Linkages through precision points: those of a table, or at Chebyshev's places of a formula's range."""
    first, second = crank, rocker
    if len(crank) != exact:
        share = 0.5 - 0.5 * np.cos(np.pi * (2 * np.arange(exact) + 1) / (2 * exact))
        first, second = wanted_angles(wanted, share)
    grid = np.linspace(0.0, 2 * np.pi, 2 * GRID, endpoint=False)
    if exact == 3:
        starts = np.stack(np.meshgrid(grid[::2], grid[:GRID:2], indexing="ij"), axis=-1).reshape(-1, 2)
        found = three_points(first, second, starts)
    elif exact == 4:
        found = four_points(first, second, grid[:GRID])
    else:
        found = five_points(first, second)
    errors = angle_errors(found.starts, found.lengths, found.side, crank, rocker)
    worst = np.abs(errors).max(axis=1, initial=0.0)
    good = keeps(margins(found.starts, found.lengths)) & np.isfinite(worst)
    order = np.flatnonzero(good)
    if len(crank) == exact:
        # all meet the points alike: what transmits best comes first
        cosines = _cosines(_with_unit_frame(found.lengths), found.starts, crank)
        order = order[np.argsort(np.abs(cosines).max(axis=1)[order], kind="stable")]
    else:
        order = order[np.argsort(worst[order], kind="stable")]
    order = order[: 6 * wanted.answers]
    return FunctionLinkages(found.starts[order], found.lengths[order], found.side[order], errors[order])
