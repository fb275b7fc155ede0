"""Templates to begin from: the built-in mechanisms and cams."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

from centrode.locale import _
from centrode.model.examples import example_names, example_text
from centrode.model.toml import toml_tables


@lru_cache(maxsize=1)
def _titles() -> tuple[tuple[str, str, str, str], ...]:
    """Name, title, kind and space of every built-in description."""
    found = []
    for kind, names in (("mechanism", example_names()), ("cam", example_names("cam"))):
        for name in names:
            tables = toml_tables(example_text(name), name)
            found.append((name, str(tables.get("title", name)), kind, str(tables.get("space", "plane"))))
    return tuple(found)


def template_list() -> list[dict[str, Any]]:
    """Name, title in the chosen language, kind and group of each template."""
    groups = {"cam": _("Cams"), "sphere": _("Spherical mechanisms"), "plane": _("Plane mechanisms")}
    return [
        {
            "name": name,
            "title": _(title),
            "kind": kind,
            "group": groups["cam" if kind == "cam" else space],
        }
        for name, title, kind, space in _titles()
    ]
