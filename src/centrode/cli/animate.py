"""`centrode animate`: a mechanism or a cam in motion, as a GIF or an MP4."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

import centrode as ct
from centrode import render
from centrode.cli import library, output
from centrode.cli.about import about
from centrode.cli.arguments import dark_option, range_option, start_option, stop_option
from centrode.cli.instants import echo_values
from centrode.cli.progress import Progress
from centrode.errors import InputError, MotionError
from centrode.locale import _, mark, ngettext
from centrode.topics.option_values import READ_PAIRS_OF_BODIES

if TYPE_CHECKING:
    from centrode.animation.animate import Shown
    from centrode.animation.video_files import Animation

ENDINGS = (".gif", ".mp4")
SIZE = "800x600"


@click.command(help=mark("Animate a mechanism or a cam: GIF or MP4."))
@click.argument(
    "described",
    metavar=mark("FILE_OR_EXAMPLE"),
    help=mark("A TOML file, or the name of a built-in mechanism or cam."),
)
@click.option(
    "--out",
    type=click.Path(path_type=Path),
    metavar=mark("FILE"),
    help=mark("FILE.gif or FILE.mp4; a GIF named after the mechanism by default."),
)
@click.option(
    "--show",
    metavar=mark("NAMES"),
    help=mark(
        "Shown beside the links, separated by commas: paths, velocities, accelerations, centres, centrodes, "
        "forces, loads, or none; paths by default."
    ),
)
@click.option(
    "--points",
    metavar=mark("NAMES"),
    help=mark("Only these points, separated by commas; all moving points by default."),
)
@click.option("--growing", is_flag=True, help=mark("Paths grow behind their points."))
@click.option(
    "--pair",
    "pairs",
    multiple=True,
    metavar=mark("LINK,LINK"),
    help=mark('Instant centre of these two links ("AC,frame"); may be repeated.'),
)
@click.option("--link", metavar=mark("LINK"), help=mark("The link that carries the moving centrode."))
@click.option(
    "--against", metavar=mark("LINK"), help=mark("The link that it rolls on; the frame by default.")
)
@click.option("--size", metavar="WxH", help=mark("Width and height in pixels; 800x600 by default."))
@click.option("--frames", type=int, metavar=mark("N"), help=mark("Number of frames; 60 by default."))
@click.option("--fps", type=float, metavar=mark("N"), help=mark("Frames per second; 20 by default."))
@click.option("--duration", type=float, metavar=mark("S"), help=mark("Duration of one loop in seconds."))
@click.option(
    "--speed",
    type=float,
    metavar=mark("X"),
    help=mark("Speed of the animation as a multiple of the mechanism's own speed (instead of --duration)."),
)
@click.option(
    "--simulation", is_flag=True, help=mark("The motion that the simulation of the description computes.")
)
@start_option
@stop_option
@range_option
@dark_option
@click.option("--force", is_flag=True, help=mark("Replace FILE where it exists."))
def animate(
    described: str,
    out: Path | None,
    show: str | None,
    points: str | None,
    growing: bool,
    pairs: tuple[str, ...],
    link: str | None,
    against: str | None,
    size: str | None,
    frames: int | None,
    fps: float | None,
    duration: float | None,
    speed: float | None,
    simulation: bool,
    start: str | None,
    stop: str | None,
    ranged: str | None,
    dark: bool,
    force: bool,
) -> None:
    """Write the animation; exit code 3 if a range was asked for that is not all reached (the rest is written)."""
    description = _in_range(library.load_either(described), ranged)
    path = out if out is not None else Path(f"{Path(described).stem}.gif")
    if path.suffix.lower() not in ENDINGS:
        raise InputError("--out", _("an animation is a .gif or a .mp4"), _("name such a file"))
    shown = _shown(show, points, growing, pairs, link, against)
    pace = library.pace_of_frames(frames, fps, duration, speed)
    first, last = _end(description, start, "--from"), _end(description, stop, "--to")
    if isinstance(description, ct.Mechanism):
        echo_values(description, ("--from", first), ("--to", last))
    with output.output_file(path, force=force) as draft, Progress() as progress:
        progress.say(_("solving"))

        def said(done: int, of: int) -> None:
            progress.say(_("drawing {name}").format(name=path.name), done, of)

        with about(described):
            made = ct.animate(
                description,
                draft,
                shown,
                pace,
                start=first,
                stop=last,
                simulation=simulation,
                size=size or SIZE,
                dark=dark,
                said=said,
            )
    click.echo(_(description.title) or described)
    click.echo("\n" + render.aligned_text(_rows(made)))
    for note in made.notes:
        click.echo(_("note: {note}").format(note=note))
    click.echo("\n" + _("wrote {file}").format(file=path))
    if made.left_out and (start is not None or stop is not None):
        what = ngettext(
            "{n} sample of the range is not reached",
            "{n} samples of the range are not reached",
            made.left_out,
        )
        raise MotionError(
            described, what.format(n=made.left_out), _("choose a range between the limits of the drive")
        )


def _in_range(
    description: ct.Mechanism | ct.Cam | ct.PlateCam, ranged: str | None
) -> ct.Mechanism | ct.Cam | ct.PlateCam:
    """A linkage with the range asked for by a word."""
    if isinstance(description, ct.Mechanism):
        return description.with_range(ranged)
    if ranged is None:
        return description
    raise InputError(
        "--range", _("this option is for linkages; a cam always makes a full turn"), _("remove it")
    )


def _shown(
    show: str | None,
    points: str | None,
    growing: bool,
    pairs: tuple[str, ...],
    link: str | None,
    against: str | None,
) -> Shown | None:
    """What is shown; nothing where nothing is said, so that a cam can be asked for in the same words."""
    if show is None and points is None and not growing and not pairs and link is None and against is None:
        return None
    shown: Shown = library.shown_signs(
        ("paths",) if show is None else _names(show),
        None if points is None else _names(points),
        growing,
        READ_PAIRS_OF_BODIES(None, pairs, "--pair") or None,
        link,
        against or "frame",
    )
    return shown


def _names(text: str) -> tuple[str, ...]:
    """Names between commas; "none" names nothing."""
    names = [name.strip() for name in text.split(",")]
    return tuple(name for name in names if name and name != "none")


def _end(description: ct.Mechanism | ct.Cam | ct.PlateCam, text: str | None, where: str) -> float | None:
    """An end of the range."""
    if text is None:
        return None
    if isinstance(description, ct.Cam | ct.PlateCam):
        raise InputError(where, _("a cam is shown as a whole"), _("remove it"))
    return description.motion_parameter.instant.read(text, where)


def _rows(made: Animation) -> list[tuple[str, str]]:
    """Frames, size, time and loop."""
    words = {"round": _("round, without a jump"), "back": _("there and back"), "once": _("once, then anew")}
    loop = words[made.loop]
    rate = _("{rate:.4g} per second: {seconds:.4g} s").format(rate=made.per_second, seconds=made.seconds)
    return [
        (_("frames"), f"{made.frames}, {rate}"),
        (_("pixels"), "{} x {}".format(*made.size)),
        (_("loop"), loop),
    ]
