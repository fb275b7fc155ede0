"""Sweeps and variants on their sheets: numbers stay numbers, names and refusals come out as they were written."""

from __future__ import annotations

import csv
import math
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import centrode as ct
from centrode.assignments.results import VariantRow, Variants
from centrode.render.files import write_table
from centrode.render.table_files import TableSpelling
from centrode.sweeps import sweep

CRANK_ROCKER = ct.example("crank-rocker")


def swept(**options: object) -> xr.Dataset:
    """Three mechanisms, the last of which does not assemble."""
    lengths = {"links.AB.length": [3.4, 3.5, 20.0]}
    return ct.sweep(CRANK_ROCKER, lengths, ["position.B", "angle.DB"], samples=9, **options)  # type: ignore[arg-type]


def test_a_sweep_is_a_table_of_its_own_numbers(tmp_path: Path) -> None:
    results = swept(reduce="max")
    columns = {column.name: column for column in ct.tables(results)["sweep"].columns}
    assert list(columns) == [
        "links.AB.length", "position_B_x", "position_B_y", "angle_DB", "samples_ok", "worst_residual",
    ]  # fmt: skip
    angles = results["angle.DB"].to_numpy()
    assert np.array_equal(np.asarray(columns["angle_DB"].values), angles, equal_nan=True)
    assert columns["angle_DB"].unit == "rad" and math.isnan(angles[2])
    ct.write(results, tmp_path / "out")
    with (tmp_path / "out" / "sweep.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["samples_ok"] for row in rows] == ["9", "9", "0"]
    assert float(rows[1]["angle_DB [rad]"]) == angles[1] and rows[2]["angle_DB [rad]"] == ""


def test_a_sweep_in_words() -> None:
    lines = dict(line.split("  ", 1) for line in ct.summary(swept(reduce="max")).splitlines())
    assert lines["mechanisms"].strip() == "3"
    assert lines["ok"].strip() == "at every sample 2, at some 0, at none 1"
    assert lines["executor"].strip() == "arrays"
    assert lines["angle.DB"].endswith(" rad") and " to " in lines["angle.DB"]


def test_a_sweep_that_is_no_table_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    whole = swept()
    assert "angle.DB" not in ct.summary(whole)
    with pytest.raises(ct.InputError, match="reduced results only"):
        ct.tables(whole)["sweep"]
    monkeypatch.setattr(sweep, "TABLE_ROWS", 2)
    with pytest.raises(ct.InputError, match="at most 2 mechanisms, here are 3"):
        ct.tables(swept(reduce="max"))["sweep"]


@pytest.mark.parametrize("hostile", ["1.50", "run 30 deg", "$x_1$", "<b>"])
def test_names_of_variants_come_out_character_by_character(hostile: str, tmp_path: Path) -> None:
    rows = (
        VariantRow(hostile, False, 1.25, "rad", "group CB-BD (point B)", "CB and BD are collinear", "locks"),
        VariantRow("other", None, None, "", "", "length must be positive, got -1", "refused"),
    )
    found = Variants(CRANK_ROCKER, (), rows)
    lines = ct.summary(found).splitlines()
    assert lines[1].startswith(f"{hostile} ") and " 1.25 rad  group CB-BD" in lines[1]
    assert lines[-1] == "2 variants: locks 1, refused 1"
    write_table(
        ct.tables(found)["summary"], tmp_path / "t.csv", CRANK_ROCKER.display, TableSpelling(comma=True)
    )
    with (tmp_path / "t.csv").open(encoding="utf-8-sig", newline="") as file:
        first, second = list(csv.reader(file, delimiter=";"))[1:]
    assert first == [hostile, "no", "1,25", "group CB-BD (point B)", "CB and BD are collinear", "locks"]
    assert second[4] == "length must be positive, got -1"
