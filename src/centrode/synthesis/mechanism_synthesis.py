"""Synthesis of any mechanism that a file describes: its free numbers, by path, function, or stroke and dwell.

What is wanted is a row of misses with exact derivatives by the free numbers, which the sweep kernels give; least
squares go from many starts between the bounds (M. A. Branch, T. F. Coleman, Y. Li, SIAM J. Sci. Comput. 21, 1999,
1-23). Crank angles that nobody gives are those of the nearest places of the curve in the order of the targets, so that
a miss is the distance along the normal, and the derivative of that place falls out.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
from scipy.optimize import least_squares

from centrode.analysis.transmission import transmission_angles
from centrode.errors import CentrodeError, InputError, MotionError, Status
from centrode.kinematics.motion import motion
from centrode.locale import _
from centrode.model.mechanism import Mechanism
from centrode.model.reading import value_text
from centrode.model.similarity import Similarity, apply_similarity, check_similarity
from centrode.model.units import read_quantity
from centrode.sweeps.designs import kind_of
from centrode.sweeps.solver import Solver, solver
from centrode.synthesis.answers import CHECKED_PLACES, Answer, Defects, SynthesisResults, box_around
from centrode.synthesis.curve_places import PlacedCurve, SampledCurve, ordered_places, place_curve
from centrode.synthesis.four_bars import Array, Complex
from centrode.synthesis.improvement import describe_moved
from centrode.synthesis.measures import Measure, hermite, measure_of
from centrode.synthesis.mechanism_constraints import link_ends, mechanism_constraints
from centrode.synthesis.path_synthesis import is_closed_path
from centrode.synthesis.processes import HERE, Processes
from centrode.synthesis.requests import Synthesis, SynthesisTask

STARTS = 400
"""Mechanisms between the bounds that are looked at."""
REFINED = 24
"""The best of them go on."""
SAMPLES = 181
FINE_SAMPLES = 1441
"""At the end of a search whose place is free: what cubics between samples leave falls with the fourth power."""
SOFT, SHARP = 30.0, 1e4
"""Weights, at first and at the end, of a constraint that is exceeded by its own size against a target that is missed by
the size of the path: what is left of it falls with the square."""
SHARE = 3
"""Starts that one process refines after the other."""
KEPT = 1e-6
Progress: TypeAlias = Callable[[float], None]


class _BrokenMotion(Exception):
    """The mechanism does not move all along."""


@dataclass(frozen=True)
class _Wanted:
    """What the misses are of: their outputs, and how they follow from these.

    Attributes
    ----------
    at : values of the drive of targets that have some
    size : of the misses, in which constraints are weighed
    place : of a path whose place is free: how its curve, by the outputs, is moved onto the targets
    """

    outputs: Mapping[str, str]
    at: Array | None
    size: float
    misses: Callable[[Solver, Mapping[str, Array], Mapping[str, Array]], tuple[Array, Array, Array]]
    place: Callable[[Solver, Mapping[str, Array]], PlacedCurve] | None = None


class _MechanismSearch:
    """What is wanted of a mechanism of a file, made into misses; another process makes its own from the request."""

    def __init__(self, task: SynthesisTask, samples: int | None = None) -> None:
        wanted, mechanism = task.synthesis, task.mechanism
        assert mechanism is not None
        self.task, self.samples = task, SAMPLES if samples is None else samples
        self.names, self.low, self.high = _ranges(mechanism, wanted)
        self.goal = _goal(mechanism, wanted)
        constraints = wanted.constraints
        if self.goal.place is None:
            _narrow_pivots(mechanism, wanted, self.names, self.low, self.high)
        else:
            # where it stands and how large it is is known of an answer only
            constraints = constraints.model_copy(update={"size": None})
        self.kept = mechanism_constraints(mechanism, constraints)
        outputs, kept, at = dict(self.goal.outputs), dict(self.kept.outputs), self.goal.at
        if at is None:
            self.moved = solver(mechanism, self.names, self.samples, outputs={**outputs, **kept})
        else:
            self.moved = solver(mechanism, self.names, None, at=at, outputs=outputs)
        # targets with times say nothing of what is between them: constraints have the whole motion
        self.whole = (
            solver(mechanism, self.names, self.samples, outputs=kept) if at is not None and kept else None
        )

    def __reduce__(self) -> tuple[Any, ...]:
        return _MechanismSearch, (self.task, self.samples)

    def similarity(self, values: Array) -> Similarity | None:
        """What brings the mechanism of these values to its targets; None where its place is given."""
        if self.goal.place is None:
            return None
        numbers, _none = _without_slopes(self.moved, values)
        return self.goal.place(self.moved, numbers).similarity

    def misses(self, values: Array) -> tuple[Array, Array, Array]:
        """Misses of the targets alone, their derivatives, values of the drive at the targets; raises _BrokenMotion."""
        return self.goal.misses(self.moved, *_numbers(self.moved, values))

    def steered_misses(self, values: Array, weight: float = SOFT) -> tuple[Array, Array]:
        """Misses of the targets, then of the constraints, with their derivatives; raises _BrokenMotion."""
        numbers, slopes = _numbers(self.moved, values)
        missed, by, _drive = self.goal.misses(self.moved, numbers, slopes)
        if self.whole is not None:
            numbers, slopes = _numbers(self.whole, values)
        exceeded, exceeded_by = self.kept.misses(self.whole or self.moved, numbers, slopes)
        size = weight * self.goal.size
        return np.concatenate([missed, size * exceeded]), np.concatenate([by, size * exceeded_by])

    def cost(self, values: Array) -> float:
        """Sum of squares of what a start misses; infinite where it does not move."""
        try:
            numbers, none = _without_slopes(self.moved, values)
            missed, _by, _drive = self.goal.misses(self.moved, numbers, none)
            if self.whole is not None:
                numbers, none = _without_slopes(self.whole, values)
        except (_BrokenMotion, ZeroDivisionError):
            return math.inf
        exceeded, _slopes = self.kept.misses(self.whole or self.moved, numbers, none)
        cost = float((missed**2).sum() + (SOFT * self.goal.size) ** 2 * (exceeded**2).sum())
        return cost if math.isfinite(cost) else math.inf


def _numbers(moved: Solver, values: Array) -> tuple[Mapping[str, Array], Mapping[str, Array]]:
    """Outputs and their derivatives; raises _BrokenMotion."""
    numbers, slopes = np.asarray(moved.outputs(values)), moved.gradient(values)
    if not (np.isfinite(numbers).all() and np.isfinite(slopes).all()):
        raise _BrokenMotion
    return moved.split(numbers), moved.split(slopes)


def _without_slopes(moved: Solver, values: Array) -> tuple[Mapping[str, Array], Mapping[str, Array]]:
    """Outputs, and zeros in place of their derivatives, which take most of the time; raises _BrokenMotion."""
    numbers = np.asarray(moved.outputs(values))
    if not np.isfinite(numbers).all():
        raise _BrokenMotion
    return moved.split(numbers), moved.split(np.zeros((*numbers.shape, len(values))))


def mechanism_answers(
    task: SynthesisTask,
    progress: Progress = lambda share: None,
    stop: Callable[[], bool] = lambda: False,
    processes: Processes = HERE,
) -> SynthesisResults:
    """The mechanism of a file with the free numbers that do what is wanted best.

    Raises
    ------
    InputError
        No number is free, an unknown path or point, a mechanism on the sphere, bounds that leave nothing.
    MotionError
        Nothing between the bounds moves all along, or keeps what is required.
    """
    wanted = task.synthesis
    search = _MechanismSearch(task)
    starts = _starts(search, wanted.seed, stop)
    if not starts:
        what = _("no mechanism between the bounds moves all along")
        raise MotionError("[synthesis.free]", what, _("choose other ranges, or another start of the drive"))
    progress(0.3)
    shares = [starts[k : k + SHARE] for k in range(0, min(len(starts), REFINED), SHARE)]
    fitted: dict[int, list[tuple[float, Array]]] = {}
    work = functools.partial(_refine_share, search)
    for index, share in processes.compute(work, shares, lambda: stop() and bool(fitted)):
        fitted[index] = share
        progress(0.3 + 0.6 * len(fitted) / len(shares))
    found = [one for index in sorted(fitted) for one in fitted[index]]
    found.sort(key=lambda one: one[0])
    fine = search if search.goal.place is None else _MechanismSearch(task, FINE_SAMPLES)
    answers, broken = _distinct_answers(fine, found)
    progress(1.0)
    if not answers:
        what = _("no mechanism that was found keeps everything that is required")
        best = _("the nearest breaks {what}").format(what=broken[0]) if broken else ""
        raise MotionError("[synthesis.constraints]", what, best)
    targets = np.empty(0, dtype=np.complex128)
    if wanted.kind == "path":
        rows = np.array(wanted.rows)
        targets = rows[:, 0] + 1j * rows[:, 1]
    return SynthesisResults(task, answers, targets, examined=STARTS, complete=not stop())


def _distinct_answers(
    search: _MechanismSearch, found: Sequence[tuple[float, Array]]
) -> tuple[tuple[Answer, ...], list[str]]:
    """Different answers that keep everything, the best first, and what others break."""
    answers: list[Answer] = []
    seen: list[Array] = []
    broken: list[str] = []
    width = search.high - search.low
    for _cost, values in found:
        if any(np.abs((values - other) / width).max() < 1e-4 for other in seen):
            continue
        seen.append(values)
        if search.goal.place is not None:
            _cost, values = _descend(search, values, SHARP)
        answer, why = _answer(search, values)
        if answer is None:
            broken.append(why)
            continue
        answers.append(answer)
        if len(answers) == search.task.synthesis.answers:
            break
    return tuple(sorted(answers, key=lambda one: one.error)), broken


def _narrow_pivots(
    mechanism: Mechanism, wanted: Synthesis, names: Sequence[str], low: Array, high: Array
) -> None:
    """Ranges of the frame's points put within [synthesis.constraints] pivots; InputError where nothing is left."""
    pivots = wanted.constraints.pivots
    for k, (axis, box) in enumerate((("x", pivots.x), ("y", pivots.y))):
        if box is None:
            continue
        where = f"[synthesis.constraints] pivots.{axis}"
        for name, at in mechanism.frame.points.items():
            path = f"frame.points.{name}.{axis}"
            if path in names:
                own = list(names).index(path)
                low[own], high[own] = max(low[own], box[0]), min(high[own], box[1])
                if not low[own] < high[own]:
                    what = _("no fixed hinge lies both in pivots and in its own range")
                    raise InputError(where, what, _("widen one of them"))
            elif isinstance(at, tuple) and not box[0] <= at[k] <= box[1]:
                what = _("the fixed point {name} stands outside, and is not free")
                repair = _("widen it, or free {path}").format(path=path)
                raise InputError(where, what.format(name=value_text(name)), repair)


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
    size = float(np.linalg.norm(targets - targets.mean(axis=0), axis=1).max())
    if wanted.has_free_place:
        return _placed_goal(mechanism, wanted, targets @ np.array([1.0, 1j]), size)
    if wanted.timing == "given":
        outputs = {"x": f"position_{point}_x", "y": f"position_{point}_y"}

        def given(
            moved: Solver, values: Mapping[str, Array], by: Mapping[str, Array]
        ) -> tuple[Array, Array, Array]:
            missed = np.concatenate([values["x"] - targets[:, 0], values["y"] - targets[:, 1]])
            return missed, np.concatenate([by["x"], by["y"]]), moved.parameter

        return _Wanted(outputs, rows[:, 2], size, given)
    outputs = {
        "x": f"position_{point}_x", "y": f"position_{point}_y", "u": f"velocity_{point}_x", "v": f"velocity_{point}_y",
    }  # fmt: skip

    def nearest(
        moved: Solver, values: Mapping[str, Array], by: Mapping[str, Array]
    ) -> tuple[Array, Array, Array]:
        curve = np.column_stack([values["x"], values["y"]])
        cells, part = ordered_places(curve, targets, wanted.constraints.order)
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

    return _Wanted(outputs, None, size, nearest)


def _placed_goal(mechanism: Mechanism, wanted: Synthesis, targets: Complex, size: float) -> _Wanted:
    """A path on which the whole mechanism is turned, scaled and shifted as it fits best."""
    check_similarity(mechanism, "[synthesis] place")
    if wanted.timing != "free":
        what = _("the zero of the drive turns with a mechanism whose place is free")
        raise InputError("[synthesis] timing", what, _('write timing = "free", or place = "given"'))
    point, closed, ordered = wanted.point, is_closed_path(wanted, targets), wanted.constraints.order
    if closed and abs(targets[0] - targets[-1]) <= 1e-9 * size:
        # a point that stands twice would be passed twice
        targets = targets[:-1]
    outputs = {
        "x": f"position_{point}_x", "y": f"position_{point}_y", "u": f"velocity_{point}_x", "v": f"velocity_{point}_y",
    }  # fmt: skip

    def curve_of(moved: Solver, values: Mapping[str, Array]) -> SampledCurve:
        pace = moved.time[1] - moved.time[0]
        return SampledCurve(values["x"] + 1j * values["y"], pace * (values["u"] + 1j * values["v"]))

    def place(moved: Solver, values: Mapping[str, Array]) -> PlacedCurve:
        return place_curve(curve_of(moved, values), targets, closed, ordered)

    def misses(
        moved: Solver, values: Mapping[str, Array], by: Mapping[str, Array]
    ) -> tuple[Array, Array, Array]:
        curve, changes = curve_of(moved, values), curve_of(moved, by)
        placed = place_curve(curve, targets, closed, ordered)
        cells, weights, _slopes = curve.weights(placed.places)
        weights = weights[:, :, None]
        change = weights[0] * changes.points[cells] + weights[1] * changes.tangents[cells]
        change = change + weights[2] * changes.points[cells + 1] + weights[3] * changes.tangents[cells + 1]
        slopes = placed.slopes(curve.at(placed.places)[0], change)
        steps = moved.parameter[1] - moved.parameter[0]
        drive = moved.parameter[0] + steps * placed.places
        return placed.project(placed.misses[:, None])[:, 0], slopes, drive

    return _Wanted(outputs, None, size, misses, place)


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

    return _Wanted({"output": output}, rows[:, 0], float(np.ptp(rows[:, 1])) or 1.0, misses)


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

    return _Wanted(outputs, None, 1.0, misses)


def _starts(search: _MechanismSearch, seed: int, stop: Callable[[], bool]) -> list[Array]:
    """Values between the bounds with which the mechanism moves, the best first; the own ones where they lie there."""
    random = np.random.default_rng(seed)
    drawn = [*random.uniform(search.low, search.high, (STARTS, len(search.low)))]
    drawn.insert(0, np.clip(np.array(search.moved.own), search.low, search.high))
    costs: list[tuple[float, int]] = []
    for index, values in enumerate(drawn):
        if stop():
            break
        cost = search.cost(values)
        if math.isfinite(cost):
            costs.append((cost, index))
    return [drawn[index] for _cost, index in sorted(costs)]


def _refine_share(
    search: _MechanismSearch, starts: Sequence[Array], stop: Callable[[], bool] = lambda: False
) -> list[tuple[float, Array]]:
    """The minima next to some starts; the first is refined in any case."""
    found: list[tuple[float, Array]] = []
    for start in starts:
        if stop() and found:
            break
        found.append(_refine(search, start))
    return found


def _refine(search: _MechanismSearch, start: Array) -> tuple[float, Array]:
    """The next minimum from a start; where constraints press against it, as sharply as they are checked."""
    cost, values = _descend(search, start, SOFT)
    if math.isfinite(cost) and search.kept.outputs:
        return _descend(search, values, SHARP)
    return cost, values


def _descend(search: _MechanismSearch, start: Array, weight: float) -> tuple[float, Array]:
    """The next minimum from a start, in units of the ranges; a step to where nothing moves is taken back."""
    low, width = search.low, search.high - search.low
    best = start
    least = math.inf
    try:
        count = len(search.steered_misses(start, weight)[0])
    except _BrokenMotion:
        return math.inf, start

    def rows(place: Array) -> Array:
        nonlocal best, least
        try:
            missed = search.steered_misses(low + width * place, weight)[0]
        except _BrokenMotion:
            return np.full(count, 1e3 * (1 + math.sqrt(least) if math.isfinite(least) else 1e3))
        cost = float((missed**2).sum())
        if cost < least:
            best, least = low + width * place, cost
        return missed

    def slopes(place: Array) -> Array:
        try:
            by: Array = search.steered_misses(low + width * place, weight)[1] * width
        except _BrokenMotion:
            return np.zeros((count, len(place)))
        return by

    inside = np.clip((start - low) / width, 1e-9, 1 - 1e-9)
    least_squares(rows, inside, slopes, bounds=(0.0, 1.0), xtol=1e-14, ftol=1e-14, gtol=1e-14, max_nfev=200)
    return least, best


def _answer(search: _MechanismSearch, values: Array) -> tuple[Answer | None, str]:
    """The answer of these values, or what it breaks."""
    wanted = search.task.synthesis
    missed, _by, drive = search.misses(values)
    try:
        mechanism = describe_moved(search.moved, dict(zip(search.names, values.tolist(), strict=True)))
        similarity = search.similarity(values)
        if similarity is not None:
            mechanism = apply_similarity(mechanism, similarity)
        data = motion(mechanism, CHECKED_PLACES)
    except CentrodeError as failure:
        return None, failure.what
    if similarity is not None:
        # the same part of the same motion, counted as the moved description counts it
        instants = np.asarray(mechanism.motion_parameter.instants(data))
        ends, own = instants[[0, -1]], search.moved.parameter[[0, -1]]
        drive = ends[0] + (drive - own[0]) * (ends[1] - ends[0]) / (own[1] - own[0])
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
        rows = np.array(wanted.rows)[: len(met)]
        errors = np.abs(met - rows[:, 0] - 1j * rows[:, 1])
        order = not _in_order(drive)
    if wanted.kind == "strokes":
        numbers = dict(_stroke_numbers(mechanism, wanted))
    transmission = least_angle(mechanism)
    broken = next(_broken(mechanism, wanted, size, transmission, branch, order), None)
    if broken is not None:
        return None, broken
    return Answer(
        mechanism,
        float(np.sqrt(np.mean(errors**2))),
        float(np.max(np.abs(errors))),
        float((errors**2).sum()),
        transmission,
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
    mechanism: Mechanism,
    wanted: Synthesis,
    size: tuple[float, float],
    transmission: float,
    branch: bool,
    order: bool,
) -> Iterator[str]:
    """Names of what an answer does not keep."""
    constraints = wanted.constraints
    if branch and (constraints.order or constraints.crank is not None):
        yield "crank" if constraints.crank is not None else "order"
    if order and constraints.order:
        yield "order"
    if constraints.transmission is not None and not transmission >= constraints.transmission - KEPT:
        yield "transmission"
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


def least_angle(mechanism: Mechanism) -> float:
    """Least transmission angle [rad] of all dyads over the whole motion; NaN where there is none."""
    try:
        least = transmission_angles(mechanism, CHECKED_PLACES).least_transmission_angle.to_numpy()
    except CentrodeError:
        return math.nan
    return float(least.min())


def _lengths(mechanism: Mechanism) -> Iterator[float]:
    for link, (first, second) in link_ends(mechanism).items():
        at = mechanism.links[link].coordinates
        yield math.dist(at[first][:2], at[second][:2])
