"""Completions of a description's text, from the schema: keys of the table at the cursor, words, headings."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from functools import lru_cache
from typing import Any

from centrode.app.documents import Document
from centrode.app.sketch import SketchParts
from centrode.app.text_places import text_places
from centrode.model.reading import Place
from centrode.model.schema import cam_schema, mechanism_schema

Schema = Mapping[str, Any]

MOST = 100
"""Completions of one place."""
_WORD = re.compile(r"[\w-]*\Z")
_VALUE = re.compile(r"\A\s*(\"?[\w-]+\"?)\s*=\s*(.*)\Z")
NAMES = {
    "point": "points",
    "points": "points",
    "through": "points",
    "centre": "points",
    "distance": "points",
    "link": "links",
    "links": "links",
    "on": "links",
    "relative_to": "links",
    "carrier": "links",
    "guide": "guides",
}
"""Keys whose values are names of objects."""


@lru_cache(maxsize=2)
def _schema(cam: bool) -> Schema:
    return cam_schema() if cam else mechanism_schema()


def completions(document: Document, line: int, column: int) -> dict[str, Any]:
    """What may stand at a line and a column, both from 1, and the column from which it replaces what is there."""
    lines = document.text.split("\n")
    before = lines[line - 1][: column - 1] if 1 <= line <= len(lines) else ""
    offset = sum(len(one) + 1 for one in lines[: line - 1])
    schema = _schema(document.is_cam)
    word = _WORD.search(before)
    start = word.start() if word else len(before)
    stripped = before.lstrip()
    if stripped.startswith("["):
        options = list(_headings(schema, document))
        start = len(before) - len(stripped)
    else:
        table = _table_at(document, offset)
        value = _VALUE.match(before)
        if value:
            options = list(_values(schema, document, (*table, value.group(1).strip('"')), value.group(2)))
        else:
            options = list(_keys(schema, document, table))
    return {"from": start + 1, "options": options[:MOST]}


def _table_at(document: Document, offset: int) -> Place:
    """The table under whose heading a line stands."""
    place: Place = ()
    for statement in text_places(document.text).statements:
        if statement.start >= offset:
            break
        if statement.is_heading:
            place = statement.place
    return place


def _headings(schema: Schema, document: Document) -> Iterator[dict[str, str]]:
    for key, value in schema["properties"].items():
        kinds = _resolve(schema, value)
        if kinds.get("type") == "array" and _resolve(schema, kinds.get("items", {})).get("type") == "object":
            yield {"label": f"[[{key}]]", "type": "heading"}
        elif kinds.get("type") == "object":
            yield {"label": f"[{key}]" if key != "links" else "[links.", "type": "heading"}


def _keys(schema: Schema, document: Document, table: Place) -> Iterator[dict[str, str]]:
    inner = _at(schema, table)
    present = _keys_given(document, table)
    for key, value in inner.get("properties", {}).items():
        if key not in present:
            yield {"label": key, "type": "key", "detail": _detail(schema, value)}


def _keys_given(document: Document, table: Place) -> Mapping[str, Any]:
    value: Any = document.tables
    for key in table:
        try:
            value = value[key]
        except (KeyError, IndexError, TypeError):
            return {}
    return value if isinstance(value, Mapping) else {}


def _values(schema: Schema, document: Document, place: Place, written: str) -> Iterator[dict[str, str]]:
    quoted = written.count('"') % 2 == 1
    key = str(place[-1])
    if key in NAMES:
        sketch = SketchParts(document)
        names = {
            "points": sketch.points,
            "links": (*sketch.links, "frame"),
            "guides": tuple(str(one.get("name", one.get("point"))) for one in sketch.guides),
        }[NAMES[key]]
        for name in names:
            yield {"label": name if quoted else f'"{name}"', "type": "name"}
    for one in _alternatives(schema, _at(schema, place)):
        for word in one.get("enum", [one["const"]] if "const" in one else []):
            if isinstance(word, str):
                yield {"label": word if quoted else f'"{word}"', "type": "word"}
        if one.get("type") == "boolean":
            yield from ({"label": word, "type": "word"} for word in ("true", "false"))


def _at(schema: Schema, place: Place) -> Schema:
    """The schema of what stands at a place; empty where nothing is known of it."""
    inner: Schema = schema
    for key in place:
        found: Schema = {}
        for one in _alternatives(schema, inner):
            if isinstance(key, int):
                found = one.get("items", found)
            elif key in one.get("properties", {}):
                found = one["properties"][key]
            elif isinstance(one.get("additionalProperties"), Mapping):
                found = one["additionalProperties"]
        inner = _resolve(schema, found)
    merged: dict[str, Any] = {}
    for one in _alternatives(schema, inner):
        merged |= one.get("properties", {})
    return {**inner, "properties": merged} if merged else inner


def _resolve(schema: Schema, value: Schema) -> Schema:
    while "$ref" in value:
        value = schema["$defs"][value["$ref"].rpartition("/")[2]]
    return value


def _alternatives(schema: Schema, value: Schema) -> Iterator[Schema]:
    value = _resolve(schema, value)
    yield value
    for key in ("anyOf", "oneOf", "allOf"):
        for one in value.get(key, ()):
            yield from _alternatives(schema, one)


def _detail(schema: Schema, value: Schema) -> str:
    value = _resolve(schema, value)
    return str(value.get("description", value.get("type", "")))
