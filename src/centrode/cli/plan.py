"""`centrode plan`: the mechanism in numbered positions of a cycle."""

from __future__ import annotations

from pathlib import Path

import click

import centrode as ct
from centrode import render
from centrode.cli import output
from centrode.cli.about import about
from centrode.cli.arguments import dark_option, mechanism_argument, no_figures_option, results_option
from centrode.cli.progress import Progress
from centrode.locale import _, mark


@click.command(help=mark("Draw the mechanism in numbered positions of its cycle."))
@mechanism_argument
@click.option("--positions", type=int, metavar=mark("N"), help=mark("Number of positions, else 12."))
@click.option(
    "--link",
    metavar=mark("NAME"),
    help=mark("Link or guide whose velocity vanishes in position 0; a slider or rocker if left out."),
)
@dark_option
@results_option
@no_figures_option
def plan(
    mechanism: str, positions: int | None, link: str | None, dark: bool, out: Path | None, no_figures: bool
) -> None:
    """Find the extreme position, compute and draw; with the transmission angles where there are any."""
    description = ct.load(mechanism)
    folder = output.folder_of(out, mechanism, "plan")
    with output.output_folder(folder) as draft, Progress() as progress:
        progress.say(_("solving"))
        with about(mechanism):
            found = ct.plan_of_positions(description, 12 if positions is None else positions, link)
        ct.write_motion_csv(
            found.positions, draft / "positions.csv", description.display, description.moving_points
        )
        if not no_figures:
            progress.say(_("drawing"))
            figure = ct.plan_figure(description, found)
            ct.save_figures({"plan": ct.darkened(figure) if dark else figure}, draft)
        names = output.finished(draft)
    click.echo(_(description.title) or mechanism)
    click.echo()
    click.echo(render.aligned(ct.plan_rows(description, found)))
    click.echo("\n" + output.files_in(folder, names))
