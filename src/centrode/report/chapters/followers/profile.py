"""The profile under a follower: formulas of its points, a table of them, drawing, pressure angle, curvature."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from centrode.cams.followers.base_circle import stretches_text
from centrode.cams.followers.motion import derivative, extremes_of, greatest_size
from centrode.locale import _
from centrode.present.cams.curves import plate_curves_figure
from centrode.present.cams.profiles import cam_body_figures
from centrode.render.document.blocks import Block, Chapter, Check, Formula, Paragraph
from centrode.render.document.figures import picture
from centrode.render.document.rows import rows_table, told
from centrode.report.chapters.followers.parts import course, motion_of, part_of, sections_of, told_failures
from centrode.report.chapters.followers.profile_checks import by_formulas, by_instant_centre, not_undercut
from centrode.report.chapters.followers.spelled import Spelled

if TYPE_CHECKING:
    from centrode.cams.followers.geometry import FollowerCam
    from centrode.report.study import ReportStudy


def follower_profile_chapter(study: ReportStudy) -> Chapter | None:
    """The profile; nothing where neither a size nor bounds are given."""
    part = part_of(study, "profile")
    if part is None:
        return None
    cam, body = study.plate, part.objects.get("plate")
    title, rows = _("Profile of the cam"), rows_table(part.rows, study.numbers)
    if body is None:
        return Chapter("profile", title, sections_of(("", (rows, *told_failures(study, part)))))
    data = part.datasets["cam-profile"]
    drawn = cam_body_figures(cam, part.objects)["cam-body"]
    pictures = (
        picture(drawn, _("The cam in its axes, with its follower at $phi = 0$")),
        picture(plate_curves_figure(cam, data), _("Pressure angle and curvature over a turn")),
    )
    sections = sections_of(
        ("", (*_formulas(study, body), by_formulas(body), by_instant_centre(body))),
        (_("Sizes"), (rows, _undercut(body, study), *told_failures(study, part))),
        (_("Points of the profile"), (_table(study, body),)),
        (_("Drawings"), pictures),
    )
    return Chapter("profile", title, sections)


def _formulas(study: ReportStudy, body: FollowerCam) -> Iterator[Block]:
    """Where the profile is, in letters, and one point with its numbers."""
    phi = _shown_angle(study, body)
    spelled = Spelled(body, study.numbers, phi)
    text = _(
        "In the axes of the cam, which are those of the frame at $phi = 0$, the follower goes about the cam against its"
        " turning; the profile is the envelope of its places."
    )
    yield Paragraph(text)
    letters = [line[:2] for line in spelled.start()]
    if not spelled.book.flat:
        letters += [line[:2] for line in spelled.radius() if line[0].startswith("u")]
        yield Paragraph(_(
            "$(u_x; u_y)$ is how the centre of the roller (the edge) goes in the cam, $(x_P; y_P)$ the contact, both"
            " along the axes of the frame:"
        ))  # fmt: skip
    yield Formula(
        (
            *letters,
            *((name, text) for name, text in spelled.aids()),
            *((a, b) for a, b, _c in spelled.place()),
        )
    )
    told_angle = study.numbers.measured(phi, "rad")
    if study.wishes.instants:
        example = _("For example at the chosen angle, $phi$ = {angle}:")
    elif spelled.book.has_pressure_angle:
        example = _("For example where the pressure angle is greatest, at $phi$ = {angle}:")
    else:
        example = _("For example where the velocity is greatest, at $phi$ = {angle}:")
    yield Paragraph(example.format(angle=told_angle))
    kept = ("u_x", "u_y", "w_x", "w_y", "K", "R")
    worked = [line if line[0] not in kept[:4] else (line[0], line[-1]) for line in spelled.radius()]
    yield Formula((*spelled.start(), *spelled.lift(), *spelled.pressure(), *worked,
                   *((name, last) for name, _letters, last in spelled.place())))  # fmt: skip


def _shown_angle(study: ReportStudy, body: FollowerCam) -> float:
    """The first instant that is asked for, else that of the greatest pressure angle, or of the greatest slope."""
    if study.wishes.instants:
        return study.wishes.instants[0]
    found = body.pressure
    if found.greatest == found.least == 0.0:
        return greatest_size(extremes_of(motion_of(study).law, 2, derivative(1)))[1]
    return found.at_greatest


def _undercut(body: FollowerCam, study: ReportStudy) -> Block:
    """Whether the follower cuts the profile away."""
    if not body.undercuts:
        return not_undercut(body)
    text = _("The profile is undercut at {stretches} deg: there the lift is lost.")
    return Check(told(text.format(stretches=stretches_text(body.undercuts)), study.numbers), False)


def _table(study: ReportStudy, body: FollowerCam) -> Block:
    """Points of the profile in both kinds of coordinates."""
    part = part_of(study, "profile")
    assert part is not None
    data = part.datasets["cam-profile"]
    data = data.assign(x=data["profile"].sel(axis="x"), y=data["profile"].sel(axis="y"))
    columns = [("x", "x"), ("y", "y"), ("profile_radius", "rho"), ("profile_angle", "chi")]
    if Spelled(body, study.numbers, 0.0).book.has_pressure_angle:
        columns.append(("cam_pressure_angle", "alpha"))
    columns.append(("profile_bend", "R"))
    caption = _(
        "Points of the profile in the axes of the cam, in polar form with the angle $chi$ from $y$ towards $x$, and the"
        " radius of curvature, negative where the profile is hollow"
    )
    return course(study, data, columns, caption)
