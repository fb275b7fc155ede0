"""Signs of forces on a page: arrows, moments, and the names of forces as mathematical text."""

from __future__ import annotations

import re
from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from centrode.render.drawing import signs
from centrode.render.drawing.style import INK
from centrode.render.drawing.texts import plain
from centrode.render.pages.page import Array, Page, arrow, flat

NAME = re.compile(r"([−]?)(MΦ|Mz|Mb|Fb|[RGΦFM])(\d+(?:,\d+)?)?([ⁿᵗ]?)(′*)(\([^()]*\))?")
LETTERS = {
    "MΦ": r"M_{\Phi %s}",
    "Φ": r"\Phi_{%s}",
    "Mz": "M_{z%s}",
    "Mb": r"M_{\mathrm{b}%s}",
    "Fb": r"F_{\mathrm{b}%s}",
}
MARKS = {"ⁿ": "^{n}", "ᵗ": "^{t}", "": ""}
SHORTEST, LONGEST = 8.0, 20.0
"""Arrows at the places where forces act are this long on a page [mm]: they show directions, the polygon sizes."""
LONGER = 1.3
"""How much longer they are on a sheet with larger signs, at most: names of forces at one place stand apart."""
LIKE = 0.97
"""Cosine from which two forces at one place are drawn on both sides of it."""
TURN = 4.0
"""Radius of the arc of a moment [mm]."""


def force_name(name: str) -> str:
    """The name of a force as mathematical text."""
    found = NAME.fullmatch(name)
    if found is None:
        return plain(name)
    sign, letter, number, mark, primes, rest = found.groups()
    below = LETTERS.get(letter, letter + "_{%s}") % (number or "")
    minus = "-" if sign else ""
    return f"${minus}{below.replace('_{}', '')}{MARKS[mark]}$" + plain((primes or "") + (rest or ""))


def force_arrows(
    page: Page, forces: Sequence[tuple[str, complex, Array, str]], longest: float = LONGEST
) -> None:
    """Arrows at places on the page [mm]: (name, force, place, colour); lengths grow with the root of the force."""
    greatest = max((abs(force) for _name, force, _place, _colour in forces), default=0.0)
    taken: list[tuple[Array, complex]] = []
    for name, force, place, colour in forces:
        if abs(force) <= 1e-12 * greatest or force == 0:
            continue
        unit = force / abs(force)
        length = min(page.signs, LONGER) * max(SHORTEST, longest * (abs(force) / greatest) ** 0.5)
        step = flat([length * unit])[0]
        crowded = along_a_line(page, place, unit) or any(
            np.hypot(*(place - at)) < 1.0 and (unit * other.conjugate()).real > LIKE for at, other in taken
        )
        start = place - step if crowded else place
        taken.append((place, -unit if crowded else unit))
        arrow(page, start, start + step, colour, width=1.2)
        page.name(start if crowded else start + step, force_name(name), clear=0.9, size=8.5, colour=colour)


def along_a_line(page: Page, place: Array, unit: complex) -> bool:
    """Whether an arrow that begins at a place would lie on a line that ends there."""
    for first, second in page.segments:
        for end, other in ((first, second), (second, first)):
            way = complex(*(other - end))
            if np.hypot(*(end - place)) < 0.3 and (unit.conjugate() * way).real > LIKE * abs(way) > 0.0:
                return True
    return False


def moment_arc(page: Page, place: Array, moment: float, name: str, colour: str = INK) -> None:
    """An arc with a head about a place [mm]: a moment, counter-clockwise where positive."""
    arc = np.pi / 2 + np.linspace(-2.0, 2.0, 25) * (1.0 if moment > 0 else -1.0)
    path = place + TURN * np.stack([np.cos(arc), np.sin(arc)], axis=1)
    signs.turning_arrow(page.overlay, path, colour)
    page.avoid(pairwise(path))
    page.name(path[12], force_name(name), clear=0.8, size=8.5, colour=colour)
