"""`centrode limits`: between which values one drive can move while the others are held."""

from __future__ import annotations

from pathlib import Path

import click

import centrode as ct
from centrode import render
from centrode.cli import output
from centrode.cli.about import about as about_file
from centrode.cli.arguments import mechanism_argument
from centrode.cli.pairs import pairs
from centrode.cli.tables import need_table, table_files, tables_options
from centrode.locale import _, mark, speaking


@click.command(help=mark("Find the limits of one drive while the others are held."))
@mechanism_argument
@click.option(
    "--drive", metavar=mark("NAME"), help=mark("The drive that moves; needed where there are several.")
)
@click.option(
    "--hold",
    multiple=True,
    metavar=mark("NAME=VALUE"),
    help=mark('Value of another drive ("EC=30 deg"); its initial one if left out.'),
)
@click.option(
    "--about", metavar=mark("VALUE"), help=mark("Value from which it moves; its initial one if left out.")
)
@click.option(
    "--out",
    type=click.Path(path_type=Path),
    metavar=mark("FILE"),
    help=mark("Also write FILE.json or FILE.csv, by the ending of its name."),
)
@tables_options
@click.option("--force", is_flag=True, help=mark("Replace FILE where it exists."))
def limits(
    mechanism: str,
    drive: str | None,
    hold: tuple[str, ...],
    about: str | None,
    out: Path | None,
    force: bool,
) -> None:
    """Print the limits of a drive, and write them where asked."""
    description = ct.load(mechanism)
    held = pairs(hold, "--hold")
    need_table(out)
    with about_file(mechanism):
        found = ct.limits(description, drive, held, about)
    if out is not None:
        with speaking("en"):  # what files hold is English
            text = ct.limits_text(ct.limits(description, drive, held, about), out.suffix[1:].lower())
        with output.output_table(out, force=force) as draft:
            draft.write_text(text, encoding="utf-8", newline="\n")
    click.echo(_(description.title) or mechanism)
    click.echo()
    click.echo(render.aligned(ct.limits_rows(description, found)))
    if out is not None:
        click.echo("\n" + output.wrote(table_files(out)))
