"""The equations of a mechanism as a page: headings, relations and systems, spelled but not yet laid out."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

from centrode.equations.spelling import FormulaSpelling, SymbolFormula, formula_of, spell_formula, spelled_sum
from centrode.equations.symbols import Letter, Sum, SumTerm
from centrode.locale import _
from centrode.model.labels import GEAR, ROLLING
from centrode.quantities import display_unit

if TYPE_CHECKING:
    from centrode.equations.derivation import Drivenness, Equations, PointVelocity
    from centrode.equations.linear import Condition, GroupEquations, GroupSolution, Unknown
    from centrode.equations.symbols import Meaning
    from centrode.model.mechanism import Display

# What the letters of a mechanism's equations stand for, in words and numbers.


def meaning_text(meaning: Meaning, equations: Equations) -> str:
    """What a letter stands for."""
    first, second, third = (*meaning.names, "", "", "")[:3]
    body = _("the frame") if second == "frame" else _("link {link}").format(link=second)
    sentences = {
        "link angle": _("angle of link {first}"),
        "relative angle": _("angle of link {first} against link {second}"),
        "bearing": _("direction of the centre of wheel {first} from that of its track"),
        "cylinder": _("direction of cylinder {first}"),
        "angle in link": _("angle of {second}-{third} against the axis of link {first}"),
        "angle of guide": _("direction of guide {first} on {body}"),
        "angle of pair": _("constant angle of the links that guide {first} keeps parallel"),
        "length": _("{second}-{third} of link {first}"),
        "reach": _("distance of the centres of wheel {first} and its track"),
        "stroke": _("length of cylinder {first}"),
        "slide": _("displacement along guide {first}"),
        "offset along": _("from {third} to where guide {first} is measured from, along it"),
        "offset beside": _("distance of guide {first} from {third}"),
        "coordinate": _("{second} of point {first}"),
        "ratio": _("ratio of gear {first}"),
        "spin": _("turns of wheel {first} over turns of its centre"),
        "radius": _("radius of wheel {first}"),
        "constant": _("constant of {first}"),
        "constant of gear": _("constant of gear {first}"),
        "constant of wheel": _("constant of the rolling of wheel {first}"),
        "arc": _("arc from {first} to {second}"),
        "arc of circle": _("arc from the pole of guide {first} to its circle"),
        "corner": _("angle in {second} from arc {second}-{first} to arc {second}-{third}"),
        "angle from arc": _("angle of link {first} in {second} from arc {second}-{third}"),
        "angle on circle": _("angle of {first} about {second} from arc {second}-{third}"),
        "angle to path": _("angle of link {first} in {second} to the path of {second} about {third}"),
    }
    kind = meaning.kind
    if kind == "constant":
        kind, first = _constant(_constraint_of(meaning.symbol, equations))
    if meaning.kind.startswith("offset") and not third:
        third = _("the origin")
    return sentences[kind].format(first=first, second=second, third=third, body=body)


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


def value_text(meaning: Meaning, display: Display, least: Mapping[str, float]) -> str:
    """Its number in the units of the description; zero where it is smaller than what counts in its unit."""
    value = 0.0 if abs(meaning.value) < least.get(meaning.unit, 0.0) else meaning.value
    if meaning.unit == "1":
        return f"{meaning.value:.6g}"
    factor, shown = display_unit(meaning.unit, display.length, display.angle)
    return f"{value * factor:.6g} {shown}"


# Velocities of points as lines of a page.

Line: TypeAlias = tuple[str, ...]

LONGEST_VELOCITY = 3
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
    elif square.size <= LONGEST_VELOCITY:
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


@dataclass(frozen=True)
class Relation:
    """a = b = ...: spelled parts, the first the left side."""

    parts: tuple[str, ...]


@dataclass(frozen=True)
class PageSystem:
    """matrix unknowns = right, spelled."""

    matrix: tuple[tuple[str, ...], ...]
    unknowns: tuple[str, ...]
    right: tuple[str, ...]


@dataclass(frozen=True)
class Symbols:
    """Rows of a letter, its number and what it stands for."""

    rows: tuple[tuple[str, str, str], ...]


@dataclass(frozen=True)
class Note:
    """A sentence."""

    text: str


LONGEST = 24
"""Terms of the longest formula that is written out."""
NOTHING = 1e-13
"""Angles [rad], and lengths as a part of the greatest, below which an initial value is rounding and shown as zero."""

Entry: TypeAlias = Relation | PageSystem | Symbols | Note


@dataclass(frozen=True)
class PageSection:
    """A heading and what stands below it."""

    heading: str
    entries: tuple[Entry, ...]


def sections(equations: Equations, spelling: FormulaSpelling, points: Sequence[str]) -> list[PageSection]:
    """The whole page in the order of the work; `points` are those whose velocities are asked for."""
    found = [PageSection(_("Symbols"), (_symbols(equations, spelling, points),))]
    conditions = [one for group in equations.groups for one in group.conditions]
    if conditions:
        found.append(PageSection(_("Constraints"), tuple(_constraint(one, spelling) for one in conditions)))
        rates = [_rate_relation(one, equations, spelling) for one in conditions]
        found.append(PageSection(_("Differentiated by time"), tuple(rates)))
    given = [line for one in equations.given.drives for line in _given(one, spelling)]
    found.append(PageSection(_("Given by the drives (SI)"), tuple(given)))
    if equations.together is not None:
        found.append(
            PageSection(
                _("Velocities: Cramer's rule"), tuple(_solution_entries(equations.together, spelling))
            )
        )
    else:
        found += [
            PageSection(
                _("Velocities of group {group}").format(group=group.label),
                tuple(_solution_entries(group.velocities, spelling)),
            )
            for group in equations.groups
        ]
    if conditions:
        told = equations.together is None
        normal = [line for group in equations.groups for line in _normal(group, spelling, told)]
        found.append(PageSection(_("Cauchy normal form"), tuple(normal)))
        seconds = [line for group in equations.groups for line in _seconds(group, spelling)]
        found.append(PageSection(_("Accelerations"), tuple(seconds)))
    through = equations.board.axes_through
    if points and through is not None:
        words = _("x runs through {first}, {second} lies in the half-plane of x and y")
        first, second = map(spelling.text, through)
        found.append(PageSection(_("Axes"), (Note(words.format(first=first, second=second)),)))
    for point in points:
        lines = velocity_lines(equations.velocity(point), spelling)
        entries: list[Entry] = [Relation(line) for line in lines]
        found.append(PageSection(_("Velocity of point {point}").format(point=point), tuple(entries)))
    return found


def _symbols(equations: Equations, spelling: FormulaSpelling, points: Sequence[str]) -> Symbols:
    display = equations.mechanism.display
    largest = max((abs(one.value) for one in equations.legend if one.unit == "m"), default=1.0)
    least = {"m": NOTHING * largest, "rad": NOTHING}
    rows = []
    for one in equations.legend_of(points):
        name = spelling.letter(Letter(0, one.symbol))
        rows.append(
            (
                spelling.initial(name) if one.moves else name,
                value_text(one, display, least),
                meaning_text(one, equations),
            )
        )
    return Symbols(tuple(rows))


def _constraint(one: Condition, spelling: FormulaSpelling) -> Relation:
    right = spelled_sum(one.right, spelling)
    name = one.name.partition("(")[0]
    left = [spelling.letter(Letter(0, name))] if name[:2] in ("x_", "y_") or _is_offset(one) else []
    full, short = spelled_sum(one.full, spelling), spelled_sum(one.left, spelling)
    return Relation((*left, full, *([short] if short != full else []), right))


def _is_offset(one: Condition) -> bool:
    return one.name.startswith("n_") and bool(one.right)


def _rate_relation(one: Condition, equations: Equations, spelling: FormulaSpelling) -> Relation:
    total = one.rate(equations.board.moves)
    return Relation((spelled_sum(total, spelling), spelling.number(0)))


def _given(one: Drivenness, spelling: FormulaSpelling) -> list[Entry]:
    value, rate = spelling.letter(one.letter), spelling.letter(one.rate)
    if one.law == "law":
        return [
            Note(
                _("{value} and {rate} by the law of drive {drive}").format(
                    value=spelling.math(value), rate=spelling.math(rate), drive=spelling.text(one.drive)
                )
            )
        ]
    size = [spelling.decimal(abs(one.speed))] if abs(one.speed) != 1.0 else []
    way = spelling.join([*size, "t"])
    minus = one.speed < 0
    if one.start:
        way = f"{spelling.decimal(one.start)} {'-' if minus else '+'} {way}"
    elif minus:
        way = f"-{way}"
    return [Relation((value, way)), Relation((rate, spelling.decimal(one.speed)))]


def _solution_entries(solution: GroupSolution, spelling: FormulaSpelling) -> list[Entry]:
    system = solution.system
    unknowns = tuple(spelling.letter(letter) for letter in system.unknowns)
    matrix = tuple(tuple(_entry(entry, spelling) for entry in row) for row in system.matrix)
    right = tuple(_entry(entry, spelling) for entry in system.right)
    if len(unknowns) == 1:
        left = formula_of(system.matrix[0][0] * Sum.letter(system.unknowns[0]))
        return [Relation((spell_formula(left, spelling), right[0]))]
    lines: list[Entry] = [PageSystem(matrix, unknowns, right)]
    if system.determinant is None or system.numerators is None:
        return [
            *lines,
            Note(_("The determinants have too many terms to be read; the system is solved as numbers.")),
        ]
    delta = spelling.letter(solution.under)
    lines.append(Relation((delta, spell_formula(system.determinant, spelling, differences_first=True))))
    for letter, unknown, one in zip(system.unknowns, unknowns, system.numerators, strict=True):
        top = spelling.letter(Letter(0, f"Delta_{index_of(letter)}"))
        lines.append(Relation((top, spell_formula(one, spelling, differences_first=True))))
        lines.append(Relation((unknown, spelling.fraction([top], [delta]))))
    return lines


def index_of(letter: Letter) -> str:
    """What stands below a rate: the determinant of its column has the same index."""
    name = letter.name
    return name.removeprefix("omega").removeprefix("gamma").removesuffix("_dot").lstrip("_")


def _entry(total: Sum, spelling: FormulaSpelling) -> str:
    return spell_formula(formula_of(total), spelling) if total else spelling.number(0)


def _normal(group: GroupEquations, spelling: FormulaSpelling, told: bool) -> list[Entry]:
    """Rates as formulas; the letter of a determinant is explained first unless Cramer's rule has `told` it."""
    lines: list[Entry] = []
    solution = group.velocities
    if solution.system.determinant is not None and solution.lettered:
        delta = spell_formula(solution.system.determinant, spelling, differences_first=True)
        if not told or len(solution.letters) == 1:
            lines.append(Relation((spelling.letter(solution.under), delta)))
    for unknown, formula in _with_formulas(group.unknowns, group.normal_form):
        if formula is None:
            lines.append(_as_numbers(unknown.rate, group, spelling))
            continue
        parts = [
            spelling.derivative(unknown.letter),
            spelling.letter(unknown.rate),
            spell_formula(formula, spelling),
        ]
        if parts[0] == parts[1]:
            del parts[0]
        lines.append(Relation(tuple(parts)))
    return lines


def _seconds(group: GroupEquations, spelling: FormulaSpelling) -> list[Entry]:
    return [
        _as_numbers(unknown.second, group, spelling)
        if formula is None
        else Relation((spelling.letter(unknown.second), spell_formula(formula, spelling)))
        for unknown, formula in _with_formulas(group.unknowns, group.seconds.formulas)
    ]


def _with_formulas(
    unknowns: Sequence[Unknown], formulas: Sequence[SymbolFormula] | None
) -> list[tuple[Unknown, SymbolFormula | None]]:
    """Unknowns with their formulas, None for those too long to be read."""
    if formulas is None:
        return [(unknown, None) for unknown in unknowns]
    return [
        (unknown, formula if formula.size <= LONGEST else None)
        for unknown, formula in zip(unknowns, formulas, strict=True)
    ]


def _as_numbers(letter: Letter, group: GroupEquations, spelling: FormulaSpelling) -> Note:
    sentence = _("{letter}: as a number, from the system of group {group}")
    symbol = spelling.math(spelling.letter(letter))
    return Note(sentence.format(letter=symbol, group=spelling.text(group.label)))
