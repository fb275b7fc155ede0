"""A sweep on a cluster against threads of one process, by the clock: two idle cores are needed."""

from __future__ import annotations

import functools
import json
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import centrode as ct
from benchmarks.sweeps import KILOBYTE
from benchmarks.table import Promise, Row
from centrode.numerics.machine_code.targets import baseline
from centrode.sweeps.clusters import open_cluster

RANGES = {
    "links.OA.length": (0.98, 1.02),
    "links.AB.length": (3.4, 3.6),
    "links.DB.length": (2.9, 3.1),
    "frame.points.D.x": (3.9, 4.1),
}
FORMULAS = {"swing": "range(angle_DB)", "x": "mean(sin(position_B_x)^2)", "y": "mean(cos(position_B_y)^2)"}
SAMPLES = 361
WORK = 60.0
"""Seconds that two threads work."""
PROBE = 200_000
"""Mechanisms by which it is told how many that are."""
MOST_OVERHEAD, LEAST_GAIN = 1.05, 1.8
STORED = 100_000_000
"""Mechanisms of a store that is opened again."""
MARKS, MISSING = 100_000, 10
"""Its blocks, as many as 2 s of work give for mechanisms that take 2 ms each; those that are still to be computed."""
OPENING = 10.0
"""Seconds in which it is listed and resumed."""
OPENED_MEMORY = 1e9
NOOPS = 2000


def clusters() -> Iterator[Row]:
    """All rows."""
    yield from _against_threads()
    yield _pieces_of_work()
    yield _opened_again()


def _against_threads() -> Iterator[Row]:
    mechanism = ct.example("crank-rocker")
    run = functools.partial(
        ct.sweep, mechanism, samples=SAMPLES, reduce=FORMULAS, executor="machine code", target=baseline()
    )
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        probe = ct.sample(RANGES, PROBE, "sobol")
        run(vary=probe, threads=2, store=folder / "warm.zarr")
        seconds = _clock(lambda: run(vary=probe, threads=2, store=folder / "probe.zarr"))
        whole = ct.sample(RANGES, int(PROBE * WORK / seconds), "sobol")
        times = {
            "threads=2": _clock(lambda: run(vary=whole, threads=2, store=folder / "two.zarr")),
            "threads=1": _clock(lambda: run(vary=whole, threads=1, store=folder / "one.zarr")),
        }
        # workers that are there: their beginning is told apart
        began = time.perf_counter()
        with open_cluster(2) as workers:
            workers.client.wait_for_workers(2)
            beginning = time.perf_counter() - began
            times["cluster=2"] = _clock(
                lambda: run(vary=whole, cluster=workers.client, store=folder / "cluster.zarr")
            )
        same = _same(folder / "two.zarr", folder / "cluster.zarr")
    overhead, gain = times["cluster=2"] / times["threads=2"], times["threads=1"] / times["cluster=2"]
    yield Row(
        f"{whole.count} mechanisms, {SAMPLES} samples",
        {**{f"{label} s": value for label, value in times.items()}, "workers' beginning s": beginning},
        note="the same bits" if same else "OTHER BITS",
        promises=[
            Promise("cluster of two workers over two threads", overhead, at_most=MOST_OVERHEAD),
            Promise("one thread over two workers", gain, at_least=LEAST_GAIN),
            Promise("cluster, the same bits (1: yes)", float(same), at_least=1.0),
        ],
    )


def _same(one: Path, other: Path) -> bool:
    """Whether two stores of other blocks have the same numbers."""
    found = [json.loads(_in_a_process(DIGESTS, str(store))) for store in (one, other)]
    return bool(found[0] == found[1])


DIGESTS = """
import hashlib, json, sys
import xarray as xr
found = {}
with xr.open_zarr(sys.argv[1], chunks=None) as data:
    for name in data.data_vars:
        digest = hashlib.sha256()
        for first in range(0, data.sizes["mechanism"], 1_000_000):
            digest.update(data[name][first : first + 1_000_000].values.tobytes())
        found[str(name)] = digest.hexdigest()
print(json.dumps(found))
"""


def _pieces_of_work() -> Row:
    """What a piece of work takes that does nothing: the scheduler's and the client's share."""
    with open_cluster(2) as workers:
        workers.client.wait_for_workers(2)
        texts = ((k, "[]") for k in range(NOOPS))
        list(workers.answers(json.loads, ((k, "[]") for k in range(100)), {}))
        seconds = _clock(lambda: list(workers.answers(json.loads, texts, {})))
    return Row("a piece of work", {"ms": seconds / NOOPS * 1e3, "a second": NOOPS / seconds})


def _opened_again() -> Row:
    """A store of a hundred million mechanisms, of which some blocks are missing, is listed and finished."""
    with tempfile.TemporaryDirectory() as name:
        store = Path(name) / "great.zarr"
        _in_a_process(MARKING, str(store), str(STORED), str(MARKS))
        seconds, memory, found = map(float, _in_a_process(RESUMING, str(store), str(STORED)).split())
        shutil.rmtree(store)
    assert found == STORED * (1 - MISSING / MARKS)
    return Row(
        f"a store of {STORED} mechanisms, {MARKS} marks",
        {"s": seconds, "MB": memory * KILOBYTE / 1e6},
        promises=[
            Promise("a store of 1e8 mechanisms listed and resumed [s]", seconds, at_most=OPENING),
            Promise(
                "a store of 1e8 mechanisms, memory [MB]", memory * KILOBYTE / 1e6, at_most=OPENED_MEMORY / 1e6
            ),
        ],
    )


ASKED = """
import resource, sys, time
from pathlib import Path
import centrode as ct
from centrode.numerics.machine_code.targets import baseline
from centrode.sweeps.clusters import open_cluster
mechanism = ct.example("crank-rocker")
vary = ct.sample({"links.AB.length": (3.4, 3.6), "links.DB.length": (2.9, 3.1)}, int(sys.argv[2]), "sobol")
"""
MARKING = f"""{ASKED}
from centrode.sweeps.designs import design_of
from centrode.sweeps.storage import storage_of
from centrode.sweeps.store import Blocks, open_store, study_of
from centrode.sweeps.sweep_plans import plan_of
plan = plan_of(
    mechanism, design_of(mechanism, vary), "machine code", "angle.DB", "range", False, None, (19, None, None),
    target=baseline(),
)
blocks = Blocks.of(plan.frame.design.shape, -(-int(sys.argv[2]) // int(sys.argv[3])))
facts = study_of(plan.frame, plan.task, plan.target)
place = Path(sys.argv[1])
with open_store(storage_of(place), plan.frame, lambda: blocks, facts) as store:
    # one block is computed; the others have its mark, and chunks of their size that take no place
    room = store.room(0)
    store.put(0, room, plan.compute(*blocks.mechanisms(0), room, lambda done: None))
    mark = (place / "progress/done/0/0.json").read_bytes()
    for block in range(1, len(blocks) - {MISSING}):
        file = place / f"progress/done/{{block // 1000}}/{{block}}.json"
        file.parent.mkdir(exist_ok=True)
        file.write_bytes(mark)
        for name, size in store.writer.marks.chunks(block):
            with open(place / name, "wb") as chunk:
                chunk.truncate(size)
"""
RESUMING = f"""{ASKED}
def main():
    with open_cluster(2) as workers:
        workers.client.wait_for_workers(2)
        start = time.perf_counter()
        found = ct.sweep(
            mechanism, vary, "angle.DB", 19, reduce="range", executor="machine code", store=sys.argv[1],
            cluster=workers.client,
        )
        seconds = time.perf_counter() - start
        assert found.attrs["mechanisms"] == int(sys.argv[2])
        memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        print(seconds, memory, found.attrs["mechanisms_found"])
if __name__ == "__main__":
    main()
"""


def _in_a_process(program: str, *arguments: str) -> str:
    # a file, as workers read the program again
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "program.py"
        file.write_text(program, encoding="utf-8")
        done = subprocess.run(
            [sys.executable, "-W", "ignore", str(file), *arguments],
            capture_output=True,
            text=True,
            check=True,
        )
    return done.stdout


def _clock(task: Callable[[], object]) -> float:
    start = time.perf_counter()
    task()
    return time.perf_counter() - start
