"""Structure: kinematic pairs, Chebyshev's count, Assur groups, the order of solving."""

from __future__ import annotations

from centrode.locale import _, ngettext
from centrode.model.mechanism import FRAME, Mechanism
from centrode.render.document.blocks import (
    Block,
    ChapterBlocks,
    CheckBlock,
    FormulaBlock,
    ItemsBlock,
    ParagraphBlock,
    SectionBlocks,
    TableBlock,
    shown,
)
from centrode.render.document.rows import small
from centrode.report.study import ReportStudy
from centrode.structure.assur import AssurGroup
from centrode.structure.rank import is_bare, slider_of
from centrode.study.check import MechanismCheck as Checked

CLOSES = 1e-9
"""Residual over the greatest length up to which an initial position is accepted as closed."""


def structure_chapter(study: ReportStudy) -> ChapterBlocks | None:
    """Pairs, mobility by formula and by rank, structural formula."""
    if study.is_cam:
        return None
    checked = study.check
    sections = (
        SectionBlocks(_("Kinematic pairs"), (_pairs(study.mechanism),)),
        SectionBlocks(_("Mobility"), _mobility(checked)),
        SectionBlocks(_("Assur groups"), _groups(checked)),
    )
    return ChapterBlocks("structure", _("Structure"), sections)


def _pairs(mechanism: Mechanism) -> TableBlock:
    """Every pair with the bodies it joins: hinges of k links are k - 1 pairs."""
    rows: list[tuple[str, str, str, str]] = []

    def add(name: str, bodies: tuple[str, str], kind: str, letter: str) -> None:
        one, other = (_("frame") if body == FRAME else shown(body) for body in bodies)
        rows.append((name, f"{one} – {other}", kind, letter))

    turning, sliding = _("turning pair, class 5"), _("sliding pair, class 5")
    for point, bodies in _hinged_bodies(mechanism).items():
        for other in bodies[1:]:
            add(shown(point), (bodies[0], other), turning, "R")
    for guide in mechanism.guides:
        add(shown(guide.id), (slider_of(guide), guide.on), sliding, "P")
    for drive in mechanism.drives:
        if drive.distance is not None:
            barrel, rod = _cylinder(drive.id)
            add(shown(drive.id), (barrel, rod), sliding, "P")
    for gear in mechanism.gears:
        add(shown(gear.id), (gear.links[0], gear.links[1]), _("gear pair, class 4"), "")
    for wheel in mechanism.rolling:
        add(shown(wheel.id), (wheel.link, wheel.on), _("rolling pair"), "")
    head = (_("pair"), _("bodies"), _("kind"), _("sign"))
    return TableBlock(head, tuple(rows), _("Kinematic pairs"))


def _cylinder(name: str) -> tuple[str, str]:
    return _("barrel of cylinder {name}").format(name=name), _("rod of cylinder {name}").format(name=name)


def _hinged_bodies(mechanism: Mechanism) -> dict[str, list[str]]:
    """Points with the bodies hinged there, the frame last; sliders and cylinders are bodies as well."""
    found: dict[str, list[str]] = {}
    for name, link in mechanism.links.items():
        for point in link.coordinates:
            found.setdefault(point, []).append(name)
    for guide in mechanism.guides:
        if is_bare(guide):
            found.setdefault(guide.point, []).append(slider_of(guide))
    for drive in mechanism.drives:
        if drive.distance is not None:
            for point, body in zip(drive.distance, _cylinder(drive.id), strict=True):
                found.setdefault(point, []).append(body)
    for point in mechanism.frame.points:
        if point in found:
            found[point].append(FRAME)
    return {point: bodies for point, bodies in found.items() if len(bodies) > 1}


def _mobility(checked: Checked) -> tuple[Block, ...]:
    """Chebyshev's formula with its numbers, the rank, redundant constraints and loops."""
    count = checked.count
    numbers = f"3 dot.op {count.moving_links} - 2 dot.op {count.lower_pairs} - {count.higher_pairs}"
    blocks: list[Block] = [
        ParagraphBlock(
            _(
                "Moving links: $n = {n}$; pairs of class 5: $p_5 = {lower}$; pairs of class 4: $p_4 = {higher}$."
            ).format(n=count.moving_links, lower=count.lower_pairs, higher=count.higher_pairs)
        ),
        FormulaBlock((("W", "3 n - 2 p_5 - p_4", numbers, str(count.mobility)),)),
    ]
    if checked.redundant:
        listed = shown(", ".join(checked.redundant))
        blocks.append(
            ParagraphBlock(
                _("Redundant constraints, which only have to fit: {constraints}.").format(constraints=listed)
            )
        )
    rank = _(
        "The rank of the Jacobian of all constraints at real positions gives the mobility {rank}, "
        "as many as there are drives."
    )
    blocks.append(CheckBlock(rank.format(rank=checked.mobility), checked.mobility == len(checked.drives)))
    blocks.append(
        ParagraphBlock(
            ngettext(
                "There is {n} independent closed loop.",
                "There are {n} independent closed loops.",
                count.loops,
            ).format(n=count.loops)
        )
    )
    return tuple(blocks)


def _groups(checked: Checked) -> tuple[Block, ...]:
    rows = tuple(_group(group) for group in checked.groups)
    head = (_("group"), _("class"), _("order"), _("kind"))
    residual = small(checked.initial_residual)
    return (
        ParagraphBlock(
            _("Structural formula: {formula}").format(formula=shown(checked.formula.replace("->", "→")))
        ),
        TableBlock(head, rows, _("Groups in the order of solving"), (False, False, True, False)),
        ItemsBlock(tuple(shown(step) for step in checked.plan), numbered=True),
        CheckBlock(
            _("The initial position closes to {residual} of the greatest length.").format(residual=residual),
            checked.initial_residual <= CLOSES,
        ),
    )


def _group(group: AssurGroup) -> tuple[str, str, str, str]:
    kind = _("input") if group.roman == "I" else group.kind
    roman = "" if group.roman == "0" else group.roman
    order = str(group.order) if group.order and group.roman != "I" else ""
    return shown(", ".join(group.members)), roman, order, shown(kind)
