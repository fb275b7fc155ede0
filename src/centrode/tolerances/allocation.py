"""Allocation of tolerances: the widest limits with which outputs keep their bounds, at the least cost.

A tolerance +-t costs c/t. The least sum of c_i/t_i under sum |g_i| t_i <= T has t_i as sqrt(c_i/|g_i|), and under
sum (g_i t_i)^2 <= T^2 it has t_i as (c_i/g_i^2)^(1/3): the costs' slopes are those of the bound (Lagrange). With
several bounds, of outputs or of samples, it is a convex programme in the logarithms of t (geometric programming: Boyd
and others 2007), which is solved with exact derivatives.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TypeAlias

import numpy as np
import numpy.typing as npt
from scipy.optimize import minimize

from centrode.errors import InputError
from centrode.kinematics.preparation import ready
from centrode.locale import _
from centrode.model.examples.catalogue import MechanismSource, mechanism_of
from centrode.model.files import value_at
from centrode.model.limits_and_fits import GRADES, standard_tolerance, widest_grade
from centrode.model.mechanism import Mechanism
from centrode.model.reading import nearest, value_text
from centrode.model.tolerances import is_size, kind_of_dimension
from centrode.printed_results import PrintsSummary
from centrode.sweeps.designs import unit_of
from centrode.tolerances.deviated_mechanisms import DeviatedMechanisms
from centrode.tolerances.dimension_limits import SIGMAS, DimensionLimits, check_paths, length_paths
from centrode.tolerances.sensitivity import Outputs, named_outputs

Array: TypeAlias = npt.NDArray[np.float64]

METHODS = ("worst case", "statistical")
KINDS = ("cost", "equal", "grade")
LEAST_SENSITIVITY = 1e-9
"""Share of the greatest sensitivity below which a number does not move an output: its tolerance is not bounded."""
MOST_ROWS = 400


@dataclass(frozen=True)
class Allowance:
    """Bounds of an output to first order.

    Attributes
    ----------
    rows : (rows, paths) derivatives, one row of an output that is one number, else one a sample
    most : (rows,) deviation that is admissible [SI]
    """

    rows: Array
    most: Array


@dataclass(frozen=True, repr=False)
class Allocation(PrintsSummary):
    """Tolerances that keep outputs within their bounds.

    Attributes
    ----------
    mechanism : Mechanism
    paths : numbers that get a tolerance
    halves : (paths,) half widths [SI]: each number +- that; infinite where no output depends on it
    rounded : (paths,) the same rounded down: of lengths of links to a grade of ISO 286, of others to two digits
    grades : (paths,) the grade of each rounded tolerance, 0 where it has none
    cost : sum of c/t of the exact ones
    rounded_cost : of the rounded ones
    use : output -> share of its bound that the exact tolerances use, at the sample where it is greatest
    rounded_use : the same of the rounded ones
    method, kind : as they were requested
    """

    mechanism: Mechanism
    paths: tuple[str, ...]
    halves: Array
    rounded: Array
    grades: tuple[int, ...]
    cost: float
    rounded_cost: float
    use: Mapping[str, float]
    rounded_use: Mapping[str, float]
    method: str
    kind: str

    @property
    def values(self) -> Array:
        """Numbers of the description [SI]."""
        return np.array([value_at(self.mechanism, path) for path in self.paths])

    @property
    def units(self) -> tuple[str, ...]:
        """SI unit of each number."""
        return tuple(unit_of(self.mechanism, path) for path in self.paths)


def allocate_tolerances(
    mechanism: MechanismSource,
    bounds: Mapping[str, float | tuple[float, float]] | None = None,
    outputs: Outputs | None = None,
    by: Sequence[str] | None = None,
    method: str = "worst case",
    kind: str = "cost",
    costs: Mapping[str, float] | None = None,
    samples: int | None = None,
) -> Allocation:
    """The widest tolerances with which outputs keep their bounds, at the least cost sum(c/t).

    Parameters
    ----------
    bounds : output -> deviation to each side [SI], or (least, greatest) value
        Without them those of the description.
    outputs : name -> output, of the names in `bounds`; by default a name is the output itself, or one of the
    description by : paths that get a tolerance; all lengths by default
    method : "worst case", or "statistical": three standard deviations keep the bound
    kind : "cost" weighs by costs; "equal" gives all the same; "grade" gives all lengths of links the widest common
    grade costs : path -> c [SI of the number]; 1 by default

    Returns
    -------
    Allocation

    Raises
    ------
    InputError
        No bounds, an unknown path or output, a nominal value outside its bounds, outputs that depend on no path.

    Notes
    -----
    To first order: exact derivatives at the description. `tolerances` says what the true worst case is.

    Examples
    --------
    >>> import centrode as ct
    >>> rods = ["links.AB.length", "links.DB.length"]
    >>> found = ct.allocate_tolerances("crank-rocker", {"range(angle_DB)": 1e-3}, by=rods)
    >>> round(found.use["range(angle_DB)"], 9)
    1.0
    """
    mechanism = mechanism_of(mechanism)
    if method not in METHODS:
        raise InputError(
            "method",
            _("there is no {name} here").format(name=value_text(method)),
            nearest(str(method), METHODS),
        )
    if kind not in KINDS:
        raise InputError(
            "kind", _("there is no {name} here").format(name=value_text(kind)), nearest(str(kind), KINDS)
        )
    paths = tuple(length_paths(mechanism) if by is None else [by] if isinstance(by, str) else by)
    check_paths(mechanism, paths, "by")
    settings = mechanism.tolerances
    distribution = "normal" if settings is None else settings.distribution
    values = np.array([value_at(mechanism, path) for path in paths])
    limits = DimensionLimits(paths, values, np.zeros(len(paths)), np.zeros(len(paths)), distribution)
    texts, given = _bounded_outputs(mechanism, bounds, outputs)
    mechanisms = DeviatedMechanisms(ready(mechanism), limits, texts, samples)
    allowances = {name: _allowance(mechanisms, name, given[name]) for name in texts}
    # three standard deviations of an output from half widths of its numbers
    factor = 1.0 if method == METHODS[0] else 3.0 / SIGMAS[distribution]
    problem = _Programme(
        np.concatenate([x.rows for x in allowances.values()]),
        np.concatenate([x.most for x in allowances.values()]),
        np.array([_cost(costs, path) for path in paths]),
        method == METHODS[1],
        factor,
    )
    if not problem.bounded_numbers.any():
        raise InputError("bounds", _("the outputs depend on none of these numbers"), _("name other paths"))
    if kind == "cost":
        halves = problem.cheapest()
    elif kind == "equal":
        _require_one_kind(mechanism, paths)
        halves = problem.equal()
    else:
        halves = _graded_half_widths(mechanism, paths, problem)
    rounded, grades = _rounded_half_widths(mechanism, paths, halves)
    found = Allocation(
        mechanism, paths, halves, rounded, grades, problem.cost(halves), problem.cost(rounded), {}, {}, method, kind
    )  # fmt: skip
    use = {name: problem.use(halves, x) for name, x in allowances.items()}
    return replace(
        found, use=use, rounded_use={name: problem.use(rounded, x) for name, x in allowances.items()}
    )


def _cost(costs: Mapping[str, float] | None, path: str) -> float:
    cost = 1.0 if costs is None else float(costs.get(path, 1.0))
    if not (np.isfinite(cost) and cost > 0.0):
        raise InputError("costs", _("{key} must be positive, got {value}").format(key=path, value=cost))
    return cost


def _bounded_outputs(
    mechanism: Mechanism,
    bounds: Mapping[str, float | tuple[float, float]] | None,
    outputs: Outputs | None,
) -> tuple[dict[str, str], dict[str, float | tuple[float, float]]]:
    settings = mechanism.tolerances
    own = {} if settings is None else settings.outputs
    given = dict(bounds or {})
    if bounds is None:
        given |= {name: x.within for name, x in own.items() if x.within is not None}
        given |= {name: x.deviation for name, x in own.items() if x.deviation is not None}
    if not given:
        raise InputError(
            "bounds",
            _("no output has bounds"),
            _("give them: {example}").format(example='{"position.B.x": 1e-4}'),
        )
    named = {} if outputs is None else named_outputs(outputs)
    texts = {name: named.get(name) or (own[name].formula if name in own else name) for name in given}
    return texts, given


def _allowance(mechanisms: DeviatedMechanisms, name: str, given: float | tuple[float, float]) -> Allowance:
    nominal = np.ravel(mechanisms.nominal[name])
    rows = mechanisms.gradients[name].reshape(len(nominal), -1)
    if isinstance(given, tuple | list):
        most = np.minimum(nominal - given[0], given[1] - nominal)
    else:
        most = np.full(len(nominal), float(given))
    known = np.isfinite(rows).all(axis=1) & np.isfinite(most)
    if not known.any() or not (most[known] > 0.0).all():
        what = _("output {name} lies outside its bounds already")
        raise InputError("bounds", what.format(name=value_text(name)), _("widen them"))
    return Allowance(rows[known], most[known])


@dataclass(frozen=True)
class _Programme:
    """Least sum of costs over tolerances under bounds, in shares of the bounds.

    Attributes
    ----------
    gradients : (rows, paths)
    most : (rows,)
    costs : (paths,)
    squares : whether squares are added
    factor : of the half widths
    """

    gradients: Array
    most: Array
    costs: Array
    squares: bool
    factor: float

    @property
    def weights(self) -> Array:
        """(rows, paths) share of its bound that a number takes by a half width of one."""
        return np.asarray(np.abs(self.gradients) * self.factor / self.most[:, None])

    @property
    def bounded_numbers(self) -> npt.NDArray[np.bool_]:
        """Whether any bound depends on a number."""
        weights = self.weights
        return np.asarray(weights.max(axis=0) > LEAST_SENSITIVITY * weights.max())

    def use(self, halves: Array, allowance: Allowance) -> float:
        """Greatest share of a bound that half widths use."""
        finite = np.where(np.isfinite(halves), halves, 0.0)
        parts = np.abs(allowance.rows) * finite * self.factor
        total = np.sqrt((parts**2).sum(axis=1)) if self.squares else parts.sum(axis=1)
        return float((total / allowance.most).max())

    def total(self, halves: Array) -> Array:
        """Share of each bound that half widths use, (rows,)."""
        parts = self.weights * np.where(np.isfinite(halves), halves, 0.0)
        return np.asarray(np.sqrt((parts**2).sum(axis=1)) if self.squares else parts.sum(axis=1))

    def cost(self, halves: Array) -> float:
        """Sum of c/t."""
        return float(np.sum(self.costs / halves))

    def equal(self) -> Array:
        """The same half width for all."""
        halves = np.full(len(self.costs), 1.0 / self.total(np.ones(len(self.costs))).max())
        return np.where(self.bounded_numbers, halves, np.inf)

    def cheapest(self) -> Array:
        """Half widths at the least cost."""
        used = self.bounded_numbers
        rows = self._deciding_rows(self.weights[:, used])
        costs = self.costs[used]
        starts = [self._of_one_row(row, costs) for row in rows]
        start = np.min(starts, axis=0)
        if len(rows) > 1:
            start = self._of_many_rows(rows, costs, start)
        found = np.full(len(self.costs), np.inf)
        found[used] = start
        # within rounding of the bound, and not beyond it
        return found / max(1.0, float(self.total(found).max()))

    def _deciding_rows(self, weights: Array) -> Array:
        """Rows that no other row exceeds in all numbers."""
        order = np.argsort(-weights.sum(axis=1))
        kept: list[Array] = []
        for row in weights[order]:
            if not any((row <= other).all() for other in kept):
                kept.append(row)
            if len(kept) == MOST_ROWS:
                break
        return np.array(kept)

    def _of_one_row(self, row: Array, costs: Array) -> Array:
        """The closed form; numbers that this row does not bound are left wide."""
        used = np.where(row > 0.0, row, 1.0)
        shape = np.cbrt(costs / used**2) if self.squares else np.sqrt(costs / used)
        parts = np.where(row > 0.0, row * shape, 0.0)
        size = np.sqrt((parts**2).sum()) if self.squares else parts.sum()
        return np.asarray(np.where(row > 0.0, shape / size, np.inf))

    def _of_many_rows(self, rows: Array, costs: Array, start: Array) -> Array:
        power = 2.0 if self.squares else 1.0
        weights = rows**power
        widths = start / max(1.0, float(((weights * start**power).sum(axis=1)).max()) ** (1.0 / power))
        unit = float(np.sum(costs / widths))

        def loss(y: Array) -> tuple[float, Array]:
            parts = costs / (widths * np.exp(y)) / unit
            return float(parts.sum()), -parts

        def slack(y: Array) -> Array:
            return np.asarray(-np.log((weights * (widths * np.exp(y)) ** power).sum(axis=1)))

        def slack_slopes(y: Array) -> Array:
            parts = weights * (widths * np.exp(y)) ** power
            return np.asarray(-power * parts / parts.sum(axis=1, keepdims=True))

        found = minimize(
            loss,
            np.zeros(len(costs)),
            jac=True,
            method="SLSQP",
            constraints=[{"type": "ineq", "fun": slack, "jac": slack_slopes}],
            options={"ftol": 1e-15, "maxiter": 1000},
        )
        return np.asarray(widths * np.exp(found.x))


def _require_one_kind(mechanism: Mechanism, paths: Sequence[str]) -> None:
    kinds = {kind_of_dimension(path, mechanism.space) for path in paths}
    if len(kinds) > 1:
        what = _("lengths and angles cannot have equal tolerances")
        raise InputError("by", what, _('name numbers of one kind, or use kind="cost"'))


def _graded_half_widths(mechanism: Mechanism, paths: Sequence[str], problem: _Programme) -> Array:
    """The widest grade that all lengths of links can have, as half widths."""
    for path in paths:
        if not is_size(path, mechanism.space):
            what = _("{path} has no grade: grades are for lengths of links and radii").format(path=path)
            raise InputError("by", what, _('name lengths, or use kind="cost"'))
    sizes = [value_at(mechanism, path) for path in paths]
    for grade in range(GRADES, 0, -1):
        halves = np.array([0.5 * standard_tolerance(size, grade) for size in sizes])
        if float(problem.total(halves).max()) <= 1.0:
            return halves
    raise InputError("bounds", _("not even grade IT1 satisfies the bounds"), _('use kind="cost"'))


def _rounded_half_widths(
    mechanism: Mechanism, paths: Sequence[str], halves: Array
) -> tuple[Array, tuple[int, ...]]:
    """Half widths rounded down, and the grades of those that have one."""
    rounded, grades = halves.copy(), [0] * len(paths)
    for number, path in enumerate(paths):
        if not np.isfinite(halves[number]):
            continue
        size = value_at(mechanism, path)
        if is_size(path, mechanism.space) and size <= 3.15:
            # a grade that fits exactly may be off by rounding
            grade = widest_grade(size, 2.0 * halves[number] * (1.0 + 1e-12))
            if grade is not None:
                grades[number], rounded[number] = grade, 0.5 * standard_tolerance(size, grade)
                continue
        digits = 1 - int(np.floor(np.log10(halves[number])))
        whole = np.floor(halves[number] * 10.0**digits * (1.0 + 1e-12))
        rounded[number] = round(float(whole) * 10.0**-digits, digits)
    return rounded, tuple(grades)
