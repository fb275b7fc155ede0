"""Figures of reports in the kinds that word processors and LaTeX take: typst sets each SVG on a page of its size."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal

import typst

from centrode.render.document.typst import quote

DENSITY = 220
"""Pixels of an inch: what word processors print with."""


def convert_pictures(pictures: Mapping[str, bytes], kind: Literal["png", "pdf"]) -> dict[str, bytes]:
    """SVG of each name as PNG or as PDF; the same bytes from the same figure."""
    return {name: _page(svg, kind) for name, svg in pictures.items()}


def _page(svg: bytes, kind: Literal["png", "pdf"]) -> bytes:
    source = f"#set page(width: auto, height: auto, margin: 0pt)\n#image({quote('picture.svg')})\n"
    files: Any = {"main": source.encode(), "picture.svg": svg}
    compiler = typst.Compiler(ignore_system_fonts=True)
    options: dict[str, Any] = {"ppi": DENSITY} if kind == "png" else {"timestamp": 0}
    page, _warnings = compiler.compile_with_warnings(input=files, format=kind, **options)
    assert isinstance(page, bytes)
    return page
