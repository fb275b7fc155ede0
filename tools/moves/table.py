"""Tables of moves: which new module is made of which old ones, and what is called anew."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

PACKAGE = "centrode"


def dotted(path: str) -> str:
    """The module of a path below the package without its ending, "laws/rises" or "laws/__init__"."""
    return ".".join([PACKAGE, *path.removesuffix("/__init__").split("/")])


@dataclass(frozen=True)
class Text:
    """A passage of a file that says something of names and is written anew."""

    file: str
    old: str
    new: str


@dataclass(frozen=True)
class Table:
    """The moves of one room.

    Attributes
    ----------
    modules : new path -> old paths
        Below the package, without endings; the first gives the docstring.
    folders : old -> new folder, from the root
        Moved whole, what `modules` names excepted.
    docstrings : new path -> text
    names : (old module, name) -> new name
        Of definitions; of an import, the name that it is bound to there.
    locals : (old module, function, name) -> new name
    methods : (old module, class, method) -> new name
    texts : passages
    gone : files, from the root
        Removed without a successor: the lazy face of a room that ceases, whose names are taken from their modules.
    """

    modules: Mapping[str, tuple[str, ...]]
    folders: Mapping[str, str] = field(default_factory=dict)
    docstrings: Mapping[str, str] = field(default_factory=dict)
    names: Mapping[tuple[str, str], str] = field(default_factory=dict)
    locals: Mapping[tuple[str, str, str], str] = field(default_factory=dict)
    methods: Mapping[tuple[str, str, str], str] = field(default_factory=dict)
    texts: tuple[Text, ...] = ()
    gone: tuple[str, ...] = ()


def read_table(path: Path) -> Table:
    """A table from TOML.

    Keys of names are "old/module:name", of locals "old/module:function:name", of methods "old/module:Class.method".
    """
    content = tomllib.loads(path.read_text(encoding="utf-8"))
    names: dict[tuple[str, str], str] = {}
    places: dict[tuple[str, str, str], str] = {}
    methods: dict[tuple[str, str, str], str] = {}
    for key, new in content.get("names", {}).items():
        module, name = key.split(":")
        names[dotted(module), name] = new
    for key, new in content.get("locals", {}).items():
        module, function, name = key.split(":")
        places[dotted(module), function, name] = new
    for key, new in content.get("methods", {}).items():
        module, name = key.split(":")
        owner, method = name.split(".")
        methods[dotted(module), owner, method] = new
    return Table(
        modules={new: tuple(old.split()) for new, old in content.get("modules", {}).items()},
        folders=content.get("folders", {}),
        docstrings=content.get("docstrings", {}),
        names=names,
        locals=places,
        methods=methods,
        texts=tuple(Text(**text) for text in content.get("texts", [])),
        gone=tuple(content.get("gone", [])),
    )
