"""`centrode import`: a description from a drawing of another program."""

from __future__ import annotations

from pathlib import Path

import click

from centrode.cli import library, output
from centrode.errors import InputError
from centrode.locale import _, mark

LINKS = ("http://", "https://")


@click.command("import", help=mark("Read a drawing as a mechanism: DXF, SVG, Linkage, PMKS+."))
@click.argument(
    "drawing",
    metavar=mark("FILE"),
    help=mark("A file .dxf, .svg or .linkage2, or a link of PMKS+."),
)
@click.option(
    "--scale",
    type=float,
    default=1.0,
    metavar=mark("NUMBER"),
    help=mark("Lengths of the mechanism by those of the drawing: 5 for a drawing 1:5."),
)
@click.option(
    "--join",
    metavar=mark("LENGTH"),
    help=mark("How far apart ends that meet may be in the drawing; 0.2 % of its size by default."),
)
@click.option("--drive", metavar=mark("LINK"), help=mark("The driving link, by the name that it gets."))
@click.option(
    "--out",
    type=click.Path(path_type=Path),
    metavar=mark("FILE"),
    help=mark("Write FILE instead of printing."),
)
@click.option("--force", is_flag=True, help=mark("Replace FILE where it exists."))
def import_drawing(
    drawing: str, scale: float, join: str | None, drive: str | None, out: Path | None, force: bool
) -> None:
    """Print or write a description; what was guessed and left out is told, and stands at its head."""
    guesses: tuple[str, ...] = ()
    omitted: tuple[str, ...] = ()
    if drawing.startswith(LINKS):
        if scale != 1.0 or join is not None or drive is not None:
            raise InputError("PMKS+", _("--scale, --join and --drive belong to drawings"), _("remove them"))
        text = library.mechanism_text(library.from_pmks(drawing))
    else:
        gap = None if join is None else library.read_quantity(join, "length", "--join")
        read = library.import_sketch(drawing, scale=scale, join=gap, drive=drive)
        text, guesses, omitted = read.text, read.guesses, read.omitted
    if out is None:
        click.echo(text, nl=False)
    else:
        with output.output_file(out, force=force) as draft:
            draft.write_text(text, encoding="utf-8", newline="\n")
        click.echo(output.wrote([out]))
    for one in guesses:
        output.tell(_("guessed: {what}").format(what=one))
    for one in omitted:
        output.tell(_("not read: {what}").format(what=one))
