"""Formulas of reports in words, for readers who hear a document: the alternative text of its formulas and figures.

Letters stay letters, which screen readers name in their own language; operations, fractions and indices are words.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

from centrode.locale import _, mark
from centrode.render.document.blocks import FormulaBlock, Picture, SystemBlock
from centrode.report.mathematics import check_formula, relations_of
from centrode.report.texts import parts_of

LONGEST = 12_000
"""Letters of a description: PDF/A allows 32 767 bytes, and a letter may take two."""

_TOKEN = re.compile(
    r'"(?:[^"\\]|\\.)*"|\d+(?:\.\d+)?|[^\W\d_](?:[^\W\d_]|\.(?=[^\W\d_]))*|\\.|[^\s]', re.DOTALL
)
_ESCAPE = re.compile(r"\\u\{([0-9a-fA-F]+)\}|\\(.)")

_GREEK: Mapping[str, str] = {
    "alpha": "α", "beta": "β", "gamma": "γ", "delta": "δ", "epsilon": "ε", "zeta": "ζ", "eta": "η", "theta": "θ",
    "iota": "ι", "kappa": "κ", "lambda": "λ", "mu": "μ", "nu": "ν", "xi": "ξ", "pi": "π", "rho": "ρ", "sigma": "σ",
    "tau": "τ", "phi": "φ", "chi": "χ", "psi": "ψ", "omega": "ω", "Gamma": "Γ", "Delta": "Δ", "Theta": "Θ",
    "Lambda": "Λ", "Xi": "Ξ", "Pi": "Π", "Sigma": "Σ", "Phi": "Φ", "Psi": "Ψ", "Omega": "Ω",
}  # fmt: skip
_OPEN, _CLOSE, _EQUALS = mark("open bracket"), mark("close bracket"), mark("equals")
_WORDS: Mapping[str, str] = {
    "+": mark("plus"), "-": mark("minus"), "−": mark("minus"), "±": mark("plus or minus"),
    "dot.op": mark("times"), "times": mark("cross"), "*": mark("times"), "/": mark("divided by"),
    "slash": mark("divided by"), ":": mark("to"), "=": _EQUALS, "<": mark("is less than"),
    ">": mark("is greater than"), "lt": mark("is less than"), "gt": mark("is greater than"),
    "lt.eq": mark("is at most"), "gt.eq": mark("is at least"), "approx": mark("is about"),
    "perp": mark("perpendicular to"), "parallel": mark("parallel to"), "triangle": mark("triangle"),
    "tilde.op": mark("is similar to"), "(": _OPEN, ")": _CLOSE, "[": _OPEN, "]": _CLOSE, "|": mark("bar"),
    "degree": mark("degrees"),
    "sin": mark("sine"), "cos": mark("cosine"), "tan": mark("tangent"), "arcsin": mark("arc sine"),
    "arccos": mark("arc cosine"), "arctan": mark("arc tangent"), "ln": mark("natural logarithm"),
    "infinity": mark("infinity"), "max": mark("maximum"), "min": mark("minimum"),
}  # fmt: skip
_UNSPOKEN = frozenset(("thin", "quad", "med", "thick", "space"))
_FRAMES: Mapping[str, str] = {
    "arrow": mark("vector {operand}"), "abs": mark("the magnitude of {operand}"),
    "overline": mark("{operand} with a bar"),
    "hat": mark("{operand} with a hat"), "sqrt": mark("the square root of {operand}, end of the root"),
    "op": "{operand}", "bold": "{operand}", "upright": "{operand}", "italic": "{operand}",
}  # fmt: skip
"""How what a function shows is called, its operand put in."""
_DOTS: Mapping[str, str] = {
    "dot": mark("{operand} with a dot"), "dot.double": mark("{operand} with two dots"),
}  # fmt: skip
_SUMS: Mapping[str, tuple[str, str, str]] = {
    "sum": (mark("the sum of"), mark("the sum over {below} of"), mark("the sum from {below} to {above} of")),
    "integral": (
        mark("the integral of"), mark("the integral over {below} of"), mark("the integral from {below} to {above} of"),
    ),
    "integral.cont": (
        mark("the integral over a cycle of"), mark("the integral over {below} of"),
        mark("the integral from {below} to {above} of"),
    ),
}  # fmt: skip
"""What stands before a term, without limits, with the lower one, with both."""
_MARKS = frozenset(("n", "t", "k", "r", "*", "T"))
"""Letters above that name a part of a vector, and are no power."""


def spoken_text(marked: str) -> str:
    """A text whose mathematics, between dollar signs, is put into words."""
    return _shortened_text(
        "".join(spoken_formula(part.text) if part.mathematics else part.text for part in parts_of(marked))
    )


def spoken_picture(picture: Picture) -> str:
    """What a figure shows, in words: its caption, and the curves that it has."""
    return spoken_text(". ".join(part for part in (picture.caption, picture.description) if part)) or _(
        "Figure"
    )


def spoken_formula(formula: str) -> str:
    """A formula in typst's notation, in words of the chosen language.

    Examples
    --------
    >>> spoken_formula("x_(B) = frac(l, 2) cos phi")
    'x sub B equals l over 2 cosine φ'
    """
    return _shortened_text(_SpokenFormulaReader(check_formula(formula)).sentence())


def spoken_relations(block: FormulaBlock) -> list[str]:
    """Each line of a formula in words; all together they are no longer than a description may be."""
    return _spoken_lines(block.lines)


def spoken_system(block: SystemBlock) -> list[str]:
    """The equations of a system in words."""
    return _spoken_lines(relations_of(block))


def _spoken_lines(lines: Sequence[Sequence[str]]) -> list[str]:
    equals = f" {_(_EQUALS)} "
    room = LONGEST // max(len(lines), 1)
    return [_shortened_text(equals.join(map(spoken_formula, line)), room) for line in lines]


def _shortened_text(text: str, room: int = LONGEST) -> str:
    return text if len(text) <= room else f"{text[: room - 1]}…"


class _SpokenFormulaReader:
    """Reads a formula from left to right; what it does not know it reads as it is written."""

    def __init__(self, formula: str) -> None:
        self.tokens = [(found[0], found.start()) for found in _TOKEN.finditer(formula)]
        self.place = 0

    def sentence(self) -> str:
        """All that is left."""
        words = []
        while self.place < len(self.tokens):
            words += self._until("")
            self.place += self.place < len(self.tokens)  # a bracket without a partner
        return _joined_words(words)

    def _next(self) -> str:
        return self.tokens[self.place][0] if self.place < len(self.tokens) else ""

    def _take(self) -> str:
        token = self._next()
        self.place += 1
        return token

    def _opens(self) -> bool:
        """Whether a bracket follows the last word at once, as the one of a function does."""
        if self._next() != "(":
            return False
        before, start = self.tokens[self.place - 1]
        return start + len(before) == self.tokens[self.place][1]

    def _until(self, end: str) -> list[str]:
        """Words of the terms before a closing bracket or, between operands, a comma."""
        words = []
        while (token := self._next()) and token != ")" and (not end or token != end):
            words.append(self._term())
        return words

    def _term(self) -> str:
        """A letter, a number, a function or a bracket, with what stands below and above it."""
        token = self._take()
        if token in _SUMS:
            return self._sum(token)
        dots = _DOTS.get(token, "") if self._opens() else ""
        bare = _joined_words(self._bracket()) if dots else self._base(token)
        below, above, primes = self._attachments()
        if below:
            bare = _("{letter} sub {index}").format(letter=bare, index=below)
        bare = _(dots).format(operand=bare) if dots else bare
        bare = " ".join([bare, *[_("prime")] * primes])
        if not above:
            return bare
        if above in _MARKS or (above.isalpha() and token == "arrow"):
            sign = {"*": _("star")}.get(above, above)
            return _("{letter} with {mark} above").format(letter=bare, mark=sign)
        if above in ("2", "3"):
            return (_("{base} squared") if above == "2" else _("{base} cubed")).format(base=bare)
        return _("{base} to the power {power}").format(base=bare, power=above)

    def _base(self, token: str) -> str:
        if token == "frac" and self._opens():
            return self._fraction()
        if token == "mat" and self._opens():
            return self._determinant()
        if token in _FRAMES and self._opens():
            operand = _joined_words(self._bracket())
            frame = _FRAMES[token]
            return (frame if frame == "{operand}" else _(frame)).format(operand=operand)
        if token == "(":
            self.place -= 1
            return _joined_words([_(_OPEN), *self._bracket(), _(_CLOSE)])
        if token.startswith('"'):
            return _ESCAPE.sub(lambda one: chr(int(one[1], 16)) if one[1] else one[2], token[1:-1])
        if token.startswith("\\"):
            token = token[1:]
        if token in _UNSPOKEN:
            return ""
        return _(_WORDS[token]) if token in _WORDS else _GREEK.get(token, token)

    def _bracket(self) -> list[str]:
        """Words within the bracket that opens here."""
        self._take()
        words = self._until(")")
        self._take()
        return words

    def _fraction(self) -> str:
        self._take()
        parts: list[list[str]] = [[]]
        while (token := self._next()) and token != ")":
            if token == ",":
                self._take()
                parts.append([])
            else:
                parts[-1].append(self._term())
        self._take()
        above, below = parts[0], parts[-1]
        simple = all(len(part) == 1 and " " not in part[0] for part in (above, below))
        frame = (
            _("{above} over {below}") if simple else _("fraction: {above}, over {below}, end of the fraction")
        )
        return frame.format(above=_joined_words(above), below=_joined_words(below))

    def _determinant(self) -> str:
        """A matrix between bars, entry by entry, its rows parted."""
        for _delimiter in ("(", "delim", ":", '"|"', ","):
            self._take()
        rows: list[list[list[str]]] = [[[]]]
        while (token := self._next()) and token != ")":
            if token == ",":
                self._take()
                rows[-1].append([])
            elif token == ";":
                self._take()
                rows.append([[]])
            else:
                rows[-1][-1].append(self._term())
        self._take()
        spoken = "; ".join(", ".join(map(_joined_words, row)) for row in rows)
        return _("determinant with the rows {rows}, end of the determinant").format(rows=spoken)

    def _sum(self, token: str) -> str:
        below, above, _primes = self._attachments()
        alone, with_lower, with_both = _SUMS[token]
        return _(with_both if below and above else with_lower if below else alone).format(
            below=below, above=above
        )

    def _attachments(self) -> tuple[str, str, int]:
        """What stands below and above, and the number of primes."""
        below, above, primes = "", "", 0
        while (token := self._next()) in ("_", "^", "'"):
            self._take()
            if token == "'":
                primes += 1
            elif token == "_":
                below = self._operand()
            else:
                above = self._operand()
        return below, above, primes

    def _operand(self) -> str:
        """A bracket, which is not spoken, or one letter, number or function."""
        if self._next() == "(":
            return _joined_words(self._bracket())
        token = self._take()
        return "*" if token == "*" else self._base(token)


def _joined_words(words: Sequence[str]) -> str:
    text = " ".join(word for word in words if word)
    return re.sub(r" (?=[,;.])", "", text)
