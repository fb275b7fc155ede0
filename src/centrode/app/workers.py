"""Computations beside the server: processes that may be stopped, so that none that is stuck holds up the others."""

from __future__ import annotations

import asyncio
import json
import multiprocessing
import os
import signal
import sys
import threading
import traceback
from collections.abc import Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from multiprocessing import resource_tracker
from multiprocessing.connection import Connection
from typing import Any, Protocol, TypeAlias

from centrode.app.documents import digest_of
from centrode.app.folders import WorkFolder
from centrode.topics.topic import Lazily

if sys.platform != "win32":
    import resource

Reply: TypeAlias = str | bytes
"""JSON as text, or a frame."""

WORKBENCH = Lazily("centrode.app.answers", "Workbench")
PRELOADED = ("centrode.app.answers",)
"""What a process has loaded before it begins: with this, another one begins at once."""
GREATEST_MEMORY = 450_000_000
"""Bytes after which a process makes room for another one."""
ENDING = 2.0
"""Seconds that a process has to end."""
STARTS = 3
"""Processes that are started for one message; after that it is said that none starts."""
READY, FAILED = b"r", b"f"
"""The first word of a process: it answers from now on, or it cannot, with the reason behind."""
REASON = 500
"""Letters of the reason for which a process does not start."""


class StartFailure(EOFError):
    """No process starts that would compute.

    Attributes
    ----------
    reason : what the process said last, or how it ended
    """

    def __init__(self, reason: str) -> None:
        self.reason = reason
        super().__init__(reason)


class Runner(Protocol):
    """What answers messages."""

    async def answer(self, message: Mapping[str, Any], limit: float) -> Reply:
        """The answer of a message; raises TimeoutError after so many seconds."""

    def stop(self) -> None:
        """Stop what it computes; another message begins afresh."""

    def end(self) -> None:
        """Stop for good: no message is answered any more."""


def reply_of(answer: dict[str, Any] | bytes) -> Reply:
    """An answer as it is sent."""
    return answer if isinstance(answer, bytes) else json.dumps(answer, ensure_ascii=False, allow_nan=False)


def serve_messages(connection: Connection, work: WorkFolder) -> None:
    """The loop of a process: a message in, an answer out."""
    # Ctrl-C reaches all processes of a terminal, but the server ends this one
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_server, daemon=True).start()
    try:
        bench = WORKBENCH(work)
    except Exception as fault:
        said = "".join(traceback.format_exception_only(fault)).strip()[-REASON:]
        connection.send_bytes(FAILED + said.encode(errors="replace"))
        return
    connection.send_bytes(READY)
    while True:
        try:
            message = json.loads(connection.recv_bytes())
        except (EOFError, OSError, KeyboardInterrupt):
            return
        reply = reply_to(bench, message)
        # half a pair of surrogates is no letter: JSON can hold it, UTF-8 cannot
        content = reply.encode(errors="replace") if isinstance(reply, str) else reply
        try:
            connection.send_bytes((b"t" if isinstance(reply, str) else b"b") + content)
        except OSError:
            return
        if _memory() > GREATEST_MEMORY:
            return


def _end_with_server() -> None:
    """End this process when the server was killed, even in the midst of a computation."""
    server = multiprocessing.parent_process()
    if server is not None:
        server.join()
        os._exit(1)


def reply_to(bench: Any, message: Mapping[str, Any]) -> Reply:
    """The answer of a workbench; a fault of the program is an answer that says so."""
    try:
        return reply_of(bench.answer(message))
    except Exception as fault:
        return reply_of(bench.fault(message, fault))


def _memory() -> int:
    """Greatest memory [bytes] that this process has had; 0 where the system does not say."""
    if sys.platform == "win32":
        return 0
    used = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return used if sys.platform == "darwin" else used * 1024


@dataclass
class ProcessRunner:
    """Answers messages in a process of its own, one at a time."""

    work: WorkFolder
    _process: Any = None
    _connection: Connection | None = None
    _is_ready: bool = False
    _ended: bool = False
    _refused: tuple[str, str] | None = None
    _guard: threading.Lock = field(default_factory=threading.Lock)
    _turn: asyncio.Lock = field(default_factory=asyncio.Lock)
    _threads: ThreadPoolExecutor = field(default_factory=lambda: ThreadPoolExecutor(max_workers=1))

    async def answer(self, message: Mapping[str, Any], limit: float) -> Reply:
        """The answer of a message; TimeoutError after so many seconds, and the process is stopped.

        Raises StartFailure where no process starts, for other messages about the same text at once.
        """
        async with self._turn:
            if self._ended:
                raise EOFError
            subject = _subject(message)
            if self._refused is not None and subject and self._refused[0] == subject:
                raise StartFailure(self._refused[1])
            self._refused = None
            try:
                return await self._answer_by_another(json.dumps(message).encode(), limit)
            except StartFailure as failure:
                self._refused = subject, failure.reason
                raise

    async def _answer_by_another(self, content: bytes, limit: float) -> Reply:
        """The answer of the process, or of one that is started in its place."""
        failed = 0
        interrupted = False
        while True:
            try:
                return await self._answer_within(content, limit)
            except TimeoutError:
                raise
            except StartFailure:
                failed += 1
                await asyncio.to_thread(self.stop)
                if failed == STARTS or self._ended:
                    raise
            except (EOFError, OSError):
                # it made room, or the system stopped it: once more in a new one
                await asyncio.to_thread(self.stop)
                if interrupted:
                    raise
                interrupted = True

    async def _answer_within(self, content: bytes, limit: float) -> Reply:
        # a process begins in the thread too: the server answers others meanwhile
        waiting = asyncio.get_running_loop().run_in_executor(self._threads, self._exchange_in_turn, content)
        try:
            return await asyncio.wait_for(asyncio.shield(waiting), limit)
        except (TimeoutError, asyncio.CancelledError):
            # a process that is about to begin is waited for, but not by the server
            await asyncio.shield(asyncio.to_thread(self.stop))
            with suppress(Exception):
                await waiting
            raise

    def _exchange_in_turn(self, content: bytes) -> Reply:
        connection = self._process_connection()
        if not self._is_ready:
            self._meet(connection)
        return _exchange(connection, content)

    def _meet(self, connection: Connection) -> None:
        """Hear the first word of a process; StartFailure where it has none, or cannot compute."""
        try:
            word = connection.recv_bytes()
        except (EOFError, OSError):
            process = self._process
            if process is None:  # stopped by somebody
                raise
            process.join(ENDING)
            raise StartFailure(f"exit code {process.exitcode}") from None
        if word[:1] != READY:
            raise StartFailure(word[1:].decode(errors="replace"))
        self._is_ready = True

    def _process_connection(self) -> Connection:
        with self._guard:
            return self._begin_process()

    def _begin_process(self) -> Connection:
        if self._ended:
            raise EOFError
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
        try:
            with _block_interrupts():
                process.start()
        except (EOFError, OSError) as fault:
            here.close()
            raise StartFailure(str(fault) or type(fault).__name__) from fault
        finally:
            there.close()
        self._process, self._connection = process, here
        return here

    def stop(self) -> None:
        """Stop the process; the next message starts another one."""
        with self._guard:
            self._stop_alone()

    def end(self) -> None:
        """Stop the process; none is started after it."""
        with self._guard:
            self._ended = True
            self._stop_alone()
        self._threads.shutdown(wait=False, cancel_futures=True)

    def _stop_alone(self) -> None:
        if self._connection is not None:
            with suppress(OSError):
                self._connection.close()
        if self._process is not None:
            self._process.kill()
            self._process.join(ENDING)
        self._process = self._connection = None
        self._is_ready = False


@contextmanager
def _block_interrupts() -> Iterator[None]:
    """What this thread starts meanwhile never meets Ctrl-C, not even while it loads its libraries."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    # it lets interrupts through again when it begins: it begins before
    resource_tracker.ensure_running()
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _subject(message: Mapping[str, Any]) -> str:
    """The digest of the text that a message is about; empty of one that is about none."""
    text, digest = message.get("text"), message.get("digest")
    if isinstance(text, str):
        return digest_of(text)
    return digest if isinstance(digest, str) else ""


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
        return reply_to(self._bench, json.loads(json.dumps(message)))

    def stop(self) -> None:
        """Nothing is to be stopped."""

    def end(self) -> None:
        """Nothing is to be ended."""
