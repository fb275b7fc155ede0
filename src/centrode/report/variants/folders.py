"""A folder for each variant of a table, several computed at once; a run that was cut short goes on where it was."""

from __future__ import annotations

import gc
import hashlib
import json
import multiprocessing
import signal
import threading
import traceback
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any, Protocol, TypeAlias

from centrode import render
from centrode.assignments.results import FAULT, STEPS, VariantResults, VariantRow, Variants, compute_variant
from centrode.assignments.tables import Table, Variant, read_variants
from centrode.equations.integration import IntegrationResults
from centrode.errors import InputError
from centrode.files.drafts import clear_folder, draft_folder, refusals, remove_file, replace_file, write_whole
from centrode.files.inputs import Input, carry_on, inputs_read, keep_inputs
from centrode.files.locks import hold_lock
from centrode.locale import _
from centrode.model.examples.catalogue import MechanismSource, mechanism_of
from centrode.model.files import mechanism_text, parse_mechanism
from centrode.model.mechanism import Mechanism
from centrode.render.table_files import PLAIN, TableSpelling
from centrode.sweeps.clusters import ClusterSource, open_cluster, wanted_libraries
from centrode.sweeps.parameter_studies import analysis_results, check_analysis
from centrode.topics.presentation import sheet_of
from centrode.version import __version__
from centrode.views import motion

# One variant computed into its folder: its files, and the marker that says that they are there.
#
# A variant's files are written first, then its marker, by a rename that happens or does not. The marker holds
# a digest
# of all that the files depend on: what has no marker, or one of another digest, is computed again.

MARKER = "variant.json"


class WritesMore(Protocol):
    """Writes further files of a variant; plain data, which goes to another process."""

    @property
    def key(self) -> str:
        """All that these files depend on besides the variant."""
        ...

    @property
    def told(self) -> dict[str, Any]:
        """All that it is made of, as JSON has it."""
        ...

    @property
    def work(self) -> Callable[[str], dict[str, Any]]:
        """The function of a module that does `row_of_text` with these files."""
        ...

    def __call__(self, results: VariantResults, folder: Path) -> None:
        """Write them into the variant's folder; not called for one that was refused."""
        ...


@dataclass(frozen=True)
class VariantTask:
    """One variant to be computed into a folder; plain data, which goes to another process."""

    topology: str
    variant: Variant
    folder: Path
    figures: bool
    more: WritesMore | None = None
    spelling: TableSpelling = PLAIN
    compute: str | None = None

    @property
    def digest(self) -> str:
        """Digest of all that the files depend on."""
        told = [__version__, self.topology, dict(self.variant.values), STEPS, self.figures]
        told += [] if self.more is None else [self.more.key]
        told += [] if self.spelling == PLAIN else [asdict(self.spelling)]
        told += [] if self.compute is None else [self.compute]
        return hashlib.sha256(json.dumps(told, sort_keys=True).encode()).hexdigest()


def finished_row(task: VariantTask) -> VariantRow | None:
    """The row of a variant whose files are there; None where they are not, or are those of other numbers."""
    told = _read_marker(task)
    try:
        return VariantRow(**told["row"]) if told["digest"] == task.digest else None
    except (KeyError, TypeError):
        return None


def _read_marker(task: VariantTask) -> dict[str, Any]:
    """What a variant's marker holds; nothing where there is none that can be read."""
    try:
        told = json.loads((task.folder / MARKER).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    return told if isinstance(told, dict) else {}


def run(task: VariantTask) -> VariantRow:
    """Compute one variant and write its folder; a fault of the program is told in its row, and tried again later."""
    task.folder.mkdir(parents=True, exist_ok=True)
    draft = task.folder / ".draft"
    clear_folder(draft)
    draft.mkdir()
    try:
        results = compute_variant(parse_mechanism(task.topology), task.variant, task.compute)
        _write(results, draft, task.spelling, figures=task.figures)
        if task.compute is not None and results.row.numbers and results.mechanism is not None:
            _write_analysis(results.mechanism, task, draft)
        if task.more is not None and results.mechanism is not None:
            task.more(results, draft)
    except OSError:
        raise
    except Exception as fault:
        cause = "".join(traceback.format_exception_only(fault)).strip()
        return VariantRow(task.variant.name, None, None, "", "", cause, FAULT)
    else:
        _exchange(task, draft, results.row)
        return results.row
    finally:
        clear_folder(draft)


def _exchange(task: VariantTask, draft: Path, row: VariantRow) -> None:
    """Put new files into the place of those of an earlier run; a marker without a digest stands while that goes on.

    Raises InputError before anything is touched where one of them is a file that was read.
    """
    names = sorted(file.name for file in draft.iterdir())
    before = [str(name) for name in _read_marker(task).get("files", []) if Path(str(name)).name == str(name)]
    keep_inputs(*(task.folder / name for name in (*before, *names, MARKER)))
    write_whole(task.folder / MARKER, {"digest": "", "files": sorted({*before, *names})})
    for name in before:
        remove_file(task.folder / name)
    for name in names:
        replace_file(draft / name, task.folder / name)
    write_whole(task.folder / MARKER, {"digest": task.digest, "row": row.as_dict(), "files": names})


def _write(results: VariantResults, folder: Path, spelling: TableSpelling, *, figures: bool) -> None:
    """The files of one variant; none of one that was refused."""
    study, mechanism, integration = results.study, results.mechanism, results.integration
    if study is None or mechanism is None:
        return
    shown = motion.sheet(study)
    (folder / "mechanism.toml").write_text(mechanism_text(mechanism), encoding="utf-8", newline="\n")
    render.write_table(shown.tables["motion"], folder / "motion.csv", mechanism.display, spelling)
    render.write_summary(sheet_of(study).scalars, folder / "summary.json")
    if figures:
        render.write_pictures(shown.pictures, folder, mechanism.display)
    if integration is not None:
        sheet = sheet_of(IntegrationResults(mechanism, integration, study.motion))
        for name, table in sheet.tables.items():
            render.write_table(table, folder / f"{name}.csv", mechanism.display, spelling)
        if figures:
            render.write_pictures(sheet.pictures, folder, mechanism.display)


def _write_analysis(mechanism: Mechanism, task: VariantTask, folder: Path) -> None:
    """Tables and figures of the analysis of a variant."""
    sheet = sheet_of(analysis_results(mechanism, str(task.compute)))
    for name, table in sheet.tables.items():
        render.write_table(table, folder / f"{name}.csv", mechanism.display, task.spelling)
    if task.figures:
        render.write_pictures(sheet.pictures, folder, mechanism.display)


Progress: TypeAlias = Callable[[int, int], None]

COLLECTION = (50_000, 50, 100)
"""Objects after which processes look for cycles among them, in each generation, as of a command."""

LOCK, SUMMARY = ".lock", "summary.csv"
MOST_JOBS = 256


def write_variants(
    topology: MechanismSource,
    table: Table,
    folder: str | Path,
    jobs: int = 1,
    figures: bool = False,
    progress: Progress | None = None,
    more: WritesMore | None = None,
    spelling: TableSpelling | None = None,
    compute: str | None = None,
    cluster: ClusterSource = None,
) -> Variants:
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
    spelling : workbooks, decimal commas; plain CSV alone by default
    compute : as of `variants`; the folder of each variant has the tables and figures of the analysis too
    cluster : as of `sweep`; its workers compute variants into `folder`, which all of them reach

    Returns
    -------
    Variants
        Rows in the order of the table.

    Raises
    ------
    InputError
        The table is wrong, the folder cannot be written, a file that was read would be replaced, another run
        writes into it, or a process was ended.

    Examples
    --------
    >>> import centrode as ct
    >>> rows = [{"variant": "long", "links.AB.length": 3.6}]
    >>> found = ct.write_variants(ct.example("crank-rocker"), rows, "variants")
    >>> found.rows[0].status
    'ok'
    """
    topology = mechanism_of(topology)
    _check_jobs(jobs)
    folder = Path(folder)
    spelling = spelling or PLAIN
    spelling.check()
    if compute is not None:
        check_analysis(compute)
    given = read_variants(topology, table)
    tasks = [
        VariantTask(
            mechanism_text(variant.base(topology)),
            replace(variant, topology=None),
            folder / f"variant-{variant.name}",
            figures,
            more,
            spelling,
            compute,
        )
        for variant in given
    ]
    keep_inputs(folder / SUMMARY)
    keep_inputs(folder / LOCK)
    with refusals(folder):
        folder.mkdir(parents=True, exist_ok=True)
        with hold_lock(folder / LOCK, str(folder), remove=remove_file):
            rows = tuple(_all(tasks, jobs, progress, cluster))
            variants = Variants(topology, given, rows, compute=compute)
            _write_summary(variants, folder, spelling)
    return variants


def _write_summary(variants: Variants, folder: Path, spelling: TableSpelling) -> None:
    """The summary as it is to be spelled, each of its files whole or not at all."""
    with draft_folder(folder) as draft:
        render.write_tables(sheet_of(variants), draft, variants.mechanism.display, spelling)
        remove_file((folder / SUMMARY).with_suffix(".xlsx"))  # of an earlier run


def _check_jobs(jobs: object) -> None:
    if isinstance(jobs, bool) or not isinstance(jobs, int) or not 1 <= jobs <= MOST_JOBS:
        what = _("{jobs} processes are given").format(jobs=jobs)
        raise InputError("jobs", what, _("give 1 to {most}").format(most=MOST_JOBS))


def _all(
    tasks: Sequence[VariantTask], jobs: int, progress: Progress | None, cluster: ClusterSource
) -> list[VariantRow]:
    """Rows of all tasks, those of finished ones from their markers."""
    rows = {task.variant.name: row for task in tasks if (row := finished_row(task)) is not None}
    open_tasks = [task for task in tasks if task.variant.name not in rows]
    if progress is not None:
        progress(len(rows), len(tasks))
    if cluster is not None:
        computed = _on_cluster(open_tasks, cluster)
    elif min(jobs, len(open_tasks)) > 1:
        computed = _several(open_tasks, jobs)
    else:
        computed = map(run, open_tasks)
    for row in computed:
        rows[row.variant] = row
        if progress is not None:
            progress(len(rows), len(tasks))
    return [rows[task.variant.name] for task in tasks]


def _several(tasks: Sequence[VariantTask], jobs: int) -> Iterator[VariantRow]:
    """Rows as processes finish them; interrupted, those that run are finished and the others left."""
    context = multiprocessing.get_context("spawn")
    size = min(jobs, len(tasks))
    pool = ProcessPoolExecutor(size, mp_context=context, initializer=_prepare, initargs=(inputs_read(),))
    with pool:
        futures: list[Future[VariantRow]] = [pool.submit(run, task) for task in tasks]
        try:
            for future in as_completed(futures):
                yield future.result()
        except BrokenProcessPool as broken:
            what = _("a process was killed")
            raise InputError(
                "", what, _("finished results are kept; the same command resumes from there")
            ) from broken
        finally:
            pool.shutdown(wait=True, cancel_futures=True)


def _prepare(read: Sequence[Input]) -> None:
    """Let the parent decide what an interruption means, and keep what it has read."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    gc.set_threshold(*COLLECTION)
    carry_on(read)


# On a cluster: a worker is told a variant as text.

_one_at_a_time = threading.Lock()


def _on_cluster(tasks: Sequence[VariantTask], cluster: ClusterSource) -> Iterator[VariantRow]:
    """Rows as workers finish them; nothing is begun where every variant is finished."""
    if not tasks:
        return
    texts = ((k, task_text(task)) for k, task in enumerate(tasks))
    more = tasks[0].more
    work = row_of_text if more is None else more.work
    with open_cluster(cluster) as workers:
        for _k, row in workers.answers(work, texts, wanted_libraries(machine_code=True)):
            yield VariantRow(**row)


def task_text(task: VariantTask) -> str:
    """A variant to be computed, as JSON from which `task_of_text` has it again."""
    told = {
        "topology": task.topology,
        "variant": {
            "name": task.variant.name,
            "values": dict(task.variant.values),
            "source": task.variant.source,
        },
        "folder": str(task.folder.absolute()),
        "figures": task.figures,
        "more": None if task.more is None else task.more.told,
        "spelling": asdict(task.spelling),
        "compute": task.compute,
    }
    return json.dumps(told)


def task_of_text(text: str, more: WritesMore | None) -> VariantTask:
    """The variant of a text; InputError where the folder of all variants is not there."""
    told = json.loads(text)
    folder = Path(told["folder"])
    if not folder.parent.is_dir():
        what = _("the folder of the results is not there")
        raise InputError(str(folder.parent), what, _("name a folder that all workers reach by the same path"))
    variant, spelling = Variant(**told["variant"]), TableSpelling(**told["spelling"])
    return VariantTask(told["topology"], variant, folder, told["figures"], more, spelling, told["compute"])


def row_of_text(text: str, more: WritesMore | None = None) -> dict[str, Any]:
    """Compute the variant of a text into its folder; its row as JSON has it."""
    task = task_of_text(text, more)
    # what was finished before its worker died is not made again; figures and languages are those of a process
    with _one_at_a_time:
        return (finished_row(task) or run(task)).as_dict()
