"""The profile under a follower: formulas of its points, a table of them, drawing, pressure angle, curvature."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from centrode.cams.followers.base_circle import stretches_text
from centrode.cams.followers.forces import meeting_of
from centrode.cams.followers.motion import derivative, extremes_of, greatest_size
from centrode.locale import _
from centrode.present.cams.curves import plate_curves_figure
from centrode.present.cams.profiles import cam_body_figures
from centrode.render.document.blocks import Block, ChapterBlocks, CheckBlock, FormulaBlock, ParagraphBlock
from centrode.render.document.figures import picture
from centrode.render.document.rows import rows_table, told
from centrode.report.chapters.followers.formulas import Array, Spelled, Textbook
from centrode.report.chapters.followers.parts import (
    ROUNDED,
    course,
    motion_of,
    part_of,
    sections_of,
    told_failures,
)
from centrode.report.texts import difference_check

if TYPE_CHECKING:
    from centrode.cams.followers.geometry import FollowerCam
    from centrode.report.study import ReportStudy

# Second routes to a profile: closed forms, and the contact by the instant centre.

PLACES = 721


def angles() -> Array:
    """Angles [rad] of a turn at which routes are compared."""
    return np.linspace(0.0, 2.0 * np.pi, PLACES)[:-1]


def closed_forms(study: ReportStudy, body: FollowerCam) -> Iterator[CheckBlock]:
    """Pressure angle and curvature by the formulas above against those of the envelope."""
    del study
    book, phi = Textbook(body), angles()
    rows, found = body.motion.lift(phi, 3), body.contact(phi)
    if book.has_pressure_angle:
        apart = float(np.abs(np.arctan(book.pressure(rows)) - found.pressure_angle).max())
        text = _("At 720 angles the formula of $alpha$ and the normal of the envelope agree to {share} rad.")
        yield difference_check(text, apart, 1.0, ROUNDED)
    with np.errstate(divide="ignore"):
        apart = float(
            np.max(
                np.abs(1.0 / book.radius(rows) - found.curvature)
                / (1.0 / body.base_radius + np.abs(found.curvature))
            )
        )
    text = _("There the formula of $R$ and the curvature of the envelope agree to {share} of the curvature.")
    # near a cusp R is what is left of much greater numbers
    worst = float(
        np.max(np.abs(found.path_curvature * found.bend), initial=1.0, where=np.isfinite(found.bend))
    )
    yield difference_check(text, apart, 1.0, ROUNDED * max(1.0, worst, *_lost(body, found.stretch)))


def _lost(body: FollowerCam, stretch: Array) -> tuple[float, ...]:
    """By how much digits are lost where the profile is nearly, or is, undercut."""
    size = 1.0 if np.isfinite(body.touch.roller) else body.base_radius
    return (size / float(np.abs(stretch).min()),) if np.abs(stretch).min() > 0.0 else (np.inf,)


def by_formulas(body: FollowerCam) -> CheckBlock:
    """Points by the formulas above against those of the envelope."""
    phi = angles()
    apart = np.hypot(*(Textbook(body).place(phi, body.motion.lift(phi, 3)) - body.contact(phi).place).T)
    text = _(
        "At 720 angles the formulas give the points of the envelope of the follower's places, to {share} of $r_0$."
    )
    return difference_check(text, float(apart.max()), body.base_radius, ROUNDED)


def by_instant_centre(body: FollowerCam) -> CheckBlock:
    """Points and normals from the instant centre of cam and follower, which no profile enters."""
    phi = angles()
    found, met = body.contact(phi), meeting_of(body, body.motion.lift(phi, 3))
    roller = body.touch.roller if np.isfinite(body.touch.roller) else 0.0
    place = met.place - roller * met.normal
    apart = float(np.hypot(*(body.in_frame(found.place, phi) - place).T).max())
    text = _(
        "The normal through the instant centre of cam and follower on the line of their axes leads to the same points,"
        " to {share} of $r_0$."
    )
    return difference_check(text, apart, body.base_radius, ROUNDED)


def not_undercut(body: FollowerCam) -> CheckBlock:
    """The closed forms against a profile on which no stretch runs back."""
    book, phi = Textbook(body), angles()
    rows = body.motion.lift(phi, 3)
    if book.flat:
        positive = bool(np.all(book.radius(rows) > 0.0))
        return CheckBlock(
            _("The profile is not undercut: at 720 angles the formula of $R$ stays positive."), positive
        )
    positive = bool(np.all(1.0 - book.roller * book.bending(rows) > 0.0))
    return CheckBlock(_("The profile is not undercut: at 720 angles $1 - r K$ stays positive."), positive)


def follower_profile_chapter(study: ReportStudy) -> ChapterBlocks | None:
    """The profile; nothing where neither a size nor bounds are given."""
    part = part_of(study, "profile")
    if part is None:
        return None
    cam, body = study.plate, part.objects.get("plate")
    title, rows = _("Profile of the cam"), rows_table(part.rows, study.numbers)
    if body is None:
        return ChapterBlocks("profile", title, sections_of(("", (rows, *told_failures(study, part)))))
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
    return ChapterBlocks("profile", title, sections)


def _formulas(study: ReportStudy, body: FollowerCam) -> Iterator[Block]:
    """Where the profile is, in letters, and one point with its numbers."""
    phi = _shown_angle(study, body)
    spelled = Spelled(body, study.numbers, phi)
    text = _(
        "In the axes of the cam, which are those of the frame at $phi = 0$, the follower goes about the cam against its"
        " turning; the profile is the envelope of its places."
    )
    yield ParagraphBlock(text)
    letters = [line[:2] for line in spelled.start()]
    if not spelled.book.flat:
        letters += [line[:2] for line in spelled.radius() if line[0].startswith("u")]
        yield ParagraphBlock(_(
            "$(u_x; u_y)$ is how the centre of the roller (the edge) goes in the cam, $(x_P; y_P)$ the contact, both"
            " along the axes of the frame:"
        ))  # fmt: skip
    yield FormulaBlock(
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
    yield ParagraphBlock(example.format(angle=told_angle))
    kept = ("u_x", "u_y", "w_x", "w_y", "K", "R")
    worked = [line if line[0] not in kept[:4] else (line[0], line[-1]) for line in spelled.radius()]
    yield FormulaBlock((*spelled.start(), *spelled.lift(), *spelled.pressure(), *worked,
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
    return CheckBlock(told(text.format(stretches=stretches_text(body.undercuts)), study.numbers), False)


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
