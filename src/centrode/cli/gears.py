"""`centrode gears`: geometry of a pair of gear wheels, with tables, drawings and true teeth."""

from __future__ import annotations

from pathlib import Path

import click

from centrode import render
from centrode.cli import library, output
from centrode.cli.about import about
from centrode.cli.arguments import dark_option, no_figures_option, written_option
from centrode.cli.progress import Progress
from centrode.cli.tables import tables_options
from centrode.cli.topic_command import write_sheet
from centrode.errors import InputError, MotionError
from centrode.locale import _, mark
from centrode.optional_packages import how_to_install


@click.command(help=mark("Compute a pair of gears: dimensions, sliding, true teeth."))
@click.argument(
    "pair",
    metavar=mark("FILE_OR_EXAMPLE"),
    help=mark("A TOML file, or the name of a built-in pair of gears."),
)
@click.option(
    "--animate", is_flag=True, help=mark("Also animate the mesh and the generation by the rack, as GIFs.")
)
@written_option
@tables_options
@no_figures_option
@dark_option
def gears(pair: str, animate: bool, out: Path | None, no_figures: bool, dark: bool) -> None:
    """Print what is known of a pair, and write it where a folder is named."""
    described = library.load_gear_pair(pair)
    if animate and out is None:
        raise InputError("--animate", _("no output folder is given"), _("name one with --out"))
    with about(pair), Progress() as progress:
        progress.say(_("solving"))
        result = library.gear_pair(described)
        sheet = library.sheet_of(result)
        names: list[str] = []
        if out is not None:
            with output.output_folder(out) as draft:
                write_sheet(sheet, draft, described.display, progress, figures=not no_figures, dark=dark)
                render.write_summary(sheet.scalars, draft / "summary.json")
                if animate:
                    progress.say(_("drawing {name}").format(name="mesh.gif"))
                    library.animate_gears(result, draft, dark=dark)
                names = output.file_names(draft)
    click.echo(_(described.title) or pair)
    click.echo()
    output.print_sheet(sheet, described.display)
    if out is not None:
        click.echo("\n" + output.files_in(out, names))
        if not render.writes_dxf():
            click.echo(_("no DXF: it needs ezdxf; {repair}").format(repair=how_to_install("drawings")))
    if sheet.failure is not None:
        what, repair = (
            render.plain_text(text, described.display) for text in (sheet.failure.what, sheet.failure.repair)
        )
        raise MotionError(pair, what, repair)
