"""Animations: whole processes, from the command to the file."""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

from benchmarks.processes import process_times
from benchmarks.table import Promise, Row

ROUNDS = 3
FRAMES = 60
EXAMPLE = "six-bar-press"
MOST = 2.0
"""Seconds of a processor that so many frames of the six-bar may take as a GIF, the start of the program included."""
EVERYTHING = "paths,velocities,accelerations,centres,centrodes,forces,loads"


def animations() -> Iterator[Row]:
    """Elapsed and processor time of each command, the least of several runs."""
    tasks = {
        f"{EXAMPLE}, paths, GIF": [EXAMPLE, "--out", "a.gif"],
        f"{EXAMPLE}, everything, GIF": [EXAMPLE, "--show", EVERYTHING, "--out", "a.gif"],
        f"{EXAMPLE}, paths, MP4": [EXAMPLE, "--out", "a.mp4"],
        "spherical-crank-rocker, GIF": [
            "spherical-crank-rocker",
            "--show",
            "paths,centrodes",
            "--out",
            "a.gif",
        ],
        "cam-driven-linkage, GIF": ["cam-driven-linkage", "--out", "a.gif"],
        "valve-cam, GIF": ["valve-cam", "--out", "a.gif"],
        "walking-wheel-three-legs, GIF": ["walking-wheel-three-legs", "--out", "a.gif"],
    }
    for name, words in tasks.items():
        elapsed, used = (min(times) for times in zip(*map(_run, [words] * ROUNDS), strict=True))
        what = f"{FRAMES} frames of {EXAMPLE} as GIF, processor [s]"
        promises = [Promise(what, used, at_most=MOST)] if name.endswith("paths, GIF") else []
        yield Row(name, {"elapsed [s]": elapsed, "processor [s]": used}, promises=promises)


def _run(words: list[str]) -> tuple[float, float]:
    """Elapsed and processor time of a process [s]."""
    command = [sys.executable, "-m", "centrode", "animate", *words, "--frames", str(FRAMES), "--force"]
    with tempfile.TemporaryDirectory() as folder:
        return process_times(command, Path(folder))
