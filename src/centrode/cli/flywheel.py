"""`centrode flywheel`: energies of a machine over its cycle, the flywheel it needs, its real motion."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, cast

import click

import centrode as ct
from centrode.cli import output
from centrode.cli.about import about
from centrode.cli.arguments import mechanism_argument, no_figures_option, samples_option
from centrode.cli.expected import announce_size
from centrode.cli.progress import Progress
from centrode.cli.tables import tables_options
from centrode.locale import _, mark

if TYPE_CHECKING:
    from centrode.dynamics.steady_motion.balance import Mean
    from centrode.dynamics.steady_motion.steady import Method
    from centrode.model.mechanism import Mechanism
    from centrode.study.forces.machines import MachineResults


@click.command(help=mark("Find the flywheel of a machine, and its real motion."))
@mechanism_argument
@click.option(
    "--mean",
    type=click.Choice(["middle", "time"]),
    default="middle",
    help=mark("Mean speed: half of greatest and least (the rule), or turns over time."),
)
@click.option(
    "--method",
    type=click.Choice(["exact", "first-order"]),
    default="exact",
    help=mark("Real velocities by the energy equation (the rule), or by the first-order formula."),
)
@click.option(
    "--out",
    type=click.Path(path_type=Path),
    metavar=mark("DIR"),
    help=mark("Also write tables, pictures and numbers into this folder."),
)
@samples_option
@no_figures_option
@tables_options
def flywheel(
    mechanism: str, mean: str, method: str, out: Path | None, samples: int | None, no_figures: bool
) -> None:
    """Print energies, inertia and sizes; write the steady motion where asked."""
    description = ct.load(mechanism)
    announce_size(description, samples)
    kind, way = cast("Mean", mean), cast("Method", method)
    names: list[str] = []
    with about(mechanism):
        if out is None:
            found = ct.flywheel(description, kind)
        else:
            found, names = _written(description, kind, way, out, samples, figures=not no_figures)
    click.echo(_(description.title) or mechanism)
    click.echo()
    click.echo(output.table(ct.flywheel_rows(description, found)))
    if out is not None:
        click.echo("\n" + output.files_in(out, names))


def _written(
    mechanism: Mechanism, mean: Mean, method: Method, out: Path, samples: int | None, *, figures: bool
) -> tuple[ct.Flywheel, list[str]]:
    """Compute and write into a folder; also returns the names of the files."""
    with output.output_folder(out) as draft, Progress() as progress:
        progress.say(_("solving"))
        ct.flywheel(mechanism, mean)  # a fluctuation is needed here
        results = ct.machine_results(mechanism, samples, mean, method)
        write(mechanism, results, draft, progress, figures=figures)
        scalars = {name: one.as_dict() for name, one in ct.flywheel_scalars(results.flywheel).items()}
        text = json.dumps(scalars, indent=2, allow_nan=False) + "\n"
        (draft / "summary.json").write_text(text, encoding="utf-8")
        names = output.finished(draft)
    return results.flywheel, names


def write(
    mechanism: Mechanism, results: MachineResults, folder: Path, progress: Progress, *, figures: bool
) -> None:
    """Write the steady motion of a machine into a folder: tables, and figures where asked."""
    progress.say(_("writing tables"))
    points = mechanism.moving_points
    ct.write_motion_csv(results.steady, folder / "machine.csv", mechanism.display, points)
    ct.write_motion_netcdf(results.steady, folder / "machine.nc")
    if results.instants is not None:
        ct.write_motion_csv(results.instants, folder / "machine-instants.csv", mechanism.display, points)
    if figures:
        progress.say(_("drawing"))
        drawn = ct.machine_figures(mechanism, results.steady)
        for number, (name, figure) in enumerate(drawn.items(), start=1):
            progress.say(_("drawing {name}").format(name=name), number, len(drawn))
            ct.save_figures({name: figure}, folder)
