"""SVG of figures whose texts are measured and read once in a process, however many figures have them."""

from __future__ import annotations

import functools
import io
import re
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg, RendererAgg
from matplotlib.backends.backend_mixed import MixedModeRenderer
from matplotlib.backends.backend_svg import FigureCanvasSVG, RendererSVG
from matplotlib.font_manager import findfont, get_font
from matplotlib.mathtext import MathTextParser, VectorParse
from matplotlib.textpath import TextToPath

if TYPE_CHECKING:
    from collections.abc import Mapping

KEPT = 4096
"""Texts that are kept: those of some hundred figures."""
EM = 1000.0
"""Points of the size that formulas are read at: their widths are rounded to one."""
HEIGHTS = {
    "OS/2": ("sTypoAscender", "sTypoDescender", "sTypoLineGap"),
    "hhea": ("ascent", "descent", "lineGap"),
}
DOLLAR = re.compile(r"(?<!\\)\$")


class KeptFormulas(MathTextParser):  # type: ignore[type-arg]
    """Formulas of texts, each piece read once: reading takes most of the time of a figure of names and angles.

    Outlines are read at one size and scaled. Between two dollar signs nothing depends on what stands beside it, so a
    text is put together of pieces, many of which stand in several texts.
    """

    def parse(self, s: str, dpi: float = 72, prop: Any = None, *, antialiased: bool | None = None) -> Any:
        """A formula laid out, as matplotlib does it."""
        prop = None if prop is None else prop.copy()
        own: Any = self
        if own._output_type == "vector" and prop is not None:
            return self._scaled_parse(s, dpi, prop)
        return self._kept(s, dpi, prop, antialiased)

    # one parser for the process: nothing else is held by the cache
    @functools.lru_cache(KEPT)  # noqa: B019
    def _kept(self, text: str, dpi: float, prop: Any, antialiased: bool | None) -> Any:
        return super().parse(text, dpi, prop, antialiased=antialiased)

    @functools.lru_cache(KEPT)  # noqa: B019
    def _scaled_parse(self, text: str, dpi: float, prop: Any) -> VectorParse:
        points = prop.get_size_in_points() / EM
        scale = points * dpi / 72.0
        prop.set_size(EM)
        parts = DOLLAR.split(text)
        spelled = [f"${part}$" if place % 2 else part for place, part in enumerate(parts)]
        if len(parts) % 2 == 0:  # a dollar sign that nothing closes: matplotlib says so
            spelled = [text]
        glyphs: list[Any] = []
        rectangles: list[Any] = []
        width = height = depth = 0.0
        for part in filter(None, spelled):
            one = self._kept(part, 72, prop, None)
            glyphs += [
                (font, points * size, *names, scale * (width + x), scale * y)
                for font, size, *names, x, y in one.glyphs
            ]
            rectangles += [(scale * (width + x), *(scale * side for side in rest)) for x, *rest in one.rects]
            width += one.width
            height, depth = max(height, one.height - one.depth), max(depth, one.depth)
        # rounded up, as matplotlib does it
        sides = (float(np.ceil(scale * side)) for side in (width, height, depth))
        wide, above, below = sides
        return VectorParse(wide, above + below, below, glyphs, rectangles)


@functools.cache
def kept_formulas(*, vector: bool) -> KeptFormulas:
    """The formulas of this process: outlines, or the pixels that renderers of earlier versions take."""
    return KeptFormulas("path") if vector else KeptFormulas("agg")


class KeptTexts(TextToPath):
    """Sizes and letters of texts, each measured and set once; formulas are those of `KeptFormulas`."""

    def __init__(self) -> None:
        super().__init__()
        self.mathtext_parser = kept_formulas(vector=True)

    def get_text_width_height_descent(self, s: str, prop: Any, ismath: Any) -> Any:
        """Size of a text, as matplotlib has it."""
        return self._size(s, prop.copy(), ismath)

    @functools.lru_cache(KEPT)  # noqa: B019
    def _size(self, text: str, prop: Any, ismath: Any) -> Any:
        return super().get_text_width_height_descent(text, prop, ismath)

    def get_glyphs_with_font(
        self, font: Any, s: str, glyph_map: Any = None, return_new_glyphs_only: bool = False, **options: Any
    ) -> Any:
        """The letters of a text and where they stand, as matplotlib has them."""
        places, outlines, rectangles = self._letters(font, s, tuple(sorted(options.items())))
        known = {} if glyph_map is None else glyph_map
        new = {name: outline for name, outline in outlines.items() if name not in known}
        return list(places), new if return_new_glyphs_only else {**known, **new}, list(rectangles)

    @functools.lru_cache(KEPT)  # noqa: B019
    def _letters(self, font: Any, text: str, options: tuple[tuple[str, Any], ...]) -> Any:
        return super().get_glyphs_with_font(font, text, **dict(options))


@functools.cache
def kept_texts() -> KeptTexts:
    """The texts of this process."""
    return KeptTexts()


@functools.lru_cache(KEPT)
def _line_heights(prop: Any, dpi: float) -> tuple[float, float, float] | tuple[None, None, float]:
    """Ascent, descent and line gap of a font [pixel], as matplotlib reads them for every text anew."""
    font: Any = get_font(findfont(prop))
    head = font.get_sfnt_table("head")
    if head is None:
        return None, None, 0.0
    scale = prop.get_size_in_points() * dpi / (72.0 * head["unitsPerEm"])
    for table, keys in HEIGHTS.items():
        if (found := font.get_sfnt_table(table)) is not None:
            ascent, descent, gap = (scale * found[key] for key in keys)
            return ascent, -descent, gap
    return None, None, 0.0


class DocumentRenderer(RendererSVG):
    """A renderer of SVG with the texts of the process."""

    def __init__(self, *arguments: Any, **options: Any) -> None:
        super().__init__(*arguments, **options)  # type: ignore[no-untyped-call]
        self._text2path = kept_texts()

    def _get_font_height_metrics(self, prop: Any) -> Any:
        """What matplotlib 3.11 asks a renderer for before it reads the font; earlier versions do not ask."""
        return _line_heights(prop.copy(), DocumentCanvas.fixed_dpi)


class DocumentCanvas(FigureCanvasSVG):
    """A canvas that lays a figure out and writes it with the same renderer."""

    def get_renderer(self) -> DocumentRenderer:
        """What layouts measure with."""
        width, height = self.figure.get_size_inches() * self.fixed_dpi
        return DocumentRenderer(width, height, io.StringIO(), image_dpi=self.figure.dpi)

    def print_svg(
        self,
        filename: Any,
        *,
        bbox_inches_restore: Any = None,
        metadata: Mapping[str, Any] | None = None,
        **_of_other_kinds: Any,
    ) -> None:
        """Write the figure to a binary stream, as matplotlib does it."""
        figure: Any = self.figure
        dpi = figure.dpi
        figure.dpi = self.fixed_dpi
        width, height = figure.get_size_inches()
        # a figure is written in some thousand pieces: each would be encoded by itself
        text = io.StringIO(newline="\n")
        size = width * self.fixed_dpi, height * self.fixed_dpi
        inner = DocumentRenderer(*size, text, image_dpi=dpi, metadata=metadata)
        mixed: Any = MixedModeRenderer
        renderer = mixed(figure, width, height, dpi, inner, bbox_inches_restore=bbox_inches_restore)
        figure.draw(renderer)
        renderer.finalize()
        filename.write(text.getvalue().encode())


class MeasuringRenderer(RendererAgg):
    """A renderer of pixels with the formulas of the process."""

    def __init__(self, width: float, height: float, dpi: float) -> None:
        super().__init__(width, height, dpi)  # type: ignore[no-untyped-call]
        # matplotlib 3.11 draws formulas from their glyphs, earlier versions from pixels
        own: Any = self.mathtext_parser
        self.mathtext_parser = kept_formulas(vector=own._output_type == "vector")

    def _get_font_height_metrics(self, prop: Any) -> Any:
        return _line_heights(prop.copy(), self.dpi)


class MeasuringCanvas(FigureCanvasAgg):
    """A canvas on which texts of a page are measured while it is drawn."""

    def get_renderer(self) -> MeasuringRenderer:
        """The renderer of this size, made once."""
        width, height = self.figure.bbox.size
        key = width, height, self.figure.dpi
        if getattr(self, "_measured_key", None) != key:
            self._measured_key, self._measured = key, MeasuringRenderer(*key)
        return self._measured
