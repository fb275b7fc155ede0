"""Figures of a cam show its numbers, in the units of its display."""

from __future__ import annotations

import math

import numpy as np
import pytest
from matplotlib.figure import Figure

import centrode as ct
from centrode.cams.cam import cam_routes, path_routes_results, roller_path_results
from centrode.render.drawing.style import darken

EXAMPLE = ct.example("cam-from-curvature")


def lines(figure: Figure) -> list[np.ndarray]:
    return [np.column_stack(line.get_data()) for axes in figure.axes for line in axes.get_lines()]


def texts(figure: Figure) -> list[str]:
    return [text.get_text() for axes in figure.axes for text in axes.texts]


def cam(**changed: object) -> ct.Cam:
    parts = {
        "kind": "cam",
        "display": {"length": "mm", "angle": "deg"},
        "curvature": {"law": "exponential", "k0": 10, "k1": 0.75},
        "start": {"radius": 0.05},
        "range": {"to": math.pi / 2},
    }
    return ct.Cam(**(parts | changed))


def test_the_path_is_drawn_with_rays_and_normals() -> None:
    data = ct.cam(EXAMPLE, samples=91)
    figure = ct.figures(roller_path_results(EXAMPLE, 91))["cam-path"]
    drawn = lines(figure)
    path = next(line for line in drawn if len(line) == 91)
    assert np.array_equal(path, data.roller_centre.to_numpy() * 1e3)
    assert texts(figure) == [f"{angle}°" for angle in range(0, 91, 15)]
    rays = [line for line in drawn if len(line) == 2 and not line[0].any()]
    normals = [line for line in drawn if len(line) == 2 and line[0].any()]
    assert len(rays) == len(normals) == 7
    for ray, normal, angle in zip(rays, normals, np.radians(range(0, 91, 15)), strict=True):
        here = ct.cam(EXAMPLE, at=[angle]).isel(sample=0)
        assert ray[1] == pytest.approx(here.roller_centre.to_numpy() * 1e3)
        to_centre, inwards = -ray[1], normal[0] - normal[1]
        cosine = to_centre @ inwards / math.hypot(*to_centre) / math.hypot(*inwards)
        assert cosine == pytest.approx(float(here.pressure_cosine))


def test_curves_are_those_of_the_dataset_and_the_stall_is_marked() -> None:
    long = cam(range={"to": math.pi})
    data = ct.cam(long, samples=61)
    figure = ct.figures(roller_path_results(long, 61))["cam-curves"]
    assert [axes.get_ylabel().partition(", ")[2] for axes in figure.axes] == ["mm", "°", "1/mm"]
    across = np.degrees(data["carrier_angle"].to_numpy())
    curves = [line[np.isin(line[:, 0], across)] for line in lines(figure) if len(line) > 61]
    for curve, name, factor in zip(
        curves,
        ("path_radius", "cam_pressure_angle", "law_curvature"),
        (1e3, 180 / math.pi, 1e-3),
        strict=True,
    ):
        assert curve[:, 1] == pytest.approx(data[name].to_numpy() * factor, nan_ok=True)
    stall = data.attrs["stall"]
    marks = [line for line in lines(figure) if len(line) == 2]
    assert [float(mark[0, 0]) for mark in marks] == pytest.approx([math.degrees(stall)] * 3)
    assert "stall" in texts(figure)


def test_differences_are_drawn_with_the_circle_of_convergence() -> None:
    data = cam_routes(EXAMPLE, samples=91)
    figure = ct.figures(path_routes_results(EXAMPLE, 91))["cam-routes"]
    axes = figure.axes[0]
    assert axes.get_yscale() == "log"
    error = next(line for line in axes.get_lines() if line.get_color() == "#009E73")
    drawn = np.asarray(error.get_ydata(), dtype=float)
    known = np.isfinite(drawn)
    assert drawn[known] == pytest.approx(np.abs(data.series_error.to_numpy())[known] * 1e3)
    assert "circle of convergence" in texts(figure)
    short = path_routes_results(cam(range={"to": 1.0}), 21)
    assert "circle of convergence" not in texts(ct.figures(short)["cam-routes"])


def test_symmetric_paths_and_dark_ground() -> None:
    both = cam(curvature={"law": "exponential", "k0": 10, "k1": 0.75, "symmetric": True})
    figures = ct.figures(roller_path_results(both, 121))
    assert list(figures) == ["cam-path", "cam-curves"]
    assert texts(figures["cam-path"])[0] == "−90°"
    dark = darken(figures["cam-path"])
    assert dark.get_facecolor()[:3] < (0.2, 0.2, 0.2)
