"""The classical Runge-Kutta scheme of fourth order with equal steps, as sources integrate: no step ends at an event.

A step needs four right sides of plain numbers, thousands of times: series of a panel are kept as tuples of their
coefficients and evaluated by Horner's rule, which for so few numbers takes less time than arrays do.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable
from math import isfinite
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from centrode.dynamics.loads import Situation
from centrode.dynamics.simulation.equation_of_motion import (
    ALONG,
    BACKWARDS,
    COORDINATE,
    EACH,
    FORMULAS,
    FORWARDS,
    INERTIA,
    NAN,
    SLOPE,
    SORTS,
    SPEED,
    STATES,
    VALUE,
    Ending,
    Field,
    FieldLeg,
    Occasion,
    ReducedTrajectory,
    TrajectoryPiece,
    too_far,
    without_value,
)
from centrode.dynamics.simulation.equation_of_motion import Array as States
from centrode.dynamics.simulation.interpolation import Interpolant
from centrode.errors import MotionError
from centrode.locale import _
from centrode.numerics.operations import SCALARS

if TYPE_CHECKING:
    from centrode.dynamics.loads import LoadLaw

Series: TypeAlias = tuple[float, ...]
Slopes: TypeAlias = tuple[float, float, float, float]
"""Acceleration of the drive, and powers of the drive, of friction and of other loads."""

TOLD = 256
"""Steps between two reports of progress."""


class StepSlopes:
    """Right sides of the equation of motion as plain numbers, for one state after the other.

    Attributes
    ----------
    field : equation of motion
    """

    def __init__(self, field: Field) -> None:
        self.field = field
        self.sense = 0.0
        # an empty panel: the first state looks up its own
        self.low, self.high = 1.0, -1.0
        drives = field.driving.formula.used
        self.constant = None if drives else field.driving.at(0.0, 0.0, 0.0)

    def at(self, t: float, value: float, rate: float) -> Slopes | None:
        """Slopes at a state; None beyond the range of the mechanism. MotionError where a formula has no value."""
        tracks = self.field.tracks
        if not tracks.low <= value <= tracks.high:  # which an absent number is not either
            return None
        # at rest loads act as they would when the drive sets out in its own sense
        sense = 1.0 if rate > 0.0 else -1.0 if rate < 0.0 else tracks.rows.sense
        if sense != self.sense or not self.low <= value < self.high:
            self._look_up(value, sense)
        s = self.factor * value + self.offset
        inertia, slope = _value(self.inertia, s), _value(self.slope, s)
        stored, friction, other = [_value(c, s) if c else 0.0 for c in self.moments]
        if self.formulas:
            loads = [stored, friction, other]
            for place, along, moment in self._of_formulas(t, value, rate, s):
                loads[place] += moment * along
            stored, friction, other = loads
        driving = self.field.driving.at(t, value, rate) if self.constant is None else self.constant
        acceleration = (stored + friction + other + driving - 0.5 * slope * rate * rate) / inertia
        if not isfinite(acceleration):
            raise without_value(t, value)
        return acceleration, driving * rate, friction * rate, other * rate

    def _of_formulas(self, t: float, value: float, rate: float, s: float) -> list[tuple[int, float, float]]:
        """Sort, derivative of what it works along, and amount of each load by a formula."""
        found = []
        for place, law, sense, (coordinate, speed, along) in self.formulas:
            x = _value(coordinate, s) if coordinate else 0.0
            v = _value(speed, s) * rate if speed else 0.0
            try:
                amount = float(law(Situation(t, value, x, v, sense, SCALARS)))
            except (ArithmeticError, ValueError):
                amount = NAN
            found.append((place, _value(along, s), amount))
        return found

    def _look_up(self, value: float, sense: float) -> None:
        """The panel of a value that is passed in a sense."""
        leg: FieldLeg = self.field.leg_at(value, sense)
        edges, shift = leg.edges, leg.shift
        inside = min(max(value, leg.low), leg.high) + shift
        panel = min(max(bisect_right(edges, inside) - 1, 0), len(edges) - 2)
        low, high = edges[panel], edges[panel + 1]
        powers = leg.powers[panel].copy()
        if leg.grown is not None:
            powers[:, 0] += leg.grown
        # a stretch that begins where the motion ends is empty
        self.factor = 2.0 / (high - low) if high > low else 0.0
        self.offset = self.factor * (shift - 0.5 * (low + high))
        self.sense = sense
        self.low, self.high = max(low - shift, leg.low), min(high - shift, leg.high)
        self.inertia, self.slope = _series(powers[INERTIA]), _series(powers[SLOPE])
        first = FORWARDS if sense > 0.0 else BACKWARDS
        self.moments = tuple(_series(row) for row in powers[first : first + len(SORTS)])
        self.formulas: list[tuple[int, LoadLaw, float, tuple[Series, Series, Series]]] = []
        for j, term in enumerate(self.field.tracks.rows.formulas):
            if not leg.gates[j]:
                continue
            law, own = term.effort.amount, powers[FORMULAS + EACH * j :]
            # what the law does not look at is not computed; a plain sum of friction resists the drive, whichever way
            rows = (
                _series(own[COORDINATE]) if "x" in law.uses else (),
                _series(own[SPEED]) if "v" in law.uses else (),
                _series(own[ALONG] * (sense if term.effort.works is not None else 1.0)),
            )
            self.formulas.append((SORTS.index(term.sort), law, leg.senses[j], rows))


def _series(coefficients: States) -> Series:
    """The coefficients of a series; of one that is zero none."""
    return tuple(coefficients.tolist()) if coefficients.any() else ()


def _value(series: Series, s: float) -> float:
    """A series of `NODES` coefficients, or of none, at a place; Horner's rule in a loop would take twice as long."""
    if not series:
        return 0.0
    a, b, c, d, e, f, g, h, i, j, k, m = series
    return a + s * (
        b + s * (c + s * (d + s * (e + s * (f + s * (g + s * (h + s * (i + s * (j + s * (k + s * m)))))))))
    )


def fixed_steps(
    field: Field,
    value: float,
    rate: float,
    duration: float,
    steps: int,
    tell: Callable[[float], None] | None = None,
) -> ReducedTrajectory:
    """The course by equal steps: no step ends at a jump or a standstill, as with any fixed-step scheme."""
    step = duration / steps
    states = np.empty((STATES, steps + 1))
    states[:, 0] = value, rate, *[0.0] * (STATES - 2)
    slopes = StepSlopes(field)
    y = tuple(states[:, 0].tolist())
    done = 0
    ended: Ending = "duration"
    try:
        for k in range(steps):
            after = _next_state(slopes, k * step, y, step)
            if after is None:
                ended = field.tracks.ending(float(states[VALUE, done]))
                break
            if field.is_too_far(after[VALUE], value):
                raise too_far((k + 1) * step)
            y = after
            done = k + 1
            states[:, done] = y
            if tell is not None and done % TOLD == 0:
                tell(done / steps)
    except KeyboardInterrupt:
        if not done:
            raise
        ended = "interrupted"
    return _trajectory_of_states(field, states[:, : done + 1], step, ended, 4 * steps)


def _next_state(slopes: StepSlopes, t: float, y: Series, h: float) -> Series | None:
    """States a step later; None where it leads beyond a limit."""
    q, v, *works = y
    half = 0.5 * h
    first = slopes.at(t, q, v)
    if first is None:
        return None
    v2 = v + half * first[0]
    second = slopes.at(t + half, q + half * v, v2)
    if second is None:
        return None
    v3 = v + half * second[0]
    third = slopes.at(t + half, q + half * v2, v3)
    if third is None:
        return None
    v4 = v + h * third[0]
    fourth = slopes.at(t + h, q + h * v3, v4)
    if fourth is None:
        return None
    sixth = h / 6.0
    value = q + sixth * (v + 2.0 * v2 + 2.0 * v3 + v4)
    speed, *done = (
        before + sixth * (a + 2.0 * b + 2.0 * c + d)
        for before, a, b, c, d in zip((v, *works), first, second, third, fourth, strict=True)
    )
    # beyond the range there is no mechanism: the last step was one too many
    tracks = slopes.field.tracks
    return (value, speed, *done) if tracks.low <= value <= tracks.high else None


def _trajectory_of_states(
    field: Field, found: States, step: float, ended: Ending, evaluations: int
) -> ReducedTrajectory:
    """States (STATES, steps + 1) at even times as a course; between two steps an interpolant of the same order."""
    count = found.shape[1] - 1
    if ended in ("limit", "change point") and count == 0:
        raise MotionError(
            "[simulation]",
            _("the first step passes a limit or a change point"),
            _("give more steps, or another start"),
        )
    inner = StepSlopes(field)

    def slopes(t: float, y: States) -> States:
        # at the end of the motion the interpolant may look a little beyond it
        inside = min(max(float(y[VALUE]), field.tracks.low), field.tracks.high)
        known = inner.at(t, inside, float(y[1]))
        return np.full(STATES, np.nan) if known is None else np.array([float(y[1]), *known])

    occasions = []
    if ended in ("limit", "change point"):
        last = float(found[VALUE, -1])
        occasions = [Occasion(ended, count * step, last if ended == "limit" else field.tracks.end(last))]
    piece = TrajectoryPiece(0.0, count * step, Interpolant(found, step, slopes), 1.0)
    return ReducedTrajectory([piece], occasions, ended, evaluations, "runge-kutta-4")


def even_times(course: ReducedTrajectory, step: float, samples: int) -> States:
    """Times of steps, as evenly spaced as may be."""
    count = round(course.last / step)
    return np.unique(np.rint(np.linspace(0, count, samples))) * step
