"""`centrode balance` as a user meets it: the table, the files, and what is refused."""

from __future__ import annotations

import csv
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from PIL import Image

import centrode as ct

Centrode = Callable[..., Any]
FILES = ["balance.csv", "balanced.toml", "harmonics.csv"]
FIGURES = ["counterweights", "shaking-cycle", "shaking-harmonics", "shaking-hodograph"]


def test_the_effect_of_counterweights(centrode: Centrode, folder: Path) -> None:
    done = centrode("balance", "in-line-four-bar", "--moment", "--out", "result")
    assert done.code == 0, done
    assert done.rows["balance"] == "shaking force and shaking moment zero"
    assert done.rows["counterweight OA"].startswith("2.68 kg, 50 mm from O at 180 deg")
    assert "turn against it about D" in done.rows["disc for DB"]
    assert done.rows["greatest shaking force"].split() == ["N", "836.014", "0", "-100.0%"]
    assert "0.8 kg at A, 0.6 kg at B" in done.out
    assert "1.11333 kg · 300 mm on DB" in done.out
    names = {path.name for path in (folder / "result").iterdir()}
    assert names == {*FILES, *(f"{name}.{kind}" for name in FIGURES for kind in ("png", "svg"))}
    balanced = ct.read_mechanism(folder / "result" / "balanced.toml")
    shaken = ct.shaking(balanced).attrs
    assert shaken["greatest_shaking_force"] <= 1e-9 * 836 and shaken["greatest_shaking_moment"] <= 1e-9 * 80
    again = centrode("balance", folder / "result" / "balanced.toml", "--no-figures")
    assert again.code == 0, again
    assert "counterweight" not in again.out


def test_tables_hold_the_numbers(centrode: Centrode, folder: Path) -> None:
    done = centrode(
        "balance", "single-cylinder-engine", "--fraction", "1/2", "--samples", 5, "--out", "r", "--no-figures"
    )
    assert done.code == 0, done
    assert sorted(path.name for path in (folder / "r").iterdir()) == FILES
    with (folder / "r" / "balance.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [float(row["drive_crank [deg]"]) for row in rows] == [0, 90, 180, 270, 360]
    # at the upper dead point half of the first order and all of the others are left
    first = (0.766 * 0.045) * (100 * 3.141592653589793) ** 2
    assert float(rows[0]["after_shaking_force_x [N]"]) == pytest.approx(first * (0.5 + 45 / 160), rel=1e-12)
    with (folder / "r" / "harmonics.csv").open(encoding="utf-8", newline="") as file:
        orders = list(csv.DictReader(file))
    assert [float(row["order"]) for row in orders] == list(range(9))
    before, after = (float(orders[1][f"{word}_force_harmonic_cosine_x [N]"]) for word in ("before", "after"))
    assert after == pytest.approx(first / 2, rel=1e-12)
    assert before == pytest.approx(first + (3.2 * 0.008 + 0.504 * 0.045) * first / (0.766 * 0.045), rel=1e-12)


def test_without_a_folder_nothing_is_written(centrode: Centrode, folder: Path) -> None:
    done = centrode("balance", "single-cylinder-engine", "--least-maximum", "--thickness", "30 mm")
    assert done.code == 0
    assert list(folder.iterdir()) == []
    assert "a disc of" in done.rows["counterweight crank"]
    assert "below" in done.rows["proved"]


def test_options_reach_the_balance(centrode: Centrode) -> None:
    done = centrode(
        "balance", "six-bar-press", "--least-maximum", "--on", "OA", "--on", "CD@C", "--weights", "1,0.5,0",
        "--radius", "OA=200 mm", "--radius", "CD=0.9 m", "--most", "CD=30 kg", "--about", "C", "--steady",
        "--samples", 5,
    )  # fmt: skip
    assert done.code == 0, done
    assert "1 x shaking force + 0.5 x shaking moment" in done.rows["balance"]
    assert "of steady motion" in done.rows["speed of the drive"]
    assert ", 0.2 m from O" in done.rows["counterweight OA"]
    assert done.rows["counterweight CD"].startswith("30 kg, 0.9 m from C")
    assert "about (1.25, 0) m" in done.out


def test_no_bound_is_told_where_the_least_force_is_none(centrode: Centrode) -> None:
    done = centrode("balance", "in-line-four-bar", "--least-maximum")
    assert done.code == 0, done
    assert done.rows["proved"] == "no better counterweights exist on these links with these radii"
    assert centrode("balance", "in-line-four-bar", "--full").rows["balance"] == "shaking force zero"


@pytest.mark.drawn
def test_dark_pictures(centrode: Centrode, folder: Path) -> None:
    assert centrode("balance", "in-line-four-bar", "--out", "r", "--dark", "--samples", 9).code == 0
    with Image.open(folder / "r" / "counterweights.png") as picture:
        assert max(picture.convert("RGB").getpixel((2, 2))) < 64


@pytest.mark.parametrize(
    ("arguments", "code", "reason"),
    [
        (("crank-rocker",), 2, "no link has a mass"),
        (("no-such-file.toml",), 2, "no such file"),
        (("spherical-four-bar",), 2, "sphere"),
        (("in-line-four-bar", "--on", "XY"), 2, "there is no link"),
        (("in-line-four-bar", "--on", "OA@"), 2, "has no point"),
        (("in-line-four-bar", "--on", "OA@B"), 2, "has no point"),
        (("in-line-four-bar", "--on", "OA"), 3, "do not balance the shaking force"),
        (("in-line-four-bar", "--fraction", "1/2"), 2, "slider-cranks only"),
        (("single-cylinder-engine", "--fraction", "2"), 2, "from 0 to 1"),
        (("single-cylinder-engine", "--fraction", "half"), 2, "fraction"),
        (("single-cylinder-engine", "--least-maximum", "--fraction", "1/2"), 2, "given together"),
        (("single-cylinder-engine", "--full", "--least-maximum"), 2, "given together"),
        (("single-cylinder-engine", "--full", "--fraction", "1/2"), 2, "given together"),
        (("single-cylinder-engine", "--density", "8000"), 2, "is used with --thickness only"),
        (("single-cylinder-engine", "--weights", "1,0,0"), 2, "are used with --least-maximum only"),
        (("single-cylinder-engine", "--least-maximum", "--weights", "1;0"), 2, "weights"),
        (("single-cylinder-engine", "--moment", "--least-maximum"), 2, "balanced fully"),
        (("single-cylinder-engine", "--moment"), 3, "the moment of inertia of rod is"),
        (("single-cylinder-engine", "--radius", "crank=0"), 2, "must be positive"),
        (("single-cylinder-engine", "--radius", "crank=1", "--radius", "crank=2"), 2, "given twice"),
        (("single-cylinder-engine", "--radius", "1 mm", "--radius", "2 mm"), 2, "NAME=VALUE"),
        (("single-cylinder-engine", "--most", "5 mm"), 2, "most"),
        (("single-cylinder-engine", "--thickness", "-1 mm"), 2, "must be positive"),
        (("single-cylinder-engine", "--thickness", "9 mm", "--density", "0"), 2, "must be positive"),
        (("single-cylinder-engine", "--about", "1,x"), 2, "--about"),
        (("single-cylinder-engine", "--about", "nan,1"), 2, "finite"),
        (("single-cylinder-engine", "--steady"), 2, "[machine]"),
        (("single-cylinder-engine", "--samples", "0"), 2, "samples"),
    ],
)
def test_what_is_refused(
    centrode: Centrode, folder: Path, arguments: tuple[str, ...], code: int, reason: str
) -> None:
    done = centrode("balance", *arguments, "--out", "result", "--no-figures")
    assert done.code == code, done
    assert reason in done.err
    assert "Traceback" not in done.err
    assert not (folder / "result").exists()
