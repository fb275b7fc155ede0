"""Commands of the topics of the registry: print the facts of a sheet, write its tables, figures and numbers."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

import click

import centrode as ct
from centrode import render
from centrode.cli import output
from centrode.cli.about import about
from centrode.cli.arguments import mechanism_argument, no_figures_option, samples_option
from centrode.cli.expected import announce_size
from centrode.cli.progress import Progress
from centrode.cli.tables import asked_spelling, tables_options
from centrode.locale import _, mark

if TYPE_CHECKING:
    from centrode.model.mechanism import Display, Mechanism
    from centrode.sheets.sheet import Sheet
    from centrode.topics.topic import Topic

OUT_OPTION = click.option(
    "--out",
    type=click.Path(path_type=Path),
    metavar=mark("DIR"),
    help=mark("Also write tables, pictures and numbers into this folder."),
)


def topic_command(topic: Topic) -> click.Command:
    """The command of a topic: `centrode TOPIC MECHANISM [options] [--out DIR]`."""

    @mechanism_argument
    @OUT_OPTION
    @samples_option
    @no_figures_option
    @tables_options
    def command(
        mechanism: str, out: Path | None, samples: int | None, no_figures: bool, **options: Any
    ) -> None:
        description = ct.load(mechanism)
        announce_size(description, samples)
        names: list[str] = []
        if out is None:
            with about(mechanism):
                sheet = _sheet(topic, description, samples, options)
        else:
            with about(mechanism), output.output_folder(out) as draft, Progress() as progress:
                progress.say(_("solving"))
                sheet = _sheet(topic, description, samples, options)
                write_sheet(sheet, draft, description.display, progress, figures=not no_figures)
                render.write_summary(sheet.scalars, draft / "summary.json")
                names = output.finished(draft)
        click.echo(_(description.title) or mechanism)
        click.echo()
        click.echo(render.facts_text(sheet.facts, description.display))
        if out is not None:
            click.echo("\n" + output.files_in(out, names))

    made = click.command(topic.name, help=topic.help)(command)
    choices: list[click.Parameter] = [
        click.Option(
            [f"--{choice.name}"], type=click.Choice(choice.words), default=choice.words[0], help=choice.help
        )
        for choice in topic.options
    ]
    made.params[1:1] = choices
    return made


def _sheet(topic: Topic, mechanism: Mechanism, samples: int | None, options: Mapping[str, Any]) -> Sheet:
    if topic.needs is not None:
        topic.needs(mechanism)
    return cast("Sheet", topic.view(topic.compute(mechanism, samples, **options)))


def write_sheet(sheet: Sheet, folder: Path, display: Display, progress: Progress, *, figures: bool) -> None:
    """Write a sheet into a folder: tables and datasets, and its pictures where wanted."""
    progress.say(_("writing tables"))
    render.write_tables(sheet, folder, display, asked_spelling())
    if figures and sheet.pictures:
        progress.say(_("drawing"))
        render.write_pictures(sheet.pictures, folder, display, progress.say)
