"""Chapters on forces: their numbers beside the seeds' print, formulas read back, checks that can fail."""

from __future__ import annotations

import re
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

import centrode as ct
from blank_canvas import blank_pictures
from centrode.dynamics import link_motions, reduction_results
from centrode.render.document.blocks import (
    ChapterBlocks,
    CheckBlock,
    FormulaBlock,
    ParagraphBlock,
    Picture,
    TableBlock,
)
from centrode.report.chapters import CHAPTERS
from centrode.report.document import report
from centrode.report.study import ReportOptions, ReportStudy, settle_options
from report.typst_reading import TypstReader

FORCES = (
    "masses-and-loads", "reduction", "flywheel", "real-motion", "reactions", "force-polygons", "balance"
)  # fmt: skip
DIGITS = 12
UNIT = re.compile(r' thin "[^"]*"$')
LETTER = re.compile(r'[A-Za-z](?!\w*")')


def made(name: str, chapters: tuple[str, ...], language: str = "en", **wishes: object) -> list[ChapterBlocks]:
    options = ReportOptions(chapters=chapters, **wishes)  # type: ignore[arg-type]
    return list(report(ct.example(name), options, language=language).chapters)


def blocks_of(chapter: ChapterBlocks, kind: type) -> list:
    return [block for section in chapter.sections for block in section.blocks if isinstance(block, kind)]


def value_of(part: str) -> float | None:
    """The value of a part that holds numbers only."""
    text = UNIT.sub("", part)
    if LETTER.search(re.sub(r"frac|dot\.op|\bpi\b", "", text)) or "dots" in text:
        return None
    return float(TypstReader(text, {"pi": np.pi}.__getitem__).sum())


@pytest.fixture(scope="module")
def press() -> dict[str, ChapterBlocks]:
    with blank_pictures():
        return {chapter.name: chapter for chapter in made("six-bar-press-printed", FORCES, digits=DIGITS)}


@pytest.fixture(scope="module")
def corrected() -> dict[str, ChapterBlocks]:
    with blank_pictures():
        return {chapter.name: chapter for chapter in made("six-bar-press", FORCES)}


def study_of(name: str) -> ReportStudy:
    """A study whose chapters nobody chose."""
    description = ct.example(name)
    return ReportStudy(description, settle_options(description, ReportOptions(), CHAPTERS))


def line(chapter: ChapterBlocks, left: str, nth: int = -1) -> tuple[str, ...]:
    found = [one for block in blocks_of(chapter, FormulaBlock) for one in block.lines if one[0] == left]
    return found[nth]


@pytest.mark.parametrize(
    ("chapter", "left", "printed", "half", "nth"),
    [
        ("reduction", "J", 12.962, 0.0005, -1),
        ("reduction", "M", -6100.0, 50.0, -1),
        ("flywheel", "A_upright(c)", -14220.0, 5.0, 0),
        ("flywheel", "M_upright(d)", 2263.0, 0.5, 0),
        ("flywheel", "J_upright(I)", 1462.0, 0.5, 0),
        ("flywheel", "J_upright(f)", 1459.0, 3.0, 0),  # exactly, where the sheet is to first order
    ],
)
def test_numbers_of_the_coursework(
    press: dict[str, ChapterBlocks], chapter: str, left: str, printed: float, half: float, nth: int
) -> None:
    value = value_of(line(press[chapter], left, nth)[-1])
    assert value is not None and abs(value - printed) <= half


def test_numbers_put_in_give_the_numbers_told(press: dict[str, ChapterBlocks]) -> None:
    read = 0
    for name in ("reduction", "flywheel", "reactions"):
        for block in blocks_of(press[name], FormulaBlock):
            for one in block.lines:
                values = [value for part in one[1:] if (value := value_of(part)) is not None]
                for first, second in pairwise(values):
                    # each number is rounded to DIGITS, sums lose what their terms have more
                    size = max(map(abs, values), default=0.0) + 1e4 * (name == "reactions")
                    assert abs(first - second) <= 20 * size * 10.0 ** (1 - DIGITS), one
                    read += 1
    assert read >= 8


def test_all_checks_hold(corrected: dict[str, ChapterBlocks]) -> None:
    engine = made("single-cylinder-engine", ("reduction", "reactions", "force-polygons"))
    found = [one for chapter in (*corrected.values(), *engine) for one in blocks_of(chapter, CheckBlock)]
    assert len(found) >= 15
    assert [one.text for one in found if not one.holds] == []


def test_primes_belong_to_letters_and_not_to_their_indices() -> None:
    (chapter,) = made("six-bar-press", ("reduction",))
    formulas = [
        block for section in chapter.sections for block in section.blocks if isinstance(block, FormulaBlock)
    ]
    parts = [part for block in formulas for line in block.lines for part in line]
    assert any("v'_(" in part for part in parts)
    assert not [part for part in parts if re.search(r"_\([^()]*\)'", part)]


def test_a_wrong_sum_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    motions = link_motions.motions_of_links

    def off(*args: object) -> list[link_motions.LinkMotion]:
        first, *others = motions(*args)  # type: ignore[arg-type]
        return [replace(first, turning=first.turning * (1.0 + 1e-9)), *others]

    monkeypatch.setattr(reduction_results, "motions_of_links", off)
    (chapter,) = made("six-bar-press", ("reduction",))
    assert not blocks_of(chapter, CheckBlock)[0].holds


def test_centres_of_mass_beside_the_line_of_their_link() -> None:
    """The sums by links know centres that are no points: beside the reduction, which goes another way."""
    press = ct.example("six-bar-press")
    text = ct.mechanism_text(press).replace('centre = "S4"', "centre = [0.6, 0.25]")
    options = ReportOptions(chapters=("reduction",), instants=(0.3, 2.0))
    (chapter,) = report(ct.parse_mechanism(text), options, language="en").chapters
    checks = blocks_of(chapter, CheckBlock)
    assert len(checks) == 4 and all(one.holds for one in checks)


@pytest.mark.drawn
def test_several_drives_and_laws_have_their_chapters() -> None:
    text = """
[frame.points]
A = [0, 0]
E = [1, 0]
[links.AB]
length = 0.5
mass = 1
shape = "rod"
[links.BC]
length = 1
mass = 2
shape = "rod"
[links.DC]
points = ["D", "C"]
length = 1
[links.ED]
length = 0.5
[[drives]]
link = "AB"
start = "60 deg"
law = "1 + 0.3*sin(t)"
[[drives]]
link = "ED"
start = "100 deg"
law = "2 + 0.2*sin(t)"
[assembly]
sides = { C = "left" }
[study]
samples = 5
to = 3
"""
    chapters = report(
        ct.parse_mechanism(text),
        ReportOptions(chapters=("reduction", "reactions"), instants=(0.5,)),
        language="en",
    ).chapters
    found = {chapter.name: chapter for chapter in chapters}
    assert not found["reduction"].missing and not found["reactions"].missing
    assert any(section.title.startswith("t = 0.5") for section in found["reactions"].sections)


def test_what_is_not_there_is_left_out_or_told() -> None:
    assert made("crank-rocker", ("data",))[0].name == "data"
    study = study_of("crank-rocker")
    assert [CHAPTERS[name].make(study) for name in FORCES] == [None] * len(FORCES)
    (asked,) = made("crank-rocker", ("reactions",))
    assert asked.missing


def test_reactions_that_cannot_be_had_fail_only_where_they_are_asked_for() -> None:
    name = "spherical-crank-rocker"
    told = CHAPTERS["reactions"].make(study_of(name))
    assert told is not None and not told.missing
    assert "plain sum" in blocks_of(told, ParagraphBlock)[0].text
    (asked,) = made(name, ("reactions",))
    assert "plain sum" in asked.missing


def test_decimals_and_minus_signs_of_the_language() -> None:
    english = re.compile(r"\d\.\d")
    ascii_minus = re.compile(r"(?<![\w–])-\d")
    for chapter in made("six-bar-press", ("reduction", "flywheel"), "ru"):
        for table in blocks_of(chapter, TableBlock):
            cells = [cell for row in table.rows for cell in row if "$" not in cell]
            assert not [cell for cell in cells if english.search(cell) or ascii_minus.search(cell)]


def test_names_of_users_are_no_mathematics() -> None:
    text = ct.mechanism_text(ct.example("six-bar-press")).replace("slider", "$x$ #a")
    text = text.replace("links.$x$ #a", 'links."$x$ #a"')
    chosen = ReportOptions(chapters=("masses-and-loads", "reduction"))
    made_ = report(ct.parse_mechanism(text), chosen, language="en")
    cells = [
        cell
        for chapter in made_.chapters
        for table in blocks_of(chapter, TableBlock)
        for row in table.rows
        for cell in row
        if "#a" in cell
    ]
    assert cells and all(r"\$x\$ #a" in cell for cell in cells)


def test_force_polygons_fit_between_the_margins(corrected: dict[str, ChapterBlocks]) -> None:
    drawings = blocks_of(corrected["force-polygons"], Picture)
    assert len(drawings) == 4
    assert all(one.width * 25.4 <= 170.0 for one in drawings)  # so that they are not scaled down


CLOSING = "M_upright(b) + J_upright(I) epsilon"


def test_reports_close_the_balance_of_the_drive() -> None:
    """In the real motion, by default: balancing moment of the links + J_I epsilon = driving moment (seeds, 2)."""
    with blank_pictures():
        found = {one.name: one for one in made("six-bar-press", FORCES, digits=DIGITS, instants=("120 deg",))}
    for name in ("real-motion", "reactions", "force-polygons"):
        _left, with_numbers, total = line(found[name], CLOSING)
        links, taken = with_numbers.split(" + ")
        inertia, acceleration = taken.split(" dot.op ")
        # along the crank's angle, which falls: the coursework counts as the crank turns
        assert float(links) == pytest.approx(-6310.25, abs=0.005), name
        assert float(inertia) == pytest.approx(1459.23, abs=0.005)
        assert float(acceleration) == pytest.approx(2.7735, abs=0.00005)
        assert value_of(total) == pytest.approx(-2263.0, abs=0.05)
        assert value_of(line(found[name], "M_upright(d)")[-1]) == pytest.approx(-2263.0, abs=0.05)
    checks = [one for one in blocks_of(found["reactions"], CheckBlock) if "driving moment" in one.text]
    assert len(checks) == 2 and all(one.holds for one in checks)
    (check,) = (one for one in blocks_of(found["force-polygons"], CheckBlock) if "driving moment" in one.text)
    assert check.holds


@pytest.mark.parametrize("motion", ["mean", None])
def test_a_description_chooses_the_motion_of_the_forces(motion: str | None) -> None:
    text = ct.mechanism_text(ct.example("six-bar-press"))
    wish = f'[report]\nmotion = "{motion}"\n' if motion else ""
    mechanism = ct.parse_mechanism(text + wish)
    with blank_pictures():
        options = ReportOptions(chapters=("reactions", "force-polygons"), motion=None if motion else "mean")
        chapters = report(mechanism, options).chapters
    for chapter in chapters:
        said = str(chapter)
        assert "the mean speed of the machine" in said and CLOSING not in said
    assert mechanism.report.motion == motion


def test_a_machine_with_friction_by_coefficients_has_the_mean_motion() -> None:
    text = ct.mechanism_text(ct.example("six-bar-press"))
    rubbed = (
        text + '[[loads]]\nkind = "friction"\npoint = "A"\nlink = "AB"\ncoefficient = 0.1\nradius = 0.01\n'
    )
    description = ct.parse_mechanism(rubbed)
    study = ReportStudy(description, settle_options(description, ReportOptions(), CHAPTERS))
    assert study.motion_of_forces == "mean"
    chosen = ReportStudy(description, settle_options(description, ReportOptions(motion="real"), CHAPTERS))
    assert chosen.motion_of_forces == "real" and "reactions" in chosen.study.refusals


def test_another_motion_of_forces_is_refused() -> None:
    with pytest.raises(ct.InputError, match="is not a motion of the drive"):
        settle_options(ct.example("six-bar-press"), ReportOptions(motion="fast"), CHAPTERS)  # type: ignore[arg-type]
    text = ct.mechanism_text(ct.example("six-bar-press")) + '[report]\nmotion = "fast"\n'
    with pytest.raises(ct.InputError, match=r"(?s)\[report\].*motion.*real"):
        ct.parse_mechanism(text)
