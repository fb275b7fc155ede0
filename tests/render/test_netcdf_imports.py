"""What writing a file does not load: libraries of clusters."""

from __future__ import annotations

import subprocess
import sys
from importlib.util import find_spec

import pytest

WRITTEN = """
import sys
from pathlib import Path
import centrode as ct
from centrode.render.netcdf import read_dataset, write_dataset
file = Path(sys.argv[1])
motion = ct.motion("crank-rocker", 7)
write_dataset(motion, file)
assert (read_dataset(file)["position"].values == motion["position"].values).all()
print("distributed" in sys.modules)
"""


@pytest.mark.skipif(find_spec("distributed") is None, reason="the library of clusters is not installed")
def test_a_file_asks_for_no_cluster(tmp_path: object) -> None:
    done = subprocess.run(
        [sys.executable, "-c", WRITTEN, f"{tmp_path}/a.nc"], capture_output=True, check=True, encoding="utf-8"
    )
    assert done.stdout.split() == ["False"]
