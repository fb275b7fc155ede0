"""Formulas in typst's mathematical notation, which the documents of reports are set from."""

from __future__ import annotations

import re
from collections.abc import Sequence

from centrode.equations.spelling import FormulaSpelling, parts_of
from centrode.equations.symbols import Letter, Wave
from centrode.locale import chosen_language, coordinate_separator, decimal_mark

GREEK = frozenset(
    (
        "alpha",
        "beta",
        "gamma",
        "delta",
        "epsilon",
        "theta",
        "kappa",
        "rho",
        "phi",
        "psi",
        "omega",
        "Delta",
        "pi",
        "pi/2",
    )
)
GAPS = "\u00a0\u202f"
"""Blanks at which no line ends, a wide and a narrow one."""
DOTS = {"dot": "dot", "ddot": "dot.double"}
LONG = 110
"""Letters of typst in a numerator beyond which it is written behind its fraction, where it can be broken."""
_LETTER_WITH_INDEX = re.compile(r"[A-Za-z]_.+")
_LATIN = re.compile(r"[A-Za-z]+")


class TypstSpelling(FormulaSpelling):
    """Formulas in typst's mathematics; numbers with the decimal mark of the reader's language."""

    def letter(self, letter: Letter) -> str:
        base, below, dots = parts_of(letter.name)
        symbol = base if base in GREEK else word(base)
        if dots:
            symbol = f"{DOTS[dots]}({symbol})"
        if not below:
            return symbol
        if _LETTER_WITH_INDEX.fullmatch(below):
            return f"{symbol}_({self.letter(Letter(letter.rank, below))})"
        return f"{symbol}_({word(below)})"

    def power(self, base: str, power: int) -> str:
        return base if power == 1 else f"{base}^({power})"

    def wave(self, one: Wave, power: int) -> str:
        name = self.power(one.kind, power)
        if len(one.parts) == 1 and one.parts[0][1] == 1:
            return f"{name} {self.letter(one.parts[0][0])}"
        return f"{name} ({self.angle(one.parts)})"

    def bracket(self, text: str) -> str:
        return f"({text})"

    def text(self, name: str) -> str:
        return shown(name)

    def math(self, text: str) -> str:
        return f"${text}$"

    def bars(self, text: str) -> str:
        return f"abs({text})"

    def initial(self, text: str) -> str:
        return f"{text} (0)"

    def root(self, text: str) -> str:
        return f"sqrt({text})"

    def function(self, name: str, text: str) -> str:
        return f"{name} {self.bracket(text)}"

    def function_of(self, name: str, letter: Letter) -> str:
        shown = name if name != "tan" or chosen_language() == "en" else 'op("tg")'
        return f"{shown} {self.letter(letter)}"

    def direction(self, y: str, x: str) -> str:
        return f'"atan2" {self.bracket(f"{y}{coordinate_separator()}{x}")}'

    def product(self, factors: Sequence[str]) -> str:
        return " dot.op ".join(factors)

    def minor(self, rows: Sequence[Sequence[str]]) -> str:
        return f'mat(delim: "|", {"; ".join(", ".join(row) for row in rows)})'

    def derivative(self, letter: Letter) -> str:
        return f"frac(d {self.letter(letter)}, d t)"

    def decimal(self, number: float) -> str:
        return decimal(f"{number:.6g}")

    def fraction(self, above: Sequence[str], below: Sequence[str]) -> str:
        top = self.join(above) or "1"
        if len(top) > LONG:
            return f"frac(1, {strip_brackets(self.join(below))}) {top}"
        whole = strip_brackets(top) if len(above) == 1 else top
        return f"frac({whole}, {strip_brackets(self.join(below))})"

    def ratio(self, above: Sequence[str], below: Sequence[str]) -> str:
        return self.fraction(above, below)

    def times(self, front: str, other: str) -> str:
        return f"{front} dot.op {other}" if "frac(" in other else f"{front} {other}"


def shown(text: str) -> str:
    """Text of a user's own between mathematics told by dollar signs, so that nothing in it is taken for mathematics."""
    return text.replace("\\", "\\\\").replace("$", r"\$")


def quote(text: str) -> str:
    """Text that typst shows as it is, wherever a string may stand."""
    safe = "".join(letter if letter.isprintable() or letter in GAPS else " " for letter in text)
    for letter, code in (("\\", "\\\\"), ('"', '\\"'), ("$", r"\u{24}")):  # mathematics ends at a dollar sign
        safe = safe.replace(letter, code)
    return f'"{safe}"'


def word(text: str) -> str:
    """A letter, a number or a name in mathematics: Latin letters slanted, what else there is upright."""
    if len(text) == 1 and text.isascii() and text.isalpha():
        return text
    if text.isascii() and text.isdecimal():
        return text
    return f"italic({quote(text)})" if _LATIN.fullmatch(text) else quote(text)


def decimal(text: str) -> str:
    """A number as Python prints it ("-1.5e-07"), with the decimal mark of the reader's language."""
    digits, sign, power = text.partition("e")
    minus = "-" if digits.startswith("-") else ""
    digits = digits.removeprefix("-")
    mark = decimal_mark()
    if mark != "." and "." in digits:
        digits = quote(digits.replace(".", mark))  # typst would set a bare comma as punctuation
    return f"{minus}{digits} dot.op 10^({int(power)})" if sign else f"{minus}{digits}"


def in_degrees(number: str) -> str:
    """A number as mathematics with the sign of degrees close behind it."""
    return f'{number[:-1]}°"' if number.endswith('"') else f"{number} degree"


def with_degrees(formula: str) -> str:
    """A formula whose quoted numbers have the sign of degrees close behind them: typst sets blanks around a string."""
    return formula.replace('" degree', '°"')


def strip_brackets(text: str) -> str:
    """What a fraction holds needs no brackets of its own."""
    if not (text.startswith("(") and text.endswith(")")):
        return text
    depth, inside = 0, False
    for i, letter in enumerate(text):
        inside ^= letter == '"' and text[i - 1 : i] != "\\"
        depth += 0 if inside else (letter == "(") - (letter == ")")
        if depth == 0 and i < len(text) - 1:
            return text
    return text[1:-1]
