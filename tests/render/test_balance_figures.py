"""Figures of a balance: what is drawn is what was computed."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from matplotlib.patches import Circle

import centrode as ct
from centrode.dynamics.balancing.balance import Balance
from centrode.render.drawing.style import darken


@pytest.fixture(scope="module")
def balance() -> Balance:
    return ct.balance(ct.example("single-cylinder-engine"), to="least", thickness="20 mm")


def test_what_is_drawn(balance: Balance) -> None:
    figures = ct.figures(balance)
    assert list(figures) == ["shaking-hodograph", "shaking-cycle", "shaking-harmonics", "counterweights"]
    curves = {line.get_label(): line for line in figures["shaking-hodograph"].axes[0].lines}
    for word, data in (
        ("without counterweights", balance.before),
        ("with counterweights", balance.after),
    ):
        drawn = np.column_stack([curves[word].get_xdata(), curves[word].get_ydata()])
        assert np.array_equal(drawn, data.shaking_force)
    heights = [bar.get_height() for bar in figures["shaking-harmonics"].axes[0].patches]
    assert heights == [
        *balance.before.force_harmonic_greatest.values[1:],
        *balance.after.force_harmonic_greatest.values[1:],
    ]
    (one,) = balance.counterweights
    assert one.disc is not None
    circles = [patch for patch in figures["counterweights"].axes[0].patches if isinstance(patch, Circle)]
    disc = max(circles, key=lambda circle: circle.radius)
    assert disc.radius == 1000 * one.disc  # millimetres
    assert np.hypot(*disc.center) == pytest.approx(1000 * one.radius, rel=1e-12)


def test_a_balanced_mechanism_and_dark_ground(balance: Balance) -> None:
    """Nothing to draw is no failure."""
    still = ct.balance(ct.balance(ct.example("in-line-four-bar")).balanced)
    assert still.counterweights == ()
    for found in (balance, still):
        for figure in ct.figures(found).values():
            darken(figure).draw_without_rendering()


def test_fewer_orders_with_counterweights(balance: Balance) -> None:
    """A cycle that counterweights shorten has fewer orders: fields without a number are empty."""
    fewer = replace(balance, after=balance.after.isel(order=slice(0, 5)))
    columns = {column.name: column.values for column in ct.tables(fewer)["harmonics"].columns}
    before, after = (
        np.asarray(columns[f"{word}_force_harmonic_greatest"], dtype=float) for word in ("before", "after")
    )
    assert np.array_equal(before, balance.before.force_harmonic_greatest)
    assert np.array_equal(after[:5], balance.after.force_harmonic_greatest[:5])
    assert np.isnan(after[5:]).all() and len(after) == len(before)
