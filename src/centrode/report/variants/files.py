"""A report for each variant of a table, and one sheet of answers for the teacher."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from centrode.assignments.answers import VariantAnswers, read_answers
from centrode.assignments.results import spoken_variants
from centrode.assignments.tables import Table
from centrode.equations.integration import results_of_integration
from centrode.locale import _, chosen_language, speaking
from centrode.model.mechanism import Mechanism
from centrode.render.document.blocks import Report
from centrode.report.chapters import CHAPTERS
from centrode.report.document import report_of_study
from centrode.report.files import DEFAULT_FORMATS, check_formats, document, write_report
from centrode.report.study import ReportOptions, ReportStudy, settle_options
from centrode.report.variants.answers import answer_sheet, answers_of
from centrode.report.variants.folders import Progress, row_of_text, write_variants
from centrode.sweeps.clusters import ClusterSource
from centrode.topics.equations import INTEGRATE

if TYPE_CHECKING:
    from centrode.assignments.results import VariantResults, VariantRow, Variants
    from centrode.render.table_files import TableSpelling

ANSWERS = "answers.json"


@dataclass(frozen=True)
class VariantReport:
    """Writes a variant's report, and its answers, into its folder; plain data, which goes to another process."""

    formats: tuple[str, ...]
    language: str

    @property
    def key(self) -> str:
        """All that the files depend on besides the variant."""
        return json.dumps(["report and answers", sorted(self.formats), self.language])

    @property
    def told(self) -> dict[str, Any]:
        """All that it is made of, as JSON has it."""
        return {"formats": list(self.formats), "language": self.language}

    @property
    def work(self) -> Callable[[str], dict[str, Any]]:
        """What a worker of a cluster does."""
        return row_of_report_text

    def __call__(self, results: VariantResults, folder: Path) -> None:
        """Write `report.html`, `report.pdf` and `answers.json`."""
        mechanism = results.mechanism
        assert mechanism is not None
        with speaking(self.language):
            title = _("{title}, variant {name}").format(
                title=_(mechanism.title) or _("Mechanism"), name=results.row.variant
            )
            study = study_of_variant(mechanism, results)
            named = replace(report_of_study(study), title=title)
            write_report(named, folder, self.formats)
            text = answers_of(study).json_text()
        (folder / ANSWERS).write_text(text, encoding="utf-8", newline="\n")


def row_of_report_text(text: str) -> dict[str, Any]:
    """`row_of_text` of a variant with a report."""
    more = json.loads(text)["more"]
    return row_of_text(text, VariantReport(tuple(more["formats"]), more["language"]))


def study_of_variant(mechanism: Mechanism, results: VariantResults) -> ReportStudy:
    """The study of a report, with what is known of the variant already."""
    study = ReportStudy(mechanism, settle_options(mechanism, ReportOptions(), CHAPTERS))
    # variants have forces at the mean speed, a report those of the real motion where there is one
    if results.study is not None and study.motion_of_forces == "mean":
        study.keep("study", results.study)
    if results.adaptive is not None and not study.wishes.options:
        study.keep(("result", INTEGRATE.name), results_of_integration(mechanism, results.adaptive))
    return study


def write_variant_reports(
    topology: Mechanism,
    table: Table,
    folder: str | Path,
    jobs: int = 1,
    figures: bool = False,
    formats: Sequence[str] = DEFAULT_FORMATS,
    language: str | None = None,
    progress: Progress | None = None,
    spelling: TableSpelling | None = None,
    compute: str | None = None,
    cluster: ClusterSource = None,
) -> Variants:
    """What `write_variants` writes, with a report for each variant and one sheet of answers.

    Parameters
    ----------
    topology, table, folder, jobs, figures, progress, spelling, compute, cluster : as of `write_variants`
        Those finished before with the same numbers, formats and language are not made again.
    formats : "html", "pdf", "docx", "tex", "ipynb"
    language : "en", "ru" or "uk", optional
        Of the reports; the language spoken at the moment if left out.

    Returns
    -------
    Variants
        Rows in the order of the table, and answers. The folder has `answers.html` and `answers.pdf` besides.

    Raises
    ------
    InputError
        As `write_variants` and `write_report`; a missing library is told before anything is computed.
    """
    spoken = chosen_language() if language is None else language
    check_formats(formats)
    with speaking(spoken):
        for kind in formats:
            document(
                Report("", "", spoken), kind
            )  # what is not installed is told here, and not by every variant
    more = VariantReport(tuple(formats), spoken)
    variants = write_variants(
        topology, table, folder, jobs, figures, progress, more, spelling, compute, cluster
    )
    variants = replace(variants, answers=_answers(Path(folder), variants.rows))
    with speaking(spoken):
        write_report(answer_sheet(_spoken(variants)), folder, formats, name="answers")
    return variants


def _spoken(variants: Variants) -> Variants:
    """The same with causes in the language that is spoken where there are no answers, which have them in it."""
    without = tuple(row for row in variants.rows if row.refusal or row.variant not in variants.answers)
    rows = {row.variant: row for row in spoken_variants(replace(variants, rows=without)).rows}
    return replace(variants, rows=tuple(rows.get(row.variant, row) for row in variants.rows))


def _answers(folder: Path, rows: Sequence[VariantRow]) -> dict[str, VariantAnswers]:
    """Answers by the names of the variants, of those that have any."""
    files = {row.variant: folder / f"variant-{row.variant}" / ANSWERS for row in rows}
    return {
        name: read_answers(file.read_text(encoding="utf-8")) for name, file in files.items() if file.is_file()
    }
