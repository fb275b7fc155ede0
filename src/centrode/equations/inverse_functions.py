"""Functions that positions in closed form need beside sums: roots, arc functions, directions of vectors.

Each stands over sums of letters; it gives its number, its spelling in any medium, and its SymPy expression.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any, TypeAlias

import numpy as np

from centrode.equations.spelling import (
    FormulaSpelling,
    SymbolFormula,
    order_terms,
    spell_formula,
    spelled_sum,
)
from centrode.equations.symbols import Angle, Letter, Sum, expression, sympy

ValueOf: TypeAlias = Callable[[Letter], Any]

PI, HALF_PI = Letter(-2_000_000, "pi"), Letter(-1_999_999, "pi/2")
CONSTANTS: dict[Letter, float] = {PI: float(np.pi), HALF_PI: float(np.pi / 2)}
"""Letters that are numbers."""
SLACK = 1e-12
"""By how much rounding may take the argument of an arc sine or cosine beyond one: in a dead position it is one."""


def angle_sum(angle: Angle) -> Sum:
    """An angle as a sum, its right angles as parts of pi between -pi/2 and pi."""
    total = Sum.collect((next(iter(Sum.letter(letter).terms)), count) for letter, count in angle.parts)
    quarters = {0: Sum({}), 1: Sum.letter(HALF_PI), 2: Sum.letter(PI), 3: -Sum.letter(HALF_PI)}
    return total + quarters[angle.quarters % 4]


_PI, _HALF = (next(iter(Sum.letter(letter).terms)) for letter in (PI, HALF_PI))
PARTS_OF_PI = {-1: (0, -1), 0: (0, 0), 1: (0, 1), 2: (1, 0)}
"""Right angles -> how many times pi and its half."""


def within_a_turn(total: Sum) -> Sum:
    """A sum of angles with its right angles between -pi/2 and pi."""
    found = dict(total.terms)
    quarters = Fraction(found.pop(_HALF, 0) + 2 * found.pop(_PI, 0))
    whole, half = PARTS_OF_PI[(int(quarters) + 1) % 4 - 1]
    return Sum(found | {term: count for term, count in ((_PI, whole), (_HALF, half)) if count})


@dataclass(frozen=True)
class AngleSum:
    """A sum of angles, pi among them."""

    total: Sum

    @property
    def letters(self) -> set[Letter]:
        return self.total.letters

    def put(self, signs: Mapping[Letter, int]) -> AngleSum:
        """The same with the signs of branches."""
        return AngleSum(
            within_a_turn(self.total.replace_letters({x: Sum.number(k) for x, k in signs.items()}))
        )

    def value(self, value_of: ValueOf) -> Any:
        """The number."""
        return self.total.value(np, value_of)

    def text(self, spelling: FormulaSpelling) -> str:
        """The formula."""
        if not self.total:
            return spelling.number(0)
        parts = [
            (term.letters[0][0], int(Fraction(self.total.terms[term]))) for term in order_terms(self.total)
        ]
        return spelling.angle(tuple(parts))

    @property
    def expression(self) -> Any:
        """The same for SymPy."""
        return _with_pi(expression(self.total))


@dataclass(frozen=True)
class VectorLength:
    """Length of a vector by its components: the root of the sum of their squares."""

    parts: tuple[Sum, ...]

    @property
    def letters(self) -> set[Letter]:
        return {letter for part in self.parts for letter in part.letters}

    def value(self, value_of: ValueOf) -> Any:
        """The number."""
        return np.sqrt(sum(part.value(np, value_of) ** 2 for part in self.parts))

    def text(self, spelling: FormulaSpelling) -> str:
        """The formula."""
        return spelling.root(" + ".join(square_text(part, spelling) for part in self.parts if part))

    @property
    def expression(self) -> Any:
        """The same for SymPy."""
        return sympy().sqrt(sum(expression(part) ** 2 for part in self.parts))


@dataclass(frozen=True)
class SquareRoot:
    """The root of a sum."""

    formula: SymbolFormula

    @property
    def letters(self) -> set[Letter]:
        return self.formula.total.letters

    def value(self, value_of: ValueOf) -> Any:
        """The number."""
        return np.sqrt(self.formula.total.value(np, value_of))

    def text(self, spelling: FormulaSpelling) -> str:
        """The formula."""
        return spelling.root(spell_formula(self.formula, spelling))

    @property
    def expression(self) -> Any:
        """The same for SymPy."""
        return sympy().sqrt(self.formula.expression)


@dataclass(frozen=True)
class VectorDirection:
    """Direction of a vector from the x axis, in (-pi, pi]: atan2(y, x)."""

    y: Sum
    x: Sum

    @property
    def letters(self) -> set[Letter]:
        return self.y.letters | self.x.letters

    def value(self, value_of: ValueOf) -> Any:
        """The number."""
        return np.arctan2(self.y.value(np, value_of), self.x.value(np, value_of))

    def text(self, spelling: FormulaSpelling) -> str:
        """The formula."""
        return spelling.direction(spelled_sum(self.y, spelling), spelled_sum(self.x, spelling))

    @property
    def expression(self) -> Any:
        """The same for SymPy."""
        return sympy().atan2(expression(self.y), expression(self.x))


@dataclass(frozen=True)
class ArcFunction:
    """The arc sine or arc cosine of a formula, which may be `over` a letter; `kind` is "arcsin" or "arccos"."""

    kind: str
    formula: SymbolFormula
    over: Letter | None = None

    @property
    def letters(self) -> set[Letter]:
        return self.formula.total.letters | (set() if self.over is None else {self.over})

    def value(self, value_of: ValueOf) -> Any:
        """The number, NaN where the argument is beyond one by more than rounding."""
        x = np.asarray(self.formula.total.value(np, value_of), dtype=np.float64)
        x = x / value_of(self.over) if self.over is not None else x
        x = np.where(np.abs(x) <= 1.0 + SLACK, np.clip(x, -1.0, 1.0), np.nan)
        return np.arcsin(x) if self.kind == "arcsin" else np.arccos(x)

    def text(self, spelling: FormulaSpelling) -> str:
        """The formula."""
        inside = spell_formula(self.formula, spelling)
        if self.over is not None and self.formula.number:
            inside = inside if self.formula.single else spelling.bracket(inside)
            inside = spelling.fraction([inside], [spelling.letter(self.over)])
        return spelling.function(self.kind, inside)

    @property
    def expression(self) -> Any:
        """The same for SymPy."""
        library = sympy()
        inside = self.formula.expression
        inside = inside / expression(Sum.letter(self.over)) if self.over is not None else inside
        return (library.asin if self.kind == "arcsin" else library.acos)(inside)


@dataclass(frozen=True)
class TangentOfAngle:
    """The tangent of the x that satisfies p cos x + q sin x = r, as the root of a quadratic equation.

    Of the two roots `sign` chooses that of x = atan2(q, p) + sign arccos(r/sqrt(p^2 + q^2)).
    """

    p: Sum
    q: Sum
    r: Sum
    branch: Letter
    sign: int = 1

    @property
    def letters(self) -> set[Letter]:
        return self.p.letters | self.q.letters | self.r.letters

    def put(self, signs: Mapping[Letter, int]) -> TangentOfAngle:
        """The same with the sign of its branch."""
        return replace(self, sign=signs[self.branch])

    def value(self, value_of: ValueOf) -> Any:
        """The number."""
        p, q, r = (one.value(np, value_of) for one in (self.p, self.q, self.r))
        with np.errstate(all="ignore"):
            return (p * q + value_of(self.branch) * r * np.sqrt(p * p + q * q - r * r)) / (r * r - q * q)

    def text(self, spelling: FormulaSpelling) -> str:
        """The formula."""
        p, q, r = (square_text(one, spelling) for one in (self.p, self.q, self.r))
        root = spelling.root(
            " + ".join(text for text, part in ((p, self.p), (q, self.q)) if part) + f" {spelling.minus} {r}"
        )
        product = -(self.p * self.q)
        if not product:
            return self._of_one_part(r, root, spelling)
        factor = spelled_sum(self.r, spelling)
        factor = factor if len(self.r.terms) == 1 else spelling.bracket(factor)
        sign = "+" if self.sign < 0 else spelling.minus
        above = f"{spelled_sum(product, spelling)} {sign} {spelling.join([factor, root])}"
        return spelling.fraction([spelling.bracket(above)], [spelling.bracket(f"{q} {spelling.minus} {r}")])

    def _of_one_part(self, r: str, root: str, spelling: FormulaSpelling) -> str:
        """The same where p or q is zero."""
        minus = spelling.minus if self.sign < 0 else ""
        if not self.q:
            return minus + spelling.fraction([root], [spelled_sum(self.r, spelling)])
        return ("" if minus else spelling.minus) + spelling.fraction([spelled_sum(self.r, spelling)], [root])

    @property
    def expression(self) -> Any:
        """The same for SymPy."""
        p, q, r = (expression(one) for one in (self.p, self.q, self.r))
        return (p * q + self.sign * r * sympy().sqrt(p**2 + q**2 - r**2)) / (r**2 - q**2)


PositionFormula: TypeAlias = (
    AngleSum | VectorLength | SquareRoot | VectorDirection | ArcFunction | TangentOfAngle
)


def square_text(total: Sum, spelling: FormulaSpelling) -> str:
    """The square of a sum: of a product the product of squares, else a bracket squared."""
    if len(total.terms) == 1:
        return spelled_sum(total * total, spelling)
    return spelling.power(spelling.bracket(spelled_sum(total, spelling)), 2)


def _with_pi(found: Any) -> Any:
    library = sympy()
    return found.subs({library.Symbol("pi"): library.pi, library.Symbol("pi/2"): library.pi / 2})
