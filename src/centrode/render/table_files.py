"""How the tables of a folder are spelled besides plain CSV: with decimal commas, as workbooks."""

from __future__ import annotations

import codecs
import csv
import importlib
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias

from centrode.optional_packages import telling_what_is_missing

# CSV as spreadsheets and MathCAD read it where the decimal sign is a comma: fields apart by semicolons.

NUMBER = re.compile(r"[+-]?\d+\.\d+(?:[eE][+-]?\d+)?|[+-]?\d+[eE][+-]?\d+")


def spell_with_comma(path: Path) -> None:
    """Rewrite a CSV file of this project with decimal commas and semicolons; text is left as it is.

    A mark of byte order goes before it: without one spreadsheets take UTF-8 for a code page of theirs.
    """
    with path.open(encoding="utf-8", newline="") as file:
        rows = [[_with_comma(field) for field in row] for row in csv.reader(file)]
    with path.open("w", encoding="utf-8-sig", newline="") as file:
        csv.writer(file, delimiter=";", lineterminator="\n").writerows(rows)


def _with_comma(field: str) -> str:
    return field.replace(".", ",") if NUMBER.fullmatch(field) else field


WorkbookColumn: TypeAlias = Sequence[float] | Sequence[str]


@telling_what_is_missing
def _workbook_of_csv() -> Callable[[Path, Path], None]:
    """What writes workbooks: XlsxWriter is an extra, so it is loaded only where they are asked for."""
    found: Callable[[Path, Path], None] = importlib.import_module("centrode.render.workbooks").workbook_of_csv
    return found


@telling_what_is_missing
def _workbook_writer() -> Callable[[Path, Sequence[str], Sequence[WorkbookColumn]], None]:
    """What writes columns as a workbook, loaded only where workbooks are wanted."""
    found: Callable[[Path, Sequence[str], Sequence[WorkbookColumn]], None] = importlib.import_module(
        "centrode.render.workbooks"
    ).write_workbook
    return found


@dataclass(frozen=True)
class TableSpelling:
    """Adds workbooks to the CSV files of a folder, and puts decimal commas into these; plain data.

    Attributes
    ----------
    xlsx : bool
        Write a workbook beside each table, a sheet for each quantity.
    comma : bool
        Decimal commas, fields apart by semicolons.
    """

    xlsx: bool = False
    comma: bool = False

    def check(self) -> None:
        """Raise InputError where workbooks are asked for and what they need is not installed."""
        if self.xlsx:
            _workbook_of_csv()

    def spell(self, folder: Path) -> None:
        """Spell the CSV files of a folder, once: a table that was written with decimal commas is left as it is."""
        for table in sorted(folder.rglob("*.csv")):
            with table.open("rb") as file:
                if file.read(len(codecs.BOM_UTF8)) == codecs.BOM_UTF8:
                    continue
            workbook = table.with_suffix(".xlsx")
            if self.comma or not workbook.exists():
                self.spell_table(table, workbook)

    def write_workbook(
        self, path: Path, headers: Sequence[str], columns: Callable[[], Sequence[WorkbookColumn]]
    ) -> None:
        """Write columns as a workbook where workbooks are wanted."""
        if self.xlsx:
            _workbook_writer()(path, headers, columns())

    def spell_table(self, table: Path, workbook: Path) -> None:
        """Spell one CSV file, once, with `workbook` beside it where one is asked for."""
        if self.xlsx:
            _workbook_of_csv()(table, workbook)
        if self.comma:
            spell_with_comma(table)


PLAIN = TableSpelling()
