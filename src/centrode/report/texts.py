"""The texts of a report, with mathematics between dollar signs, taken apart."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

from centrode.render.document.blocks import (
    Block,
    CheckBlock,
    ItemsBlock,
    Moving,
    ParagraphBlock,
    Picture,
    Report,
    TableBlock,
)

PART = re.compile(r"\$((?:[^$\\]|\\.)*)\$|((?:[^$\\]|\\.)+|.)", re.DOTALL)
"""Mathematics, which keeps its backslashes, or text; a dollar sign or backslash that has no partner is text."""
ESCAPED = re.compile(r"\\([\\$])")


@dataclass(frozen=True)
class TextPart:
    """A stretch of text, or of mathematics."""

    text: str
    mathematics: bool = False


def parts_of(marked: str) -> list[TextPart]:
    """The parts of a text in their order; neighbours of one kind are one part."""
    found: list[TextPart] = []
    for formula, plain in PART.findall(marked):
        if formula:
            found.append(TextPart(formula, mathematics=True))
        elif found and not found[-1].mathematics:
            found[-1] = TextPart(found[-1].text + ESCAPED.sub(r"\1", plain))
        else:
            found.append(TextPart(ESCAPED.sub(r"\1", plain)))
    return [part for part in found if part.text]


def blocks_of(report: Report) -> Iterator[Block]:
    """All blocks of a report in their order."""
    yield from report.opening
    for chapter in report.chapters:
        for section in chapter.sections:
            yield from section.blocks


def texts_of(block: Block) -> Iterator[str]:
    """The texts of a block in which parts between dollar signs are mathematics."""
    if isinstance(block, ParagraphBlock | CheckBlock):
        yield block.text
    elif isinstance(block, ItemsBlock):
        yield from block.texts
    elif isinstance(block, TableBlock):
        yield from (block.caption, *block.head)
        for row in block.rows:
            yield from row
    elif isinstance(block, Picture | Moving):
        yield block.caption
