"""What a check and a run import: looked up in `sys.modules` of processes of their own."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

OWN_PROBE = """
import json, sys
from centrode.cli.main import main
code = main()
sys.stdout.flush()
there = sorted(name for name, module in sys.modules.items() if module is not None)
print(json.dumps([code, there]), file=sys.__stderr__)
"""
"""As a command of its own process, in which libraries are held back."""
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


def modules_of(*arguments: str, code: int = 0, probe: str = PROBE) -> list[str]:
    """Modules that a command imports."""
    command = [sys.executable, "-c", probe, *arguments]
    done = subprocess.run(command, capture_output=True, encoding="utf-8", check=True)
    ended, modules = json.loads(done.stderr.splitlines()[-1])
    assert ended == code
    return list(modules)


def imported(*arguments: str, code: int = 0) -> set[str]:
    """Packages that a command imports."""
    return {module.split(".")[0] for module in modules_of(*arguments, code=code)}


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


def test_an_animation_of_a_linkage_loads_neither_cams_nor_forces() -> None:
    modules = modules_of("animate", "crank-rocker", "--frames", "2", "--out", "a.gif")
    rooms = {".".join(module.split(".")[:2]) for module in modules}
    assert "centrode.kinematics" in rooms
    assert not rooms & {"centrode.cams", "centrode.dynamics", "centrode.tolerances"}


def test_commands_hold_back_what_labelled_arrays_would_import() -> None:
    """Angles of transmission are a dataset at whose making xarray looks for pint, and for dask."""
    modules = modules_of("angles", "six-bar-press", "--samples", "13", probe=OWN_PROBE)
    packages = {module.split(".")[0] for module in modules}
    assert "xarray" in packages
    assert not packages & {"pint", "dask"}


def test_rare_units_are_let_in_where_they_are_held_back(folder: Path, four_bar: str) -> None:
    (folder / "press.toml").write_text(four_bar.replace("length = 1\n", 'length = "1 yard"\n'))
    modules = modules_of("check", "press.toml", probe=OWN_PROBE)
    assert "pint" in {module.split(".")[0] for module in modules}
