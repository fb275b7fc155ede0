"""The notation of constructions on paper as mathematics of documents: v_B = v_A + v_BA (⊥ BA)."""

from __future__ import annotations

import re

from centrode.locale import _
from centrode.render.document.typst import decimal, in_degrees, quote, word

GREEK = {"φ": "phi", "ω": "omega", "ε": "epsilon", "μ": "mu"}
MARKS = {"ⁿ": "n", "ᵗ": "t", "ᵏ": "k", "ʳ": "r"}
SIGNS = {
    "⊥": "perp", "∥": "parallel", "−": "-", "·": "dot.op", ":": ":", "+": "+", "-": "-", "=": "=", "(": "(", ")": ")",
    "/": "slash", "|": "|", ",": ",", "△": "triangle", "∼": "tilde.op",
}  # fmt: skip
TOKEN = re.compile(
    r"(?P<letter>[vaωεμP])(?P<mark>[ⁿᵗᵏʳ]?)_(?P<name>\w[\w′’'-]*)"
    r"|(?P<number>\d+(?:\.\d+)?(?:e[+-]?\d+)?)(?P<degree>°?)(?!\w)"
    r"|(?P<sine>\bsin\b)"
    r"|\bguide (?P<guide>[^()]+)"
    r"|(?P<word>\w[\w′’'-]*)"
    r"|(?P<sign>\S)"
    r"|(?P<space>\s+)"
)
SUM = re.compile(r"[+−]")
BARS = re.compile(r"\|([^|]+)\|")


def symbol(letter: str, name: str, mark: str = "", vector: bool = False) -> str:
    """A velocity, an acceleration or a rate with what it belongs to below, as mathematics."""
    base = GREEK.get(letter, letter)
    base = f"arrow({base})" if vector else base
    below = f"_({word(name)})" if name else ""
    return f"{base}{below}^({mark})" if mark else f"{base}{below}"


def vector_mathematics(text: str) -> str:
    """A relation, or one side of it; what stands alone between bars is a scalar, a sum is one of vectors."""
    vectors = "|" not in text
    pieces = []
    position = 0
    for found in BARS.finditer(text):
        pieces.append(_tokens(text[position : found.start()], vectors))
        pieces.append(f"abs({_tokens(found[1], vectors=bool(SUM.search(found[1])))})")
        position = found.end()
    return " ".join(piece for piece in [*pieces, _tokens(text[position:], vectors)] if piece)


def _tokens(text: str, vectors: bool) -> str:
    return " ".join(_token(found, vectors) for found in TOKEN.finditer(text) if not found["space"])


def _token(found: re.Match[str], vectors: bool) -> str:
    if found["letter"]:
        vector = vectors and found["letter"] in "va"
        return symbol(found["letter"], found["name"], MARKS.get(found["mark"], ""), vector)
    if found["number"]:
        number = decimal(found["number"])
        return in_degrees(number) if found["degree"] else number
    if found["sine"]:
        return "sin"
    if found["guide"]:
        # in the case that the word has behind the sign, which is mathematics of its own
        return quote(_("∥ guide {guide}").format(guide=found["guide"]).removeprefix("∥ "))
    if found["word"]:
        return word(found["word"])
    return SIGNS.get(found["sign"], quote(found["sign"]))
