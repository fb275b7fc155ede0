"""Figures of a reduction: every part, their sum, and a panel for what the greatest hides."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.figure import Figure

import centrode as ct
from centrode.dynamics.reduction_results import reduction_results
from drawn_curves import at_samples


def names(figure: Figure, panel: int) -> list[str]:
    legend = figure.axes[panel].get_legend()
    assert legend is not None
    return [text.get_text() for text in legend.get_texts()]


def test_the_press() -> None:
    press = ct.example("six-bar-press")
    results = reduction_results(press, 37)
    data, figures = results.reduction, ct.figures(results)
    loads = ["loads", "load-diagram", "moment-sum"]
    assert list(figures) == ["reduced-inertia", "reduced-moment", *loads]
    assert names(figures["reduced-inertia"], 0) == ["AB", "CD", "DH", "slider", "sum"]
    assert names(figures["reduced-moment"], 1) == ["weight AB", "weight CD", "weight DH"]
    drawn = {line.get_label(): line.get_ydata() for line in figures["reduced-inertia"].axes[0].lines}
    # in the order of time, the drive turns back
    assert np.array_equal(at_samples(drawn["sum"], 37), data.reduced_inertia.values)
    assert figures["reduced-inertia"].axes[0].get_ylabel() == "$J$, kg·m²"


@pytest.mark.parametrize("name", ["a_b_c", "50 %", "#1", "A^2"])
def test_names_of_drives_are_no_formulas(name: str) -> None:
    lifted = ct.Mechanism(
        frame={"points": {"O": [0, 0]}},
        links={name: {"points": {"O": [0, 0], "A": [1, 0]}, "mass": 1, "shape": "rod"},
               "AB": {"length": 1, "mass": 2, "shape": "rod"}},
        drives=[{"link": name, "speed": 1}, {"link": "AB", "speed": 2}],
        gravity=[0, -10],
    )  # fmt: skip
    figures = ct.figures(reduction_results(lifted, 5))
    for figure in figures.values():
        figure.draw_without_rendering()
    assert name in figures["generalised-forces"].axes[0].get_ylabel()


def test_no_masses_no_picture_of_them() -> None:
    loaded = ct.Mechanism(
        frame={"points": {"O": [0, 0]}},
        links={"OA": {"length": 1}},
        drives=[{"link": "OA", "speed": 1}],
        loads=[{"kind": "torque", "link": "OA", "value": "sin(x)"}],
    )
    assert list(ct.figures(reduction_results(loaded, 5))) == ["reduced-moment", "loads", "load-diagram"]
