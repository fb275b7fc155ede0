"""`centrode sheets`: drawings of a mechanism on sheets A1 with frame and main inscription, at standard scales."""

from __future__ import annotations

from pathlib import Path

import click

import centrode as ct
from centrode.cli import library, output
from centrode.cli.about import about
from centrode.cli.arguments import results_option
from centrode.cli.instants import echo_values
from centrode.errors import InputError, MotionError
from centrode.locale import _, mark, ngettext

FORMATS = ("pdf", "dxf")


@click.command(help=mark("Draw a mechanism, a cam or gears on sheets A1."))
@click.argument(
    "mechanism",
    metavar=mark("FILE_OR_EXAMPLE"),
    help=mark("A TOML file, or the name of a built-in mechanism or cam."),
)
@results_option
@click.option(
    "--format",
    "formats",
    default="pdf,dxf",
    metavar=mark("KINDS"),
    help=mark("Kinds of files, separated by commas: pdf, dxf; both by default."),
)
@click.option(
    "--at",
    "instants",
    multiple=True,
    metavar=mark("VALUE"),
    help=mark(
        "Value of the drive, or time, at which plans of velocities, accelerations and forces are drawn; "
        "may be repeated."
    ),
)
@click.option(
    "--scale",
    metavar=mark("RATIO"),
    help=mark(
        "Scale of the plan of positions or of the cam (1:5); the largest standard one that fits by default."
    ),
)
@click.option(
    "--positions", type=int, default=12, metavar=mark("N"), help=mark("Number of positions; 12 by default.")
)
@click.option(
    "--link",
    metavar=mark("NAME"),
    help=mark("Link or guide whose motion is plotted, at rest in position 0; a slider or rocker by default."),
)
def sheets(
    mechanism: str,
    out: Path | None,
    formats: str,
    instants: tuple[str, ...],
    scale: str | None,
    positions: int,
    link: str | None,
) -> None:
    """Write the sheets; exit code 3 where one that is described could not be made (the others are there)."""
    kinds = tuple(part.strip() for part in formats.split(",") if part.strip())
    for kind in kinds:
        if kind not in FORMATS:
            what = _("a sheet cannot be written as {ending}").format(ending=f'"{kind}"')
            raise InputError("--format", what, _("use one of {known}").format(known=", ".join(FORMATS)))
    wanted = None if scale is None else library.read_scale(scale, "--scale")
    description = library.load_drawn(mechanism)
    with about(mechanism):
        places: list[float] = []
        if isinstance(description, ct.Mechanism):
            places = description.motion_parameter.instant.read_all(instants, "--at")
            echo_values(description, *(("--at", place) for place in places))
        else:
            _refuse_for_cams(instants, link)
        made = library.drawing_sheets(description, instants=places, positions=positions, link=link)
    with output.output_folder(output.folder_of(out, mechanism, "sheets")) as draft:
        library.write_drawing_set(made, draft, kinds, wanted)
        names = output.file_names(draft)
    click.echo(output.files_in(output.folder_of(out, mechanism, "sheets"), names))
    if made.absent:
        output.tell(made.absent)
    if made.missing:
        what = ngettext(
            "{n} drawing could not be made: {reasons}",
            "{n} drawings could not be made: {reasons}",
            len(made.missing),
        )
        raise MotionError(mechanism, what.format(n=len(made.missing), reasons="\n".join(made.missing)))


def _refuse_for_cams(instants: tuple[str, ...], link: str | None) -> None:
    """Refuse options about linkages where a cam is drawn."""
    if instants:
        raise InputError("--at", _("the sheet of a cam has no plans of vectors"), _("omit it"))
    if link is not None:
        raise InputError("--link", _("the sheet of a cam shows the motion of its follower"), _("omit it"))
