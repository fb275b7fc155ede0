"""Captions and numbers of tables, figures and formulas, and the sentences that refer to them."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import count, groupby
from typing import Literal, TypeAlias

from centrode.locale import _
from centrode.render.document.blocks import (
    Block,
    ChapterBlocks,
    FormulaBlock,
    Moving,
    ParagraphBlock,
    Picture,
    ReferenceBlock,
    Report,
    SectionBlocks,
    SystemBlock,
    TableBlock,
    shown,
)

Captioned: TypeAlias = TableBlock | Picture | Moving
Kind: TypeAlias = Literal["figure", "table"]


def number_blocks(report: Report) -> Report:
    """The report with every formula, captioned table and captioned figure numbered from 1 in the order of the document.

    Sentences get the numbers of the formulas before them that they name; those without any are left out. Numbers that
    blocks have already are given anew, so a report may be numbered more than once.
    """
    tables, figures, formulas = count(1), count(1), count(1)
    named: defaultdict[str, tuple[int, ...]] = defaultdict(tuple)

    def number_block(block: Block) -> Block:
        if isinstance(block, TableBlock):
            return replace(block, number=next(tables) if block.caption else 0)
        if isinstance(block, Picture | Moving):
            return replace(block, number=next(figures) if block.caption else 0)
        if isinstance(block, FormulaBlock | SystemBlock):
            block = replace(block, number=next(formulas))
            if isinstance(block, FormulaBlock) and block.name:
                named[block.name] += (block.number,)
        if isinstance(block, ReferenceBlock):
            return replace(block, numbers={name: named[name] for name in block.names if name in named})
        return block

    opening = tuple(map(number_block, report.opening))
    chapters = _without_loose_references(_change_blocks(report.chapters, number_block))
    return replace(report, opening=opening, chapters=chapters)


def _without_loose_references(chapters: Sequence[ChapterBlocks]) -> tuple[ChapterBlocks, ...]:
    """Chapters without the sentences that name a formula which is not there."""
    return _change_sections(
        chapters, lambda section, _chapter: (block for block in section.blocks if not _is_loose(block))
    )


def _is_loose(block: Block) -> bool:
    return isinstance(block, ReferenceBlock) and set(block.names) != set(block.numbers)


def _change_sections(
    chapters: Sequence[ChapterBlocks],
    blocks_of: Callable[[SectionBlocks, ChapterBlocks], Iterable[Block]],
) -> tuple[ChapterBlocks, ...]:
    """Chapters whose sections have other blocks."""

    def change(section: SectionBlocks, chapter: ChapterBlocks) -> SectionBlocks:
        return replace(section, blocks=tuple(blocks_of(section, chapter)))

    return tuple(
        replace(chapter, sections=tuple(change(section, chapter) for section in chapter.sections))
        for chapter in chapters
    )


def _change_blocks(
    chapters: Sequence[ChapterBlocks], change: Callable[[Block], Block]
) -> tuple[ChapterBlocks, ...]:
    return _change_sections(chapters, lambda section, _chapter: map(change, section.blocks))


def caption_blocks(chapters: Sequence[ChapterBlocks]) -> tuple[ChapterBlocks, ...]:
    """Chapters in which every table and figure has a caption, and no two the same.

    One without is named by its section and chapter. Captions that several blocks have are told apart by the titles of
    their sections, then of their chapters, then by counting.
    """
    named = _change_sections(
        chapters,
        lambda section, chapter: (_name_block(block, section, chapter) for block in section.blocks),
    )
    named = _tell_apart(named, lambda section, _chapter: section.title)
    named = _tell_apart(named, lambda _section, chapter: chapter.title)
    taken: Counter[str] = Counter()

    def add_count(block: Block) -> Block:
        if not isinstance(block, Captioned):
            return block
        taken[block.caption] += 1
        often = taken[block.caption]
        return block if often == 1 else replace(block, caption=f"{block.caption} ({often})")

    return _change_blocks(named, add_count)


def _name_block(block: Block, section: SectionBlocks, chapter: ChapterBlocks) -> Block:
    if not isinstance(block, Captioned) or block.caption:
        return block
    if section.title:
        title = _("{chapter}: {section}").format(chapter=chapter.title, section=section.title)
    else:
        title = _("{chapter}: summary").format(chapter=chapter.title)
    return replace(block, caption=shown(title))


def _tell_apart(
    chapters: Sequence[ChapterBlocks], title: Callable[[SectionBlocks, ChapterBlocks], str]
) -> tuple[ChapterBlocks, ...]:
    """Captions that stand more than once, each with a title behind it."""
    often = Counter(block.caption for block in captioned_blocks(chapters))

    def add_title(block: Block, behind: str) -> Block:
        if not isinstance(block, Captioned) or often[block.caption] == 1 or shown(behind) in block.caption:
            return block
        return replace(block, caption=f"{block.caption}; {shown(behind)}")

    return _change_sections(
        chapters,
        lambda section, chapter: (add_title(block, title(section, chapter)) for block in section.blocks),
    )


def captioned_blocks(chapters: Sequence[ChapterBlocks]) -> Iterator[Captioned]:
    """Tables and figures of chapters in their order."""
    for chapter in chapters:
        for section in chapter.sections:
            yield from (block for block in section.blocks if isinstance(block, Captioned))


def refer_to_captions(report: Report) -> Report:
    """The report with a sentence before each run of tables, and of figures, that names their numbers.

    On paper figures stand where there is room, so the text has to say which belong to it; standards demand the same of
    tables.
    """
    chapters = _change_sections(report.chapters, lambda section, _chapter: _with_references(section.blocks))
    return replace(report, chapters=chapters)


def _with_references(blocks: Sequence[Block]) -> list[Block]:
    found: list[Block] = []
    for kind, run in groupby(blocks, _captioned_kind):
        members = list(run)
        numbers = [block.number for block in members if isinstance(block, Captioned)]
        if kind is not None:
            found = _with_sentence(found, kind, numbers[0], numbers[-1])
        found += members
    return found


def _captioned_kind(block: Block) -> Kind | None:
    """What a numbered block is called in the text."""
    if not isinstance(block, Captioned) or not block.number:
        return None
    return "table" if isinstance(block, TableBlock) else "figure"


def _with_sentence(blocks: Sequence[Block], kind: Kind, first: int, last: int) -> list[Block]:
    """Blocks with a reference: behind the last sentence, in brackets before its colon, or as a sentence of its own."""
    told, before = list(blocks[:-1]), blocks[-1] if blocks else None
    if isinstance(before, ParagraphBlock | ReferenceBlock):
        if before.text.endswith("."):
            return [*told, replace(before, text=f"{before.text} {reference(kind, first, last)}")]
        if before.text.endswith(":"):
            see = _("see {what}").format(what=_numbers(kind, first, last))
            return [*told, replace(before, text=f"{before.text[:-1]} ({see}):")]
    return [*blocks, ParagraphBlock(reference(kind, first, last))]


def reference(kind: Kind, first: int, last: int) -> str:
    """A sentence that names the numbers of a run."""
    return _("See {what}.").format(what=_numbers(kind, first, last))


def _numbers(kind: Kind, first: int, last: int) -> str:
    """Whom to see: "table 3", "figures 2 and 3", "tables 4 to 7"."""
    if first == last:
        what = _("figure {number}") if kind == "figure" else _("table {number}")
        return what.format(number=first)
    if last == first + 1:
        pair = _("figures {first} and {last}") if kind == "figure" else _("tables {first} and {last}")
        return pair.format(first=first, last=last)
    several = _("figures {first} to {last}") if kind == "figure" else _("tables {first} to {last}")
    return several.format(first=first, last=last)
