"""Everything about the reactions of a mechanism: over a motion with loads and wear of its bearings, or at instants."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.dynamics.bearings.extremes import BearingLoad, bearing_loads
from centrode.dynamics.bearings.wear import bearings, motion_beside
from centrode.dynamics.kinetostatics.applied_forces import MotionOfDrive
from centrode.dynamics.kinetostatics.reactions import motion_of_reactions, reactions
from centrode.dynamics.reduction import reduce
from centrode.dynamics.steady_motion.steady import steady_motion
from centrode.errors import CentrodeError
from centrode.kinematics.motion import motion
from centrode.kinematics.several_inputs.limits import End, limits_met
from centrode.model.mechanism import Mechanism


@dataclass(frozen=True)
class ReactionsAtInstants:
    """What equations of equilibrium are written with at a few instants, all at the same samples.

    Attributes
    ----------
    reactions, motion : of `reactions` and `motion`
    reduced : of `reduce`, where one drive runs at constant speed; None without, and with friction by coefficients
    steady : of `steady_motion`, where the reactions are those of the real motion
    """

    reactions: xr.Dataset
    motion: xr.Dataset
    reduced: xr.Dataset | None
    steady: xr.Dataset | None = None


@dataclass(frozen=True)
class ReactionResults:
    """Reactions of a mechanism and what follows from them.

    Attributes
    ----------
    mechanism : with its masses and loads
    reactions : of `reactions`, over a motion or at single places
    at : the single places as they were named; empty for a motion
    loads : extremes and means of each reaction over the motion; None at single places, and where left out
    motion, bearings : of `motion` and `bearings` at the samples; None on the sphere, and without `loads`
    instants : the same reactions at a few instants for equations; None without any
    limits : what bounds the motion where samples are not reached; none where all are
    """

    mechanism: Mechanism
    reactions: xr.Dataset
    at: tuple[float | str, ...] = ()
    loads: tuple[BearingLoad, ...] | None = None
    motion: xr.Dataset | None = None
    bearings: xr.Dataset | None = None
    instants: ReactionsAtInstants | None = None
    limits: tuple[End, ...] = ()


def reaction_results(
    mechanism: Mechanism,
    samples: int | None = None,
    start: float | None = None,
    stop: float | None = None,
    at: Sequence[float | str] = (),
    *,
    motion: MotionOfDrive = "mean",
    speed: float | str | None = None,
    acceleration: float | str | None = None,
    frictionless: bool = False,
    complete: bool = True,
    instants: npt.ArrayLike | None = None,
) -> ReactionResults:
    """Reactions over a motion with the loads and the wear of the bearings, or reactions at single places.

    Parameters
    ----------
    samples, start, stop : as of `motion`
    at : single places in place of the range, numbers in SI or texts with a unit ("120 deg")
    motion : "mean", or "real": at the real speed of a machine in steady motion, over its cycle
    speed, acceleration : of the drive in its own sense, at the places `at`: numbers in SI or texts with a unit
    frictionless : without friction by coefficients
    complete : with loads and wear of the bearings, which take several times as long as the reactions
    instants : further places [rad, m or s] for equations with numbers

    Raises
    ------
    InputError, NotComputedYet
        As `reactions`.
    """
    instant = mechanism.motion_parameter.instant
    places = [instant.read(place, "at") for place in at] or None
    found = reactions(
        mechanism,
        samples,
        start,
        stop,
        places,
        motion=motion,
        speed=speed,
        acceleration=acceleration,
        friction=not frictionless,
    )
    results = ReactionResults(mechanism, found, tuple(at))
    if complete and not at:
        results = with_bearings(mechanism, found)
    results = _with_limits(results)
    return results if instants is None else with_instants(results, instants)


def results_of_reactions(mechanism: Mechanism, found: xr.Dataset) -> ReactionResults:
    """A dataset of `reactions`, over a motion with the loads and the wear of the bearings."""
    if found.attrs["samples"] == "range":
        return _with_limits(with_bearings(mechanism, found))
    places = tuple(map(float, mechanism.motion_parameter.instants(found)))
    return _with_limits(ReactionResults(mechanism, found, places))


def _with_limits(results: ReactionResults) -> ReactionResults:
    """Results with what bounds the motion where samples are not reached."""
    return replace(results, limits=limits_met(results.mechanism, results.reactions["status"].values))


def with_bearings(mechanism: Mechanism, found: xr.Dataset) -> ReactionResults:
    """Reactions over a motion with the loads of the bearings, in the plane with their wear."""
    loads = bearing_loads(mechanism, found)
    if mechanism.space != "plane":
        return ReactionResults(mechanism, found, loads=loads)
    moving = motion_beside(mechanism, found)
    worn = bearings(mechanism, found, moving)
    return ReactionResults(mechanism, found, loads=loads, motion=moving, bearings=worn)


def with_instants(results: ReactionResults, instants: npt.ArrayLike) -> ReactionResults:
    """Results with the reactions at further instants [rad, m or s]; friction by coefficients counts there.

    They are those of the motion that the results are computed at.
    """
    mechanism, places = results.mechanism, np.asarray(instants, dtype=np.float64)
    reduced = None
    if motion_of_reactions(results.reactions) == "real":
        there = ReactionsAtInstants(
            reactions(mechanism, at=places, motion="real"),
            motion(mechanism, at=places),
            None,
            steady_motion(mechanism, at=places),
        )
        return replace(results, instants=there)
    if mechanism.motion_parameter.is_uniform:
        # friction by a coefficient has no reduction without the reactions
        with suppress(CentrodeError):
            reduced = reduce(mechanism, at=places)
    there = ReactionsAtInstants(reactions(mechanism, at=places), motion(mechanism, at=places), reduced)
    return replace(results, instants=there)
