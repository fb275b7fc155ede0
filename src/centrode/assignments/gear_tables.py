"""Tables of variants of a gear pair or a train: a CSV file with one row a variant.

A header is a key of the description ("module", "rack.pressure_angle"), or short as tables of courseworks have it: m,
z1, x2, aw. A unit stands behind it, in brackets or after an underscore. Cells are read as the keys of a file are.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from copy import deepcopy
from dataclasses import dataclass
from typing import Any, TypeAlias

from centrode.assignments.tables import NAME, NAMES, Table, refuse_equal_names, table_rows, variant_name
from centrode.errors import InputError
from centrode.locale import _
from centrode.model.examples.catalogue import files_of
from centrode.model.gear_pairs import STANDARD, GearPair
from centrode.model.gear_trains import GearTrain
from centrode.model.links import part_tables
from centrode.model.reading import nearest, value_text

GearDescription: TypeAlias = GearPair | GearTrain
Key: TypeAlias = tuple[str | int, ...]

SHORT_OF_PAIRS: Mapping[str, Key] = {
    "m": ("module",), "z1": ("teeth", 0), "z2": ("teeth", 1), "x1": ("shifts", 0), "x2": ("shifts", 1),
    "aw": ("centre_distance",), "a_w": ("centre_distance",), "beta": ("helix_angle",), "β": ("helix_angle",),
    "alpha": ("rack", "pressure_angle"), "α": ("rack", "pressure_angle"), "ha": ("rack", "addendum"),
    "c": ("rack", "clearance"), "b": ("width",), "n1": ("speed",), "omega1": ("speed",), "ω1": ("speed",),
    "T1": ("moment",), "M1": ("moment",),
}  # fmt: skip
SHORT_OF_TRAINS: Mapping[str, Key] = {
    "m": ("module",), "u": ("ratio",), "i": ("ratio",), "k": ("planets",), "n1": ("input_speed",),
    "n2": ("output_speed",), "omega1": ("input_speed",), "ω1": ("input_speed",), "omega2": ("output_speed",),
    "ω2": ("output_speed",), "z1": ("pair_behind", 0), "z2": ("pair_behind", 1),
}  # fmt: skip
_BRACKET = re.compile(r"(.*?)\s*\[([^\[\]]*)\]\s*")
_SUFFIX = re.compile(r"(.+?)_([a-zA-Z°].*)")
_NUMBER = re.compile(r"[+\-−]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+\-]?[0-9]{1,3})?")


@dataclass(frozen=True)
class GearColumn:
    """What a header names.

    Attributes
    ----------
    header : as the table has it
    key : in the tables of the description
    unit : of numbers in its cells; empty where it names none
    """

    header: str
    key: Key
    unit: str = ""


@dataclass(frozen=True)
class GearVariant:
    """A row of a table.

    Attributes
    ----------
    name : of the variant
    described : with the numbers of the row; None where they describe no pair or train
    refusal : why
    """

    name: str
    described: GearDescription | None
    refusal: str = ""


def read_gear_variants(described: GearDescription, table: Table) -> tuple[GearVariant, ...]:
    """The variants of a table: the path of a CSV file, or rows from header to value.

    An empty cell leaves the key as the description has it. Shifts in numbers take the place of a centre distance, a
    ratio that of speeds, and the other way round. Raises InputError that names row and column.
    """
    where, headers, rows = table_rows(table)
    columns = [_column(described, header, where) for header in headers]
    if all(column is not None for column in columns):
        what = _("the column {name} is missing").format(name=value_text(NAME))
        raise InputError(where, what, _("give every variant a name in it, such as its number"))
    found = []
    for number, cells in rows:
        place = _("{table}, row {number}").format(table=where, number=number)
        name, values = "", {}
        for column, cell in zip(columns, cells, strict=True):
            if column is None:
                name = variant_name(cell, place)
            elif cell is not None and str(cell).strip():
                values[column.key] = _value(column, cell)
        found.append(_variant(described, name, values, place))
    refuse_equal_names((variant.name for variant in found), where)
    return tuple(found)


def _column(described: GearDescription, header: str, where: str) -> GearColumn | None:
    """The column of a header; None of that which names the variants."""
    if header.strip().casefold() in NAMES:
        return None
    short = SHORT_OF_PAIRS if isinstance(described, GearPair) else SHORT_OF_TRAINS
    bracket = _BRACKET.fullmatch(header)
    name, unit = (bracket.group(1).strip(), bracket.group(2).strip()) if bracket else (header.strip(), "")
    key = _key(described, name, short)
    if key is None and bracket is None and (suffix := _SUFFIX.fullmatch(name)) is not None:
        key, unit = _key(described, suffix.group(1), short), suffix.group(2).replace("_", "/")
    if key is None:
        what = _("it names no number of the description")
        place = _("column {header}").format(header=value_text(header))
        raise InputError(f"{where}, {place}", what, nearest(name, [*short, *type(described).model_fields]))
    return GearColumn(header.strip(), key, unit)


def _key(described: GearDescription, name: str, short: Mapping[str, Key]) -> Key | None:
    if name in short:
        return short[name]
    head, _dot, inner = name.partition(".")
    kept = {"title", "kind", "display", "report"}
    if head not in type(described).model_fields or head in kept:
        return None
    return (head, inner) if inner else (head,)


def _value(column: GearColumn, cell: object) -> object:
    """What a cell says, as a key of a file has it: a number, or a text with its unit."""
    text = str(cell).strip().replace("−", "-")
    if _NUMBER.fullmatch(text) is None:
        return text
    if column.unit:
        return f"{text} {column.unit}"
    return int(text) if re.fullmatch(r"[+\-]?[0-9]+", text) else float(text)


def _variant(described: GearDescription, name: str, values: Mapping[Key, object], place: str) -> GearVariant:
    tables = deepcopy(part_tables(described))
    _leave_room(tables, values)
    for key, value in values.items():
        _put(tables, key, value)
    try:
        return GearVariant(name, files_of(described).from_tables(tables, place))
    except InputError as refusal:
        return GearVariant(name, None, str(refusal))


def _leave_room(tables: dict[str, Any], values: Mapping[Key, object]) -> None:
    """Remove what the row gives in another way, and an application of which other shifts know nothing."""
    heads = {key[0] for key in values}
    numbers = ("shifts", 0) in values or ("shifts", 1) in values
    if numbers and "centre_distance" not in heads:
        tables.pop("centre_distance", None)
    if "centre_distance" in heads and not isinstance(tables.get("shifts"), str) and "shifts" not in heads:
        tables.pop("shifts", None)
    if "shifts" in heads and values.get(("shifts",)) != STANDARD and "application" not in heads:
        tables.pop("application", None)
    if "ratio" in heads:
        for speed in {"input_speed", "output_speed"} - heads:
            tables.pop(speed, None)
    elif heads & {"input_speed", "output_speed"} and {"input_speed", "output_speed"} <= heads | set(tables):
        tables.pop("ratio", None)


def _put(tables: dict[str, Any], key: Key, value: object) -> None:
    """Put a value into a key, an entry of a list, or a key of an inner table."""
    head = str(key[0])
    if len(key) == 1:
        tables[head] = value
    elif isinstance(key[1], int):
        own = tables.get(head)
        tables[head] = list(own) if isinstance(own, list | tuple) else [0, 0]
        tables[head][key[1]] = value
    else:
        tables.setdefault(head, {})[key[1]] = value
