"""Workers, the scheduler or the client of a sweep are killed: whoever goes on ends with the same bytes."""

from __future__ import annotations

import re
import tempfile
from pathlib import Path

import centrode as ct
from centrode.sweeps import designs
from tools.campaigns.campaign import Campaign, Outcome, random_of
from tools.campaigns.clusters.processes import Client, Machines

BYTES = 1500
"""Bytes of a block: a mechanism or two."""
TARGET = "x86-64-v2"
KILLS = 10
"""Kills of one store."""
KINDS = ("worker", "scheduler", "client")
GRID = {"links.AB.length": [1.6 + 0.2 * k for k in range(12)], "frame.points.D.x": [3.9, 4.0, 4.1]}
OUTPUTS = ["position.B", "angle"]
MECHANISMS = 36
MARK = re.compile(r"progress/done/\d+/\d+\.json")


def contents(store: Path) -> dict[str, bytes]:
    """What a store holds, but for its lock and the text for workers."""
    return {
        file.relative_to(store).as_posix(): file.read_bytes()
        for file in sorted(store.rglob("*"))
        if file.is_file() and file.name not in {"lock", "work.json"} and file.suffix != ".partial"
    }


def reference(folder: Path, executor: str) -> dict[str, bytes]:
    """The store that one process makes without a cluster."""
    before = designs.BLOCK_BYTES
    designs.BLOCK_BYTES = BYTES
    try:
        ct.sweep(
            ct.example("crank-rocker"),
            ct.grid(GRID),
            OUTPUTS,
            19,
            store=folder,
            target=TARGET,
            executor=executor,
        )
    finally:
        designs.BLOCK_BYTES = before
    return contents(folder)


def run(seed: int, number: int) -> Outcome:
    """A store in whose making ten processes are killed, one after the other."""
    draw = random_of(seed, number)
    plan = [
        (KINDS[int(draw.integers(3))], int(draw.integers(1, 4)), int(draw.integers(2))) for _k in range(KILLS)
    ]
    return killed_sweep(plan, ("machine code", "arrays")[number % 2])


def killed_sweep(plan: list[tuple[str, int, int]], executor: str) -> Outcome:
    """A sweep in which processes are killed: (which kind, after how many reports of progress, which worker)."""
    found = Outcome(subject=f"{executor}: {plan}")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        whole, store = reference(folder / "whole.zarr", executor), folder / "killed.zarr"
        asked: dict[str, object] = {
            "mechanism": "crank-rocker", "grid": GRID, "outputs": OUTPUTS, "store": str(store), "target": TARGET,
            "executor": executor, "bytes": BYTES,
        }  # fmt: skip
        left = list(plan)
        marks: dict[str, bytes] = {}
        with Machines(folder, 2) as machines:
            for _attempt in range(len(plan) + 2):
                client = Client.of({**asked, "scheduler": machines.address})
                try:
                    ended = _watch(client, machines, left, found)
                finally:
                    client.end()
                # what a worker that was killed was writing is no mark
                now = {name: text for name, text in contents(store).items() if MARK.fullmatch(name)}
                if any(now.get(name) != content for name, content in marks.items()):
                    found.fault("a mark that was there is lost or another one")
                marks = now
                if ended.startswith("whole"):
                    break
        if not ended.startswith(f"whole [{MECHANISMS},"):
            found.fault(f"it ended with: {ended}")
        found.count("stores")
        if contents(store) != whole:
            other = [name for name in whole if contents(store).get(name) != whole[name]]
            found.fault(f"other bytes in {', '.join(other)}")
        return found


def _watch(client: Client, machines: Machines, left: list[tuple[str, int, int]], found: Outcome) -> str:
    """Follow a client until it ends or is killed; returns its last line."""
    last, reports = "", 0
    for line in client.reports():
        last = line
        reports += 1
        if not left or not line.isdigit() or reports < left[0][1]:
            continue
        kind, _after, which = left.pop(0)
        found.count(f"{kind} killed")
        reports = 0
        if kind == "worker":
            machines.kill_worker(which)
        elif kind == "client":
            return "killed"
        else:
            machines.kill_scheduler()
    if last.startswith("refused"):
        if "the scheduler went away" not in last:
            found.fault(last)
        machines.stop()
        machines.start()
    return last


CAMPAIGN = Campaign(
    "clusters",
    "Sweeps whose processes are killed",
    "A sweep on a scheduler and two workers, each a process of its own. While it runs, workers, the scheduler or the "
    "client are killed (SIGKILL), ten a store, at places drawn at random; then the same sweep is begun again. In the "
    "end the store has to hold, byte by byte, what one process without a cluster writes: numbers, labels, marks. A "
    "mark that is there may not change or go. Odd cases are computed by arrays, even ones by machine code. Some of the "
    "mechanisms lock.",
    {},
    run,
    cases=10,
    block=1,
)
