"""The printed table of a cam with an exponential law of curvature."""

from __future__ import annotations

import math

import numpy as np

import centrode as ct
from centrode.cams.curvature_laws import ExponentialCurvature
from centrode.cams.followers.motion import peaks_of
from centrode.cams.path_series import series_path
from centrode.laws import LawSegment, SegmentedLaw
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


PEAKS = {
    "harmonic": ("1.571", "4.935", "15.50"),
    "cycloidal": ("2.000", "6.283", "39.48"),
    "3-4-5": ("1.875", "5.773", "60.0"),
    "4-5-6-7": ("2.188", "7.513", "52.5"),
    "modified sine": ("1.760", "5.528", "69.47"),
    "modified trapezoid": ("2.000", "4.888", "61.43"),
}
"""Greatest velocity, acceleration and jerk of a rise of 1 over an angle of 1, as the handbook prints them."""
CUT = ("3-4-5", 1)
"""10/sqrt 3 = 5.7735 is printed 5.773: cut, not rounded."""


def laws() -> Source:
    """Peak coefficients of motion laws."""
    rows = []
    for name, told in PEAKS.items():
        found = peaks_of(SegmentedLaw((LawSegment(1.0, 1.0, name),))).coefficients
        for order, (text, value) in enumerate(zip(told, found, strict=False)):
            digit = 10.0 ** -len(text.partition(".")[2])
            half = digit if (name, order) == CUT else 0.5 * digit
            symbol = ("C_v", "C_a", "C_j")[order]
            rows.append(Row(f"peak coefficient, {name}", symbol, "1", float(text), half, value))
    return Source(
        "Motion laws of followers",
        "R. L. Norton, Cam Design and Manufacturing Handbook (2009), chapters 2 and 3. The acceleration of 3-4-5, "
        "10/sqrt 3 = 5.7735, is printed cut: there a whole unit of the last digit is allowed.",
        rows=tuple(rows),
    )


def flat_face() -> Source:
    """The worked cam with a flat face: cycloidal rise 1, dwell, fall 1, dwell, 90 degrees each."""
    cam = ct.parse_cam(FLAT)
    assert isinstance(cam, ct.PlateCam)
    found = ct.follower_cam(cam)
    return Source(
        "Plate cam under a flat face",
        "Cycloidal rise of 1, dwell, fall, dwell, 90 deg each, least radius of curvature 0.25.",
        rows=(
            Row("base radius", "R_0", "", 1.893, 0.5e-3, found.base_radius),
            Row("face width", "b", "", 2.546, 0.5e-3, found.face.greatest - found.face.least),
        ),
    )


FLAT = """
kind = "cam"
[cam]
[follower]
kind = "translating"
contact = "flat"
[bounds]
curvature_radius = 0.25
""" + "".join(
    f"[[segments]]\nangle = \"90 deg\"\n{line}\n"
    for line in (
        'to = 1\ncurve = "cycloidal"', 'curve = "dwell"', 'to = 0\ncurve = "cycloidal"', 'curve = "dwell"',
    )
)  # fmt: skip
