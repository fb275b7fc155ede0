"""The chapters of reports by name, in the order of the document.

A chapter is made by a function of the report's study. It gives None where the description has nothing for it, and
raises CentrodeError where it cannot be made.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import NamedTuple, TypeAlias

from centrode.locale import mark
from centrode.report.blocks import Chapter
from centrode.report.chapters.forces.flywheel import flywheel_chapter
from centrode.report.chapters.forces.given import masses_and_loads
from centrode.report.chapters.forces.joints import reactions_chapter
from centrode.report.chapters.forces.polygons import polygons_chapter
from centrode.report.chapters.forces.real_motion import real_motion_chapter
from centrode.report.chapters.forces.reduction import reduction_chapter
from centrode.report.chapters.forces.running import simulation_chapter
from centrode.report.chapters.forces.shaken import balance_chapter
from centrode.report.chapters.linkages.centres import centres_chapter
from centrode.report.chapters.linkages.constraints import constraints_chapter
from centrode.report.chapters.linkages.data import data_chapter
from centrode.report.chapters.linkages.derivation import derivation_chapter
from centrode.report.chapters.linkages.graphic import graphic_chapter
from centrode.report.chapters.linkages.integration import integration_chapter
from centrode.report.chapters.linkages.moving import motion_chapter
from centrode.report.chapters.linkages.plots import plots_chapter
from centrode.report.chapters.linkages.positions import positions_chapter
from centrode.report.chapters.linkages.structure import structure_chapter
from centrode.report.chapters.linkages.tables import tables_chapter
from centrode.report.chapters.linkages.turning import turning_chapter
from centrode.report.chapters.linkages.words import words_chapter
from centrode.report.study import ReportStudy

Make: TypeAlias = Callable[[ReportStudy], Chapter | None]


class Kind(NamedTuple):
    """A chapter's title, marked for the catalogues, and what makes it."""

    title: str
    make: Make


CHAPTERS: Mapping[str, Kind] = {
    "data": Kind(mark("Data"), data_chapter),
    "motion": Kind(mark("Motion"), motion_chapter),
    "words": Kind(mark("How it works"), words_chapter),
    "structure": Kind(mark("Structure"), structure_chapter),
    "equations": Kind(mark("Constraint equations"), constraints_chapter),
    "derivation": Kind(mark("Velocities and accelerations"), derivation_chapter),
    "tables": Kind(mark("Tables of the motion"), tables_chapter),
    "plots": Kind(mark("Plots of the motion"), plots_chapter),
    "positions": Kind(mark("Plan of positions"), positions_chapter),
    "graphic": Kind(mark("Graph-analytic check"), graphic_chapter),
    "centres": Kind(mark("Instant centres of velocity"), centres_chapter),
    "integration": Kind(mark("Integration of the equations"), integration_chapter),
    "rotatability": Kind(mark("Rotatability"), turning_chapter),
    "masses-and-loads": Kind(mark("Masses and loads"), masses_and_loads),
    "reduction": Kind(mark("Reduction to the drive"), reduction_chapter),
    "flywheel": Kind(mark("Flywheel"), flywheel_chapter),
    "real-motion": Kind(mark("Real motion"), real_motion_chapter),
    "simulation": Kind(mark("Motion under loads"), simulation_chapter),
    "reactions": Kind(mark("Reactions in the joints"), reactions_chapter),
    "force-polygons": Kind(mark("Force polygons"), polygons_chapter),
    "balance": Kind(mark("Shaking forces and balance"), balance_chapter),
}
