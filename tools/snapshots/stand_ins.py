"""What stands in for slow or machine-dependent libraries while a command runs.

Only entry points of other libraries are replaced, so that the same record can be made of any state of the program:
matplotlib hands over figures instead of drawing them, typst the source it is given instead of a document.
"""

from __future__ import annotations

import contextlib
import functools
import inspect
import io
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from unittest import mock
from xml.sax.saxutils import escape

import typst
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure
from matplotlib.mathtext import MathTextParser

from centrode.render.figures import files
from centrode.render.figures.document_canvas import DocumentCanvas
from tools.snapshots.artefacts import Artefact
from tools.snapshots.pictures import figure_artefact

MARK = "figure number"
"""How a file begins that stands for a figure; its number in `Seen.figures` follows."""
FORMULA = re.compile(r"\$ (.*?) \$(?=\n\n|\Z)", re.DOTALL)
PARSER: Any = MathTextParser
REMEMBERED = functools.lru_cache(20_000)(inspect.unwrap(PARSER._parse_cached))
"""Sizes of formulas in labels, as often as they are asked for; matplotlib itself remembers 50."""
PAGE_SOURCE = "document set by typst"
INCLUDED = re.compile(r'#include "(chapter-\d+\.typ)"')


@dataclass
class Seen:
    """What was handed over: figures in the order they were made, frames of animations apart."""

    comma: bool = False
    figures: list[Artefact] = field(default_factory=list)
    frames: list[Artefact] = field(default_factory=list)
    last: Figure | None = None

    def take(self, figure: Figure, *, anew: bool = True) -> int:
        """Keep a figure; returns its number. What was just printed is not looked at again unless it is `anew`."""
        if anew or figure is not self.last:
            self.figures.append(figure_artefact(figure, self.comma))
        self.last = figure
        return len(self.figures) - 1


@contextlib.contextmanager
def seen_instead_of_drawn(comma: bool = False) -> Iterator[Seen]:
    """While the block runs, figures and documents are handed over instead of being drawn and set."""
    seen = Seen(comma)
    restore: Any = FigureCanvasAgg.restore_region

    def put(target: Any, text: str) -> None:
        if hasattr(target, "write"):
            target.write(text.encode())
        else:
            Path(target).write_text(text, encoding="utf-8")

    def print_png(canvas: Any, target: Any, **_options: Any) -> None:
        put(target, f"{MARK} {seen.take(canvas.figure)}")

    def print_svg(canvas: Any, target: Any, **_options: Any) -> None:
        in_memory = isinstance(target, io.BytesIO)  # a picture of a document; files come in pairs, PNG first
        number = seen.take(canvas.figure, anew=in_memory)
        if not in_memory:
            put(target, f"{MARK} {number}")
            return
        wide, high = (72.0 * side for side in canvas.figure.get_size_inches())
        put(
            target,
            f'<svg xmlns="http://www.w3.org/2000/svg" width="{wide:.6g}pt" height="{high:.6g}pt"'
            f' viewBox="0 0 {wide:.6g} {high:.6g}"><desc>{MARK} {number}</desc></svg>',
        )

    def restore_region(canvas: Any, *arguments: Any, **options: Any) -> Any:
        seen.frames.append(figure_artefact(canvas.figure, comma))
        return restore(canvas, *arguments, **options)

    with (
        mock.patch.object(FigureCanvasAgg, "print_png", print_png),
        mock.patch.object(FigureCanvasSVG, "print_svg", print_svg),
        mock.patch.object(DocumentCanvas, "print_svg", print_svg),
        mock.patch.object(FigureCanvasAgg, "restore_region", restore_region),
        mock.patch.object(Figure, "draw_without_rendering", lambda _figure: None),
        mock.patch.object(files, "lay_out", lambda _figure: None),
        mock.patch.object(typst, "Compiler", Typesetter),
        mock.patch.object(PARSER, "_parse_cached", REMEMBERED),
    ):
        yield seen


class Typesetter:
    """Gives back the source of a document, and of formulas of a page MathML that holds their source."""

    def __init__(self, *_arguments: Any, **_options: Any) -> None:
        pass

    def eval(self, _expression: str) -> str:
        """Nothing stands anywhere: neither ends of chapters nor figures."""
        return "[[], []]"

    def compile_with_warnings(
        self, input: Mapping[str, bytes], format: str, **_options: Any
    ) -> tuple[bytes, list[str]]:
        """What typst would make of the files in `input`."""
        source = INCLUDED.sub(lambda found: _chapter(input[found[1]]), input["main"].decode())
        if format == "html":
            formulas = FORMULA.findall(source)
            return "\n".join(f"<math><mtext>{escape(one)}</mtext></math>" for one in formulas).encode(), []
        beside = {
            name: content
            for name, content in sorted(input.items())
            if name != "main" and not name.startswith("chapter-")
        }
        lists = "\n".join(
            f"{name} {len(content)} bytes" for name, content in beside.items() if content[:1] != b"<"
        )
        return f"{PAGE_SOURCE}\n{source}\n{lists}\n".encode(), []


def _chapter(content: bytes) -> str:
    """A chapter as the source of a document has it: behind the line that imports the style."""
    return content.decode().partition("\n")[2]
