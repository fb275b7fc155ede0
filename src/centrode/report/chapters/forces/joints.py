"""The chapter of reactions: forces in every joint and what the drives must give."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from centrode.errors import InputError, NotComputedYet
from centrode.locale import _
from centrode.model.labels import reaction_name
from centrode.present.forces.bearing_figures import bearing_figures
from centrode.present.forces.reaction_figures import reaction_figures
from centrode.render.document.blocks import Block, Chapter, Check, Formula, Paragraph, Section, shown
from centrode.render.document.numbers import respelled
from centrode.report.chapters.forces.inertia import inertia_at
from centrode.report.chapters.forces.places import not_reached, titles
from centrode.report.chapters.forces.results import has_forces, reactions_at_instants, reactions_of
from centrode.report.chapters.forces.virtual_work import by_virtual_work
from centrode.report.telling import facts, listed, measured, pictures
from centrode.report.topics import left_out
from centrode.study.forces.bearing_loads import bearing_load_rows, bearing_loads
from centrode.study.forces.bearings import bearings, motion_beside
from centrode.study.forces.joints import joint_table
from centrode.study.forces.reacting import CHECKS, reaction_rows, reactions_at_instant
from centrode.study.forces.rubbing import friction_losses

if TYPE_CHECKING:
    from centrode.report.study import ReportStudy


def reactions_chapter(study: ReportStudy) -> Chapter | None:
    """Kinetostatics: inertia, the table of joints, reactions at instants, the worst over the motion, checks."""
    if not has_forces(study):
        return None
    try:
        reactions_of(study)
    except (InputError, NotComputedYet) as reason:
        if study.wishes.chapters is not None:
            raise
        return left_out("reactions", _("Reactions in the joints"), reason)
    return _made(study)


def _made(study: ReportStudy) -> Chapter:
    mechanism, found = study.mechanism, reactions_of(study)
    header, rows = joint_table(mechanism)
    told = _(
        "1 marks the link on which the reaction of a joint acts, -1 the one that bears its opposite; the rows are the"
        " equations of equilibrium of the links."
    )
    sections = [
        Section(
            "", (*_meaning(study), facts(study.numbers, reaction_rows(mechanism, found)[: -len(CHECKS)]))
        ),
        Section(_("Table of joints"), (Paragraph(respelled(told)), listed(study.numbers, header, rows))),
    ]
    sections += [Section(title, tuple(_at(study, k))) for k, title in enumerate(titles(study))]
    sections.append(Section(_("Greatest reactions"), _greatest(study)))
    sections.append(Section(_("Checks"), tuple(_checks(study))))
    sections.append(Section(_("Figures"), tuple(_figures(study))))
    return Chapter("reactions", _("Reactions in the joints"), tuple(sections))


def _meaning(study: ReportStudy) -> tuple[Block, ...]:
    """Inertia as a force, equilibrium of every link, one list of constraints."""
    text = _(
        "With inertia counted as a force each link is in equilibrium. The reactions follow for all links together from"
        " one system, in which every constraint is a row of derivatives and its reaction a multiplier $lambda$."
    )
    lines: tuple[tuple[str, ...], ...] = (
        ("arrow(Phi)_k", "-m_k arrow(a)_k"),
        ("M_(Phi k)", "-J_k epsilon_k"),
        ("upright(bold(J))^upright(T) upright(bold(lambda))", "-upright(bold(Q))"),
    )
    if study.is_spherical:
        turning = (
            "-upright(bold(I))_k arrow(epsilon)_k - arrow(omega)_k times upright(bold(I))_k arrow(omega)_k"
        )
        lines = (("arrow(M)_(Phi k)", turning), lines[-1])
    signs = _("A force in a hinge is that of the pin on the link, in the axes of the frame.")
    return Paragraph(text), Formula(lines), Paragraph(signs)


def _at(study: ReportStudy, k: int) -> list[Block]:
    """One instant: inertia forces, all reactions, the balancing moment by virtual work."""
    mechanism, data = study.mechanism, reactions_at_instants(study)
    if not np.isfinite(data["frame_force"].to_numpy()[k]).all():
        return [Paragraph(not_reached())]
    header, rows = reactions_at_instant(mechanism, data, k)
    return [
        *inertia_at(study, k),
        listed(study.numbers, header, rows, _("Reactions")),
        *by_virtual_work(study, k),
    ]


def _greatest(study: ReportStudy) -> tuple[Block, ...]:
    """The worst of each reaction over the motion; what friction takes."""
    mechanism, found = study.mechanism, reactions_of(study)
    loads = study.study.bearing_loads
    if not loads:
        loads = study.once("bearing loads", lambda: bearing_loads(mechanism, found))
    header, rows = bearing_load_rows(mechanism, loads)
    blocks: list[Block] = [
        listed(
            study.numbers, header, rows, _("Extremes are found between the samples too; means are over time.")
        )
    ]
    losses = friction_losses(found)
    if losses is not None:
        blocks.append(listed(study.numbers, losses[0], losses[1], _("What friction takes")))
    return tuple(blocks)


def _checks(study: ReportStudy) -> list[Check]:
    """Three sums that are not used to find the reactions; allowed is what rounding can make wrong of them."""
    found = reactions_of(study)
    loss = found["reaction_loss"].to_numpy()
    allowed = float(np.max(loss, where=np.isfinite(loss) & (loss < 1.0), initial=0.0))
    texts = (
        _("Equilibrium of every link is off by {share} of the greatest force."),
        _("The sum over the frame is off from the rates of momentum by {share} of the greatest force."),
        _("The power of the drives is off from virtual work by {share} of the greatest power."),
    )
    checks = [
        measured(text, float(found.attrs[name]), 1.0, allowed)
        for text, name in zip(texts, CHECKS, strict=True)
    ]
    open_ = found.attrs["undetermined"]
    if open_:
        text = _("Constraints that repeat each other leave open: {names}. These have no numbers.")
        checks.append(Check(text.format(names=shown("; ".join(map(reaction_name, open_.split("; "))))), True))
    return checks


def _figures(study: ReportStudy) -> list[Block]:
    mechanism, found = study.mechanism, reactions_of(study)
    drawn = reaction_figures(mechanism, found)
    if study.is_planar:
        motion = motion_beside(mechanism, found)
        drawn |= bearing_figures(mechanism, found, bearings(mechanism, found, motion), motion)
    captions = {
        "joint-forces": _("Forces in the hinges"),
        "joint-components": _("Forces in the hinges by components"),
        "centre-forces": _("Forces of the centre of the sphere"),
        "other-reactions": _("Reactions of guides, gears and wheels"),
        "balancing": _("What the drives must give"),
        "friction": _("What friction takes"),
        "frame-force": _("Force and moment on the frame"),
        "bearing-loads": _("Loads of the bearings on the bushes, in the axes of the frame"),
        "journal-loads": _("Loads on the journals, in the axes of their links"),
        "bearing-wear": _("Wear of journals (inside) and bushes (outside)"),
        "force-vectors": _("The instant of the greatest joint force, to scale"),
    }
    return [*pictures(drawn, captions)]
