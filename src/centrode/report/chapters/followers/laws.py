"""Laws of motion beside each other for the first rise of a cam."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from centrode.locale import _
from centrode.present.cams.motion_drawing import laws_figure
from centrode.render.document.blocks import Block, Chapter, Check, Formula, Paragraph, Section, Table
from centrode.render.document.figures import picture
from centrode.render.document.rows import rows_table, told
from centrode.report.chapters.followers.curves import PEAKS
from centrode.report.chapters.followers.parts import part_of
from centrode.report.telling import listed, measured

if TYPE_CHECKING:
    import xarray as xr

    from centrode.report.study import ReportStudy

FOUND = 1e-12
"""What is allowed between a coefficient found by search and its closed form: jets of degree 7."""


def laws_chapter(study: ReportStudy) -> Chapter | None:
    """What other laws would do for the same rise; nothing where no segment rises."""
    if not study.is_plate_cam or not _rises(study):
        return None
    part = part_of(study, "laws")
    assert part is not None
    data = part.datasets["cam-laws"]
    text = _(
        "A rise $h$ over the angle $beta$ has the greatest velocity $C_v h \\/ beta$, acceleration $C_a h \\/ beta^2$"
        " and jerk $C_j h \\/ beta^3$; the torque that a mass asks of the camshaft grows with the greatest velocity"
        " times acceleration, $C_T h^2 \\/ beta^3$. Where a derivative jumps at the ends, those above it have no bound."
    )
    coefficients, sizes = part.tables
    head = (
        told(coefficients.header[0], study.numbers), "$C_v$", "$C_a$", "$C_j$", "$C_T$",
        told(coefficients.header[-1], study.numbers),
    )  # fmt: skip
    cells = tuple(tuple(told(cell, study.numbers) for cell in line) for line in coefficients.lines)
    blocks: tuple[Block, ...] = (
        Paragraph(text),
        rows_table(part.rows, study.numbers),
        Table(head, cells, _("Peak coefficients"), (False, True, True, True, True, False)),
        Paragraph(_("The closed forms of the coefficients are")),
        Formula(tuple(_closed(data))),
        _check(data),
        listed(study.numbers, sizes.header, sizes.lines, told(sizes.heading, study.numbers)),
        picture(laws_figure(data, _(study.plate.title)), _("Lift and derivatives over the rise")),
    )
    return Chapter("laws", _("Laws of motion for one rise"), (Section("", blocks),))


def _rises(study: ReportStudy) -> bool:
    lifts = [0.0 if one.to is None else one.to for one in study.plate.segments]
    return any(lifts)


def _closed(data: xr.Dataset) -> list[tuple[str, ...]]:
    """A line for each curve that is there: C_v, C_a, C_j of curve k."""
    found: list[tuple[str, ...]] = []
    for name in data["law"].to_numpy().tolist():
        if name in PEAKS:
            spelled = ", quad ".join(
                f"C_{letter} = {text}" for letter, text in zip("vaj", PEAKS[name][0], strict=True)
            )
            found.append((f'"{_(name)}:" quad {spelled}',))
    return found


def _check(data: xr.Dataset) -> Check:
    """Coefficients found by search on the exact derivatives against the closed forms."""
    worst = 0.0
    for name in data["law"].to_numpy().tolist():
        if name in PEAKS:
            closed = np.array(PEAKS[name][1])
            found = data["peak_coefficient"].sel(law=name).to_numpy()[1:]
            worst = max(worst, float(np.max(np.abs(found - closed) / np.where(closed > 0, closed, 1.0))))
    text = _(
        "Looked for on the exact derivatives, the greatest values are those of the closed forms to {share}."
    )
    return measured(text, worst, 1.0, FOUND)
