"""SVG of figures whose texts are measured and read once in a process, however many figures have them."""

from __future__ import annotations

import functools
import io
from typing import TYPE_CHECKING, Any

from matplotlib.backends.backend_agg import FigureCanvasAgg, RendererAgg
from matplotlib.backends.backend_mixed import MixedModeRenderer
from matplotlib.backends.backend_svg import FigureCanvasSVG, RendererSVG
from matplotlib.mathtext import MathTextParser
from matplotlib.textpath import TextToPath

if TYPE_CHECKING:
    from collections.abc import Mapping

KEPT = 4096
"""Texts that are kept: those of some hundred figures."""


class KeptFormulas(MathTextParser):  # type: ignore[type-arg]
    """Formulas of texts, each read once: reading takes most of the time of drawing a figure of names and angles."""

    def parse(self, s: str, dpi: float = 72, prop: Any = None, *, antialiased: bool | None = None) -> Any:
        """A formula laid out, as matplotlib does it."""
        return self._kept(s, dpi, None if prop is None else prop.copy(), antialiased)

    # one parser for the process: nothing else is held by the cache
    @functools.lru_cache(KEPT)  # noqa: B019
    def _kept(self, text: str, dpi: float, prop: Any, antialiased: bool | None) -> Any:
        return super().parse(text, dpi, prop, antialiased=antialiased)


class KeptTexts(TextToPath):
    """Sizes of texts, each measured once; formulas are those of `KeptFormulas`."""

    def __init__(self) -> None:
        super().__init__()
        self.mathtext_parser = KeptFormulas("path")

    def get_text_width_height_descent(self, s: str, prop: Any, ismath: Any) -> Any:
        """Size of a text, as matplotlib has it."""
        return self._size(s, prop.copy(), ismath)

    @functools.lru_cache(KEPT)  # noqa: B019
    def _size(self, text: str, prop: Any, ismath: Any) -> Any:
        return super().get_text_width_height_descent(text, prop, ismath)


@functools.cache
def kept_texts() -> KeptTexts:
    """The texts of this process."""
    return KeptTexts()


class DocumentRenderer(RendererSVG):
    """A renderer of SVG with the texts of the process."""

    def __init__(self, *arguments: Any, **options: Any) -> None:
        super().__init__(*arguments, **options)  # type: ignore[no-untyped-call]
        self._text2path = kept_texts()


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
        text = io.TextIOWrapper(filename, encoding="utf-8", newline="\n", write_through=True)
        size = width * self.fixed_dpi, height * self.fixed_dpi
        inner = DocumentRenderer(*size, text, image_dpi=dpi, metadata=metadata)
        mixed: Any = MixedModeRenderer
        renderer = mixed(figure, width, height, dpi, inner, bbox_inches_restore=bbox_inches_restore)
        figure.draw(renderer)
        renderer.finalize()
        text.detach()


class MeasuringRenderer(RendererAgg):
    """A renderer of pixels with the formulas of the process."""

    def __init__(self, width: float, height: float, dpi: float) -> None:
        super().__init__(width, height, dpi)  # type: ignore[no-untyped-call]
        # matplotlib 3.11 draws formulas from their glyphs, earlier versions from pixels
        own: Any = self.mathtext_parser
        self.mathtext_parser = kept_formulas(vector=own._output_type == "vector")


@functools.cache
def kept_formulas(*, vector: bool) -> KeptFormulas:
    """The formulas of this process, as renderers of pixels take them."""
    return KeptFormulas("path") if vector else KeptFormulas("agg")


class MeasuringCanvas(FigureCanvasAgg):
    """A canvas on which texts of a page are measured while it is drawn."""

    def get_renderer(self) -> MeasuringRenderer:
        """The renderer of this size, made once."""
        width, height = self.figure.bbox.size
        key = width, height, self.figure.dpi
        if getattr(self, "_measured_key", None) != key:
            self._measured_key, self._measured = key, MeasuringRenderer(*key)
        return self._measured
