"""Commands of the topics of the registry: print a sheet, write its tables, figures and numbers."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

import click

import centrode as ct
from centrode import render
from centrode.cli import output
from centrode.cli.about import about
from centrode.cli.arguments import (
    dark_option,
    mechanism_argument,
    no_figures_option,
    range_option,
    results_option,
    samples_option,
    start_option,
    stop_option,
    written_option,
)
from centrode.cli.expected import announce_size
from centrode.cli.progress import Progress
from centrode.cli.tables import asked_spelling, tables_options
from centrode.locale import _, mark
from centrode.topics.registry import INSTANT
from centrode.topics.topic import Choice, OutFolder

if TYPE_CHECKING:
    from centrode.model.mechanism import Display, Mechanism
    from centrode.sheets.sheet import Sheet
    from centrode.topics.topic import Option, Topic

Decorator = Callable[[Callable[..., None]], Callable[..., None]]

OUT_OPTIONS: dict[OutFolder, Decorator] = {
    OutFolder.WITH_NUMBERS: click.option(
        "--out",
        type=click.Path(path_type=Path),
        metavar=mark("DIR"),
        help=mark("Also write tables, pictures and numbers into this folder."),
    ),
    OutFolder.ON_REQUEST: written_option,
    OutFolder.ALWAYS: results_option,
}


def topic_command(topic: Topic) -> click.Command:
    """The command of a topic: `centrode TOPIC MECHANISM [options] [--out DIR]`."""

    def command(
        mechanism: str,
        out: Path | None,
        no_figures: bool,
        dark: bool = False,
        animate: bool = False,
        **given: Any,
    ) -> None:
        description = ct.load(mechanism)
        if topic.samples:
            announce_size(description, given["samples"])
        description = ct.with_range(description, given.pop("ranged", None))
        folder = output.folder_of(out, mechanism, topic.name) if topic.out is OutFolder.ALWAYS else out
        names: list[str] = []
        with ExitStack() as stack:
            # a folder that cannot be written is refused before anything is computed
            with about(mechanism):
                draft = None if folder is None else stack.enter_context(output.output_folder(folder))
            progress = stack.enter_context(Progress())
            progress.say(_("solving"))
            with about(mechanism):
                result = _result(topic, description, given)
            sheet = cast("Sheet", topic.view(result))
            if draft is not None:
                write_sheet(sheet, draft, description.display, progress, figures=not no_figures, dark=dark)
                if sheet.scalars:
                    render.write_summary(sheet.scalars, draft / "summary.json")
                if animate and topic.animation is not None:
                    name = f"{topic.name}.gif"
                    progress.say(_("drawing {name}").format(name=name))
                    with about(mechanism):
                        topic.animation(result, draft / name, dark)
                names = output.finished(draft)
        click.echo(_(description.title) or mechanism)
        click.echo()
        click.echo(render.sheet_text(sheet, description.display))
        if folder is not None:
            click.echo("\n" + output.files_in(folder, names))
        if topic.shortfall is not None:
            with about(mechanism):
                topic.shortfall(result)

    decorators: list[Decorator] = [mechanism_argument, *_decorators(topic)]
    decorated: Callable[..., None] = command
    for decorate in reversed(decorators):
        decorated = decorate(decorated)
    return click.command(topic.name, help=topic.help)(decorated)


def _decorators(topic: Topic) -> Iterator[Decorator]:
    """The options of a topic's command, in the order of its help."""
    yield from map(_option, topic.options)
    yield OUT_OPTIONS[topic.out]
    if topic.samples:
        yield samples_option
    if topic.ranged:
        yield from (start_option, stop_option, range_option)
    if topic.animation is not None:
        yield click.option("--animate", is_flag=True, help=topic.animation_help)
    yield no_figures_option
    if topic.dark:
        yield dark_option
    yield tables_options


def _option(option: Option) -> Decorator:
    if isinstance(option, Choice):
        return click.option(
            f"--{option.name}", type=click.Choice(option.words), default=option.words[0], help=option.help
        )
    return click.option(
        f"--{option.name}",
        option.parameter,
        metavar=option.metavar,
        help=option.help,
        multiple=option.several,
        required=option.required,
    )


def _result(topic: Topic, mechanism: Mechanism, given: dict[str, Any]) -> Any:
    """What a topic computes with the options of its command; an option without a value is left to the computation."""
    options = {
        name: value
        for name, value in _read(topic, mechanism, given).items()
        if value is not None and value != []
    }
    if topic.needs is not None:
        topic.needs(mechanism, **options)
    return topic.compute(mechanism, **options)


def _read(topic: Topic, mechanism: Mechanism, given: dict[str, Any]) -> dict[str, Any]:
    """The values of a command's options as its topic takes them."""
    values = dict(given)
    if topic.ranged:
        for name, where in (("start", "--from"), ("stop", "--to")):
            if values[name] is not None:
                values[name] = INSTANT(mechanism, values[name], where)
    for option in topic.options:
        if isinstance(option, Choice) or values[option.parameter] is None:
            continue
        read = option.read or _text
        texts = values[option.parameter]
        where = f"--{option.name}"
        values[option.parameter] = (
            [read(mechanism, text, where) for text in texts]
            if option.several
            else read(mechanism, texts, where)
        )
    return values


def _text(_mechanism: Mechanism, text: str, _where: str) -> str:
    return text


def write_sheet(
    sheet: Sheet, folder: Path, display: Display, progress: Progress, *, figures: bool, dark: bool = False
) -> None:
    """Write a sheet into a folder: tables and datasets, and its pictures where wanted."""
    progress.say(_("writing tables"))
    render.write_tables(sheet, folder, display, asked_spelling())
    if figures and sheet.pictures:
        progress.say(_("drawing"))
        render.write_pictures(sheet.pictures, folder, display, progress.say, dark)
