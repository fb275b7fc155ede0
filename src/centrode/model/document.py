"""A mechanism as the tables of its file, with only what differs from the defaults."""

from __future__ import annotations

from typing import Any

from centrode.model.description import Description
from centrode.model.names import two_points
from centrode.model.tabled import part_tables


def document(mechanism: Description) -> dict[str, Any]:
    """Tables, lists, texts and SI numbers that read back as the same mechanism."""
    tables = part_tables(mechanism)
    for name, link in mechanism.links.items():
        if link.points == two_points(name):
            del tables["links"][name]["points"]
    return tables
