"""`centrode reactions` on the sphere."""

from __future__ import annotations

import csv
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import centrode as ct
from centrode.model.examples import example_text

Centrode = Callable[..., Any]

LOCKING = """\
title = "Locks"
space = "sphere"
[frame.points]
A = [0, 0]
D = [1, 0]
Z = [0, 1.5]
[links.AB]
length = 0.5
reference = ["A", "D"]
[links.BC]
length = 1.2
[links.DC]
length = 0.5
reference = ["D", "Z"]
[[drives]]
link = "AB"
start = 1
speed = 1
[[loads]]
kind = "force"
point = "C"
vector = [0, 0, -100]
[assembly]
sides = { C = "left" }
"""


def rows_of(path: Path) -> list[dict[str, str]]:
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def test_what_locks_ends_with_3(centrode: Centrode, folder: Path) -> None:
    text = example_text("slider-between-cranks-locked")
    (folder / "locked.toml").write_text(text.replace("[links.AC]", "[links.AC]\nmass = 1\nshape = 'rod'"))
    done = centrode("reactions", "locked.toml", "--out", "result", "--no-figures")
    assert done.code == 3
    assert "not reached" in done.err
    assert (folder / "result" / "reactions.csv").is_file()
    assert "nan" not in done.out


@pytest.mark.drawn
def test_the_sphere(centrode: Centrode, folder: Path) -> None:
    """Three components, the forces of the centre, and no column of directions."""
    done = centrode("reactions", "spherical-crank-rocker-rigid", "--samples", 13, "--out", "r")
    assert (done.code, done.err) == (0, "")
    assert done.rows["samples"] == "13: ok 13"
    assert "centre on BC" in done.out
    rows = rows_of(folder / "r" / "reactions.csv")
    assert {"joint_force_B/BC_z [N]", "joint_moment_B/BC_z [N m]", "centre_force_BC_x [N]"} <= set(rows[0])
    figures = {path.name for path in (folder / "r").iterdir() if path.suffix == ".svg"}
    assert {"joint-forces.svg", "joint-components.svg", "centre-forces.svg", "frame-force.svg"} <= figures
    data = ct.reactions(ct.example("spherical-crank-rocker-rigid"), at=[1.0])
    done = centrode("reactions", "spherical-crank-rocker-rigid", "--at", "1 rad")
    header = next(line for line in done.out.splitlines() if line.startswith("reaction "))
    assert header.split() == ["reaction", "unit", "x", "y", "z", "magnitude"]
    line = next(line for line in done.out.splitlines() if line.startswith("B: BC on AB"))
    force = data.joint_force.sel(side="B/AB").to_numpy()[0]
    wanted = [f"{x:.6g}" for x in (*force, np.linalg.norm(force))]
    assert line.split()[-4:] == wanted


@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("spherical-four-bar", "neither masses nor loads"),
        ("spherical-crank-rocker", "not a moment in a hinge"),
    ],
)
def test_what_makes_no_reactions_on_the_sphere(centrode: Centrode, name: str, reason: str) -> None:
    done = centrode("reactions", name)
    assert done.code == 2
    assert reason in done.err
    assert "Traceback" not in done.err


def test_a_spherical_linkage_that_locks_ends_with_3(centrode: Centrode, folder: Path) -> None:
    (folder / "m.toml").write_text(LOCKING)
    done = centrode("reactions", "m.toml", "--samples", 21, "--from", "1 rad", "--to", "0 rad")
    assert done.code == 3
    assert "locks" in done.err
    assert "open" in done.out
