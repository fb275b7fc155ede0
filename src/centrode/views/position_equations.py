"""Positions in closed form: the formulas of every group of the plan, and their numbers at an instant."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from fractions import Fraction
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from centrode.equations.instants import PlacedEquations
from centrode.equations.inverse_functions import AngleSum, VectorDirection
from centrode.equations.position_functions import put_signs
from centrode.equations.spelling import SymbolFormula, formula_of
from centrode.equations.symbols import Angle, Letter, Sum
from centrode.quantities import display_unit
from centrode.sheets.sheet import Block, Formula, Paragraph, Section
from centrode.sheets.symbolic import FactoredFormula, FunctionOfLetter, InverseFormula, SumFormula
from centrode.sheets.texts import Joined, Leaf, Name, Number, Sentence, Text
from centrode.views.instants import instant_title

if TYPE_CHECKING:
    from centrode.equations.derivation import Equations
    from centrode.equations.position_functions import (
        Formula as PositionFormula,
    )
    from centrode.equations.position_functions import (
        GroupPositions,
        PositionLine,
        SphericalCoordinates,
    )

Line: TypeAlias = tuple[Leaf, ...]
Values: TypeAlias = Mapping[Letter, float]

ROUNDING = 1e-14
"""Part of the greatest number of its kind below which a number is rounding."""
BIGGEST = 6
"""Terms of the longest formula that is written with its numbers."""


def position_sections(equations: Equations) -> Iterator[Section]:
    """The formulas of all positions; with one instant of a motion their numbers, and these put in as a detail."""
    functions = equations.position_functions
    if functions.groups:
        title = Sentence("Positions in closed form")
        yield Section(title, tuple(_Positions(equations, None).blocks()))
    if functions.spherical:
        yield Section(Sentence("Spherical coordinates"), tuple(_spherical(functions.spherical)))


def numbered_sections(equations: Equations) -> Iterator[Section]:
    """The same with the numbers of the first instant that is reached; the numbers put in as a detail."""
    found = next(_reached_samples(equations), None)
    if found is None or not equations.position_functions.groups:
        yield from position_sections(equations)
        return
    sample, _values = found
    assert isinstance(equations, PlacedEquations)
    place = instant_title(equations.mechanism, equations.motion, sample)
    numbered = _Positions(equations, sample)
    title = Sentence("Positions in closed form, with their values at {place}", place=place)
    yield Section(title, tuple(numbered.blocks()))
    lines = tuple(numbered.put_in())
    if lines:
        title = Sentence("Positions with the numbers at {place} put in", place=place)
        yield Section(title, (Formula(lines),), detail=True)
    if equations.position_functions.spherical:
        spherical = _spherical(equations.position_functions.spherical)
        yield Section(Sentence("Spherical coordinates"), tuple(spherical))


def _reached_samples(equations: Equations) -> Iterator[tuple[int, Values]]:
    """Samples at which the positions have numbers."""
    if isinstance(equations, PlacedEquations):
        for sample, values in enumerate(equations.place_values):
            if values is not None:
                yield sample, values


class _Positions:
    """Lines of all groups, behind each its number where a sample is chosen."""

    def __init__(self, equations: Equations, sample: int | None) -> None:
        self.equations = equations
        self.functions = equations.position_functions
        self.values: Values | None = None
        self.signs = {branch.letter: branch.initial for branch in self.functions.branches}
        if sample is not None and isinstance(equations, PlacedEquations):
            self.values = equations.place_values[sample] or {}
            self.signs = {letter: int(self.values[letter]) for letter in self.signs}
        self.units = {letter: one.unit for letter, one in equations.board.alphabet.meanings.items()}
        self.units |= {line.letter: line.unit for line in self.functions.lines}

    def blocks(self) -> Iterator[Block]:
        """What the letters are, then what is done in each group, and its lines."""
        yield from self._explain()
        lines: list[Line] = []
        shown = {one.tangent[0] for one in self.functions.spherical if one.tangent is not None}
        for group in self.functions.groups:
            words = self._words(group)
            if words is not None:
                if lines:
                    yield Formula(tuple(lines))
                    lines = []
                yield Paragraph(words)
            lines += [self._line(line) for line in group.lines]
            for letter, formula in group.tangents.items():
                if letter not in shown:
                    lines.append((FunctionOfLetter("tan", letter), _leaf(put_signs(formula, self.signs))))
        if lines:
            yield Formula(tuple(lines))

    def _explain(self) -> Iterator[Block]:
        """What atan2 is, and which of two solutions the formulas are for."""
        sentences: list[Text] = []
        if any(isinstance(line.formula, VectorDirection) for line in self.functions.lines):
            x, y = (Sum.letter(Letter(0, axis)) for axis in "xy")
            direction = InverseFormula(VectorDirection(y, x))
            sentences.append(
                Sentence(
                    "{direction} is the direction of the vector with the components x and y.",
                    direction=direction,
                )
            )
        if self.signs:
            sentences.append(
                Sentence(
                    "The signs before the auxiliary angles are those of the assembly; "
                    "beyond a change point of a group they are opposite."
                )
            )
        if sentences:
            yield Paragraph(Joined(tuple(sentences), " "))

    def _words(self, group: GroupPositions) -> Text | None:
        """What is done in a group; nothing where its lines speak for themselves."""
        label = Name(group.label)
        if group.unsolved:
            unsolved = Joined(tuple(SumFormula(Sum.letter(letter)) for letter in group.unsolved))
            if group.kind == "higher class":
                return Sentence(
                    "{group} is of higher class and has no closed form; found numerically: {letters}.",
                    group=label, letters=unsolved,
                )  # fmt: skip
            return Sentence(
                "{group} is not written in closed form; found numerically: {letters}.",
                group=label,
                letters=unsolved,
            )
        if group.branch is None:
            return None
        sentence = self._sentences(group)[self.signs[group.branch.letter] > 0]
        letters: dict[str, Text] = {
            name: SumFormula(Sum.letter(one))
            for name, one in zip(("first", "second", "third"), group.auxiliary, strict=False)
        }
        point, centre, other = map(Name, group.names)
        if self.equations.mechanism.space == "sphere":
            turn = Angle.of(group.lines[-1].letter)
            p, q, r = (Sum.letter(Letter(k, name)) for k, name in enumerate("pqr"))
            letters["closure"] = SumFormula(p * Sum.wave("cos", turn) + q * Sum.wave("sin", turn))
            letters["result"] = SumFormula(r)
        return sentence.fill(group=label, point=point, centre=centre, other=other, **letters)

    def _sentences(self, group: GroupPositions) -> tuple[Sentence, Sentence]:
        """Of a group with two solutions the sentences for the negative and for the positive sign."""
        if self.equations.mechanism.space == "sphere":
            return (
                Sentence(
                    "{group}: the closure {closure} = {result}, with the auxiliary angles {second} and {third}; "
                    "{point} is to the right of the arc from {centre} to {other}."
                ),
                Sentence(
                    "{group}: the closure {closure} = {result}, with the auxiliary angles {second} and {third}; "
                    "{point} is to the left of the arc from {centre} to {other}."
                ),
            )
        if group.kind == "RPR":
            return (
                Sentence(
                    "{group}: auxiliary vector from {centre} to {point}, its length {first}, its angle {second}; "
                    "{point} is behind on guide {other}."
                ),
                Sentence(
                    "{group}: auxiliary vector from {centre} to {point}, its length {first}, its angle {second}; "
                    "{point} is ahead on guide {other}."
                ),
            )
        if group.kind == "RRP":
            return (
                Sentence(
                    "{group}: {first} is the angle of {centre}-{point} to guide {other}; "
                    "{point} is behind the foot of the perpendicular."
                ),
                Sentence(
                    "{group}: {first} is the angle of {centre}-{point} to guide {other}; "
                    "{point} is ahead of the foot of the perpendicular."
                ),
            )
        return (
            Sentence(
                "{group}: auxiliary vector from {centre} to {other}, its length {first}, its angle {second}; "
                "law of cosines for the angle {third} at {centre}; {point} is to the right of the vector."
            ),
            Sentence(
                "{group}: auxiliary vector from {centre} to {other}, its length {first}, its angle {second}; "
                "law of cosines for the angle {third} at {centre}; {point} is to the left of the vector."
            ),
        )

    def _line(self, line: PositionLine) -> Line:
        left, formula = SumFormula(Sum.letter(line.letter)), _leaf(put_signs(line.formula, self.signs))
        other = () if line.other is None else (_leaf(line.other),)
        number = () if self.values is None else (self._number(line),)
        return (left, formula, *other, *number)

    def _number(self, line: PositionLine) -> Number:
        assert self.values is not None
        sizes = [abs(x) for letter, x in self.values.items() if self.units.get(letter) == line.unit]
        least = ROUNDING * max((x for x in sizes if np.isfinite(x)), default=0.0)
        value = self.values[line.letter]
        return Number(value if abs(value) > least else 0.0, line.unit)

    def put_in(self) -> Iterator[Line]:
        """Every formula with its numbers, lengths in the unit of the display."""
        if self.values is None:
            return
        length, _unit = display_unit("m", str(self.equations.mechanism.display.length))
        values = {
            letter: x * (length if self.units.get(letter) == "m" else 1.0)
            for letter, x in self.values.items()
        }
        for line in self.functions.lines:
            formula = put_signs(line.formula, self.signs)
            letters = formula.total.letters if isinstance(formula, SymbolFormula) else formula.letters
            size = formula.size if isinstance(formula, SymbolFormula) else 1
            same = isinstance(formula, AngleSum) and len(formula.total.terms) == 1
            if letters and size <= BIGGEST and not same:
                yield SumFormula(Sum.letter(line.letter)), _leaf(formula, values), self._number(line)


def _leaf(formula: PositionFormula, values: Values | None = None) -> Leaf:
    if isinstance(formula, SymbolFormula):
        if values is None and not formula.number:
            return SumFormula(Sum({}))
        return FactoredFormula(formula, values=values)
    return InverseFormula(formula, values)


def _spherical(points: tuple[SphericalCoordinates, ...]) -> Iterator[Block]:
    """Angles of points from the z axis and about it."""
    polar, longitude = (SumFormula(Sum.letter(Letter(0, name))) for name in ("theta", "phi"))
    words = Sentence(
        "{polar} is the angle of a point from the z axis, {longitude} its longitude from the x axis.",
        polar=polar, longitude=longitude,
    )  # fmt: skip
    yield Paragraph(words)
    lines: list[Line] = []
    for one in points:
        cosine = FunctionOfLetter("cos", one.polar)
        lines.append((cosine, SumFormula(one.z)))
        if one.tangent is not None:
            letter, formula = one.tangent
            tangent = InverseFormula(put_signs(formula, {formula.branch: formula.sign}))  # type: ignore[arg-type]
            lines.append((FunctionOfLetter("tan", one.polar), FunctionOfLetter("tan", letter), tangent))
        tangent_of = FunctionOfLetter("tan", one.longitude)
        if not one.y:
            lines.append((tangent_of, SumFormula(one.y)))
        elif len(one.x.terms) == 1:
            (term, number), *_others = one.x.terms.items()
            ratio = formula_of(one.y.divide(term).scale(1 / Fraction(number)))
            lines.append((tangent_of, FactoredFormula(ratio)))
        else:
            direction = InverseFormula(VectorDirection(one.y, one.x))
            lines.append((SumFormula(Sum.letter(one.longitude)), direction))
    yield Formula(tuple(lines))
