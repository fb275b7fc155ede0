"""A folder for each variant of a gear pair or of a train, and the summary of all."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

from centrode import render
from centrode.assignments.gear_variants import GearVariants, gear_variants
from centrode.files.drafts import draft_folder, remove_file
from centrode.locale import speaking
from centrode.model.examples.catalogue import files_of
from centrode.render.table_files import PLAIN, TableSpelling
from centrode.report.document import report
from centrode.report.files import check_formats, write_report
from centrode.topics.presentation import sheet_of

if TYPE_CHECKING:
    from centrode.assignments.gear_tables import GearDescription
    from centrode.assignments.gear_variants import GearVariantResults
    from centrode.assignments.tables import Table

SUMMARY = "summary.csv"
Progress: TypeAlias = Callable[[int, int], None]


def write_gear_variants(
    source: GearDescription | str,
    table: Table,
    folder: str | Path,
    figures: bool = False,
    formats: tuple[str, ...] = (),
    progress: Progress | None = None,
    spelling: TableSpelling = PLAIN,
) -> GearVariants:
    """Compute every variant of a table into a folder of its own, and sum them up in `summary.csv`.

    Parameters
    ----------
    source, table : as of `gear_variants`
    folder : path
        Gets a folder `variant-NAME` for each: its description, its tables, `summary.json`.
    figures : draw the figures of each, and the outlines of its wheels
    formats : kinds of documents on each; none by default
    progress : called with (variants done, variants in all)
    spelling : workbooks, decimal commas

    Raises
    ------
    InputError
        The table is wrong, the folder cannot be written, a file that was read would be replaced.
    """
    spelling.check()
    if formats:
        check_formats(formats)
    found = gear_variants(source, table)
    for number, one in enumerate(found.results, start=1):
        if one.result is not None:
            _write(one, Path(folder) / f"variant-{one.variant.name}", figures, formats, spelling)
        if progress is not None:
            progress(number, len(found.results))
    with draft_folder(Path(folder)) as draft, speaking("en"):
        render.write_tables(sheet_of(found), draft, found.described.display, spelling)
        remove_file((Path(folder) / SUMMARY).with_suffix(".xlsx"))  # of an earlier run
    return found


def _write(
    one: GearVariantResults, folder: Path, figures: bool, formats: tuple[str, ...], spelling: TableSpelling
) -> None:
    """The files of one variant."""
    described = one.variant.described
    assert described is not None
    shown = sheet_of(one.result)
    name = described.kind.removeprefix("gear ")
    with draft_folder(folder) as draft:
        text = files_of(described).text(described)
        (draft / f"{name}.toml").write_text(text, encoding="utf-8", newline="\n")
        render.write_tables(shown, draft, described.display, spelling)
        render.write_summary(shown.scalars, draft / "summary.json")
        if figures:
            render.write_pictures(shown.pictures, draft, described.display)
        if formats:
            write_report(report(described, name=one.variant.name), draft, formats)
