"""What is given: the description of the mechanism as tables."""

from __future__ import annotations

from centrode.locale import _
from centrode.report.blocks import Chapter, Section, Table, shown
from centrode.report.study import ReportStudy


def data_chapter(study: ReportStudy) -> Chapter | None:
    """Lengths and initial angles of the links of a planar linkage."""
    if study.is_cam:
        return None
    numbers, mechanism = study.numbers, study.mechanism
    rows = []
    for name, link in mechanism.links.items():
        length = "" if link.length is None else numbers.measured(link.length, "m")
        angle = mechanism.initial_angle(name)
        rows.append((shown(name), length, "" if angle is None else numbers.measured(angle, "rad")))
    table = Table((_("link"), _("length"), _("initial angle")), tuple(rows), _("Links"), (False, True, True))
    return Chapter("data", _("Data"), (Section("", (table,)),))
