"""Sentences of the workbench: they name a panel where a terminal names a command, and numbers have six digits."""

from __future__ import annotations

import pytest

from centrode.app.panel_titles import shown_topics, with_panel_titles
from centrode.locale import _, speaking
from centrode.model.examples import example_text
from centrode.render.spelling import PlainSpelling, ScreenSpelling
from centrode.sheets.texts import Number

MARKS = {"en": "“{}”", "ru": "«{}»", "uk": "«{}»"}
"""How a language quotes a title."""


@pytest.mark.parametrize("language", MARKS)
def test_a_command_is_named_by_its_panel(language):
    """Its title in the language, in its quotation marks, wherever it stands in the sentence."""
    titles = {topic.name: topic.title for topic in shown_topics()}
    with speaking(language):
        quoted = {name: MARKS[language].format(_(title)) for name, title in titles.items()}
        for name, title in quoted.items():
            assert with_panel_titles(f"see centrode {name}.") == f"see {title}."
        both = with_panel_titles("centrode limits, then centrode reactions")
        assert both == f"{quoted['limits']}, then {quoted['reactions']}"


@pytest.mark.parametrize(
    "sentence",
    [
        "no command here",
        "start centrode app",
        "centrode no-such-command",
        "a microcentrode limits it",
        "centrode",
        "fixed centrode {name}",
    ],
)
def test_what_is_no_panel_stays(sentence):
    assert with_panel_titles(sentence) == sentence


def test_a_repair_in_a_panel_names_a_panel(ask):
    """A mechanism that locks: what a terminal says of it, with a panel in place of the command, and no option."""
    panel = ask("panel", text=example_text("slider-between-cranks-locked"), topic="run", samples=13)
    said = str(panel["blocks"])
    assert "the mechanism locks" in said and "as “Rotatability” proposes" in said
    assert "centrode rotatability" not in said


@pytest.mark.parametrize(
    ("value", "digits", "shown"),
    [
        (1.234567890123, ".9g", "1.23457"),
        (-1234567.89, ".12g", "-1.23457e+06"),
        (2.0, ".9g", "2"),
        (0.25, ".3g", "0.25"),
        (1.23456789, ".4g", "1.235"),
        (1.23456789e-15, ".1e", "1.2e-15"),
    ],
)
def test_a_screen_shows_six_digits(value, digits, shown):
    """No more, and no more than the format has; files keep all of them."""
    number = Number(value, digits=digits)
    assert ScreenSpelling(None).text(number) == shown
    assert PlainSpelling(None).text(number) == format(value, digits)


def test_facts_of_a_panel_have_six_digits(ask):
    """The limits of a mechanism that locks, which a terminal writes with nine."""
    panel = ask("panel", text=example_text("slider-between-cranks-locked"), topic="limits", samples=37)
    said = str([block for block in panel["blocks"] if block["kind"] == "facts"])
    assert "1.79991" in said and "1.79991242" not in said
