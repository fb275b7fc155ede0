"""The browser that the tests of a module share: to start one takes seconds."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

from report.browser import browser


@pytest.fixture(scope="module")
def running() -> Iterator[Any]:
    """A browser without windows."""
    with browser() as one:
        yield one
