"""How many random cases the suite looks at: a fixed sample of them; `make samples` looks at all."""

from __future__ import annotations

import os
from collections.abc import Iterable
from typing import TypeVar

Cases = TypeVar("Cases")
ALL = os.environ.get("CENTRODE_SAMPLES") == "all"


def few(some: Cases, whole: Cases) -> Cases:
    """Some of the cases of a random sample, or the whole of it where all are asked for."""
    return whole if ALL else some


SLOW = ("scissor-lift-cylinder",)
"""Examples whose motion takes seconds: its groups are of higher class with many circles about change points."""


def examples_at_hand(names: Iterable[str]) -> list[str]:
    """Examples for a test whose statement does not hang on the slow ones; all of them where all are asked for.

    Motion, copies, reactions and limits of the slow ones are looked at always.
    """
    return [name for name in names if ALL or name not in SLOW]
