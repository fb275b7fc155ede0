"""Names and lists of names as sentences have them."""

from __future__ import annotations

from collections.abc import Iterable

from centrode.locale import _
from centrode.model.reading import two_points


def called(name: str) -> str:
    """A link's name, in quotes where it is a word: crank OA, but crank "crank"."""
    if two_points(name) is not None or len(name) < 3:
        return name
    # Translators: a name in quotation marks
    return _('"{name}"').format(name=name)


def listed(names: Iterable[str]) -> str:
    """Names with commas and an "and" before the last."""
    every = list(names)
    if len(every) < 2:
        return "".join(every)
    # Translators: the last two of a list of names, such as "AC and CB"
    return _("{names} and {last}").format(names=", ".join(every[:-1]), last=every[-1])


def links_listed(names: Iterable[str]) -> str:
    """Names of links as a list."""
    return listed(map(called, names))
