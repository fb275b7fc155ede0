"""A study small enough to run many times, and a process that computes it and may kill itself on the way."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

STUDY = """\
mechanism = "crank-rocker"
outputs = ["position.B", "angle.DB"]
samples = 19
[grid]
links.AB.length = { from = "3.2 m", to = "3.8 m", count = 15 }
"frame.points.D.x" = [3.9, 4.0, 4.1]
"""

PROCESS = """
import os, signal, sys, threading
from centrode.cli.main import main
from centrode.sweeps import designs
designs.BLOCK_POSITIONS = 1600
store, last = os.path.abspath(sys.argv[2]), int(sys.argv[3])
EVENTS = {"open", "os.rename", "os.mkdir", "os.remove", "os.rmdir"}
count, lock = 0, threading.Lock()
def watch(event, arguments):
    global count
    if event not in EVENTS or not isinstance(arguments[0], (str, bytes)):
        return
    if os.path.abspath(os.fsdecode(arguments[0])).startswith(store):
        with lock:
            count += 1
            if count == last:
                os.kill(os.getpid(), signal.SIGKILL)
sys.addaudithook(watch)
code = main(["sweep", sys.argv[1], "--out", sys.argv[2]])
print(count)
sys.exit(code)
"""

Process = Callable[..., subprocess.CompletedProcess[str]]


@pytest.fixture
def study(tmp_path: Path) -> Path:
    file = tmp_path / "study.toml"
    file.write_text(STUDY, encoding="utf-8")
    return file


@pytest.fixture
def process() -> Process:
    """Sweep into a store in a process that kills itself at its `last`-th touch of the store (0: never)."""

    def run(study: Path, store: Path, last: int = 0) -> subprocess.CompletedProcess[str]:
        arguments = [sys.executable, "-c", PROCESS, str(study), str(store), str(last)]
        return subprocess.run(arguments, capture_output=True, encoding="utf-8", check=False)

    return run
