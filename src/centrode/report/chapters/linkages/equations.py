"""Constraint equations in symbols: letters, constraints, their derivatives, what the drives give."""

from __future__ import annotations

from collections.abc import Iterator
from math import degrees

import numpy as np

from centrode.equations.instants import Instant, SolvedSystem, instant_of, rates_compared
from centrode.equations.linear import GroupEquations, GroupSolution
from centrode.equations.spelling import SymbolFormula as Equation
from centrode.equations.symbols import Letter
from centrode.errors import Status
from centrode.locale import _
from centrode.present.equations import page
from centrode.present.equations.page import index_of
from centrode.present.equations.typst import TypstSpelling
from centrode.render.document.blocks import (
    Block,
    ChapterBlocks,
    CheckBlock,
    FormulaBlock,
    ParagraphBlock,
    SectionBlocks,
    SystemBlock,
)
from centrode.render.document.rows import small
from centrode.report.equations import NOTHING, clean_rates, section_of, with_numbers
from centrode.report.study import Moment, ReportStudy, moments_of

EPS = float(np.finfo(float).eps)
SAMPLES = 12
"""Samples at which the constraints are put to the test."""


def page_sections(study: ReportStudy) -> list[page.PageSection]:
    """The page of the equations, as `centrode equations` prints it, in the report's mathematics."""
    return study.once("page", lambda: page.sections(study.equations, TypstSpelling(), study.points))


def first_sections(study: ReportStudy) -> int:
    """How many sections of the page come before anything is solved."""
    headings = {_("Symbols"), _("Constraints"), _("Differentiated by time"), _("Given by the drives (SI)")}
    return sum(section.heading in headings for section in page_sections(study))


def constraints_chapter(study: ReportStudy) -> ChapterBlocks | None:
    """The same relations that `centrode equations` prints, checked on samples of the motion."""
    if not study.is_planar:
        return None
    sections = [section_of(section) for section in page_sections(study)[: first_sections(study)]]
    check = _constraint_check(study)
    if check is not None:
        sections.append(SectionBlocks(_("Check"), (check,)))
    return ChapterBlocks("equations", _("Constraint equations"), tuple(sections))


def _constraint_check(study: ReportStudy) -> Block | None:
    """The constraints with the numbers of the motion put in: both sides agree to rounding."""
    conditions = [one for group in study.equations.groups for one in group.conditions]
    reached = np.flatnonzero(study.motion["status"].to_numpy() == Status.OK)
    if not conditions or not reached.size:
        return None
    chosen = np.unique(reached[np.linspace(0, reached.size - 1, SAMPLES).astype(int)])
    worst, allowed = 0.0, 0.0
    for sample in chosen.tolist():
        instant = instant_of(study.equations, study.motion, sample)
        scale = _scale(instant)
        worst = max(worst, *(abs(instant.number(one.residual)) for one in conditions))
        allowed = max(allowed, 64 * EPS * scale)
    text = _(
        "With the angles and displacements of the motion in closed form put in, both sides of every constraint "
        "agree to {worst} at {count} positions; rounding allows {allowed} (lengths in m, angles in rad)."
    )
    return CheckBlock(
        text.format(worst=small(worst), count=len(chosen), allowed=small(allowed)),
        worst <= allowed,
    )


def _scale(instant: Instant) -> float:
    """Size of what is added up in a constraint: lengths times angles, which carry a rounding of their own size."""
    sizes = [
        abs(value)
        for letter, value in instant.values.items()
        if np.isfinite(value) and not _is_rate(letter.name)
    ]
    return max(1.0, *sizes) ** 2


def _is_rate(name: str) -> bool:
    return name.startswith(("omega", "epsilon", "Delta")) or name.endswith(("_dot", "_ddot"))


# The derivation: linear systems, determinants, Cauchy's normal form, accelerations, with numbers at the
# instants.

SPELLING = TypstSpelling()
STRAIGHT = 1e-13
"""Angles [rad] below which they are rounding."""


def derivation_chapter(study: ReportStudy) -> ChapterBlocks | None:
    """Formulas as `centrode equations` prints them, then the same with the numbers of each instant."""
    if not study.is_planar:
        return None
    sections = [section_of(section) for section in page_sections(study)[first_sections(study) :]]
    if study.equations.groups:
        for moment in moments_of(study):
            title = _("Numbers at {place}").format(place=moment.title)
            sections.append(SectionBlocks(title, tuple(_numbers(study, moment))))
    return ChapterBlocks("derivation", _("Velocities and accelerations"), tuple(sections))


def _numbers(study: ReportStudy, moment: Moment) -> Iterator[Block]:
    if not moment.reached:
        yield ParagraphBlock(moment.missing)
        return
    length = study.numbers.shown("m")[0]
    instant = instant_of(study.equations, moment.data, moment.sample, length)
    made = _Numbers(study, instant)
    yield made.angles()
    equations = study.equations
    if equations.together is not None and instant.together is not None:
        yield from made.solved(equations.together, instant.together)
    else:
        for group, solved in zip(equations.groups, instant.velocities, strict=True):
            yield from made.solved(group.velocities, solved)
    yield from made.lines([line for group in equations.groups for line in made.rates(group)])
    yield from made.lines([line for group in equations.groups for line in made.accelerations(group)])
    yield from made.lines([line for point in study.points for line in made.velocity(point)])
    yield _check(study, instant, moment)


class _Numbers:
    """Relations of one instant, each followed by its numbers."""

    def __init__(self, study: ReportStudy, instant: Instant) -> None:
        self.study = study
        self.numbers = study.numbers
        self.instant = instant
        found = study.equations.unknowns
        self.values = clean_rates(instant.values, [one.rate for one in found])
        self.values |= clean_rates(self.values, [one.second for one in found])
        angles = [one.letter for one in found if not one.name.startswith("slide.")]
        self.values |= {letter: 0.0 for letter in angles if abs(self.values[letter]) < STRAIGHT}
        unit = study.numbers.shown("m")[1]
        self.units: dict[Letter, str] = {}
        for one in study.equations.unknowns:
            base = "rad" if not one.name.startswith("slide.") else unit
            self.units |= {one.letter: base, one.rate: f"{base}/s", one.second: f"{base}/s²"}

    @property
    def fastest(self) -> float:
        """The greatest rate, of what the drives give included."""
        rates = [one.rate for one in self.study.equations.unknowns]
        rates += [one.rate for one in self.study.equations.given.drives]
        return max((abs(self.values[rate]) for rate in rates), default=0.0)

    def lines(self, lines: list[tuple[str, ...]]) -> Iterator[Block]:
        if lines:
            yield FormulaBlock(tuple(lines))

    def value(self, letter: Letter) -> str:
        """A number with the unit of its letter; angular rates also in degrees where these are shown."""
        value, unit = self.values[letter], self.units[letter]
        text = f'{self.numbers.math(value)} thin "{unit}"'
        if unit.startswith("rad") and str(self.numbers.display.angle) == "deg":
            text += f' = {self.numbers.math(degrees(value))} thin "{unit.replace("rad", "°")}"'
        return text

    def angles(self) -> Block:
        """What moves, at this instant: what the drives give first."""
        equations, lines = self.study.equations, []
        unit = self.numbers.shown("m")[1]
        for driven in equations.given.drives:
            meaning = equations.board.alphabet.meanings[driven.letter]
            own = unit if meaning.unit == "m" else "rad"
            self.units |= {driven.letter: own, driven.rate: f"{own}/s", driven.second: f"{own}/s²"}
            lines.append((SPELLING.letter(driven.letter), self.value(driven.letter)))
            lines.append((SPELLING.letter(driven.rate), self.value(driven.rate)))
        lines += [(SPELLING.letter(one.letter), self.value(one.letter)) for one in equations.unknowns]
        return FormulaBlock(tuple(lines))

    def solved(self, solution: GroupSolution, solved: SolvedSystem) -> Iterator[Block]:
        """The system and its determinants."""
        system = solution.system
        unknowns = tuple(SPELLING.letter(letter) for letter in system.unknowns)
        if len(unknowns) == 1:
            return
        largest = float(np.nanmax(np.abs(solved.matrix)))
        matrix = tuple(tuple(self.short(x, largest) for x in row) for row in solved.matrix.tolist())
        right = [self.short(x, largest * self.fastest) for x in solved.right.tolist()]
        yield SystemBlock(matrix, unknowns, tuple(right))
        if system.determinant is None or system.numerators is None:
            return
        under = SPELLING.letter(solution.under)
        size = float(np.nanmax(np.abs([solved.determinant, *solved.numerators])))
        lines = [self.told(under, system.determinant, solved.determinant, size)]
        for letter, unknown, one, number in zip(
            system.unknowns, unknowns, system.numerators, solved.numerators, strict=True
        ):
            top = SPELLING.letter(Letter(0, f"Delta_{index_of(letter)}"))
            lines.append(self.told(top, one, float(number), size))
            above, below = self.short(float(number), size), self.numbers.math(solved.determinant)
            lines.append((unknown, f"frac({top}, {under})", f"frac({above}, {below})", self.value(letter)))
        yield FormulaBlock(tuple(lines))

    def told(self, left: str, formula: Equation, value: float, size: float) -> tuple[str, ...]:
        """A determinant, its formula with numbers where that can be read, its value."""
        inside = with_numbers(formula, self.values, self.numbers, differences_first=True)
        return (left, *([inside] if inside else []), self.short(value, size))

    def short(self, value: float, size: float) -> str:
        """A number beside others of a size; what is rounding of them is zero."""
        return self.numbers.math(value if abs(value) > NOTHING * size else 0.0)

    def rates(self, group: GroupEquations) -> Iterator[tuple[str, ...]]:
        """Cauchy's normal form with numbers."""
        for unknown, formula in zip(group.unknowns, group.normal_form or (), strict=False):
            inside = with_numbers(formula, self.values, self.numbers)
            if inside:
                yield SPELLING.letter(unknown.rate), inside, self.value(unknown.rate)

    def accelerations(self, group: GroupEquations) -> Iterator[tuple[str, ...]]:
        """Accelerations with numbers; of long formulas the numbers alone."""
        formulas = group.seconds.formulas or (None,) * len(group.unknowns)
        for unknown, formula in zip(group.unknowns, formulas, strict=True):
            inside = None if formula is None else with_numbers(formula, self.values, self.numbers)
            yield (
                SPELLING.letter(unknown.second),
                *([inside] if inside else []),
                self.value(unknown.second),
            )

    def velocity(self, point: str) -> Iterator[tuple[str, ...]]:
        """Components of a point's velocity, or that along its guide."""
        velocity, unit = self.study.equations.velocity(point), self.numbers.shown("m/s")[1]
        parts = (
            [(f"v_{point}", velocity.closed_along or velocity.along)]
            if velocity.along is not None
            else [
                (f"v_{point}x", velocity.closed_x or velocity.x),
                (f"v_{point}y", velocity.closed_y or velocity.y),
            ]
        )
        for name, formula in parts:
            value = self.instant.number(formula)
            inside = with_numbers(formula, self.values, self.numbers, turned=formula.single)
            number = f'{self.numbers.math(value)} thin "{unit}"'
            yield (SPELLING.letter(Letter(0, name)), *([inside] if inside else []), number)


def _check(study: ReportStudy, instant: Instant, moment: Moment) -> Block:
    """Rates and accelerations of the systems beside those of the motion in closed form."""
    rates = rates_compared(study.equations, instant, moment.data, moment.sample)
    worst = max(
        rates, key=lambda rate: abs(rate.solved - rate.closed) / max(rate.allowed, 1e-300), default=None
    )
    if worst is None:
        return ParagraphBlock(_("The motion in closed form has no rates to compare these with."))
    text = _(
        "The systems give the same rates and accelerations as the motion in closed form: the difference is at most "
        "{worst}, rounding and the condition of the systems allow {allowed} (rad or m, by s or s²)."
    )
    off = small(abs(worst.solved - worst.closed))
    return CheckBlock(
        text.format(worst=off, allowed=small(worst.allowed)), all(rate.agrees for rate in rates)
    )
