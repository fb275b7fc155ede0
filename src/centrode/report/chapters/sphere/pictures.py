"""Figures of a motion on the sphere, and its instantaneous axes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from centrode.analysis.instant_centres.centres import instant_centres
from centrode.errors import CentrodeError
from centrode.locale import _, mark
from centrode.present.figures import motion_figures
from centrode.render.document.blocks import Block, Chapter, Paragraph, Section, Table, shown
from centrode.render.document.figures import picture
from centrode.report.moments import Moment, reached_moments

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


def axes_chapter(study: ReportStudy) -> Chapter | None:
    """Instantaneous axes of the links against the frame at the instants."""
    if not study.is_spherical or not reached_moments(study):
        return None
    text = _(
        "At every instant a link turns against the frame about an axis through the centre; its end is given where the"
        " link turns counter-clockwise about it as the drive's value grows."
    )
    sections = [Section("", (Paragraph(text),))]
    sections += [Section(moment.title, (_axes(study, moment),)) for moment in reached_moments(study)]
    return Chapter("axes", _("Instantaneous axes"), tuple(sections))


def _axes(study: ReportStudy, moment: Moment) -> Block:
    names = [name for name, link in study.mechanism.links.items() if len(link.coordinates) > 1]
    try:
        found = instant_centres(moment.data, [(name, "frame") for name in names]).isel(sample=moment.sample)
    except CentrodeError as reason:
        return Paragraph(shown(reason.what))
    numbers = study.numbers
    centre, speed = found["centre"].to_numpy(), np.abs(found["relative_speed"].to_numpy())
    columns = [tuple(map(shown, names))]
    columns += [numbers.column(centre[:, k], "1", 1e-14) for k in range(3)]
    columns.append(numbers.column(speed, "rad/s", 1e-14))
    head = (_("link"), "$x$", "$y$", "$z$", numbers.head(_("angular velocity"), "rad/s"))
    return Table(head, tuple(zip(*columns, strict=True)), "", (False, *(True,) * 4))
