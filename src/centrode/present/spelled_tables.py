"""How the tables of a folder are spelled besides plain CSV: with decimal commas, as workbooks."""

from __future__ import annotations

import importlib
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from centrode.present.decimal_comma import spell_with_comma
from centrode.present.missing import telling_what_is_missing


@telling_what_is_missing
def _workbook_of_csv() -> Callable[[Path, Path], None]:
    """What writes workbooks: XlsxWriter is an extra, so it is loaded only where they are asked for."""
    found: Callable[[Path, Path], None] = importlib.import_module(
        "centrode.present.workbooks"
    ).workbook_of_csv
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
        """Spell the CSV files of a folder, once: a table with decimal commas is not read again."""
        for table in sorted(folder.rglob("*.csv")):
            self.spell_table(table, table.with_suffix(".xlsx"))

    def spell_table(self, table: Path, workbook: Path) -> None:
        """Spell one CSV file, once, with `workbook` beside it where one is asked for."""
        if self.xlsx:
            _workbook_of_csv()(table, workbook)
        if self.comma:
            spell_with_comma(table)


PLAIN = TableSpelling()
