"""`centrode sweep` as a user meets it."""

from __future__ import annotations

import csv
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

import centrode as ct

Centrode = Callable[..., Any]

STUDY = """\
mechanism = "crank-rocker"
outputs = ["position.B", "angle.DB"]
samples = 19
to = "180 deg"
reduce = "range"
[grid]
links.AB.length = { from = "3.2 m", to = "3800 mm", count = 3 }
"frame.points.D.x" = [3.9, 4.0]
"""


def expected(**more: Any) -> xr.Dataset:
    ranges = {"links.AB.length": np.linspace(3.2, 3.8, 3), "frame.points.D.x": [3.9, 4.0]}
    asked = {"outputs": ["position.B", "angle.DB"], "reduce": "range", **more}
    return ct.sweep(ct.example("crank-rocker"), ct.grid(ranges), samples=19, stop=np.pi, **asked)


@pytest.fixture
def study(folder: Path) -> Path:
    (folder / "study.toml").write_text(STUDY, encoding="utf-8")
    return folder / "study.toml"


def test_a_store_and_its_summary(centrode: Centrode, folder: Path, study: Path) -> None:
    pytest.importorskip("zarr", reason="stores need the extra sweeps")
    done = centrode("sweep", "study.toml")
    assert (done.code, done.err) == (0, "")
    assert done.rows["mechanisms"] == "6 (3 x 2)"
    assert done.rows["samples"] == "19"
    assert done.rows["ok"] == "at every sample 6, at some 0, at none 0"
    assert done.rows["executor"] == "arrays"
    found = expected()
    low, high = float(found["angle.DB"].min()), float(found["angle.DB"].max())
    assert done.rows["angle.DB"] == f"{low:.9g} to {high:.9g} rad"
    assert done.out.endswith("\nwrote study.zarr\n")
    with xr.open_zarr("study.zarr") as data:
        xr.testing.assert_equal(data, found)
    again = centrode("sweep", "study.toml")
    assert (again.code, again.out) == (0, done.out)
    assert again.err == "6 mechanisms were computed in an earlier run\n"


def test_a_table(centrode: Centrode, folder: Path, study: Path) -> None:
    done = centrode("sweep", "study.toml", "--out", "r.csv")
    assert (done.code, done.err) == (0, "")
    with (folder / "r.csv").open(encoding="utf-8", newline="") as stream:
        rows = list(csv.DictReader(stream))
    found = expected()
    assert list(rows[0]) == [
        "links.AB.length [m]", "frame.points.D.x [m]", "position_B_x [m]", "position_B_y [m]", "angle_DB [rad]",
        "samples_ok", "worst_residual",
    ]  # fmt: skip
    for k, row in enumerate(rows):
        i, j = divmod(k, 2)
        assert float(row["links.AB.length [m]"]) == np.linspace(3.2, 3.8, 3)[i]
        assert float(row["frame.points.D.x [m]"]) == [3.9, 4.0][j]
        assert float(row["position_B_y [m]"]) == float(found["position.B"][i, j, 1])
        assert float(row["angle_DB [rad]"]) == float(found["angle.DB"][i, j])
    refused = centrode("sweep", "study.toml", "--out", "r.csv")
    assert (refused.code, refused.err) == (2, "Error: r.csv: exists already; add --force to replace it\n")
    assert centrode("sweep", "study.toml", "--out", "r.csv", "--force").code == 0


def test_formulas_samples_and_a_mechanism_beside_the_study(centrode: Centrode, folder: Path) -> None:
    (folder / "here").mkdir()
    (folder / "here" / "mine.toml").write_text(
        ct.mechanism_text(ct.example("crank-rocker")), encoding="utf-8"
    )
    (folder / "here" / "study.toml").write_text(
        'mechanism = "mine.toml"\nsamples = 9\n'
        '[reduce]\nswing = "range(angle_DB)"\n'
        '[sample]\ncount = 8\nmethod = "sobol"\nseed = 2\n'
        '[sample.ranges]\nlinks.AB.length = ["3.4 m", 3.6]\nlinks.DB.length = { from = 2.9, to = "3.1 m" }\n',
        encoding="utf-8",
    )
    done = centrode("sweep", "here/study.toml", "--out", "r.csv")
    assert (done.code, done.err) == (0, "")
    ranges = {"links.AB.length": (3.4, 3.6), "links.DB.length": (2.9, 3.1)}
    design = ct.sample(ranges, 8, "sobol", seed=2)
    found = ct.sweep(ct.example("crank-rocker"), design, samples=9, reduce={"swing": "range(angle_DB)"})
    ct.write(found, folder / "again")
    assert (folder / "r.csv").read_bytes() == (folder / "again" / "sweep.csv").read_bytes()


def test_no_mechanism_that_moves_is_exit_3(centrode: Centrode, folder: Path, study: Path) -> None:
    study.write_text(STUDY.replace('{ from = "3.2 m", to = "3800 mm", count = 3 }', "[20.0, 21.0]"))
    done = centrode("sweep", "study.toml", "--out", "r.csv")
    assert done.code == 3
    assert "no mechanism has a valid sample" in done.err
    assert done.rows["ok"] == "at every sample 0, at some 0, at none 4"
    assert done.rows["angle.DB"] == "no number"
    assert (folder / "r.csv").exists()


WRONG = [
    (STUDY + "[vary]\nlinks.AB.length = [1]\n", "exactly one of [vary], [grid], [sample]"),
    (STUDY.replace('mechanism = "crank-rocker"', ""), "study.toml, mechanism: it is missing"),
    (STUDY.replace("crank-rocker", "crank-rokcer"), 'did you mean "crank-rocker"'),
    (STUDY.replace("outputs", "output"), 'unknown key "output"; did you mean "outputs"'),
    (STUDY.replace('["position.B", "angle.DB"]', "3"), "expected a list of texts"),
    (STUDY.replace("samples = 19", "samples = 0"), "0 samples are given"),
    (STUDY.replace("samples = 19", 'samples = "many"'), "expected a whole number"),
    (STUDY.replace("180 deg", "180 kg"), "to: expected an angle"),
    (STUDY.replace('to = "180 deg"', "to = [1]"), "to: expected a number or a text"),
    (STUDY.replace('"range"', '"rnage"'), 'did you mean "range"'),
    (STUDY.replace('"range"', "[1]"), "expected a text, or a table of formulas"),
    (STUDY.replace("count = 3", "number = 3"), 'unknown key "number"'),
    (STUDY.replace(", count = 3", ""), "count is missing"),
    (STUDY.replace("3800 mm", "3000 mm"), "does not increase"),
    (STUDY.replace("links.AB", "links.AX"), "there is no"),
    (STUDY.replace("[grid]", 'executor = "machine codes"\n[grid]'), 'did you mean "machine code"'),
    (STUDY.replace("[grid]", "executor = 3\n[grid]"), "executor: expected a text"),
    (STUDY.replace("[grid]", "[[grid]]"), "expected a table"),
    (STUDY + "[", "not TOML"),
    ('mechanism = "kite"\n[sample]\ncount = 3\n', "needs count and ranges"),
]


@pytest.mark.parametrize(("text", "message"), WRONG, ids=[message for _text, message in WRONG])
def test_studies_that_are_refused(
    centrode: Centrode, folder: Path, study: Path, text: str, message: str
) -> None:
    study.write_text(text, encoding="utf-8")
    done = centrode("sweep", "study.toml", "--out", "r.csv")
    assert (done.code, done.out) == (2, "")
    assert message in done.err
    assert done.err.startswith("Error: study.toml")
    assert [file.name for file in folder.iterdir()] == ["study.toml"]


def test_places_that_are_refused(centrode: Centrode, folder: Path, study: Path) -> None:
    study.write_text(STUDY.replace('reduce = "range"\n', ""))
    assert "reduced results only" in centrode("sweep", "study.toml", "--out", "r.csv").err
    assert "neither a .zarr nor a .csv" in centrode("sweep", "study.toml", "--out", "r.nc").err
    assert "there is no such file" in centrode("sweep", "nothing.toml").err
    (folder / "r.zarr").mkdir()
    (folder / "r.zarr" / "x").touch()
    pytest.importorskip("zarr", reason="stores need the extra sweeps")
    assert "holds something else" in centrode("sweep", "study.toml", "--out", "r.zarr").err


def test_an_interrupted_table_is_not_written(
    centrode: Centrode, folder: Path, study: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("centrode.sweeps.designs.BLOCK_POSITIONS", 1)

    def stop(self: object, what: str, done: int = 0, of: int = 0) -> None:
        if done == 3:
            raise KeyboardInterrupt

    monkeypatch.setattr("centrode.cli.sweep.Progress.say", stop)
    done = centrode("sweep", "study.toml", "--out", "r.csv")
    assert (done.code, done.out) == (130, "")
    assert not (folder / "r.csv").exists()
    pytest.importorskip("zarr", reason="stores need the extra sweeps")
    done = centrode("sweep", "study.toml", "--out", "r.zarr")
    assert done.code == 130
    assert "the same command resumes from there" in done.err
