"""The classical Runge-Kutta scheme of fourth order with equal steps, as sources integrate: no step ends at an event.

A step needs four right sides of plain numbers, thousands of times: series of a panel are kept as tuples of their
coefficients and evaluated by Horner's rule, which for so few numbers takes less time than arrays do. What laws make of
their values is traced once and is a function of Python.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable
from dataclasses import dataclass
from math import isfinite
from typing import TypeAlias

import numpy as np

from centrode.dynamics.forward_dynamics.broken_lines import broken_line_of
from centrode.dynamics.loads import LoadTable, Situation
from centrode.dynamics.simulation.equation_of_motion import (
    ALONG,
    BACKWARDS,
    COORDINATE,
    EACH,
    FORMULAS,
    FORWARDS,
    INERTIA,
    SLOPE,
    SORTS,
    SPEED,
    STATES,
    TOLERANCE,
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
from centrode.numerics.expressions import EXPRESSIONS, variable
from centrode.numerics.graphs import Graph
from centrode.numerics.python_functions import Function, python_function

Series: TypeAlias = tuple[float, ...]
Slopes: TypeAlias = tuple[float, float, float, float]
"""Acceleration of the drive, and powers of the drive, of friction and of other loads."""

TOLD = 256
"""Steps between two reports of progress."""


NOTHING = -1
"""Stands for a series that is zero."""


@dataclass(frozen=True)
class RightSide:
    """A form of the right side: laws alone, so that panels share its function.

    Attributes
    ----------
    places : of inertia, its slope, moments by sort, and what formulas ask for: numbers of series, or NOTHING
    acting : numbers of the formulas that act, and the sense in which the coordinate of each goes
    """

    places: tuple[int, ...]
    acting: tuple[tuple[int, float], ...]


Panel: TypeAlias = tuple[list[Series], list[float], Function]
"""Series that are evaluated, values of those that are constant, and the function of both."""


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
        self.functions: dict[RightSide, Function] = {}
        self.panels: dict[tuple[object, ...], Panel] = {}
        formulas = [(SORTS.index(term.sort), term.effort) for term in field.tracks.rows.formulas]
        # a table looks rows up in arrays; as a formula it is compared with a row after the other
        self.laws = [
            (sort, broken_line_of(effort.amount) if isinstance(effort.amount, LoadTable) else effort.amount)
            for sort, effort in formulas
        ]
        # a plain sum of friction resists the drive, whichever way it goes
        self.resists = [effort.works is not None for _sort, effort in formulas]

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
        slopes = self.function([t, value, rate, *[_value(c, s) for c in self.series], *self.constants])
        if not isfinite(slopes[0]):
            raise without_value(t, value)
        return slopes

    def _look_up(self, value: float, sense: float) -> None:
        """The panel of a value that is passed in a sense."""
        leg: FieldLeg = self.field.leg_at(value, sense)
        edges, shift = leg.edges, leg.shift
        inside = min(max(value, leg.low), leg.high) + shift
        panel = min(max(bisect_right(edges, inside) - 1, 0), len(edges) - 2)
        low, high = edges[panel], edges[panel + 1]
        # a stretch that begins where the motion ends is empty
        self.factor = 2.0 / (high - low) if high > low else 0.0
        self.offset = self.factor * (shift - 0.5 * (low + high))
        self.sense = sense
        self.low, self.high = max(low - shift, leg.low), min(high - shift, leg.high)
        grown = leg.grown is not None and bool(leg.grown.any())
        # the stretches of a period come back again and again, and stay where they are
        key = id(leg.powers), panel, sense, leg.gates, leg.senses
        found = None if grown else self.panels.get(key)
        if found is None:
            found = self._panel(leg, panel, sense)
            if not grown:
                self.panels[key] = found
        self.series, self.constants, self.function = found

    def _panel(self, leg: FieldLeg, panel: int, sense: float) -> Panel:
        """What is evaluated on a panel."""
        powers = leg.powers[panel].copy()
        if leg.grown is not None:
            powers[:, 0] += leg.grown
        first = FORWARDS if sense > 0.0 else BACKWARDS
        rows = [INERTIA, SLOPE, *range(first, first + len(SORTS))]
        acting = []
        for j, (_sort, law) in enumerate(self.laws):
            if leg.gates[j]:
                own = FORMULAS + EACH * j
                if self.resists[j]:
                    powers[own + ALONG] *= sense
                # what the law does not look at is not computed
                powers[own + COORDINATE] *= "x" in law.uses
                powers[own + SPEED] *= "v" in law.uses
                acting.append((j, leg.senses[j]))
                rows += [own + COORDINATE, own + SPEED, own + ALONG]
        each = [_series(powers[row]) for row in rows]
        # a joint that a load turns in often moves as what the load works along does, or as another one
        series = list(dict.fromkeys(row for row in each if len(row) > 1))
        single = list(dict.fromkeys(row for row in each if len(row) == 1))
        places = {row: k for k, row in enumerate([*series, *single])}
        side = RightSide(tuple(places.get(row, NOTHING) for row in each), tuple(acting))
        if side not in self.functions:
            self.functions[side] = self._traced_function(side)
        return series, [row[0] for row in single], self.functions[side]

    def _traced_function(self, side: RightSide) -> Function:
        """A function of time, value and rate of the drive and the values of the series, laws and all."""
        t, q, rate = variable("t"), variable("q"), variable("rate")
        count = max(side.places) + 1
        known = [variable(f"series {k}") for k in range(count)]
        inertia, slope, *moments = [0.0 if k == NOTHING else known[k] for k in side.places]
        loads = moments[: len(SORTS)]
        for (j, sense), (x, speed, along) in zip(
            side.acting, zip(*[iter(moments[len(SORTS) :])] * 3, strict=True), strict=True
        ):
            sort, law = self.laws[j]
            loads[sort] = loads[sort] + law(Situation(t, q, x, speed * rate, sense, EXPRESSIONS)) * along
        driving = self.field.driving.over(EXPRESSIONS, t, q, rate)
        stored, friction, other = loads
        acceleration = (stored + friction + other + driving - 0.5 * slope * rate * rate) / inertia
        outputs = (acceleration, driving * rate, friction * rate, other * rate)
        graph = Graph.of({str(k): each for k, each in enumerate(outputs)})
        return python_function(graph, ["t", "q", "rate", *(f"series {k}" for k in range(count))])


def _series(coefficients: States) -> Series:
    """The coefficients of a series: all of them, one of a constant, of one that is zero none."""
    if not coefficients.any():
        return ()
    first, rest = float(coefficients[0]), float(np.sum(np.abs(coefficients[1:])))
    return (first,) if rest <= TOLERANCE * abs(first) else tuple(coefficients.tolist())


def _value(series: Series, s: float) -> float:
    """A series of `NODES` coefficients at a place; Horner's rule in a loop would take twice as long."""
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
