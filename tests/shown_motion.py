"""Figures and tables of a motion that is at hand as a dataset."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from pathlib import Path

import xarray
from matplotlib.figure import Figure

import centrode as ct
from centrode import render
from centrode.model.settings import Display
from centrode.render.files import header, shown_columns
from centrode.render.table_files import PLAIN, TableSpelling
from centrode.views.columns import motion_table
from centrode.views.motion import motion_pictures


def motion_figures(
    mechanism: ct.Mechanism,
    dataset: xarray.Dataset,
    instants: Sequence[float] = (),
    only: Collection[str] = (),
) -> dict[str, Figure]:
    """The figures of a motion by name; all of them, or those of some names."""
    pictures = motion_pictures(mechanism, dataset, instants)
    chosen = {name: picture for name, picture in pictures.items() if not only or name in only}
    return render.figures_of(chosen, mechanism.display)


def columns_of(
    dataset: xarray.Dataset, display: Display | None = None, points: Sequence[str] | None = None
) -> tuple[list[str], list[list[float] | list[str]]]:
    """Headers and columns of the table of a motion, in SI without a display."""
    table = motion_table(dataset, points)
    return [header(column, display) for column in table.columns], shown_columns(table, display)


def write_motion(
    dataset: xarray.Dataset,
    path: Path,
    display: Display | None = None,
    points: Sequence[str] | None = None,
    spelling: TableSpelling = PLAIN,
) -> None:
    """Write the table of a motion as CSV, and as what `spelling` says."""
    render.write_table(motion_table(dataset, points), path, display or Display(), spelling)
