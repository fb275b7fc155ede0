"""Texts of figures: names as they are, symbols as mathematical text, labels with their unit."""

from __future__ import annotations

from centrode.quantities import spelled_unit

MATHEMATICAL = str.maketrans(
    {
        "β": r"\beta ",
        "φ": r"\varphi ",
        "θ": r"\theta ",
        "ω": r"\omega ",
        "ε": r"\varepsilon ",
        "′": "'",
        "″": "''",
        "‴": "'''",
        "⁗": "''''",
        "²": "^2",
        "³": "^3",
    }
)


def plain(name: str) -> str:
    """A name as text of a figure, where a dollar sign would start a formula."""
    return name.replace("$", r"\$")


def formula(symbol: str, subscript: str = "") -> str:
    """A symbol of the vocabulary as mathematical text, with a subscript if asked."""
    symbol = symbol.translate(MATHEMATICAL).strip()
    return f"${{{symbol}}}_{{{subscript}}}$" if subscript else f"${symbol}$"


def label_with_unit(text: str, unit: str) -> str:
    """A text with its unit behind it: "v, mm/s²"; a plain number has none."""
    label = spelled_unit(unit)
    return f"{text}, {label}" if label else text


def centre_symbol(pair: tuple[int, int], bodies: int) -> str:
    """The symbol of the instant centre of two of so many bodies, as mathematical text."""
    return f"$P_{{{pair[0]}{',' if bodies > 10 else ''}{pair[1]}}}$"
