"""`centrode report`: documents that are written, repeated and refused."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from centrode.report import files

Centrode = Callable[..., Any]

QUICK = ("--chapters", "data,structure", "--format", "pdf")


def test_a_report_is_written_and_summed_up(centrode: Centrode, folder: Path) -> None:
    done = centrode("report", "crank-rocker", *QUICK)
    assert (done.code, done.err) == (0, "")
    assert "1  Data\n2  Structure\n" in done.out
    assert done.out.endswith("1 file in crank-rocker-report: report.pdf\n")
    assert (folder / "crank-rocker-report" / "report.pdf").read_bytes().startswith(b"%PDF-")


@pytest.mark.parametrize("language", ["en", "ru", "uk"])
def test_the_bytes_repeat(centrode: Centrode, folder: Path, language: str) -> None:
    for out in ("one", "two"):
        asked = ("--chapters", "data,words,equations", "--lang", language)
        assert centrode("report", "crank-rocker", *asked, "--out", out).code == 0
    for kind in ("html", "pdf"):
        assert (folder / "one" / f"report.{kind}").read_bytes() == (
            folder / "two" / f"report.{kind}"
        ).read_bytes()


def test_tables_repeat_too(centrode: Centrode, folder: Path) -> None:
    for out in ("one", "two"):
        assert centrode("run", "crank-rocker", "--no-figures", "--out", out).code == 0
    assert (folder / "one" / "motion.csv").read_bytes() == (folder / "two" / "motion.csv").read_bytes()


def test_a_chapter_with_nothing_to_tell_was_asked_for(centrode: Centrode, folder: Path) -> None:
    done = centrode("report", "crank-rocker", "--chapters", "data,flywheel", "--format", "pdf", "--out", "x")
    assert done.code == 3
    assert (
        "Error: crank-rocker: 1 chapter could not be made: Flywheel: the description has nothing" in done.err
    )
    assert (folder / "x" / "report.pdf").is_file()


def test_hostile_names_are_shown(centrode: Centrode, folder: Path, four_bar: str) -> None:
    hostile = four_bar.replace('title = "Press"', 'title = "</script> #panic(1) $x$ *b*"')
    hostile = hostile.replace("links.AB", 'links."$A$ #panic(1) <b>"').replace(
        "length = 3.5", 'points = ["A", "B"]\nlength = 3.5'
    )
    (folder / "bad.toml").write_text(hostile)
    done = centrode("report", "bad.toml", "--out", "x")
    assert (done.code, done.err) == (0, ""), done
    assert b"<script> #panic" not in (folder / "x" / "report.html").read_bytes()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--chapters", "date"), 'crank-rocker, chapters: there is no chapter "date"; did you mean "data"?'),
        (("--points", "Q"), 'crank-rocker, points: unknown point "Q"'),
        (("--digits", "1"), "crank-rocker, digits: the number of significant digits is 2 to 12, 1 is given"),
        (("--digits", "many"), "Invalid value for '--digits'"),
        (("--at", "1 kg"), "crank-rocker, --at: "),
        (("--at", "x"), "crank-rocker, --at: "),
        (("--format", "odt"), 'format: "odt" is not a format of a report'),
        (("--format", ","), "format: no format is named"),
        (("--out", "press.toml"), "press.toml"),
    ],
)
def test_wrong_input(
    centrode: Centrode, folder: Path, four_bar: str, arguments: tuple[str, ...], message: str
) -> None:
    (folder / "press.toml").write_text(four_bar)
    before = sorted(folder.iterdir())
    done = centrode("report", "crank-rocker", *arguments)
    assert done.code == 2, done
    assert message in done.err
    assert "Traceback" not in done.err
    assert sorted(folder.iterdir()) == before


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("title = 3", "Error: press.toml"),
        ("kind = 'cam'", "Error: press.toml"),
        (None, "Error: press.toml: there is no such file"),
    ],
)
def test_wrong_files(centrode: Centrode, folder: Path, content: str | None, message: str) -> None:
    if content is not None:
        (folder / "press.toml").write_text(content)
    done = centrode("report", "press.toml", "--out", "x")
    assert done.code == 2
    assert done.err.startswith(message)
    assert not (folder / "x").exists()


def test_an_interrupted_report_leaves_nothing(
    centrode: Centrode, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupted(report: object, name: str) -> dict[str, bytes]:
        raise KeyboardInterrupt

    monkeypatch.setattr(files, "FORMATS", {"pdf": interrupted})
    before = sorted(folder.iterdir())
    done = centrode("report", "crank-rocker", *QUICK)
    assert (done.code, done.err) == (130, "interrupted\n")
    assert sorted(folder.iterdir()) == before


def test_what_stands_in_the_way_is_told_before_anything_is_computed(centrode: Centrode, folder: Path) -> None:
    (folder / "taken").write_text("x")
    done = centrode("report", "crank-rocker", *QUICK, "--out", "taken")
    assert done.code == 2
    assert done.err.startswith("Error: taken is not a folder")
    assert (folder / "taken").read_text() == "x"


def test_the_ending_of_out_names_one_document(centrode: Centrode, folder: Path) -> None:
    chosen = ("report", "crank-rocker", "--chapters", "structure")
    done = centrode(*chosen, "--out", "notes/note.docx")
    assert (done.code, done.err) == (0, "")
    assert done.out.endswith("1 file in notes: note.docx\n")
    assert (folder / "notes" / "note.docx").read_bytes()[:2] == b"PK"
    done = centrode(*chosen, "--out", "notes/note.tex", "--format", "tex")
    assert (done.code, done.out.splitlines()[-2:]) == (
        0,
        ["2 files in notes: note.tex", "note-figures/: 01.pdf"],
    )
    done = centrode(*chosen, "--out", "other.ipynb", "--format", "pdf")
    assert done.code == 2
    assert done.err.startswith("Error: --format: the ending of other.ipynb names another kind of document")
    assert not (folder / "other.ipynb").exists()
