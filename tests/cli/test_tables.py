"""`--xlsx` and `--decimal-comma` of the commands that write tables."""

from __future__ import annotations

import csv
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import openpyxl
import pytest

COMMANDS = {
    "run six-bar-press --samples 5 --no-figures": {
        "motion",
        "instants",
        "reactions/reactions",
        "flywheel/machine",
    },
    "reactions six-bar-press --samples 5 --no-figures": {"reactions", "joints"},
    "reduce six-bar-press --samples 5 --no-figures": {"reduction"},
    "integrate slider-between-cranks --no-figures": {"integration"},
    "cam cam-from-curvature --samples 5 --no-figures": {"cam-path", "cam-routes"},
}


@pytest.mark.parametrize("command", COMMANDS)
def test_tables_as_workbooks_and_with_commas(
    command: str, centrode: Callable[..., Any], tmp_path: Path
) -> None:
    plain, both = tmp_path / "plain", tmp_path / "both"
    assert centrode(*command.split(), "--out", str(plain)).code == 0
    done = centrode(*command.split(), "--out", str(both), "--xlsx", "--decimal-comma")
    assert done.code == 0
    tables = {path.relative_to(plain).with_suffix("").as_posix() for path in plain.rglob("*.csv")}
    assert COMMANDS[command] <= tables
    for name in tables:
        assert f"{name.rpartition('/')[2]}.xlsx" in done.out.replace("\n", " ")
        assert (both / f"{name}.xlsx").read_bytes()[:2] == b"PK"
        with (plain / f"{name}.csv").open(encoding="utf-8", newline="") as file:
            expected = list(csv.reader(file))
        with (both / f"{name}.csv").open(encoding="utf-8-sig", newline="") as file:
            found = list(csv.reader(file, delimiter=";"))
        assert [[field.replace(",", ".") for field in row] for row in found] == [
            [field.replace(",", ".") for field in row] for row in expected
        ]
        assert not any("." in field for field in found[-1] if field and field[0] in "0123456789-")


STUDY = """\
mechanism = "crank-rocker"
outputs = ["position.B", "angle.DB"]
samples = 5
reduce = "range"
[grid]
links.AB.length = ["3.2 m", "3.4 m"]
"""
SINGLE = {"limits kite": {"table"}, "sweep study.toml": {"position", "angle"}}
"""Commands that write one table -> the sheets of its workbook."""
SIXTEEN_DIGITS = 5e-16 + 2.0**-53
"""Of a workbook's number: half a unit of the last that begins with 1, and the rounding of what is read, relatively."""


@pytest.mark.parametrize("command", SINGLE)
def test_single_tables_with_commas_and_as_workbooks(
    command: str, centrode: Callable[..., Any], folder: Path
) -> None:
    (folder / "study.toml").write_text(STUDY, encoding="utf-8")
    assert centrode(*command.split(), "--out", "plain.csv").code == 0
    done = centrode(*command.split(), "--out", "both.csv", "--xlsx", "--decimal-comma")
    assert (done.code, done.err) == (0, "")
    assert done.out.endswith("\nwrote both.csv, both.xlsx\n")
    with Path("plain.csv").open(encoding="utf-8", newline="") as file:
        headers, *expected = csv.reader(file)
    with Path("both.csv").open(encoding="utf-8-sig", newline="") as file:
        commas = list(csv.reader(file, delimiter=";"))
    assert commas[0] == headers
    assert [[field.replace(",", ".") for field in row] for row in commas[1:]] == expected
    book = openpyxl.load_workbook("both.xlsx")
    assert set(book.sheetnames) == SINGLE[command]
    for sheet in book:
        head, *rows = sheet.iter_rows(values_only=True)
        assert head[0] == headers[0]  # what a row is about is told on each sheet
        for row, told in zip(rows, expected, strict=True):
            for header, value in zip(head, row, strict=True):
                field = told[headers.index(str(header))]
                if isinstance(value, float | int):
                    assert abs(value - float(field)) <= SIXTEEN_DIGITS * abs(float(field))
                else:
                    assert (value or "") == field


def test_a_workbook_that_stands_there_is_kept(centrode: Callable[..., Any], folder: Path) -> None:
    (folder / "a.xlsx").write_text("mine", encoding="utf-8")
    done = centrode("limits", "kite", "--out", "a.csv", "--xlsx")
    assert (done.code, done.err) == (2, "Error: a.xlsx: exists already; add --force to replace it\n")
    assert [file.name for file in folder.iterdir()] == ["a.xlsx"]
    assert (folder / "a.xlsx").read_text(encoding="utf-8") == "mine"
    assert centrode("limits", "kite", "--out", "a.csv", "--xlsx", "--force").code == 0
    assert (folder / "a.xlsx").read_bytes()[:2] == b"PK"


@pytest.mark.parametrize("option", ["--xlsx", "--decimal-comma"])
@pytest.mark.parametrize(
    "words", ["limits kite", "limits kite --out a.json", "sweep study.toml", "sweep study.toml --out a.zarr"]
)
def test_no_table_to_spell(words: str, option: str, centrode: Callable[..., Any], folder: Path) -> None:
    (folder / "study.toml").write_text(STUDY, encoding="utf-8")
    done = centrode(*words.split(), option)
    assert (done.code, done.out) == (2, "")
    assert done.err == (f"Error: {option}: no table is written; name a file .csv with --out, or omit it\n")
    assert [file.name for file in folder.iterdir()] == ["study.toml"]


@pytest.mark.parametrize("words", [["run", "kite", "--out", "a"], ["limits", "kite", "--out", "a.csv"]])
def test_workbooks_without_what_writes_them(words: list[str], tmp_path: Path) -> None:
    """A process of its own, since libraries stay loaded."""
    code = (
        "import sys; sys.modules['xlsxwriter'] = None\n"
        f"from centrode.cli.main import main; sys.exit(main({[*words, '--xlsx']!r}))"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=False,
        encoding="utf-8", env={**os.environ, "LANGUAGE": "en"},
    )  # fmt: skip
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == (
        "Error: workbooks need XlsxWriter, which is not installed;"
        ' install the extra tables: pip install -e ".[tables]" in the folder with the source files,'
        " or use the CSV files\n"
    )
    assert list(tmp_path.iterdir()) == []


def test_a_command_asked_plainly_writes_plain_tables(centrode: Callable[..., Any], tmp_path: Path) -> None:
    """What one command was asked does not cling to the next."""
    words = ("run", "crank-rocker", "--samples", "3", "--no-figures", "--out", str(tmp_path))
    assert centrode(*words, "--xlsx", "--decimal-comma").code == 0
    (tmp_path / "motion.xlsx").unlink()
    assert centrode(*words).code == 0
    assert not (tmp_path / "motion.xlsx").exists()
    assert b";" not in (tmp_path / "motion.csv").read_bytes()


def test_a_name_that_reads_like_a_number_keeps_its_point(
    centrode: Callable[..., Any], folder: Path, four_bar: str
) -> None:
    """The crank is called 2.50; its length is another matter."""
    crank = four_bar.replace("[links.OA]", '[links."2.50"]\npoints = ["O", "A"]').replace('"OA"', '"2.50"')
    (folder / "numbered.toml").write_text(crank, encoding="utf-8")
    done = centrode("centres", "numbered.toml", "--decimal-comma", "--out", "r")
    assert done.code == 0, done.err
    head, first, *_rows = (folder / "r" / "centres.csv").read_text(encoding="utf-8-sig").splitlines()
    fields = dict(zip(head.split(";"), first.split(";"), strict=True))
    assert fields["first"] == "2.50"
