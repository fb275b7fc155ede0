"""`centrode export`: models on the terminal and in files."""

from __future__ import annotations

import json
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET

import pytest

Centrode = Callable[..., Any]


def test_a_model_is_printed_or_written(centrode: Centrode, tmp_path: Path) -> None:
    printed = centrode("export", "crank-rocker", "--format", "mjcf")
    assert printed.code == 0
    assert ET.fromstring(printed.out).tag == "mujoco"
    assert centrode("export", "crank-rocker").out == printed.out
    file = tmp_path / "model.xml"
    assert centrode("export", "crank-rocker", "--format", "mjcf", "--out", file).code == 0
    assert file.read_text(encoding="utf-8") == printed.out
    again = centrode("export", "crank-rocker", "--format", "mjcf", "--out", file)
    assert (again.code, "exists already" in again.err) == (2, True)
    assert centrode("export", "crank-rocker", "--format", "mjcf", "--out", file, "--force").code == 0


def test_source_files_are_printed_or_written(centrode: Centrode, tmp_path: Path) -> None:
    printed = centrode("export", "crank-rocker", "--python", "--vary", "links.AB.length", "--to", "90 deg")
    assert printed.code == 0 and printed.out.startswith("# Crank-rocker")
    assert "DIMENSION_NAMES = ['links.AB.length']" in printed.out
    compile(printed.out, "printed", "exec")
    for kind, suffix in (("c", ".c"), ("javascript", ".js"), ("matlab", ".m")):
        file = tmp_path / f"my_crank{suffix}"
        assert centrode("export", "crank-rocker", f"--{kind}", "--out", file).code == 0
        text = file.read_text(encoding="utf-8")
        assert "my_crank" in text and "crank_rocker" not in text
        assert centrode("export", "crank-rocker", "--format", kind, "--out", file, "--force").code == 0
        assert file.read_text(encoding="utf-8") == text


def test_models_of_robots_have_a_file_of_loops_beside_them(centrode: Centrode, tmp_path: Path) -> None:
    for kind, tag in (("urdf", "robot"), ("sdf", "sdf")):
        file = tmp_path / f"model.{kind}"
        done = centrode("export", "crank-rocker", "--format", kind, "--out", file)
        assert done.code == 0 and "model.loops.json" in done.out
        assert ET.fromstring(file.read_text(encoding="utf-8")).tag == tag
        assert len(json.loads((tmp_path / "model.loops.json").read_text(encoding="utf-8"))["closures"]) == 1
        (tmp_path / "model.loops.json").unlink()


def test_an_fmu_is_written(centrode: Centrode, tmp_path: Path) -> None:
    file = tmp_path / "engine.fmu"
    words = ("export", "single-cylinder-engine", "--format", "fmu", "--output", "position B x", "--out", file)
    done = centrode(*words)
    assert (done.code, str(file) in done.out) == (0, True), done.err
    with zipfile.ZipFile(file) as archive:
        assert set(archive.namelist()) == {
            "modelDescription.xml", "sources/buildDescription.xml", "sources/engine.c",
        }  # fmt: skip
        root = ET.fromstring(archive.read("modelDescription.xml"))
        names = [each.attrib["name"] for each in root.iter("Float64")]
    assert "drive moment" in names and "position B x" in names and "position B y" not in names
    assert centrode(*words).code == 2 and centrode(*words, "--force").code == 0


def test_what_cannot_be_exported_is_told(centrode: Centrode) -> None:
    for words, told in (
        (("export", "crank-rocker", "--format", "step"), "'step' is not one of"),
        (("export", "crank-rocker", "--vary", "links.AB.length"), "--vary belongs to source files and FMUs"),
        (("export", "crank-rocker", "--to", "90 deg"), "--to belongs to source files and FMUs"),
        (("export", "hookes-joint", "--format", "urdf"), "planar linkages"),
        (("export", "crank-rocker", "--format", "fmu"), "FILE.fmu"),
        (("export", "crank-rocker", "--format", "fmu", "--out", "x.fmu"), "masses"),
        (("export", "crank-rocker", "--driven"), "belong to an FMU"),
        (("export", "crank-rocker", "--free", "--c"), "only a model for MuJoCo"),
        (("export", "third-class-triad", "--python"), "platform"),
        (("export", "crank-rocker", "--c", "--vary", "links.XY.length"), "XY"),
        (("export", "crank-rocker", "--matlab", "--out", "my crank.m"), "my_crank.m"),
        (("export", "spherical-crank-rocker"), "ring and a point mass"),
        (("export", "cam-from-curvature"), "cam"),
        (("export", "nothing"), "no such file"),
    ):
        done = centrode(*words)
        assert (done.code, told in done.err) == (2, True), done.err


@pytest.mark.parametrize(
    ("words", "named"),
    [
        (("--c", "--python"), "--c and --python"),
        (("--format", "fmu", "--matlab"), "--format fmu and --matlab"),
        (("--format", "urdf", "--format", "sdf"), "--format urdf and --format sdf"),
    ],
)
def test_one_format_is_written_at_a_time(centrode: Centrode, words: tuple[str, ...], named: str) -> None:
    """In whatever order they stand; the same format said twice is one."""
    for order in (words, words[::-1] if "--format" not in words else words):
        done = centrode("export", "crank-rocker", *order)
        assert (done.code, done.out) == (2, "")
        assert f"--format: {named} are given together" in done.err
    twice = centrode("export", "crank-rocker", "--c", "--format", "c")
    assert (twice.code, twice.out) == (0, centrode("export", "crank-rocker", "--c").out)
