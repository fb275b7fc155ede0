"""The PDF of a report."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import typst

from centrode.render.document.blocks import Report
from centrode.report.pdf.source import Source

STYLE = Path(__file__).with_name("style.typ")


def pdf_document(report: Report) -> bytes:
    """A report as PDF: searchable, with an outline and page numbers; the same bytes from the same report.

    Typst reads nothing but what is handed to it, and no fonts but its own.
    """
    source = Source(report)
    files: Any = {
        "main": source.text.encode(),
        "style.typ": STYLE.read_bytes(),
        **source.files,
    }
    compiler = typst.Compiler(ignore_system_fonts=True)
    document, _warnings = compiler.compile_with_warnings(input=files, format="pdf", timestamp=0)
    assert isinstance(document, bytes)
    return document
