"""Chapters that a description gives no sense to, although it has what they are about."""

from __future__ import annotations

from centrode.errors import CentrodeError
from centrode.locale import _
from centrode.report.blocks import Chapter, Paragraph, Section, shown


def left_out(name: str, title: str, reason: CentrodeError) -> Chapter:
    """A chapter that nobody asked for by name and that cannot be had: it says why, and is no failure."""
    where = f"{reason.where}: " if reason.where else ""
    text = _("This is left out. {reason}").format(reason=shown(f"{where}{reason.what}"))
    return Chapter(name, title, (Section("", (Paragraph(text),)),))
