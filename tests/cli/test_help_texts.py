"""What commands do not load: help texts of artists, and libraries of clusters."""

from __future__ import annotations

import subprocess
import sys
from importlib.util import find_spec

import pytest

WITHOUT = """
from centrode.cli.help_texts import omitted_help_texts
with omitted_help_texts():
    from matplotlib.lines import Line2D
from matplotlib.patches import Circle
line, circle = Line2D([0, 1], [0, 1]), Circle((0, 0))
line.set(color="red", linewidth=3)
circle.set(radius=2)
assert (line.get_color(), line.get_linewidth(), circle.get_radius()) == ("red", 3, 2)
assert not Line2D.set.__doc__
try:
    line.set(colours="red")
except AttributeError as failure:
    print(failure)
"""
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


def test_artists_without_help_do_what_they_did() -> None:
    """Properties are set and refused as before, also of classes that are imported later."""
    done = subprocess.run([sys.executable, "-c", WITHOUT], capture_output=True, check=True, encoding="utf-8")
    assert "colours" in done.stdout


@pytest.mark.skipif(find_spec("distributed") is None, reason="the library of clusters is not installed")
def test_a_file_asks_for_no_cluster(tmp_path: object) -> None:
    done = subprocess.run(
        [sys.executable, "-c", WRITTEN, f"{tmp_path}/a.nc"], capture_output=True, check=True, encoding="utf-8"
    )
    assert done.stdout.split() == ["False"]
