"""Pictures that are made but not rendered: rendering is most of what a command or a report takes."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import lru_cache
from pathlib import Path
from typing import IO

import pytest
from matplotlib.figure import Figure
from matplotlib.mathtext import MathTextParser

from centrode.render.document import figures
from centrode.render.figures import files

SVG = (
    b'<svg xmlns="http://www.w3.org/2000/svg" width="100pt" height="100pt" viewBox="0 0 100 100">'
    b'<rect width="100" height="100" fill="#0072B2"/></svg>'
)
PNG = bytes.fromhex(
    "89504e470d0a1a0a0000000d4948445200000001000000010802000000907753de0000"
    "000c49444154789c636028da0400019a012579d294fa0000000049454e44ae426082"
)


class BlankCanvas:
    """A canvas that lays nothing out and prints the same small picture of every figure."""

    def __init__(self, figure: Figure) -> None:
        self.figure = figure

    def print_svg(self, target: str | IO[bytes], **_metadata: object) -> None:
        _write(target, SVG)

    def print_figure(self, target: str | IO[bytes], **_how: object) -> None:
        _write(target, SVG)

    def print_png(self, target: str | IO[bytes], **_metadata: object) -> None:
        _write(target, PNG)


def _write(target: str | IO[bytes], picture: bytes) -> None:
    if isinstance(target, str):
        Path(target).write_bytes(picture)
    else:
        target.write(picture)


def remember_mathematics() -> None:
    """Let matplotlib set each text of mathematics once: each canvas has a parser of its own, which knows no other's."""
    parse = getattr(MathTextParser._parse_cached, "__wrapped__", None)
    if parse is None:  # done already, or another version of matplotlib
        return
    parsers: dict[str, MathTextParser] = {}

    @lru_cache(4096)
    def remembered(output: str, *text_and_font: object) -> object:
        return parse(parsers[output], *text_and_font)

    def parse_once(self: MathTextParser, *text_and_font: object) -> object:
        parsers.setdefault(self._output_type, self)
        return remembered(self._output_type, *text_and_font)

    MathTextParser._parse_cached = parse_once  # type: ignore[method-assign]


@contextmanager
def blank_pictures() -> Iterator[None]:
    """Context in which commands and reports make every figure and write every file, and render no figure.

    For tests of what stands beside the pictures. That a figure can be rendered, and how it looks, is tested where
    nothing is left out: in tests/render, and by the tests of commands and reports that are marked `drawn`.
    """
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(figures, "DocumentCanvas", BlankCanvas)
        patch.setattr(files, "MeasuringCanvas", BlankCanvas)
        patch.setattr(files, "DocumentCanvas", BlankCanvas)
        patch.setattr(files, "lay_out", lambda _figure: None)
        yield
