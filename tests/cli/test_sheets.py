"""`centrode sheets` and `centrode draw --scale`: files, options, and what is refused."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import ezdxf
import pytest

import centrode as ct

Centrode = Callable[..., Any]


def test_sheets_are_written(centrode: Centrode, tmp_path: Path) -> None:
    done = centrode("sheets", "crank-rocker", "--at", "30 deg", "--scale", "1:25", "--out", tmp_path / "a")
    assert (done.code, "--at: 0.523598776 rad" in done.err) == (0, True), done.err
    assert sorted(file.name for file in (tmp_path / "a").iterdir()) == ["sheet-1.dxf", "sheet-1.pdf"]
    document = ezdxf.readfile(tmp_path / "a" / "sheet-1.dxf")
    assert not document.audit().errors
    assert "1:25" in {text.dxf.text for text in document.modelspace().query("TEXT")}
    assert centrode("sheets", "crank-rocker", "--format", "pdf", "--out", tmp_path / "b").code == 0
    assert [file.name for file in (tmp_path / "b").iterdir()] == ["sheet-1.pdf"]


def test_what_cannot_be_put_on_sheets_is_told(centrode: Centrode, tmp_path: Path) -> None:
    for words, told in (
        (
            ("crank-rocker", "--scale", "2:1"),
            "2:1 is too large for the sheet; the largest standard scale is 1:15",
        ),
        (
            ("crank-rocker", "--scale", "big"),
            '--scale: "big" is not a scale; write it as a ratio, such as 1:5 or 2:1',
        ),
        (("crank-rocker", "--scale", "1:0"), "is not a scale"),
        (("crank-rocker", "--format", "dwg"), "use one of pdf, dxf"),
        (("crank-rocker", "--link", "Z"), "neither a link nor a guide"),
        (("crank-rocker", "--positions", "1"), "1 position is given"),
        (("crank-rocker", "--at", "1 kg"), "--at"),
        (
            ("spherical-crank-rocker", "--link", "BC"),
            "BC neither turns about a hinge of the frame nor is a guide",
        ),
        (("valve-cam", "--at", "30 deg"), "--at: the sheet of a cam has no plans of vectors; omit it"),
        (
            ("valve-cam", "--link", "A"),
            "--link: the sheet of a cam shows the motion of its follower; omit it",
        ),
        (
            ("valve-cam", "--scale", "10:1"),
            "10:1 is too large for the sheet; the largest standard scale is 4:1",
        ),
        (("valve-cam", "--positions", "40"), "40 positions are given"),
    ):
        done = centrode("sheets", *words, "--out", tmp_path / "a")
        assert (done.code, told in done.err) == (2, True), done.err
    assert list(tmp_path.iterdir()) == []


def test_of_a_spherical_linkage_its_diagrams_are_drawn(centrode: Centrode, tmp_path: Path) -> None:
    done = centrode("sheets", "spherical-crank-guide", "--out", tmp_path / "a")
    assert (done.code, "not drawn on the sphere: plan of positions" in done.err) == (0, True), done.err
    assert sorted(file.name for file in (tmp_path / "a").iterdir()) == ["sheet-1.dxf", "sheet-1.pdf"]


def test_of_a_cam_its_synthesis_is_drawn(centrode: Centrode, tmp_path: Path) -> None:
    done = centrode("sheets", "indexing-cam", "--positions", "8", "--out", tmp_path / "a")
    assert done.code == 0, done.err
    document = ezdxf.readfile(tmp_path / "a" / "sheet-1.dxf")
    words = {text.dxf.text for text in document.modelspace().query("TEXT")}
    assert {
        "Profile of the cam by the method of inversion",
        "Angular velocity coefficient of the follower",
    } <= words


def test_a_sheet_that_cannot_be_made_is_named(centrode: Centrode, tmp_path: Path) -> None:
    text = ct.mechanism_text(ct.example("crank-rocker")).replace("[links.DB]", "[links.DB]\nmass = 3")
    file = tmp_path / "rocker.toml"
    file.write_text(text + "\n[machine]\nmean_speed = 1\nfluctuation = 0.1\n", encoding="utf-8")
    done = centrode("sheets", file, "--format", "pdf", "--out", tmp_path / "a")
    assert (done.code, "could not be made" in done.err) == (3, True), done.err
    assert (tmp_path / "a" / "sheet-1.pdf").exists()


def test_a_drawing_has_its_scale(centrode: Centrode, tmp_path: Path) -> None:
    apart = []
    for scale in ("1:1", "1:2,5"):
        file = tmp_path / f"{len(apart)}.dxf"
        assert centrode("draw", "crank-rocker", "--scale", scale, "--out", file).code == 0
        space = ezdxf.readfile(file).modelspace()
        circles = [tuple(one.dxf.center)[:2] for one in space.query("CIRCLE")]
        apart.append([math.dist(a, b) for a in circles for b in circles])
        told = {text.dxf.text for text in space.query("TEXT")}
        assert f"scale {scale.replace(',', '.')}, millimetres" in told
    assert apart[1] == pytest.approx([one / 2.5 for one in apart[0]], rel=1e-9)
    done = centrode("draw", "crank-rocker", "--scale", "half", "--out", tmp_path / "b.dxf")
    assert (done.code, '"half" is not a scale' in done.err) == (2, True)
