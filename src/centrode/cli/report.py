"""`centrode report`: everything about a mechanism as one document."""

from __future__ import annotations

import functools
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import click
import lazy_loader

import centrode as ct
from centrode import render
from centrode.cli import library, output
from centrode.cli.about import about
from centrode.cli.instants import echo_values
from centrode.cli.progress import Progress
from centrode.errors import InputError, MotionError
from centrode.locale import _, mark, ngettext
from centrode.model.page_standards import STANDARDS

if TYPE_CHECKING:
    from centrode.model.page_standards import Standard
    from centrode.render.document.blocks import Report

# What they import is too much for a list of commands.
_options, _writing, _outline = (
    functools.partial(lazy_loader.load, f"centrode.{name}", suppress_warning=True)
    for name in ("report.study", "report.files", "render.document.outline")
)


@click.command(help=mark("Write all about a mechanism, a cam or gears as a document."))
@click.argument(
    "description",
    metavar=mark("FILE_OR_EXAMPLE"),
    help=mark("A TOML file, or the name of a built-in mechanism, cam, pair or train of gears."),
)
@click.option(
    "--out",
    type=click.Path(path_type=Path),
    metavar=mark("DIR"),
    help=mark("Folder for the documents, or one document (note.docx); by default named after the mechanism."),
)
@click.option(
    "--format",
    "formats",
    metavar=mark("KINDS"),
    help=mark("Kinds of documents, separated by commas: html, pdf, docx, tex, ipynb; html,pdf by default."),
)
@click.option(
    "--chapters",
    metavar=mark("NAMES"),
    help=mark("Chapters, separated by commas; all that apply by default."),
)
@click.option(
    "--at",
    "instants",
    multiple=True,
    metavar=mark("A"),
    help=mark(
        'A value of the drive ("99.1 deg"), or time ("1 s"), that tables and diagrams show; may be repeated.'
    ),
)
@click.option(
    "--points",
    metavar=mark("NAMES"),
    help=mark("Points whose velocities and paths are reported, separated by commas."),
)
@click.option("--digits", type=int, metavar=mark("N"), help=mark("Significant digits of numbers."))
@click.option(
    "--full/--compact",
    "full",
    default=None,
    help=mark(
        "The full or the compact form; by default as [report] has it, and full if chapters are chosen."
    ),
)
@click.option(
    "--motion",
    type=click.Choice(("real", "mean")),
    help=mark(
        "Forces at the real speed and acceleration of a machine, or at its mean speed; by default as [report] has it, "
        "and real where it can be computed."
    ),
)
@click.option(
    "--standard",
    type=click.Choice(STANDARDS),
    help=mark("Page style: GOST 2.105, DSTU 3008 or plain; of a note by default that of the language."),
)
@click.option("--rows", type=int, metavar=mark("N"), help=mark("Rows of a table over the motion, at most."))
@click.option("--positions", type=int, metavar=mark("N"), help=mark("Positions in the plan of positions."))
@click.option(
    "--rk4-steps",
    type=int,
    metavar=mark("N"),
    help=mark("Also integrate by N fixed Runge-Kutta steps: their rows and their errors."),
)
@click.option(
    "--angle-step",
    metavar=mark("ANGLE"),
    help=mark('Reading step of directions in the graph-analytic check ("1 deg"); exact by default.'),
)
@click.option(
    "--least-transmission-angle",
    metavar=mark("ANGLE"),
    help=mark(
        "Least transmission angle of every dyad; by default 20 deg, or less where that is out of reach."
    ),
)
@click.option(
    "--greatest-change",
    type=float,
    metavar=mark("SHARE"),
    help=mark("Greatest change of a length over itself, or of a coordinate over the greatest length (0.3)."),
)
def report(
    description: str,
    out: Path | None,
    formats: str | None,
    chapters: str | None,
    instants: tuple[str, ...],
    points: str | None,
    digits: int | None,
    full: bool | None,
    motion: Literal["real", "mean"] | None,
    standard: Standard | None,
    rows: int | None,
    positions: int | None,
    rk4_steps: int | None,
    angle_step: str | None,
    least_transmission_angle: str | None,
    greatest_change: float | None,
) -> None:
    """Write the documents; exit code 3 where a chapter could not be made (the others are there)."""
    described = library.reported_subject(description)
    folder, name, kinds = _place(out, description, formats)
    _writing().check_formats(kinds)
    with about(description):
        places = tuple(_options().instant(described, text, "--at") for text in instants)
        options = ct.ReportOptions(
            None if chapters is None else _names_in(chapters),
            places or None,
            None if points is None else _names_in(points),
            digits,
            full,
            motion,
            standard,
            rows,
            positions,
            rk4_steps,
            angle_step,
            least_transmission_angle,
            greatest_change,
        )
    if isinstance(described, ct.Mechanism):
        echo_values(described, *(("--at", place) for place in places))
    with output.output_folder(folder) as draft, Progress() as progress:
        with about(description):
            made = ct.report(described, options, name=Path(description).stem, said=progress.say)
        ct.write_report(
            made, draft, kinds, name, lambda file: progress.say(_("writing {file}").format(file=file))
        )
        names = output.file_names(draft)
    click.echo(_summary(made))
    click.echo("\n" + output.files_in(folder, names))
    _told(made, description)


def _place(out: Path | None, description: str, formats: str | None) -> tuple[Path, str, tuple[str, ...]]:
    """The folder of the documents, their name and their kinds; `--out note.docx` names all three."""
    kinds = None if formats is None else _names_in(formats)
    ending = "" if out is None or out.is_dir() else out.suffix.removeprefix(".")
    if out is None or ending not in _writing().FORMATS:
        chosen = _writing().DEFAULT_FORMATS if kinds is None else kinds
        return output.folder_of(out, description, "report"), "report", chosen
    if kinds is not None and kinds != (ending,):
        what = _("the ending of {file} names another kind of document").format(file=out.name)
        raise InputError("--format", what, _("leave one of them out"))
    return out.parent, out.stem, (ending,)


def _names_in(text: str) -> tuple[str, ...]:
    return tuple(part.strip() for part in text.split(",") if part.strip())


def _summary(made: Report) -> str:
    """Title, and chapters with their numbers."""
    chapters = [
        (heading.number, heading.title)
        for chapter in _outline().outline_of(made)
        for heading in chapter.headings
    ]
    return f"{made.title}\n\n{render.aligned_text(chapters)}"


def _told(made: Report, description: str) -> None:
    """Chapters that could not be made, as the failure that the command ends with."""
    missing = [chapter for chapter in made.chapters if chapter.missing]
    if missing:
        what = ngettext(
            "{n} chapter could not be made: {reasons}",
            "{n} chapters could not be made: {reasons}",
            len(missing),
        )
        reasons = "\n".join(f"{chapter.title}: {chapter.missing}" for chapter in missing)
        raise MotionError(description, what.format(n=len(missing), reasons=reasons))
