"""A second reader of documents: what PDFium finds in a PDF, from its outline to the places of its words."""

from __future__ import annotations

import ctypes
import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import pypdfium2
from pypdfium2 import raw

BAND = 1 / 12
"""Of the height of a page: a blank band that belongs to what is around it."""
TOP = 1 / 10
"""Of the height of a page: what begins above that begins at its top, below the margin."""
STANDARD = re.compile(rb"<pdf(a|ua)id:(part|conformance)>(\w)<")


@dataclass
class PdfFile:
    """A PDF that is read.

    Attributes
    ----------
    data : its bytes
    """

    data: bytes

    @contextmanager
    def _opened(self) -> Iterator[Any]:
        document = pypdfium2.PdfDocument(self.data)
        yield document
        document.close()

    @cached_property
    def pages(self) -> list[str]:
        """Text of each page."""
        with self._opened() as document:
            texts = [page.get_textpage().get_text_range() for page in document]
        return [text.replace("\r\n", "\n") for text in texts]

    @property
    def text(self) -> str:
        return "\n".join(self.pages)

    @cached_property
    def outline(self) -> list[str]:
        """Titles of the outline in their order, with their numbers."""
        with self._opened() as document:
            return [entry.get_title() for entry in document.get_toc()]

    @cached_property
    def half_empty_pages(self) -> list[int]:
        """Numbers of the pages less than half full on which no chapter ends, of those from the first chapter on.

        A page is as full as its text is high, blank bands of more than a twelfth of it left out. A chapter ends on it
        if the next begins at the top of the page behind: what stands there above a heading belongs to the chapter too.
        """
        with self._opened() as document:
            entries = [one for one in document.get_toc(max_depth=15) if one.level == 0]
            begins = [_beginning(one.get_dest(), document) for one in entries]
            full = {number: _filled(page) for number, page in enumerate(document, start=1)}
        first, last = min(begins)[0], max(full)
        ends = {page - 1 for page, down in begins if down < TOP}
        return [number for number in range(first, last) if full[number] < 0.5 and number not in ends]

    @cached_property
    def title(self) -> str:
        with self._opened() as document:
            return str(document.get_metadata_value("Title"))

    @cached_property
    def language(self) -> str:
        with self._opened() as document:
            return _text(lambda *buffer: raw.FPDFCatalog_GetLanguage(document, *buffer))

    @cached_property
    def is_tagged(self) -> bool:
        with self._opened() as document:
            return bool(raw.FPDFCatalog_IsTagged(document))

    @property
    def standards(self) -> str:
        """Those that the file names: "ua-1 a-2a"; nothing of a plain one."""
        told = {(kind, key): value.decode().lower() for kind, key, value in STANDARD.findall(self.data)}
        accessible = [f"ua-{told[b'ua', b'part']}"] if (b"ua", b"part") in told else []
        kept = [f"a-{told[b'a', b'part']}{told[b'a', b'conformance']}"] if (b"a", b"part") in told else []
        return " ".join([*accessible, *kept])

    def descriptions(self, kind: str) -> list[str]:
        """Alternative texts of all elements of a kind ("Formula", "Figure") in the tree of the document."""
        with self._opened() as document:
            return [one for page in document for one in _descriptions(page, kind)]

    def words(self) -> list[tuple[float, float, float, float, str]]:
        """Left, bottom, right, top [points] of the runs of letters on all pages, and what they say."""
        found = []
        with self._opened() as document:
            for page in document:
                text = page.get_textpage()
                boxes = [text.get_rect(k) for k in range(text.count_rects())]
                found += [(*box, text.get_text_bounded(*box)) for box in boxes]
        return found


def _beginning(place: Any, document: Any) -> tuple[int, float]:
    """The page of a place in the outline, from 1, and the share of the page above it."""
    number = place.get_index()
    _mode, (_left, up, *_zoom) = place.get_view()
    return number + 1, 1.0 - up / document[number].get_height()


def _filled(page: Any) -> float:
    """The share of the height of a page that is filled, its head and foot left out."""
    grey = np.atleast_3d(page.render(scale=0.5, grayscale=True).to_numpy())[..., 0]
    height = len(grey)
    text = grey[int(height * 19 / 297) : int(height * 278 / 297)]
    inked = np.flatnonzero((text < 200).any(axis=1))
    if not inked.size:
        return 0.0
    gaps = np.diff(np.concatenate([[0], inked])) / len(text)
    return float(inked[-1] / len(text) - (gaps - BAND)[gaps > BAND].sum())


def _descriptions(page: Any, kind: str) -> Iterator[str]:
    tree = raw.FPDF_StructTree_GetForPage(page)
    for k in range(raw.FPDF_StructTree_CountChildren(tree)):
        yield from _below(raw.FPDF_StructTree_GetChildAtIndex(tree, k), kind)
    raw.FPDF_StructTree_Close(tree)


def _below(element: Any, kind: str) -> Iterator[str]:
    if _text(lambda *buffer: raw.FPDF_StructElement_GetType(element, *buffer)) == kind:
        yield _text(lambda *buffer: raw.FPDF_StructElement_GetAltText(element, *buffer))
    for k in range(raw.FPDF_StructElement_CountChildren(element)):
        child = raw.FPDF_StructElement_GetChildAtIndex(element, k)
        if child:
            yield from _below(child, kind)


def _text(get: Callable[..., int]) -> str:
    """What a function of PDFium writes into a buffer."""
    length = get(None, 0)
    buffer = (ctypes.c_ushort * (length // 2))()
    get(buffer, length)
    return bytes(buffer).decode("utf-16-le").rstrip("\0")
