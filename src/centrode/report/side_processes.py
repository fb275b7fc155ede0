"""Work that forks of this process do meanwhile: each knows all that this one knew when it began.

Only what is made there without a failure and without a warning comes back. All else is made again here, in its turn,
so that results, failures and warnings are those of one process.
"""

from __future__ import annotations

import gc
import multiprocessing
import os
import signal
import sys
import threading
import warnings
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from contextvars import ContextVar
from dataclasses import dataclass, field
from multiprocessing.connection import Connection
from typing import TYPE_CHECKING, Any, Generic, TypeVar

if TYPE_CHECKING:
    from multiprocessing.process import BaseProcess

Made = TypeVar("Made")

USE_THREADS = ("typst",)
"""Libraries with threads of their own, which a fork would lack: once they are loaded, everything is made here."""
INTERRUPTIONS = (signal.SIGINT, signal.SIGTERM)
FORK_WITH_THREADS = ".*is multi-threaded, use of fork.*"
"""What newer versions of Python say where NumPy's linear algebra has threads, which it ends before a fork."""


@dataclass(eq=False)
class BegunWork(Generic[Made]):
    """Something that is made here or in another process, once.

    Attributes
    ----------
    work : makes it; the result has to be picklable
    answer, process : where it is being made, if that is another process
    made : the result, alone in a tuple, once it is there
    """

    work: Callable[[], Made]
    processes: SideProcesses | None = None
    answer: Connection | None = None
    process: BaseProcess | None = None
    made: tuple[Made, ...] = field(default=())

    def result(self) -> Made:
        """What is made; raises what `work` raises."""
        if self.processes is not None:
            self.processes.wait_for(self)
        if not self.made:
            self.made = (self.work(),)
        return self.made[0]

    def start(self) -> None:
        """Begin in another process."""
        context = multiprocessing.get_context("fork")
        self.answer, told = context.Pipe(duplex=False)
        self.process = context.Process(target=_tell, args=(told, self.work), daemon=True)
        # no interruption may reach the other process before it leaves them to this one
        before = signal.pthread_sigmask(signal.SIG_BLOCK, INTERRUPTIONS)
        try:
            with told, warnings.catch_warnings():
                warnings.filterwarnings("ignore", FORK_WITH_THREADS, DeprecationWarning)
                self.process.start()
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, before)

    def receive(self) -> None:
        """Take what the other process tells, if it does."""
        if self.answer is None or self.process is None:
            return
        with self.answer, suppress(Exception):  # there is no answer where it failed, warned or was killed
            self.made = self.answer.recv()
        self.answer = None
        self.process.join()


class SideProcesses:
    """So many processes at most beside this one."""

    def __init__(self, most: int) -> None:
        self._most = most
        self._running: list[BegunWork[Any]] = []
        self._waiting: deque[BegunWork[Any]] = deque()

    def begin(self, work: Callable[[], Made]) -> BegunWork[Made]:
        """Begin it where a process is free, else leave it for later."""
        begun = BegunWork(work, self)
        self._waiting.append(begun)
        self._start_waiting()
        return begun

    def wait_for(self, begun: BegunWork[Any]) -> None:
        """Until another process has made it, if one does; meanwhile make here what waits."""
        if begun in self._waiting:
            self._waiting.remove(begun)
        while begun in self._running:
            self._start_waiting()
            if self._waiting and begun in self._running:
                other = self._waiting.popleft()
                with suppress(Exception):  # it fails in its turn
                    other.made = (other.work(),)
            elif begun in self._running:
                begun.receive()
                self._running.remove(begun)

    def end(self) -> None:
        """Stop what nobody waits for any more."""
        self._waiting.clear()
        for begun in self._running:
            if begun.process is not None:
                begun.process.kill()
                begun.process.join()
            if begun.answer is not None:
                begun.answer.close()
        self._running.clear()

    def _start_waiting(self) -> None:
        for begun in [one for one in self._running if one.answer is not None and one.answer.poll()]:
            begun.receive()
            self._running.remove(begun)
        while self._waiting and len(self._running) < self._most and _may_fork():
            begun = self._waiting.popleft()
            try:
                begun.start()
            except OSError:  # the system has no room for another process
                self._most = 0
                begun.answer = begun.process = None
                return
            self._running.append(begun)


_PROCESSES: ContextVar[SideProcesses | None] = ContextVar("side processes", default=None)


@contextmanager
def side_processes(most: int | None = None) -> Iterator[None]:
    """While the block runs, work may be begun in other processes: one less than there are cores, or `most`.

    There are none where this process cannot be forked, or is one of several already.
    """
    count = (_cores() - 1 if most is None else most) if _may_fork() else 0
    if count < 1:
        yield
        return
    processes = SideProcesses(count)
    token = _PROCESSES.set(processes)
    try:
        yield
    finally:
        _PROCESSES.reset(token)
        processes.end()


def has_side_processes() -> bool:
    """Whether work can be begun in another process now."""
    return _PROCESSES.get() is not None and _may_fork()


def begin(work: Callable[[], Made]) -> BegunWork[Made]:
    """Begin work in another process; where there is none it is done when its result is asked for.

    What it makes has to be picklable, and it must change nothing that others see.
    """
    processes = _PROCESSES.get()
    return BegunWork(work) if processes is None or not _may_fork() else processes.begin(work)


def _cores() -> int:
    """Those that this process may use."""
    return len(os.sched_getaffinity(0)) if sys.platform == "linux" else 1


def _may_fork() -> bool:
    alone = threading.active_count() == 1 and multiprocessing.parent_process() is None
    return sys.platform == "linux" and alone and not any(name in sys.modules for name in USE_THREADS)


def _tell(told: Connection, work: Callable[[], Any]) -> None:
    """What the other process does: it tells what it has made, or nothing where it failed or warned."""
    # an interruption is for the process that began this one, which ends it
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, INTERRUPTIONS)
    gc.freeze()  # a collection would copy the pages of all objects that both share
    with told, suppress(BaseException), warnings.catch_warnings(record=True) as warned:
        made = work()
        if not warned:
            told.send((made,))
