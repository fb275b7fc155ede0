from __future__ import annotations

from collections.abc import Iterator

import pytest

from blank_canvas import blank_pictures
from computed_once import computed_once


@pytest.fixture(autouse=True)
def pictures(request: pytest.FixtureRequest) -> Iterator[None]:
    """Pictures are made but not rendered, except in tests marked `drawn`: some of each room, and all that look."""
    if request.node.get_closest_marker("drawn") and not request.config.getoption("--blank"):
        yield
        return
    with blank_pictures():
        yield


@pytest.fixture(autouse=True)
def shared() -> Iterator[None]:
    """What reports and variants compute of a mechanism is computed once for all tests."""
    with computed_once():
        yield
