"""The graph-analytic check: diagrams of velocities and accelerations, and what they give beside the other routes."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from matplotlib.figure import Figure

from centrode.analysis.graphic.checks import CheckRow, GraphicCheck, graphic_check
from centrode.analysis.graphic.diagrams import Diagram
from centrode.errors import CentrodeError
from centrode.locale import _
from centrode.present.diagram_drawing import COLUMN, TOP
from centrode.present.instant_drawing import diagram_figures
from centrode.quantities import QUANTITIES
from centrode.render.document.blocks import (
    Block,
    Chapter,
    Check,
    Formula,
    Paragraph,
    Picture,
    Section,
    Table,
    shown,
)
from centrode.render.document.rows import rows_table, small, told
from centrode.render.document.scaled import drawn_to_scale, scale_of
from centrode.report.moments import Moment, moments_of
from centrode.report.study import ReportStudy
from centrode.report.vectors import rates_in, symbol, vector_parts
from centrode.study.graphic import graphic_about, sine_lines, trial_lines

TOLERANCE = 1e-9
"""Part of the greatest number of its kind up to which a drawing that is read exactly agrees with the closed form."""


def graphic_chapter(study: ReportStudy) -> Chapter | None:
    """For each instant the drawing, what was done, and the comparison of three routes."""
    if not study.is_planar:
        return None
    sections = tuple(Section(moment.title, tuple(_instant(study, moment))) for moment in moments_of(study))
    return Chapter("graphic", _("Graph-analytic check"), sections)


def _instant(study: ReportStudy, moment: Moment) -> Iterator[Block]:
    if not moment.reached:
        yield Paragraph(moment.missing)
        return
    try:
        check = graphic_check(study.mechanism, moment.at)
    except CentrodeError as failure:
        yield Paragraph(_("It cannot be drawn: {reason}").format(reason=told(str(failure), study.numbers)))
        return
    figures = diagram_figures(check.diagrams)
    yield rows_table(graphic_about(check), study.numbers, _("Scales and instant centres"))
    yield _drawn(study, figures["mechanism"], _("Instant centres, velocities, senses of rotation"), "m")
    for diagram, name, title in (
        (check.diagrams.velocity, "velocity", _("Velocity diagram")),
        (check.diagrams.acceleration, "acceleration", _("Acceleration diagram")),
    ):
        yield from _steps(study, diagram)
        yield _drawn(study, figures[name], title, diagram.unit, diagram.scale)
    yield _table(study, check)
    yield _judged(study, check)


def _drawn(study: ReportStudy, figure: Figure, title: str, unit: str, scale: float | None = None) -> Picture:
    """A drawing with its scale [SI by mm], that of its own axes where it is not told."""
    factor, label = study.numbers.shown(unit)
    by_millimetre = scale_of(figure) if scale is None else factor * scale
    caption = _("{title}; a millimetre stands for {scale} {unit}").format(
        title=title, scale=study.numbers.plain(by_millimetre), unit=label
    )
    return drawn_to_scale(figure, caption, COLUMN, TOP)


def _steps(study: ReportStudy, diagram: Diagram) -> Iterator[Block]:
    """Vector equations, false positions and the law of sines, group by group."""
    yield Paragraph(
        _("Velocities, group by group:") if diagram.order == 1 else _("Accelerations, group by group:")
    )
    for step in diagram.steps:
        yield Paragraph(shown(step.group))
        lines = [*step.equations]
        yield Formula(tuple(vector_parts(line) for line in lines))
        for line in trial_lines(step, diagram.order):
            yield Paragraph(rates_in(told(line, study.numbers)))
        sines = sine_lines(step)
        if sines:
            yield Formula(tuple(vector_parts(line) for line in sines))


def _table(study: ReportStudy, check: GraphicCheck) -> Table:
    """By the drawing, by integration, by the closed form; the rows of one kind with the same decimals."""
    numbers = study.numbers
    rows: list[tuple[str, ...]] = []
    for quantity in dict.fromkeys(row.quantity for row in check.rows):
        own = [row for row in check.rows if row.quantity == quantity]
        unit = own[0].unit
        size = max(abs(row.closed) for row in own)
        drawn, integrated, closed = (
            numbers.column(values, unit, least=1e-12 * size)
            for values in (
                [row.graphic for row in own],
                [np.nan if row.integrated is None else row.integrated for row in own],
                [row.closed for row in own],
            )
        )
        off = [small(row.difference * numbers.shown(unit)[0]) if row.difference else "0" for row in own]
        names = [f"${_symbol(row)}$" for row in own]
        units = [numbers.shown(unit)[1]] * len(own)
        rows += list(zip(names, units, drawn, integrated, closed, off, strict=True))
    head = (_("quantity"), _("unit"), _("drawn"), _("integrated"), _("closed form"), _("difference"))
    caption = _("Comparison of the routes: by drawing, by integration of the equations, in closed form")
    return Table(head, tuple(rows), caption, (False, False, True, True, True, True))


def _symbol(row: CheckRow) -> str:
    letter = QUANTITIES[row.quantity].symbol
    text = symbol(letter, row.name)
    return text if row.quantity.startswith("angular") else f"abs({text})"


def _judged(study: ReportStudy, check: GraphicCheck) -> Check:
    """The greatest difference of the drawing from the closed forms, over the greatest number of its kind."""
    worst = max((abs(row.difference) / _size(study, row.quantity) for row in check.rows), default=0.0)
    text = _(
        "The drawing, read exactly, agrees with the closed forms: the greatest difference is {off} "
        "of the greatest number of its kind in the motion, {allowed} is allowed."
    )
    return Check(text.format(off=small(worst), allowed=small(TOLERANCE)), worst <= TOLERANCE)


def _size(study: ReportStudy, quantity: str) -> float:
    """The greatest number of a kind in the whole motion; of accelerations also that of their normal parts."""

    def greatest(name: str) -> float:
        return float(np.nanmax(np.abs(study.motion[name].to_numpy()), initial=0.0))

    spin = greatest("angular_velocity")
    normal = {"angular_acceleration": spin**2, "acceleration": spin * greatest("velocity")}
    return max(greatest(quantity), normal.get(quantity, 0.0)) or 1.0
