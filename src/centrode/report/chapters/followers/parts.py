"""Parts of the results of a cam with a follower, each computed when first asked for, once."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from centrode.cams.followers.base_circle import follower_cam, has_bounds
from centrode.cams.followers.motion import FollowerMotion, follower_motion
from centrode.locale import _
from centrode.render.document.blocks import Block, CheckBlock, SectionBlocks, TableBlock
from centrode.render.document.rows import told
from centrode.report.chapters.forces.tables import ForceColumn, over_samples
from centrode.study.cams.parts import Asked, CamPart
from centrode.study.cams.results import FOLLOWER_PARTS
from centrode.views.columns import rows_shown

if TYPE_CHECKING:
    import xarray as xr

    from centrode.cams.followers.geometry import FollowerCam
    from centrode.report.study import ReportStudy

MEGA = 1e-6
ROUNDED = float(np.finfo(float).eps) * (1 << 12)
"""What rounding may leave, in parts of a size: some dozens of operations, and a few angles in between."""
SAME = 1e-12
"""Share of a column's greatest size below which a difference is rounding."""
ROWS = 37
"""Rows of a table over a turn: every ten degrees of 361 samples."""


def part_of(study: ReportStudy, name: str) -> CamPart | None:
    """One part of the results; None where the description does not ask for it."""
    if not study.is_plate_cam:
        return None
    return study.once(("follower", name), lambda: FOLLOWER_PARTS[name](study.plate, Asked()))


def motion_of(study: ReportStudy) -> FollowerMotion:
    """The follower's motion."""
    return study.once("follower-motion", lambda: follower_motion(study.plate))


def body_of(study: ReportStudy) -> FollowerCam | None:
    """The cam; nothing where neither its size nor bounds are given. Raises as `follower_cam`."""
    cam = study.plate
    if cam.body.base_radius is None and not has_bounds(cam):
        return None
    return study.once("follower-cam", lambda: follower_cam(cam))


def letter_of(study: ReportStudy) -> str:
    """Of the lift, as mathematics."""
    return "psi" if study.plate.swings else "s"


def rate(letter: str, order: int) -> str:
    """A derivative by the cam's angle, as mathematics."""
    return letter + "'" * order


def course(
    study: ReportStudy, data: xr.Dataset, columns: list[tuple[str, str]], caption: str, *, brief: bool = False
) -> TableBlock:
    """Variables of a dataset over the angle of the cam, at even steps; stresses in MPa.

    A `brief` one has of rows that are alike, but for the angle, only the first and the last.
    """
    found = [ForceColumn("$phi$", "rad", data["cam_angle"].to_numpy())]
    for name, letter in columns:
        values, unit = data[name].to_numpy(), str(data[name].attrs["units"])
        scale, shown_unit = (MEGA, "MPa") if unit == "Pa" else (1.0, unit)
        found.append(ForceColumn(f"${letter}$", shown_unit, scale * values))
    kept = list(rows_shown(data.sizes["sample"], ROWS))
    if brief:
        kept = _unlike(kept, found[1:])
        if len(kept) < len(rows_shown(data.sizes["sample"], ROWS)):
            caption = _("{caption}; of alike rows the first and the last").format(caption=caption)
    return over_samples(study.numbers, found, kept, caption)


def _unlike(kept: list[int], columns: list[ForceColumn]) -> list[int]:
    """Rows without those between others that are the same."""
    values = np.array([one.values[kept] for one in columns])
    sizes = np.nanmax(np.abs(values), axis=1, initial=0.0, keepdims=True)
    step = np.abs(np.diff(values, axis=1)) <= SAME * sizes
    alike = (step | (np.isnan(values[:, 1:]) & np.isnan(values[:, :-1]))).all(axis=0)
    inner = np.flatnonzero(alike[1:] & alike[:-1]) + 1
    return [row for k, row in enumerate(kept) if k not in set(inner.tolist())]


def sections_of(*titled: tuple[str, tuple[Block, ...]]) -> tuple[SectionBlocks, ...]:
    """Sections with something in them."""
    return tuple(SectionBlocks(title, blocks) for title, blocks in titled if blocks)


def told_failures(study: ReportStudy, part: CamPart) -> tuple[CheckBlock, ...]:
    """What the cam cannot do."""
    return tuple(CheckBlock(told(f"{one}.", study.numbers), False) for one in part.failures)
