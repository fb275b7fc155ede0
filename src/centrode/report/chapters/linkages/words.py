"""How the mechanism works, in words."""

from __future__ import annotations

from centrode.locale import _
from centrode.render.document.blocks import Chapter, Paragraph, Section
from centrode.render.document.rows import told
from centrode.report.study import ReportStudy
from centrode.study.verbal_description import describe


def words_chapter(study: ReportStudy) -> Chapter | None:
    """Parts, motion, freedom: the paragraphs of `centrode describe`."""
    if study.is_cam:
        return None
    paragraphs = describe(study.mechanism).split("\n\n")
    blocks = tuple(Paragraph(told(text, study.numbers)) for text in paragraphs)
    return Chapter("words", _("How it works"), (Section("", blocks),))
