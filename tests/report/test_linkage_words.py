"""Vector equations, sentences and drawings of linkages in reports."""

from __future__ import annotations

import re

import numpy as np
import pytest

import centrode as ct
from centrode.model.mechanism import Display
from centrode.render.document.blocks import (
    ChapterBlocks,
    CheckBlock,
    FormulaBlock,
    Moving,
    ParagraphBlock,
    Picture,
    TableBlock,
)
from centrode.render.document.numbers import NARROW, Numbers
from centrode.render.document.scale import drawn_to_scale, scale_of
from centrode.render.document.spelling import DocumentSpelling
from centrode.render.document.vectors import symbol
from centrode.render.spelling import PlainSpelling
from centrode.report.document import report
from centrode.report.mathematics import check_formula
from centrode.report.pdf_document import Source, pdf_document
from centrode.report.study import ReportOptions
from centrode.sheets.texts import Joined, Number, VectorNotation

NUMBERS = Numbers(Display(), 5)
LINKAGES = (
    "data", "motion", "words", "structure", "equations", "derivation", "tables", "plots", "positions", "graphic",
    "centres", "integration", "rotatability",
)  # fmt: skip


def made(key: str, mechanism: ct.Mechanism, **wishes: object) -> ChapterBlocks:
    (found,) = report(mechanism, ReportOptions(chapters=(key,), **wishes), language="en").chapters  # type: ignore[arg-type]
    assert not found.missing
    return found


def blocks(found: ChapterBlocks, kind: type) -> list:  # type: ignore[type-arg]
    return [block for section in found.sections for block in section.blocks if isinstance(block, kind)]


@pytest.mark.parametrize(
    ("text", "parts"),
    [
        ("v_C = vʳ_C (∥ C)", ("arrow(v)_(C)", "arrow(v)_(C)^(r) ( parallel C )")),
        ("|v_A| = sin 61.352°", ("abs(v_(A))", "sin 61.352 degree")),
        ("|v_E − v_C| = 2", ("abs(arrow(v)_(E) - arrow(v)_(C))", "2")),
        ("ω_2 = -0.5·ω_1", ("omega_(2)", "- 0.5 dot.op omega_(1)")),
        ("△s2ab ∼ △S2AB", ('triangle "s2ab" tilde.op triangle "S2AB"',)),
    ],
)
def test_vector_equations(text: str, parts: tuple[str, ...]) -> None:
    spelling = DocumentSpelling(NUMBERS)
    assert tuple(spelling.mathematics(VectorNotation(part)) for part in text.split(" = ")) == parts


def test_rates_in_sentences() -> None:
    tried = Joined((Joined((VectorNotation("ω_OC"), Number(0.0)), " = "), VectorNotation("ε_AB")))
    assert DocumentSpelling(NUMBERS).text(tried) == '$omega_(italic("OC"))$ = 0, $epsilon_(italic("AB"))$'


def test_numbers_of_a_relation_fill_its_holes() -> None:
    relation = VectorNotation("|v_{{a}}| = sin {angle}°", angle=Number(64.0, "deg", ".5g"))
    assert PlainSpelling(Display()).text(relation) == "|v_{a}| = sin 64°"
    assert DocumentSpelling(NUMBERS).mathematics(VectorNotation("sin {a}°", a=Number(2.5, "deg"))) == (
        "sin 2.5 degree"
    )


def test_nothing_in_a_name_is_code() -> None:
    for name in ("#panic(1)", "a$b", "B'", "точка 1", '"', "\\", "`x`", "@ref", "//", "_", "a/b"):
        check_formula(symbol("v", name))
        check_formula(DocumentSpelling(NUMBERS).mathematics(VectorNotation(f"v_{name} = v_A (⊥ {name})")))


def test_what_stops_a_locking_mechanism_and_its_repair() -> None:
    found = made("rotatability", ct.example("slider-between-cranks-locked"))
    cells = [cell for table in blocks(found, TableBlock) for row in table.rows for cell in row]
    assert any("$sin(phi_(3) - phi_(4)) = 0$" in cell for cell in cells)
    assert any("OA = 1.7999 rad (103.13°)" in cell for cell in cells)
    titles = ["", "Transmission angles", "Repair", "Change of several dimensions"]
    assert [section.title for section in found.sections] == titles
    repair = found.sections[2]
    said = " ".join(block.text for block in repair.blocks if isinstance(block, ParagraphBlock))
    said = said.replace(NARROW, " ")
    assert "The mechanism locks at OA = 1.7999 rad (103.13°): CB and BD are collinear, extended" in said
    assert "initial angle of link CB 4.3 rad (246.37°) instead of 4.7 rad (269.29°)" in said
    assert "The transmission angle of every group stays at 20.7° or more." in said
    (schemes,) = (block for block in repair.blocks if isinstance(block, Picture))
    assert schemes.caption.replace(NARROW, " ").startswith(
        "Kinematic schemes at OA = 1.7999 rad (103.13°): a) in the dead position; b) repaired: initial angle of link AC"
    )
    assert all(check.holds for check in blocks(found, CheckBlock)) and blocks(found, CheckBlock)
    turning = made("rotatability", ct.example("six-bar-press"))
    assert [section.title for section in turning.sections] == ["", "Transmission angles"]


def test_the_drawing_agrees_with_the_closed_forms_and_says_how_far() -> None:
    found = made("graphic", ct.example("six-bar-press"))
    assert all(check.holds for check in blocks(found, CheckBlock)) and len(blocks(found, CheckBlock)) == 1
    lines = [line for block in blocks(found, FormulaBlock) for line in block.lines]
    assert ("arrow(v)_(H)", 'arrow(v)_(D) + arrow(v)_(italic("HD")) ( perp italic("HD") )') in lines
    table = blocks(found, TableBlock)[-1]
    drawn, integrated, closed = (table.head.index(word) for word in ("drawn", "integrated", "closed form"))
    rates = [row for row in table.rows if "ω" in row[0] or "v_" in row[0]]
    assert rates and all(row[drawn] == row[integrated] == row[closed] for row in rates)
    assert all(row[drawn] == row[closed] and row[integrated] == "—" for row in table.rows if row not in rates)


def test_an_instant_that_is_not_reached_is_said_to_be_so() -> None:
    mechanism = ct.example("slider-between-cranks-locked")
    for key in ("graphic", "centres", "tables"):
        found = made(key, mechanism, instants=(3.0,))
        section = next(section for section in found.sections if section.title.startswith("OA = 3"))
        (only,) = section.blocks
        assert isinstance(only, ParagraphBlock) and "open" in only.text


def test_a_point_of_the_frame_has_no_velocity_to_be_told() -> None:
    with pytest.raises(ct.InputError, match='point "O" does not move'):
        report(ct.example("crank-rocker"), ReportOptions(points=("B", "O")), language="en")


@pytest.mark.drawn
def test_drawings_keep_their_scale() -> None:
    figure = ct.figures(ct.plan_of_positions(ct.example("slider-between-cranks")))["plan"]
    written = [text.get_text() for axes in figure.axes for text in axes.texts]
    scale = float(next(re.search(r"= ([\d.]+) m", text)[1] for text in written if "mu" in text))  # type: ignore[index]
    assert scale_of(figure) == pytest.approx(scale, rel=1e-12)
    shown = drawn_to_scale(figure, "Plan", 160.0, 134.0)
    assert shown.to_scale and 3.0 < shown.width <= 160.0 / 25.4
    width = float(re.search(rb'width="([\d.]+)pt"', shown.svg)[1])  # type: ignore[index]
    assert width == pytest.approx(72 * shown.width, abs=1e-5)
    # of what stood beside the drawing nothing is left
    assert not [text for axes in figure.axes[:1] for text in axes.texts if text.get_position()[0] >= 160.0]


@pytest.mark.drawn
def test_pictures_repeat() -> None:
    options = ReportOptions(chapters=("positions", "graphic"))
    one, other = (report(ct.example("crank-rocker"), options, language="en") for _time in range(2))
    for first, second in zip(one.chapters, other.chapters, strict=True):
        assert [p.svg for p in blocks(first, Picture)] == [p.svg for p in blocks(second, Picture)]


def test_the_motion_comes_after_the_data() -> None:
    made_of = report(ct.example("crank-rocker"), ReportOptions(chapters=("motion", "data")), language="en")
    assert [chapter.name for chapter in made_of.chapters] == ["data", "motion"]
    (moving,) = blocks(made_of.chapters[1], Moving)
    assert moving.places["B"].shape[1] == 2 and np.isfinite(moving.places["B"]).all()


NAMES = """
title = '$x$ #panic(1) <script> \\\\ "q" `c` @r [b] *s* _u_ // /* 50 %'
[frame.points]
"точка O" = [0, 0]
"D_1'" = [4, 0]
[links."a b-c"]
points = ["точка O", "A x"]
length = 1
[links."_u_ it"]
points = { "A x" = [0, 0], "B-1" = [3.5, 0], "P’" = [1, 1] }
[links."rocker _"]
points = ["D_1'", "B-1"]
length = 3
[[drives]]
link = "a b-c"
start = 0.3
law = "2*t"
[assembly]
sides = { "B-1" = "left" }
[study]
start = 0
stop = 3
samples = 9
instants = [0.5]
[report]
points = ["B-1", "P’"]
"""


@pytest.mark.drawn
def test_names_of_all_kinds_are_shown_as_they_are() -> None:
    mechanism = ct.parse_mechanism(NAMES)
    drawn = set(LINKAGES) - {"plots"}
    for language, chapters in (("en", drawn), ("ru", {"data", "words", "derivation", "tables"})):
        found = report(mechanism, ReportOptions(chapters=tuple(chapters)), language=language)
        assert not [chapter.missing for chapter in found.chapters if chapter.missing]
        assert {chapter.name for chapter in found.chapters} == chapters
        Source(found)  # every formula is looked at for code
    document = pdf_document(
        report(mechanism, ReportOptions(chapters=("data", "derivation", "graphic")), language="en")
    )
    assert document.startswith(b"%PDF")
