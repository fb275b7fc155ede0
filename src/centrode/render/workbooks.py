"""Tables as workbooks (XLSX): a sheet for each quantity, units in the headers; the same table gives the same bytes."""

from __future__ import annotations

import csv
import datetime
import math
import re
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

import xlsxwriter

from centrode.errors import InputError
from centrode.locale import _
from centrode.quantities import QUANTITIES

if TYPE_CHECKING:
    from xlsxwriter.worksheet import Worksheet

Column: TypeAlias = Sequence[float | str] | Sequence[float] | Sequence[str]

MOST_ROWS, MOST_COLUMNS, MOST_LETTERS = 1_048_575, 16_384, 31
"""Rows below the header, columns and letters of a sheet's name that the format holds."""
ALONG = ("time", "drive", "turned", "carrier_angle", "cam_angle")
"""Quantities that tell where a row is: each sheet begins with them."""
FROZEN = 4
"""The most columns that stay in view: more of them would leave no room for the others."""
NUMBER = re.compile(r"-?\d+(\.\d+)?(e[+-]?\d+)?", re.ASCII)
ENDLESS = ("inf", "-inf", "nan")
BESIDE = ("status", "residual", "samples_ok", "worst_residual")
"""Columns that end each sheet."""
CREATED = datetime.datetime(2000, 1, 1, tzinfo=datetime.UTC)
"""The workbook's time stamp: not that of the run."""
NONE = "table"
"""The sheet of what is of no known quantity."""
WIDTH = 14


def workbook_of_csv(source: Path, path: Path) -> None:
    """Write a CSV file of this project as a workbook."""
    with source.open(encoding="utf-8", newline="") as file:
        headers, *rows = csv.reader(file)
    columns = list(zip(*rows, strict=True)) if rows else [() for _header in headers]
    write_workbook(path, headers, [_numbers(column) for column in columns])


def write_workbook(path: str | Path, headers: Sequence[str], columns: Sequence[Column]) -> None:
    """Write columns as a workbook: those of one quantity on a sheet of their own.

    Raises InputError for more rows or columns than a sheet holds.
    """
    rows = max((len(column) for column in columns), default=0)
    if rows > MOST_ROWS or len(columns) > MOST_COLUMNS:
        raise InputError(
            str(path),
            _("a sheet holds {rows} rows and {columns} columns").format(rows=MOST_ROWS, columns=MOST_COLUMNS),
            _("give fewer samples, or use the CSV file"),
        )
    book = xlsxwriter.Workbook(str(path), {"nan_inf_to_errors": False})
    book.set_properties({"created": CREATED})
    bold = book.add_format({"bold": True, "text_wrap": True, "valign": "top"})
    leading = len(_leading(headers))
    for name, numbers in _sheets(headers).items():
        sheet = book.add_worksheet(name)
        for place, number in enumerate(numbers):
            sheet.write_string(0, place, headers[number], bold)
            _write_column(sheet, place, columns[number])
        sheet.set_column(0, len(numbers) - 1, WIDTH)
        sheet.freeze_panes(1, min(leading, FROZEN))
    book.close()


def _write_column(sheet: Worksheet, place: int, column: Column) -> None:
    for row, value in enumerate(column, start=1):
        if isinstance(value, str):
            sheet.write_string(row, place, value)
        elif math.isfinite(value):
            sheet.write_number(row, place, value)


def _sheets(headers: Sequence[str]) -> dict[str, list[int]]:
    """Name of a sheet -> numbers of its columns; one sheet alone where no column is of a known quantity."""
    quantities = [_quantity(header) for header in headers]
    leading = _leading(headers)
    beside = [n for n, quantity in enumerate(quantities) if quantity in BESIDE]
    found: dict[str, list[int]] = {}
    for number, quantity in enumerate(quantities):
        if number not in (*leading, *beside):
            found.setdefault(quantity[:MOST_LETTERS], []).append(number)
    if set(found) <= {NONE}:
        return {NONE: list(range(len(headers)))}
    return {name: [*leading, *numbers, *beside] for name, numbers in found.items()}


def _leading(headers: Sequence[str]) -> list[int]:
    """Numbers of the columns that tell what a row is about: time, drives, and names before the first quantity."""
    quantities = [_quantity(header) for header in headers]
    known = [n for n, quantity in enumerate(quantities) if quantity not in (NONE, *ALONG)]
    first = known[0] if known else 0
    return [n for n, quantity in enumerate(quantities) if quantity in ALONG or n < first]


def _quantity(header: str) -> str:
    """The quantity that a header such as "position_C_x [m]" begins with; `NONE` for none."""
    name = header.partition(" [")[0]
    fitting = [key for key in (*QUANTITIES, *ALONG, *BESIDE) if name == key or name.startswith(f"{key}_")]
    return max(fitting, key=len, default=NONE)


def _numbers(column: Sequence[str]) -> Column:
    """Fields as numbers where those that are not empty are: names such as "1_0" and "nan" are none."""
    told = [field for field in column if field]
    if any(map(NUMBER.fullmatch, told)) and all(NUMBER.fullmatch(one) or one in ENDLESS for one in told):
        return [float(field) if field else math.nan for field in column]
    return column
