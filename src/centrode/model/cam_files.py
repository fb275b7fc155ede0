"""Cams in files: TOML in, TOML out."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, TypeAlias

from centrode.errors import InputError
from centrode.locale import _
from centrode.model.cam import Cam
from centrode.model.description_files import DescriptionFiles
from centrode.model.follower_cam import PlateCam

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
    return CAMS.read(path)


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
    return CAMS.parse(text, where, folder)


def kind_of_cam(mapping: Mapping[str, Any], where: str = "") -> type[Cam] | type[PlateCam]:
    """Which kind of cam tables describe; raises InputError that starts with `where` where they mix both."""
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


CAMS: DescriptionFiles[AnyCam] = DescriptionFiles("cam", kind_of_cam)
"""Cams in files."""


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
    return CAMS.text(cam)
