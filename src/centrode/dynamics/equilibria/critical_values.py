"""Equilibria followed along a number of the description, and the values at which they are lost or lose stability.

The pair (position, number) is a curve; it is followed by its arc length, so that it goes on where the number turns back
(a fold, where an equilibrium is lost). Where the stiffness loses its rank and the number goes on, other equilibria
branch off; where a pair of eigenvalues crosses the imaginary axis, oscillations grow (Hopf). (R. Seydel, Practical
Bifurcation and Stability Analysis, 3rd ed., 2010, chapters 4 and 5; W. Govaerts, Numerical Methods for Bifurcations of
Dynamical Equilibria, 2000.)
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TypeAlias

import numpy as np
import numpy.typing as npt
from numpy.polynomial import Chebyshev
from scipy.optimize import brentq

from centrode.dynamics.equilibria.configuration_curve import repeats_with_position
from centrode.dynamics.equilibria.equilibrium_search import settled_equilibria
from centrode.dynamics.equilibria.linear_equations import LinearEquations, LoadedMechanism
from centrode.dynamics.equilibria.small_motions import SmallMotions, small_motions
from centrode.errors import NotComputedYet
from centrode.locale import _

Array: TypeAlias = npt.NDArray[np.float64]

FOLD, BRANCH_POINT, HOPF, KINK = "fold", "branch point", "Hopf point", "kink"
KINDS = (FOLD, BRANCH_POINT, HOPF, KINK)
"""An equilibrium is lost; others branch off; oscillations begin to grow; the stiffness jumps (a stop closes)."""
DEGREE = 20
"""Of the polynomial in which numbers of the equations are expanded along the parameter."""
EXACT = 1e-12
FIRST, LONGEST, LEAST = 0.01, 0.06, 1e-7
"""Steps along the curve, in rad, greatest lengths, and shares of the range of the number."""
MOST_STEPS = 1500
CORRECTED = 1e-12
CORRECTIONS = 12
SAME = 1e-5
BESIDE, JUMP = 1e-5, 1e-3
"""Distance to both sides of a place, in units, at which stiffnesses that differ by this share say that they jump."""
BEYOND = 1e-4
"""Share of the range of the number by which a kink is passed."""


@dataclass(frozen=True)
class CriticalValue:
    """A value of the number at which equilibria are lost or lose their stability.

    Attributes
    ----------
    kind : one of `KINDS`
    value : of the number [SI]
    place : (coordinates) [rad or m]
    frequency : of the oscillations that begin there [rad/s]; zero but at a Hopf point
    """

    kind: str
    value: float
    place: Array
    frequency: float = 0.0


@dataclass(frozen=True)
class EquilibriumBranch:
    """Equilibria one behind the other along a number.

    Attributes
    ----------
    values : (n) of the number [SI]
    places : (n, coordinates) [rad or m]
    motions : small motions about each
    critical : on the way, in its order
    """

    values: Array
    places: Array
    motions: tuple[SmallMotions, ...]
    critical: tuple[CriticalValue, ...]


@dataclass(frozen=True)
class ContinuationNumber:
    """A number of a mechanism that runs through a range, and what the equations make of it.

    Attributes
    ----------
    loaded : traced at a value at which no number of the equations happens to vanish
    low, high : ends of the range [SI]
    series : variable of the equations -> its value along the range
    """

    loaded: LoadedMechanism
    low: float
    high: float
    series: Mapping[str, Chebyshev]

    @cached_property
    def slopes(self) -> Mapping[str, Chebyshev]:
        """Derivatives of the series."""
        return {name: one.deriv() for name, one in self.series.items()}

    @cached_property
    def _constant(self) -> Mapping[str, float]:
        return {name: float(one(self.low)) for name, one in self.series.items() if one.degree() == 0}

    def numbers(self, value: float) -> dict[str, float]:
        """Numbers of the equations at a value."""
        varied = {name: float(one(value)) for name, one in self.series.items() if one.degree()}
        return dict(self._constant) | varied

    @property
    def unit(self) -> float:
        """What changes of the number are compared with."""
        return self.high - self.low


def number_range(
    made: Callable[[float], LoadedMechanism], low: float, high: float, where: str
) -> ContinuationNumber:
    """A number that runs from one value to another.

    Parameters
    ----------
    made : value -> the mechanism with it
    where : the path of the number, for messages

    Raises
    ------
    InputError
        The mechanism cannot be made with one of the values.
    NotComputedYet
        The number changes more than the numbers of the equations, or these not smoothly.
    """
    nodes = 0.5 * (low + high) + 0.5 * (high - low) * np.cos(
        np.pi * (np.arange(DEGREE + 1) + 0.5) / (DEGREE + 1)
    )
    several = [made(float(node)) for node in nodes]
    loaded = several[DEGREE // 2 + 1]
    values = []
    for one in several:
        values.append(loaded.numbers_of(loaded.with_numbers_of(one)))
    series = {}
    for name in loaded.numbers:
        along = np.array([value[name] for value in values])
        scale = float(np.max(np.abs(along), initial=0.0)) or 1.0
        if np.ptp(along) <= 4e-16 * scale:
            series[name] = Chebyshev([along[0]], [low, high])
            continue
        fitted = Chebyshev.fit(nodes, along, DEGREE, domain=[low, high])
        coefficients = np.where(np.abs(fitted.coef) > 1e-15 * scale, fitted.coef, 0.0)
        series[name] = Chebyshev(np.trim_zeros(coefficients, "b"), [low, high])
    found = ContinuationNumber(loaded, low, high, series)
    for share in (0.137, 0.618):
        _check_series(found, made, low + share * (high - low), where)
    return found


def _check_series(
    found: ContinuationNumber, made: Callable[[float], LoadedMechanism], value: float, where: str
) -> None:
    """Refuse a number that the numbers of the equations do not tell all about."""
    own, place = made(value), found.loaded.start
    at = place[None] + 0.1 * found.loaded.units
    exact, expanded = own.at(at), found.loaded.at(at, numbers=found.numbers(value))
    for name in ("force", "closures", "mass"):
        one, other = getattr(exact, name), getattr(expanded, name)
        scale = float(np.max(np.abs(one), initial=0.0)) or 1.0
        if not np.allclose(one, other, rtol=0.0, atol=EXACT * max(scale, 1.0)):
            what = _("equilibria are not followed along this number")
            raise NotComputedYet(where, what, _("vary a length, a mass, a stiffness, a force or a moment"))


@dataclass(frozen=True)
class _Point:
    """A point of the curve: position, number, the equations there, and the tangent."""

    place: Array
    value: float
    tangent: Array
    found: LinearEquations


class _Follower:
    """Steps along the equilibria of one mechanism."""

    def __init__(self, along: ContinuationNumber) -> None:
        self.along, self.loaded = along, along.loaded
        self.units = np.append(self.loaded.units, along.unit)
        self.turning = np.append(self.loaded.angles, False) & repeats_with_position(self.loaded)

    def apart(self, point: _Point, whole: Array) -> Array:
        """Difference of a point and another one in units; whole turns are none where the loads repeat with them."""
        found = (np.append(point.place, point.value) - whole) / self.units
        turned = np.remainder(found + np.pi, 2.0 * np.pi) - np.pi
        return np.asarray(np.where(self.turning, turned, found))

    def slopes(self, place: Array, value: float, reactions: Array) -> tuple[Array, Array]:
        """Derivatives of residual and closures by the number."""
        loaded, numbers = self.loaded, self.along.numbers(value)
        rates = {name: float(one(value)) for name, one in self.along.slopes.items()}
        return loaded.slopes_by_numbers(place, reactions, numbers, rates)

    def frame(self, place: Array, value: float) -> tuple[LinearEquations, Array, Array, Array, Array]:
        """Equations, force along the free directions, its derivative along the free ways, and these."""
        loaded = self.loaded
        found = loaded.at(place[None], numbers=self.along.numbers(value))
        reactions = loaded.reactions(found)[0]
        residual_slope, closure_slope = self.slopes(place, value, reactions)
        free = loaded.free_directions(found.rows)[0]
        rows = np.column_stack([found.rows[0], closure_slope]) * self.units / loaded.equation_units[:, None]
        if len(rows):
            _left, _sizes, right = np.linalg.svd(rows)
            ways = right[loaded.rank :].T * self.units[:, None]
        else:
            ways = np.diag(self.units)
        derivative = free.T @ (-found.stiffness[0] @ ways[:-1] + np.outer(residual_slope, ways[-1]))
        return found, free.T @ found.residual[0], derivative, ways, free

    def tangent(self, place: Array, value: float, before: Array) -> tuple[LinearEquations, Array]:
        """Unit direction of the curve, going on as before."""
        found, _force, derivative, ways, _free = self.frame(place, value)
        _left, _sizes, right = np.linalg.svd(derivative)
        along = ways @ right[-1]
        along = along / np.linalg.norm(along / self.units)
        return found, along if np.dot(along / self.units, before / self.units) >= 0.0 else -along

    def corrected_equilibrium(self, guess: Array, tangent: Array) -> Array | None:
        """The equilibrium (coordinates and number) in the plane through a guess square to the tangent."""
        here, scaled = guess.copy(), tangent / self.units
        for _step in range(CORRECTIONS):
            place = self.loaded.closed_coordinates(here[:-1], self.along.numbers(here[-1]))
            if not np.isfinite(place[0]):
                return None
            here = np.append(place, here[-1])
            _found, force, derivative, ways, _free = self.frame(place, float(here[-1]))
            matrix = np.vstack([derivative, scaled @ (ways / self.units[:, None])])
            right = -np.append(force, scaled @ ((here - guess) / self.units))
            step = ways @ np.linalg.lstsq(matrix, right, rcond=1e-13)[0]
            size = float(np.max(np.abs(step / self.units)))
            if not size < 0.5:
                return None
            here = here + step
            if size < CORRECTED:
                return np.append(
                    self.loaded.closed_coordinates(here[:-1], self.along.numbers(here[-1])), here[-1]
                )
        return here if size < 1e-9 else None

    def point(self, here: Array, before: Array) -> _Point:
        """A point of the curve with its tangent."""
        found, tangent = self.tangent(here[:-1], float(here[-1]), before)
        return _Point(here[:-1], float(here[-1]), tangent, found)

    def ahead(self, point: _Point, step: float) -> _Point | None:
        """The point a step further on; None where it is not reached smoothly."""
        whole = np.append(point.place, point.value)
        here = self.corrected_equilibrium(whole + step * point.tangent, point.tangent)
        if here is None or not np.all(np.isfinite(here)):
            return None
        moved = float(np.linalg.norm((here - whole) / self.units))
        if moved > 2.0 * abs(step) + 1e-9:
            return None
        found = self.point(here, point.tangent)
        return found if np.dot(found.tangent / self.units, point.tangent / self.units) > 0.9 else None

    def motion(self, point: _Point) -> SmallMotions:
        """Small motions about a point."""
        return small_motions(self.loaded, point.place[None], None, self.along.numbers(point.value))[0]


def follow_equilibrium(along: ContinuationNumber, place: Array, value: float) -> EquilibriumBranch:
    """The equilibria that an equilibrium (coordinates) at a value of the number belongs to."""
    follower = _Follower(along)
    start = follower.point(np.append(place, value), np.append(np.zeros(len(place)), 1.0))
    ahead, critical, closed = _steps(follower, start)
    behind: list[_Point] = []
    before: list[CriticalValue] = []
    if not closed:
        back = replace(start, tangent=-start.tangent)
        behind, before, _closed = _steps(follower, back)
    points = [*reversed(behind), start, *ahead]
    return EquilibriumBranch(
        np.array([point.value for point in points]),
        np.array([point.place for point in points]),
        tuple(follower.motion(point) for point in points),
        (*reversed(before), *critical),
    )


def _steps(follower: _Follower, start: _Point) -> tuple[list[_Point], list[CriticalValue], bool]:
    along = follower.along
    points: list[_Point] = []
    critical: list[CriticalValue] = []
    here, step = start, FIRST
    began = np.append(start.place, start.value)
    for _step in range(MOST_STEPS):
        there = follower.ahead(here, step)
        if there is None:
            step *= 0.5
            if step >= LEAST:
                continue
            if not _stiffness_jumps(follower, here):
                break
            critical.append(CriticalValue(KINK, here.value, here.place))
            beyond = _point_beyond(follower, here)
            if beyond is None:
                break
            points.append(beyond)
            here, step = beyond, FIRST
            continue
        if not along.low <= there.value <= along.high:
            end = along.low if there.value < along.low else along.high
            last = _point_at_value(follower, here, step, end)
            if last is not None:
                critical += _between(follower, here, last[0], last[1])
                points.append(last[0])
            break
        critical += _between(follower, here, there, step)
        points.append(there)
        gone = np.linalg.norm(follower.apart(there, began))
        if len(points) > 5 and gone < 0.75 * step:
            return points, critical, True
        here, step = there, min(LONGEST, 1.4 * step)
    return points, critical, False


def _stiffness_jumps(follower: _Follower, here: _Point) -> bool:
    """Whether a force has a kink at a point."""
    along, loaded = follower.along, follower.loaded
    scaled = here.tangent / np.max(np.abs(here.tangent / follower.units))
    found = []
    for side in (-BESIDE, BESIDE):
        whole = np.append(here.place, here.value) + side * scaled
        at = loaded.at(whole[None, :-1], numbers=along.numbers(float(whole[-1])))
        found.append(at.stiffness[0] * np.outer(loaded.units, loaded.units))
    return float(np.max(np.abs(found[1] - found[0]))) > JUMP * float(np.max(np.abs(found)))


def _point_beyond(follower: _Follower, here: _Point) -> _Point | None:
    """The point of the branch beyond a kink at which it turns sharply; None where it ends or turns back."""
    along, moved = follower.along, BEYOND * follower.along.unit
    value = here.value + (moved if here.tangent[-1] > 0.0 else -moved)
    if not along.low < value < along.high:
        return None
    place = settled_equilibria(follower.loaded, here.place[None], along.numbers(value))[0]
    way = np.append(place - here.place, value - here.value)
    # as far as the number goes, or some times as far where the position is soft
    if not np.max(np.abs(way / follower.units)) < 100.0 * BEYOND:
        return None
    return follower.point(np.append(place, value), way)


def _point_at_value(
    follower: _Follower, here: _Point, step: float, value: float
) -> tuple[_Point, float] | None:
    """The point within a step at which the number has a value, and how far it is."""

    def beyond(far: float) -> float:
        there = follower.ahead(here, far) if far else here
        return (there.value if there is not None else here.value) - value

    if here.value == value or beyond(0.0) * beyond(step) > 0.0:
        return None
    far = float(brentq(beyond, 0.0, step, xtol=1e-15, rtol=1e-14))
    found = follower.ahead(here, far)
    return None if found is None else (replace(found, value=value), far)


def _between(follower: _Follower, here: _Point, there: _Point, step: float) -> list[CriticalValue]:
    """Critical values within a step."""
    if here.tangent[-1] * there.tangent[-1] < 0.0:
        return _locate_critical_values(follower, here, step, FOLD, lambda point: float(point.tangent[-1]))
    if _determinant(follower, here) * _determinant(follower, there) < 0.0:
        return _locate_critical_values(
            follower, here, step, BRANCH_POINT, lambda point: _determinant(follower, point)
        )
    growth = [_growth_of_oscillations(follower.motion(point)) for point in (here, there)]
    if growth[0] * growth[1] < 0.0:
        return _locate_critical_values(
            follower, here, step, HOPF, lambda point: _growth_of_oscillations(follower.motion(point))
        )
    return []


def _locate_critical_values(
    follower: _Follower, here: _Point, step: float, kind: str, measure: Callable[[_Point], float]
) -> list[CriticalValue]:
    reached: dict[float, _Point] = {}

    def at(far: float) -> float:
        point = follower.ahead(here, far) if far else here
        reached[far] = here if point is None else point
        return measure(reached[far])

    if at(0.0) * at(step) > 0.0:
        return []
    far = float(brentq(at, 0.0, step, xtol=1e-15, rtol=1e-14))
    at(far)
    point = reached[far]
    frequency = 0.0
    if kind == HOPF:
        values = follower.motion(point).eigenvalues
        frequency = float(values[np.argmin(np.abs(values.real))].imag)
    return [CriticalValue(kind, point.value, point.place, frequency)]


def _determinant(follower: _Follower, point: _Point) -> float:
    """Determinant of the stiffness along the free directions, without units; its sign is what counts."""
    motion = follower.motion(point)
    return float(np.linalg.det(motion.stiffness / max(float(np.max(np.abs(motion.stiffness))), 1e-300)))


def _growth_of_oscillations(motion: SmallMotions) -> float:
    """The greatest real part of the oscillations; positive numbers alone where rounding is all there is."""
    values = motion.eigenvalues
    scale = float(np.max(np.abs(values), initial=0.0))
    oscillating = values[values.imag > 1e-6 * scale]
    greatest = float(np.max(oscillating.real, initial=-np.inf)) if len(oscillating) else -np.inf
    return greatest if np.isfinite(greatest) and abs(greatest) > 1e-9 * scale else 0.0


def branches(
    along: ContinuationNumber, places_at: Sequence[tuple[float, Array]]
) -> tuple[EquilibriumBranch, ...]:
    """The branches through equilibria (n, coordinates) at some values of the number, each once."""
    found: list[EquilibriumBranch] = []
    for value, places in places_at:
        for place in settled_equilibria(along.loaded, places, along.numbers(value)):
            if np.isfinite(place[0]) and not any(_has(along, branch, value, place) for branch in found):
                found.append(follow_equilibrium(along, place, value))
    return tuple(found)


def _has(along: ContinuationNumber, branch: EquilibriumBranch, value: float, place: Array) -> bool:
    """Whether a branch runs through an equilibrium: settled from where it crosses the value."""
    passes = np.flatnonzero((branch.values[:-1] - value) * (branch.values[1:] - value) <= 0.0)
    for k in passes:
        wide = branch.values[k + 1] - branch.values[k]
        share = (value - branch.values[k]) / wide if wide else 0.0
        guess = branch.places[k] + share * (branch.places[k + 1] - branch.places[k])
        apart = np.remainder((guess - place) / along.loaded.units + np.pi, 2.0 * np.pi) - np.pi
        if np.max(np.abs(apart)) < 5e-3:
            here = settled_equilibria(along.loaded, guess[None], along.numbers(value))[0]
            near = np.remainder((here - place) / along.loaded.units + np.pi, 2.0 * np.pi) - np.pi
            if np.isfinite(here[0]) and np.max(np.abs(near)) < SAME:
                return True
    return False
