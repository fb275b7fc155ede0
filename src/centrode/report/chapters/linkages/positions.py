"""The plan of positions: the mechanism in numbered positions of its cycle."""

from __future__ import annotations

import numpy as np
import xarray as xr

from centrode.analysis.position_plan import plan_of_positions
from centrode.errors import Status
from centrode.locale import _
from centrode.present.plan_drawing import COLUMN, TOP, plan_figure
from centrode.render.document.blocks import Chapter, Section, Table, shown
from centrode.render.document.rows import rows_table
from centrode.render.document.scaled import drawn_to_scale, scale_of
from centrode.report.study import ReportStudy
from centrode.report.vectors import symbol
from centrode.study.positions import plan_rows

SUBTITLE = 6.0
"""From the head of a plan down to the end of what stands below it [mm]."""


def positions_chapter(study: ReportStudy) -> Chapter | None:
    """How the positions were chosen, the plan drawn, and the positions of the points as a table."""
    if not study.is_planar:
        return None
    mechanism = study.mechanism
    plan = plan_of_positions(mechanism)
    rows = rows_table(plan_rows(mechanism, plan), study.numbers)
    figure = plan_figure(mechanism, plan)
    unit = study.numbers.shown("m")[1]
    caption = _("Plan of positions; a millimetre stands for {scale} {unit}").format(
        scale=study.numbers.plain(scale_of(figure)), unit=unit
    )
    drawn = drawn_to_scale(figure, caption, COLUMN, TOP - SUBTITLE)
    return Chapter(
        "positions", _("Plan of positions"), (Section("", (rows, drawn, _table(study, plan.positions))),)
    )


def _table(study: ReportStudy, data: xr.Dataset) -> Table:
    numbers, drive = study.numbers, study.mechanism.drives[0]
    unit = study.mechanism.motion_parameter.drive(drive.id).unit
    head = [_("position"), numbers.head(shown(drive.id), unit)]
    values = data["drive_value"].to_numpy()[:, 0]
    ok = data["status"].to_numpy() == Status.OK
    columns = [tuple(str(k) for k in range(len(values))), numbers.column(values, unit)]
    for point in study.points:
        place = np.where(ok[:, None], data["position"].sel(point=point).to_numpy(), np.nan)
        for axis, letter in enumerate("xy"):
            head.append(numbers.head(f"${symbol(letter, point)}$", "m"))
            columns.append(numbers.column(place[:, axis], "m"))
    return Table(
        tuple(head), tuple(zip(*columns, strict=True)), _("Points in the positions"), (True,) * len(head)
    )
