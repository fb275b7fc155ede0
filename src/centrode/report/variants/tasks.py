"""One variant computed into its folder: its files, and the marker that says that they are there.

A variant's files are written first, then its marker, by a rename that happens or does not. The marker holds a digest
of all that the files depend on: what has no marker, or one of another digest, is computed again.
"""

from __future__ import annotations

import functools
import hashlib
import json
import traceback
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Protocol

import lazy_loader

from centrode import render
from centrode.equations.integration import IntegrationResults
from centrode.files.drafts import clear_folder, remove_file, replace_file, write_whole
from centrode.files.inputs import keep_inputs
from centrode.model.files import mechanism_text, parse_mechanism
from centrode.present.spelled_tables import PLAIN, TableSpelling
from centrode.present.tables import write_motion_csv
from centrode.study.variant_results import FAULT, STEPS, VariantResults, VariantRow, computed
from centrode.study.variant_tables import Variant
from centrode.version import __version__
from centrode.views import integrations

# Matplotlib is an extra, and slow to import: only where figures are asked for.
_figures, _saving = (
    functools.partial(lazy_loader.load, f"centrode.present.{name}", suppress_warning=True)
    for name in ("figures", "figure_files")
)

MARKER = "variant.json"


class WritesMore(Protocol):
    """Writes further files of a variant; plain data, which goes to another process."""

    @property
    def key(self) -> str:
        """All that these files depend on besides the variant."""
        ...

    def __call__(self, results: VariantResults, folder: Path) -> None:
        """Write them into the variant's folder; not called for one that was refused."""
        ...


@dataclass(frozen=True)
class Task:
    """One variant to be computed into a folder; plain data, which goes to another process."""

    topology: str
    variant: Variant
    folder: Path
    figures: bool
    more: WritesMore | None = None
    spelling: TableSpelling = PLAIN

    @property
    def digest(self) -> str:
        """Digest of all that the files depend on."""
        told = [__version__, self.topology, dict(self.variant.values), STEPS, self.figures]
        told += [] if self.more is None else [self.more.key]
        told += [] if self.spelling == PLAIN else [asdict(self.spelling)]
        return hashlib.sha256(json.dumps(told, sort_keys=True).encode()).hexdigest()


def finished(task: Task) -> VariantRow | None:
    """The row of a variant whose files are there; None where they are not, or are those of other numbers."""
    told = _marked(task)
    try:
        return VariantRow(**told["row"]) if told["digest"] == task.digest else None
    except (KeyError, TypeError):
        return None


def _marked(task: Task) -> dict[str, Any]:
    """What a variant's marker holds; nothing where there is none that can be read."""
    try:
        told = json.loads((task.folder / MARKER).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    return told if isinstance(told, dict) else {}


def run(task: Task) -> VariantRow:
    """Compute one variant and write its folder; a fault of the program is told in its row, and tried again later."""
    task.folder.mkdir(parents=True, exist_ok=True)
    draft = task.folder / ".draft"
    clear_folder(draft)
    draft.mkdir()
    try:
        results = computed(parse_mechanism(task.topology), task.variant)
        _write(results, draft, figures=task.figures)
        if task.more is not None and results.mechanism is not None:
            task.more(results, draft)
        task.spelling.spell(draft)
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


def _exchange(task: Task, draft: Path, row: VariantRow) -> None:
    """Put new files into the place of those of an earlier run; a marker without a digest stands while that goes on.

    Raises InputError before anything is touched where one of them is a file that was read.
    """
    names = sorted(file.name for file in draft.iterdir())
    before = [str(name) for name in _marked(task).get("files", []) if Path(str(name)).name == str(name)]
    keep_inputs(*(task.folder / name for name in (*before, *names, MARKER)))
    write_whole(task.folder / MARKER, {"digest": "", "files": sorted({*before, *names})})
    for name in before:
        remove_file(task.folder / name)
    for name in names:
        replace_file(draft / name, task.folder / name)
    write_whole(task.folder / MARKER, {"digest": task.digest, "row": row.as_dict(), "files": names})


def _write(results: VariantResults, folder: Path, *, figures: bool) -> None:
    """The files of one variant; none of one that was refused."""
    study, mechanism, integration = results.study, results.mechanism, results.integration
    if study is None or mechanism is None:
        return
    points = mechanism.moving_points
    (folder / "mechanism.toml").write_text(mechanism_text(mechanism), encoding="utf-8", newline="\n")
    write_motion_csv(study.motion, folder / "motion.csv", mechanism.display, points)
    scalars = {name: scalar.as_dict() for name, scalar in study.scalars.items()}
    text = json.dumps(scalars, indent=2, allow_nan=False) + "\n"
    (folder / "summary.json").write_text(text, encoding="utf-8", newline="\n")
    if figures:
        drawn = _figures().motion_figures(mechanism, study.motion, mechanism.study.instants, study.instants)
        _saving().save_figures(drawn, folder)
    if integration is not None:
        sheet = integrations.sheet(IntegrationResults(mechanism, integration, study.motion))
        for name, table in sheet.tables.items():
            render.write_table(table, folder / f"{name}.csv", mechanism.display)
        if figures:
            render.write_pictures(sheet.pictures, folder, mechanism.display)
