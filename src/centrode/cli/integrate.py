"""`centrode integrate`: the motion by integration of its equations, beside the closed forms."""

from __future__ import annotations

import math
from pathlib import Path

import click

import centrode as ct
from centrode import render
from centrode.cli import output
from centrode.cli.about import about
from centrode.cli.arguments import mechanism_argument, no_figures_option, results_option, stop_option
from centrode.cli.progress import Progress
from centrode.cli.tables import tables_options
from centrode.errors import InputError, MotionError
from centrode.locale import _, mark


@click.command(help=mark("Integrate the differential equations of a mechanism."))
@mechanism_argument
@click.option(
    "--method",
    default="rk4",
    metavar="rk4|adaptive",
    help=mark("Fixed steps of Runge-Kutta's method of fourth order, or adaptive ones of eighth order."),
)
@click.option(
    "--steps", type=int, default=100, metavar=mark("N"), help=mark("Number of steps, and of rows less one.")
)
@click.option("--tolerance", type=float, metavar=mark("X"), help=mark("Tolerance of each adaptive step."))
@stop_option
@results_option
@tables_options
@no_figures_option
def integrate(
    mechanism: str,
    method: str,
    steps: int,
    tolerance: float | None,
    stop: str | None,
    out: Path | None,
    no_figures: bool,
) -> None:
    """Integrate and write; exit code 3 if the equations stop within the range (the rows before are written)."""
    description = ct.load(mechanism)
    folder = output.folder_of(out, mechanism, "integration")
    if tolerance is not None and method == "rk4":
        what = _("fixed steps have no tolerance")
        raise InputError("--tolerance", what, _("add --method adaptive, or ask for more --steps"))
    with output.output_folder(folder) as draft, Progress() as progress:
        progress.say(_("integrating"))
        last = None if stop is None else ct.range_value(description, stop, "--to")
        with about(mechanism):
            found = ct.integrate(
                description,
                method,
                steps,
                **({} if tolerance is None else {"tolerance": tolerance}),
                stop=last,
            )
        progress.say(_("writing tables"))
        ct.write_integration_csv(
            found, draft / "integration.csv", description.display, description.moving_points
        )
        ct.write_motion_netcdf(found, draft / "integration.nc")
        if not no_figures:
            progress.say(_("drawing"))
            drawn = ct.integration_figures(description, found, ct.closed_motion(description, found))
            ct.save_figures(drawn, draft)
        names = output.finished(draft)
    click.echo(_(description.title) or mechanism)
    click.echo()
    click.echo(render.aligned(ct.integration_rows(description, found)))
    click.echo("\n" + output.files_in(folder, names))
    stopped = ct.integration_failure(description, found)
    if stopped is not None:
        # steps that are too coarse are told with their repair
        ends = not math.isnan(found.attrs["stop_time"])
        repair = _("ask for a range that ends before it, or change the dimensions") if ends else ""
        raise MotionError(mechanism, stopped, repair)
