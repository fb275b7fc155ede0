"""Symbols of instant centres as mathematical text."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from centrode.analysis.instant_centres.bodies import Pair


def subscripted(pair: Pair, bodies: int) -> str:
    """The symbol of a centre as mathematical text."""
    return f"$P_{{{pair[0]}{',' if bodies > 10 else ''}{pair[1]}}}$"
