"""Cams in files: TOML in, TOML out."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, TypeAlias

import tomli_w

from centrode.errors import InputError
from centrode.locale import _
from centrode.model.cam import Cam
from centrode.model.files import in_short_lines
from centrode.model.follower_cam import PlateCam
from centrode.model.links import part_tables
from centrode.model.reading import read_file
from centrode.model.toml import bare_angles_of, parse_tables, refuse_other_kind, toml_tables, with_unit
from centrode.model.values import BareAngles

AnyCam: TypeAlias = Cam | PlateCam
"""A cam by the curvature of its roller's path, or by the lift of its follower."""

_OF_CURVATURE = ("curvature", "start", "range")
_OF_FOLLOWER = ("follower", "segments")


def read_cam(path: str | Path) -> AnyCam:
    """The cam described in a TOML file; raises InputError that says where it is wrong.

    Examples
    --------
    >>> import centrode as ct
    >>> from pathlib import Path
    >>> _ = Path("cam.toml").write_text(ct.cam_text(ct.example("valve-cam")))
    >>> ct.read_cam("cam.toml").title
    'Valve cam'
    """
    path = Path(path)
    return parse_cam(read_file(path), path.name, path.parent)


def parse_cam(text: str, where: str = "", folder: Path | None = None) -> AnyCam:
    """The cam described in a text of TOML.

    Parameters
    ----------
    text : str
    where : str
        What messages call the text, such as the name of its file.
    folder : Path
        Where the points of a spline lie; the current folder by default.

    Raises
    ------
    InputError

    Examples
    --------
    >>> import centrode as ct
    >>> cam = ct.example("valve-cam")
    >>> ct.parse_cam(ct.cam_text(cam)) == cam
    True
    """
    tables = toml_tables(text, where)
    return cam_from(tables, where, folder, bare_angles_of(tables))


def cam_from(
    mapping: Mapping[str, Any],
    where: str = "",
    folder: Path | None = None,
    bare_angles: BareAngles = "radians",
) -> AnyCam:
    """The cam described by plain dicts and lists as a file's; raises InputError that starts with `where`."""
    kind: type[Cam] | type[PlateCam] = kind_of_cam(mapping, where)
    return parse_tables(kind, mapping, where, folder, bare_angles)


def kind_of_cam(mapping: Mapping[str, Any], where: str = "") -> type[Cam] | type[PlateCam]:
    """Which kind of cam tables describe; raises InputError that starts with `where` for those of a linkage."""
    refuse_other_kind(mapping, "cam", where)
    given = [key for key in _OF_FOLLOWER if key in mapping]
    if not given:
        return Cam
    other = [key for key in _OF_CURVATURE if key in mapping]
    if other:
        what = _(
            "{one} and {other} exclude each other: a cam has either a curvature law or a follower's lift"
        )
        told = what.format(
            one=f"[{other[0]}]", other="[follower]" if given[0] == "follower" else "[[segments]]"
        )
        raise InputError(where, told, _("keep one of them"))
    return PlateCam


def require_curvature_cam(cam: AnyCam) -> Cam:
    """The cam itself if it is one by a curvature law; InputError if a follower's lift gives it."""
    if isinstance(cam, Cam):
        return cam
    what = _("this cam is given by its follower's lift and has no curvature law")
    raise InputError("", what, _("its lift is that of follower_motion"))


def has_curvature_law(cam: AnyCam) -> bool:
    """Whether the curvature of its roller's path gives the cam."""
    return isinstance(cam, Cam)


def has_follower(cam: AnyCam) -> bool:
    """Whether a follower's lift gives the cam."""
    return isinstance(cam, PlateCam)


def with_follower(cam: AnyCam) -> PlateCam:
    """The cam itself if a follower's lift gives it; InputError if it is one by a curvature law."""
    if isinstance(cam, PlateCam):
        return cam
    what = _("this cam is given by a curvature law and has no follower's lift")
    raise InputError("", what, _("write [follower] and [[segments]]"))


def cam_text(cam: AnyCam) -> str:
    """The cam as TOML in SI, without defaults; `parse_cam` gives exactly it back.

    Where the cam displays degrees, angles are texts with their unit ("0.5 rad").

    Examples
    --------
    >>> import centrode as ct
    >>> print(ct.cam_text(ct.example("valve-cam")).splitlines()[1])
    kind = "cam"
    """
    tables = part_tables(cam)
    if cam.display.refuses_bare_angles:
        tables = with_unit(part_tables(cam_from(tables, bare_angles="marked")))
    return in_short_lines(tomli_w.dumps(tables))
