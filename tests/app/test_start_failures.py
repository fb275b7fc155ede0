"""A process that cannot start: a few tries, a sentence that says why, and a server that goes on."""

from __future__ import annotations

import asyncio
import multiprocessing
import os
import signal
from pathlib import Path
from typing import Any

import pytest

from centrode.app import workers
from centrode.app.folders import WorkFolder
from centrode.app.server import ServerSettings, server_application
from centrode.app.workers import STARTS, DirectRunner, ProcessRunner, StartFailure, serve_messages

from .conftest import ORIGIN, PORT
from .test_server import SOCKET

TEXT, OTHER = "[frame.points]\nO = [0, 0]\n", "[frame.points]\nO = [0, 1]\n"


def end_at_once(tally: str) -> None:
    """What a process meets before its first word."""
    with Path(tally).open("a", encoding="ascii") as file:
        file.write("x")
    os._exit(7)


class Deadly(WorkFolder):
    """A folder with which no process begins."""

    def __reduce__(self) -> tuple[Any, ...]:
        return end_at_once, (str(self.folder / "tally"),)


@pytest.fixture
def deadly(tmp_path: Path) -> Deadly:
    (tmp_path / "tally").write_text("", "ascii")
    return Deadly(tmp_path.resolve())


def started(work: WorkFolder) -> int:
    """Processes that have been started."""
    return len((work.folder / "tally").read_text("ascii"))


def test_tries_are_few_and_another_text_has_its_own(deadly: Deadly, monkeypatch: pytest.MonkeyPatch) -> None:
    """Each text starts so many; the same one again, also by its digest, starts none."""
    assert 1 < STARTS < 5
    monkeypatch.setattr(workers, "STARTS", 2)
    runner = ProcessRunner(deadly)

    async def told(**message: Any) -> str:
        with pytest.raises(StartFailure) as failure:
            await runner.answer({"do": "read", **message}, 60.0)
        return failure.value.reason

    async def talk() -> None:
        for message, tries in (
            ({"text": TEXT}, 1),
            ({"text": TEXT}, 1),
            ({"digest": workers.digest_of(TEXT)}, 1),
            ({"text": OTHER}, 2),
        ):
            assert await told(**message) == "exit code 7"
            assert started(deadly) == 2 * tries

    try:
        asyncio.run(talk())
    finally:
        runner.end()


def test_the_page_is_told_and_the_rest_goes_on(deadly: Deadly) -> None:
    """What takes longer has no process: panels say so in the language, and descriptions are read all the same."""
    testing = pytest.importorskip("starlette.testclient")
    runners = [DirectRunner(WorkFolder(deadly.folder)), ProcessRunner(deadly)]
    settings = ServerSettings(WorkFolder(deadly.folder), PORT)
    application = server_application(settings, lambda _work: runners.pop(0))  # type: ignore[return-value]
    with (
        testing.TestClient(application, base_url=ORIGIN, headers={"Origin": ORIGIN}) as client,
        client.websocket_connect(f"{SOCKET}?token={settings.token}") as socket,
    ):
        for number, (language, words) in enumerate(
            (("en", "does not start: exit code 7"), ("uk", "exit code 7"))
        ):
            socket.send_json(
                {"id": number, "do": "panel", "text": TEXT, "topic": "check", "language": language}
            )
            answer = socket.receive_json()
            assert answer["id"] == number
            assert words in answer["error"]["message"] and answer["error"]["repair"]
            socket.send_json({"id": 9, "do": "read", "text": TEXT})
            assert "scene" in socket.receive_json()
        assert "does not start" not in answer["error"]["message"]


def test_a_process_says_why_it_cannot_compute(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A library that is missing: its name is the first word of the process, and its last."""

    def missing(_work: WorkFolder) -> None:
        raise ModuleNotFoundError("No module named 'shapes'")

    monkeypatch.setattr(workers, "WORKBENCH", missing)
    here, there = multiprocessing.Pipe()
    before = signal.getsignal(signal.SIGINT)
    try:
        serve_messages(there, WorkFolder(tmp_path))
    finally:
        signal.signal(signal.SIGINT, before)
    runner = ProcessRunner(WorkFolder(tmp_path))
    with pytest.raises(StartFailure, match="No module named 'shapes'"):
        runner._meet(here)
    here.close()
    there.close()
