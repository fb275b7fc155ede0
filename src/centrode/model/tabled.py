"""Any part of a description as the tables of a file, with only what differs from the defaults."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from centrode.model.names import PLACED
from centrode.model.pairs import PLANE_KEYS, Guide
from centrode.model.part import Part
from centrode.model.values import Placed


def part_tables(part: Part) -> dict[str, Any]:
    """Tables of any part of a description."""
    tables = {}
    for key, name in part.keys().items():
        value, field = getattr(part, name), type(part).model_fields[name]
        if field.is_required() or value != field.default or _needed(part, name):
            tables[key] = _plain(value)
    return tables


def _needed(part: Part, name: str) -> bool:
    """Keys that a file has to give although the part has a default: a guide's line, in the plane."""
    return isinstance(part, Guide) and part.pole is None and name in PLANE_KEYS


def _plain(value: object) -> Any:
    if isinstance(value, Part):
        return part_tables(value)
    if isinstance(value, Placed):
        return PLACED if value.at is None else {PLACED: list(value.at)}
    if isinstance(value, Mapping):
        return {key: _plain(entry) for key, entry in value.items()}
    if isinstance(value, tuple):
        return [_plain(entry) for entry in value]
    return value
