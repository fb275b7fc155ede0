"""The script of the thesis's figures draws what the thesis states of them."""

from __future__ import annotations

import importlib.util
import math
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

SCRIPT = Path(__file__).parents[2] / "tools" / "thesis_figures.py"


@pytest.fixture(scope="module")
def script() -> ModuleType:
    spec = importlib.util.spec_from_file_location("thesis_figures", SCRIPT)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_there_are_eight(script: ModuleType) -> None:
    assert [row[0] for row in script.FIGURES] == list(range(1, 9))


@pytest.mark.parametrize(("number", "least", "most"), [(5, 2.478, 3.631), (8, 5.062, 6.532)])
def test_curves(script: ModuleType, number: int, least: float, most: float) -> None:
    _number, crank, whole, moment, alpha = script.FIGURES[number - 1]
    found = script.curves(crank, whole - crank, moment, alpha)
    turns = found["beta"] / math.tau
    steady = turns > turns[-1] - 2.0
    # half a unit of the last digit, and what an extreme may lose between two samples of its parabola
    step = float(np.abs(np.diff(found["speed"][steady], 2)).max())
    assert abs(found["speed"][steady].min() - least) <= 0.5e-3 + step / 8
    assert abs(found["speed"][steady].max() - most) <= 0.5e-3 + step / 8
    assert math.isclose(
        found["gamma"][0], math.asin(math.sin(crank) / math.sin(whole - crank)), rel_tol=1e-14
    )
    at = found["beta"] % math.tau
    width = float(np.diff(found["beta"]).max())
    assert abs(at[steady][found["psi"][steady].argmin()] - math.pi / 2) <= width
    assert abs(at[steady][found["psi"][steady].argmax()] - 3 * math.pi / 2) <= width
    assert len(script.figure("", found).axes) == 6
