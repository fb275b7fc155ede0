"""What the commands print in Russian and Ukrainian: no English left but names, units and numbers."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import centrode as ct
from centrode import render
from centrode.cli import output
from centrode.dynamics import motion_results
from centrode.kinematics.solve import Solved, solve
from samples import examples_at_hand

Centrode = Callable[..., Any]
LANGUAGES = ("ru", "uk")
NOT_WORDS = {
    "centrode", "rad", "deg", "mm", "m", "s", "I", "II", "III", "IV",
    "loads", "machine", "instants", "motion", "coefficients", "csv", "nc", "summary", "json", "toml", "TOML", "NAME",
    "run", "examples",
    "from", "to", "samples", "out", "study", "drives", "frame", "e", "r",
}  # fmt: skip
EXAMPLES = (
    "slider-between-cranks",
    "scotch-yoke",
    "kite",
    "two-link-arm",
    "three-crank-parallelogram",
    "wiper",
    "third-class-triad",
    "planetary-gear-train",
    "rolling-wheel-rod",
    "scissor-lift-cylinder",
    "spherical-crank-guide",
)


@pytest.fixture(scope="module")
def solved() -> dict[tuple[str, bytes], Solved]:
    """Motions by the description and the samples."""
    return {}


@pytest.fixture
def solved_once(solved: dict[tuple[str, bytes], Solved], monkeypatch: pytest.MonkeyPatch) -> None:
    """Each motion is solved for the first language only: places and statuses are numbers, and words come after them."""

    def look_up(ready: Any, span: Any) -> Solved:
        key = ct.mechanism_text(ready.mechanism), span.parameter.tobytes()
        if key not in solved:
            solved[key] = solve(ready, span)
        return solved[key]

    monkeypatch.setattr(motion_results, "solve", look_up)


def latin_words(text: str, mechanism: ct.Mechanism) -> set[str]:
    """Latin words of a text that name no link, point, guide or drive."""
    names = " ".join([*mechanism.links, *mechanism.points, *(guide.id for guide in mechanism.guides)])
    return set(re.findall(r"[A-Za-z]+", text)) - NOT_WORDS - set(re.findall(r"[A-Za-z]+", names))


@pytest.mark.usefixtures("solved_once")
@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize("name", examples_at_hand(EXAMPLES))
def test_runs_and_checks_speak_one_language(centrode: Centrode, name: str, language: str) -> None:
    mechanism = ct.example(name)
    for arguments in (["check", name], ["run", name, "--out", "r", "--no-figures", "--samples", "9"]):
        done = centrode(*arguments, "--lang", language)
        assert done.code == 0
        assert latin_words(done.out, mechanism) == set()


@pytest.mark.parametrize("language", LANGUAGES)
def test_a_mechanism_that_locks(centrode: Centrode, language: str) -> None:
    name = "slider-between-cranks-locked"
    done = centrode("run", name, "--out", "r", "--no-figures", "--lang", language)
    assert done.code == 3
    assert done.err.startswith({"ru": "Ошибка: ", "uk": "Помилка: "}[language])
    told = done.out + done.err
    for word in (
        name,
        'range = "reachable"',
        "[study]",
        "--range reachable",
        "centrode rotatability",
    ):  # what is to be typed
        assert word in told
        told = told.replace(word, "")
    assert latin_words(told, ct.example(name)) == set()


@pytest.mark.parametrize("language", LANGUAGES)
def test_tables_stay_in_english_for_programs(centrode: Centrode, folder: Path, language: str) -> None:
    def written(language: str) -> list[bytes]:
        name = "slider-between-cranks-locked"
        centrode("run", name, "--out", language, "--no-figures", "--lang", language)
        return [(folder / language / name).read_bytes() for name in ("motion.csv", "summary.json")]

    assert written(language) == written("en")


@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("length = 1\n", "length = -1\n"),
        ("length = 1\n", "lenght = 1\n"),
        ("length = 1\n", 'length = "0.5 kg"\n'),
        ("length = 3.5", "length = 0.5"),
        ("length = 3.5\n", "length = 3.5\nangle = 2\n"),
        ("length = 1\n", "length = nan\n"),
        ("[[drives]]", "[links.EF]\nlength = 1\n[[drives]]"),
        ("[assembly]", '[[drives]]\nlink = "DB"\nspeed = 1\n[assembly]'),
        ("[assembly]", "[study]\nsamples = 1000000000\n[assembly]"),
        ('sides = { B = "left" }', ""),
        ("speed = 1", 'speed = "1 kg"'),
        ("speed = 1", 'law = "1/t"'),
        ("speed = 1", 'law = "sin(t"'),
    ],
)
def test_refusals_speak_one_language(
    centrode: Centrode, folder: Path, four_bar: str, language: str, old: str, new: str
) -> None:
    (folder / "press.toml").write_text(four_bar.replace(old, new, 1))
    done = centrode("run", "press.toml", "--out", "r", "--no-figures", "--lang", language)
    assert done.code == 2
    told = re.sub(r'"[^"]*"|\[\[?[\w. ]+\]\]?( \w+,?)?( \w+)?|press\.toml', "", done.err)
    words = latin_words(told, ct.example("kite")) - {"length", "angle", "speed", "sides", "B", "O", "D", "EF"}
    assert not any(len(word) > 3 for word in words), words


def test_columns_stand_in_line(centrode: Centrode) -> None:
    for language in ("en", *LANGUAGES):
        out = centrode("check", "slider-between-cranks", "--lang", language).out
        rows = out.splitlines()[2:]
        column = re.search(r"(?<=  )\S", rows[0])
        assert column is not None
        assert all(row[: column.start()].endswith("  ") for row in rows)
        assert all(row[column.start()] != " " for row in rows)


def test_letters_with_marks_and_wide_letters_keep_the_columns() -> None:
    text = render.aligned_text([("e\u0301", "1"), ("漢", "2"), ("ab", "3")])
    assert text.splitlines() == ["e\u0301   1", "漢  2", "ab  3"]


def test_long_lists_are_broken_between_names() -> None:
    names = [f"name-{i}" for i in range(30)]
    lines = output.paragraph("30 files in a-b:", names).splitlines()
    assert lines[0] == "30 files in a-b:"
    assert all(line.startswith("  name-") and len(line) <= output.WIDTH for line in lines[1:])
    assert "".join(lines[1:]).replace(" ", "").split(",") == names
    assert output.paragraph("2 files in r:", names[:2]) == "2 files in r: name-0, name-1"
