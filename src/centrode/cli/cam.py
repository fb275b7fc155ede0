"""`centrode cam`: a cam from the curvature of its roller's path."""

from __future__ import annotations

import json
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

import click

import centrode as ct
from centrode.cli import output
from centrode.cli.about import about
from centrode.cli.arguments import dark_option, no_figures_option, samples_option, written_option
from centrode.cli.progress import Progress
from centrode.errors import MotionError
from centrode.locale import _, mark

if TYPE_CHECKING:
    from centrode.study.cam_results import CamResults
    from centrode.study.cam_said import CamPart

_DXF = find_spec("ezdxf") is not None


@click.command(help=mark("Compute a cam from the curvature of its roller's path."))
@click.argument(
    "cam", metavar=mark("FILE_OR_EXAMPLE"), help=mark("A TOML file, or the name of a built-in cam.")
)
@written_option
@samples_option
@click.option(
    "--terms",
    type=int,
    metavar=mark("N"),
    help=mark("Cut the power series after a_N; the description's own number, else 20."),
)
@click.option("--groove", is_flag=True, help=mark("Also the outer wall of a groove that the roller runs in."))
@no_figures_option
@dark_option
def cam(
    cam: str,
    out: Path | None,
    samples: int | None,
    terms: int | None,
    groove: bool,
    no_figures: bool,
    dark: bool,
) -> None:
    """Print what is known of a cam, and write it where asked."""
    description = ct.load_cam(cam)
    names: list[str] = []
    with about(cam), Progress() as progress:
        progress.say(_("solving"))
        if out is None:
            results = ct.cam_results(description, samples, terms, groove=groove)
        else:
            with output.output_folder(out) as draft:
                results = ct.cam_results(description, samples, terms, groove=groove)
                _write(results, draft, progress, groove=groove, figures=not no_figures, dark=dark)
                names = sorted(path.name for path in draft.iterdir())
    click.echo(_(description.title) or cam)
    for part in results.parts.values():
        click.echo("\n" + _text(part))
    if out is not None:
        click.echo("\n" + output.files_in(out, names))
        if "body" in results.objects and not _DXF:
            click.echo(_('no DXF: it needs ezdxf, install it with pip install "centrode[drawings]"'))
    if results.failures:
        raise MotionError(cam, "; ".join(results.failures), _("end the range before that angle"))


def _text(part: CamPart) -> str:
    """A part as it is printed: heading, rows, tables."""
    text = f"{part.heading}\n\n{output.table(part.rows)}"
    for table in part.tables:
        numbers = range(len(table.header))
        text += f"\n\n{table.heading}\n\n{output.table(table.lines, table.header, numbers)}"
    return text


def _write(
    results: CamResults, folder: Path, progress: Progress, *, groove: bool, figures: bool, dark: bool
) -> None:
    """Write tables, numbers and figures into a folder."""
    progress.say(_("writing tables"))
    datasets = {name: data for part in results.parts.values() for name, data in part.datasets.items()}
    ct.write_cam_tables(results.cam, datasets, folder)
    for name, data in datasets.items():
        ct.write_motion_netcdf(data, folder / f"{name}.nc")
    ct.write_cam_outlines(results.cam, results.objects, folder, groove=groove, dxf=_DXF)
    scalars = {name: one.as_dict() for name, one in results.scalars.items()}
    text = json.dumps(scalars, indent=2, allow_nan=False) + "\n"
    (folder / "summary.json").write_text(text, encoding="utf-8")
    if figures:
        progress.say(_("drawing"))
        drawn = ct.cam_figures(results.cam, datasets)
        drawn |= ct.cam_body_figures(results.cam, results.objects, groove=groove)
        for number, (name, figure) in enumerate(drawn.items(), start=1):
            progress.say(_("drawing {name}").format(name=name), number, len(drawn))
            ct.save_figures({name: ct.darkened(figure) if dark else figure}, folder)
