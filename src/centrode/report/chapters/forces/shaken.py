"""The chapter of balance: shaking force and moment, harmonics, and what counterweights would do."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from centrode.errors import CentrodeError
from centrode.locale import _
from centrode.present.forces.balance_figures import balance_figures
from centrode.render.document.blocks import Block, Chapter, Formula, Items, Paragraph, Section, Table
from centrode.render.document.rows import told
from centrode.report.chapters.forces.results import balanced, has_forces, shaken
from centrode.report.telling import facts, listed, measured, pictures
from centrode.study.forces.balancing import balance_effects, balance_rows, balance_steps

if TYPE_CHECKING:
    import xarray as xr

    from centrode.report.study import ReportStudy


def balance_chapter(study: ReportStudy) -> Chapter | None:
    """Shaking force and moment of a planar linkage with masses, and its full balance where there is one."""
    if not has_forces(study) or not study.is_planar:
        return None
    data = shaken(study)
    if not data["shaking_force"].to_numpy().any():
        return None  # nothing with mass moves
    text = _(
        "The inertia of the links acts on the frame with the shaking force and moment; weights and loads are not in"
        " them."
    )
    lines = (("arrow(F)", "-sum_k m_k arrow(a)_k"), ("M", "-frac(d K, d t)"))
    blocks: list[Block] = [Paragraph(text), Formula(lines)]
    if "greatest_shaking_force" in data.attrs:
        blocks.append(facts(study.numbers, _greatest(data)))
    sections = [Section("", tuple(blocks))]
    if "force_harmonic_amplitude" in data:
        sections.append(Section(_("Harmonics"), (_harmonics(study, data),)))
    sections.append(Section(_("Full balance"), _balance(study)))
    return Chapter("balance", _("Shaking forces and balance"), tuple(sections))


def _greatest(data: xr.Dataset) -> list[tuple[str, str]]:
    facts_ = data.attrs
    return [
        (_("greatest shaking force"), f"{facts_['greatest_shaking_force']:.6g} N"),
        (_("greatest shaking moment"), f"{facts_['greatest_shaking_moment']:.6g} N m"),
        (_("greatest moment of the drive for the inertia"), f"{facts_['greatest_inertia_on_drive']:.6g} N m"),
    ]


def _harmonics(study: ReportStudy, data: xr.Dataset) -> Table:
    numbers = study.numbers
    force, moment = (
        data[name].to_numpy() for name in ("force_harmonic_amplitude", "moment_harmonic_amplitude")
    )
    least, least_moment = 1e-10 * float(force.max()), 1e-10 * float(moment.max())
    columns = [
        tuple(numbers.plain(float(order)) for order in data["order"].to_numpy()),
        numbers.column(force[:, 0], "N", least),
        numbers.column(force[:, 1], "N", least),
        numbers.column(data["force_harmonic_greatest"].to_numpy(), "N", least),
        numbers.column(moment, "N m", least_moment),
    ]
    heads = (
        _("order"),
        numbers.head("$F_x$", "N"),
        numbers.head("$F_y$", "N"),
        numbers.head(_("greatest"), "N"),
        numbers.head("$M$", "N m"),
    )
    caption = _("Amplitudes of the shaking force and moment by orders of the drive's turning")
    return Table(heads, tuple(zip(*columns, strict=True)), caption, (True,) * len(heads))


def _balance(study: ReportStudy) -> tuple[Block, ...]:
    """Counterweights that take the shaking force away; why not, where there are none."""
    try:
        found = balanced(study)
    except CentrodeError as refusal:
        return (Paragraph(told(str(refusal), study.numbers)),)
    header, rows = balance_effects(found)
    blocks: list[Block] = [facts(study.numbers, balance_rows(found)), listed(study.numbers, header, rows)]
    steps = balance_steps(found)
    if steps:
        blocks += [
            Paragraph(_("Masses replaced at the joints:")),
            Items(tuple(told(step, study.numbers) for step in steps)),
        ]
    before, after = (float(one.attrs["greatest_shaking_force"]) for one in (found.before, found.after))
    allowed = 1e4 * float(np.finfo(float).eps)
    text = _("With the counterweights {share} of the greatest shaking force is left.")
    blocks.append(measured(text, after, before, allowed))
    captions = {
        "counterweights": _("The mechanism with its counterweights"),
        "shaking-hodograph": _("Hodograph of the shaking force, before and after"),
        "shaking-cycle": _("Shaking force, shaking moment and the drive over the cycle, before and after"),
        "shaking-harmonics": _("Harmonics before and after"),
    }
    return (*blocks, *pictures(balance_figures(found, study.motion), captions))
