"""The chapter of force polygons: reactions as they are found on a drawing board, and Zhukovsky's lever."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from centrode.dynamics.force_polygons.polygons import force_polygons
from centrode.errors import CentrodeError
from centrode.locale import _
from centrode.present.forces.lever_drawing import lever_column
from centrode.present.forces.polygon_drawing import column_of, group_scale, polygon_figures
from centrode.present.sheet_column import TOP, sheet_size
from centrode.present.shown import shown_as
from centrode.render.document.blocks import Block, Chapter, Check, Items, Paragraph, Picture, Section, shown
from centrode.render.document.numbers import spelled_number
from centrode.render.document.rows import told
from centrode.render.document.scaled import drawn_to_scale
from centrode.report.chapters.forces.places import instants, titles
from centrode.report.chapters.forces.results import has_forces
from centrode.report.telling import facts, listed, measured, worked
from centrode.study.forces.force_polygons import (
    group_title,
    polygon_about,
    polygon_balance_rows,
    polygon_rows,
)

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from centrode.dynamics.force_polygons.polygons import ForcePolygons, Lever
    from centrode.report.study import ReportStudy

PAPER = "A5"
"""A sheet whose drawings fit between the margins of a page."""
ROUNDINGS = 1e4
"""Roundings that the routes may differ by: the square of the condition of some well turned mechanism."""


def polygons_chapter(study: ReportStudy) -> Chapter | None:
    """Force polygons of the instants of a planar linkage."""
    if not has_forces(study) or not study.is_planar:
        return None
    text = _(
        "Groups are taken in reverse order: each is freed from its neighbours, moments give the tangential parts of"
        " its outer reactions, the polygon the rest. The drawings are to the scales that they name."
    )
    sections = [Section("", (Paragraph(text),))]
    made = 0
    refusals: list[CentrodeError] = []
    for at, title in zip(instants(study), titles(study), strict=True):
        try:
            found = force_polygons(study.mechanism, at, PAPER)
        except CentrodeError as refusal:
            refusals.append(refusal)
            sections.append(Section(title, (Paragraph(told(str(refusal), study.numbers)),)))
            continue
        made += 1
        sections += _instant(study, found, title)
    if not made and refusals:
        raise refusals[0]
    return Chapter("force-polygons", _("Force polygons"), tuple(sections))


def _instant(study: ReportStudy, found: ForcePolygons, title: str) -> list[Section]:
    """An instant: what is what, group by group with its drawing, all forces, the balancing moment."""
    figures = polygon_figures(found)
    blocks: list[Block] = [facts(study.numbers, polygon_about(found))]
    for number, group in enumerate(found.groups, start=1):
        name = told(group_title(group), study.numbers)
        steps = tuple(worked(study.numbers, step) for step in group.steps)
        blocks += [Paragraph(f"{name}."), Items(steps, numbered=True)]
        blocks.append(_group(found, number, figures[f"group-{number}"], name))
    for lever in found.levers:
        page = "lever" if len(found.levers) == 1 else f"lever-{lever.drive}"
        blocks.append(_lever(found, lever, figures[page]))
    rows = polygon_rows(found)
    blocks.append(listed(study.numbers, rows[0], rows[1:], _("Forces of the polygons")))
    balance = polygon_balance_rows(found)
    blocks.append(
        listed(study.numbers, balance[0], balance[1:], _("Balancing moment or force by three routes"))
    )
    return [Section(title, tuple([*blocks, *_checks(found)]))]


def _group(found: ForcePolygons, number: int, figure: Figure, name: str) -> Picture:
    """A group and its polygon without the page's column, which the report tells; true to their scales."""
    group = found.groups[number - 1]
    unit = shown_as("m", found.mechanism.display)[1]
    scales = [f"$mu_l$ = {spelled_number(f'{group_scale(found, group):g}')} {unit}/mm"]
    if group.kind != "together":
        scales.append(f"$mu_F$ = {spelled_number(f'{group.polygon.scale:g}')} N/mm")
    high = sheet_size(found.paper)[1]
    return drawn_to_scale(figure, f"{name}; {', '.join(scales)}", column_of(found), high - TOP)


def _lever(found: ForcePolygons, lever: Lever, figure: Figure) -> Picture:
    """Zhukovsky's lever, likewise."""
    caption = _("Zhukovsky's lever of drive {drive}: the velocity diagram turned by 90° clockwise")
    high = sheet_size(found.paper)[1]
    return drawn_to_scale(figure, caption.format(drive=shown(lever.drive)), lever_column(found), high - TOP)


def _checks(found: ForcePolygons) -> list[Check]:
    """The polygons beside lever and virtual work."""
    levers = {lever.drive: lever.balancing for lever in found.levers}
    size = max((abs(force) for force in found.reactions.values()), default=0.0)
    allowed, checks = ROUNDINGS * float(np.finfo(float).eps), []
    for drive in found.mechanism.drives:
        own = found.balancing[drive.id]
        others = [value for value in (levers.get(drive.id), found.work.get(drive.id)) if value is not None]
        text = _("Drive {drive}: polygons, lever and virtual work agree to {share}.")
        said = text.replace("{drive}", shown(drive.id).replace("{", "{{").replace("}", "}}"))
        off = max((abs(own - value) for value in others), default=0.0)
        checks.append(measured(said, off, max(size, abs(own)), allowed))
    return checks
