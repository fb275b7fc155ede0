"""The chapter of what is given: masses, loads, the machine."""

from __future__ import annotations

from typing import TYPE_CHECKING, assert_never

import numpy as np

from centrode.dynamics.masses import masses_of, massless_links
from centrode.dynamics.state import Centre
from centrode.locale import _, mark
from centrode.model.labels import LOADS, load_name
from centrode.model.loads import (
    AnyLoad,
    BearingFriction,
    GuideForce,
    GuideFriction,
    HingeDamper,
    HingeFriction,
    HingeSpring,
    LinkWeight,
    PointDamper,
    PointForce,
    PointSpring,
    PointWeight,
    SliderFriction,
    Torque,
)
from centrode.quantities import display_unit
from centrode.render.document.blocks import Block, ChapterBlocks, ParagraphBlock, SectionBlocks, TableBlock
from centrode.render.document.rows import told
from centrode.report.texts import facts, typeset_table

if TYPE_CHECKING:
    from centrode.dynamics.state import Mass
    from centrode.model.mechanism import Mechanism
    from centrode.render.document.numbers import Numbers
    from centrode.report.study import ReportStudy

AMOUNTS = (
    ("value", ""),
    ("stiffness", "c"),
    ("damping", "k"),
    ("viscous", mark("viscous")),
    ("quadratic", mark("quadratic")),
    ("coefficient", "f"),
)
"""Numbers of a load, by what stands before them."""


def has_masses(mechanism: Mechanism) -> bool:
    """Whether there is anything that forces could be computed of."""
    return bool(mechanism.loads) or any(link.mass or link.inertia for link in mechanism.links.values())


def masses_and_loads(study: ReportStudy) -> ChapterBlocks | None:
    """Masses of the links, loads, gravity, and the machine that the mechanism works in."""
    if study.is_cam or not has_masses(study.mechanism):
        return None
    mechanism = study.mechanism
    sections = [SectionBlocks(_("Masses of the links"), _masses(mechanism, study.numbers))]
    if mechanism.loads or mechanism.gravity:
        sections.append(SectionBlocks(_("Loads"), _loads(mechanism, study.numbers)))
    if mechanism.machine is not None:
        sections.append(SectionBlocks(_("Machine"), (_machine(mechanism, study.numbers),)))
    return ChapterBlocks("masses-and-loads", _("Masses and loads"), tuple(sections))


def _masses(mechanism: Mechanism, numbers: Numbers) -> tuple[Block, ...]:
    masses = masses_of(mechanism)
    blocks: list[Block] = []
    if masses:
        head = (_("link"), _("mass, kg"), _("centre of mass"), _("central inertia, kg m²"))
        rows = [
            (one.link, f"{float(one.mass):.6g}", _centre(mechanism, one), _inertia(mechanism, one))
            for one in masses
        ]
        blocks.append(typeset_table(numbers, head, rows))
    massless = ", ".join(massless_links(mechanism))
    if massless:
        blocks.append(ParagraphBlock(told(_("Without mass: {links}.").format(links=massless), numbers)))
    return tuple(blocks)


def _inertia(mechanism: Mechanism, one: Mass) -> str:
    """In the plane a moment; on the sphere what the description has: moments, or the shape they follow from."""
    if mechanism.space == "plane":
        return f"{float(one.moment_of_inertia):.6g}"
    link = mechanism.links[one.link]
    if link.inertia is None:
        return _("of its shape") if link.shape else "–"
    flat = np.atleast_1d(np.asarray(link.inertia, dtype=float)).ravel()
    return "; ".join(f"{x:.6g}" for x in flat)


def _centre(mechanism: Mechanism, one: Mass) -> str:
    """Where a centre of mass lies: in a point, or beside one in the axes of its link."""
    if not one.weighs:
        return "–"
    own = mechanism.links[one.link].centre
    if isinstance(own, str):
        return own
    if not isinstance(one.centre, Centre):
        distance = _("{distance:.6g} m from the centre of the sphere")
        return distance.format(distance=float(one.centre.distance))
    factor, unit = display_unit("m", mechanism.display.length)
    along, across = (float(x) * factor for x in (one.centre.along, one.centre.across))
    if along == across == 0.0:
        return one.centre.base
    return _("{along:.6g} {unit} along and {across:.6g} {unit} across the link from {point}").format(
        along=along, across=across, unit=unit, point=one.centre.base
    )


def _loads(mechanism: Mechanism, numbers: Numbers) -> tuple[Block, ...]:
    blocks: list[Block] = []
    if mechanism.gravity:
        vector = "; ".join(f"{x:.6g}" for x in mechanism.gravity)
        blocks.append(
            ParagraphBlock(told(_("Weights act with g = ({vector}) m/s².").format(vector=vector), numbers))
        )
    if mechanism.loads:
        head = (_("load"), _("kind"), _("acts on"), _("amount (SI)"))
        rows = [
            (load_name(mechanism, one.label), _(LOADS[one.kind]), _acts_on(one), _amount(one))
            for one in mechanism.loads
        ]
        blocks.append(typeset_table(numbers, head, rows))
    return tuple(blocks)


def _acts_on(load: AnyLoad) -> str:
    """Point, link, guide or two points."""
    match load:
        case GuideForce(guide=guide) | GuideFriction(guide=guide) | SliderFriction(guide=guide):
            return _("guide {name}").format(name=guide)
        case PointSpring(points=points) | PointDamper(points=points):
            return ", ".join(points)
        case Torque() | HingeSpring() | HingeDamper() | HingeFriction():
            return load.link if load.relative_to == "frame" else f"{load.link}, {load.relative_to}"
        case LinkWeight(link=link):
            return link
        case BearingFriction(point=point, link=link):
            return point if link is None else link
        case PointForce(point=point) | PointWeight(point=point):
            return point
        case _:
            assert_never(load)


def _amount(load: AnyLoad) -> str:
    """Vector, value and coefficients of a load, in SI; a table by the number of its rows."""
    parts = []
    if isinstance(load, PointForce):
        parts.append("(" + "; ".join(_text(one) for one in load.vector) + ")")
    for key, before in AMOUNTS:
        value = getattr(load, key, None)
        if value is not None:
            parts.append(f"{_(before)} = {_text(value)}" if before else _text(value))
    if isinstance(load, GuideForce) and load.table is not None:
        parts.append(_("indicator diagram of {count} points").format(count=len(load.table)))
    if isinstance(load, PointForce) and load.while_moving is not None:
        way = "; ".join(f"{x:.6g}" for x in load.while_moving)
        parts.append(_("while the point moves towards ({way})").format(way=way))
    return ", ".join(parts) or "–"


def _text(value: float | str) -> str:
    return value if isinstance(value, str) else f"{value:.6g}"


def _machine(mechanism: Mechanism, numbers: Numbers) -> TableBlock:
    machine = mechanism.machine
    assert machine is not None
    rows = [(_("mean speed of the drive"), f"{machine.mean_speed:.6g} rad/s")]
    if machine.fluctuation is not None:
        rows.append((_("admissible coefficient of fluctuation"), f"{machine.fluctuation:.6g}"))
    for number, shaft in enumerate(machine.shafts, start=1):
        label = shaft.name or _("shaft {number}").format(number=number)
        text = _("{inertia:.6g} kg m², {ratio:.6g} turns in a turn of the drive")
        if shaft.ratio == 1.0:
            text = _("{inertia:.6g} kg m², on the shaft of the drive")
        rows.append((label, text.format(inertia=shaft.inertia, ratio=shaft.ratio)))
    if machine.driving is not None:
        rows.append((_("course of the driving moment"), machine.driving))
    return facts(numbers, rows)
