"""`centrode animate`: from the description to the file; what is refused, and that nothing half-written is left."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from PIL import Image

import centrode as ct

Centrode = Callable[..., Any]
SMALL = ("--size", "120x90", "--frames", "6")


def frames(path: Path) -> tuple[int, tuple[int, int], int]:
    """Frames, size and milliseconds of a GIF."""
    with Image.open(path) as picture:
        count, total = getattr(picture, "n_frames", 1), 0
        for number in range(count):
            picture.seek(number)
            total += picture.info["duration"]
        return count, picture.size, total


def test_a_gif_of_an_example(centrode: Centrode, folder: Path) -> None:
    done = centrode("animate", "crank-rocker", "--frames", "6", "--duration", "1.5", "--size", "160x120")
    assert (done.code, done.err) == (0, "")
    assert done.rows["frames"] == "6, 4 per second: 1.5 s"
    assert done.rows["pixels"] == "160 x 120"
    assert done.rows["loop"] == "round, without a jump"
    assert "wrote crank-rocker.gif" in done.out
    assert frames(folder / "crank-rocker.gif") == (6, (160, 120), 1500)
    assert [one.name for one in folder.iterdir()] == ["crank-rocker.gif"]


def test_speed_is_the_mechanisms_own(centrode: Centrode, folder: Path) -> None:
    """A turn at 1 rad/s takes 2 pi s; ten times as fast a tenth of it, in whole frames."""
    done = centrode(
        "animate", "crank-rocker", "--speed", "10", "--fps", "10", "--size", "120x90", "--out", "p.gif"
    )
    assert done.code == 0
    assert frames(folder / "p.gif") == (6, (120, 90), 600)


@pytest.mark.parametrize(
    ("name", "show"),
    [
        ("six-bar-press", "paths,velocities,accelerations,centres,centrodes,forces,loads"),
        ("spherical-crank-rocker-rigid", "paths,velocities,accelerations,centres,centrodes"),
        ("planetary-gear-train", "centrodes"),
        ("excavator-arm", "paths, velocities"),
        ("hookes-joint", "none"),
    ],
)
def test_everything_is_shown(centrode: Centrode, folder: Path, name: str, show: str) -> None:
    done = centrode("animate", name, "--show", show, "--dark", *SMALL, "--out", "shown.gif")
    assert (done.code, done.err) == (0, "")
    assert frames(folder / "shown.gif")[0] == 6


def test_forces_on_the_sphere_are_shown(centrode: Centrode, folder: Path) -> None:
    text = ct.mechanism_text(ct.example("spherical-crank-rocker-rigid")).replace('form = "plain sum"\n', "")
    (folder / "ball.toml").write_text(text)
    done = centrode("animate", "ball.toml", "--show", "forces,loads", *SMALL)
    assert (done.code, done.err) == (0, "")


def test_points_pairs_and_links_are_chosen(centrode: Centrode, folder: Path) -> None:
    words = ("--show", "paths,centres,centrodes", "--points", "B, A", "--growing", "--pair", "DB,OA")
    done = centrode("animate", "crank-rocker", *words, "--link", "AB", "--against", "DB", *SMALL)
    assert (done.code, done.err) == (0, "")


def test_a_limited_mechanism_runs_there_and_back(centrode: Centrode, folder: Path) -> None:
    done = centrode("animate", "slider-between-cranks-locked", *SMALL, "--out", "back.gif")
    assert done.code == 0
    assert done.rows["loop"] == "there and back"
    assert "note: it moves from OA -0.795" in done.out
    assert "72 of 101 samples are not reached and not shown" in done.out


def test_a_range_that_is_not_all_reached_ends_with_3(centrode: Centrode, folder: Path) -> None:
    words = ("--from", "0 deg", "--to", "3 rad", *SMALL, "--out", "part.gif")
    done = centrode("animate", "slider-between-cranks-locked", *words)
    assert done.code == 3
    assert "samples of the range are not reached; choose a range between the limits of the drive" in done.err
    assert frames(folder / "part.gif")[0] == 6


def test_an_mp4_takes_even_sizes(centrode: Centrode, folder: Path) -> None:
    done = centrode(
        "animate", "walking-wheel-three-legs", "--size", "121x91", "--frames", "4", "--out", "wheel.mp4"
    )
    assert (done.code, done.err) == (0, "")
    assert done.rows["pixels"] == "122 x 92"
    assert (folder / "wheel.mp4").read_bytes()[4:8] == b"ftyp"


@pytest.mark.parametrize("name", ["valve-cam", "indexing-cam"])
def test_a_cam_turns_below_its_follower(centrode: Centrode, folder: Path, name: str) -> None:
    done = centrode("animate", name, *SMALL, "--dark")
    assert (done.code, done.err) == (0, "")
    assert done.rows["loop"] == "round, without a jump"
    assert frames(folder / f"{name}.gif")[0] == 6


def test_a_file_that_is_there_is_kept(centrode: Centrode, folder: Path) -> None:
    (folder / "old.gif").write_text("old")
    done = centrode("animate", "crank-rocker", *SMALL, "--out", "old.gif")
    assert done.code == 2
    assert "exists already; add --force to replace it" in done.err
    assert (folder / "old.gif").read_text() == "old"
    assert centrode("animate", "crank-rocker", *SMALL, "--out", "old.gif", "--force").code == 0
    assert frames(folder / "old.gif")[0] == 6


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (("nothing-of-the-kind",), "no such file, and no built-in mechanism of this name"),
        (("crank-rocker", "--out", "a.avi"), "an animation is a .gif or a .mp4; name such a file"),
        (("crank-rocker", "--out", "."), "an animation is a .gif or a .mp4"),
        (("crank-rocker", "--show", "speeds"), '"speeds" cannot be shown'),
        (("crank-rocker", "--points", "Z"), 'there is no moving point "Z"'),
        (("crank-rocker", "--link", "AB"), "it controls how centrodes are shown, which are not shown"),
        (("crank-rocker", "--against", "AB"), "it controls how centrodes are shown, which are not shown"),
        (("crank-rocker", "--show", "none", "--growing"), "it controls how paths"),
        (("crank-rocker", "--pair", "AB"), 'expected LINK,LINK, got "AB"'),
        (("crank-rocker", "--show", "centres", "--pair", "AB,XY"), "XY"),
        (("crank-rocker", "--show", "forces"), "there are neither masses nor loads"),
        (("crank-rocker", "--size", "800"), "expected WIDTHxHEIGHT"),
        (("crank-rocker", "--size", "10x10"), "give 64 to 4096 pixels in each direction"),
        (
            ("crank-rocker", "--size", "4096x4096", "--frames", "3000"),
            "give at most 59 frames of this size",
        ),
        (("crank-rocker", "--frames", "1"), "give 2 to 3000 frames"),
        (("crank-rocker", "--frames", "many"), "many"),
        (("crank-rocker", "--fps", "1000"), "give 0.1 to 50 frames per second"),
        (("crank-rocker", "--duration", "-1"), "it must be a finite number greater than zero"),
        (("crank-rocker", "--speed", "nan"), "it must be a finite number greater than zero"),
        (("crank-rocker", "--speed", "1", "--duration", "1"), "remove one of the two"),
        (("crank-rocker", "--frames", "9", "--fps", "9", "--duration", "1"), "remove one of the three"),
        (("crank-rocker", "--from", "1 kg"), "kg"),
        (("crank-rocker", "--from", "1", "--to", "1"), "the range is empty: it begins and ends at 1 rad"),
        (
            ("crank-rocker", "--speed", "inf"),
            "speed: it must be a finite number greater than zero, and inf is given",
        ),
        (("walking-wheel-four-legs", "--show", "paths"), "a cam is shown as a whole"),
        (("walking-wheel-four-legs", "--from", "0"), "a cam is shown as a whole"),
        (("walking-wheel-four-legs", "--speed", "1"), "a cam has no speed of its own"),
        (("cam-from-curvature",), "a profile needs a roller"),
        (("valve-cam", "--show", "paths"), "a cam is shown as a whole"),
        (("indexing-cam", "--to", "90 deg"), "a cam is shown as a whole"),
        (("scissor-lift", "--show", "centrodes", "--link", "frame"), "frame"),
        ((), "FILE_OR_EXAMPLE"),
    ],
)
def test_what_is_refused(centrode: Centrode, folder: Path, words: tuple[str, ...], told: str) -> None:
    done = centrode("animate", *words)
    assert (done.code, done.out) == (2, "")
    assert told in done.err
    assert "Traceback" not in done.err
    assert list(folder.iterdir()) == []
