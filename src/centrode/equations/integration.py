"""The motion of a mechanism by integration of its differential equations, beside the motion in closed form."""

from __future__ import annotations

import functools
import importlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Protocol, TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.equations.chain_assembly import assemble_chains
from centrode.equations.derivation import equations
from centrode.equations.linear import LinearSystem, Unknown, UnknownPlace, system_of
from centrode.equations.symbols import Letter, Sum, Wave
from centrode.errors import InputError, Status
from centrode.kinematics.motion import (
    attributes_of,
    coordinates_of,
    dataset_of,
    judgements_of,
    labels_of,
    motion,
    vocabulary_variable,
)
from centrode.kinematics.path import DrivenBy
from centrode.kinematics.preparation import Ready, ready
from centrode.kinematics.sample_index import selectable
from centrode.kinematics.solve import Solved, requested_grid, solve
from centrode.locale import _
from centrode.model.examples.catalogue import MechanismSource, mechanism_of
from centrode.model.mechanism import FRAME, Mechanism
from centrode.model.reading import nearest, value_text
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.jets import Jet, JetFunctions
from centrode.numerics.search import bisect
from centrode.structure.dimensions import Dimensions

# Integration of equations in Cauchy form: fixed steps of the classical Runge-Kutta method, or adaptive ones.
#
# It knows nothing of closed forms: how far the motion goes is judged by the equations alone.

Array: TypeAlias = npt.NDArray[np.float64]

# slower to import than NumPy, and needed by nothing else
_scipy = functools.partial(importlib.import_module, "scipy.integrate")

FINE = 1e-10
"""Tolerance of the adaptive method with which a fixed step is judged."""
MOST_ADAPTIVE_STEPS = 20_000
"""Adaptive steps after which an integration is refused."""
FAR = 1e6
"""Change of an unknown, in its own measure, beyond which it goes to infinity: steps would become ever smaller there."""
NEAR_POLE = 1e-3
"""Part of the range within which a pole is expected from there."""
LONGEST = 1 / 24
"""Longest adaptive step as a part of the range: a determinant that is zero twice in one step would not be seen."""
NUDGE = 1e-6
"""Step of the differences that form the Jacobian of the constraints [rad, and parts of the greatest length]."""
LOST = 0.01
"""Drift, as a part of the greatest length or in radians, beyond which a state is no position of the mechanism."""


class CauchyEquations(Protocol):
    """What is integrated: equations in Cauchy form with the constraints they were derived from.

    Times are numbers or (...), states (..., unknowns): many states are computed at once.
    """

    @property
    def initial(self) -> Array:
        """The state at t = 0 [rad, and m for slides]."""
        ...

    @property
    def sizes(self) -> Array:
        """What a great change of each unknown is: 1 for an angle, the greatest length for a slide."""
        ...

    def rates(self, time: Any, state: Array) -> Array:
        """Derivatives of the state by time."""
        ...

    def constraints(self, time: Any, state: Array) -> Array:
        """Left sides less constants, lengths over the greatest length: zero on the motion."""
        ...


@dataclass(frozen=True)
class CauchySolution:
    """States at the times asked for, NaN where the integration does not get.

    Attributes
    ----------
    state, rates : (n, unknowns)
    stop : float or None
        Time at which the determinant is zero: there the equations define no rates [s].
    lost : float or None
        Time of the first row that fixed steps carried away from the mechanism [s].
    steps : int
        Steps taken.
    """

    state: Array
    rates: Array
    stop: float | None
    lost: float | None
    steps: int


def fixed_steps(
    equations: CauchyEquations, times: Array, judge: CauchySolution | None = None
) -> CauchySolution:
    """Classical fourth-order Runge-Kutta, one step from each time to the next.

    An adaptive integration, `judge` where it is known, goes before it and tells where the determinant is zero; rows
    behind that are left out, and so are those after a row with another sign of the determinant or with a drift of
    more than `LOST`.
    """
    stop = _adaptive_states(equations, times, FINE).stop if judge is None else judge.stop
    state = np.full((len(times), len(equations.initial)), np.nan)
    state[0] = equations.initial
    with np.errstate(all="ignore"):
        for row, (time, step) in enumerate(zip(times[:-1], np.diff(times), strict=True)):
            state[row + 1] = _runge_kutta(equations, float(time), float(step), state[row])
    beyond = _beyond(times, stop)
    lost = _lost(equations, times, state, beyond)
    if lost is not None:
        beyond |= np.arange(len(times)) >= lost
    state[beyond] = np.nan
    when = None if lost is None else float(times[lost])
    return CauchySolution(state, _rates(equations, times, state), stop, when, len(times) - 1)


def adaptive_steps(equations: CauchyEquations, times: Array, tolerance: float) -> CauchySolution:
    """Dormand and Prince's method of eighth order with error control; rows come from its dense output."""
    found = _adaptive_states(equations, times, tolerance)
    return CauchySolution(found.state, _rates(equations, times, found.state), found.stop, None, found.steps)


def determinant(equations: CauchyEquations, time: Any, state: Array) -> Array:
    """Determinant of the Jacobian of the constraints by the unknowns (...), NaN where there are not as many of both."""
    columns = []
    for shift in NUDGE * np.diag(equations.sizes):
        ahead = np.asarray(equations.constraints(time, state + shift))
        columns.append((ahead - equations.constraints(time, state - shift)) / (2 * NUDGE))
    matrix = np.stack(columns, axis=-1)
    if matrix.shape[-1] != matrix.shape[-2]:
        return np.full(matrix.shape[:-2], np.nan)
    return np.asarray(np.linalg.det(matrix))


def _runge_kutta(equations: CauchyEquations, time: float, step: float, state: Array) -> Array:
    first = equations.rates(time, state)
    second = equations.rates(time + step / 2, state + step / 2 * first)
    third = equations.rates(time + step / 2, state + step / 2 * second)
    fourth = equations.rates(time + step, state + step * third)
    return np.asarray(state + step / 6 * (first + 2 * second + 2 * third + fourth))


@dataclass(frozen=True)
class _Followed:
    state: Array
    stop: float | None
    steps: int


def _adaptive_states(equations: CauchyEquations, times: Array, tolerance: float) -> _Followed:
    """States at the times by adaptive steps, as far as the determinant keeps its sign.

    Raises InputError where too many steps would be needed.
    """
    initial = np.asarray(equations.initial, dtype=np.float64)
    state = np.full((len(times), len(initial)), np.nan)
    first, last = float(times[0]), float(times[-1])
    state[times == first] = initial
    if first == last or not len(initial):
        return _Followed(np.broadcast_to(initial, state.shape).copy(), None, 0)
    sign = np.sign(determinant(equations, first, initial))
    with np.errstate(all="ignore"):
        if sign == 0 or not np.isfinite(equations.rates(first, initial)).all():
            return _Followed(state, first, 0)
        solver = _scipy().DOP853(
            equations.rates, first, initial, last, rtol=tolerance, atol=tolerance * equations.sizes,
            max_step=LONGEST * abs(last - first),
        )  # fmt: skip
        for steps in range(1, MOST_ADAPTIVE_STEPS + 1):
            if solver.step() is not None or not np.isfinite(solver.y).all():
                return _Followed(state, float(solver.t), steps)
            if (np.abs(solver.y - initial) > FAR * equations.sizes).any():
                return _Followed(state, _pole(equations, first, initial, solver), steps)
            course = solver.dense_output()
            crosses = sign * determinant(equations, solver.t, solver.y) < 0
            stop = _singular_time(equations, course) if crosses else None
            _fill(state, times, course, course.t if stop is None else stop)
            if stop is not None or solver.status == "finished":
                return _Followed(state, stop, steps)
    raise InputError(
        "",
        _("the integration needs more than {most} steps").format(most=MOST_ADAPTIVE_STEPS),
        _("shorten the range, or increase the tolerance"),
    )


def _fill(state: Array, times: Array, course: Any, stop: float) -> None:
    """Rows between the last step's ends, from its polynomial."""
    forward = np.sign(course.t - course.t_old)
    inside = (forward * times > forward * course.t_old) & (forward * times <= forward * stop)
    if inside.any():
        state[inside] = course(times[inside]).T


def _pole(equations: CauchyEquations, first: float, initial: Array, solver: Any) -> float:
    """Where an unknown that is very great goes to infinity: near a simple pole y/y' is what is left."""
    moved = solver.y - initial
    most = int(np.argmax(np.abs(moved) / equations.sizes))
    left = float(moved[most] / equations.rates(solver.t, solver.y)[most])
    # where it runs away otherwise than to a pole nearby, it has run away here
    return float(solver.t) + (left if abs(left) <= NEAR_POLE * abs(solver.t_bound - first) else 0.0)


def _singular_time(equations: CauchyEquations, course: Any) -> float:
    """Where the determinant changes its sign within a step, by bisection: it may be anything but smooth there."""
    low, high = np.array([course.t_old]), np.array([course.t])
    sign = np.sign(determinant(equations, float(low[0]), course(low[0])))

    def before(time: Array) -> npt.NDArray[np.bool_]:
        return np.asarray([sign * determinant(equations, float(t), course(t)) > 0 for t in time])

    return float(bisect(before, low, high)[0][0])


def _beyond(times: Array, stop: float | None) -> npt.NDArray[np.bool_]:
    if stop is None:
        return np.zeros(len(times), dtype=bool)
    return np.asarray(np.sign(times[-1] - times[0]) * (times - stop) > 0)


def _lost(
    equations: CauchyEquations, times: Array, state: Array, beyond: npt.NDArray[np.bool_]
) -> int | None:
    """First row that is no position of the mechanism any more, or one of another assembly."""
    rows = np.flatnonzero(~beyond)
    if not rows.size or not state.shape[1]:
        return None
    with np.errstate(all="ignore"):
        drift = np.abs(equations.constraints(times[rows], state[rows])).max(axis=1)
        signs = np.sign(determinant(equations, times[rows], state[rows]))
    # a row that is no number drifts by no number
    wrong = ~(drift <= LOST) | (signs * signs[0] < 0)
    return int(rows[np.argmax(wrong)]) if wrong.any() else None


def _rates(equations: CauchyEquations, times: Array, state: Array) -> Array:
    """Rates at the rows that have a state."""
    found = np.full(state.shape, np.nan)
    rows = np.isfinite(state).all(axis=1)
    if rows.any() and state.shape[1]:
        with np.errstate(all="ignore"):
            found[rows] = equations.rates(times[rows], state[rows])
    return found


# The equations of a mechanism in Cauchy normal form, as numbers: rates of its unknowns from time and state.
#
# They come from the differentiated chain equations alone, not from the closed forms of positions, so that
# what is
# integrated is a second way to the same motion.

JETS = JetFunctions(ARRAYS)


@dataclass(frozen=True)
class CauchyForm:
    """d state/dt = rates(time, state), with what the chains say of a state.

    Attributes
    ----------
    names : of the unknowns of all groups in the order of the plan: "angle.AC", "slide.C", "bearing.wheel";
        the angle of a cylinder is "angle.K-A"
    symbols : their letters, "phi2"
    initial : (n,) state at t = 0 [rad, m], angles as in the initial position, with their turns
    constraint_names : "y_C", "x_D", ..., as many as unknowns

    `time` is a number or (...), a state is (..., n): many states are computed at once.
    """

    names: tuple[str, ...]
    symbols: tuple[str, ...]
    initial: Array
    constraint_names: tuple[str, ...]
    unknowns: tuple[Unknown, ...]
    systems: tuple[LinearSystem, ...]
    residuals: tuple[Sum, ...]
    places: Mapping[str, UnknownPlace]
    constants: Mapping[Letter, float]
    drives: tuple[tuple[Letter, Letter, DrivenBy], ...]

    def rates(self, time: Any, state: npt.ArrayLike) -> Array:
        """Derivatives of the state by time [rad/s, m/s], (..., n); NaN where a group's determinant is zero."""
        values = self._values(time, state)
        waves: dict[Wave, Any] = {}  # no rate stands in a sine: they are those of all systems
        found: list[Array] = []
        for system in self.systems:
            shape = np.shape(next(iter(values.values())))
            matrix = np.array(
                [[self._number(entry, values, shape, waves) for entry in row] for row in system.matrix]
            )
            right = np.array([self._number(entry, values, shape, waves) for entry in system.right])
            if shape:
                matrix, right = np.moveaxis(matrix, (0, 1), (-2, -1)), np.moveaxis(right, 0, -1)
            solved = _solve_systems(matrix, right)
            for i, letter in enumerate(system.unknowns):
                values[letter] = solved[..., i]
                found.append(solved[..., i])
        return np.stack(found, axis=-1) if found else np.zeros((*np.shape(time), 0))

    def positions(self, time: Any, state: npt.ArrayLike) -> dict[str, Array]:
        """Places of all points by their chains [m]: name -> (..., 2)."""
        values = self._values(time, state)
        shape = np.shape(next(iter(values.values()), 0.0))
        waves: dict[Wave, Any] = {}
        return {
            name: np.stack([self._number(one, values, shape, waves) for one in (at.x, at.y)], axis=-1)
            for name, at in self.places.items()
        }

    def constraints(self, time: Any, state: npt.ArrayLike) -> Array:
        """Left sides less right sides [m, rad], (..., n): how far a state has drifted off the constraints."""
        values = self._values(time, state)
        shape = np.shape(next(iter(values.values()), 0.0))
        waves: dict[Wave, Any] = {}
        found = [self._number(one, values, shape, waves) for one in self.residuals]
        return np.stack(found, axis=-1) if found else np.zeros((*shape, 0))

    def _values(self, time: Any, state: npt.ArrayLike) -> dict[Letter, Any]:
        state = np.asarray(state, dtype=np.float64)
        values: dict[Letter, Any] = {}
        time = np.asarray(time, dtype=np.float64)
        shape = np.broadcast_shapes(time.shape, state.shape[:-1])
        for i, one in enumerate(self.unknowns):
            values[one.letter] = _spread(state[..., i], shape)
        for letter, rate, driven in self.drives:
            jet = driven.value(JETS, Jet.variable(time, 1))
            value, speed = (jet.value, jet.derivative(1)) if isinstance(jet, Jet) else (jet, 0.0)
            values[letter], values[rate] = _spread(value, shape), _spread(speed, shape)
        return values | {letter: np.float64(x) for letter, x in self.constants.items()}

    @staticmethod
    def _number(
        total: Sum, values: Mapping[Letter, Any], shape: tuple[int, ...], waves: dict[Wave, Any]
    ) -> Any:
        return _spread(total.value(np, values.__getitem__, waves), shape)


def _spread(value: Any, shape: tuple[int, ...]) -> Any:
    """A number for each state: of one state the number itself, with which NumPy is quicker than with an array of it."""
    return np.broadcast_to(value, shape).astype(np.float64) if shape else np.float64(value)


def _solve_systems(matrix: Array, right: Array) -> Array:
    """Solutions of many systems; NaN where one is singular."""
    with np.errstate(all="ignore"):
        try:
            return np.asarray(np.linalg.solve(matrix, right[..., None])[..., 0])
        except np.linalg.LinAlgError:
            if matrix.ndim == 2:
                return np.full(right.shape, np.nan)
            flat = [_solve_systems(a, b) for a, b in zip(matrix, right, strict=True)]
            return np.stack(flat)


def cauchy_form(mechanism: Mechanism) -> CauchyForm:
    """The normal form of a mechanism.

    Raises InputError on the sphere, and what `motion` raises for a mechanism that does not assemble.
    """
    return form_of(ready(mechanism))


def form_of(made: Ready) -> CauchyForm:
    """The normal form of a mechanism made ready."""
    if made.mechanism.space != "plane":
        raise InputError(
            "space",
            _("the normal form is integrated in the plane, not on the sphere"),
            _("compute the motion: centrode run; equations in symbols: centrode equations"),
        )
    board, drafts = assemble_chains(made)
    letters = board.alphabet
    systems = tuple(
        system_of(
            [one.rate(board.moves) for one in draft.conditions],
            [one.rate for one in draft.unknowns],
            [one.pair for one in draft.conditions],
        )
        for draft in drafts
    )
    unknowns = tuple(one for draft in drafts for one in draft.unknowns)
    conditions = [one for draft in drafts for one in draft.conditions]
    values = letters.values
    driven = {one.drive.id: one for one in made.kinematics.path.driven}
    return CauchyForm(
        names=tuple(one.name for one in unknowns),
        symbols=tuple(one.letter.name for one in unknowns),
        initial=np.array([values[one.letter] for one in unknowns], dtype=np.float64),
        constraint_names=tuple(one.name for one in conditions),
        unknowns=unknowns,
        systems=systems,
        residuals=tuple(one.residual for one in conditions),
        places=dict(board.points),
        constants={letter: x for letter, x in values.items() if letter not in letters.rates},
        drives=tuple(
            (letter, letters.rates[letter], driven[drive]) for letter, drive in board.driven.items()
        ),
    )


# From integrated states to angles, places and displacements with their rates, as a motion has them.

STENCIL = np.array([-3.0, -2.0, -1.0, 1.0, 2.0, 3.0])
WEIGHTS = np.array([-1.0, 9.0, -45.0, 45.0, -9.0, 1.0]) / 60
STRIDE = 0.01
"""Step of the sixth-order differences along the rates [rad]: both errors stay near 1e-14 of a great value."""


@dataclass(frozen=True)
class IntegratedMotion:
    """Rows of an integrated motion.

    `angles` and `spins` (n, links), `points` and `velocities` (n, points, 2), `slides` and `slips` (n, guides);
    NaN where there is no state, or where the equations say nothing of a point.
    """

    angles: Array
    spins: Array
    points: Array
    velocities: Array
    slides: Array
    slips: Array


def motion_of_solution(
    prepared: Ready, closed: xr.Dataset, form: CauchyForm, found: CauchySolution
) -> IntegratedMotion:
    """Everything a state tells; names and their order are those of the motion in closed form."""
    times = closed["time"].values
    angles, spins = (
        _link_angles(prepared.mechanism, form, columns, closed[name].values)
        for name, columns in (("angle", found.state), ("angular_velocity", found.rates))
    )
    names = [str(name) for name in closed["point"].values]
    places = _places(form, names, prepared.kinematics.numbers)
    reached = np.isfinite(found.state).all(axis=1)
    points, velocities = np.full((2, len(times), len(names), 2), np.nan)
    if reached.any():
        points[reached] = places(times[reached], found.state[reached])
        rates = found.rates[reached]
        step = STRIDE / _time_scale(prepared, form, rates)
        velocities[reached] = _speeds(places, times[reached], found.state[reached], rates, step)
    seen = _Seen(prepared.mechanism, prepared.kinematics.numbers, names, angles, spins, points, velocities)
    slides, slips = np.full((2, len(times), len(prepared.mechanism.guides)), np.nan)
    for column, guide in enumerate(prepared.mechanism.guides):
        if f"slide.{guide.id}" in form.names:
            which = form.names.index(f"slide.{guide.id}")
            slides[:, column], slips[:, column] = found.state[:, which], found.rates[:, which]
        else:
            slides[:, column], slips[:, column] = seen.along(guide.id, guide.point)
    return IntegratedMotion(angles, spins, points, velocities, slides, slips)


def _link_angles(mechanism: Mechanism, form: CauchyForm, columns: Array, closed: Array) -> Array:
    """Angles of all links, or their rates.

    What is no unknown turns against another body as its drive says, or not at all: that difference is taken from the
    motion in closed form, where it is the law itself.
    """
    names = mechanism.link_names
    found: dict[str, Array] = {FRAME: np.zeros(len(columns))}
    reached = np.where(np.isfinite(columns).all(axis=1), 0.0, np.nan)

    def angle(link: str) -> Array:
        if link not in found:
            if f"angle.{link}" in form.names:
                found[link] = columns[:, form.names.index(f"angle.{link}")]
            else:
                base = base_of(mechanism, link)
                known = 0.0 if base == FRAME else closed[:, names.index(base)]
                found[link] = angle(base) + closed[:, names.index(link)] - known + reached
        return found[link]

    return np.stack([angle(link) for link in names], axis=1)


def base_of(mechanism: Mechanism, link: str) -> str:
    """The body against which a link's angle is given: by its drive, or by a guide that keeps it from turning."""
    for drive in mechanism.drives:
        if drive.link == link:
            return drive.relative_to
    return next((guide.on for guide in mechanism.guides if guide.link == link), FRAME)


Places: TypeAlias = Callable[[Array, Array], Array]


def _places(form: CauchyForm, names: list[str], numbers: Dimensions) -> Places:
    """Places of all points of states, in the order of the names; those of the frame stand still."""
    frame = {name: np.array(place) for name, place in numbers.frame.items()}
    nowhere = np.full(2, np.nan)

    def places(times: Array, states: Array) -> Array:
        known = form.positions(times, states)
        every = [known.get(name, frame.get(name, nowhere)) for name in names]
        return np.stack([np.broadcast_to(one, (len(times), 2)) for one in every], axis=1)

    return places


def _time_scale(prepared: Ready, form: CauchyForm, rates: Array) -> Array:
    """How fast the mechanism moves at rows of rates [rad/s, and parts of the greatest length]: (n,).

    A law of time may rest and yet turn within a second, so that with one a second is the longest time.
    """
    scale = float(prepared.kinematics.numbers.scale)
    sizes = np.array([scale if name.startswith("slide.") else 1.0 for name in form.names])
    speed, least = prepared.parameter.constant_speed, 1.0
    if speed:
        least = abs(speed) / (1.0 if prepared.parameter.turns else scale)
    return np.asarray(np.maximum(least, (np.abs(rates) / sizes).max(axis=1, initial=0.0)))


def _speeds(places: Places, times: Array, states: Array, rates: Array, step: Array) -> Array:
    """Velocities of all points: derivatives of their places along the rates, by steps of time."""
    moved = sum(
        weight * places(times + shift * step, states + (shift * step)[:, None] * rates)
        for shift, weight in zip(STENCIL, WEIGHTS, strict=True)
    )
    return np.asarray(moved / step[:, None, None])


@dataclass(frozen=True)
class _Seen:
    """What displacements along guides are measured by."""

    mechanism: Mechanism
    numbers: Dimensions
    names: list[str]
    angles: Array
    spins: Array
    points: Array
    velocities: Array

    def along(self, guide: str, point: str) -> tuple[Array, Array]:
        """Displacement and its rate of a point along the line of a guide."""
        body = self.numbers.bodies[guide]
        direction, through = np.array(self.numbers.direction[guide]), np.array(self.numbers.through[guide])
        at, velocity = self._point(point)
        if body == FRAME:
            return (at - through) @ direction, velocity @ direction
        link = self.mechanism.link_names.index(body)
        turn, spin = self.angles[:, link], self.spins[:, link]
        axis, across = _rotate(turn, direction), _rotate(turn, np.array([-direction[1], direction[0]]))
        pole, local = next(iter(self.numbers.local[body].items()))
        start, start_velocity = self._point(pole)
        arm = _rotate(turn, through - np.array(local))
        away = at - start - arm
        away_velocity = velocity - start_velocity - spin[:, None] * np.stack([-arm[:, 1], arm[:, 0]], axis=1)
        slide = np.sum(away * axis, axis=1)
        return slide, np.sum(away_velocity * axis, axis=1) + spin * np.sum(away * across, axis=1)

    def _point(self, name: str) -> tuple[Array, Array]:
        column = self.names.index(name)
        return self.points[:, column], self.velocities[:, column]


def _rotate(angles: Array, vector: Array) -> Array:
    """A vector turned by angles: (n, 2)."""
    cosine, sine = np.cos(angles), np.sin(angles)
    return np.stack([cosine * vector[0] - sine * vector[1], sine * vector[0] + cosine * vector[1]], axis=1)


METHODS = ("rk4", "adaptive")
MOST_STEPS = 100_000
TOLERANCES = (1e-13, 1e-2)
"""Finest and coarsest tolerance of the adaptive method: below the first it would be rounding that is controlled."""


def integrate(
    mechanism: MechanismSource,
    method: str = "rk4",
    steps: int = 100,
    tolerance: float = FINE,
    stop: float | str | None = None,
) -> xr.Dataset:
    """The motion from t = 0 by integration of the equations in Cauchy form, with its difference from the closed forms.

    Parameters
    ----------
    method : "rk4" or "adaptive"
        Fixed steps of the classical Runge-Kutta method, or Dormand and Prince's of eighth order with error control.
    steps : int
        Number of fixed steps; of either method the result has steps + 1 rows, evenly spaced in time.
    tolerance : float
        Of the adaptive method, relative and absolute, for each step: rad, and parts of the greatest length.
    stop : float [rad or m, or s], or a text with a unit
        Last value of the drive, a time where the drive is a law or there are several; one turn by default.

    Returns
    -------
    Dataset
        Variables as `motion` names them, `drift` of the constraints, `angle_difference` and `position_difference`
        from the closed forms (docs: integration). Rows that the integration does not reach are NaN with the status
        `open`; those that fixed steps carry away from the mechanism, `unconverged`.

    Raises
    ------
    InputError
        As `motion` and `equations` do, or method, steps or tolerance do not exist.

    Examples
    --------
    >>> import centrode as ct
    >>> found = ct.integrate(ct.example("crank-rocker"), steps=200)
    >>> print(ct.summary(found).splitlines()[2])
    rows                 201: ok 201
    """
    mechanism = mechanism_of(mechanism)
    _check(method, steps, tolerance)
    task = _task(mechanism, steps, stop)
    if method == "rk4":
        return task.dataset(fixed_steps(task.scaled, task.times), method, steps)
    return task.dataset(adaptive_steps(task.scaled, task.times, tolerance), method, steps, tolerance)


def integrate_both(mechanism: Mechanism, steps: int = 100) -> tuple[xr.Dataset, xr.Dataset]:
    """What `integrate` gives by fixed steps, and by the adaptive method, which judges them: integrated once."""
    task = _task(mechanism, steps, None)
    judge = adaptive_steps(task.scaled, task.times, FINE)
    fixed = fixed_steps(task.scaled, task.times, judge)
    return task.dataset(fixed, "rk4", steps), task.dataset(judge, "adaptive", steps, FINE)


@dataclass(frozen=True)
class _Task:
    """What is integrated, and the motion in closed form at the same times."""

    prepared: Ready
    solved: Solved
    scaled: Scaled

    @property
    def times(self) -> Array:
        return self.solved.span.time

    def dataset(
        self, found: CauchySolution, method: str, steps: int, tolerance: float | None = None
    ) -> xr.Dataset:
        """The dataset of a solution; `tolerance` is that of the adaptive method."""
        told: dict[str, Any] = {"method": method, "steps": steps, "steps_taken": found.steps}
        if tolerance is not None:
            told["tolerance"] = tolerance
        return _dataset(self.prepared, self.solved, self.scaled.form, self.scaled, found, told)


def _task(mechanism: Mechanism, steps: int, stop: float | str | None) -> _Task:
    prepared = ready(mechanism)
    if prepared.parameter.constant_speed == 0.0:
        where = f"[[drives]] {mechanism.drives[0].id}"
        raise InputError(where, _("its speed is zero"), _("give a speed, or a law"))
    form = form_of(prepared)
    start = prepared.kinematics.path.initial if prepared.parameter.is_uniform else 0.0
    solved = solve(prepared, requested_grid(prepared, steps + 1, start, stop))
    return _Task(prepared, solved, Scaled(form, float(prepared.kinematics.numbers.scale)))


@dataclass(frozen=True)
class IntegrationResults:
    """An integrated motion beside the one in closed form.

    Attributes
    ----------
    mechanism : Mechanism
    integration : the dataset of `integrate`
    closed : the motion in closed form over the same range, whose curves stand under the integrated ones
    fixed : the dataset of `integrate` by fixed steps that a document has besides; None where nobody wishes it
    """

    mechanism: Mechanism
    integration: xr.Dataset
    closed: xr.Dataset
    fixed: xr.Dataset | None = None


def integration_results(
    mechanism: Mechanism,
    method: str = "rk4",
    steps: int = 100,
    tolerance: float | None = None,
    stop: float | None = None,
    rk4_steps: int | None = None,
) -> IntegrationResults:
    """The motion by integration, with the mechanism and the motion in closed form.

    Arguments and failures are those of `integrate`; InputError also for a tolerance of fixed steps. With `rk4_steps`
    the motion by so many fixed steps stands beside it.
    """
    if tolerance is not None and method == "rk4":
        what = _("fixed steps have no tolerance")
        raise InputError("--tolerance", what, _("add --method adaptive, or increase --steps"))
    integration = integrate(mechanism, method, steps, FINE if tolerance is None else tolerance, stop)
    found = results_of_integration(mechanism, integration)
    return (
        found
        if rk4_steps is None
        else replace(found, fixed=integrate(mechanism, "rk4", rk4_steps, stop=stop))
    )


def results_of_integration(mechanism: Mechanism, integration: xr.Dataset) -> IntegrationResults:
    """A dataset of `integrate` with the motion in closed form over the same range."""
    return IntegrationResults(mechanism, integration, closed_motion(mechanism, integration))


def closed_motion(mechanism: Mechanism, integration: xr.Dataset, samples: int = 361) -> xr.Dataset:
    """The motion in closed form over the range of an integrated one, for curves to be compared with."""
    instants = mechanism.motion_parameter.instants(integration)
    first, last = (float(instants[end]) for end in (0, -1))
    return motion(mechanism, samples, start=first, stop=last)


def is_integrated(mechanism: Mechanism) -> bool:
    """Whether a mechanism moves in the plane, with time, and has unknowns that its equations give."""
    if mechanism.motion_parameter.constant_speed == 0.0:
        return False
    return mechanism.space == "plane" and bool(equations(mechanism).unknowns)


def _check(method: object, steps: object, tolerance: object) -> None:
    if method not in METHODS:
        what = _("there is no method {name}").format(name=value_text(method))
        raise InputError("method", what, nearest(str(method), METHODS))
    if isinstance(steps, bool) or not isinstance(steps, int) or not 1 <= steps <= MOST_STEPS:
        what = _("{steps} steps are given").format(steps=value_text(steps))
        raise InputError("steps", what, _("give 1 to {most}").format(most=MOST_STEPS))
    low, high = TOLERANCES
    if isinstance(tolerance, bool) or not isinstance(tolerance, int | float) or not low <= tolerance <= high:
        what = _("{value} is not a valid tolerance").format(value=value_text(tolerance))
        raise InputError("tolerance", what, _("give {low:g} to {high:g}").format(low=low, high=high))


@dataclass(frozen=True)
class Scaled:
    """Equations whose constraints are compared with the greatest length."""

    form: CauchyForm
    scale: float

    @property
    def initial(self) -> Array:
        return self.form.initial

    @property
    def sizes(self) -> Array:
        return np.array([self.scale if name.startswith("slide.") else 1.0 for name in self.form.names])

    def rates(self, time: Any, state: Array) -> Array:
        return np.asarray(self.form.rates(time, state), dtype=np.float64)

    def constraints(self, time: Any, state: Array) -> Array:
        return np.asarray(self.form.constraints(time, state), dtype=np.float64) / self._units

    @cached_property
    def _units(self) -> Array:
        """What each constraint is compared with: those of wheels are angles."""
        angular = ("gear ", "rolling ")
        return np.array(
            [1.0 if name.startswith(angular) else self.scale for name in self.form.constraint_names]
        )


def _dataset(
    prepared: Ready,
    solved: Solved,
    form: CauchyForm,
    scaled: Scaled,
    found: CauchySolution,
    told: Mapping[str, Any],
) -> xr.Dataset:
    closed = dataset_of(solved)
    times = solved.span.time
    status = _status(found, times)
    course = motion_of_solution(prepared, closed, form, found)
    drift = np.full((len(status), len(form.constraint_names)), np.nan)
    rows = status == Status.OK
    drift[rows] = scaled.constraints(times[rows], found.state[rows])
    off = course.angles - closed["angle"].values
    apart = np.linalg.norm(course.points - closed["position"].values, axis=-1)
    judged = judgements_of(solved, ())["status"]
    variables = {
        "angle": vocabulary_variable("angle", ("sample", "link"), course.angles),
        "angular_velocity": vocabulary_variable("angular_velocity", ("sample", "link"), course.spins),
        "position": vocabulary_variable("position", ("sample", "point", "axis"), course.points),
        "velocity": vocabulary_variable("velocity", ("sample", "point", "axis"), course.velocities),
        "slide": vocabulary_variable("slide", ("sample", "guide"), course.slides),
        "slide_velocity": vocabulary_variable("slide_velocity", ("sample", "guide"), course.slips),
        "drift": vocabulary_variable("drift", ("sample", "constraint"), drift),
        "angle_difference": vocabulary_variable("angle_difference", ("sample", "link"), off),
        "position_difference": vocabulary_variable("position_difference", ("sample", "point"), apart),
        "status": (judged[0], status, judged[2]),
        **{name: closed[name] for name in ("event_value", "event_kind", "event_group")},
    }
    coordinates = {**coordinates_of(solved), "constraint": labels_of(form.constraint_names)}
    attributes = attributes_of(solved, "integrate")
    attributes = {name: told for name, told in attributes.items() if "residual" not in name}
    attributes |= {
        **told,
        "stop_time": _or_nan(found.stop),
        "lost_time": _or_nan(found.lost),
        "return_difference": _apart(course.angles, course.points, scaled.scale),
        "closed_return_difference": _apart(closed["angle"].values, closed["position"].values, scaled.scale),
    }
    return selectable(xr.Dataset(variables, coords=coordinates, attrs=attributes))


def _or_nan(time: float | None) -> float:
    return float("nan") if time is None else time


def _status(found: CauchySolution, times: Array) -> npt.NDArray[np.int8]:
    """Ok where there is a state; behind a stop open, from a row that is lost on unconverged."""
    status = np.where(np.isfinite(found.state).all(axis=1), Status.OK, Status.OPEN).astype(np.int8)
    forward = np.sign(times[-1] - times[0])
    if found.lost is not None:
        end = times[-1] if found.stop is None else found.stop
        status[(forward * times >= forward * found.lost) & (forward * times <= forward * end)] = (
            Status.UNCONVERGED
        )
    return status


def _apart(angles: Array, points: Array, scale: float) -> float:
    """How far the last row is from the first: angles modulo turns [rad], places over the greatest length.

    NaN where one of them does not exist.
    """
    turned = np.abs(np.remainder(angles[-1] - angles[0] + np.pi, 2 * np.pi) - np.pi)
    moved = np.abs(points[-1] - points[0]) / scale
    return float(np.max(np.concatenate([turned.ravel(), moved.ravel()]), initial=0.0))
