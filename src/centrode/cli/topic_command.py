"""Commands of the topics of the registry: print what a sheet has for a terminal, write tables, figures and numbers."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, assert_never

import click

from centrode import render
from centrode.cli import library, output
from centrode.cli.about import about
from centrode.cli.arguments import (
    dark_option,
    mechanism_argument,
    no_figures_option,
    numbers_option,
    range_option,
    results_option,
    samples_option,
    start_option,
    stop_option,
    written_option,
)
from centrode.cli.instants import default_instants, echo_values
from centrode.cli.option_values import pairs
from centrode.cli.progress import Progress, announce_size, announce_turns
from centrode.cli.tables import asked_spelling, need_table, table_files, tables_options
from centrode.errors import InputError, MotionError
from centrode.locale import _, chosen_language, mark, speaking
from centrode.topics.arguments import option_arguments, option_name
from centrode.topics.sheets import sheet_with_parts
from centrode.topics.topic import (
    ChoiceOption,
    Command,
    FlagOption,
    InstantsOption,
    NumbersOption,
    Option,
    RangeOptions,
    ValueOption,
)

if TYPE_CHECKING:
    from centrode.model.mechanism import Display, Mechanism
    from centrode.sheets.sheet import Sheet
    from centrode.topics.topic import Topic

force_option = click.option("--force", is_flag=True, help=mark("Replace FILE where it exists."))


def topic_command(topic: Topic, command: Command) -> click.Command:
    """The command of a topic: `centrode TOPIC MECHANISM [options] [--out DIR]`."""

    def run(mechanism: str, out: Path | None = None, **given: Any) -> None:
        description = _with_numbers(library.load(mechanism), given.pop("numbers", ()))
        samples = given.pop("samples") if command.samples else None
        if command.samples and command.extent is None:
            announce_size(description, samples)
        description = _in_range(command, description, given)
        _check_instants(command, description, samples, given)
        written = {name: given.pop(name, False) for name in ("force", "no_figures", "dark", "animate")}
        with about(mechanism):
            arguments = option_arguments(command, description, given)
        if command.samples:
            arguments["samples"] = samples
        if command.pages and out is not None:
            click.echo(
                _written_page(topic, command, mechanism, description, arguments, out, written["force"])
            )
            return
        with default_instants(topic, mechanism, description, arguments):
            files = ""
            if command.prints_only:
                with about(mechanism), Progress() as progress:
                    result = _result(topic, command, description, arguments, progress)
                    sheet = sheet_with_parts(topic, result)
            elif command.kinds:
                result, sheet, files = _beside_file(
                    topic, command, mechanism, description, arguments, out, written["force"]
                )
            else:
                folder = output.folder_of(out, mechanism, command.folder) if command.folder else out
                result, sheet, files = _beside_folder(
                    topic, command, mechanism, description, arguments, folder, written
                )
            click.echo(_(description.title) or mechanism)
            click.echo()
            output.print_sheet(sheet, description.display)
            if files:
                click.echo("\n" + files)
            with about(mechanism):
                _end(command, result, sheet, description.display)

    made = click.command(topic.name, help=command.help)(run)
    made.params = list(_parameters(command))
    return made


def _parameters(command: Command) -> Iterator[click.Parameter]:
    """The argument and the options of a command, in the order of `--help`."""
    yield from parameters_of([mechanism_argument])
    for option in command.options:
        yield from option_parameters(option)
    if command.prints_only:
        return
    if command.kinds or command.pages:
        file_option = click.option(
            "--out",
            type=click.Path(path_type=Path),
            metavar=mark("FILE"),
            help=command.file_help or mark("Also write FILE.json or FILE.csv, according to its extension."),
        )
        yield from parameters_of(
            [file_option, *([tables_options] if "csv" in command.kinds else []), force_option]
        )
        return
    decorators = [results_option if command.folder else written_option]
    decorators += [samples_option] if command.samples else []
    if command.animation is not None:
        decorators.append(click.option("--animate", is_flag=True, help=command.animation_help))
    decorators += [no_figures_option] if command.pictures else []
    decorators += [dark_option] if command.dark else []
    yield from parameters_of([*decorators, tables_options])


def option_parameters(option: Option) -> Iterator[click.Parameter]:
    """An option of a topic as options of its command."""
    match option:
        case ChoiceOption(name, words, text, has_default):
            default = words[0] if has_default else None
            yield click.Option([option_name(name)], type=click.Choice(words), default=default, help=text)
        case ValueOption(name, metavar, text, kind, several, required):
            yield click.Option(
                [option_name(name), name],
                type=kind,
                metavar=metavar,
                help=text,
                multiple=several,
                required=required,
            )
        case FlagOption(name, text):
            yield click.Option([option_name(name)], is_flag=True, help=text)
        case InstantsOption(text):
            yield click.Option(["--at"], multiple=True, metavar=mark("VALUE"), help=text)
        case RangeOptions():
            yield from parameters_of([start_option, stop_option, range_option])
        case NumbersOption():
            yield from parameters_of([numbers_option])
        case _:
            assert_never(option)


def parameters_of(decorators: list[Any]) -> list[click.Parameter]:
    """The parameters that decorators of click give a command, in the order of the decorators."""

    def nothing() -> None:
        """Carries the parameters."""

    decorated: Any = nothing
    for decorate in reversed(decorators):
        decorated = decorate(decorated)
    return click.command()(decorated).params


def _with_numbers(mechanism: Mechanism, texts: tuple[str, ...]) -> Mechanism:
    """The mechanism with the numbers of `--set`."""
    if not texts:
        return mechanism
    with about("--set"):
        changed: Mechanism = library.with_numbers(mechanism, pairs(texts, "", "links.AB.length=3.6 m"))
    return changed


def _in_range(command: Command, mechanism: Mechanism, given: dict[str, Any]) -> Mechanism:
    """The mechanism in the range of `--range`; `--from` and `--to` are read into SI."""
    mechanism = mechanism.with_range(given.pop("ranged", None))
    for name, where in (("start", "--from"), ("stop", "--to")):
        if isinstance(given.get(name), str):
            given[name] = mechanism.motion_parameter.instant.read(given[name], where)
    if any(isinstance(option, RangeOptions) and option.echoed for option in command.options):
        echo_values(mechanism, ("--from", given.get("start")), ("--to", given.get("stop")))
    return mechanism


def _check_instants(
    command: Command, mechanism: Mechanism, samples: int | None, given: dict[str, Any]
) -> None:
    """Refuse instants that cannot be read, too many of them to print, and instants beside a range."""
    option = next((option for option in command.options if isinstance(option, InstantsOption)), None)
    if option is None:
        return
    places = given["at"]
    if len(places) > option.most:
        raise InputError(
            "--at",
            _("{count} instants are given").format(count=len(places)),
            _("give at most {most}").format(most=option.most),
        )
    beside = {"--samples": samples, "--from": given.get("start"), "--to": given.get("stop")}
    other = next((name for name, value in beside.items() if places and value is not None), None)
    if other is not None:
        raise InputError(other, _("use --at for instants"), _("remove one of the two"))
    for text in places:
        mechanism.motion_parameter.instant.read(text, "--at")


def _result(
    topic: Topic, command: Command, mechanism: Mechanism, arguments: dict[str, Any], progress: Progress
) -> Any:
    """What a topic computes; long work is announced before."""
    if command.needs is not None:
        command.needs(mechanism, **{name: arguments[name] for name in arguments if name != "samples"})
    if command.extent is not None:
        count, turns = command.extent(mechanism, **arguments)
        announce_size(mechanism, count)
        announce_turns(turns)
    if command.progress:
        text = _(command.progress)
        arguments = arguments | {"progress": lambda share: progress.say(text, round(100 * share), 100)}
    return topic.compute(mechanism, **arguments)


def _beside_folder(
    topic: Topic,
    command: Command,
    name: str,
    mechanism: Mechanism,
    arguments: dict[str, Any],
    folder: Path | None,
    written: dict[str, bool],
) -> tuple[Any, Sheet, str]:
    """Result and sheet of a topic, written into a folder where one is named; and what was written."""
    if folder is None:
        with about(name), Progress() as progress:
            if command.complete:
                arguments = arguments | {command.complete: False}
            result = _result(topic, command, mechanism, arguments, progress)
            return result, sheet_with_parts(topic, result), ""
    # a folder that cannot be written is refused before anything is computed
    with output.output_folder(folder) as draft, Progress() as progress:
        progress.say(_("solving"))
        with about(name):
            result = _result(topic, command, mechanism, arguments, progress)
        sheet = sheet_with_parts(topic, result)
        figures = command.pictures and not written["no_figures"]
        write_sheet(sheet, draft, mechanism.display, progress, figures=figures, dark=written["dark"])
        if command.summary and sheet.scalars:
            render.write_summary(sheet.scalars, draft / "summary.json")
        if command.animation is not None and written["animate"]:
            animation = command.animation_file or f"{topic.name}.gif"
            progress.say(_("drawing {name}").format(name=animation))
            with about(name):
                command.animation(result, draft / animation, written["dark"])
        names = output.file_names(draft)
    return result, sheet, output.files_in(folder, names)


def _beside_file(
    topic: Topic,
    command: Command,
    name: str,
    mechanism: Mechanism,
    arguments: dict[str, Any],
    out: Path | None,
    force: bool,
) -> tuple[Any, Sheet, str]:
    """Result and sheet of a topic, written as one file where one is named; and what was written."""
    need_table(out)
    with about(name), Progress() as progress:
        kind = None if out is None else _kind(out, command.kinds)
        result = _result(topic, command, mechanism, arguments, progress)
        sheet = sheet_with_parts(topic, result)
        if kind is None or out is None:
            return result, sheet, ""
        known = tuple(_kinds_of(sheet))
        if kind not in known and sheet.failure is not None:
            return result, sheet, ""  # what would be written was not found
        kind = _kind(out, known)
        english = sheet
        if chosen_language() != "en":
            with speaking("en"):  # what files hold is English
                english = sheet_with_parts(topic, _result(topic, command, mechanism, arguments, progress))
    with output.output_table(out, force=force) as (draft, workbook):
        if kind == "json" and english.record is not None:
            render.write_record(english.record, draft)
        elif kind == "csv":
            (table,) = english.tables.values()
            render.write_table(table, draft, mechanism.display, asked_spelling(), workbook)
        else:
            text = next(text for name, text in english.files.items() if _ending(name) == kind)
            draft.write_text(text, encoding="utf-8", newline="\n")
    return result, sheet, output.wrote(table_files(out))


def _written_page(
    topic: Topic,
    command: Command,
    name: str,
    mechanism: Mechanism,
    arguments: dict[str, Any],
    out: Path,
    force: bool,
) -> str:
    """Write what is printed without `--out`, in the reader's language, as a document by the ending of its name."""
    kind = _kind(out, command.pages)
    with about(name), Progress() as progress:
        sheet = topic.view(_result(topic, command, mechanism, arguments, progress))
    text = render.page_text(sheet, _(mechanism.title) or name, kind, mechanism.display)
    output.write_file(out, text, force=force)
    return output.wrote([out])


def _kinds_of(sheet: Sheet) -> Iterator[str]:
    """The kinds of the one file that a sheet can be written as."""
    if sheet.record is not None:
        yield "json"
    if sheet.tables:
        yield "csv"
    yield from map(_ending, sheet.files)


def _ending(name: str) -> str:
    return Path(name).suffix[1:].lower()


def _kind(out: Path, known: tuple[str, ...]) -> str:
    """Kind of a file by the end of its name; InputError for one that the topic does not write."""
    kind = _ending(out.name)
    if kind not in known:
        raise InputError(
            "--out",
            _("this result cannot be written as {kind}").format(kind=f'"{out.suffix}"'),
            _("use one of {known}").format(known=", ".join(f".{one}" for one in known)),
        )
    return kind


def write_sheet(
    sheet: Sheet, folder: Path, display: Display, progress: Progress, *, figures: bool, dark: bool = False
) -> None:
    """Write a sheet into a folder: tables, datasets and further files, and its pictures where wanted."""
    progress.say(_("writing tables"))
    render.write_tables(sheet, folder, display, asked_spelling())
    if figures and sheet.pictures:
        progress.say(_("drawing"))
        render.write_pictures(sheet.pictures, folder, display, progress.say, dark=dark)


def _end(command: Command, result: Any, sheet: Sheet, display: Display) -> None:
    """Raise MotionError where the result falls short of what the command computes: it has been shown before."""
    if sheet.failure is not None:
        what, repair = (
            render.plain_text(text, display) for text in (sheet.failure.what, sheet.failure.repair)
        )
        raise MotionError("", what, repair)
    if command.ending is not None:
        command.ending(result)
