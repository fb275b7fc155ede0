"""Places of a motion in chapters on forces: the instants that are shown, and how they are named."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from centrode.kinematics.several_drives.holding import unit_of_value
from centrode.locale import _
from centrode.render.document.blocks import shown
from centrode.report.moments import moments_of

if TYPE_CHECKING:
    import xarray as xr

    from centrode.report.study import ReportStudy


def by_value(study: ReportStudy) -> bool:
    """Whether places are values of the one drive, and not times."""
    drives = study.mechanism.drives
    return len(drives) == 1 and drives[0].speed is not None


def instants(study: ReportStudy) -> tuple[float, ...]:
    """The instants that are shown: values of the drive; by a law or with several drives times."""
    return tuple(moment.at for moment in moments_of(study))


def unit_of_place(study: ReportStudy) -> str:
    """SI unit of a place."""
    return unit_of_value(study.mechanism, study.mechanism.drives[0]) if by_value(study) else "s"


def titles(study: ReportStudy) -> tuple[str, ...]:
    """How titles name the instants: "OA = 120°"."""
    return tuple(moment.title for moment in moments_of(study))


def head_of_places(study: ReportStudy) -> str:
    """Head of a column of places, without the unit."""
    return shown(study.mechanism.drives[0].id) if by_value(study) else "$t$"


def places_of(study: ReportStudy, data: xr.Dataset) -> np.ndarray:
    """Places of the samples of a dataset [rad, m or s]."""
    return np.asarray(data["drive_value"].to_numpy()[:, 0] if by_value(study) else data["time"].to_numpy())


def not_reached() -> str:
    """What stands in place of numbers where there are none."""
    return _("The mechanism does not get there: there are no numbers.")
