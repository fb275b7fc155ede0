"""Figures of reports: drawn once, as SVG whose letters are outlines, the same bytes from the same figure."""

from __future__ import annotations

import io
import re
import textwrap
import unicodedata
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from typing import Any

import numpy as np
from matplotlib.axis import Axis
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from matplotlib.text import Text
from matplotlib.ticker import FixedLocator
from matplotlib.transforms import Bbox

from centrode.locale import _
from centrode.render.document.blocks import Picture, shown
from centrode.render.document.numbers import spelled_number
from centrode.render.document.typst import quote
from centrode.render.drawing.style import house_style
from centrode.render.figures.document_canvas import DocumentCanvas
from centrode.render.figures.files import METADATA, spell_decimals

FLAT = {1: 0.33, 2: 0.42, 3: 0.46, 4: 0.72}
"""Height of curves by their width, by the number of panels above each other: of one panel three figures with their
captions find room on a page, of three panels three too, of four panels two. More panels could not be
read at such a height."""
LETTER_WITH_INDEX = re.compile(
    r"\{?(?P<letter>[A-Za-zΑ-ω]+)(?P<primes>'*)\}?(?:_(?:\{(?P<index>[^{}]+)\}|(?P<short>\w)))?"
)
DRAWING_HEIGHT = 4.0
"""Inches: a drawing of one field is no higher, so that text finds room beside it on a page."""
TEXT_WIDTH, TEXT_HEIGHT = 6.3, 8.6
"""Inches that a picture may fill of a page, its caption left out."""
PAPER_WIDTH = 8.268
_SIZE = re.compile(
    rb'<svg[^>]*?\bheight="([\d.]+)pt"[^>]*?\bwidth="([\d.]+)pt"|<svg[^>]*?\bviewBox="0 0 ([\d.]+) ([\d.]+)"'
)
EDGED = "edged-"
EDGE = 2.0
"""Width of the edge about letters, in points: as wide as `style.halo` draws it."""
OUTLINES = 64
"""Units of the outline of a letter in one of its text."""
_EDGED = re.compile(rb'<g id="edged-\d+">(?:\s|<!--.*?-->|<g[^>]*>.*?</g>)*</g>', re.DOTALL)
_LETTERS = re.compile(rb'<g(?: style="[^"]*")?( transform="[^"]*")>(.*?)</g>', re.DOTALL)
_DEFINITIONS = re.compile(rb"<defs>.*?</defs>\s*", re.DOTALL)
_SCALE = re.compile(rb"scale\(([-\d.]+)")
_PLACES = re.compile(rb' (?:d|x|y)="[^"]*"|translate\([^)]*\)')
_DECIMALS = re.compile(rb"-?\d+\.\d{3,}(?!\d*e)")
NOISE = 1e-9
"""Of the greatest value of curves: what is below it is zero."""
LETTER, EDGES, GAP = 0.078, 1.3, 0.12
"""Inches: a letter of a label, what titles and ticks take of a figure's height, and what is between panels."""


def picture(figure: Figure, caption: str, *, to_scale: bool = False) -> Picture:
    """A figure as a block, with its caption in place of its own title.

    One `to_scale` (at most as wide as A4) keeps its size on paper.

    Curves are drawn no higher than half a page; numbers have the decimal mark of the language.
    """
    if caption:
        figure.suptitle("").set_in_layout(False)
    spell_decimals(figure)
    if not to_scale:
        _flatten(figure)
    width = float(figure.get_figwidth())
    if not to_scale and len(figure.axes) == 1 and figure.axes[0].get_aspect() != "auto":
        width *= min(1.0, DRAWING_HEIGHT / float(figure.get_figheight()))
    return Picture(svg_of(figure), caption, width, to_scale, description=describe_curves(figure))


def svg_of(figure: Figure, box: Bbox | None = None) -> bytes:
    """A figure, or a box [inch] of it, as SVG for documents: places to hundredths of a point, edges of outlines.

    Edges about letters are left to SVG: a path for each such text would hold the outlines of its letters anew.
    """
    texts = [one for one in _texts_in(figure) if one.get_path_effects()]
    effects = [one.get_path_effects() for one in texts]
    names = [one.get_gid() for one in texts]
    try:
        for number, text in enumerate(texts):
            text.set_path_effects([])
            text.set_gid(f"{EDGED}{number}")
        with house_style():
            stream = io.BytesIO()
            with nullcontext() if box is None else _cut_to(figure, box):
                DocumentCanvas(figure).print_svg(stream, metadata=METADATA["svg"])
    finally:
        for text, effect, name in zip(texts, effects, names, strict=True):
            text.set_path_effects(effect)
            text.set_gid(name)
    ground = to_hex(figure.get_facecolor()).encode()
    svg = _EDGED.sub(
        lambda found: _LETTERS.sub(lambda letters: _with_edge(letters, ground), found[0]), stream.getvalue()
    )
    return _PLACES.sub(lambda found: _DECIMALS.sub(_rounded_number, found[0]), svg)


@contextmanager
def _cut_to(figure: Figure, box: Bbox) -> Iterator[None]:
    """Make a figure as large as a box [inch] of it, its axes where they were; matplotlib would draw it twice."""
    wide, high = figure.get_size_inches()
    places = [one.get_position() for one in figure.axes]
    try:
        figure.set_size_inches(box.width, box.height)
        for axes, place in zip(figure.axes, places, strict=True):
            low = (place.x0 * wide - box.x0) / box.width, (place.y0 * high - box.y0) / box.height
            axes.set_position((*low, place.width * wide / box.width, place.height * high / box.height))
        yield
    finally:
        figure.set_size_inches(wide, high)
        for axes, place in zip(figure.axes, places, strict=True):
            axes.set_position(place)


def _texts_in(artist: Any) -> Iterator[Any]:
    """Texts of a figure but those of axes: these have no edges, and looking for them makes ticks that nobody draws."""
    for child in artist.get_children():
        if isinstance(child, Text):
            yield child
        elif not isinstance(child, Axis):
            yield from _texts_in(child)


def _with_edge(found: re.Match[bytes], ground: bytes) -> bytes:
    """Letters behind themselves in the colour of the ground, stroked as wide as the edge is.

    Outlines of letters are finer than places.
    """
    transform, letters = found[1], _DEFINITIONS.sub(b"", found[2])
    scale = _SCALE.search(transform)
    width = EDGE / (abs(float(scale[1])) if scale else 1.0)
    fine = b'<use style="stroke-width: %.5g" ' % (width * OUTLINES)
    edge = b'<g style="fill: %b; stroke: %b; stroke-width: %.5g; stroke-linejoin: round"%b>%b</g>'
    behind = edge % (ground, ground, width, transform, letters.replace(b"<use ", fine))
    return b"".join(_DEFINITIONS.findall(found[2])) + behind + _DEFINITIONS.sub(b"", found[0])


def _rounded_number(found: re.Match[bytes]) -> bytes:
    return f"{float(found[0]):.2f}".rstrip("0").rstrip(".").encode()


def describe_curves(figure: Figure) -> str:
    """What a figure of curves plots, from where to where, and the names of its curves; nothing of a drawing.

    Letters of its labels stand between dollar signs, as in captions.
    """
    panels = [axes for axes in figure.axes if axes.get_aspect() == "auto" and axes.name == "rectilinear"]
    ranges = [(_label(axes.get_ylabel()), _extent(axes)) for axes in panels]
    quantities = [
        _("{quantity} from {least} to {greatest}").format(quantity=label, least=least, greatest=greatest)
        for label, (least, greatest) in ranges
        if label and least
    ]
    across = next((label for axes in reversed(panels) if (label := _label(axes.get_xlabel()))), "")
    if not quantities or not across:
        return ""
    names: dict[str, None] = {}
    for axes in panels:
        legend = axes.get_legend()
        names |= dict.fromkeys(_label(text.get_text()) for text in (legend.get_texts() if legend else ()))
    plotted = _("Horizontal axis: {across}. Vertical axis: {quantities}.").format(
        across=across, quantities="; ".join(quantities)
    )
    curves = _("Curves: {names}.").format(names=", ".join(names))
    return f"{plotted} {curves}" if names else plotted


def _extent(axes: Any) -> tuple[str, str]:
    """The least and the greatest value of all curves, spelled; empty where there is none."""
    values = np.concatenate(
        [np.empty(0), *(np.asarray(line.get_ydata(), dtype=float).ravel() for line in axes.lines)]
    )
    values = values[np.isfinite(values)]
    if not values.size:
        return "", ""
    ends = np.array([values.min(), values.max()])
    least, greatest = np.where(np.abs(ends) <= NOISE * np.abs(ends).max(), 0.0, ends).tolist()
    return spelled_number(f"{least:.3g}"), spelled_number(f"{greatest:.3g}")


def _label(text: str) -> str:
    """A label whose letters, spelled for matplotlib, are mathematics of documents."""
    parts = text.replace("\n", " ").split("$")
    if len(parts) % 2 == 0:  # a dollar sign of its own
        return shown(text)
    return "".join(_letters(part) if place % 2 else shown(part) for place, part in enumerate(parts))


def _letters(spelled: str) -> str:
    """A letter with its primes and its index; what is more than that stands as its bare letters."""
    plain = spelled.replace("\\mathrm", "").replace("\\var", "\\").replace(" ", "")
    found = LETTER_WITH_INDEX.fullmatch(plain.replace("\\", ""))
    if found is None:
        return shown(re.sub(r"[{}^_\\]", "", re.sub(r"\\([a-z]+)", _greek, plain)))
    below = found["index"] or found["short"]
    index = f"_({quote(below)})" if below else ""
    return f"${found['letter']}{index}{found['primes']}$"


def _flatten(figure: Figure) -> None:
    """Make curves lower, so that two figures share a page, and wrap labels that are longer than their panels.

    Drawings keep their proportions.
    """
    axes: list[Any] = figure.axes
    rows = max((one.get_gridspec().nrows for one in axes if one.get_subplotspec() is not None), default=0)
    if rows not in FLAT or figure.get_layout_engine() is None:
        return
    if any(one.get_aspect() != "auto" or one.name != "rectilinear" for one in axes):
        return
    # bars beside their names need a line for each of them
    if any(isinstance(one.yaxis.get_major_locator(), FixedLocator) for one in axes):
        return
    # no word of a label is longer than its panel: it would run into the label of the next one
    words = [word for one in axes if "$" not in (label := one.get_ylabel()) for word in label.split()]
    least = EDGES + rows * (GAP + LETTER * max(map(len, words), default=0))
    figure.set_figheight(min(max(FLAT[rows] * figure.get_figwidth(), least), figure.get_figheight()))
    room = int(((figure.get_figheight() - EDGES) / rows - GAP) / LETTER)
    for one in axes:
        label = one.get_ylabel().replace(" = ", "\N{NO-BREAK SPACE}=\N{NO-BREAK SPACE}")
        if len(label) > room and "$" not in label:
            one.set_ylabel(textwrap.fill(label, max(room, 1), break_long_words=False))


def _greek(found: re.Match[str]) -> str:
    """The letter that a command of mathematics stands for; nothing where it is no letter."""
    try:
        return unicodedata.lookup(f"GREEK SMALL LETTER {found[1].upper()}")
    except KeyError:
        return ""


def picture_width(picture: Picture) -> float:
    """Width [in] of a picture, reduced where a page has not the room for it; of one to scale, where paper has not."""
    if picture.to_scale:
        return min(picture.width, PAPER_WIDTH)
    found = _SIZE.search(picture.svg[:2000])
    if found is None:
        return min(picture.width, TEXT_WIDTH)
    height, width, box_width, box_height = (float(one) if one else 0.0 for one in found.groups())
    slope = (height or box_height) / (width or box_width or 1.0)
    return min(picture.width, TEXT_WIDTH, TEXT_HEIGHT / slope if slope else TEXT_WIDTH)
