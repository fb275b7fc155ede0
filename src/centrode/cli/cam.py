"""`centrode cam`: a cam from the curvature of its roller's path."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

import click

import centrode as ct
from centrode import render
from centrode.cli import output
from centrode.cli.about import about
from centrode.cli.announcements import announce_samples
from centrode.cli.arguments import dark_option, no_figures_option, samples_option, written_option
from centrode.cli.progress import Progress
from centrode.cli.tables import asked_spelling, tables_options
from centrode.errors import InputError, MotionError
from centrode.locale import _, mark
from centrode.topics.sheets import sheets_of_cam

if TYPE_CHECKING:
    from centrode.sheets.sheet import Sheet
    from centrode.study.cams.parts import CamPart
    from centrode.study.cams.results import CamResults

_DXF = find_spec("ezdxf") is not None


@click.command(help=mark("Compute a cam by a curvature law or its follower's lift."))
@click.argument(
    "cam", metavar=mark("FILE_OR_EXAMPLE"), help=mark("A TOML file, or the name of a built-in cam.")
)
@written_option
@tables_options
@samples_option
@click.option(
    "--terms",
    type=int,
    metavar=mark("N"),
    help=mark("Cut the power series after a_N; the description's own number, else 20."),
)
@click.option("--groove", is_flag=True, help=mark("Also the outer wall of a groove that the roller runs in."))
@click.option(
    "--laws", is_flag=True, help=mark("Also other laws of motion for the first rise of the follower.")
)
@click.option(
    "--animate",
    is_flag=True,
    help=mark("Also write an animation: a walking wheel makes a step, a cam turns under its follower."),
)
@no_figures_option
@dark_option
def cam(
    cam: str,
    out: Path | None,
    samples: int | None,
    terms: int | None,
    groove: bool,
    laws: bool,
    animate: bool,
    no_figures: bool,
    dark: bool,
) -> None:
    """Print what is known of a cam, and write it where asked."""
    description = ct.load_cam(cam)
    names: list[str] = []
    _check_options(description, {"--terms": terms is not None, "--groove": groove}, {"--laws": laws})
    _check_animation(description, out, animate)
    announce_samples(samples or 0)
    with about(cam), Progress() as progress:
        progress.say(_("solving"))
        sheets = list(sheets_of_cam(description, samples, ["laws"] if laws else []).values())
        if out is None:
            results = ct.cam_results(description, samples, terms, groove=groove)
        else:
            with output.output_folder(out) as draft:
                results = ct.cam_results(description, samples, terms, groove=groove, front=True)
                _write(results, sheets, draft, progress, groove=groove, figures=not no_figures, dark=dark)
                if animate:
                    _animate(results, draft, progress, dark=dark)
                names = output.finish_folder(draft)
    click.echo(_(description.title) or cam)
    for sheet in sheets:
        click.echo("\n" + render.sheet_text(sheet, description.display))
    for part in results.parts.values():
        click.echo("\n" + _text(part))
    if out is not None:
        click.echo("\n" + output.files_in(out, names))
        if {"body", "plate"} & results.objects.keys() and not _DXF:
            click.echo(_('no DXF: it needs ezdxf, install it with pip install "centrode[drawings]"'))
    if results.failures:
        raise MotionError(cam, "; ".join(results.failures))


def _check_options(
    cam: ct.Cam | ct.PlateCam, of_curvature: Mapping[str, bool], of_lift: Mapping[str, bool]
) -> None:
    """Options that mean nothing for this cam."""
    plate = isinstance(cam, ct.PlateCam)
    what = _("this cam is given by a curvature law and has no follower's lift")
    if plate:
        what = _("this cam is given by its follower's lift and has no curvature law")
    for name, given in (of_curvature if plate else of_lift).items():
        if given:
            raise InputError(name, what, _("leave it out"))


def _check_animation(cam: ct.Cam | ct.PlateCam, out: Path | None, animate: bool) -> None:
    """An animation needs a cam with its roller or its follower, and a folder."""
    if animate and isinstance(cam, ct.Cam) and cam.roller is None:
        raise InputError("--animate", _("a profile needs a roller"), _("give [roller] radius"))
    if animate and out is None:
        raise InputError("--animate", _("there is no folder to write into"), _("name one with --out"))


def _text(part: CamPart) -> str:
    """A part as it is printed: heading, rows, tables."""
    text = f"{part.heading}\n\n{render.aligned(part.rows)}"
    for table in part.tables:
        numbers = range(1 if table.named else 0, len(table.header))
        text += f"\n\n{table.heading}\n\n{render.aligned(table.lines, table.header, numbers)}"
    return text


def _write(
    results: CamResults,
    sheets: Sequence[Sheet],
    folder: Path,
    progress: Progress,
    *,
    groove: bool,
    figures: bool,
    dark: bool,
) -> None:
    """Write tables, numbers and figures into a folder."""
    progress.say(_("writing tables"))
    display = results.cam.display
    for sheet in sheets:
        render.write_tables(sheet, folder, display, asked_spelling())
    datasets = {name: data for part in results.parts.values() for name, data in part.datasets.items()}
    ct.write_cam_tables(results.cam, datasets, folder)
    for name, data in datasets.items():
        ct.write_motion_netcdf(data, folder / f"{name}.nc")
    if "choice" in results.objects:
        ct.write_choice(results.objects["choice"], folder)
    ct.write_cam_outlines(results.cam, results.objects, folder, groove=groove, dxf=_DXF)
    scalars = {name: one for sheet in sheets for name, one in sheet.scalars.items()} | results.scalars
    render.write_summary(scalars, folder / "summary.json")
    if figures:
        progress.say(_("drawing"))
        drawn = {
            name: one for sheet in sheets for name, one in render.figures_of(sheet.pictures, display).items()
        }
        drawn |= ct.cam_figures(results.cam, datasets)
        drawn |= ct.cam_body_figures(results.cam, results.objects, groove=groove)
        if "choice" in results.objects:
            drawn |= ct.choice_figures(results.objects["choice"])
        for number, (name, figure) in enumerate(drawn.items(), start=1):
            progress.say(_("drawing {name}").format(name=name), number, len(drawn))
            ct.save_figures({name: ct.darkened(figure) if dark else figure}, folder)


def _animate(results: CamResults, folder: Path, progress: Progress, *, dark: bool) -> None:
    """Write the walking wheel's step, or a turn of the cam under its roller or its follower, into a folder."""
    objects, cam = results.objects, results.cam
    name = "walking-wheel.gif" if "wheel" in objects else "cam.gif"

    def said(done: int, of: int) -> None:
        progress.say(_("drawing {name}").format(name=name), done, of)

    title, display = _(cam.title), cam.display
    if "wheel" in objects:
        ct.animate_walking(objects["wheel"], folder / name, title, display, dark=dark, said=said)
    elif "plate" in objects:
        ct.animate_follower(objects["plate"], folder / name, title, display, dark=dark, said=said)
    elif "body" in objects and isinstance(cam, ct.Cam) and cam.mover is None:
        ct.animate_cam_body(objects["body"], folder / name, title, display, dark=dark, said=said)
    elif isinstance(cam, ct.PlateCam) and not results.failures:
        what = _("the cam has no size: neither base_radius nor bounds are given")
        raise InputError("--animate", what, _("give one of them, or leave it out"))
