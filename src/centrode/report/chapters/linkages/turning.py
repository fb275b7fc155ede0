"""Rotatability: whether the drives turn fully, what stops them, and a change after which they do."""

from __future__ import annotations

from collections.abc import Iterator

from centrode.analysis.redesign.repair import Repair, repair
from centrode.analysis.transmission import TransmissionResults, transmission_results
from centrode.errors import CentrodeError
from centrode.locale import _
from centrode.render.document.blocks import Block, Chapter, Check, Paragraph, Section
from centrode.render.document.chapters import document_section
from centrode.render.document.rows import rows_table, told
from centrode.report.study import ReportStudy
from centrode.study.repairing import repair_rows
from centrode.study.turning import rotatability_rows
from centrode.views import transmission


def turning_chapter(study: ReportStudy) -> Chapter | None:
    """What `centrode rotatability` tells; of a mechanism that does not turn fully, the repair."""
    if study.is_cam:
        return None
    found = study.rotatability
    rows = rows_table(rotatability_rows(study.mechanism, found), study.numbers)
    sections = [Section("", (rows,))]
    angles = _angles(study)
    if angles is not None:
        pictures = transmission.sheet(angles).pictures
        sections.append(document_section(transmission.section(angles), pictures, study.numbers))
    if found.turns_fully is False and len(study.mechanism.drives) == 1:
        sections.append(Section(_("Repair"), tuple(_repair(study))))
    return Chapter("rotatability", _("Rotatability"), tuple(sections))


def _angles(study: ReportStudy) -> TransmissionResults | None:
    """Transmission angles over the motion; None where no group has one."""
    try:
        return transmission_results(study.mechanism)
    except CentrodeError:
        return None


def _repair(study: ReportStudy) -> Iterator[Block]:
    """The smallest change after which the drive turns fully, or why there is none."""
    try:
        found: Repair = study.once("repair", lambda: repair(study.mechanism))
    except CentrodeError as failure:
        yield Paragraph(
            _("No repair was looked for: {reason}").format(reason=told(str(failure), study.numbers))
        )
        return
    yield Paragraph(_("A change of the description was looked for after which the drive turns fully."))
    yield rows_table(repair_rows(study.mechanism, found), study.numbers)
    if found.mechanism is not None:
        turns = study.once("rotatability after repair", lambda: _turns(found))
        yield Check(_("The changed mechanism was analysed again: its drive turns fully."), turns)


def _turns(found: Repair) -> bool:
    return found.after is not None and found.after.turns_fully is True
