"""Thirty reports: every row of the assignment's table, two processes at once, as a teacher runs them."""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

from benchmarks.processes import ENVIRONMENT, process_times
from benchmarks.table import Promise, Row

TABLE = Path(__file__).parents[1] / "tests" / "reference" / "planar-variants.csv"
TOPOLOGY = "slider-between-cranks"
JOBS = 2
SECONDS, MEGABYTES = 90.0, 30.0
"""What thirty reports may take on two cores that do nothing else, and what their documents may hold."""
DOCUMENTS = ("report.html", "report.pdf")


def thirty_reports() -> Iterator[Row]:
    """Seconds, processor seconds and bytes of the whole command, and both over their bounds.

    The bound of the clock is judged by the processor time of two cores: a busy machine has less to give.
    """
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "variants"
        program = [sys.executable, "-m", "centrode", "variants", str(TABLE), "--topology", TOPOLOGY]
        elapsed, used = process_times(
            [*program, "--report", "--jobs", str(JOBS), "--out", str(out)],
            environment=ENVIRONMENT | {"OPENBLAS_NUM_THREADS": "1"},
        )
        files = [file for file in out.rglob("*") if file.is_file()]
        documents = sum(file.stat().st_size for file in files if file.name in DOCUMENTS) / 1e6
        every = sum(file.stat().st_size for file in files) / 1e6
    over = used / JOBS / SECONDS
    yield Row(
        "time",
        {"s": elapsed, "processor s": used, "s / 90": elapsed / SECONDS, "processor s / 180": over},
        promises=[Promise("thirty reports, processor time over that of two cores in 90 s", over, 1.0)],
    )
    yield Row(
        "bytes",
        {"documents, MB": documents, "all files, MB": every, "documents / 30 MB": documents / MEGABYTES},
        promises=[Promise("thirty reports, documents over 30 MB", documents / MEGABYTES, 1.0)],
    )
