"""Samples that are drawn block by block: any run of them by itself, as if all were drawn at once."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from scipy.stats import qmc

import centrode as ct
from centrode.sweeps import designs
from centrode.sweeps.designs import design_of
from centrode.sweeps.drawn_designs import DrawnDesigns, key_of, permute

RANGES = {"links.AB.length": (3.4, 3.6), "links.DB.length": ("2.9 m", 3.1), "frame.points.D.x": (3.9, 4.1)}
SPANS = {"a": (0.0, 1.0), "b": (2.0, 4.0)}


@pytest.mark.parametrize("count", [1, 2, 1000, 4096])
def test_sobol_points_are_those_of_scipy(count: int) -> None:
    """Bit for bit the points that the public engine draws in order."""
    drawn = DrawnDesigns(SPANS, count, "sobol", 7)
    points = qmc.Sobol(2, seed=np.random.default_rng(7)).random_base2((count - 1).bit_length())[:count]
    assert (drawn.values("a", 0, count) == points[:, 0]).all()
    assert (drawn.values("b", 0, count) == 2.0 + 2.0 * points[:, 1]).all()
    half = count // 2
    assert (drawn.rows(half, count)["b"] == drawn.values("b", 0, count)[half:]).all()


def test_long_sobol_sequences_stay_balanced_far_out() -> None:
    """Of 2^k points from a multiple of 2^k on each slice of 2^-k has one: the sequence's own property."""
    drawn = DrawnDesigns(SPANS, 10**12, "sobol", 0)
    first = (10**12 >> 12 << 12) - 4096
    for path, (low, high) in SPANS.items():
        unit = (drawn.values(path, first, first + 4096) - low) / (high - low)
        assert (np.sort(np.floor(unit * 4096)) == np.arange(4096)).all()
    whole = qmc.Sobol(2, bits=64, seed=np.random.default_rng(0)).random_base2(5)
    assert (drawn.values("a", 0, 32) == whole[:, 0]).all()


@pytest.mark.parametrize("count", [1, 2, 3, 1000, 65536, 65537])
def test_a_hypercube_takes_each_slice_once(count: int) -> None:
    drawn = DrawnDesigns(SPANS, count, "latin hypercube", 5)
    for path, (low, high) in SPANS.items():
        unit = (drawn.values(path, 0, count) - low) / (high - low)
        # a value may lie on the boundary of its slice by rounding
        slices = np.sort(np.floor(unit * count * (1.0 - 2.0**-50)))
        assert (slices == np.arange(count)).all()
    assert (
        np.sort(permute(np.arange(count, dtype=np.uint64), count, key_of(1, 2, 3))) == np.arange(count)
    ).all()


def test_hypercubes_are_random() -> None:
    """Ranks of two paths, and of neighbours, are uncorrelated: 5 standard deviations of independent ranks."""
    count = 20_000
    drawn = DrawnDesigns(SPANS, count, "latin hypercube", 11)
    a, b = drawn.values("a", 0, count), drawn.values("b", 0, count)
    bound = 5.0 / np.sqrt(count)
    assert abs(np.corrcoef(a, b)[0, 1]) < bound
    assert abs(np.corrcoef(a[1:], a[:-1])[0, 1]) < bound
    assert abs(np.corrcoef(a, np.arange(count))[0, 1]) < bound
    within = a * count % 1.0
    assert abs(within.mean() - 0.5) < 5.0 / np.sqrt(12.0 * count)
    assert (DrawnDesigns(SPANS, count, "latin hypercube", 12).values("a", 0, count) != a).mean() > 0.99


def test_values_of_a_long_design_are_made_when_they_are_read() -> None:
    mechanism = ct.example("crank-rocker")
    design = design_of(mechanism, ct.sample(RANGES, 10**12, "latin hypercube"))
    assert isinstance(design, DrawnDesigns)
    assert DrawnDesigns.of_text(design.text) == design
    rows = design.rows(10**12 - 3, 10**12)
    assert [len(values) for values in rows.values()] == [3, 3, 3]
    with pytest.raises(ct.InputError, match="give a whole number from 1 to 1000000000000"):
        design_of(mechanism, ct.sample(RANGES, 10**12 + 1))


@pytest.mark.parametrize("method", designs.METHODS)
def test_a_sweep_drawn_block_by_block(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, method: str) -> None:
    monkeypatch.setattr(designs, "DRAWN", 30)
    monkeypatch.setattr(designs, "BLOCK_POSITIONS", 6_000)
    mechanism, vary = ct.example("crank-rocker"), ct.sample(RANGES, 50, method, 3)
    found = ct.sweep(mechanism, vary, "angle.DB", 19, reduce="range", gradient=True)
    drawn = design_of(mechanism, vary)
    values = {path: np.asarray(found[path]) for path in RANGES}
    assert {path: x.tolist() for path, x in drawn.rows(0, 50).items()} == {
        p: x.tolist() for p, x in values.items()
    }
    listed = ct.sweep(mechanism, values, "angle.DB", 19, reduce="range", gradient=True)
    xr.testing.assert_equal(found.drop_vars("path"), listed.drop_vars("path"))
    assert found["links.DB.length"].attrs["units"] == "m"
    assert (found["links.AB.length"][5:9] == values["links.AB.length"][5:9]).all()
    assert float(found["links.AB.length"][7]) == values["links.AB.length"][7]
    pytest.importorskip("zarr", reason="stores need the extra sweeps")
    stored = ct.sweep(mechanism, vary, "angle.DB", 19, reduce="range", store=tmp_path / "r.zarr")
    assert (stored["links.AB.length"] == values["links.AB.length"]).all()
    with xr.open_zarr(tmp_path / "r.zarr", chunks=None) as plain:
        assert DrawnDesigns.of_text(plain.attrs["drawn"]) == drawn
    with pytest.raises(ct.InputError, match="what differs: vary"):
        ct.sweep(
            mechanism,
            ct.sample(RANGES, 50, method, 4),
            "angle.DB",
            19,
            reduce="range",
            store=tmp_path / "r.zarr",
        )
