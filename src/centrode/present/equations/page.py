"""The equations of a mechanism as a page: headings, relations and systems, spelled but not yet laid out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

from centrode.equations.spelling import FormulaSpelling, SymbolFormula, formula_of, spell_formula, spelled_sum
from centrode.equations.symbols import Letter, Sum
from centrode.locale import _
from centrode.present.equations.velocities import velocity_lines
from centrode.present.equations.words import meaning_text, value_text

if TYPE_CHECKING:
    from centrode.equations.derivation import Drivenness, Equations
    from centrode.equations.linear import Condition, GroupEquations, GroupSolution, Unknown


@dataclass(frozen=True)
class Relation:
    """a = b = ...: spelled parts, the first the left side."""

    parts: tuple[str, ...]


@dataclass(frozen=True)
class System:
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

Entry: TypeAlias = Relation | System | Symbols | Note


@dataclass(frozen=True)
class Section:
    """A heading and what stands below it."""

    heading: str
    entries: tuple[Entry, ...]


def sections(equations: Equations, spelling: FormulaSpelling, points: Sequence[str]) -> list[Section]:
    """The whole page in the order of the work; `points` are those whose velocities are asked for."""
    found = [Section(_("Symbols"), (_symbols(equations, spelling, points),))]
    conditions = [one for group in equations.groups for one in group.conditions]
    if conditions:
        found.append(Section(_("Constraints"), tuple(_constraint(one, spelling) for one in conditions)))
        rates = [_differentiated(one, equations, spelling) for one in conditions]
        found.append(Section(_("Differentiated by time"), tuple(rates)))
    given = [line for one in equations.given.drives for line in _given(one, spelling)]
    found.append(Section(_("Given by the drives (SI)"), tuple(given)))
    if equations.together is not None:
        found.append(Section(_("Velocities: Cramer's rule"), tuple(_solved(equations.together, spelling))))
    else:
        found += [
            Section(
                _("Velocities of group {group}").format(group=group.label),
                tuple(_solved(group.velocities, spelling)),
            )
            for group in equations.groups
        ]
    if conditions:
        told = equations.together is None
        normal = [line for group in equations.groups for line in _normal(group, spelling, told)]
        found.append(Section(_("Cauchy normal form"), tuple(normal)))
        seconds = [line for group in equations.groups for line in _seconds(group, spelling)]
        found.append(Section(_("Accelerations"), tuple(seconds)))
    through = equations.board.axes_through
    if points and through is not None:
        words = _("x runs through {first}, {second} lies in the half-plane of x and y")
        first, second = map(spelling.text, through)
        found.append(Section(_("Axes"), (Note(words.format(first=first, second=second)),)))
    for point in points:
        lines = velocity_lines(equations.velocity(point), spelling)
        entries: list[Entry] = [Relation(line) for line in lines]
        found.append(Section(_("Velocity of point {point}").format(point=point), tuple(entries)))
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


def _differentiated(one: Condition, equations: Equations, spelling: FormulaSpelling) -> Relation:
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


def _solved(solution: GroupSolution, spelling: FormulaSpelling) -> list[Entry]:
    system = solution.system
    unknowns = tuple(spelling.letter(letter) for letter in system.unknowns)
    matrix = tuple(tuple(_entry(entry, spelling) for entry in row) for row in system.matrix)
    right = tuple(_entry(entry, spelling) for entry in system.right)
    if len(unknowns) == 1:
        left = formula_of(system.matrix[0][0] * Sum.letter(system.unknowns[0]))
        return [Relation((spell_formula(left, spelling), right[0]))]
    lines: list[Entry] = [System(matrix, unknowns, right)]
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
