"""`centrode rotatability`: whether a mechanism turns fully, what stops it, and the change after which it does."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

import centrode as ct
from centrode import render
from centrode.cli import output
from centrode.cli.about import about
from centrode.cli.arguments import mechanism_argument
from centrode.cli.pairs import ranges
from centrode.cli.progress import Progress
from centrode.errors import InputError, MotionError
from centrode.locale import _, mark, speaking

if TYPE_CHECKING:
    from centrode.analysis.redesign.repair import Repair

REPORT, DESCRIPTION = ".json", ".toml"


@click.command(help=mark("Tell whether a mechanism turns fully, and repair it."))
@mechanism_argument
@click.option("--repair", is_flag=True, help=mark("Seek the smallest change after which it turns fully."))
@click.option(
    "--vary",
    multiple=True,
    metavar=mark("PATH[=LOW:HIGH]"),
    help=mark('A number that may change ("links.CB.angle=200 deg:300 deg"); as often as needed.'),
)
@click.option(
    "--least-transmission-angle",
    "least_angle",
    metavar=mark("ANGLE"),
    help=mark("What every dyad keeps over the turn; 1 deg if left out."),
)
@click.option(
    "--out",
    type=click.Path(path_type=Path),
    metavar=mark("FILE"),
    help=mark("Also write FILE.json, what was found, or FILE.toml, the repaired mechanism."),
)
@click.option("--force", is_flag=True, help=mark("Replace FILE where it exists."))
def rotatability(
    mechanism: str,
    repair: bool,
    vary: tuple[str, ...],
    least_angle: str | None,
    out: Path | None,
    force: bool,
) -> None:
    """Print what is found, and write it where asked; exit code 3 if no repair was found."""
    description = ct.load(mechanism)
    _check_options(repair, vary, least_angle, out)
    if not repair:
        _analyse(mechanism, description, out, force)
        return
    paths, bounds = _varied(vary)
    with Progress() as progress, about(mechanism):
        found = ct.repair(
            description,
            paths or None,
            bounds,
            least_angle,
            progress=lambda done, of: progress.say(_("seeking a repair"), done, of),
        )
    _heading(description, mechanism)
    click.echo(render.aligned(ct.repair_rows(description, found)))
    if out is not None:
        _write_repair(description, found, out, force)
    if not found.found:
        raise MotionError(
            mechanism, _("no change was found after which it turns so"), _("widen the bounds, or vary more")
        )


def _analyse(name: str, description: ct.Mechanism, out: Path | None, force: bool) -> None:
    with about(name):
        found = ct.rotatability(description)
    _heading(description, name)
    click.echo(render.aligned(ct.rotatability_rows(description, found)))
    if out is not None:
        with speaking("en"):  # what files hold is English
            text = ct.rotatability_text(ct.rotatability(description))
        output.write_file(out, text, force=force)
        click.echo("\n" + _("wrote {file}").format(file=out))


def _heading(description: ct.Mechanism, name: str) -> None:
    click.echo(_(description.title) or name)
    click.echo()


def _check_options(repair: bool, vary: Sequence[str], least_angle: str | None, out: Path | None) -> None:
    """Refuse what belongs to a repair without one, and files that are neither report nor description."""
    for option, given in (("--vary", bool(vary)), ("--least-transmission-angle", least_angle is not None)):
        if given and not repair:
            raise InputError(option, _("it belongs to a repair"), _("add --repair"))
    known = (REPORT, DESCRIPTION) if repair else (REPORT,)
    if out is not None and out.suffix.lower() not in known:
        raise InputError(
            "--out",
            _("{kind} is not a kind of file for this").format(kind=f'"{out.suffix}"'),
            _("use one of {known}").format(known=", ".join(known)),
        )


def _varied(texts: Sequence[str]) -> tuple[list[str], dict[str, tuple[str, str]]]:
    """Paths, and bounds of those that have them."""
    bounds = ranges([text for text in texts if "=" in text], "--vary")
    paths = [text.partition("=")[0].strip() for text in texts]
    twice = next((path for k, path in enumerate(paths) if path in paths[:k]), None)
    if twice is not None:
        raise InputError("--vary", _("{name} is given twice").format(name=twice), _("keep one of them"))
    return paths, bounds


def _write_repair(description: ct.Mechanism, found: Repair, out: Path, force: bool) -> None:
    """The report, or the description of the repaired mechanism, which there is only if one was found."""
    if out.suffix.lower() == REPORT:
        output.write_file(out, ct.repair_text(description, found), force=force)
    elif found.mechanism is not None:
        output.write_file(out, ct.mechanism_text(found.mechanism), force=force)
    else:
        return
    click.echo("\n" + _("wrote {file}").format(file=out))
