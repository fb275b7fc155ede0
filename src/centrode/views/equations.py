"""The equations of a mechanism in symbols: the printed page, and the chapters of documents with numbers at instants."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from centrode.equations.instants import NumberedEquations
from centrode.equations.spelling import SymbolFormula, formula_of
from centrode.equations.symbols import ZERO, Letter, Sum, SumTerm
from centrode.errors import Status
from centrode.model.labels import GEAR, ROLLING
from centrode.model.settings import shown_as
from centrode.sheets.sheet import (
    Block,
    Chapter,
    Check,
    ExplainedSymbol,
    Formula,
    Paragraph,
    Section,
    Sheet,
    SheetEquations,
    SymbolList,
)
from centrode.sheets.symbolic import (
    AbsoluteProduct,
    Cofactors,
    FactoredFormula,
    GivenNumber,
    InitialValue,
    SumFormula,
    TimeDerivative,
    UniformMotion,
)
from centrode.sheets.texts import NOTHING, Expression, Leaf, Name, Number, Sentence, Text
from centrode.views.instants import instant_title
from centrode.views.position_equations import numbered_sections, position_sections

if TYPE_CHECKING:
    from centrode.equations.cofactors import CofactorExpansion
    from centrode.equations.derivation import Drivenness, Equations, PointVelocity
    from centrode.equations.instants import Instant, NumbersAtInstant, SolvedSystem
    from centrode.equations.linear import GroupEquations, GroupSolution, LinearConstraint, Unknown
    from centrode.equations.symbols import Meaning

Line: TypeAlias = tuple[Leaf, ...]
"""A relation a = b = ..., the first part its left side."""

LONGEST = 24
"""Terms of the longest formula that is written out."""
LONGEST_VELOCITY = 3
"""Terms of the longest square of a speed that tells more than the components."""
MANY = 9
"""Terms of three components whose squares are not tried: hardly any of them would go."""
MOST_TERMS, MOST_NUMBERS = 6, 26
"""Terms and numbers of the longest formula that is written with its numbers: beyond them nobody follows."""
SMALL = 1e-13
"""Angles [rad], and lengths as a part of the greatest, below which a value is rounding and shown as zero."""
ROUNDING = 1e-14
"""Part of the greatest number of its kind below which a number is rounding."""


def sheet(equations: Equations) -> Sheet:
    """The page of the equations; in documents constraints and derivation are chapters, with numbers where known."""
    explained, derived = (
        tuple(_explain_constraints(equations)),
        tuple(_derive_systems(equations, first_step=True)),
    )
    positions, placed = tuple(position_sections(equations)), tuple(numbered_sections(equations))
    printed = (*explained, *positions, *_derive_systems(equations, first_step=False))
    if equations.mechanism.space == "sphere":
        text = Sentence(
            "Each dyad adds one point: the law of cosines in the triangle of the dyad's two centres and this "
            "point gives one angle, from which the angle of the other arc follows."
        )
        sections = (Section(NOTHING, (Paragraph(text),)), *explained, *placed, *derived)
        return Sheet(printed=printed, chapters={"equations": _constraints(sections)})
    checked: tuple[Section, ...] = ()
    numbered: tuple[Section, ...] = ()
    if isinstance(equations, NumberedEquations):
        checked, numbered = tuple(_check_constraints(equations)), tuple(_put_numbers(equations))
    title = Sentence("Velocities and accelerations")
    chapters = {
        "equations": _constraints((*explained, *placed, *checked)),
        "derivation": Chapter(title, (*derived, *numbered)),
    }
    return Sheet(printed=printed, chapters=chapters)


def _constraints(sections: tuple[Section, ...]) -> Chapter:
    return Chapter(Sentence("Constraint equations"), sections)


def _explain_constraints(equations: Equations) -> Iterator[Section]:
    """Letters, constraints, their derivatives, and what the drives give."""
    yield Section(Sentence("Symbols"), (_symbols(equations),))
    conditions = [one for group in equations.groups for one in group.conditions]
    if conditions:
        yield Section(Sentence("Constraints"), (Formula(tuple(map(_constraint, conditions))),))
        rates = [(SumFormula(one.rate(equations.board.moves)), SumFormula(ZERO)) for one in conditions]
        yield Section(Sentence("Derivatives with respect to time"), (Formula(tuple(rates)),))
    given = [line for one in equations.given.drives for line in _given(one)]
    yield Section(Sentence("Given by the drives (SI)"), _blocks(given))


def _derive_systems(equations: Equations, *, first_step: bool) -> Iterator[Section]:
    """Systems and determinants, normal form, accelerations, velocities of points.

    Cofactor expansions of more than two rows stand in a section of their own, which is a detail; their `first_step`
    stands with the determinants where it is one product.
    """
    if equations.together is not None:
        yield Section(
            Sentence("Velocities: Cramer's rule"),
            _blocks(_solution(equations.together, first_step=first_step)),
        )
        yield from _expansions([equations.together])
    else:
        for group in equations.groups:
            title = Sentence("Velocities of group {group}", group=Name(group.label))
            yield Section(title, _blocks(_solution(group.velocities, first_step=first_step)))
        yield from _expansions([group.velocities for group in equations.groups])
    if equations.groups:
        explained = equations.together is None
        normal = [line for group in equations.groups for line in _normal_form(group, explained)]
        yield Section(Sentence("Cauchy normal form"), _blocks(normal, "rates"))
        seconds = [line for group in equations.groups for line in _accelerations(group)]
        yield Section(Sentence("Accelerations"), _blocks(seconds, "accelerations"))
    through = equations.board.axes_through
    if equations.points and through is not None:
        first, second = map(Name, through)
        words = Sentence(
            "x passes through {first}, {second} lies in the half-plane of x and y", first=first, second=second
        )
        yield Section(Sentence("Axes"), (Paragraph(words),))
    for point in equations.points:
        title = Sentence("Velocity of point {point}", point=Name(point))
        yield Section(title, (Formula(tuple(_velocity(equations.velocity(point)))),))


def _blocks(entries: Iterable[Line | Block], name: str = "") -> tuple[Block, ...]:
    """Relations that follow each other stand in one formula; it has a name where nothing is left to sentences."""
    entries = list(entries)
    if name and all(isinstance(entry, tuple) for entry in entries):
        return (Formula(tuple(entry for entry in entries if isinstance(entry, tuple)), name),)
    blocks: list[Block] = []
    lines: list[Line] = []
    for entry in entries:
        if isinstance(entry, tuple):
            lines.append(entry)
            continue
        blocks += [Formula(tuple(lines))] if lines else []
        lines = []
        blocks.append(entry)
    return (*blocks, Formula(tuple(lines))) if lines else tuple(blocks)


def _letter(letter: Letter | str) -> SumFormula:
    """A letter by itself."""
    return SumFormula(Sum.letter(Letter(0, letter) if isinstance(letter, str) else letter))


def constraint_text(name: str) -> Text:
    """A constraint by its name: one along an axis by the letter of that coordinate ("x_C"), any other as it is."""
    along_axis = name.startswith(("x_", "y_", "n_")) and "(" not in name
    return _letter(name) if along_axis else Name(name)


# What the letters stand for, in words and numbers.

# Translators: {first}, {second}, {third} are names of links, points and guides; names do not change.
MEANINGS = {
    "link angle": Sentence("angle of link {first}"),
    "relative angle": Sentence("angle of link {first} relative to link {second}"),
    "bearing": Sentence("direction of the centre of wheel {first} from that of its track"),
    "cylinder": Sentence("direction of cylinder {first}"),
    "angle in link": Sentence("angle of {second}-{third} relative to the axis of link {first}"),
    "angle of guide": Sentence("direction of guide {first} on {body}"),
    "angle of pair": Sentence("constant angle of the links that guide {first} keeps parallel"),
    "length": Sentence("{second}-{third} of link {first}"),
    "reach": Sentence("distance of the centres of wheel {first} and its track"),
    "stroke": Sentence("length of cylinder {first}"),
    "slide": Sentence("displacement along guide {first}"),
    "offset along": Sentence("from {third} to the origin of guide {first}, along it"),
    "offset beside": Sentence("distance of guide {first} from {third}"),
    "coordinate": Sentence("{second} of point {first}"),
    "ratio": Sentence("ratio of gear {first}"),
    "spin": Sentence("turns of wheel {first} over turns of its centre"),
    "radius": Sentence("radius of wheel {first}"),
    "constant": Sentence("constant of {first}"),
    "constant of gear": Sentence("constant of gear {first}"),
    "constant of wheel": Sentence("constant of the rolling of wheel {first}"),
    "arc": Sentence("arc from {first} to {second}"),
    "arc of circle": Sentence("arc from the pole of guide {first} to its circle"),
    "corner": Sentence("angle in {second} from arc {second}-{first} to arc {second}-{third}"),
    "angle from arc": Sentence("angle of link {first} in {second} from arc {second}-{third}"),
    "angle on circle": Sentence("angle of {first} about {second} from arc {second}-{third}"),
    "angle to path": Sentence("angle of link {first} in {second} to the path of {second} about {third}"),
}


def _symbols(equations: Equations) -> SymbolList:
    largest = max((abs(one.value) for one in equations.legend if one.unit == "m"), default=1.0)
    least = {"m": SMALL * largest, "rad": SMALL}
    symbols = []
    for one in equations.legend_of(equations.points):
        letter = Letter(0, one.symbol)
        value = 0.0 if abs(one.value) < least.get(one.unit, 0.0) else one.value
        symbols.append(
            ExplainedSymbol(
                InitialValue(letter) if one.moves else _letter(letter),
                Number(value, one.unit),
                _meaning(one, equations),
            )
        )
    return SymbolList(tuple(symbols))


def _meaning(meaning: Meaning, equations: Equations) -> Text:
    """What a letter stands for."""
    first, second, third = (*meaning.names, "", "", "")[:3]
    kind = meaning.kind
    if kind == "constant":
        kind, first = _constant(_constraint_of(meaning.symbol, equations))
    origin = kind.startswith("offset") and not third
    return MEANINGS[kind].fill(
        first=constraint_text(first) if kind == "constant" else Name(first),
        second=Name(second),
        third=Sentence("the origin") if origin else Name(third),
        body=Sentence("the frame") if second == "frame" else Sentence("link {link}", link=Name(second)),
    )


def _constant(constraint: str) -> tuple[str, str]:
    """What a constant belongs to, and its name: gears and wheels have names of their own."""
    for start, kind in ((GEAR, "constant of gear"), (ROLLING, "constant of wheel")):
        if constraint.startswith(start):
            return kind, constraint.removeprefix(start)
    return "constant", constraint


def _constraint_of(symbol: str, equations: Equations) -> str:
    for group in equations.groups:
        for one in group.conditions:
            if any(letter.name == symbol for letter in one.residual.letters):
                return one.name
    return ""


# Constraints, systems and formulas.


def _constraint(one: LinearConstraint) -> Line:
    name = one.name.partition("(")[0]
    offset = one.name.startswith("n_") and bool(one.right)
    left = [_letter(name)] if name[:2] in ("x_", "y_") or offset else []
    full, short, right = SumFormula(one.full), SumFormula(one.left), SumFormula(one.right)
    return (*left, full, *([short] if short != full else []), right)


def _given(one: Drivenness) -> Iterator[Line | Block]:
    value, rate = _letter(one.letter), _letter(one.rate)
    if one.law == "law":
        sentence = Sentence(
            "{value} and {rate} by the law of drive {drive}", value=value, rate=rate, drive=Name(one.drive)
        )
        yield Paragraph(sentence)
        return
    yield value, UniformMotion(one.start, one.speed)
    yield rate, GivenNumber(one.speed)


def _solution(solution: GroupSolution, *, first_step: bool) -> Iterator[Line | Block]:
    """The system of the rates, its determinants, and Cramer's rule."""
    system = solution.system
    right = tuple(map(_entry, system.right))
    if len(system.unknowns) == 1:
        yield FactoredFormula(formula_of(system.matrix[0][0] * Sum.letter(system.unknowns[0]))), right[0]
        return
    matrix = tuple(tuple(map(_entry, row)) for row in system.matrix)
    yield SheetEquations(matrix, tuple(map(_letter, system.unknowns)), right)
    if system.determinant is None or system.numerators is None:
        text = Sentence("The determinants have too many terms to print; the system is solved numerically.")
        yield Paragraph(text)
        return
    yield _determinant(solution, None, first_step=first_step)
    for column, letter in enumerate(system.unknowns):
        yield _determinant(solution, column, first_step=first_step)
        yield _letter(letter), _cramer(solution, letter)


def _determinant(solution: GroupSolution, column: int | None, *, first_step: bool) -> Line:
    """A determinant of Cramer's rule; of two rows multiplied out, of more with the `first_step` of its expansion.

    That step is shown where it is one product.
    """
    letter, expansion, formula = _parts_of(solution, column)
    fits = len(expansion.steps) == 1 or (first_step and expansion.fits)
    steps = expansion.steps[:1] if fits else ()
    return (letter, *map(Cofactors, steps), formula)


def _parts_of(
    solution: GroupSolution, column: int | None
) -> tuple[SumFormula, CofactorExpansion, FactoredFormula]:
    """Letter of a determinant, its expansion, and what it comes to."""
    system = solution.system
    assert system.determinant is not None and system.numerators is not None
    formula = system.determinant if column is None else system.numerators[column]
    letter = solution.under if column is None else _numerator(system.unknowns[column])
    return _letter(letter), system.expansion(column), FactoredFormula(formula, differences_first=True)


def _expansions(solutions: Iterable[GroupSolution]) -> Iterator[Section]:
    """The cofactor expansions of determinants of three rows and more in all their steps, as a detail."""
    lines: list[Line] = []
    for solution in solutions:
        system = solution.system
        if len(system.unknowns) > 2 and system.determinant is not None:
            for column in (None, *range(len(system.unknowns))):
                letter, expansion, formula = _parts_of(solution, column)
                lines.append((letter, *map(Cofactors, expansion.steps), formula))
    if lines:
        yield Section(Sentence("Determinants by cofactor expansion"), (Formula(tuple(lines)),), detail=True)


def _cramer(solution: GroupSolution, letter: Letter) -> SumFormula:
    """The determinant of a column over that of the system."""
    return SumFormula(Sum({SumTerm(((_numerator(letter), 1), (solution.under, -1))): 1}))


def _numerator(letter: Letter) -> Letter:
    """The determinant of the column of a rate, which has the same index."""
    name = letter.name
    index = name.removeprefix("omega").removeprefix("gamma").removesuffix("_dot").lstrip("_")
    return Letter(0, f"Delta_{index}")


def _entry(total: Sum) -> Leaf:
    return FactoredFormula(formula_of(total)) if total else SumFormula(ZERO)


def _normal_form(group: GroupEquations, explained: bool) -> Iterator[Line | Block]:
    """Rates as formulas; the letter of a determinant comes first unless Cramer's rule has `explained` it."""
    solution = group.velocities
    if solution.system.determinant is not None and solution.has_letter:
        delta = FactoredFormula(solution.system.determinant, differences_first=True)
        if not explained or len(solution.letters) == 1:
            yield _letter(solution.under), delta
    for unknown, formula in _with_formulas(group.unknowns, group.normal_form):
        if formula is None:
            yield _as_number(unknown.rate, group)
            continue
        yield TimeDerivative(unknown.letter), _letter(unknown.rate), FactoredFormula(formula)


def _accelerations(group: GroupEquations) -> Iterator[Line | Block]:
    for unknown, formula in _with_formulas(group.unknowns, group.seconds.formulas):
        if formula is None:
            yield _as_number(unknown.second, group)
        else:
            yield _letter(unknown.second), FactoredFormula(formula)


def _with_formulas(
    unknowns: Sequence[Unknown], formulas: Sequence[SymbolFormula] | None
) -> Iterator[tuple[Unknown, SymbolFormula | None]]:
    """Unknowns with their formulas, None for those too long to be read."""
    for unknown, formula in zip(unknowns, formulas or (None,) * len(unknowns), strict=True):
        yield unknown, formula if formula is not None and formula.size <= LONGEST else None


def _as_number(letter: Letter, group: GroupEquations) -> Paragraph:
    sentence = Sentence(
        "{letter}: numerically, from the system of group {group}",
        letter=_letter(letter),
        group=Name(group.label),
    )
    return Paragraph(sentence)


# Velocities of points.


def _velocity(velocity: PointVelocity) -> Iterator[Line]:
    """Coordinates, then the velocity along its guide, or its components and the speed.

    In the rates, and with these put in where that is short.
    """
    point = velocity.point
    rates = (velocity.x, velocity.y, velocity.z)
    for axis, total, rate in zip("xyz", velocity.place, rates, strict=False):
        if rate is not None and rate.number:
            yield _letter(f"{axis}_{point}"), SumFormula(total)
    if velocity.along is not None:
        yield _component(f"v_{point}", velocity.along, velocity.closed_along)
        return
    yield _component(f"v_{point}x", velocity.x, velocity.closed_x)
    yield _component(f"v_{point}y", velocity.y, velocity.closed_y)
    if velocity.z is not None:
        yield _component(f"v_{point}z", velocity.z, velocity.closed_z)
        if velocity.x.size + velocity.y.size + velocity.z.size > MANY:
            return
    square, speed = velocity.squared_speed, Letter(0, f"v_{point}")
    if _is_square(square):
        yield _letter(speed), _root(square)
    elif square.size <= LONGEST_VELOCITY:
        yield SumFormula(Sum.letter(speed, 2)), FactoredFormula(square)


def _component(name: str, formula: SymbolFormula, closed: SymbolFormula | None) -> Line:
    written = FactoredFormula(formula, turned=formula.single)
    short = None if closed is None else FactoredFormula(closed, turned=True)
    return (_letter(name), written, *([] if short is None or short == written else [short]))


def _is_square(formula: SymbolFormula) -> bool:
    return (
        formula.single
        and formula.number == 1
        and not formula.product.waves
        and all(power % 2 == 0 for _letter, power in formula.product.letters)
    )


def _root(formula: SymbolFormula) -> AbsoluteProduct:
    """Square root of a product of squares; rates may be negative."""
    halves = [
        (letter, power // 2, letter.name.startswith("omega") or letter.name.endswith("_dot"))
        for letter, power in formula.product.letters
    ]
    return AbsoluteProduct(tuple(halves))


# The equations with numbers: checks, and what stands behind the letters at each instant.


def _check_constraints(equations: NumberedEquations) -> Iterator[Section]:
    """The constraints with the numbers of the motion put in."""
    check = equations.check
    if check is not None:
        text = Sentence(
            "With angles and displacements in closed form substituted, both sides of every constraint equation "
            "agree within {share} at {count} positions; rounding allows {allowed} (lengths in m, angles in rad).",
            count=Number(check.samples, digits="d"),
            allowed=Number(check.allowed, digits=".1e"),
        )
        yield Section(Sentence("Check"), (Check(text, check.greatest, 1.0, check.allowed),))


def _put_numbers(equations: NumberedEquations) -> Iterator[Section]:
    """The formulas with the numbers of each instant."""
    if not equations.groups:
        return
    for sample, numbers in enumerate(equations.numbers):
        place = instant_title(equations.mechanism, equations.motion, sample)
        title = Sentence("Numbers at {place}", place=place)
        if numbers is None:
            status = Status(int(equations.motion["status"][sample]))
            missing = Sentence(
                "At {place} the sample is {status}: the velocities are not defined.",
                place=place,
                status=Sentence(status.word),
            )
            yield Section(title, (Paragraph(missing),))
        else:
            yield Section(title, tuple(_Numbers(equations, numbers.instant).blocks(numbers)))


class _Numbers:
    """Relations of one instant, each followed by its numbers; lengths in the unit of the display."""

    def __init__(self, equations: NumberedEquations, instant: Instant) -> None:
        self.equations, self.instant = equations, instant
        unknowns = equations.unknowns
        values = _without_rounding(instant.values, [one.rate for one in unknowns])
        values = _without_rounding(values, [one.second for one in unknowns])
        angles = [one.letter for one in unknowns if not one.name.startswith("slide.")]
        self.values = values | {letter: 0.0 for letter in angles if abs(values[letter]) < SMALL}
        self.length = str(equations.mechanism.display.length)
        self.units: dict[Letter, str] = {}
        for one in unknowns:
            self._set_units(one.letter, one.rate, one.second, angular=not one.name.startswith("slide."))
        meanings = equations.board.alphabet.meanings
        for driven in equations.given.drives:
            angular = meanings[driven.letter].unit != "m"
            self._set_units(driven.letter, driven.rate, driven.second, angular=angular)

    def _set_units(self, letter: Letter, rate: Letter, second: Letter, *, angular: bool) -> None:
        base = "rad" if angular else self.length
        self.units |= {letter: base, rate: f"{base}/s", second: f"{base}/s^2"}

    def blocks(self, numbers: NumbersAtInstant) -> Iterator[Block]:
        """Angles and displacements, systems, rates, accelerations, velocities, and how far two routes differ."""
        equations, instant = self.equations, self.instant
        yield Formula(tuple(self.angles()))
        if equations.together is not None and instant.together is not None:
            solutions = [(equations.together, instant.together)]
        else:
            velocities = [group.velocities for group in equations.groups]
            solutions = list(zip(velocities, instant.velocities, strict=True))
        for solution, solved in solutions:
            yield from self.solved_system(solution, solved)
        # what determinants have given is not given again by the normal form
        known = {letter for solution, _solved in solutions for letter in _given_by_determinants(solution)}
        for lines in (
            [line for group in equations.groups for line in self.rates(group, known)],
            [line for group in equations.groups for line in self.accelerations(group)],
            [line for point in equations.points for line in self.velocity(point)],
        ):
            if lines:
                yield Formula(tuple(lines))
        yield _compare_rates(numbers)

    def value(self, letter: Letter) -> Leaf:
        """A number with the unit of its letter; angles also in degrees where these are shown."""
        unit = self.units[letter]
        number = Number(self.values[letter], unit, unit_fixed=True)
        if shown_as(unit, self.equations.mechanism.display)[1].startswith("deg"):
            return Expression(
                "{radians} = {degrees}", radians=number, degrees=Number(self.values[letter], unit)
            )
        return number

    def angles(self) -> Iterator[Line]:
        """What moves, at this instant: what the drives give first."""
        for driven in self.equations.given.drives:
            yield _letter(driven.letter), self.value(driven.letter)
            yield _letter(driven.rate), self.value(driven.rate)
        for one in self.equations.unknowns:
            yield _letter(one.letter), self.value(one.letter)

    def solved_system(self, solution: GroupSolution, solved: SolvedSystem) -> Iterator[Block]:
        """The system and its determinants."""
        system = solution.system
        if len(system.unknowns) == 1:
            return
        largest = float(np.nanmax(np.abs(solved.matrix)))
        matrix = tuple(tuple(_beside(x, largest) for x in row) for row in solved.matrix.tolist())
        right = tuple(_beside(x, largest * self.fastest) for x in solved.right.tolist())
        yield SheetEquations(matrix, tuple(map(_letter, system.unknowns)), right)
        if system.determinant is None or system.numerators is None:
            return
        size = float(np.nanmax(np.abs([solved.determinant, *solved.numerators])))
        lines = [self.determinant(solution.under, system.determinant, solved.determinant, size)]
        for letter, one, number in zip(
            system.unknowns, system.numerators, solved.numerators.tolist(), strict=True
        ):
            lines.append(self.determinant(_numerator(letter), one, number, size))
            ratio = Expression(
                "frac({above}, {below})", above=_beside(number, size), below=Number(solved.determinant)
            )
            lines.append((_letter(letter), _cramer(solution, letter), ratio, self.value(letter)))
        yield Formula(tuple(lines))

    @property
    def fastest(self) -> float:
        """The greatest rate, of what the drives give included."""
        rates = [one.rate for one in self.equations.unknowns]
        rates += [one.rate for one in self.equations.given.drives]
        return max((abs(self.values[rate]) for rate in rates), default=0.0)

    def determinant(self, letter: Letter, formula: SymbolFormula, value: float, size: float) -> Line:
        """A determinant, its formula with numbers where that can be read, its value."""
        inside = self.with_numbers(formula, differences_first=True)
        return (_letter(letter), *inside, _beside(value, size))

    def with_numbers(
        self, formula: SymbolFormula | None, *, differences_first: bool = False, turned: bool = False
    ) -> tuple[FactoredFormula, ...]:
        """A formula with its numbers; none where it is too long, has no letters, or one of its numbers is missing."""
        if formula is None:
            return ()
        count = sum(map(_letters_in, (formula.product, *formula.rest.terms)))
        if not count or formula.size > MOST_TERMS or count > MOST_NUMBERS:
            return ()
        values = {letter: self.values.get(letter, math.nan) for letter in formula.total.letters}
        if not all(map(math.isfinite, values.values())):
            return ()
        return (FactoredFormula(formula, differences_first, turned, values),)

    def rates(self, group: GroupEquations, known: Collection[Letter]) -> Iterator[Line]:
        """Cauchy's normal form with numbers, of the rates that are not known yet."""
        for unknown, formula in zip(group.unknowns, group.normal_form or (), strict=False):
            inside = self.with_numbers(formula)
            if inside and unknown.rate not in known:
                yield (_letter(unknown.rate), *inside, self.value(unknown.rate))

    def accelerations(self, group: GroupEquations) -> Iterator[Line]:
        """Accelerations with numbers; of long formulas the numbers alone."""
        formulas = group.seconds.formulas or (None,) * len(group.unknowns)
        for unknown, formula in zip(group.unknowns, formulas, strict=True):
            yield (_letter(unknown.second), *self.with_numbers(formula), self.value(unknown.second))

    def velocity(self, point: str) -> Iterator[Line]:
        """Components of a point's velocity, or that along its guide."""
        velocity = self.equations.velocity(point)
        parts = (
            [(f"v_{point}", velocity.closed_along or velocity.along)]
            if velocity.along is not None
            else [
                (f"v_{point}x", velocity.closed_x or velocity.x),
                (f"v_{point}y", velocity.closed_y or velocity.y),
            ]
        )
        for name, formula in parts:
            number = Number(self.instant.number(formula), f"{self.length}/s", unit_fixed=True)
            yield (_letter(name), *self.with_numbers(formula, turned=formula.single), number)


def _given_by_determinants(solution: GroupSolution) -> tuple[Letter, ...]:
    """The rates whose quotients of determinants a document shows with numbers."""
    system = solution.system
    shown = len(system.unknowns) > 1 and system.determinant is not None and system.numerators is not None
    return tuple(system.unknowns) if shown else ()


def _letters_in(term: SumTerm) -> int:
    return len(term.letters) + sum(len(one.parts) for one, _power in term.waves)


def _without_rounding(values: Mapping[Letter, float], rates: Sequence[Letter]) -> dict[Letter, float]:
    """Values as they are shown: rates that are nothing but the rounding of others are zero."""
    sizes = [abs(values[letter]) for letter in rates if math.isfinite(values[letter])]
    least = ROUNDING * max(sizes, default=0.0)
    return {**values, **{letter: 0.0 for letter in rates if abs(values[letter]) <= least}}


def _beside(value: float, size: float) -> Number:
    """A number beside others of a size; what is rounding of them is zero."""
    return Number(value if abs(value) > ROUNDING * size else 0.0)


def _compare_rates(numbers: NumbersAtInstant) -> Block:
    """Rates and accelerations of the systems beside those of the motion in closed form."""
    if not numbers.rates:
        return Paragraph(Sentence("The closed-form solution gives no velocities to compare with."))
    # the first that does not agree, else the one that is nearest to what is allowed
    worst = min(
        numbers.rates,
        key=lambda rate: (rate.agrees, -abs(rate.solved - rate.closed) / max(rate.allowed, 1e-300)),
    )
    text = Sentence(
        "The systems give the same velocities and accelerations as the motion in closed form: the difference is "
        "at most {share}; rounding and the condition of the systems allow {allowed} (rad or m, by s or s²).",
        allowed=Number(worst.allowed, digits=".1e"),
    )
    return Check(text, abs(worst.solved - worst.closed), 1.0, worst.allowed)
