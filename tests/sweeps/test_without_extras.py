"""Where llvmlite and zarr are missing: the leg `make tests-without-extras`, in which they cannot be imported."""

from __future__ import annotations

import importlib
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import centrode as ct
from centrode.numerics import executors, machine_code
from centrode.numerics.expressions import variable
from centrode.numerics.scans import Scan

WITHOUT = os.environ.get("CENTRODE_WITHOUT", "").split()
pytestmark = pytest.mark.skipif(not WITHOUT, reason="of the leg `make tests-without-extras`")
LENGTHS = {"links.AB.length": np.linspace(3.4, 3.6, 300)}
"""So many mechanisms that machine code would be worth it."""


def test_they_are_missing() -> None:
    """Else all of this leg would pass and say nothing."""
    assert {"llvmlite", "zarr"} <= set(WITHOUT)
    assert not machine_code.PRESENT
    for name in WITHOUT:
        with pytest.raises(ImportError):
            importlib.import_module(name)
        assert subprocess.run(
            [sys.executable, "-c", f"import {name}"], capture_output=True, check=False
        ).returncode


def test_scans_run_on_numpy() -> None:
    double = Scan(("x",), (), {"twice": variable("x") * 2.0})
    assert executors.choose_executor("auto") == "arrays"
    assert executors.runner(double)([[1.0, 4.0]], None).outputs.tolist() == [[[2.0, 8.0]]]
    with pytest.raises(ImportError):
        executors.runner(double, "machine code")


def test_sweeps_say_why_arrays_compute_them() -> None:
    found = ct.sweep(ct.example("crank-rocker"), LENGTHS, "position.B", 91, reduce="range")
    assert found.attrs["executor"] == "arrays (llvmlite is not installed)"
    assert (found["samples_ok"] == 91).all()
    with pytest.raises(ct.InputError, match="llvmlite is not installed"):
        ct.sweep(ct.example("crank-rocker"), LENGTHS, "position.B", 91, executor="machine code")


def test_gradients_are_computed_by_numpy() -> None:
    def mean(length: float) -> float:
        given = {"links.AB.length": [length]}
        return float(
            ct.sweep(ct.example("crank-rocker"), given, "position.B", 37, reduce="mean")["position.B"][0, 0]
        )

    given = {"links.AB.length": [3.5]}
    found = ct.sweep(ct.example("crank-rocker"), given, "position.B", 37, reduce="mean", gradient=True)
    step = 1e-4  # a central difference: error by its third derivative, and by rounding over the step
    slope = (mean(3.5 + step) - mean(3.5 - step)) / (2.0 * step)
    assert abs(float(found["gradient.position.B"][0, 0, 0]) - slope) <= 100.0 * step**2


def test_motions_of_many_mechanisms() -> None:
    many = ct.motion(ct.example("crank-rocker"), 145, vary=LENGTHS)
    one = ct.motion(ct.example("crank-rocker"), 145, vary={"links.AB.length": LENGTHS["links.AB.length"][:1]})
    np.testing.assert_array_equal(many["position"][:1], one["position"])


def test_a_store_needs_its_library(tmp_path: Path) -> None:
    with pytest.raises(ct.InputError, match="a store needs zarr, which is not installed"):
        ct.sweep(ct.example("crank-rocker"), LENGTHS, "position.B", 7, store=tmp_path / "all.zarr")


STUDY = """
mechanism = "crank-rocker"
outputs = ["position.B"]
reduce = "range"
executor = "{executor}"
[grid]
links.AB.length = {{ from = 3.4, to = 3.6, count = 3 }}
"""


@pytest.mark.parametrize(
    ("executor", "target", "code", "told"),
    [
        ("auto", "all.csv", 0, "mechanisms"),
        ("auto", "all.zarr", 2, "a store needs zarr, which is not installed"),
        ("machine code", "all.csv", 2, "llvmlite is not installed"),
    ],
)
def test_commands(tmp_path: Path, executor: str, target: str, code: int, told: str) -> None:
    study = tmp_path / "study.toml"
    study.write_text(STUDY.format(executor=executor), encoding="utf-8")
    done = subprocess.run(
        [sys.executable, "-m", "centrode", "sweep", str(study), "--out", str(tmp_path / target)],
        capture_output=True, encoding="utf-8", check=False, env={**os.environ, "LANGUAGE": "en"},
    )  # fmt: skip
    assert done.returncode == code, done.stderr
    assert told in done.stdout + done.stderr
    assert "Traceback" not in done.stderr
