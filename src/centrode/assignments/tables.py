"""Tables of variants: a CSV file with one row a variant, read strictly and told in sentences."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from decimal import Decimal
from pathlib import Path
from typing import TypeAlias

from centrode.errors import InputError
from centrode.locale import _, ngettext
from centrode.model import reading
from centrode.model.examples.catalogue import load
from centrode.model.files import kind_at, value_at, with_values
from centrode.model.mechanism import FRAME, Mechanism
from centrode.model.placement import replace_placed
from centrode.model.reading import Problem, csv_separator, nearest, read_file, read_name, value_text
from centrode.model.units import read_quantity, scale_value, unit_factor

# Columns of a table of variants: which numbers of a mechanism a header names.
#
# A header is a path ("links.AC.length"), or short as tables of assignments have it: a letter and the number
# of the
# link, counted in the order of the description. l2 is the length of the second link, phi2_0 its initial
# angle,
# omega1 the speed of the drive of the first. A unit stands behind, in brackets or after an underscore.
# A cell is a value, or a change of the number in the description: "+10 %", "x1.2", "+=5 mm". The column
# "topology" names the description of a row, where it has its own.

NAME = "variant"
"""Header of the column that names the variants."""
NAMES = (NAME, "вариант", "варіант")
"""The same in every language of the messages."""

TOPOLOGIES = ("topology", "file", "топология", "топологія", "файл")
"""Headers of the column that names the description of each row: a file beside the table, or a built-in example."""

# three digits of an exponent are more than a number has, and decimals are bounded too
_PLAIN = r"(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]{1,3})?"
_SHARE = re.compile(rf"([+\-−])\s*({_PLAIN})\s*%")
_TIMES = re.compile(rf"[x×*хX]\s*({_PLAIN})")
_STEP = re.compile(r"([+\-−])=\s*(\S.*)")
_PERCENT = re.compile(rf"{_PLAIN}\s*%")
_BRACKET = re.compile(r"(.*?)\s*\[([^\[\]]*)\]\s*")
_SHORT = re.compile(r"(l|phi|φ|omega|ω)(\d{1,4})(_0)?(?:_([a-zA-Z°]\w*))?")
_KINDS = {"l": "length", "phi": "angle", "φ": "angle", "omega": "speed", "ω": "speed"}


@dataclass(frozen=True)
class VariantColumn:
    """One column of numbers.

    Attributes
    ----------
    header : as the table has it
    paths : what the number is put into; a driven link's initial angle is also the start of its drive
    kind : kind of quantity ("length", "angle", ...)
    factor : value in SI of one of the header's unit; None where it names none, so that cells may have their own
    refuses_bare : whether an angle needs its unit in the header or in the cell
    """

    header: str
    paths: tuple[str, ...]
    kind: str
    factor: float | None
    refuses_bare: bool = False


Columns: TypeAlias = Sequence[VariantColumn | InputError | None]
"""What the headers of a table name; None for names and topologies, an error for what a topology has not."""


def columns_of(mechanism: Mechanism, headers: Sequence[str]) -> Columns:
    """The columns of a table for one mechanism.

    Raises InputError: no column of names, two that name the same; where the rows have no topologies of their own, a
    header that names nothing, a unit that does not fit.
    """
    found: list[VariantColumn | InputError | None] = []
    named: dict[str, str] = {}
    several = any(_is_one_of(header, TOPOLOGIES) for header in headers)
    for header in headers:
        column: VariantColumn | InputError | None = None
        if not _is_one_of(header, (*NAMES, *TOPOLOGIES)):
            try:
                column = _column(mechanism, header)
            except InputError as error:
                if not several:
                    raise
                column = error
        paths = column.paths if isinstance(column, VariantColumn) else ()
        names = {NAME: NAMES, TOPOLOGIES[0]: TOPOLOGIES}
        for path in (*paths, *(key for key, known in names.items() if _is_one_of(header, known))):
            if path in named:
                both = _("columns {one} and {other} refer to the same number")
                raise InputError(
                    "",
                    both.format(one=value_text(named[path]), other=value_text(header)),
                    _("keep one of them"),
                )
            named[path] = header
        found.append(column)
    if NAME not in named:
        what = _("the column {name} is missing").format(name=value_text(NAME))
        raise InputError("", what, _("give every variant a name in it, such as its number"))
    if len(found) == 1:
        raise InputError("", _("no column has a number of the mechanism"), _hint(mechanism))
    return found


def _is_one_of(header: str, known: Sequence[str]) -> bool:
    return header.strip().casefold() in known


def _column(mechanism: Mechanism, header: str) -> VariantColumn:
    bracket = _BRACKET.fullmatch(header)
    name, unit = (bracket.group(1).strip(), bracket.group(2)) if bracket else (header.strip(), None)
    short = _SHORT.fullmatch(name)
    try:
        if short is not None:
            letter, number, _initial, suffix = short.groups()
            if suffix is not None and unit is not None:
                raise InputError("", _("it names two units"), _("keep one of them"))
            unit = suffix.replace("_", "/") if suffix is not None else unit
            paths = _short_paths(mechanism, _KINDS[letter], int(number))
        elif "." in name:
            paths = (name,)
        else:
            raise InputError("", _("it names no number of the mechanism"), _hint(mechanism))
        kind = kind_at(mechanism, paths[0])
        factor = None if unit is None else unit_factor(unit, kind)
    except InputError as error:
        where = _("column {header}").format(header=value_text(header))
        raise InputError(where, error.what, error.repair) from None
    return VariantColumn(header.strip(), paths, kind, factor, mechanism.display.refuses_bare_angles)


def _short_paths(mechanism: Mechanism, kind: str, number: int) -> tuple[str, ...]:
    """Paths of a short header: length, initial angle or speed of the link with a number."""
    names = mechanism.link_names
    if not 1 <= number <= len(names):
        what = ngettext(
            "there is no link {number}: the mechanism has {count} link",
            "there is no link {number}: the mechanism has {count} links",
            len(names),
        ).format(number=number, count=len(names))
        raise InputError(
            "",
            what,
            _("they are counted in the order of the description: {names}").format(names=", ".join(names)),
        )
    link = names[number - 1]
    drive = next((drive for drive in mechanism.drives if drive.link == link), None)
    if kind == "length":
        if mechanism.links[link].length is None:
            what = _("link {link} has no length, its points have coordinates").format(link=link)
            repair = _("name one of them: links.{link}.points.{point}.x")
            raise InputError(
                "", what, repair.format(link=link, point=list(mechanism.links[link].coordinates)[-1])
            )
        return (f"links.{link}.length",)
    if kind == "speed":
        if drive is None:
            what = _("link {link} has no drive").format(link=link)
            raise InputError("", what, nearest(link, [one.id for one in mechanism.drives]))
        return (f"drives.{link}.speed",)
    start = drive is not None and drive.relative_to == FRAME and drive.start is not None
    return (f"links.{link}.angle", *([f"drives.{link}.start"] if start else []))


def _hint(mechanism: Mechanism) -> str:
    names = mechanism.link_names
    link = next((name for name in reversed(names) if mechanism.links[name].length is not None), names[-1])
    return _("write a path such as links.{link}.length, or l{n}, phi{n}_0 for link number {n}").format(
        link=link, n=names.index(link) + 1
    )


Table: TypeAlias = str | Path | Sequence[Mapping[str, object]]
FORMULAS = ("=", "+", "-", "@")
"""With these begins what a spreadsheet computes when it opens a summary."""


@dataclass(frozen=True)
class Variant:
    """One row of a table.

    Attributes
    ----------
    name : of the variant
    values : numbers [SI] that it puts into its topology, by their paths
    topology : its own description; None where it has that of all
    source : the file or the example of its own description
    """

    name: str
    values: Mapping[str, float]
    topology: Mechanism | None = None
    source: str = ""

    def base(self, topology: Mechanism) -> Mechanism:
        """The description whose numbers it changes: its own, else that of all variants."""
        return topology if self.topology is None else self.topology

    def of(self, topology: Mechanism) -> Mechanism:
        """The mechanism of this variant; what the topology places is placed anew. Raises InputError if it is none."""
        return replace_placed(with_values(self.base(topology), self.values))


def read_variants(topology: Mechanism, table: Table) -> tuple[Variant, ...]:
    """The variants of a table: the path of a CSV file, or rows from header to value.

    Commas, semicolons or tabulators separate the columns; decimals have a point, or between semicolons and
    tabulators a comma. Files that the column "topology" names lie beside the table. Raises InputError that names the
    row and the column.
    """
    where, headers, rows = table_rows(table)
    try:
        columns = columns_of(topology, headers)
    except InputError as error:
        raise InputError(
            f"{where}, {error.where}" if error.where else where, error.what, error.repair
        ) from None
    folder = Path(table).parent if isinstance(table, str | Path) else None
    bases = _Bases(topology, columns, headers, folder)
    found = [
        _variant(bases, row, _("{table}, row {number}").format(table=where, number=n)) for n, row in rows
    ]
    refuse_equal_names((variant.name for variant in found), where)
    return tuple(found)


def refuse_equal_names(names: Iterable[str], where: str) -> None:
    """Raise InputError for two variants of one name: folders are named after them, and may know no capital letters."""
    seen: set[str] = set()
    for name in names:
        if name.casefold() in seen:
            what = _("variant {name} occurs twice").format(name=value_text(name))
            raise InputError(where, what, _("give each a different name"))
        seen.add(name.casefold())


Row: TypeAlias = tuple[int, list[object]]
"""Number of a row in its file, and its cells."""


def table_rows(table: Table) -> tuple[str, list[str], list[Row]]:
    """What messages call a table, its headers and its rows; InputError where it has none, or too many."""
    if isinstance(table, Mapping):
        what, repair = (
            _("it is one mapping"),
            _("give the path of a file, or a list with a mapping for each variant"),
        )
        raise InputError(_("table"), what, repair)
    if isinstance(table, str | Path):
        where = Path(table).name
        headers, rows = _file(Path(table), where)
    else:
        where = _("table")
        headers, rows = _mappings(table, where)
    if not rows:
        raise InputError(where, _("it has no variants"), _("write one row below the headers for each"))
    if len(rows) > reading.TABLE_ROWS:
        what = _("a table has at most {most} rows, got {count}").format(
            most=reading.TABLE_ROWS, count=len(rows)
        )
        raise InputError(where, what, _("split it into several"))
    return where, headers, rows


def _file(path: Path, where: str) -> tuple[list[str], list[Row]]:
    """Headers and rows of a CSV file; blank lines count but hold nothing."""
    text = read_file(path)
    separator = csv_separator(text)
    reader = csv.reader(io.StringIO(text, newline=""), delimiter=separator, strict=True)
    try:
        lines = [(reader.line_num, cells) for cells in reader if any(cell.strip() for cell in cells)]
    except csv.Error as error:
        what = _("{name} is not a CSV file: {reason}").format(name=value_text(where), reason=error)
        place = _("{table}, row {number}").format(table=where, number=reader.line_num)
        raise InputError(place, what) from None
    if not lines:
        raise InputError(
            where, _("the file is empty"), _("give it a row of headers, and one for each variant")
        )
    headers = lines[0][1]
    rows: list[Row] = []
    for number, cells in lines[1:]:
        if len(cells) != len(headers):
            place = _("{table}, row {number}").format(table=where, number=number)
            what = ngettext(
                "it has {n} cell, the headers are {wanted}",
                "it has {n} cells, the headers are {wanted}",
                len(cells),
            ).format(n=len(cells), wanted=len(headers))
            raise InputError(place, what, _separators(separator))
        points = [cell if separator == "," else cell.replace(",", ".") for cell in cells]
        rows.append(
            (
                number,
                [
                    cells[k] if _is_one_of(header, (*NAMES, *TOPOLOGIES)) else points[k]
                    for k, header in enumerate(headers)
                ],
            )
        )
    return headers, rows


def _separators(separator: str) -> str:
    if separator == ",":
        return _("where decimals have commas, separate the columns by semicolons")
    return _("give every column a value")


def _mappings(table: Sequence[Mapping[str, object]], where: str) -> tuple[list[str], list[Row]]:
    headers = [str(header) for header in table[0]] if table else []
    rows: list[Row] = []
    for number, row in enumerate(table, start=1):
        if list(map(str, row)) != headers:
            place = _("{table}, row {number}").format(table=where, number=number)
            raise InputError(place, _("its keys are not those of the first row"), ", ".join(headers))
        rows.append((number, list(row.values())))
    return headers, rows


@dataclass
class _Bases:
    """The descriptions that the rows of a table change, each with its columns.

    Attributes
    ----------
    topology : of rows that name none
    columns : of this one
    headers : of the table
    folder : where the table lies; None where it is no file
    """

    topology: Mechanism
    columns: Columns
    headers: Sequence[str]
    folder: Path | None
    others: dict[str, tuple[Mechanism, Columns]] = field(default_factory=dict)

    def source(self, row: Sequence[object]) -> str:
        """What a row names as its topology; empty where it names none."""
        cells = (
            str(cell).strip()
            for header, cell in zip(self.headers, row, strict=True)
            if _is_one_of(header, TOPOLOGIES) and cell is not None
        )
        return next(cells, "")

    def of(self, source: str, where: str) -> tuple[Mechanism, Columns]:
        """The description that a row names, and its columns."""
        if not source:
            return self.topology, self.columns
        if source not in self.others:
            beside = None if self.folder is None else self.folder / source
            try:
                mechanism = load(source if beside is None or not beside.is_file() else beside)
                self.others[source] = mechanism, columns_of(mechanism, self.headers)
            except InputError as error:
                place = f"{where}: {error.where}" if error.where else where
                raise InputError(place, error.what, error.repair) from None
            if mechanism.space != self.topology.space:
                what = _("{source} is a mechanism of another space").format(source=value_text(source))
                raise InputError(
                    where, what, _("keep mechanisms of the plane and of the sphere in two tables")
                )
        return self.others[source]


def _variant(bases: _Bases, row: list[object], where: str) -> Variant:
    name = ""
    values: dict[str, float] = {}
    source = bases.source(row)
    mechanism, columns = bases.of(source, where)
    has_own = any(_is_one_of(header, TOPOLOGIES) for header in bases.headers)
    for header, column, cell in zip(bases.headers, columns, row, strict=True):
        if column is None:
            name = variant_name(cell, where) if _is_one_of(header, NAMES) else name
            continue
        if has_own and (cell is None or not str(cell).strip()):
            continue  # the row's description has it, or has nothing of the kind
        if isinstance(column, InputError):
            raise InputError(f"{where}, {column.where}", column.what, column.repair)
        place = _("{row}, column {header}").format(row=where, header=value_text(column.header))
        values |= {path: _number(column, cell, place, mechanism, path) for path in column.paths}
    return Variant(name, values, mechanism if source else None, source)


def variant_name(cell: object, where: str) -> str:
    """The name of a variant by its cell; InputError for an empty one and for what is no name."""
    text = str(cell).strip()
    if not text:
        raise InputError(
            where, _("the variant has no name"), _("give every variant a name, such as its number")
        )
    if text.startswith(FORMULAS):
        what = _("{name} begins like a formula of a spreadsheet").format(name=value_text(text))
        raise InputError(where, what, _("begin it with a letter or a digit"))
    try:
        return read_name(text)
    except Problem as problem:
        raise InputError(where, problem.what, problem.repair) from None


def _number(column: VariantColumn, cell: object, where: str, mechanism: Mechanism, path: str) -> float:
    """Value in SI of a cell: a value, or a change of the number that the description has at the path."""
    given = cell.strip() if isinstance(cell, str) else cell
    if given == "" or given is None:
        raise InputError(where, _("the cell is empty"), _("give every variant a value"))
    if isinstance(given, str):
        changed = _changed_number(column, given, where, mechanism, path)
        if changed is not None:
            return changed
    return _value(column, given, where)


def _value(column: VariantColumn, given: object, where: str) -> float:
    """Value in SI: a number in the header's unit, or where it has none a text with a unit."""
    if column.factor is None:
        # a cell of a workbook may be a number: its text is what is written there
        text = repr(given) if isinstance(given, int | float) and not isinstance(given, bool) else given
        return read_quantity(text, column.kind, where, refuses_bare=column.refuses_bare)
    return scale_value(read_quantity(given, "ratio", where), column.factor)


def _changed_number(
    column: VariantColumn, text: str, where: str, mechanism: Mechanism, path: str
) -> float | None:
    """The number of the description changed as a cell says; None where the cell is a value.

    Shares and sums are those of the decimals that are written: 0.7 m and 10 % make 0.77 m to the last bit.
    """
    share, times, step = _SHARE.fullmatch(text), _TIMES.fullmatch(text), _STEP.fullmatch(text)
    if share is None and times is None and step is None:
        _refuse_unclear(column, text, where)
        return None
    if share is not None and column.kind == "ratio":
        what = _("{text} may be a share or a change of it: the number has no unit").format(
            text=value_text(text)
        )
        raise InputError(where, what, _('write "x1.1" for a tenth more, "0.1" for the number itself'))
    try:
        before = value_at(mechanism, path)
    except InputError as error:
        raise InputError(where, error.what, error.repair) from None
    base = Decimal(repr(before))
    if step is not None:
        more = Decimal(repr(_value(column, step.group(2), where)))
        return float(base - more if step.group(1) != "+" else base + more)
    if not before:
        what = _("the description has 0 there, and a share of it is 0")
        raise InputError(
            where, what, _("write the value, or a difference such as {text}").format(text='"+=1"')
        )
    if times is not None:
        return float(base * Decimal(times.group(1)))
    assert share is not None
    part = Decimal(share.group(2)) / 100
    return float(base * (1 + part if share.group(1) == "+" else 1 - part))


def _refuse_unclear(column: VariantColumn, text: str, where: str) -> None:
    """Raise InputError for what may be a value or a change of one."""
    if text.startswith("+"):
        plain = text[1:].strip()
        what = _("{text} may be a value or a change of it").format(text=value_text(text))
        repair = _("write {value} for the value, {change} for a change")
        raise InputError(where, what, repair.format(value=value_text(plain), change=value_text(f"+={plain}")))
    if _PERCENT.fullmatch(text) and column.kind != "ratio":
        what = _("{text} is a share without a sign").format(text=value_text(text))
        repair = _("write {more} or {less} for a change")
        raise InputError(where, what, repair.format(more=value_text(f"+{text}"), less=value_text(f"-{text}")))
