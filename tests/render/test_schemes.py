"""The kinematic scheme at the opening of a report: its key stands on the paper, whatever the links are called."""

from __future__ import annotations

from typing import Any

import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg

import centrode as ct
from centrode.locale import speaking
from centrode.model.settings import Display
from centrode.render.drawing.style import house_style
from centrode.render.figures.schemes import scheme_figure
from centrode.views.schemes import scheme_picture


@pytest.mark.parametrize("space", ["plane", "sphere"])
@pytest.mark.parametrize("name", ["BC", "connecting rod", "ведуча вилка"])
def test_names_of_links_stand_on_the_paper(name: str, space: str) -> None:
    sphere = space == "sphere"
    points = {"A": [1, 0, 0], "D": [0, 1, 0]} if sphere else {"A": [0, 0], "D": [4, 0]}
    lengths = ("20 deg", "70 deg", "80 deg") if sphere else (1, 3.5, 3)
    ends = (("A", "B"), ("B", "C"), ("D", "C"))
    links: dict[str, dict[str, object]] = {
        link: {"points": list(points), "length": length}
        for link, points, length in zip(("AB", name, "DC"), ends, lengths, strict=True)
    }
    if sphere:
        links["AB"]["reference"], links["DC"]["reference"] = ["A", "D"], ["D", "A"]
    mechanism = ct.Mechanism(
        space=space,
        frame={"points": points},
        links=links,
        drives=[{"link": "AB", "start": 0.0, "speed": 1}],
        assembly={"sides": {"C": "left"}},
    )
    picture = scheme_picture(mechanism, ct.motion(mechanism, samples=37))
    with speaking("uk"), house_style():
        figure = scheme_figure(picture, Display())
        canvas: Any = FigureCanvasAgg(figure)
        canvas.draw()  # places the legend
        (axes,) = figure.axes
        legend = axes.get_legend()
        assert legend is not None
        rightmost = max(text.get_window_extent().x1 for text in legend.get_texts())
    assert rightmost < figure.bbox.x1
