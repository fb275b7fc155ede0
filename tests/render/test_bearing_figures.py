"""Figures of bearings: what is drawn is what was computed, and nothing is missing or crowded."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from matplotlib.figure import Figure
from matplotlib.patches import FancyArrowPatch

import centrode as ct
from centrode import render
from centrode.dynamics.bearings import wear
from centrode.dynamics.bearings.results import with_bearings
from centrode.sheets.plots import Plot
from centrode.topics.presentation import sheet_of
from mechanisms import parts_of

NAMES = ["bearing-loads", "journal-loads", "bush-loads", "bearing-wear", "force-vectors"]


def figures_of(mechanism: ct.Mechanism, reactions: xr.Dataset) -> dict[str, Figure]:
    """The figures that are no curves over the motion."""
    pictures = sheet_of(with_bearings(mechanism, reactions)).pictures
    bearings = {name: picture for name, picture in pictures.items() if not isinstance(picture, Plot)}
    return render.figures_of(bearings, mechanism.display)


def texts(figure: Figure, panel: int = 0) -> list[str]:
    return [text.get_text() for text in figure.axes[panel].texts]


def test_hodographs_of_the_press() -> None:
    press = ct.example("six-bar-press")
    reactions = ct.reactions(press, 361)
    data = wear.bearings(press, reactions)
    figures = figures_of(press, reactions)
    assert list(figures) == NAMES
    for name, variable in (
        ("bearing-loads", "bearing_load"), ("journal-loads", "load_on_journal"), ("bush-loads", "load_on_bush"),
    ):  # fmt: skip
        assert len(figures[name].axes) == 6
        for k, axes in enumerate(figures[name].axes):
            curve = np.array(axes.lines[0].get_data()).T
            force = data[variable][:, k].to_numpy()
            order = np.argsort(data.time.to_numpy(), kind="stable")
            assert np.array_equal(curve[np.isfinite(curve).all(axis=1)], force[order])
            # all of it lies in the panel, at one scale both ways
            assert (axes.viewLim.min <= force.min(axis=0)).all() and (
                axes.viewLim.max >= force.max(axis=0)
            ).all()
            assert axes.get_aspect() == 1.0


def test_ticks_stand_at_round_values_of_the_drive() -> None:
    engine = ct.example("single-cylinder-engine")
    figure = figures_of(engine, ct.reactions(engine, 73))["bearing-loads"]
    said = texts(figure)
    # those that have room, in their order; each has its dot
    round_values = [f"{turn}°" for turn in range(0, 360, 30)]
    assert len(said) >= 6
    assert said == [text for text in round_values if text in said]
    dots = np.array(figure.axes[0].lines[2].get_data()).T
    exact = (
        ct.reactions(engine, at=np.radians(np.arange(0, 360, 30))).joint_force.sel(side="O/frame").to_numpy()
    )
    # 5 degrees part the samples, and the ticks are at every sixth of them
    assert np.abs(dots - exact).max() <= 1e-9 * np.abs(exact).max()


def test_wear_is_drawn_to_one_scale() -> None:
    crank = ct.Mechanism(
        frame={"points": {"O": [0, 0]}},
        links={"OA": {"points": {"O": [0, 0], "A": [2, 0]}, "mass": 5, "centre": [0.5, 0], "inertia": 0.25}},
        drives=[{"link": "OA", "speed": 3.0}],
    )
    figure = figures_of(crank, ct.reactions(crank, 361))["bearing-wear"]
    journal, bush = (np.hypot(*line.get_data()) for line in figure.axes[0].lines[-2:])
    assert journal.max() <= 1.0 + 1e-12
    # the journal's share is a twelfth where it is worn, the bush's a thirty-sixth all around
    assert np.allclose(bush - 1.0, (1.0 - journal.min()) / 3.0, rtol=0, atol=1e-9)
    assert texts(figure)[-1] == "greatest in 10°\njournal 8.3 %\nbush 2.8 %"


def test_forces_are_drawn_to_scale() -> None:
    """Arrows are as long as the page says, the longest of them not too long for it."""
    press = ct.example("six-bar-press")
    reactions = ct.reactions(press, 37)
    page = figures_of(press, reactions)["force-vectors"]
    size = np.hypot(*np.moveaxis(reactions.joint_force.to_numpy(), -1, 0))
    sample = int(np.argmax(size.max(axis=1)))
    written = [text for axes in page.axes for text in (text.get_text() for text in axes.texts)]
    scale = next(text for text in written if "F" in text and "N per mm" in text)
    per_mm = float(scale.split("=")[1].split("N")[0])
    drawn = [
        np.hypot(*np.subtract(*arrow._posA_posB))
        for axes in page.axes
        for arrow in axes.patches
        if isinstance(arrow, FancyArrowPatch) and arrow._posA_posB is not None
    ]
    for force in size[sample]:
        assert min(abs(length - force / per_mm) for length in drawn) <= 1e-9 * force / per_mm
    assert max(size[sample]) / per_mm <= 26.0 + 1e-9


def test_what_nothing_determines_is_said() -> None:
    """A wheel whose centre is in a guide as well: its track and the guide may press against each other."""
    wheel = ct.Mechanism(
        frame={"points": {"O": [0, 0]}},
        links={"OA": {"length": 1}, "AC": {"length": 3}, "wheel": {"points": ["C"]}},
        guides=[{"point": "C", "on": "frame", "through": "O", "direction": [1, 0]}],
        rolling=[
            {
                "link": "wheel",
                "centre": "C",
                "radius": 0.5,
                "along": {"through": [0, -0.5], "direction": [1, 0]},
            }
        ],
        drives=[{"link": "OA", "speed": 1}],
        loads=[{"kind": "torque", "link": "wheel", "value": 3}],
        assembly={"sides": {"C": "ahead"}},
    )
    figures = figures_of(wheel, ct.reactions(wheel, samples=5))
    names = [axes.get_title() for axes in figures["bearing-loads"].axes]
    assert [
        k
        for k, name in enumerate(names)
        if "no sample has a value here" in texts(figures["bearing-loads"], k)
    ] == [names.index("C: AC in wheel")]
    page = figures["force-vectors"]
    assert any("not determined" in text.get_text() for axes in page.axes for text in axes.texts)


def test_a_mechanism_without_loads_in_its_joints() -> None:
    """A crank in balance: no force anywhere."""
    still = ct.Mechanism(
        frame={"points": {"O": [0, 0]}},
        links={"OA": {"points": {"O": [0, 0], "A": [1, 0]}, "mass": 1, "centre": [0, 0], "inertia": 1}},
        drives=[{"link": "OA", "speed": 1}],
    )
    figures = figures_of(still, ct.reactions(still, 9))
    assert list(figures) == NAMES[:-1]
    assert texts(figures["bearing-wear"])[-1] == "no turning\nunder load"


@pytest.mark.parametrize("samples", [1, 2, 3])
def test_few_samples(samples: int) -> None:
    engine = ct.example("single-cylinder-engine")
    for figure in figures_of(engine, ct.reactions(engine, samples, start=0.3, stop=0.9)).values():
        figure.draw_without_rendering()


def test_several_drives_count_by_time() -> None:
    load = {"kind": "force", "point": "P", "vector": [0.0, -10.0]}
    bar = ct.example("five-bar-two-drives")
    load["point"] = bar.moving_points[-1]
    loaded = ct.Mechanism(**{**parts_of(bar), "loads": [load]})
    figures = figures_of(loaded, ct.reactions(loaded, 31))
    assert list(figures) == NAMES
    assert not any("°" in text for text in texts(figures["bearing-loads"]))


@pytest.mark.parametrize("name", ["a_b_c", "50 %", "#1", "A^2", "$x$"])
def test_names_are_no_formulas(name: str) -> None:
    rod = ct.Mechanism(
        frame={"points": {"O": [0, 0]}},
        links={name: {"points": {"O": [0, 0], "A": [1, 0]}, "mass": 1, "shape": "rod"}},
        drives=[{"link": name, "speed": 1}],
    )
    for figure in figures_of(rod, ct.reactions(rod, samples=5)).values():
        figure.draw_without_rendering()
