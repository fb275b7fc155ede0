"""Tables as inputs of formulas, formulas of every sample and their derivatives, room given by the caller."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import xarray as xr

import centrode as ct
from centrode.cli.main import main
from centrode.numerics.machine_code import PRESENT
from centrode.sweeps.sample_tables import read_columns

EXECUTORS = ["arrays", pytest.param("machine code", marks=pytest.mark.skipif(not PRESENT, reason="llvmlite"))]
SAMPLES = 37
VARY = {"links.AB.length": [3.45, 3.5, 3.6], "links.OA.length": [1.0, 1.01, 0.98]}
FORMULAS = {
    "dx": "position_B_x - target_x",
    "dy": "position_B_y - target_y",
    "error": "mean(dx^2 + dy^2)",
    "beside": "dx - mean(dx)",
}
EPS = float(np.finfo(float).eps)


def targets() -> dict[str, Any]:
    position = ct.motion("crank-rocker", samples=SAMPLES).position.sel(point="B")
    return {"target_x": position.sel(axis="x").values + 0.01, "target_y": position.sel(axis="y").values}


def differences(tables: dict[str, Any], vary: Any = VARY) -> tuple[Any, Any]:
    """Differences from the targets by `motion`, another way than formulas, (mechanisms, samples)."""
    position = ct.motion("crank-rocker", samples=SAMPLES, vary=vary).position.sel(point="B").values
    return position[..., 0] - tables["target_x"], position[..., 1] - tables["target_y"]


@pytest.mark.parametrize("executor", EXECUTORS)
def test_error_against_targets(executor: str) -> None:
    tables = targets()
    found = ct.sweep("crank-rocker", VARY, FORMULAS, SAMPLES, executor=executor, tables=tables)
    dx, dy = differences(tables)
    assert (found["dx"].values == dx).all()
    assert found["dx"].dims == ("mechanism", "sample")
    np.testing.assert_allclose(found["error"], (dx**2 + dy**2).mean(axis=1), rtol=SAMPLES * EPS)
    np.testing.assert_allclose(
        found["beside"], dx - dx.mean(axis=1, keepdims=True), atol=SAMPLES * EPS * np.abs(dx).max()
    )
    assert (found["target_x"].values == tables["target_x"]).all()
    assert found["error"].attrs["least"] == float(found["error"].min())


@pytest.mark.parametrize("executor", EXECUTORS)
@pytest.mark.parametrize("name", ["crank-rocker", "third-class-triad"])
def test_derivatives_against_differences(name: str, executor: str) -> None:
    path, point = {
        "crank-rocker": ("links.AB.length", "B"),
        "third-class-triad": ("links.AB.length", "C"),
    }[name]
    length = ct.value_at(ct.example(name), path)
    step = 1e-5 * length
    position = ct.motion(name, samples=SAMPLES).position.sel(point=point).values
    tables = {"target_x": 0.9 * position[:, 0]}
    tables["target_x"][5] = np.nan
    formulas = {
        "d": f"position_{point}_x - target_x",
        "error": "mean(d^2)",
        "beside": f"d - max(d) + velocity_{point}_y",
    }
    vary = {path: [length - step, length, length + step]}
    found = ct.sweep(name, vary, formulas, SAMPLES, executor=executor, tables=tables, gradient=True)
    for column in formulas:
        values, slopes = found[column].values, found[f"gradient.{column}"].values[1, ..., 0]
        change = (values[2] - values[0]) / (2.0 * step)
        # the difference errs by rounding over the step, and by the third derivative times its square
        scale = np.nanmax(np.abs(values)) + 1.0
        np.testing.assert_allclose(slopes, change, rtol=1e-6, atol=1e-6 * scale)
    assert np.isnan(found["gradient.d"].values[:, 5]).all()
    plain = ct.sweep(name, {path: [length]}, f"position.{point}", SAMPLES, executor=executor, gradient=True)
    assert plain[f"gradient.position.{point}"].dims == ("mechanism", "sample", "axis", "path")
    known = ~np.isnan(tables["target_x"])
    ours = plain[f"gradient.position.{point}"].values[0, known, 0]
    np.testing.assert_allclose(found["gradient.d"].values[1, known], ours, rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize("executor", EXECUTORS)
def test_samples_without_a_target_are_omitted(executor: str) -> None:
    tables = targets()
    tables["target_x"][3:] = np.nan
    tables["target_y"][0] = np.nan
    found = ct.sweep("crank-rocker", VARY, FORMULAS, SAMPLES, executor=executor, tables=tables)
    dx, dy = differences(tables)
    some = slice(1, 3)  # where both have a number
    np.testing.assert_allclose(found["error"], (dx**2 + dy**2)[:, some].mean(axis=1), rtol=SAMPLES * EPS)
    assert np.isnan(found["dx"].values[:, 3:]).all()
    assert (found["dx"].values[:, :3] == dx[:, :3]).all()
    worst = ct.sweep(
        "crank-rocker", VARY, samples=SAMPLES, reduce="range(position_B_x - target_x)", tables=tables,
        executor=executor,
    )  # fmt: skip
    np.testing.assert_allclose(worst["value"], np.ptp(dx[:, :3], axis=1), rtol=4 * EPS)


@pytest.mark.parametrize("executor", EXECUTORS)
def test_mechanisms_with_events(executor: str) -> None:
    tables = targets()
    vary = {"links.AB.length": [3.5, 1.9, 20.0]}
    found = ct.sweep("crank-rocker", vary, FORMULAS, SAMPLES, executor=executor, tables=tables, gradient=True)
    dx, dy = differences(tables, vary)
    ok = found["status"].values == 0
    assert (found["samples_ok"].values == ok.sum(axis=1)).all()
    squares = np.where(ok, dx**2 + dy**2, 0.0).sum(axis=1)
    np.testing.assert_allclose(found["error"][:2], (squares[:2] / ok[:2].sum(axis=1)), rtol=SAMPLES * EPS)
    assert np.isnan(found["error"].values[2])
    assert np.isnan(found["gradient.dx"].values[1:]).all()
    assert np.isfinite(found["gradient.dx"].values[0]).all()


def test_formulas_reduced_by_a_name() -> None:
    tables = targets()
    found = ct.sweep("crank-rocker", VARY, {"dx": FORMULAS["dx"]}, SAMPLES, reduce="max", tables=tables)
    assert (found["dx"].values == differences(tables)[0].max(axis=1)).all()


def test_tables_as_a_frame_and_as_a_file(tmp_path: Path) -> None:
    tables = targets()
    file = tmp_path / "targets.csv"
    rows = [
        f"{x * 1000.0!r};{'' if k == 4 else repr(y)}".replace(".", ",")
        for k, (x, y) in enumerate(zip(tables["target_x"].tolist(), tables["target_y"].tolist(), strict=True))
    ]
    file.write_text("target_x [mm];target_y\n" + "\n".join(rows) + "\n", encoding="utf-8")
    tables["target_y"][4] = np.nan
    run = {"outputs": FORMULAS, "samples": SAMPLES}
    by_frame = ct.sweep("crank-rocker", VARY, tables=pd.DataFrame(tables), **run)  # type: ignore[arg-type]
    by_file = ct.sweep("crank-rocker", VARY, tables=file, **run)  # type: ignore[arg-type]
    # a product with 1e-3 and one with 1000: two roundings of coordinates
    np.testing.assert_allclose(by_file["error"], by_frame["error"], rtol=1e-13)


@pytest.mark.parametrize("option", [True, False])
def test_the_command(option: bool, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    tables = targets()
    pd.DataFrame(tables).to_csv(tmp_path / "targets.csv", index=False)
    study = tmp_path / "study.toml"
    line = "" if option else 'tables = "targets.csv"\n'
    study.write_text(
        f'mechanism = "crank-rocker"\nsamples = {SAMPLES}\n{line}'
        '[outputs]\nerror = "mean((position_B_x - target_x)^2 + (position_B_y - target_y)^2)"\n'
        '[vary]\n"links.AB.length" = [3.45, 3.5]\n',
        encoding="utf-8",
    )
    more = ["--table", str(tmp_path / "targets.csv")] if option else []
    out = tmp_path / "errors.csv"
    assert main(["sweep", str(study), "--out", str(out), *more]) == 0
    assert "error" in capsys.readouterr().out
    found = pd.read_csv(out)
    dx, dy = differences(tables, {"links.AB.length": [3.45, 3.5]})
    column = next(name for name in found.columns if name.startswith("error"))
    np.testing.assert_allclose(found[column], (dx**2 + dy**2).mean(axis=1), rtol=1e-9)


def test_stores_keep_tables_apart(tmp_path: Path) -> None:
    pytest.importorskip("zarr")
    tables = targets()
    run = {"outputs": FORMULAS, "samples": SAMPLES, "gradient": True, "store": tmp_path / "x.zarr"}
    kept = ct.sweep("crank-rocker", VARY, tables=tables, **run)  # type: ignore[arg-type]
    here = ct.sweep("crank-rocker", VARY, FORMULAS, SAMPLES, tables=tables, gradient=True)
    for name in here.data_vars:
        assert kept[name].values.tobytes() == here[name].values.tobytes()
    with xr.open_zarr(tmp_path / "x.zarr") as plain:
        assert (plain["target_x"].values == tables["target_x"]).all()
    again = ct.sweep("crank-rocker", VARY, tables=tables, **run)  # type: ignore[arg-type]
    assert again.attrs["mechanisms_found"] == 3
    tables["target_x"][0] += 1.0
    with pytest.raises(ct.InputError, match="what differs: tables"):
        ct.sweep("crank-rocker", VARY, tables=tables, **run)  # type: ignore[arg-type]


ERROR = {"error": "mean(position_B_x - t)"}
ONES = np.ones(SAMPLES)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            {"tables": {"t": ONES[1:]}},
            r"tables t: expected 37 values, one for each sample of the motion, got 36",
        ),
        ({"tables": {"t": [[1.0]]}}, "expected 37 values, .* got 1 x 1"),
        ({"tables": {"t": ["a"] * SAMPLES}}, "its values are not numbers"),
        ({"tables": {"t": ONES * np.inf}}, "sample 0 is infinite"),
        ({"tables": {"t": ONES * np.nan}}, "no value at any sample"),
        ({"tables": {"time": ONES}}, "time. is a name of the motion already"),
        ({"tables": {"position_B_x": ONES}}, "is a name of the motion already"),
        ({"tables": {"links_AB_length": ONES}}, "is a name of the motion already"),
        ({"tables": {"mean": ONES}}, "is a name of formulas already"),
        ({"tables": {"1x": ONES}}, "cannot be the name of a table"),
        ({"tables": {"tt": ONES}}, "unknown name"),
        ({"tables": 5}, "expected a table of names and values"),
        ({"tables": {"t": ONES}, "outputs": ["position.B"]}, "no formula is given"),
        ({"tables": {"error": ONES, "t": ONES}}, "cannot be the name of a result"),
        ({"tables": {"t": ONES}, "reduce": {"a": "max(time)"}}, "outputs are formulas already"),
        ({"tables": {"t": ONES}, "out": np.empty(5)}, "nothing is kept of every sample"),
        ({"outputs": ["position.B"], "out": np.empty(5)}, "room for 5 numbers; needed: 222"),
        ({"outputs": ["position.B"], "out": [1.0]}, "contiguous"),
        ({"outputs": {"e": 5}}, "a formula is a text"),
        ({"compute": "flywheel"}, "formulas belong to sweeps of motions"),
        ({"compute": "flywheel", "outputs": None, "tables": {"t": ONES}}, "belongs to sweeps of motions"),
    ],
)
def test_what_is_refused(change: dict[str, Any], message: str) -> None:
    given: dict[str, Any] = {"vary": VARY, "outputs": ERROR, "samples": SAMPLES} | change
    if "compute" in change:
        del given["samples"]
    with pytest.raises(ct.InputError, match=message):
        ct.sweep("crank-rocker", **given)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "the file is empty"),
        ("t\nx\n", "row 2: .* is not a number"),
        ("t,u\n1\n", "row 2: it has 1 cell, the headers are 2"),
        ("t [parrot]\n1\n", "unknown unit"),
        ("t,t\n1,2\n", "is given twice"),
    ],
)
def test_files_that_are_no_tables(text: str, message: str, tmp_path: Path) -> None:
    file = tmp_path / "t.csv"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(ct.InputError, match=message):
        ct.sweep("crank-rocker", VARY, ERROR, SAMPLES, tables=file)


@pytest.mark.parametrize("executor", EXECUTORS)
def test_room_of_the_caller(executor: str) -> None:
    outputs = ["position", "velocity.B"]
    plain = ct.sweep("crank-rocker", VARY, outputs, SAMPLES, executor=executor)
    room = np.full(3 * SAMPLES * 10 + 7, 8.0)
    found = ct.sweep("crank-rocker", VARY, outputs, SAMPLES, executor=executor, out=room)
    xr.testing.assert_identical(found, plain)
    assert np.shares_memory(found["position"].values, room)
    assert (room[-7:] == 8.0).all()


def test_a_plan_that_is_kept_gives_the_same_bits() -> None:
    mechanism = ct.example("crank-rocker")
    other = {path: np.array(values) * 1.001 for path, values in VARY.items()}
    run = {"outputs": ["position.B", "angle"], "samples": SAMPLES}
    ct.sweep(mechanism, VARY, **run)  # type: ignore[arg-type]
    again = ct.sweep(mechanism, other, **run)  # type: ignore[arg-type]
    fresh = ct.sweep(ct.example("crank-rocker"), other, **run)  # type: ignore[arg-type]
    xr.testing.assert_identical(again, fresh)


def test_a_file_of_one_column(tmp_path: Path) -> None:
    """A blank line is the empty cell of a single column, and a comma in it is that of a decimal."""
    file = tmp_path / "measured.csv"
    file.write_text("\ufeffheight [mm]\n1,5\n\n2,5\n\n", encoding="utf-8")
    (values,) = read_columns(file).values()
    np.testing.assert_array_equal(values, [1.5e-3, np.nan, 2.5e-3])
    file.write_text("a,b\n1,2\n\n3,4\n", encoding="utf-8")
    assert read_columns(file) == {"a": [1.0, 3.0], "b": [2.0, 4.0]}
