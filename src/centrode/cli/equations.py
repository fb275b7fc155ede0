"""`centrode equations`: constraint equations in symbols, differentiated and solved."""

from __future__ import annotations

from pathlib import Path

import click

import centrode as ct
from centrode.cli import output
from centrode.cli.about import about
from centrode.cli.arguments import mechanism_argument
from centrode.errors import InputError
from centrode.locale import _, mark

KINDS = {".txt": "equations_text", ".tex": "equations_latex", ".md": "equations_markdown"}


@click.command(help=mark("Write the constraint equations in symbols, solved."))
@mechanism_argument
@click.option(
    "--point",
    "points",
    multiple=True,
    metavar=mark("NAME"),
    help=mark(
        "A point whose velocity is asked for, again for more; those on guides of the frame if left out."
    ),
)
@click.option(
    "--out",
    type=click.Path(path_type=Path),
    metavar=mark("FILE"),
    help=mark("Write FILE.txt, FILE.tex (LaTeX) or FILE.md (Markdown) instead of printing."),
)
@click.option("--force", is_flag=True, help=mark("Replace FILE where it exists."))
def equations(mechanism: str, points: tuple[str, ...], out: Path | None, force: bool) -> None:
    """Print the equations of a mechanism, or write them as a document in the reader's language."""
    description = ct.load(mechanism)
    kind = _kind(out)
    with about(mechanism):
        text: str = getattr(ct, kind)(ct.equations(description), points or None)
    if out is None:
        click.echo(text, nl=False)
        return
    output.write_file(out, text, force=force)
    click.echo(_("wrote {file}").format(file=out))


def _kind(out: Path | None) -> str:
    """Which presentation an ending asks for."""
    if out is None:
        return KINDS[".txt"]
    if out.suffix.lower() not in KINDS:
        raise InputError(
            "--out",
            _("{ending} is no kind of file for equations").format(ending=f'"{out.suffix}"'),
            _("use one of {known}").format(known=", ".join(KINDS)),
        )
    return KINDS[out.suffix.lower()]
