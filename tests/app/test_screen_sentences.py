"""Sentences of the workbench name nothing that only a terminal has: no option, no command, no call of Python."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from string import Formatter

import pytest
from tools import catalogues

import centrode.locale
from centrode.app.panel_titles import with_panel_titles
from centrode.app.screen_sentences import SCREEN_SENTENCES
from centrode.model.examples import example_text

TERMINAL = re.compile(
    r"(?<![\w-])--[a-z]|\bcentrode (?!\d)[a-z]|\bct\.|\bPython\b|\boption\b|\bcommand\b|\bterminal\b|\w\(\)"
)
"""What names an option, a command or a call."""
OUTSIDE = (
    "cli/",
    "notebook/",
    "sweeps/",
    "assignments/",
    "files/",
    "report/",
    "animation/",
    "chains/",
    "tools/",
)
"""Rooms whose sentences do not reach the workbench: commands, what it does not compute, what documents hold."""
OF_THE_TERMINAL = {
    # they speak to whoever has started the program
    "No workbench runs at this address. Open the address that centrode app prints.",
    "write the built-in mechanism first: centrode examples {name} --out {name}.toml",
    "choose another one, or leave the option out",
    # the workbench gives no such option
    "omit --laws, or use centrode.cams.followers.motion.compare_laws",
    "omit --compile: importers compile the source",
    "name a netCDF file that a command has written",
    "Also write an animation: one centrode rolls on the other.",
    "the list is long: --out writes it into a folder",
    "{line}, or the option {option}",
}
"""Sentences that are about a terminal, or never reach the page."""
WORDS_OF_THE_FIELD = {"there is no centrode in this range", "the connection to centrode is lost"}
"""Centrode as the curve, and as the program."""


def holes(sentence: str) -> set[str]:
    """Names of the holes of a sentence; none where the braces are a piece of TOML."""
    return {name for _text, name, _spec, _turn in Formatter().parse(sentence) if name}


def sentences_of_the_workbench() -> Iterator[str]:
    """Every sentence of the catalogues that a room within its reach has."""
    for message in catalogues.sentences(catalogues.read("en")):
        rooms = [place.removeprefix("src/centrode/") for place, _line in message.locations]
        # values of fields are read as those of options are
        if not all(room.startswith(OUTSIDE) and room != "cli/option_values.py" for room in rooms):
            yield from catalogues.forms(message.id)


def test_every_sentence_about_a_terminal_has_one_for_the_screen() -> None:
    """None is forgotten: what is neither in the table nor an exception by name names nothing of a terminal."""
    found = [
        sentence
        for sentence in sentences_of_the_workbench()
        if TERMINAL.search(with_panel_titles(SCREEN_SENTENCES.get(sentence, sentence)))
    ]
    assert set(found) - OF_THE_TERMINAL - WORDS_OF_THE_FIELD == set()


def test_the_table_has_sentences_of_the_code_alone() -> None:
    """A sentence that was changed in the code is changed here too, and its version fills no hole that it has not."""
    known = set(sentences_of_the_workbench())
    assert set(SCREEN_SENTENCES) - known == set()
    for sentence, version in SCREEN_SENTENCES.items():
        assert holes(version) <= holes(sentence)
        assert version != sentence


def said_by(answer: object) -> Iterator[str]:
    """All texts of an answer, but for pictures and formulas, which no catalogue has."""
    if isinstance(answer, dict):
        for key, value in answer.items():
            if key not in ("svg", "mathml"):
                yield from said_by(value)
    elif isinstance(answer, list):
        for value in answer:
            yield from said_by(value)
    elif isinstance(answer, str):
        yield answer


def faults_of(answer: object) -> list[str]:
    """Texts of an answer that name something of a terminal."""
    if isinstance(answer, bytes):  # the header of a frame, in front of numbers or of a file
        answer = json.loads(answer[4 : 4 + int.from_bytes(answer[:4], "little")])
    return [text for text in said_by(answer) if TERMINAL.search(text) and text not in WORDS_OF_THE_FIELD]


TOPICS = (
    "run",
    "limits",
    "region",
    "centres",
    "reduce",
    "simulate",
    "reactions",
    "rotatability",
    "equations",
)
"""Whose sheets say what to do. All topics of usual descriptions are opened in `test_panels`."""


@pytest.mark.parametrize(
    "name", ["five-bar-two-drives", "spherical-four-bar", "slider-between-cranks-locked"]
)
def test_no_panel_names_an_option(ask, name):  # type: ignore[no-untyped-def]
    text = example_text(name)
    assert faults_of({**ask("read", text=text), "text": ""}) == []
    for topic in TOPICS:
        assert faults_of(ask("panel", text=text, topic=topic, samples=7, options={"samples": 5})) == []


PRESS, LOCKED = example_text("six-bar-press"), example_text("slider-between-cranks-locked")
SHAFT = "[frame.points]\nO = [0, 0]\n\n[links]\nOA = { length = 1.0 }\n\n[[drives]]\nlink = 'OA'\n"
REFUSALS = [
    ("panel", {"text": PRESS, "topic": "simulate"}),
    ("panel", {"text": PRESS, "topic": "simulate", "options": {"steps": 10}}),
    ("panel", {"text": PRESS, "topic": "simulate", "options": {"duration": "1 s", "turns": 2, "steps": 10}}),
    ("panel", {"text": PRESS, "topic": "rotatability", "options": {"greatest_change": 0.1}}),
    ("panel", {"text": LOCKED, "topic": "rotatability"}),
    ("panel", {"text": PRESS, "topic": "integrate", "options": {"tolerance": 1e-9, "method": "rk4"}}),
    ("panel", {"text": PRESS, "topic": "centres", "options": {"pair": "OA,OA"}}),
    ("panel", {"text": PRESS, "topic": "centrodes", "options": {"against": "OA", "link": "OA"}}),
    ("panel", {"text": PRESS, "topic": "region", "options": {"drive": "OA"}}),
    ("panel", {"text": PRESS, "topic": "limits", "options": {"hold": "OA"}}),
    ("panel", {"text": PRESS, "topic": "modes", "options": {"equilibrium": 99}}),
    ("panel", {"text": PRESS, "topic": "reactions", "options": {"speed": "1 rad/s"}}),
    ("panel", {"text": PRESS, "topic": "balance", "options": {"density": "1", "thickness": ""}}),
    ("panel", {"text": PRESS, "topic": "balance", "options": {"weights": "1,1,1"}}),
    ("panel", {"text": PRESS, "topic": "tolerances", "options": {"output": "nothing"}}),
    ("panel", {"text": example_text("five-bar-two-drives"), "topic": "reduce"}),
    ("motion", {"text": example_text("five-bar-two-drives")}),
    ("motion", {"text": SHAFT}),
    ("motion", {"text": f"{SHAFT}law = 't**2'\n"}),
    ("motion", {"text": f"{SHAFT}law = 't**2'\n\n[study]\nrange = 'reachable'\n"}),
    ("read", {"text": f"kind = 'cam'\n{PRESS}"}),
    ("read", {"text": f"kind = 'gear pair'\n{PRESS}"}),
    ("read", {"text": f"kind = 'gear train'\n{PRESS}"}),
    ("read", {"text": f"{PRESS}\n[synthesis]\nkind = 'path'\n"}),
    ("read", {"text": f"{SHAFT}cam = 'no-such-cam'\n"}),
    ("example", {"name": "nothing of this name"}),
    ("import", {"url": "https://example.org"}),
    ("export", {"text": PRESS, "topic": "fmu", "format": "fmu", "options": {}}),
    ("export", {"text": example_text("five-bar-two-drives"), "topic": "code", "format": "c", "options": {}}),
    ("hello", {}),
]


@pytest.mark.parametrize("language", ["en", "uk"])
@pytest.mark.parametrize(("do", "message"), REFUSALS)
def test_no_refusal_names_an_option(ask, language, do, message):  # type: ignore[no-untyped-def]
    answer = ask(do, language=language, samples=7, **message)
    answer = {**answer, "text": ""} if isinstance(answer, dict) else answer
    if isinstance(answer, dict):
        assert "this is an error in centrode" not in json.dumps(answer)
    assert faults_of(answer) == []


def test_a_terminal_keeps_its_options() -> None:
    """The versions are those of the workbench alone, and a report that it writes is a document as any other."""
    with centrode.locale.speaking("en", SCREEN_SENTENCES):
        assert centrode.locale._("add --repair") == "tick the field that seeks the smallest change"
        with centrode.locale.speaking("en"):
            assert centrode.locale._("add --repair") == "add --repair"
    assert centrode.locale._("add --repair") == "add --repair"


def test_a_field_takes_several_values_with_semicolons(ask) -> None:  # type: ignore[no-untyped-def]
    """What the two pairs have in common is said once, what is of each stands in both panels."""
    both, *single = (
        ask("panel", text=PRESS, topic="centres", options={"pair": pair, "at": "30 deg"})
        for pair in ("OA,frame; DH,frame", "OA,frame", "DH,frame")
    )
    rows = [
        {str(row) for block in panel["blocks"] if block["kind"] == "table" for row in block["rows"]}
        for panel in (both, *single)
    ]
    assert rows[1] - rows[2] and rows[2] - rows[1]
    assert rows[0] == rows[1] | rows[2]


@pytest.mark.parametrize(
    "text", ["", "\n", "# nothing yet\n", "[frame.points]\nO = [0, 0]\n", "[frame.points]\n\n[links]\n"]
)
def test_a_text_that_nobody_has_begun_is_told_how(ask, text):  # type: ignore[no-untyped-def]
    """A user who draws is asked for a link, not for a key."""
    (problem,) = ask("read", text=text)["problems"]
    assert problem["message"] == "there are no links" and problem["repair"].startswith("draw one")
    assert ask("motion", text=text)["repair"] == problem["repair"]


def test_a_text_that_is_too_long_has_a_repair(ask):  # type: ignore[no-untyped-def]
    error = ask("read", text="#" * 300_001)["error"]
    assert "300001" in error["message"] and error["repair"] == "shorten it"
