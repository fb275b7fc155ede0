"""The motion to be played."""

from __future__ import annotations

from centrode.locale import _, mark
from centrode.present.figures import motion_figures
from centrode.render.document.blocks import ChapterBlocks, SectionBlocks
from centrode.render.document.figures import picture
from centrode.report.player_linkages import moving_of
from centrode.report.study import ReportStudy, moments_of


def motion_chapter(study: ReportStudy) -> ChapterBlocks | None:
    """The mechanism in motion, which a page plays and a PDF shows in its initial position."""
    if study.is_cam:
        return None
    moving = study.once("moving", lambda: moving_of(study.mechanism, study.motion))
    return ChapterBlocks("motion", _("Motion"), (SectionBlocks("", (moving,)),))


# The motion as figures: the mechanism, the paths of its points, curves of everything that moves.

CAPTIONS = {
    "mechanism": mark("The mechanism"),
    "paths": mark("Paths of the points"),
    "angles": mark("Angles of the links"),
    "angular-velocities": mark("Angular velocities of the links"),
    "angular-accelerations": mark("Angular accelerations of the links"),
    "velocities": mark("Velocities of the points"),
    "accelerations": mark("Accelerations of the points"),
    "slides": mark("Motion along the guides"),
    "kinematic-coefficients": mark("Kinematic coefficients"),
}


def plots_chapter(study: ReportStudy) -> ChapterBlocks | None:
    """The figures that `centrode run` draws."""
    if not study.is_planar:
        return None
    exact = moments_of(study)[0].data if study.wishes.instants else None
    instants = [] if exact is None else study.mechanism.motion_parameter.values(exact).tolist()
    figures = motion_figures(study.mechanism, study.motion, instants, exact)
    blocks = tuple(picture(figure, _(CAPTIONS[name])) for name, figure in figures.items())
    return ChapterBlocks("plots", _("Plots of the motion"), (SectionBlocks("", blocks),))
