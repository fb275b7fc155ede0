"""Computations beside the server: processes that may be stopped, so that none that is stuck holds up the others."""

from __future__ import annotations

import asyncio
import json
import multiprocessing
import sys
import threading
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import dataclass, field
from multiprocessing.connection import Connection
from typing import Any, Protocol, TypeAlias

from centrode.app.folders import WorkFolder
from centrode.topics.topic import Lazily

Reply: TypeAlias = str | bytes
"""JSON as text, or a frame."""

WORKBENCH = Lazily("centrode.app.answers", "Workbench")
PRELOADED = ("centrode.app.answers",)
"""What a process has loaded before it begins: with this, another one begins at once."""
GREATEST_MEMORY = 450_000_000
"""Bytes after which a process makes room for another one."""
ENDING = 2.0
"""Seconds that a process has to end."""


class TimedOut(Exception):
    """A computation took longer than it may."""


class Runner(Protocol):
    """What answers messages."""

    async def answer(self, message: Mapping[str, Any], limit: float) -> Reply:
        """The answer of a message; raises TimedOut after so many seconds."""

    def stop(self) -> None:
        """Stop what it computes; another message begins afresh."""


def reply_of(answer: dict[str, Any] | bytes) -> Reply:
    """An answer as it is sent."""
    return answer if isinstance(answer, bytes) else json.dumps(answer, ensure_ascii=False, allow_nan=False)


def serve_messages(connection: Connection, work: WorkFolder) -> None:
    """The loop of a process: a message in, an answer out."""
    bench = WORKBENCH(work)
    while True:
        try:
            message = json.loads(connection.recv_bytes())
        except (EOFError, OSError, KeyboardInterrupt):
            return
        reply = answered(bench, message)
        content = reply.encode() if isinstance(reply, str) else reply
        try:
            connection.send_bytes((b"t" if isinstance(reply, str) else b"b") + content)
        except OSError:
            return
        if _memory() > GREATEST_MEMORY:
            return


def answered(bench: Any, message: Mapping[str, Any]) -> Reply:
    """The answer of a workbench; a fault of the program is an answer that says so."""
    try:
        return reply_of(bench.answer(message))
    except Exception as fault:
        return reply_of(bench.fault(message, fault))


def _memory() -> int:
    """Greatest memory [bytes] that this process has had; 0 where the system does not say."""
    try:
        import resource  # noqa: PLC0415 (Windows has none)
    except ImportError:
        return 0
    used = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return used if sys.platform == "darwin" else used * 1024


@dataclass
class ProcessRunner:
    """Answers messages in a process of its own, one at a time."""

    work: WorkFolder
    _process: Any = None
    _connection: Connection | None = None
    _guard: threading.Lock = field(default_factory=threading.Lock)
    _turn: asyncio.Lock = field(default_factory=asyncio.Lock)
    _threads: ThreadPoolExecutor = field(default_factory=lambda: ThreadPoolExecutor(max_workers=1))

    async def answer(self, message: Mapping[str, Any], limit: float) -> Reply:
        """The answer of a message; TimedOut after so many seconds, and the process is stopped."""
        async with self._turn:
            content = json.dumps(message).encode()
            # a process begins in the thread too: the server answers others meanwhile
            waiting = asyncio.get_running_loop().run_in_executor(self._threads, self._asked, content)
            try:
                reply = await asyncio.wait_for(asyncio.shield(waiting), limit)
            except (TimeoutError, asyncio.CancelledError):
                # a process that is about to begin is waited for, but not by the server
                await asyncio.shield(asyncio.to_thread(self.stop))
                with suppress(Exception):
                    await waiting
                raise
            except (EOFError, OSError):
                # it made room, or the system stopped it: once more in a new one
                self.stop()
                waiting = asyncio.get_running_loop().run_in_executor(self._threads, self._asked, content)
                reply = await asyncio.wait_for(waiting, limit)
            return reply

    def _asked(self, content: bytes) -> Reply:
        return _exchange(self._started(), content)

    def _started(self) -> Connection:
        with self._guard:
            return self._started_alone()

    def _started_alone(self) -> Connection:
        if self._connection is not None and self._process is not None and self._process.is_alive():
            return self._connection
        self._stop_alone()
        methods = multiprocessing.get_all_start_methods()
        context: Any = multiprocessing.get_context("forkserver" if "forkserver" in methods else "spawn")
        if "forkserver" in methods:
            context.set_forkserver_preload(list(PRELOADED))
        here: Connection
        here, there = context.Pipe()
        process = context.Process(target=serve_messages, args=(there, self.work), daemon=True)
        process.start()
        there.close()
        self._process, self._connection = process, here
        return here

    def stop(self) -> None:
        """Stop the process; the next message starts another one."""
        with self._guard:
            self._stop_alone()

    def _stop_alone(self) -> None:
        if self._connection is not None:
            with suppress(OSError):
                self._connection.close()
        if self._process is not None:
            self._process.kill()
            self._process.join(ENDING)
        self._process = self._connection = None


def _exchange(connection: Connection, content: bytes) -> Reply:
    connection.send_bytes(content)
    reply = connection.recv_bytes()
    return reply[1:].decode() if reply[:1] == b"t" else reply[1:]


class DirectRunner:
    """Answers messages in the process of the server, one at a time: for tests."""

    def __init__(self, work: WorkFolder) -> None:
        self._bench = WORKBENCH(work)

    async def answer(self, message: Mapping[str, Any], limit: float) -> Reply:
        """The answer of a message."""
        return answered(self._bench, json.loads(json.dumps(message)))

    def stop(self) -> None:
        """Nothing is to be stopped."""
