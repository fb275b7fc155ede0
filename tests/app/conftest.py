"""A workbench in the process of the test, its server behind starlette's client, and one that browsers are shown."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from centrode.app.answers import Workbench
from centrode.app.folders import WorkFolder
from centrode.app.server import ServerSettings, server_application
from centrode.app.workers import DirectRunner

from .served import Served, served

PORT = 8123
ORIGIN = f"http://127.0.0.1:{PORT}"


@pytest.fixture
def ask(tmp_path: Path) -> Callable[..., Any]:
    """Answers of a workbench whose folder is empty."""
    bench = Workbench(WorkFolder(tmp_path.resolve()))
    return lambda do, **message: bench.answer({"id": 1, "do": do, **message})


@pytest.fixture
def settings(tmp_path: Path) -> ServerSettings:
    """Of a server on the folder of the test."""
    return ServerSettings(WorkFolder(tmp_path.resolve()), PORT)


@pytest.fixture
def client(settings: ServerSettings) -> Iterator[Any]:
    """A browser of this machine, whose pages the server itself has given."""
    testing = pytest.importorskip("starlette.testclient")
    application = server_application(settings, DirectRunner)
    with testing.TestClient(application, base_url=ORIGIN, headers={"Origin": ORIGIN}) as made:
        yield made


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    """Of the browsers of a module, in a folder of its own."""
    pytest.importorskip("starlette", reason="no starlette: pip install centrode[app]")
    pytest.importorskip("uvicorn", reason="no uvicorn: pip install centrode[app]")
    with served(tmp_path_factory.mktemp("bench")) as one:
        yield one
