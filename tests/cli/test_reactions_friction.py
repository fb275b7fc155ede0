"""`centrode reactions` with friction by coefficients: losses, self-locking, wrong input; the same in a run."""

from __future__ import annotations

import csv
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import xarray as xr

Centrode = Callable[..., Any]

PUMP = """\
title = "Pump"
[frame.points]
O = [0, 0]
[links.OA]
length = 0.1
[links.AB]
length = 0.4
[links.piston]
points = ["B"]
[[guides]]
point = "B"
on = "frame"
through = "O"
direction = [1, 0]
link = "piston"
[[drives]]
link = "OA"
speed = "300 rpm"
[[loads]]
kind = "force"
point = "B"
vector = ["-2 kN", 0]
while_moving = [1, 0]
[[loads]]
kind = "friction"
point = "A"
coefficient = 0.1
radius = "10 mm"
[[loads]]
kind = "friction"
guide = "B"
coefficient = 0.2
[assembly]
sides = { B = "ahead" }
"""

DRAWER = """\
[frame.points]
O = [0, 0]
[links.puller]
points = ["D"]
[links.drawer]
points = ["S"]
[[guides]]
point = "D"
on = "frame"
through = [0, 0.3]
direction = [1, 0]
link = "puller"
[[guides]]
point = "S"
on = "frame"
through = "O"
direction = [1, 0]
link = "drawer"
[[guides]]
point = "D"
on = "drawer"
name = "slot"
through = [0, 0]
direction = [0, 1]
[[drives]]
guide = "D"
speed = 0.5
[[loads]]
kind = "force"
guide = "S"
value = -10
[[loads]]
kind = "friction"
guide = "S"
coefficient = 0.25
length = "100 mm"
[study]
from = 0
to = 0.2
samples = 5
"""


def test_losses_are_told_and_written(centrode: Centrode, folder: Path) -> None:
    (folder / "pump.toml").write_text(PUMP)
    done = centrode("reactions", "pump.toml", "--samples", 73, "--out", "result")
    assert (done.code, done.err) == (0, "")
    assert 0.8 < float(done.rows["overall efficiency"]) < 1
    assert done.rows["friction reverses"] == "3 samples, values just after each"
    assert "A/AB, moment of friction" in done.out
    assert "guide B, friction" in done.out
    assert "friction at  greatest power, W" in done.out
    with (folder / "result" / "reactions.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert {"friction_moment_A/AB [N m]", "friction_force_B [N]", "friction_power_guide B [W]"} <= set(
        rows[0]
    )
    data = xr.load_dataset(folder / "result" / "reactions.nc")
    shares = [
        float(line.split()[-1]) for line in done.out.splitlines() if line.startswith(("A/AB  ", "guide B  "))
    ]
    assert abs(sum(shares[-2:]) - 100) < 0.011
    assert float(rows[5]["friction_moment_A/AB [N m]"]) == data.friction_moment[5, 0].item()


def test_friction_can_be_left_out(centrode: Centrode, folder: Path) -> None:
    (folder / "pump.toml").write_text(PUMP)
    (folder / "smooth.toml").write_text(
        PUMP.partition('[[loads]]\nkind = "friction"')[0] + "[assembly]\n" + 'sides = { B = "ahead" }\n'
    )
    done = centrode("reactions", "pump.toml", "--samples", 37, "--frictionless")
    assert done.code == 0
    assert done.out == centrode("reactions", "smooth.toml", "--samples", 37).out
    assert "friction" not in done.out


def test_an_instant(centrode: Centrode, folder: Path) -> None:
    (folder / "pump.toml").write_text(PUMP)
    done = centrode("reactions", "pump.toml", "--at", "40 deg")
    assert done.code == 0
    assert "overall" not in done.out
    assert "friction at" not in done.out


def test_what_jams_ends_with_3(centrode: Centrode, folder: Path) -> None:
    (folder / "drawer.toml").write_text(DRAWER)
    done = centrode("reactions", "drawer.toml", "--out", "result")
    assert done.code == 3
    assert "self-locking: at 5 samples no drive overcomes the friction" in done.err
    assert done.rows["samples"] == "5: self-locking 5"
    assert (folder / "result" / "reactions.csv").read_text().count("self-locking") == 5
    done = centrode("run", "drawer.toml", "--out", "run")
    assert done.code == 0
    assert "note: self-locking: at 5 samples no drive overcomes the friction" in done.out


def test_a_joint_that_stands_is_named(centrode: Centrode, folder: Path) -> None:
    still = PUMP.replace('speed = "300 rpm"', 'law = "1 + 0*t"').replace("while_moving = [1, 0]\n", "")
    (folder / "pump.toml").write_text(still + "[study]\nto = 1\nsamples = 3\n")
    done = centrode("reactions", "pump.toml")
    assert done.code == 0
    assert done.rows["no friction"] == "A/AB, guide B: no motion there, friction is set to 0"


@pytest.mark.parametrize(
    ("change", "command", "message"),
    [
        (("coefficient = 0.1", "coefficient = -0.1"), "reactions", "coefficient must not be negative"),
        (('radius = "10 mm"\n', ""), "reactions", "the radius of the pin is missing"),
        (('point = "A"', 'point = "Z"'), "reactions", "unknown point"),
        (
            ('radius = "10 mm"', 'radius = "10 mm"\npin = "piston"'),
            "reactions",
            "pin piston has no hinge in A",
        ),
        (("", ""), "reduce", "Coulomb friction needs the reactions"),
        (("", ""), "polygons", "Coulomb friction needs the reactions"),
    ],
)
def test_wrong_input_ends_with_2(
    centrode: Centrode, folder: Path, change: tuple[str, str], command: str, message: str
) -> None:
    (folder / "pump.toml").write_text(PUMP.replace(*change))
    more = ("--at", "1 rad") if command == "polygons" else ()
    done = centrode(command, "pump.toml", *more)
    assert done.code == 2
    assert message in done.err
    assert "Traceback" not in done.err
