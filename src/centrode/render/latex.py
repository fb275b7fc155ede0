"""Mathematics in LaTeX (amsmath): letters and formulas, aligned relations, matrices, text that is shown as it is."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

from centrode.equations.spelling import FormulaSpelling, parts_of
from centrode.equations.symbols import Letter, Wave
from centrode.render.plain_formulas import distinct, split_at_signs

LONG = 150
"""Letters of LaTeX in a numerator beyond which it is written behind its fraction, where it can be broken."""
WIDE = 190
"""Letters of LaTeX on one line."""
GREEK = {"phi": "varphi", "epsilon": "varepsilon"} | {
    name: name
    for name in (
        "alpha",
        "beta",
        "gamma",
        "delta",
        "theta",
        "kappa",
        "rho",
        "psi",
        "omega",
        "Delta",
        "pi",
        "pi/2",
    )
}
SPECIAL = re.compile(r"([#$%&_{}])|([\\^~])")


def escape(text: str) -> str:
    """Text that LaTeX shows as it is."""
    return SPECIAL.sub(lambda m: f"\\{m[1]}" if m[1] else rf"\char{ord(m[2])}{{}}", text)


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

    def root(self, text: str) -> str:
        return rf"\sqrt{{{text}}}"

    def function(self, name: str, text: str) -> str:
        return f"\\{name}{self.bracket(text)}"

    def function_of(self, name: str, letter: Letter) -> str:
        return f"\\{name} {self.letter(letter)}"

    def direction(self, y: str, x: str) -> str:
        return rf"\operatorname{{atan2}}{self.bracket(f'{y}, {x}')}"

    def product(self, factors: Sequence[str]) -> str:
        return r" \cdot ".join(factors)

    def minor(self, rows: Sequence[Sequence[str]]) -> str:
        inside = r" \\ ".join(" & ".join(row) for row in rows)
        return rf"\begin{{vmatrix}} {inside} \end{{vmatrix}}"

    def derivative(self, letter: Letter) -> str:
        return self.letter(Letter(letter.rank, f"{letter.name}_dot"))

    def decimal(self, number: float) -> str:
        digits, sign, power = f"{number:.6g}".partition("e")
        return rf"{digits} \cdot 10^{{{int(power)}}}" if sign else digits

    def fraction(self, above: Sequence[str], below: Sequence[str]) -> str:
        top = self.join(above) or "1"
        if len(top) > LONG:
            return rf"\frac{{1}}{{{self.without_brackets(self.join(below))}}} {top}"
        whole = self.without_brackets(top) if len(above) == 1 else top
        bottom = self.join(below)
        return rf"\frac{{{whole}}}{{{self.without_brackets(bottom) if len(below) == 1 else bottom}}}"

    def ratio(self, above: Sequence[str], below: Sequence[str]) -> str:
        return self.fraction(above, below)

    def times(self, front: str, other: str) -> str:
        return rf"{front} \cdot {other}" if r"\frac" in other else f"{front} {other}"

    def without_brackets(self, text: str) -> str:
        """A numerator needs no brackets of its own."""
        if not (text.startswith("(") and text.endswith(")")):
            return text
        depth = 0
        for i, letter in enumerate(text):
            depth += (letter == "(") - (letter == ")")
            if depth == 0 and i < len(text) - 1:
                return text
        return text[1:-1]


def aligned_relations(lines: Iterable[Iterable[str]]) -> str:
    """Relations below each other, aligned at their first sign of equality; long ones are broken."""
    return " \\\\\n".join(map(_relation, lines))


def _relation(parts: Iterable[str]) -> str:
    first, *others = distinct(parts)
    text = f"{first} &= " + (" = ".join(others))
    if len(text) > WIDE and len(others) > 1:
        return f"{first} &= " + " \\\\\n&= ".join(_broken(part) for part in others)
    return f"{first} &= " + _broken(others[0]) if len(text) > WIDE else text


def _broken(text: str) -> str:
    """A long formula on several lines; what stands in braces stays whole."""
    pieces = [""]
    for word in split_at_signs(text):
        whole = pieces[-1].count("{") == pieces[-1].count("}") and r"\left(" not in pieces[-1]
        whole &= pieces[-1].count(r"\begin{") == pieces[-1].count(r"\end{")
        if len(pieces[-1]) + len(word) > WIDE and pieces[-1].strip() and whole:
            pieces.append("")
        pieces[-1] += word
    return " \\\\\n&\\quad ".join(piece.strip() for piece in pieces)


def linear_system(matrix: Sequence[Sequence[str]], unknowns: Sequence[str], right: Sequence[str]) -> str:
    """A linear system with matrices in brackets."""
    rows = " \\\\\n".join(" & ".join(row) for row in matrix)
    return f"\\begin{{pmatrix}}\n{rows}\n\\end{{pmatrix}}\n{_column(unknowns)}\n=\n{_column(right)}"


def _column(entries: Sequence[str]) -> str:
    rows = r" \\ ".join(entries)
    return rf"\begin{{pmatrix}} {rows} \end{{pmatrix}}"
