"""What whole processes take."""

from __future__ import annotations

import os
import subprocess
import time
from collections.abc import Mapping, Sequence
from pathlib import Path

ENVIRONMENT = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
"""Byte code is kept, as it is for an installed package."""


def process_times(
    arguments: Sequence[str], folder: Path | None = None, environment: Mapping[str, str] = ENVIRONMENT
) -> tuple[float, float]:
    """Elapsed and processor time of a process, and of those that it began and waited for [s]."""
    before, start = os.times(), time.perf_counter()
    done = subprocess.run(
        arguments, capture_output=True, check=False, encoding="utf-8", env=environment, cwd=folder
    )
    after, end = os.times(), time.perf_counter()
    if done.returncode:
        raise SystemExit(f"{' '.join(arguments)} ended with {done.returncode}\n{done.stderr}")
    used = after.children_user + after.children_system - before.children_user - before.children_system
    return end - start, used
