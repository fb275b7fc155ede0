"""Figures hold the values of the dataset in display units; gaps are gaps; what is drawn is named."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.colors import to_hex
from matplotlib.figure import Figure

from centrode.render.drawing.style import PALETTE, pens
from centrode.render.figures import curves
from centrode.render.figures.files import save_figures
from centrode.views.motion_plots import deal_to_panels
from drawn_curves import at_samples
from shown_motion import motion_figures

ALWAYS = [
    "mechanism",
    "paths",
    "angles",
    "angular-velocities",
    "angular-accelerations",
    "velocities",
    "accelerations",
]


def lines(figure: Figure, name: str, panel: int = 0):
    """The lines of a name in a panel of a figure."""
    return [line for line in figure.axes[panel].get_lines() if line.get_label() == name]


def legend_texts(figure: Figure) -> set[str]:
    legends = [axes.get_legend() for axes in figure.axes]
    return {text.get_text() for legend in legends if legend for text in legend.get_texts()}


def test_every_figure_is_there(gallery):
    assert list(gallery("press")[-1]) == [*ALWAYS, "slides", "kinematic-coefficients"]
    assert list(gallery("jansen")[-1]) == [*ALWAYS, "kinematic-coefficients"]
    assert list(gallery("five_bar")[-1]) == ALWAYS


def test_curves_hold_the_values_in_display_units(gallery):
    _mechanism, dataset, figures = gallery("press")
    x = np.degrees(dataset["drive_value"].values[:, 0])
    eps = 4 * np.finfo(float).eps
    for link in ("OA", "AB", "rocker", "DH"):
        (line,) = lines(figures["angles"], link)
        np.testing.assert_allclose(line.get_xdata(), x, rtol=eps)
        np.testing.assert_allclose(line.get_ydata(), np.degrees(dataset["angle"].sel(link=link)), rtol=eps)
    velocity = dataset["velocity"].sel(point="D").values
    for panel, expected in enumerate((velocity[:, 0], velocity[:, 1], np.hypot(*velocity.T))):
        (line,) = lines(figures["velocities"], "D", panel)
        np.testing.assert_array_equal(line.get_ydata(), 1000.0 * expected)
    (line,) = lines(figures["paths"], "S2")
    np.testing.assert_array_equal(
        np.stack(line.get_data(), axis=1), 1000.0 * dataset["position"].sel(point="S2").values
    )
    (line,) = lines(figures["slides"], "H", 2)
    np.testing.assert_array_equal(line.get_ydata(), 1000.0 * dataset["slide_acceleration"].values[:, 0])


def test_axes_name_quantity_and_unit(gallery):
    figures = gallery("press")[-1]
    assert figures["angles"].axes[0].get_xlabel() == r"angle $\varphi$ of link OA, °"
    assert figures["angles"].axes[0].get_ylabel() == r"$\varphi$, °"
    assert [axes.get_ylabel() for axes in figures["velocities"].axes] == [
        "${v}_{x}$, mm/s",
        "${v}_{y}$, mm/s",
        "$v$, mm/s",
    ]
    labels = [axes.get_ylabel() for axes in figures["kinematic-coefficients"].axes]
    assert labels[:4] == [
        r"$\varphi '$",
        r"$\varphi ''$, 1/rad",
        "${r'}_{x}$, mm/rad",
        "${r''}_{x}$, mm/rad²",
    ]
    assert "Six-bar press" in figures["angles"].get_suptitle()


def test_links_that_cannot_turn_have_no_curve(gallery):
    figures = gallery("press")[-1]
    assert legend_texts(figures["angles"]) == {"OA", "AB", "rocker", "DH"}


def test_only_what_is_reached_is_drawn_up_to_the_dead_position(gallery):
    """Of a mechanism that locks: neither its gap nor what is cut off; the axes end at the limit."""
    _mechanism, dataset, figures = gallery("worked", locked=True)
    reached = dataset["status"].values == 0
    assert 0 < reached.sum() < reached.size
    first, limit = float(dataset["time"][0]), float(dataset["event_value"].min())
    for name in ("angles", "velocities", "accelerations", "kinematic-coefficients"):
        for axes in figures[name].axes:
            # at a speed of 1 rad/s the time is the value of the drive
            assert axes.get_xlim() == pytest.approx((first, limit), rel=1e-14)
            for line in axes.get_lines():
                known = np.isfinite(line.get_ydata())
                assert np.all(np.asarray(line.get_xdata())[known] <= limit)
    (path,) = lines(figures["paths"], "B")
    shown = np.column_stack(path.get_data())
    expected = dataset["position"].sel(point="B").values[reached]
    np.testing.assert_array_equal(shown[np.isfinite(shown).all(axis=1)][[0, -1]], expected[[0, -1]])
    for figure in figures.values():
        assert "cut off" not in legend_texts(figure)
    assert "limit" in legend_texts(figures["angular-velocities"])


def test_what_is_cut_off_is_drawn_where_nothing_is_reached(make):
    """A gap between two parts is not bridged."""
    mechanism, dataset = make("worked", locked=True)
    known = np.isfinite(dataset["position"].sel(point="B", axis="x").values)
    assert not known.all()
    status = np.where(dataset["status"].values == 0, 2, dataset["status"].values).astype(np.int8)
    figures = motion_figures(mechanism, dataset.assign(status=("sample", status)), only=["paths"])
    (regular,) = lines(figures["paths"], "B")
    (beyond,) = lines(figures["paths"], "B (cut off)")
    assert not np.isfinite(regular.get_ydata()).any()
    assert np.isfinite(beyond.get_ydata()).sum() == known.sum()
    assert beyond.get_linestyle() != "-"
    assert to_hex(beyond.get_color()).upper() == curves.MUTED


def test_a_gap_between_two_samples_parts_them(make):
    mechanism, dataset = make("worked", samples=9)
    dataset = dataset.drop_dims("event").assign(
        event_value=("event", [2.0, 2.1]), event_kind=("event", np.zeros(2, dtype=np.int8))
    )
    figures = motion_figures(mechanism, dataset, only=["angles"])
    (line,) = lines(figures["angles"], "AC")
    before = int(np.searchsorted(dataset["time"].values, 2.0))
    (gap,) = np.flatnonzero(np.isnan(line.get_ydata()))
    times, angles = line.get_xdata(), line.get_ydata()
    expected, values = dataset["time"].values, dataset["angle"].sel(link="AC").values
    assert (times[gap - 1], times[gap + 1]) == (expected[before - 1], expected[before])
    samples = np.isin(times, expected)
    np.testing.assert_array_equal(angles[samples], values)


def test_events_are_marked_in_every_panel(gallery):
    _mechanism, dataset, figures = gallery("worked", locked=True)
    limit, beyond = dataset["event_value"].values
    for name in ALWAYS[2:]:
        for axes in figures[name].axes:
            upright = [line.get_xdata()[0] for line in axes.get_lines() if len(line.get_xdata()) == 2]
            assert limit in upright and beyond not in upright


def test_events_of_a_law_stand_at_the_times_it_passes_them(gallery):
    figures = gallery("slotted")[-1]
    axes = figures["angles"].axes[0]
    assert axes.get_xlabel() == "time $t$, s"
    upright = [line.get_xdata()[0] for line in axes.get_lines() if len(line.get_xdata()) == 2]
    expected = np.array([np.arcsin(0.5) / 2, np.pi / 2 - np.arcsin(0.5) / 2])
    step = np.pi / 180
    np.testing.assert_allclose(upright, expected, atol=step**2)
    assert "change point" in legend_texts(figures["angles"])
    assert figures["kinematic-coefficients"].axes[-1].get_xlabel() == r"angle $\varphi$ of link OA, °"


def test_names_of_any_alphabet_are_gallery(gallery, tmp_path):
    figures = gallery("slotted")[-1]
    texts = {text.get_text() for text in figures["mechanism"].axes[0].texts}
    assert {"O", "A", "C", "Б’"} <= texts
    assert "кулиса" in legend_texts(figures["angles"])
    assert "Кулисный механизм" in figures["paths"].get_suptitle()
    # a missing glyph is a warning, and warnings are errors; these have the names of links and points, and the title
    save_figures({name: figures[name] for name in ("mechanism", "angles", "paths")}, tmp_path)


def test_one_colour_everywhere(gallery):
    mechanism, _dataset, figures = gallery("worked")
    for kept, names in (
        (mechanism.link_names, ["angles", "angular-velocities", "kinematic-coefficients", "mechanism"]),
        (mechanism.moving_points, ["paths", "velocities", "accelerations"]),
    ):
        for name, pen in pens(kept).items():
            for figure in names:
                found = lines(figures[figure], name)
                assert found
                assert {to_hex(line.get_color()).upper() for line in found} == {pen.colour}


def test_few_curves_in_one_panel(gallery):
    figures = gallery("jansen")[-1]
    for axes in figures["angular-velocities"].axes:
        assert len(axes.get_lines()) <= len(PALETTE)
    names = [f"P{k}" for k in range(20)]
    groups = deal_to_panels(names)
    assert [name for group in groups for name in group] == names
    assert max(map(len, groups)) <= len(PALETTE)
    assert len(deal_to_panels([f"P{k}" for k in range(200)])) <= 4


def test_curves_that_coincide_all_show(gallery):
    figure = gallery("jansen")[-1]["angular-velocities"]
    widths = [lines(figure, name)[0].get_linewidth() for name in ("ZB", "BC", "ZC")]
    assert widths == sorted(widths, reverse=True)
    assert len(set(widths)) == 3


def test_rounding_is_not_blown_up(make):
    mechanism, dataset = make("worked")
    dataset["angular_acceleration"][:] = 1e-16 * np.sin(
        np.arange(dataset["angular_acceleration"].size)
    ).reshape(dataset["angular_acceleration"].shape)
    figures = motion_figures(mechanism, dataset, only=["angular-accelerations"])
    low, high = figures["angular-accelerations"].axes[0].get_ylim()
    assert high - low > 1e-9


def test_what_runs_to_infinity_leaves_the_rest_readable(gallery):
    _mechanism, dataset, figures = gallery("worked", locked=True)
    greatest = float(np.nanmax(np.abs(dataset["acceleration"].values)))
    low, high = figures["accelerations"].axes[0].get_ylim()
    assert high - low < greatest


def test_instants_are_drawn_where_asked(make):
    mechanism, dataset = make("press")
    figure = motion_figures(mechanism, dataset, [np.radians(99.0), np.radians(-30.0)], ["mechanism"])[
        "mechanism"
    ]
    assert len(figure.axes) == 2
    for axes, degrees in zip(figure.axes, (99, -30), strict=True):
        assert f"{degrees}°".replace("-", "−") in axes.get_title()
        sample = int(np.argmin(np.abs(dataset["drive_value"].values[:, 0] - np.radians(degrees))))
        (crank,) = [line for line in axes.get_lines() if line.get_label() == "OA"]
        tip = np.stack(crank.get_data(), axis=1)[1]
        np.testing.assert_array_equal(tip, 1000.0 * dataset["position"].sel(point="A").values[sample])


def test_two_drives_are_drawn_over_time(make):
    mechanism, dataset = make("five_bar")
    figures = motion_figures(mechanism, dataset, [0.5], ["angles", "mechanism"])
    assert figures["angles"].axes[0].get_xlabel() == "time $t$, s"
    np.testing.assert_array_equal(
        at_samples(lines(figures["angles"], "AB")[0].get_xdata(), 61), dataset["time"].values
    )
    assert "0.5 s" in figures["mechanism"].axes[0].get_title()


def test_shuffled_samples_are_drawn_in_order(make):
    mechanism, dataset = make("worked", samples=50)
    shuffled = dataset.isel(sample=np.random.default_rng(0).permutation(50))
    first, second = (
        motion_figures(mechanism, each, only=["angles"])["angles"] for each in (dataset, shuffled)
    )
    np.testing.assert_array_equal(lines(first, "CB")[0].get_ydata(), lines(second, "CB")[0].get_ydata())


@pytest.mark.parametrize("scale", [1e-6, 1e6])
def test_any_size(make, tmp_path, scale):
    mechanism, dataset = make("press", samples=31)
    small = dataset.copy()
    for variable in dataset.data_vars:
        if str(dataset[variable].attrs.get("units", "")).startswith("m"):
            small[variable] = scale * dataset[variable]
    frame = {
        "points": {name: tuple(scale * x for x in at) for name, at in mechanism.frame.coordinates.items()}
    }
    links = {
        name: {"points": {p: tuple(scale * x for x in at) for p, at in link.coordinates.items()}}
        for name, link in mechanism.links.items()
    }
    guides = [
        {"point": "H", "on": "frame", "through": (0.0, 0.9 * scale), "direction": (1.0, 0.0), "link": "block"}
    ]
    drives = [{"link": "OA", "start": mechanism.drives[0].start, "speed": -1.0}]
    scaled = type(mechanism)(frame=frame, links=links, guides=guides, drives=drives)
    figures = motion_figures(scaled, small, only=["mechanism"])
    low, high = figures["mechanism"].axes[0].get_xlim()
    assert 1 < (high - low) / scale < 10
    save_figures({"mechanism": figures["mechanism"]}, tmp_path)


@pytest.mark.parametrize("name", ["press", "worked", "slotted", "jansen", "five_bar"])
def test_one_sample(make, tmp_path, name):
    figures = motion_figures(*make(name, samples=1), only=["mechanism", "angles"])
    save_figures(figures, tmp_path)
    line = next(line for line in figures["angles"].axes[0].get_lines() if line.get_label() == "OA")
    assert line.get_marker() == "o"


def test_nothing_known(make, tmp_path):
    mechanism, dataset = make("press", samples=7)
    for variable in dataset.data_vars:
        if "sample" in dataset[variable].dims and variable != "status":
            dataset[variable] = dataset[variable] * np.nan
    dataset["status"] = (dataset["status"] * 0 + 1).astype(np.int8)
    figures = motion_figures(mechanism, dataset, only=["mechanism", "paths", "angles", "velocities"])
    assert "(open)" in figures["mechanism"].axes[0].get_title()
    for name in ("paths", "angles", "velocities"):
        assert "no sample has a value here" in [text.get_text() for text in figures[name].axes[0].texts]
    save_figures({name: figures[name] for name in ("mechanism", "paths", "angles")}, tmp_path)


@pytest.mark.parametrize(
    ("inches", "ticks"), [(0.3, [30, 60]), (0.6, [30, 40, 50, 60]), (2.0, [30, 35, 40, 45, 50, 55, 60])]
)
def test_round_angles_have_room_beside_each_other(inches: float, ticks: list[float]) -> None:
    """In a low panel every second angle, or fewer, but never one alone."""
    figure = Figure(figsize=(6.0, inches + 1.0))
    axes = figure.add_axes((0.1, 0.5 / (inches + 1.0), 0.8, inches / (inches + 1.0)))
    axes.set_ylim(29.0, 61.0)
    curves.angle_ticks(axes.yaxis, 30.0, 60.0, "deg", 6)
    drawn = [float(x) for x in axes.get_yticks() if 29.0 <= x <= 61.0]
    assert drawn == ticks
