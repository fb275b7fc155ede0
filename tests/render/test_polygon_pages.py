"""Pages of force polygons: true scales, names that stand free, every paper, light and dark."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.patches import FancyArrowPatch
from matplotlib.text import Text

import centrode as ct
from boxes import boxes, outside, overlapping
from centrode.dynamics.force_polygons.polygons import PAPERS, ForcePolygons
from centrode.dynamics.force_polygons.results import ForcePolygonResults, force_polygon_results
from centrode.render.drawing.style import darken
from centrode.render.pages.force_polygons import SHORT
from centrode.render.pages.force_signs import force_name
from centrode.render.pages.page import INCH
from mechanisms import parts_of
from samples import few

INSTANTS = {
    "six-bar-press": math.radians(120),
    "slider-crank-offset": 0.8,
    "crank-rocker": 0.9,
    "whitworth-quick-return": 0.9,
    "third-class-triad": 1.0,
    "fourth-class-group": 0.4,
    "rolling-wheel-rod": 0.6,
    "planetary-gear-train": 0.5,
    "two-link-arm": 0.7,
    "jansen-leg": 1.0,
    "tangent-mechanism": 0.1,
    "scotch-yoke": 0.8,
    "oscillating-cylinder": 0.3,
}
LOOKED_AT = few(
    [
        "six-bar-press", "crank-rocker", "whitworth-quick-return", "third-class-triad", "rolling-wheel-rod",
        "planetary-gear-train", "jansen-leg", "oscillating-cylinder",
    ],
    list(INSTANTS),
)  # fmt: skip


def heavy(name: str) -> ct.Mechanism:
    """An example with a mass on every link that turns."""
    if name == "six-bar-press":
        return ct.example(name)
    example = ct.example(name)
    parts: dict[str, Any] = parts_of(example) | {"gravity": [0, -9.81]}
    for link, body in parts["links"].items():
        places = list(example.links[link].coordinates.values())
        middle = [sum(at[k] for at in places) / len(places) for k in (0, 1)]
        body |= {"mass": 8.0, "centre": middle, "inertia": 0.5}
    return ct.Mechanism(**parts)


@pytest.fixture(scope="module")
def results() -> dict[str, ForcePolygonResults]:
    return {name: force_polygon_results(heavy(name), [INSTANTS[name]]) for name in LOOKED_AT}


def forces_of(results: ForcePolygonResults) -> ForcePolygons:
    """The forces of the only instant."""
    (found,) = results.polygons
    assert found is not None
    return found


@pytest.fixture(scope="module")
def pages(results: dict[str, ForcePolygonResults]) -> dict[str, dict[str, Figure]]:
    return {name: ct.figures(results[name]) for name in LOOKED_AT}


@pytest.mark.parametrize("name", LOOKED_AT)
def test_no_text_covers_another_or_leaves_the_page(
    results: dict[str, ForcePolygonResults], pages: dict[str, dict[str, Figure]], name: str
) -> None:
    figures, found = pages[name], forces_of(results[name])
    levers = ["lever"] if len(found.levers) == 1 else [f"lever-{one.drive}" for one in found.levers]
    assert list(figures) == [*(f"group-{k + 1}" for k in range(len(found.groups))), *levers]
    for page, figure in figures.items():
        measured = boxes(figure)
        assert overlapping(measured) == [], page
        assert outside(figure, measured) == [], page


@pytest.mark.parametrize("paper", list(PAPERS))
def test_pages_have_the_size_of_the_paper(paper: str) -> None:
    for figure in ct.figures(force_polygon_results(heavy("crank-rocker"), [0.9], paper)).values():
        assert INCH * np.array(figure.get_size_inches()) == pytest.approx(PAPERS[paper])
        measured = boxes(figure)
        assert outside(figure, measured) == []
        assert overlapping(measured) == []


def arrows(figure: Figure) -> list[complex]:
    """Arrows of the page [mm]."""
    patches = [patch for axes in figure.axes for patch in axes.patches if isinstance(patch, FancyArrowPatch)]
    ends = [np.array(patch._posA_posB) for patch in patches if patch._posA_posB is not None]
    return [complex(*(end - start)) for start, end in ends]


@pytest.mark.parametrize("name", ["six-bar-press", "whitworth-quick-return", "crank-rocker"])
def test_vectors_are_as_long_as_the_scale_says(
    results: dict[str, ForcePolygonResults], pages: dict[str, dict[str, Figure]], name: str
) -> None:
    figures = pages[name]
    for number, group in enumerate(forces_of(results[name]).groups, start=1):
        drawn = arrows(figures[f"group-{number}"])
        scale = group.polygon.scale
        texts = [text.get_text() for text in figures[f"group-{number}"].findobj(Text)]
        assert any(f"{scale:g} N" in text for text in texts)
        for vector in (*group.polygon.vectors, *group.polygon.chords):
            part = vector.name[-1] in "ⁿᵗ"
            if part or group.polygon.length(vector) <= SHORT:
                continue
            assert min(abs(arrow - vector.force / scale) for arrow in drawn) <= 1e-9
            assert force_name(vector.name) in texts


def test_names_of_forces() -> None:
    assert force_name("R12ᵗ") == "$R_{12}^{t}$"
    assert force_name("R12,0ⁿ") == "$R_{12,0}^{n}$"
    assert force_name("MΦ4") == r"$M_{\Phi 4}$"
    assert force_name("−Mb(OA)") == r"$-M_{\mathrm{b}}$(OA)"
    assert force_name("pin $") == r"pin \$"


def test_dark_pages(results: dict[str, ForcePolygonResults]) -> None:
    for figure in ct.figures(results["crank-rocker"]).values():
        assert overlapping(darken(figure)) == []
