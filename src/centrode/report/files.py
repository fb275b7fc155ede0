"""Reports as files: each is there whole, or not at all."""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping, Sequence
from importlib.util import find_spec
from pathlib import Path

import lazy_loader

from centrode.errors import InputError
from centrode.files.drafts import draft_folder, refusals
from centrode.locale import _, speaking
from centrode.model.reading import nearest, value_text
from centrode.optional_packages import how_to_install
from centrode.render.document.blocks import Report

# What documents need is an extra: only where they are asked for.
_html, _pdf = (
    functools.partial(lazy_loader.load, f"centrode.report.{name}", suppress_warning=True)
    for name in ("html.page", "pdf_document")
)

FORMATS: Mapping[str, Callable[[Report], bytes]] = {
    "html": lambda report: _html().html_page(report),
    "pdf": lambda report: _pdf().pdf_document(report),
}
"""What makes a document of a report, by the ending of its file."""


def write_report(
    report: Report,
    folder: str | Path,
    formats: Sequence[str] = tuple(FORMATS),
    name: str = "report",
    said: Callable[[str], None] | None = None,
) -> list[Path]:
    """Write a report as documents NAME.html and NAME.pdf into a folder; the same report gives the same bytes.

    Parameters
    ----------
    report : Report
    folder : path
        Is made where it is missing.
    formats : "html", "pdf"
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
    with speaking(report.language):
        for kind in dict.fromkeys(formats):
            if said is not None:
                said(f"{name}.{kind}")
            documents[f"{name}.{kind}"] = document(report, kind)
    folder = Path(folder)
    with refusals(folder):
        folder.mkdir(parents=True, exist_ok=True)
    with draft_folder(folder) as draft:
        for file, content in documents.items():
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
    if find_spec("typst") is None:
        raise lacking("typst")


def lacking(library: str) -> InputError:
    """The failure of a library that reports need and that is not installed."""
    what = _("reports need {library}, which is not installed").format(library=library)
    return InputError("", what, how_to_install("documents", "figures"))


def document(report: Report, kind: str) -> bytes:
    """A report as the bytes of a document; InputError where a library is missing."""
    try:
        return FORMATS[kind](report)
    except ModuleNotFoundError as missing:
        library = (missing.name or "").partition(".")[0]
        if library == "centrode":
            raise
        raise lacking(library) from missing
