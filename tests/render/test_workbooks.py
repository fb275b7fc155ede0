"""Workbooks hold the table's numbers to sixteen digits, a sheet for each quantity; decimal commas read back."""

from __future__ import annotations

import csv
import math
from pathlib import Path

import openpyxl
import pytest

import centrode as ct
from centrode.render.table_files import TableSpelling, spell_with_comma
from centrode.render.workbooks import MOST_COLUMNS, MOST_ROWS, workbook_of_csv, write_workbook
from shown_motion import columns_of, write_motion

SIXTEEN_DIGITS = 5e-16 + 2.0**-53
"""Half a unit of the sixteenth digit of a number that begins with 1, and the rounding of what is read, relatively."""


def sheets(path: Path) -> dict[str, list[tuple[object, ...]]]:
    book = openpyxl.load_workbook(path, read_only=True)
    return {sheet.title: list(sheet.iter_rows(values_only=True)) for sheet in book}


def test_every_number_of_the_table_is_on_its_sheet(make, tmp_path: Path) -> None:
    mechanism, dataset = make("worked")
    path = tmp_path / "motion.xlsx"
    points = mechanism.moving_points
    write_motion(dataset, path.with_suffix(".csv"), mechanism.display, points, TableSpelling(xlsx=True))
    headers, columns = columns_of(dataset, mechanism.display, points)
    table = dict(zip(headers, columns, strict=True))
    found = sheets(path)
    assert {"angle", "velocity", "slide_acceleration", "velocity_coefficient"} <= found.keys()
    seen = set()
    for name, (head, *rows) in found.items():
        assert [header for header in head if name in header]
        assert (head[0], head[-2], head[-1]) == ("time [s]", "status", "residual")
        for header, values in zip(head, zip(*rows, strict=True), strict=True):
            seen.add(header)
            for value, told in zip(values, table[str(header)], strict=True):
                if isinstance(told, str):
                    assert value == told
                elif math.isnan(told):
                    assert value is None
                else:
                    assert abs(float(value) - told) <= SIXTEEN_DIGITS * abs(told)
    assert seen == set(headers)


def test_samples_without_a_number_are_empty_cells(tmp_path: Path) -> None:
    dataset = ct.motion(ct.example("slider-between-cranks-locked"), 37)
    write_motion(dataset, tmp_path / "motion.csv", spelling=TableSpelling(xlsx=True))
    head, *rows = sheets(tmp_path / "motion.xlsx")["angle"]
    last = dict(zip(head, rows[18], strict=True))
    assert last["angle_CB [rad]"] is None
    assert last["status"] == "open"


def test_what_a_row_is_about_stands_on_each_sheet(tmp_path: Path) -> None:
    """Names and varied values that no quantity begins with, before the first of a quantity; four stay in view."""
    headers = [
        "time [s]",
        "first",
        "links.AB.length [m]",
        "x",
        "y",
        "position_A_x [m]",
        "case",
        "angle_A [rad]",
    ]
    write_workbook(tmp_path / "a.xlsx", headers, [[float(k)] for k in range(len(headers))])
    leading = tuple(headers[:5])
    found = sheets(tmp_path / "a.xlsx")
    assert {name: head for name, (head, _row) in found.items()} == {
        "position": (*leading, headers[5]),
        "table": (*leading, headers[6]),
        "angle": (*leading, headers[7]),
    }
    assert openpyxl.load_workbook(tmp_path / "a.xlsx")["angle"].freeze_panes == "E2"


def test_the_same_table_gives_the_same_bytes(tmp_path: Path) -> None:
    for name in ("a", "b"):
        write_workbook(tmp_path / name, ["time [s]", "angle_A [rad]"], [[0.0, 1.0], [0.1, 0.2]])
    assert (tmp_path / "a").read_bytes() == (tmp_path / "b").read_bytes()


def test_text_that_looks_like_a_formula_stays_text(tmp_path: Path) -> None:
    write_workbook(tmp_path / "a.xlsx", ["=1+1", "link"], [["=SUM(A1)", "{=B1}"], ["http://x", "+1"]])
    book = openpyxl.load_workbook(tmp_path / "a.xlsx")
    assert [cell.data_type for row in book["table"] for cell in row] == ["s"] * 6


@pytest.mark.parametrize(("rows", "columns"), [(MOST_ROWS + 1, 1), (1, MOST_COLUMNS + 1)])
def test_what_no_sheet_holds_is_refused(rows: int, columns: int, tmp_path: Path) -> None:
    with pytest.raises(ct.InputError, match="a sheet holds 1048575 rows"):
        write_workbook(tmp_path / "a.xlsx", ["x"] * columns, [range(rows)] * columns)
    assert not (tmp_path / "a.xlsx").exists()


def test_decimal_commas(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text('name,x [m]\n"A, 1.5",0.25\nv1.2,-1e-09\n,3\n1.2.3,1.5e+20\n', encoding="utf-8")
    spell_with_comma(path)
    assert path.read_bytes().startswith(b"\xef\xbb\xbf")
    with path.open(encoding="utf-8-sig", newline="") as file:
        rows = list(csv.reader(file, delimiter=";"))
    assert rows == [
        ["name", "x [m]"],
        ["A, 1.5", "0,25"],
        ["v1.2", "-1e-09"],
        ["", "3"],
        ["1.2.3", "1,5e+20"],
    ]


def test_names_that_python_reads_as_numbers_stay_names(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text(
        "joint,x [m],y [m]\n1_0,1.5,inf\nnan,,2.0\ninf,-1e-05,1e+16\n", encoding="utf-8"
    )
    workbook_of_csv(tmp_path / "a.csv", tmp_path / "a.xlsx")
    assert list(sheets(tmp_path / "a.xlsx")["table"]) == [
        ("joint", "x [m]", "y [m]"), ("1_0", 1.5, None), ("nan", None, 2), ("inf", -1e-5, 1e16)
    ]  # fmt: skip
