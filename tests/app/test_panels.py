"""Panels: every topic of the registry has one that opens, in every language, and what it lacks is said."""

from __future__ import annotations

import json
import re

import pytest

from centrode.app.frames import read_frame
from centrode.app.panel_titles import shown_topics
from centrode.model.examples import example_text

from .test_screen_sentences import faults_of

EXAMPLES = {
    "region": "five-bar-two-drives",
    "simulate": "five-bar-pendulum",
    "equilibrium": "six-bar-press-run-up",
    "modes": "five-bar-pendulum",
    "cam-profile": "walking-wheel-four-legs",
    "roller-path": "cam-from-curvature",
    "path-routes": "cam-from-curvature",
    "walking-wheel": "walking-wheel-four-legs",
    "cam-contact": "walking-wheel-four-legs",
    "cam-choice": "walking-wheel-four-legs",
}
"""Topic -> a built-in description that it concerns, where that is none of the usual ones."""
USUAL = {"mechanism": "six-bar-press", "cam": "indexing-cam"}
WORDS = ("base radius", "pivot distance", "roller radius")


@pytest.mark.parametrize("topic", shown_topics(), ids=lambda topic: topic.name)
def test_every_panel_opens(ask, topic):
    """It has something to show, or a reason in words: never a fault of the program."""
    text = example_text(EXAMPLES.get(topic.name, USUAL[topic.subject]))
    scene = ask("read", text=text)["scene"]
    panel = ask("panel", text=text, topic=topic.name, samples=37, language="uk")
    panel = read_frame(panel)[0] if isinstance(panel, bytes) else panel
    said = json.dumps(panel, ensure_ascii=False)
    assert "error" not in panel, said
    assert faults_of(panel) == []
    if scene["topics"].get(topic.name) is True:
        assert panel.get("blocks") or panel.get("missing"), said
    else:
        assert panel["missing"]


def test_options_and_fields_are_named_in_the_language(ask):
    english, ukrainian = (
        {one["name"]: one for one in ask("hello", language=code)["topics"]} for code in ("en", "uk")
    )
    for name, topic in english.items():
        for option, other in zip(topic["options"], ukrainian[name]["options"], strict=True):
            assert option["name"] == other["name"] and option["label"] != other["label"]
    fields = ask("read", text=example_text("indexing-cam"), language="uk")["scene"]["dimensions"]
    assert not {field["name"] for field in fields if field["of"] in ("cam", "follower")} & set(WORDS)


WIDTH = re.compile(r'<svg[^>]*? width="([\d.]+)pt"')
LOOK = re.compile(r"none|currentColor|var\(--paper\)|light-dark\(#[0-9a-f]{6}, #[0-9a-f]{6}\)")
"""Colours that follow the screen."""


@pytest.mark.parametrize(
    ("name", "topic"), [("six-bar-press", "centres"), ("indexing-cam", "follower-motion")]
)
def test_pictures_have_the_edges_of_their_ground_and_commas(ask, name, topic):
    """At night names are no white spots, and a Russian picture has a decimal comma wherever it has a decimal."""
    panel = ask("panel", text=example_text(name), topic=topic, samples=37, language="ru")
    pictures = [block for block in panel["blocks"] if block["kind"] == "picture"]
    assert pictures
    for block in pictures:
        edges = set(
            re.findall(
                r'style="fill: ([^;"]+); stroke: \1; stroke-width: [\d.]+; stroke-linejoin: round',
                block["svg"],
            )
        )
        assert edges <= {"var(--paper)"}
        colours = set(re.findall(r"(?:fill|stroke): ([^;\"]+)", block["svg"]))
        assert len(colours) > 3
        assert all(LOOK.fullmatch(one) for one in colours)
        assert "#" not in "".join(re.findall(r' (?:fill|stroke)="([^"]+)"', block["svg"]))
        assert "DejaVuSans-2e" not in block["svg"]  # the full stop, among outlines of letters


@pytest.mark.parametrize("room", [240, 278, 420])
@pytest.mark.parametrize("topic", ["polygons", "diagrams", "centres"])
def test_pictures_are_no_wider_than_the_panel_has_room(ask, topic, room):
    """A drawing to scale takes a coarser scale, or a group stands above its polygon."""
    panel = ask("panel", text=example_text("six-bar-press"), topic=topic, samples=37, room=room)
    widths = [float(WIDTH.search(block["svg"])[1]) for block in panel["blocks"] if block["kind"] == "picture"]
    assert widths and max(widths) <= room


@pytest.mark.parametrize("room", [None, True, -1, "wide", 1e308, [], {}])
def test_a_room_that_is_none_is_that_of_a_document(ask, room):
    asked = {"text": example_text("crank-rocker"), "topic": "plan", "samples": 37}
    shown, usual = (ask("panel", **asked, **more)["blocks"] for more in ({"room": room}, {}))
    assert shown == usual


def test_what_is_wrong_names_no_option_of_the_command(ask):
    """A reason reads alike on the page and in the terminal."""
    text = example_text("six-bar-press")
    for topic in ("equilibrium", "modes"):
        panel = ask("panel", text=text, topic=topic, samples=37)
        assert "--" not in panel.get("missing", "") + panel.get("repair", "")
