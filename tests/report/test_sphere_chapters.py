"""Chapters of linkages on the sphere: tables beside the thesis's closed form, checks that can fail."""

from __future__ import annotations

import math
import re
from collections.abc import Callable

import numpy as np
import pytest

import centrode as ct
from centrode.model.labels import place_words
from centrode.render.document.blocks import ChapterBlocks, CheckBlock, FormulaBlock, TableBlock
from centrode.report.chapters import CHAPTERS
from centrode.report.document import report
from centrode.report.study import ReportOptions, ReportStudy, settle_options
from report.texts import texts_of

SPHERE = ("data", "words", "structure", "equations", "tables", "plots", "rotatability", "axes")
AB, BC = math.pi / 12, math.pi / 4


def study_of(name: str, **wishes: object) -> ReportStudy:
    description = ct.example(name)
    return ReportStudy(description, settle_options(description, ReportOptions(full=True, **wishes), CHAPTERS))  # type: ignore[arg-type]


def tables_of(chapter: ChapterBlocks | None) -> list[TableBlock]:
    assert chapter is not None
    return [
        block for section in chapter.sections for block in section.blocks if isinstance(block, TableBlock)
    ]


def checks_of(chapter: ChapterBlocks | None) -> list[CheckBlock]:
    assert chapter is not None
    return [
        block for section in chapter.sections for block in section.blocks if isinstance(block, CheckBlock)
    ]


def number(text: str) -> float:
    return float(text.replace("−", "-"))


def half_unit(text: str) -> float:
    return 0.5 * 10.0 ** -len(text.partition(".")[2])


def test_the_table_is_that_of_the_closed_form() -> None:
    """cos BC = cos AB sin psi + sin AB cos psi sin beta, and psi' from its derivative (thesis, corrected)."""
    table = tables_of(CHAPTERS["tables"].make(study_of("spherical-crank-rocker")))[-1]
    assert len(table.rows) == 37
    rate = math.degrees(2.94)
    for beta_, _beta, _rate, psi_, speed_, *_hinges in table.rows:
        beta = math.radians(number(beta_))
        # a sin psi + b cos psi = cos BC
        a, b = math.cos(AB), math.sin(AB) * math.sin(beta)
        psi = math.pi - math.asin(math.cos(BC) / math.hypot(a, b)) - math.atan2(b, a)
        psi = min(psi, math.asin(math.cos(BC) / math.hypot(a, b)) - math.atan2(b, a))
        below = math.sin(AB) * math.sin(beta) * math.sin(psi) - math.cos(AB) * math.cos(psi)
        speed = rate * math.sin(AB) * math.cos(beta) * math.cos(psi) / below
        assert abs(number(psi_) - math.degrees(psi)) <= 1.0001 * half_unit(psi_)
        assert abs(number(speed_) - speed) <= 1.0001 * half_unit(speed_)


@pytest.mark.parametrize("name", ["spherical-crank-rocker", "spherical-crank-guide", "bevel-differential"])
def test_every_chapter_is_there(name: str) -> None:
    study = study_of(name)
    made = {key: CHAPTERS[key].make(study) for key in SPHERE}
    assert all(chapter is not None and not chapter.missing for chapter in made.values())
    assert all(one.holds for chapter in made.values() for one in checks_of(chapter))


def test_formulas_are_those_of_the_equations() -> None:
    chapter = CHAPTERS["equations"].make(study_of("spherical-crank-rocker"))
    assert chapter is not None
    lines = [
        line
        for section in chapter.sections
        for block in section.blocks
        if isinstance(block, FormulaBlock)
        for line in block.lines
    ]
    closure = ('cos italic("BC")', 'sin italic("AB") sin phi_(1) cos phi_(3) + cos italic("AB") sin phi_(3)')
    assert closure in lines


@pytest.mark.parametrize(
    ("variable", "wrong", "which"),
    [
        ("position", lambda values: values * (1.0 + 1e-12), 0),
        ("velocity", lambda values: values + 1e-8, 1),
    ],
)
def test_a_wrong_motion_is_found(
    variable: str, wrong: Callable[[np.ndarray], np.ndarray], which: int
) -> None:
    study = study_of("spherical-crank-rocker")
    study.motion[variable][...] = wrong(study.motion[variable].to_numpy())
    holds = [one.holds for one in checks_of(CHAPTERS["tables"].make(study))]
    assert holds[which] is False


def test_equations_that_are_not_written_fail_only_where_they_are_asked_for() -> None:
    chapter = CHAPTERS["equations"].make(study_of("bevel-differential"))
    assert chapter is not None and not chapter.missing
    options = ReportOptions(chapters=("equations",))
    (asked,) = report(ct.example("bevel-differential"), options, language="en").chapters
    assert asked.missing


def test_axes_are_those_of_hinges() -> None:
    """Crank and rocker turn about their pivots; the ends show from which side they turn counter-clockwise."""
    (table,) = tables_of(CHAPTERS["axes"].make(study_of("spherical-crank-rocker", instants=(1.0,))))
    rows = {row[0]: [number(cell) for cell in row[1:4]] for row in table.rows}
    assert rows["AB"] == [1.0, 0.0, 0.0]
    assert [abs(x) for x in rows["DC"]] == [0.0, 1.0, 0.0]
    assert abs(np.linalg.norm(rows["BC"]) - 1.0) <= 3 * 0.5e-4


def driven_by_an_arc() -> ct.Mechanism:
    """The slider C is driven along a great circle about D; it begins an eighth of a turn from the north."""
    return ct.Mechanism(
        space="sphere",
        frame={"points": {"A": [1, 0, 0], "D": [0, 1, 0]}},
        links={"AB": {"length": AB}, "BC": {"length": BC}},
        guides=[{"point": "C", "pole": "D", "radius": math.pi / 2}],
        drives=[{"guide": "C", "start": math.pi / 4, "speed": 1.0}],
        assembly={"sides": {"B": "left"}},
        study={"samples": 5},
    )


def test_the_value_of_a_drive_along_an_arc_is_an_angle() -> None:
    mechanism = driven_by_an_arc()
    made = report(mechanism, ReportOptions(chapters=("data", "tables")))
    found = texts_of(tuple(made.chapters))
    assert "0.7854\u202frad" in found
    assert "constant 1\u202frad/s" in found
    assert any(text.startswith("C = 0.7854\u202frad (45°)") for text in found)
    metres = [text for text in found if re.search(r"\d\u202fm(/s)?\b|, m(/s)?$", text)]
    assert metres == []
    motion = ct.motion(mechanism, at=[math.pi / 4])
    assert place_words(mechanism, motion, 0) == "C 0.785398163 rad (45 deg)"
