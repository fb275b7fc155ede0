"""`centrode synthesise`: mechanisms for a path, a function, poses or strokes, as descriptions that run."""

from __future__ import annotations

import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType

import click

from centrode import render
from centrode.cli import library, output
from centrode.cli.about import about
from centrode.cli.arguments import dark_option, no_figures_option, written_option
from centrode.cli.progress import Progress
from centrode.cli.tables import tables_options
from centrode.cli.topic_command import write_sheet
from centrode.locale import _, mark


@contextmanager
def _interruption() -> Iterator[Callable[[], bool]]:
    """Whether somebody has interrupted: the search then ends with what there is; the second time everything ends."""
    asked = [False]

    def remember(number: int, frame: FrameType | None) -> None:
        if asked[0]:
            raise KeyboardInterrupt
        asked[0] = True

    before = signal.signal(signal.SIGINT, remember)
    try:
        yield lambda: asked[0]
    finally:
        signal.signal(signal.SIGINT, before)


@click.command(help=mark("Find mechanisms for a path, a function, poses or strokes."))
@click.argument(
    "wanted", metavar=mark("FILE"), help=mark("A TOML file with what is wanted below [synthesis].")
)
@written_option
@click.option(
    "--jobs",
    type=int,
    default=1,
    metavar=mark("N"),
    help=mark("Number of parallel processes."),
)
@tables_options
@no_figures_option
@dark_option
def synthesise(wanted: str, out: Path | None, jobs: int, no_figures: bool, dark: bool) -> None:
    """Print the answers, and write them with their pictures where a folder is named."""
    task = library.read_synthesis(wanted)

    with Progress() as progress, _interruption() as stopped:

        def say(share: float) -> None:
            progress.say(_("searching"), round(100 * share), 100)

        names: list[str] = []
        if out is None:
            with about(wanted):
                sheet = library.sheet_of(library.synthesise(task, say, stopped, jobs))
        else:
            with output.output_folder(out) as draft:
                with about(wanted):
                    sheet = library.sheet_of(library.synthesise(task, say, stopped, jobs))
                write_sheet(sheet, draft, task.display, progress, figures=not no_figures, dark=dark)
                render.write_summary(sheet.scalars, draft / "summary.json")
                names = output.file_names(draft)
    click.echo(_(task.title) or wanted)
    click.echo()
    output.print_sheet(sheet, task.display)
    if out is not None:
        click.echo("\n" + output.files_in(out, names))
