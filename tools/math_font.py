"""Cut the mathematical font of pages out of STIX Two Math: `python tools/math_font.py STIXTwoMath-Regular.ttf`.

Needs fonttools. The same font gives the same bytes. The letters are those that formulas and names can hold:
Latin, Greek and Cyrillic, mathematical italic, upright and bold, operators, arrows, brackets that grow. Of these each
page holds those that stand on it.
"""

from __future__ import annotations

import sys

from centrode.report.html import fonts

RANGES = (
    (0x20, 0x7E), (0xA0, 0x17F), (0x237, 0x237), (0x2B0, 0x2FF), (0x300, 0x338), (0x370, 0x3FF),
    (0x400, 0x45F), (0x490, 0x491), (0x2010, 0x2044), (0x2070, 0x209C), (0x20D0, 0x20E0), (0x2102, 0x2116),
    (0x2190, 0x2195), (0x21D0, 0x21D5), (0x2200, 0x22FF), (0x2308, 0x230B), (0x239B, 0x23B7), (0x23DC, 0x23E1),
    (0x25A0, 0x25FF), (0x2713, 0x2717), (0x27E8, 0x27E9), (0x2A00, 0x2A06), (0x1D400, 0x1D49B), (0x1D6A4, 0x1D755),
)  # fmt: skip


def main() -> None:
    """Cut the font."""
    letters = frozenset(chr(code) for first, last in RANGES for code in range(first, last + 1))
    fonts.FONT.write_bytes(fonts.cut_font(letters, sys.argv[1]))
    print(f"{fonts.FONT}: {fonts.FONT.stat().st_size} bytes")


if __name__ == "__main__":
    main()
