"""Kinematic coefficients of one instant: derivatives by the drive's value, the analogs of velocity and acceleration."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import xarray as xr

from centrode.locale import _
from centrode.render.document.blocks import Table, shown
from centrode.report.study import ReportStudy


def coefficient_tables(study: ReportStudy, data: xr.Dataset) -> Iterator[Table]:
    """One table of the links, one of the points; `data` is a sample of a motion with one drive."""
    yield _of_links(study, data)
    yield _of_points(study, data)


def _of_links(study: ReportStudy, data: xr.Dataset) -> Table:
    heads, columns = [], []
    for order, word in enumerate(("velocity", "acceleration"), start=1):
        values = data[f"angular_{word}_coefficient"]
        unit = str(values.attrs["units"])
        columns.append(study.numbers.column(np.asarray(values), unit))
        heads.append(study.numbers.head(f"$phi{order * chr(39)}$", unit))
    names = [shown(name) for name in study.mechanism.link_names]
    caption = _("Kinematic coefficients of the links: derivatives of their angles by the value of the drive")
    return Table((_("link"), *heads), tuple(zip(names, *columns, strict=True)), caption, (False, True, True))


def _of_points(study: ReportStudy, data: xr.Dataset) -> Table:
    heads, columns = [], []
    points = list(study.mechanism.moving_points)
    for order, word in enumerate(("velocity", "acceleration"), start=1):
        values = data[f"{word}_coefficient"].sel(point=points)
        unit = str(values.attrs["units"])
        for axis in ("x", "y"):
            columns.append(study.numbers.column(np.asarray(values.sel(axis=axis)), unit))
            heads.append(study.numbers.head(f"${axis}{order * chr(39)}$", unit))
    names = [shown(name) for name in points]
    caption = _("Kinematic coefficients of the points: analogs of their velocities and accelerations")
    return Table(
        (_("point"), *heads), tuple(zip(names, *columns, strict=True)), caption, (False, *(True,) * 4)
    )
