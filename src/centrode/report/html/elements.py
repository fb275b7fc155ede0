"""The blocks of a report as elements of a page."""

from __future__ import annotations

import html
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import zip_longest

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
    Span,
    SystemBlock,
    TableBlock,
)
from centrode.report.html.drawings import Drawings
from centrode.report.html.mathematics import Formulas
from centrode.report.html.stage import stage_of
from centrode.report.mathematics import check_formula, fragments_of
from centrode.report.spoken_formulas import spoken_picture
from centrode.report.texts import parts_of, texts_of

BREAK = "<wbr>"
LONG = 60
"""Characters of a left side from which on it is not aligned but runs on with its line."""


LONG_TEXT, LONGEST_TEXT = 11, 60
"""Letters of a table's text from which on its column is not narrower than some words."""


def formulas_in(block: Block) -> Iterator[str]:
    """The mathematics of a block, as it is spelled; ValueError, which is a fault, for what is none."""
    if isinstance(block, FormulaBlock):
        for line in block.lines:
            yield from line[:1]
            for part in line:
                yield from fragments_of(part)
    elif isinstance(block, SystemBlock):
        for row in (*block.matrix, block.unknowns, block.right):
            yield from map(check_formula, row)
    else:
        for text in texts_of(block):
            yield from (check_formula(part.text) for part in parts_of(text) if part.mathematics)


@dataclass
class Elements:
    """Makes the elements of a page; `separator` stands between the number of a caption and its words."""

    formulas: Formulas
    drawings: Drawings = field(default_factory=Drawings)
    separator: str = ". "

    def text(self, marked: str) -> str:
        """A text with its mathematics."""
        return "".join(
            self.formulas.inline(part.text) if part.mathematics else html.escape(part.text)
            for part in parts_of(marked)
        )

    def element(self, block: Block) -> str:
        """A block."""
        if isinstance(block, ParagraphBlock):
            return f"<p>{self.text(block.text)}</p>"
        if isinstance(block, ProseBlock):
            return _prose(block)
        if isinstance(block, ItemsBlock):
            kind = "ol" if block.numbered else "ul"
            return f"<{kind}>{''.join(f'<li>{self.text(one)}</li>' for one in block.texts)}</{kind}>"
        if isinstance(block, FormulaBlock):
            return self.formula(block)
        if isinstance(block, SystemBlock):
            system = self.formulas.system(block.matrix, block.unknowns, block.right)
            return numbered_formula(f'<div class="one system">{system}</div>', block.number)
        if isinstance(block, ReferenceBlock):
            return f"<p>{''.join(map(_piece, block.pieces))}</p>"
        if isinstance(block, TableBlock):
            return self.table(block)
        if isinstance(block, CheckBlock):
            return self.check(block)
        if isinstance(block, Moving):
            return self.moving(block)
        return self.picture(block)

    def formula(self, block: FormulaBlock) -> str:
        """Lines of a = b = ..., aligned at their first relation unless a left side is too long for that."""
        lines = [line for line in block.lines if line]
        aligned = all(len(line) > 1 and _length(line[0]) <= LONG for line in lines)
        drawn = []
        for line in lines:
            right = BREAK.join(
                piece for part in line[1:] for piece in self.formulas.pieces(part, relation="=")
            )
            if aligned:
                left = self.formulas.display_formula(line[0])
                drawn.append(f'<div class="left">{left}</div><div class="right">{right}</div>')
            else:
                drawn.append(f"<p>{BREAK.join(self.formulas.pieces(line[0]))}{BREAK}{right}</p>")
        kind = "aligned" if aligned else "running"
        return numbered_formula(f'<div class="{kind}">{"".join(drawn)}</div>', block.number)

    def table(self, block: TableBlock) -> str:
        """Rows under heads, with a number if it has a caption."""
        flush = [number for number, _name in zip_longest(block.numbers, block.head, fillvalue=False)]
        kinds = [' class="n"' if number is True else "" for number in flush]
        head = "".join(
            f'<th scope="col"{_head_class(texts, is_number=number is True)}>{self.text(texts[0])}</th>'
            for number, texts in zip(flush, zip_longest(block.head, *block.rows, fillvalue=""), strict=False)
        )
        rows = "".join(
            "<tr>"
            + "".join(f"<td{kind}>{self.text(cell)}</td>" for cell, kind in _cells(row, kinds))
            + "</tr>"
            for row in block.rows
        )
        caption, name = "", ""
        if block.caption:
            number = html.escape(_("Table {number}").format(number=block.number))
            name = f' aria-labelledby="t{block.number}"'
            opening = self._caption_opening(number)
            caption = f'<p class="caption" id="t{block.number}">{opening}{self.text(block.caption)}</p>'
        first = [row[0] for row in (block.head, *block.rows) if row]
        short = ' class="short"' if max(map(_letters, first), default=0) <= LONG_TEXT else ""
        drawn = f"<table{name}{short}><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table>"
        return f'{caption}<div class="table">{drawn}</div>'

    def check(self, block: CheckBlock) -> str:
        """How something was verified."""
        mark, word = ("\u2713", _("Checked")) if block.holds else ("\u2717", _("Does not hold"))
        kind = "check" if block.holds else "check fails"
        return f'<p class="{kind}"><b>{mark} {html.escape(word)}.</b> {self.text(block.text)}</p>'

    def picture(self, block: Picture) -> str:
        """A figure with its caption."""
        paper = f'<div class="paper" style="--size:{block.width:.4g}in">{self.drawing(block)}</div>'
        return f"<figure>{paper}{self.caption(block)}</figure>"

    def moving(self, block: Moving) -> str:
        """A motion: its first picture, until the script of the page draws it."""
        return f"<figure>{stage_of(block, self.drawing(block.still))}{self.caption(block)}</figure>"

    def drawing(self, block: Picture) -> str:
        """A figure alone."""
        return self.drawings.embedded_figure(block.svg, spoken_picture(block))

    def caption(self, block: Picture | Moving) -> str:
        """The number of a figure, and what it shows; nothing where nothing is said."""
        if not block.caption:
            return ""
        number = html.escape(_("Figure {number}").format(number=block.number))
        return f"<figcaption>{self._caption_opening(number)}{self.text(block.caption)}</figcaption>"

    def _caption_opening(self, word: str) -> str:
        """What a caption begins with: "Figure 3. ", in bold letters unless a standard has a dash."""
        return f"<b>{word}.</b> " if self.separator == ". " else f"{word}{self.separator}"


def numbered_formula(formula: str, number: int) -> str:
    """A formula on lines of its own, with its number, which can be referred to."""
    shown = f'<span class="number" id="formula-{number}">({number})</span>'
    return f'<div class="formulas">{formula}{shown}</div>'


def _piece(piece: str | int) -> str:
    """Of a sentence: text, or the number of a formula, which leads to it."""
    return f'<a href="#formula-{piece}">({piece})</a>' if isinstance(piece, int) else html.escape(piece)


def _prose(block: ProseBlock) -> str:
    """What a user wrote about a chapter."""
    paragraphs = ["".join(map(_span, one)) for one in block.paragraphs]
    if block.kind == "paragraph":
        return "".join(f"<p>{one}</p>" for one in paragraphs)
    kind = "ol" if block.kind == "numbers" else "ul"
    return f"<{kind}>{''.join(f'<li>{one}</li>' for one in paragraphs)}</{kind}>"


def _span(span: Span) -> str:
    text = html.escape(span.text)
    for tag, wanted in (("code", span.code), ("em", span.emphasized), ("strong", span.strong)):
        text = f"<{tag}>{text}</{tag}>" if wanted else text
    return text


def _cells(row: Iterable[str], kinds: list[str]) -> Iterator[tuple[str, str]]:
    yield from zip_longest(row, kinds, fillvalue="")


def _head_class(texts: Sequence[str], *, is_number: bool) -> str:
    """The class of a head by its column's texts, the head's first: a long text keeps a few words in a line.

    Where a browser has no room it would break every text at every blank.
    """
    longest = max(map(_letters, texts[:1] if is_number else texts))
    kinds = ["n"] if is_number else []
    kinds += ["longest"] if longest > LONGEST_TEXT else ["long"] if longest > LONG_TEXT else []
    return f' class="{" ".join(kinds)}"' if kinds else ""


def _letters(marked: str) -> int:
    """How many letters a text has, about: a formula counts as a symbol with an index."""
    return sum(2 if part.mathematics else len(part.text) for part in parts_of(marked))


def _length(spelled: str) -> int:
    """How long a formula is, about: its letters, without the names of signs and quotation marks."""
    return sum(len(word) if '"' in word else min(len(word), 3) for word in spelled.split())
