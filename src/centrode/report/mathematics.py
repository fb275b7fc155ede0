"""Mathematics of reports in typst's notation: nothing in it may be code, and long formulas can be taken apart."""

from __future__ import annotations

import re
from itertools import pairwise

from centrode.render.document.blocks import SystemBlock

_STRING = re.compile(r'"(?:[^"\\]|\\.)*"')
_CODE = re.compile(r'[#$@`"\\&]|//|/\*')
_ESCAPED = re.compile(r"\\[/()|,;]")
_NAME = re.compile(r"[\w.]$")
LONG = 90
"""Letters of typst in a piece beyond which it is cut further."""
_WAVES = ("sin", "cos", "tan", "arcsin", "arccos", "arctan", "exp", "ln")


def check_formula(formula: str) -> str:
    """The formula; ValueError, which is a fault of whoever made it, for what only code or text could need."""
    if _CODE.search(_ESCAPED.sub("x", _STRING.sub("x", formula))):
        raise ValueError(f"not a formula: {formula!r}")
    return formula


def pieces_of(formula: str, depth: int = 0) -> list[str]:
    """A formula cut before its plus and minus signs.

    With a `depth` of 1 also inside one bracket, but never inside of a function or of an angle; a bracket that is cut
    is written so that typst takes its two sides for themselves.
    """
    places, opened = _signs(formula, depth)
    if not places:
        return [formula]
    apart = list(formula)
    for place in opened:
        apart[place] = f"\\{apart[place]}"
    ends = [0, *places, len(formula)]
    return ["".join(apart[first:last]).strip() for first, last in pairwise(ends)]


def fragments_of(spelled: str) -> list[str]:
    """The pieces that a formula is laid out in; long ones are cut inside of their bracket as well."""
    found = []
    for piece in pieces_of(check_formula(spelled)):
        found += pieces_of(piece, depth=1) if len(piece) > LONG else [piece]
    return found


def relations_of(system: SystemBlock) -> list[tuple[str, ...]]:
    """The equations of a system that no page is wide enough for."""
    lines: list[tuple[str, ...]] = []
    for row, right in zip(system.matrix, system.right, strict=True):
        terms = [
            _term(entry, unknown) for entry, unknown in zip(row, system.unknowns, strict=True) if entry != "0"
        ]
        text = " + ".join(terms).replace("+ -", "- ") or "0"
        lines.append((text, right))
    return lines


def _term(entry: str, unknown: str) -> str:
    if entry in ("1", "-1"):
        return f"{entry[:-1]}{unknown}"
    several = len(pieces_of(entry)) > 1
    return f"({entry}) {unknown}" if several else f"{entry} {unknown}"


def _signs(formula: str, depth: int) -> tuple[list[int], list[int]]:
    """Where a formula is cut, and the brackets that are open there and their partners."""
    places: list[int] = []
    opened: list[int] = []
    stack: list[tuple[int, bool, bool]] = []  # place of a bracket, whether it may be cut, whether it is
    text = _STRING.sub(lambda found: "x" * len(found[0]), formula)
    for i, letter in enumerate(text):
        if letter == "(":
            stack.append((i, _is_plain(text, i), False))
        elif letter == ")" and stack:
            place, _plain, cut = stack.pop()
            opened += [place, i] if cut else []
        elif letter in "+-" and text[i - 1 : i] == " " == text[i + 1 : i + 2]:
            if len(stack) > depth or not all(plain for _place, plain, _cut in stack):
                continue
            places.append(i)
            stack = [(place, plain, True) for place, plain, _cut in stack]
    return places, opened


def _is_plain(text: str, place: int) -> bool:
    """Whether a bracket is no function's, no index's and no angle's."""
    before = text[:place]
    if before and (_NAME.search(before) or before[-1] in "_^"):
        return False
    word = re.search(r"(\w+)(?:\^\([^()]*\))?\s*$", before)
    return word is None or word[1] not in _WAVES
