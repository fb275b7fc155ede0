"""Synthesis of any mechanism that a file describes: its free numbers, by path, function, or stroke and dwell.

What is wanted is a row of misses with exact derivatives by the free numbers, which the sweep kernels give; least
squares go from many starts between the bounds (M. A. Branch, T. F. Coleman, Y. Li, SIAM J. Sci. Comput. 21, 1999,
1-23). Crank angles that nobody gives are those of the nearest places of the curve in the order of the targets, so that
a miss is the distance along the normal, and the derivative of that place falls out.
"""

from __future__ import annotations

import cmath
import functools
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import xarray as xr
from scipy.optimize import least_squares

from centrode.analysis.transmission import transmission_angles
from centrode.errors import CentrodeError, InputError, MotionError, Status
from centrode.kinematics.motion import motion
from centrode.locale import _
from centrode.model.mechanism import Mechanism
from centrode.model.reading import nearest, value_text
from centrode.model.similarity import Similarity, apply_similarity
from centrode.model.units import read_quantity
from centrode.sweeps.designs import kind_of
from centrode.sweeps.solver import Solver, solver
from centrode.synthesis.answers import CHECKED_PLACES, Answer, Defects, SynthesisResults, box_around
from centrode.synthesis.four_bars import Array, Complex
from centrode.synthesis.improvement import describe_moved
from centrode.synthesis.measures import measure_of
from centrode.synthesis.mechanism_constraints import (
    box_output,
    broken_constraints,
    mechanism_constraints,
)
from centrode.synthesis.mechanism_goals import (
    BrokenMotion,
    Numbers,
    mechanism_goal,
    output_name,
    place_outputs,
)
from centrode.synthesis.processes import HERE, Processes
from centrode.synthesis.requests import Synthesis, SynthesisTask

STARTS = 400
"""Mechanisms between the bounds that are looked at."""
LOOKED_AT = 40
"""Of them, to say how near the nearest is where none moves."""
REFINED = 24
"""The best of them go on."""
SAMPLES = 181
FINE_SAMPLES = 1441
"""At the end, where targets lie between samples: what cubics between them leave falls with the fourth power."""
SOFT, SHARP = 30.0, 1e4
"""Weights, at first and at the end, of a constraint that is exceeded by its own size against a target that is missed by
the size of the path: what is left of it falls with the square."""
ROUGH, NEAR, EXACT = 1e-5, 1e-8, 1e-14
"""Tolerances of least squares: with soft constraints, with sharp ones, and without any or at the end."""
SHORTEST = 1e-9
"""Step after which least squares end, in units of the ranges."""
STEPS = 100
SHARE = 3
"""Starts that one process refines after the other."""
TURN = 2 * math.pi
MOST_SCALE = math.log(1e6)
"""Logarithm of the scale by which a mechanism may become larger or smaller."""
Progress: TypeAlias = Callable[[float], None]


class _MechanismSearch:
    """What is wanted of a mechanism of a file, made into misses; another process makes its own from the request.

    Its values are the free numbers, in their order. Where the place is free, and not eliminated, four more follow: the
    logarithm of the scale, the turn [rad], and the shift in sizes of the targets.
    """

    def __init__(self, task: SynthesisTask, samples: int | None = None) -> None:
        wanted, mechanism = task.synthesis, task.mechanism
        assert mechanism is not None
        self.task, self.samples = task, SAMPLES if samples is None else samples
        self.names, self.low, self.high = _ranges(mechanism, wanted)
        self.goal = mechanism_goal(mechanism, wanted)
        _check_crank(mechanism, wanted)
        self.is_placed = self.goal.begin is not None
        if self.goal.place is None and not self.is_placed:
            _narrow_pivots(mechanism, wanted, self.names, self.low, self.high)
        placed_size = self.goal.size if self.is_placed else None
        self.kept = mechanism_constraints(mechanism, wanted.constraints, placed_size)
        outputs, kept, at = dict(self.goal.outputs), dict(self.kept.outputs), self.goal.at
        if at is None:
            self.moved = solver(mechanism, self.names, self.samples, outputs={**outputs, **kept})
        else:
            self.moved = solver(mechanism, self.names, None, at=at, outputs=outputs)
        # targets with times say nothing of what is between them: constraints have the whole motion
        self.whole: Solver | None = (
            solver(mechanism, self.names, self.samples, outputs=kept) if at is not None and kept else None
        )

    def __reduce__(self) -> tuple[Any, ...]:
        return _MechanismSearch, (self.task, self.samples)

    @property
    def units(self) -> tuple[Array, Array, Array, Array]:
        """Zeros and units of the values, and their least and greatest in these units."""
        low, width = self.low, self.high - self.low
        least, greatest = np.zeros(len(low)), np.ones(len(low))
        if self.is_placed:
            low, width = np.append(low, np.zeros(4)), np.append(width, np.ones(4))
            # a scale beyond would let a mechanism shrink to a point or its parts grow without end
            least = np.append(least, [-MOST_SCALE, -np.inf, -np.inf, -np.inf])
            greatest = np.append(greatest, [MOST_SCALE, np.inf, np.inf, np.inf])
        return low, width, least, greatest

    def begin(self, values: Array) -> Array:
        """Free numbers with the place from which to go on; raises BrokenMotion."""
        if self.goal.begin is None:
            return values
        numbers, _none = _without_slopes(self.moved, values)
        first = self.goal.begin(self.moved, numbers)
        shift = first.shift / self.goal.size
        scale = float(np.clip(math.log(first.scale), -MOST_SCALE, MOST_SCALE))
        return np.append(values, [scale, first.turn, shift.real, shift.imag])

    def similarity(self, values: Array) -> Similarity | None:
        """What brings the mechanism of these values to its targets; None where its place is given."""
        if self.is_placed:
            scale, turn, x, y = values[len(self.names) :].tolist()
            return Similarity(cmath.exp(complex(scale, turn)), self.goal.size * complex(x, y))
        if self.goal.place is None:
            return None
        numbers, _none = _without_slopes(self.moved, values)
        return self.goal.place(self.moved, numbers).similarity

    def misses(self, values: Array) -> tuple[Array, Array, Array]:
        """Misses of the targets alone, their derivatives, values of the drive at the targets; raises BrokenMotion."""
        return self.goal.misses(self.moved, *self._numbers(self.moved, values))

    def steered_misses(self, values: Array, weight: float = SOFT) -> tuple[Array, Array]:
        """Misses of the targets, then of the constraints, with their derivatives; raises BrokenMotion."""
        numbers, slopes = self._numbers(self.moved, values)
        missed, by, _drive = self.goal.misses(self.moved, numbers, slopes)
        if self.whole is not None:
            numbers, slopes = self._numbers(self.whole, values)
        exceeded, exceeded_by = self.kept.misses(numbers, slopes, len(values))
        size = weight * self.goal.size
        return np.concatenate([missed, size * exceeded]), np.concatenate([by, size * exceeded_by])

    def cost(self, values: Array) -> float:
        """Sum of squares of what a start misses; infinite where it does not move."""
        try:
            numbers, none = self._place(values, *_without_slopes(self.moved, values[: len(self.names)]))
            missed, _by, _drive = self.goal.misses(self.moved, numbers, none)
            if self.whole is not None:
                numbers, none = self._place(values, *_without_slopes(self.whole, values[: len(self.names)]))
        except (BrokenMotion, ZeroDivisionError):
            return math.inf
        exceeded, _slopes = self.kept.misses(numbers, none, len(values))
        cost = float((missed**2).sum() + (SOFT * self.goal.size) ** 2 * (exceeded**2).sum())
        return cost if math.isfinite(cost) else math.inf

    def _numbers(self, moved: Solver, values: Array) -> tuple[Numbers, Numbers]:
        """Outputs and their derivatives, where the mechanism stands; raises BrokenMotion."""
        own = values[: len(self.names)]
        numbers, slopes = np.asarray(moved.outputs(own)), moved.gradient(own)
        if not (np.isfinite(numbers).all() and np.isfinite(slopes).all()):
            raise BrokenMotion
        return self._place(values, moved.split(numbers), moved.split(slopes))

    def _place(self, values: Array, numbers: Numbers, slopes: Numbers) -> tuple[Numbers, Numbers]:
        similarity = self.similarity(values) if self.is_placed else None
        if similarity is None:
            return numbers, slopes
        points = [(box_output(point, "x"), box_output(point, "y")) for point in self.kept.points]
        return place_outputs(numbers, slopes, similarity, self.goal.size, [("x", "y"), *points])


def _without_slopes(moved: Solver, values: Array) -> tuple[Numbers, Numbers]:
    """Outputs, and zeros in place of their derivatives, which take most of the time; raises BrokenMotion."""
    numbers = np.asarray(moved.outputs(values))
    if not np.isfinite(numbers).all():
        raise BrokenMotion
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
        repair = _(
            "the nearest does over {share:.0f} % of its motion; choose other ranges, or another start of the drive"
        )
        raise MotionError("[synthesis.free]", what, repair.format(share=100 * _moving_share(search)))
    progress(0.3)
    shares = [starts[k : k + SHARE] for k in range(0, min(len(starts), REFINED), SHARE)]
    fitted: dict[int, list[tuple[float, Array]]] = {}
    work = functools.partial(_refine_share, search)
    for index, share in processes.compute(work, shares, lambda: stop() and bool(fitted)):
        fitted[index] = share
        progress(0.3 + 0.6 * len(fitted) / len(shares))
    found = [one for index in sorted(fitted) for one in fitted[index]]
    found.sort(key=lambda one: one[0])
    fine = _MechanismSearch(task, FINE_SAMPLES) if search.goal.by_samples else search
    answers, broken = _distinct_answers(fine, found)
    progress(1.0)
    if not answers:
        what = _("no mechanism that was found keeps everything that is required")
        best = broken[0] if broken else ""
        raise MotionError("[synthesis.constraints]", what, best)
    targets = np.empty(0, dtype=np.complex128)
    if wanted.kind in ("path", "motion"):
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
    width = search.units[1]
    for _cost, values in found:
        if any(np.abs((values - other) / width).max() < 1e-4 for other in seen):
            continue
        seen.append(values)
        if search.goal.by_samples:
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


def _check_crank(mechanism: Mechanism, wanted: Synthesis) -> None:
    """Raise InputError where the link that shall turn fully is not driven."""
    crank = wanted.constraints.crank
    driven = [drive.link for drive in mechanism.drives if drive.link is not None]
    if crank is not None and crank not in driven:
        what = _("no drive turns the link {name}").format(name=value_text(crank))
        raise InputError("[synthesis.constraints] crank", what, nearest(crank, driven))


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
            equal = _("give two different numbers, or write the number into the mechanism")
            raise InputError(where, what, equal if low == high else _("exchange them"))
        names.append(path)
        ends.append((low, high))
    low_ends, high_ends = np.array(ends).T
    return names, low_ends, high_ends


def _starts(search: _MechanismSearch, seed: int, stop: Callable[[], bool]) -> list[Array]:
    """Values between the bounds with which the mechanism moves, the best first; the own ones where they lie there."""
    random = np.random.default_rng(seed)
    drawn = [*random.uniform(search.low, search.high, (STARTS, len(search.low)))]
    drawn.insert(0, np.clip(np.array(search.moved.own), search.low, search.high))
    costs: list[tuple[float, int, Array]] = []
    for index, values in enumerate(drawn):
        if stop():
            break
        try:
            begun = search.begin(values)
        except BrokenMotion:
            continue
        cost = search.cost(begun)
        if math.isfinite(cost):
            costs.append((cost, index, begun))
    return [begun for _cost, _index, begun in sorted(costs, key=lambda one: one[:2])]


def _moving_share(search: _MechanismSearch) -> float:
    """The greatest part of its motion over which one of the first starts moves."""
    best = 0.0
    for values in np.random.default_rng(search.task.synthesis.seed).uniform(
        search.low, search.high, (LOOKED_AT, len(search.low))
    ):
        try:
            named = dict(zip(search.names, values.tolist(), strict=True))
            status = motion(describe_moved(search.moved, named), SAMPLES).status.to_numpy()
        except CentrodeError:
            continue
        best = max(best, float((status == int(Status.OK)).mean()))
    return best


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
    if not search.kept.outputs:
        return _descend(search, start, SOFT, NEAR if search.goal.by_samples else EXACT)
    cost, values = _descend(search, start, SOFT, ROUGH)
    return _descend(search, values, SHARP, NEAR) if math.isfinite(cost) else (cost, values)


def _descend(
    search: _MechanismSearch, start: Array, weight: float, tolerance: float = EXACT
) -> tuple[float, Array]:
    """The next minimum from a start, in units of the ranges; a step to where nothing moves is taken back."""
    low, width, least_place, greatest_place = search.units
    best = start
    least = math.inf
    # the solver asks for misses and for slopes at the same place
    last: tuple[bytes, tuple[Array, Array]] | None = None

    def at(place: Array) -> tuple[Array, Array]:
        nonlocal last
        if last is None or last[0] != place.tobytes():
            last = place.tobytes(), search.steered_misses(low + width * place, weight)
        return last[1]

    inside = np.clip((start - low) / width, least_place + 1e-9, greatest_place - 1e-9)
    try:
        count = len(at(inside)[0])
    except BrokenMotion:
        return math.inf, start

    def rows(place: Array) -> Array:
        nonlocal best, least
        try:
            missed = at(place)[0]
        except BrokenMotion:
            return np.full(count, 1e3 * (1 + math.sqrt(least) if math.isfinite(least) else 1e3))
        cost = float((missed**2).sum())
        if cost < least:
            best, least = low + width * place, cost
        return missed

    def slopes(place: Array) -> Array:
        try:
            by: Array = at(place)[1] * width
        except BrokenMotion:
            return np.zeros((count, len(place)))
        return by

    bounds = (least_place, greatest_place)
    # next to a minimum a step is the square of the one before; next to where a mechanism stops smaller ones say nothing
    ends = {"xtol": max(tolerance, SHORTEST), "ftol": tolerance, "gtol": EXACT}
    least_squares(rows, inside, slopes, bounds=bounds, max_nfev=STEPS, **ends)
    return least, best


def _answer(search: _MechanismSearch, values: Array) -> tuple[Answer | None, str]:
    """The answer of these values, or what it breaks and by how much."""
    wanted = search.task.synthesis
    missed, _by, drive = search.misses(values)
    try:
        mechanism = describe_moved(search.moved, dict(zip(search.names, values.tolist(), strict=False)))
        similarity = search.similarity(values)
        if similarity is not None:
            mechanism = apply_similarity(mechanism, similarity)
        data = motion(mechanism, CHECKED_PLACES)
        instants = np.asarray(mechanism.motion_parameter.instants(data))
        if similarity is not None:
            # the same part of the same motion, counted as the moved description counts it
            ends, own = instants[[0, -1]], search.moved.parameter[[0, -1]]
            drive = ends[0] + (drive - own[0]) * (ends[1] - ends[0]) / (own[1] - own[0])
        traced = _trace(mechanism, wanted, drive, data) if wanted.kind in ("path", "motion") else None
    except CentrodeError as failure:
        return None, failure.what
    branch = bool((data.status.to_numpy() != int(Status.OK)).any())
    # a motion over less than a turn proves no crank
    branch |= wanted.constraints.crank is not None and float(np.ptp(instants)) < TURN * (1 - 1e-9)
    transmission = least_angle(mechanism)
    size = box_around(mechanism, data.position.to_numpy())
    errors = missed if traced is None else traced.errors
    order = traced is not None and not _in_order(drive)
    numbers = {} if traced is None else dict(traced.numbers)
    if wanted.kind == "strokes":
        numbers = dict(_stroke_numbers(mechanism, wanted))
    error = float(np.sqrt(np.mean(errors**2)))
    broken = next(broken_constraints(mechanism, wanted.constraints, size, transmission, branch, order), None)
    if broken is not None:
        return None, broken.sentence(error if traced is not None else None)
    return Answer(
        mechanism,
        error,
        float(np.max(np.abs(errors))),
        float((errors**2).sum()),
        transmission,
        size,
        Defects(order, branch, False),
        traced.curve if traced is not None else np.empty(0, dtype=np.complex128),
        traced.met if traced is not None else np.empty(0, dtype=np.complex128),
        drive,
        (),
        missed if wanted.kind == "function" else None,
        numbers,
        traced.links if traced is not None else (),
    ), ""


@dataclass(frozen=True)
class _Trace:
    """What the engine makes of an answer: the curve of its point, where it is at the targets, and links there.

    Attributes
    ----------
    errors : (targets) distances [m]
    links : lines through the points of each link at the first target
    """

    curve: Complex
    met: Complex
    errors: Array
    numbers: Mapping[str, tuple[float, str]]
    links: tuple[Complex, ...]


def _trace(mechanism: Mechanism, wanted: Synthesis, drive: Array, data: xr.Dataset) -> _Trace:
    at_targets = motion(mechanism, at=list(drive))
    met = _planar(at_targets.position.sel(point=wanted.point).to_numpy())
    rows = np.array(wanted.rows)[: len(met)]
    numbers = {}
    if wanted.kind == "motion":
        turned = at_targets.angle.sel(link=wanted.link).to_numpy() - rows[:, 2]
        numbers["turn_error"] = (float(np.abs(np.angle(np.exp(1j * turned))).max()), "rad")
    first = at_targets.position.isel(sample=0)
    places = dict(zip(first.point.to_numpy().tolist(), _planar(first.to_numpy()).tolist(), strict=True))
    links = [[places[point] for point in link.points if point in places] for link in mechanism.links.values()]
    return _Trace(
        _planar(data.position.sel(point=wanted.point).to_numpy()),
        met,
        np.abs(met - rows[:, 0] - 1j * rows[:, 1]),
        numbers,
        tuple(np.array(link) for link in links if len(link) > 1),
    )


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
    output = output_name(mechanism, wanted)
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


def least_angle(mechanism: Mechanism) -> float:
    """Least transmission angle [rad] of all dyads over the whole motion; NaN where there is none."""
    try:
        least = transmission_angles(mechanism, CHECKED_PLACES).least_transmission_angle.to_numpy()
    except CentrodeError:
        return math.nan
    return float(least.min())
