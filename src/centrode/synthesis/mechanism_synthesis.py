"""Synthesis of any mechanism that a file describes: its free numbers, by path, function, or stroke and dwell.

What is wanted is a row of misses with exact derivatives by the free numbers, which the sweep kernels give; least
squares go from many starts between the bounds (M. A. Branch, T. F. Coleman, Y. Li, SIAM J. Sci. Comput. 21, 1999,
1-23). Crank angles that nobody gives are those of the nearest places of the curve in the order of the targets, so that
a miss is the distance along the normal, and the derivative of that place falls out.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from scipy.optimize import least_squares

from centrode.errors import CentrodeError, InputError, MotionError, Status
from centrode.kinematics.motion import motion
from centrode.locale import _
from centrode.model.mechanism import Mechanism
from centrode.model.reading import two_points, value_text
from centrode.model.units import read_quantity
from centrode.sweeps.designs import kind_of
from centrode.sweeps.solver import Solver, solver
from centrode.synthesis.answers import CHECKED_PLACES, Answer, Defects, SynthesisResults, box_around
from centrode.synthesis.four_bars import Array, Complex
from centrode.synthesis.improvement import describe_moved
from centrode.synthesis.measures import Measure, hermite, measure_of
from centrode.synthesis.requests import Synthesis, SynthesisTask

STARTS = 400
"""Mechanisms between the bounds that are looked at."""
REFINED = 24
"""The best of them go on."""
SAMPLES = 181
KEPT = 1e-6
Progress: TypeAlias = Callable[[float], None]
Misses: TypeAlias = Callable[[Array], tuple[Array, Array, Array]]
"""values -> misses (m,), derivatives (m, free), drive values at the targets; raises _Open."""


class _BrokenMotion(Exception):
    """The mechanism does not move all along."""


@dataclass(frozen=True)
class _Wanted:
    """What the misses are of: their outputs, and how they follow from these."""

    outputs: Mapping[str, str]
    at: Array | None
    misses: Callable[[Solver, Mapping[str, Array], Mapping[str, Array]], tuple[Array, Array, Array]]


def mechanism_answers(
    task: SynthesisTask, progress: Progress = lambda share: None, stop: Callable[[], bool] = lambda: False
) -> SynthesisResults:
    """The mechanism of a file with the free numbers that do what is wanted best.

    Raises
    ------
    InputError
        No number is free, an unknown path or point, a mechanism on the sphere, bounds that leave nothing.
    MotionError
        Nothing between the bounds moves all along, or keeps what is required.
    """
    wanted, mechanism = task.synthesis, task.mechanism
    assert mechanism is not None
    names, low, high = _ranges(mechanism, wanted)
    goal = _goal(mechanism, wanted)
    moved = solver(
        mechanism, names, None if goal.at is not None else SAMPLES, at=goal.at, outputs=dict(goal.outputs)
    )

    def misses(values: Array) -> tuple[Array, Array, Array]:
        numbers = np.asarray(moved.outputs(values))
        slopes = moved.gradient(values)
        if not (np.isfinite(numbers).all() and np.isfinite(slopes).all()):
            raise _BrokenMotion
        return goal.misses(moved, moved.split(numbers), moved.split(slopes))

    starts = _starts(moved, goal, low, high, wanted.seed, stop)
    if not starts:
        what = _("no mechanism between the bounds moves all along")
        raise MotionError("[synthesis.free]", what, _("choose other ranges, or another start of the drive"))
    progress(0.3)
    found: list[tuple[float, Array]] = []
    for count, start in enumerate(starts[:REFINED]):
        if stop() and found:
            break
        found.append(_refine(misses, start, low, high))
        progress(0.3 + 0.6 * (count + 1) / min(len(starts), REFINED))
    found.sort(key=lambda one: one[0])
    answers: list[Answer] = []
    seen: list[Array] = []
    broken: list[str] = []
    for _cost, values in found:
        if any(np.abs((values - other) / (high - low)).max() < 1e-4 for other in seen):
            continue
        seen.append(values)
        answer, why = _answer(task, moved, names, values, misses)
        if answer is None:
            broken.append(why)
            continue
        answers.append(answer)
        if len(answers) == wanted.answers:
            break
    progress(1.0)
    if not answers:
        what = _("no mechanism that was found keeps everything that is required")
        best = _("the nearest breaks {what}").format(what=broken[0]) if broken else ""
        raise MotionError("[synthesis.constraints]", what, best)
    targets = np.empty(0, dtype=np.complex128)
    if wanted.kind == "path":
        rows = np.array(wanted.rows)
        targets = rows[:, 0] + 1j * rows[:, 1]
    return SynthesisResults(task, tuple(answers), targets, examined=STARTS, complete=not stop())


def _ranges(mechanism: Mechanism, wanted: Synthesis) -> tuple[list[str], Array, Array]:
    if mechanism.space != "plane":
        what = _("mechanisms of files are synthesised in the plane")
        raise InputError("space", what, _('on the sphere name topology = "spherical-four-bar"'))
    if not wanted.free:
        what = _("no number of the mechanism is free")
        raise InputError("[synthesis.free]", what, _('give ranges, as links.AB.length = ["1 m", "2 m"]'))
    names, ends = [], []
    for path, given in wanted.free.items():
        where = f"[synthesis.free] {path}"
        try:
            kind = kind_of(mechanism, path)
        except InputError as error:
            raise InputError(where, error.what, error.repair) from None
        if not isinstance(given, list | tuple) or len(given) != 2:
            raise InputError(where, _("expected [least, greatest]"))
        low, high = (read_quantity(value, kind, where) for value in given)
        if not low < high:
            what = _("the range goes from {low:g} to {high:g}").format(low=low, high=high)
            raise InputError(where, what, _("exchange them"))
        names.append(path)
        ends.append((low, high))
    low_ends, high_ends = np.array(ends).T
    return names, low_ends, high_ends


def _goal(mechanism: Mechanism, wanted: Synthesis) -> _Wanted:
    if wanted.kind == "path":
        return _path_goal(mechanism, wanted)
    if wanted.kind == "function":
        return _function_goal(wanted)
    if wanted.kind == "strokes":
        return _stroke_goal(mechanism, wanted)
    what = _("poses are synthesised for four-bar linkages")
    raise InputError(
        "[synthesis] kind", what, _('name topology = "crank-rocker", or lead a point of the link')
    )


def _path_goal(mechanism: Mechanism, wanted: Synthesis) -> _Wanted:
    point = wanted.point
    if not any(point in link.coordinates for link in mechanism.links.values()):
        raise InputError(
            "[synthesis] point", _("no link has the point {name}").format(name=value_text(point))
        )
    rows = np.array(wanted.rows, dtype=np.float64)
    targets = rows[:, :2]
    if wanted.timing == "given":
        outputs = {"x": f"position_{point}_x", "y": f"position_{point}_y"}

        def given(
            moved: Solver, values: Mapping[str, Array], by: Mapping[str, Array]
        ) -> tuple[Array, Array, Array]:
            missed = np.concatenate([values["x"] - targets[:, 0], values["y"] - targets[:, 1]])
            return missed, np.concatenate([by["x"], by["y"]]), moved.parameter

        return _Wanted(outputs, rows[:, 2], given)
    outputs = {
        "x": f"position_{point}_x", "y": f"position_{point}_y", "u": f"velocity_{point}_x", "v": f"velocity_{point}_y",
    }  # fmt: skip

    def nearest(
        moved: Solver, values: Mapping[str, Array], by: Mapping[str, Array]
    ) -> tuple[Array, Array, Array]:
        curve = np.column_stack([values["x"], values["y"]])
        cells, part = _ordered_places(curve, targets, wanted.constraints.order)
        pace = moved.time[1] - moved.time[0]

        def at(name: str, rate: str, numbers: Mapping[str, Array], factors: Array) -> Array:
            ends = (
                numbers[name][cells], pace * numbers[rate][cells],
                numbers[name][cells + 1], pace * numbers[rate][cells + 1],
            )  # fmt: skip
            shape = (slice(None),) + (None,) * (ends[0].ndim - 1)
            total: Array = sum(weight[shape] * end for weight, end in zip(factors, ends, strict=True))
            return total

        for _iteration in range(5):
            # to where the cubic of the cell is nearest, which the chord only estimates
            weights, turn = hermite(part)
            place = np.column_stack([at("x", "u", values, weights), at("y", "v", values, weights)])
            along = np.column_stack([at("x", "u", values, turn), at("y", "v", values, turn)])
            square = np.maximum((along**2).sum(axis=1), 1e-300)
            part = np.clip(part - ((place - targets) * along).sum(axis=1) / square, -0.2, 1.2)
        weights, turn = hermite(part)
        place = np.column_stack([at("x", "u", values, weights), at("y", "v", values, weights)])
        along = np.column_stack([at("x", "u", values, turn), at("y", "v", values, turn)])
        length = np.maximum(np.linalg.norm(along, axis=1), 1e-300)
        along = along / length[:, None]
        slopes = np.stack([at("x", "u", by, weights), at("y", "v", by, weights)], axis=1)
        miss = place - targets
        # a step of the place along the curve takes out what lies along it, except at the ends of an open curve
        inner = (part > -0.2) & (part < 1.2)
        loose = np.where(inner, 1.0, 0.0)[:, None, None] * along[:, :, None] * along[:, None, :]
        normal = np.eye(2) - loose
        rows_missed = np.einsum("nij,nj->ni", normal, miss)
        rows_by = np.einsum("nij,njp->nip", normal, slopes)
        steps = moved.parameter[1] - moved.parameter[0]
        drive = moved.parameter[0] + steps * (cells + part)
        return rows_missed.ravel(), rows_by.reshape(-1, slopes.shape[-1]), drive

    return _Wanted(outputs, None, nearest)


def _ordered_places(
    curve: Array, targets: Array, ordered: bool
) -> tuple[np.ndarray[tuple[int], np.dtype[np.int64]], Array]:
    """Cells (n,) of a sampled curve that are nearest to targets, and the parts (n,) of the cells.

    In the order of the targets, over less than a turn: the best of all such choices (dynamic programming), run through
    in either sense.
    """
    steps = np.diff(curve, axis=0)
    square = np.maximum((steps**2).sum(axis=1), 1e-300)
    away = targets[:, None] - curve[None, :-1]
    part = np.clip((away * steps).sum(axis=-1) / square, 0.0, 1.0)
    distance = ((away - part[..., None] * steps) ** 2).sum(axis=-1)
    count = np.arange(len(targets))
    if not ordered:
        cells = np.argmin(distance, axis=1)
        return cells, part[count, cells]
    best, chosen = math.inf, np.zeros(len(targets), dtype=np.int64)
    places = len(steps)
    closes = float(np.linalg.norm(curve[0] - curve[-1])) < 1e-6 * float(np.abs(curve).max() + 1e-300)
    for sense in (1, -1):
        own = distance[:, ::sense]
        for cut in range(0, places, max(1, places // 12)) if closes else (0,):
            cost, cells = _monotone(np.roll(own, -cut, axis=1))
            if cost < best:
                best, chosen = cost, (cells + cut) % places
                chosen = chosen if sense > 0 else places - 1 - chosen
    return chosen, part[count, chosen]


def _monotone(distance: Array) -> tuple[float, np.ndarray[tuple[int], np.dtype[np.int64]]]:
    """Least sum of distances (n, places) over places that do not decrease, and the places (n,)."""
    n, places = distance.shape
    total = distance[0]
    before = np.zeros((n, places), dtype=np.int64)
    for row in range(1, n):
        run = np.minimum.accumulate(total)
        # the last place at which the running minimum was lowered
        lowered = np.concatenate([[True], total[1:] < run[:-1]])
        before[row] = np.maximum.accumulate(np.where(lowered, np.arange(places), 0))
        total = run + distance[row]
    cells = np.zeros(n, dtype=np.int64)
    cells[-1] = int(np.argmin(total))
    for row in range(n - 1, 0, -1):
        cells[row - 1] = before[row, cells[row]]
    return float(total.min()), cells


def _function_goal(wanted: Synthesis) -> _Wanted:
    """An output that follows the drive, up to a constant."""
    if wanted.formula is not None:
        what = _("a function of a mechanism of a file is a table")
        raise InputError(
            "[synthesis] formula", what, _("give targets: values of the drive, and of the output")
        )
    rows = np.array(wanted.rows, dtype=np.float64)
    output = wanted.of.replace(".", "_")

    def misses(
        moved: Solver, values: Mapping[str, Array], by: Mapping[str, Array]
    ) -> tuple[Array, Array, Array]:
        missed = values["output"] - rows[:, 1]
        if output.startswith("angle"):
            missed = np.unwrap(missed)
        return missed - missed.mean(), by["output"] - by["output"].mean(axis=0), moved.parameter

    return _Wanted({"output": output}, rows[:, 0], misses)


def _stroke_goal(mechanism: Mechanism, wanted: Synthesis) -> _Wanted:
    """Stroke, time ratio and dwell of an output, each in units of its size."""
    output = f"slide_{wanted.guide}" if wanted.guide is not None else wanted.of.replace(".", "_")
    stroke = wanted.stroke if wanted.stroke is not None else wanted.swing
    goals: list[tuple[Measure, float, float]] = []
    for number, (text, value) in enumerate(
        ((f"stroke({output})", stroke), (f"time_ratio({output})", wanted.time_ratio))
    ):
        if value is not None:
            goals.append((measure_of(mechanism, text, "[synthesis]", number), value, value))
    outputs = {name: formula for one, _value, _size in goals for name, formula in one.outputs.items()}
    dwell = wanted.dwell
    if dwell is not None:
        outputs["dwell"] = output
    if not outputs:
        raise InputError("[synthesis]", _("neither a stroke nor a dwell is given"), _("give stroke or dwell"))
    scale = stroke or 1.0

    def misses(
        moved: Solver, values: Mapping[str, Array], by: Mapping[str, Array]
    ) -> tuple[Array, Array, Array]:
        missed, slopes = [], []
        for measure, value, size in goals:
            number, slope = measure.compute(moved.parameter, moved.time, values, by)
            if not math.isfinite(number):
                raise _BrokenMotion
            missed.append(np.array([(number - value) / size]))
            slopes.append(slope[None] / size)
        if dwell is not None:
            first, last = dwell.range
            within = np.flatnonzero(np.mod(moved.parameter[:-1] - first, 2 * math.pi) <= last - first)
            part, part_by = values["dwell"][within], by["dwell"][within]
            if dwell.value is None:
                part, part_by = part - part.mean(), part_by - part_by.mean(axis=0)
            else:
                part = part - dwell.value
            missed.append(part / scale / math.sqrt(len(within)))
            slopes.append(part_by / scale / math.sqrt(len(within)))
        return np.concatenate(missed), np.concatenate(slopes), np.empty(0)

    return _Wanted(outputs, None, misses)


def _starts(
    moved: Solver, goal: _Wanted, low: Array, high: Array, seed: int, stop: Callable[[], bool]
) -> list[Array]:
    """Values between the bounds with which the mechanism moves, the best first; the own ones where they lie there."""
    random = np.random.default_rng(seed)
    drawn = [*random.uniform(low, high, (STARTS, len(low)))]
    own = np.array(moved.own)
    drawn.insert(0, np.clip(own, low, high))
    costs: list[tuple[float, int]] = []
    none = np.zeros((len(low),))
    for index, values in enumerate(drawn):
        if stop():
            break
        numbers = np.asarray(moved.outputs(values))
        if not np.isfinite(numbers).all():
            continue
        slopes = moved.split(np.zeros((*numbers.shape, *none.shape)))
        try:
            missed, _by, _drive = goal.misses(moved, moved.split(numbers), slopes)
        except (_BrokenMotion, ZeroDivisionError):
            continue
        if np.isfinite(missed).all():
            costs.append((float((missed**2).sum()), index))
    return [drawn[index] for _cost, index in sorted(costs)]


def _refine(misses: Misses, start: Array, low: Array, high: Array) -> tuple[float, Array]:
    """The next minimum from a start, in units of the ranges; a step to where nothing moves is taken back."""
    width = high - low
    best = start
    least = math.inf
    count = len(misses(start)[0])

    def rows(place: Array) -> Array:
        nonlocal best, least
        try:
            missed = misses(low + width * place)[0]
        except _BrokenMotion:
            return np.full(count, 1e3 * (1 + math.sqrt(least) if math.isfinite(least) else 1e3))
        cost = float((missed**2).sum())
        if cost < least:
            best, least = low + width * place, cost
        return missed

    def slopes(place: Array) -> Array:
        try:
            by: Array = misses(low + width * place)[1] * width
        except _BrokenMotion:
            return np.zeros((count, len(place)))
        return by

    inside = np.clip((start - low) / width, 1e-9, 1 - 1e-9)
    least_squares(rows, inside, slopes, bounds=(0.0, 1.0), xtol=1e-14, ftol=1e-14, gtol=1e-14, max_nfev=200)
    return least, best


def _answer(
    task: SynthesisTask, moved: Solver, names: list[str], values: Array, misses: Misses
) -> tuple[Answer | None, str]:
    """The answer of these values, or what it breaks."""
    wanted = task.synthesis
    missed, _by, drive = misses(values)
    try:
        mechanism = describe_moved(moved, dict(zip(names, values.tolist(), strict=True)))
        data = motion(mechanism, CHECKED_PLACES)
    except CentrodeError as failure:
        return None, failure.what
    branch = bool((data.status.to_numpy() != int(Status.OK)).any())
    places = data.position.to_numpy()
    size = box_around(mechanism, places)
    curve = met = np.empty(0, dtype=np.complex128)
    numbers: dict[str, tuple[float, str]] = {}
    errors = missed
    order = False
    if wanted.kind == "path":
        curve = _planar(data.position.sel(point=wanted.point).to_numpy())
        met = _planar(motion(mechanism, at=list(drive)).position.sel(point=wanted.point).to_numpy())
        rows = np.array(wanted.rows)
        errors = np.abs(met - rows[:, 0] - 1j * rows[:, 1])
        order = not _in_order(drive)
    if wanted.kind == "strokes":
        numbers = dict(_stroke_numbers(mechanism, wanted))
    broken = next(_broken(mechanism, wanted, size, branch, order), None)
    if broken is not None:
        return None, broken
    return Answer(
        mechanism,
        float(np.sqrt(np.mean(errors**2))),
        float(np.max(np.abs(errors))),
        float((errors**2).sum()),
        math.nan,
        size,
        Defects(order, branch, False),
        curve,
        met,
        drive,
        (),
        missed if wanted.kind == "function" else None,
        numbers,
    ), ""


def _planar(places: Array) -> Complex:
    plane: Complex = places[:, 0] + 1j * places[:, 1]
    return plane


def _in_order(drive: Array) -> bool:
    """Whether drive values grow or fall all along; a turn may lie between two of them."""
    for sense in (1.0, -1.0):
        steps = np.mod(sense * np.diff(drive), 2 * math.pi)
        if float(steps.sum()) < 2 * math.pi + 1e-9:
            return True
    return False


def _stroke_numbers(mechanism: Mechanism, wanted: Synthesis) -> Iterator[tuple[str, tuple[float, str]]]:
    """Stroke, time ratio and what is left of the dwell, by a finer motion."""
    output = f"slide_{wanted.guide}" if wanted.guide is not None else wanted.of.replace(".", "_")
    texts = {"stroke": f"stroke({output})", "time_ratio": f"time_ratio({output})"}
    if wanted.dwell is not None:
        first, last = wanted.dwell.range
        texts["dwell_spread"] = f"dwell({output}, {first!r} rad, {last!r} rad)"
    for number, (name, text) in enumerate(texts.items()):
        measure = measure_of(mechanism, text, "[synthesis]", number)
        checked = solver(mechanism, next(iter(wanted.free)), 721, outputs=dict(measure.outputs))
        values = np.asarray(checked.outputs(checked.own))
        none = checked.split(np.zeros((*values.shape, 1)) if values.ndim else np.zeros(1))
        number_of, _slope = measure.compute(checked.parameter, checked.time, checked.split(values), none)
        if math.isfinite(number_of):
            key = "swing" if name == "stroke" and measure.unit == "rad" else name
            yield key, (number_of, measure.unit)


def _broken(
    mechanism: Mechanism, wanted: Synthesis, size: tuple[float, float], branch: bool, order: bool
) -> Iterator[str]:
    """Names of what an answer does not keep."""
    constraints = wanted.constraints
    if branch and (constraints.order or constraints.crank is not None):
        yield "crank" if constraints.crank is not None else "order"
    if order and constraints.order:
        yield "order"
    if constraints.size is not None and any(
        own > most * (1 + KEPT) for own, most in zip(size, constraints.size, strict=True)
    ):
        yield "size"
    for axis, box in enumerate((constraints.pivots.x, constraints.pivots.y)):
        frame = np.array(list(mechanism.frame.points.values()), dtype=np.float64)
        places = frame[:, axis].tolist()
        if box is not None and not all(box[0] - KEPT <= place <= box[1] + KEPT for place in places):
            yield f"pivots.{'xy'[axis]}"
    if constraints.length_ratio is not None:
        lengths = list(_lengths(mechanism))
        if max(lengths) > constraints.length_ratio * min(lengths) * (1 + KEPT):
            yield "length_ratio"


def _lengths(mechanism: Mechanism) -> Iterator[float]:
    for name, link in mechanism.links.items():
        at = link.coordinates
        named = two_points(name)
        ends = [at[end] for end in named] if named and set(named) <= set(at) else list(at.values())
        if len(ends) > 1:
            yield math.dist(ends[0][:2], ends[1][:2])
