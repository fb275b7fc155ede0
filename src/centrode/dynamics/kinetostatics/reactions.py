"""Reactions in every joint, and what the drives must give, as a labelled result."""

from __future__ import annotations

from typing import Literal, TypeAlias, get_args

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.dynamics.friction.contacts import Contact, contacts_of, without_friction
from centrode.dynamics.kinetostatics.finding import find
from centrode.dynamics.kinetostatics.labelled import labelled
from centrode.dynamics.kinetostatics.moving import Pace, pace_of, steady_span
from centrode.dynamics.reducer import Burden
from centrode.errors import InputError, NotComputedYet
from centrode.kinematics.ready import ready
from centrode.kinematics.solve import Solved, asked_span, solve
from centrode.kinematics.spans import span_at
from centrode.locale import _
from centrode.model.mechanism import Mechanism

Speed: TypeAlias = Literal["mean", "steady"]
SPEEDS = get_args(Speed)


def reactions(
    mechanism: Mechanism,
    samples: int | None = None,
    start: float | None = None,
    stop: float | None = None,
    at: npt.ArrayLike | None = None,
    *,
    speed: Speed = "mean",
    friction: bool = True,
) -> xr.Dataset:
    """Forces in every joint and what the drives must give, from J' lambda = -Q with one list of constraints.

    Parameters
    ----------
    samples, start, stop, at
        As for `motion`; with `speed="steady"` as for `steady_motion`, without start and stop.
    speed : "mean" or "steady"
        The speed of `reduce`, or the real one of a machine in steady motion.
    friction
        Whether friction by coefficients counts; where there is any, `friction_moment`, `friction_force`,
        `friction_power`, `efficiency` and more tell it (docs: friction).

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
        Friction by a coefficient on the sphere, and at the real speed.
    """
    mechanism = mechanism if friction else without_friction(mechanism)
    burden, contacts = Burden.for_reactions(mechanism), contacts_of(mechanism)
    if speed not in SPEEDS:
        what = _("{name} is not a speed").format(name=f'"{speed}"')
        raise InputError("speed", what, _("use one of {known}").format(known=", ".join(SPEEDS)))
    if speed == "steady":
        if start is not None or stop is not None:
            what = _("steady motion is given over a whole cycle")
            raise InputError(_("range"), what, _("leave its ends out, or ask for places with at"))
        _refuse_unknown_speed(contacts)
        prepared, span, pace = steady_span(mechanism, samples, at)
        return reactions_at(solve(prepared, span), burden, pace, whole=at is None)
    prepared = ready(mechanism)
    if at is None:
        span = asked_span(prepared, samples, start, stop)
    else:
        span = span_at(prepared.kinematics.path, np.asarray(at, dtype=np.float64))
    solved = solve(prepared, span)
    return reactions_at(solved, burden, pace_of(solved, burden), contacts, at is None)


def _refuse_unknown_speed(contacts: tuple[Contact, ...]) -> None:
    if contacts:
        what = _("the real speed of a machine with friction by coefficients is not computed yet")
        raise NotComputedYet(contacts[0].where, what, _("ask for the mean speed, or leave friction out"))


def reactions_at(
    solved: Solved, burden: Burden, pace: Pace, contacts: tuple[Contact, ...] = (), whole: bool = True
) -> xr.Dataset:
    """The same for a motion solved before, of one mechanism, with friction in the contacts.

    `whole` where its samples are a range, over which works have a sense.
    """
    return labelled(solved, burden, find(solved, burden, pace, contacts), whole)
