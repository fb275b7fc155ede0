"""Local improvement: a mechanism whose dimensions change a little until one number of its motion is least.

The number and those that are kept are measures of one solver, which gives them with exact derivatives. Steps are found
by sequential quadratic programming (D. Kraft, DFVLR-FB 88-28, 1988) in a box around the dimensions reached so far: it
grows where a step helps, and shrinks where one does not, or where the mechanism no longer assembles.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal, TypeAlias

import numpy as np
from scipy.optimize import minimize

from centrode.errors import CentrodeError, InputError, MotionError, Status
from centrode.kinematics.motion import motion
from centrode.locale import _
from centrode.model.examples.catalogue import MechanismSource, mechanism_of
from centrode.model.files import value_at, with_values
from centrode.model.mechanism import Mechanism
from centrode.model.reading import value_text
from centrode.model.units import read_quantity
from centrode.printed_results import PrintsSummary
from centrode.sweeps.designs import kind_of, unit_of
from centrode.sweeps.solver import Solver, solver
from centrode.synthesis.measures import Array, Measure, measure_of

Bounds: TypeAlias = Sequence[float | str | None]
Aim: TypeAlias = Literal["least", "greatest"]
SAMPLES = 181
PROOF = 4
"""Times as many samples have to hold what is kept."""
ROUNDS = 60
FIRST_BOX, LEAST_BOX, GREATEST_BOX = 0.2, 1e-7, 0.5
"""Half widths of the box around the dimensions reached, in units of their ranges."""
KEPT = 1e-6
"""What is kept may be missed by this part of its size."""
PROVED_KEPT = 1e-3
"""And by this part between the samples of the search."""


@dataclass(frozen=True)
class KeptNumber:
    """A number that stays between bounds; an open end is infinite.

    Attributes
    ----------
    text : the measure
    low, high : in SI
    before, after : its values
    unit : SI unit, empty where a formula leaves it open
    """

    text: str
    low: float
    high: float
    before: float
    after: float
    unit: str = ""


@dataclass(frozen=True)
class FreeNumber:
    """A dimension that was free.

    Attributes
    ----------
    path : of the dimension
    unit : SI unit
    low, high, before, after : in it
    """

    path: str
    unit: str
    low: float
    high: float
    before: float
    after: float

    @property
    def at_bound(self) -> bool:
        """Whether a wider range would help."""
        near = 1e-6 * (self.high - self.low)
        return self.after <= self.low + near or self.after >= self.high - near


@dataclass(frozen=True, repr=False)
class Improvement(PrintsSummary):
    """A mechanism that does better, and what has changed.

    Attributes
    ----------
    mechanism : the improved one, proved by a motion at four times as many samples as the search has
    original : the one that was given
    objective : the measure
    aim : "least" or "greatest"
    before, after : its value
    unit : SI unit, empty where a formula leaves it open
    free : dimensions, as FreeNumber
    kept : what had to stay within bounds, as KeptNumber
    evaluations : motions that the search computed
    complete : False where it was stopped before its end
    """

    mechanism: Mechanism
    original: Mechanism = field(repr=False)
    objective: str
    aim: Aim
    before: float
    after: float
    unit: str
    free: tuple[FreeNumber, ...]
    kept: tuple[KeptNumber, ...]
    evaluations: int
    complete: bool = True


class _OpenMotion(Exception):
    """The mechanism does not assemble all along its motion."""


class _ImprovementSearch:
    """Measures of a solver in units in which each range is one."""

    def __init__(self, moved: Solver, measures: Sequence[Measure], low: Array, high: Array) -> None:
        self.moved, self.measures = moved, measures
        self.low, self.width = low, high - low
        self.evaluations = 0
        self._last: tuple[bytes, Array, Array] | None = None

    def values_at(self, place: Array) -> tuple[Array, Array]:
        """All measures (m,), and their derivatives (m, free) by the place; raises _Open."""
        key = place.tobytes()
        if self._last is not None and self._last[0] == key:
            return self._last[1], self._last[2]
        self.evaluations += 1
        given = self.low + self.width * place
        values = self.moved.split(np.asarray(self.moved.outputs(given)))
        slopes = self.moved.split(self.moved.gradient(given))
        results = [
            one.compute(self.moved.parameter, self.moved.time, values, slopes) for one in self.measures
        ]
        numbers = np.array([value for value, _slope in results])
        by = np.stack([slope for _value, slope in results]) * self.width
        if not (np.isfinite(numbers).all() and np.isfinite(by).all()):
            raise _OpenMotion
        self._last = key, numbers, by
        return numbers, by


def improve(
    mechanism: MechanismSource,
    objective: str,
    free: Mapping[str, Bounds],
    constraints: Mapping[str, Bounds] | None = None,
    *,
    aim: Aim = "least",
    samples: int | None = None,
    progress: Callable[[float], None] = lambda share: None,
    stop: Callable[[], bool] = lambda: False,
) -> Improvement:
    """A mechanism of changed dimensions whose objective is locally least, or greatest.

    Parameters
    ----------
    objective : measure
        A formula of the motion as those of `solver`, "max(abs(velocity_H_x))", or one of "stroke(slide_H)",
        "time_ratio(slide_H)", "dwell(slide_H, 90 deg, 150 deg)" (how far it moves meanwhile), "reaction(B/AB)" (the
        greatest), "shaking_force" (the greatest), "unevenness" (of a machine).
    free : path -> (least, greatest)
        Dimensions that may change, in SI or as texts with a unit.
    constraints : measure -> (least, greatest)
        Numbers that are kept within bounds [SI]; None leaves an end open.
    aim : "least" or "greatest"
    samples : of the whole motion in the search, by default 181
    progress : called with the share that is done
    stop : once it is true the search ends with what there is

    Returns
    -------
    Improvement
        Proved by a motion at four times as many samples.

    Raises
    ------
    InputError
        An unknown path or measure, an empty range, a mechanism that does not move all along.
    MotionError
        Nothing better was found, or what was found does not hold between the samples.

    Examples
    --------
    >>> import centrode as ct
    >>> better = ct.improve("crank-rocker", "stroke(angle_DB)", {"links.AB.length": ["3.4 m", "3.6 m"]}, samples=37)
    >>> bool(better.after < better.before)
    True
    """
    mechanism = mechanism_of(mechanism)
    samples = SAMPLES if samples is None else samples
    if aim not in ("least", "greatest"):
        raise InputError("aim", _("expected one of {names}").format(names="least, greatest"))
    names, low, high = _free_ranges(mechanism, free)
    measures, limits, wheres = _measures_and_limits(mechanism, objective, constraints or {})
    outputs = {name: formula for one in measures for name, formula in one.outputs.items()}
    moved = _solver_of_measures(mechanism, names, samples, outputs, wheres)
    search = _ImprovementSearch(moved, measures, low, high)
    own = np.array(moved.own)
    before = _numbers_at_start(search, own)
    # bounds are those of a search within the ranges: dimensions outside begin at the nearer end
    start = np.clip((own - low) / (high - low), 0.0, 1.0)
    sign = 1.0 if aim == "least" else -1.0
    place = _descend(search, start, sign, limits, progress, stop)
    after = search.values_at(place)[0]
    if not _is_better(sign, limits, before, after):
        what = _("no dimensions within the ranges are better")
        raise MotionError("objective", what, _("widen a range, free more dimensions, or loosen what is kept"))
    chosen = low + (high - low) * place
    improved = describe_moved(moved, dict(zip(names, chosen.tolist(), strict=True)))
    fine = PROOF * (samples - 1) + 1
    before = _measure(solver(mechanism, names, fine, outputs=outputs), measures)
    proved = _prove(improved, names, outputs, measures, limits, fine)
    return Improvement(
        improved,
        mechanism,
        objective.strip(),
        aim,
        float(before[0]),
        float(proved[0]),
        measures[0].unit,
        tuple(
            FreeNumber(path, unit_of(mechanism, path), *map(float, numbers))
            for path, *numbers in zip(names, low, high, own, chosen, strict=True)
        ),
        tuple(
            KeptNumber(one.text, *bounds, float(old), float(new), one.unit)
            for one, bounds, old, new in zip(measures[1:], limits, before[1:], proved[1:], strict=True)
        ),
        search.evaluations,
        not stop(),
    )


def _measures_and_limits(
    mechanism: Mechanism, objective: str, constraints: Mapping[str, Bounds]
) -> tuple[list[Measure], list[tuple[float, float]], list[str]]:
    """Measures of the objective and of the numbers that are kept, limits of the latter, and where each was given."""
    texts = [objective, *constraints]
    wheres = ["objective", *(f"constraints {text}" for text in constraints)]
    measures = [
        measure_of(mechanism, text, where, number)
        for number, (text, where) in enumerate(zip(texts, wheres, strict=True))
    ]
    limits = [
        _limits(bounds, one, where)
        for one, where, bounds in zip(measures[1:], wheres[1:], constraints.values(), strict=True)
    ]
    return measures, limits, wheres


def _solver_of_measures(
    mechanism: Mechanism,
    names: Sequence[str],
    samples: int,
    outputs: Mapping[str, str],
    wheres: Sequence[str],
) -> Solver:
    """The solver of what measures need; InputError names the measure as it was given."""
    try:
        return solver(mechanism, names, samples, outputs=outputs)
    except InputError as error:
        # what the solver calls measure_2 is the second of the numbers that are kept
        which, _between, _rest = error.where.removeprefix("outputs measure_").partition("_")
        if not error.where.startswith("outputs measure_") or not which.isdigit():
            raise
        raise InputError(wheres[int(which)], error.what, error.repair) from None


def _numbers_at_start(search: _ImprovementSearch, own: Array) -> Array:
    """Numbers of the mechanism as it is; InputError where it has none."""
    try:
        return search.values_at((own - search.low) / search.width)[0]
    except _OpenMotion:
        what = _("the mechanism does not move through its whole range, or a number has no value there")
        raise InputError("mechanism", what, _("choose dimensions with which it moves")) from None


def _free_ranges(mechanism: Mechanism, free: object) -> tuple[list[str], Array, Array]:
    if not isinstance(free, Mapping) or not free:
        what = _("no dimension is free")
        raise InputError("free", what, _('give ranges, as {"links.AB.length": ["3.4 m", "3.6 m"]}'))
    names, ends = [], []
    for path, given in free.items():
        where = f"free {path}"
        kind = kind_of(mechanism, str(path))
        low, high = _pair(given, kind, where)
        if not (math.isfinite(low) and math.isfinite(high) and low < high):
            what = _("the range goes from {low:g} to {high:g}").format(low=low, high=high)
            raise InputError(where, what, _("give [least, greatest]"))
        names.append(str(path))
        ends.append((low, high))
    low_ends, high_ends = np.array(ends).T
    own = np.array([value_at(mechanism, path) for path in names])
    outside = np.flatnonzero((own < low_ends) | (own > high_ends))
    if len(outside):
        k = int(outside[0])
        what = _("the own value {own:g} lies outside {low:g} to {high:g}")
        what = what.format(own=own[k], low=low_ends[k], high=high_ends[k])
        raise InputError(f"free {names[k]}", what, _("widen the range: improvement begins there"))
    return names, low_ends, high_ends


def _pair(given: object, kind: str, where: str) -> tuple[float, float]:
    """Two numbers of a kind; None is an open end."""
    if isinstance(given, str) or not isinstance(given, Iterable):
        raise InputError(where, _("expected [least, greatest], got {value}").format(value=value_text(given)))
    ends: list[Any] = list(given)
    if len(ends) != 2:
        raise InputError(where, _("expected [least, greatest], got {value}").format(value=value_text(given)))
    opened = (-math.inf, math.inf)
    low, high = (
        default if end is None else float(read_quantity(end, kind, where))
        for end, default in zip(ends, opened, strict=True)
    )
    return low, high


KINDS = {"rad": "angle", "m": "length", "N": "force"}


def _limits(given: object, measure: Measure, where: str) -> tuple[float, float]:
    low, high = _pair(given, KINDS.get(measure.unit, "ratio"), where)
    if not low <= high or (low == -math.inf and high == math.inf):
        what = _("the range goes from {low:g} to {high:g}").format(low=low, high=high)
        raise InputError(where, what, _("give [least, greatest]"))
    return low, high


def _violation(limits: Sequence[tuple[float, float]], numbers: Array) -> float:
    """Greatest miss of what is kept, in units of its bounds."""
    worst = 0.0
    for (low, high), value in zip(limits, numbers[1:], strict=True):
        size = max(abs(x) for x in (low, high) if math.isfinite(x)) or 1.0
        worst = max(worst, (low - value) / size, (value - high) / size)
    return worst


def _is_better(sign: float, limits: Sequence[tuple[float, float]], old: Array, new: Array) -> bool:
    """Whether numbers keep more, or keep all and have a better objective."""
    before, after = _violation(limits, old), _violation(limits, new)
    if max(before, after) > KEPT:
        return after < before * (1 - 1e-6)
    return bool(sign * new[0] < sign * old[0])


def _descend(
    search: _ImprovementSearch,
    place: Array,
    sign: float,
    limits: Sequence[tuple[float, float]],
    progress: Callable[[float], None],
    stop: Callable[[], bool],
) -> Array:
    """The place from which no box leads farther."""
    best = search.values_at(place)[0]
    scale = abs(best[0]) or 1.0
    rows = []
    for number, (low, high) in enumerate(limits, 1):
        size = max(abs(x) for x in (low, high) if math.isfinite(x)) or 1.0
        for end, side in ((low, 1.0), (high, -1.0)):
            if math.isfinite(end):
                rows.append(
                    {
                        "type": "ineq",
                        "fun": lambda x, n=number, e=end, s=side, z=size: s * (search.values_at(x)[0][n] - e) / z,
                        "jac": lambda x, n=number, s=side, z=size: s * search.values_at(x)[1][n] / z,
                    }
                )  # fmt: skip
    half = FIRST_BOX
    for count in range(ROUNDS):
        if stop() or half < LEAST_BOX:
            break
        box = np.column_stack([np.maximum(place - half, 0.0), np.minimum(place + half, 1.0)])
        proposed = None
        try:
            solved = minimize(
                lambda x: sign * search.values_at(x)[0][0] / scale,
                place,
                jac=lambda x: sign * search.values_at(x)[1][0] / scale,
                bounds=box,
                constraints=rows,
                method="SLSQP",
                options={"maxiter": 40, "ftol": 1e-12},
            )
            proposed = np.clip(solved.x, box[:, 0], box[:, 1])
            numbers = search.values_at(proposed)[0]
        except _OpenMotion:
            proposed = None
        if proposed is not None and _is_better(sign, limits, best, numbers):
            small = abs(numbers[0] - best[0]) < 1e-10 * scale and _violation(limits, best) <= KEPT
            place, best = proposed, numbers
            half = half / 4 if small else min(2 * half, GREATEST_BOX)
        else:
            half /= 4
        progress((count + 1) / ROUNDS)
    progress(1.0)
    return place


def describe_moved(moved: Solver, values: Mapping[str, float]) -> Mechanism:
    """The description with these numbers, its estimates of angles put to where the links are then.

    The angle of a guided link and of the one that guides it, and that of a driven link, is a dimension, and stays.
    """
    mechanism = moved.mechanism
    if mechanism.space == "plane":
        guided = [guide for guide in mechanism.guides if guide.link is not None]
        fixed = {guide.link for guide in guided} | {guide.on for guide in guided}
        fixed |= {drive.link for drive in mechanism.drives}
        stands = moved.move(list(values.values())).angle[0].tolist()
        names = motion(mechanism, 3).link.to_numpy().tolist()
        angles = {
            f"links.{name}.angle": angle
            for name, angle in zip(names, stands, strict=True)
            if name not in fixed and mechanism.links[name].angle is not None
        }
        values = {**angles, **values}
    return with_values(mechanism, values)


def _measure(moved: Solver, measures: Sequence[Measure]) -> Array:
    """The measures at a solver's own numbers."""
    numbers = np.asarray(moved.outputs(moved.own))
    values, none = moved.split(numbers), moved.split(np.zeros((*numbers.shape, len(moved.free))))
    return np.array([one.compute(moved.parameter, moved.time, values, none)[0] for one in measures])


def _prove(
    improved: Mechanism,
    names: Sequence[str],
    outputs: Mapping[str, str],
    measures: Sequence[Measure],
    limits: Sequence[tuple[float, float]],
    samples: int,
) -> Array:
    """Measures of the improved mechanism at more samples; raises MotionError where it does not hold there."""
    what = _("the best that was found does not hold between the samples")
    repair = _("give more samples, or narrow the ranges")
    try:
        status = motion(improved, samples).status.to_numpy()
        proved = _measure(solver(improved, names, samples, outputs=outputs), measures)
    except CentrodeError as failure:
        raise MotionError("objective", what, failure.what) from None
    moves = bool((status == int(Status.OK)).all())
    if not moves or not np.isfinite(proved).all() or _violation(limits, proved) > PROVED_KEPT:
        raise MotionError("objective", what, repair)
    return proved
