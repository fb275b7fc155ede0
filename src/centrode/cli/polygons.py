"""`centrode polygons`: reactions of chosen instants by force polygons and Zhukovsky's lever."""

from __future__ import annotations

from pathlib import Path

import click

import centrode as ct
from centrode import render
from centrode.cli import output
from centrode.cli.about import about
from centrode.cli.arguments import dark_option, mechanism_argument, no_figures_option, results_option
from centrode.cli.progress import Progress
from centrode.cli.tables import tables_options
from centrode.errors import InputError
from centrode.locale import _, mark

MOST_INSTANTS = 100


@click.command(help=mark("Find reactions and the balancing moment by force polygons."))
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
    "--paper",
    default="A4",
    metavar=mark("SIZE"),
    help=mark("Sheet that scales are chosen for: A5, A4 (if left out) or A3."),
)
@dark_option
@results_option
@tables_options
@no_figures_option
def polygons(
    mechanism: str, instants: tuple[str, ...], paper: str, dark: bool, out: Path | None, no_figures: bool
) -> None:
    """Solve, compare and draw."""
    description = ct.load(mechanism)
    folder = output.folder_of(out, mechanism, "polygons")
    if len(instants) > MOST_INSTANTS:
        raise InputError(
            "--at",
            _("{count} instants were asked for").format(count=len(instants)),
            _("ask for at most {most}").format(most=MOST_INSTANTS),
        )
    texts = [_(description.title) or mechanism]
    with output.output_folder(folder) as draft, Progress() as progress:
        for count, text in enumerate(instants, start=1):
            progress.say(_("drawing"), count, len(instants))
            with about(mechanism):
                at = ct.range_value(description, text, "--at")
                found = ct.force_polygons(description, at, paper)
            suffix = f"-{count}" if len(instants) > 1 else ""
            (draft / f"polygons{suffix}.csv").write_text(ct.polygon_csv(found), encoding="utf-8")
            if not no_figures:
                figures = ct.polygon_figures(found)
                named = {f"{name}{suffix}": figure for name, figure in figures.items()}
                shown = {name: ct.darkened(figure) for name, figure in named.items()} if dark else named
                ct.save_figures(shown, draft)
            texts += ["", _("at {value}").format(value=text), report(found)]
        names = output.finished(draft)
    click.echo("\n".join(texts))
    click.echo("\n" + output.files_in(folder, names))


def report(found: ct.ForcePolygons) -> str:
    """What is printed of one instant."""
    return "\n".join(
        [
            render.aligned(ct.polygon_about(found)),
            "",
            *ct.polygon_steps(found),
            "",
            render.aligned(ct.polygon_rows(found), right=(2, 3, 4, 5)),
            "",
            render.aligned(ct.polygon_balance_rows(found), right=(2, 3, 4, 5)),
        ]
    )
