"""Reactions in every joint, and what the drives must give, as a labelled result."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.dynamics.kinetostatics.finding import find
from centrode.dynamics.kinetostatics.labelled import labelled
from centrode.dynamics.kinetostatics.moving import Pace, pace_of
from centrode.dynamics.reducer import Burden
from centrode.kinematics.ready import ready
from centrode.kinematics.solve import Solved, asked_span, solve
from centrode.kinematics.spans import span_at
from centrode.model.mechanism import Mechanism

Array: TypeAlias = npt.NDArray[np.float64]


def reactions(
    mechanism: Mechanism,
    samples: int | None = None,
    start: float | None = None,
    stop: float | None = None,
    at: npt.ArrayLike | None = None,
) -> xr.Dataset:
    """Reactions in every joint and the balancing moments of the drives, from J' lambda = -Q.

    Parameters
    ----------
    samples, start, stop, at
        As for `motion`.

    Returns
    -------
    Dataset
        `joint_force` (sample, side, axis), `guide_force`, `guide_moment`, `gear_moment`, `rolling_force`, `balancing`
        (sample, drive), `inertia_force`, `frame_force`, `shaking_force` and more (docs: reactions), with a status of
        their own.

    Raises
    ------
    InputError
        As `motion` does; masses or loads that are not complete, or none; a formula without a value.
    NotComputedYet
        Friction, the sphere.
    """
    prepared = ready(mechanism)
    burden = Burden.of(mechanism)
    if at is None:
        span = asked_span(prepared, samples, start, stop)
    else:
        span = span_at(prepared.kinematics.path, np.asarray(at, dtype=np.float64))
    solved = solve(prepared, span)
    return reactions_at(solved, burden, pace_of(solved, burden))


def reactions_at(solved: Solved, burden: Burden, pace: Pace) -> xr.Dataset:
    """Reactions of a motion solved before, of one mechanism."""
    return labelled(solved, burden, find(solved, burden, pace))
