"""`centrode run`: the motion of a mechanism as tables, pictures and a summary."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING

import click

import centrode as ct
from centrode import render
from centrode.cli import output
from centrode.cli.about import about
from centrode.cli.announcements import announce_size
from centrode.cli.arguments import (
    mechanism_argument,
    no_figures_option,
    range_option,
    results_option,
    samples_option,
    start_option,
    stop_option,
)
from centrode.cli.progress import Progress
from centrode.cli.tables import tables_options
from centrode.cli.topic_command import write_sheet
from centrode.errors import MotionError
from centrode.locale import _, mark
from centrode.topics.presentation import sheet_of
from centrode.topics.topic import Lazily

if TYPE_CHECKING:
    from centrode.study.run import StudyResults

GREATEST = Lazily("centrode.views.reactions", "greatest_joint_force")
"""The fact about reactions that a run prints among its own."""


@click.command(help=mark("Compute the motion of a mechanism: tables and pictures."))
@mechanism_argument
@results_option
@tables_options
@samples_option
@start_option
@stop_option
@range_option
@click.option("--animate", is_flag=True, help=mark("Also write an animation of the motion."))
@no_figures_option
def run(
    mechanism: str,
    out: Path | None,
    samples: int | None,
    start: str | None,
    stop: str | None,
    ranged: str | None,
    animate: bool,
    no_figures: bool,
) -> None:
    """Compute and write; exit code 3 if the mechanism locks in the range asked for (the rest is written)."""
    description = ct.load(mechanism)
    announce_size(description, samples)
    description = ct.with_range(description, ranged)
    folder = output.folder_of(out, mechanism, "result")
    with output.output_folder(folder) as draft, Progress() as progress:
        progress.say(_("solving"))
        first = None if start is None else ct.range_value(description, start, "--from")
        last = None if stop is None else ct.range_value(description, stop, "--to")
        with about(mechanism):
            study = ct.study(description, samples, first, last)
        write(study, draft, progress, figures=not no_figures)
        if animate:
            with about(mechanism):
                _animate(study, draft, progress)
        names = output.finish_folder(draft)
    click.echo(summary_text(study, mechanism))
    click.echo("\n" + output.files_in(folder, names))
    if study.failure is not None:
        raise MotionError(mechanism, study.failure, ct.repair_of_range(description))


def write(study: StudyResults, folder: Path, progress: Progress, *, figures: bool) -> None:
    """Write everything about a study into a folder."""
    mechanism = study.mechanism
    progress.say(_("writing tables"))
    ct.write_motion_csv(study.motion, folder / "motion.csv", mechanism.display, mechanism.moving_points)
    if study.instants is not None:
        ct.write_motion_csv(
            study.instants, folder / "instants.csv", mechanism.display, mechanism.moving_points
        )
    ct.write_motion_netcdf(study.motion, folder / "motion.nc")
    if study.coefficients is not None:
        ct.write_coefficients_csv(
            study.coefficients, folder / "coefficients.csv", mechanism.display, mechanism.moving_points
        )
        ct.write_motion_netcdf(study.coefficients, folder / "coefficients.nc")
    for result in study.results.values():
        write_sheet(sheet_of(result), folder, mechanism.display, progress, figures=figures)
    scalars = {name: scalar.as_dict() for name, scalar in study.scalars.items()}
    text = json.dumps(scalars, indent=2, allow_nan=False) + "\n"
    (folder / "summary.json").write_text(text, encoding="utf-8")
    if figures:
        progress.say(_("drawing"))
        drawn = ct.motion_figures(mechanism, study.motion, mechanism.study.instants, study.instants)
        for number, (name, figure) in enumerate(drawn.items(), start=1):
            progress.say(_("drawing {name}").format(name=name), number, len(drawn))
            ct.save_figures({name: figure}, folder)


def _animate(study: StudyResults, folder: Path, progress: Progress) -> None:
    """Write the motion's animation into a folder."""

    def said(done: int, of: int) -> None:
        progress.say(_("drawing {name}").format(name="motion.gif"), done, of)

    ct.animate_motion(study.mechanism, study.motion, folder / "motion.gif", said=said)


def summary_text(study: StudyResults, name: str) -> str:
    """What a run prints: structure, range, limits, change points, statuses, worst residual, notes."""
    rows = [*ct.check_rows(study.check), *ct.motion_rows(study)]
    if study.reactions is not None:
        rows += render.fact_rows(GREATEST(study.reactions), study.mechanism.display)
    lines = [_(study.mechanism.title) or name, "", render.aligned(rows)]
    if study.machine is not None:
        facts = sheet_of(study.machine).facts
        lines += ["", render.facts_text(facts, study.mechanism.display)]
    lines += [_("note: {note}").format(note=note) for note in study.notes]
    return "\n".join(lines)
