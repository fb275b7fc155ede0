"""`centrode rotatability`: what it prints and writes, and what it refuses."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import centrode as ct

Centrode = Callable[..., Any]


def test_what_stops_a_mechanism_is_printed_and_written(centrode: Centrode, folder: Path) -> None:
    done = centrode("rotatability", "slider-between-cranks-locked", "--out", "found.json")
    assert done.code == 0
    assert done.err == ""
    assert done.out.startswith("Slider between two cranks, locking\n\n")
    assert done.rows["turns fully"] == "no"
    assert done.rows["upper limit"] == "OA = 1.79991242 rad (103.127 deg), group CB-BD (point B)"
    assert "CB and BD are collinear, extended (distance of C and D: 2 m): sin(phi3 - phi4) = 0" in done.out
    assert done.rows["loop frame-OA-AC-C"] == "slider-crank, the crank turns fully"
    assert done.out.endswith("wrote found.json\n")
    data = json.loads((folder / "found.json").read_text(encoding="utf-8"))
    assert data["limits"][1]["value"] == ct.limits(ct.example("slider-between-cranks-locked")).interval[1]
    assert data["limits"][1]["condition"] == "sin(phi3 - phi4) = 0"


def test_a_mechanism_that_turns(centrode: Centrode) -> None:
    done = centrode("rotatability", "six-bar-press")
    assert done.code == 0
    assert done.rows["turns fully"] == "yes, it returns after 1 turn"
    assert done.rows["link CD"].endswith(" deg, time ratio 1.20253, forward 163.448 deg, back 196.552 deg")
    assert "OA and AB in line" in done.out


def test_a_repair_is_printed_and_written(centrode: Centrode, folder: Path) -> None:
    asked = ("--repair", "--vary", "links.CB.angle", "--vary", "links.BD.angle=5 rad:7 rad")
    done = centrode("rotatability", "slider-between-cranks-locked", *asked, "--out", "turning.toml")
    assert done.code == 0
    assert done.rows["verified"].startswith("turns fully, least transmission angle 10.000")
    assert done.rows["links.BD.angle"].startswith("from 5.7 rad (326.586 deg) to ")
    again = centrode("rotatability", "turning.toml")
    assert again.rows["turns fully"] == "yes, it returns after 1 turn"
    run = centrode("run", "turning.toml", "--no-figures", "--samples", "361")
    assert run.code == 0
    assert run.rows["samples"] == "361: ok 361"
    report = centrode(
        "rotatability",
        "turning.toml",
        "--repair",
        "--least-transmission-angle",
        "10 deg",
        "--out",
        "report.json",
    )
    assert report.rows["found"] == "the requirement is already satisfied"
    assert json.loads((folder / "report.json").read_text(encoding="utf-8"))["found"] is True


def test_no_repair_ends_with_exit_code_3(centrode: Centrode, folder: Path) -> None:
    asked = ("--repair", "--vary", "links.CB.angle", "--vary", "links.BD.angle")
    done = centrode(
        "rotatability",
        "slider-between-cranks-locked",
        *asked,
        "--least-transmission-angle",
        "20 deg",
        "--out",
        "none.toml",
    )
    assert done.code == 3
    assert done.rows["found"].startswith("impossible: OA + e > AC cos 20 deg: 0.979426 m > 0.939693 m")
    assert done.err.startswith("Error: slider-between-cranks-locked: no change was found")
    assert not (folder / "none.toml").exists()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("no-such-file",), "no-such-file: no such file"),
        (
            ("crank-rocker", "--vary", "links.OA.length"),
            "--vary: this option is used with --repair only; add --repair",
        ),
        (("crank-rocker", "--least-transmission-angle", "9 deg"), "this option is used with --repair only"),
        (
            ("crank-rocker", "--out", "x.toml"),
            '--out: this result cannot be written as ".toml"; use one of .json',
        ),
        (("crank-rocker", "--out", "x"), 'cannot be written as ""'),
        (("triple-rocker", "--repair", "--out", "x.csv"), "use one of .json, .toml"),
        (("triple-rocker", "--repair", "--vary", "links.OA.length=2"), "expected NAME=FIRST:LAST"),
        (("triple-rocker", "--repair", "--vary", "links.OA.length=2 kg:3 kg"), "links.OA.length: "),
        (("triple-rocker", "--repair", "--vary", "OA"), "there is no "),
        (
            ("triple-rocker", "--repair", "--vary", "links.OA.length", "--vary", "links.OA.length"),
            "given twice",
        ),
        (("triple-rocker", "--repair", "--least-transmission-angle", "ninety"), "least_transmission_angle: "),
        (
            ("five-bar-two-drives", "--repair"),
            "five-bar-two-drives, [[drives]]: a repair is computed for one drive",
        ),
        (("third-class-triad", "--repair", "--least-transmission-angle", "1 deg"), "groups of higher class"),
    ],
)
def test_wrong_questions_are_refused(
    centrode: Centrode, folder: Path, arguments: tuple[str, ...], message: str
) -> None:
    done = centrode("rotatability", *arguments)
    assert done.code == 2
    assert done.out == ""
    assert message in done.err
    assert "Traceback" not in done.err
    assert list(folder.iterdir()) == []


def test_files_are_not_replaced_unasked(centrode: Centrode, folder: Path) -> None:
    (folder / "found.json").write_text("mine")
    assert centrode("rotatability", "crank-rocker", "--out", "found.json").code == 2
    assert (folder / "found.json").read_text() == "mine"
    assert centrode("rotatability", "crank-rocker", "--out", "found.json", "--force").code == 0
    assert json.loads((folder / "found.json").read_text())["turns_fully"] is True
