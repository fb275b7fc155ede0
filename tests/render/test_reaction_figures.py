"""Figures of reactions: hinges by magnitude, guides and wheels, drives, the frame."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.figure import Figure

import centrode as ct
from centrode import render
from centrode.dynamics.bearings.results import reaction_results
from centrode.render.drawing.style import Decimals, house_style
from centrode.render.figures.curves import write_legend
from centrode.sheets.plots import Plot
from centrode.topics.presentation import sheet_of
from drawn_curves import at_samples, heights_at
from mechanisms import parts_of


def curves_of(mechanism: ct.Mechanism, samples: int) -> dict[str, Figure]:
    """The figures of curves over the motion."""
    pictures = sheet_of(reaction_results(mechanism, samples)).pictures
    plots = {name: picture for name, picture in pictures.items() if isinstance(picture, Plot)}
    return render.figures_of(plots, mechanism.display)


def names(figure: Figure, panel: int) -> list[str]:
    legend = figure.axes[panel].get_legend()
    assert legend is not None
    return [text.get_text() for text in legend.get_texts()]


def test_the_press() -> None:
    """Action and reaction are one curve; at the loaded pin each side has its own."""
    press = ct.example("six-bar-press")
    data = ct.reactions(press, samples=37)
    figures = curves_of(press, 37)
    assert list(figures) == ["joint-forces", "other-reactions", "balancing", "frame-force"]
    assert names(figures["joint-forces"], 0) == ["O", "A", "B", "C", "D", "H/DH", "H/slider"]
    drawn = {line.get_label(): line for line in figures["joint-forces"].axes[0].lines}
    force = data.joint_force.sel(side="A/OA").to_numpy()
    across = np.degrees(data.drive_value.to_numpy()[:, 0])
    force, across = force[np.argsort(across)], np.sort(across)
    assert np.array_equal(heights_at(drawn["A"], across), np.hypot(force[:, 0], force[:, 1]))
    assert figures["balancing"].axes[0].get_ylabel() == "$M_b$, N·m"
    # the guide bears no moment: no panel for it
    assert [axes.get_ylabel() for axes in figures["other-reactions"].axes] == ["$R_n$, N"]


def test_the_power_of_ten_of_an_axis_stands_beside_the_legend() -> None:
    """Reactions of tens of thousands of newtons, their names in two rows above the axes."""
    with house_style():
        figure = Figure(figsize=(6.0, 3.0), layout="constrained")
        axes = figure.subplots()
        axes.yaxis.set_major_formatter(Decimals())
        lines = axes.plot([0.0, 1.0], np.outer([0.0, 3e4], np.ones(7)))
        write_legend(axes, [(line, f"pin {k} of a long name") for k, line in enumerate(lines)], beside=False)
        figure.draw_without_rendering()
        legend, power = axes.get_legend(), axes.yaxis.get_offset_text()
        assert legend is not None and power.get_text() == "×10⁴"
        assert len({round(text.get_window_extent().y0) for text in legend.get_texts()}) > 1
        assert power.get_window_extent().x1 <= legend.get_window_extent().x0
        assert power.get_window_extent().y1 > legend.get_window_extent().y0  # else nothing is tried


def test_what_is_not_determined_is_not_drawn() -> None:
    load = {"kind": "torque", "link": "wheel", "value": 3.0}
    loaded = ct.Mechanism(**{**parts_of(ct.example("rolling-wheel-rod")), "loads": [load]})
    figures = curves_of(loaded, 9)
    assert names(figures["joint-forces"], 0) == ["P", "B"]
    assert names(figures["other-reactions"], 0) == ["B", "wheel tangential"]


def test_drives_of_two_kinds_have_a_panel_each() -> None:
    crane = ct.Mechanism(
        gravity=[0, -9.81],
        frame={"points": {"O": [0, 0]}},
        links={
            "carriage": {"points": {"A": [0, 0]}, "mass": 4},
            "AB": {"length": 1, "mass": 2, "shape": "rod"},
        },
        guides=[{"point": "A", "on": "frame", "through": "O", "direction": [1, 0], "link": "carriage"}],
        drives=[{"guide": "A", "law": "t"}, {"link": "AB", "relative_to": "carriage", "law": "0.5*t"}],
        study={"to": 1.0},
    )
    figures = curves_of(crane, 5)
    assert [axes.get_ylabel() for axes in figures["balancing"].axes] == ["$F_b$, N", "$M_b$, N·m"]
    assert len(figures["other-reactions"].axes) == 2


@pytest.mark.parametrize("name", ["a_b_c", "50 %", "#1", "A^2", "$x$"])
def test_names_are_no_formulas(name: str) -> None:
    rod = ct.Mechanism(
        frame={"points": {"O": [0, 0]}},
        links={name: {"points": {"O": [0, 0], "A": [1, 0]}, "mass": 1, "shape": "rod"}},
        drives=[{"link": name, "speed": 1}],
    )
    for figure in curves_of(rod, 5).values():
        figure.draw_without_rendering()


def test_friction_has_a_figure() -> None:
    sled = ct.Mechanism(
        frame={"points": {"O": [0, 0]}},
        links={"OA": {"length": 1}, "AB": {"length": 3}},
        guides=[{"point": "B", "on": "frame", "through": "O", "direction": [1, 0]}],
        drives=[{"link": "OA", "speed": 2.0}],
        loads=[
            {"kind": "force", "guide": "B", "value": -5},
            {"kind": "friction", "guide": "B", "coefficient": 0.1},
            {"kind": "friction", "point": "A", "coefficient": 0.1, "radius": 0.1},
        ],
        assembly={"sides": {"B": "ahead"}},
    )
    data = ct.reactions(sled, 25)
    figures = curves_of(sled, 25)
    power, efficiency = figures["friction"].axes
    assert names(figures["friction"], 0) == ["guide B", "A/AB"]
    drawn = {line.get_label(): line.get_ydata() for line in power.lines}
    assert np.array_equal(at_samples(drawn["A/AB"], 25), data.friction_power.sel(friction="A/AB"))
    assert (power.get_ylabel(), efficiency.get_ylabel()) == ("$P_f$, W", "$η$")


def test_the_sphere() -> None:
    """Three components at the first link of each hinge, magnitudes of the rest."""
    rigid = ct.example("spherical-crank-rocker-rigid")
    data = ct.reactions(rigid, samples=13)
    figures = curves_of(rigid, 13)
    assert list(figures) == ["joint-forces", "joint-components", "centre-forces", "balancing", "frame-force"]
    axes = figures["joint-components"].axes
    assert [one.get_ylabel() for one in axes] == ["${R}_{x}$, N", "${R}_{y}$, N", "${R}_{z}$, N"]
    for number, one in enumerate(axes):
        drawn = {line.get_label(): line.get_ydata() for line in one.lines}
        assert np.array_equal(
            at_samples(drawn["C/BC"], 13), data.joint_force.sel(side="C/BC").to_numpy()[:, number]
        )
    drawn = {line.get_label(): line.get_ydata() for line in figures["centre-forces"].axes[0].lines}
    size = np.linalg.norm(data.centre_force.sel(held="DC").to_numpy(), axis=1)
    assert np.max(abs(at_samples(drawn["DC"], 13) - size)) <= 4 * 2.0**-52 * np.max(size)
    moment = np.linalg.norm(data.frame_moment.to_numpy(), axis=1)
    whole = figures["frame-force"].axes[1].lines[0].get_ydata()
    assert np.max(abs(at_samples(whole, 13) - moment)) <= 4 * 2.0**-52 * np.max(moment)
