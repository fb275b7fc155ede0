"""The power series of a path as a result: the paper's numbers, and a series in fractions by equation (23)."""

from __future__ import annotations

import csv
import math
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

import centrode as ct
from centrode.views import cam_series as view
from mechanisms import EPS

PAPER = ct.example("cam-from-curvature")
PRINTED = Path(__file__).parents[1] / "reference" / "cam-curvature-table.csv"


def half_unit(text: str) -> float:
    return 0.5 * 10.0 ** -len(text.partition(".")[2])


def test_the_printed_coefficients() -> None:
    found = ct.cam_series(PAPER, 2)
    for name, printed in (
        ("sine_coefficient", "0.0 0.5 -0.1875 -0.130208 -0.000977"),
        ("cosine_coefficient", "1.0 0.0 -0.1250 0.093750 0.039714"),
    ):
        for value, text in zip(found[name].to_numpy(), printed.split(), strict=False):
            assert abs(value - float(text)) <= half_unit(text) * (1 + 1e-9)


def test_the_printed_table() -> None:
    """All 19 rows, with the second derivative of the series cut after a_20."""
    rows = list(csv.DictReader(PRINTED.read_text(encoding="utf-8").splitlines()))
    degrees = [float(row["phi_deg"]) for row in rows]
    found = ct.cam_series(PAPER, at=np.radians(degrees))
    assert found.attrs["terms"] == 20 and len(rows) == 19
    columns = {
        "eta": found.pressure_sine, "eta_d1": found.pressure_sine_slope, "eta_d2": found.pressure_sine_second,
        "cos_gamma": found.pressure_cosine, "K_1_mm": found.law_curvature / 1e3, "rho_mm": found.path_radius * 1e3,
    }  # fmt: skip
    for name, values in columns.items():
        for row, value in zip(rows, values.to_numpy(), strict=True):
            assert abs(value - float(row[name])) <= half_unit(row[name]) * (1 + 1e-6), (name, row["phi_deg"])


def test_the_coefficients_are_those_of_equation_26_in_fractions() -> None:
    """eta'' - k1 eta' + eta + k1 lambda = 0 with lambda^2 + eta^2 = 1, compared power by power."""
    terms, k1 = 24, Fraction(3, 4)
    a, b = [Fraction(0), Fraction(1, 2)], [Fraction(1)]
    for n in range(terms):
        a.append((k1 * ((n + 1) * a[n + 1] - b[n]) - a[n]) / ((n + 1) * (n + 2)))
        squares = sum((a[i] * a[n + 1 - i] for i in range(n + 2)), Fraction(0))
        squares += sum((b[i] * b[n + 1 - i] for i in range(1, n + 1)), Fraction(0))
        b.append(-squares / (2 * b[0]))
    found = ct.cam_series(PAPER, 2, terms=terms)
    for name, exact in (("sine_coefficient", a), ("cosine_coefficient", b)):
        for n, value in enumerate(found[name].to_numpy()):
            # each coefficient is a sum of n products of those before it
            scale = max(abs(float(one)) for one in (a[n], b[n])) or 1.0
            assert abs(value - float(exact[n])) <= 64 * (n + 1) * EPS * scale, (name, n)


@pytest.mark.parametrize("name", ct.example_names("cam"))
def test_any_law_has_a_series(name: str) -> None:
    """At the start the cut series is exact, and near it the path by steps agrees."""
    cam = ct.example(name)
    if not hasattr(cam, "curvature"):
        with pytest.raises(ct.InputError):
            ct.cam_series(cam)
        return
    near = ct.cam_series(cam, at=[0.0, 0.05])
    path = ct.cam(cam, at=[0.0, 0.05])
    for variable in (
        "pressure_sine",
        "pressure_sine_slope",
        "pressure_sine_second",
        "pressure_cosine",
        "path_radius",
    ):
        values, others = near[variable].to_numpy(), path[variable].to_numpy()
        known = np.isfinite(values)
        assert np.allclose(
            values[known], others[known], rtol=1e-9, atol=1e-9 * float(np.nanmax(np.abs(others)))
        )


def test_tables_have_all_digits_and_pages_the_papers_letters() -> None:
    found = ct.cam_series(PAPER, 19)
    tables = ct.tables(found)
    coefficients = {column.name: column.values for column in tables["cam-coefficients"].columns}
    assert np.array_equal(np.asarray(coefficients["sine_coefficient"]), found.sine_coefficient)
    assert "pressure_sine_second" in [column.name for column in tables["cam-series"].columns]
    printed = ct.summary(found)
    assert "η″" in printed or "eta''" in printed
    assert len(view.sheet(ct.cams.series.CamSeriesResults(PAPER, found)).printed) == 2


def test_terms_out_of_bounds_are_refused() -> None:
    with pytest.raises(ct.InputError, match="1 term is given; give 2 to"):
        ct.cam_series(PAPER, terms=1)
    with pytest.raises(ct.InputError, match=r"2\.5 terms are given"):
        ct.cam_series(PAPER, terms=2.5)  # type: ignore[arg-type]
    assert math.isclose(float(ct.cam_series(PAPER, terms=2).sine_coefficient[2]), -0.1875)
