"""The mathematical font of a page: the letters that stand on it, and no others."""

from __future__ import annotations

import base64
import functools
import io
import unicodedata
from collections.abc import Iterable
from pathlib import Path

from fontTools import subset
from fontTools.ttLib import TTFont

FONT = Path(__file__).with_name("math-font.woff")
"""All letters that formulas can hold."""
FEATURES = ["ssty", "dtls", "flac", "kern", "mark", "mkmk", "ccmp", "locl"]
"""What lays out mathematics."""
NAMES = [0, 1, 2, 13, 14]
"""Copyright, family, style and licence."""


def font_letters(formulas: frozenset[str], names: Iterable[str], page: str) -> frozenset[str]:
    """The letters that a page takes from its font: those of formulas, of names in motions, and signs in its texts."""
    signs = (
        letter for letter in set(page) if not letter.isspace() and unicodedata.category(letter)[0] in "SPN"
    )
    return formulas.union(" ", "".join(names), signs)


@functools.lru_cache(maxsize=64)
def cut_font(letters: frozenset[str], source: str | Path = FONT) -> bytes:
    """A font with these letters alone (WOFF); the same letters give the same bytes."""
    options = subset.Options()
    options.layout_features = FEATURES
    options.name_IDs = NAMES
    options.hinting = False
    stream = io.BytesIO()
    # lazy: of most tables only what these letters need is read, so the file stays open until the font is closed
    with TTFont(source, recalcTimestamp=False, lazy=True) as font:
        cut = subset.Subsetter(options)
        cut.populate(unicodes=sorted(map(ord, letters)))
        cut.subset(font)
        font.flavor = "woff"
        font.save(stream)
    return stream.getvalue()


def embedded_font(letters: frozenset[str]) -> str:
    """The font as style sheets hold it."""
    return base64.b64encode(cut_font(letters)).decode()
