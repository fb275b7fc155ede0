"""Sheets as files of a folder: tables, datasets and outlines as files of their kinds, the summary as JSON."""

from __future__ import annotations

import csv
import json
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from centrode.locale import speaking
from centrode.model.settings import shown_as
from centrode.render.netcdf import write_dataset
from centrode.render.outlines import write_outlines
from centrode.render.spelling import DataSpelling
from centrode.render.table_files import PLAIN, TableSpelling

if TYPE_CHECKING:
    from centrode.model.settings import Display
    from centrode.sheets.sheet import Column, Scalar, Sheet, Table

BLOCK = 10_000
"""Rows that become text at once: as Python's own numbers they take many times the memory of an array."""


def write_tables(sheet: Sheet, folder: Path, display: Display, spelling: TableSpelling = PLAIN) -> None:
    """Write the tables of a sheet as CSV (and as workbooks where `spelling` says so), its datasets as netCDF.

    Outlines are written as drawings in true size; further files as they are. What is named behind a folder is in it.
    """
    for name in (*sheet.tables, *sheet.datasets, *sheet.files, *sheet.outlines):
        (folder / name).parent.mkdir(exist_ok=True)
    for name, table in sheet.tables.items():
        write_table(table, folder / f"{name}.csv", display, spelling)
    for name, dataset in sheet.datasets.items():
        write_dataset(dataset, folder / f"{name}.nc")
    for name, text in sheet.files.items():
        (folder / name).write_text(text, encoding="utf-8")
    for name, outlines in sheet.outlines.items():
        write_outlines(outlines, folder / name)


def write_summary(scalars: Mapping[str, Scalar], path: Path) -> None:
    """Write numbers with their SI units as JSON; no file where there are none."""
    if not scalars:
        return
    text = json.dumps({name: one.as_dict() for name, one in scalars.items()}, indent=2, allow_nan=False)
    path.write_text(text + "\n", encoding="utf-8")


def write_record(record: Mapping[str, Any], path: Path) -> None:
    """Write a result as JSON, names in their own letters; texts of a sheet in English, with numbers in SI."""
    with speaking("en"):
        text = json.dumps(
            record, indent=2, ensure_ascii=False, allow_nan=False, default=DataSpelling(None).text
        )
    path.write_text(text + "\n", encoding="utf-8", newline="\n")


def write_table(
    table: Table, path: Path, display: Display, spelling: TableSpelling = PLAIN, workbook: Path | None = None
) -> None:
    """Write a table as CSV in UTF-8, one line end everywhere; numbers read back bit for bit, one that is NaN is empty.

    With decimal commas fields are apart by semicolons, and a byte order mark goes before them: without it spreadsheets
    take UTF-8 for a code page of theirs. Names and words keep their dots. A workbook stands beside it where one is
    wanted, if no other file is named for it.
    """
    encoding, delimiter, mark = ("utf-8-sig", ";", ",") if spelling.comma else ("utf-8", ",", ".")
    words = DataSpelling(display)
    headers = [header(column, display) for column in table.columns]
    with path.open("w", encoding=encoding, newline="") as file:
        writer = csv.writer(file, delimiter=delimiter, lineterminator="\n")
        writer.writerow(headers)
        for first in range(0, len(table.columns[0].values), BLOCK):
            fields = [_fields(column, slice(first, first + BLOCK), words, mark) for column in table.columns]
            writer.writerows(zip(*fields, strict=True))
    spelling.write_workbook(
        workbook or path.with_suffix(".xlsx"), headers, lambda: shown_columns(table, display)
    )


def shown_columns(table: Table, display: Display | None) -> list[list[float] | list[str]]:
    """The columns of a table: numbers in the units of the display, in SI without one, and texts."""
    words = DataSpelling(display)
    return [_cells(column, words) for column in table.columns]


def header(column: Column, display: Display | None) -> str:
    """Name of a column with the unit it is shown in: "velocity_B_x [mm/s]"."""
    unit = _shown(column, display)[1]
    return f"{column.name} [{unit}]" if unit not in ("", "1") else column.name


def _shown(column: Column, display: Display | None) -> tuple[float, str]:
    """Factor and unit in which a column appears."""
    return shown_as(column.unit, None if column.unit_fixed else display)


def _cells(column: Column, words: DataSpelling, rows: slice = slice(None)) -> list[float] | list[str]:
    """Numbers in the unit shown, or texts."""
    values = column.values[rows]
    if not isinstance(values, np.ndarray):
        return [words.text(text) for text in values]
    factor = _shown(column, words.display)[0]
    numbers: list[float] = (values if factor == 1.0 else values * factor).tolist()
    return numbers


def _number(cell: float, column: Column) -> float | int:
    return int(cell) if column.whole else cell


def _fields(column: Column, rows: slice, words: DataSpelling, mark: str) -> list[str]:
    """Cells as fields: the shortest digits that read back as the same number."""
    return [
        cell
        if isinstance(cell, str)
        else ("" if cell != cell else repr(_number(cell, column)).replace(".", mark))
        for cell in _cells(column, words, rows)
    ]
