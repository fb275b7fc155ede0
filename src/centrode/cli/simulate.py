"""`centrode simulate`: the motion of a machine under its loads and what drives it, and its steady regime."""

from __future__ import annotations

from math import tau
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

import centrode as ct
from centrode import render
from centrode.cli import output
from centrode.cli.about import about
from centrode.cli.arguments import mechanism_argument, no_figures_option, samples_option, written_option
from centrode.cli.expected import announce_size, announce_turns
from centrode.cli.progress import Progress
from centrode.cli.tables import tables_options
from centrode.errors import CentrodeError, InputError, MotionError
from centrode.locale import _, mark

if TYPE_CHECKING:
    import xarray


@click.command(help=mark("Let a machine run: loads, friction and a motor move it."))
@mechanism_argument
@click.option("--duration", metavar=mark("T"), help=mark('How long it runs: "20 s".'))
@click.option("--turns", type=float, metavar=mark("N"), help=mark("End after so many turns of the drive."))
@click.option(
    "--driving", metavar=mark("FORMULA"), help=mark('Moment of the drive in t, q and v: "20 - 2*v".')
)
@click.option("--speed", metavar=mark("V"), help=mark('Speed of the drive at the start: "65 rpm".'))
@click.option(
    "--scheme",
    type=click.Choice(["adaptive", "stiff", "runge-kutta-4"]),
    help=mark("How to integrate: adaptive (the rule), for stiff laws, or fixed steps."),
)
@click.option("--steps", type=int, metavar=mark("N"), help=mark("Number of fixed steps."))
@click.option("--motion", is_flag=True, help=mark("Write the motion of all points and links too."))
@written_option
@tables_options
@samples_option
@no_figures_option
def simulate(
    mechanism: str, out: Path | None, samples: int | None, motion: bool, no_figures: bool, **changes: Any
) -> None:
    """Print how it ran and its steady regime, and write it where asked; exit code 3 where it stops at a limit."""
    description = ct.load(mechanism)
    names: list[str] = []
    with about(mechanism):
        settings = _settings(description, changes | {"samples": samples})
        announce_size(description, settings.samples)
        announce_turns(_turns(description, settings))
        if out is None:
            with Progress() as progress:
                found = _simulated(description, settings, progress, motion=motion)
        else:
            with output.output_folder(out) as draft, Progress() as progress:
                found = _simulated(description, settings, progress, motion=motion)
                _write(description, found, draft, progress, motion=motion, figures=not no_figures)
                names = output.finished(draft)
    click.echo(_(description.title) or mechanism)
    click.echo()
    rows = [*ct.simulation_rows(description, found), *_regime(description, settings, found)]
    click.echo(render.aligned(rows))
    if out is not None:
        click.echo("\n" + output.files_in(out, names))
    _tell_ending(mechanism, found)


def _settings(description: ct.Mechanism, changes: dict[str, Any]) -> ct.Simulation:
    """The description's own settings with what the command line says in place of theirs."""
    own = description.simulation
    known = {} if own is None else {key: getattr(own, key) for key in own.model_fields_set}
    given = {key: value for key, value in changes.items() if value is not None}
    if "driving" in given:
        known.pop("motor", None)
    if "turns" in given and "duration" not in given:
        known.pop("duration", None)
    if "duration" in given and "turns" not in given:
        known.pop("turns", None)
    if not known and not given:
        raise InputError(
            "[simulation]", _("it is missing"), _('say --driving "20 - 2*v" and --duration "10 s"')
        )
    return ct.Simulation.for_parameter(description.motion_parameter, **known | given)


def _turns(description: ct.Mechanism, settings: ct.Simulation) -> float:
    """Turns of the drive at the speed of the start, up to where they end."""
    if not description.motion_parameter.turns:
        return 0.0
    ends = [settings.turns] if settings.turns is not None else []
    if settings.duration is not None:
        ends.append(abs(settings.speed) * settings.duration / tau)
    return min(ends, default=0.0)


def _simulated(
    description: ct.Mechanism, settings: ct.Simulation, progress: Progress, *, motion: bool
) -> xarray.Dataset:
    def tell(share: float) -> None:
        progress.say(_("integrating, %"), round(100 * share), 100)

    return ct.simulate(description, settings, motion=motion, progress=tell)


def _write(
    description: ct.Mechanism,
    found: xarray.Dataset,
    folder: Path,
    progress: Progress,
    *,
    motion: bool,
    figures: bool,
) -> None:
    progress.say(_("writing tables"))
    points = description.moving_points if motion else None
    ct.write_motion_csv(found, folder / "simulation.csv", description.display, points)
    ct.write_motion_netcdf(found, folder / "simulation.nc")
    if figures:
        progress.say(_("drawing"))
        ct.save_figures(ct.simulation_figures(description, found), folder)


def _regime(
    description: ct.Mechanism, settings: ct.Simulation, found: xarray.Dataset
) -> list[tuple[str, str]]:
    """Rows of the steady regime, of a drive that has turned all the way round."""
    if not description.motion_parameter.turns or found.attrs["ended"] not in ("duration", "turns"):
        return []
    if not float(found["turned"].to_numpy().max()) >= tau:
        return []
    try:
        return ct.regime_rows(description, ct.steady_regime(description, settings))
    except CentrodeError as failure:
        return [(_("steady regime"), _("none is found: {reason}").format(reason=failure.what))]


def _tell_ending(mechanism: str, found: xarray.Dataset) -> None:
    """Raise where it did not run as long as it was asked to."""
    ended = found.attrs["ended"]
    if ended == "interrupted":
        raise KeyboardInterrupt
    if ended == "limit":
        what = _("it stops at a limit after {time:.6g} s").format(time=float(found["time"].to_numpy()[-1]))
        raise MotionError(mechanism, what, _("ask for a shorter time, or change drive or dimensions"))
    if ended == "change point":
        what = _(
            "its path ends at the change point at {value:.9g} {unit}, after {time:.6g} s: "
            "the assembly is kept, and from there on it would be another motion"
        ).format(
            value=float(found["occasion_value"].to_numpy()[-1]),
            unit=found["occasion_value"].attrs["units"],
            time=float(found["occasion_time"].to_numpy()[-1]),
        )
        raise MotionError(
            mechanism,
            what,
            _('choose continuation = "smooth" in [assembly], which runs on, or a shorter time'),
        )
