"""The motion of a machine that is left to itself: what the terminal, the files, the figures and the document show."""

from __future__ import annotations

from typing import TYPE_CHECKING

from centrode.views.multibody_motion import multibody_sheet
from centrode.views.reduced_motion import reduced_sheet

if TYPE_CHECKING:
    from centrode.dynamics.simulation.results import SimulationResults
    from centrode.sheets.sheet import Sheet


def sheet(results: SimulationResults) -> Sheet:
    """Everything there is to say about the motion of a machine under its loads and what drives it."""
    if results.simulation.attrs.get("equations") == "multibody":
        return multibody_sheet(results)
    return reduced_sheet(results)
