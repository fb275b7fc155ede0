"""`centrode diagrams`: velocities and accelerations of chosen instants as on a drawing board."""

from __future__ import annotations

from pathlib import Path

import click

import centrode as ct
from centrode import render
from centrode.cli import output
from centrode.cli.about import about
from centrode.cli.arguments import dark_option, mechanism_argument, no_figures_option, results_option
from centrode.cli.pairs import pairs
from centrode.cli.progress import Progress
from centrode.cli.tables import tables_options
from centrode.errors import InputError
from centrode.locale import _, mark

MOST_INSTANTS = 100
SCALE = "length=0.02"
"""A scale as it is written."""


@click.command(help=mark("Check velocities and accelerations by drawing them."))
@mechanism_argument
@click.option(
    "--at",
    "instants",
    multiple=True,
    required=True,
    metavar=mark("VALUE"),
    help=mark('Value of the drive ("pi/2 rad"), or a time ("1 s"); as often as needed.'),
)
@click.option(
    "--angle-step",
    metavar=mark("ANGLE"),
    help=mark('Read directions to this ("1 deg"); exactly if left out.'),
)
@click.option(
    "--length-step",
    metavar=mark("LENGTH"),
    help=mark('Read lengths on paper to this ("0.5 mm"); exactly if left out.'),
)
@click.option(
    "--scale",
    "scales",
    multiple=True,
    metavar=mark("NAME=VALUE"),
    help=mark('What a millimetre stands for in SI: length, velocity or acceleration ("length=0.02").'),
)
@dark_option
@results_option
@tables_options
@no_figures_option
def diagrams(
    mechanism: str,
    instants: tuple[str, ...],
    angle_step: str | None,
    length_step: str | None,
    scales: tuple[str, ...],
    dark: bool,
    out: Path | None,
    no_figures: bool,
) -> None:
    """Construct, compare and draw."""
    description = ct.load(mechanism)
    folder = output.folder_of(out, mechanism, "diagrams")
    if len(instants) > MOST_INSTANTS:
        raise InputError(
            "--at",
            _("{count} instants were asked for").format(count=len(instants)),
            _("ask for at most {most}").format(most=MOST_INSTANTS),
        )
    given = {name: number(value) for name, value in pairs(scales, "--scale", SCALE).items()}
    texts = [_(description.title) or mechanism]
    with output.output_folder(folder) as draft, Progress() as progress:
        for count, text in enumerate(instants, start=1):
            progress.say(_("drawing"), count, len(instants))
            with about(mechanism):
                at = ct.range_value(description, text, "--at")
                check = ct.graphic_check(description, at, angle_step, length_step, given)
            suffix = f"-{count}" if len(instants) > 1 else ""
            (draft / f"check{suffix}.csv").write_text(ct.graphic_csv(check), encoding="utf-8")
            if not no_figures:
                figures = ct.diagram_figures(check.diagrams)
                named = {f"{name}{suffix}": figure for name, figure in figures.items()}
                shown = {name: ct.darkened(figure) for name, figure in named.items()} if dark else named
                ct.save_figures(shown, draft)
            texts += ["", _("at {value}").format(value=text), report(check)]
        names = output.finished(draft)
    click.echo("\n".join(texts))
    click.echo("\n" + output.files_in(folder, names))


def number(text: str) -> float:
    """A plain number; InputError for another text."""
    try:
        return float(text)
    except ValueError:
        what = _("expected a number, got {text}").format(text=f'"{text}"')
        raise InputError("--scale", what, _("write {sample}").format(sample=f'"{SCALE}"')) from None


def report(check: ct.GraphicCheck) -> str:
    """What is printed of one instant."""
    table = render.aligned(ct.graphic_rows(check), right=(2, 3, 4, 5))
    return "\n".join([render.aligned(ct.graphic_about(check)), *ct.graphic_steps(check), "", table])
