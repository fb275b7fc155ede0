"""The curve that a group of higher class follows over the path, by its own arc.

State and parameter are found together on a plane square to the curve (Keller, Numerical Solution of Bifurcation
and Nonlinear Eigenvalue Problems, 1977), so limits are ordinary places: there the parameter turns back. The
curve's coordinates are the free coordinates of the group and, last, the parameter in the path's unit.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.kinematics.higher_class.loop_closure import LoopClosure, solve_places
from centrode.kinematics.higher_class.newton import (
    Shifts,
    bordered_equations,
    is_rounding_step,
    motion_along,
    size_of,
)
from centrode.kinematics.higher_class.system import GroupMotion, Linear, Surroundings, total
from centrode.kinematics.path import JETS
from centrode.numerics.jets import Jet
from centrode.numerics.rounding_bounds import ROUNDED, SAFETY, UNIT_ROUNDOFF, Rounded

Array: TypeAlias = npt.NDArray[np.float64]
Lanes: TypeAlias = npt.NDArray[np.intp]
Mask: TypeAlias = npt.NDArray[np.bool_]

STEPS = 7
"""Newton steps onto a plane."""
ENOUGH = 1e-9
"""What part of a step along the curve the next Newton step onto a plane may be."""
FAR = 3e-4
"""The first step counts as one after a step this great: the curve may bend so sharply that only a second one tells."""
CONTRACTION = 0.2
"""By how much every Newton step must be smaller than the one before, but for rounding."""


@dataclass
class CurvePlaces:
    """Places on curves, one lane each; all arrays have one row a place.

    `numbers` (k, width + 1) are state and parameter, `first` their derivatives by the curve's arc; `along` is the
    curve's unit vector (k, free + 1), `size` the determinant of the equations bordered by it. `second` are second
    Taylor coefficients by the distance of `numbers` along `first`, which to begin with is the arc. Distances count
    every number in its own measure, `weight` (k, width + 1): they are the same in metres and in millimetres.
    """

    numbers: Array
    first: Array
    second: Array
    along: Array
    size: Array
    weight: Array

    @property
    def state(self) -> Array:
        return self.numbers[:, :-1]

    @property
    def parameter(self) -> Array:
        return self.numbers[:, -1]

    def of(self, which: Lanes | Mask) -> CurvePlaces:
        """Places with these numbers, or where a mask is true."""
        return CurvePlaces(*(getattr(self, f.name)[which] for f in fields(self)))

    def put(self, which: Lanes | Mask, others: CurvePlaces) -> None:
        """Put others in some of the places."""
        for f in fields(self):
            getattr(self, f.name)[which] = getattr(others, f.name)

    def distance(self, numbers: Array) -> Array:
        """Distance of numbers (k, width + 1) along the curve's direction here."""
        own = self.first * self.weight**2
        # the scalar product with the curve's direction, every number in its own measure
        return total(own * numbers) / total(own * self.first)


@dataclass(frozen=True)
class ReachedPlace:
    """Places found on planes square to curves at their bases.

    `arc` is their distance along the bases' directions, `first` and `second` are Taylor coefficients of numbers
    by it; `wrong` is by how much the foretold place was off.
    """

    places: CurvePlaces
    arc: Array
    first: Array
    second: Array
    wrong: Array
    found: Mask

    def of(self, which: Lanes | Mask) -> ReachedPlace:
        """Places with these numbers, or where a mask is true."""
        return ReachedPlace(
            self.places.of(which), self.arc[which], self.first[which], self.second[which], self.wrong[which],
            self.found[which],
        )  # fmt: skip


def reach(
    around: Surroundings,
    lanes: Lanes,
    base: CurvePlaces,
    along: Array,
    parameter: Array,
    state: Array,
    stride: Array | None = None,
) -> ReachedPlace:
    """Where curves pass planes square to `along` through foretold places.

    They are as good as it takes to foretell others at such strides; without these, to the last digit.
    """
    count = len(parameter)
    arrived, active = np.zeros(count, dtype=bool), np.isfinite(state).all(axis=1)
    last, wrong = np.full(count, FAR), np.full(count, np.nan)
    loops = around.loops_at(parameter, lanes)
    on_plane: _ByLoops | _ByConstraints
    if loops is None:
        on_plane = _ByConstraints(around, lanes, along, state)
    else:
        on_plane = _ByLoops(around, loops, lanes, along, state)
    for k in range(STEPS):
        size = on_plane.step(parameter)
        if k == 0:
            wrong = size
        # a step of a radian, or of the greatest length, has nothing to do with the place foretold
        good = active & np.isfinite(size) & (size < 1.0)
        parameter = on_plane.move(parameter, good)
        with np.errstate(all="ignore"):
            # without a stride to the last digit; with one, until the next step, foretold by quadratic
            # convergence, is small beside it
            enough = (
                is_rounding_step(last, size)
                if stride is None
                else size * (size / last) ** 2 <= ENOUGH * stride
            )
        # steps have to shrink, or the place belongs to another curve; tiny ones are rounding and need not
        done = good & enough
        arrived |= done
        active = good & ~done & ((k == 0) | (size <= np.maximum(CONTRACTION * last, 1e-9)))
        last = size
        if not active.any():
            break
    state, slope, size, first, second = on_plane.tangent(parameter)
    numbers = np.concatenate([state, parameter[:, None]], axis=1)
    with np.errstate(all="ignore"):
        length = np.sqrt(total(slope * slope))
        # the determinant bordered by the curve's own direction is that by the plane's, times their cosine
        places = CurvePlaces(
            numbers, first / length[:, None], second, slope / length[:, None], size * length, base.weight
        )
        _rate, places.second = _by_distance(places, first, second)
        inward = _by_distance(base, first, second)
    arrived &= np.isfinite(inward[1]).all(axis=1)
    return ReachedPlace(places, base.distance(numbers - base.numbers), *inward, wrong, arrived)


Tangent: TypeAlias = tuple[Array, Array, Array, Array, Array]
"""States, slopes of the curve (k, free + 1) against the plane's normal, bordered determinants, and first and second
Taylor coefficients of numbers by the distance from the plane."""


class _ByLoops:
    """Newton's method onto planes across curves, by the loops of a group."""

    def __init__(
        self, around: Surroundings, loops: LoopClosure, lanes: Lanes, along: Array, state: Array
    ) -> None:
        self.around, self.loops, self.lanes = around, loops, lanes
        self.free, self.whole = loops.free_of(state)
        self.matrix = np.empty((len(along), loops.free + 1, loops.free + 1))
        self.matrix[:, -1] = along
        self.right = np.zeros((len(along), loops.free + 1))

    def step(self, parameter: Array) -> Array:
        """Find a step; returns its size."""
        self._series(parameter, 1)
        self.right[:, :-1] = -self.left
        self.steps = solve_places(self.matrix, self.right[:, :, None])[:, :, 0]
        return np.asarray(np.max(np.abs(self.steps), axis=1))

    def move(self, parameter: Array, good: Mask) -> Array:
        """Make the step where it is good; returns the parameters there."""
        self.free = np.where(good[:, None], self.free + self.steps[:, :-1], self.free)
        return np.where(good, parameter + self.around.unit * self.steps[:, -1], parameter)

    def _series(self, parameter: Array, order: int) -> tuple[Array, Array]:
        """Numbers of places with their matrix, and series of what is known by the path's parameter."""
        ahead = Jet((parameter, np.ones(len(parameter)), *[0.0] * (order - 1)))
        known = self.loops.known(self.around.known(ahead, self.lanes), len(parameter), order + 1)
        series = self.loops.begin(self.loops.numbers(self.free, self.whole, known[0]), known)
        self.left, self.matrix[:, :-1, :-1] = self.loops.equations(series[0])
        # the parameter's column is of the size of the others
        self.matrix[:, :-1, -1] = self.around.unit * self.loops.coefficient(series, 1)
        return series, known

    def tangent(self, parameter: Array) -> Tangent:
        """The curves where the planes are met."""
        loops, unit = self.loops, self.around.unit
        series, known = self._series(parameter, 2)
        # the tangent: the direction along which no equation changes, of length 1 along the normal of the plane
        self.right[:] = 0.0
        self.right[:, -1] = 1.0
        slope = solve_places(self.matrix, self.right[:, :, None])[:, :, 0]
        rate = unit * slope[:, -1:]
        along = np.stack([known[0], known[1] * rate, known[2] * rate**2])
        series = loops.begin(series[0], along)
        loops.put(series, 1, slope[:, :-1])
        loops.bend(series, 2)
        # along the tangent alone the equations fail in second order
        self.right[:, :-1] = -loops.coefficient(series, 2)
        self.right[:, -1] = 0.0
        bend = solve_places(self.matrix, self.right[:, :, None])[:, :, 0]
        series[2, :, loops.first_known :] += known[1] * (unit * bend[:, -1:])
        loops.put(series, 2, bend[:, :-1])
        first = np.concatenate([loops.state(series[1]), rate], axis=1)
        second = np.concatenate([loops.state(series[2]), unit * bend[:, -1:]], axis=1)
        return loops.state(series[0]), slope, np.linalg.det(self.matrix), first, second


class _ByConstraints:
    """The same by all constraints of a group, for batches and on the sphere."""

    def __init__(self, around: Surroundings, lanes: Lanes, along: Array, state: Array) -> None:
        self.around, self.lanes, self.along, self.state = around, lanes, along, state

    def step(self, parameter: Array) -> Array:
        """Find a step; returns its size."""
        system, linear, moved, rest, follow, matrix = bordered_equations(
            self.around, self.lanes, parameter, self.state, self.along
        )
        right = np.concatenate([rest, np.zeros((len(parameter), 1))], axis=1)
        self.steps = solve_places(matrix, right[:, :, None])[:, :, 0]
        self.moved = system.move(self.state, motion_along(linear, moved, follow, self.steps))
        return size_of(system, moved, self.steps)

    def move(self, parameter: Array, good: Mask) -> Array:
        """Make the step where it is good; returns the parameters there."""
        self.state = np.where(good[:, None], self.moved, self.state)
        return np.where(good, parameter + self.around.unit * self.steps[:, -1], parameter)

    def tangent(self, parameter: Array) -> Tangent:
        """The curves where the planes are met."""
        _system, linear, _moved, _rest, follow, matrix = bordered_equations(
            self.around, self.lanes, parameter, self.state, self.along
        )
        # the tangent: the direction along which no equation changes, of length 1 along the normal of the plane
        ahead = np.zeros((*matrix.shape[:2], 1))
        ahead[:, -1] = 1.0
        slope = solve_places(matrix, ahead)[:, :, 0]
        first, second = _coefficients(
            self.around, self.lanes, parameter, self.state, slope, linear, follow, matrix
        )
        with np.errstate(all="ignore"):
            size = np.linalg.det(matrix)
        return self.state, slope, size, first, second


def _by_distance(base: CurvePlaces, first: Array, second: Array) -> tuple[Array, Array]:
    """Taylor coefficients by the distance along a base's direction, from those by any other variable."""
    rate, bend = base.distance(first)[:, None], base.distance(second)[:, None]
    # with the distance t = r s + b s^2, x = x1 s + x2 s^2 has x1 / r and x2 / r^2 - x1 b / r^3
    return first / rate, second / rate**2 - first * bend / rate**3


def _coefficients(
    around: Surroundings,
    lanes: Lanes,
    parameter: Array,
    state: Array,
    slope: Array,
    linear: Linear,
    follow: Shifts,
    matrix: Array,
) -> tuple[Array, Array]:
    """First and second Taylor coefficients of numbers by the distance from the plane."""
    ahead = Jet((parameter, around.unit * slope[:, -1], np.zeros(len(parameter))))
    known = around.known(ahead, lanes)
    system = around.system(known, lanes)
    still = {entity: (0.0,) * entity.unknowns for entity in follow}
    one = motion_along(linear, still, follow, slope)
    zero = np.zeros(len(parameter))
    # along the tangent alone the equations fail in second order: by how much is the right side of the second
    # coefficient
    straight = GroupMotion(
        {e: tuple(Jet((zero, x, zero)) for x in shift) for e, shift in one.shifts.items()},
        [Jet((zero, x, zero)) for x in one.free],
    )
    values = system.residual(JETS, system.at(JETS, known, state, straight))
    moved, rest = linear.reduce([-x.coefficients[2] if isinstance(x, Jet) else 0.0 for x in values])
    right = np.concatenate([system.stack(rest), zero[:, None]], axis=1)
    bend = solve_places(matrix, right[:, :, None])[:, :, 0]
    two = motion_along(linear, moved, follow, bend)
    curved = GroupMotion(
        {
            e: tuple(Jet((zero, x, y)) for x, y in zip(one.shifts[e], two.shifts[e], strict=True))
            for e in one.shifts
        },
        [Jet((zero, x, y)) for x, y in zip(one.free, two.free, strict=True)],
    )
    at = system.at(JETS, known, state, curved)
    jets = system.numbers_of(at)
    first = [x.coefficients[1] for x in jets] + [around.unit * slope[:, -1]]
    second = [x.coefficients[2] for x in jets] + [around.unit * bend[:, -1]]
    return system.stack(first), system.stack(second)


def quintic(base: CurvePlaces, reached: ReachedPlace) -> Array:
    """Polynomials (k, 6, width + 1) through two places each, in the share of the arc between them.

    Values, first and second derivatives agree at both ends; the parameter is that beyond the base.
    """
    # c0, c1, c2 match the base; a, b, c are what these leave of value, slope and second derivative at the
    # other end
    arc = reached.arc[:, None]
    c1, c2 = base.first * arc, base.second * arc**2
    d, e = reached.first * arc, 2.0 * reached.second * arc**2
    a = reached.places.numbers - base.numbers - c1 - c2
    b, c = d - c1 - 2.0 * c2, e - 2.0 * c2
    c3, c4, c5 = 10.0 * a - 4.0 * b + 0.5 * c, -15.0 * a + 7.0 * b - c, 6.0 * a - 3.0 * b + 0.5 * c
    start = base.numbers.copy()
    # the parameter counts from the base, so that a short piece far out loses no digits
    start[:, -1] = 0.0
    return np.stack([start, c1, c2, c3, c4, c5], axis=1)


# Limits of a group of higher class: places of its curve at which the path's parameter turns back.

LIMIT_STEPS = 30
"""Most Newton steps along the curve to a limit, from where the polynomial between two places turns back."""
SMALL_ARC = 1e-8
"""After a step this small, in the arc between the two places, the next is below rounding."""
LONGEST = 0.1
"""Greatest such step, in the arc between the two places."""
LEAST_MARGIN = 8.0
"""Units of rounding of the parameter itself that a place may be away from a limit and still be the limit."""


@dataclass(frozen=True)
class CurveLimits:
    """Limits reached from places, and by how much rounding may shift the parameter there."""

    reached: ReachedPlace
    margin: Array


def limits(around: Surroundings, lanes: Lanes, here: CurvePlaces, there: ReachedPlace) -> CurveLimits:
    """Limits between places and those reached beyond them."""
    whole = quintic(here, there)
    share = _first_turn(whole[:, :, -1])
    arrived = np.zeros(len(share), dtype=bool)
    for _step in range(LIMIT_STEPS):
        powers = share[:, None] ** np.arange(6)
        value = total(whole * powers[:, :, None])
        parameter = here.parameter + value[:, -1]
        state = around.normalise(value[:, :-1], lanes)
        limit = reach(around, lanes, here, here.along, parameter, state)
        with np.errstate(all="ignore"):
            # at a limit the parameter's first coefficient is zero: Newton's step of that along the arc
            change = -limit.first[:, -1] / (2.0 * limit.second[:, -1]) / there.arc
            change = np.where(np.isfinite(change), np.clip(change, -LONGEST, LONGEST), np.inf)
        if arrived.all():
            break
        share = np.where(arrived | np.isinf(change), share, share + change)
        arrived |= np.abs(change) <= SMALL_ARC
    limit.found[:] &= arrived
    return CurveLimits(limit, _margin(around, lanes, limit.places))


def _first_turn(coefficients: Array) -> Array:
    """The first share in [0, 1] at which polynomials (k, 6) turn back."""
    # where the polynomial has no turn, its middle: Newton's method goes on from there
    earliest = np.full(len(coefficients), 0.5)
    for k, c in enumerate(coefficients):
        roots = np.polynomial.Polynomial(c).deriv().roots()
        real = np.sort(roots.real[np.abs(roots.imag) < 1e-6])
        inside = real[(real >= -1e-6) & (real <= 1.0 + 1e-6)]
        earliest[k] = inside[0] if len(inside) else 0.5
    return earliest


def _margin(around: Surroundings, lanes: Lanes, places: CurvePlaces) -> Array:
    """By how much rounding of the equations may shift a limit along the path."""
    parameter, state = places.parameter, places.state
    system, linear, _moved, _rest, _follow, matrix = bordered_equations(around, lanes, parameter, state, None)
    values = system.residual(ROUNDED, system.at(ROUNDED, around.with_bounds(parameter, lanes), state))
    zero = np.zeros(len(parameter))
    _moved, rest = linear.reduce([Rounded(zero, zero + Rounded.of(x).bound) for x in values])
    bounds = system.stack([Rounded.of(x).bound for x in rest])
    with np.errstate(all="ignore"):
        # the combination of equations that does not feel the group's own motion there tells the parameter
        least = np.linalg.svd(np.where(np.isfinite(matrix), matrix, 0.0)[:, :, :-1])[0][:, :, -1]
        pushed = np.abs(total(least * matrix[:, :, -1]))
        shift = around.unit * total(np.abs(least) * bounds) / pushed
    # as near as this to a limit the parameter itself has no digits to tell the places apart
    spacing = LEAST_MARGIN * np.spacing(np.maximum(np.abs(parameter), 1e-3 * around.unit))
    return np.asarray(np.fmax(SAFETY * shift, spacing), dtype=np.float64)


# Where two curves of a group of higher class meet: a change point, distinguished from a near miss.
#
# At a change point the equations are dependent, parameter included. Seen along the two directions in which
# they tell least, the worst equation has a saddle there; its value at the saddle is to a group of higher
# class what the radicand is to a dyad: zero within its rounding error at a change point, anything else a near
# miss (Golubitsky and Schaeffer, Singularities and Groups in Bifurcation Theory I, 1985, chapter 1).

CROSSING_STEPS = 20
GREATEST = 0.05
"""Greatest step towards a saddle, in rad or in the greatest length."""
FLAT_SADDLE = 1e-11
"""A saddle is flat: its value is exact to the square of this."""
LEAST_VALUE = UNIT_ROUNDOFF**2
"""No value of a saddle is known better: it is exact to the square of the rounding of its place."""
FAR_SADDLE = 1e-7
"""A last step greater than this has not found the saddle."""
NEAR = 3.0
"""How many arcs away from its beginning a crossing may lie to belong to it."""


class _BendsByLoops:
    """Equations of one place with their second derivatives, by the loops of a group."""

    def __init__(
        self, around: Surroundings, loops: LoopClosure, lane: Lanes, parameter: Array, state: Array
    ) -> None:
        self.around, self.loops, self.lane, self.parameter = around, loops, lane, parameter
        self.free, self.whole = loops.free_of(state)

    def look(self) -> tuple[Array, Array]:
        """The matrix (free, free + 1), and what is missing in the equations (free,)."""
        loops, unit = self.loops, self.around.unit
        ahead = Jet((self.parameter, np.ones(1), 0.0))
        self.known = loops.known(self.around.known(ahead, self.lane), 1, 3)
        self.numbers = loops.numbers(self.free, self.whole, self.known[0])
        by_parameter = loops.coefficient(loops.begin(self.numbers, self.known), 1)
        left, matrix = loops.equations(self.numbers)
        return np.concatenate([matrix[0], unit * by_parameter.T], axis=1), -left[0]

    def bend(self, least: Array, direction: Array) -> float:
        """Second derivative of a combination of equations in a direction of the curve's coordinates."""
        loops, rate = self.loops, self.around.unit * direction[-1]
        along = np.stack([self.known[0], self.known[1] * rate, self.known[2] * rate**2])
        series = loops.begin(self.numbers, along)
        loops.put(series, 1, direction[None, :-1])
        loops.bend(series, 2)
        return 2.0 * float(least @ loops.coefficient(series, 2)[0])

    def move(self, step: Array) -> None:
        """Make a step (free + 1,)."""
        self.free = self.free + step[:-1]
        self.parameter = self.parameter + self.around.unit * step[-1]

    @property
    def state(self) -> Array:
        """The state that is reached."""
        known = self.loops.known(self.around.known_at(self.parameter, self.lane), 1)
        return self.loops.state(self.loops.numbers(self.free, self.whole, known[0]))


class _BendsByConstraints:
    """The same by all constraints of a group."""

    def __init__(self, around: Surroundings, lane: Lanes, parameter: Array, state: Array) -> None:
        self.around, self.lane, self.parameter, self.state = around, lane, parameter, state

    def look(self) -> tuple[Array, Array]:
        """The matrix (free, free + 1), and what is missing in the equations (free,)."""
        self.system, self.linear, self.moved, rest, self.follow, matrix = bordered_equations(
            self.around, self.lane, self.parameter, self.state, None
        )
        return matrix[0], rest[0]

    def bend(self, least: Array, direction: Array) -> float:
        """Second derivative of a combination of equations in a direction of the curve's coordinates."""
        zero = np.zeros(1)
        still = {entity: (0.0,) * entity.unknowns for entity in self.follow}
        one = motion_along(self.linear, still, self.follow, direction[None, :])
        shifts = {e: tuple(Jet((zero, x, zero)) for x in shift) for e, shift in one.shifts.items()}
        straight = GroupMotion(shifts, [Jet((zero, x, zero)) for x in one.free])
        ahead = Jet((self.parameter, zero + self.around.unit * direction[-1], zero))
        known = self.around.known(ahead, self.lane)
        values = self.system.residual(JETS, self.system.at(JETS, known, self.state, straight))
        _moved, rest = self.linear.reduce([x.coefficients[2] if isinstance(x, Jet) else 0.0 for x in values])
        return 2.0 * float(least @ self.system.stack(rest)[0])

    def move(self, step: Array) -> None:
        """Make a step (free + 1,)."""
        motion = motion_along(self.linear, self.moved, self.follow, step[None, :])
        self.state = self.system.move(self.state, motion)
        self.parameter = self.parameter + self.around.unit * step[-1]


class _Saddle:
    """A place on its way to the saddle: one lane."""

    def __init__(self, around: Surroundings, lane: Lanes, parameter: Array, state: Array) -> None:
        self.around, self.lane = around, lane
        loops = around.loops_at(parameter, lane)
        self.at: _BendsByLoops | _BendsByConstraints
        if loops is None:
            self.at = _BendsByConstraints(around, lane, parameter, state)
        else:
            self.at = _BendsByLoops(around, loops, lane, parameter, state)

    @property
    def parameter(self) -> Array:
        """The path's parameter there (1,)."""
        return self.at.parameter

    def approach(self) -> tuple[float, bool]:
        """Step towards the saddle; returns the size of the step and whether it is one."""
        matrix, rest = self.at.look()
        left, values, right = np.linalg.svd(matrix)
        # the combination of equations that changes least, and the two directions in which anything changes
        # least
        least, plane = left[:, -1], right[-2:]
        bends = [self.at.bend(least, d) for d in (plane[0], plane[1], plane[0] + plane[1])]
        # by polarisation: B(p + q) - B(p) - B(q) = 2 B(p, q)
        mixed = 0.5 * (bends[2] - bends[0] - bends[1])
        hessian = np.array([[bends[0], mixed], [mixed, bends[1]]])
        # in the plane to where the worst equation has no slope; square to it to where the others hold
        inside = -np.linalg.solve(hessian, plane @ matrix.T @ least)
        back = right[: len(values) - 1].T @ ((left[:, :-1].T @ rest) / values[:-1])
        step = plane.T @ inside + back
        size = float(np.max(np.abs(step)))
        step *= min(1.0, GREATEST / size)
        self.at.move(step)
        # a saddle is met by two curves; a top or a bottom is an isolated point or nothing
        return size, bool(np.linalg.det(hessian) < 0.0)

    def value(self) -> tuple[float, float]:
        """The worst equation's value with the bound of its rounding error."""
        parameter, state = self.at.parameter, self.at.state
        system, linear, _moved, rest, _follow, matrix = bordered_equations(
            self.around, self.lane, parameter, state, None
        )
        least = np.linalg.svd(matrix[0])[0][:, -1]
        known = self.around.with_bounds(parameter, self.lane)
        values = system.residual(ROUNDED, system.at(ROUNDED, known, state))
        _moved, bounds = linear.reduce([Rounded(np.zeros(1), Rounded.of(x).bound) for x in values])
        bound = float(np.abs(least) @ np.array([float(np.max(Rounded.of(x).bound)) for x in bounds]))
        return float(least @ rest[0]), bound


def curve_crossing(around: Surroundings, lane: Lanes, base: CurvePlaces, there: ReachedPlace) -> float | None:
    """The parameter at which curves cross between two places; None if they do not."""
    # where the determinant, taken for straight, is zero; the polynomial has the state there
    share = float(np.clip(base.size[0] / (base.size[0] - there.places.size[0]), 0.0, 1.0))
    middle = total(quintic(base, there) * share ** np.arange(6)[:, None])
    state = around.normalise(middle[:, :-1], lane)
    saddle = _Saddle(around, lane, base.parameter + middle[:, -1], state)
    try:
        with np.errstate(all="ignore"):
            for _step in range(CROSSING_STEPS):
                size, crosses = saddle.approach()
                if not size > FLAT_SADDLE:
                    break
            if size > FAR_SADDLE or not crosses:
                return None
            value, bound = saddle.value()
    except np.linalg.LinAlgError:
        return None
    parameter = float(saddle.parameter[0])
    away = abs(parameter - float(base.parameter[0])) / around.unit
    # the saddle has to be found, near by, with a value that its rounding error explains
    met = away <= NEAR * float(there.arc[0]) and abs(value) <= SAFETY * max(bound, LEAST_VALUE)
    return parameter if met else None
