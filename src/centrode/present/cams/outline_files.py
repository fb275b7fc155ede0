"""The outlines of a cam's results as files for machines."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from centrode.locale import _
from centrode.present.cams.outline_dxf import write_outlines_dxf
from centrode.present.cams.outlines import write_outlines_svg

if TYPE_CHECKING:
    from centrode.model.cam_files import AnyCam


def write_cam_outlines(cam: AnyCam, objects: Mapping[str, Any], folder: Path, *, dxf: bool = True) -> None:
    """Write the profiles of a cam and of its shoe as SVG and DXF into a folder.

    Parameters
    ----------
    objects : mapping
        `CamPart.objects` of all parts: "plate_outlines" are written where they are there.
    dxf : bool
        Also DXF; InputError where the extra `drawings` is not installed.
    """
    found = {}
    if "plate_outlines" in objects:
        found["cam-profile"] = objects["plate_outlines"]
    title = _(cam.title)
    for name, outlines in found.items():
        write_outlines_svg(outlines, folder / f"{name}.svg", title)
        if dxf:
            write_outlines_dxf(outlines, folder / f"{name}.dxf", title)
