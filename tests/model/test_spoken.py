"""Names that results have in English, in the language of the reader; what a user named stays."""

from __future__ import annotations

from typing import Any

import pytest

import centrode as ct
from centrode.locale import LANGUAGES, speaking
from centrode.model.labels import body_name
from centrode.render.spelling import PlainSpelling
from centrode.sheets.texts import Text
from centrode.views.load_names import KINDS, load_text
from centrode.views.reaction_names import contact_text, side_text

PRESS = ct.example("six-bar-press")
FRAME = {"en": "frame", "ru": "стойка", "uk": "стояк"}
SAID = {
    ("ru", "weight AB"): "вес AB",
    ("ru", "weight AB 2"): "вес AB 2",
    ("uk", "weight AB"): "вага AB",
    ("ru", "force H"): "сила H",
}


def said(text: Text) -> str:
    """A text of a sheet as a terminal prints it."""
    return PlainSpelling(PRESS.display).text(text)


def named(name: str) -> ct.Mechanism:
    load: dict[str, Any] = {"kind": "force", "name": name, "point": "A", "vector": [1, 0]}
    return ct.Mechanism(
        frame={"points": {"O": [0, 0]}},
        links={"OA": {"length": 1}, "slider C": {"points": {"A": [0, 0], "B": [1, 0]}}},
        drives=[{"link": "OA", "speed": 1}, {"link": "slider C", "speed": 2}],
        loads=[load],
    )


@pytest.mark.parametrize(("language", "label"), SAID)
def test_loads_without_a_name(language: str, label: str) -> None:
    with speaking(language):
        assert said(load_text(PRESS, label)) == SAID[language, label]


@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize("name", ["friction A", "weight AB", "load", "force"])
def test_names_of_users_stay(language: str, name: str) -> None:
    with speaking(language):
        assert said(load_text(named(name), name)) == name
        assert said(load_text(named(name), f"{name} 2")) == f"{name} 2"
        assert body_name(named(name), "slider C") == "slider C"


@pytest.mark.parametrize("language", LANGUAGES)
def test_bodies_and_sides(language: str) -> None:
    with speaking(language):
        assert body_name(PRESS, "frame") == FRAME[language]
        assert body_name(PRESS, "slider") == "slider"
        assert said(side_text("O/frame")) == f"O/{FRAME[language]}"
        for label in ("O/OA", "guide 1/OA", "gear/slider C"):
            assert said(side_text(label)) == said(contact_text(label)) == label


@pytest.mark.parametrize("language", LANGUAGES)
def test_english_is_what_results_have(language: str) -> None:
    """In English labels stay; in other languages none of their words does."""
    for label in ("guide H", "gear H", "slider H", *(f"{kind} H" for kind in KINDS)):
        with speaking(language):
            names = {said(contact_text(label)), body_name(PRESS, label), said(load_text(PRESS, label))} - {
                label
            }
        assert len(names) == (language != "en")
        assert all(one.endswith(" H") and not one[:-1].isascii() for one in names)


def test_gears_and_wheels_have_words() -> None:
    with speaking("ru"):
        assert said(contact_text("x_C")) == "x_C"
        assert said(contact_text("gear sun-planet")) == "зубчатая передача sun-planet"
        assert said(contact_text("rolling wheel")) == "колесо wheel"
