"""Cams in files: TOML in, TOML out."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import tomli_w

from centrode.errors import InputError
from centrode.locale import _
from centrode.model.cams.description import Cam
from centrode.model.files import in_short_lines
from centrode.model.reading import read_file
from centrode.model.tabled import part_tables
from centrode.model.toml_text import described, is_cam, toml_tables


def read_cam(path: str | Path) -> Cam:
    """The cam described in a TOML file; raises InputError that says where it is wrong."""
    path = Path(path)
    return parse_cam(read_file(path), path.name, path.parent)


def parse_cam(text: str, where: str = "", folder: Path | None = None) -> Cam:
    """The cam described in a text of TOML.

    Parameters
    ----------
    text : str
    where : str
        What messages call the text, such as the name of its file.
    folder : Path
        Where the points of a spline lie; the current folder if left out.

    Raises
    ------
    InputError
    """
    return cam_from(toml_tables(text, where), where, folder)


def cam_from(mapping: Mapping[str, Any], where: str = "", folder: Path | None = None) -> Cam:
    """The cam described by plain dicts and lists as a file's; raises InputError that starts with `where`."""
    if not is_cam(mapping) and "links" in mapping:
        what = _("this describes a linkage, not a cam")
        raise InputError(
            where, what, _("compute it with: centrode run; in Python read it with read_mechanism")
        )
    return described(Cam, mapping, where, folder)


def cam_text(cam: Cam) -> str:
    """The cam as TOML in SI, without defaults; `parse_cam` gives exactly it back."""
    return in_short_lines(tomli_w.dumps(part_tables(cam)))
