"""Help texts of matplotlib's artists, which no command shows: to write them takes a fifth of its import."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from importlib.abc import MetaPathFinder
from importlib.machinery import ModuleSpec, PathFinder
from types import ModuleType
from typing import Any

ARTISTS = "matplotlib.artist"
WRITER = "_update_set_signature_and_docstring"
"""What writes signature and help of `set` for each class of artists, as matplotlib 3.5 and later name it."""


class _Finder(MetaPathFinder):
    """Finds the module of artists alone, and takes their help texts out before other modules make classes of it."""

    def find_spec(
        self, name: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """The module as it is, with a loader that goes on where its own ends."""
        found = PathFinder.find_spec(name, path, target) if name == ARTISTS else None
        if found is not None and found.loader is not None:
            loader: Any = found.loader
            execute = loader.exec_module

            def without_help(module: ModuleType) -> None:
                execute(module)
                artist = getattr(module, "Artist", None)
                if hasattr(artist, WRITER):
                    setattr(artist, WRITER, classmethod(lambda _kind: None))

            loader.exec_module = without_help
        return found


@contextmanager
def omitted_help_texts() -> Iterator[None]:
    """While the block runs, matplotlib is imported without the help of its artists; where it is there, it stays."""
    finder = _Finder()
    sys.meta_path.insert(0, finder)
    try:
        yield
    finally:
        sys.meta_path.remove(finder)
