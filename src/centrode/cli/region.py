"""`centrode region`: the reachable region of two drives, as tables and a picture."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

import centrode as ct
from centrode import render
from centrode.cli import output
from centrode.cli.about import about
from centrode.cli.arguments import mechanism_argument, no_figures_option, results_option
from centrode.cli.pairs import pairs, ranges
from centrode.cli.progress import Progress
from centrode.cli.tables import tables_options
from centrode.errors import InputError
from centrode.locale import _, mark

if TYPE_CHECKING:
    import xarray


@click.command(help=mark("Compute the reachable region of two drives and draw it."))
@mechanism_argument
@click.option(
    "--drive",
    "drives",
    multiple=True,
    metavar=mark("NAME"),
    help=mark("One of the two drives; say it twice where there are more than two."),
)
@click.option(
    "--range",
    "spans",
    multiple=True,
    metavar=mark("NAME=FIRST:LAST"),
    help=mark('Range of a drive ("EC=0 deg:90 deg"); one turn, or between its limits, if left out.'),
)
@click.option(
    "--hold",
    multiple=True,
    metavar=mark("NAME=VALUE"),
    help=mark("Value of a further drive; its initial one if left out."),
)
@click.option("--samples", type=int, metavar=mark("N"), help=mark("Grid lines of each drive."))
@results_option
@tables_options
@no_figures_option
def region(
    mechanism: str,
    drives: tuple[str, ...],
    spans: tuple[str, ...],
    hold: tuple[str, ...],
    samples: int | None,
    out: Path | None,
    no_figures: bool,
) -> None:
    """Compute and write the region of two drives."""
    description = ct.load(mechanism)
    folder = output.folder_of(out, mechanism, "region")
    with output.output_folder(folder) as draft, Progress() as progress:
        progress.say(_("solving"))
        with about(mechanism):
            found = ct.reachable_region(
                description,
                drives or None,
                ranges(spans, "--range"),
                held=pairs(hold, "--hold"),
                **({} if samples is None else {"samples": samples}),
            )
        progress.say(_("writing tables"))
        ct.write_region_csv(found, draft, description.display)
        ct.write_motion_netcdf(found, draft / "region.nc")
        if not no_figures:
            progress.say(_("drawing"))
            picture = ct.region_figure(description, found, _motion(description))
            ct.save_figures({"region": picture}, draft)
        names = output.finished(draft)
    click.echo(_(description.title) or mechanism)
    click.echo()
    click.echo(render.aligned(ct.region_rows(description, found)))
    click.echo("\n" + output.files_in(folder, names))


def _motion(description: ct.Mechanism) -> xarray.Dataset | None:
    """The path of the drives in time; none where nothing says how long it is."""
    try:
        return ct.motion(description)
    except InputError:
        return None
