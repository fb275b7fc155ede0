"""The numbers that the source documents print, all of them, through the built-in examples."""

from __future__ import annotations

import csv
from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import centrode as ct
from mechanisms import EPS, Array, link, point, statuses

REFERENCE = Path(__file__).parents[1] / "reference"
ROUNDED = 1 + 1e-9
"""A printed value is one of its decimals off by half a unit at most; the decimal fraction itself is not exact."""


def rows(name: str) -> list[dict[str, str]]:
    with (REFERENCE / name).open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def agrees(computed: Array, printed: Array, half_unit: float) -> None:
    worst = float(np.max(np.abs(computed - printed)))
    assert worst <= half_unit * ROUNDED, f"{worst} off, half a unit is {half_unit}"


@cache
def worked_mechanism() -> xr.Dataset:
    """The assignment's motion at the printed times: steps of 2 pi/100, of which the source prints fifty."""
    return ct.motion(ct.example("slider-between-cranks"), 50, start=0.0, stop=49 * 2 * np.pi / 100)


WORKED_COLUMNS: dict[str, Callable[[xr.Dataset], Array]] = {
    "phi2_rad": lambda data: link(data, "AC"),
    "phi3_rad": lambda data: link(data, "CB"),
    "phi4_rad": lambda data: link(data, "BD"),
    "omega2_rad_s": lambda data: link(data, "AC", "angular_velocity"),
    "omega3_rad_s": lambda data: link(data, "CB", "angular_velocity"),
    "omega4_rad_s": lambda data: link(data, "BD", "angular_velocity"),
    "v_C_m_s": lambda data: point(data, "C", "velocity").real,
}


def test_times_of_the_assignments_table() -> None:
    printed = np.array([float(row["t_s"]) for row in rows("planar-slider-rocker-table.csv")])
    assert len(printed) == 50
    agrees(worked_mechanism().time.to_numpy(), printed, 0.5e-6)


@pytest.mark.parametrize("column", WORKED_COLUMNS)
def test_assignments_table(column: str) -> None:
    printed = np.array([float(row[column]) for row in rows("planar-slider-rocker-table.csv")])
    agrees(WORKED_COLUMNS[column](worked_mechanism()), printed, 0.5e-3)


def test_assignments_last_row_repeats_the_first() -> None:
    data = ct.motion(ct.example("slider-between-cranks"), 101)
    assert set(statuses(data)) == {"ok"}
    for name in ("AC", "CB", "BD"):
        angle = link(data, name)
        # the drive's last value is 2 pi rounded: half a unit of it turns into position errors of the same order
        assert abs(angle[-1] - angle[0]) <= 16 * EPS * 2 * np.pi


def test_excerpts_table() -> None:
    table = rows("four-bar-table.csv")
    data = ct.motion(ct.example("four-bar-excerpt-printed"), 16, start=0.0, stop=1.8)
    agrees(data.time.to_numpy(), np.array([float(row["t_s"]) for row in table]), 0.5e-2)
    for name, column in (("OA", "phi1_rad"), ("DB", "phi2_rad"), ("BA", "phi3_rad")):
        agrees(link(data, name), np.array([float(row[column]) for row in table]), 0.5e-3)


@cache
def press() -> xr.Dataset:
    """The coursework's mechanism at its instant, crank at 120 deg."""
    angle = np.radians(120.0)
    return ct.motion(ct.example("six-bar-press"), 1, start=angle, stop=angle)


def press_value(quantity: str, symbol: str) -> float:
    """A printed quantity as the motion gives it: analogs are derivatives at -1 rad/s, angles in degrees."""
    data = press()
    order = {"velocity analog": 1, "acceleration analog": 2}.get(quantity, 0)
    if symbol[0] in "XY" and len(symbol) <= 3:
        z = point(data, symbol[1:], ("position", "velocity", "acceleration")[order])[0]
        return float(z.real if symbol[0] == "X" else z.imag)
    name = {"phi1": "OA", "phi2": "AB", "phi3": "CD", "phi4": "DH"}[symbol]
    if quantity == "angular velocity analog":
        return float(link(data, name, "angular_velocity")[0])
    if quantity == "angular acceleration analog":
        return float(link(data, name, "angular_acceleration")[0])
    degrees = np.degrees(link(data, name)[0])
    return float(degrees + 180.0 if symbol == "phi4" else degrees)


def triangle_value(symbol: str) -> float:
    """The sheet's auxiliary quantities, from the positions: AC, the angles at C to it, the slope of DH."""
    data = press()
    a, b, c, d, h = (point(data, name)[0] for name in ("A", "B", "C", "D", "H"))
    if symbol == "l_AC":
        return float(abs(a - c))
    if symbol == "delta1":
        return float(180.0 - np.degrees(np.angle(a - c)))
    if symbol == "delta2":
        return float(np.degrees(np.angle((a - c) / (b - c))))
    return float(np.degrees(np.angle(d - h)) * -1.0 + 180.0)


KINEMATIC = ("crank angle", "position", "distance", "angle", "velocity analog", "angular velocity analog",
             "acceleration analog", "angular acceleration analog")  # fmt: skip
PRESS_ROWS = [row for row in rows("six-bar-printed-values.csv") if row["quantity"] in KINEMATIC]


@pytest.mark.parametrize("row", PRESS_ROWS, ids=lambda row: f"{row['quantity']} {row['symbol']}")
def test_courseworks_numbers(row: dict[str, str]) -> None:
    derived = row["symbol"].startswith("delta") or row["symbol"] == "l_AC"
    found = triangle_value(row["symbol"]) if derived else press_value(row["quantity"], row["symbol"])
    assert abs(found - float(row["printed"])) <= float(row["half_unit"]) * ROUNDED


def test_all_kinematic_rows_of_the_coursework_are_there() -> None:
    assert len(PRESS_ROWS) == 47
