"""Results that chapters on forces share; each is computed once a report."""

from __future__ import annotations

from typing import TYPE_CHECKING

from centrode.dynamics.kinetostatics.reactions import reactions
from centrode.dynamics.masses import has_masses_or_loads
from centrode.dynamics.reduction import reduce
from centrode.report.chapters.forces.places import instants
from centrode.report.moments import moments_of

if TYPE_CHECKING:
    import xarray as xr

    from centrode.report.study import ReportStudy


def has_forces(study: ReportStudy) -> bool:
    """Whether a linkage is reported on that has masses or loads."""
    return not study.is_cam and has_masses_or_loads(study.mechanism)


def reduced_at_instants(study: ReportStudy) -> xr.Dataset:
    """Masses and loads reduced to the drives, at the instants."""
    return study.once("reduced at instants", lambda: reduce(study.mechanism, at=instants(study)))


def motion_at_instants(study: ReportStudy) -> xr.Dataset:
    """The motion at the instants."""
    return moments_of(study)[0].data


def reactions_at_instants(study: ReportStudy) -> xr.Dataset:
    """Forces in every joint at the instants."""
    return study.once("reactions at instants", lambda: reactions(study.mechanism, at=instants(study)))
