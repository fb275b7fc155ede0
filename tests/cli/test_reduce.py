"""`centrode reduce`: what it prints and writes, and how it ends."""

from __future__ import annotations

import csv
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import xarray as xr

import centrode as ct
from centrode.model.examples import example_text

Centrode = Callable[..., Any]

ARM = """\
title = "Arm"
gravity = [0, -9.81]
[frame.points]
O = [0, 0]
[links.OA]
length = 0.5
mass = 3
shape = "rod"
[links.AB]
length = 0.8
mass = 2
shape = "rod"
[[drives]]
link = "OA"
start = 0.2
law = "0.9*sin(t)"
[[drives]]
link = "AB"
relative_to = "OA"
law = "0.4*sin(3*t)"
[study]
to = 6
"""


def test_the_press(centrode: Centrode, folder: Path) -> None:
    done = centrode("reduce", "six-bar-press", "--samples", 37, "--out", "result", "--no-figures")
    assert done.code == 0, done
    assert done.err == ""
    assert done.rows["links with mass"] == "AB, CD, DH, slider"
    assert done.rows["massless links"] == "OA"
    assert done.rows["loads"] == "force H, weight AB, weight CD, weight DH, weight slider"
    assert done.rows["speed of the drive"] == "-6.80678 rad/s, the mean speed of the machine"
    assert done.rows["jumps and kinks of the loads at"] == "-138.177219 deg; 25.2708308 deg"
    assert sorted(path.name for path in (folder / "result").iterdir()) == [
        "loads.csv",
        "reduction.csv",
        "reduction.nc",
    ]
    with (folder / "result" / "reduction.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    expected = ct.reduce(ct.example("six-bar-press"), samples=37)
    assert [
        float(row["reduced_inertia [kg m^2]"]) for row in rows
    ] == expected.reduced_inertia.values.tolist()
    slider = expected.reduced_inertia_slope_part.sel(link="slider").values.tolist()
    assert [float(row["reduced_inertia_slope_part_slider [kg m^2/rad]"]) for row in rows] == slider
    moment = expected.reduced_moment_part.sel(load="force H").values.tolist()
    assert [float(row["reduced_moment_part_force H [N m]"]) for row in rows] == moment
    degrees = [math.degrees(q) for q in expected.drive_value.values[:, 0]]
    assert [float(row["drive_OA [deg]"]) for row in rows] == pytest.approx(degrees, rel=1e-15)
    with xr.open_dataset(folder / "result" / "reduction.nc", engine="scipy") as read:
        assert read.jumps.values.tolist() == expected.jumps.values.tolist()


def test_nothing_is_written_unless_asked(centrode: Centrode, folder: Path) -> None:
    done = centrode("reduce", "six-bar-press", "--samples", 7)
    assert done.code == 0
    assert list(folder.iterdir()) == []
    table = [line.split() for line in done.out.splitlines() if line.startswith(("reduced", "  "))]
    assert len(table) == 1 + 2 + 4 + 5


def test_several_drives(centrode: Centrode, folder: Path) -> None:
    (folder / "arm.toml").write_text(ARM)
    done = centrode("reduce", "arm.toml", "--samples", 5, "--out", "result")
    assert done.code == 0, done
    assert "inertia coefficient OA, AB" in done.out
    assert "force by AB" in done.out
    assert sorted(path.name for path in (folder / "result").glob("*.png")) == [
        "generalised-forces.png",
        "inertia-matrix.png",
    ]
    with (folder / "result" / "reduction.csv").open(encoding="utf-8", newline="") as file:
        row = next(csv.DictReader(file))
    assert float(row["inertia_matrix_AB_AB [kg m^2]"]) == pytest.approx(2 * 0.64 / 3)


def test_the_mean_of_a_drive_that_turns_back_is_over_time(centrode: Centrode, folder: Path) -> None:
    one, _rest, after = ARM.partition('[[drives]]\nlink = "AB"')
    text = one.replace('[links.AB]\nlength = 0.8\nmass = 2\nshape = "rod"\n', "")
    text += '[[loads]]\nkind = "torque"\nlink = "OA"\nvalue = 4\n' + after[after.index("[study]") :]
    (folder / "swing.toml").write_text(text)
    done = centrode("reduce", "swing.toml", "--samples", 50)
    assert done.code == 0, done
    row = next(line for line in done.out.splitlines() if "torque OA" in line and "N·m" in line)
    assert row.split()[-3:] == ["4", "4", "4"]


def test_what_locks_ends_with_3(centrode: Centrode, folder: Path) -> None:
    text = example_text("slider-between-cranks-locked")
    (folder / "locked.toml").write_text(text.replace("[links.AC]", "[links.AC]\nmass = 1\nshape = 'rod'"))
    done = centrode("reduce", "locked.toml", "--out", "result", "--no-figures")
    assert done.code == 3
    assert "not reached" in done.err
    assert (folder / "result" / "reduction.csv").is_file()


@pytest.mark.parametrize(
    ("change", "arguments", "reason"),
    [
        (("mass = 3\n", "mass = -3\n"), (), "mass must not be negative"),
        (('mass = 3\nshape = "rod"', "mass = 3"), (), "no moment of inertia"),
        (('mass = 3\nshape = "rod"', 'mass = "3 m"'), (), "mass"),
        (("mass", "maas"), (), "unknown key"),
        (("", ""), ("--samples", "0"), "samples"),
        (("", ""), ("--from", "3 kg"), "--from"),
        (
            ("[study]", '[[loads]]\nkind = "force"\npoint = "Z"\nvector = [1, 0]\n[study]'),
            (),
            "unknown point",
        ),
        (("[study]", '[[loads]]\nkind = "torque"\nlink = "OA"\nvalue = "w"\n[study]'), (), "unknown name"),
        (
            (
                "[study]",
                '[[loads]]\nkind = "friction"\npoint = "O"\nradius = 0.1\ncoefficient = 0.1\n[study]',
            ),
            (),
            "Coulomb friction needs the reactions",
        ),
    ],
)
def test_wrong_input_ends_with_2(
    centrode: Centrode, folder: Path, change: tuple[str, str], arguments: tuple[str, ...], reason: str
) -> None:
    (folder / "arm.toml").write_text(ARM.replace(*change) if change[0] else ARM)
    done = centrode("reduce", "arm.toml", "--out", "result", *arguments)
    assert done.code == 2, done
    assert reason in done.err
    assert "Traceback" not in done.err
    assert not (folder / "result").exists()


def test_nothing_to_reduce(centrode: Centrode) -> None:
    done = centrode("reduce", "kite")
    assert done.code == 2
    assert "neither masses nor loads" in done.err


def test_a_run_without_a_machine_says_where_loads_are(centrode: Centrode, tmp_path: Path) -> None:
    press = ct.example("six-bar-press").model_copy(update={"machine": None})
    file = tmp_path / "press.toml"
    file.write_text(ct.mechanism_text(press), encoding="utf-8")
    done = centrode("run", file, "--samples", 5, "--no-figures")
    assert done.code == 0
    assert "centrode reduce" in done.out


@pytest.mark.drawn
def test_the_sphere(centrode: Centrode, folder: Path) -> None:
    """The thesis's crank-rocker: parts by link and load, tables and figures."""
    done = centrode("reduce", "spherical-crank-rocker-rigid", "--out", "result", "--samples", "37")
    assert done.code == 0, done
    assert done.rows["links with mass"] == "AB, BC, DC"
    assert "friction B" in done.out
    assert (folder / "result" / "reduction.csv").read_text().splitlines()[0].count("friction") == 4
    assert (folder / "result" / "reduced-inertia.png").is_file()


def test_a_tensor_of_no_body_ends_with_2(centrode: Centrode, folder: Path) -> None:
    text = example_text("spherical-crank-rocker-rigid").replace(
        'shape = "arc"', "inertia = [1, 1, 3]\ncentre = 'C'"
    )
    (folder / "s.toml").write_text(text)
    for command in ("check", "reduce", "run"):
        done = centrode(command, "s.toml")
        assert done.code == 2
        assert "no body has the principal moments 1, 1, 3" in done.err
