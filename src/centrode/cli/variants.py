"""`centrode variants`: every row of a table on one topology, a folder each."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

import centrode as ct
from centrode import render
from centrode.cli import library, output
from centrode.cli.arguments import asked_cluster, scheduler_option, workers_option
from centrode.cli.progress import Progress
from centrode.cli.tables import asked_spelling, tables_options
from centrode.errors import InputError, MotionError
from centrode.locale import _, mark

if TYPE_CHECKING:
    from centrode.model.settings import Display
    from centrode.sheets.sheet import Sheet


@click.command(help=mark("Compute every variant of a table."))
@click.argument("table", metavar=mark("TABLE"), help=mark("A CSV file with one row per variant."))
@click.option(
    "--topology",
    required=True,
    metavar=mark("FILE_OR_EXAMPLE"),
    help=mark("The mechanism, gear pair or train whose numbers the table varies."),
)
@click.option(
    "--out",
    type=click.Path(path_type=Path),
    metavar=mark("DIR"),
    help=mark("Folder for the results (an interrupted run is resumed); named after the table by default."),
)
@click.option("--jobs", type=int, default=1, metavar=mark("N"), help=mark("Number of parallel processes."))
@click.option(
    "--compute",
    metavar=mark("NAME"),
    help=mark(
        "Also simulate, steady_motion, flywheel or reactions of every variant: extremes in the summary, tables and "
        "pictures in its folder."
    ),
)
@click.option("--figures", is_flag=True, help=mark("Draw pictures of every variant."))
@click.option(
    "--report",
    "reports",
    is_flag=True,
    help=mark("Also write a report of every variant, and a sheet of all answers."),
)
@click.option(
    "--format",
    "formats",
    metavar=mark("KINDS"),
    help=mark("With --report: kinds of documents, separated by commas; html,pdf by default."),
)
@workers_option
@scheduler_option
@tables_options
def variants(
    table: str,
    topology: str,
    out: Path | None,
    jobs: int,
    compute: str | None,
    figures: bool,
    reports: bool,
    formats: str | None,
    workers: int | None,
    scheduler: str | None,
) -> None:
    """Compute and write; exit code 3 if a variant was refused (the others are written)."""
    if formats is not None and not reports:
        raise InputError("--format", _("this option is used with --report only"), _("give that option too"))
    kinds = tuple(part.strip() for part in (formats or "html,pdf").split(",") if part.strip())
    cluster = asked_cluster(workers, scheduler)
    spelling = asked_spelling()
    described = library.load_description(topology)
    if isinstance(described, ct.GearPair | ct.GearTrain):
        _refuse_for_gears(jobs=jobs, compute=compute, cluster=cluster)
        _gear_variants(
            described, table, output.folder_of(out, table, "variants"), figures, kinds if reports else ()
        )
        return
    description = library.load(topology)
    folder = output.folder_of(out, table, "variants")
    try:
        with Progress() as progress:

            def tell(done: int, of: int) -> None:
                progress.say(_("computing variants"), done, of)

            if reports:
                found = library.write_variant_reports(
                    description,
                    table,
                    folder,
                    jobs,
                    figures,
                    formats=kinds,
                    progress=tell,
                    spelling=spelling,
                    compute=compute,
                    cluster=cluster,
                )
            else:
                found = ct.write_variants(
                    description,
                    table,
                    folder,
                    jobs=jobs,
                    figures=figures,
                    progress=tell,
                    spelling=spelling,
                    compute=compute,
                    cluster=cluster,
                )
    except KeyboardInterrupt:
        note = _("finished results stay in {folder}; the same command resumes from there")
        output.tell(note.format(folder=folder))
        raise
    written = ["summary.csv", *(f"answers.{kind}" for kind in dict.fromkeys(kinds) if reports)]
    _show(library.sheet_of(library.spoken_variants(found)), table, folder, written, description.display)


def _show(sheet: Sheet, table: str, folder: Path, written: Sequence[str], display: Display) -> None:
    """Print the table and what was written; MotionError where a variant was refused."""
    output.print_sheet(sheet, display)
    click.echo("\n".join(_("wrote {file}").format(file=folder / name) for name in written))
    if sheet.failure is not None:
        raise MotionError(table, render.plain_text(sheet.failure.what, display))


def _refuse_for_gears(*, jobs: int, compute: str | None, cluster: object) -> None:
    """Options that say nothing of gears."""
    given = {
        "--jobs": jobs != 1, "--compute": compute is not None, "--workers": cluster is not None
    }  # fmt: skip
    for option, is_given in given.items():
        if is_given:
            raise InputError(option, _("this option is for variants of mechanisms"), _("remove it"))


def _gear_variants(
    described: ct.GearPair | ct.GearTrain, table: str, folder: Path, figures: bool, formats: tuple[str, ...]
) -> None:
    """Variants of a gear pair or of a train."""
    with Progress() as progress:

        def tell(done: int, of: int) -> None:
            progress.say(_("computing variants"), done, of)

        found = library.write_gear_variants(
            described, table, folder, figures, formats, tell, asked_spelling()
        )
    _show(library.sheet_of(found), table, folder, ("summary.csv",), described.display)
