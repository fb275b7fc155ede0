"""What room a figure has: the width of the text of a document, or the width that a screen has for it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar

PAGE_WIDTH, PAGE_HEIGHT = 6.3, 8.2
"""The most a figure may take of a page [inch]: the width of the text, and its height less a caption."""
LEAST_WIDTH = 3.0
"""A figure is never narrower [inch]: its labels would leave nothing of its panels."""
_SCREEN: ContextVar[float | None] = ContextVar("width of a screen", default=None)


@contextmanager
def screen_of_width(width: float | None) -> Iterator[None]:
    """Context in which figures are drawn for a screen with room of a width [inch]; with None for a page."""
    before = _SCREEN.set(None if width is None else max(width, LEAST_WIDTH))
    try:
        yield
    finally:
        _SCREEN.reset(before)


def screen_width() -> float | None:
    """The room of the screen that a figure is drawn for [inch]; None on a page, where drawings keep their scales."""
    return _SCREEN.get()


def figure_width() -> float:
    """How wide a figure is [inch]: as the text of a page, or less where the screen has less."""
    screen = _SCREEN.get()
    return PAGE_WIDTH if screen is None else min(PAGE_WIDTH, screen)


def count_across(most: int) -> int:
    """How many columns, or ticks, stand beside each other in a figure, of which a page has at most so many."""
    return max(1, round(most * figure_width() / PAGE_WIDTH))
