"""Figures of a motion on the sphere."""

from __future__ import annotations

from typing import TYPE_CHECKING

from centrode.locale import _, mark
from centrode.present.figures import motion_figures
from centrode.render.document.blocks import Chapter, Section
from centrode.render.document.figures import picture

if TYPE_CHECKING:
    from centrode.report.study import ReportStudy

CAPTIONS = {
    "mechanism": mark("The mechanism from outside; dashed what is behind"),
    "paths": mark("Paths of the points"),
    "joint-angles": mark("Angles of the links in their hinges"),
    "joint-velocities": mark("Angular velocities in the hinges"),
    "joint-accelerations": mark("Angular accelerations in the hinges"),
    "angular-velocities": mark("Angular velocities of the links"),
    "angular-accelerations": mark("Angular accelerations of the links"),
    "velocities": mark("Velocities of the points"),
    "accelerations": mark("Accelerations of the points"),
    "slides": mark("Motion along the circles"),
    "kinematic-coefficients": mark("Kinematic coefficients"),
}


def sphere_plots_chapter(study: ReportStudy) -> Chapter | None:
    """The figures that `centrode run` draws."""
    if not study.is_spherical:
        return None
    figures = motion_figures(study.mechanism, study.motion, study.wishes.instants)
    blocks = tuple(picture(figure, _(CAPTIONS[name])) for name, figure in figures.items())
    return Chapter("plots", _("Plots of the motion"), (Section("", blocks),))
