"""`centrode cam` of a cam with a follower: its profile, the least cam, files and refusals as a user meets them."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

Centrode = Callable[..., Any]

LIFTER = """
title = "Lifter"
kind = "cam"
display = { length = "mm", angle = "deg" }
[cam]
base_radius = "30 mm"
[follower]
contact = "roller"
roller_radius = "10 mm"
offset = "8 mm"
[[segments]]
angle = "100 deg"
to = "25 mm"
curve = "cycloidal"
[[segments]]
angle = "60 deg"
curve = "dwell"
[[segments]]
angle = "80 deg"
to = 0
curve = "3-4-5"
[[segments]]
angle = "120 deg"
curve = "dwell"
"""
BOUNDS = '[bounds]\npressure_angle = "30 deg"\nreturn_pressure_angle = "45 deg"\ncurvature_radius = "4 mm"\n'
TOOL = '[tool]\nradius = "6 mm"\n'
FLAT = (
    ('contact = "roller"', 'contact = "flat"'),
    ('roller_radius = "10 mm"\n', ""),
    ("8 mm", "0 mm"),
    ("25 mm", "6 mm"),
)
SWINGING = (
    ('contact = "roller"', 'kind = "oscillating"\ncontact = "flat"\npivot_distance = "120 mm"'),
    ('roller_radius = "10 mm"\noffset = "8 mm"\n', 'face_offset = "5 mm"\n'),
    ('"30 mm"', '"40 mm"'),
    ("25 mm", "6 deg"),
)
UNDERCUT = (
    ('"100 deg"', '"40 deg"'),
    ('"120 deg"', '"180 deg"'),
    ('"10 mm"', '"16 mm"'),
    ('"30 mm"', '"20 mm"'),
)


@pytest.fixture
def write(folder: Path) -> Callable[..., str]:
    def written(*pairs: tuple[str, str], more: str = "") -> str:
        text = LIFTER
        for old, new in pairs:
            assert old in text, old
            text = text.replace(old, new)
        (folder / "cam.toml").write_text(text + more, encoding="utf-8")
        return "cam.toml"

    return written


@pytest.fixture
def refuses(centrode: Centrode, folder: Path) -> Callable[..., str]:
    """Run a cam that must be refused; returns the message."""

    def refused(name: str) -> str:
        done = centrode("cam", name, "--out", "out")
        assert done.code == 2, done
        assert done.err.startswith("Error: ") and "Traceback" not in done.err
        assert done.out == "" and not (folder / "out").exists()
        return str(done.err)

    return refused


def test_the_profile_is_told(centrode: Centrode, write: Callable[..., str]) -> None:
    done = centrode("cam", write(more=BOUNDS + TOOL))
    assert done.code == 0, done.err
    for said in (
        "base radius                         30 mm",
        "-39.7296 deg at 205.685 deg to 22.1206 deg at 46.4211 deg",
        "from 21.3414 mm where it is convex, at 175.843 deg",
        "from 121.434 mm where it is hollow, at 228.398 deg",
        "undercut                            none",
        "greatest roller                     below 31.3414 mm on this path of its centre",
        "cutter                              radius 6 mm, at most 121.434 mm",
        "least base radius  22.0811 mm, determined by the pressure angle at 206.781 deg",
        "best offset        5.60656 mm: base radius of at least 19.2172 mm",
    ):
        assert said in done.out


@pytest.mark.parametrize(
    ("pairs", "said"),
    [
        (
            FLAT,
            ("0 deg: the face is perpendicular to its motion", "from the follower's axis, ", "best offset  "),
        ),
        (SWINGING, ("from the pivot, ", "determined by the radius of curvature")),
        ((('contact = "roller"\nroller_radius = "10 mm"', 'contact = "knife"'),), ("undercut  ",)),
    ],
)
def test_other_followers(
    centrode: Centrode, write: Callable[..., str], pairs: tuple[tuple[str, str], ...], said: tuple[str, ...]
) -> None:
    bounds = BOUNDS.replace("30 deg", "50 deg").replace("45 deg", "55 deg").replace("4 mm", "0.1 mm")
    done = centrode("cam", write(*pairs, more=bounds), "--out", "out", "--samples", "19", "--no-figures")
    assert done.code == 0, done.err
    assert all(one in done.out for one in said), done.out


def test_everything_is_written(centrode: Centrode, write: Callable[..., str], folder: Path) -> None:
    ezdxf = pytest.importorskip("ezdxf")
    done = centrode("cam", write(more=BOUNDS + TOOL), "--out", "out", "--samples", "37")
    assert done.code == 0, done.err
    names = {path.name for path in (folder / "out").iterdir()}
    for stem, kinds in {
        "cam-profile": ("csv", "nc", "svg", "dxf"),
        "cam-points": ("csv", "nc"),
        "cam-body": ("png", "svg"),
        "cam-curvature": ("png", "svg"),
    }.items():
        assert {f"{stem}.{kind}" for kind in kinds} <= names
    document = ezdxf.readfile(folder / "out" / "cam-profile.dxf")
    assert not document.audit().has_errors
    assert {one.dxf.layer for one in document.modelspace()} >= {"profile", "path", "cutter", "points-cutter"}
    rows = list(csv.DictReader((folder / "out" / "cam-points.csv").read_text(encoding="utf-8").splitlines()))
    assert list(rows[0]) == [
        "curve", "cam_angle [deg]", "curve_point_x [mm]", "curve_point_y [mm]", "curve_normal_x", "curve_normal_y",
    ]  # fmt: skip
    points = {
        name: np.array(
            [[float(row[f"curve_point_{one} [mm]"]) for one in "xy"] for row in rows if row["curve"] == name]
        )
        for name in ("profile", "path", "cutter")
    }
    assert np.abs(np.hypot(*(points["path"] - points["profile"]).T) - 10.0).max() < 1e-12
    assert np.abs(np.hypot(*(points["cutter"] - points["profile"]).T) - 6.0).max() < 1e-12
    numbers = json.loads((folder / "out" / "summary.json").read_text(encoding="utf-8"))
    assert numbers["cam_base_radius"] == {"value": 0.03, "unit": "m"}
    assert numbers["cam_greatest_pressure_angle"]["value"] == pytest.approx(np.radians(39.7296), rel=1e-6)
    assert numbers["cam_best_offset"]["value"] == pytest.approx(0.00560656, rel=1e-6)
    header = (folder / "out" / "cam-profile.csv").read_text(encoding="utf-8").splitlines()[0]
    assert "cutter_centre_x [mm]" in header and "profile_normal_y" in header


def test_without_a_base_radius_the_bounds_give_it(centrode: Centrode, write: Callable[..., str]) -> None:
    done = centrode("cam", write(('[cam]\nbase_radius = "30 mm"\n', ""), more=BOUNDS))
    assert done.code == 0, done.err
    assert "22.0811 mm, the least that the bounds admit" in done.out
    done = centrode("cam", write(('[cam]\nbase_radius = "30 mm"\n', "")))
    assert done.code == 0 and "Profile of the cam" not in done.out


def test_bounds_that_are_broken(centrode: Centrode, write: Callable[..., str]) -> None:
    done = centrode("cam", write(('"30 mm"', '"20 mm"'), more=BOUNDS))
    assert done.code == 3
    assert "the pressure angle is not admissible at 207.147 deg" in done.err
    assert "choose a base radius of at least 22.0811 mm" in done.err and "Profile of the cam" in done.out
    uniform = ('curve = "cycloidal"', 'curve = "uniform"')
    done = centrode("cam", write(('[cam]\nbase_radius = "30 mm"\n', ""), uniform, more=BOUNDS))
    assert done.code == 3
    assert "at 100 deg the velocity of the lift jumps: every base radius leaves a sharp corner" in done.err
    done = centrode("cam", "cam.toml", "--out", "out", "--no-figures", "--animate")
    assert done.code == 3 and "Choice of the base radius" in done.out  # there is nothing to animate


@pytest.mark.drawn
def test_undercut_is_refused_or_shown(
    centrode: Centrode, refuses: Callable[..., str], write: Callable[..., str], folder: Path
) -> None:
    said = refuses(write(*UNDERCUT))
    for one in (
        "[cam] base_radius: the follower undercuts the profile at 26.6717 to 36.5583 deg",
        "choose a base radius above 37.5568 mm or a roller below 10.3295 mm",
        "[study] show_undercut = true shows it",
    ):
        assert one in said
    done = centrode("cam", write(*UNDERCUT, more="[study]\nshow_undercut = true\n"), "--out", "out")
    assert done.code == 0, done.err
    assert "undercut                            at 26.6717 to 36.5583 deg" in done.out
    assert "mm where it is undercut, at " in done.out and "where it is convex" not in done.out
    numbers = json.loads((folder / "out" / "summary.json").read_text(encoding="utf-8"))
    assert numbers["cam_undercuts"]["value"] == 1 and numbers["cam_least_bend"]["value"] < 0


@pytest.mark.parametrize(
    ("pairs", "more", "said"),
    [
        ([('"8 mm"', '"41 mm"')], "", "[follower] offset: with an offset of 41 mm the follower's axis misses"),
        ([], '[tool]\nradius = "200 mm"\n', "[tool] radius: a cutter of 200 mm cuts away the hollow at 228.398 deg"),
        ([], '[tool]\nradius = "-1 mm"\n', "[tool]: radius must be positive"),
        ([], '[study]\nchord_tolerance = "1e-12 mm"\n', "chord_tolerance: a chord tolerance of 1e-12 mm requires"),
        ([], '[study]\nchord_tolerance = "0 mm"\n', "[study]: chord_tolerance must be positive"),
        ([], '[study]\nshow_undercut = "yes"\n', "show_undercut"),
        ([], '[bounds]\nreturn_pressure_angle = "95 deg"\n', "[bounds]: return_pressure_angle must be smaller"),
        ([('curve = "cycloidal"', 'curve = "uniform"')], "", "[[segments]]: the follower undercuts the profile at 100"),
        ([('"8 mm"', '"8 mm"\nface_offset = "1 mm"')], "", "face_offset"),
        (
            [(*SWINGING[0],), (*SWINGING[1],), ("25 mm", "6 deg"), ('"30 mm"', '"130 mm"')],
            "",
            "[follower] pivot_distance: a face 5 mm off a pivot at 120 mm does not reach",
        ),
        (
            [
                ('contact = "roller"', 'kind = "oscillating"\narm = "20 mm"\npivot_distance = "120 mm"'),
                ('offset = "8 mm"\n', ""),
                ("25 mm", "6 deg"),
            ],
            "",
            "[follower] arm: an arm of 20 mm about a pivot at 120 mm does not reach the base circle",
        ),
        (
            [
                ('contact = "roller"', 'kind = "oscillating"\narm = "100 mm"\npivot_distance = "120 mm"'),
                ('offset = "8 mm"\n', ""),
                ("25 mm", "200 deg"),
            ],
            "",
            "its pressure angle reaches 90 deg there",
        ),
        (
            [*SWINGING[:3], ("25 mm", "60 deg"), ('"100 deg"', '"30 deg"'), ('"120 deg"', '"190 deg"'),
             ('"40 mm"', '"40 mm"\nturn = "clockwise"')],
            "",
            "the flat face would have to turn faster than the cam",
        ),
        ([(*SWINGING[0],), ('roller_radius = "10 mm"\noffset = "8 mm"\n', 'arm = "90 mm"\n'), ("25 mm", "6 deg")],
         "", "arm"),
    ],
)  # fmt: skip
def test_refusals(
    refuses: Callable[..., str], write: Callable[..., str], pairs: list[tuple[str, str]], more: str, said: str
) -> None:
    assert said in refuses(write(*pairs, more=more))


SLOW = """
kind = "cam"
display = { length = "mm", angle = "deg" }
[follower]
contact = "flat"
[[segments]]
angle = "180 deg"
to = "20 mm"
curve = "harmonic"
[[segments]]
angle = "180 deg"
to = 0
curve = "harmonic"
[bounds]
pressure_angle = "30 deg"
"""


def test_bounds_that_decide_no_base_radius(
    refuses: Callable[..., str], centrode: Centrode, folder: Path
) -> None:
    # s + s'' is h/2 everywhere: no cam is too small, as the face is square to its way whatever the cam.
    (folder / "slow.toml").write_text(SLOW, encoding="utf-8")
    assert "[cam] base_radius: no bound limits the base radius" in refuses("slow.toml")
    (folder / "slow.toml").write_text('cam = { base_radius = "5 mm" }\n' + SLOW, encoding="utf-8")
    done = centrode("cam", "slow.toml", "--out", "out", "--samples", "19", "--no-figures")
    assert done.code == 0, done.err
    assert done.rows["least base radius"] == "none: no bound limits it"
    numbers = json.loads((folder / "out" / "summary.json").read_text(encoding="utf-8"))
    assert "cam_least_base_radius" not in numbers
    assert str(numbers["cam_greatest_pressure_angle"]["value"]) == "0.0"  # not -0.0


def test_the_greatest_radius_lies_where_the_lift_rests(centrode: Centrode, folder: Path) -> None:
    # A polynomial swings beyond the height of its ends; over a centred edge the profile is r0 + s in polar form.
    text = SLOW.replace("flat", "knife").replace('"harmonic"', '"polynomial"\nat_start = [0.02, 0]', 1)
    (folder / "swing.toml").write_text('cam = { base_radius = "40 mm" }\n' + text, encoding="utf-8")
    assert centrode("cam", "swing.toml", "--out", "out", "--no-figures", "--samples", "3").code == 0
    numbers = json.loads((folder / "out" / "summary.json").read_text(encoding="utf-8"))
    lift = numbers["follower_greatest_lift"]["value"]
    assert lift > 0.021
    # two roundings of the sum
    assert numbers["cam_profile_greatest_radius"]["value"] == pytest.approx(0.04 + lift, rel=4.5e-16, abs=0)
