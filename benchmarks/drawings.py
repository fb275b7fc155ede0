"""Commands that draw: a report, and runs with and without their figures, as whole processes."""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from benchmarks.processes import process_times
from benchmarks.table import Promise, Row

ROUNDS = 3
PRESS, CRANK = "six-bar-press", "crank-rocker"
REPORT, RUN = 5.0, 3.2
"""Seconds of a processor that a compact report of the six-bar may take, and a run of the four-bar with figures."""
SHARE = 1.3
"""A run of the six-bar with figures over one without them and what matplotlib takes for the same drawings."""
DRAWN = """\
import time
from pathlib import Path
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.backends.backend_svg import FigureCanvasSVG
import centrode as ct
from centrode.dynamics.motion_results import study
from centrode.render.drawing.style import house_style
from centrode.render.figures.pictures import figures_of
from centrode.topics.kinematics import RUN
from centrode.topics.sheets import sheet_with_parts
mechanism = ct.example("{name}")
pictures = sheet_with_parts(RUN, study(mechanism)).pictures
start = time.process_time()
for figure in figures_of(pictures, mechanism.display).values():
    with house_style():
        FigureCanvasAgg(figure).print_png("a.png")
        FigureCanvasSVG(figure).print_svg("a.svg")
Path("seconds").write_text(str(time.process_time() - start))
"""
"""Figures are made and printed by matplotlib's own canvases."""


def drawings() -> Iterator[Row]:
    """Elapsed and processor time of each command, the least of several rounds in turns."""
    program = [sys.executable, "-m", "centrode"]
    tasks: Mapping[str, Sequence[str]] = {
        f"report {PRESS}": [*program, "report", PRESS],
        f"run {CRANK}": [*program, "run", CRANK],
        f"run {PRESS}": [*program, "run", PRESS],
        f"run {PRESS} --no-figures": [*program, "run", PRESS, "--no-figures"],
    }
    found: dict[str, list[tuple[float, float]]] = {name: [] for name in tasks}
    own: list[float] = []
    for _round in range(ROUNDS):
        for name, arguments in tasks.items():
            with tempfile.TemporaryDirectory() as folder:
                found[name].append(process_times([*arguments, "--out", "out"], Path(folder)))
        own.append(_matplotlib_alone(PRESS))
    for name, times in found.items():
        elapsed, used = (min(each) for each in zip(*times, strict=True))
        yield Row(name, {"elapsed [s]": elapsed, "processor [s]": used}, promises=_promises(name, used))
    drawn, plain = (min(used for _elapsed, used in found[name]) for name in list(tasks)[2:])
    share = drawn / (plain + min(own))
    what = f"run {PRESS} over --no-figures and matplotlib alone"
    yield Row(
        f"{PRESS}, matplotlib alone",
        {"processor [s]": min(own), "run / (no figures + alone)": share},
        promises=[Promise(what, share, at_most=SHARE)],
    )


def _promises(name: str, used: float) -> list[Promise]:
    bounds = {f"report {PRESS}": REPORT, f"run {CRANK}": RUN}
    return [Promise(f"{name}, processor [s]", used, at_most=bounds[name])] if name in bounds else []


def _matplotlib_alone(name: str) -> float:
    """Processor time in which matplotlib makes and prints the figures of a run [s]."""
    with tempfile.TemporaryDirectory() as folder:
        process_times([sys.executable, "-c", DRAWN.format(name=name)], Path(folder))
        return float((Path(folder) / "seconds").read_text())
