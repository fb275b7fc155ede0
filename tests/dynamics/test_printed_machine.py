"""The coursework's flywheel and real motion: all of its printed numbers, and the right ones beside them."""

from __future__ import annotations

import csv
from functools import cache
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import centrode as ct

REFERENCE = Path(__file__).parents[1] / "reference" / "six-bar-printed-values.csv"
ROUNDED = 1 + 1e-9
AT = np.radians(120.0)
"""Its crank angle: phi = 99.1 deg of its own angle, which is what has been turned since the beginning."""

POINTS = {"velocity": "velocity", "acceleration": "acceleration"}
LENGTHS = {"speed": "velocity", "acceleration magnitude": "acceleration"}
TURNING = {
    ("angular velocity", "omega2"): ("angular_velocity", "AB"),
    ("angular velocity", "omega4"): ("angular_velocity", "DH"),
    ("angular acceleration", "eps2"): ("angular_acceleration", "AB"),
    ("angular acceleration", "eps4"): ("angular_acceleration", "DH"),
}
FOUND = {
    "J2", "M_r", "A_c", "M_d", "omega1_mean", "T1_max", "T1_min", "dT1", "J1", "d_omega", "omega", "epsilon", "J_fly",
    "D2", "D1", "b", "m", "D",
}  # fmt: skip


def rows() -> list[dict[str, str]]:
    with REFERENCE.open(encoding="utf-8", newline="") as file:
        return [row for row in csv.DictReader(file) if belongs(row)]


def belongs(row: dict[str, str]) -> bool:
    if row["quantity"] in LENGTHS or (row["quantity"], row["symbol"]) in TURNING:
        return True
    return row["quantity"] in POINTS or row["symbol"] in FOUND


@cache
def printed() -> ct.Flywheel:
    return ct.flywheel(ct.example("six-bar-press-printed"))


@cache
def moving() -> xr.Dataset:
    return ct.steady_motion(ct.example("six-bar-press-printed"), at=[AT], method="first-order")


def value(quantity: str, symbol: str) -> float:
    """A printed quantity as it is computed; angular ones by phi, which runs against the angle of the crank's link."""
    data, found = moving(), printed()
    if quantity in POINTS:
        place = data[POINTS[quantity]].sel(point=symbol[1:], axis="x" if symbol[0] == "X" else "y")
        return float(place[0])
    if quantity in LENGTHS:
        return float(np.hypot(*data[LENGTHS[quantity]].sel(point=symbol).values[0]))
    if (quantity, symbol) in TURNING:
        name, link = TURNING[quantity, symbol]
        return float(data[name].sel(link=link)[0])
    assert found.source_rim is not None
    assert found.source_disc is not None
    made = found.source_rim if quantity.startswith("rim") else found.source_disc
    if quantity.partition(" ")[0] in ("rim", "disc"):
        return {"D2": made.outer, "D": made.outer, "D1": made.inner, "b": made.width, "m": made.mass}[symbol]
    assert found.inertia_first_order is not None
    assert found.added_first_order is not None
    return {
        "J2": float(data["inertia_of_links"][0]),
        "M_r": float(data["moment_of_loads"][0]),
        "A_c": found.work_of_loads,
        "M_d": found.driving_moment,
        "omega1_mean": found.mean_speed,
        "T1_max": found.energy_greatest,
        "T1_min": found.energy_least,
        "dT1": found.energy_greatest - found.energy_least,
        "J1": found.inertia_first_order,
        "d_omega": float(data["drive_speed_first_order"][0]) - found.mean_speed,
        "omega": float(data["drive_speed_first_order"][0]),
        "epsilon": float(data["drive_acceleration_first_order"][0]),
        "J_fly": found.added_first_order,
    }[symbol]


@pytest.mark.parametrize("row", rows(), ids=lambda row: f"{row['quantity']} {row['symbol']}")
def test_the_printed_numbers(row: dict[str, str]) -> None:
    assert (
        abs(value(row["quantity"], row["symbol"]) - float(row["printed"]))
        <= float(row["half_unit"]) * ROUNDED
    )


def test_all_rows_of_the_dynamics_are_there() -> None:
    assert len(rows()) == 101 - 47


def test_the_right_numbers() -> None:
    """With m3 and the slider: J_II = 15.457, J_I = 1462.0, epsilon = -2.768, T1_max by exact integration."""
    assert abs(printed().energy_greatest - 599.813) <= 0.0005
    right = ct.example("six-bar-press")
    found, data = ct.flywheel(right), ct.steady_motion(right, at=[AT], method="first-order")
    assert abs(float(data["inertia_of_links"][0]) - 15.457) <= 0.0005
    assert found.inertia_first_order is not None
    assert abs(found.inertia_first_order - 1462.0) <= 0.05
    assert abs(float(data["drive_acceleration_first_order"][0]) + 2.768) <= 0.0005
    assert found.rim is not None
    assert abs(found.rim.outer - 1.744) <= 0.001
    assert abs(found.rim.mass - 2340) <= 3


def test_the_exact_speed_differs_by_the_second_order() -> None:
    """What the first-order formula leaves out: squares of the fluctuation, and the energy of the links."""
    mechanism = ct.example("six-bar-press")
    data = ct.steady_motion(mechanism, 181)
    apart = np.abs(data["drive_speed"] - data["drive_speed_first_order"]).max()
    links = float(data["inertia_of_links"].max()) / data.attrs["inertia"]
    assert 0.0 < apart <= 6.807 * (0.11**2 / 2 + 0.11 * links)
