"""Sums of products of letters, sines and cosines: what the constraint equations of planar linkages are made of."""

from __future__ import annotations

import functools
import math
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from importlib.util import find_spec
from typing import Any, NamedTuple, TypeAlias

import lazy_loader

from centrode.errors import InputError
from centrode.locale import _
from centrode.optional_packages import how_to_install

# Letters of formulas, and angles as sums of letters and right angles.


class Letter(NamedTuple):
    """A symbol; `rank` says where it stands in a product or a sum. Driven angles, too, rank with their link."""

    rank: int
    name: str


Parts = tuple[tuple[Letter, int], ...]


class Angle(NamedTuple):
    """A sum of letters with whole factors, and of right angles."""

    parts: Parts = ()
    quarters: int = 0

    @classmethod
    def of(cls, letter: Letter) -> Angle:
        """The angle that a letter stands for."""
        return cls(((letter, 1),))

    def plus(self, other: Angle, factor: int = 1) -> Angle:
        """The angle and `factor` times the other."""
        total = dict(self.parts)
        for letter, count in other.parts:
            total[letter] = total.get(letter, 0) + factor * count
        parts = tuple(sorted((letter, count) for letter, count in total.items() if count))
        return Angle(parts, (self.quarters + factor * other.quarters) % 4)

    def turned_by(self, quarters: int) -> Angle:
        """The angle and some right angles."""
        return Angle(self.parts, (self.quarters + quarters) % 4)


class Wave(NamedTuple):
    """A sine or cosine of an angle without right angles, whose first letter has a positive factor."""

    parts: Parts
    kind: str

    @property
    def order(self) -> tuple[bool, Parts, str]:
        """Where it stands in a product: single angles before differences."""
        return len(self.parts) > 1, self.parts, self.kind

    @property
    def partner(self) -> Wave:
        """The sine of the same angle for a cosine, and the other way round."""
        return Wave(self.parts, "cos" if self.kind == "sin" else "sin")


COSINES = ((1, "cos"), (-1, "sin"), (-1, "cos"), (1, "sin"))
"""cos(x + k pi/2) for k = 0, 1, 2, 3: sign and function of x."""
SINES = ((1, "sin"), (1, "cos"), (-1, "sin"), (-1, "cos"))


def wave(kind: str, angle: Angle) -> tuple[int, Wave | None]:
    """A sine or cosine as sign and wave; no wave where it is a number: then the sign is that number."""
    sign, function = (COSINES if kind == "cos" else SINES)[angle.quarters % 4]
    parts = angle.parts
    if not parts:
        return (sign if function == "cos" else 0), None
    if parts[0][1] < 0:
        parts = tuple((letter, -count) for letter, count in parts)
        sign = -sign if function == "sin" else sign
    return sign, Wave(parts, function)


Number: TypeAlias = Any
Namespace: TypeAlias = Any
Coefficient: TypeAlias = int | Fraction


class SumTerm(NamedTuple):
    """A product without its number: letters and waves with their whole exponents, in their order."""

    letters: tuple[tuple[Letter, int], ...] = ()
    waves: tuple[tuple[Wave, int], ...] = ()

    def times(self, other: SumTerm, power: int = 1) -> SumTerm:
        """The product with `power` of another term."""
        return SumTerm(
            _multiply_terms(self.letters, other.letters, power),
            _multiply_terms(self.waves, other.waves, power),
        )


def _multiply_terms(one: tuple[Any, ...], other: tuple[Any, ...], power: int) -> tuple[Any, ...]:
    if not other:
        return one
    total = dict(one)
    for factor, exponent in other:
        total[factor] = total.get(factor, 0) + power * exponent
    return tuple(sorted((factor, exponent) for factor, exponent in total.items() if exponent))


ONE = SumTerm()


@dataclass(frozen=True)
class Sum:
    """Terms with their numbers, none of them zero; numbers are whole or fractions, everything else is a letter."""

    terms: Mapping[SumTerm, Coefficient]

    @classmethod
    def collect(cls, terms: Iterable[tuple[SumTerm, Coefficient]]) -> Sum:
        """The sum of terms, equal ones taken together."""
        total: dict[SumTerm, Coefficient] = {}
        for term, number in terms:
            total[term] = total.get(term, 0) + number
        return cls({term: number for term, number in total.items() if number})

    @classmethod
    def number(cls, number: Coefficient) -> Sum:
        """A number."""
        return cls({ONE: number} if number else {})

    @classmethod
    def letter(cls, letter: Letter, power: int = 1) -> Sum:
        """A letter, or a power of it."""
        return cls({SumTerm(((letter, power),)): 1})

    @classmethod
    def wave(cls, kind: str, angle: Angle) -> Sum:
        """The sine or cosine of an angle."""
        sign, found = wave(kind, angle)
        return cls.number(sign) if found is None else cls({SumTerm((), ((found, 1),)): sign})

    def __bool__(self) -> bool:
        return bool(self.terms)

    def __add__(self, other: Sum) -> Sum:
        return Sum.collect([*self.terms.items(), *other.terms.items()])

    def __sub__(self, other: Sum) -> Sum:
        return self + -other

    def __neg__(self) -> Sum:
        return self.scale(-1)

    def __mul__(self, other: Sum) -> Sum:
        return Sum.collect(
            (one.times(two), a * b) for one, a in self.terms.items() for two, b in other.terms.items()
        )

    def scale(self, number: Coefficient) -> Sum:
        """Every term times a number."""
        return Sum({term: value * number for term, value in self.terms.items()} if number else {})

    def divide(self, term: SumTerm) -> Sum:
        """Every term over a product."""
        return Sum({own.times(term, -1): number for own, number in self.terms.items()})

    @property
    def letters(self) -> set[Letter]:
        """All letters, those of angles included."""
        found = {letter for term in self.terms for letter, _power in term.letters}
        for term in self.terms:
            for one, _power in term.waves:
                found.update(letter for letter, _count in one.parts)
        return found

    def slope(self, letter: Letter) -> Sum:
        """Partial derivative by a letter."""
        found: list[tuple[SumTerm, Coefficient]] = []
        for term, number in self.terms.items():
            power = dict(term.letters).get(letter, 0)
            if power:
                found.append((term.times(SumTerm(((letter, 1),)), -1), number * power))
            for one, exponent in term.waves:
                count = dict(one.parts).get(letter, 0)
                if count:
                    sign = 1 if one.kind == "sin" else -1
                    changed = SumTerm((), ((one.partner, 1),)).times(SumTerm((), ((one, 1),)), -1)
                    found.append((term.times(changed), number * exponent * count * sign))
        return Sum.collect(found)

    def rate(self, rates: Mapping[Letter, Sum]) -> Sum:
        """Derivative by time, the rates of those letters that move being given."""
        total = Sum({})
        for letter in sorted(self.letters & rates.keys()):
            total += self.slope(letter) * rates[letter]
        return total

    def replace_letters(self, values: Mapping[Letter, Sum]) -> Sum:
        """The sum with letters outside of angles replaced; they have positive exponents."""
        total = Sum({})
        for term, number in self.terms.items():
            known = [(letter, power) for letter, power in term.letters if letter in values]
            part = Sum({term.times(SumTerm(tuple(known)), -1): number})
            for letter, power in known:
                for _time in range(power):
                    part = part * values[letter]
            total += part
        return total

    def rename_letters(self, names: Mapping[Letter, Letter]) -> Sum:
        """The sum with letters written otherwise, also in angles; the new ones have the ranks of the old."""

        def other(one: Wave) -> Wave:
            return Wave(tuple((names.get(letter, letter), count) for letter, count in one.parts), one.kind)

        return Sum.collect(
            (
                SumTerm(
                    tuple(sorted((names.get(x, x), power) for x, power in term.letters)),
                    tuple(sorted((other(x), power) for x, power in term.waves)),
                ),
                number,
            )
            for term, number in self.terms.items()
        )

    def value(
        self, m: Namespace, value_of: Callable[[Letter], Number], waves: dict[Wave, Number] | None = None
    ) -> Number:
        """The number that it is, from those of its letters, over any algebra.

        Sums of the same letters share `waves`: each sine and cosine is computed once and kept there.
        """
        known = {} if waves is None else waves
        total: Number = 0.0
        for term, number in self.terms.items():
            product: Number = float(number)
            for letter, power in term.letters:
                product = product * _power(value_of(letter), power)
            for one, power in term.waves:
                if one not in known:
                    angle: Number = 0.0
                    for letter, count in one.parts:
                        angle = angle + count * value_of(letter)
                    known[one] = m.sin(angle) if one.kind == "sin" else m.cos(angle)
                product = product * _power(known[one], power)
            total = total + product
        return total


def _power(x: Number, power: int) -> Number:
    result = x
    for _time in range(abs(power) - 1):
        result = result * x
    return result if power > 0 else 1.0 / result


ZERO = Sum({})


# Products of sines and cosines taken together: sin a cos b - cos a sin b = sin(a - b), and the like.
#
# The determinants and numerators of planar linkages are sums of such pairs, so taking pairs together, nothing
# else,
# brings them to the form of the textbooks.


def merge_waves(total: Sum) -> Sum:
    """The sum with every pair of terms taken together that makes one wave of two."""
    terms = dict(total.terms)
    waiting = sorted(terms, key=_order, reverse=True)
    while waiting:
        term = waiting.pop()
        number = terms.get(term)
        found = None if number is None else _pair(term, number, terms)
        if found is None:
            continue
        partner, together = found
        del terms[term], terms[partner]
        for new, value in together.terms.items():
            terms[new] = terms.get(new, 0) + value
            if not terms[new]:
                del terms[new]
            waiting.append(new)
        # a pair that was looked at before may have a partner now
        waiting += [one for one in terms if one not in waiting] if together.terms else []
    return Sum(terms)


def _order(term: SumTerm) -> tuple[int, SumTerm]:
    return sum(abs(power) for _wave, power in term.waves), term


def _pair(
    term: SumTerm, number: Coefficient, terms: dict[SumTerm, Coefficient]
) -> tuple[SumTerm, Sum] | None:
    """Another term with which this one makes a single one, and that one."""
    for one, other in _pairs(term):
        rest = term.times(_product(one, other), -1)
        partner = rest.times(_product(one.partner, other.partner))
        value = terms.get(partner)
        if value is None or abs(value) != abs(number) or partner == term:
            continue
        together = _together(one, other, value == number)
        return partner, Sum({rest: number}) * together
    return None


def _together(one: Wave, other: Wave, same: bool) -> Sum:
    """Two waves times each other, plus or minus the product of their partners, as a single wave."""
    a, b = Angle(one.parts), Angle(other.parts)
    if one.kind == other.kind:  # cos a cos b + sin a sin b, or sin a sin b + cos a cos b
        if same:
            return Sum.wave("cos", a.plus(b, -1))
        return Sum.wave("cos", a.plus(b)).scale(1 if one.kind == "cos" else -1)
    if same:
        return Sum.wave("sin", a.plus(b))
    return Sum.wave("sin", a.plus(b, -1)).scale(1 if one.kind == "sin" else -1)


def _pairs(term: SumTerm) -> Iterator[tuple[Wave, Wave]]:
    """Pairs of waves in a product; a squared wave is a pair with itself."""
    present = [(one, power) for one, power in term.waves if power > 0]
    for i, (one, power) in enumerate(present):
        if power > 1:
            yield one, one
        for other, _power in present[i + 1 :]:
            yield one, other


def _product(one: Wave, other: Wave) -> SumTerm:
    return SumTerm((), ((one, 1),)).times(SumTerm((), ((other, 1),)))


# The letters of a mechanism's equations, what each stands for, and its number.

Vector: TypeAlias = tuple[float, float]

RATIO, BEARING, TURN, FIXED, RATE, SECOND, LENGTH, SLIDE, PLACE, CONSTANT = (
    -1_000_000, 1_000_000, 2_000_000, 3_000_000, 10_000_000, 20_000_000, 30_000_000, 40_000_000, 50_000_000, 60_000_000,
)  # fmt: skip
"""Ranks from which letters of a kind are counted; angles of links stand between the first two, by number."""
ROUNDING = 4 * math.ulp(1.0)
"""A direction this near to an axis [rad] is along it: the cosine of 90 deg is not zero in floats."""
SIMPLE = re.compile(r"[^\W\d_]\d*['’′]*")


@dataclass(frozen=True)
class Meaning:
    """What a letter stands for.

    Attributes
    ----------
    symbol : its name ("phi2")
    kind : "link angle", "relative angle", "bearing", "angle in link", "angle of guide", "angle of pair", "length",
        "reach", "stroke", "slide", "offset along", "offset beside", "coordinate", "ratio", "spin", "radius", "constant"
    names : links, points or guides it belongs to
    value : its number; of what moves, that in the initial position
    unit : "m", "rad" or "1"
    moves : whether it is a function of time
    """

    symbol: str
    kind: str
    names: tuple[str, ...]
    value: float
    unit: str
    moves: bool = False


@dataclass
class Alphabet:
    """Letters as they are needed, each with its meaning."""

    meanings: dict[Letter, Meaning] = field(default_factory=dict)
    rates: dict[Letter, Letter] = field(default_factory=dict)
    seconds: dict[Letter, Letter] = field(default_factory=dict)
    found: dict[tuple[str, tuple[str, ...], str], Letter] = field(default_factory=dict)

    def letter(
        self, rank: int, name: str, kind: str, names: tuple[str, ...], value: float, unit: str
    ) -> Letter:
        """A letter that stays, or the one there is; another thing of the same name gets a prime."""
        key = kind, names, name
        if key in self.found:
            return self.found[key]
        new = self.found[key] = Letter(rank, self._free(name))
        self.meanings[new] = Meaning(new.name, kind, names, float(value), unit)
        return new

    def moving(
        self, rank: int, name: str, kind: str, names: tuple[str, ...], value: float, unit: str, rate: str
    ) -> Letter:
        """A letter that moves, with those of its two derivatives (`rate` begins with omega where it is an angle's)."""
        new = Letter(rank, self._free(name))
        self.meanings[new] = Meaning(new.name, kind, names, float(value), unit, True)
        second = (
            rate.replace("omega", "epsilon") if rate.startswith("omega") else rate.replace("_dot", "_ddot")
        )
        self.rates[new] = Letter(RATE + rank, self._free(rate))
        self.seconds[self.rates[new]] = Letter(SECOND + rank, self._free(second))
        return new

    def constant(self, value: float, unit: str) -> Letter:
        """The next constant of a constraint: C1, C2, ..."""
        number = 1 + sum(one.kind == "constant" for one in self.meanings.values())
        new = Letter(CONSTANT + number, f"C{number}")
        self.meanings[new] = Meaning(new.name, "constant", (), float(value), unit)
        return new

    def angle(self, name: str, kind: str, names: tuple[str, ...], direction: Vector) -> Angle:
        """A constant angle by its cosine and sine: right angles as such, another one by a letter."""
        quarters = quarters_of(direction)
        if quarters is not None:
            return Angle((), quarters)
        value = math.atan2(direction[1], direction[0])
        return Angle.of(self.letter(FIXED + len(self.meanings), name, kind, names, value, "rad"))

    def size(self, rank: int, name: str, kind: str, names: tuple[str, ...], value: float) -> Sum:
        """A constant length, or nothing where it is zero."""
        return Sum.letter(self.letter(rank, name, kind, names, value, "m")) if value else ZERO

    @property
    def values(self) -> Mapping[Letter, float]:
        """Number of every letter; of what moves, that in the initial position."""
        return {letter: meaning.value for letter, meaning in self.meanings.items()}

    def _free(self, name: str) -> str:
        taken = {letter.name for letters in (self.meanings, self.rates, self.seconds) for letter in letters}
        taken |= {letter.name for letter in self.seconds.values()}
        while name in taken:
            name += "'"
        return name


def quarters_of(direction: Vector) -> int | None:
    """Right angles from the x axis to a direction, or None where it is along no axis."""
    x, y = direction
    size = math.hypot(x, y)
    if abs(y) <= ROUNDING * size:
        return 0 if x > 0 else 2
    if abs(x) <= ROUNDING * size:
        return 1 if y > 0 else 3
    return None


def join_points(first: str, second: str) -> str:
    """Two points as an index: AP, or A1-P where that could be read otherwise."""
    plain = SIMPLE.fullmatch(first) and SIMPLE.fullmatch(second)
    return f"{first}{second}" if plain else f"{first}-{second}"


# Sums as SymPy expressions, for whoever goes on with them. SymPy is an extra and slow to import: it comes
# late.

_load = functools.partial(lazy_loader.load, "sympy")


def sympy() -> Any:
    """The library; raises InputError where it is not installed."""
    if find_spec("sympy") is None:
        raise InputError(
            "",
            _("expressions need SymPy, which is not installed"),
            how_to_install("symbols"),
        )
    return _load()


def expression(total: Sum) -> Any:
    """A sum as a SymPy expression; its symbols have the names of the letters and no assumptions."""
    library = sympy()
    terms = []
    for (letters, waves), number in total.terms.items():
        parts = [library.Rational(Fraction(number).numerator, Fraction(number).denominator)]
        parts += [library.Symbol(letter.name) ** power for letter, power in letters]
        parts += [_wave(library, one) ** power for one, power in waves]
        terms.append(library.Mul(*parts))
    return library.Add(*terms)


def _wave(library: Any, one: Wave) -> Any:
    angle = library.Add(*(count * library.Symbol(letter.name) for letter, count in one.parts))
    return library.sin(angle) if one.kind == "sin" else library.cos(angle)


def matrix(rows: Sequence[Sequence[Sum]]) -> Any:
    """Rows of sums as an immutable SymPy matrix."""
    return sympy().ImmutableMatrix([[expression(entry) for entry in row] for row in rows])
