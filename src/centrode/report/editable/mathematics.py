"""Mathematics of reports as LaTeX: pandoc reads typst's notation, all formulas of a report in one run."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from centrode.render.document.blocks import FormulaBlock, SystemBlock
from centrode.render.latex import linear_system
from centrode.report.editable.pandoc import run_pandoc
from centrode.report.mathematics import check_formula, fragments_of, relations_of

WIDE = 84
"""Signs of a formula that a line holds."""
WIDE_SYSTEM = 95
"""Signs of the widest row of a system that a line holds; wider ones are written equation by equation."""
INDENT = 4
"""Signs by which a line that goes on is set in."""

_STRING = re.compile(r'"((?:[^"\\]|\\.)*)"')
_ESCAPE = re.compile(r"\\u\{([0-9a-fA-F]+)\}|\\(.)")
_DECIMAL = re.compile(r"(\d+),(\d+)(°?)")
_PLACE = re.compile(
    r"\\(mathit|mathrm)\{\\text\{(zq[a-z]+)\}\}|\\text\{ ?(zq[a-z]+) ?\}|\\operatorname\{(zq[a-z]+)\}"
)
_MENDED = (
    (re.compile(r"\{\\overset\{\\rightarrow\}\{(\w|\\\w+)\}\}"), r"\\vec{\1}"),
    (re.compile(r"\{\^\\circ\}"), r"^{\\circ}"),
)
_SPECIAL = {
    "\\": r"\textbackslash{}", "^": r"\textasciicircum{}", "~": r"\textasciitilde{}",
    **{letter: f"\\{letter}" for letter in "#$%&_{}"},
}  # fmt: skip
_COMMAND = re.compile(r"\\(?:left|right|mathit|mathrm|text|vec|frac|begin|end|quad|,|\s)|[{}_^&]")
_NAMED = re.compile(r"\\[A-Za-z]+")
_FRACTION = re.compile(r"\\frac\{([^{}]*(?:\{[^{}]*\}[^{}]*)*)\}\{([^{}]*(?:\{[^{}]*\}[^{}]*)*)\}")


@dataclass(frozen=True)
class LatexFormulas:
    """Formulas of a report in LaTeX (amsmath), by their spelling in typst's notation."""

    found: Mapping[str, str]

    def inline(self, spelled: str) -> str:
        """A formula in a sentence."""
        return self.found[spelled]

    def relations(self, block: FormulaBlock) -> str:
        """Relations below each other, aligned at their first sign of equality; long ones are broken."""
        rows = [row for line in block.lines if line for row in self._rows(line)]
        return "\\begin{aligned}\n" + " \\\\\n".join(rows) + "\n\\end{aligned}"

    def system(self, block: SystemBlock) -> str:
        """A matrix times its unknowns = the right sides; equation by equation where no page is wide enough."""
        matrix = [[self.found[entry] for entry in row] for row in block.matrix]
        unknowns, right = ([self.found[one] for one in side] for side in (block.unknowns, block.right))
        columns = zip(*matrix, strict=True)
        width = sum(max(map(visible_length, column)) + 2 for column in columns)
        if width + max(map(visible_length, right), default=0) > WIDE_SYSTEM:
            return self.relations(FormulaBlock(tuple(relations_of(block))))
        return linear_system(matrix, unknowns, right)

    def _rows(self, line: Sequence[str]) -> list[str]:
        """A relation a = b = ... as rows of which each has its place of alignment."""
        left, *parts = line
        start = self.found[left]
        if not parts:
            return [f"{start} &"]
        rest = [self._pieces(part) for part in parts]
        if visible_length(start) > WIDE / 2:  # too long to be aligned: it runs on with its line
            pieces = self._pieces(left)
            for part in rest:
                pieces += [f"= {part[0]}", *part[1:]]
            first, *others = pack_rows(pieces, WIDE)
            return [f"& {first}", *(f"& \\quad {row}" for row in others)]
        whole = " = ".join("".join(part) for part in rest)
        if visible_length(start) + visible_length(whole) <= WIDE:
            return [f"{start} &= {whole}"]
        rows = []
        for number, part in enumerate(rest):
            first, *others = pack_rows(part, WIDE - INDENT - visible_length(start))
            rows += [f"{'' if number else start} &= {first}", *(f"& \\quad {row}" for row in others)]
        return rows

    def _pieces(self, spelled: str) -> list[str]:
        return [self.found[piece] for piece in fragments_of(spelled)]


def pack_rows(pieces: Iterable[str], width: float) -> list[str]:
    """Pieces in rows of at most so many signs."""
    rows: list[str] = []
    for piece in pieces:
        if rows and visible_length(rows[-1]) + visible_length(piece) <= width:
            rows[-1] = f"{rows[-1]} {piece}"
        else:
            rows.append(piece)
    return rows


def visible_length(latex: str) -> int:
    """How many signs of a formula stand beside each other, about."""
    text = _FRACTION.sub(lambda found: max(found.groups(), key=visible_length), latex)
    return len(re.sub(r"\s+", "", _NAMED.sub("xx", _COMMAND.sub("", text))))


def spellings_of(block: FormulaBlock | SystemBlock) -> list[str]:
    """All formulas of a block that its LaTeX is made from."""
    if isinstance(block, SystemBlock):
        lines: Iterable[Sequence[str]] = relations_of(block)
        entries = [entry for row in (*block.matrix, block.unknowns, block.right) for entry in row]
    else:
        lines, entries = block.lines, []
    for line in lines:
        for part in line:
            entries += [part, *fragments_of(part)]
    return entries


def latex_formulas(spelled: Iterable[str]) -> LatexFormulas:
    """Formulas in typst's notation as LaTeX, each of them once; ValueError for what is no formula."""
    wanted = list(dict.fromkeys(spelled))
    if not wanted:
        return LatexFormulas({})
    strings: list[str] = []
    source = "\n\n".join(f"${_without_strings(check_formula(one), strings).strip()}$" for one in wanted)
    tree = json.loads(run_pandoc(source.encode(), "--from=typst", "--to=json"))
    blocks = [block["c"] for block in tree["blocks"]]
    if len(blocks) != len(wanted):
        raise ValueError(f"{len(wanted)} formulas became {len(blocks)}")
    return LatexFormulas({one: _latex(block, strings) for one, block in zip(wanted, blocks, strict=True)})


def _without_strings(formula: str, strings: list[str]) -> str:
    """A formula with a word in place of each string, which pandoc would read as mathematics; the strings are kept."""

    def place(found: re.Match[str]) -> str:
        strings.append(_ESCAPE.sub(lambda one: chr(int(one[1], 16)) if one[1] else one[2], found[1]))
        return f'"{_word(len(strings) - 1)}"'

    return _STRING.sub(place, formula)


def _word(number: int) -> str:
    return "zq" + "".join(chr(ord("a") + int(digit)) for digit in str(number))


def _number(word: str) -> int:
    return int("".join(str(ord(letter) - ord("a")) for letter in word.removeprefix("zq")))


def _latex(inlines: Sequence[Mapping[str, object]], strings: Sequence[str]) -> str:
    """The mathematics of a paragraph that holds nothing else, its strings put in again."""
    (one,) = inlines
    kind, latex = one["t"], one["c"]
    if kind != "Math" or not isinstance(latex, list):
        raise ValueError(f"no formula: {one}")
    text = str(latex[1])
    for pattern, replacement in _MENDED:
        text = pattern.sub(replacement, text)

    def string(found: re.Match[str]) -> str:
        kind, letters, word, function = found.groups()
        text = strings[_number(letters or word or function)]
        return f"\\operatorname{{{text}}}" if function else _string(text, kind or "")

    return _PLACE.sub(string, text)


def _string(text: str, kind: str) -> str:
    """A string of a formula: a number whose comma is no punctuation, letters of a kind, or text as it is."""
    decimal = _DECIMAL.fullmatch(text)
    if decimal is not None:
        degree = r"^{\circ}" if decimal[3] else ""
        return f"{decimal[1]}{{,}}{decimal[2]}{degree}"
    if kind and text.isascii() and text.isalpha():
        return f"\\{kind}{{{text}}}"
    safe = "".join(_SPECIAL.get(letter, letter) for letter in text).replace("--", "-{-}")
    return f"\\{kind}{{\\text{{{safe}}}}}" if kind else f"\\text{{{safe}}}"
