"""`centrode centrodes`: the centrodes of a link as tables, a picture and an animation; curvature at places."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

import centrode as ct
from centrode import render
from centrode.cli import output
from centrode.cli.about import about
from centrode.cli.arguments import (
    dark_option,
    mechanism_argument,
    no_figures_option,
    range_option,
    results_option,
    samples_option,
    start_option,
    stop_option,
)
from centrode.cli.expected import announce_size
from centrode.cli.progress import Progress
from centrode.cli.reached import is_moving, tell_absent, tell_no_centre
from centrode.cli.tables import tables_options
from centrode.locale import _, mark

if TYPE_CHECKING:
    import xarray


@click.command(help=mark("Compute the centrodes of a link and draw them."))
@mechanism_argument
@click.option(
    "--link", required=True, metavar=mark("LINK"), help=mark("The link that carries the moving centrode.")
)
@click.option(
    "--against",
    default="frame",
    metavar=mark("LINK"),
    help=mark("The link that it rolls on; the frame if left out."),
)
@samples_option
@start_option
@stop_option
@range_option
@click.option(
    "--at",
    "places",
    multiple=True,
    metavar=mark("VALUE"),
    help=mark("Also the curvature of the paths of the link's points there; as often as needed."),
)
@results_option
@tables_options
@click.option(
    "--animate", is_flag=True, help=mark("Also write an animation: one centrode rolls on the other.")
)
@no_figures_option
@dark_option
def centrodes(
    mechanism: str,
    link: str,
    against: str,
    samples: int | None,
    start: str | None,
    stop: str | None,
    ranged: str | None,
    places: tuple[str, ...],
    out: Path | None,
    animate: bool,
    no_figures: bool,
    dark: bool,
) -> None:
    """Compute and write both curves, and the curvature where asked."""
    description = ct.load(mechanism)
    announce_size(description, samples)
    description = ct.with_range(description, ranged)
    folder = output.folder_of(out, mechanism, "centrodes")
    with output.output_folder(folder) as draft, Progress() as progress:
        progress.say(_("solving"))
        with about(mechanism):
            first = None if start is None else ct.range_value(description, start, "--from")
            last = None if stop is None else ct.range_value(description, stop, "--to")
            at = [ct.range_value(description, text, "--at") for text in places]
            motion = ct.motion(description, samples, first, last)
            found = ct.centrodes(motion, link, against)
            bent = ct.curvature(description, link, at, against) if at else None
            looked = ct.motion(description, at=at) if at else None
        progress.say(_("writing tables"))
        ct.write_centrodes_csv(description, found, draft / "centrodes.csv")
        ct.write_motion_netcdf(found, draft / "centrodes.nc")
        if bent is not None:
            ct.write_motion_netcdf(bent, draft / "curvature.nc")
        if not no_figures:
            progress.say(_("drawing"))
            _draw(description, motion, found, draft, dark)
            if bent is not None and looked is not None:
                _draw_curvature(description, looked, bent, draft, dark)
        if animate:
            progress.say(_("drawing {name}").format(name="centrodes.gif"))
            with about(mechanism):
                ct.animate_centrodes(description, motion, found, draft / "centrodes.gif", dark)
        names = output.finished(draft)
    click.echo(_(description.title) or mechanism)
    click.echo(f"\n{render.aligned(ct.centrode_rows(description, found))}")
    for sample in range(len(at)):
        assert bent is not None
        click.echo(f"\n{render.aligned(ct.curvature_rows(description, bent, sample))}")
    click.echo("\n" + output.files_in(folder, names))
    if looked is not None:
        tell_absent(mechanism, looked)
    if not (found["centrode_piece"] >= 0).any():
        tell_no_centre(mechanism, link, against)


def _draw(
    description: ct.Mechanism, motion: xarray.Dataset, found: xarray.Dataset, folder: Path, dark: bool
) -> None:
    figure = ct.centrodes_figure(description, motion, found)
    ct.save_figures({"centrodes": ct.darkened(figure) if dark else figure}, folder)


def _draw_curvature(
    description: ct.Mechanism, motion: xarray.Dataset, bent: xarray.Dataset, folder: Path, dark: bool
) -> None:
    """One picture for each place; numbered where there are several."""
    count = motion.sizes["sample"]
    for sample in range(count):
        if not is_moving(motion, sample):
            continue
        figure = ct.curvature_figure(description, motion, bent, sample)
        name = "curvature" if count == 1 else f"curvature-{sample + 1}"
        ct.save_figures({name: ct.darkened(figure) if dark else figure}, folder)
