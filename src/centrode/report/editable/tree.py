"""A report as pandoc's tree: headings, paragraphs, native formulas, tables and figures, for any of its writers."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import singledispatchmethod
from typing import Any, TypeAlias

from centrode.locale import _
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
from centrode.render.document.outline import Heading, OutlinedChapter, outline_of
from centrode.report.editable.mathematics import LatexFormulas, latex_formulas, spellings_of
from centrode.report.spoken_formulas import spoken_picture
from centrode.report.texts import blocks_of, parts_of, texts_of

Element: TypeAlias = dict[str, Any]
"""A node of pandoc's tree."""
API = (1, 23, 1)
"""Version of the tree."""
NO_ATTRIBUTES: tuple[str, tuple[str, ...], tuple[tuple[str, str], ...]] = ("", (), ())
ROOM = 104
"""Letters that the cells of a row may have beside each other on the width of a page."""
TABLE_CAPTION = "Table Caption"
"""Name of the style of lines above tables."""
LEAST, SENTENCE, GAP = 3, 24, 3
"""Letters of a column of words at least and where it is broken into lines, and between two columns."""


@dataclass
class DocumentTree:
    """Makes the tree of a report.

    Attributes
    ----------
    formulas : of the report in LaTeX
    number : (LaTeX of a displayed formula, its number) -> blocks
    refer : number of a formula -> what stands for it in a sentence
    file : ending of the pictures
    cover : title page -> blocks, for what has no title page of its own
    contents : what stands where the contents of a note are
    unnumbered : (heading without a number, what it belongs to) -> the element; the writer's own if None
    pictures : name -> SVG of each picture, in their order
    """

    formulas: LatexFormulas
    number: Callable[[str, int], list[Element]]
    refer: Callable[[int], Element]
    file: str
    cover: Callable[[TitlePageBlocks], list[Element]] = lambda _page: []
    contents: Callable[[], list[Element]] = list
    unnumbered: Callable[[Heading, str], Element] | None = None
    pictures: dict[str, bytes] = field(default_factory=dict)

    def document(self, report: Report) -> bytes:
        """The whole tree as pandoc reads it."""
        blocks = [] if report.is_note else self._opening(report)
        if report.title_page is not None:
            blocks += self.cover(report.title_page)
        outline = list(outline_of(report))
        front = [one for one in outline if one.chapter.role == "front"]
        blocks += [one for outlined in front for one in self.chapter(outlined, report)]
        if report.is_note:
            blocks += self.contents()
        blocks += [
            one
            for outlined in outline
            if outlined.chapter.role != "front"
            for one in self.chapter(outlined, report)
        ]
        details = {
            "title": [_text(report.title)],
            "subtitle": [_text(report.subtitle)],
            "lang": [_text(report.language)],
            "toc-title": [_text(_("Contents"))],
        }
        if report.title_page is not None:  # the title stands on it
            del details["title"], details["subtitle"]
        meta = {key: {"t": "MetaInlines", "c": value} for key, value in details.items()}
        return json.dumps({"pandoc-api-version": API, "meta": meta, "blocks": blocks}).encode()

    def _opening(self, report: Report) -> list[Element]:
        """The scheme; paper plays no motion."""
        return [one for block in report.opening if not isinstance(block, Moving) for one in self.shown(block)]

    def chapter(self, outlined: OutlinedChapter, report: Report) -> Iterator[Element]:
        """A chapter under its heading, and that of its part where it is the first of one."""
        chapter = outlined.chapter
        for heading in outlined.headings:
            yield self.heading(heading, chapter.role)
        if chapter.missing:
            yield paragraph(
                [_text(_("This chapter could not be made: {reason}").format(reason=chapter.missing))]
            )
        if outlined.opens:
            yield from self._opening(report)
        for title, section in outlined.sections:
            yield from self.section(title, section, chapter.role)

    def heading(self, heading: Heading, role: str) -> Element:
        """A heading, which the writer numbers unless it has no number."""
        if role != "chapter" and self.unnumbered is not None:
            return self.unnumbered(heading, role)
        return _heading(heading, role)

    def section(self, heading: Heading | None, section: SectionBlocks, role: str) -> Iterator[Element]:
        """A section, under its heading if it has one."""
        if heading is not None:
            yield self.heading(heading, role)
        for block in section.blocks:
            yield from self.shown(block)

    def inlines(self, marked: str) -> list[Element]:
        """A text with its mathematics."""
        return [
            _node("Math", [{"t": "InlineMath"}, self.formulas.inline(part.text)])
            if part.mathematics
            else _text(part.text)
            for part in parts_of(marked)
        ]

    @singledispatchmethod
    def shown(self, block: Block) -> list[Element]:
        """A block of the report."""
        raise TypeError(f"no block of a report: {type(block).__name__}")

    @shown.register
    def _paragraph(self, block: ParagraphBlock) -> list[Element]:
        return [paragraph(self.inlines(block.text))]

    @shown.register
    def _prose(self, block: ProseBlock) -> list[Element]:
        paragraphs = [[_span(span) for span in one] for one in block.paragraphs]
        if block.kind == "paragraph":
            return [paragraph(one) for one in paragraphs]
        return [_list(paragraphs, block.kind == "numbers")]

    @shown.register
    def _items(self, block: ItemsBlock) -> list[Element]:
        return [_list([self.inlines(text) for text in block.texts], block.numbered)]

    @shown.register
    def _formula(self, block: FormulaBlock) -> list[Element]:
        return self.number(self.formulas.relations(block), block.number)

    @shown.register
    def _system(self, block: SystemBlock) -> list[Element]:
        return self.number(self.formulas.system(block), block.number)

    @shown.register
    def _reference(self, block: ReferenceBlock) -> list[Element]:
        return [paragraph([self.refer(one) if isinstance(one, int) else _text(one) for one in block.pieces])]

    @shown.register
    def _check(self, block: CheckBlock) -> list[Element]:
        sign, word = ("\u2713", _("Checked")) if block.holds else ("\u2717", _("Does not hold"))
        return [
            paragraph([_node("Strong", [_text(f"{sign} {word}.")]), _text(" "), *self.inlines(block.text)])
        ]

    @shown.register
    def _table(self, block: TableBlock) -> list[Element]:
        return list(self._tables(block))

    @shown.register
    def _picture(self, block: Picture) -> list[Element]:
        name = f"{len(self.pictures) + 1:02}.{self.file}"
        self.pictures[name] = block.svg
        caption = self.inlines(block.caption)
        width = ("", (), (("width", f"{picture_width(block):.2f}in"),))
        image = _node("Image", [width, [_text(spoken_picture(block))], [name, ""]])
        if not caption:
            return [paragraph([image])]
        return [_node("Figure", [NO_ATTRIBUTES, _caption(caption), [_node("Plain", [image])]])]

    @shown.register
    def _moving(self, block: Moving) -> list[Element]:
        return self._picture(replace(block.still, caption=block.caption or block.still.caption))

    def _tables(self, block: TableBlock) -> Iterator[Element]:
        """A table, dealt to several where a page is not wide enough; each begins with the first column.

        Further parts have no number of their own: they stand below a line that names the table.
        """
        widths = [_width(block, column) for column in range(len(block.head))]
        for number, chosen in enumerate(_dealt(widths)):
            caption = self.inlines(block.caption) if block.caption and not number else []
            if block.caption and number:
                yield styled_paragraph(TABLE_CAPTION, continued_table(str(block.number)))
            yield self._grid(block, chosen, widths, caption)

    def _grid(
        self, block: TableBlock, chosen: Sequence[int], widths: Sequence[int], caption: list[Element]
    ) -> Element:
        numbers = [block.numbers[column] if column < len(block.numbers) else False for column in chosen]
        total = sum(widths[column] + GAP for column in chosen)
        share = [(widths[column] + GAP) / max(total, ROOM / 2) for column in chosen]
        columns = [
            [{"t": "AlignRight" if number else "AlignLeft"}, {"t": "ColWidth", "c": round(min(1.0, one), 4)}]
            for number, one in zip(numbers, share, strict=True)
        ]
        head = self._row([block.head[column] for column in chosen])
        rows = [self._row([row[column] for column in chosen]) for row in block.rows]
        return _node(
            "Table",
            [
                NO_ATTRIBUTES,
                _caption(caption),
                columns,
                [NO_ATTRIBUTES, [head]],
                [[NO_ATTRIBUTES, 0, [], rows]],
                [NO_ATTRIBUTES, []],
            ],
        )

    def _row(self, cells: Sequence[str]) -> list[Any]:
        return [NO_ATTRIBUTES, [cell_of(self.inlines(cell)) for cell in cells]]


def cell_of(inlines: list[Element], alignment: str = "AlignDefault") -> list[Any]:
    """A cell of a table."""
    return [NO_ATTRIBUTES, {"t": alignment}, 1, 1, [_node("Plain", inlines)] if inlines else []]


def continued_table(number: str) -> str:
    """What stands above a further part of a table."""
    return _("Table {number}, continued").format(number=number)


def styled_paragraph(style: str, text: str) -> Element:
    """A paragraph with a style of its own, where the writer knows styles."""
    return _node("Div", [["", [], [["custom-style", style]]], [paragraph([plain_text(text)])]])


def tree_of(
    report: Report,
    number: Callable[[str, int], list[Element]],
    refer: Callable[[int], Element],
    file: str,
    cover: Callable[[TitlePageBlocks], list[Element]] = lambda _page: [],
    contents: Callable[[], list[Element]] = list,
    unnumbered: Callable[[Heading, str], Element] | None = None,
) -> tuple[bytes, Mapping[str, bytes]]:
    """The tree of a report and the pictures that it names."""
    report = number_blocks(report)
    spelled: list[str] = []
    for block in blocks_of(report):
        spelled += [part.text for text in texts_of(block) for part in parts_of(text) if part.mathematics]
        if isinstance(block, FormulaBlock | SystemBlock):
            spelled += spellings_of(block)
    tree = DocumentTree(latex_formulas(spelled), number, refer, file, cover, contents, unnumbered)
    return tree.document(report), tree.pictures


def displayed_formula(latex: str) -> Element:
    """A formula on a line of its own."""
    return paragraph([_node("Math", [{"t": "DisplayMath"}, latex])])


def raw_block(kind: str, text: str) -> Element:
    """What a writer takes as it is."""
    return _node("RawBlock", [kind, text])


def raw_inline(kind: str, text: str) -> Element:
    """What a writer takes as it is, in a sentence."""
    return _node("RawInline", [kind, text])


def paragraph(inlines: list[Element]) -> Element:
    """Sentences."""
    return _node("Para", inlines)


def plain_text(text: str) -> Element:
    """Text as it is."""
    return _text(text)


def _node(kind: str, content: Any) -> Element:
    return {"t": kind, "c": content}


def _text(text: str) -> Element:
    """Text as it is: a single string, in which nothing is read."""
    return _node("Str", " ".join(re.split(r"[\t\r\n]+", "".join(map(_printable, text)))))


def _span(span: Span) -> Element:
    """A stretch of a user's text."""
    element = _node("Code", [NO_ATTRIBUTES, span.text]) if span.code else _text(span.text)
    element = _node("Emph", [element]) if span.emphasized else element
    return _node("Strong", [element]) if span.strong else element


def _printable(letter: str) -> str:
    return letter if letter.isprintable() or letter in "\u00a0\u202f" else " "


def _heading(heading: Heading, role: str) -> Element:
    """A heading that the writer numbers; one without a number says what it belongs to."""
    listed = heading.level == 1 and role != "front"
    kinds = () if role == "chapter" else ("unnumbered", role, *(() if listed else ("unlisted",)))
    return _node("Header", [heading.level, ["", kinds, []], [_text(heading.title)]])


def _list(items: Sequence[list[Element]], numbered: bool) -> Element:
    blocks = [[_node("Plain", item)] for item in items]
    if numbered:
        return _node("OrderedList", [[1, {"t": "Decimal"}, {"t": "Period"}], blocks])
    return _node("BulletList", blocks)


def _caption(inlines: list[Element]) -> list[Any]:
    return [None, [_node("Plain", inlines)] if inlines else []]


def _width(block: TableBlock, column: int) -> int:
    """Letters that a column needs beside the others: of numbers the longest, of words no more than a few."""
    cells = [_letters(row[column]) for row in block.rows]
    words = max((len(word) for word in re.split(r"\s+", _letters(block.head[column]))), default=0)
    longest = max(map(len, cells), default=0)
    if column < len(block.numbers) and block.numbers[column]:
        return max(longest, words, LEAST)
    whole = max((len(word) for cell in cells for word in re.split(r"\s+", cell)), default=0)
    return max(min(longest, SENTENCE), min(whole, SENTENCE), words, LEAST)


def _letters(marked: str) -> str:
    """A text with a letter for each sign of its mathematics, about."""
    return "".join(
        re.sub(r"[\w.]{3,}|[^\w.]", lambda found: "xx" if len(found[0]) > 2 else "", part.text)
        if part.mathematics
        else part.text
        for part in parts_of(marked)
    )


def _dealt(widths: Sequence[int]) -> list[list[int]]:
    """Columns dealt to as few tables as hold them; each begins with the first column."""
    if not widths:
        return []
    groups, first = [[0]], widths[0] + GAP
    used = first
    for column, width in enumerate(widths[1:], start=1):
        if len(groups[-1]) > 1 and used + width + GAP > ROOM:
            groups.append([0])
            used = first
        groups[-1].append(column)
        used += width + GAP
    return groups
