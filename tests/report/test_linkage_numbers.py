"""Formulas of the derivation followed by their numbers: read back, they give the numbers that stand behind them."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest

import centrode as ct
from centrode.equations import instants
from centrode.equations.instants import instant_of, rates_compared
from centrode.locale import speaking
from centrode.render.document.blocks import (
    ChapterBlocks,
    CheckBlock,
    FormulaBlock,
    ParagraphBlock,
    SystemBlock,
)
from centrode.render.document.typst import TypstSpelling
from centrode.report.document import report
from centrode.report.study import ReportOptions
from equation_pages import Relation, System, entries
from report.typst_reading import TypstReader

EXAMPLES = (
    "slider-between-cranks", "slider-between-cranks-locked", "six-bar-press", "inverted-slider-crank",
    "rolling-wheel-rod", "geared-five-bar", "five-bar-two-drives", "oscillating-cylinder", "wiper", "shaper",
)  # fmt: skip
LETTERS = {"degree": math.pi / 180}
QUANTITY = re.compile(r'^(.*?) thin "(?P<unit>[^"]*)"(?: = .*)?$')
NUMBER = re.compile(r'-?"?\d[\d.,]*"?(?: dot\.op 10\^\(-?\d+\))?')
DIGITS = 12


def chapter(name: str, mechanism: ct.Mechanism, **wishes: object) -> ChapterBlocks:
    options = ReportOptions(chapters=(name,), digits=DIGITS, **wishes)  # type: ignore[arg-type]
    (found,) = report(mechanism, options, language="en").chapters
    assert not found.missing
    return found


def lines_of(found: ChapterBlocks) -> list[tuple[str, ...]]:
    return [
        line
        for section in found.sections
        for block in section.blocks
        if isinstance(block, FormulaBlock)
        for line in block.lines
    ]


def value_of(text: str) -> float:
    told = QUANTITY.match(text)
    return float(TypstReader(told[1] if told else text, LETTERS.__getitem__).sum())


@pytest.mark.parametrize("name", EXAMPLES)
def test_numbers_put_in_give_the_numbers_told(name: str) -> None:
    mechanism = ct.example(name)
    read = 0
    sections_with_numbers = [
        s for s in chapter("derivation", mechanism).sections if s.title.startswith("Numbers")
    ]
    assert sections_with_numbers
    for section in sections_with_numbers:
        for block in section.blocks:
            for line in block.lines if isinstance(block, FormulaBlock) else ():
                *inside, last = line[1:]
                value = value_of(last)
                for part in inside:
                    if "Delta" in part:
                        continue
                    terms = [abs(float(x)) for x in re.findall(r"\d+\.?\d*", part)]
                    # every number is rounded to so many digits, and enters with factors no greater than these
                    error = len(terms) * 10.0 ** (1 - DIGITS) * max(1.0, *terms) ** 3
                    assert value_of(part) == pytest.approx(value, rel=error, abs=error), line
                    read += 1
    assert read or name == "wiper"


def test_the_textbook_s_numbers() -> None:
    found = report(
        ct.example("slider-between-cranks"), ReportOptions(chapters=("derivation",), digits=3), language="en"
    ).chapters[0]
    quarter = found.sections[-1]
    told = {
        line[0]: line[-1]
        for block in quarter.blocks
        if isinstance(block, FormulaBlock)
        for line in block.lines
    }
    # what the assignment prints for t = pi/2; its velocities have three figures
    assert told["phi_(4)"] == '3.59 thin "rad"' and told["omega_(3)"] == '-0.411 thin "rad/s"'
    assert told["omega_(2)"] == '0 thin "rad/s"' and told["v_(C)"] == '-0.5 thin "m/s"'


def whole(line: tuple[str, ...]) -> tuple[str, ...]:
    """A determinant as it is and what it comes to; any other relation with all its parts."""
    return (line[0], line[-1]) if line[0].startswith("Delta") else line


def test_formulas_are_those_of_the_equations() -> None:
    for name in ("slider-between-cranks", "six-bar-press", "oscillating-cylinder"):
        mechanism = ct.example(name)
        equations = ct.equations(mechanism)
        page = list(entries(equations, TypstSpelling()))
        relations = [entry.parts for entry in page if isinstance(entry, Relation)]
        systems = [tuple(entry) for entry in page if isinstance(entry, System)]
        own = [chapter(key, mechanism) for key in ("equations", "derivation")]
        symbolic = [
            # positions have their values behind them
            line[:-1] if section.title.startswith("Positions in closed form, with") else line
            for part in own
            for section in part.sections
            if not section.title.startswith(("Numbers", "Positions with the numbers"))
            for block in section.blocks
            if isinstance(block, FormulaBlock)
            for line in block.lines
        ]
        # beside Cramer's rule documents have the first step of an expansion too; all its steps stand below
        assert [whole(line) for line in symbolic] == [whole(line) for line in relations]
        assert [x for x in symbolic if len(x) > 3] == [x for x in relations if len(x) > 3]
        assert len(relations) + len(systems) == len(page)
        told = [
            (b.matrix, b.unknowns, b.right)
            for part in own
            for s in part.sections
            if not s.title.startswith("Numbers")
            for b in s.blocks
            if isinstance(b, SystemBlock)
        ]
        assert told == systems


@pytest.mark.parametrize("name", ["six-bar-press", "slider-between-cranks", "geared-five-bar", "wiper"])
def test_each_rate_is_given_once(name: str) -> None:
    mechanism = ct.example(name)
    found = chapter("derivation", mechanism, instants=(mechanism.motion_parameter.drives[0].value_of(0.3),))
    numbers = next(section for section in found.sections if section.title.startswith("Numbers at"))
    lefts = [line[0] for block in numbers.blocks if isinstance(block, FormulaBlock) for line in block.lines]
    rates = [left for left in lefts if left.startswith("omega_")]
    assert rates
    assert len(set(rates)) == len(rates)


def test_angles_stand_in_degrees_where_these_are_shown() -> None:
    lines = lines_of(chapter("derivation", ct.example("six-bar-press")))
    rates = [line[-1] for line in lines if line[0] == "omega_(2)" and "rad/s" in line[-1]]
    assert rates
    for text in rates:
        radians, degrees = (float(x) for x in re.findall(r"(-?[\d.]+) thin", text))
        assert degrees == pytest.approx(math.degrees(radians), rel=10.0 ** (1 - DIGITS) * 10)
    assert any("degree" in part for line in lines for part in line)


def test_the_decimal_comma_is_a_word_of_mathematics() -> None:
    options = ReportOptions(chapters=("derivation",))
    for language in ("ru", "uk"):
        found = report(ct.example("six-bar-press"), options, language=language).chapters[0]
        texts = [part for line in lines_of(found) for part in line]
        assert not any(re.search(r"\d[.,]\d", re.sub(r'"[^"]*"', "", text)) for text in texts)
        assert any('"22,167°"' in text for text in texts)


def test_what_is_not_reached_has_no_numbers() -> None:
    mechanism = ct.example("slider-between-cranks-locked")
    found = chapter("derivation", mechanism, instants=(1.0, 3.0))
    *_symbolic, reached, beyond = found.sections
    assert any(isinstance(block, FormulaBlock) for block in reached.blocks)
    (only,) = beyond.blocks
    assert isinstance(only, ParagraphBlock) and "open" in only.text


def test_a_wrong_motion_is_noticed() -> None:
    mechanism = ct.example("six-bar-press")
    equations, motion = ct.equations(mechanism), ct.motion(mechanism, 5)
    instant = instant_of(equations, motion, 1)
    assert all(rate.agrees for rate in rates_compared(equations, instant, motion, 1))
    turned = motion.assign(angular_velocity=-motion["angular_velocity"])
    assert not all(rate.agrees for rate in rates_compared(equations, instant, turned, 1))


def test_checks_of_a_wrong_system_do_not_hold(monkeypatch: pytest.MonkeyPatch) -> None:
    right = np.linalg.solve

    def wrong(matrix: np.ndarray, side: np.ndarray) -> np.ndarray:
        return right(matrix, side) * (1 + 1e-9)

    def checks() -> list[bool]:
        found = report(ct.example("six-bar-press"), ReportOptions(chapters=("derivation",))).chapters[0]
        return [b.holds for s in found.sections for b in s.blocks if isinstance(b, CheckBlock)]

    with speaking("en"):
        assert checks() == [True]
        monkeypatch.setattr(instants.np.linalg, "solve", wrong)
        assert checks() == [False]
