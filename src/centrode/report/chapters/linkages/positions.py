"""The plan of positions: the mechanism in numbered positions of its cycle."""

from __future__ import annotations

from centrode.analysis.position_plan import plan_of_positions
from centrode.errors import Status
from centrode.locale import _
from centrode.present.plan_drawing import plan_figure
from centrode.report.blocks import Chapter, Section, Table, shown
from centrode.report.figures import picture
from centrode.report.rows import rows_table
from centrode.report.study import ReportStudy
from centrode.study.positions import plan_rows


def positions_chapter(study: ReportStudy) -> Chapter | None:
    """How the positions were chosen, the plan drawn, and the positions of the points as a table."""
    if not study.is_planar:
        return None
    mechanism = study.mechanism
    plan = plan_of_positions(mechanism)
    rows = rows_table(plan_rows(mechanism, plan), (_("what"), _("value")))
    drawn = picture(plan_figure(mechanism, plan), _("Plan of positions"))
    return Chapter("positions", _("Plan of positions"), (Section("", (rows, drawn, _table(study, plan.positions))),))


def _table(study: ReportStudy, data) -> Table:  # type: ignore[no-untyped-def]
    numbers, drive = study.numbers, study.mechanism.drives[0]
    unit = "rad" if drive.kind == "angle" else "m"
    head = [_("position"), numbers.head(shown(drive.id), unit)]
    values = data["drive_value"].to_numpy()[:, 0]
    ok = data["status"].to_numpy() == Status.OK
    columns = [tuple(str(k) for k in range(len(values))), numbers.column(values, unit)]
    for point in study.points:
        place = data["position"].sel(point=point).to_numpy()
        place[~ok] = float("nan")
        for axis, letter in enumerate("xy"):
            head.append(numbers.head(f"${letter}$ ({shown(point)})", "m"))
            columns.append(numbers.column(place[:, axis], "m"))
    return Table(tuple(head), tuple(zip(*columns, strict=True)), _("Points in the positions"), (True,) * len(head))
