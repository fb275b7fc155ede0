"""Mechanisms in files: TOML in, TOML out, and nothing lost between."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import tomli_w

from centrode.errors import InputError
from centrode.locale import _
from centrode.model.document import document
from centrode.model.mechanism import Mechanism
from centrode.model.reading import read_file
from centrode.model.toml_text import described, is_cam, toml_tables

_HEADING = re.compile(r"^(\[\[?)", re.MULTILINE)
_SHORT_LIST = re.compile(r"\[\n((?: +[^\[\]\n]*,\n)+) *\]")


def read_mechanism(path: str | Path) -> Mechanism:
    """The mechanism described in a TOML file; raises InputError that says where it is wrong."""
    path = Path(path)
    return parse_mechanism(read_file(path), path.name, path.parent)


def parse_mechanism(text: str, where: str = "", folder: Path | None = None) -> Mechanism:
    """The mechanism described in a text of TOML.

    Parameters
    ----------
    text : str
    where : str
        What messages call the text, such as the name of its file.
    folder : Path
        Where the tables of drives lie; the current folder if left out.

    Raises
    ------
    InputError
    """
    return mechanism_from(toml_tables(text, where), where, folder)


def mechanism_from(mapping: Mapping[str, Any], where: str = "", folder: Path | None = None) -> Mechanism:
    """The mechanism described by plain dicts and lists as a file's; raises InputError that starts with `where`."""
    if is_cam(mapping):
        repair = _("compute it with: centrode cam; in Python read it with read_cam")
        raise InputError(where, _("this describes a cam, not a linkage"), repair)
    return described(Mechanism, mapping, where, folder)


def mechanism_text(mechanism: Mechanism) -> str:
    """The mechanism as TOML in SI, without defaults; `parse_mechanism` gives exactly it back."""
    return in_short_lines("\n".join(_sections(document(mechanism))))


def _sections(tables: Mapping[str, Any]) -> Iterator[str]:
    """Top keys, then each table in its order; each entry of a list of tables below a heading of its own."""
    plain = {
        key: value for key, value in tables.items() if not isinstance(value, dict) and not _is_tables(value)
    }
    if plain:
        yield tomli_w.dumps(plain)
    for key, value in tables.items():
        if isinstance(value, dict):
            yield tomli_w.dumps({key: value})
        elif _is_tables(value):
            # headings inside an entry belong to the entry
            yield from (f"[[{key}]]\n" + _HEADING.sub(rf"\1{key}.", tomli_w.dumps(entry)) for entry in value)


def _is_tables(value: object) -> bool:
    return isinstance(value, list | tuple) and bool(value) and all(isinstance(entry, dict) for entry in value)


def in_short_lines(text: str) -> str:
    """A text of TOML with short lists in one line each."""
    return _SHORT_LIST.sub(_in_one_line, text)


def _in_one_line(match: re.Match[str]) -> str:
    return "[" + ", ".join(line.strip().removesuffix(",") for line in match.group(1).splitlines()) + "]"
