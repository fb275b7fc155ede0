"""`centrode cam`: everything that the topics of cams have about one, by a curvature law or a follower's lift."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from centrode import render
from centrode.cli import library, output
from centrode.cli.about import about
from centrode.cli.arguments import dark_option, no_figures_option, samples_option, written_option
from centrode.cli.progress import Progress, announce_samples
from centrode.cli.tables import tables_options
from centrode.cli.topic_command import option_parameters, parameters_of, write_sheet
from centrode.errors import InputError, MotionError
from centrode.locale import _, mark
from centrode.optional_packages import how_to_install
from centrode.topics.arguments import option_arguments, option_name
from centrode.topics.registry import TOPICS
from centrode.topics.topic import Command, RangeOptions, Topic

if TYPE_CHECKING:
    from centrode.model.cam_files import AnyCam
    from centrode.sheets.sheet import Sheet

TOPICS_OF_CAMS = tuple(
    topic for topic in TOPICS if topic.subject == "cam" and (topic.title or topic.flag or topic.command)
)
"""Those of cams that more than Python has."""

cam_argument = click.argument(
    "cam", metavar=mark("FILE_OR_EXAMPLE"), help=mark("A TOML file, or the name of a built-in cam.")
)
animate_option = click.option(
    "--animate",
    is_flag=True,
    help=mark("Also write an animation: a walking wheel makes a step, a cam turns under its follower."),
)


def run(cam: str, out: Path | None, samples: int | None, animate: bool, **given: Any) -> None:
    """Print what is known of a cam, and write it where a folder is named."""
    description = library.load_cam(cam)
    no_figures, dark = given.pop("no_figures"), given.pop("dark")
    _check_options(description, given)
    with about(cam):
        topics = [topic for topic in TOPICS_OF_CAMS if _applies(topic, description, given)]
    if animate:
        _check_animation(description, out)
    announce_samples(samples or 0)
    names: list[str] = []
    with about(cam), Progress() as progress:
        progress.say(_("solving"))
        if out is None:
            sheets = [
                sheet for _result, sheet in _results(topics, description, samples, given, written=False)
            ]
        else:
            with output.output_folder(out) as draft:
                found = _results(topics, description, samples, given, written=True)
                sheets = [sheet for _result, sheet in found]
                _write(sheets, draft, progress, description, figures=not no_figures, dark=dark)
                if animate:
                    _animate(topics, [result for result, _sheet in found], draft, progress, dark=dark)
                names = output.file_names(draft)
    click.echo(_(description.title) or cam)
    for sheet in sheets:
        if text := render.sheet_text(sheet, description.display, output.terminal_width()):
            click.echo("\n" + text)
    if out is not None:
        click.echo("\n" + output.files_in(out, names))
        if any(sheet.outlines for sheet in sheets) and not render.writes_dxf():
            click.echo(_("no DXF: it needs ezdxf; {repair}").format(repair=how_to_install("drawings")))
    failures = [_failure(sheet, description) for sheet in sheets if sheet.failure is not None]
    if failures:
        raise MotionError(cam, "; ".join(failures))


def _command() -> click.Command:
    """The command, with the options of all topics of cams."""
    made = click.command("cam", help=mark("Compute a cam by a curvature law or its follower's lift."))(run)
    made.params = parameters_of([cam_argument, written_option, tables_options, samples_option])
    for topic in TOPICS_OF_CAMS:
        for option in topic.command.options if topic.command is not None else ():
            made.params += option_parameters(option)
    made.params += parameters_of([animate_option, no_figures_option, dark_option])
    return made


cam = _command()


def _names(command: Command | None) -> Iterator[str]:
    """Names of the options of a topic."""
    for option in command.options if command is not None else ():
        if not isinstance(option, RangeOptions):
            yield getattr(option, "name", "at")


def _applies(topic: Topic, cam: AnyCam, given: Mapping[str, Any]) -> bool:
    """Whether a topic has something to say about a cam, and is wanted."""
    if topic.flag and not given[topic.flag]:
        return False
    return topic.concerns is None or bool(topic.concerns(cam))


def _refusal(topic: Topic, cam: AnyCam) -> InputError | None:
    """Why a topic is none of this kind of cam; None where it may be."""
    if topic.command is not None and topic.command.needs is not None:
        try:
            topic.command.needs(cam)
        except InputError as reason:
            return reason
    return None


def _check_options(cam: AnyCam, given: Mapping[str, Any]) -> None:
    """Refuse options of topics of another kind of cam."""
    for topic in TOPICS_OF_CAMS:
        for name in _names(topic.command):
            reason = _refusal(topic, cam) if given[name] else None
            if reason is not None:
                raise InputError(option_name(name), reason.what, _("omit it"))


def _check_animation(cam: AnyCam, out: Path | None) -> None:
    """Refuse an animation of a cam that has no shape, or without a folder."""
    topics = [
        topic
        for topic in TOPICS_OF_CAMS
        if topic.command is not None and topic.command.animation is not None and _refusal(topic, cam) is None
    ]
    if not any(topic.concerns is None or topic.concerns(cam) for topic in topics):
        for topic in topics:
            try:
                topic.compute(cam)
            except InputError as reason:
                raise InputError("--animate", reason.what, reason.repair) from None
            except MotionError:
                pass  # the sheets say why there is no such cam
    if out is None:
        raise InputError("--animate", _("no output folder is given"), _("name one with --out"))


def _results(
    topics: Sequence[Topic], cam: AnyCam, samples: int | None, given: Mapping[str, Any], *, written: bool
) -> list[tuple[Any, Sheet]]:
    """Results of topics with their sheets; what only files hold is computed where they are `written`."""
    found = []
    for topic in topics:
        command = Command("") if topic.command is None else topic.command
        options = {name: given[name] for name in _names(command) if name != topic.flag}
        arguments = option_arguments(command, cam, options)
        if command.samples:
            arguments["samples"] = samples
        if command.complete:
            arguments[command.complete] = written
        result = topic.compute(cam, **arguments)
        found.append((result, topic.view(result)))
    return found


def _write(
    sheets: Sequence[Sheet],
    folder: Path,
    progress: Progress,
    cam: AnyCam,
    *,
    figures: bool,
    dark: bool,
) -> None:
    """Write tables, outlines, numbers and figures into a folder."""
    for sheet in sheets:
        write_sheet(sheet, folder, cam.display, progress, figures=figures, dark=dark)
    scalars = {name: scalar for sheet in sheets for name, scalar in sheet.scalars.items()}
    render.write_summary(scalars, folder / "summary.json")


def _animate(
    topics: Sequence[Topic], results: Sequence[Any], folder: Path, progress: Progress, *, dark: bool
) -> None:
    """Write the animation of the last topic that has one: a wheel that walks goes before the cam that it walks on."""
    for topic, result in reversed(list(zip(topics, results, strict=True))):
        command = topic.command
        if command is not None and command.animation is not None:
            name = command.animation_file or f"{topic.name}.gif"
            progress.say(_("drawing {name}").format(name=name))
            command.animation(result, folder / name, dark)
            return


def _failure(sheet: Sheet, cam: AnyCam) -> str:
    """Why a cam falls short, and what helps."""
    assert sheet.failure is not None
    texts = (sheet.failure.what, sheet.failure.repair)
    return "; ".join(filter(None, (render.plain_text(text, cam.display) for text in texts)))
