"""What an author writes about chapters: Markdown as sections of a report, of which nothing but the text is taken."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Literal

from markdown_it import MarkdownIt
from markdown_it.token import Token

from centrode.render.document.blocks import Block, ProseBlock, SectionBlocks, Span, TableBlock, shown


def prose_sections(markdown: str, place: Literal["before", "after"]) -> tuple[SectionBlocks, ...]:
    """A text in Markdown (CommonMark with tables) as sections; headings of any level begin a section.

    Tags, formulas and pictures are not read: they stand there as they are written, a picture by its words.
    """
    reader = MarkdownIt("commonmark", {"html": False}).enable("table")
    found = _Sections()
    for token in reader.parse(markdown):
        found.take(token)
    return tuple(
        SectionBlocks(title, tuple(blocks), place) for title, blocks in found.sections if title or blocks
    )


@dataclass
class _Sections:
    """Sections as they are found.

    Attributes
    ----------
    sections : titles and blocks
    lists : kinds of the lists that are open, the outermost first
    items : of the outermost list
    rows : of the table that is open
    """

    sections: list[tuple[str, list[Block]]] = field(default_factory=lambda: [("", [])])
    lists: list[Literal["bullets", "numbers"]] = field(default_factory=list)
    items: list[tuple[Span, ...]] = field(default_factory=list)
    rows: list[list[str]] = field(default_factory=list)
    around: str = ""

    def take(self, token: Token) -> None:
        """The next token."""
        match token.type:
            case "bullet_list_open":
                self.lists.append("bullets")
            case "ordered_list_open":
                self.lists.append("numbers")
            case "bullet_list_close" | "ordered_list_close":
                kind = self.lists.pop()
                if not self.lists:
                    self._add(ProseBlock(tuple(self.items), kind))
                    self.items = []
            case "heading_open" | "th_open" | "td_open":
                self.around = token.type.removesuffix("_open")
            case "heading_close" | "th_close" | "td_close":
                self.around = ""
            case "tr_open":
                self.rows.append([])
            case "table_close":
                head, *rows = self.rows
                self._add(TableBlock(tuple(head), tuple(map(tuple, rows))))
                self.rows = []
            case "fence" | "code_block":
                for line in token.content.splitlines():
                    self._paragraph((Span(line, code=True),))
            case "inline":
                self._text(tuple(_spans(token.children or ())))

    def _text(self, spans: tuple[Span, ...]) -> None:
        plain = "".join(span.text for span in spans)
        if self.around == "heading":
            self.sections.append((plain, []))
        elif self.around:
            self.rows[-1].append(shown(plain))
        else:
            self._paragraph(spans)

    def _paragraph(self, spans: tuple[Span, ...]) -> None:
        if self.lists:
            self.items.append(spans)
        else:
            self._add(ProseBlock((spans,)))

    def _add(self, block: Block) -> None:
        self.sections[-1][1].append(block)


def _spans(tokens: Sequence[Token]) -> Iterator[Span]:
    """The stretches of a paragraph; behind a link stands where it leads."""
    strong = emphasized = 0
    address = ""
    for token in tokens:
        strong += token.nesting if token.type.startswith("strong_") else 0
        emphasized += token.nesting if token.type.startswith("em_") else 0
        text = token.content
        if token.type in ("softbreak", "hardbreak"):
            text = " "
        elif token.type == "link_open":
            address = str(token.attrGet("href") or "")
        elif token.type == "link_close":
            text = f" ({address})"
        if text:
            yield Span(text, bool(strong), bool(emphasized), token.type == "code_inline")
