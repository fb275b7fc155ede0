"""Where figures stand on paper: none leaves a page much less than two thirds full before the end of its chapter.

Typst puts a figure at the top of the page where the text comes to it, or of the next one if too little of the page is
left. It cannot move text that stands on the page already. So at the end of a chapter a figure that just found no room,
before another one as high, has a page of its own. A few lines earlier it stands above this text, which fills the page
behind it.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

# lines of the source of a document, see `style.typ`
FLOATING = "#floating-picture("
CHAPTER_END = "#chapter-end"
ENDS = ("#heading(level: 1,", "#element(level: 1,", "#appendix(", "#show", "#sentences[", CHAPTER_END)
"""How lines begin that no figure goes before, as it stays in its chapter."""
STEPS = (1, 2, 3, 5, 8, 13, 21, 34)
"""Lines of the source by which figures go earlier, tried one after another."""
LEAST_FULL = 0.6

Place = tuple[int, float]
"""A page, from 1, and how far below its upper edge [points]."""

EXPRESSION = """(<chapter-end>, <figure-end>).map(which => query(which).map(it => {
  let place = it.location().position()
  (place.page, place.y / 1pt)
}))"""
"""What typst tells of a document: ends of chapters and lower ends of figures, each as places."""


@dataclass(frozen=True)
class Layout:
    """Where things stand in a document, each in its order.

    Attributes
    ----------
    ends : of the text of chapters
    figures : lower ends of figures that float
    """

    ends: tuple[Place, ...]
    figures: tuple[Place, ...]

    @classmethod
    def read(cls, told: str) -> Layout:
        """What typst tells by `EXPRESSION`."""
        ends, figures = (tuple((page, y) for page, y in places) for places in json.loads(told))
        return cls(ends, figures)


def well_placed(text: str, layout_of: Callable[[str], Layout], top: float, height: float) -> str:
    """The source of a document, with figures earlier whose pages would be too empty.

    A figure goes no earlier than it has to. Where that mends nothing it stays. That another page becomes too empty
    behind it is no reason: the figure of that one is tried next.

    Parameters
    ----------
    layout_of : lays out a source
    top, height : of the text of a page [points]
    """
    lines = text.splitlines()
    alone = list(lonely_figures(lines, layout_of(text), top, height))
    refused: set[int] = set()
    while left := [figure for figure in alone if figure not in refused]:
        for tried in _earlier(lines, left[0]):
            found = list(lonely_figures(tried, layout_of("\n".join(tried)), top, height))
            later = all(figure > left[0] for figure in found if figure not in alone)
            if len(found) < len(alone) or (len(found) == len(alone) and left[0] not in found and later):
                lines, alone = tried, found
                break
        else:
            refused.add(left[0])
    return "\n".join(lines)


def lonely_figures(lines: Sequence[str], layout: Layout, top: float, height: float) -> Iterator[int]:
    """For each page too empty that its chapter goes on behind: the figure that would fill it, from 0.

    These are pages at the end of a chapter, whose text has ended or ends there, and another page begins with a figure.
    """
    first = 0
    chapters = (line for line in lines if line.startswith((FLOATING, CHAPTER_END)))
    counts = _floating_figures(chapters)
    for (last_page, end), count in zip(layout.ends, counts, strict=False):
        mine = range(first, first + count)
        first += count
        filled = {last_page: end}
        leading: dict[int, int] = {}
        for figure in mine:
            page, low = layout.figures[figure]
            if page > last_page:
                filled[page] = max(low, filled.get(page, 0.0))
                leading.setdefault(page, figure)
        for page, low in filled.items():
            if low - top < LEAST_FULL * height and page + 1 in leading:
                # text of the page before goes behind its own figure, or that of the next page before its text
                yield leading.get(page, leading[page + 1])


def _floating_figures(lines: Iterator[str]) -> Iterator[int]:
    """How many figures float in each chapter."""
    count = 0
    for line in lines:
        if line.startswith(CHAPTER_END):
            yield count
            count = 0
        else:
            count += 1


def _earlier(lines: Sequence[str], figure: int) -> Iterator[list[str]]:
    """The lines with a figure before ever more of those before it; then together with the figure before it."""
    figures = [number for number, line in enumerate(lines) if line.startswith(FLOATING)]
    groups = [figures[figure : figure + 1]]
    if figure and not any(line.startswith(ENDS) for line in lines[figures[figure - 1] : figures[figure]]):
        groups.append(figures[figure - 1 : figure + 1])
    for group in groups:
        room = 0
        for line in reversed(lines[: group[0]]):
            if line.startswith((FLOATING, *ENDS)):
                break
            room += 1
        others = [line for number, line in enumerate(lines) if number not in group]
        for step in sorted({min(step, room) for step in STEPS} if room else ()):
            before = group[0] - step
            yield [*others[:before], *(lines[number] for number in group), *others[before:]]
