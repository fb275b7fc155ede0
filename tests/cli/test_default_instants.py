"""Commands about instants without `--at`: which they take, said in the file's unit; one that works where that fails."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

Centrode = Callable[..., Any]

PARALLELOGRAM = """\
[frame.points]
A = [0, 0]
D = [4, 0]
[links.AB]
length = 1
[links.BC]
length = 4
angle = "0 deg"
[links.DC]
length = 1
angle = "0 deg"
[[drives]]
link = "AB"
start = "0 deg"
speed = 1
[assembly]
sides = { C = "left" }
[display]
angle = "deg"
"""
"""All links lie in one line in the initial position: a change point."""

OUTSTRETCHED = """\
[frame.points]
A = [0, 0]
[links.AB]
length = "100 mm"
[links.BC]
length = "300 mm"
angle = "0 deg"
[[guides]]
point = "C"
through = "A"
direction = "0 deg"
[[drives]]
guide = "C"
start = "400 mm"
speed = "-1 m/s"
[assembly]
sides = { B = "left" }
[display]
length = "mm"
"""
"""A slider drives a crank from its outer end: a limit."""


@pytest.mark.parametrize(
    ("command", "name", "told"),
    [
        ("diagrams", "six-bar-press", "the instants of [study]: 120 deg"),
        ("polygons", "six-bar-press", "the instants of [study]: 120 deg"),
        ("centres", "six-bar-press", "the instants of [study]: 120 deg"),
        ("diagrams", "crank-rocker", "the initial position: 0 rad"),
        # the value of a drive by a law may come again: an instant is a time
        ("diagrams", "cam-driven-linkage", "the instants of [study]: 0.04 s, 0.24 s"),
        ("diagrams", "wiper", "the initial position: 0 s"),
    ],
)
def test_the_instants_that_are_taken_are_told(
    centrode: Centrode, folder: Path, command: str, name: str, told: str
) -> None:
    done = centrode(command, name, "--no-figures", "--out", "left-out")
    assert (done.code, done.err) == (0, f"without --at, {told}\n")
    instants = [word for value in told.rpartition(": ")[2].split(", ") for word in ("--at", value)]
    named = centrode(command, name, "--no-figures", "--out", "named", *instants)
    assert (named.code, named.err) == (0, "")
    assert named.out.replace("named:", "left-out:") == done.out


@pytest.mark.parametrize(
    ("command", "text", "told", "unit"),
    [
        ("diagrams", PARALLELOGRAM, "0 deg", "deg"),
        ("diagrams", OUTSTRETCHED, "400 mm", "mm"),
        ("centres", OUTSTRETCHED, "400 mm", "mm"),
        (
            "polygons",
            PARALLELOGRAM.replace("length = 4", "length = 4\nmass = 1\ninertia = 1"),
            "0 deg",
            "deg",
        ),
    ],
)
def test_an_initial_position_that_will_not_do(
    centrode: Centrode, folder: Path, command: str, text: str, told: str, unit: str
) -> None:
    (folder / "m.toml").write_text(text, encoding="utf-8")
    done = centrode(command, "m.toml", "--no-figures")
    assert done.code == 3
    assert done.err.startswith(f"without --at, the initial position: {told}\n")
    other = re.search(rf'choose another instant: --at "([0-9.e+-]+ {unit})"\n$', done.err)
    assert other is not None, done.err
    assert centrode(command, "m.toml", "--no-figures", "--at", other[1]).code == 0
    # an instant that was named gets no other one
    assert "--at" not in centrode(command, "m.toml", "--no-figures", "--at", told).err


def test_a_file_that_does_not_assemble_is_named(centrode: Centrode, folder: Path) -> None:
    (folder / "m.toml").write_text(PARALLELOGRAM.replace('sides = { C = "left" }', ""), encoding="utf-8")
    done = centrode("diagrams", "m.toml")
    assert done.code == 2
    assert done.err.startswith("Error: m.toml, ")


OUT = ("--out", "drawing.svg")
STRUCTURE = ("--chapters", "structure", "--format", "html")


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("draw", "six-bar-press", "--at", "1 rad", *OUT), "--at: 57.2957795 deg\n"),
        (
            ("draw", "six-bar-press", "--at", "1 rad", "--from", "10 deg", "--to", "90 deg", *OUT),
            "--at: 57.2957795 deg; --from: 10 deg; --to: 90 deg\n",
        ),
        (("reduce", "six-bar-press", "--from", "0.5 rad", "--samples", 5), "--from: 28.6478898 deg\n"),
        (("reduce", "six-bar-press", "--samples", 5), ""),
        (
            ("centrodes", "crank-rocker", "--link", "AB", "--to", "90 deg", "--samples", 9),
            "--to: 1.57079633 rad\n",
        ),
        (
            (
                "report",
                "crank-rocker",
                "--at",
                "60 deg",
                "--at",
                "1.5 rad",
                "--chapters",
                "structure",
                "--format",
                "html",
            ),
            "--at: 1.04719755 rad; --at: 1.5 rad\n",
        ),
        # the summary of a run names the range
        (("run", "six-bar-press", "--to", "90 deg", "--samples", 5, "--no-figures"), ""),
    ],
)
def test_values_are_echoed_in_the_unit_of_the_display(
    centrode: Centrode, folder: Path, words: tuple[str | int, ...], said: str
) -> None:
    done = centrode(*words)
    assert (done.code, done.err) == (0, said)
