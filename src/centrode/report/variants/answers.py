"""What a teacher checks of a variant: its numbers, whether it turns, and the motion and forces at the instants.

Answers are plain numbers in SI, kept as JSON beside the variant's report: the sheet of all is made from these files, so
that a run that was cut short goes on where it was.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from centrode.errors import CentrodeError
from centrode.kinematics.preparation import ready
from centrode.report.chapters.forces.results import reactions_at_instants
from centrode.report.moments import Moment, moments_of
from centrode.study.rotation import rotation_of

if TYPE_CHECKING:
    import xarray as xr

    from centrode.report.study import ReportStudy

Answers = dict[str, Any]
OF_LINKS = ("angle", "angular_velocity", "angular_acceleration")
ON_SPHERE = ("joint_angle", "joint_velocity", "joint_acceleration")
OF_POINTS = ("velocity", "acceleration")


def answers_of(study: ReportStudy) -> Answers:
    """The answers of a mechanism, in the words of the language that is spoken."""
    rotation = rotation_of(ready(study.mechanism))
    check = study.check
    return {
        "turns_fully": rotation.turns_fully,
        "limit": rotation.limit,
        "unit": rotation.unit,
        "group": rotation.group,
        "cause": rotation.cause,
        "mobility": check.mobility,
        "formula": check.formula,
        "failure": study.study.failure or "",
        "instants": [_at(study, moment) for moment in moments_of(study)],
    }


def _at(study: ReportStudy, moment: Moment) -> Answers:
    """One instant: angles and rates of the links, speeds of the points, what the drives give."""
    found: Answers = {
        "title": moment.title,
        "reached": moment.reached,
        "links": {},
        "points": {},
        "drives": {},
    }
    if not moment.reached:
        return found
    here = moment.data.isel(sample=moment.sample)
    flat = study.is_planar
    dimension, names = ("link", OF_LINKS) if flat else ("joint", ON_SPHERE)
    for label in here[dimension].to_numpy().tolist():
        found["links"][label] = [_number(here[name].sel({dimension: label})) for name in names]
    for point in study.mechanism.moving_points:
        vectors = (here[name].sel(point=point).to_numpy() for name in OF_POINTS)
        found["points"][point] = [float(np.linalg.norm(vector)) for vector in vectors]
    found["drives"] = _drives(study, moment)
    return found


def _drives(study: ReportStudy, moment: Moment) -> dict[str, float]:
    """What each drive has to give, where masses or loads are there and reactions can be found."""
    reactions = study.study.reactions
    if reactions is None:
        return {}
    try:
        here = reactions_at_instants(study).isel(sample=moment.sample)
    except CentrodeError:
        return {}
    values = here["balancing"].to_numpy().tolist()
    found = dict(zip(here["drive"].to_numpy().tolist(), values, strict=True))
    return {name: value for name, value in found.items() if np.isfinite(value)}


def _number(value: xr.DataArray) -> float:
    return float(value)
