"""Pieces of formulas with numbers, as expressions: letters with names below them, long sums."""

from __future__ import annotations

from collections.abc import Sequence

from centrode.sheets.texts import Expression, Leaf, Name, Number

LONGEST = 6
"""Terms of a sum beyond which only its first and its last ones are written."""
ROUNDING = 1e-13
"""Terms below this share of the greatest are zero."""


def index_symbol(letter: str, name: str, behind: str = "") -> Expression:
    """A letter with a name below it; `behind` follows, as a power does."""
    return Expression(f"{letter}_({{name}}){behind}", name=Name(name))


def sum_of(values: Sequence[float]) -> Expression:
    """Numbers added up, each with its sign; a long sum by its first and last terms, what is rounding as zero."""
    least = ROUNDING * max(map(abs, values), default=0.0)
    values = [0.0 if abs(value) <= least else value for value in values]
    shown = values if len(values) <= LONGEST else [*values[: LONGEST - 2], values[-1]]
    holes: dict[str, Leaf] = {}
    parts = []
    for place, value in enumerate(shown):
        holes[f"term{place}"] = Number(abs(value) if place else value)
        sign = ("- " if value < 0 else "+ ") if place else ""
        parts.append(f"{sign}{{term{place}}}")
    if len(shown) < len(values):
        parts.insert(LONGEST - 2, "+ dots.c")
    return Expression(" ".join(parts), **holes)


def join_expressions(parts: Sequence[Expression], between: str) -> Expression:
    """Expressions with a sign between them."""
    holes = {f"part{place}": part for place, part in enumerate(parts)}
    return Expression(between.join(f"{{{name}}}" for name in holes), **holes)
