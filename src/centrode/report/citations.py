"""Sources that a note names in its text: [2], [1, 3], [2, p. 15], [1–3]."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import replace

from centrode.locale import _
from centrode.render.document.blocks import (
    ChapterBlocks,
    ItemsBlock,
    ParagraphBlock,
    ProseBlock,
    SectionBlocks,
)

CITATION = re.compile(r"\[(\d[^\[\]]*)\]")
ENTRY = re.compile(r"\s*(\d+)(?:\s*[-\u2013\u2014]\s*(\d+))?\s*")
"""A number, or a range; what else a citation holds (a page) follows a comma or a semicolon."""


def cite_sources(chapters: Sequence[ChapterBlocks], count: int) -> tuple[ChapterBlocks, ...]:
    """Chapters of a note whose text names each of its sources: those that its author does not cite in a sentence.

    It stands at the end of the introduction, or where there is none at the beginning of the first chapter.
    """
    cited = {number for text in _texts(chapters) for number in cited_numbers(text)}
    missing = [number for number in range(1, count + 1) if number not in cited]
    place = _place(chapters)
    if not missing or place is None:
        return tuple(chapters)
    numbers = ", ".join(f"[{number}]" for number in missing)
    sentence = ParagraphBlock(_("Literature used: {numbers}.").format(numbers=numbers))
    own = SectionBlocks("", (sentence,))
    chapter = chapters[place]
    sections = (*chapter.sections, own) if chapter.role == "element" else (own, *chapter.sections)
    return (*chapters[:place], replace(chapter, sections=sections), *chapters[place + 1 :])


def cited_numbers(text: str) -> Iterator[int]:
    """Numbers of the sources that a text cites; a range has all of its numbers."""
    for citation in CITATION.findall(text):
        for entry in re.split("[,;]", citation):
            found = ENTRY.fullmatch(entry)
            if found is not None:
                first = int(found[1])
                last = min(int(found[2] or first), first + 1000)
                yield from range(first, last + 1)


def _place(chapters: Sequence[ChapterBlocks]) -> int | None:
    """The introduction, or else the first chapter that has a number."""
    for name, role in (("introduction", "element"), ("", "chapter")):
        for place, chapter in enumerate(chapters):
            if chapter.role == role and name in ("", chapter.name):
                return place
    return None


def _texts(chapters: Sequence[ChapterBlocks]) -> Iterator[str]:
    """What is told outside of tables and of the list of sources itself."""
    blocks = (
        block
        for chapter in chapters
        if chapter.name != "sources"
        for section in chapter.sections
        for block in section.blocks
    )
    for block in blocks:
        if isinstance(block, ParagraphBlock):
            yield block.text
        elif isinstance(block, ItemsBlock):
            yield from block.texts
        elif isinstance(block, ProseBlock):
            yield from ("".join(span.text for span in one) for one in block.paragraphs)
