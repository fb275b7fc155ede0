from __future__ import annotations

from collections.abc import Iterator

import pytest

from blank_canvas import blank_pictures


@pytest.fixture(autouse=True)
def pictures(request: pytest.FixtureRequest) -> Iterator[None]:
    """Pictures of chapters and files are made but not rendered, except in tests marked `drawn`."""
    if request.node.get_closest_marker("drawn") and not request.config.getoption("--blank"):
        yield
        return
    with blank_pictures():
        yield
