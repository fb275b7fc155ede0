"""Where a description names a point, a link or a guide."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from centrode.app.documents import Tables
from centrode.model.reading import Place

POINT_KEYS = frozenset(
    {"point", "points", "through", "pole", "centre", "at", "cam_point", "distance", "reference"}
)
"""Keys whose texts are names of points."""
LINK_KEYS = frozenset({"link", "links", "on", "relative_to", "carrier"})
"""Keys whose texts are names of links."""
GUIDE_KEYS = frozenset({"guide"})
KEYS = {"point": POINT_KEYS, "link": LINK_KEYS, "guide": GUIDE_KEYS}
OWN_ROOMS = ("display", "title", "gravity")
"""Keys at the top that name nothing."""


def references(tables: Tables, name: str, kind: str) -> Iterator[Place]:
    """Places of the texts that name an object of a kind, "point", "link" or "guide"."""
    for key, value in tables.items():
        if key not in OWN_ROOMS:
            yield from _within(value, (key,), name, KEYS[kind])


def _within(value: Any, place: Place, name: str, keys: frozenset[str]) -> Iterator[Place]:
    if isinstance(value, Mapping):
        for key, inner in value.items():
            yield from _within(inner, (*place, key), name, keys)
    elif isinstance(value, list):
        for k, inner in enumerate(value):
            yield from _within(inner, (*place, k), name, keys)
    elif value == name:
        key = next((part for part in reversed(place) if isinstance(part, str)), "")
        if key in keys:
            yield place


def key_places(tables: Tables, name: str, kind: str) -> Iterator[Place]:
    """Places of the keys that name an object: of tables of points and links, and of sides."""
    if name in tables.get("assembly", {}).get("sides", {}):
        yield ("assembly", "sides", name)
    if kind == "point":
        if isinstance(tables.get("points"), Mapping) and name in tables["points"]:
            yield ("points", name)
        frame = tables.get("frame", {}).get("points")
        if isinstance(frame, Mapping) and name in frame:
            yield ("frame", "points", name)
        for link, table in tables.get("links", {}).items():
            points = table.get("points") if isinstance(table, Mapping) else None
            if isinstance(points, Mapping) and name in points:
                yield ("links", link, "points", name)
    elif kind == "link" and name in tables.get("links", {}):
        yield ("links", name)
