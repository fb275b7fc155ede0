"""Read by every Python that finds it at its start: libraries named in CENTRODE_WITHOUT are not found."""

from __future__ import annotations

import os
from importlib.machinery import ModuleSpec, PathFinder
from typing import Any

MISSING = frozenset(os.environ.get("CENTRODE_WITHOUT", "").split())
found = PathFinder.find_spec


class Finder:
    @classmethod  # as the one it stands for: others take it over into classes of their own
    def find_spec(cls, name: str, *more: Any, **named: Any) -> ModuleSpec | None:
        return None if name in MISSING else found(name, *more, **named)


PathFinder.find_spec = Finder.find_spec  # type: ignore[method-assign, assignment]
