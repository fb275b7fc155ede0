"""`centrode centres` and `centrode centrodes`: what they print and write, and wrong questions."""

from __future__ import annotations

import csv
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

import centrode as ct

Centrode = Callable[..., Any]


def rows(file: Path) -> list[dict[str, str]]:
    with file.open(encoding="utf-8", newline="") as stream:
        return list(csv.DictReader(stream))


def printed(out: str, symbol: str) -> str:
    """The row of a centre."""
    return next(line for line in out.splitlines() if line.startswith(f"{symbol} "))


def test_centres_are_printed(centrode: Centrode) -> None:
    done = centrode("centres", "slider-between-cranks", "--at", "pi/2 rad")
    assert done.code == 0
    assert done.err == ""
    assert done.out.startswith(
        "Slider between two cranks\n\nbodies: 0 frame, 1 OA, 2 AC, 3 CB, 4 BD, 5 slider C\n"
    )
    assert "OA 1.57079633 rad (90 deg)" in done.out
    second, third = printed(done.out, "P20"), printed(done.out, "P30")
    assert "at infinity, 90 deg" in second and "equal velocities: translation" in second
    assert "P21 P10 × P52 P50" in second
    assert "(0.999788323, 1.69663632) m" in third and "two velocity directions" in third
    assert "hinge D" in printed(done.out, "P40")
    assert "no relative motion" not in done.out
    assert len([line for line in done.out.splitlines() if line.startswith("P")]) == 15


@pytest.mark.drawn
def test_centres_are_written(centrode: Centrode, folder: Path) -> None:
    done = centrode(
        "centres", "six-bar-press", "--at", "120 deg", "--at", "30 deg", "--pair", "AB,frame",
        "--pair", "slider,CD", "--out", "result",
    )  # fmt: skip
    assert done.code == 0, done.err
    result = folder / "result"
    names = ["centres-1.png", "centres-1.svg", "centres-2.png", "centres-2.svg", "centres.csv", "centres.nc"]
    assert sorted(path.name for path in result.iterdir()) == names
    mechanism = ct.example("six-bar-press")
    motion = ct.motion(mechanism, at=np.radians([120.0, 30.0]))
    centres = ct.instant_centres(motion, [("AB", "frame"), ("slider", "CD")])
    table = rows(result / "centres.csv")
    assert [(row["first"], row["second"]) for row in table] == [("AB", "frame"), ("slider", "CD")] * 2
    unit = next(name for name in table[0] if name.startswith("centre_x")).partition(" ")[2]
    assert all(row["case"] == "two velocity directions" and row["constructed"] == "kennedy" for row in table)
    factor = 1000.0 if unit == "[mm]" else 1.0
    found = [float(row[f"centre_{axis} {unit}"]) / factor for row in table for axis in "xy"]
    np.testing.assert_allclose(found, centres["centre"].to_numpy().reshape(-1), rtol=1e-15)
    assert max(float(row["mismatch"]) for row in table) < 1e-13
    with xr.open_dataset(result / "centres.nc", engine="scipy") as written:
        np.testing.assert_array_equal(written["centre"], centres["centre"])


def test_the_usual_places(centrode: Centrode, folder: Path, four_bar: str) -> None:
    (folder / "press.toml").write_text(four_bar)
    assert "OA 1 rad (57.2958 deg)" in centrode("centres", "press.toml").out  # the initial position
    (folder / "press.toml").write_text(f'{four_bar}[study]\ninstants = ["90 deg", "180 deg"]\n')
    done = centrode("centres", "press.toml", "--out", "dark", "--dark")
    assert "(90 deg)" in done.out and "(180 deg)" in done.out
    assert (folder / "dark" / "centres-2.png").read_bytes().startswith(b"\x89PNG")
    done = centrode("centres", "press.toml", "--out", "plain", "--no-figures")
    assert sorted(path.name for path in (folder / "plain").iterdir()) == ["centres.csv", "centres.nc"]
    assert "velocity field" in centrode("centres", "two-link-arm").out


def test_places_that_are_not_reached_end_with_3(centrode: Centrode, folder: Path) -> None:
    done = centrode(
        "centres",
        "slider-between-cranks-locked",
        "--at",
        "1 rad",
        "--at",
        "2 rad",
        "--out",
        "r",
        "--no-figures",
    )
    assert done.code == 3
    assert "at 1 of 2 places there are no velocities (open)" in done.err
    assert printed(done.out, "P30").count("(") == 1
    assert "no position" in done.out
    assert {row["case"] for row in rows(folder / "r" / "centres.csv")} >= {"no position", "common hinge"}


@pytest.mark.drawn
def test_centrodes_are_written(centrode: Centrode, folder: Path) -> None:
    done = centrode(
        "centrodes", "elliptic-trammel", "--link", "AB", "--samples", "7", "--at", "0.3 m", "--animate"
    )
    assert done.code == 0, done.err
    result = folder / "elliptic-trammel-centrodes"
    names = [
        "centrodes.csv",
        "centrodes.gif",
        "centrodes.nc",
        "centrodes.png",
        "centrodes.svg",
        "curvature.nc",
    ]
    assert sorted(path.name for path in result.iterdir()) == [*names, "curvature.png", "curvature.svg"]
    assert done.rows["pieces"] == "1"
    assert done.rows["samples with a centre"] == "7 / 7"
    assert done.rows["diameter of the inflection circle"] == "1 m"
    assert done.rows["radius of the path of A"] == "∞"
    table = rows(result / "centrodes.csv")
    assert len(table) == 7
    radii = [
        math.hypot(float(row["fixed_centrode_x [m]"]), float(row["fixed_centrode_y [m]"])) for row in table
    ]
    np.testing.assert_allclose(radii, 1.0, rtol=1e-13)
    assert {row["status"] for row in table} == {"ok"}


def test_curvature_at_a_place_that_is_not_reached_ends_with_3(centrode: Centrode, folder: Path) -> None:
    arguments = ("--link", "CB", "--samples", "5", "--at", "1 rad", "--at", "2 rad", "--out", "r")
    done = centrode("centrodes", "slider-between-cranks-locked", *arguments)
    assert done.code == 3
    assert "at 1 of 2 places there are no velocities (open)" in done.err
    assert sorted(path.name for path in (folder / "r").glob("*.png")) == ["centrodes.png", "curvature-1.png"]


def test_the_way_to_a_pair_is_told(centrode: Centrode) -> None:
    done = centrode("centres", "five-bar-two-drives", "--pair", "AB,EC")
    assert done.code == 0
    assert "through: " in done.out and "velocity field" in done.out.partition("through: ")[2]


def test_a_link_that_translates_has_no_centrode(centrode: Centrode, folder: Path) -> None:
    done = centrode(
        "centrodes", "rack-and-pinion", "--link", "rack", "--samples", "5", "--no-figures", "--out", "r"
    )
    assert done.code == 3
    assert (
        "rack-and-pinion: rack has no centre relative to the frame in this range: it translates" in done.err
    )
    assert "--against" in done.err


def test_centrodes_of_links_against_each_other(centrode: Centrode, folder: Path) -> None:
    done = centrode(
        "centrodes", "antiparallelogram", "--link", "DB", "--against", "OA", "--from", "30 deg", "--to", "160 deg",
        "--out", "r", "--no-figures",
    )  # fmt: skip
    assert done.code == 0, done.err
    assert done.rows["bodies"] == "DB relative to OA"
    assert sorted(path.name for path in (folder / "r").iterdir()) == ["centrodes.csv", "centrodes.nc"]


REFUSED = {
    ("centres", "crank-rocker", "--pair", "AB"): '--pair: expected LINK,LINK, got "AB"; write "AC,frame"',
    ("centres", "crank-rocker", "--pair", "AB,XY"): 'crank-rocker, pair: there is no link "XY"',
    ("centres", "crank-rocker", "--pair", "AB,AB"): "AB has no centre relative to itself; name two bodies",
    ("centres", "crank-rocker", "--at", "1 m"): "crank-rocker, --at: expected an angle",
    ("centres", "crank-rocker", "--at", "1e9"): "crank-rocker, range: it is too long",
    ("centres", "spherical-four-bar", "--pair", "AB,XY"): 'there is no link "XY"',
    ("centres", "nowhere"): "nowhere: no such file",
    ("centres", "crank-rocker", "--out", "taken"): "taken is not a folder",
    ("centrodes", "crank-rocker"): "--link",
    ("centrodes", "crank-rocker", "--link", "XY"): 'there is no link "XY"',
    ("centrodes", "crank-rocker", "--link", "AB", "--against", "AB"): "AB has no centre relative to itself",
    ("centrodes", "crank-rocker", "--link", "AB", "--samples", "0"): "0 samples are given",
    (
        "centrodes",
        "spherical-four-bar",
        "--link",
        "BC",
        "--at",
        "1 rad",
    ): "curvature is not computed on the sphere",
    ("centrodes", "spherical-four-bar", "--link", "BC", "--against", "XY"): 'there is no link "XY"',
    (
        "centrodes",
        "slider-between-cranks",
        "--link",
        "slider C",
        "--animate",
    ): "there is no centrode in this range",
}


@pytest.mark.parametrize("arguments", REFUSED, ids=" ".join)
def test_wrong_questions(centrode: Centrode, folder: Path, arguments: tuple[str, ...]) -> None:
    (folder / "taken").write_text("")
    done = centrode(*arguments)
    assert done.code == 2
    assert done.out == ""
    assert REFUSED[arguments] in done.err
    assert "Traceback" not in done.err
    assert [path.name for path in folder.iterdir()] == ["taken"]


def test_a_big_mechanism_asks_for_pairs(centrode: Centrode, folder: Path) -> None:
    text = ["[frame.points]\nO = [0, 0]"]
    text += [f"D{k} = [{4 + 0.01 * k}, {0.01 * k}]" for k in range(30)]
    text += ['[links.crank]\npoints = ["O", "A"]\nlength = 1']
    for k in range(30):
        text += [f'[links.rod{k}]\npoints = ["A", "B{k}"]\nlength = 3.5']
        text += [f'[links.arm{k}]\npoints = ["D{k}", "B{k}"]\nlength = 3']
    text += ['[[drives]]\nlink = "crank"\nstart = 1\nspeed = 1\n[assembly.sides]']
    text += [f'B{k} = "left"' for k in range(30)]
    (folder / "big.toml").write_text("\n".join(text))
    done = centrode("centres", "big.toml")
    assert done.code == 2
    assert (
        'big.toml, --pair: 62 bodies have 1891 centres; name those that matter, as in --pair "crank,frame"'
        in done.err
    )
    done = centrode("centres", "big.toml", "--pair", "rod7,frame", "--out", "r")
    assert done.code == 0, done.err
    assert "two velocity directions" in printed(done.out, "P16,0")
    assert sorted(path.name for path in (folder / "r").iterdir()) == ["centres.csv", "centres.nc"]


@pytest.mark.drawn
def test_axes_on_the_sphere(centrode: Centrode, folder: Path) -> None:
    """Rows with the relative speed, a table with unit vectors, the picture."""
    done = centrode("centres", "spherical-crank-guide", "--at", "1 rad", "--out", "r")
    assert done.code == 0, done.err
    assert "pole of guide C" in done.out and "57.2957795 deg/s" in done.out
    assert "P20" in done.out and "P21 P10 × P32 P30" in done.out
    head, *rows = (folder / "r" / "centres.csv").read_text().splitlines()
    assert head.split(",")[4:8] == ["centre_x", "centre_y", "centre_z", "relative_speed [deg/s]"]
    assert len(rows) == 6
    for row in rows:
        assert abs(sum(float(x) ** 2 for x in row.split(",")[4:7]) - 1.0) <= 8 * np.finfo(float).eps
    assert sorted(p.name for p in (folder / "r").iterdir()) == [
        "centres.csv", "centres.nc", "centres.png", "centres.svg"
    ]  # fmt: skip


@pytest.mark.drawn
def test_polodes_on_the_sphere(centrode: Centrode, folder: Path) -> None:
    done = centrode(
        "centrodes",
        "bevel-pair",
        "--link",
        "BF",
        "--against",
        "AE",
        "--samples",
        "25",
        "--animate",
        "--out",
        "r",
    )
    assert done.code == 0, done.err
    assert done.rows["pieces"] == "1"
    assert done.rows["arc of the fixed centrode"].startswith("160.99")  # 360 deg / sqrt(5)
    head = (folder / "r" / "centrodes.csv").read_text().splitlines()[0]
    assert "fixed_centrode_z" in head and "moving_arc [deg]" in head
    assert (folder / "r" / "centrodes.gif").stat().st_size > 10_000
