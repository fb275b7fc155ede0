"""`centrode simulate` and `animate --simulation` of mechanisms with any number of degrees of freedom."""

from __future__ import annotations

import csv
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from PIL import Image

import centrode as ct
from free_motions import DOUBLE_PENDULUM, DOUBLE_ROCKER, FIVE_BAR, table

Centrode = Callable[..., Any]
MASSLESS_END = DOUBLE_PENDULUM.replace(
    'mass = 1\nshape = "rod"\nangle = 0.0\n[simulation]', "angle = 0.0\n[simulation]"
)


@pytest.fixture
def files(folder: Path) -> Path:
    """Descriptions in the folder of the command."""
    for name, text in (("pendulum", DOUBLE_PENDULUM), ("five-bar", FIVE_BAR), ("rocker", DOUBLE_ROCKER)):
        (folder / f"{name}.toml").write_text(text, encoding="utf-8")
    return folder


def test_tables_hold_what_is_computed(centrode: Centrode, files: Path) -> None:
    done = centrode("simulate", "five-bar.toml", "--samples", 11, "--out", "free", "--no-figures")
    assert done.code == 0, done
    assert done.rows["degrees of freedom"] == "2"
    assert done.rows["ended"] == "after 5 s"
    assert sorted(path.name for path in (files / "free").iterdir()) == ["simulation.csv", "simulation.nc"]
    mechanism = ct.read_mechanism(files / "five-bar.toml")
    assert mechanism.simulation is not None
    expected = ct.simulate(mechanism, mechanism.simulation.model_copy(update={"samples": 11}))
    with (files / "free" / "simulation.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    for head, values in {
        "time [s]": expected.time,
        "drive_AB [rad]": expected.drive_value.sel(drive="AB"),
        "generalised_velocity_AB [rad/s]": expected.generalised_velocity.sel(coordinate="AB"),
        "position_C_y [m]": expected.position.sel(point="C", axis="y"),
        "angular_velocity_DC [rad/s]": expected.angular_velocity.sel(link="DC"),
        "work_part_spring C-F [J]": expected.work_part.sel(source="spring C-F"),
        "kinetic_energy [J]": expected.kinetic_energy,
    }.items():
        assert [float(row[head]) for row in rows] == values.values.tolist(), head
    with xr.open_dataset(files / "free" / "simulation.nc", engine="scipy") as read:
        assert read.angle.values.tolist() == expected.angle.values.tolist()
        assert read.attrs["equations"] == "multibody"


def test_everything_on_the_command_line(centrode: Centrode, files: Path) -> None:
    done = centrode(
        "simulate", "five-bar.toml", "--duration", "2 s", "--tolerance", 1e-11, "--at", "1 s", "--at", "2 s",
        "--speed-of", "drives.AB=0 rad/s", "--out", "at", "--no-figures",
    )  # fmt: skip
    assert done.code == 0, done
    with (files / "at" / "simulation.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    known = table("five-bar")
    assert [float(row["time [s]"]) for row in rows] == [1.0, 2.0]
    for row, k in zip(rows, (2, 4), strict=True):
        assert abs(float(row["angle_AB [rad]"]) - known["AB"][k]) < 1e-8


def test_a_limit_is_a_place(centrode: Centrode, files: Path) -> None:
    (files / "driven.toml").write_text(
        DOUBLE_ROCKER.replace("start = 1.2", "start = 1.2\nspeed = 1"), encoding="utf-8"
    )
    done = centrode("simulate", "driven.toml")
    assert done.code == 3
    assert "--equations multibody" in done.err
    done = centrode("simulate", "driven.toml", "--equations", "multibody")
    assert done.code == 0, done
    assert done.rows["ended"] == "after 5 s"
    assert "differs by at most" in done.rows["reduced equation"]


@pytest.mark.parametrize(
    ("text", "arguments", "said"),
    [
        (DOUBLE_PENDULUM, ["--speed-of", "links.OA=1", "--speed-of", "points.A=0,2"], "contradicts"),
        (DOUBLE_PENDULUM, ["--speed-of", "links.XX=1"], 'unknown link "XX"'),
        (DOUBLE_PENDULUM, ["--speed-of", "points.A=1"], "expected [x, y]"),
        (DOUBLE_PENDULUM, ["--speed", "1"], "speed is that of the first drive, and there is none"),
        (
            DOUBLE_PENDULUM,
            ["--driving", "1"],
            "the coordinate along which the driving moment acts is not given",
        ),
        (DOUBLE_PENDULUM, ["--keep", "OA"], 'there is no drive "OA"'),
        (DOUBLE_PENDULUM, ["--duration", "0 s"], "duration must be positive"),
        (DOUBLE_PENDULUM, ["--turns", "2"], "turns end a simulation by the reduced equation alone"),
        (DOUBLE_PENDULUM, ["--scheme", "runge-kutta-4"], "fixed steps are those of the reduced equation"),
        (DOUBLE_PENDULUM, ["--at", "9 s"], "lies behind the end of the simulation"),
        (DOUBLE_PENDULUM, ["--equations", "reduced"], "a simulation needs one drive"),
        (DOUBLE_PENDULUM.replace("angle = 0.0", ""), [], "its initial angle is not given"),
        (MASSLESS_END, [], "moves"),
        (FIVE_BAR.replace("length = 0.5", "length = 5"), [], "it does not close"),
        (FIVE_BAR, ["--keep", "AB"], 'drive "AB" has no law that it could keep'),
        (
            DOUBLE_PENDULUM
            + '[[loads]]\nkind = "friction"\nlink = "OA"\nquadratic = 1\nform = "plain sum"\n',
            [],
            "a plain sum of friction",
        ),
    ],
)
def test_wrong_input_is_refused_by_name(
    centrode: Centrode, folder: Path, text: str, arguments: list[str], said: str
) -> None:
    (folder / "bad.toml").write_text(text, encoding="utf-8")
    done = centrode("simulate", "bad.toml", *arguments)
    assert done.code == 2, done
    assert said in done.err
    assert done.out == ""


def test_a_load_that_grows_without_bound_ends_the_run(centrode: Centrode, folder: Path) -> None:
    torque = '[[loads]]\nkind = "torque"\nlink = "OA"\nvalue = "1/(0.5 - t)^2"\n'
    (folder / "pole.toml").write_text(DOUBLE_PENDULUM + torque, encoding="utf-8")
    done = centrode("simulate", "pole.toml", "--out", "kept", "--no-figures")
    assert done.code == 3, done
    assert "0.5 s" in done.err
    assert "Traceback" not in done.err
    # what was computed up to there is kept
    with (folder / "kept" / "simulation.csv").open(encoding="utf-8", newline="") as file:
        times = [float(row["time [s]"]) for row in csv.DictReader(file)]
    assert 0.4 < times[-1] < 0.5


def test_kinematics_refuses_what_nothing_drives(centrode: Centrode, files: Path) -> None:
    for command in ("run", "check", "limits"):
        done = centrode(command, "five-bar.toml")
        assert done.code == 2
        assert "[[drives]] AB: it has no law of motion" in done.err
        assert "centrode simulate" in done.err


def test_an_animation_goes_once(centrode: Centrode, files: Path) -> None:
    done = centrode(
        "animate", "pendulum.toml", "--simulation", "--frames", 6, "--size", "160x120", "--out", "free.gif"
    )
    assert done.code == 0, done
    assert done.rows["loop"] == "once, then anew"
    with Image.open(files / "free.gif") as image:
        assert image.n_frames == 6
    done = centrode("animate", "pendulum.toml", "--simulation", "--show", "forces", "--out", "no.gif")
    assert done.code == 2
    assert "cannot be shown of a simulation" in done.err
    done = centrode("animate", "pendulum.toml", "--simulation", "--from", "1", "--out", "no.gif")
    assert done.code == 2
    assert not (files / "no.gif").exists()


def test_frames_stand_where_the_motion_is(files: Path) -> None:
    made = ct.animate(
        ct.read_mechanism(files / "pendulum.toml"), files / "own.gif", simulation=True, size=(160, 120)
    )
    # five seconds at their own pace, twenty frames a second
    assert (made.frames, made.loop) == (100, "once")
    assert np.isclose(made.seconds, 5.0)
