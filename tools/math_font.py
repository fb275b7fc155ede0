"""Cut the mathematical fonts of pages out of STIX Two Math: `python tools/math_font.py STIXTwoMath-Regular.ttf`.

Needs fonttools and brotli. The same font gives the same bytes. The letters are those that formulas and names can hold:
Latin, Greek and Cyrillic, mathematical italic, upright and bold, operators, arrows, brackets that grow. The smaller
font has those of nearly every page; `common` in the place of the font cuts it anew out of the greater one.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable
from pathlib import Path

from fontTools import subset
from fontTools.ttLib import TTFont

from centrode.report.html.mathematics import COMMON_LETTERS

TARGET = Path(__file__).parent.parent / "src" / "centrode" / "report" / "html" / "math-font.woff2"
RANGES = (
    (0x20, 0x7E), (0xA0, 0x17F), (0x237, 0x237), (0x2B0, 0x2FF), (0x300, 0x338), (0x370, 0x3FF),
    (0x400, 0x45F), (0x490, 0x491), (0x2010, 0x2044), (0x2070, 0x209C), (0x20D0, 0x20E0), (0x2102, 0x2116),
    (0x2190, 0x2195), (0x21D0, 0x21D5), (0x2200, 0x22FF), (0x2308, 0x230B), (0x239B, 0x23B7), (0x23DC, 0x23E1),
    (0x25A0, 0x25FF), (0x2713, 0x2717), (0x27E8, 0x27E9), (0x2A00, 0x2A06), (0x1D400, 0x1D49B), (0x1D6A4, 0x1D755),
)  # fmt: skip
COMMON = TARGET.with_name("math-font-common.woff2")
FEATURES = ["ssty", "dtls", "flac", "kern", "mark", "mkmk", "ccmp", "locl"]
NAMES = [0, 1, 2, 13, 14]


def cut_font(source: str | Path, target: Path, ranges: Iterable[tuple[int, int]]) -> None:
    """Write the letters of ranges of a font, with what lays out mathematics."""
    options = subset.Options()
    options.layout_features = FEATURES
    options.name_IDs = NAMES
    options.hinting = False
    options.recalc_timestamp = False
    font = TTFont(source, recalcTimestamp=False)
    cut = subset.Subsetter(options)
    cut.populate(unicodes=[code for first, last in ranges for code in range(first, last + 1)])
    cut.subset(font)
    font.flavor = "woff2"
    font.save(target)
    print(f"{target}: {target.stat().st_size} bytes, {len(font.getGlyphOrder())} glyphs")


def main() -> None:
    """Cut both fonts, or the smaller one alone."""
    if sys.argv[1] != "common":
        cut_font(sys.argv[1], TARGET, RANGES)
    cut_font(TARGET, COMMON, COMMON_LETTERS)


if __name__ == "__main__":
    main()
