"""Tables of a drive: rows of time and value, in the description or in a CSV file beside it."""

from __future__ import annotations

import csv
import re
from pathlib import Path, PurePosixPath

from centrode.errors import InputError
from centrode.locale import _
from centrode.model import limits
from centrode.model.problems import Problem, shown
from centrode.model.reading import read_file
from centrode.model.units import unit_factor
from centrode.model.values import numbers, si

Rows = tuple[tuple[float, float], ...]
_UNIT = re.compile(r"\[(.+)\]")
_NUMBER = re.compile(r"[+-]?\.?\d|nan|[+-]?inf", re.IGNORECASE)


def read_rows(value: object, kind: str, folder: Path) -> Rows:
    """Rows (time [s], value [SI]) from a list of pairs or from the path of a CSV file relative to `folder`."""
    if isinstance(value, str):
        return _csv_rows(value, kind, folder)
    if not isinstance(value, list | tuple):
        what = _("expected the path of a CSV file or rows [[time, value], ...], got {value}")
        raise Problem(what.format(value=shown(value)))
    _count(len(value))
    rows = (numbers(row, ("time", kind), "[time, value]") for row in value)
    return tuple((time, number) for time, number in rows)


def _csv_rows(name: str, kind: str, folder: Path) -> Rows:
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
    factors = _header(lines[0], kind) if lines else None
    body = lines[1:] if factors else lines
    _count(len(body))
    return tuple(_row(row, number, factors or (1.0, 1.0), kind, name) for number, row in enumerate(body, 1))


def _header(row: list[str], kind: str) -> tuple[float, float] | None:
    """Factors to SI that a heading row says in brackets ("angle [deg]"); None if the first row is numbers."""
    if len(row) != 2 or any(_NUMBER.match(cell.strip()) for cell in row):
        return None
    try:
        return _heading_factor(row[0], "time"), _heading_factor(row[1], kind)
    except InputError as error:
        raise Problem(error.what, error.repair) from None


def _heading_factor(cell: str, kind: str) -> float:
    unit = _UNIT.search(cell)
    return unit_factor(unit.group(1), kind) if unit else 1.0


def _row(
    row: list[str], number: int, factors: tuple[float, float], kind: str, name: str
) -> tuple[float, float]:
    if len(row) != 2:
        what = _("row {number} of {name} has {count} values, expected a time and a value")
        raise Problem(what.format(number=number, name=shown(name), count=len(row)))
    try:
        return si(row[0].strip(), "time") * factors[0], si(row[1].strip(), kind) * factors[1]
    except Problem as problem:
        place = _("row {number} of {name}: {what}").format(number=number, name=shown(name), what=problem.what)
        raise Problem(place, problem.repair) from None


def _count(count: int) -> None:
    if count > limits.TABLE_ROWS:
        what = _("a table has at most {most} rows, got {count}").format(most=limits.TABLE_ROWS, count=count)
        raise Problem(what, _("thin it out"))
