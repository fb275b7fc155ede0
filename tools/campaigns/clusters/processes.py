"""A scheduler, workers and a client of a sweep, each a process of its own that can be killed."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Self

SCHEDULER = """
import asyncio, sys
from distributed import Scheduler
async def run():
    async with Scheduler(host="127.0.0.1", port=0, dashboard=False) as scheduler:
        print(scheduler.address, flush=True)
        await scheduler.finished()
asyncio.run(run())
"""
WORKER = """
import asyncio, sys
from distributed import Worker
async def run():
    scheduler, folder = sys.argv[1:]
    async with Worker(scheduler, nthreads=1, dashboard=False, local_directory=folder, death_timeout=30) as worker:
        print(worker.address, flush=True)
        await worker.finished()
asyncio.run(run())
"""
CLIENT = """
import json, sys
import centrode as ct
from centrode.sweeps import designs
asked = json.loads(sys.argv[1])
designs.BLOCK_BYTES = asked["bytes"]
def tell(done, of):
    print(done, flush=True)
    sys.stdin.readline()
try:
    found = ct.sweep(
        ct.example(asked["mechanism"]), ct.grid(asked["grid"]), asked["outputs"], 19, store=asked["store"],
        cluster=asked["scheduler"], target=asked["target"], executor=asked["executor"], progress=tell,
    )
except ct.InputError as refused:
    print("refused", refused, flush=True)
    sys.exit(2)
print("whole", json.dumps([found.attrs["mechanisms"], found.attrs["mechanisms_found"]]), flush=True)
"""


def begin(program: str, *arguments: str) -> subprocess.Popen[str]:
    """A process whose output is read and whose input is written line by line."""
    return subprocess.Popen(
        [sys.executable, "-W", "ignore", "-c", program, *arguments],
        stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, encoding="utf-8",
    )  # fmt: skip


def line_of(process: subprocess.Popen[str]) -> str:
    """The next line of a process; nothing where it has ended."""
    assert process.stdout is not None
    return process.stdout.readline().strip()


def kill(process: subprocess.Popen[str]) -> None:
    """Kill a process, and wait until it is gone."""
    process.kill()
    process.wait()
    for stream in (process.stdin, process.stdout):
        if stream is not None:
            stream.close()


@dataclass
class Machines:
    """A scheduler and its workers, which end with the block."""

    folder: Path
    count: int
    address: str = ""
    scheduler: subprocess.Popen[str] | None = None
    workers: list[subprocess.Popen[str]] = field(default_factory=list)

    def __enter__(self) -> Self:
        self.start()
        return self

    def start(self) -> None:
        """Start all of them; returns when the workers are known to the scheduler."""
        self.scheduler = begin(SCHEDULER)
        self.address = line_of(self.scheduler)
        self.workers = [begin(WORKER, self.address, str(self.folder)) for _k in range(self.count)]
        for worker in self.workers:
            line_of(worker)

    def stop(self) -> None:
        """Kill all of them."""
        for process in (*self.workers, self.scheduler):
            if process is not None:
                kill(process)
        self.workers, self.scheduler = [], None

    def __exit__(self, *failure: object) -> None:
        self.stop()

    def kill_worker(self, which: int) -> None:
        """Kill one worker, and start another in its place."""
        kill(self.workers[which])
        self.workers[which] = begin(WORKER, self.address, str(self.folder))

    def kill_scheduler(self) -> None:
        """Kill the scheduler."""
        assert self.scheduler is not None
        kill(self.scheduler)


@dataclass
class Client:
    """A sweep in a process of its own, which stops at every report of progress until it is told to go on."""

    process: subprocess.Popen[str]

    @classmethod
    def of(cls, asked: dict[str, object]) -> Self:
        """The sweep that is asked for."""
        return cls(begin(CLIENT, json.dumps(asked)))

    def reports(self) -> Iterator[str]:
        """Its lines; it goes on when the next one is asked for."""
        assert self.process.stdin is not None
        while line := line_of(self.process):
            yield line
            if self.process.poll() is None:
                try:
                    self.process.stdin.write("\n")
                    self.process.stdin.flush()
                except BrokenPipeError:
                    return

    def end(self) -> None:
        """Kill it, whatever it does."""
        kill(self.process)
