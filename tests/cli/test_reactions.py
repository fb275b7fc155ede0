"""`centrode reactions`: what it prints and writes, how it ends; reactions as part of a run."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

import centrode as ct
from centrode.dynamics.bearings.joint_table import JointKind, tabled_joints
from centrode.dynamics.bearings.results import reaction_results
from centrode.model.examples import example_text
from centrode.render.spelling import PlainSpelling
from centrode.sheets.sheet import Table
from centrode.topics.presentation import sheet_of

Centrode = Callable[..., Any]

PUSHED = """\
title = "Pushed"
[frame.points]
O = [0, 0]
[links.OA]
length = 0.1
[links.AB]
length = 0.4
[links.piston]
points = ["B"]
mass = 2
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
guide = "B"
value = "-2 kN"
[assembly]
sides = { B = "ahead" }
"""


def rows_of(path: Path) -> list[dict[str, str]]:
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def extremes_of(mechanism: ct.Mechanism, samples: int) -> dict[str, list[str]]:
    """The printed table of extremes: name -> unit, least, at, greatest, at."""
    table = sheet_of(reaction_results(mechanism, samples, complete=False)).printed[1]
    assert isinstance(table, Table)
    spelling = PlainSpelling(mechanism.display)
    cells = [[spelling.text(text) for text in column.values] for column in table.columns]
    return {name: list(row) for name, *row in zip(*cells, strict=True)}


def test_the_press(centrode: Centrode, folder: Path) -> None:
    done = centrode("reactions", "six-bar-press", "--samples", 37, "--out", "result", "--no-figures")
    assert (done.code, done.err) == (0, "")
    assert done.rows["massless links"] == "OA"
    assert done.rows["speed of the drive"] == "-6.80678 rad/s, the mean speed of the machine"
    assert done.rows["samples"] == "37: ok 37"
    assert "not determined" not in done.rows
    assert sorted(path.name for path in (folder / "result").iterdir()) == [
        "bearing-loads.csv",
        "bearings.nc",
        "joints.csv",
        "reactions.csv",
        "reactions.nc",
    ]
    expected = ct.reactions(ct.example("six-bar-press"), samples=37)
    rows = rows_of(folder / "result" / "reactions.csv")
    for column, values in (
        ("balancing_OA [N m]", expected.balancing.sel(drive="OA")),
        ("joint_force_A/AB_x [N]", expected.joint_force.sel(side="A/AB", axis="x")),
        ("guide_normal_H [N]", expected.guide_normal.sel(guide="H")),
        ("shaking_moment [N m]", expected.shaking_moment),
    ):
        assert [float(row[column]) for row in rows] == values.values.tolist()
    assert {row["status"] for row in rows} == {"ok"}
    degrees = [math.degrees(q) for q in expected.drive_value.values[:, 0]]
    assert [float(row["drive_OA [deg]"]) for row in rows] == pytest.approx(degrees, rel=1e-15)
    with xr.open_dataset(folder / "result" / "reactions.nc", engine="scipy") as read:
        assert read.joint_force.values.tolist() == expected.joint_force.values.tolist()


def test_the_table_of_joints_of_the_source(centrode: Centrode, folder: Path) -> None:
    """The coursework's own table, with its two slips put right: link 3 at B and the frame at C."""
    source = {
        "1 OA": "1 1 0 0 0 0 0",
        "2 AB": "0 -1 1 0 0 0 0",
        "3 CD": "0 0 -1 1 1 0 0",
        "4 DH": "0 0 0 0 -1 1 0",
        "5 slider": "0 0 0 0 0 -1 1",
        "0 frame": "-1 0 0 -1 0 0 -1",
    }
    done = centrode("reactions", "six-bar-press", "--samples", 2, "--out", "result", "--no-figures")
    with (folder / "result" / "joints.csv").open(encoding="utf-8", newline="") as file:
        header, *rows = list(csv.reader(file))
    assert header == ["link", "O", "A", "B", "C", "D", "H", "guide H"]
    assert {row[0]: " ".join(row[1:]) for row in rows} == source
    assert {label: " ".join(text.split()) for label, text in done.rows.items() if label in source} == source


def test_hinges_of_several_links_and_wheels_have_columns_of_their_own() -> None:
    train = ct.example("planetary-gear-train")
    joints = tabled_joints(train)
    assert [one for one in joints if one.kind is JointKind.GEAR]
    bodies = [*train.links, "frame"]
    for joint in joints:
        signs = sorted(joint.sign(body) for body in bodies)
        assert signs == [-1, *[0] * (len(bodies) - 2), 1]
    slider = tabled_joints(ct.example("slider-between-cranks"))
    assert [one.name for one in slider] == ["O", "A", "C", "B", "D", "C"]
    assert slider[-1].kind is JointKind.GUIDE


def test_instants(centrode: Centrode, folder: Path) -> None:
    done = centrode("reactions", "six-bar-press", "--at", "120 deg", "--at", "2 rad", "--out", "at")
    assert (done.code, done.err) == (0, "")
    assert sorted(path.name for path in (folder / "at").iterdir()) == [
        "joints.csv",
        "reactions.csv",
        "reactions.nc",
    ]
    assert "\nat 120 deg\n" in done.out
    assert "\nat 114.591559 deg\n" in done.out  # in the unit of the display, whatever was typed
    found = ct.reactions(ct.example("six-bar-press"), at=[math.radians(120)])
    force = found.joint_force.sel(side="A/OA").values[0]
    row = next(line for line in done.out.splitlines() if line.startswith("A: AB on OA"))
    x, y, size, direction = (float(cell) for cell in row.split()[-4:])
    assert (x, y) == (float(f"{force[0]:.6g}"), float(f"{force[1]:.6g}"))
    assert size == float(f"{math.hypot(*force):.6g}")
    assert direction == pytest.approx(math.degrees(math.atan2(force[1], force[0])), abs=0.0051)


def test_a_dead_point_is_told_in_words(centrode: Centrode, folder: Path) -> None:
    text = example_text("parallelogram") + '\n[[loads]]\nkind = "force"\npoint = "B"\nvector = [1, 2]\n'
    (folder / "p.toml").write_text(text)
    done = centrode("reactions", "p.toml", "--at", "0 deg")
    assert (done.code, done.err) == (0, "")
    assert done.rows["samples"] == "1: singular 1"
    assert "nan" not in done.out
    line = next(line for line in done.out.splitlines() if line.startswith("drive"))
    assert line
    assert [line for line in done.out.splitlines() if "N·m" in line and "singular" in line]
    done = centrode("reactions", "p.toml", "--samples", 9)
    assert done.code == 0
    assert "nan" not in done.out


@pytest.mark.drawn
def test_what_is_not_determined_is_named(centrode: Centrode, folder: Path) -> None:
    text = example_text("rolling-wheel-rod") + '\n[[loads]]\nkind = "torque"\nlink = "wheel"\nvalue = 3\n'
    (folder / "w.toml").write_text(text)
    done = centrode("reactions", "w.toml", "--samples", 5, "--out", "result")
    assert done.code == 0, done
    assert sorted(path.name for path in (folder / "result").glob("*.png")) == [
        "balancing.png",
        "bearing-loads.png",
        "bearing-wear.png",
        "bush-loads.png",
        "frame-force.png",
        "joint-forces.png",
        "journal-loads.png",
        "other-reactions.png",
    ]
    assert done.rows["not determined"] == "C/wheel; guide C; wheel wheel"
    assert "nan" not in done.out
    assert {row["rolling_normal_wheel [N]"] for row in rows_of(folder / "result" / "reactions.csv")} == {""}


def test_what_is_rounding_is_shown_as_zero(centrode: Centrode, folder: Path) -> None:
    """A torque between a rocker and the frame, and the drive's moment: nothing is left for the frame as a whole."""
    text = example_text("crank-rocker") + '\n[[loads]]\nkind = "torque"\nlink = "DB"\nvalue = 3\n'
    (folder / "w.toml").write_text(text)
    mechanism = ct.read_mechanism(folder / "w.toml")
    found = ct.reactions(mechanism, samples=361)
    assert found.frame_moment.to_numpy().any()  # but for rounding
    rows = extremes_of(mechanism, 361)
    assert rows["moment on the frame"] == ["N·m", "0", "", "0", ""]
    done = centrode("reactions", "w.toml", "--at", "100 deg", "--at", "200 deg")
    assert done.code == 0, done
    assert "e-1" not in done.out.split("\nreaction ", 1)[1]


def test_of_values_alike_the_first_is_named() -> None:
    """The last sample of a turn repeats the first, and one of them is the greater by rounding."""
    press = ct.example("six-bar-press")
    found = ct.reactions(press, samples=5)
    size = np.hypot(*found.frame_force.to_numpy().T)
    assert np.isclose(size[0], size[-1], rtol=1e-12) and np.max(size) == max(size[0], size[-1])
    assert extremes_of(press, 5)["force on the frame"][4] == "219.1 deg"


def test_extremes_of_a_drive_by_a_law_are_told_by_their_time(centrode: Centrode, folder: Path) -> None:
    """A drive that turns back passes its values more than once; --at takes a time too."""
    text = example_text("in-line-four-bar").replace('speed = "500 rpm"', 'law = "sin(2*t)"')
    (folder / "l.toml").write_text(text + "\n[study]\nto = 3\n")
    done = centrode("reactions", "l.toml", "--samples", 31)
    assert done.code == 0, done
    line = next(line for line in done.out.splitlines() if line.startswith("A: "))
    match = re.search(r"(\S+) +(\S+) s$", line)
    assert match
    greatest, time = match.groups()
    there = centrode("reactions", "l.toml", "--at", f"{time} s").out
    row = next(line for line in there.splitlines() if line.startswith("A: "))
    assert math.isclose(float(row.split()[-2]), float(greatest), rel_tol=1e-5)


def test_the_real_speed_of_a_machine(centrode: Centrode) -> None:
    done = centrode("reactions", "six-bar-press", "--motion", "real", "--samples", 13)
    assert done.code == 0, done
    assert done.rows["speed of the drive"].endswith("the real speed of the machine")
    done = centrode("reactions", "six-bar-press", "--motion", "real", "--from", "0 deg")
    assert done.code == 2
    assert "whole cycle" in done.err


def test_several_drives_have_a_row_each(centrode: Centrode, folder: Path) -> None:
    text = example_text("two-link-arm").replace("[links.OA]", "[links.OA]\nmass = 2\nshape = 'rod'")
    (folder / "arm.toml").write_text(text)
    done = centrode("reactions", "arm.toml", "--samples", 5)
    assert done.code == 0, done
    assert sum(line.startswith("balancing moment of drive ") for line in done.out.splitlines()) == 2
    assert "speed of the drive" not in done.rows


@pytest.mark.parametrize(
    ("change", "arguments", "reason"),
    [
        (("mass = 2\n", "mass = -2\n"), (), "mass must not be negative"),
        (("length = 0.4", "length = 0.4\nmass = 1"), (), "no moment of inertia"),
        (('value = "-2 kN"', 'value = "-2 m"'), (), "value"),
        (
            ('kind = "force"\nguide = "B"', 'kind = "friction"\nguide = "B"'),
            (),
            "value must not be negative",
        ),
        (("", ""), ("--samples", "0"), "samples"),
        (("", ""), ("--samples", "999999"), "give at most"),
        (("", ""), ("--at", "3 m"), "--at"),
        (("", ""), ("--at", "x"), "--at"),
        (("", ""), ("--at", "1 rad", "--samples", "5"), "remove one of the two"),
        (("", ""), ("--at", "1 rad") * 101, "101 instants"),
        (("", ""), ("--from", "nan"), "--from"),
        (("", ""), ("--motion", "real"), "[machine]"),
    ],
)
def test_wrong_input_ends_with_2(
    centrode: Centrode, folder: Path, change: tuple[str, str], arguments: tuple[str, ...], reason: str
) -> None:
    (folder / "m.toml").write_text(PUSHED.replace(*change) if change[0] else PUSHED)
    done = centrode("reactions", "m.toml", *arguments, "--out", "result")
    assert done.code == 2, done
    assert reason in done.err
    assert "Traceback" not in done.err
    assert not (folder / "result").exists()


def test_a_mechanism_without_masses_and_loads_is_refused(centrode: Centrode) -> None:
    done = centrode("reactions", "crank-rocker")
    assert done.code == 2
    assert "neither masses nor loads" in done.err
    assert "give links a mass" in done.err


def test_a_run_writes_reactions(centrode: Centrode, folder: Path) -> None:
    (folder / "m.toml").write_text(PUSHED)
    done = centrode("run", "m.toml", "--out", "r", "--samples", 5, "--no-figures")
    assert (done.code, done.err) == (0, "")
    assert done.rows["greatest joint force"].startswith("O/OA: 2148.04 N at")
    written = folder / "r" / "reactions"
    assert {"joints.csv", "reactions.csv", "reactions.nc"} <= {path.name for path in written.iterdir()}
    assert len(rows_of(written / "reactions.csv")) == 5


def test_a_run_says_why_reactions_are_left_out(centrode: Centrode, folder: Path) -> None:
    """Masses that are not complete do not hinder the motion."""
    (folder / "m.toml").write_text(PUSHED.replace("length = 0.4", "length = 0.4\nmass = 1"))
    done = centrode("run", "m.toml", "--out", "r", "--samples", 5, "--no-figures")
    assert (done.code, done.err) == (0, "")
    assert "note: reactions are omitted: [links.AB]: it has a mass and turns" in done.out
    assert not (folder / "r" / "reactions").exists()
    done = centrode("run", "crank-rocker", "--out", "s", "--samples", 5, "--no-figures")
    assert "reactions" not in done.out
    assert not (folder / "s" / "reactions").exists()


def test_friction_that_no_joint_bears_is_refused(centrode: Centrode, folder: Path) -> None:
    example = example_text("crank-rocker") + '\n[[loads]]\nkind = "friction"\nlink = "DB"\n'
    link = list(ct.example("crank-rocker").links)[-1]
    for keys, message in (
        ("coefficient = 0.1", "Coulomb friction in a hinge needs the point"),
        ('quadratic = 0.1\nform = "plain sum"', "a plain sum is not a moment in a hinge"),
    ):
        (folder / "r.toml").write_text(example.replace('"DB"', f'"{link}"') + keys + "\n")
        done = centrode("reactions", "r.toml")
        assert done.code == 2
        assert message in done.err


def test_instants_beyond_a_lock_name_the_limits(centrode: Centrode, folder: Path) -> None:
    text = example_text("slider-between-cranks-locked")
    (folder / "m.toml").write_text(text.replace("[links.AC]", "[links.AC]\nmass = 1\nshape = 'rod'"))
    done = centrode("reactions", "m.toml", "--at", "1 rad", "--at", "150 deg")
    assert done.code == 3
    assert done.err == (
        "Error: m.toml: the mechanism locks: 1 of 2 samples is not reached"
        " (limit at -0.808314721 rad (-46.313 deg), group CB-BD (point B) in a dead position;"
        " limit at 1.79991242 rad (103.127 deg), group CB-BD (point B) in a dead position);"
        " choose positions between the limits\n"
    )
