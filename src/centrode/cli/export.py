"""`centrode export`: a mechanism for another program."""

from __future__ import annotations

from pathlib import Path

import click

import centrode as ct
from centrode.cli import library, output
from centrode.cli.about import about
from centrode.cli.arguments import mechanism_argument
from centrode.locale import _, mark


@click.command(help=mark("Write a mechanism for another program."))
@mechanism_argument
@click.option(
    "--format",
    "kind",
    type=click.Choice(["mjcf"]),
    default="mjcf",
    help=mark("mjcf (default): a model for MuJoCo, its loops closed by constraints."),
)
@click.option(
    "--out",
    type=click.Path(path_type=Path),
    metavar=mark("FILE"),
    help=mark("Write FILE instead of printing."),
)
@click.option("--force", is_flag=True, help=mark("Replace FILE where it exists."))
def export(mechanism: str, kind: str, out: Path | None, force: bool) -> None:
    """Print or write the mechanism in its initial position as another program reads it."""
    description = library.load(mechanism)
    with about(mechanism):
        text = library.mjcf_text(description, ct.motion(description, at=[library.initial_place(description)]))
    if out is None:
        click.echo(text, nl=False)
        return
    output.write_file(out, text, force=force)
    click.echo(_("wrote {file}").format(file=out))
