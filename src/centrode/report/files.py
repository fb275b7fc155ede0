"""Reports as files: each is there whole, or not at all."""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Future
from importlib.util import find_spec
from pathlib import Path
from threading import Thread
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
PATIENCE = 0.2
"""Seconds after which a thread that waits looks for Ctrl-C, as some systems wake none that waits."""


def _typeset(report: Report, name: str) -> Callable[[], Documents]:
    """What waits for the PDF of a report. Typst computes outside of Python, so others are made in the meantime.

    Nothing can stop typst: who does not wait, as Ctrl-C makes it, leaves it its thread, which keeps no process alive.
    """
    typesetting, made = _pdf().typesetting(report), Future[bytes]()

    def work() -> None:
        try:
            made.set_result(typesetting())
        except BaseException as failure:
            made.set_exception(failure)

    thread = Thread(target=work, daemon=True)
    thread.start()

    def wait() -> Documents:
        while thread.is_alive():
            thread.join(PATIENCE)
        return {f"{name}.pdf": made.result()}

    return wait


def _latex_files(report: Report, name: str) -> Documents:
    """The LaTeX of a report, and its figures in a folder beside it."""
    folder = f"{name}-figures"
    source, figures = _latex().latex_document(report, folder)
    return {f"{name}.tex": source} | {f"{folder}/{figure}": content for figure, content in figures.items()}


FORMATS: Mapping[str, Callable[[Report, str], Documents | Callable[[], Documents]]] = {
    "html": lambda report, name: {f"{name}.html": _html().html_page(report)},
    "pdf": _typeset,
    "docx": lambda report, name: {f"{name}.docx": _word().word_document(report)},
    "tex": _latex_files,
    "ipynb": lambda report, name: {f"{name}.ipynb": _notebook().notebook_document(report)},
}
"""What makes the documents NAME of a report, by the ending of their file: at once, or as something that waits."""
FIRST = "pdf"
"""That which is begun before others, as it is made beside them."""
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
    with speaking(report.language):
        begun = {}
        for kind in sorted(kinds, key=lambda kind: kind != FIRST):
            if said is not None:
                said(f"{name}.{kind}")
            begun[kind] = _begin(report, kind, name)
        for kind in kinds:
            documents |= begun[kind]()
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
    return _begin(report, kind, name)()


def _begin(report: Report, kind: str, name: str) -> Callable[[], Documents]:
    """What gives the files of a document when they are made."""
    try:
        made = FORMATS[kind](report, name)
    except ModuleNotFoundError as missing:
        library = (missing.name or "").partition(".")[0]
        if library == "centrode":
            raise
        raise lacking(library) from missing
    return made if callable(made) else lambda: made
