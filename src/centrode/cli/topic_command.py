"""Commands of the topics of the registry: print what a sheet says, write its tables, figures and numbers."""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping, Sequence
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
    results_option,
    samples_option,
)
from centrode.cli.expected import announce_size
from centrode.cli.pairs import pairs, ranges
from centrode.cli.progress import Progress
from centrode.cli.tables import asked_spelling, need_table, table_files, tables_options
from centrode.errors import InputError, MotionError
from centrode.locale import _, mark, speaking
from centrode.topics.topic import Choice, OptionKind

if TYPE_CHECKING:
    from centrode.model.mechanism import Display, Mechanism
    from centrode.sheets.sheet import Sheet
    from centrode.topics.topic import Option, Topic

OUT_OPTION = click.option(
    "--out",
    type=click.Path(path_type=Path),
    metavar=mark("DIR"),
    help=mark("Also write tables, pictures and numbers into this folder."),
)
FILE_OPTION = click.option(
    "--out",
    type=click.Path(path_type=Path),
    metavar=mark("FILE"),
    help=mark("Also write FILE.json or FILE.csv, by the ending of its name."),
)
FORCE_OPTION = click.option("--force", is_flag=True, help=mark("Replace FILE where it exists."))
TYPES: Mapping[OptionKind, Mapping[str, Any]] = {
    OptionKind.FLAG: {"is_flag": True},
    OptionKind.WORD: {},
    OptionKind.WORDS: {"multiple": True},
    OptionKind.COUNT: {"type": int},
    OptionKind.NUMBER: {"type": float},
    OptionKind.PAIRS: {"multiple": True},
    OptionKind.RANGES: {"multiple": True},
    OptionKind.INSTANT: {},
}


def topic_command(topic: Topic) -> click.Command:
    """The command of a topic: `centrode TOPIC MECHANISM [options] [--out DIR]`."""

    def command(mechanism: str, out: Path | None, **given: Any) -> None:
        description = ct.load(mechanism)
        options = _options(topic, description, given)
        if topic.samples:
            announce_size(description, given["samples"])
            options["samples"] = given["samples"]
        if topic.files:
            sheet, written = _beside_file(topic, mechanism, description, options, out, given["force"])
        else:
            folder = output.folder_of(out, mechanism, topic.folder) if topic.folder else out
            sheet, written = _beside_folder(topic, mechanism, description, options, folder, given)
        click.echo(_(description.title) or mechanism)
        click.echo()
        click.echo(render.sheet_text(sheet, description.display))
        if written:
            click.echo("\n" + written)
        if sheet.failure is not None:
            raise MotionError(
                mechanism,
                render.plain_text(sheet.failure.what, description.display),
                render.plain_text(sheet.failure.repair, description.display),
            )

    return click.command(topic.name, help=topic.help)(_with_parameters(topic, command))


def _with_parameters(topic: Topic, command: Callable[..., None]) -> Callable[..., None]:
    """A command with its argument and its options, in the order of `--help`."""
    decorators = [mechanism_argument, *map(_option, topic.options)]
    if topic.files:
        decorators += [FILE_OPTION, *([tables_options] if "csv" in topic.files else []), FORCE_OPTION]
    else:
        decorators.append(results_option if topic.folder else OUT_OPTION)
        decorators += [samples_option] if topic.samples else []
        decorators += [no_figures_option] if topic.pictures else []
        decorators += [dark_option] if topic.dark else []
        decorators.append(tables_options)
    for decorator in reversed(decorators):
        command = decorator(command)
    return command


def _option(option: Choice | Option) -> Callable[..., Any]:
    """What gives a command an option."""
    if isinstance(option, Choice):
        return click.option(
            f"--{option.name}", type=click.Choice(option.words), default=option.words[0], help=option.help
        )
    return click.option(f"--{option.name}", metavar=option.value, help=option.help, **TYPES[option.kind])


def _options(topic: Topic, description: Mechanism, given: Mapping[str, Any]) -> dict[str, Any]:
    """Parameters of the computation; those that the user left out are left to it."""
    readers: Mapping[OptionKind, Callable[[Any, str], Any]] = {
        OptionKind.PAIRS: pairs,
        OptionKind.RANGES: ranges,
        OptionKind.INSTANT: functools.partial(ct.range_value, description),
    }
    options: dict[str, Any] = {}
    for option in topic.options:
        value = given[option.name.replace("-", "_")]
        if isinstance(option, Choice):
            options[option.name] = value
        elif value is not None and value is not False and value != ():
            read = readers.get(option.kind)
            parameter = option.parameter or option.name.replace("-", "_")
            options[parameter] = value if read is None else read(value, f"--{option.name}")
    return options


def _beside_folder(
    topic: Topic,
    name: str,
    description: Mechanism,
    options: Mapping[str, Any],
    folder: Path | None,
    given: Mapping[str, Any],
) -> tuple[Sheet, str]:
    """The sheet of a topic, written into a folder where one is named; and what was written."""
    if folder is None:
        with about(name):
            return _sheet(topic, description, options), ""
    with output.output_folder(folder) as draft, Progress() as progress:
        progress.say(_("solving"))
        with about(name):
            sheet = _sheet(topic, description, options)
        figures = topic.pictures and not given["no_figures"]
        dark = bool(given.get("dark"))
        write_sheet(sheet, draft, description.display, progress, figures=figures, dark=dark)
        if sheet.scalars:
            render.write_summary(sheet.scalars, draft / "summary.json")
        names = output.finished(draft)
    return sheet, output.files_in(folder, names)


def _beside_file(
    topic: Topic,
    name: str,
    description: Mechanism,
    options: Mapping[str, Any],
    out: Path | None,
    force: bool,
) -> tuple[Sheet, str]:
    """The sheet of a topic, written as one file where one is named; and what was written."""
    need_table(out)
    if out is None:
        with about(name):
            return _sheet(topic, description, options), ""
    kind = _kind(out, topic.files)
    with about(name):
        sheet = _sheet(topic, description, options)
        with speaking("en"):  # what files hold is English
            english = _sheet(topic, description, options)
    with output.output_table(out, force=force) as draft:
        if kind == "json" and english.record is not None:
            render.write_record(english.record, draft)
        else:
            (table,) = english.tables.values()
            render.write_table(table, draft, description.display)
    return sheet, output.wrote(table_files(out))


def _kind(out: Path, known: Sequence[str]) -> str:
    """Kind of a file by the end of its name; InputError for one that the topic does not write."""
    kind = out.suffix[1:].lower()
    if kind not in known:
        raise InputError(
            "--out",
            _("{kind} is not a kind of file for this").format(kind=f'"{out.suffix}"'),
            _("use one of {known}").format(known=", ".join(f".{one}" for one in known)),
        )
    return kind


def _sheet(topic: Topic, mechanism: Mechanism, options: Mapping[str, Any]) -> Sheet:
    if topic.needs is not None:
        topic.needs(mechanism)
    return cast("Sheet", topic.view(topic.compute(mechanism, **options)))


def write_sheet(
    sheet: Sheet, folder: Path, display: Display, progress: Progress, *, figures: bool, dark: bool = False
) -> None:
    """Write a sheet into a folder: tables and datasets, and its pictures where wanted."""
    progress.say(_("writing tables"))
    render.write_tables(sheet, folder, display, asked_spelling())
    if figures and sheet.pictures:
        progress.say(_("drawing"))
        render.write_pictures(sheet.pictures, folder, display, progress.say, dark=dark)
