"""Grids, samples and blocks: every mechanism once, in order, never all at once."""

from __future__ import annotations

import itertools
import math
import tracemalloc
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import centrode as ct
from centrode.sweeps.designs import Crossed, design_of
from centrode.sweeps.store import Blocks

AB, DX = "links.AB.length", "frame.points.D.x"


@given(st.lists(st.integers(1, 7), min_size=1, max_size=4), st.integers(1, 60))
def test_blocks_cover_every_mechanism_once(shape: list[int], most: int) -> None:
    blocks = Blocks.of(tuple(shape), most)
    places = np.arange(math.prod(shape)).reshape(shape)
    seen: list[int] = []
    for block in blocks:
        first, stop = blocks.mechanisms(block)
        assert 1 <= stop - first <= most
        assert places[blocks.region(block)].ravel().tolist() == list(range(first, stop))
        for along, extent in zip(blocks.region(block), blocks.chunk, strict=True):
            assert along.start % extent == 0, "a block is one chunk of a stored array"
            assert along.stop - along.start <= extent
        seen += range(first, stop)
    assert seen == list(range(math.prod(shape)))


@given(st.lists(st.integers(1, 5), min_size=1, max_size=4), st.data())
def test_grids_are_products(shape: list[int], data: Any) -> None:
    axes = {f"p{k}": np.arange(n) + 10.0 * k for k, n in enumerate(shape)}
    design = Crossed(axes)
    every = list(itertools.product(*(values.tolist() for values in axes.values())))
    first = data.draw(st.integers(0, len(every) - 1))
    stop = data.draw(st.integers(first + 1, len(every)))
    rows = design.rows(first, stop)
    assert list(zip(*(rows[path].tolist() for path in axes), strict=True)) == every[first:stop]


def test_a_grid_of_a_billion_takes_no_memory() -> None:
    mechanism = ct.example("crank-rocker")
    tracemalloc.start()
    try:
        design = design_of(mechanism, ct.grid({AB: (3.4, 3.6, 40_000), DX: (3.9, 4.1, 25_000)}))
        assert math.prod(design.shape) == 10**9
        rows = design.rows(10**9 - 1000, 10**9)
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert (rows[AB] == 3.6).all()
    assert rows[DX][-1] == 4.1
    axes = 8 * (40_000 + 25_000)
    assert peak < 10 * axes, "some copies of the axes, not of the grid"


def test_units_of_ranges() -> None:
    mechanism = ct.example("crank-rocker")
    design = design_of(mechanism, ct.grid({AB: ("3400 mm", 3.6, 3), DX: ["390 cm", 4]}))
    assert design.coordinates[AB][1].tolist() == np.linspace(3.4, 3.6, 3).tolist()
    assert design.coordinates[DX][1].tolist() == [3.9, 4.0]
    guided = design_of(ct.example("elliptic-trammel"), {"guides.B.direction": ["90 deg", "91 deg"]})
    np.testing.assert_array_equal(
        guided.coordinates["guides.B.direction"][1], np.array([90, 91]) * (np.pi / 180)
    )


def test_latin_hypercubes_fill_every_slice_once() -> None:
    design = design_of(ct.example("crank-rocker"), ct.sample({AB: (3.4, 3.6), DX: ("3.9 m", "4.1 m")}, 200))
    for path, low in ((AB, 3.4), (DX, 3.9)):
        values = design.coordinates[path][1]
        # a value at the edge of a slice may be rounded into its neighbour; none of these is
        assert sorted(np.floor((values - low) / 0.2 * 200).astype(int).tolist()) == list(range(200))


def test_sobol_points_are_balanced() -> None:
    design = design_of(
        ct.example("crank-rocker"), ct.sample({AB: (3.0, 4.0), DX: (3.0, 5.0)}, 64, "sobol", seed=3)
    )
    x, y = design.coordinates[AB][1] - 3.0, (design.coordinates[DX][1] - 3.0) / 2.0
    counts, _edges, _others = np.histogram2d(x, y, bins=8, range=[[0, 1], [0, 1]])
    assert (counts == 1).all()


@pytest.mark.parametrize("method", ["latin hypercube", "sobol"])
def test_the_seed_decides(method: str) -> None:
    mechanism = ct.example("crank-rocker")
    one, same, other = (
        design_of(mechanism, ct.sample({AB: (3.4, 3.6)}, 10, method, seed)).coordinates[AB][1]
        for seed in (1, 1, 2)
    )
    assert (one == same).all()
    assert (one != other).any()
    assert ((one >= 3.4) & (one <= 3.6)).all()
