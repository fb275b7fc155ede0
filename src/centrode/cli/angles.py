"""`centrode angles`: transmission and pressure angles of the dyads over a motion."""

from __future__ import annotations

from pathlib import Path

import click

import centrode as ct
from centrode.cli import output
from centrode.cli.about import about
from centrode.cli.arguments import mechanism_argument
from centrode.cli.progress import Progress
from centrode.locale import _, mark, ngettext

DEFAULT_FOLDER = "{name}-angles"


@click.command(help=mark("Compute transmission and pressure angles over the motion."))
@mechanism_argument
@click.option("--samples", type=int, metavar=mark("N"), help=mark("Number of samples, both ends included."))
@click.option("--dark", is_flag=True, help=mark("Pictures with light lines on a dark ground."))
@click.option(
    "--out",
    type=click.Path(path_type=Path),
    metavar=mark("DIR"),
    help=mark("Folder for the results; named after the mechanism if left out."),
)
@click.option("--no-figures", is_flag=True, help=mark("Write no pictures."))
def angles(mechanism: str, samples: int | None, dark: bool, out: Path | None, no_figures: bool) -> None:
    """Compute, write and draw."""
    description = ct.load(mechanism)
    folder = out if out is not None else Path(DEFAULT_FOLDER.format(name=Path(mechanism).stem))
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
        names = sorted(path.name for path in draft.iterdir())
    click.echo(_(description.title) or mechanism)
    click.echo()
    click.echo(output.table(ct.transmission_rows(found), right=(1, 2, 3)))
    count = ngettext("{n} file in {folder}", "{n} files in {folder}", len(names)).format(
        n=len(names), folder=folder
    )
    click.echo(f"\n{output.paragraph(f'{count}:', names)}")
