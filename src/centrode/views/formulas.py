"""Formulas with numbers, as expressions: letters with names below them, long sums, letters followed by numbers."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from types import MappingProxyType

from centrode.sheets.texts import Expression, Leaf, Name, Number

LONGEST = 6
"""Terms of a sum beyond which only its first and its last ones are written."""
ROUNDING = 1e-13
"""Terms below this share of the greatest are zero."""
NO_LETTERS: Mapping[str, str] = MappingProxyType({})


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


def relation(
    left: str,
    notation: str,
    result: Leaf,
    values: Mapping[str, Leaf],
    letters: Mapping[str, str] = NO_LETTERS,
) -> tuple[Leaf, ...]:
    """A line of a formula: left side, right side in letters, the same with numbers, and the result.

    Parameters
    ----------
    left : in the notation of `Expression`, as `notation`
    notation : with a hole for each quantity; an asterisk between blanks is a product, whose sign letters do without
    values : hole -> the number, or an expression of numbers
    letters : hole -> how the quantity is written, where that is not the name of the hole
    """
    return left, in_letters(notation, values, letters), with_numbers(notation, values), result


def in_letters(notation: str, values: Iterable[str], letters: Mapping[str, str] = NO_LETTERS) -> str:
    """The right side of a `relation` in letters."""
    return notation.replace(" * ", " ").format(**{name: letters.get(name, name) for name in values})


def with_numbers(notation: str, values: Mapping[str, Leaf]) -> Expression:
    """The right side of a `relation` with numbers."""
    return Expression(notation.replace(" * ", " dot.op "), **values)
