"""What rotatability says: sentences of typed causes, names of users character by character, files of the command."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import centrode as ct
from centrode.analysis.redesign.results import rotatability_results
from centrode.analysis.rotatability.causes import AngleCondition, AngleSymbol, Cause, CauseKind, Tracer
from centrode.analysis.rotatability.circuits import LoopType, Uncounted
from centrode.locale import _, choose_language
from centrode.model.examples import example_text
from centrode.model.settings import Display
from centrode.render.document.chapters import document_chapter
from centrode.render.document.numbers import Numbers
from centrode.render.spelling import PlainSpelling
from centrode.topics.kinematics import ROTATABILITY
from centrode.views.rotatability import cause_text
from report.texts import texts_of
from turning import recorded

HOSTILE = ("No 1.23456", "run 30 deg", "2.50 kg", "$x_1$", "<b>", "#a")
LOCKED = "slider-between-cranks-locked"


@pytest.mark.parametrize("language", ["en", "ru", "uk"])
def test_every_cause_has_a_sentence_in_every_language(language: str) -> None:
    """With the names of its bodies or its points; no two causes have the same."""
    choose_language(language)
    sentences = set()
    for kind in CauseKind:
        bodies = ((Tracer.LINK, "alpha"), (Tracer.GUIDE, "beta"))
        cause = Cause(kind, bodies, ("gamma", "delta"), stretched=True, distance=0.25)
        if kind == CauseKind.ARC_SQUARE:
            cause = Cause(kind, bodies, ("gamma", "delta"))
        said = PlainSpelling(Display()).text(cause_text(cause))
        assert "{" not in said and said not in sentences
        alone = kind in (CauseKind.TURNS_BACK, CauseKind.POSITIONS_MEET)
        assert alone != bool(re.search("alpha|beta|gamma|delta", said))
        assert language == "en" or re.search("[а-яії]{3}", said)
        sentences.add(said)
    for vocabulary in (LoopType, Uncounted):
        words = [_(one.word) for one in vocabulary]
        assert len(set(words)) == len(words) and all(words)
    choose_language("en")


def test_conditions_have_their_signs_and_constants() -> None:
    first, last = AngleSymbol("phi", "3"), AngleSymbol("psi", "KA")
    assert str(AngleCondition("sin", (first,), (last,))) == "sin(phi3 - psi_KA) = 0"
    assert str(AngleCondition("cos", (first,), (), -0.25)) == "cos(phi3 - 0.25) = 0"
    assert str(AngleCondition("cos", (first, last), (), 0.5)) == "cos(phi3 + psi_KA + 0.5) = 0"


@pytest.mark.parametrize(("other", "hostile"), list(zip(HOSTILE[::2], HOSTILE[1::2], strict=True)))
def test_names_come_out_character_by_character(other: str, hostile: str, tmp_path: Path) -> None:
    """Of the two links that fall in line: on the terminal, in the record and in the document, with the repair."""
    text = example_text(LOCKED).replace("[links.BD]", f'[links."{hostile}"]\npoints = ["B", "D"]')
    text = text.replace("[links.CB]", f'[links."{other}"]\npoints = ["C", "B"]')
    mechanism = ct.parse_mechanism(text)
    assert {other, hostile} <= set(mechanism.link_names)
    found = rotatability_results(mechanism, complete=True)
    assert found.repair is not None and found.repair.found
    rotatability = ct.rotatability(mechanism)
    printed = ct.summary(rotatability)
    assert (
        f"{other} and {hostile} are collinear, extended (distance of C and D: 2 m): sin(phi3 - phi4) = 0"
        in printed
    )
    assert f"driven at {hostile}: " in printed and f"loop frame-{hostile}-{other}-C" in printed
    assert f"\nlinks.{hostile}.angle  " in ct.summary(found.repair)
    data = recorded(rotatability, tmp_path)
    assert data["limits"][0]["cause"].startswith(f"{other} and {hostile} are collinear, extended")
    assert data["limits"][0]["condition"] == "sin(phi3 - phi4) = 0"
    for language, line in (("en", "are collinear"), ("ru", ""), ("uk", "")):
        choose_language(language)
        chapter = document_chapter("rotatability", ROTATABILITY.view(found), Numbers(mechanism.display))
        cells = [text.replace(r"\$", "$") for text in texts_of((chapter,))]
        assert any(
            other in text and hostile in text and "phi_(3) - phi_(4)" in text and line in text
            for text in cells
        )
        assert any(f"links.{hostile}.angle" in text for text in cells)
    choose_language("en")


def test_lengths_of_a_record_are_in_si(tmp_path: Path) -> None:
    """Whatever the display says: what is printed in millimetres is written in metres."""
    arm = ct.rotatability(ct.example("excavator-arm"))
    assert "(distance of O and K: 710.634 mm)" in ct.summary(arm)
    data = recorded(arm, tmp_path)
    assert data["limits"][0]["cause"].endswith("(distance of O and K: 0.710634 m)")
    assert data["four_bars"][0]["inequality"].startswith("1.04426 m > 1.02407 m: ")
