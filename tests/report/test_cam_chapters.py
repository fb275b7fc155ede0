"""Chapters of cams: the printed table of the paper, checks that can fail, what the cam cannot do."""

from __future__ import annotations

import csv
from dataclasses import replace
from pathlib import Path

import pytest

import centrode as ct
from centrode.cams.cam import roller_path_results
from centrode.model.examples.catalogue import load_cam
from centrode.render.document.blocks import ChapterBlocks, CheckBlock, FormulaBlock, Moving, TableBlock
from centrode.render.document.chapters import document_chapter
from centrode.report.chapters import CHAPTERS
from centrode.report.study import ReportOptions, ReportStudy, settle_options
from centrode.topics.presentation import sheet_of

PRINTED = Path(__file__).parents[1] / "reference" / "cam-curvature-table.csv"
CAM = ("data", "motion", "path", "series", "routes", "profile", "walking", "contact")


def study_of(name: str, **wishes: object) -> ReportStudy:
    description = load_cam(name)
    return ReportStudy(description, settle_options(description, ReportOptions(**wishes), CHAPTERS))  # type: ignore[arg-type]


def blocks_of(chapter: ChapterBlocks | None, kind: type) -> list:
    assert chapter is not None
    return [block for section in chapter.sections for block in section.blocks if isinstance(block, kind)]


@pytest.fixture(scope="module")
def wheel() -> ReportStudy:
    return study_of("walking-wheel-four-legs")


def test_the_table_of_routes_is_the_printed_one() -> None:
    """The paper prints the series cut after a_20: route (a), to the last digit of its radii."""
    with PRINTED.open(encoding="utf-8") as file:
        printed = {float(row["phi_deg"]): row for row in csv.DictReader(file)}
    study = study_of("cam-from-curvature")
    table = blocks_of(CHAPTERS["routes"].make(study), TableBlock)[-1]
    shown = {float(row[0]): row for row in table.rows if float(row[0]) in printed}
    assert len(shown) >= 5
    for angle, row in shown.items():
        assert row[1] == printed[angle]["rho_mm"]


@pytest.mark.drawn
def test_every_chapter_is_there_and_its_checks_hold(wheel: ReportStudy) -> None:
    made = {key: CHAPTERS[key].make(wheel) for key in CAM}
    assert all(chapter is not None and not chapter.missing for chapter in made.values())
    checks = [one for key in CAM for one in blocks_of(made[key], CheckBlock)]
    assert len(checks) >= 6 and all(one.holds for one in checks)
    assert len(blocks_of(made["motion"], Moving)) == 1
    assert all(blocks_of(made[key], FormulaBlock) for key in CAM[2:])


def test_chapters_of_linkages_are_none_of_cams(wheel: ReportStudy) -> None:
    others = set(CHAPTERS) - {*CAM, "choice", "conclusions"}
    assert [key for key in sorted(others) if CHAPTERS[key].make(wheel) is not None] == []


def test_a_wrong_path_is_found(wheel: ReportStudy) -> None:
    assert isinstance(wheel.description, ct.Cam)
    results = roller_path_results(wheel.description)
    data = results.dataset.copy(deep=True)
    data["pressure_sine"] = data["pressure_sine"] * (1.0 + 1e-9)
    chapter = document_chapter("path", sheet_of(replace(results, dataset=data)), wheel.numbers)
    assert [one.holds for one in blocks_of(chapter, CheckBlock)] == [False]


def test_a_cam_that_stalls_says_so() -> None:
    cam = load_cam("cam-from-curvature")
    longer = cam.model_copy(update={"range": cam.range.model_copy(update={"stop": 3.0})})
    study = ReportStudy(longer, settle_options(longer, ReportOptions(), CHAPTERS))
    failed = [one for one in blocks_of(CHAPTERS["path"].make(study), CheckBlock) if not one.holds]
    assert len(failed) == 1 and "stalls" in failed[0].text


def test_tables_stand_at_the_instants_that_are_asked_for() -> None:
    study = study_of("cam-from-curvature", instants=(0.0, 0.5, 1.0))
    table = blocks_of(CHAPTERS["routes"].make(study), TableBlock)[-1]
    assert len(table.rows) == 3
