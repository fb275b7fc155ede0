"""The classical Runge-Kutta scheme of fourth order with equal steps, as the source integrates."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from centrode.dynamics.simulation.course import STATES, VALUE, Course, Ending, Occasion, Piece
from centrode.dynamics.simulation.course import Array as States
from centrode.dynamics.simulation.field import Field, too_far, without_value
from centrode.dynamics.simulation.interpolation import Interpolant
from centrode.errors import MotionError
from centrode.locale import _

TOLD = 256
"""Steps after which it is told how far it is."""


def fixed_steps(
    field: Field,
    value: float,
    rate: float,
    duration: float,
    steps: int,
    tell: Callable[[float], None] | None = None,
) -> Course:
    """The course by equal steps: no step ends at a jump or a standstill, as with any fixed-step scheme."""
    step = duration / steps
    found = np.empty((STATES, steps + 1))
    y: States = np.array([value, rate, *[0.0] * (STATES - 2)])
    found[:, 0] = y
    done = 0
    ended: Ending = "duration"
    try:
        for k in range(steps):
            y = next_state(field, k * step, y, step)
            if not np.isfinite(y).all():
                ended = field.tracks.ending(float(found[VALUE, done]))
                break
            if field.is_too_far(float(y[VALUE]), value):
                raise too_far((k + 1) * step)
            done = k + 1
            found[:, done] = y
            if tell is not None and done % TOLD == 0:
                tell(done / steps)
    except KeyboardInterrupt:
        if not done:
            raise
        ended = "interrupted"
    return course_of(field, found[:, : done + 1], step, ended, 4 * steps)


def course_of(field: Field, found: States, step: float, ended: Ending, evaluations: int) -> Course:
    """States (STATES, steps + 1) at even times as a course; between two steps an interpolant of the same order."""
    count = found.shape[1] - 1
    if ended in ("limit", "change point") and count == 0:
        raise MotionError(
            "[simulation]",
            _("the first step leads beyond a limit or a change point"),
            _("ask for more steps, or another start"),
        )

    def slopes(t: float, y: States) -> States:
        inside = y.copy()
        inside[VALUE] = min(max(y[VALUE], field.tracks.low), field.tracks.high)
        return _rates(field, t, inside)

    occasions = []
    if ended in ("limit", "change point"):
        last = float(found[VALUE, -1])
        occasions = [Occasion(ended, count * step, last if ended == "limit" else field.tracks.end(last))]
    piece = Piece(0.0, count * step, Interpolant(found, step, slopes), 1.0)
    return Course([piece], occasions, ended, evaluations, "runge-kutta-4")


def even_times(course: Course, step: float, samples: int) -> States:
    """Times of steps, as evenly spaced as may be."""
    count = round(course.last / step)
    return np.unique(np.rint(np.linspace(0, count, samples))) * step


def next_state(field: Field, t: float, y: States, step: float) -> States:
    """States (STATES) a step later, NaN where it leads beyond a limit; MotionError where a formula has no value."""
    k1 = _rates(field, t, y)
    k2 = _rates(field, t + 0.5 * step, y + 0.5 * step * k1)
    k3 = _rates(field, t + 0.5 * step, y + 0.5 * step * k2)
    k4 = _rates(field, t + step, y + step * k3)
    found = np.asarray(y + step / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4))
    return found if field.tracks.low <= found[VALUE] <= field.tracks.high else np.full(STATES, np.nan)


def _rates(field: Field, t: float, y: States) -> States:
    """Slopes of the states; NaN beyond a limit."""
    value, rate = float(y[0]), float(y[1])
    tracks = field.tracks
    if not np.isfinite(value) or not tracks.low <= value <= tracks.high:
        return np.full(STATES, np.nan)
    sense = 1.0 if rate > 0.0 else -1.0 if rate < 0.0 else tracks.rows.sense
    forces = field.forces(field.leg_at(value, sense), t, value, rate)
    found = np.array(
        [rate, forces.acceleration(rate), forces.driving * rate, forces.friction * rate, forces.other * rate]
    )
    if not np.isfinite(found).all():
        raise without_value(t, value)
    return found
