"""`centrode reactions`: forces in every joint and what the drives must give."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Literal

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
from centrode.errors import InputError, MotionError, Status
from centrode.locale import _, mark, ngettext

if TYPE_CHECKING:
    import xarray

MISSING = (Status.OPEN, Status.CUT_OFF, Status.UNCONVERGED)
MOST_INSTANTS = 100


@click.command(help=mark("Find the forces in every joint and what the drives must give."))
@mechanism_argument
@click.option(
    "--at",
    "instants",
    multiple=True,
    metavar=mark("VALUE"),
    help=mark('Only at this value of the drive ("120 deg"), or time ("1 s"); as often as needed.'),
)
@click.option(
    "--steady",
    is_flag=True,
    help=mark("At the real speed of a machine in steady motion, not at its mean speed."),
)
@click.option("--frictionless", is_flag=True, help=mark("Leave out friction that is given by coefficients."))
@written_option
@tables_options
@samples_option
@start_option
@stop_option
@range_option
@no_figures_option
def reactions(
    mechanism: str,
    instants: tuple[str, ...],
    steady: bool,
    frictionless: bool,
    out: Path | None,
    samples: int | None,
    start: str | None,
    stop: str | None,
    ranged: str | None,
    no_figures: bool,
) -> None:
    """Print extremes or instants, write tables where asked; exit code 3 if samples are not reached."""
    description = ct.load(mechanism)
    announce_size(description, samples)
    description = ct.with_range(description, ranged)
    _check(instants, samples, start, stop)
    places = [ct.range_value(description, text, "--at") for text in instants] or None
    first = None if start is None else ct.range_value(description, start, "--from")
    last = None if stop is None else ct.range_value(description, stop, "--to")
    names: list[str] = []

    def solved() -> xarray.Dataset:
        speed: Literal["mean", "steady"] = "steady" if steady else "mean"
        return ct.reactions(description, samples, first, last, places, speed=speed, friction=not frictionless)

    with about(mechanism):
        if out is None:
            found = solved()
        else:
            with output.output_folder(out) as draft, Progress() as progress:
                progress.say(_("solving"))
                found = solved()
                write(description, found, draft, progress, figures=not no_figures, over_range=not instants)
                names = output.finished(draft)
    click.echo(_(description.title) or mechanism)
    click.echo("\n" + report(description, found, instants))
    if out is not None:
        click.echo("\n" + output.files_in(out, names))
    repair = _("ask for places between the limits") if instants else ct.repair_of_range(description)
    _tell_failure(mechanism, description, found, repair)


def _check(instants: tuple[str, ...], samples: int | None, start: str | None, stop: str | None) -> None:
    """Refuse instants beside a range, and too many of them to print."""
    if len(instants) > MOST_INSTANTS:
        raise InputError(
            "--at",
            _("{count} instants were asked for").format(count=len(instants)),
            _("ask for at most {most}").format(most=MOST_INSTANTS),
        )
    given = {"--samples": samples, "--from": start, "--to": stop}
    beside = next((name for name, value in given.items() if instants and value is not None), None)
    if beside is not None:
        raise InputError(beside, _("instants are asked for with --at"), _("take one of the two out"))


def write(
    mechanism: ct.Mechanism,
    found: xarray.Dataset,
    folder: Path,
    progress: Progress,
    *,
    figures: bool,
    loads: tuple[ct.BearingLoad, ...] | None = None,
    over_range: bool = True,
) -> None:
    """Write reactions and the table of joints into a folder; over a range worst cases, and figures where asked."""
    progress.say(_("writing tables"))
    ct.write_reactions_csv(found, folder / "reactions.csv", mechanism.display)
    ct.write_motion_netcdf(found, folder / "reactions.nc")
    ct.write_joint_table_csv(ct.joint_table(mechanism), folder / "joints.csv")
    if not over_range:
        return
    loads = ct.bearing_loads(mechanism, found) if loads is None else loads
    ct.write_bearing_loads_csv(mechanism, loads, folder / "bearing-loads.csv")
    drawn = {}
    if figures:
        progress.say(_("drawing"))
        drawn = ct.reaction_figures(mechanism, found)
    if mechanism.space == "plane":
        motion = ct.motion_beside(mechanism, found)
        bearings = ct.bearings(mechanism, found, motion)
        ct.write_motion_netcdf(bearings, folder / "bearings.nc")
        drawn |= ct.bearing_figures(mechanism, found, bearings, motion) if figures else {}
    for number, (name, figure) in enumerate(drawn.items(), start=1):
        progress.say(_("drawing {name}").format(name=name), number, len(drawn))
        ct.save_figures({name: figure}, folder)


def report(mechanism: ct.Mechanism, found: xarray.Dataset, instants: tuple[str, ...]) -> str:
    """What is printed: what acts, the table of joints, and extremes or instants."""
    header, joints = ct.joint_table(mechanism)
    texts = [
        render.aligned(ct.reaction_rows(mechanism, found)),
        render.aligned(joints, header, right=range(1, len(header))),
    ]
    if not instants:
        header, rows = ct.reaction_extremes(mechanism, found)
        texts.append(render.aligned(rows, header, right=(2, 4)))
        losses = ct.friction_losses(found)
        if losses is not None:
            texts.append(render.aligned(losses[1], losses[0], right=(1, 2, 3)))
    for number, text in enumerate(instants):
        header, rows = ct.reactions_at_instant(mechanism, found, number)
        heading = _("at {value}").format(value=text)
        texts.append(heading + "\n" + render.aligned(rows, header, right=(2, 3, 4, 5)))
    return "\n\n".join(texts)


def _tell_failure(name: str, description: ct.Mechanism, found: xarray.Dataset, repair: str) -> None:
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
        raise MotionError(name, f"{what} ({where})" if where else what, repair)
    locked = int((found["reaction_status"] == Status.SELF_LOCKING).sum())
    if locked:
        what = ngettext(
            "self-locking: at {n} sample no drive overcomes the friction",
            "self-locking: at {n} samples no drive overcomes the friction",
            locked,
        ).format(n=locked)
        raise MotionError(name, what, _("make the coefficients or radii less, or the sliders longer"))
