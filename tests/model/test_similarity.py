"""Descriptions that are moved as a whole: their motions are similar, and what has no similar one is named."""

from __future__ import annotations

import cmath
import math

import numpy as np
import pytest

import centrode as ct
from centrode.model.similarity import Similarity, apply_similarity

DOUBLED = Similarity(2 * cmath.exp(1j * math.radians(30)), 0.7 - 1.3j)
MECHANISMS = [
    "crank-rocker", "jansen-leg", "watt-six-bar", "third-class-triad", "shaper", "scotch-yoke", "excavator-arm",
    "oscillating-cylinder", "rolling-wheel-rod", "rack-and-pinion", "planetary-gear-train", "geared-five-bar",
    "five-bar-two-drives", "elliptic-trammel", "whitworth-quick-return", "slider-between-cranks",
]  # fmt: skip


def places(motion) -> np.ndarray:
    return motion.position.to_numpy() @ np.array([1, 1j])


@pytest.mark.parametrize("name", MECHANISMS)
def test_positions_are_those_of_the_similarity(name: str) -> None:
    mechanism = ct.example(name)
    moved = apply_similarity(mechanism, DOUBLED)
    wanted = DOUBLED.factor * places(ct.motion(mechanism, 37)) + DOUBLED.shift
    got = places(ct.motion(moved, 37))
    assert np.abs(got - wanted).max() < 1e-12 * np.abs(wanted).max()
    # the file that is written of it is the same
    assert ct.parse_mechanism(ct.mechanism_text(moved)) == moved


def test_back_again() -> None:
    mechanism = ct.example("jansen-leg")
    there = apply_similarity(mechanism, DOUBLED)
    back = Similarity(1 / DOUBLED.factor, -DOUBLED.shift / DOUBLED.factor)
    again = apply_similarity(there, back)
    assert np.abs(places(ct.motion(again, 37)) - places(ct.motion(mechanism, 37))).max() < 1e-12


def test_instants_and_ranges_go_with_the_drive() -> None:
    """A range of the crank's angle, its instants and its chosen zero turn; those of a slider grow."""
    tables = {
        "frame": {"points": {"O": [0, 0], "D": [4, 0]}},
        "links": {"OA": {"length": 1.0}, "AB": {"length": 3.5}, "DB": {"length": 3.0}},
        "drives": [{"link": "OA", "start": 0.2, "speed": 2.0}],
        "assembly": {"sides": {"B": "left"}},
        "study": {"from": 0.5, "to": 1.5, "instants": [0.7]},
    }
    for study in (tables["study"], {**tables["study"], "coordinate": {"zero": 0.4}}):
        mechanism = ct.Mechanism(**{**tables, "study": study})
        moved = apply_similarity(mechanism, DOUBLED)
        wanted = DOUBLED.factor * places(ct.motion(mechanism, 9)) + DOUBLED.shift
        assert np.abs(places(ct.motion(moved, 9)) - wanted).max() < 1e-12 * np.abs(wanted).max()
        at = [
            DOUBLED.factor * places(ct.motion(mechanism, at=list(mechanism.study.instants))) + DOUBLED.shift
        ]
        assert np.abs(places(ct.motion(moved, at=list(moved.study.instants))) - at[0]).max() < 1e-12 * 10
    by_law = ct.Mechanism(
        frame={"points": {"O": [0, 0]}},
        links={"AB": {"length": 2.0}, "block": {"points": {"A": [0, 0]}}},
        guides=[
            {"point": "A", "through": "O", "direction": [1, 0], "link": "block"},
            {"point": "B", "through": [0, 0.5], "direction": "90 deg"},
        ],
        drives=[{"guide": "A", "start": 0.5, "law": "0.3*sin(t)"}],
        assembly={"sides": {"B": "ahead"}},
    )
    moved = apply_similarity(by_law, DOUBLED)
    wanted = DOUBLED.factor * places(ct.motion(by_law, 9, start=0, stop=2)) + DOUBLED.shift
    assert np.abs(places(ct.motion(moved, 9, start=0, stop=2)) - wanted).max() < 1e-12 * 10


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("six-bar-press", "loads cannot be moved"),
        ("cam-driven-linkage", "drives lever.cam cannot be moved"),
        ("hookes-joint", 'space = "sphere" cannot be moved'),
        ("double-pendulum", "simulation cannot be moved"),
    ],
)
def test_what_has_no_similar_one_is_named(name: str, said: str) -> None:
    with pytest.raises(ct.InputError, match=said):
        apply_similarity(ct.example(name), DOUBLED)
