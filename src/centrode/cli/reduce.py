"""`centrode reduce`: masses and loads reduced to the drive."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

import centrode as ct
from centrode import render
from centrode.cli import output
from centrode.cli.about import about
from centrode.cli.arguments import (
    mechanism_argument,
    no_figures_option,
    range_option,
    samples_option,
    start_option,
    stop_option,
    written_option,
)
from centrode.cli.expected import announce_size
from centrode.cli.progress import Progress
from centrode.cli.tables import tables_options
from centrode.errors import MotionError, Status
from centrode.locale import _, mark, ngettext

if TYPE_CHECKING:
    import xarray

MISSING = (Status.OPEN, Status.CUT_OFF, Status.UNCONVERGED)


@click.command(help=mark("Reduce masses and loads to the drive, part by part."))
@mechanism_argument
@written_option
@tables_options
@samples_option
@start_option
@stop_option
@range_option
@no_figures_option
def reduce(
    mechanism: str,
    out: Path | None,
    samples: int | None,
    start: str | None,
    stop: str | None,
    ranged: str | None,
    no_figures: bool,
) -> None:
    """Print the parts of the reduction and write them where asked; exit code 3 if the mechanism locks in the range."""
    description = ct.load(mechanism)
    announce_size(description, samples)
    description = ct.with_range(description, ranged)
    first = None if start is None else ct.range_value(description, start, "--from")
    last = None if stop is None else ct.range_value(description, stop, "--to")
    names: list[str] = []
    if out is None:
        found = _reduced(mechanism, description, samples, first, last)
    else:
        with output.output_folder(out) as draft, Progress() as progress:
            progress.say(_("solving"))
            found = _reduced(mechanism, description, samples, first, last)
            _write(description, found, draft, progress, figures=not no_figures)
            names = output.finished(draft)
    click.echo(_(description.title) or mechanism)
    click.echo()
    click.echo(render.aligned(ct.reduction_rows(description, found)))
    header, rows = ct.reduction_parts(found, description)
    click.echo("\n" + render.aligned(rows, header, right=(2, 3, 4)))
    if out is not None:
        click.echo("\n" + output.files_in(out, names))
    _tell_failure(mechanism, description, found)


def _reduced(
    name: str, description: ct.Mechanism, samples: int | None, start: float | None, stop: float | None
) -> xarray.Dataset:
    with about(name):
        return ct.reduce(description, samples, start, stop)


def _write(
    description: ct.Mechanism, found: xarray.Dataset, folder: Path, progress: Progress, *, figures: bool
) -> None:
    progress.say(_("writing tables"))
    ct.write_reduction_csv(found, folder / "reduction.csv", description.display)
    ct.write_motion_netcdf(found, folder / "reduction.nc")
    if figures:
        progress.say(_("drawing"))
        ct.save_figures(ct.reduction_figures(description, found), folder)


def _tell_failure(name: str, description: ct.Mechanism, found: xarray.Dataset) -> None:
    """Raise MotionError where samples are not reached, with the limits that bound the motion."""
    status = found["status"].to_numpy().tolist()
    missing = sum(code in MISSING for code in status)
    if missing:
        what = ngettext(
            "the mechanism locks: {missing} of {all} samples is not reached",
            "the mechanism locks: {missing} of {all} samples are not reached",
            missing,
        ).format(missing=missing, all=len(status))
        where = ct.limits_sentence(description)
        raise MotionError(name, f"{what} ({where})" if where else what, ct.repair_of_range(description))
