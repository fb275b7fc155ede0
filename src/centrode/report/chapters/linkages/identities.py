"""Checks of a motion by identities that it was not computed from: rigid bodies, differences, return after a turn."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.errors import Status
from centrode.locale import _
from centrode.model.mechanism import Mechanism
from centrode.render.document.blocks import Check
from centrode.render.document.rows import small
from centrode.report.study import ReportStudy

Array = npt.NDArray[np.float64]
EPS = float(np.finfo(float).eps)
MENDED = (1e-10, 1e-8)
"""Errors of velocities and accelerations about change points, where motions are interpolated (docs: conventions)."""
ROUNDED = 1 << 20
"""Rounding of a rate is multiplied by this at a transmission angle of 0.06 deg: one over the square of its sine."""


def identity_checks(study: ReportStudy) -> Iterator[Check]:
    """Theorems on the velocities and accelerations of rigid bodies, over all samples that are reached."""
    data = study.motion
    reached = data["status"].to_numpy() == Status.OK
    if not reached.any():
        return
    data = data.isel(sample=np.flatnonzero(reached))
    mended = bool(study.motion["event_kind"].to_numpy().any())
    for order, text in (
        (
            1,
            _(
                "Euler's theorem: for all points of each link the velocity is that of another point and the rotation "
                "about it; the greatest difference is {off} of the greatest velocity, {allowed} is allowed."
            ),
        ),
        (
            2,
            _(
                "The same for accelerations, with their normal and tangential parts: the greatest difference is {off} "
                "of the greatest acceleration, {allowed} is allowed."
            ),
        ),
    ):
        worst = off_rigid(study.mechanism, data, order)
        if worst is None:
            continue
        allowed = ROUNDED * EPS + (MENDED[order - 1] if mended else 0.0)
        told = text.format(off=small(worst), allowed=small(allowed))
        yield Check(told, worst <= allowed)


def off_rigid(mechanism: Mechanism, data: xr.Dataset, order: int) -> float | None:
    """Greatest difference from the rotation about another point of the link, over the greatest rate.

    None where no link has two points, or nothing moves.
    """
    name = "velocity" if order == 1 else "acceleration"
    worst, size = 0.0, 0.0
    pairs = 0
    for link, described in mechanism.links.items():
        points = list(described.coordinates)
        turn, second = (
            data[f"angular_{word}"].sel(link=link).to_numpy()[:, None]
            for word in ("velocity", "acceleration")
        )
        for point in points[1:]:
            arm = _of(data, "position", point) - _of(data, "position", points[0])
            apart = _of(data, name, point) - _of(data, name, points[0])
            square = np.stack([-arm[:, 1], arm[:, 0]], axis=1)
            rotation = turn * square if order == 1 else second * square - turn**2 * arm
            worst = max(worst, float(np.nanmax(np.abs(apart - rotation))))
            size = max(
                size, float(np.nanmax(np.abs(_of(data, name, point)))), float(np.nanmax(np.abs(rotation)))
            )
            pairs += 1
    return worst / size if pairs and size else None


def _of(data: xr.Dataset, name: str, point: str) -> Array:
    return np.asarray(data[name].sel(point=point).to_numpy(), dtype=np.float64)
