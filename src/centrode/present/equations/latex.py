"""The equations of a mechanism as LaTeX: a document of its own, or mathematics in Markdown."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import TYPE_CHECKING, TypeAlias

from centrode.equations.spelling import FormulaSpelling, parts_of
from centrode.equations.symbols import Letter, Wave
from centrode.locale import _
from centrode.present.equations.page import Entry, Note, PageSystem, Relation, Symbols, sections
from centrode.present.equations.text import split_at_signs

if TYPE_CHECKING:
    from centrode.equations.derivation import Equations

LONG = 150
"""Letters of LaTeX in a numerator beyond which it is written behind its fraction, where it can be broken."""
WIDE = 190
"""Letters of LaTeX on one line."""
GREEK = {"phi": "varphi", "epsilon": "varepsilon"} | {
    name: name for name in ("alpha", "beta", "gamma", "theta", "kappa", "rho", "psi", "omega", "Delta")
}
SPECIAL = re.compile(r"([#$%&_{}])|([\\^~])")
HEAD = r"""\documentclass{article}
\usepackage[T1,T2A]{fontenc}
\usepackage[utf8]{inputenc}
\usepackage{amsmath}
\usepackage[margin=2cm]{geometry}
\allowdisplaybreaks
\begin{document}
"""


class LatexSpelling(FormulaSpelling):
    """Formulas in LaTeX (amsmath)."""

    def letter(self, letter: Letter) -> str:
        base, below, dots = parts_of(letter.name)
        symbol = f"\\{GREEK[base]}" if base in GREEK else base
        if dots:
            symbol = f"\\{dots}{{{symbol}}}"
        if not below:
            return symbol
        plain = below.isascii() and below.replace("'", "").isalnum()
        index = below if plain else rf"\text{{{escape(below)}}}"
        return f"{symbol}_{{{index}}}"

    def power(self, base: str, power: int) -> str:
        return base if power == 1 else f"{base}^{{{power}}}"

    def wave(self, one: Wave, power: int) -> str:
        name = self.power(f"\\{one.kind}", power)
        if len(one.parts) == 1 and one.parts[0][1] == 1:
            return f"{name} {self.letter(one.parts[0][0])}"
        return f"{name}({self.angle(one.parts)})"

    def bracket(self, text: str) -> str:
        return rf"\left({text}\right)" if r"\frac" in text else f"({text})"

    def math(self, text: str) -> str:
        return f"${text}$"

    def bars(self, text: str) -> str:
        return rf"\lvert {text} \rvert"

    def initial(self, text: str) -> str:
        return f"{text}(0)"

    def derivative(self, letter: Letter) -> str:
        return self.letter(Letter(letter.rank, f"{letter.name}_dot"))

    def decimal(self, number: float) -> str:
        digits, sign, power = f"{number:.6g}".partition("e")
        return rf"{digits} \cdot 10^{{{int(power)}}}" if sign else digits

    def fraction(self, above: Sequence[str], below: Sequence[str]) -> str:
        top = self.join(above) or "1"
        if len(top) > LONG:
            return rf"\frac{{1}}{{{self.join(below)}}} {top}"
        whole = self.unbracketed(top) if len(above) == 1 else top
        return rf"\frac{{{whole}}}{{{self.join(below)}}}"

    def ratio(self, above: Sequence[str], below: Sequence[str]) -> str:
        return self.fraction(above, below)

    def times(self, front: str, other: str) -> str:
        return rf"{front} \cdot {other}" if r"\frac" in other else f"{front} {other}"

    def unbracketed(self, text: str) -> str:
        """A numerator needs no brackets of its own."""
        if not (text.startswith("(") and text.endswith(")")):
            return text
        depth = 0
        for i, letter in enumerate(text):
            depth += (letter == "(") - (letter == ")")
            if depth == 0 and i < len(text) - 1:
                return text
        return text[1:-1]


def escape(text: str) -> str:
    """Text that LaTeX shows as it is."""
    return SPECIAL.sub(lambda m: f"\\{m[1]}" if m[1] else rf"\char{ord(m[2])}{{}}", text)


def equations_latex(equations: Equations, points: Sequence[str] | None = None) -> str:
    """The equations as a LaTeX document; `points` are those whose velocities are told."""
    chosen = equations.sliding if points is None else points
    parts = [HEAD]
    if equations.mechanism.title:
        parts.append(rf"\section*{{{escape(_(equations.mechanism.title))}}}" + "\n")
    for section in sections(equations, LatexSpelling(), chosen):
        parts.append(rf"\subsection*{{{escape(section.heading)}}}" + "\n")
        parts += [_tex(block) for block in _blocks(section.entries)]
    return "".join(parts) + "\\end{document}\n"


def equations_markdown(equations: Equations, points: Sequence[str] | None = None) -> str:
    """The equations as Markdown with LaTeX between dollar signs."""
    chosen = equations.sliding if points is None else points
    parts = [f"# {_(equations.mechanism.title)}\n"] if equations.mechanism.title else []
    for section in sections(equations, LatexSpelling(), chosen):
        parts.append(f"## {section.heading}\n")
        parts += [_markdown(block) for block in _blocks(section.entries)]
    return "\n".join(parts)


Block: TypeAlias = list[Relation] | PageSystem | Symbols | Note


def _blocks(entries: Sequence[Entry]) -> list[Block]:
    """Entries with relations that follow each other taken together."""
    found: list[Block] = []
    for entry in entries:
        if isinstance(entry, Relation):
            if not (found and isinstance(found[-1], list)):
                found.append([])
            last = found[-1]
            assert isinstance(last, list)
            last.append(entry)
        else:
            found.append(entry)
    return found


def _tex(block: Block) -> str:
    if isinstance(block, list):
        return "\\begin{align*}\n" + _align(block) + "\n\\end{align*}\n"
    if isinstance(block, PageSystem):
        return "\\[\n" + _system(block) + "\n\\]\n"
    if isinstance(block, Symbols):
        rows = [rf"${name}$ & {escape(value)} & {escape(words)} \\" for name, value, words in block.rows]
        return "\\begin{tabular}{lll}\n" + "\n".join(rows) + "\n\\end{tabular}\n"
    return _sentence(block.text) + "\n\n"


def _sentence(text: str) -> str:
    """A sentence for LaTeX; every other part of it, between dollar signs, is mathematics."""
    parts = text.split("$")
    return "$".join(part if i % 2 else escape(part) for i, part in enumerate(parts))


def _markdown(block: Block) -> str:
    if isinstance(block, list):
        return "$$\n\\begin{aligned}\n" + _align(block) + "\n\\end{aligned}\n$$\n"
    if isinstance(block, PageSystem):
        return "$$\n" + _system(block) + "\n$$\n"
    if isinstance(block, Symbols):
        heads = " | ".join((_("symbol"), _("value"), _("meaning")))
        head = f"| {heads} |\n|---|---|---|\n"
        return head + "".join(f"| ${name}$ | {value} | {words} |\n" for name, value, words in block.rows)
    return block.text + "\n"


def _align(relations: Sequence[Relation]) -> str:
    lines = []
    for relation in relations:
        first, *others = relation.parts
        text = f"{first} &= " + (" = ".join(others))
        if len(text) > WIDE and len(others) > 1:
            text = f"{first} &= " + " \\\\\n&= ".join(_broken(part) for part in others)
        elif len(text) > WIDE:
            text = f"{first} &= " + _broken(others[0])
        lines.append(text)
    return " \\\\\n".join(lines)


def _broken(text: str) -> str:
    """A long formula on several lines; what stands in braces stays whole."""
    pieces = [""]
    for word in split_at_signs(text):
        whole = pieces[-1].count("{") == pieces[-1].count("}") and r"\left(" not in pieces[-1]
        if len(pieces[-1]) + len(word) > WIDE and pieces[-1].strip() and whole:
            pieces.append("")
        pieces[-1] += word
    return " \\\\\n&\\quad ".join(piece.strip() for piece in pieces)


def _system(system: PageSystem) -> str:
    rows = " \\\\\n".join(" & ".join(row) for row in system.matrix)
    matrix = f"\\begin{{pmatrix}}\n{rows}\n\\end{{pmatrix}}"
    return f"{matrix}\n{_column(system.unknowns)}\n=\n{_column(system.right)}"


def _column(entries: Sequence[str]) -> str:
    rows = r" \\ ".join(entries)
    return rf"\begin{{pmatrix}} {rows} \end{{pmatrix}}"
