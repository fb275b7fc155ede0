"""`centrode cam` and `centrode run`: forces on cam and follower, linkages that a cam drives; what is refused."""

from __future__ import annotations

import csv
import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import xarray as xr
from PIL import Image

from centrode.animation import cams as animated_cams

Centrode = Callable[..., Any]


def test_the_valve_cam_from_the_description_to_the_files(centrode: Centrode, folder: Path) -> None:
    done = centrode("cam", "valve-cam", "--out", "valve", "--samples", "73", "--no-figures")
    assert done.code == 0
    assert done.rows["separation of the follower"] == "from 2870.77 rpm on at 58.0801 deg"
    assert done.rows["contact of cam and follower"].startswith("kept: at least 180 N")
    names = {path.name for path in (folder / "valve").iterdir()}
    assert {"cam-forces.csv", "cam-forces.nc"} <= names
    with (folder / "valve" / "cam-forces.csv").open(encoding="utf-8", newline="") as file:
        table = list(csv.DictReader(file))
    held = xr.load_dataset(folder / "valve" / "cam-forces.nc")
    assert len(table) == held.sizes["sample"] == 73
    for row, angle, force in zip(table, held["cam_angle"], held["contact_force"], strict=True):
        assert math.isclose(
            math.radians(float(row["cam_angle [deg]"])), float(angle), rel_tol=1e-15, abs_tol=0
        )
        assert float(row["contact_force [N]"]) == float(force)
    numbers = json.loads((folder / "valve" / "summary.json").read_text(encoding="utf-8"))
    assert numbers["cam_jump_speed"]["value"] == held.attrs["jump_speed"]
    # 180 N and 25 N/mm over 8 mm: what holds the tappet at the top of its lift.
    assert abs(numbers["cam_greatest_force"]["value"] - 380.0) < 1e-9


FAST = """\
kind = "cam"
[cam]
base_radius = "40 mm"
speed = "900 rpm"
[follower]
contact = "roller"
roller_radius = "10 mm"
mass = "0.5 kg"
spring = { stiffness = "2 N/mm", preload = "20 N" }
[[segments]]
angle = "120 deg"
to = "15 mm"
curve = "harmonic"
[[segments]]
angle = "240 deg"
to = 0
curve = "harmonic"
"""


def test_a_follower_that_jumps_ends_with_three(centrode: Centrode, folder: Path) -> None:
    (folder / "fast.toml").write_text(FAST)
    done = centrode("cam", "fast.toml", "--out", "fast", "--no-figures")
    assert done.code == 3
    assert "the follower leaves the cam at 2.0944 rad (120 deg)" in done.err
    # The closed form of the quicker stroke: 2 (F0 + k h) beta^2 / (m h pi^2).
    limit = math.sqrt(2 * (20.0 + 2e3 * 0.015) * math.radians(120) ** 2 / (0.5 * 0.015 * math.pi**2))
    assert f"slower than {limit * 30 / math.pi:.6g} rpm" in done.err
    assert (folder / "fast" / "cam-forces.csv").exists()
    (folder / "slow.toml").write_text(FAST.replace("900", f"{limit * 30 / math.pi * 0.999:.9g}"))
    assert centrode("cam", "slow.toml").code == 0


def test_a_step_of_the_slope_loses_the_contact_at_every_speed(centrode: Centrode, folder: Path) -> None:
    (folder / "step.toml").write_text(FAST.replace("harmonic", "uniform").replace('"roller"', '"knife"').replace(
        'roller_radius = "10 mm"\n', ""
    ))  # fmt: skip
    done = centrode("cam", "step.toml")
    assert done.code == 3
    assert done.rows["separation of the follower"] == "at every speed"
    assert done.rows["spring needed"] == "none keeps the contact"


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('mass = "0.5 kg"', 'mass = "0.5 m"', "expected a mass"),
        ('stiffness = "2 N/mm"', 'stiffness = "2 N"', "expected a stiffness"),
        ('stiffness = "2 N/mm"', 'stiffness = "-2 N/mm"', "must not be negative"),
        ('preload = "20 N"', "load = 1", 'unknown key "load"'),
        ('speed = "900 rpm"', 'speed = "900 Hz"', "does not distinguish turns from radians"),
        ('base_radius = "40 mm"', 'base_radius = "-40 mm"', "must be positive"),
        ('mass = "0.5 kg"', "friction = -1", "must not be negative"),
        ('mass = "0.5 kg"', 'offset = "60 mm"', "misses the base circle"),
        ('mass = "0.5 kg"', "inertia = 1", "is used with an oscillating follower only"),
    ],
)
def test_wrong_cams_are_refused(centrode: Centrode, folder: Path, old: str, new: str, message: str) -> None:
    (folder / "wrong.toml").write_text(FAST.replace(old, new, 1))
    done = centrode("cam", "wrong.toml")
    assert done.code == 2
    assert message in done.err


def test_the_linkage_and_its_cam_move_together(centrode: Centrode, folder: Path) -> None:
    asked = ("--out", "feed", "--samples", "9", "--animate", "--no-figures")
    done = centrode("run", "cam-driven-linkage", *asked)
    assert done.code == 0
    assert done.rows["range"] == "0 s to 0.4 s, lever between -24 deg and 0 deg"
    with Image.open(folder / "feed" / "motion.gif") as animation:
        assert animation.n_frames == 8  # the last sample is the first again
    told = centrode("describe", "cam-driven-linkage").out
    assert 'Link "lever" is driven by a cam, which turns at a constant 900 deg/s.' in " ".join(told.split())


def test_a_cam_turns_under_its_follower(
    centrode: Centrode, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert animated_cams.FRAMES_OF_A_TURN == 60
    monkeypatch.setattr(animated_cams, "FRAMES_OF_A_TURN", 6)
    asked = ("--out", "turn", "--samples", "9", "--animate", "--no-figures", "--dark")
    assert centrode("cam", "indexing-cam", *asked).code == 0
    with Image.open(folder / "turn" / "cam.gif") as animation:
        assert animation.n_frames == 6


def test_an_animation_needs_a_size_and_a_folder(centrode: Centrode, folder: Path) -> None:
    (folder / "open.toml").write_text(FAST.replace('base_radius = "40 mm"\n', ""))
    done = centrode("cam", "open.toml", "--out", "open", "--animate")
    assert done.code == 2
    assert "a profile needs the cam's base radius" in done.err
    assert not (folder / "open").exists()
    done = centrode("cam", "valve-cam", "--animate")
    assert done.code == 2
    assert "no output folder is given" in done.err


def test_a_linkage_with_a_cam_that_undercuts_tells_it(centrode: Centrode, folder: Path) -> None:
    flat = FAST.replace('"roller"', '"flat"').replace('roller_radius = "10 mm"\n', "")
    (folder / "fast.toml").write_text(flat.replace('"40 mm"', '"1 mm"'))
    (folder / "linkage.toml").write_text(
        "[frame.points]\nO = [0, 0]\n[links]\nAB = { length = 0.05 }\nOB = { length = 0.06 }\n"
        '[[guides]]\npoint = "A"\non = "frame"\nthrough = [0.07, 0]\ndirection = [0, 1]\n'
        '[[drives]]\nguide = "A"\ncam = "fast.toml"\n[assembly]\nsides = { B = "left" }\n'
    )
    done = centrode("run", "linkage.toml", "--out", "out")
    assert done.code == 2
    assert "[[drives]]" in done.err and "undercuts the profile" in done.err
    assert centrode("run", "linkage.toml", "--out", "bare", "--no-figures").code == 0
