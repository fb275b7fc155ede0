"""`centrode tolerances` as a user meets it: the tables, the files, what falls apart and what is refused."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import centrode as ct

Centrode = Callable[..., Any]
LIMITS = """
[tolerances]
default = "±0.1 mm"
[tolerances.clearances]
B = "0.05 mm"
[tolerances.outputs]
swing = { formula = "range(angle_DB)", deviation = "0.1 deg" }
rocker = "angle.DB"
"""
FIGURES = ["band", "contributions", "histogram"]


def described(folder: Path, tolerances: str = LIMITS, example: str = "crank-rocker") -> Path:
    path = folder / "limits.toml"
    path.write_text(ct.mechanism_text(ct.example(example)) + tolerances, encoding="utf-8")
    return path


def test_tables_and_files(centrode: Centrode, folder: Path) -> None:
    done = centrode("tolerances", described(folder), "--out", "result", "--samples", 91)
    assert done.code == 0, done
    assert done.rows["mechanisms within the limits"] == "all move: 32 corners, 10000 drawn"
    assert done.rows["bounds of swing"].startswith("kept in the worst case, yield 100 % of those drawn")
    assert "says nothing of impacts" in done.out + done.err
    names = {path.name for path in (folder / "result").iterdir()}
    tables = {"outputs.csv", "contributions.csv", "bands.csv", "histogram.csv", "play.csv", "summary.json"}
    assert names == tables | {f"{name}.{kind}" for name in FIGURES for kind in ("png", "svg")}
    found = ct.tolerances(ct.read_mechanism(folder / "limits.toml"), samples=91)
    with (folder / "result" / "contributions.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["path"] for row in rows] == list(found.limits.paths)
    shares = [float(row["contribution to swing [%]"]) for row in rows]
    assert sum(shares) == pytest.approx(100, rel=1e-12)
    assert shares == pytest.approx(100 * found["swing"].statistics.contributions, rel=1e-12)
    summary = json.loads((folder / "result" / "summary.json").read_text(encoding="utf-8"))
    assert summary["swing.true_upper"]["value"] == pytest.approx(float(found["swing"].true.upper), rel=1e-12)
    assert summary["swing.true_upper"]["unit"] == "rad"


def test_workbooks(centrode: Centrode, folder: Path) -> None:
    done = centrode(
        "tolerances",
        described(folder),
        "--out",
        "book",
        "--xlsx",
        "--no-figures",
        "--draws",
        50,
        "--samples",
        37,
    )
    assert done.code == 0, done
    assert list((folder / "book").glob("*.xlsx"))


def test_outputs_and_draws_of_the_command(centrode: Centrode, folder: Path) -> None:
    path = described(folder)
    words = (
        "tolerances",
        path,
        "--output",
        "max(position_B_x)",
        "--draws",
        100,
        "--seed",
        3,
        "--samples",
        37,
    )
    first, again = centrode(*words), centrode(*words)
    assert first.code == 0, first
    assert first.out == again.out
    assert "max(position_B_x)" in first.out
    assert "32 corners, 100 drawn" in first.out


def test_what_falls_apart_is_told_with_its_place(centrode: Centrode, folder: Path) -> None:
    """Crank and frame together reach coupler and rocker together at a share of these limits."""
    text = '\n[tolerances]\nlinks.OA.length = "±0.8 m"\nlinks.AB.length = "±0.9 m"\n'
    done = centrode(
        "tolerances", described(folder, text), "--out", "result", "--no-figures", "--samples", 181
    )
    assert done.code == 3, done
    assert "falls apart" in done.err
    assert "group AB-DB locks at" in done.err
    assert "% of the tolerances" in done.err
    # what is known is written all the same
    assert (folder / "result" / "outputs.csv").exists()


@pytest.mark.parametrize(
    ("tolerances", "words", "told"),
    [
        ("", (), "no dimension has a tolerance"),
        ('\n[tolerances]\n"links.AB.lenght" = "±1 mm"\n', (), 'did you mean "length"'),
        ('\n[tolerances]\n"links.AB.length" = "±-1 mm"\n', (), "negative"),
        ('\n[tolerances]\n"links.AB.length" = "IT7"\n', (), "3150 mm"),
        (LIMITS, ("--output", "position.Q.x"), '"Q"'),
        (LIMITS, ("--output", "position.B"), "name one of them"),
        (LIMITS, ("--draws", 0), "draws"),
        (LIMITS, ("--seed", -1), "seed"),
    ],
)
def test_refusals(
    centrode: Centrode, folder: Path, tolerances: str, words: tuple[object, ...], told: str
) -> None:
    done = centrode("tolerances", described(folder, tolerances), *words, "--out", "result")
    assert done.code == 2, done
    assert told in done.err
    assert not (folder / "result").exists()


def test_chapter_of_a_report(centrode: Centrode, folder: Path) -> None:
    done = centrode("report", described(folder), "--chapters", "accuracy", "--out", "report")
    assert done.code == 0, done
    page = (folder / "report" / "report.html").read_text(encoding="utf-8")
    assert "Accuracy of the mechanism" in page
    assert "Contributions of the numbers to the variance" in page
    assert "links.AB.length" in page
