"""The texts of a report, for tests of what it says."""

from __future__ import annotations


def texts_of(part: object) -> list[str]:
    """Every text of a part of a report, however deep."""
    if isinstance(part, str):
        return [part]
    if isinstance(part, tuple):
        return [text for one in part for text in texts_of(one)]
    return texts_of(tuple(vars(part).values())) if hasattr(part, "__dict__") else []
