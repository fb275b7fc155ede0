"""The equations as text, LaTeX and Markdown: complete, balanced, and mathematics that a second reader understands."""

from __future__ import annotations

import re

import matplotlib.mathtext
import pytest

import centrode as ct
from centrode.model.examples import example_text
from centrode.render.document.blocks import TableBlock
from centrode.render.document.chapters import document_chapter
from centrode.render.document.numbers import Numbers
from centrode.render.latex import LatexSpelling, escape
from centrode.render.plain_formulas import split_at_signs
from centrode.topics.presentation import page
from centrode.views.equations import LONGEST, sheet
from equation_pages import formulas, rows

WIDTH = 110
"""Columns of a relation that can be broken."""
MINOR = re.compile(r"\\begin\{vmatrix\}(.+?)\\end\{vmatrix\}")
BREAK = r"\\"
SAMPLE = (
    "slider-between-cranks",
    "excavator-arm",
    "third-class-triad",
    "planetary-gear-train",
    "scissor-lift-cylinder",
)


@pytest.mark.parametrize("name", SAMPLE)
def test_every_formula_is_mathematics_to_matplotlib(name: str) -> None:
    mechanism = ct.example(name)
    found = ct.equations(mechanism, ct.equations(mechanism).board.moving[:3])
    parser = matplotlib.mathtext.MathTextParser("path")
    for text in formulas(found, LatexSpelling()):
        # what matplotlib spells otherwise
        known = text.replace(r"\text{", r"\mathrm{").replace(r"\lvert", "|").replace(r"\rvert", "|")
        known = MINOR.sub(lambda found: f"|{found[1].replace('&', ',').replace(BREAK, ';')}|", known)
        parser.parse(f"${known}$")


@pytest.mark.parametrize("name", SAMPLE)
def test_documents_are_balanced(name: str) -> None:
    found = ct.equations(ct.example(name))
    latex, markdown = page(found, "tex"), page(found, "md")
    for text in (latex, markdown):
        assert text.count("{") - text.count(r"\{") == text.count("}") - text.count(r"\}")
        assert text.count(r"\left(") == text.count(r"\right)")
        opened = re.findall(r"\\begin\{(.+?)\}", text)
        assert sorted(opened) == sorted(re.findall(r"\\end\{(.+?)\}", text))
    assert latex.startswith(r"\documentclass")
    assert latex.endswith("\\end{document}\n")
    assert markdown.count("$$") % 2 == 0
    headings = [line[3:] for line in markdown.splitlines() if line.startswith("## ")]
    assert headings == re.findall(r"\\subsection\*\{(.+?)\}", latex.replace(r"\_", "_"))


@pytest.mark.parametrize("name", SAMPLE)
def test_lines_of_text_are_broken_at_signs(name: str) -> None:
    text = ct.summary(ct.equations(ct.example(name)))
    long = [
        line for line in text.splitlines() if len(line) > WIDTH + 24 and not line.lstrip().startswith("|")
    ]
    assert long == []
    assert not any(line != line.rstrip() for line in text.splitlines())


def test_rows_hold_every_relation() -> None:
    found = ct.equations(ct.example("slider-between-cranks"), ["A", "C"])
    every = rows(found)
    assert ("Constraints", "y_C", "l₁ sin φ₁ + l₂ sin φ₂ = C₁") in every
    assert ("Symbols", "l₂", "1 m, A-C of link AC") in every
    assert ("Velocity of point A", "v_A", "l₁") in every
    text = ct.summary(found)
    assert all(left in text for _heading, left, _right in every)


def test_only_letters_that_are_used_are_explained() -> None:
    found = ct.equations(ct.example("slider-between-cranks"))
    symbols = {left for heading, left, _right in rows(found) if heading == "Symbols"}
    assert symbols == {
        *(f"φ{i}(0)" for i in "₁₂₃₄"), *(f"l{i}" for i in "₁₂₃₄"), *(f"C{i}" for i in "₁₂₃"),
        "x_D", "y_D",
    }  # fmt: skip


def test_units_of_the_description_are_shown() -> None:
    text = ct.summary(ct.equations(ct.example("excavator-arm")))
    assert re.search(r"l₃ += 620 mm +G-N of link GN", text)
    assert re.search(r"φ₁\(0\) += 10.3324 deg +angle of link boom", text)


def test_latex_shows_names_as_they_are() -> None:
    assert escape("a_b & 5 % \\ ~") == r"a\_b \& 5 \% \char92{} \char126{}"


def test_velocities_are_told_in_rates_and_put_in() -> None:
    found = ct.equations(ct.example("slider-between-cranks"), ["B"])
    lines = [line.strip() for line in ct.summary(found).splitlines()]
    start = lines.index("Velocity of point B")
    assert lines[start + 1 : start + 6] == [
        "x_B = x_D - l₄ cos φ₄",
        "y_B = y_D - l₄ sin φ₄",
        "v_Bx = ω₄ l₄ sin φ₄ = l₁ cos φ₃ sin φ₄ sin(t - φ₂)/(cos φ₂ sin(φ₃ - φ₄))",
        "v_By = -ω₄ l₄ cos φ₄ = l₁ cos φ₃ cos φ₄ sin(φ₂ - t)/(cos φ₂ sin(φ₃ - φ₄))",
        "v_B = l₄ |ω₄|",
    ]


@pytest.mark.parametrize("hostile", ["No 1.23456", "run 30 deg", "2.50 kg", "$x_1$", "<b>", "#a"])
def test_names_come_out_character_by_character(hostile: str) -> None:
    """In plain text, Markdown, LaTeX and the chapter of a document."""
    coupler = f'[links."{hostile}"]\npoints = ["A", "B"]'
    mechanism = ct.parse_mechanism(example_text("crank-rocker").replace("[links.AB]", coupler))
    found = ct.equations(mechanism)
    assert f"angle of link {hostile}\n" in ct.summary(found)
    assert f"| angle of link {hostile} |" in page(found, "md")
    assert f"& angle of link {escape(hostile)} " in page(found, "tex")
    chapter = document_chapter("equations", sheet(found), Numbers(mechanism.display))
    (symbols,) = [block for block in chapter.sections[0].blocks if isinstance(block, TableBlock)]
    assert f"angle of link {hostile}" in [row[2].replace(r"\$", "$") for row in symbols.rows]


def test_long_formulas_are_left_out_of_the_page_alone() -> None:
    found = ct.equations(ct.example("watt-driven-second-loop"))
    (group,) = found.groups
    assert group.seconds.formulas is not None
    longest = max(formula.size for formula in group.seconds.formulas)
    assert longest > LONGEST
    text = ct.summary(found)
    written = [one.second for one, formula in zip(group.unknowns, group.seconds.formulas, strict=True)
               if formula.size <= LONGEST]  # fmt: skip
    assert text.count("numerically, from") == len(group.unknowns) - len(written)
    assert r"$\varepsilon_{1}$: numerically" in page(found, "tex")


def test_groups_too_large_for_determinants_say_so() -> None:
    text = ct.summary(ct.equations(ct.example("scissor-lift-cylinder")))
    assert "too many terms to print" in text
    assert "ω₁: numerically, from the system of group IV(OC, AB, BE, CF, slider A)" in text


WIDE = """
[frame.points]
A = [2.2, 1.9]
F = [-1.6, -1.6]
[links.crank]
points = ["A", "B"]
length = 0.9
[links.rod]
points = ["B", "G"]
length = 3.1
[links.block]
points = { G = [0, 0], H = [0.9, 2.3] }
[links.lever]
points = { F = [0, 0], K = [1, 0.4] }
[[guides]]
point = "G"
on = "frame"
through = [0, 0]
direction = 0.7
link = "block"
angle = 0.3
[[guides]]
point = "H"
on = "lever"
through = [-0.8, 0.9]
direction = 0.2
[[drives]]
link = "crank"
start = 0.4
speed = 1
[assembly]
sides = { G = "behind", H = "ahead" }
"""


def test_a_matrix_that_no_line_holds_is_written_as_equations() -> None:
    lines = ct.summary(ct.equations(ct.parse_mechanism(WIDE))).splitlines()
    assert max(map(len, lines)) <= WIDTH + 24
    first = lines[lines.index("Velocities: Cramer's rule") + 1]
    assert first.startswith("  l₂ cos(φ₂ - β_G) ω₂ = ")
    assert any(" + (-a_H sin(" in line for line in lines)


def test_lines_are_broken_in_no_angle() -> None:
    assert split_at_signs("a = -(b sin(x - y) + c cos(u + 2 v))/(d - e) + f") == [
        "a = -(b sin(x - y) ",
        "+ c cos(u + 2 v))/(d ",
        "- e) ",
        "+ f",
    ]


def test_a_sign_goes_into_sines_of_differences_only() -> None:
    """Q lies beside the axis of its link: its angle is a sum, and sin(-phi - alpha) is nothing that one writes."""
    every = rows(ct.equations(ct.example("watt-six-bar"), ["Q"]))
    x = next(right for _heading, left, right in every if left == "v_Qx")
    assert x.startswith("-ω₃ l_DQ sin(φ₃ + α_DQ) = ")
    assert "(-" not in x
