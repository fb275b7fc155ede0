"""Commands of the topics of the registry: print what a sheet has for a terminal, write tables, figures and numbers."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, assert_never

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
    samples_option,
    start_option,
    stop_option,
    written_option,
)
from centrode.cli.expected import announce_size, announce_turns
from centrode.cli.progress import Progress
from centrode.cli.tables import asked_spelling, tables_options
from centrode.errors import InputError
from centrode.locale import _, mark
from centrode.topics.topic import Choice, Flag, InstantsOption, MotionRange, Option, Topic, Written

if TYPE_CHECKING:
    from centrode.model.mechanism import Display, Mechanism
    from centrode.sheets.sheet import Sheet


def topic_command(topic: Topic) -> click.Command:
    """The command of a topic: `centrode TOPIC MECHANISM [options] [--out DIR]`."""

    @mechanism_argument
    @written_option
    @samples_option
    @no_figures_option
    @tables_options
    def command(
        mechanism: str,
        out: Path | None,
        samples: int | None,
        no_figures: bool,
        dark: bool = False,
        **options: Any,
    ) -> None:
        description = ct.load(mechanism)
        if topic.extent is None:
            announce_size(description, samples)
        description = _in_range(description, options)
        _check_instants(topic, description, samples, options)
        if topic.arguments is not None:
            options = topic.arguments(options)
        names: list[str] = []
        if out is None:
            with about(mechanism), Progress() as progress:
                options |= {topic.complete: False} if topic.complete else {}
                result = _result(topic, description, samples, options, progress)
                sheet = topic.view(result)
        else:
            with about(mechanism), output.output_folder(out) as draft, Progress() as progress:
                progress.say(_("solving"))
                result = _result(topic, description, samples, options, progress)
                sheet = topic.view(result)
                write_sheet(sheet, draft, description.display, progress, figures=not no_figures, dark=dark)
                if topic.summary:
                    render.write_summary(sheet.scalars, draft / "summary.json")
                names = output.finished(draft)
        click.echo(_(description.title) or mechanism)
        click.echo()
        click.echo(render.sheet_text(sheet, description.display))
        if out is not None:
            click.echo("\n" + output.files_in(out, names))
        if topic.ending is not None:
            with about(mechanism):
                topic.ending(result)

    made = click.command(topic.name, help=topic.help)(dark_option(command) if topic.dark else command)
    made.params[1:1] = [parameter for option in topic.options for parameter in _parameters(option)]
    return made


def _parameters(option: Option) -> Iterator[click.Parameter]:
    """An option of a topic as options of its command."""
    match option:
        case Choice(name, words, text, has_rule):
            default = words[0] if has_rule else None
            yield click.Option([_option(name)], type=click.Choice(words), default=default, help=text)
        case Written(name, metavar, text, kind, several):
            yield click.Option([_option(name), name], type=kind, metavar=metavar, help=text, multiple=several)
        case Flag(name, text):
            yield click.Option([_option(name)], is_flag=True, help=text)
        case InstantsOption(text):
            yield click.Option(["--at"], multiple=True, metavar=mark("VALUE"), help=text)
        case MotionRange():
            yield from _range_options.params
        case _:
            assert_never(option)


@click.command()
@start_option
@stop_option
@range_option
def _range_options(**_options: str) -> None:
    """Holds the options of a range."""


def _option(name: str) -> str:
    return "--" + name.replace("_", "-")


def _in_range(mechanism: Mechanism, options: dict[str, Any]) -> Mechanism:
    """The mechanism in the range of `--range`; `--from` and `--to` are read into SI."""
    mechanism = ct.with_range(mechanism, options.pop("ranged", None))
    for name, where in (("start", "--from"), ("stop", "--to")):
        if options.get(name) is not None:
            options[name] = ct.range_value(mechanism, options[name], where)
    return mechanism


def _check_instants(topic: Topic, mechanism: Mechanism, samples: int | None, options: dict[str, Any]) -> None:
    """Refuse instants that cannot be read, too many of them to print, and instants beside a range."""
    places = options.get("at") or ()
    most = next((option.most for option in topic.options if isinstance(option, InstantsOption)), 0)
    if len(places) > most:
        raise InputError(
            "--at",
            _("{count} instants were asked for").format(count=len(places)),
            _("ask for at most {most}").format(most=most),
        )
    given = {"--samples": samples, "--from": options.get("start"), "--to": options.get("stop")}
    beside = next((name for name, value in given.items() if places and value is not None), None)
    if beside is not None:
        raise InputError(beside, _("instants are asked for with --at"), _("take one of the two out"))
    for text in places:
        ct.range_value(mechanism, text, "--at")


def _result(
    topic: Topic, mechanism: Mechanism, samples: int | None, options: dict[str, Any], progress: Progress
) -> Any:
    """What a topic computes; long work is announced before."""
    if topic.needs is not None:
        topic.needs(mechanism)
    if topic.extent is not None:
        count, turns = topic.extent(mechanism, samples, **options)
        announce_size(mechanism, count)
        announce_turns(turns)
    if topic.progress:
        text = _(topic.progress)
        options = options | {"progress": lambda share: progress.say(text, round(100 * share), 100)}
    return topic.compute(mechanism, samples=samples, **options)


def write_sheet(
    sheet: Sheet, folder: Path, display: Display, progress: Progress, *, figures: bool, dark: bool = False
) -> None:
    """Write a sheet into a folder: tables, datasets and further files, and its pictures where wanted."""
    progress.say(_("writing tables"))
    render.write_tables(sheet, folder, display, asked_spelling())
    if figures and sheet.pictures:
        progress.say(_("drawing"))
        render.write_pictures(sheet.pictures, folder, display, progress.say, dark=dark)
