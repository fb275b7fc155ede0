"""The paper's example: its table, its coefficients, and where the cut series leaves the path."""

from __future__ import annotations

import csv
import math
from pathlib import Path

import mpmath as mp
import numpy as np
import pytest
from tools.validation import cams as validation
from tools.validation.rows import Row

import centrode as ct
from centrode.cams.cam import cam_routes
from centrode.cams.curvature_laws import ExponentialCurvature
from centrode.cams.path_series import SeriesPath, series_path

from .conftest import exponential_path

TABLE = Path(__file__).parents[1] / "reference" / "cam-curvature-table.csv"
ROUNDED = 1 + 1e-9
HALF_UNIT = {"eta": 5e-7, "eta_d1": 5e-7, "eta_d2": 5e-7, "cos_gamma": 5e-7, "K_1_mm": 5e-7, "rho_mm": 5e-4}

with TABLE.open() as stream:
    ROWS = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(stream)]
PHI = np.radians([row["phi_deg"] for row in ROWS])


def computed(path: SeriesPath) -> dict[str, np.ndarray]:
    eta = path.sine(PHI, 2)
    return {
        "eta": eta[0],
        "eta_d1": eta[1],
        "eta_d2": eta[2],
        "cos_gamma": np.cos(path.pressure_angle(PHI)),
        "K_1_mm": path.curvature(PHI)[0] / 1e3,
        "rho_mm": path.radius(PHI)[0] * 1e3,
    }


def worst_in_half_units(path: SeriesPath) -> float:
    found = computed(path)
    return max(
        abs(found[name][k] - row[name]) / half
        for k, row in enumerate(ROWS)
        for name, half in HALF_UNIT.items()
    )


def test_all_nineteen_rows_are_the_series_cut_after_a_20(law: ExponentialCurvature) -> None:
    assert len(ROWS) == 19
    assert worst_in_half_units(series_path(law, 0.05, terms=20)) <= ROUNDED


@pytest.mark.parametrize("terms", [18, 19, 21, 22])
def test_no_other_number_of_terms_gives_the_table(law: ExponentialCurvature, terms: int) -> None:
    assert worst_in_half_units(series_path(law, 0.05, terms=terms)) > 2


def test_printed_coefficients(law: ExponentialCurvature) -> None:
    path = series_path(law, 0.05)
    for found, printed in zip(path.sines, (0.0, 0.5, -0.1875, -0.130208, -0.000977), strict=False):
        assert abs(found - printed) <= 5e-7 * ROUNDED
    for found, printed in zip(path.cosines, (1.0, 0.0, -0.125, 0.093750, 0.039714), strict=False):
        assert abs(found - printed) <= 5e-7 * ROUNDED


@pytest.mark.parametrize("row", validation.true_values(), ids=lambda row: row.symbol)
def test_true_values_at_ninety_degrees(row: Row) -> None:
    assert row.agrees, row


def test_routes_agree_to_a_trillionth() -> None:
    found = cam_routes(ct.example("cam-from-curvature"), at=[math.pi / 2]).isel(sample=0)
    for name in ("path_radius", "pressure_sine", "pressure_sine_slope"):
        steps, integrated = (float(found[name].sel(route=route)) for route in ("steps", "integrated"))
        assert abs(integrated - steps) <= 1e-12 * abs(steps)


def test_steps_agree_with_forty_digits() -> None:
    places = PHI[[3, 9, 14, 18]]
    data = ct.cam(ct.example("cam-from-curvature"), at=places)
    for k, phi in enumerate(places):
        rho, gamma, slope = exponential_path(10.0, 0.75, 0.05, 0.0, phi)
        # seven steps, each of which may leave out 1e-13 of the value
        assert abs(data.path_radius[k] - float(rho)) <= 7e-13 * float(rho)
        assert abs(data.pressure_sine[k] - float(mp.sin(gamma))) <= 7e-13
        assert abs(data.pressure_sine_slope[k] - float(slope)) <= 2 * 7e-13


def test_up_to_sixty_degrees_the_paper_is_right_to_a_micrometre() -> None:
    data = ct.cam(ct.example("cam-from-curvature"), at=PHI)
    apart = np.abs(data.path_radius.to_numpy() * 1e3 - [row["rho_mm"] for row in ROWS])
    printed = HALF_UNIT["rho_mm"]
    assert np.all(apart[math.radians(60.1) >= PHI] <= 1e-3 + printed)
    assert apart[-1] > 0.05


def test_the_series_does_not_even_converge_at_ninety_degrees() -> None:
    """More terms help inside the circle of convergence and harm outside it."""
    example = ct.example("cam-from-curvature")
    at = np.radians([80.0, 90.0])
    true = ct.cam(example, at=at).path_radius.to_numpy()
    law = ExponentialCurvature(10.0, 0.75)
    errors = {n: np.abs(series_path(law, 0.05, terms=n).radius(at)[0] - true) for n in (100, 200, 500)}
    radius = cam_routes(example, at=at).attrs["radius_of_convergence"]
    assert math.radians(87.2) < radius < math.radians(87.4)
    assert errors[100][0] > 1e3 * errors[200][0] > 0
    assert not errors[500][1] < 100 * errors[100][1]  # NaN: beyond |eta| = 1


@pytest.mark.parametrize(
    "row",
    [*validation.laws().rows, *validation.flat_face().rows],
    ids=lambda row: f"{row.quantity} {row.symbol}",
)
def test_printed_numbers_of_plate_cams(row: Row) -> None:
    assert row.agrees, row
