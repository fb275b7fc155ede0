"""The picture of a reachable region: its border is where the mechanism locks, its path that of the drives."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from matplotlib.contour import QuadContourSet
from matplotlib.figure import Figure

import centrode as ct
from centrode.kinematics.several_inputs.region import region_results
from drives import apart, five_bar, least_and_greatest

DEGREES = {"display": {"angle": "deg", "length": "mm"}}


def drawn(mechanism: ct.Mechanism, samples: int = 61, **more: Any) -> tuple[Any, Figure]:
    results = region_results(mechanism, samples=samples, **more)
    shown = replace(results, motion=ct.motion(mechanism, 2000, stop=6.0))
    return results.region, ct.figures(shown)["region"]


def border_of(figure: Figure) -> Any:
    """All places of the lines drawn around the region."""
    sets = [c for c in figure.axes[0].collections if isinstance(c, QuadContourSet) and not c.filled]
    return np.concatenate([path.vertices for one in sets for path in one.get_paths() if len(path.vertices)])


@pytest.mark.parametrize("samples", [41, 81, 161])
def test_the_border_lies_where_the_mechanism_locks(samples: int) -> None:
    mechanism = five_bar(**DEGREES)
    region, figure = drawn(mechanism, samples)
    border = np.radians(border_of(figure))
    least, greatest = least_and_greatest(mechanism)
    between = apart(mechanism, *border.T)
    step = 2 * np.pi / (samples - 1)
    # between nodes the radicand is taken as straight: off by its curvature times step^2/8 over its slope, and at a
    # corner of two limits by a step; |AC| moves by at most 0.5 a radian, curves by as much
    off = np.minimum(np.abs(between - least), np.abs(between - greatest))
    assert np.quantile(off, 0.9) <= step**2
    assert np.max(off) <= step
    assert len(border) >= region.sizes["border"] / 2


def texts(figure: Figure) -> list[str]:
    legend = figure.axes[0].get_legend()
    assert legend is not None
    return [text.get_text() for text in legend.get_texts()]


def test_axes_path_and_initial_position() -> None:
    mechanism = five_bar(**DEGREES)
    region, figure = drawn(mechanism)
    axes = figure.axes[0]
    assert axes.get_xlabel() == r"angle $\varphi$ of link OA, °"
    assert axes.get_ylabel() == r"angle $\varphi$ of link EC, °"
    ends = np.degrees(region["first"].to_numpy()[[0, -1]])
    assert axes.get_xlim() == pytest.approx(tuple(ends))
    assert "reached" in texts(figure)
    assert "path of the drives in time" in texts(figure)
    path = axes.lines[0].get_xydata()
    known = path[np.isfinite(path).all(axis=1)]
    assert known[0] == pytest.approx(np.degrees([1.0, 1.8]))
    # OA turns at 1, EC at -2 rad/s; whole turns are taken out, so jumps are gaps
    steps = np.diff(path, axis=0)
    steps = steps[np.isfinite(steps).all(axis=1)]
    assert steps[:, 1] == pytest.approx(-2 * steps[:, 0], abs=1e-9)
    mark = axes.lines[-1]
    assert (mark.get_xdata()[0], mark.get_ydata()[0]) == pytest.approx((np.degrees(1.0), np.degrees(1.8)))


def test_what_is_cut_off_is_told_from_what_is_reached() -> None:
    two_islands = five_bar(0.7, (0.17, 0.13), 0.7, 1.0, (0.95, 2.3))
    _region, figure = drawn(two_islands)
    assert "closes, but cut off" in texts(figure)
    _region, figure = drawn(five_bar())
    assert "closes, but cut off" not in texts(figure)


def test_nothing_locks() -> None:
    arm = ct.example("two-link-arm")
    figure = ct.figures(replace(region_results(arm, samples=5), motion=None))["region"]
    assert texts(figure) == ["reached", "initial position"]
