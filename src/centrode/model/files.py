"""Mechanisms in files: TOML in, TOML out, and nothing lost between."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import tomli_w

from centrode.errors import InputError
from centrode.locale import _
from centrode.model.document import document
from centrode.model.mechanism import Mechanism
from centrode.model.reading import read_file
from centrode.model.toml_text import described, is_cam, toml_tables

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
    return in_short_lines(tomli_w.dumps(document(mechanism)))


def in_short_lines(text: str) -> str:
    """A text of TOML with short lists in one line each."""
    return _SHORT_LIST.sub(_in_one_line, text)


def _in_one_line(match: re.Match[str]) -> str:
    return "[" + ", ".join(line.strip().removesuffix(",") for line in match.group(1).splitlines()) + "]"
