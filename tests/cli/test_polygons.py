"""`centrode polygons`: what it writes and prints, and what it refuses."""

from __future__ import annotations

import csv
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import centrode as ct
from centrode.model.examples import example_text

Centrode = Callable[..., Any]


def rows(file: Path) -> list[dict[str, str]]:
    with file.open(encoding="utf-8", newline="") as stream:
        return list(csv.DictReader(stream))


def test_the_press_at_its_instant(centrode: Centrode, folder: Path) -> None:
    done = centrode("polygons", "six-bar-press", "--at", "120 deg", "--out", "p")
    assert done.code == 0, done
    assert "Group 4, 5 (RRP): DH, slider" in done.out
    assert "-6.80678 rad/s, the mean speed of the machine" in done.out
    names = sorted(file.name for file in (folder / "p").iterdir())
    pages = ("group-1", "group-2", "group-3", "lever")
    assert names == sorted(["polygons.csv", *(f"{page}.{kind}" for page in pages for kind in ("png", "svg"))])
    found = ct.force_polygons(ct.example("six-bar-press"), math.radians(120))
    balancing = f"{found.balancing['OA']:.9g}"
    assert done.out.count(balancing) == 3  # three routes
    written = rows(folder / "p" / "polygons.csv")
    vectors = [row for row in written if row["polygon"] == "group" and row["bodies"] == "AB; CD"]
    assert [row["name"] for row in vectors] == [one.name for one in found.groups[1].polygon.vectors]
    for row, vector in zip(vectors, found.groups[1].polygon.vectors, strict=True):
        assert complex(float(row["force_x [N]"]), float(row["force_y [N]"])) == vector.force
        assert complex(float(row["end_x [N]"]), float(row["end_y [N]"])) == vector.end
        assert float(row["length [mm]"]) == found.groups[1].polygon.length(vector)


def test_several_instants(centrode: Centrode, folder: Path) -> None:
    done = centrode(
        "polygons", "six-bar-press", "--at", "30 deg", "--at", "90 deg", "--no-figures", "--paper", "A5"
    )
    assert done.code == 0, done
    names = sorted(file.name for file in (folder / "six-bar-press-polygons").iterdir())
    assert names == ["polygons-1.csv", "polygons-2.csv"]


@pytest.mark.drawn
def test_dark_pages(centrode: Centrode, folder: Path) -> None:
    done = centrode("polygons", "six-bar-press", "--at", "1 rad", "--dark", "--out", "p")
    assert done.code == 0, done
    assert (folder / "p" / "lever.png").is_file()


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["six-bar-press", *("--at", "1 rad") * 101], "at most 100"),
        (["six-bar-press", "--at", "fast"], "--at"),
        (["six-bar-press", "--at", "1 mm"], "--at"),
        (["six-bar-press", "--at", "nan"], "--at"),
        (["six-bar-press", "--at", "1e9 rad"], "range"),
        (["six-bar-press", "--at", "1 rad", "--paper", "letter"], "is not a supported paper size"),
        (["crank-rocker", "--at", "1 rad"], "neither masses nor loads"),
        (["spherical-four-bar", "--at", "1 rad"], "sphere"),
        (["no-such-mechanism", "--at", "1 rad"], "no-such-mechanism"),
    ],
)
def test_wrong_input(centrode: Centrode, folder: Path, arguments: list[str], told: str) -> None:
    done = centrode("polygons", *arguments)
    assert done.code == 2, done
    assert told in done.err
    assert "Traceback" not in done.err
    assert list(folder.iterdir()) == []


LOADED = """
[[loads]]
kind = "torque"
link = "{link}"
value = 3
"""


@pytest.mark.parametrize(
    ("name", "link", "at", "told"),
    [
        ("slider-between-cranks-locked", "BD", "2.5 rad", "the mechanism is open"),
        ("parallelogram", "DB", "pi rad", "singular"),
    ],
)
def test_where_there_are_no_forces(
    centrode: Centrode, folder: Path, name: str, link: str, at: str, told: str
) -> None:
    text = example_text(name) + LOADED.format(link=link)
    (folder / "loaded.toml").write_text(text, encoding="utf-8")
    done = centrode("polygons", "loaded.toml", "--at", at)
    assert done.code == 3, done
    assert told in done.err
    assert sorted(path.name for path in folder.iterdir()) == ["loaded.toml"]


def test_constraints_that_repeat_each_other_are_named(centrode: Centrode, folder: Path) -> None:
    text = example_text("three-crank-parallelogram") + LOADED.format(link="FE")
    (folder / "loaded.toml").write_text(text, encoding="utf-8")
    done = centrode("polygons", "loaded.toml", "--at", "1 rad")
    assert done.code == 2, done
    assert "point E in link FE: constraints are redundant" in done.err
