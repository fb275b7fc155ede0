"""Sheets as pages for other programs: LaTeX documents, and Markdown with LaTeX between dollar signs."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, assert_never

from centrode.locale import _
from centrode.render.latex import LatexSpelling, aligned_relations, escape, linear_system
from centrode.render.spelling import PrintSpelling
from centrode.render.symbolic import spell_symbolic
from centrode.render.terminal import notes_of, sheet_text, symbol_texts, table_cells
from centrode.sheets.players import CamPlayer, MotionPlayer, WheelPlayer
from centrode.sheets.sheet import (
    Block,
    Check,
    FactTable,
    Formula,
    Illustration,
    Items,
    Listing,
    Paragraph,
    Reference,
    Section,
    Sheet,
    SheetEquations,
    SymbolList,
    Table,
)
from centrode.sheets.symbolic import SymbolicLeaf

if TYPE_CHECKING:
    from centrode.model.settings import Display
    from centrode.sheets.sheet import ExplainedSymbol, Fact
    from centrode.sheets.texts import Leaf, Number

HEAD = r"""\documentclass{article}
\usepackage[T1,T2A]{fontenc}
\usepackage[utf8]{inputenc}
\usepackage{amsmath}
\usepackage[margin=2cm]{geometry}
\allowdisplaybreaks
\begin{document}
"""


def page_text(sheet: Sheet, title: str, kind: str, display: Display) -> str:
    """What a terminal prints of a sheet, under its title, as a document.

    Parameters
    ----------
    title : str
        Without a heading if empty.
    kind : "txt", "tex" or "md"
        Plain text, a LaTeX document (amsmath), or Markdown.
    """
    if kind == "txt":
        return "\n\n".join(filter(None, (title, sheet_text(sheet, display)))) + "\n"
    return (LatexPage(display) if kind == "tex" else MarkdownPage(display)).page(sheet, title)


class MarkupPage(PrintSpelling):
    """Sheets in a language of marks; texts in it are spelled as on terminals, units as in books."""

    @abstractmethod
    def page(self, sheet: Sheet, title: str) -> str:
        """A whole document."""

    @abstractmethod
    def heading(self, text: str) -> str:
        """A heading below the title."""

    @abstractmethod
    def table(self, heads: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
        """Rows of texts; without heads where there are none."""

    @abstractmethod
    def items(self, texts: Sequence[str], numbered: bool) -> str:
        """Texts below each other."""

    @abstractmethod
    def paragraph(self, text: str) -> str:
        """Sentences."""

    @abstractmethod
    def relations(self, lines: Sequence[Sequence[str]]) -> str:
        """Relations below each other."""

    @abstractmethod
    def display_mathematics(self, mathematics: str) -> str:
        """Mathematics on lines of its own."""

    def symbolic(self, leaf: SymbolicLeaf) -> str:
        """A formula in letters within a sentence."""
        return f"${self.leaf(leaf)}$"

    def leaf(self, leaf: Leaf) -> str:
        """A part of a relation: formulas without their dollar signs."""
        return spell_symbolic(leaf, LatexSpelling()) if isinstance(leaf, SymbolicLeaf) else super().leaf(leaf)

    def parts(self, sheet: Sheet) -> Iterator[str]:
        """The facts of a sheet, and what is printed below them."""
        if sheet.facts:
            yield self._facts(sheet.facts)
        for block in sheet.printed:
            if isinstance(block, Section):
                yield self.heading(self.text(block.title))
                yield from map(self._block, block.blocks)
            else:
                yield self._block(block)
        yield from map(self.paragraph, notes_of(sheet, self))

    def _facts(self, facts: Sequence[Fact]) -> str:
        return self.table((), [(self.text(fact.label), self.text(fact.value)) for fact in facts])

    def _symbols(self, symbols: Sequence[ExplainedSymbol]) -> list[tuple[str, str, str]]:
        texts = (symbol_texts(symbol, self) for symbol in symbols)
        return [(f"${symbol}$", value, meaning) for symbol, value, meaning in texts]

    def _block(self, block: Block) -> str:
        match block:
            case Paragraph(text):
                return self.paragraph(self.text(text))
            case FactTable(facts):
                return self._facts(facts)
            case Table():
                heads, cells = table_cells(block, self)
                caption = self.text(block.caption)
                return (self.paragraph(caption) if caption else "") + self.table(heads, cells)
            case Items(texts, numbered):
                return self.items([self.text(item) for item in texts], numbered)
            case Listing(heading, texts):
                return self.paragraph(f"{self.text(heading)}: {', '.join(map(self.text, texts))}")
            case Formula(lines):
                return self.relations([list(map(self.leaf, line)) for line in lines])
            case SheetEquations(matrix, unknowns, right):
                entries = [list(map(self.leaf, row)) for row in matrix]
                sides = (list(map(self.leaf, side)) for side in (unknowns, right))
                return self.display_mathematics(linear_system(entries, *sides))
            case SymbolList(symbols):
                return self.table((_("symbol"), _("value"), _("meaning")), self._symbols(symbols))
            case Illustration() | Reference() | Check() | CamPlayer() | WheelPlayer() | MotionPlayer():
                return ""
            case _:
                assert_never(block)


class LatexPage(MarkupPage):
    """Sheets as LaTeX documents."""

    def name(self, text: str) -> str:
        """What a user called something, as LaTeX shows it."""
        return escape(text)

    def number(self, number: Number) -> str:
        """A number with its unit, of which no letter is a command."""
        return escape(super().number(number))

    def page(self, sheet: Sheet, title: str) -> str:
        """A document of its own."""
        heading = [rf"\section*{{{escape(title)}}}" + "\n"] if title else []
        return "".join((HEAD, *heading, *self.parts(sheet), "\\end{document}\n"))

    def heading(self, text: str) -> str:
        """A subsection without a number."""
        return rf"\subsection*{{{text}}}" + "\n"

    def table(self, heads: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
        """Cells flush left, heads over a line."""
        columns = "l" * len(rows[0] if rows else heads)
        lines = [" & ".join(row) + r" \\" for row in rows]
        head = " & ".join(heads) + " \\\\\n\\hline\n" if heads else ""
        return f"\\begin{{tabular}}{{{columns}}}\n{head}" + "\n".join(lines) + "\n\\end{tabular}\n"

    def items(self, texts: Sequence[str], numbered: bool) -> str:
        """A list, with numbers where the order matters."""
        kind = "enumerate" if numbered else "itemize"
        lines = "\n".join(rf"\item {text}" for text in texts)
        return f"\\begin{{{kind}}}\n{lines}\n\\end{{{kind}}}\n"

    def paragraph(self, text: str) -> str:
        """Sentences, with an empty line behind them."""
        return f"{text}\n\n"

    def relations(self, lines: Sequence[Sequence[str]]) -> str:
        """Relations without numbers, aligned."""
        return "\\begin{align*}\n" + aligned_relations(lines) + "\n\\end{align*}\n"

    def display_mathematics(self, mathematics: str) -> str:
        """Mathematics on lines of its own."""
        return f"\\[\n{mathematics}\n\\]\n"


class MarkdownPage(MarkupPage):
    """Sheets as Markdown."""

    def page(self, sheet: Sheet, title: str) -> str:
        """The title and the parts, an empty line between them."""
        heading = [f"# {title}\n"] if title else []
        return "\n".join((*heading, *self.parts(sheet)))

    def heading(self, text: str) -> str:
        """A heading of the second level."""
        return f"## {text}\n"

    def table(self, heads: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
        """A table; Markdown has none without heads."""
        heads = heads or (_("quantity"), _("value"))
        lines = (f"| {' | '.join(row)} |\n" for row in (heads, *rows))
        return next(lines) + "|" + "---|" * len(heads) + "\n" + "".join(lines)

    def items(self, texts: Sequence[str], numbered: bool) -> str:
        """A list, with numbers where the order matters."""
        return "".join(f"{'1.' if numbered else '-'} {text}\n" for text in texts)

    def paragraph(self, text: str) -> str:
        """Sentences on one line."""
        return f"{text}\n"

    def relations(self, lines: Sequence[Sequence[str]]) -> str:
        """Relations, aligned."""
        return self.display_mathematics(f"\\begin{{aligned}}\n{aligned_relations(lines)}\n\\end{{aligned}}")

    def display_mathematics(self, mathematics: str) -> str:
        """Mathematics on lines of its own."""
        return f"$$\n{mathematics}\n$$\n"
