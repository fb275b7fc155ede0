"""How values are shown: in the units that a description's [display] asks for, with names and symbols as texts.

Inside, everything is SI and radians. Lengths and angles change their unit wherever they stand ("m/s^2" becomes
"mm/s^2", "rad/s" becomes "deg/s"), except that kinematic coefficients stay per radian of the drive: only so
are they the analogs of velocity and acceleration that textbooks print.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from centrode.quantities import display_unit, typeset_unit

if TYPE_CHECKING:
    from centrode.model.mechanism import Display

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


def shown_as(unit: str, display: Display | None) -> tuple[float, str]:
    """Factor and unit in which a quantity of this SI unit is shown."""
    if display is None or unit in ("", "1"):
        return 1.0, unit
    angle = "rad" if "/rad" in unit else str(display.angle)
    return display_unit(unit, str(display.length), angle)


def plain(name: str) -> str:
    """A name as text of a figure, where a dollar sign would start a formula."""
    return name.replace("$", r"\$")


def formula(symbol: str, subscript: str = "") -> str:
    """A symbol of the vocabulary as mathematical text, with a subscript if asked."""
    symbol = symbol.translate(MATHEMATICAL).strip()
    return f"${{{symbol}}}_{{{subscript}}}$" if subscript else f"${symbol}$"


def label_with_unit(text: str, unit: str) -> str:
    """A text with its unit behind it: "v, mm/s²"; a plain number has none."""
    return f"{text}, {typeset_unit(unit)}" if unit not in ("", "1") else text
