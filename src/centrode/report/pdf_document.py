"""The PDF of a report."""

from __future__ import annotations

import functools
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from functools import singledispatchmethod
from itertools import chain
from pathlib import Path
from typing import Any

import typst

from centrode.locale import LANGUAGES, _, chosen_language, speaking
from centrode.model.page_standards import Standard
from centrode.quantities import UNIT_SYMBOLS
from centrode.render.document.blocks import (
    Block,
    CheckBlock,
    FormulaBlock,
    ItemsBlock,
    Moving,
    ParagraphBlock,
    Picture,
    ProseBlock,
    ReferenceBlock,
    Report,
    SectionBlocks,
    Span,
    SystemBlock,
    TableBlock,
    TitlePageBlocks,
)
from centrode.render.document.captions import number_blocks
from centrode.render.document.figures import picture_width
from centrode.render.document.numbers import NO_BREAK
from centrode.render.document.outline import Heading, OutlinedChapter, outline_of
from centrode.render.document.typst import quote
from centrode.report.figure_places import CHAPTER_END, EXPRESSION, FLOATING, Layout, well_placed
from centrode.report.mathematics import check_formula, pieces_of, relations_of
from centrode.report.note import CONCLUSIONS, SOURCES
from centrode.report.page_styles import page_style
from centrode.report.pdf_objects import packed_pdf
from centrode.report.spoken_formulas import spoken_formula, spoken_picture, spoken_relations, spoken_system
from centrode.report.texts import parts_of

# A report as the source of a typst document; everything a user wrote stands in it as a string.

ANNOUNCEMENT = 160
"""Letters of a paragraph that may be there only for the formula, table or picture behind it."""
LONGEST_WHOLE = 600
"""Characters from which on a cell may break between pages."""
LONGEST_NUMBER = 24
"""Characters of a number that is not parted from its unit."""
POINTS = 72.0 / 25.4
"""Points in a millimetre."""
STYLE_IMPORT = '#import "style.typ": *'
LETTERS = 1024
"""Outlines that are kept: most figures of a document have the same letters."""
WIDEST = 8
"""Cells of a column, the longest of them, that its width is measured by."""


class Source:
    """The source of a document and the pictures it shows.

    Attributes
    ----------
    text : of the document
    head : lines of it before the first chapter
    files : name -> bytes of every picture
    """

    def __init__(self, report: Report) -> None:
        self.files: dict[str, bytes] = {}
        report = number_blocks(report)
        outline = list(outline_of(report))
        head = "\n".join(self._head(report, outline))
        chapters = (self._chapter(one, report) for one in outline if one.chapter.role != "front")
        self.head = head.count("\n") + 1
        self.text = "\n".join([head, *chain.from_iterable(chapters)]) + "\n"

    def _head(self, report: Report, outline: Sequence[OutlinedChapter]) -> Iterator[str]:
        """What stands before the first chapter."""
        contents = _("Contents")
        yield STYLE_IMPORT
        front = [one for one in outline if one.chapter.role == "front"]
        opening = "none" if report.is_note else self._opening(report.opening)
        before = "\n".join(line for one in front for line in self._chapter(one, report))
        note = (
            f", note: true, cover: {_cover(report.title_page)}, front: [{before}]" if report.is_note else ""
        )
        if report.standard != "plain":
            # typst's own words are shorter than the standards have them
            words = (_("Figure {number}"), _("Table {number}"))
            figure, table = (quote(word.format(number="").strip()) for word in words)
            note += f", figure-word: {figure}, table-word: {table}"
        yield (
            f"#show: document.with(title: {quote(report.title)}, subtitle: {quote(report.subtitle)},"
            f" language: {quote(report.language)}, contents: {quote(contents)},"
            f" opening: {opening}"
            f"{note})"
        )

    def _opening(self, blocks: Sequence[Block]) -> str:
        """What stands below the title: pictures stay there, all others float; paper plays no motion."""
        parts = (
            self._picture(one, floats=False) if isinstance(one, Picture) else self._shown(one)
            for one in blocks
            if not isinstance(one, Moving)
        )
        return f"[{''.join(parts)}]" if blocks else "none"

    def _chapter(self, outlined: OutlinedChapter, report: Report) -> Iterator[str]:
        chapter = outlined.chapter
        sentences = chapter.name in (CONCLUSIONS, SOURCES)
        if sentences:
            yield "#sentences["
        for heading in outlined.headings:
            yield _heading(heading, chapter.role)
        if chapter.missing:
            words = _("This chapter could not be made: {reason}").format(reason=chapter.missing)
            yield f"#missing({quote(words)})"
        if outlined.opens:
            yield f"#{self._opening(report.opening)}" if report.opening else ""
        for title, section in outlined.sections:
            yield from self._section(title, section, chapter.role)
        if sentences:
            yield "]"
        if chapter.role != "front":
            yield CHAPTER_END

    def _section(self, title: Heading | None, section: SectionBlocks, role: str) -> Iterator[str]:
        if title is not None:
            yield _heading(title, role)
        for number, block in enumerate(section.blocks):
            shown = self._shown(block)
            yield f"#block(sticky: true, {shown[1:]})" if _announces(section.blocks[number:]) else shown

    @singledispatchmethod
    def _shown(self, block: Block) -> str:
        raise TypeError(f"no block of a report: {type(block).__name__}")

    @_shown.register
    def _paragraph(self, block: ParagraphBlock) -> str:
        return f"#par({content(block.text)})"

    @_shown.register
    def _prose(self, block: ProseBlock) -> str:
        paragraphs = [f"[{''.join(map(_span, one))}]" for one in block.paragraphs]
        if block.kind == "paragraph":
            return "\n".join(f"#par({one})" for one in paragraphs)
        return f"#{'enum' if block.kind == 'numbers' else 'list'}({', '.join(paragraphs)})"

    @_shown.register
    def _items(self, block: ItemsBlock) -> str:
        kind = "enum" if block.numbered else "list"
        return f"#{kind}({', '.join(map(content, block.texts))})"

    @_shown.register
    def _formula(self, block: FormulaBlock) -> str:
        formula = f"relations({_relations(block.lines)}, {_strings(spoken_relations(block))})"
        return f"#numbered({block.number}, {formula})"

    @_shown.register
    def _system(self, block: SystemBlock) -> str:
        matrix = _array([_array([_math(entry) for entry in row]) for row in block.matrix])
        unknowns, right = (_array([_math(one) for one in column]) for column in (block.unknowns, block.right))
        lines, words = _relations(relations_of(block)), _strings(spoken_system(block))
        formula = f"system({matrix}, {unknowns}, {right}, {lines}, {words})"
        return f"#numbered({block.number}, {formula})"

    @_shown.register
    def _reference(self, block: ReferenceBlock) -> str:
        pieces = (
            f"#formula-number({one});" if isinstance(one, int) else _bracketed_text(one)
            for one in block.pieces
        )
        return f"#par([{''.join(pieces)}])"

    @_shown.register
    def _table(self, block: TableBlock) -> str:
        numbers = block.numbers or (False,) * len(block.head)
        columns = [
            _column(head, [row[i] for row in block.rows], numbers[i]) for i, head in enumerate(block.head)
        ]
        rows = [_array([_cell(cell) for cell in row]) for row in block.rows]
        # A row that no page could hold has to be torn.
        whole = "true" if all(len(cell) < LONGEST_WHOLE for row in block.rows for cell in row) else "false"
        continued = quote(_("Table {number}, continued").format(number=block.number))
        given = (_array(columns), _array(rows), _caption(block.caption), f"{block.number}", whole, continued)
        return f"#data-table({', '.join(given)})"

    @_shown.register
    def _picture(self, block: Picture, floats: bool = True) -> str:
        name = f"pictures/{len(self.files) + 1}.svg"
        self.files[name] = with_cubic_letters(block.svg)
        kind = FLOATING if floats and block.caption else "#picture("
        given = (f"{picture_width(block):.3f}in", _caption(block.caption), quote(spoken_picture(block)))
        return f"{kind}{quote(name)}, {', '.join(given)}, {block.number})"

    @_shown.register
    def _moving(self, block: Moving) -> str:
        return self._picture(replace(block.still, caption=block.caption, number=block.number))

    @_shown.register
    def _check(self, block: CheckBlock) -> str:
        return f"#check({'true' if block.holds else 'false'}, {content(block.text)})"


_OUTLINE = re.compile(rb'(<path id="[^"]*" d=")([^"]*)(" transform="scale\(0\.015625\))')
_STEP = re.compile(rb"[A-Za-z]|-?\d+")


def with_cubic_letters(svg: bytes) -> bytes:
    """A picture whose letters have cubic curves between whole units: PDF knows no others, and whole numbers are short.

    A unit is less than a two-thousandth of the height of a capital.
    """
    return _OUTLINE.sub(lambda found: found[1] + _cubic(found[2]) + found[3], svg)


@functools.lru_cache(LETTERS)
def _cubic(outline: bytes) -> bytes:
    """The outline of a letter with cubic curves for parabolas; as it is where it is not what matplotlib writes."""
    steps = _STEP.findall(outline)
    written: list[str] = []
    here = (0, 0)
    k = 0
    while k < len(steps):
        letter = steps[k].decode()
        count = {"M": 2, "L": 2, "Q": 4, "z": 0}.get(letter)
        if count is None or len(steps) < k + 1 + count or b"." in outline:
            return outline
        numbers = [int(one) for one in steps[k + 1 : k + 1 + count]]
        if letter == "Q":
            control, end = numbers[:2], numbers[2:]
            near = [round((one + 2 * c) / 3) for one, c in zip(here, control, strict=True)]
            far = [round((one + 2 * c) / 3) for one, c in zip(end, control, strict=True)]
            letter, numbers = "C", [*near, *far, *end]
        if numbers:
            here = numbers[-2], numbers[-1]
        written.append(f"{letter} {' '.join(map(str, numbers))}")
        k += 1 + count
    return " ".join(written).encode()


def _heading(heading: Heading, role: str) -> str:
    """A heading, which typst numbers; of elements and appendices without, and their sections in no contents."""
    if role == "chapter":
        return f"#heading(level: {heading.level}, {quote(heading.title)})"
    if role == "appendix" and heading.level == 1:
        letter, _dot, title = heading.title.partition(". ")
        return f"#appendix({quote(letter)}, {quote(title)})"
    listed = "true" if heading.level == 1 and role != "front" else "false"
    kind = "element" if heading.level == 1 else "heading.with(numbering: none)"
    return f"#{kind}(level: {heading.level}, outlined: {listed}, {quote(heading.title)})"


def _cover(page: TitlePageBlocks | None) -> str:
    """The title page; none without one."""
    if page is None:
        return "none"
    people = _array([_strings(one) for one in page.people])
    lines = (page.work, page.course, page.title, page.variant)
    return f"title-page({_strings(page.head)}, {', '.join(map(quote, lines))}, {people}, {quote(page.foot)})"


def _announces(blocks: Sequence[Block]) -> bool:
    """Whether the first of these is a line that would be lost at the foot of a page without what it announces.

    Lines that end with a colon, and those that refer to formulas, announce a line too.
    """
    block, *others = blocks
    if isinstance(block, ReferenceBlock) and others:
        return not isinstance(others[0], ParagraphBlock | ReferenceBlock) or _announces(others)
    if not isinstance(block, ParagraphBlock) or not others or len(block.text) > ANNOUNCEMENT:
        return False
    following = others[0]
    if isinstance(following, Picture | Moving) and following.caption:
        return False  # it stands where there is room, so the line stays with what is before it
    return not isinstance(following, ParagraphBlock | ReferenceBlock) or (
        block.text.endswith(":") and _announces(others)
    )


def content(marked: str) -> str:
    """Text with mathematics between dollar signs as content."""
    parts = [
        f"#{_inline(part.text)};" if part.mathematics else _bracketed_text(part.text)
        for part in parts_of(marked)
    ]
    return f"[{''.join(parts)}]"


_EQUAL = re.compile(r"= (?=[−+-]?\d)")
"""Before a number, which is not parted from its sign of equality."""


@functools.cache
def _measured_quantity(language: str) -> re.Pattern[str]:
    """A number, the blank behind it, and its unit."""
    place = LANGUAGES.index(language)
    symbols = sorted({re.escape(names[place]) for names in UNIT_SYMBOLS.values()}, key=len, reverse=True)
    unit = f"(?:{'|'.join(symbols)})[²³⁴]?"
    digits = "\\d⁰¹²³⁴-⁹"
    number = rf"[−+-]?[{digits}.,·⁻]{{0,{LONGEST_NUMBER}}}[{digits}]"
    return re.compile(rf"({number})([ \u00a0\u202f])({unit}(?:[·/]{unit})*)(?!\w)")


def _whole_quantities(text: str) -> list[str]:
    """Pieces of a text as typst's strings: a number stays on one line with its unit, a unit whole."""
    found: list[str] = []
    end = 0
    text = _EQUAL.sub(f"={NO_BREAK}", text)
    for one in _measured_quantity(chosen_language()).finditer(text):
        quantity = _kept_together(one)
        before = text[end : one.start()]
        if "/" in quantity:
            found += [quote(before), f"box({quote(quantity)})"]
        else:
            found.append(quote(before + quantity))
        end = one.end()
    return [*found, quote(text[end:])] if end < len(text) or not found else found


def _kept_together(quantity: re.Match[str]) -> str:
    """A number and its unit without a blank at which a line may end."""
    number, gap, unit = quantity.groups()
    return f"{number}{NO_BREAK if gap == ' ' else gap}{unit}"


def _with_units(text: str) -> str:
    """A text whose numbers keep their units."""
    return _measured_quantity(chosen_language()).sub(_kept_together, _EQUAL.sub(f"={NO_BREAK}", text))


def _bracketed_text(text: str) -> str:
    """A text as content between brackets."""
    return "".join(f"#{piece};" for piece in _whole_quantities(text))


def _span(span: Span) -> str:
    """A stretch of a user's text as content."""
    shown = f"raw({quote(span.text)})" if span.code else f"[{_bracketed_text(span.text)}]"
    shown = f"emph({shown})" if span.emphasized else shown
    return f"#{f'strong({shown})' if span.strong else shown};"


def _math(formula: str) -> str:
    """Mathematics; a blank at both ends would set it apart from its sentence."""
    return f"${check_formula(formula).strip()}$"


def _inline(formula: str) -> str:
    """Mathematics of a sentence with its words, for those who hear it."""
    return f"inline({_math(formula)}, {quote(spoken_formula(formula))})"


def _cell(text: str) -> str:
    """A cell of a table: text without mathematics is a string, which typst reads much faster."""
    parts = parts_of(text)
    if any(part.mathematics for part in parts):
        return content(text)
    pieces = _whole_quantities("".join(part.text for part in parts))
    return pieces[0] if len(pieces) == 1 else content(text)


def _caption(text: str) -> str:
    return content(text) if text else "none"


def _strings(texts: Sequence[str]) -> str:
    return _array([quote(text) for text in texts])


def _array(entries: Sequence[str]) -> str:
    return f"({', '.join(entries)}{',' if len(entries) == 1 else ''})"


def _relations(lines: Sequence[Sequence[str]]) -> str:
    return _array([_array([_pieces(part) for part in line]) for line in lines])


def _pieces(formula: str) -> str:
    """The pieces of a formula, each with the finer ones that it can be cut into: ((coarse, (fine, ...)), ...)."""
    found = []
    for piece in pieces_of(check_formula(formula)):
        fine = pieces_of(piece, depth=1)
        found.append(f"(${piece}$, {_array([f'${one}$' for one in fine])})")
    return _array(found)


def _column(head: str, cells: Sequence[str], number: bool) -> str:
    """What the width of a column is measured by: its head, the words that may not be cut, its longest cells.

    The words of its head are the most lines that it has.
    """
    longest = sorted(set(cells), key=lambda cell: (-len(cell), cell))[:WIDEST] or [""]
    words = _words(head)
    if not number:
        found = {word for cell in set(cells) for word in _words(cell)}
        words += sorted(found, key=lambda word: (-len(word), word))[:WIDEST]
    fields = {
        "head": content(head),
        "lines": f"{max(len(_words(head)), 1)}",
        "words": _array(words or [quote("")]),
        "longest": _array([_cell(cell) for cell in longest]),
        "number": "true" if number else "false",
    }
    return f"({', '.join(f'{key}: {value}' for key, value in fields.items())})"


def _words(text: str) -> list[str]:
    """What of a text stands on one line: words, numbers with their units, formulas, each as content."""
    found = []
    for part in parts_of(text):
        if part.mathematics:
            found.append(_math(part.text))
        else:
            found += [quote(word) for word in re.split(r"[ \t\r\n]+", _with_units(part.text)) if word]
    return found


STYLE = Path(__file__).with_name("style.typ")


def style_files(report: Report) -> dict[str, bytes]:
    """What the source of a report imports: the style, and the page of its standard."""
    return {"style.typ": STYLE.read_bytes(), "page.typ": page_style(report.standard).typst().encode()}


STANDARDS: tuple[list[Any], ...] = (["ua-1", "a-2a"], [])
"""PDF/UA-1 (tagged, described) with PDF/A-2a (kept for decades); neither where a user's letters are in no font."""

EPOCH = 315_532_800
"""The date of every document: PDF/A wants one, and the same report gives the same bytes. That of the other formats."""


def document_files(text: str, head: int) -> dict[str, bytes]:
    """The source of a document as files: the main one, and each chapter in one of its own.

    Typst remembers what it has laid out by the place of the source within its file. So a chapter whose figures move is
    laid out anew, and no other one.

    Parameters
    ----------
    text, head : of a `Source`
    """
    lines = text.splitlines()
    main, chapter = lines[:head], [STYLE_IMPORT]
    files: dict[str, bytes] = {}
    for line in lines[head:]:
        chapter.append(line)
        if line.startswith(CHAPTER_END):
            name = f"chapter-{len(files) + 1}.typ"
            files[name] = "\n".join(chapter).encode()
            main.append(f'#include "{name}"')
            chapter = [STYLE_IMPORT]
    return {"main": "\n".join(main).encode(), **files}


def pdf_document(report: Report) -> bytes:
    """A report as PDF/UA-1 and PDF/A-2a: tagged, with an outline and page numbers; the same bytes from the same report.

    Typst reads nothing but what is handed to it, and no fonts but its own. Both standards forbid letters that no font
    has: a document with such letters of a user's is a plain PDF.
    """
    return typesetting(report)()


def typesetting(report: Report) -> Callable[[], bytes]:
    """What makes the PDF of a report: it speaks no language any more, and may work beside what speaks another one."""
    with speaking(report.language):
        source = Source(report)
        beside = {**style_files(report), **source.files}
    return functools.partial(_typeset, source, beside, report.standard)


def _typeset(source: Source, beside: Mapping[str, bytes], standard: Standard) -> bytes:

    def layout_of(text: str) -> Layout:
        inputs: Any = {**document_files(text, source.head), **beside}
        return Layout.read(typst.Compiler(input=inputs, ignore_system_fonts=True).eval(EXPRESSION))

    page = page_style(standard)
    text = well_placed(source.text, layout_of, page.top * POINTS, (297.0 - page.top - page.bottom) * POINTS)
    files: Any = {**document_files(text, source.head), **beside}
    # a compiler with the same input as the one that was asked for places finds what that laid out
    compiler = typst.Compiler(input=files, ignore_system_fonts=True)
    *strict, plain = STANDARDS
    for standards in strict:
        with suppress(typst.TypstError):
            return _compiled_pdf(compiler, files, standards)
    return _compiled_pdf(compiler, files, plain)


def _compiled_pdf(compiler: typst.Compiler, files: Any, standards: list[Any]) -> bytes:
    document, _warnings = compiler.compile_with_warnings(
        input=files, format="pdf", timestamp=EPOCH, pdf_standards=standards
    )
    assert isinstance(document, bytes)
    return packed_pdf(document)
