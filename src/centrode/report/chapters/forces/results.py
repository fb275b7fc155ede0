"""Results that chapters on forces share; each is computed once a report."""

from __future__ import annotations

from typing import TYPE_CHECKING

from centrode.dynamics.kinetostatics.reactions import reactions
from centrode.report.chapters.forces.places import instants

if TYPE_CHECKING:
    import xarray as xr

    from centrode.report.study import ReportStudy


def reactions_at_instants(study: ReportStudy) -> xr.Dataset:
    """Forces in every joint at the instants."""
    return study.once("reactions at instants", lambda: reactions(study.mechanism, at=instants(study)))
