"""Change points on the way of an integration: how near steps may come, and what leads on behind them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.forward_dynamics.change_points import Detour, HalfCircles
from centrode.dynamics.forward_dynamics.event_steps import EventWatch
from centrode.dynamics.forward_dynamics.initial_position import units_of
from centrode.dynamics.forward_dynamics.motion_functions import MotionFunctions
from centrode.dynamics.forward_dynamics.motion_problem import (
    AHEAD,
    CONTROLS,
    FAR,
    GUARD,
    INDEPENDENCE,
    LIMIT,
    LOOKED,
    NEVER,
)
from centrode.dynamics.forward_dynamics.motion_steps import (
    CROSSING,
    NEAR_MISS,
    Event,
)
from centrode.locale import _
from centrode.numerics.initial_value_problems import END, HEADER, STEP, TIME
from centrode.numerics.integrators import Integrator
from centrode.numerics.scans import evaluate

Array: TypeAlias = npt.NDArray[np.float64]

# how near a step may come to a change point, and how far it is taken back
TOO_NEAR = 0.05
"""A change point is passed from a place from which the fastest link turns by more than this up to it."""
ROWS = 1024
"""Steps taken again at most on the way to a place from which a change point is passed."""
# how independent closures are that lose rank, or nearly so
DOUBTFUL = 1e-3
"""Closures that come nearer to losing rank than this, and do not, leave it doubtful how the motion goes on."""
LOST = 1e-4
"""Closures that are no more independent than this have lost rank, even where no smooth motion leads through."""
# what is compared behind a change point
ENERGY = 1e-7
"""Energies before and behind a change point agree to this share of the kinetic energy."""


@dataclass(frozen=True)
class ChangePointPassage:
    """Passes change points of one motion.

    Attributes
    ----------
    motion : its equations as functions
    half_circles : along which they are followed in complex time
    take : the integrator
    parameters : (parameters, 1) of its steps
    rate : what speeds are compared with [1/s]
    tolerance : of the error of a step
    """

    motion: MotionFunctions
    half_circles: HalfCircles
    take: Integrator
    parameters: Array
    rate: float
    tolerance: float

    def step_back(
        self, state: Array, kept: Sequence[Array], detours: Sequence[Detour]
    ) -> tuple[Array, list[Array]] | None:
        """The state at a good distance before a change point that a step came too near, and the rows up to there.

        Beside a change point the speeds are those of equations that have nearly lost rank, and miss by what rounding
        makes of that. None where the distance is good already.
        """
        carried, names = self.motion.problem.carried_names, self.motion.names
        place = HEADER + carried.index(AHEAD)
        units = units_of(self.motion.equations.tree, self.motion.equations.numbers)
        fast = np.abs(state[HEADER:, 0][names.part(names.speeds)]) / units
        fastest = max(self.rate, float(np.max(fast, initial=0.0)))
        time, ahead = float(state[0, 0]), float(state[place, 0])
        if not ahead * fastest < TOO_NEAR:
            return None
        until = max(time + ahead - 0.5 * FAR / fastest, detours[-1].end if detours else 0.0)
        rows = list(kept)
        while len(rows) > 1 and rows[-1][0, 0] > until:
            rows.pop()
        rows[-1] = rows[-1][: max(1, int(np.searchsorted(rows[-1][:, 0], until, side="right")))]
        row = rows[-1][-1]
        before = np.concatenate([[row[0], until - row[0], 0.0, 0.0], row[1:]])[:, None]
        if until > row[0]:
            before[HEADER + carried.index(GUARD)], before[HEADER + carried.index(LIMIT)] = 0.0, NEVER
            ended = self.parameters.copy()
            ended[CONTROLS.index(END)] = until
            between = np.empty((ROWS, len(row)))
            before = self.take.run(ended, before, ROWS, between)
            rows.append(between[: int(before[3, 0])])
        before[place] = time + ahead - before[0]
        return before, rows

    def lead_on(
        self, state: Array, watch: EventWatch | None = None
    ) -> tuple[Detour | None, Event | None] | str:
        """Pass the change point ahead, if it is one; the state is that behind it then.

        Returns the detour and the event, or why it is not passed.
        """
        names, problem = self.motion.names, self.motion.problem
        carried = list(problem.carried_names)
        row = {name: HEADER + carried.index(name) for name in (AHEAD, LOOKED, GUARD, LIMIT, INDEPENDENCE)}
        time, ahead, near = (
            float(state[0, 0]),
            float(state[row[AHEAD], 0]),
            float(state[row[INDEPENDENCE], 0]),
        )
        units = units_of(self.motion.equations.tree, self.motion.equations.numbers)
        measured = [(names.part(kind), units) for kind in (names.coordinates, names.speeds)]
        detour = self.half_circles.around(self.parameters[:, 0], time, state[HEADER:, 0], ahead, measured)
        if not detour.is_analytic:
            if near < LOST:
                what = _("a change point at {time:.9g} s through which no smooth motion leads")
                return what.format(time=detour.centre)
            state[row[LOOKED], 0], state[row[GUARD], 0] = 0.5 * near, 0.0
            return None, Event(detour.centre, NEAR_MISS, near) if near < DOUBTFUL else None
        count = len(problem.unknowns)
        if watch is not None:
            clear = watch.clear_until(detour, state[HEADER:, 0])
            if clear is None:
                # something happens before the change point is reached: it is integrated straight up to there
                state[row[LOOKED], 0], state[row[GUARD], 0] = 0.5 * near, 0.0
                return None, None
            detour = replace(detour, short=detour.end - clear)
        before = self.motion.energies_at(state[HEADER:, 0], time)
        landed = detour.at(np.array([detour.end]))[:, 0]
        values = dict(zip(carried, state[HEADER:, 0], strict=True)) | dict(
            zip(carried[:count], landed, strict=True)
        )
        given = dict(zip(problem.parameters, self.parameters[:, 0], strict=True))
        values[INDEPENDENCE] = 0.0
        closed = evaluate(problem.of_closing, values | given | {TIME: detour.end, STEP: 1.0})
        state[HEADER:, 0] = [float(closed[name]) for name in carried]
        state[0, 0] = detour.end
        state[1, 0] = 0.25 * ahead
        after = self.motion.energies_at(state[HEADER:, 0], detour.end)
        scale = max(abs(before[0]), abs(after[0]))
        if abs(sum(after) - sum(before)) > max(ENERGY, 100.0 * self.tolerance) * scale:
            what = _("a change point at {time:.9g} s behind which the energy would be another")
            return what.format(time=detour.centre)
        return detour, Event(detour.centre, CROSSING, sum(after) - sum(before))
