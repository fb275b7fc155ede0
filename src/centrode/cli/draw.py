"""`centrode draw`: a mechanism to scale in conventional signs, for the shop."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

import centrode as ct
from centrode.cli import library, output
from centrode.cli.about import about
from centrode.cli.arguments import mechanism_argument, range_option, samples_option, start_option, stop_option
from centrode.cli.instants import echo_values
from centrode.cli.progress import announce_size
from centrode.errors import InputError, MotionError, Status
from centrode.locale import _, mark
from centrode.quantities import spelled_unit
from centrode.topics.topic import Lazily

if TYPE_CHECKING:
    import xarray

PLACED = (Status.OK, Status.CUT_OFF, Status.SINGULAR)
"""Statuses of samples that have a position."""
REQUIRE_CENTRES = Lazily("centrode.analysis.instant_centres.results", "require_centres")
KINDS = {".dxf": library.write_drawing_dxf, ".svg": library.write_drawing_svg}


@click.command(help=mark("Draw a mechanism to scale in conventional signs."))
@mechanism_argument
@click.option(
    "--at",
    "instant",
    metavar=mark("VALUE"),
    help=mark("Value of the drive at which it is drawn; the initial value by default."),
)
@click.option(
    "--path",
    "paths",
    multiple=True,
    metavar=mark("NAME"),
    help=mark("A point whose path is drawn, or all; may be repeated."),
)
@click.option(
    "--centrodes",
    "links",
    multiple=True,
    metavar=mark("LINK"),
    help=mark("A link whose centrodes are drawn; may be repeated."),
)
@click.option(
    "--scale",
    default="1:1",
    metavar=mark("RATIO"),
    help=mark("Scale of the drawing, such as 1:5 or 2:1; 1:1 by default."),
)
@click.option("--no-names", is_flag=True, help=mark("Omit the names of the points."))
@samples_option
@start_option
@stop_option
@range_option
@click.option(
    "--out",
    required=True,
    type=click.Path(path_type=Path),
    metavar=mark("FILE"),
    help=mark("FILE.dxf or FILE.svg, in millimetres."),
)
@click.option("--force", is_flag=True, help=mark("Replace FILE where it exists."))
def draw(
    mechanism: str, instant: str | None, paths: tuple[str, ...], links: tuple[str, ...], scale: str, no_names: bool,
    samples: int | None, start: str | None, stop: str | None, ranged: str | None, out: Path, force: bool,
) -> None:  # fmt: skip
    """Write one drawing, whole or not at all."""
    kind = out.suffix.lower()
    if kind not in KINDS:
        what = _("a drawing cannot be written as {ending}").format(ending=f'"{out.suffix}"')
        raise InputError("--out", what, _("use one of {known}").format(known=", ".join(KINDS)))
    ratio = library.read_scale(scale, "--scale")
    description = library.load(mechanism)
    announce_size(description, samples)
    description = description.with_range(ranged)
    place = (
        library.initial_place(description)
        if instant is None
        else description.motion_parameter.instant.read(instant, "--at")
    )
    first = None if start is None else description.motion_parameter.instant.read(start, "--from")
    last = None if stop is None else description.motion_parameter.instant.read(stop, "--to")
    echo_values(description, ("--at", None if instant is None else place), ("--from", first), ("--to", last))
    with about(mechanism):
        course = ct.motion(description, samples, first, last)
        motion, sample = library.motion_among(description, course, place)
        rolled = [_centrodes(course, link) for link in links]
        drawing = library.mechanism_drawing(
            description,
            motion,
            sample,
            library.moving_points(description, paths, "--path"),
            rolled,
            not no_names,
            course,
            str if kind == ".dxf" else spelled_unit,
            ratio,
        )
    with output.output_file(out, force=force) as draft:
        KINDS[kind](drawing, draft)
    click.echo(_("wrote {file}").format(file=out))
    if Status(int(motion["status"][sample])) not in PLACED:
        raise MotionError(
            mechanism,
            _("the mechanism has no position at {place}").format(
                place=library.place_words(description, motion, sample)
            ),
            _("choose a value between the limits of the drive"),
        )


def _centrodes(course: xarray.Dataset, link: str) -> xarray.Dataset:
    """The centrodes of a link against the frame; MotionError where there are none."""
    found = ct.centrodes(course, link)
    REQUIRE_CENTRES(found)
    return found
