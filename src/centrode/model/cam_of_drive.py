"""A cam that a drive names: a description in a file beside its own, a built-in one, or tables of it."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import PurePosixPath

from centrode.errors import InputError
from centrode.locale import _
from centrode.model.examples import example_names, example_text
from centrode.model.follower_cam import PlateCam
from centrode.model.reading import Problem, nearest, read_file, value_text
from centrode.model.toml import bare_angles_of, description_kind, parse_tables, toml_tables
from centrode.model.values import READING


def read_plate_cam(value: object) -> PlateCam | None:
    """The plate cam that a value names or holds; Problem where there is none."""
    if value is None or isinstance(value, PlateCam):
        return value
    if isinstance(value, Mapping):
        return _parse_plate_cam(value, "")
    if not isinstance(value, str):
        what = _("expected the name of a cam's file or of a built-in cam, got {value}")
        raise Problem(what.format(value=value_text(value)))
    try:
        return _parse_plate_cam(toml_tables(_text(value), value), value)
    except InputError as error:
        raise Problem(": ".join(part for part in (error.where, error.what) if part), error.repair) from None


def _text(name: str) -> str:
    """Text of a file beside the description, or of a built-in cam."""
    if not name.endswith(".toml"):
        names = example_names("cam")
        if name not in names:
            what = _("there is no built-in cam {name}").format(name=value_text(name))
            raise Problem(what, _("a file's name ends in .toml") + "; " + nearest(name, names))
        return example_text(name)
    path = PurePosixPath(name.replace("\\", "/"))
    if not name.isprintable() or path.is_absolute() or ".." in path.parts or ":" in name:
        what = _("{name} is not in the folder of the description").format(name=value_text(name))
        raise Problem(what, _("put the cam's file into the folder of the description"))
    return read_file(READING.get().folder / path)


def _parse_plate_cam(tables: Mapping[str, object], name: str) -> PlateCam:
    """The plate cam that tables describe."""
    if description_kind(tables) != "cam":
        what = _("this does not describe a cam")
        raise Problem(f"{name}: {what}" if name else what, _('a cam\'s description has kind = "cam"'))
    if "follower" not in tables:
        what = _("this cam has no follower whose lift could drive something")
        raise Problem(f"{name}: {what}" if name else what, _("write [follower] and [[segments]]"))
    try:
        outer = READING.get()
        bare_angles = bare_angles_of(tables) if outer.bare_angles == "refused" else outer.bare_angles
        return parse_tables(PlateCam, tables, name, outer.folder, bare_angles)
    except InputError as error:
        raise Problem(": ".join(part for part in (error.where, error.what) if part), error.repair) from None
