"""Cold starts: whole processes, as multiples of a process that imports NumPy and ends."""

from __future__ import annotations

import statistics
import sys
import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path

from benchmarks import peer
from benchmarks.processes import process_times
from benchmarks.table import Row

ROUNDS = 9
EXAMPLE = "slider-between-cranks"
COMMON_UNITS = """\
[frame.points]
O = [0, 0]
D = ["400 mm", 0]
[links.OA]
length = "100 mm"
[links.AB]
length = "300 mm"
angle = "60 deg"
[links.DB]
length = "300 mm"
angle = "120 deg"
[[drives]]
link = "OA"
start = "0 deg"
speed = "120 rpm"
"""
RARE_UNITS = COMMON_UNITS.replace('"100 mm"', '"0.1 metre"')
"""One unit that is not in the table of common ones, so that pint has to be asked."""
PEER = """\
from math import tau
from pylinkage.actuators import Crank
from pylinkage.components import Ground
from pylinkage.dyads import RRRDyad
from pylinkage.simulation import Linkage
o, d = Ground(0.0, 0.0), Ground(0.4, 0.0)
crank = Crank(o, 0.1, angular_velocity=tau / 360)
linkage = Linkage([o, d, crank, RRRDyad(crank.output, d, 0.3, 0.3, x=0.25, y=0.26)])
linkage.set_input_velocity(crank, 2.0)
linkage.step_fast_with_kinematics(361)
"""
BASE = 'python -c "import numpy"'


def cold_starts() -> Iterator[Row]:
    """Elapsed and processor time of each process over those of the process that imports NumPy."""
    with tempfile.TemporaryDirectory() as folder:
        tasks = _tasks(Path(folder))
        found: dict[str, list[tuple[float, float]]] = {name: [] for name in tasks}
        for arguments in tasks.values():
            process_times(arguments)  # writes byte code and the caches of pint and numba
        for _round in range(ROUNDS):
            for name, arguments in tasks.items():
                found[name].append(process_times(arguments))
    elapsed, used = _medians(found[BASE])
    for name in tasks:
        mine = _medians(found[name])
        yield Row(name, {"elapsed": mine[0] / elapsed, "processor": mine[1] / used})


def _tasks(folder: Path) -> Mapping[str, list[str]]:
    common, rare, out = folder / "common.toml", folder / "rare.toml", str(folder / "out")
    common.write_text(COMMON_UNITS, encoding="utf-8")
    rare.write_text(RARE_UNITS, encoding="utf-8")
    program = [sys.executable, "-m", "centrode"]
    tasks = {
        BASE: [sys.executable, "-c", "import numpy"],
        "centrode --help": [*program, "--help"],
        "centrode examples": [*program, "examples"],
        f"check {EXAMPLE}": [*program, "check", EXAMPLE],
        "check, lengths in mm": [*program, "check", str(common)],
        "check, a length in metre (pint)": [*program, "check", str(rare)],
        f"run {EXAMPLE} --no-figures": [*program, "run", EXAMPLE, "--no-figures", "--out", out],
        f"run {EXAMPLE}": [*program, "run", EXAMPLE, "--out", out],
    }
    if peer.PRESENT:
        tasks["pylinkage, one four-bar"] = [sys.executable, "-c", PEER]
    return tasks


def _medians(times: list[tuple[float, float]]) -> tuple[float, float]:
    elapsed, used = zip(*times, strict=True)
    return statistics.median(elapsed), statistics.median(used)
