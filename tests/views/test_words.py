"""Words about mechanisms: what they say is so, of every example, in every language."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings

import centrode as ct
from centrode.render.spelling import PlainSpelling
from centrode.sheets.sheet import Paragraph
from centrode.views.words import moving_parts, sheet
from growing import descriptions, mechanism_of
from mechanisms import four_bar
from samples import examples_at_hand

WORKED = """\
The mechanism has 6 links: the frame and 5 moving links (OA, AC, CB, BD, slider C). Hinged to the frame: OA in O, \
BD in D. Hinged to each other: OA and AC in A, CB and BD in B. A slider, hinged to AC and CB in C, moves along a fixed \
horizontal guide.

Crank OA is driven: it turns about O at a constant 1 rad/s. Coupler AC reciprocates the slider in C along its \
guide; its stroke is 1.279 m. Coupler CB passes the motion on to rocker BD, which swings about D through 29.7°.

The mobility is 1: one drive determines the position of every link. The drive can turn fully."""


def words_of(mechanism: ct.Mechanism) -> str:
    """The paragraphs of a mechanism as plain text, a blank line between them."""
    spelling = PlainSpelling(mechanism.display)
    blocks = sheet(ct.principle_of_operation(mechanism)).printed
    return "\n\n".join(spelling.text(block.text) for block in blocks if isinstance(block, Paragraph))


@pytest.fixture(autouse=True)
def english() -> Iterator[None]:
    ct.choose_language("en")
    yield
    ct.choose_language("en")


def test_the_worked_example() -> None:
    assert words_of(ct.example("slider-between-cranks")) == WORKED
    motion = ct.motion(ct.example("slider-between-cranks"), 2001)
    assert f"{np.ptp(motion.slide.to_numpy()):.4g}" == "1.279"
    assert f"{math.degrees(np.ptp(motion.angle.sel(link='BD').to_numpy())):.3g}" == "29.7"


def test_a_machine_runs_at_its_mean_speed() -> None:
    """65 rpm of the machine, not the rate of 1 rad/s by which the motion is computed."""
    text = words_of(ct.example("six-bar-press"))
    assert "Crank OA is driven: it turns about O at a mean speed of 65 rpm." in text
    assert "57.3" not in text
    alone = ct.example("six-bar-press").model_copy(update={"machine": None})
    assert "it turns about O at a constant 57.3 deg/s." in words_of(alone)


@pytest.mark.parametrize("name", examples_at_hand(ct.example_names()))
def test_every_example_is_told_in_whole_sentences(name: str) -> None:
    mechanism = ct.example(name)
    text = words_of(mechanism)
    assert len(text.split("\n\n")) == 3
    assert not re.search(r"[{}]|\bnan\b|None|  | ,|\.\.|e-\d\d", text)
    assert all(paragraph.endswith(".") for paragraph in text.split("\n\n"))
    for part in moving_parts(mechanism):
        assert PlainSpelling(mechanism.display).text(part) in text
    for point in mechanism.moving_points:
        joined = sum(point in link.coordinates for link in mechanism.links.values())
        assert joined < 2 or re.search(rf"\bin {re.escape(point)}\b", text), point
    for drive in mechanism.drives:
        assert text.count("is driven") == len(mechanism.drives), drive.id


@settings(max_examples=25)
@given(descriptions())
def test_random_mechanisms_are_told_in_whole_sentences(parts: dict[str, Any]) -> None:
    mechanism = mechanism_of(parts)
    text = words_of(mechanism)
    assert not re.search(r"[{}]|\bnan\b|None|  | ,|\.\.|e-\d\d", text)
    assert all(name in text for name in mechanism.link_names)


@pytest.mark.parametrize("language", ["ru", "uk"])
@pytest.mark.parametrize(
    "name", ["six-bar-press", "excavator-arm", "planetary-gear-train", "third-class-triad"]
)
def test_every_language_has_the_same_names(name: str, language: str) -> None:
    mechanism = ct.example(name)
    ct.choose_language(language)
    text = words_of(mechanism)
    assert not re.search(r"[{}]", text)
    assert all(link in text for link in mechanism.link_names)


def test_cranks_and_rockers_are_told_by_their_motion() -> None:
    rocker = four_bar(1.0, 3.5, 3.0, 4.0)
    assert "rocker DB, which swings about D through 40°" in words_of(rocker)
    # extreme positions of a rocker: crank and coupler in line
    ends = [math.acos((3**2 + 4**2 - (3.5 + sign) ** 2) / (2 * 3 * 4)) for sign in (1, -1)]
    assert f"{math.degrees(ends[0] - ends[1]):.3g}" == "40"
    assert "crank DB, which turns fully about D" in words_of(four_bar(3.0, 3.5, 4.0, 1.0))
    locking = words_of(four_bar(3.0, 1.5, 3.0, 4.0, drives=[{"link": "OA", "start": 0.5, "speed": 1.0}]))
    assert "link DB, which turns about D" in locking
    assert "The drive cannot turn fully; it stops at " in locking
    assert "AB and DB are collinear" in locking


@pytest.mark.parametrize(
    ("name", "sentence"),
    [
        ("elliptic-trammel", "The slider in A is driven along its guide at a constant 0.1 m/s."),
        ("excavator-arm", 'Cylinder K-A swings link "boom" about O through 34°.'),
        ("five-bar-two-drives", "AB is hinged to OA in A, CB to EC in C."),
        (
            "geared-five-bar",
            "Links OA and EC are geared: EC turns in the ratio 2 to OA, in the opposite sense.",
        ),
        (
            "oscillating-cylinder",
            'Link "rod" slides along link "cylinder" and swings it about D through 29°.',
        ),
        ("planetary-hypocycloid", 'Wheel "planet" rolls without slip inside a fixed circle.'),
        ("rack-and-pinion", 'Wheel "pinion" rolls without slip on a straight track of link "rack".'),
        ("scissor-lift", 'The slider in E moves along link "platform", which does not turn.'),
        ("rack-and-pinion", 'Link "pinion" is driven: it turns about O at a constant 30 rpm.'),
        ("rack-and-pinion", 'Link "rack" moves along its guide by 125.7 mm in total.'),
        ("rolling-wheel-rod", "Coupler PB moves the slider in B along its guide, by 1885 mm in total."),
        ("geared-five-bar", "Crank OA is driven"),
        ("three-crank-parallelogram", "FE, hinged in F and E, is passive: without it"),
        ("scotch-yoke", 'Link "yoke" reciprocates along its guide; its stroke is 1 m.'),
        ("shaper", 'The slider in A moves along link "lever" and swings it about D through 60°.'),
        ("spherical-crank-guide", "A slider, hinged to BC in C, moves along a fixed circle."),
        ("third-class-triad", 'Links AB, "platform", DC and EF form a group of class III: their positions'),
        (
            "three-crank-parallelogram",
            "Redundant constraints (their dimensions have to be consistent with the others): ",
        ),
        ("two-link-arm", "Link AB is driven relative to link OA at a constant 2 rad/s."),
        ("whitworth-quick-return", 'The slider in A moves along link "lever" and turns it fully about D.'),
        ("wiper", "Link OA is driven: it turns about O by a given law."),
    ],
)
def test_sentences_of_all_kinds(name: str, sentence: str) -> None:
    assert sentence in words_of(ct.example(name))


def test_lengths_and_angles_are_in_the_units_asked_for() -> None:
    millimetres = ct.example("slider-between-cranks").model_copy(
        update={"display": ct.example("scissor-lift").display}
    )
    assert "its stroke is 1279 mm" in words_of(millimetres)
