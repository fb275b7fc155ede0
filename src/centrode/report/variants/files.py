"""A report for each variant of a table, and one sheet of answers for the teacher."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from centrode.locale import _, chosen_language, speaking
from centrode.model.mechanism import Mechanism
from centrode.model.settings import DIGITS
from centrode.render.document.blocks import Report
from centrode.report.chapters import CHAPTERS
from centrode.report.document import report
from centrode.report.files import FORMATS, check_formats, document, write_report
from centrode.report.study import ReportOptions, ReportStudy, settle_options
from centrode.report.variants.answer_sheet import Answers, answer_sheet, answers_of
from centrode.report.variants.folders import Progress, write_variants
from centrode.study.variant_results import spoken_variants
from centrode.study.variant_tables import Table, read_variants

if TYPE_CHECKING:
    from centrode.present.spelled_tables import TableSpelling
    from centrode.study.variant_results import VariantResults, VariantRow

ANSWERS = "answers.json"


@dataclass(frozen=True)
class VariantReport:
    """Writes a variant's report, and its answers, into its folder; plain data, which goes to another process."""

    formats: tuple[str, ...]
    language: str

    @property
    def key(self) -> str:
        """All that the files depend on besides the variant."""
        return json.dumps(["report", sorted(self.formats), self.language])

    def __call__(self, results: VariantResults, folder: Path) -> None:
        """Write `report.html`, `report.pdf` and `answers.json`."""
        mechanism = results.mechanism
        assert mechanism is not None
        with speaking(self.language):
            title = _("{title}, variant {name}").format(
                title=_(mechanism.title) or _("Mechanism"), name=results.row.variant
            )
            made = report(mechanism, ReportOptions(), language=self.language)
            named = Report(title, made.subtitle, made.language, made.chapters)
            write_report(named, folder, self.formats)
            study = ReportStudy(mechanism, settle_options(mechanism, ReportOptions(), CHAPTERS))
            text = json.dumps(answers_of(study), indent=1, ensure_ascii=False) + "\n"
        (folder / ANSWERS).write_text(text, encoding="utf-8", newline="\n")


def write_variant_reports(
    topology: Mechanism,
    table: Table,
    folder: str | Path,
    jobs: int = 1,
    figures: bool = False,
    formats: Sequence[str] = tuple(FORMATS),
    language: str | None = None,
    progress: Progress | None = None,
    spelling: TableSpelling | None = None,
) -> tuple[VariantRow, ...]:
    """What `write_variants` writes, with a report for each variant and one sheet of answers.

    Parameters
    ----------
    topology, table, folder, jobs, figures, progress, spelling : as of `write_variants`
        Those finished before with the same numbers, formats and language are not made again.
    formats : "html", "pdf"
    language : "en", "ru" or "uk", optional
        Of the reports; the language spoken at the moment if left out.

    Returns
    -------
    tuple of VariantRow
        In the order of the table. The folder has `answers.html` and `answers.pdf` besides.

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
        variants = read_variants(topology, table)
    rows = write_variants(
        topology, table, folder, jobs, figures, progress, VariantReport(tuple(formats), spoken), spelling
    )
    with speaking(spoken):
        digits = topology.report.digits or DIGITS
        answers = _answers(Path(folder), rows)
        without = [row for row in rows if row.variant not in answers]
        told = {row.variant: row for row in spoken_variants(topology, table, without)}
        said = [told.get(row.variant, row) for row in rows]
        sheet = answer_sheet(topology, variants, said, answers, digits)
        write_report(sheet, folder, formats, name="answers")
    return rows


def _answers(folder: Path, rows: Sequence[VariantRow]) -> dict[str, Answers]:
    """Answers by the names of the variants, of those that have any."""
    found: dict[str, Answers] = {}
    for row in rows:
        file = folder / f"variant-{row.variant}" / ANSWERS
        if file.is_file():
            found[row.variant] = json.loads(file.read_text(encoding="utf-8"))
    return found
