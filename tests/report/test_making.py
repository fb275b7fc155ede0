"""Reports from descriptions: which chapters, in what order, by whose wishes, and what is told where one fails."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import centrode as ct
from centrode.errors import InputError, MotionError
from centrode.locale import choose_language, chosen_language
from centrode.render.document.blocks import ChapterBlocks
from centrode.report import document
from centrode.report.chapters import CHAPTERS, Kind
from centrode.report.study import ReportOptions, ReportStudy, settle_options

FOUR_BAR = """
title = "$x$ #panic(1)"
[frame.points]
O = [0, 0]
D = [4, 0]
[links.OA]
length = 1
[links.AB]
length = 3.5
[links.DB]
length = 3
[[drives]]
link = "OA"
start = 1
speed = 1
[assembly]
sides = { B = "left" }
[study]
instants = [2]
[report]
chapters = ["structure", "data"]
instants = ["1 rad", "90 deg"]
points = ["B"]
digits = 7
"""


def four_bar() -> ct.Mechanism:
    return ct.parse_mechanism(FOUR_BAR)


def test_a_description_has_wishes() -> None:
    mechanism = four_bar()
    assert ct.parse_mechanism(ct.mechanism_text(mechanism)) == mechanism
    wishes = settle_options(mechanism, ReportOptions(), CHAPTERS)
    assert wishes.chapters == ("structure", "data")
    assert wishes.instants == pytest.approx((1.0, 1.5707963267948966), rel=1e-15)
    assert (wishes.points, wishes.digits) == (("B",), 7)


def test_the_caller_s_wishes_go_first_and_the_study_s_last() -> None:
    asked = ReportOptions(("data",), (0.5,), ("A",), 3)
    assert settle_options(four_bar(), asked, CHAPTERS) == document.settle_options(four_bar(), asked, CHAPTERS)
    wishes = settle_options(four_bar(), asked, CHAPTERS)
    assert (wishes.chapters, wishes.instants, wishes.points, wishes.digits) == (("data",), (0.5,), ("A",), 3)
    bare = ct.parse_mechanism(FOUR_BAR.partition("[report]")[0])
    wishes = settle_options(bare, ReportOptions(), CHAPTERS)
    assert (wishes.chapters, wishes.instants, wishes.points, wishes.digits) == (None, (2.0,), None, 5)


def test_chapters_stand_in_the_order_of_the_document() -> None:
    made = ct.report(four_bar())
    assert [chapter.name for chapter in made.chapters] == ["data", "structure"]
    assert made.title == "$x$ #panic(1)"


def test_the_title_of_a_nameless_one() -> None:
    mechanism = ct.parse_mechanism(FOUR_BAR.replace('title = "$x$ #panic(1)"', ""))
    assert ct.report(mechanism, name="four-bar").title == "four-bar"


def test_a_report_speaks_its_language_and_leaves_the_other_alone() -> None:
    choose_language("en")
    made = ct.report(ct.example("slider-between-cranks"), ReportOptions(("data",)), language="uk")
    assert made.language == "uk"
    assert made.title == "Повзун між двома кривошипами"
    assert chosen_language() == "en"


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (ReportOptions(chapters=("date",)), 'there is no chapter "date"; did you mean "data"'),
        (ReportOptions(points=("Q",)), 'unknown point "Q"'),
        (ReportOptions(chapters=()), "chapters: no chapter is named; known are: synthesis, data"),
        (ReportOptions(digits=1), "the number of significant digits is 2 to 12, 1 is given"),
        (ReportOptions(digits=99), "the number of significant digits is 2 to 12"),
    ],
)
def test_wrong_wishes(options: ReportOptions, message: str) -> None:
    with pytest.raises(InputError, match=message):
        ct.report(four_bar(), options)


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("digits = 1", r"\[report\]: digits must lie between 2 and 12, got 1"),
        ("digits = 5.0", "must be a whole number"),
        ("digits = true", "must be a whole number"),
        ('points = ["Z"]', 'unknown point "Z"'),
        ('points = "A"', "expected a list"),
        ('chapters = [""]', "is not a name"),
        ('instants = ["1 kg"]', "report"),
        ("chapter = []", 'unknown key "chapter"; did you mean "chapters"'),
    ],
)
def test_wrong_wishes_of_a_description(line: str, message: str) -> None:
    with pytest.raises(InputError, match=message):
        ct.parse_mechanism(FOUR_BAR.partition("[report]")[0] + f"[report]\n{line}\n")


def test_a_mechanism_that_does_not_assemble_has_no_report() -> None:
    with pytest.raises(InputError):
        ct.report(ct.parse_mechanism(FOUR_BAR.replace("length = 3.5", "length = 0.5")))


def failing(study: ReportStudy) -> ChapterBlocks | None:
    raise MotionError("here", "it locks", "turn it back")


def silent(study: ReportStudy) -> ChapterBlocks | None:
    return None


def test_a_chapter_that_cannot_be_made_says_why_and_the_rest_is_there(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    kinds = {"structure": Kind("Bad", failing), "words": Kind("Quiet", silent), "data": CHAPTERS["data"]}
    monkeypatch.setattr(document, "CHAPTERS", kinds)
    said: list[tuple[str, int, int]] = []
    asked = ReportOptions(chapters=("structure", "data"))
    made = ct.report(four_bar(), asked, said=lambda *told: said.append(told))
    assert [(chapter.title, bool(chapter.missing)) for chapter in made.chapters] == [
        ("Bad", True),
        ("Data", False),
    ]
    assert made.chapters[0].missing == "here: it locks; turn it back"
    assert said == [("Bad", 0, 2), ("Data", 1, 2)]
    bare = ct.parse_mechanism(FOUR_BAR.partition("[report]")[0])
    assert [chapter.name for chapter in ct.report(bare).chapters] == ["structure", "data"]
    asked = ReportOptions(chapters=("words",))
    assert ct.report(bare, asked).chapters[0].missing == "the description has nothing for this chapter"


def test_what_is_computed_is_computed_once() -> None:
    study = ReportStudy(four_bar(), settle_options(four_bar(), ReportOptions(), CHAPTERS))
    assert study.motion is study.motion
    assert study.check is study.check
    calls: list[int] = []

    def fails() -> int:
        calls.append(1)
        raise MotionError("", "no")

    for _attempt in range(2):
        with pytest.raises(MotionError):
            study.once("fails", fails)
    assert calls == [1]


def test_every_chapter_is_told() -> None:
    page = (Path(__file__).parents[2] / "docs" / "report.md").read_text(encoding="utf-8")
    told = re.findall(
        r"^\| `([\w-]+)` \| ", page.partition("\n## Chapters")[2].partition("\n##")[0], re.MULTILINE
    )
    assert told == list(CHAPTERS)


def test_a_missing_centre_of_mass_fails_what_needs_it_alone() -> None:
    """Motion, tables and drawings need no masses; the others say what is missing."""
    text = (
        FOUR_BAR[: FOUR_BAR.index("[report]")]
        + """
samples = 9
[machine]
mean_speed = "60 rpm"
[[loads]]
kind = "torque"
link = "DB"
value = -2
"""
    )
    text = text.replace(
        "length = 3\n", "points = { D = [0, 0], B = [3, 0], E = [1, 1] }\nmass = 2\ninertia = 0.1\n"
    )
    made = ct.report(ct.parse_mechanism(text))
    reasons = {chapter.name: chapter.missing for chapter in made.chapters if chapter.missing}
    assert set(reasons) == {"reduction", "flywheel", "real-motion", "force-polygons", "balance"}
    assert all("[links.DB]: the position of its centre" in reason for reason in reasons.values())
    kept = {chapter.name for chapter in made.chapters} - set(reasons)
    assert {"tables", "plots", "graphic", "centres", "masses-and-loads", "checks"} <= kept
