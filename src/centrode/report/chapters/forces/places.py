"""Places of a motion in chapters on forces: the instants that are shown, and how they are named."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from centrode.render.document.blocks import shown
from centrode.report.study import moments_of

if TYPE_CHECKING:
    import xarray as xr

    from centrode.report.study import ReportStudy


def instants(study: ReportStudy) -> tuple[float, ...]:
    """The instants that are shown: values of the drive; by a law or with several drives times."""
    return tuple(moment.at for moment in moments_of(study))


def unit_of_place(study: ReportStudy) -> str:
    """SI unit of a place."""
    return study.mechanism.motion_parameter.instant.unit


def head_of_places(study: ReportStudy) -> str:
    """Head of a column of places, without the unit."""
    parameter = study.mechanism.motion_parameter
    return shown(parameter.drives[0].name) if parameter.is_uniform else f"${parameter.instant.symbol}$"


def places_of(study: ReportStudy, data: xr.Dataset) -> np.ndarray:
    """Places of the samples of a dataset [rad, m or s]."""
    return np.asarray(study.mechanism.motion_parameter.instants(data))
