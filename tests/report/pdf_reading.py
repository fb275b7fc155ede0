"""A second reader of documents: what pypdf finds in a PDF, from its outline to the places of its letters."""

from __future__ import annotations

import io
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from pypdf import PdfReader
from pypdf.generic import ContentStream

STANDARD = re.compile(r"<pdf(a|ua)id:(part|conformance)>(\w+)<")


@dataclass
class PdfFile:
    """A PDF that was read.

    Attributes
    ----------
    data : its bytes
    """

    data: bytes

    @cached_property
    def reader(self) -> PdfReader:
        return PdfReader(io.BytesIO(self.data), strict=True)

    @cached_property
    def pages(self) -> list[str]:
        """Text of each page."""
        return [page.extract_text() for page in self.reader.pages]

    @property
    def text(self) -> str:
        return "\n".join(self.pages)

    @property
    def catalogue(self) -> Any:
        return self.reader.trailer["/Root"]

    @property
    def language(self) -> str:
        return str(self.catalogue["/Lang"])

    @property
    def standards(self) -> str:
        """Those that the file names: "ua-1 a-2a"; nothing of a plain one."""
        metadata = self.catalogue["/Metadata"].get_object().get_data().decode()
        told = {(kind, key): value for kind, key, value in STANDARD.findall(metadata)}
        accessible = [f"ua-{told['ua', 'part']}"] if ("ua", "part") in told else []
        kept = [f"a-{told['a', 'part']}{told['a', 'conformance'].lower()}"] if ("a", "part") in told else []
        return " ".join([*accessible, *kept])

    @property
    def outline(self) -> list[str]:
        """Titles of the outline in their order, with their numbers."""
        return list(_titles(self.reader.outline))

    def alternatives(self, kind: str) -> list[str]:
        """Descriptions of all elements of a kind ("Formula", "Figure") in the tree of the document."""
        return [
            str(node.get("/Alt", ""))
            for node in _nodes(self.catalogue["/StructTreeRoot"])
            if node.get("/S") == f"/{kind}"
        ]

    def runs(self) -> Iterator[tuple[float, float, float, float]]:
        """Left, bottom, right, top [points] of the runs of letters on all pages, by their advances."""
        for page in self.reader.pages:
            yield from _runs(page)


def _titles(entries: Sequence[Any]) -> Iterator[str]:
    for entry in entries:
        if isinstance(entry, list):
            yield from _titles(entry)
        else:
            yield str(entry.title)


def _nodes(node: Any) -> Iterator[Any]:
    """Elements of the tree below one."""
    kids = node.get("/K", [])
    for kid in kids if isinstance(kids, list) else [kids]:
        child = kid.get_object()
        if hasattr(child, "get"):
            yield child
            yield from _nodes(child)


def _runs(page: Any) -> Iterator[tuple[float, float, float, float]]:
    fonts = {name: _Advances(font.get_object()) for name, font in page["/Resources"].get("/Font", {}).items()}
    stack: list[np.ndarray] = []
    current, text, line = np.eye(3), np.eye(3), np.eye(3)
    font, size = None, 0.0
    for operands, operator in ContentStream(page.get_contents(), page.pdf).operations:
        match operator:
            case b"q":
                stack.append(current)
            case b"Q":
                current = stack.pop()
            case b"cm":
                current = _matrix(operands) @ current
            case b"BT":
                text = line = np.eye(3)
            case b"Tf":
                font, size = fonts[operands[0]], float(operands[1])
            case b"Tm":
                text = line = _matrix(operands)
            case b"Td":
                text = line = _matrix([1, 0, 0, 1, *operands]) @ line
            case b"Tj" | b"TJ":
                assert font is not None
                parts = operands[0] if operator == b"TJ" else operands
                width = sum(
                    -float(part)
                    if isinstance(part, (int, float)) or hasattr(part, "as_numeric")
                    else font.width(part)
                    for part in parts
                )
                corners = (
                    np.array([[0.0, 0.0, 1.0], [width / 1000.0 * size, size * 0.7, 1.0]]) @ text @ current
                )
                (left, right), (bottom, top) = np.sort(corners[:, :2], axis=0).T
                yield float(left), float(bottom), float(right), float(top)
                text = _matrix([1, 0, 0, 1, width / 1000.0 * size, 0]) @ text
            case b"T*" | b"'" | b'"' | b"TD" | b"Tc" | b"Tw" | b"Tz":
                raise NotImplementedError(operator)


def _matrix(numbers: Sequence[Any]) -> np.ndarray:
    a, b, c, d, x, y = map(float, numbers)
    return np.array([[a, b, 0.0], [c, d, 0.0], [x, y, 1.0]])


class _Advances:
    """Widths of the letters of a font whose codes have two bytes."""

    def __init__(self, font: Any) -> None:
        assert font["/Encoding"] == "/Identity-H"
        below = font["/DescendantFonts"][0].get_object()
        self.default = float(below.get("/DW", 1000))
        self.found: dict[int, float] = {}
        entries = list(below["/W"].get_object())
        while entries:
            first, second, *entries = entries
            if isinstance(second, list):
                widths = [float(one) for one in second]
            else:
                width, *entries = entries
                widths = [float(width)] * (int(second) - int(first) + 1)
            self.found |= dict(enumerate(widths, start=int(first)))

    def width(self, text: Any) -> float:
        """Of a string [thousandths of the size]."""
        data = text.original_bytes
        codes = [int.from_bytes(data[k : k + 2], "big") for k in range(0, len(data), 2)]
        return sum(self.found.get(code, self.default) for code in codes)
