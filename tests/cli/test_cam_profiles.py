"""`centrode cam` of a cam with roller, return arc and legs, as a user meets it."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from cam_shapes import WHEEL

Centrode = Callable[..., Any]
RETURN = "[return]\n"


@pytest.fixture
def wheel(folder: Path) -> Path:
    (folder / "wheel.toml").write_text(WHEEL, encoding="utf-8")
    return folder


def test_profile_and_wheel_are_printed(centrode: Centrode, wheel: Path) -> None:
    done = centrode("cam", "wheel.toml")
    assert done.code == 0, done.err
    for said in (
        "working arc                         -45 deg to 45 deg",
        "the smoothest, without active bounds, convex",
        "ρ 56.0051 mm to 74.2886 mm",
        "height of the hub         170 mm",
        "step                      272.714 mm; a turn travels 1090.86 mm",
        "dX/dφ 170 mm/rad at 0 deg to 178.69 mm/rad at ±45 deg, ratio 1.05112",
        "255.334 mm long, and 17.3802 mm between them",
        "clear of the ground",
    ):
        assert said in done.out
    assert list(wheel.iterdir()) == [wheel / "wheel.toml"]


@pytest.mark.drawn
def test_everything_is_written(centrode: Centrode, wheel: Path) -> None:
    pytest.importorskip("ezdxf")
    done = centrode("cam", "wheel.toml", "--out", "out", "--samples", "31", "--groove")
    assert done.code == 0, done.err
    names = {path.name for path in (wheel / "out").iterdir()}
    for stem, kinds in {
        "cam-profile": ("csv", "nc", "svg", "dxf"),
        "shoe-profile": ("csv", "nc", "svg", "dxf"),
        "cam-body": ("png", "svg"),
        "walking-wheel": ("png", "svg"),
    }.items():
        assert {f"{stem}.{kind}" for kind in kinds} <= names
    numbers = json.loads((wheel / "out" / "summary.json").read_text(encoding="utf-8"))
    assert numbers["walking_step"]["value"] == pytest.approx(0.2727145, abs=1e-7)
    assert numbers["walking_step"]["unit"] == "m"
    assert numbers["walking_level_error"]["value"] < 1e-14
    assert numbers["cam_undercuts"]["value"] == 0
    assert "groove_x [mm]" in (wheel / "out" / "cam-profile.csv").read_text(encoding="utf-8").splitlines()[0]


def test_mirror_images_are_told_with_their_kink(centrode: Centrode, wheel: Path) -> None:
    with (wheel / "wheel.toml").open("a", encoding="utf-8") as file:
        file.write(RETURN + 'kind = "mirrored"\n')
    done = centrode("cam", "wheel.toml")
    assert done.code == 0
    assert "kinks of 24.7535 deg outwards at 45, 135, -135, -45 deg" in done.out
    assert "undercut                            from 40.4569 to 49.5431" in done.out


def test_what_is_impossible_ends_with_3_and_is_told_once(centrode: Centrode, wheel: Path) -> None:
    with (wheel / "wheel.toml").open("a", encoding="utf-8") as file:
        file.write(RETURN + 'greatest_radius = "56.2 mm"\nconvex = true\n')
    done = centrode("cam", "wheel.toml")
    assert done.code == 3
    assert done.err.count("no return arc satisfies the bounds") == 1
    assert "the polar radius grows to" in done.err and done.err.rstrip().endswith("relax them")
    assert "Path of the roller's centre" in done.out  # what could be computed stands there


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("legs = 4", "legs = 2", "legs must be a whole number from 3 to 24, got 2"),
        ('to = "90 deg"', 'to = "40 deg"', "the working arc covers -45 to 45 deg"),
        ('post = "120 mm"', 'post = "1 mm"', "reach the ground"),
        ("legs = 4", 'legs = 4\nworking_arc = ["-1 rad", "0.5 rad"]', "the same angle on both sides"),
        ('"15 mm"', '"15 kg"', "kg"),
        ('"15 mm"', '"-15 mm"', "positive"),
        ("symmetric = true", "symmetric = false", "the path 0 to 90 deg"),
    ],
)
def test_wrong_input_ends_with_2_without_a_traceback(
    centrode: Centrode, wheel: Path, old: str, new: str, said: str
) -> None:
    assert old in WHEEL
    (wheel / "wheel.toml").write_text(WHEEL.replace(old, new), encoding="utf-8")
    done = centrode("cam", "wheel.toml", "--out", "out")
    assert done.code == 2
    assert said in done.err and "Traceback" not in done.err
    assert not (wheel / "out").exists()


def test_a_pressure_angle_at_the_start_makes_the_shoe_singular(centrode: Centrode, wheel: Path) -> None:
    text = WHEEL.replace("symmetric = true\n", "").replace('to = "90 deg"', 'to = "1 rad"\nfrom = "-1 rad"')
    text = text.replace('radius = "50 mm"', 'radius = "50 mm"\npressure_angle = "5 deg"')
    (wheel / "wheel.toml").write_text(text, encoding="utf-8")
    done = centrode("cam", "wheel.toml")
    assert done.code == 2
    assert "the shoe is singular" in done.err
