"""A sweep is the motions of its mechanisms, whatever the chunks; reductions and formulas are NumPy's."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import xarray as xr

import centrode as ct
from centrode.quantities import QUANTITIES
from centrode.sweeps import designs
from centrode.sweeps.outputs import DERIVED
from mechanisms import EPS

CASES: list[tuple[str, dict[str, Any], int]] = [
    (
        "crank-rocker",
        {"links.AB.length": np.linspace(3.2, 3.8, 23), "frame.points.D.x": np.linspace(3.9, 4.1, 23)},
        37,
    ),
    ("slider-crank-offset", {"guides.B.through.y": np.linspace(0.0, 2.5, 17)}, 25),
    ("triple-rocker", {"links.OA.length": np.linspace(1.8, 2.6, 11)}, 31),
    ("five-bar-two-drives", {}, 19),
    ("geared-five-bar", {}, 19),
    ("rolling-wheel-rod", {}, 19),
    ("third-class-triad", {}, 19),
    ("spherical-four-bar", {}, 19),
]


def varied(name: str, vary: dict[str, Any]) -> dict[str, Any]:
    """What varies: as given, else the mechanism's first length by 2 %."""
    if vary:
        return vary
    mechanism = ct.example(name)
    link = next(link for link in mechanism.links if mechanism.links[link].length is not None)
    path = f"links.{link}.length"
    return {path: ct.value_at(mechanism, path) * np.linspace(0.98, 1.02, 9)}


@pytest.fixture
def small_chunks(monkeypatch: pytest.MonkeyPatch) -> None:
    """A few mechanisms at once, a few chunks in a block."""
    monkeypatch.setattr(designs, "WORKING_SET", 250_000)
    monkeypatch.setattr(designs, "BLOCK_POSITIONS", 3_000)


def quantities(motion: xr.Dataset) -> list[str]:
    """Everything a motion has at each sample of its own; what it derives from that is not swept."""
    own = [name for name in QUANTITIES if name in motion.data_vars and name not in DERIVED]
    return [name for name in own if "sample" in motion[name].dims]


@pytest.mark.usefixtures("small_chunks")
@pytest.mark.parametrize(("name", "vary", "samples"), CASES, ids=[case[0] for case in CASES])
def test_a_sweep_is_its_motions_bit_by_bit(name: str, vary: dict[str, Any], samples: int) -> None:
    mechanism, vary = ct.example(name), varied(name, vary)
    motion = ct.motion(mechanism, samples, vary=vary)
    outputs = [quantity for quantity in quantities(motion) if quantity != "status"]
    calls: list[tuple[int, int]] = []
    found = ct.sweep(mechanism, vary, outputs, samples, progress=lambda done, of: calls.append((done, of)))
    count = len(next(iter(vary.values())))
    assert calls[-1] == (count, count)
    assert len(calls) > 2, "one chunk proves nothing"
    for quantity in [*outputs, "status"]:
        assert found[quantity].dims == motion[quantity].dims
        np.testing.assert_array_equal(found[quantity], motion[quantity])
        assert found[quantity].attrs["units"] == motion[quantity].attrs["units"]
    np.testing.assert_array_equal(found["samples_ok"], (motion["status"] == ct.Status.OK).sum("sample"))
    np.testing.assert_array_equal(found["worst_residual"], motion["residual"].max("sample"))
    for coordinate in ("time", "drive_value", *vary):
        np.testing.assert_array_equal(found[coordinate], motion[coordinate])


def test_parts_of_quantities() -> None:
    mechanism = ct.example("crank-rocker")
    vary = {"links.AB.length": ["3400 mm", 3.5]}
    motion = ct.motion(mechanism, 7, vary={"links.AB.length": [3.4, 3.5]})
    names = ["position.B", "position.B.x", "velocity", "angle.AB", "angular_velocity_coefficient.DB"]
    found = ct.sweep(mechanism, vary, names, 7)
    assert found["position.B"].dims == ("mechanism", "sample", "axis")
    assert found["angle.AB"].dims == ("mechanism", "sample")
    np.testing.assert_array_equal(found["position.B"], motion["position"].sel(point="B"))
    np.testing.assert_array_equal(found["position.B.x"], motion["position"].sel(point="B", axis="x"))
    np.testing.assert_array_equal(found["angle.AB"], motion["angle"].sel(link="AB"))
    rates = motion["angular_velocity_coefficient"].sel(link="DB")
    np.testing.assert_array_equal(found["angular_velocity_coefficient.DB"], rates)
    assert list(found.data_vars) == [*names, "status", "samples_ok", "worst_residual"]


def test_grids_stand_in_order() -> None:
    mechanism = ct.example("crank-rocker")
    lengths, places = np.linspace(3.4, 3.6, 3), np.array([3.9, 4.0, 4.1, 4.15])
    ranges = {"links.AB.length": ("3.4 m", "3600 mm", 3), "frame.points.D.x": places}
    found = ct.sweep(mechanism, ct.grid(ranges), "angle.DB", 9)
    assert found["angle.DB"].dims == ("links.AB.length", "frame.points.D.x", "sample")
    np.testing.assert_array_equal(found["links.AB.length"], lengths)
    for length in lengths:
        for place in places:
            one = ct.with_value(
                ct.with_value(mechanism, "links.AB.length", length), "frame.points.D.x", place
            )
            column = found["angle.DB"].sel({"links.AB.length": length, "frame.points.D.x": place})
            np.testing.assert_array_equal(column, ct.motion(one, 9)["angle"].sel(link="DB"))


def open_cases() -> tuple[ct.Mechanism, dict[str, Any]]:
    """A crank-rocker of which some couplers do not reach round, and some reach nowhere."""
    return ct.example("crank-rocker"), {
        "links.AB.length": np.concatenate([np.linspace(1.2, 6.8, 40), np.linspace(9.0, 12.0, 10)])
    }


@pytest.mark.usefixtures("small_chunks")
@pytest.mark.parametrize("name", ["min", "max", "range", "mean"])
def test_reductions_are_numpys(name: str) -> None:
    mechanism, vary = open_cases()
    motion = ct.motion(mechanism, 37, vary=vary)
    ok = motion["status"].to_numpy() == ct.Status.OK
    whole, none = ok.all(axis=1), ~ok.any(axis=1)
    assert min(whole.sum(), none.sum(), (~whole & ~none).sum()) >= 5, "of each kind a few"
    found = ct.sweep(mechanism, vary, ["position.B", "angular_velocity"], 37, reduce=name)
    for output, values in (
        ("position.B", motion["position"].sel(point="B").to_numpy()),
        ("angular_velocity", motion["angular_velocity"].to_numpy()),
    ):
        assert found[output].dims == ("mechanism", *found[output].dims[1:])
        for lane in range(len(ok)):
            kept = values[lane][ok[lane]]
            number = found[output].to_numpy()[lane]
            if not len(kept):
                assert np.isnan(number).all()
            elif name == "mean":
                allowed = 2 * len(kept) * EPS * np.abs(kept).mean(axis=0)
                assert (np.abs(number - kept.mean(axis=0)) <= allowed).all()
            else:
                expected = {"min": kept.min(0), "max": kept.max(0), "range": np.ptp(kept, 0)}[name]
                np.testing.assert_array_equal(number, expected)
    np.testing.assert_array_equal(found["samples_ok"], ok.sum(axis=1))
    told = found.attrs
    assert told["mechanisms"] == len(ok)
    assert told["mechanisms_whole"] == ok.all(axis=1).sum()
    assert told["mechanisms_none"] == (~ok.any(axis=1)).sum()
    least = [np.nanmin(found["position.B"].to_numpy()[:, axis]) for axis in range(2)]
    assert found["position.B"].attrs["least"] == least


def test_mechanisms_without_any_sample_are_nan() -> None:
    mechanism = ct.example("crank-rocker")
    vary = {"links.AB.length": [3.5, 20.0]}
    reduced = ct.sweep(mechanism, vary, ["angle.DB"], 7, reduce="mean")
    assert reduced["samples_ok"].values.tolist() == [7, 0]
    assert np.isfinite(reduced["angle.DB"].values).tolist() == [True, False]
    formula = ct.sweep(mechanism, vary, samples=7, reduce="1 + links_AB_length")
    assert formula["value"].values[0] == 4.5
    assert np.isnan(formula["value"].values[1])
    whole = ct.sweep(mechanism, vary, ["angle.DB"], 7)
    assert (whole["status"].values[1] == ct.Status.OPEN).all()
    assert np.isnan(whole["angle.DB"].values[1]).all()


@pytest.mark.usefixtures("small_chunks")
def test_formulas_of_the_motion() -> None:
    mechanism, vary = open_cases()
    motion = ct.motion(mechanism, 37, vary=vary)
    ok = motion["status"] == ct.Status.OK
    formulas = {
        "swing": "range(angle_DB) / links_AB_length",
        "wander": "max(abs(position_B_y - mean(position_B_y)))",
        "when": "max(time) + max(drive_OA)",
        "far": "sqrt(max(position_B_x^2 + position_B_y^2))",
        "work": "sum(velocity_B_x * acceleration_B_x)",
        "either": "max(min(angle_DB), min(angle_AB))",
    }
    found = ct.sweep(mechanism, vary, samples=37, reduce=formulas)
    angle = motion["angle"].where(ok)
    b, v, a = (motion[name].sel(point="B").where(ok) for name in ("position", "velocity", "acceleration"))
    x, y = b.sel(axis="x"), b.sel(axis="y")
    db = angle.sel(link="DB")
    swing = (db.max("sample") - db.min("sample")) / motion["links.AB.length"]
    np.testing.assert_array_equal(found["swing"], swing)
    size = float(np.abs(y).max())
    wander = np.abs(y - y.mean("sample")).max("sample")
    np.testing.assert_allclose(found["wander"], wander, rtol=0, atol=2 * 37 * EPS * size)
    when = motion["time"].where(ok).max("sample") + motion["drive_value"][:, 0].where(ok).max("sample")
    np.testing.assert_array_equal(found["when"], when)
    np.testing.assert_array_equal(found["far"], np.sqrt((x * x + y * y).max("sample")))
    product = v.sel(axis="x") * a.sel(axis="x")
    work = product.sum("sample", min_count=1)
    allowed = 2 * 37 * EPS * np.abs(product).sum("sample").to_numpy()
    difference = np.abs(found["work"].to_numpy() - work.to_numpy())
    assert ((difference <= allowed) | np.isnan(work.to_numpy())).all()
    np.testing.assert_array_equal(np.isnan(found["work"]), np.isnan(work))
    either = np.maximum(db.min("sample"), angle.sel(link="AB").min("sample"))
    np.testing.assert_array_equal(found["either"], either)
    assert found["swing"].attrs["formula"] == formulas["swing"]


def test_one_formula_has_the_name_value() -> None:
    found = ct.sweep(
        ct.example("crank-rocker"), {"links.AB.length": [3.5]}, samples=5, reduce="mean(angle_OA) + 0"
    )
    motion = ct.motion(ct.example("crank-rocker"), 5)
    expected = motion["angle"].sel(link="OA").mean()
    assert abs(float(found["value"][0]) - float(expected)) <= 10 * EPS * float(expected)


def test_range_of_the_motion_is_the_motions() -> None:
    mechanism = ct.example("crank-rocker")
    vary = {"links.AB.length": [3.4, 3.5]}
    found = ct.sweep(mechanism, vary, "angle", 11, start=0.2, stop=0.9)
    np.testing.assert_array_equal(found["angle"], ct.motion(mechanism, 11, 0.2, 0.9, vary=vary)["angle"])


def test_executors_are_told() -> None:
    mechanism, vary = ct.example("crank-rocker"), {"links.AB.length": [3.5]}
    for name in ("auto", "arrays"):
        assert ct.sweep(mechanism, vary, "angle", 3, executor=name).attrs["executor"] == "arrays"
    with pytest.raises(ct.InputError, match='did you mean "arrays"'):
        ct.sweep(mechanism, vary, "angle", 3, executor="array")


@pytest.mark.usefixtures("small_chunks")
def test_an_interruption_keeps_whole_blocks() -> None:
    mechanism, vary = ct.example("crank-rocker"), {"links.AB.length": np.linspace(3.2, 3.8, 60)}
    whole = ct.sweep(mechanism, vary, "angle", 37)

    def stop(done: int, of: int) -> None:
        if done > of / 2:
            raise KeyboardInterrupt

    with pytest.warns(RuntimeWarning, match="interrupted: "):
        part = ct.sweep(mechanism, vary, "angle", 37, progress=stop)
    kept = part.attrs["mechanisms"]
    assert 0 < kept < 60
    np.testing.assert_array_equal(part["angle"][:kept], whole["angle"][:kept])
    assert np.isnan(part["angle"][kept:]).all()
    assert (part["samples_ok"][kept:] == -1).all()


def test_what_is_written_to_a_result_stays_in_it() -> None:
    """The description's own motion is kept for the next sweep: a result holds copies of its coordinates."""
    mechanism = ct.example("crank-rocker")

    def computed() -> xr.Dataset:
        return ct.sweep(mechanism, {"links.AB.length": [3.4, 3.6]}, ["angle.DB"], 37)

    first = computed()
    expected = first.copy(deep=True)
    for name in ("time", "drive_value"):
        first[name].values[...] = 7.0
        first[name].attrs.clear()
    xr.testing.assert_identical(computed(), expected)


@pytest.mark.parametrize("reduce", [None, "max"])
def test_outputs_that_are_no_names(reduce: str | None) -> None:
    with pytest.raises(ct.InputError, match="an output is a text"):
        ct.sweep("crank-rocker", {"links.AB.length": [3.4]}, 3, 37, reduce=reduce)  # type: ignore[arg-type]
