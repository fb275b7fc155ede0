"""Numbers as a report spells them: sensible digits, their unit, and the decimal mark of the reader's language."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from centrode.locale import decimal_mark
from centrode.model.settings import DIGITS, Display, shown_as
from centrode.quantities import DEGREES, spelled_unit, with_unit
from centrode.render.document.typst import decimal

MINUS, NOTHING, ENDLESS, NARROW, NO_BREAK = "\u2212", "\u2014", "\u221e", "\u202f", "\u00a0"
MOST_DECIMALS = 7
"""Zeros behind the decimal mark that can still be read; beyond them numbers get a power of ten."""
_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def spelled_number(text: str) -> str:
    """A number as Python prints it ("-1.5e-07"), as it stands in text; never minus zero."""
    digits, sign, power = text.partition("e")
    minus = MINUS if digits.startswith("-") and digits.strip("-0.") else ""
    digits = digits.removeprefix("-").replace(".", decimal_mark())
    return f"{minus}{digits}·10{str(int(power)).translate(_RAISED)}" if sign else f"{minus}{digits}"


@dataclass(frozen=True)
class Numbers:
    """How a report spells its numbers.

    Attributes
    ----------
    display : units of lengths and angles
    digits : significant digits of the greatest number of a column, and of a single number at most
    """

    display: Display
    digits: int = DIGITS

    def plain(self, value: float, digits: int | None = None) -> str:
        """A number without unit, as text."""
        if not math.isfinite(value):
            return NOTHING if math.isnan(value) else (MINUS if value < 0 else "") + ENDLESS
        return spelled_number(f"{value:.{digits or self.digits}g}")

    def math(self, value: float, unit: str = "1", digits: int | None = None) -> str:
        """A quantity in SI as mathematics, in the units of the display, the unit left out."""
        value *= self.shown(unit)[0]
        if not math.isfinite(value):
            return '"' + self.plain(value) + '"'
        return decimal(f"{value or 0.0:.{digits or self.digits}g}")

    def with_unit(self, value: float, unit: str, digits: int | None = None) -> str:
        """A quantity in SI as text, with its unit."""
        factor, label = self.shown(unit)
        return with_unit(self.plain(value * factor, digits), label, NARROW)

    def shown(self, unit: str) -> tuple[float, str]:
        """Factor and label of the unit in which a quantity of an SI unit is shown; analogs stay by radian."""
        factor, label = shown_as(unit, self.display)
        return factor, spelled_unit(label)

    def head(self, name: str, unit: str) -> str:
        """Head of a column: a name (or mathematics between dollar signs) with the unit behind it.

        The sign of degrees is too small for a line of its own.
        """
        label = self.shown(unit)[1]
        return f"{name},{NO_BREAK if label == DEGREES else ' '}{label}" if label else name

    def column(self, values: Iterable[float], unit: str = "1", least: float = 0.0) -> tuple[str, ...]:
        """Numbers in SI below each other, all with the same decimals; what is below `least` [SI] is zero."""
        factor, _label = self.shown(unit)
        found = [0.0 if abs(value) < least else float(value) * factor for value in values]
        decimals = self._decimals(found)
        return tuple(
            spelled_number(f"{value:.{decimals}f}")
            if decimals is not None and math.isfinite(value)
            else self.plain(value)
            for value in found
        )

    def _decimals(self, values: Sequence[float]) -> int | None:
        """Decimals that give the greatest number of a column its digits; None where powers of ten are needed."""
        greatest = max((abs(value) for value in values if math.isfinite(value)), default=0.0)
        if not greatest:
            return 0
        whole = math.floor(math.log10(greatest)) + 1
        decimals = self.digits - whole
        if decimals > MOST_DECIMALS + max(0, self.digits - 2) or decimals < -2:
            return None
        return max(0, decimals)
