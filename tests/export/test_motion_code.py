"""Source files of mechanisms: run in their languages, they give what the program gives, statuses among it."""

from __future__ import annotations

import math
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from tools.campaigns.campaign import Outcome
from tools.campaigns.source_files.cases import CAMPAIGN, cases, compare, sets_of
from tools.source_programs import PROGRAMS, Places, answers_of

import centrode as ct
from centrode.errors import InputError, NotComputedYet
from centrode.export.code_files import STATUSES
from centrode.export.motion_code import motion_code
from centrode.export.motion_program import program_name, traced_program
from centrode.model.files import parse_mechanism
from centrode.numerics.rule_translation import translate_rules
from centrode.numerics.source_languages import LANGUAGES

SAMPLE = (
    ("double-rocker", "c"), ("geared-five-bar", "c"), ("parallelogram", "c"), ("spherical-crank-guide", "c"),
    ("excavator-arm", "c"), ("rack-and-pinion", "javascript"), ("peaucellier", "javascript"), ("wiper", "python"),
    ("slider-between-cranks-locked", "python"), ("crank-rocker", "matlab"),
)  # fmt: skip
"""Limits; gears; change points; the sphere; several drives; rolling; kites; a law; a mechanism that locks."""


@pytest.mark.parametrize(("name", "language"), SAMPLE)
def test_places_and_statuses_are_those_of_the_motion(name: str, language: str) -> None:
    if PROGRAMS[language] is None:
        pytest.skip(f"{language} is not installed")
    program = traced_program(name, None)
    outcome = Outcome(subject=name)
    few = {"matlab": (1, 60), "python": (3, 8)}
    count, every = few.get(language, (8, 1))
    compare(outcome, program, language, sets_of(program, np.random.default_rng(34), count), every)
    assert outcome.faults == []
    assert outcome.counts["places"] > 0


def test_the_campaign_has_twenty_linkages_in_every_language() -> None:
    assert CAMPAIGN.cases == len(cases()) == len(ct.example_names()) + 3 * 20


def run_python(text: str) -> ModuleType:
    module = ModuleType("printed")
    exec(compile(text, "printed", "exec"), vars(module))
    return module


def test_the_law_of_cosines_holds_for_a_chosen_dimension() -> None:
    printed = run_python(motion_code("crank-rocker", "python", ["links.AB.length"]))
    assert printed.DIMENSIONS == [3.5] and printed.DIMENSION_NAMES == ["links.AB.length"]
    for length in (2.5, 3.5, 3.9):
        record = printed.prepare([length])
        assert printed.at(record, 1.0) == 0
        found = dict(zip(printed.RESULTS, record.row, strict=False))
        a = found["position A x"], found["position A y"]
        b = found["position B x"], found["position B y"]
        assert math.dist(a, b) == pytest.approx(length, rel=1e-14)
        assert math.dist(b, (4.0, 0.0)) == pytest.approx(3.0, rel=1e-14)


def test_a_limit_is_where_coupler_and_rocker_are_in_line() -> None:
    printed = run_python(motion_code("crank-rocker", "python", ["links.AB.length"]))
    record = printed.prepare([1.5])
    # O and A at 1, O and D at 4: the diagonal AD is 1.5 + 3 there
    limit = math.acos((1.0 + 16.0 - 4.5**2) / 8.0)
    assert STATUSES[printed.at(record, limit - 1e-9)] == "ok"
    assert STATUSES[printed.at(record, limit + 1e-9)] == "open"
    assert math.isnan(record.row[printed.RESULTS.index("position B x")])
    assert STATUSES[printed.at(record, 2 * math.pi - limit + 0.1)] == "cut off"
    assert STATUSES[printed.at(record, 100.0)] == "outside"
    assert STATUSES[printed.at(record, math.nan)] == "outside"


@pytest.mark.parametrize("length", [0.0, -1.0, math.nan, math.inf])
def test_impossible_dimensions_are_open(length: float) -> None:
    printed = run_python(motion_code("crank-rocker", "python", ["links.AB.length"]))
    assert STATUSES[printed.at(printed.prepare([length]), 1.0)] == "open"


def test_rates_are_those_of_the_drive() -> None:
    printed = run_python(motion_code("crank-rocker", "python", []))
    record = printed.prepare([])
    rows = []
    for speed, acceleration in ((1.0, 0.0), (0.0, 1.0), (3.0, -2.0)):
        printed.at(record, 0.7, speed, acceleration)
        found = dict(zip(printed.RESULTS, record.row, strict=False))
        rows.append((found["angular velocity DB"], found["angular acceleration DB"]))
    (first, second), (still, also_first), (faster, bent) = rows
    assert still == 0.0 and also_first == pytest.approx(first, rel=1e-14)
    assert faster == pytest.approx(3.0 * first, rel=1e-14)
    assert bent == pytest.approx(9.0 * second - 2.0 * first, rel=1e-12)


def test_a_file_of_python_prints_its_own_table(tmp_path: Path) -> None:
    file = tmp_path / "crank.py"
    file.write_text(motion_code("crank-rocker", "python", name="crank"), encoding="utf-8")
    ended = subprocess.run([sys.executable, "-I", str(file)], capture_output=True, text=True, check=True)
    lines = ended.stdout.splitlines()
    assert len(lines) == 362 and lines[0].startswith("drive;status;position O x;") and ";ok;" in lines[1]


ODD = "Кривошип 1'"
HOSTILE = "A\"*/\\ ??/%s'`<!--$x"


@pytest.mark.parametrize("language", LANGUAGES)
def test_hostile_names_are_names(language: str, tmp_path: Path) -> None:
    if PROGRAMS[language] is None:
        pytest.skip(f"{language} is not installed")
    quoted = HOSTILE.replace("\\", "\\\\").replace('"', '\\"')
    mechanism = parse_mechanism(f"""
        title = "{quoted}"
        frame.points = {{ O = [0, 0], D = [4, 0] }}
        links."{ODD}" = {{ points = {{ O = [0, 0], A = [1, 0] }} }}
        links.AB.length = 3.5
        links.DB.length = 3
        drives = [{{ link = "{ODD}", start = 0, speed = 1 }}]
        assembly.sides = {{ B = "left" }}
        """)
    program = traced_program(mechanism, None, name="hostile")
    answers = answers_of(program, language, Places([program.values], np.array([[1.0, 1.0, 0.0]])), tmp_path)
    wanted = ct.motion(mechanism, at=[1.0]).position.values.ravel()
    assert answers.status[0, 0] == 0
    assert np.abs(answers.result[0, 0, : len(wanted)] - wanted).max() < 1e-14 * 4.0


@pytest.mark.parametrize(
    ("name", "language", "vary", "error", "told"),
    [
        ("third-class-triad", "c", None, NotComputedYet, "platform"),
        ("crank-rocker", "fortran", None, InputError, "fortran"),
        ("crank-rocker", "c", ["links.XY.length"], InputError, "XY"),
        ("crank-rocker", "c", ["drives.OA.speed"], InputError, "no dimension"),
    ],
)
def test_what_cannot_be_printed_is_refused_by_name(
    name: str, language: str, vary: list[str] | None, error: type[Exception], told: str
) -> None:
    with pytest.raises(error, match=told):
        motion_code(name, language, vary)


def test_names_are_ones_of_all_languages() -> None:
    assert [program_name(x) for x in ("a/six-bar press.toml", "Привод", "double", "find_root", "x")] == [
        "six_bar_press", "mechanism", "double_motion", "find_root_motion", "mechanism",
    ]  # fmt: skip


@pytest.mark.parametrize(
    "text",
    [
        "x: float = m.a\n    with m: pass",
        "x: float = other(1.0)",
        "for x in m.a:\n        pass",
        "x: float = 1.0\n    for x in range(3):\n        pass",
        "return [1]",
    ],
)
def test_rules_that_are_not_plain_are_refused(text: str, monkeypatch: pytest.MonkeyPatch) -> None:
    module = ModuleType("rules")
    monkeypatch.setattr("inspect.getsource", lambda _module: f"def rule(m: Record) -> float:\n    {text}\n")
    with pytest.raises(SyntaxError):
        translate_rules(module, LANGUAGES["c"], {})
