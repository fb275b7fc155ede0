"""A cam that a drive names: a description in a file beside its own, a built-in one, or tables of it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from centrode.errors import InputError
from centrode.locale import _
from centrode.model.description_files import DescriptionFiles
from centrode.model.follower_cam import PlateCam
from centrode.model.toml import description_kind


def read_plate_cam(value: object) -> PlateCam | None:
    """The plate cam that a value names or holds; Problem where there is none."""
    if value is None or isinstance(value, PlateCam):
        return value
    return PLATE_CAMS.from_value(value)


def _plate_cam(tables: Mapping[str, Any], where: str) -> type[PlateCam]:
    """The class of plate cams, where tables describe one that can drive something."""
    if description_kind(tables) != "cam":
        repair = _('a cam\'s description has kind = "cam"')
        raise InputError(where, _("this does not describe a cam"), repair)
    if "follower" not in tables:
        what = _("this cam has no follower whose lift could drive something")
        raise InputError(where, what, _("write [follower] and [[segments]]"))
    return PlateCam


PLATE_CAMS = DescriptionFiles("cam", _plate_cam)
"""Plate cams in files."""
