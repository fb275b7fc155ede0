"""A command line in a process of its own, with bounds on its time and memory."""

from __future__ import annotations

import contextlib
import io
import os
import signal
import subprocess
import sys
import tempfile
import time
import warnings
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from centrode.cli.main import main

if sys.platform != "win32":
    import resource

SECONDS = 120
"""Of processor time. What is drawn small takes well under a second; what is drawn large is to be refused."""
PATIENCE = 600
"""Seconds by the clock, on a machine that others use too."""
GIBIBYTES = 2
"""Of address space beyond what the process begins with."""
OUT, COMPLAINT = "stdout", "stderr"
TOO_LONG = (-9, -24, -999)
"""Codes of what was killed, ran out of processor time, or of `PATIENCE`."""


@dataclass(frozen=True)
class Ending:
    """How a command ended: its exit code (less the signal that killed it), what it printed, seconds it took."""

    code: int
    said: str
    complained: str
    seconds: float


def ending(words: list[str], folder: Path, beside: Path, forked: bool) -> Ending:
    """Run a command line in a folder; `beside` takes what it prints. Forked, it need not start anew."""
    began = time.monotonic()
    with (beside / OUT).open("wb") as out, (beside / COMPLAINT).open("wb") as complaint:
        run = in_fork if forked and hasattr(os, "fork") else in_process
        code = run(words, folder, out.fileno(), complaint.fileno())
    said, complained = (
        (beside / name).read_text(encoding="utf-8", errors="replace") for name in (OUT, COMPLAINT)
    )
    return Ending(code, said, complained, time.monotonic() - began)


def bounded() -> None:
    """Bound what the process may still use, where the operating system can."""
    if sys.platform == "win32":
        return
    with open("/proc/self/statm", encoding="ascii") as stream:
        used = int(stream.read().split()[0]) * resource.getpagesize()
    most = used + GIBIBYTES * 2**30
    resource.setrlimit(resource.RLIMIT_AS, (most, most))
    resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS + 5))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def in_process(words: list[str], folder: Path, out: int, complaint: int) -> int:
    """The command as a terminal runs it."""
    limit = None if sys.platform == "win32" else bounded
    try:
        done = subprocess.run(
            [sys.executable, "-m", "centrode", *words],
            cwd=folder, stdin=subprocess.DEVNULL, stdout=out, stderr=complaint, check=False,
            timeout=PATIENCE, preexec_fn=limit, env={**os.environ, "LANGUAGE": "en"},
        )  # fmt: skip
    except subprocess.TimeoutExpired:
        return TOO_LONG[-1]
    return done.returncode


@cache
def warmed() -> None:
    """Load what most commands need, so that copies of this process need not."""
    with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()):
        main(["run", "crank-rocker", "--samples", "3", "--xlsx", "--out", f"{folder}/run"])
        main(["reactions", "six-bar-press", "--samples", "3", "--no-figures", "--out", f"{folder}/reactions"])
        main(["cam", "valve-cam", "--samples", "7", "--no-figures", "--out", f"{folder}/cam"])
        main(["report", "crank-rocker", "--format", "html", "--out", f"{folder}/report"])


def in_fork(words: list[str], folder: Path, out: int, complaint: int) -> int:
    """The command in a copy of this process, which has loaded what it needs."""
    warmed()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)  # threads of libraries do nothing between cases
        child = os.fork()
    if child == 0:
        code = 70
        try:
            bounded()
            os.chdir(folder)
            os.environ["LANGUAGE"] = "en"
            nothing = os.open(os.devnull, os.O_RDONLY)
            for own, given in ((0, nothing), (1, out), (2, complaint)):
                os.dup2(given, own)
            sys.stdout, sys.stderr = (
                os.fdopen(own, "w", encoding="utf-8", closefd=False, errors="replace") for own in (1, 2)
            )
            code = main(words)
            sys.stdout.flush()
            sys.stderr.flush()
        finally:
            os._exit(code)
    return waited(child)


def waited(child: int) -> int:
    """The exit code of a child, killed where it takes too long."""
    until = time.monotonic() + PATIENCE
    pause = 0.001
    while True:
        found, status = os.waitpid(child, os.WNOHANG)
        if found:
            return os.waitstatus_to_exitcode(status)
        if time.monotonic() > until:
            os.kill(child, signal.SIGKILL)
            os.waitpid(child, 0)
            return TOO_LONG[-1]
        time.sleep(pause)
        pause = min(0.05, 2.0 * pause)
