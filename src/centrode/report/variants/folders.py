"""A folder for each variant of a table, several computed at once; a run that was cut short goes on where it was."""

from __future__ import annotations

import csv
import io
import multiprocessing
import signal
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from pathlib import Path
from typing import TypeAlias

from centrode.errors import InputError
from centrode.files.drafts import draft_folder, refusals, remove_file
from centrode.files.inputs import Input, carry_on, keep_inputs, noted
from centrode.files.locks import locked
from centrode.locale import _
from centrode.model.files import mechanism_text
from centrode.model.mechanism import Mechanism
from centrode.present.spelled_tables import PLAIN, TableSpelling
from centrode.report.variants.tasks import Task, WritesMore, finished, run
from centrode.study.variant_results import VariantRow
from centrode.study.variant_tables import Table, read_variants

Progress: TypeAlias = Callable[[int, int], None]

LOCK, SUMMARY = ".lock", "summary.csv"
MOST_JOBS = 256


def write_variants(
    topology: Mechanism,
    table: Table,
    folder: str | Path,
    jobs: int = 1,
    figures: bool = False,
    progress: Progress | None = None,
    more: WritesMore | None = None,
    spelling: TableSpelling | None = None,
) -> tuple[VariantRow, ...]:
    """Compute every variant of a table into a folder of its own, and sum them up in `summary.csv`.

    Parameters
    ----------
    topology, table : as of `variants`
    folder : path
        Gets a folder `variant-NAME` for each; those finished before with the same numbers are not computed again.
    jobs : int
        Processes at once. More than one asks a script for the usual `if __name__ == "__main__"`.
    figures : bool
        Draw the figures of each.
    progress : called with (variants done, variants in all)
    more : writes further files of each variant into its folder
    spelling : workbooks, decimal commas; plain CSV alone if left out

    Returns
    -------
    tuple of VariantRow
        In the order of the table.

    Raises
    ------
    InputError
        The table is wrong, the folder cannot be written, a file that was read would be replaced, another run
        writes into it, or a process was ended.
    """
    _check_jobs(jobs)
    folder = Path(folder)
    spelling = spelling or PLAIN
    spelling.check()
    text = mechanism_text(topology)
    tasks = [
        Task(text, variant, folder / f"variant-{variant.name}", figures, more, spelling)
        for variant in read_variants(topology, table)
    ]
    keep_inputs(folder / SUMMARY)
    with refusals(folder):
        folder.mkdir(parents=True, exist_ok=True)
        with locked(folder / LOCK, str(folder)):
            rows = _all(tasks, jobs, progress)
            _write_summary(rows, folder, spelling)
    return tuple(rows)


def _write_summary(rows: Sequence[VariantRow], folder: Path, spelling: TableSpelling) -> None:
    """The summary as it is to be spelled, each of its files whole or not at all."""
    with draft_folder(folder) as draft:
        (draft / SUMMARY).write_text(summary_text(rows), encoding="utf-8", newline="\n")
        spelling.spell(draft)
        remove_file((folder / SUMMARY).with_suffix(".xlsx"))  # of an earlier run


def _check_jobs(jobs: object) -> None:
    if isinstance(jobs, bool) or not isinstance(jobs, int) or not 1 <= jobs <= MOST_JOBS:
        what = _("{jobs} processes were asked for").format(jobs=jobs)
        raise InputError("jobs", what, _("ask for 1 to {most}").format(most=MOST_JOBS))


def _all(tasks: Sequence[Task], jobs: int, progress: Progress | None) -> list[VariantRow]:
    """Rows of all tasks, those of finished ones from their markers."""
    rows = {task.variant.name: row for task in tasks if (row := finished(task)) is not None}
    open_tasks = [task for task in tasks if task.variant.name not in rows]
    if progress is not None:
        progress(len(rows), len(tasks))
    for row in _several(open_tasks, jobs) if min(jobs, len(open_tasks)) > 1 else map(run, open_tasks):
        rows[row.variant] = row
        if progress is not None:
            progress(len(rows), len(tasks))
    return [rows[task.variant.name] for task in tasks]


def _several(tasks: Sequence[Task], jobs: int) -> Iterator[VariantRow]:
    """Rows as processes finish them; interrupted, those that run are finished and the others left."""
    context = multiprocessing.get_context("spawn")
    size = min(jobs, len(tasks))
    pool = ProcessPoolExecutor(size, mp_context=context, initializer=_prepare, initargs=(noted(),))
    with pool:
        futures: list[Future[VariantRow]] = [pool.submit(run, task) for task in tasks]
        try:
            for future in as_completed(futures):
                yield future.result()
        except BrokenProcessPool as broken:
            what = _("a process was ended from outside")
            raise InputError(
                "", what, _("what is finished stays; the same command goes on from there")
            ) from broken
        finally:
            pool.shutdown(wait=True, cancel_futures=True)


def _prepare(read: Sequence[Input]) -> None:
    """Let the parent decide what an interruption means, and keep what it has read."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    carry_on(read)


def summary_text(rows: Sequence[VariantRow]) -> str:
    """The summary of all variants as CSV."""
    text = io.StringIO(newline="")
    writer = csv.writer(text, lineterminator="\n")
    unit = next((row.unit for row in rows if row.unit), "rad")
    writer.writerow(["variant", "turns_fully", f"limit [{unit}]", "group", "cause", "status"])
    words = {True: "yes", False: "no", None: ""}
    for row in rows:
        limit = "" if row.limit is None else repr(row.limit)
        writer.writerow([row.variant, words[row.turns_fully], limit, row.group, row.cause, row.status])
    return text.getvalue()
