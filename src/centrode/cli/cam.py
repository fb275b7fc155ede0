"""`centrode cam`: everything that the topics of cams have about one, by a curvature law or a follower's lift."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

import centrode as ct
from centrode import render
from centrode.cli import output
from centrode.cli.about import about
from centrode.cli.announcements import announce_samples
from centrode.cli.arguments import dark_option, no_figures_option, samples_option, written_option
from centrode.cli.progress import Progress
from centrode.cli.tables import tables_options
from centrode.cli.topic_command import (
    option_arguments,
    option_name,
    option_parameters,
    parameters_of,
    write_sheet,
)
from centrode.errors import InputError, MotionError
from centrode.locale import _, mark
from centrode.study.cams.results import CamResults
from centrode.topics.registry import TOPICS
from centrode.topics.topic import Command, RangeOptions, Topic

if TYPE_CHECKING:
    from centrode.model.cam_files import AnyCam
    from centrode.sheets.sheet import Sheet

TOPICS_OF_CAMS = tuple(topic for topic in TOPICS if topic.subject == "cam")

cam_argument = click.argument(
    "cam", metavar=mark("FILE_OR_EXAMPLE"), help=mark("A TOML file, or the name of a built-in cam.")
)
groove_option = click.option(
    "--groove", is_flag=True, help=mark("Also the outer wall of a groove that the roller runs in.")
)
animate_option = click.option(
    "--animate",
    is_flag=True,
    help=mark("Also write an animation: a walking wheel makes a step, a cam turns under its follower."),
)


def run(cam: str, out: Path | None, samples: int | None, animate: bool, **given: Any) -> None:
    """Print what is known of a cam, and write it where a folder is named."""
    description = ct.load_cam(cam)
    no_figures, dark = given.pop("no_figures"), given.pop("dark")
    if given["groove"] and isinstance(description, ct.PlateCam):
        what = _("this cam is given by its follower's lift and has no curvature law")
        raise InputError("--groove", what, _("leave it out"))
    _check_options(description, given)
    if animate:
        _check_animation(description, out)
    announce_samples(samples or 0)
    topics = [topic for topic in TOPICS_OF_CAMS if _applies(topic, description, given)]
    names: list[str] = []
    parts = Parts(description, samples, given)
    with about(cam), Progress() as progress:
        progress.say(_("solving"))
        if out is None:
            sheets = [
                sheet for _result, sheet in _results(topics, description, samples, given, written=False)
            ]
            parts.compute(front=False)
        else:
            with output.output_folder(out) as draft:
                found = _results(topics, description, samples, given, written=True)
                sheets = [sheet for _result, sheet in found]
                parts.compute(front=True)
                _write(sheets, parts, draft, progress, description, figures=not no_figures, dark=dark)
                if animate:
                    parts.animate(draft, dark=dark)
                    _animate(topics, [result for result, _sheet in found], draft, progress, dark=dark)
                names = output.finish_folder(draft)
    click.echo(_(description.title) or cam)
    for sheet in sheets:
        if text := render.sheet_text(sheet, description.display):
            click.echo("\n" + text)
    parts.show()
    if out is not None:
        click.echo("\n" + output.files_in(out, names))
        if (any(sheet.outlines for sheet in sheets) or parts.outlined) and not render.writes_dxf():
            click.echo(_('no DXF: it needs ezdxf, install it with pip install "centrode[drawings]"'))
    failures = [_failure(sheet, description) for sheet in sheets if sheet.failure is not None]
    failures += parts.results.failures
    if failures:
        raise MotionError(cam, "; ".join(failures))


def _command() -> click.Command:
    """The command, with the options of all topics of cams."""
    made = click.command("cam", help=mark("Compute a cam by a curvature law or its follower's lift."))(run)
    made.params = parameters_of([cam_argument, written_option, tables_options, samples_option])
    for topic in TOPICS_OF_CAMS:
        for option in topic.command.options if topic.command is not None else ():
            made.params += option_parameters(option)
    made.params += parameters_of([groove_option, animate_option, no_figures_option, dark_option])
    return made


cam = _command()


# Parts that are no topics yet.


class Parts:
    """What `cam_results` has of a cam."""

    def __init__(self, cam: AnyCam, samples: int | None, given: Mapping[str, Any]) -> None:
        self.cam, self.samples, self.groove = cam, samples, bool(given.get("groove"))
        self.results = CamResults(cam, {})

    def compute(self, *, front: bool) -> None:
        """Compute all parts."""
        self.results = ct.cam_results(self.cam, self.samples, groove=self.groove, front=front)

    @property
    def outlined(self) -> bool:
        """Whether there are outlines."""
        return "body" in self.results.objects

    def show(self) -> None:
        """Print all parts."""
        for part in self.results.parts.values():
            text = f"{part.heading}\n\n{render.aligned(part.rows)}"
            for table in part.tables:
                numbers = range(1 if table.named else 0, len(table.header))
                text += f"\n\n{table.heading}\n\n{render.aligned(table.lines, table.header, numbers)}"
            click.echo("\n" + text)

    def write(self, folder: Path, *, figures: bool, dark: bool) -> None:
        """Write tables and figures."""
        cam, objects = self.cam, self.results.objects
        datasets = {
            name: data for part in self.results.parts.values() for name, data in part.datasets.items()
        }
        ct.write_cam_tables(cam, datasets, folder)
        for name, data in datasets.items():
            ct.write_motion_netcdf(data, folder / f"{name}.nc")
        if "choice" in objects:
            ct.write_choice(objects["choice"], folder)
        ct.write_cam_outlines(cam, objects, folder, groove=self.groove, dxf=render.writes_dxf())
        if figures:
            drawn = ct.cam_figures(cam, datasets) | ct.cam_body_figures(cam, objects, groove=self.groove)
            if "choice" in objects:
                drawn |= ct.choice_figures(objects["choice"])
            for name, figure in drawn.items():
                ct.save_figures({name: ct.darkened(figure) if dark else figure}, folder)

    def animate(self, folder: Path, *, dark: bool) -> None:
        """Write the animation."""
        objects, cam = self.results.objects, self.cam
        title, display = _(cam.title), cam.display
        if "wheel" in objects:
            ct.animate_walking(objects["wheel"], folder / "walking-wheel.gif", title, display, dark=dark)
        elif "body" in objects and isinstance(cam, ct.Cam) and cam.mover is None:
            ct.animate_cam_body(objects["body"], folder / "cam.gif", title, display, dark=dark)


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


def _check_options(cam: AnyCam, given: Mapping[str, Any]) -> None:
    """Refuse options of topics of another kind of cam."""
    for topic in TOPICS_OF_CAMS:
        for name in _names(topic.command):
            if given[name] and topic.command is not None and topic.command.needs is not None:
                try:
                    topic.command.needs(cam)
                except InputError as reason:
                    raise InputError(option_name(name), reason.what, _("leave it out")) from None


def _check_animation(cam: AnyCam, out: Path | None) -> None:
    """Refuse an animation of a cam that has no shape, or without a folder."""
    if isinstance(cam, ct.Cam) and cam.roller is None:
        raise InputError("--animate", _("a profile needs a roller"), _("give [roller] radius"))
    topics = [
        topic for topic in TOPICS_OF_CAMS if topic.command is not None and topic.command.animation is not None
    ]
    if isinstance(cam, ct.PlateCam) and not any(
        topic.concerns is None or topic.concerns(cam) for topic in topics
    ):
        for topic in topics:
            try:
                topic.compute(cam)
            except InputError as reason:
                raise InputError("--animate", reason.what, reason.repair) from None
            except MotionError:
                pass  # the sheets say why there is no such cam
    if out is None:
        raise InputError("--animate", _("there is no folder to write into"), _("name one with --out"))


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
    parts: Parts,
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
    parts.write(folder, figures=figures, dark=dark)
    scalars = {
        name: scalar for sheet in sheets for name, scalar in sheet.scalars.items()
    } | parts.results.scalars
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
