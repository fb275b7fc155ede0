"""Tables of drives and loads: rows of numbers, in the description or in a CSV file beside it."""

from __future__ import annotations

import csv
import re
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

from centrode.errors import InputError
from centrode.locale import _
from centrode.model import limits
from centrode.model.problems import Problem, shown
from centrode.model.reading import read_file
from centrode.model.units import unit_factor
from centrode.model.values import numbers, si

Rows = tuple[tuple[float, ...], ...]
_UNIT = re.compile(r"\[(.+)\]")
_NUMBER = re.compile(r"[+-]?\.?\d|nan|[+-]?inf", re.IGNORECASE)


@dataclass(frozen=True)
class Columns:
    """Kinds of quantity of a table's columns, of which at least `least` are given, and how a row is written."""

    kinds: tuple[str, ...]
    form: str
    least: int

    def fit(self, count: int) -> bool:
        """Whether a row may have so many values."""
        return self.least <= count <= len(self.kinds)


def read_rows(value: object, columns: Columns, folder: Path) -> Rows:
    """Rows of SI numbers, all of one length, from a list or from the path of a CSV file relative to `folder`."""
    if isinstance(value, str):
        return _csv_rows(value, columns, folder)
    if not isinstance(value, list | tuple):
        what = _("expected the path of a CSV file or rows [{form}, ...], got {value}")
        raise Problem(what.format(form=columns.form, value=shown(value)))
    _count(len(value))
    first = len(value[0]) if value and isinstance(value[0], list | tuple) else 0
    kinds = columns.kinds[: max(first, columns.least)]
    return tuple(numbers(row, kinds, columns.form) for row in value)


def _csv_rows(name: str, columns: Columns, folder: Path) -> Rows:
    path = PurePosixPath(name.replace("\\", "/"))
    if not name.isprintable() or path.is_absolute() or ".." in path.parts or ":" in name:
        what = _("{name} does not lie beside the description").format(name=shown(name))
        raise Problem(what, _("put the CSV file into the folder of the description"))
    try:
        lines = [
            row for row in csv.reader(read_file(folder / path).splitlines()) if any(c.strip() for c in row)
        ]
    except InputError as error:
        raise Problem(f"{shown(name)}: {error.what}", error.repair) from None
    except csv.Error as error:
        raise Problem(
            _("{name} is not a CSV file: {reason}").format(name=shown(name), reason=error)
        ) from None
    factors = _header(lines[0], columns) if lines else None
    body = lines[1:] if factors else lines
    _count(len(body))
    width = len(lines[0]) if lines and columns.fit(len(lines[0])) else columns.least
    units = factors or (1.0,) * width
    kinds = columns.kinds[:width]
    return tuple(_row(row, number, units, kinds, name) for number, row in enumerate(body, 1))


def _header(row: list[str], columns: Columns) -> tuple[float, ...] | None:
    """Factors to SI that a heading row says in brackets ("angle [deg]"); None if the first row is numbers."""
    if not columns.fit(len(row)) or any(_NUMBER.match(cell.strip()) for cell in row):
        return None
    try:
        return tuple(_heading_factor(cell, kind) for cell, kind in zip(row, columns.kinds, strict=False))
    except InputError as error:
        raise Problem(error.what, error.repair) from None


def _heading_factor(cell: str, kind: str) -> float:
    unit = _UNIT.search(cell)
    return unit_factor(unit.group(1), kind) if unit else 1.0


def _row(
    row: list[str], number: int, factors: tuple[float, ...], kinds: tuple[str, ...], name: str
) -> tuple[float, ...]:
    if len(row) != len(kinds):
        if kinds[0] == "time":
            what = _("row {number} of {name} has {count} values, expected a time and a value")
        else:
            what = _("row {number} of {name} has {count} values, expected {expected}")
        text = what.format(number=number, name=shown(name), count=len(row), expected=len(kinds))
        raise Problem(text)
    try:
        values = (si(cell.strip(), kind) for cell, kind in zip(row, kinds, strict=True))
        return tuple(value * factor for value, factor in zip(values, factors, strict=True))
    except Problem as problem:
        place = _("row {number} of {name}: {what}").format(number=number, name=shown(name), what=problem.what)
        raise Problem(place, problem.repair) from None


def _count(count: int) -> None:
    if count > limits.TABLE_ROWS:
        what = _("a table has at most {most} rows, got {count}").format(most=limits.TABLE_ROWS, count=count)
        raise Problem(what, _("thin it out"))
