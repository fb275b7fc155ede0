"""How the mechanism works, in words."""

from __future__ import annotations

from centrode.locale import _
from centrode.render.document.blocks import ChapterBlocks, ParagraphBlock, SectionBlocks
from centrode.render.document.rows import told
from centrode.report.study import ReportStudy
from centrode.study.verbal_description import describe


def words_chapter(study: ReportStudy) -> ChapterBlocks | None:
    """Parts, motion, freedom: the paragraphs of `centrode describe`."""
    if study.is_cam:
        return None
    paragraphs = describe(study.mechanism).split("\n\n")
    blocks = tuple(ParagraphBlock(told(text, study.numbers)) for text in paragraphs)
    return ChapterBlocks("words", _("How it works"), (SectionBlocks("", blocks),))
