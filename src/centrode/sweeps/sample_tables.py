"""Tables of a sweep: numbers at every sample that its formulas name, such as targets of a path or measured values."""

from __future__ import annotations

import csv
import hashlib
import io
import re
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.errors import InputError
from centrode.locale import _, ngettext
from centrode.model.reading import csv_separator, read_file, value_text
from centrode.model.units import KINDS, unit_factor
from centrode.numerics.operations import CONSTANTS, FUNCTIONS
from centrode.sweeps import designs

Array: TypeAlias = npt.NDArray[np.float64]
Mask: TypeAlias = npt.NDArray[np.bool_]
Tables: TypeAlias = Mapping[str, npt.ArrayLike] | str | Path | None
"""Name -> values at the samples, or a CSV file whose columns they are."""

NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,39}")
_HEADING = re.compile(r"\s*([^\[\]]*?)\s*(?:\[(.+)\])?\s*")


@dataclass(frozen=True)
class SampleTable:
    """Numbers at the samples of a sweep.

    Attributes
    ----------
    values : (samples,); 0 where there is none
    known : (samples,), where there is a number; None where there is one everywhere
    """

    values: Array
    known: Mask | None

    @property
    def digest(self) -> str:
        """A digest of every bit."""
        known = b"" if self.known is None else self.known.tobytes()
        return hashlib.sha256(self.values.tobytes() + known).hexdigest()

    @property
    def numbers(self) -> Array:
        """The numbers as they were given: NaN where there is none."""
        return self.values if self.known is None else np.where(self.known, self.values, np.nan)


def tables_of(
    given: object, samples: int, taken: Collection[str], functions: Collection[str] = ()
) -> dict[str, SampleTable]:
    """The tables of a sweep, name -> table; `taken` are the names that formulas know already, `functions` their own.

    Raises InputError: a name that is none or is taken, a number of values other than that of the samples, values that
    are no numbers or infinite, nothing but NaN; a file that is no table.
    """
    if given is None:
        return {}
    columns = read_columns(given) if isinstance(given, str | Path) else given
    # a frame of pandas is a mapping in all but its class
    if not isinstance(columns, Mapping) and not (hasattr(columns, "items") and hasattr(columns, "columns")):
        what = _("expected a table of names and values, got {value}").format(value=value_text(given))
        raise InputError("tables", what, _('write {"target_x": values}, or the path of a CSV file'))
    found: dict[str, SampleTable] = {}
    for name, values in columns.items():
        _check_name(name, taken, {*functions, *FUNCTIONS, *CONSTANTS})
        found[name] = _table(f"tables {name}", values, samples)
    if len(found) > designs.TABLES:
        what = _("{count} tables are given").format(count=len(found))
        raise InputError("tables", what, _("give at most {most}").format(most=designs.TABLES))
    return found


def _check_name(name: object, taken: Collection[str], functions: Collection[str]) -> None:
    if not isinstance(name, str) or not NAME.fullmatch(name):
        what = _("{name} cannot be the name of a table").format(name=value_text(name))
        raise InputError("tables", what, _("use letters, digits and underscores"))
    if name in taken:
        what = _("{name} is a name of the motion already").format(name=value_text(name))
        raise InputError("tables", what, _("give the table another name"))
    if name in functions:
        what = _("{name} is a name of formulas already").format(name=value_text(name))
        raise InputError("tables", what, _("give the table another name"))


def _table(where: str, given: Any, samples: int) -> SampleTable:
    try:
        values = np.array(given, dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        raise InputError(
            where, _("its values are not numbers"), _("give a number for each sample, in SI")
        ) from None
    if values.shape != (samples,):
        count = " x ".join(map(str, values.shape)) or "1"
        what = ngettext(
            "expected {n} value, one for each sample of the motion, got {count}",
            "expected {n} values, one for each sample of the motion, got {count}",
            samples,
        ).format(count=count, n=samples)
        raise InputError(where, what, _("give NaN where there is no value"))
    if np.isinf(values).any():
        what = _("the value of sample {number} is infinite").format(number=int(np.isinf(values).argmax()))
        raise InputError(where, what, _("give NaN where there is no value"))
    known = ~np.isnan(values)
    if not known.any():
        raise InputError(where, _("it has no value at any sample"), _("give one value or more"))
    return SampleTable(np.where(known, values, 0.0), None if known.all() else known)


def common_known(tables: Collection[SampleTable]) -> Mask | None:
    """The samples at which all of these tables have a number; None where that is every sample."""
    known = [table.known for table in tables if table.known is not None]
    return np.logical_and.reduce(known) if known else None


def read_columns(path: str | Path) -> dict[str, list[float]]:
    """Columns of a CSV file by their headings ("target_x", "target_x [mm]"), in SI; an empty cell is NaN.

    Raises InputError that says in which row the file is wrong.
    """
    path = Path(path)
    text = read_file(path)
    separator = csv_separator(text)
    if separator not in text.lstrip().partition("\n")[0]:
        # of one column commas can only be those of decimals
        separator = ";"
    reader = csv.reader(io.StringIO(text, newline=""), delimiter=separator, strict=True)
    try:
        rows = [(reader.line_num, cells) for cells in reader]
    except csv.Error as error:
        what = _("{name} is not a CSV file: {reason}").format(name=value_text(path.name), reason=error)
        place = _("{table}, row {number}").format(table=path.name, number=reader.line_num)
        raise InputError(place, what) from None
    rows = _without_blank_lines(rows)
    if not rows:
        raise InputError(
            path.name, _("the file is empty"), _("give it a row of headings, and one for each sample")
        )
    headings = [_heading(path.name, cell) for cell in rows[0][1]]
    names = [name for name, _factor in headings]
    for name in names:
        if names.count(name) > 1:
            raise InputError(path.name, _("{name} is given twice").format(name=value_text(name)))
    columns: dict[str, list[float]] = {name: [] for name in names}
    for number, cells in rows[1:]:
        place = _("{table}, row {number}").format(table=path.name, number=number)
        if len(cells) != len(headings):
            what = ngettext(
                "it has {n} cell, the headers are {wanted}",
                "it has {n} cells, the headers are {wanted}",
                len(cells),
            ).format(n=len(cells), wanted=len(headings))
            raise InputError(place, what, _("give every column a value"))
        for (name, factor), cell in zip(headings, cells, strict=True):
            columns[name].append(
                _number(place, cell if separator == "," else cell.replace(",", ".")) * factor
            )
    return columns


def _without_blank_lines(rows: Sequence[tuple[int, list[str]]]) -> list[tuple[int, list[str]]]:
    """The rows with cells; a blank line among those of a single column is its empty cell."""
    filled = [number for number, cells in rows if cells]
    if not filled or any(len(cells) > 1 for _number, cells in rows):
        return [(number, cells) for number, cells in rows if cells]
    return [(number, cells or [""]) for number, cells in rows if filled[0] <= number <= filled[-1]]


def _heading(table: str, cell: str) -> tuple[str, float]:
    """Name of a column, and the factor of its unit."""
    found = _HEADING.fullmatch(cell)
    if found is None:
        what = _("{name} cannot be the name of a table").format(name=value_text(cell))
        raise InputError(table, what, _("write a name, or a name and a unit: target_x [mm]"))
    name, unit = found.groups()
    return name, 1.0 if unit is None else _factor(table, unit)


def _factor(table: str, unit: str) -> float:
    """Factor to SI of a unit of any kind."""
    for kind in KINDS:
        try:
            return unit_factor(unit, kind)
        except InputError:
            continue
    raise InputError(
        table, _("unknown unit {unit}").format(unit=value_text(unit)), _("write a unit such as mm or deg")
    )


def _number(place: str, cell: str) -> float:
    text = cell.strip()
    try:
        # no underscores, which float() would take
        return float(text) if text and "_" not in text else _empty(text)
    except ValueError:
        what = _("{value} is not a number").format(value=value_text(text))
        raise InputError(place, what, _("leave the cell empty where there is no value")) from None


def _empty(text: str) -> float:
    if text:
        raise ValueError(text)
    return np.nan
