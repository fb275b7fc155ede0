"""Quadrature and extremes against what is known in closed form; the error told bounds the error made."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt
import pytest

from centrode.dynamics.steady_motion.cycle import MOST_PANELS, NODES, Panels, resolve_panels
from centrode.numerics.search import extremes

Array = npt.NDArray[np.float64]
EPS = float(np.finfo(np.float64).eps)
TURN = np.linspace(0.0, 2 * math.pi, 73)


@pytest.mark.parametrize("degree", range(NODES))
def test_polynomials_are_exact(degree: int) -> None:
    panels = Panels(np.array([0.0, 0.3, 1.1, 2.0]))
    series = panels.series(panels.nodes**degree)
    places = np.linspace(0.0, 2.0, 41)
    size = 2.0 ** (degree + 1)
    np.testing.assert_allclose(series.at(places), places**degree, rtol=0.0, atol=64 * NODES * EPS * size)
    exact = places ** (degree + 1) / (degree + 1)
    np.testing.assert_allclose(series.integral(places), exact, rtol=0.0, atol=64 * NODES * EPS * size)
    assert abs(series.total - size / (degree + 1)) <= 64 * NODES * EPS * size
    assert abs(panels.weights.sum() - 2.0) <= 64 * EPS


@pytest.mark.parametrize("sharp", [1.5, 1.05, 1.001])
def test_the_error_told_bounds_the_error(sharp: float) -> None:
    """A peak of any width: the integral of 1/(a + cos x) over a turn is 2 pi / sqrt(a^2 - 1)."""
    panels, values = resolve_panels(lambda x: (1.0 / (sharp + np.cos(x)))[None], TURN, (1e-13,))
    series = panels.series(values[0])
    exact = 2 * math.pi / math.sqrt(sharp**2 - 1)
    # the peak itself is rounded by the difference a + cos x
    rounding = 64 * EPS * exact / (sharp - 1)
    assert abs(series.total - exact) <= series.error + rounding
    assert series.error <= 1e-13 * 2 * math.pi / (sharp - 1) * (len(panels.edges) - 1)


@pytest.mark.parametrize("at", [1.0, math.pi, 5.0])
def test_a_jump_that_nobody_announced(at: float) -> None:
    panels, values = resolve_panels(lambda x: np.where(x < at, -1.0, 2.0 + np.sin(x))[None], TURN, (1e-13,))
    series = panels.series(values[0])
    exact = -at + 2 * (2 * math.pi - at) + math.cos(at) - 1.0
    assert abs(series.total - exact) <= series.error + 64 * EPS * 20
    assert series.error <= 1e-10
    assert len(panels.edges) < MOST_PANELS


def test_a_jump_on_an_edge_costs_nothing() -> None:
    edges = np.unique(np.append(TURN, 1.0))
    panels, values = resolve_panels(lambda x: np.where(x < 1.0, -1.0, 2.0)[None], edges, (1e-13,))
    assert len(panels.edges) == len(edges)
    series = panels.series(values[0])
    assert series.at(np.array([1.0])) == pytest.approx(2.0)  # what holds behind it
    assert abs(series.integral(np.array([1.0]))[0] + 1.0) <= 64 * EPS


def test_noise_ends_at_the_greatest_number_of_panels() -> None:
    noise = np.random.default_rng(1)
    panels, _values = resolve_panels(lambda x: noise.normal(size=(1, len(x))), TURN, (1e-13,))
    assert len(panels.edges) - 1 <= MOST_PANELS


def test_extremes_between_the_nodes() -> None:
    panels = Panels(TURN)
    found = extremes(lambda x: np.sin(3 * x + 0.2), lambda x: 3 * np.cos(3 * x + 0.2), panels.ends_and_nodes)
    assert abs(found.greatest - 1.0) <= 4 * EPS
    assert abs(found.least + 1.0) <= 4 * EPS
    assert abs(math.cos(3 * found.at_greatest + 0.2)) <= 16 * EPS * 10


def test_extremes_at_jumps_of_the_slope_and_at_the_ends() -> None:
    edges = np.unique(np.append(TURN, [1.0, 4.0]))
    found = extremes(
        lambda x: np.abs(x - 1.0) - 3.0 * np.maximum(x - 4.0, 0.0),
        lambda x: np.where(x < 1.0, -1.0, np.where(x < 4.0, 1.0, -2.0)),
        Panels(edges).ends_and_nodes,
    )
    assert (found.greatest, found.at_greatest) == pytest.approx((3.0, 4.0), abs=8 * EPS)
    ends = 2 * math.pi
    assert found.least == pytest.approx(ends - 1.0 - 3.0 * (ends - 4.0), abs=16 * EPS * ends)


def test_extremes_of_a_constant() -> None:
    found = extremes(np.ones_like, np.zeros_like, Panels(TURN).ends_and_nodes)
    assert (found.least, found.greatest, found.range) == (1.0, 1.0, 0.0)
