"""Velocities of points as lines of a page."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

from centrode.equations.spelling import FormulaSpelling, SymbolFormula, spell_formula, spelled_sum
from centrode.equations.symbols import Letter, Sum, SumTerm

if TYPE_CHECKING:
    from centrode.equations.derivation import PointVelocity

Line: TypeAlias = tuple[str, ...]

LONGEST = 3
"""Terms of the longest square of a speed that tells more than the components."""
MANY = 9
"""Terms of three components whose squares are not tried: hardly any of them would go."""


def velocity_lines(velocity: PointVelocity, spelling: FormulaSpelling) -> list[Line]:
    """Coordinates, then the velocity along its guide, or both components and the speed.

    In the rates, and with these put in where that is short.
    """
    point = velocity.point
    lines: list[Line] = [
        (spelling.letter(Letter(0, f"{axis}_{point}")), spelled_sum(total, spelling))
        for axis, total, rate in zip(
            "xyz", velocity.place, (velocity.x, velocity.y, velocity.z), strict=False
        )
        if rate is not None and rate.number
    ]
    if velocity.along is not None:
        return [*lines, _line(f"v_{point}", velocity.along, velocity.closed_along, spelling)]
    lines += [
        _line(f"v_{point}x", velocity.x, velocity.closed_x, spelling),
        _line(f"v_{point}y", velocity.y, velocity.closed_y, spelling),
    ]
    if velocity.z is not None:
        lines.append(_line(f"v_{point}z", velocity.z, velocity.closed_z, spelling))
        if velocity.x.size + velocity.y.size + velocity.z.size > MANY:
            return lines
    speed = spelling.letter(Letter(0, f"v_{point}"))
    square = velocity.squared
    if _is_square(square):
        lines.append((speed, _root(square, spelling)))
    elif square.size <= LONGEST:
        lines.append((spelling.power(speed, 2), spell_formula(square, spelling)))
    return lines


def _line(name: str, formula: SymbolFormula, closed: SymbolFormula | None, spelling: FormulaSpelling) -> Line:
    parts = [spelling.letter(Letter(0, name)), spell_formula(formula, spelling, turned=formula.single)]
    if closed is not None:
        short = spell_formula(closed, spelling, turned=True)
        parts += [short] if short != parts[1] else []
    return tuple(parts)


def _is_square(formula: SymbolFormula) -> bool:
    return (
        formula.single
        and formula.number == 1
        and not formula.product.waves
        and all(power % 2 == 0 for _letter, power in formula.product.letters)
    )


def _root(formula: SymbolFormula, spelling: FormulaSpelling) -> str:
    """Square root of a product of squares; rates may be negative, so they stand between bars."""
    halves = [(letter, power // 2) for letter, power in formula.product.letters]
    texts = []
    for letter, power in halves:
        factor = spell_formula(SymbolFormula(1, SumTerm(((letter, power),)), Sum.number(1)), spelling)
        rate = letter.name.startswith("omega") or letter.name.endswith("_dot")
        texts.append((rate, spelling.bars(factor) if rate else factor))
    return spelling.join([text for _rate, text in sorted(texts, key=lambda one: one[0])]) or spelling.number(
        1
    )
