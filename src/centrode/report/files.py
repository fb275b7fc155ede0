"""Reports as files: each is there whole, or not at all."""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from importlib.util import find_spec
from pathlib import Path
from typing import TypeAlias

import lazy_loader

from centrode.errors import InputError
from centrode.files.drafts import draft_folder, refusals
from centrode.locale import _, speaking
from centrode.model.reading import nearest, value_text
from centrode.optional_packages import how_to_install
from centrode.render.document.blocks import Report

# What documents need is an extra: only where they are asked for.
_html, _pdf, _word, _latex, _notebook = (
    functools.partial(lazy_loader.load, f"centrode.report.{name}", suppress_warning=True)
    for name in (
        "html.page",
        "pdf_document",
        "editable.word",
        "editable.latex_document",
        "notebook_document",
    )
)

Documents: TypeAlias = Mapping[str, bytes]
"""Paths of files within a folder -> what they hold."""


def _latex_files(report: Report, name: str) -> Documents:
    """The LaTeX of a report, and its figures in a folder beside it."""
    folder = f"{name}-figures"
    source, figures = _latex().latex_document(report, folder)
    return {f"{name}.tex": source} | {f"{folder}/{figure}": content for figure, content in figures.items()}


FORMATS: Mapping[str, Callable[[Report, str], Documents]] = {
    "html": lambda report, name: {f"{name}.html": _html().html_page(report)},
    "pdf": lambda report, name: {f"{name}.pdf": _pdf().pdf_document(report)},
    "docx": lambda report, name: {f"{name}.docx": _word().word_document(report)},
    "tex": _latex_files,
    "ipynb": lambda report, name: {f"{name}.ipynb": _notebook().notebook_document(report)},
}
"""What makes the documents NAME of a report, by the ending of their file."""
DEFAULT_FORMATS = ("html", "pdf")
"""Those that are made where nobody chooses."""
NEEDS = {"docx": "pypandoc", "tex": "pypandoc"}
"""The library that a format needs besides those of every report."""
EXTRAS = {"pypandoc": ("editable",)}
"""The extras in which libraries are, if not in those of every report."""


def write_report(
    report: Report,
    folder: str | Path,
    formats: Sequence[str] = DEFAULT_FORMATS,
    name: str = "report",
    said: Callable[[str], None] | None = None,
) -> list[Path]:
    """Write a report as documents NAME.html, NAME.pdf, ... into a folder; the same report gives the same bytes.

    Parameters
    ----------
    report : Report
    folder : path
        Is made where it is missing.
    formats : "html", "pdf", "docx", "tex", "ipynb"
        A LaTeX document has its figures in the folder NAME-figures beside it.
    name : str
        Of the files.
    said : function, optional
        Called with the name of each file before it is made.

    Returns
    -------
    list of Path
        The files written. They appear when all are made: one that fails leaves none behind.

    Raises
    ------
    InputError
        An unknown format, a missing library, or a folder that cannot be written.

    Examples
    --------
    >>> import centrode as ct
    >>> chosen = ct.ReportOptions(chapters=("structure",))
    >>> [file.name for file in ct.write_report(ct.report(ct.example("crank-rocker"), chosen), "pages", ["html"])]
    ['report.html']
    """
    check_formats(formats)
    documents: dict[str, bytes] = {}
    kinds = list(dict.fromkeys(formats))
    # typst computes outside of Python: while it lays out a PDF another document is made
    with speaking(report.language), ThreadPoolExecutor(len(kinds)) as threads:
        made = []
        for kind in kinds:
            if said is not None:
                said(f"{name}.{kind}")
            made.append(threads.submit(document, report, kind, name))
        for one in made:
            documents |= one.result()
    folder = Path(folder)
    with refusals(folder):
        folder.mkdir(parents=True, exist_ok=True)
    with draft_folder(folder) as draft:
        for file, content in documents.items():
            (draft / file).parent.mkdir(exist_ok=True)
            (draft / file).write_bytes(content)
    return [folder / file for file in documents]


def check_formats(formats: Sequence[str]) -> None:
    """InputError for a format that there is not, for none, and where nothing can set documents."""
    if not formats:
        raise InputError("format", _("no format is named"), nearest("", FORMATS))
    for kind in formats:
        if kind not in FORMATS:
            what = _("{kind} is not a format of a report").format(kind=value_text(kind))
            raise InputError("format", what, nearest(kind, FORMATS))
    for library in ("typst", *(NEEDS[kind] for kind in formats if kind in NEEDS)):
        if find_spec(library) is None:
            raise lacking(library)


def lacking(library: str) -> InputError:
    """The failure of a library that reports need and that is not installed."""
    what = _("reports need {library}, which is not installed").format(library=library)
    return InputError("", what, how_to_install(*EXTRAS.get(library, ("documents", "figures"))))


def document(report: Report, kind: str, name: str = "report") -> Documents:
    """The files of a document; InputError where a library is missing."""
    try:
        return FORMATS[kind](report, name)
    except ModuleNotFoundError as missing:
        library = (missing.name or "").partition(".")[0]
        if library == "centrode":
            raise
        raise lacking(library) from missing
