"""Chapters that a description gives no sense to, although it has what they are about."""

from __future__ import annotations

from typing import TYPE_CHECKING

from centrode.errors import CentrodeError, MotionError, NotComputedYet
from centrode.locale import _
from centrode.render.document.blocks import Chapter, Paragraph, Section, shown
from centrode.report.chapters.forces.results import machine_of

if TYPE_CHECKING:
    from centrode.report.study import ReportStudy


def left_out(name: str, title: str, reason: CentrodeError) -> Chapter:
    """A chapter that nobody asked for by name and that cannot be had: it says why, and is no failure."""
    where = f"{reason.where}: " if reason.where else ""
    text = _("This is left out. {reason}").format(reason=shown(f"{where}{reason.what}"))
    return Chapter(name, title, (Section("", (Paragraph(text),)),))


def without_machine(study: ReportStudy, name: str, title: str) -> Chapter | None:
    """Such a chapter where the steady motion of the machine cannot be had; None where it can.

    The failure is raised where chapters are asked for by name.
    """
    try:
        machine_of(study)
    except (MotionError, NotComputedYet) as reason:
        if study.wishes.chapters is not None:
            raise
        return left_out(name, title, reason)
    return None
