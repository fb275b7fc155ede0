"""`centrode sweep`: many mechanisms of one structure, from a file that says what varies."""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, TextIO, TypeAlias

import click

import centrode as ct
from centrode import render
from centrode.cli import library, output
from centrode.cli.about import about
from centrode.cli.arguments import asked_cluster, no_figures_option, scheduler_option, workers_option
from centrode.cli.progress import Progress
from centrode.cli.tables import asked_spelling, need_table, table_files, tables_options
from centrode.errors import ClusterWarning, DamageWarning, InputError, MotionError
from centrode.locale import _, mark, ngettext

if TYPE_CHECKING:
    import xarray as xr

    from centrode.sweeps.sweep import SweepStudy

TABLE, STORE = ".csv", ".zarr"
NOTES = (DamageWarning, ClusterWarning)
How: TypeAlias = Mapping[str, Any]
"""Arguments of `sweep` that say what computes."""


@click.command(help=mark("Compute many mechanisms of one structure, from a study."))
@click.argument("study", metavar=mark("STUDY"), help=mark("A TOML file: mechanism, what varies, outputs."))
@click.option(
    "--out",
    metavar=mark("OUT"),
    help=mark(
        "A folder .zarr or an address such as s3://BUCKET/NAME.zarr (an interrupted run is resumed), or a table .csv "
        "of a reduced sweep; of a parameter study a table .csv or a folder with table and figure."
    ),
)
@click.option(
    "--table",
    "values",
    type=click.Path(path_type=Path),
    metavar=mark("FILE"),
    help=mark("A CSV file of numbers at every sample, such as targets, that formulas of the study name."),
)
@no_figures_option
@tables_options
@click.option("--force", is_flag=True, help=mark("Replace the table where it exists."))
@workers_option
@scheduler_option
@click.option(
    "--target",
    metavar=mark("NAME"),
    help=mark(
        "The processor that machine code is compiled for: x86-64-v2, x86-64-v3, x86-64-v4 or aarch64. By default this "
        "machine's; with a cluster x86-64-v3 or aarch64."
    ),
)
def sweep(
    study: str,
    out: str | None,
    values: Path | None,
    no_figures: bool,
    force: bool,
    workers: int | None,
    scheduler: str | None,
    target: str | None,
) -> None:
    """Compute and write; exit code 3 if no mechanism moves anywhere (the results are written)."""
    asked = library.read_sweep(study)
    if values is not None:
        if asked.tables is not None:
            raise InputError(
                "--table", _("the study has tables of its own"), _("give them in one of the two places")
            )
        asked = replace(asked, tables=values)
    how = {"cluster": asked_cluster(workers, scheduler), "target": target}
    if asked.compute is not None:
        _parameter_study(
            asked, study, None if out is None else Path(out), how, figures=not no_figures, force=force
        )
        return
    place = out if out is not None else Path(study).stem + STORE
    need_table(Path(place))
    suffix = Path(place).suffix
    if suffix == TABLE and "://" not in place:
        data = _as_table(asked, study, Path(place), how, force)
        written = table_files(Path(place))
    elif suffix == STORE:
        data = _as_store(asked, study, place, how)
        written = [Path(place)]
    else:
        raise InputError(
            place, _("it is neither a .zarr nor a .csv"), _("name a folder x.zarr or a file x.csv")
        )
    _show(
        asked, study, data, _("wrote {file}").format(file=place) if "://" in place else output.wrote(written)
    )


def _show(asked: SweepStudy, study: str, data: xr.Dataset, written: str) -> None:
    """Print what a result says and what was written; MotionError where nothing moves."""
    sheet, display = library.sheet_of(data), asked.mechanism.display
    output.print_sheet(sheet, display)
    click.echo("\n" + written)
    if sheet.failure is not None:
        what, repair = (
            render.plain_text(text, display) for text in (sheet.failure.what, sheet.failure.repair)
        )
        raise MotionError(study, what, repair)


def _parameter_study(
    asked: SweepStudy, study: str, out: Path | None, how: How, *, figures: bool, force: bool
) -> None:
    """Analyse every mechanism; a table, or a folder with the table, the dataset and the figure."""
    if out is not None and out.suffix == TABLE:
        with output.output_table(out, force=force) as (draft, workbook):
            data = _compute(asked, study, None, how)
            (table,) = ct.tables(data).values()
            render.write_table(table, draft, asked.mechanism.display, asked_spelling(), workbook)
        _show(asked, study, data, output.wrote(table_files(out)))
        return
    folder = output.folder_of(out, study, "study")
    with output.output_folder(folder) as draft:
        data = _compute(asked, study, None, how)
        sheet = library.sheet_of(data)
        render.write_tables(sheet, draft, asked.mechanism.display, asked_spelling())
        if figures:
            render.write_pictures(sheet.pictures, draft, asked.mechanism.display)
        names = output.file_names(draft)
    _show(asked, study, data, output.files_in(folder, names))


def _as_table(asked: SweepStudy, study: str, target: Path, how: How, force: bool) -> xr.Dataset:
    if asked.reduce is None and not isinstance(asked.outputs, Mapping):
        raise InputError(
            str(target), _("a table holds reduced results only"), _("give reduce, or write .zarr")
        )
    with output.output_table(target, force=force) as (draft, workbook):
        with warnings.catch_warnings():
            warnings.simplefilter(
                "ignore", RuntimeWarning
            )  # an interruption is told in the command's own words
            data = _compute(asked, study, None, how)
        if data.attrs["mechanisms"] < data["samples_ok"].size:
            raise KeyboardInterrupt  # a part of a table looks like a whole one
        (table,) = ct.tables(data).values()
        render.write_table(table, draft, asked.mechanism.display, asked_spelling(), workbook)
    return data


def _as_store(asked: SweepStudy, study: str, target: str, how: How) -> xr.Dataset:
    try:
        with _notes_told():
            data = _compute(asked, study, target, how)
    except KeyboardInterrupt:
        note = _("finished results stay in {folder}; the same command resumes from there")
        output.tell(note.format(folder=target))
        raise
    found = data.attrs["mechanisms_found"]
    if found:
        told = ngettext(
            "{n} mechanism was computed in an earlier run",
            "{n} mechanisms were computed in an earlier run",
            found,
        )
        output.tell(told.format(n=found))
    return data


@contextmanager
def _notes_told() -> Iterator[None]:
    """Say what of a store is damaged, and that a cluster has no workers, in the command's own words."""
    with warnings.catch_warnings():
        for kind in NOTES:
            warnings.simplefilter("always", kind)
        show = warnings.showwarning

        def tell(
            message: Warning | str,
            category: type[Warning],
            filename: str,
            lineno: int,
            file: TextIO | None = None,
            line: str | None = None,
        ) -> None:
            if issubclass(category, NOTES):
                output.tell(_("note: {note}").format(note=message))
            else:
                show(message, category, filename, lineno, file, line)

        warnings.showwarning = tell
        yield


def _compute(asked: SweepStudy, study: str, store: str | None, how: How) -> xr.Dataset:
    with about(study), Progress() as progress:
        start, stop = (
            None if end is None else asked.mechanism.motion_parameter.instant.read(end, key)
            for key, end in (("from", asked.start), ("to", asked.stop))
        )

        def tell(done: int, of: int) -> None:
            progress.say(_("computing mechanisms"), done, of)

        return ct.sweep(
            asked.mechanism,
            asked.vary,
            asked.outputs,
            samples=asked.samples,
            start=start,
            stop=stop,
            reduce=asked.reduce,
            gradient=asked.gradient,
            executor=asked.executor,
            store=store,
            progress=tell,
            compute=asked.compute,
            dependent=asked.dependent or None,
            tables=asked.tables,
            **how,
        )
