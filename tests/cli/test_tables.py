"""`--xlsx` and `--decimal-comma` of the commands that write tables."""

from __future__ import annotations

import csv
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

COMMANDS = {
    "run six-bar-press --samples 5 --no-figures": {"motion", "instants", "reactions", "machine"},
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
    tables = {path.stem for path in plain.glob("*.csv")}
    assert COMMANDS[command] <= tables
    for name in tables:
        assert f"{name}.xlsx" in done.out.replace("\n", " ")
        assert (both / f"{name}.xlsx").read_bytes()[:2] == b"PK"
        with (plain / f"{name}.csv").open(encoding="utf-8", newline="") as file:
            expected = list(csv.reader(file))
        with (both / f"{name}.csv").open(encoding="utf-8-sig", newline="") as file:
            found = list(csv.reader(file, delimiter=";"))
        assert [[field.replace(",", ".") for field in row] for row in found] == [
            [field.replace(",", ".") for field in row] for row in expected
        ]
        assert not any("." in field for field in found[-1] if field and field[0] in "0123456789-")


def test_a_command_asked_plainly_writes_plain_tables(centrode: Callable[..., Any], tmp_path: Path) -> None:
    """What one command was asked does not cling to the next."""
    words = ("run", "crank-rocker", "--samples", "3", "--no-figures", "--out", str(tmp_path))
    assert centrode(*words, "--xlsx", "--decimal-comma").code == 0
    (tmp_path / "motion.xlsx").unlink()
    assert centrode(*words).code == 0
    assert not (tmp_path / "motion.xlsx").exists()
    assert b";" not in (tmp_path / "motion.csv").read_bytes()
