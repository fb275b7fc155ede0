"""`centrode angles`: transmission and pressure angles of the dyads over a motion."""

from __future__ import annotations

from pathlib import Path

import click

import centrode as ct
from centrode import render
from centrode.cli import output
from centrode.cli.about import about
from centrode.cli.arguments import (
    dark_option,
    mechanism_argument,
    no_figures_option,
    results_option,
    samples_option,
)
from centrode.cli.expected import announce_size
from centrode.cli.progress import Progress
from centrode.cli.tables import tables_options
from centrode.locale import _, mark


@click.command(help=mark("Compute transmission and pressure angles over the motion."))
@mechanism_argument
@samples_option
@dark_option
@results_option
@tables_options
@no_figures_option
def angles(mechanism: str, samples: int | None, dark: bool, out: Path | None, no_figures: bool) -> None:
    """Compute, write and draw."""
    description = ct.load(mechanism)
    announce_size(description, samples)
    folder = output.folder_of(out, mechanism, "angles")
    with output.output_folder(folder) as draft, Progress() as progress:
        progress.say(_("solving"))
        with about(mechanism):
            found = ct.transmission_angles(description, samples)
        (draft / "transmission.csv").write_text(ct.transmission_csv(found), encoding="utf-8")
        ct.write_motion_netcdf(found, draft / "transmission.nc")
        if not no_figures:
            progress.say(_("drawing"))
            figure = ct.transmission_figure(description, found)
            ct.save_figures({"transmission": ct.darkened(figure) if dark else figure}, draft)
        names = output.finished(draft)
    click.echo(_(description.title) or mechanism)
    click.echo()
    click.echo(render.aligned(ct.transmission_rows(found), right=(1, 2, 3)))
    click.echo("\n" + output.files_in(folder, names))
