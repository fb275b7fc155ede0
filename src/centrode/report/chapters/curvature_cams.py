"""The chapters of a cam given by the curvature of its roller's path, and of the wheel that walks on it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from centrode.locale import _
from centrode.present.cams.choice import choice_figures
from centrode.present.cams.curves import contact_figure
from centrode.present.cams.profiles import cam_body_figures, profile_figure
from centrode.render.document.blocks import (
    Block,
    ChapterBlocks,
    CheckBlock,
    FormulaBlock,
    ParagraphBlock,
    SectionBlocks,
    TableBlock,
    shown,
)
from centrode.render.document.figures import picture
from centrode.render.document.rows import rows_table, told
from centrode.report.chapters.forces.tables import ForceColumn, over_samples
from centrode.report.player_cams import moving_wheel
from centrode.report.texts import difference_check, typeset_table
from centrode.study.cams.parts import Asked, CamPart
from centrode.study.cams.parts import CamTable as Told
from centrode.study.cams.results import PARTS
from centrode.views.columns import rows_shown

if TYPE_CHECKING:
    import xarray as xr

    from centrode.model.cam import Cam
    from centrode.report.study import ReportStudy

# Parts of a cam's results for a report: each computed when its chapter is made, once.

MEGA = 1e-6


def cam_of(study: ReportStudy) -> Cam:
    """The cam, its tables at the instants of the report."""
    if not study.wishes.instants:
        return study.cam
    asked = study.cam.study.model_copy(update={"instants": study.wishes.instants})
    return study.cam.model_copy(update={"study": asked})


def part_of(study: ReportStudy, name: str) -> CamPart | None:
    """One part of the results; None where the description does not ask for it."""
    if not study.is_cam or study.is_plate_cam:
        return None
    # the front of best designs takes longer than all the rest: only where the choice is what is asked for
    front = study.wishes.chapters is not None and "choice" in study.wishes.chapters
    return study.once(("cam", name), lambda: PARTS[name](cam_of(study), Asked(front=front)))


def told_part(study: ReportStudy, part: CamPart) -> tuple[Block, ...]:
    """What the command prints of a part: rows, tables, what the cam cannot do."""
    failures = [CheckBlock(told(f"{one}.", study.numbers), False) for one in part.failures]
    return (rows_table(part.rows, study.numbers), *(_typeset(study, one) for one in part.tables), *failures)


def _typeset(study: ReportStudy, table: Told) -> TableBlock:
    return typeset_table(study.numbers, table.header, table.lines, shown(table.heading))


def course(study: ReportStudy, data: xr.Dataset, columns: list[tuple[str, str]], caption: str) -> TableBlock:
    """Variables of a dataset over the angle of the carrier, at even steps."""
    found = [ForceColumn("$phi$", "rad", data["carrier_angle"].to_numpy())]
    for name, letter in columns:
        values, unit = data[name].to_numpy(), str(data[name].attrs["units"])
        scale, shown_unit = (MEGA, "MPa") if unit == "Pa" else (1.0, unit)
        found.append(ForceColumn(f"${letter}$", shown_unit, scale * values))
    return over_samples(study.numbers, found, rows_shown(data.sizes["sample"]), caption)


def sections_of(*titled: tuple[str, tuple[Block, ...]]) -> tuple[SectionBlocks, ...]:
    """Sections with something in them."""
    return tuple(SectionBlocks(title, blocks) for title, blocks in titled if blocks)


# What a cam's description gives, as a table.


ROUNDED = float(np.finfo(float).eps) * (1 << 16)
"""What rounding may leave of sums that are to vanish: series of some twenty terms, quotients near a stall."""


def cam_motion_chapter(study: ReportStudy) -> ChapterBlocks | None:
    """The wheel that walks, which a page plays."""
    curved = study.is_cam and not study.is_plate_cam
    part = part_of(study, "walking") if curved and study.cam.mover is not None else None
    if part is None or "wheel" not in part.objects:
        return None
    moving = moving_wheel(part.objects["wheel"], _(study.cam.title))
    return ChapterBlocks("motion", _("Motion"), (SectionBlocks("", (moving,)),))


def cam_profile_chapter(study: ReportStudy) -> ChapterBlocks | None:
    """The profile that the roller leaves, how it closes, undercut."""
    part = part_of(study, "profile")
    if part is None:
        return None
    text = _(
        "The profile lies by the radius $r$ of the roller inside its path, along the normal; the return arc joins the"
        " working arc in value, slope and curvature."
    )
    lines = (("x", "rho sin phi - r sin psi"), ("y", "rho cos phi - r cos psi"), ("psi", "phi - gamma"))
    blocks: list[Block] = [ParagraphBlock(text), FormulaBlock(lines), *told_part(study, part)]
    body = part.objects.get("body")
    if body is None:
        return ChapterBlocks("profile", _("Profile of the cam"), (SectionBlocks("", tuple(blocks)),))
    if body.returned is not None:
        gap = max(abs(joint.gap) for joint in body.closed.joints)
        joined = _("The arcs join: the gap is {share} of the radius.")
        blocks.append(difference_check(joined, gap, float(body.returned.radius.greatest), ROUNDED))
        smooth = _("They join without a kink, to {share} rad.")
        blocks.append(difference_check(smooth, float(body.closed.greatest_kink), 1.0, ROUNDED))
    columns = [("profile_radius", "R"), ("profile_angle", "alpha"), ("cam_pressure_angle", "gamma")]
    table = course(study, part.datasets["cam-profile"], columns, _("The profile in polar coordinates"))
    figure = profile_figure(body, _(study.cam.title), study.cam.display)
    sections = sections_of(
        ("", tuple(blocks)),
        (_("Coordinates"), (table,)),
        (_("Figures"), (picture(figure, _("The cam with its roller and the path of the roller's centre")),)),
    )
    return ChapterBlocks("profile", _("Profile of the cam"), sections)


def cam_walking_chapter(study: ReportStudy) -> ChapterBlocks | None:
    """The wheel that walks: the shoe, its travel, the proof that it stays level and does not slip."""
    part = part_of(study, "walking")
    if part is None:
        return None
    text = _(
        "The hub stays at the height $h$ while the shoe of the standing leg rolls on the ground. In the axes of the leg"
        " the ground is a line at the distance $p$ from the roller's centre; the shoe is the envelope of these lines."
    )
    lines = (
        ("h", "rho (0) + C"),
        ("p", "h - rho cos phi"),
        ("x_B", "p sin phi + p' cos phi"),
        ("y_B", "p cos phi - p' sin phi"),
        ("frac(d X, d phi)", "h + rho' sin phi"),
    )
    blocks: list[Block] = [ParagraphBlock(text), FormulaBlock(lines), *told_part(study, part)]
    wheel = part.objects.get("wheel")
    if wheel is None:
        return ChapterBlocks("walking", _("Walking wheel"), (SectionBlocks("", tuple(blocks)),))
    data = part.datasets["shoe-profile"]
    columns = [
        ("shoe_radius", "r_B"), ("shoe_angle", "alpha"), ("shoe_bend", "R_B"),
        ("hub_travel", "X"), ("hub_rate", "X'"),
    ]  # fmt: skip
    table = course(study, data, columns, _("The shoe in polar coordinates, and the travel of the hub"))
    profile = part_of(study, "profile")
    objects = {"wheel": wheel} if profile is None else {**profile.objects, "wheel": wheel}
    figure = cam_body_figures(cam_of(study), objects)["walking-wheel"]
    sections = sections_of(
        ("", tuple(blocks)),
        (_("Proof"), _proof(study)),
        (_("The shoe"), (table,)),
        (_("Figures"), (picture(figure, _("The wheel over a step")),)),
    )
    return ChapterBlocks("walking", _("Walking wheel"), sections)


def _proof(study: ReportStudy) -> tuple[CheckBlock, ...]:
    """Level, without slip, equal arcs: by the shoe's curve alone, put on the ground."""
    part = part_of(study, "walking")
    assert part is not None
    told = {name: one.value for name, one in part.scalars.items()}
    height = told["walking_hub_height"]
    return (
        difference_check(_("The shoe on the ground holds the hub level to {share} of its height."),
                 told["walking_level_error"], height, ROUNDED),
        difference_check(_("The shoe's point at the contact moves at {share} of the speed of the hub."),
                 told["walking_slip"], 1.0, ROUNDED),
        difference_check(_("The arc of the shoe is as long as the ground travelled, to {share} of it."),
                 told["walking_arc_difference"], told["walking_footprint"], ROUNDED),
    )  # fmt: skip


# The chapters on the contact of a cam and its roller, and on the design that was chosen.


def cam_contact_chapter(study: ReportStudy) -> ChapterBlocks | None:
    """Hertzian stress between roller and cam."""
    part = part_of(study, "contact")
    if part is None:
        return None
    text = _(
        "Roller and cam touch along a line of the length $b$; the force $P$ along the follower makes the normal force"
        " $P \\/ cos gamma$. With the curvature $K$ of the path"
    )
    lines = (
        ("w", "frac(P, b cos gamma)"),
        ("kappa", "1/r + 1/R", "frac(1, r (1 - r K))"),
        ("1/E^*", "frac(1 - nu_1^2, E_1) + frac(1 - nu_2^2, E_2)"),
        ("sigma", "sqrt(frac(w kappa E^*, pi))"),
        ("a", "sqrt(frac(4 w, pi kappa E^*))"),
    )
    cam, data = cam_of(study), part.datasets["cam-contact"]
    if cam.contact is not None and cam.contact.outer:
        lines = (lines[0], ("kappa", "1/r - 1/R", "frac(1, r (1 + r K))"), *lines[2:])
    columns = [
        ("cam_curvature_radius", "R"), ("contact_half_width", "a"), ("contact_stress", "sigma"),
        ("contact_shear", "tau"),
    ]  # fmt: skip
    table = course(study, data, columns, _("The contact over the working arc"))
    sections = sections_of(
        ("", (ParagraphBlock(text), FormulaBlock(lines), *told_part(study, part))),
        (_("Over the working arc"), (table,)),
        (_("Figures"), (picture(contact_figure(cam, data), _("Contact stress over the working arc")),)),
    )
    return ChapterBlocks("contact", _("Contact of roller and cam"), sections)


def cam_choice_chapter(study: ReportStudy) -> ChapterBlocks | None:
    """The parameters that make one measure least while others keep their bounds."""
    part = part_of(study, "choice")
    if part is None:
        return None
    text = _(
        "The numbers named below are chosen so that one measure is least while the others keep their bounds; the rest"
        " of this document is about the description as it is given, not about the choice."
    )
    figures = choice_figures(part.objects["choice"])
    captions = {"cam-choice": _("What a bound costs: the best values over the bound that is moved")}
    drawn = tuple(
        picture(figure, captions.get(name, _("The chosen cam"))) for name, figure in figures.items()
    )
    sections = sections_of(("", (ParagraphBlock(text), *told_part(study, part))), (_("Figures"), drawn))
    return ChapterBlocks("choice", _("Chosen parameters"), sections)
