"""`centrode synthesise` as a user meets it: files that run, pictures, and what is refused."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import centrode as ct

Centrode = Callable[..., Any]
POSES = """title = "Поворот крышки"
[synthesis]
topology = "crank-rocker"
kind = "motion"
targets = "poses.csv"
"""
STROKES = '[synthesis]\nkind = "strokes"\n'


def test_answers_are_descriptions_that_run(centrode: Centrode, folder: Path) -> None:
    (folder / "lid.toml").write_text(POSES, encoding="utf-8")
    (folder / "poses.csv").write_text(
        "x [cm];y [cm];angle [deg]\n0;0;0\n10;6;17,5\n20;10;40\n", encoding="utf-8"
    )
    done = centrode("synthesise", "lid.toml", "--out", "lid")
    assert done.code == 0
    assert "Поворот крышки" in done.out
    names = {path.name for path in (folder / "lid").iterdir()}
    assert {"answer-1.toml", "answers.csv", "answers.png", "answers.svg", "summary.json"} <= names
    first = ct.read_mechanism(folder / "lid" / "answer-1.toml")
    assert "P" in first.links["AB"].coordinates
    place = ct.motion(first, at=[float(first.drives[0].start)]).position.sel(point="P").to_numpy()[0]
    assert place == pytest.approx([0, 0], abs=1e-9)
    assert centrode("check", "lid/answer-1.toml").code == 0
    with (folder / "lid" / "answers.csv").open(encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    assert len(rows) == json.loads((folder / "lid" / "summary.json").read_text())["answers"]["value"]


@pytest.mark.parametrize("language", ["en", "ru", "uk"])
def test_strokes_are_printed_with_their_construction(centrode: Centrode, folder: Path, language: str) -> None:
    wanted = STROKES + 'topology = "shaper"\nstroke = "400 mm"\ntime_ratio = 1.6\n'
    (folder / "shaper.toml").write_text(wanted, encoding="utf-8")
    done = centrode("--lang", language, "synthesise", "shaper.toml")
    assert done.code == 0
    assert "(K - 1)/(K + 1)" in done.out
    assert "0.4" in done.out or "0,4" in done.out


@pytest.mark.parametrize(
    ("text", "code", "said"),
    [
        ("", 2, "there is no table [synthesis]"),
        ('[synthesis]\nkind = "path"', 2, "the structure that is sought is not given"),
        # keys of the table below say where they belong
        (
            '[synthesis]\nkind = "path"\ntopology = "crank-rocker"\nsize = ["1 m", "1 m"]',
            2,
            'unknown key "size"; did you mean constraints.size?',
        ),
        (
            '[synthesis]\nkind = "path"\ntopology = "crank-rocker"\npivots = {}',
            2,
            'unknown key "pivots"; did you mean constraints.pivots?',
        ),
        ('[synthesis]\nkind = "way"\ntopology = "crank-rocker"', 2, "expected one of"),
        (
            '[synthesis]\nkind = "path"\ntopology = "crank-rocker"\ntargets = [[0, 0]]',
            2,
            "1 row is too few",
        ),
        (
            '[synthesis]\nkind = "path"\ntopology = "crank-rocker"\ntargets = [[0, 0], [1, nan], [2, 2]]',
            2,
            "finite",
        ),
        (
            '[synthesis]\nkind = "path"\ntopology = "crank-rocker"\ntargets = [[1, 1], [1, 1], [1, 1]]',
            2,
            "all targets are the same",
        ),
        (
            '[synthesis]\nkind = "path"\ntopology = "crank-rocker"\ntargets = "no.csv"',
            2,
            "there is no such file",
        ),
        (
            '[synthesis]\nkind = "path"\ntopology = "crank-rocker"\ntargets = [[0, 0], [1, 1], [2, 0]]\n'
            'timing = "given"',
            2,
            "timing needs an angle of the drive in every row",
        ),
        (
            '[synthesis]\nkind = "path"\ntopology = "crank-rocker"\ntargets = [[0, 0], [1, 1], [2, 0]]\n'
            "[synthesis.free]\nlinks.XY.length = [1, 2]",
            2,
            "is not a number of this topology",
        ),
        (
            '[synthesis]\nkind = "path"\ntopology = "crank-rocker"\ntargets = [[0, 0], [1, 1], [2, 0]]\n'
            "[synthesis.free]\nframe.points.O.x = [1, 2]\n[synthesis.constraints]\npivots = { x = [5, 6] }",
            2,
            "pivots.x: no fixed hinge lies both in pivots and in its own range",
        ),
        (
            '[synthesis]\nkind = "motion"\ntopology = "crank-rocker"\ntargets = [[0, 0, 0], [0, 0, 0]]',
            2,
            "all targets are the same",
        ),
        (
            '[synthesis]\nkind = "motion"\ntopology = "crank-rocker"\ntargets = [[0, 0, 0], [1, 0, 0], [0, 0, 0]]',
            2,
            "poses 1 and 3 are the same",
        ),
        (
            '[synthesis]\nkind = "function"\ntopology = "crank-rocker"\ntargets = [[0, 0], [1, 1], [1, 2]]',
            2,
            "an angle of the crank has two values",
        ),
        (
            '[synthesis]\nkind = "function"\ntopology = "crank-rocker"\nformula = "log(x)"\nx = [0, 1]\n'
            'swings = ["60 deg", "60 deg"]',
            2,
            "the formula has no value at x = 0",
        ),
        (
            STROKES
            + 'topology = "slider-crank-offset"\nstroke = 1\ntime_ratio = 1.2\ntransmission = "70 deg"',
            3,
            "at most 47.2 deg is possible",
        ),
        (
            '[synthesis]\nkind = "path"\ntopology = "crank-rocker"\ntargets = [[0, 0], [1, 1], [2, 0]]\nexact = 4',
            2,
            '"exact" means nothing to kind = "path"',
        ),
        (
            '[synthesis]\nkind = "function"\ntopology = "crank-rocker"\ntargets = [[0, 0], [1, 1], [2, 3]]\nexact = 5',
            2,
            "5 exact points, and a table of 3",
        ),
        (
            '[synthesis]\nkind = "motion"\ntopology = "crank-rocker"\ntargets = [[0, 0, 0], [1, 1, 1]]\n'
            "hinges = [[0, 0], [1, 0]]",
            2,
            "given hinges need three poses, got 2",
        ),
        (
            '[synthesis]\nkind = "function"\ntopology = "crank-rocker"\ntargets = [[0, 0], [1, 1], [2, 3]]\n'
            "[synthesis.free]\nlinks.OA.length = [1, 2]",
            2,
            '"free" means nothing to kind = "function"',
        ),
        (
            STROKES + 'topology = "shaper"\nstroke = 1\ndwell = { range = [0, 1] }',
            2,
            "a dwell is that of a mechanism",
        ),
        (STROKES + 'topology = "shapr"\nstroke = 1', 2, 'did you mean "shaper"?'),
        (
            '[links.OA]\nlength = 1\n[synthesis]\nkind = "path"\ntopology = "crank-rocker"',
            2,
            "remove topology",
        ),
    ],
)
def test_refusals(centrode: Centrode, folder: Path, text: str, code: int, said: str) -> None:
    (folder / "wanted.toml").write_text(text, encoding="utf-8")
    done = centrode("synthesise", "wanted.toml", "--out", "found")
    assert done.code == code
    assert said in done.err
    assert done.err.startswith("Error: wanted.toml")
    assert not (folder / "found").exists()


def test_a_million_targets_are_refused_before_anything_is_computed(centrode: Centrode, folder: Path) -> None:
    (folder / "many.csv").write_text("0,0\n" * 10**6, encoding="utf-8")
    (folder / "many.toml").write_text(
        '[synthesis]\nkind = "path"\ntopology = "crank-rocker"\ntargets = "many.csv"', encoding="utf-8"
    )
    done = centrode("synthesise", "many.toml")
    assert done.code == 2
    assert "are allowed" in done.err


def test_the_result_is_shown_as_any_other() -> None:
    wanted = {
        "kind": "strokes",
        "topology": "crank-rocker",
        "swing": "40 deg",
        "time_ratio": 1.25,
        "answers": 2,
    }
    found = ct.synthesise({"synthesis": wanted})
    assert "swing" in ct.summary(found)
    assert list(ct.tables(found)) == ["answers"]
    assert list(ct.figures(found)) == ["construction"]
