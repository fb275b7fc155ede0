"""`centrode page`: a mechanism as one file on which a reader changes it."""

from __future__ import annotations

from pathlib import Path

import click

from centrode.cli import library, output
from centrode.cli.about import about
from centrode.cli.arguments import mechanism_argument, samples_option
from centrode.cli.option_values import ranges
from centrode.errors import InputError
from centrode.locale import LANGUAGES, _, mark


@click.command(help=mark("Write a mechanism as a page to change dimensions on."))
@mechanism_argument
@click.option(
    "--out",
    type=click.Path(path_type=Path),
    metavar=mark("FILE"),
    help=mark("The page, FILE.html; named after the mechanism by default."),
)
@click.option(
    "--vary",
    multiple=True,
    metavar=mark("PATH=FIRST:LAST"),
    help=mark(
        'A number that the reader changes, and its range ("links.AB.length=3 m:4 m"); may be repeated. By default all '
        "lengths and the places of joints."
    ),
)
@click.option(
    "--language",
    type=click.Choice(LANGUAGES),
    help=mark("Language of the page; that of the messages by default."),
)
@samples_option
@click.option("--force", is_flag=True, help=mark("Replace FILE where it exists."))
def page(
    mechanism: str,
    out: Path | None,
    vary: tuple[str, ...],
    language: str | None,
    samples: int | None,
    force: bool,
) -> None:
    """Write the page; exit code 2 where a group has no closed form, with its name."""
    path = out if out is not None else Path(f"{Path(mechanism).stem}.html")
    if path.suffix.lower() not in (".html", ".htm"):
        raise InputError("--out", _("a page is a .html"), _("name such a file"))
    description = library.load(mechanism)
    varied = ranges(vary, "--vary", "links.AB.length=3 m:4 m") if vary else None
    with about(mechanism):
        text = library.mechanism_page(
            description, varied, language=language, samples=samples, source=mechanism
        )
    output.write_file(path, text, force=force)
    click.echo(_("wrote {file}").format(file=path))
