"""The outlines of a cam's results as files for machines."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from centrode.cams.profiles import cam_outlines, shoe_outlines
from centrode.locale import _
from centrode.present.cams.outline_dxf import write_outlines_dxf
from centrode.present.cams.outlines import write_outlines_svg

if TYPE_CHECKING:
    from centrode.model.cam_files import AnyCam

SAMPLES = 720
"""Spaces between the points of an outline over a turn."""


def write_cam_outlines(
    cam: AnyCam, objects: Mapping[str, Any], folder: Path, *, groove: bool = False, dxf: bool = True
) -> None:
    """Write the profiles of a cam and of its shoe as SVG and DXF into a folder.

    Parameters
    ----------
    objects : mapping
        `CamPart.objects` of all parts: "body" and "wheel" are written where they are there.
    groove : bool
        Also the outer wall.
    dxf : bool
        Also DXF; InputError where the extra `drawings` is not installed.
    """
    found = {}
    if "body" in objects:
        found["cam-profile"] = cam_outlines(objects["body"], SAMPLES, groove=groove)
    if "wheel" in objects:
        found["shoe-profile"] = shoe_outlines(objects["wheel"].shoe, SAMPLES // 4)
    title = _(cam.title)
    for name, outlines in found.items():
        write_outlines_svg(outlines, folder / f"{name}.svg", title)
        if dxf:
            write_outlines_dxf(outlines, folder / f"{name}.dxf", title)
