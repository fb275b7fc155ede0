"""Rotatability: whether the drives turn fully, what stops them, and a change after which they do."""

from __future__ import annotations

from collections.abc import Iterator

from centrode.analysis.repair import Repair, repair
from centrode.errors import CentrodeError
from centrode.locale import _
from centrode.report.blocks import Block, Chapter, Check, Paragraph, Section
from centrode.report.rows import rows_table, told
from centrode.report.study import ReportStudy
from centrode.study.repairing import repair_rows
from centrode.study.turning import rotatability_rows


def turning_chapter(study: ReportStudy) -> Chapter | None:
    """What `centrode rotatability` tells; of a mechanism that does not turn fully, the repair."""
    if not study.is_planar:
        return None
    found = study.rotatability
    rows = rows_table(rotatability_rows(study.mechanism, found), (_("what"), _("value")))
    sections = [Section("", (rows,))]
    if found.turns_fully is False and len(study.mechanism.drives) == 1:
        sections.append(Section(_("Repair"), tuple(_repair(study))))
    return Chapter("rotatability", _("Rotatability"), tuple(sections))


def _repair(study: ReportStudy) -> Iterator[Block]:
    """The smallest change after which the drive turns fully, or why there is none."""
    try:
        found: Repair = study.once("repair", lambda: repair(study.mechanism))
    except CentrodeError as failure:
        yield Paragraph(_("No repair was looked for: {reason}").format(reason=told(str(failure))))
        return
    yield Paragraph(_("The smallest change of the description after which the drive turns fully:"))
    yield rows_table(repair_rows(study.mechanism, found), (_("what"), _("value")))
    if found.mechanism is not None:
        turns = study.once("rotatability after repair", lambda: _turns(found))
        yield Check(_("The changed mechanism was analysed again: its drive turns fully."), turns)


def _turns(found: Repair) -> bool:
    return found.after is not None and found.after.turns_fully is True
