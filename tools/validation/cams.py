"""The printed table of a cam with an exponential law of curvature."""

from __future__ import annotations

import math

import numpy as np

import centrode as ct
from centrode.cams.curvature_laws import ExponentialCurvature
from centrode.cams.series import series_path
from tools.validation.rows import Column, Row, Source, column, printed

UNITS = {"eta": 5e-7, "eta_d1": 5e-7, "eta_d2": 5e-7, "cos_gamma": 5e-7, "K_1_mm": 5e-7, "rho_mm": 5e-4}
TERMS = 20


def paper() -> Source:
    """The paper's nineteen rows, by its own series cut after a_20."""
    table = printed("cam-curvature-table.csv")
    phi = np.radians(column(table, "phi_deg"))
    path = series_path(ExponentialCurvature(10.0, 0.75), 0.05, terms=TERMS)
    eta = path.sine(phi, 2)
    found = {
        "eta": eta[0],
        "eta_d1": eta[1],
        "eta_d2": eta[2],
        "cos_gamma": np.cos(path.pressure_angle(phi)),
        "K_1_mm": path.curvature(phi)[0] / 1e3,
        "rho_mm": path.radius(phi)[0] * 1e3,
    }
    return Source(
        "Cam from a curvature law",
        f"A paper on a cam and its walking wheel: the series cut after a_{TERMS}, which is what its table shows "
        "(`cam-from-curvature`). Beyond 60 deg the cut series leaves the true path (see [errata](errata.md)); the true "
        "values stand below.",
        columns=tuple(
            Column(name, column(table, name), UNITS[name], values) for name, values in found.items()
        ),
        rows=true_values(),
    )


def true_values() -> tuple[Row, ...]:
    """At 90 deg, by an integration to high order made outside this project."""
    row = ct.cam(ct.example("cam-from-curvature"), at=[math.pi / 2]).isel(sample=0)
    return (
        Row("true path radius at 90 deg", "rho", "mm", 60.132, 0.5e-3, float(row.path_radius) * 1e3),
        Row("true sine of the pressure angle", "eta", "1", -0.159650, 0.5e-6, float(row.pressure_sine)),
        Row("its derivative", "eta'", "1", -0.966032, 0.5e-6, float(row.pressure_sine_slope)),
    )
