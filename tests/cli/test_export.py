"""`centrode export`: models on the terminal and in files."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET

Centrode = Callable[..., Any]


def test_a_model_is_printed_or_written(centrode: Centrode, tmp_path: Path) -> None:
    printed = centrode("export", "crank-rocker", "--mjcf")
    assert printed.code == 0
    assert ET.fromstring(printed.out).tag == "mujoco"
    file = tmp_path / "model.xml"
    assert centrode("export", "crank-rocker", "--mjcf", "--out", file).code == 0
    assert file.read_text(encoding="utf-8") == printed.out
    again = centrode("export", "crank-rocker", "--mjcf", "--out", file)
    assert (again.code, "exists already" in again.err) == (2, True)
    assert centrode("export", "crank-rocker", "--mjcf", "--out", file, "--force").code == 0


def test_what_cannot_be_exported_is_told(centrode: Centrode) -> None:
    for words, told in (
        (("export", "crank-rocker"), "nothing says for which program"),
        (("export", "hookes-joint", "--mjcf"), "planar linkages"),
        (("export", "rack-and-pinion", "--mjcf"), "no wheels that roll"),
        (("export", "cam-from-curvature", "--mjcf"), "cam"),
        (("export", "nothing", "--mjcf"), "no such file"),
    ):
        done = centrode(*words)
        assert (done.code, told in done.err) == (2, True), done.err
