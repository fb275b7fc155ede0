"""How many random cases the suite looks at: a fixed sample of them; `make samples` looks at all."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from typing import TypeVar

Case = TypeVar("Case")
Cases = TypeVar("Cases")
ALL = os.environ.get("CENTRODE_SAMPLES") == "all"


def few(some: Cases, whole: Cases) -> Cases:
    """Some of the cases of a random sample, or the whole of it where all are asked for."""
    return whole if ALL else some


def spread(cases: Sequence[Case], count: int) -> list[Case]:
    """So many of the cases, spread evenly from the first to the last; all of them where all are asked for."""
    if ALL or count >= len(cases):
        return list(cases)
    return [cases[k * (len(cases) - 1) // (count - 1)] for k in range(count)]


SLOW = ("scissor-lift-cylinder",)
"""Examples whose motion takes seconds: its groups are of higher class with many circles about change points."""


def examples_at_hand(names: Iterable[str]) -> list[str]:
    """Examples for a test whose statement does not hang on the slow ones; all of them where all are asked for.

    The motion of the slow ones is looked at always.
    """
    return [name for name in names if ALL or name not in SLOW]
