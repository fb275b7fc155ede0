"""Forces by hand at some instants as one result."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import xarray as xr

from centrode.dynamics.force_polygons.polygons import ForcePolygons, force_polygons
from centrode.dynamics.kinetostatics.applied_forces import MotionOfDrive
from centrode.dynamics.masses import has_masses_or_loads
from centrode.errors import MotionError
from centrode.kinematics.motion import default_instants
from centrode.kinematics.motion import motion as labelled_motion
from centrode.model.mechanism import Mechanism


@dataclass(frozen=True)
class ForcePolygonResults:
    """Force polygons of a mechanism at some instants.

    Attributes
    ----------
    mechanism : with its masses and loads
    at : the instants as they were named: values of the drive [rad or m], times [s], or texts
    motion : the labelled motion at the instants
    polygons : of each instant; None where the mechanism is open or singular, and no forces balance it
    """

    mechanism: Mechanism
    at: tuple[float | str, ...]
    motion: xr.Dataset
    polygons: tuple[ForcePolygons | None, ...]


def force_polygon_results(
    mechanism: Mechanism,
    at: Sequence[float | str] = (),
    paper: str = "A4",
    *,
    motion: MotionOfDrive = "mean",
    instants: Sequence[float] | None = None,
    complete: bool = True,
) -> ForcePolygonResults:
    """Reactions and balancing moment at some instants by force polygons and by Zhukovsky's lever.

    Parameters
    ----------
    at : instants, numbers in SI or texts with a unit ("120 deg"): values of the drive, or times, as in `motion(at=...)`
    paper : "A5", "A4" or "A3"
        The sheet that scales of forces are chosen for.
    motion : "mean", or "real": at the real speed and acceleration of a machine in steady motion
    instants : the same in SI [rad or m, or s], if `at` is left out; else those of the study, else the initial position
    complete : every instant has to have forces; otherwise one at least

    Raises
    ------
    InputError, NotComputedYet, MotionError
        As `force_polygons`.
    """
    if instants is None:
        instants = default_instants(mechanism)
    named, instant = tuple(at) or tuple(instants), mechanism.motion_parameter.instant
    places = [instant.read(place, "at") for place in named]
    found: list[ForcePolygons | None] = []
    refusals: list[MotionError] = []
    for place in places:
        try:
            found.append(force_polygons(mechanism, place, paper, motion=motion))
        except MotionError as refusal:
            refusals.append(refusal)
            found.append(None)
    if refusals and (complete or not any(found)):
        raise refusals[0]
    return ForcePolygonResults(mechanism, named, labelled_motion(mechanism, at=places), tuple(found))


def results_of_force_polygons(mechanism: Mechanism, polygons: ForcePolygons) -> ForcePolygonResults:
    """Force polygons at one instant."""
    at = float(mechanism.motion_parameter.instants(polygons.exact)[0])
    return ForcePolygonResults(mechanism, (at,), polygons.exact, (polygons,))


def has_force_polygons(mechanism: Mechanism) -> bool:
    """Whether a mechanism is plane and has masses or loads."""
    return mechanism.space == "plane" and has_masses_or_loads(mechanism)
