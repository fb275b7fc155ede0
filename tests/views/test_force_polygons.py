"""The sheet of forces by hand: several instants, instants without forces, names of users and of the program."""

from __future__ import annotations

import math

import pytest

import centrode as ct
from centrode.dynamics.force_polygons.results import ForcePolygonResults, force_polygon_results
from centrode.dynamics.force_polygons.statics import StaticJoint
from centrode.dynamics.force_polygons.steps import (
    EquationOutcome,
    MomentsOfGroup,
    MomentsOfLink,
    MomentUnknown,
)
from centrode.locale import speaking
from centrode.model.examples import example_text
from centrode.model.settings import Display
from centrode.render.document import blocks
from centrode.render.document.chapters import document_chapter
from centrode.render.document.numbers import Numbers
from centrode.render.document.spelling import DocumentSpelling
from centrode.render.spelling import PlainSpelling
from centrode.sheets.sheet import Formula
from centrode.sheets.texts import NOTHING
from centrode.topics.dynamics import FORCE_POLYGONS
from centrode.views.force_equations import step_equations
from centrode.views.force_polygons import step_text

TORQUE = """
[[loads]]
kind = "torque"
link = "{link}"
value = 3
"""


def loaded(name: str, link: str) -> ct.Mechanism:
    """An example with a moment on one link."""
    return ct.parse_mechanism(example_text(name) + TORQUE.format(link=link))


def chapter_of(results: ForcePolygonResults) -> blocks.ChapterBlocks:
    numbers = Numbers(results.mechanism.display)
    return document_chapter("force-polygons", FORCE_POLYGONS.view(results), numbers)


def test_parts_of_several_instants_are_numbered() -> None:
    press = ct.example("six-bar-press")
    results = force_polygon_results(press, ["30 deg", math.pi / 2])
    sheet = FORCE_POLYGONS.view(results)
    pages = ("group-1", "group-2", "group-3", "lever")
    assert list(sheet.tables) == ["polygons-1", "polygons-2"]
    assert list(sheet.pictures) == [f"{page}-{number}" for number in (1, 2) for page in pages]
    printed = ct.summary(results).splitlines()
    # a text is shown as it was written, a number in the units of the display
    assert [line for line in printed if line.startswith("at ")] == ["at 30 deg", "at 90 deg"]


@pytest.mark.parametrize(
    ("name", "link", "at", "there", "status"),
    [
        ("parallelogram", "DB", 1.0, math.pi, "singular"),
        ("slider-between-cranks-locked", "BD", 1.5, 2.5, "open"),
    ],
)
def test_an_instant_without_forces_is_said_in_its_place(
    name: str, link: str, at: float, there: float, status: str
) -> None:
    mechanism = loaded(name, link)
    with pytest.raises(ct.MotionError, match=status):
        force_polygon_results(mechanism, instants=[at, there])
    with pytest.raises(ct.MotionError, match=status):
        force_polygon_results(mechanism, instants=[there], complete=False)
    results = force_polygon_results(mechanism, instants=[at, there], complete=False)
    assert [found is None for found in results.polygons] == [False, True]
    assert list(ct.tables(results)) == ["polygons-1"]
    (said,) = chapter_of(results).sections[-1].blocks
    assert isinstance(said, blocks.ParagraphBlock)
    assert said.text == f"The mechanism is {status} there: no finite forces keep it in equilibrium."


@pytest.mark.parametrize("hostile", ["No 1.23456", "2.50 kg", "$x_1$", "pin A", "<b>"])
def test_links_of_any_name_are_called_by_it(hostile: str) -> None:
    text = ct.mechanism_text(ct.example("six-bar-press"))
    text = text.replace('"slider"', f'"{hostile}"').replace("links.slider", f'links."{hostile}"')
    results = force_polygon_results(ct.parse_mechanism(text), ["120 deg"], "A5")
    assert f"Group 4, 5 (RRP): DH, {hostile}" in ct.summary(results)
    assert f"5 {hostile}" in ct.summary(results)
    titles = [
        block.text
        for block in chapter_of(results).sections[1].blocks
        if isinstance(block, blocks.ParagraphBlock)
    ]
    assert f"Group 4, 5 (RRP): DH, {hostile}." in [title.replace(r"\$", "$") for title in titles]


def test_a_slider_has_a_word_of_the_language() -> None:
    """The names of results stay English, so that files are the same for every reader."""
    mechanism = loaded("scotch-yoke", "OA")
    with speaking("ru"):
        results = force_polygon_results(mechanism, [0.8])
        assert "ползун" in ct.summary(results) and "slider" not in ct.summary(results)
    (found,) = results.polygons
    assert found is not None and any(name.startswith("slider ") for name in found.names)


def test_a_chapter_has_every_step_and_its_drawings_to_scale() -> None:
    results = force_polygon_results(ct.example("six-bar-press"), ["120 deg"], "A5")
    (found,) = results.polygons
    assert found is not None
    parts = chapter_of(results).sections[1].blocks
    formulas = [block for block in parts if isinstance(block, blocks.FormulaBlock)]
    sums = [one for one in formulas if one.lines[0][0].startswith("sum M") and one.lines[0][-1] == "0"]
    moments = [
        step
        for group in found.groups
        for step in group.steps
        if isinstance(step, MomentsOfLink | MomentsOfGroup) and getattr(step, "unknown", None) is not None
    ]
    assert len(sums) == len(moments) + len(found.levers)
    drawings = [block for block in parts if isinstance(block, blocks.Picture)]
    assert len(drawings) == len(found.groups) + len(found.levers)
    for group, drawing in zip(found.groups, drawings, strict=False):
        assert f"$mu_F$ = {group.polygon.scale:g} N/mm" in drawing.caption
    checks = [block for block in parts if isinstance(block, blocks.CheckBlock)]
    assert checks and all(check.holds for check in checks)


@pytest.mark.parametrize(("arm", "shown"), [(-0.25, "R12ᵗ·(-0.25)"), (0.25, "R12ᵗ·0.25")])
def test_a_negative_arm_is_in_brackets(arm: float, shown: str) -> None:
    joint = StaticJoint("hinge", "B", {"AB": 1.0}, 0j, ())
    step = MomentsOfLink(2, joint, MomentUnknown("R12ᵗ", arm), (), EquationOutcome("R12ᵗ", 3.0))
    assert PlainSpelling(Display()).text(step_text(step)).startswith(f"moments of link 2 about B: {shown}")
    formula = next(one for one in step_equations(step, NOTHING) if isinstance(one, Formula))
    spelled = DocumentSpelling(Numbers(Display(), 5)).mathematics(formula.lines[0][-2])
    assert spelled.endswith("dot.op (-0.25)" if arm < 0 else "dot.op 0.25")
