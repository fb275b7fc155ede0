"""On the sphere the arc of a guide that drives is an angle, in whatever a command reads or shows."""

from __future__ import annotations

import csv
import json
import math
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

Centrode = Callable[..., Any]

TEXT = """\
space = "sphere"
display = { angle = "deg" }
[frame.points]
A = [1, 0, 0]
D = [0, 1, 0]
[links.AB]
length = "15 deg"
reference = ["A", "D"]
[links.BC]
length = "45 deg"
mass = 2
shape = "arc"
[[guides]]
point = "C"
pole = "D"
radius = "90 deg"
[[drives]]
guide = "C"
start = "45 deg"
speed = "10 deg/s"
[assembly]
sides = { B = "left" }
[study]
samples = 3
from = "40 deg"
to = "50 deg"
instants = ["45 deg"]
"""
METRES = re.compile(r"\d\s*m\b(?!\^)|\[m(/s)?\]")


@pytest.fixture(autouse=True)
def arc(folder: Path) -> Path:
    path = folder / "arc.toml"
    path.write_text(TEXT, encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("words", "shown"),
    [
        (["centres", "arc.toml", "--at", "45 deg"], "C 45 deg"),
        (["centres", "arc.toml"], "C 45 deg"),
        (
            ["run", "arc.toml", "--from", "40 deg", "--to", "50 deg", "--no-figures"],
            "40 deg to 50 deg in 1 s",
        ),
        (["reactions", "arc.toml"], "0.174533 rad/s"),
        (["reactions", "arc.toml", "--at", "45 deg"], "balancing moment of drive C  N·m"),
        (["reduce", "arc.toml", "--from", "40 deg", "--to", "50 deg"], "0.174533 rad/s"),
        (["limits", "arc.toml", "--about", "50 deg"], "60 deg, limit of group AB-BC (point B)"),
        (["rotatability", "arc.toml"], "C = 60 deg"),
        (["describe", "arc.toml"], "10 deg/s"),
    ],
)
def test_values_are_angles(centrode: Centrode, words: list[str], shown: str) -> None:
    done = centrode(*words)
    resolved = "without --at, the instants of [study]: 45 deg\n" if words == ["centres", "arc.toml"] else ""
    if words[0] == "reduce":
        resolved = "--from: 40 deg; --to: 50 deg\n"
    assert (done.code, done.err) == (0, resolved)
    assert shown in done.out
    assert METRES.search(done.out) is None


@pytest.mark.parametrize(
    "words",
    [
        ["centres", "arc.toml", "--at", "5 mm"],
        ["reactions", "arc.toml", "--at", "5 mm"],
        ["reactions", "arc.toml", "--from", "5 mm"],
        ["run", "arc.toml", "--to", "5 mm", "--no-figures"],
        ["limits", "arc.toml", "--about", "5 mm"],
        ["report", "arc.toml", "--at", "5 mm"],
        ["animate", "arc.toml", "--from", "5 mm"],
        ["simulate", "arc.toml", "--duration", "1 s", "--speed", "1 m/s"],
    ],
)
def test_lengths_are_refused(centrode: Centrode, words: list[str]) -> None:
    done = centrode(*words)
    assert done.code == 2
    assert "an angle (rad)" in done.err or "an angular speed (rad/s)" in done.err


def test_files_are_in_angles(centrode: Centrode, folder: Path) -> None:
    done = centrode("run", "arc.toml", "--no-figures", "--out", "r")
    assert done.code == 0
    with (folder / "r" / "motion.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    values = [float(row["drive_C [deg]"]) for row in rows]
    assert values == pytest.approx([40.0, 45.0, 50.0], rel=1e-15)
    scalars = json.loads((folder / "r" / "summary.json").read_text(encoding="utf-8"))
    assert scalars["first_value"]["unit"] == "rad"
    assert scalars["first_value"]["value"] == pytest.approx(math.radians(40), rel=1e-15)
    assert {one["unit"] for one in scalars.values()} <= {"1", "rad", "s", "N", "N m"}


def test_the_speed_of_a_simulation_is_an_angular_speed(centrode: Centrode) -> None:
    """It was read in metres a second, although the description's own was an angular one."""
    done = centrode("simulate", "arc.toml", "--duration", "10 ms", "--speed", "10 deg/s", "--driving", "0")
    assert (done.code, done.err) == (0, "")
    assert "rad/s" in done.rows["speed of the drive"]
    assert "deg" in done.rows["moved"]


@pytest.mark.parametrize("command", ["plan", "diagrams", "polygons"])
def test_what_is_drawn_in_the_plane_alone_refuses_the_sphere(centrode: Centrode, command: str) -> None:
    done = centrode(command, "arc.toml", *([] if command == "plan" else ["--at", "45 deg"]))
    assert done.code == 2
    assert "the sphere" in done.err or "the plane only" in done.err
