"""The headings of a document with their numbers: parts, chapters, sections, elements without numbers, appendices."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import count

from centrode.locale import _
from centrode.render.document.blocks import ChapterBlocks, Report, SectionBlocks

LETTERS = {
    "en": "ABCDEFGHIJKLMNOPQRSTUVWXYZ",
    "ru": "АБВГДЕЖИКЛМНПРСТУФХЦШЩЭЮЯ",
    "uk": "АБВГДЕЖИКЛМНПРСТУФХЦШЩЮЯ",
}
"""Letters of appendices: those of each alphabet that the standards leave for them."""


@dataclass(frozen=True)
class Heading:
    """A heading.

    Attributes
    ----------
    level : 1 of a chapter or a part
    number : "2.1"; empty of one without
    title : of an appendix with its letter
    """

    level: int
    number: str
    title: str


@dataclass(frozen=True)
class OutlinedChapter:
    """A chapter with its headings.

    Attributes
    ----------
    headings : that of its part, where it is the first of one, and its own
    sections : each with its heading; None of one without a title
    opens : whether the opening of the document stands in it
    """

    chapter: ChapterBlocks
    headings: tuple[Heading, ...]
    sections: tuple[tuple[Heading | None, SectionBlocks], ...]
    opens: bool


def outline_of(report: Report) -> Iterator[OutlinedChapter]:
    """The chapters of a document in their order, with the headings that stand before them and in them."""
    numbers, letters = count(1), iter(letters_of(report.language))
    part, number, within = "", 0, count(1)
    opened = not report.is_note
    for chapter in report.chapters:
        headings: list[Heading] = []
        if chapter.role == "appendix":
            letter = next(letters)
            own = Heading(
                1, letter, _("Appendix {letter}. {title}").format(letter=letter, title=chapter.title)
            )
        elif chapter.role != "chapter":
            own = Heading(1, "", chapter.title)
        elif chapter.part:
            if chapter.part != part:
                number, within = next(numbers), count(1)
                headings.append(Heading(1, str(number), chapter.part))
            own = Heading(2, f"{number}.{next(within)}", chapter.title)
        else:
            own = Heading(1, str(next(numbers)), chapter.title)
        part = chapter.part
        opens = not opened and chapter.role == "chapter"
        opened = opened or opens
        yield OutlinedChapter(chapter, (*headings, own), tuple(_sections(chapter, own)), opens)


def letters_of(language: str) -> str:
    """The letters of appendices, in their order."""
    return LETTERS.get(language, LETTERS["en"])


def _sections(chapter: ChapterBlocks, above: Heading) -> Iterator[tuple[Heading | None, SectionBlocks]]:
    """Sections with their headings; those without a title are not counted."""
    number = 0
    for section in chapter.sections:
        if not section.title:
            yield None, section
            continue
        number += 1
        own = f"{above.number}.{number}" if above.number else ""
        yield Heading(above.level + 1, own, section.title), section
