"""Every kind of figure as it is printed: no text over another, none small or cut off, no data in a corner."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import pytest

import centrode as ct
from centrode.render.figures.pictures import figures_of
from centrode.sheets.force_pages import GroupPage, LeverPage
from centrode.sheets.pages import InstantPage, InstantsPage, PositionsPage, VectorDiagramPage
from centrode.sheets.plots import VectorPage
from centrode.topics.registry import TOPICS
from centrode.topics.sheets import sheet_with_parts
from printed import faults
from samples import ALL

TO_SCALE = GroupPage, InstantPage, InstantsPage, LeverPage, PositionsPage, VectorDiagramPage, VectorPage
TOPIC = {topic.name: topic for topic in TOPICS}
KINDS: Mapping[tuple[str, str], tuple[dict[str, Any], tuple[str, ...]]] = {
    ("six-bar-press", "run"): (
        {"samples": 73},
        ("mechanism", "paths", "velocities", "kinematic-coefficients"),
    ),
    ("six-bar-press", "flywheel"): ({"samples": 73}, ("moments", "wittenbauer")),
    ("six-bar-press", "reactions"): (
        {"samples": 73},
        ("journal-loads", "bearing-wear", "force-vectors"),
    ),
    ("six-bar-press", "balance"): (
        {"samples": 73},
        ("counterweights", "shaking-harmonics", "shaking-hodograph"),
    ),
    ("six-bar-press", "plan"): ({}, ("plan",)),
    ("six-bar-press", "polygons"): ({"at": (0.7,)}, ("group-1", "lever")),
    ("crank-rocker", "diagrams"): ({"instants": (0.7,)}, ("mechanism", "velocity", "acceleration")),
    ("slider-between-cranks", "diagrams"): ({}, ("instants",)),
    ("crank-rocker", "integrate"): ({}, ("integration-errors",)),
    ("jansen-leg", "run"): ({"samples": 73}, ("mechanism",)),
    ("jansen-leg", "centres"): ({}, ("centres",)),
    ("crank-rocker", "centrodes"): ({"link": "AB", "instants": (0.7,)}, ("centrodes", "curvature")),
    ("spherical-crank-rocker", "run"): ({"samples": 73}, ("paths",)),
    ("spherical-crank-rocker", "centres"): ({}, ("centres",)),
    ("five-bar-two-drives", "region"): ({"samples": 13}, ("region",)),
    ("valve-cam", "follower-motion"): ({}, ("cam-motion",)),
    ("valve-cam", "follower-forces"): ({"samples": 73}, ("cam-forces",)),
    ("walking-wheel-three-legs", "roller-path"): ({}, ("cam-path",)),
    ("walking-wheel-three-legs", "path-routes"): ({}, ("cam-routes",)),
    ("walking-wheel-three-legs", "cam-profile"): ({}, ("cam-body",)),
    ("walking-wheel-three-legs", "walking-wheel"): ({}, ("walking-wheel",)),
}
"""Of each kind of figure one: example and topic, what is computed, names of the figures."""


def figures(name: str, topic: str, chosen: tuple[str, ...] | None, **options: Any) -> dict[str, list[str]]:
    """What is wrong with the figures of a topic, by their names."""
    example: Any = ct.example(name)
    sheet = sheet_with_parts(TOPIC[topic], TOPIC[topic].compute(example, **options))
    pictures = sheet.pictures if chosen is None else {key: sheet.pictures[key] for key in chosen}
    drawn = figures_of(pictures, example.display)
    return {key: faults(one, to_scale=isinstance(pictures[key], TO_SCALE)) for key, one in drawn.items()}


@pytest.mark.parametrize(("name", "topic"), KINDS)
def test_each_kind_of_figure_can_be_read_in_print(name: str, topic: str) -> None:
    options, chosen = KINDS[name, topic]
    found = figures(name, topic, chosen, **options)
    assert set(found) == set(chosen)
    assert {key: wrong for key, wrong in found.items() if wrong} == {}


@pytest.mark.skipif(not ALL, reason="every figure of the gallery is looked at by make samples")
@pytest.mark.parametrize("name", ct.example_names("linkage"))
def test_every_figure_of_the_gallery_can_be_read_in_print(name: str) -> None:
    found = figures(name, "run", None)
    assert {key: wrong for key, wrong in found.items() if wrong} == {}
