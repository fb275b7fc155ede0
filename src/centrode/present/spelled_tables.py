"""How the tables of a folder are spelled besides plain CSV: with decimal commas, as workbooks."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from pathlib import Path

import lazy_loader

from centrode.present.decimal_comma import spell_with_comma

# XlsxWriter is an extra: only where workbooks are asked for.
_workbooks = functools.partial(lazy_loader.load, "centrode.present.workbooks", suppress_warning=True)


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
        """Raise ModuleNotFoundError where workbooks are asked for and what they need is not installed."""
        if self.xlsx:
            _ = _workbooks().workbook_of_csv

    def spell(self, folder: Path) -> None:
        """Spell the CSV files of a folder, once: a table with decimal commas is not read again."""
        for table in sorted(folder.rglob("*.csv")):
            if self.xlsx:
                _workbooks().workbook_of_csv(table, table.with_suffix(".xlsx"))
            if self.comma:
                spell_with_comma(table)


PLAIN = TableSpelling()
