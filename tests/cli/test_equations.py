"""`centrode equations`: printed, written, refused."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

Centrode = Callable[..., Any]

PROBE = """
import json, sys
from centrode.cli.main import main
code = main(sys.argv[1:])
print(json.dumps([code, "sympy" in sys.modules]), file=sys.__stderr__)
"""


def test_the_worked_example_is_printed(centrode: Centrode) -> None:
    done = centrode("equations", "slider-between-cranks")
    assert (done.code, done.err) == (0, "")
    assert done.out.startswith("Slider between two cranks\n\nSymbols\n")
    assert "  dφ₂/dt = ω₂ = -(l₁/l₂) cos t/cos φ₂\n" in done.out
    assert done.out.endswith("Velocity of point C\n  x_C = l₁ cos φ₁ + l₂ cos φ₂\n"
                             "  v_C = -l₁ sin t - ω₂ l₂ sin φ₂ = l₁ sin(φ₂ - t)/cos φ₂\n")  # fmt: skip


def test_a_file_of_ones_own_and_points(centrode: Centrode, folder: Path, four_bar: str) -> None:
    (folder / "press.toml").write_text(four_bar)
    done = centrode("equations", "press.toml", "--point", "B", "--point", "A")
    assert done.code == 0
    assert done.out.index("Velocity of point B") < done.out.index("Velocity of point A")
    assert "v_B = l₃ |ω₃|" in done.out


@pytest.mark.parametrize(
    ("name", "begins", "has"),
    [
        ("press.txt", "Slider between", "ω₂ = Δ₂/Δ"),
        ("press.tex", r"\documentclass", r"\omega_{2} &= \frac{\Delta_{2}}{\Delta}"),
        ("press.md", "# Slider between", r"\begin{pmatrix}"),
        ("PRESS.MD", "# Slider between", r"\begin{pmatrix}"),
    ],
)
def test_documents_are_written_whole(
    centrode: Centrode, folder: Path, name: str, begins: str, has: str
) -> None:
    done = centrode("equations", "slider-between-cranks", "--out", name)
    assert (done.code, done.out) == (0, f"wrote {name}\n")
    text = (folder / name).read_text(encoding="utf-8")
    assert text.startswith(begins)
    assert has in text
    assert centrode("equations", "slider-between-cranks", "--out", name).code == 2
    assert centrode("equations", "crank-rocker", "--out", name, "--force").code == 0
    assert (folder / name).read_text(encoding="utf-8") != text


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("crank-rocker", "--point", "Q"), "crank-rocker, Q: this is not a moving point; one of: A, B"),
        (("crank-rocker", "--point", "O"), "crank-rocker, O: this is not a moving point"),
        (
            ("crank-rocker", "--out", "x.pdf"),
            '--out: this result cannot be written as ".pdf"; use one of .txt, .tex',
        ),
        (("crank-rocker", "--out", "x"), '--out: this result cannot be written as ""'),
        (("no-such-mechanism",), "no-such-mechanism"),
        (("crank-rocker", "--out", "there.txt"), "there.txt: exists already; add --force"),
    ],
)
def test_wrong_input_is_refused(
    centrode: Centrode, folder: Path, arguments: tuple[str, ...], message: str
) -> None:
    (folder / "there.txt").write_text("kept")
    done = centrode("equations", *arguments)
    assert done.code == 2
    assert done.out == ""
    assert message in done.err
    assert "Traceback" not in done.err
    assert [(file.name, file.read_text()) for file in folder.iterdir()] == [("there.txt", "kept")]


def test_a_mechanism_that_does_not_close_is_refused(centrode: Centrode, folder: Path, four_bar: str) -> None:
    (folder / "press.toml").write_text(four_bar.replace("length = 3.5", "length = 0.5"))
    done = centrode("equations", "press.toml")
    assert done.code == 2
    assert "does not close" in done.err


def test_usage_errors_and_help(centrode: Centrode) -> None:
    assert centrode("equations").code == 2
    assert centrode("equations", "crank-rocker", "--no-such-option").code == 2
    assert centrode("equations", "--help").code == 0


def test_printing_needs_no_sympy() -> None:
    done = subprocess.run(
        [sys.executable, "-c", PROBE, "equations", "six-bar-press"],
        capture_output=True, encoding="utf-8", check=True,
    )  # fmt: skip
    assert json.loads(done.stderr.splitlines()[-1]) == [0, False]
