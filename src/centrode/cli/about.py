"""Which file a failure is about, where only its parts are named."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from centrode.errors import CentrodeError


@contextmanager
def about(mechanism: str) -> Iterator[None]:
    """Put the file or example in front of the place that a failure inside names."""
    try:
        yield
    except CentrodeError as failure:
        where = f"{mechanism}, {failure.where}" if failure.where else mechanism
        raise type(failure)(where, failure.what, failure.repair) from failure
