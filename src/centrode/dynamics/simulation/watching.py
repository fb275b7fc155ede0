"""What is watched while an integration steps: that it gets on, how far it is, when the stiff scheme takes over."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import copysign
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.simulation.course import VALUE, Course
from centrode.dynamics.simulation.field import Field, Forces, Leg, too_far, without_value
from centrode.errors import MotionError
from centrode.locale import _

State: TypeAlias = npt.NDArray[np.float64]

MOST_STEPS = 150_000
"""Steps of one simulation: some two minutes, and 200 MB of their interpolants."""
EDGE = 3.0
"""Step times damping rate from which a step counts as held back by stability."""
ASIDE = 1e-6
"""Change of the rate, as a share of it, from which the damping rate is taken."""
LEAST_RATE = 1e-280
"""Rate below which a share of it would be no number."""
HELD_BACK = 15
"""Steps so held back after which the stiff scheme takes over."""


@dataclass(frozen=True)
class Until:
    """When to end: at a time [s], or at a distance of the drive's value from the start."""

    time: float
    way: float | None


@dataclass
class Watch:
    """Counts steps and watches them.

    Attributes
    ----------
    field, until, course : what is integrated, how far, and what is found
    stiff : whether the stiff scheme is used from now on
    tell : progress, a share of the whole
    most : steps
    start : value of the drive
    """

    field: Field
    until: Until
    course: Course
    stiff: bool
    tell: Callable[[float], None] | None
    most: int
    start: float = 0.0
    steps: int = 0
    held_back: int = 0

    def count(self, leg: Leg, begun: State, solver: Any, message: str | None) -> None:
        self.steps += 1
        value = float(begun[VALUE] + solver.y[0])
        if solver.status == "failed" or not np.isfinite(solver.y).all():
            raise (
                without_value(solver.t, value)
                if message is None
                else MotionError(
                    "[simulation]",
                    _("no step is small enough at t = {time:.6g} s, drive at {value:.6g}").format(
                        time=solver.t, value=value
                    ),
                    _('choose scheme = "stiff", or a greater tolerance'),
                )
            )
        if self.field.is_too_far(value, self.start):
            raise too_far(solver.t)
        if self.steps > self.most:
            raise MotionError(
                "[simulation]",
                _("{count} steps were taken up to t = {time:.6g} s").format(count=self.most, time=solver.t),
                _('ask for a shorter time, or choose scheme = "stiff" or a greater tolerance'),
            )
        if self.tell is not None and self.steps % 20 == 0:
            way = self.until.way
            share = solver.t / self.until.time if np.isfinite(self.until.time) else 0.0
            self.tell(share if way is None else max(share, abs(value - self.start) / way))
        if not self.stiff:
            self._watch(leg, solver, value)

    def _watch(self, leg: Leg, solver: Any, value: float) -> None:
        """Change to the stiff scheme where damping holds the steps back."""
        rate = float(solver.y[1])
        # away from zero: beyond it friction would be another one
        more = rate + copysign(ASIDE * max(abs(rate), float(solver.atol[1]), LEAST_RATE), rate or leg.sense)

        def slowed(speed: float) -> float:
            forces: Forces = self.field.forces(leg, solver.t, value, speed)
            return float(forces.acceleration(speed))

        damping = abs(slowed(more) - slowed(rate)) / (more - rate)
        held = damping * (solver.step_size or 0.0) > EDGE
        self.held_back = self.held_back + 1 if held else 0
        if self.held_back >= HELD_BACK:
            self.stiff = True
            self.course.scheme = "adaptive, then stiff"
