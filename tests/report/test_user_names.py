"""Names are the user's: no report rounds a number in them, spells their units or sets their decimal mark."""

from __future__ import annotations

import pytest

import centrode as ct
from centrode.report.document import report
from centrode.report.study import ReportOptions
from report.texts import texts_of

CHAPTERS_WITH_NAMES = ("words", "rotatability", "centres")


def crank_rocker(crank: str) -> ct.Mechanism:
    return ct.Mechanism(
        frame={"points": {"O": [0, 0], "D": [4, 0]}},
        links={crank: {"points": ["O", "A"], "length": 1}, "AB": {"length": 3.5}, "DB": {"length": 3}},
        drives=[{"link": crank, "start": 0.5, "speed": 1}],
        assembly={"sides": {"B": "left"}},
        study={"samples": 13},
    )


@pytest.mark.parametrize("chapter", CHAPTERS_WITH_NAMES)
@pytest.mark.parametrize(
    ("name", "edited", "language"),
    [
        ("No 1.23456", "No 1.2346", "en"),
        ("run 30 deg", "run 30°", "en"),
        ("1e-3 x", "10⁻³ x", "en"),
        ("2.50 kg", "2,50 kg", "ru"),
        ("2.50 kg", "2,50 kg", "uk"),
    ],
)
def test_a_name_stands_in_a_report_as_it_is_written(
    name: str, edited: str, language: str, chapter: str
) -> None:
    made = report(crank_rocker(name), ReportOptions(chapters=(chapter,)), language=language)
    texts = texts_of(made.chapters)
    assert any(name in text for text in texts)
    assert not any(edited in text for text in texts)
