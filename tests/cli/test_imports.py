"""What a check and a run import: looked up in `sys.modules` of processes of their own."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

PROBE = """
import json, sys
from centrode.cli.main import main
code = main(sys.argv[1:])
sys.stdout.flush()
print(json.dumps([code, sorted(sys.modules)]), file=sys.__stderr__)
"""
DRAWING = {"matplotlib", "PIL"}
SYMBOLS = {"sympy", "mpmath"}
LABELS = {"xarray", "pandas", "scipy"}


def imported(*arguments: str, code: int = 0) -> set[str]:
    """Packages that a command imports."""
    probe = [sys.executable, "-c", PROBE, *arguments]
    done = subprocess.run(probe, capture_output=True, encoding="utf-8", check=True)
    ended, modules = json.loads(done.stderr.splitlines()[-1])
    assert ended == code
    return {module.split(".")[0] for module in modules}


def test_a_check_needs_arrays_and_no_more(folder: Path, four_bar: str) -> None:
    (folder / "press.toml").write_text(four_bar.replace("start = 1", 'start = "57.3 deg"'))
    for mechanism in ("slider-between-cranks", "press.toml"):
        assert not imported("check", mechanism) & (DRAWING | SYMBOLS | LABELS | {"pint"})


def test_rare_units_ask_for_pint(folder: Path, four_bar: str) -> None:
    (folder / "press.toml").write_text(four_bar.replace("length = 1\n", 'length = "1 yard"\n'))
    assert "pint" in imported("check", "press.toml")


def test_a_run_without_figures_draws_nothing() -> None:
    modules = imported("run", "kite", "--out", "r", "--no-figures", "--samples", "3")
    assert not modules & (DRAWING | SYMBOLS | {"pint"})
    assert {"numpy", "xarray"} <= modules


@pytest.mark.parametrize(
    "arguments",
    [
        ["run", "nowhere.toml"],
        ["run", "nowhere"],
        ["check", "nowhere"],
    ],
)
def test_a_missing_mechanism_is_told_without_arrays(arguments: list[str]) -> None:
    assert not imported(*arguments, code=2) & (DRAWING | SYMBOLS | LABELS | {"pint"})
