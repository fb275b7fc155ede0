"""`centrode draw`: drawings in files, and what is refused."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET

import ezdxf

Centrode = Callable[..., Any]


def test_drawings_are_written(centrode: Centrode, tmp_path: Path) -> None:
    svg, dxf = tmp_path / "a.svg", tmp_path / "a.dxf"
    words = (
        "draw",
        "six-bar-press",
        "--at",
        "120 deg",
        "--path",
        "all",
        "--centrodes",
        "AB",
        "--samples",
        "37",
    )
    assert centrode(*words, "--out", svg).code == 0
    groups = [group.attrib["id"] for group in ET.parse(svg).getroot()]
    assert {"frame", "links", "hinges", "drive", "names", "paths", "centrodes", "title"} == set(groups)
    assert "OA 120°" in svg.read_text(encoding="utf-8")
    assert centrode(*words, "--out", dxf).code == 0
    assert not ezdxf.readfile(dxf).audit().errors
    again = centrode(*words, "--out", dxf)
    assert (again.code, "exists already" in again.err) == (2, True)
    assert centrode(*words, "--out", dxf, "--force", "--no-names").code == 0
    assert "names" not in {entity.dxf.layer for entity in ezdxf.readfile(dxf).modelspace()}


def test_a_driving_cam_is_drawn(centrode: Centrode, tmp_path: Path) -> None:
    svg, dxf = tmp_path / "a.svg", tmp_path / "a.dxf"
    assert centrode("draw", "cam-driven-linkage", "--at", "0.1 s", "--out", svg).code == 0
    assert "cams" in {group.attrib["id"] for group in ET.parse(svg).getroot()}
    assert centrode("draw", "cam-driven-linkage", "--at", "0.1 s", "--out", dxf).code == 0
    document = ezdxf.readfile(dxf)
    assert not document.audit().errors
    assert {entity.dxftype() for entity in document.modelspace().query('*[layer=="cams"]')} == {
        "CIRCLE",
        "LWPOLYLINE",
    }


def test_what_cannot_be_drawn_is_told(centrode: Centrode, tmp_path: Path) -> None:
    for words, told in (
        (("six-bar-press", "--out", tmp_path / "a.pdf"), "a drawing cannot be written as"),
        (("six-bar-press", "--path", "Z", "--out", tmp_path / "a.svg"), "no moving point"),
        (("six-bar-press", "--centrodes", "Z", "--out", tmp_path / "a.svg"), "no link"),
        (("six-bar-press", "--at", "1 kg", "--out", tmp_path / "a.svg"), "--at"),
        (("hookes-joint", "--out", tmp_path / "a.svg"), "planar"),
        (("six-bar-press", "--out", tmp_path), "a drawing cannot be written as"),
        (("valve-cam", "--out", tmp_path / "a.svg"), "this describes a cam, not a linkage"),
    ):
        done = centrode("draw", *words)
        assert (done.code, told in done.err) == (2, True), done.err
    assert list(tmp_path.iterdir()) == []


def test_what_is_not_reached_is_told(centrode: Centrode, tmp_path: Path) -> None:
    far = centrode("draw", "slider-between-cranks-locked", "--at", "150 deg", "--out", tmp_path / "a.svg")
    assert (far.code, "no position" in far.err, (tmp_path / "a.svg").exists()) == (3, True, True)
    still = centrode("draw", "parallelogram", "--centrodes", "AB", "--out", tmp_path / "b.svg")
    assert (still.code, "no centre" in still.err, (tmp_path / "b.svg").exists()) == (3, True, False)


def test_a_place_beyond_the_range_is_no_part_of_the_paths(centrode: Centrode, tmp_path: Path) -> None:
    drawn = []
    for name, at in (("a.svg", "100 deg"), ("b.svg", "820 deg")):  # two turns later
        words = (
            "draw",
            "crank-rocker",
            "--at",
            at,
            "--samples",
            "73",
            "--path",
            "B",
            "--out",
            tmp_path / name,
        )
        assert centrode(*words).code == 0
        (paths,) = (group for group in ET.parse(tmp_path / name).getroot() if group.attrib["id"] == "paths")
        drawn.append([[float(x) for x in line.attrib["points"].replace(",", " ").split()] for line in paths])
    for first, second in zip(*drawn, strict=True):
        # millimetres of a sheet of some metres, in coordinates with six digits of it after the first
        assert max(abs(a - b) for a, b in zip(first, second, strict=True)) <= 0.02
