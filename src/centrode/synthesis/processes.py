"""Shares of a search on several processes.

What is searched is always cut into the same shares, however many processes there are, so that the numbers of one core
and of many are the same to the last bit.
"""

from __future__ import annotations

import importlib
import multiprocessing
import signal
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from typing import TypeVar

from centrode.errors import InputError
from centrode.locale import _

MOST_JOBS = 64
LOOK = 0.1
"""Time [s] after which a search that waits for its processes looks whether it is to stop."""
WORK = ("centrode.synthesis.path_synthesis", "centrode.synthesis.mechanism_synthesis")
"""What a process imports while the first shares are made."""

Share = TypeVar("Share")
Found = TypeVar("Found")
Stop = Callable[[], bool]


def check_jobs(jobs: object) -> int:
    """A number of processes; InputError for anything else."""
    if isinstance(jobs, bool) or not isinstance(jobs, int) or not 1 <= jobs <= MOST_JOBS:
        what = _("{jobs} processes are given").format(jobs=jobs)
        raise InputError("jobs", what, _("give 1 to {most}").format(most=MOST_JOBS))
    return jobs


class Processes:
    """What computes shares: this process, or several others."""

    def __init__(self, pool: ProcessPoolExecutor | None = None) -> None:
        self._pool = pool

    def compute(
        self, work: Callable[..., Found], shares: Sequence[Share], stop: Stop
    ) -> Iterator[tuple[int, Found]]:
        """Index and result of each share as they are finished; once `stop` is true those that are open are left out.

        `work` takes a share, and `stop` where it runs in this process; both have to be picklable for others.
        """
        if self._pool is None:
            for index, share in enumerate(shares):
                if stop():
                    return
                yield index, work(share, stop=stop)
            return
        try:
            waiting: dict[Future[Found], int] = {
                self._pool.submit(work, share): index for index, share in enumerate(shares)
            }
            while waiting and not stop():
                for future in wait(waiting, LOOK, FIRST_COMPLETED).done:
                    yield waiting.pop(future), future.result()
            for future in waiting:
                future.cancel()
        except BrokenProcessPool as broken:
            raise InputError("jobs", _("a process was killed"), _("give fewer processes")) from broken


HERE = Processes()
"""This process alone."""


@contextmanager
def processes(jobs: int) -> Iterator[Processes]:
    """So many processes as long as the context lasts; one is this process."""
    if jobs == 1:
        yield HERE
        return
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(jobs, mp_context=context, initializer=_prepare) as pool:
        for _process in range(jobs):
            # each is started by a call, and imports while this process makes the first shares
            pool.submit(_prepare)
        try:
            yield Processes(pool)
        finally:
            pool.shutdown(wait=False, cancel_futures=True)


def _prepare() -> None:
    """Let the process that has begun the search decide what an interruption means."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    for name in WORK:
        importlib.import_module(name)
