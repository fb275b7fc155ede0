"""How the drive moves while reactions are asked for."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.jets import Jet
from centrode.dynamics.burden import Burden
from centrode.dynamics.reducer import Reducer
from centrode.dynamics.several import refuse_drive_in_formulas
from centrode.dynamics.states import Moving
from centrode.dynamics.steady_motion.solution import solution_of
from centrode.dynamics.steady_motion.steady import turned_at
from centrode.kinematics.paths import JETS
from centrode.kinematics.ready import Ready
from centrode.kinematics.solve import Solved
from centrode.kinematics.spans import Span
from centrode.model.mechanism import Mechanism

Array: TypeAlias = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Pace:
    """Speed and acceleration of the path's parameter at samples, and whose they are.

    Attributes
    ----------
    acceleration : (n)
    source : "drive", "machine" or "steady"
    """

    moving: Moving
    acceleration: Array
    source: str


def pace_of(solved: Solved, burden: Burden) -> Pace:
    """As `reduce` takes it: the mean speed of a machine, where the drive has a constant speed; else the drive's own."""
    span, prepared = solved.span, solved.ready
    path = prepared.kinematics.path
    if path.by_time:
        refuse_drive_in_formulas(burden)
    if path.by_time or prepared.mechanism.machine is None or not path.parameter.is_uniform:
        return _along(span, "drive")
    moving = Reducer(prepared, burden).moving(span.parameter)
    return Pace(moving, np.zeros(len(span.parameter)), "machine")


def steady_span(
    mechanism: Mechanism, samples: int | None, at: npt.ArrayLike | None
) -> tuple[Ready, Span, Pace]:
    """Samples of a machine in steady motion, with the real speed of its drive; raises as `steady_motion` does."""
    found = solution_of(mechanism)
    turned, cycle, speed = turned_at(found, samples, at), found.cycle, found.speed
    span = Span(
        speed.time(turned),
        cycle.value(turned),
        cycle.sense * speed.at(turned),
        cycle.sense * speed.acceleration(turned),
    )
    return found.prepared, span, _along(span, "steady")


def rates_of(solved: Solved, pace: Pace) -> Array:
    """Speeds of the drives (samples, drives)."""
    path = solved.ready.kinematics.path
    if not path.by_time:
        return pace.moving.rate[:, None]
    time = Jet.variable(solved.span.time, 1)
    values = path.drive_values(JETS, time).values()
    speeds = [value.derivative(1) if isinstance(value, Jet) else 0.0 for value in values]
    return np.stack([np.broadcast_to(speed, solved.span.time.shape) for speed in speeds], axis=-1)


def _along(span: Span, source: str) -> Pace:
    return Pace(Moving(span.time, span.parameter, span.rate), span.second_rate, source)
