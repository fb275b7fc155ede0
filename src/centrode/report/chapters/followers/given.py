"""What the description of a cam with a follower gives, as tables."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from centrode.locale import _
from centrode.render.document.blocks import Block, ChapterBlocks, SectionBlocks, TableBlock
from centrode.render.document.numbers import NARROW, spelled_unit
from centrode.report.chapters.forces.tables import ForceColumn, over_samples
from centrode.views.followers import CONTACTS, KINDS

if TYPE_CHECKING:
    from centrode.model.cam import Material
    from centrode.model.follower_cam import LiftSegment, PlateCam
    from centrode.render.document.numbers import Numbers
    from centrode.report.study import ReportStudy


def follower_data_chapter(study: ReportStudy) -> ChapterBlocks | None:
    """Everything the description gives."""
    if not study.is_plate_cam:
        return None
    cam, numbers = study.plate, study.numbers
    blocks: list[Block] = [
        TableBlock((_("what"), _("value")), tuple(given_rows(cam, numbers)), _("Cam and follower"))
    ]
    bounds = tuple(_bounds(cam, numbers))
    if bounds:
        blocks.append(TableBlock((_("what"), _("value")), bounds, _("What is admissible")))
    blocks += segment_tables(cam, numbers)
    return ChapterBlocks("data", _("Data"), (SectionBlocks("", tuple(blocks)),))


def given_rows(cam: PlateCam, numbers: Numbers) -> Iterator[tuple[str, str]]:
    """Cam and follower without the motion: labels and texts."""
    body, follower = cam.body, cam.follower
    if body.base_radius is not None:
        yield _("base radius"), numbers.measured(body.base_radius, "m")
    turns = {"counter-clockwise": _("counter-clockwise"), "clockwise": _("clockwise")}
    yield _("the cam turns"), turns[body.turn]
    if body.speed is not None:
        yield _("speed of the cam"), turning_text(body.speed, numbers)
    if body.thickness is not None:
        yield _("thickness of the cam"), numbers.measured(body.thickness, "m")
    yield from _material(_("material of the cam"), body.material, numbers)
    kind = _("{kind}, with {contact}")
    yield (
        _("follower"),
        kind.format(kind=_(KINDS[follower.kind].message), contact=_(CONTACTS[follower.contact].message)),
    )
    sizes = (
        (_("radius of the roller"), follower.roller_radius),
        (_("offset of the follower's axis"), follower.offset or None),
        (_("length of the arm"), follower.arm),
        (_("pivot from the cam's centre"), follower.pivot_distance),
        (_("offset of the face from the pivot"), follower.face_offset or None),
    )
    for label, size in sizes:
        if size is not None:
            yield label, numbers.measured(size, "m")
    yield from _burden(cam, numbers)
    if cam.tool is not None:
        yield _("radius of the cutter"), numbers.measured(cam.tool.radius, "m")


def turning_text(speed: float, numbers: Numbers) -> str:
    """The speed of a cam [rad/s] in turns a minute and in radians."""
    told = _("{turns} turns a minute, {rate}")
    turns = numbers.plain(speed * 30.0 / math.pi)
    return told.format(turns=turns, rate=f"{numbers.plain(speed)}{NARROW}{spelled_unit('rad/s')}")


def _burden(cam: PlateCam, numbers: Numbers) -> Iterator[tuple[str, str]]:
    """Masses, spring, load, friction of the follower."""
    follower, swings = cam.follower, cam.swings
    push = "N m" if swings else "N"
    if follower.mass is not None:
        yield _("mass of the follower"), numbers.measured(follower.mass, "kg")
    if follower.inertia is not None:
        yield _("moment of inertia of the follower"), numbers.measured(follower.inertia, "kg m^2")
    if follower.spring is not None:
        unit = "N m/rad" if swings else "N/m"
        yield _("stiffness of the spring"), numbers.measured(follower.spring.stiffness, unit)
        yield _("preload of the spring"), numbers.measured(follower.spring.preload, push)
    if follower.load:
        yield _("load"), numbers.measured(follower.load, push)
    if follower.friction:
        yield _("friction between cam and follower"), numbers.plain(follower.friction)
    yield from _material(_("material of the follower"), follower.material, numbers)


def _material(label: str, material: Material | None, numbers: Numbers) -> Iterator[tuple[str, str]]:
    if material is not None:
        modulus = numbers.measured(material.elasticity * 1e-9, "GPa")
        yield label, f"$E$ = {modulus}, $nu$ = {numbers.plain(material.poisson)}"


def _bounds(cam: PlateCam, numbers: Numbers) -> Iterator[tuple[str, str]]:
    given = cam.bounds
    sizes = (
        (_("greatest pressure angle"), given.pressure_angle, "rad"),
        (_("greatest pressure angle where the follower falls"), given.return_pressure_angle, "rad"),
        (_("least radius of curvature of the profile"), given.curvature_radius, "m"),
        (_("greatest contact stress"), None if given.stress is None else given.stress * 1e-6, "MPa"),
    )
    for label, size, unit in sizes:
        if size is not None:
            yield label, numbers.measured(size, unit)


def segment_tables(cam: PlateCam, numbers: Numbers) -> Iterator[TableBlock]:
    """The segments of a turn, and of those through points their conditions."""
    unit, letter = ("rad", "psi") if cam.swings else ("m", "s")
    start = before = 0.0
    rows = []
    for segment in cam.segments:
        after = before if segment.to is None else segment.to
        rows.append((start, start + segment.angle, before, after))
        start, before = start + segment.angle, after
    columns = [
        tuple(numbers.plain(row[k] * numbers.shown(of)[0]) for row in rows)
        for k, of in enumerate(("rad", "rad", unit, unit))
    ]
    head = (
        _("segment"), _("curve"), numbers.head(_("$phi$ from"), "rad"), numbers.head(_("$phi$ to"), "rad"),
        numbers.head(_("${letter}$ from").format(letter=letter), unit),
        numbers.head(_("${letter}$ to").format(letter=letter), unit),
    )  # fmt: skip
    cells = tuple(
        (str(k + 1), _(segment.curve), *(column[k] for column in columns))
        for k, segment in enumerate(cam.segments)
    )
    yield TableBlock(head, cells, _("Segments of a turn"), (True, False, True, True, True, True))
    for number, segment in enumerate(cam.segments, 1):
        yield from _through(segment, number, unit, letter, numbers)


def _through(
    segment: LiftSegment, number: int, unit: str, letter: str, numbers: Numbers
) -> Iterator[TableBlock]:
    """Derivatives at the ends and points on the way that a segment is asked for."""
    ends = [
        (f"${letter}^(({order}))$", where, numbers.measured(value, f"{unit}/rad" + (f"^{order}" if order > 1 else "")))
        for where, rates in ((_("at its start"), segment.at_start), (_("at its end"), segment.at_end))
        for order, value in enumerate(rates, 1)
    ]  # fmt: skip
    if ends:
        caption = _("Derivatives by the angle of the cam that segment {number} has").format(number=number)
        yield TableBlock((_("derivative"), _("where"), _("value")), tuple(ends), caption)
    if segment.through:
        angles, lifts = zip(*segment.through, strict=True)
        columns = [
            ForceColumn("$phi$", "rad", np.array(angles)),
            ForceColumn(f"${letter}$", unit, np.array(lifts)),
        ]
        caption = _("Points of segment {number}, angles from its start").format(number=number)
        yield over_samples(numbers, columns, range(len(angles)), caption)
