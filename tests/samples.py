"""How many random cases the suite looks at: a fixed sample of them; `make samples` looks at all."""

from __future__ import annotations

import os
from typing import TypeVar

Cases = TypeVar("Cases")
ALL = os.environ.get("CENTRODE_SAMPLES") == "all"


def few(some: Cases, whole: Cases) -> Cases:
    """Some of the cases of a random sample, or the whole of it where all are asked for."""
    return whole if ALL else some
