"""A report as an explanatory note: title page, task, contents, parts, conclusions, sources, appendices."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

from centrode.locale import _
from centrode.model.explanatory_note import ExplanatoryNote, TitlePage
from centrode.model.page_standards import Standard
from centrode.render.document.blocks import (
    Block,
    ChapterBlocks,
    ParagraphBlock,
    Picture,
    ProseBlock,
    Report,
    SectionBlocks,
    Span,
    TableBlock,
    TitlePageBlocks,
)
from centrode.render.document.captions import reference
from centrode.render.document.outline import letters_of
from centrode.report.citations import cite_sources
from centrode.topics.order import PARTS

CONCLUSIONS, CHECKS, SOURCES = "conclusions", "checks", "sources"
"""Names of chapters that have places of their own."""
STANDARD_OF_LANGUAGE: Mapping[str, Standard] = {"ru": "gost", "uk": "dstu"}
"""Of a note that names none."""

WORD = re.compile("[а-яёєіїґ]{2}")
"""How a head begins that is a word of Russian or Ukrainian, no letter of a quantity and no name in Latin letters."""

Sections = Callable[[str], tuple[SectionBlocks, ...]]
"""What makes sections of a text in Markdown."""


def standard_of(wished: Standard | None, is_note: bool, language: str) -> Standard:
    """The standard of a document: as wished, of a note that of its language, else none."""
    if wished is not None:
        return wished
    return STANDARD_OF_LANGUAGE.get(language, "plain") if is_note else "plain"


def as_note(report: Report, note: ExplanatoryNote, sections: Sections) -> Report:
    """A report with what is given of a note around its chapters, these in parts."""
    end = [chapter for chapter in report.chapters if chapter.name == CONCLUSIONS]
    checks = [replace(chapter, role="appendix") for chapter in report.chapters if chapter.name == CHECKS]
    body = [chapter for chapter in report.chapters if chapter.name not in (CONCLUSIONS, CHECKS)]
    page = note.title_page
    chapters = (
        *_element("task", _("Task"), note.task, sections, front=True),
        *_element("abstract", _("Abstract"), note.abstract, sections, front=True),
        *_element("introduction", _("Introduction"), note.introduction, sections),
        *_in_parts(body),
        *_conclusions(end, note.conclusions, sections),
        *_sources(note.sources),
        *checks,
    )
    chapters = _with_reference_to_checks(cite_sources(chapters, len(note.sources)), report.language)
    title = page.title if page is not None and page.title else report.title
    return replace(
        report,
        title=title,
        opening=_opening_with_reference(report.opening),
        chapters=chapters,
        title_page=None if page is None else _title_page(page, title),
        is_note=True,
    )


def _with_reference_to_checks(
    chapters: tuple[ChapterBlocks, ...], language: str
) -> tuple[ChapterBlocks, ...]:
    """Chapters whose last numbered one says where the checks are; as they are without the appendix."""
    places = [place for place, chapter in enumerate(chapters) if chapter.role == "chapter"]
    if not places or not any(chapter.role == "appendix" for chapter in chapters):
        return chapters
    text = _("Appendix {letter} gathers the checks of the results.").format(letter=letters_of(language)[0])
    last = places[-1]
    chapter = chapters[last]
    sections = (*chapter.sections, SectionBlocks("", (ParagraphBlock(text),)))
    return (*chapters[:last], replace(chapter, sections=sections), *chapters[last + 1 :])


def with_capital_heads(report: Report) -> Report:
    """A report whose heads of columns and rows begin with capital letters (ГОСТ 2.105-2019; ДСТУ 3008:2015)."""
    chapters = tuple(
        replace(
            chapter,
            sections=tuple(
                replace(section, blocks=tuple(map(_with_capitals, section.blocks)))
                for section in chapter.sections
            ),
        )
        for chapter in report.chapters
    )
    return replace(report, chapters=chapters)


def _with_capitals(block: Block) -> Block:
    if not isinstance(block, TableBlock):
        return block
    rows = tuple((*map(_capital, row[:1]), *row[1:]) for row in block.rows)
    return replace(block, head=tuple(map(_capital, block.head)), rows=rows)


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:] if WORD.match(text) else text


def _element(
    name: str, title: str, text: str, sections: Sections, *, front: bool = False
) -> tuple[ChapterBlocks, ...]:
    """What the author writes under a heading of its own; nothing where nothing is written."""
    if not text:
        return ()
    return (ChapterBlocks(name, title, sections(text), computed=False, role="front" if front else "element"),)


def _in_parts(chapters: Sequence[ChapterBlocks]) -> list[ChapterBlocks]:
    """Chapters with the part of the note that each belongs to; one alone in its part stands for itself."""
    often = Counter(PARTS.get(chapter.name, "") for chapter in chapters)
    parts = {name for name, times in often.items() if name and times > 1}
    if len(often) == 1:  # all of one part: they are the parts
        return list(chapters)
    found = [(PARTS.get(chapter.name, ""), chapter) for chapter in chapters]
    return [replace(chapter, part=_(part)) if part in parts else chapter for part, chapter in found]


def _conclusions(
    computed: Sequence[ChapterBlocks], text: str, sections: Sections
) -> tuple[ChapterBlocks, ...]:
    """Those from the results, then the author's own."""
    own = sections(text) if text else ()
    if computed:
        return tuple(replace(one, sections=(*one.sections, *own), role="element") for one in computed)
    return _element(CONCLUSIONS, _("Conclusions"), text, sections)


def _sources(entries: Sequence[str]) -> tuple[ChapterBlocks, ...]:
    if not entries:
        return ()
    listed = ProseBlock(tuple((Span(entry),) for entry in entries), "numbers")
    made = ChapterBlocks(
        SOURCES, _("List of sources"), (SectionBlocks("", (listed,), "before"),), computed=False
    )
    return (replace(made, role="element"),)


def _opening_with_reference(opening: tuple[Block, ...]) -> tuple[Block, ...]:
    """The opening behind a sentence that names its figure."""
    figures = [block for block in opening if isinstance(block, Picture) and block.number]
    if not figures:
        return opening
    number = figures[0].number
    return (ParagraphBlock(reference("figure", number, number)), *opening)


def _title_page(page: TitlePage, title: str) -> TitlePageBlocks:
    """The lines of the title page, with the words of the language before what needs them."""
    group = _("group {group}").format(group=page.group) if page.group else ""
    done, accepted = ", ".join(one for one in (page.author, group) if one), page.teacher
    people = ((_("Done by"), done), (_("Accepted by"), accepted))
    head = (page.ministry, page.institution, page.faculty, page.department)
    return TitlePageBlocks(
        tuple(line for line in head if line),
        page.work,
        _("course: {course}").format(course=page.course) if page.course else "",
        title,
        _("Variant {variant}").format(variant=page.variant) if page.variant else "",
        tuple((label, name) for label, name in people if name),
        " ".join(str(one) for one in (page.city, page.year) if one),
    )
