"""`centrode cam` for a cam by its follower's lift: what is printed, written and refused."""

from __future__ import annotations

import csv
import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import xarray as xr

import centrode as ct

Centrode = Callable[..., Any]
CAM = """\
kind = "cam"
title = "Valve cam"
display = { length = "mm", angle = "deg" }
[cam]
base_radius = "40 mm"
speed = "600 rpm"
[follower]
contact = "roller"
roller_radius = "10 mm"
[[segments]]
angle = "90 deg"
to = "25 mm"
curve = "cycloidal"
[[segments]]
angle = "90 deg"
curve = "dwell"
[[segments]]
angle = "90 deg"
to = 0
curve = "polynomial"
at_start = [0, 0]
at_end = [0, 0]
[[segments]]
angle = "90 deg"
curve = "dwell"
[study]
instants = ["45 deg", "225 deg"]
"""
WRITTEN = ["cam-motion.csv", "cam-motion.nc", "summary.json"]


@pytest.fixture
def cam(folder: Path) -> Path:
    (folder / "cam.toml").write_text(CAM)
    return folder


def test_the_motion_is_printed(centrode: Centrode, cam: Path) -> None:
    done = centrode("cam", "cam.toml")
    assert (done.code, done.err) == (0, "")
    assert done.out.startswith("Valve cam\n\nMotion of the follower\n\n")
    said = done.rows
    assert said["follower"] == "translating, with a roller"
    assert said["speed of the cam"] == "600 rpm, a turn takes 0.1 s"
    assert said["lift"] == "0 mm to 25 mm at 90 deg"
    # 2 h/beta and, in time, that times 20 pi: 2 m/s.
    assert said["greatest velocity"] == "31.831 mm/rad, 2000 mm/s at 45 deg"
    assert said["greatest acceleration"] == "63.662 mm/rad², 251327 mm/s² at 22.5 deg"
    assert said["continuous"] == "up to the acceleration; the jerk jumps"
    lines = [line.split() for line in done.out.splitlines()]
    assert ["3", "180", "…", "270", "25", "…", "0", "polynomial", "1.875", "5.7735", "60"] in lines
    assert ["180", "–", "–", "-387.018", "+1478.3"] in lines
    # Half way the acceleration is zero, of which sin(pi) leaves some 1e-14.
    assert next(line for line in lines if line[:1] == ["45"])[:5] == ["45", "12.5", "31.831", "0", "-254.648"]


def test_the_slope_of_an_angle_is_a_plain_number(centrode: Centrode, folder: Path) -> None:
    said = centrode("cam", "indexing-cam").rows
    # 2 times 24 deg over 110 deg.
    assert said["greatest velocity"].startswith("-0.436364, -392.727 deg/s at 235 deg")


def test_laws_are_compared_where_asked(centrode: Centrode, cam: Path) -> None:
    assert "Laws of motion" not in centrode("cam", "cam.toml").out
    done = centrode("cam", "cam.toml", "--laws")
    assert done.code == 0
    lines = [" ".join(line.split()) for line in done.out.splitlines()]
    assert "modified sine 1.7596 5.528 69.466 5.4578 jerk" in lines
    assert "harmonic 1.5708 4.9348 15.503, ∞ there 3.8758 acceleration" in lines
    assert "modified trapezoid 2000 195525 9.82816e+07" in lines
    assert "rise 25 mm over 90 deg: segment 1, cycloidal" in lines


@pytest.mark.drawn
def test_everything_is_written(centrode: Centrode, cam: Path) -> None:
    done = centrode("cam", "cam.toml", "--laws", "--out", "out", "--samples", "5")
    assert (done.code, done.err) == (0, "")
    names = {path.name for path in (cam / "out").iterdir()}
    figures = {f"{name}.{kind}" for name in ("cam-motion", "cam-laws") for kind in ("png", "svg")}
    assert {*WRITTEN, "cam-laws.csv", "cam-laws.nc", *figures} <= names
    with (cam / "out" / "cam-motion.csv").open(encoding="utf-8", newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert [float(row["cam_angle [deg]"]) for row in rows] == [0, 90, 180, 270, 360]
    assert [float(row["lift [mm]"]) for row in rows] == [0, 25, 25, 0, 0]
    assert float(rows[0]["lift_third [mm/rad^3]"]) == pytest.approx(4 * math.pi**2 * 25 / (math.pi / 2) ** 3)
    with xr.open_dataset(cam / "out" / "cam-motion.nc", engine="scipy") as data:
        assert data.attrs["curves"] == "cycloidal, dwell, polynomial, dwell"
        assert ct.parse_cam(data.attrs["cam"]) == ct.read_cam(cam / "cam.toml")
        assert data.joint_after.shape == (4, 5)
    numbers = json.loads((cam / "out" / "summary.json").read_text(encoding="utf-8"))
    assert numbers["follower_first_jump"] == {"value": 3, "unit": "1"}
    assert numbers["follower_greatest_velocity_in_time"] == {"value": pytest.approx(2.0), "unit": "m/s"}


def test_no_figures_are_drawn_where_none_are_wanted(centrode: Centrode, cam: Path) -> None:
    assert centrode("cam", "cam.toml", "--out", "out", "--no-figures").code == 0
    assert not [path.name for path in (cam / "out").iterdir() if path.suffix in (".png", ".gif")]


@pytest.mark.parametrize(
    ("curve", "told"),
    [
        ("uniform", "the lift only; the velocity jumps: rigid impacts"),
        ("harmonic", "up to the velocity; the acceleration jumps: soft impacts, unbounded jerk"),
        ("4-5-6-7", "up to the acceleration; the jerk jumps"),
    ],
)
def test_what_jumps_is_told(centrode: Centrode, cam: Path, curve: str, told: str) -> None:
    # Where the velocity jumps the profile has a corner, which is undercut inside a roller: shown all the same.
    (cam / "cam.toml").write_text(CAM.replace("cycloidal", curve) + "show_undercut = true\n")
    assert centrode("cam", "cam.toml").rows["continuous"] == told


def test_a_smooth_motion_is_called_so_and_one_below_zero_is_told(centrode: Centrode, cam: Path) -> None:
    smooth = CAM.replace("[0, 0]", "[0, 0, 0, 0]").replace("4 5", "")
    smooth = smooth.replace(
        'curve = "cycloidal"', 'curve = "polynomial"\nat_start = [0, 0, 0, 0]\nat_end = [0, 0, 0, 0]'
    )
    (cam / "cam.toml").write_text(smooth)
    assert centrode("cam", "cam.toml").rows["continuous"] == "all derivatives up to the fourth"
    swung = CAM.replace("at_end = [0, 0]", 'at_end = ["20 mm/rad", 0]') + "show_undercut = true\n"
    (cam / "cam.toml").write_text(swung)
    done = centrode("cam", "cam.toml")
    assert "it goes below 0, to its least value at" in done.out


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (("--terms", "30"), "--terms: this cam is given by its follower's lift and has no curvature law"),
        (("--groove",), "--groove: this cam is given by its follower's lift"),
        (("--samples", "1"), "1 sample is given"),
    ],
)
def test_options_that_mean_nothing_are_refused(
    centrode: Centrode, cam: Path, arguments: tuple[str, ...], told: str
) -> None:
    done = centrode("cam", "cam.toml", *arguments)
    assert done.code == 2
    assert told in done.err
    assert "Traceback" not in done.err


def test_laws_are_those_of_a_follower(centrode: Centrode, folder: Path) -> None:
    done = centrode("cam", "cam-from-curvature", "--laws")
    assert done.code == 2
    assert "--laws: this cam is given by a curvature law and has no follower's lift" in done.err


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ('angle = "90 deg"\nto = "25 mm"', 'angle = "60 deg"\nto = "25 mm"', "the segments leave a gap"),
        ('angle = "90 deg"\nto = "25 mm"', 'angle = "95 deg"\nto = "25 mm"', "the segments overlap"),
        ("to = 0", 'to = "2 mm"', "the lift does not return: a turn begins at 0 and ends at 0.002 m"),
        ('to = "25 mm"', 'to = "25 s"', "[[segments]] 1, to: expected a length (m)"),
        ('curve = "cycloidal"', 'curve = "cycloid"', 'did you mean "cycloidal"?'),
    ],
)
def test_wrong_descriptions_are_refused(centrode: Centrode, cam: Path, old: str, new: str, told: str) -> None:
    (cam / "cam.toml").write_text(CAM.replace(old, new, 1))
    done = centrode("cam", "cam.toml")
    assert done.code == 2
    assert told in done.err
    assert "Traceback" not in done.err


def test_other_commands_send_it_here(centrode: Centrode, cam: Path) -> None:
    done = centrode("run", "cam.toml")
    assert done.code == 2
    assert "centrode cam" in done.err
