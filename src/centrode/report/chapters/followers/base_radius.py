"""Choice of the base radius: what decides it, with the numbers where it does, and other radii beside it."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from centrode.cams.followers.base_circle import admissible_of, exact_margin, has_bounds, layout_of, least_cam
from centrode.cams.nodes import nodes_of
from centrode.errors import CentrodeError
from centrode.locale import _
from centrode.render.document.blocks import (
    Block,
    ChapterBlocks,
    CheckBlock,
    FormulaBlock,
    ParagraphBlock,
    TableBlock,
    shown,
)
from centrode.render.document.numbers import NOTHING
from centrode.render.document.rows import small
from centrode.report.chapters.followers.formulas import Spelled
from centrode.report.chapters.followers.parts import body_of, motion_of, sections_of
from centrode.report.chapters.followers.profile import closed_forms

if TYPE_CHECKING:
    from centrode.cams.followers.base_circle import Least
    from centrode.cams.followers.geometry import FollowerCam
    from centrode.model.follower_cam import PlateCam
    from centrode.report.study import ReportStudy

SHARES = (0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.25, 1.5, 2.0)
"""Base radii beside each other, over the cam's own."""
NEAR = 1e-6
"""By how much of itself a least radius is changed to see that it is one."""


def base_radius_chapter(study: ReportStudy) -> ChapterBlocks | None:
    """What decides the size of the cam; nothing where neither a size nor bounds are given."""
    body = body_of(study) if study.is_plate_cam else None
    if body is None:
        return None
    sections = sections_of(
        ("", tuple(_demands(study, body))),
        (_("The least base radius"), tuple(_least(study, body))),
        (_("Base radii beside each other"), (_beside(study, body), *closed_forms(study, body))),
    )
    return ChapterBlocks("base-radius", _("Choice of the base radius"), sections)


def _demands(study: ReportStudy, body: FollowerCam) -> Iterator[Block]:
    """What grows and what shrinks with the cam."""
    spelled = Spelled(body, study.numbers, 0.0)
    if spelled.book.has_pressure_angle:
        yield ParagraphBlock(_(
            "The smaller the cam, the greater the pressure angle $alpha$ between the normal and the follower's way, and"
            " the smaller the radius of curvature $R$ of the profile where it bulges; at $R <= 0$ the profile is"
            " undercut."
        ))  # fmt: skip
    else:
        yield ParagraphBlock(_(
            "Under a flat face that is square to the follower's way the pressure angle is zero. The smaller the cam,"
            " the smaller the radius of curvature $R$ of its profile; at $R <= 0$ it is undercut."
        ))  # fmt: skip
    lines = [line[:2] for line in (*spelled.start(), *spelled.pressure(), *spelled.radius())]
    yield FormulaBlock(tuple(line for line in lines if line[0] != "alpha"))


def _least(study: ReportStudy, body: FollowerCam) -> Iterator[Block]:
    """The least radius with its numbers, and how it compares with the one that is taken."""
    cam, numbers = study.plate, study.numbers
    try:
        least = least_cam(cam)
    except CentrodeError as refusal:
        yield ParagraphBlock(shown(f"{refusal.what}. {refusal.repair or ''}".strip()))
        return
    admissible = _("The bounds of the description decide it.")
    none = _("No bounds are given: the profile is only kept from being undercut.")
    if least.by == "nothing":
        free = _(
            "No bounds are given, and no base radius undercuts the profile: the size of the cam is free."
        )
        kept = _("no bound decides the base radius: a cam as small as one likes keeps them all")
        yield ParagraphBlock(f"{kept[0].upper()}{kept[1:]}." if has_bounds(cam) else free)
        return
    yield ParagraphBlock(admissible if has_bounds(cam) else none)
    decided = {
        "pressure angle": _(
            "The least base radius is {radius}. The pressure angle decides it, at $phi$ = {angle}:"
        ),
        "curvature": _(
            "The least base radius is {radius}. The radius of curvature decides it, at $phi$ = {angle}:"
        ),
    }
    at = least.at % math.tau
    text = decided[least.by]
    yield ParagraphBlock(
        text.format(radius=numbers.measured(least.base_radius, "m"), angle=numbers.measured(at, "rad"))
    )
    there = layout_of(cam).cam(motion_of(study), least.base_radius * (1.0 + 1e-12))
    spelled = Spelled(there, numbers, at)
    decisive = spelled.pressure() if least.by == "pressure angle" else spelled.radius()
    yield FormulaBlock(
        (("r_0", spelled.told(least.base_radius)), *spelled.start(), *spelled.lift(), *decisive)
    )
    yield _is_least(study, least)
    yield ParagraphBlock(_taken(cam, body, least, study))
    yield from _best_offset(study, least)


def _taken(cam: PlateCam, body: FollowerCam, least: Least, study: ReportStudy) -> str:
    """Which radius the cam has."""
    if cam.body.base_radius is None:
        return _("The cam is made with this radius.")
    text = _("The cam is made with a base radius of {radius}, {share} times the least one.")
    share = study.numbers.plain(body.base_radius / least.base_radius, 4)
    return text.format(radius=study.numbers.measured(body.base_radius, "m"), share=share)


def _is_least(study: ReportStudy, least: Least) -> CheckBlock:
    """A little smaller a cam breaks the bounds, a little greater one keeps them."""
    layout, kept, motion = layout_of(study.plate), admissible_of(study.plate), motion_of(study)

    def keeps(base: float) -> bool:
        try:
            return exact_margin(layout.cam(motion, base), layout, kept).least >= 0.0
        except CentrodeError:
            return False

    right = keeps(least.base_radius * (1.0 + NEAR)) and not keeps(least.base_radius * (1.0 - NEAR))
    text = _(
        "With a base radius smaller by {share} of itself a bound is broken, with one so much greater none is."
    )
    return CheckBlock(text.format(share=small(NEAR)), right)


def _best_offset(study: ReportStudy, least: Least) -> Iterator[Block]:
    """The offset with which a translating follower's cam may be least."""
    cam = study.plate
    if cam.swings or cam.follower.contact == "flat" or cam.bounds.pressure_angle is None:
        return
    try:
        best = least_cam(cam, offset=True)
    except CentrodeError:
        return
    text = _(
        "With an offset of {offset} of the follower's axis the base radius could be {radius}, {share} % less."
    )
    saved = study.numbers.plain(100.0 * (1.0 - best.base_radius / least.base_radius), 3)
    offset = 0.0 if abs(best.offset) < 1e-9 * best.base_radius else best.offset
    shown_offset, radius = (study.numbers.measured(one, "m") for one in (offset, best.base_radius))
    yield ParagraphBlock(text.format(offset=shown_offset, radius=radius, share=saved))


def _beside(study: ReportStudy, body: FollowerCam) -> TableBlock:
    """Pressure angles and the least radius of curvature of cams of several sizes."""
    numbers, layout, motion = study.numbers, layout_of(study.plate), motion_of(study)
    pressed = Spelled(body, numbers, 0.0).book.has_pressure_angle
    bases = [share * body.base_radius for share in SHARES]
    values: list[tuple[float, float, float] | None] = []
    for base in bases:
        try:
            values.append(_worst(layout.cam(motion, base)))
        except CentrodeError:
            values.append(None)
    columns = [numbers.column(bases, "m")]
    heads = [numbers.head("$r_0$", "m")]
    kinds = (
        [(_("$alpha$ where it rises"), "rad", 0), (_("$alpha$ where it falls"), "rad", 1)] if pressed else []
    )
    for head, unit, k in (*kinds, (_("least $R$ where it bulges"), "m", 2)):
        shown_values = numbers.column([math.nan if one is None else one[k] for one in values], unit)
        columns.append(
            tuple(NOTHING if one is None else text for one, text in zip(values, shown_values, strict=True))
        )
        heads.append(numbers.head(head, unit))
    caption = _(
        "Greatest pressure angles and least radius of curvature; a dash: the cam cannot lead the follower"
    )
    return TableBlock(tuple(heads), tuple(zip(*columns, strict=True)), caption, (True,) * len(heads))


def _worst(cam: FollowerCam) -> tuple[float, float, float]:
    """Greatest sizes of the pressure angle on the way up and down, the least radius of curvature."""
    phi = np.concatenate([nodes_of(cam.edges), cam.turns("pressure")])
    slope, steep = cam.motion.lift(phi, 1)[1], np.abs(cam.contact(phi).pressure_angle)
    still = 1e-12 * float(np.abs(slope).max())
    up, down = (float(np.max(steep, where=one, initial=0.0)) for one in (slope >= -still, slope <= still))
    return up, down, cam.least_bend[0]
