"""`centrode trains`: trains of gears of a ratio, with the chosen one as a mechanism that moves."""

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
from centrode.locale import _, mark

MECHANISM = "train.toml"
"""The chosen train as a mechanism."""


@click.command(help=mark("Find trains of gears of a ratio: teeth, efficiency, speeds."))
@click.argument(
    "train",
    metavar=mark("FILE_OR_EXAMPLE"),
    help=mark("A TOML file, or the name of a built-in train of gears."),
)
@click.option(
    "--drives",
    "machine",
    metavar=mark("FILE_OR_EXAMPLE"),
    help=mark("A mechanism that the train drives; train.toml is then the machine with its train."),
)
@written_option
@tables_options
@no_figures_option
@dark_option
def trains(train: str, machine: str | None, out: Path | None, no_figures: bool, dark: bool) -> None:
    """Print the trains of a ratio, and write them, their plans and a mechanism where a folder is named."""
    described = library.load_gear_train(train)
    with about(train), Progress() as progress:
        progress.say(_("solving"))
        result = library.gear_train(described)
        sheet = library.sheet_of(result)
        whole = library.train_mechanism(result, machine)
        names: list[str] = []
        if out is not None:
            with output.output_folder(out) as draft:
                write_sheet(sheet, draft, described.display, progress, figures=not no_figures, dark=dark)
                render.write_summary(sheet.scalars, draft / "summary.json")
                (draft / MECHANISM).write_text(library.mechanism_text(whole), encoding="utf-8")
                names = output.file_names(draft)
    click.echo(_(described.title) or train)
    click.echo()
    output.print_sheet(sheet, described.display)
    if out is not None:
        click.echo("\n" + output.files_in(out, names))
        click.echo(_("the chosen train moves with: centrode run {file}").format(file=out / MECHANISM))
