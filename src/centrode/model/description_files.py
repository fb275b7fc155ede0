"""Reader and writer of descriptions of every kind: files, texts of TOML, tables, names in other descriptions."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path, PurePosixPath
from typing import Any, Generic

import tomli_w

from centrode.errors import InputError
from centrode.locale import _
from centrode.model.examples import FOLDERS, example_names, example_text
from centrode.model.links import part_tables
from centrode.model.reading import Problem, nearest, read_file, value_text
from centrode.model.toml import (
    KINDS,
    Described,
    bare_angles_of,
    in_short_lines,
    parse_tables,
    refuse_other_kind,
    toml_tables,
    with_unit,
)
from centrode.model.values import READING, BareAngles

START: Mapping[str, str] = {"linkage": "crank-rocker"}
"""The built-in description to begin with, where that is not the first of its kind."""


class DescriptionFiles(Generic[Described]):
    """Descriptions of one kind: read from files, texts and tables, and written.

    Parameters
    ----------
    kind : of `KINDS`
    class_of : (tables, where) -> the class that they describe; raises InputError that starts with `where`
    """

    def __init__(self, kind: str, class_of: Callable[[Mapping[str, Any], str], type[Described]]) -> None:
        self.kind = kind
        self._class_of = class_of

    def read(self, path: str | Path) -> Described:
        """What a TOML file describes; raises InputError that says where it is wrong."""
        path = Path(path)
        return self.parse(read_file(path), path.name, path.parent)

    def parse(self, text: str, where: str = "", folder: Path | None = None) -> Described:
        """What a text of TOML describes, files beside it in `folder`; `where` is what messages call it."""
        tables = toml_tables(text, where)
        if not tables and self.kind in FOLDERS:
            start = START.get(self.kind) or example_names(self.kind)[0]
            repair = _("begin with a built-in one: centrode examples {name} --out mine.toml").format(
                name=start
            )
            raise InputError(where, _("nothing is described: no line has key = value"), repair)
        return self.from_tables(tables, where, folder, bare_angles_of(tables))

    def from_tables(
        self,
        mapping: Mapping[str, Any],
        where: str = "",
        folder: Path | None = None,
        bare_angles: BareAngles = "radians",
    ) -> Described:
        """What plain dicts and lists as a file's describe; raises InputError that starts with `where`."""
        refuse_other_kind(mapping, self.kind, where)
        return parse_tables(self._class_of(mapping, where), mapping, where, folder, bare_angles)

    def example(self, name: str) -> Described:
        """The built-in one of a name; InputError where there is none."""
        return self.parse(example_text(name), f"{name}.toml")

    def from_value(self, value: object) -> Described:
        """What a value of another description names or holds: a file beside that one, a built-in one, or tables.

        Raises Problem where there is none of this kind.
        """
        try:
            if isinstance(value, Mapping):
                return self._from_inner_tables(value, "")
            if not isinstance(value, str):
                raise Problem(_(KINDS[self.kind].named).format(value=value_text(value)))
            return self._from_inner_tables(toml_tables(self._text_of(value), value), value)
        except InputError as error:
            said = ": ".join(part for part in (error.where, error.what) if part)
            raise Problem(said, error.repair) from None

    def _from_inner_tables(self, tables: Mapping[str, Any], name: str) -> Described:
        outer = READING.get()
        own_angles = outer.bare_angles == "refused"
        bare_angles = bare_angles_of(tables) if own_angles else outer.bare_angles
        return self.from_tables(tables, name, outer.folder, bare_angles)

    def _text_of(self, name: str) -> str:
        """Text of a file beside the description that is read, or of a built-in one."""
        if not name.endswith(".toml"):
            names = example_names(self.kind)
            if name not in names:
                what = _(KINDS[self.kind].unknown).format(name=value_text(name))
                raise Problem(what, _("a file's name ends in .toml") + "; " + nearest(name, names))
            return example_text(name)
        path = PurePosixPath(name.replace("\\", "/"))
        if not name.isprintable() or path.is_absolute() or ".." in path.parts or ":" in name:
            what = _("{name} is not in the folder of the description").format(name=value_text(name))
            raise Problem(what, _("put the file into the folder of the description"))
        return read_file(READING.get().folder / path)

    def text(self, described: Described) -> str:
        """The description as TOML in SI, without defaults; `parse` gives exactly it back.

        Where it displays another unit of angles than the radian, angles are texts with their unit ("0.5 rad").
        """
        tables = part_tables(described)
        if bare_angles_of(tables) == "refused":
            tables = with_unit(part_tables(self.from_tables(tables, bare_angles="marked")))
        return in_short_lines(tomli_w.dumps(tables))
