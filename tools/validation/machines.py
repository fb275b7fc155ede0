"""Printed flywheels and speeds: the coursework's machine, the thesis's spherical crank-rocker."""

from __future__ import annotations

import math
from functools import cache

import numpy as np
import xarray as xr

import centrode as ct
from centrode.dynamics.simulation.steady_state import steady_regime
from centrode.dynamics.steady_motion.flywheel import Flywheel
from tools.thesis_figures import ALPHA, mechanism
from tools.validation.kinematics import KINEMATIC
from tools.validation.rows import Row, Source, printed

AT = math.radians(120.0)
"""The coursework's crank angle: 99.1 deg of its own angle, which is what has been turned since the beginning."""
POINTS = {"velocity": "velocity", "acceleration": "acceleration"}
LENGTHS = {"speed": "velocity", "acceleration magnitude": "acceleration"}
TURNING = {
    "omega2": ("angular_velocity", "AB"), "omega4": ("angular_velocity", "DH"),
    "eps2": ("angular_acceleration", "AB"), "eps4": ("angular_acceleration", "DH"),
}  # fmt: skip


def coursework() -> Source:
    """The coursework's reduction, flywheel and real motion, with the slips of its reduced inertia."""
    rows = [row for row in printed("six-bar-printed-values.csv") if row["quantity"] not in KINEMATIC]
    return Source(
        "Six-bar press: reduction, flywheel, real motion",
        "The same coursework, n = 65 rpm, coefficient of speed fluctuation 0.11. `six-bar-press-printed` repeats its "
        "slips (see [errata](errata.md)); half a unit of `T1_max` is 0.1 J, for the sheet integrates coarsely.",
        rows=tuple(
            Row(
                row["quantity"], row["symbol"], row["unit"], float(row["printed"]), float(row["half_unit"]),
                machine_value(row["quantity"], row["symbol"]),
            )
            for row in rows
        ),
    )  # fmt: skip


@cache
def flywheel() -> Flywheel:
    """The printed machine's flywheel."""
    return ct.flywheel(ct.example("six-bar-press-printed"))


@cache
def moving() -> xr.Dataset:
    """The printed machine's real motion at the printed instant, by the source's first-order formula."""
    return ct.steady_motion(ct.example("six-bar-press-printed"), at=["99.1 deg"], method="first-order")


def machine_value(quantity: str, symbol: str) -> float:
    """A printed quantity as it is computed."""
    data = moving()
    if quantity in POINTS:
        place = data[POINTS[quantity]].sel(point=symbol[1:], axis="x" if symbol[0] == "X" else "y")
        return float(place[0])
    if quantity in LENGTHS:
        return float(np.hypot(*data[LENGTHS[quantity]].sel(point=symbol).to_numpy()[0]))
    if symbol in TURNING:
        name, link = TURNING[symbol]
        return float(data[name].sel(link=link)[0])
    if quantity.partition(" ")[0] in ("rim", "disc"):
        return _size(quantity, symbol)
    return _scalar(symbol)


def _size(quantity: str, symbol: str) -> float:
    """A size of the wheel by the source's own formulas."""
    found = flywheel()
    made = found.source_rim if quantity.startswith("rim") else found.source_disc
    assert made is not None
    return {"D2": made.outer, "D": made.outer, "D1": made.inner, "b": made.width, "m": made.mass}[symbol]


def _scalar(symbol: str) -> float:
    found, data = flywheel(), moving()
    assert found.inertia_first_order is not None
    assert found.added_first_order is not None
    speed = float(data["drive_speed_first_order"][0])
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
        "d_omega": speed - found.mean_speed,
        "omega": speed,
        "epsilon": float(data["drive_acceleration_first_order"][0]),
        "J_fly": found.added_first_order,
    }[symbol]


STEADY = (
    # crank, coupler, moment, and the regime's least, greatest and mean speed (None: not told)
    (math.pi / 12, math.pi / 3 - math.pi / 12, 1.0, (2.478, 3.631, 2.940)),
    (math.pi / 13, math.pi / 2 - math.pi / 13, 3.5, (5.062, 6.532, None)),
)


def thesis() -> Source:
    """Steady speeds of a thesis's spherical crank-rocker, with its plain sum of friction."""
    rows = []
    for crank, coupler, moment, told in STEADY:
        regime = steady_regime(mechanism(crank, coupler, ALPHA), ct.Simulation(driving=repr(moment)))
        found = (regime.least_speed, regime.greatest_speed, regime.mean_speed)
        for name, printed_value, value in zip(("least", "greatest", "mean"), told, found, strict=True):
            if printed_value is not None:
                quantity = f"{name} speed, AB = pi/{round(math.pi / crank)}, M = {moment:g}"
                rows.append(Row(quantity, "beta'", "rad/s", printed_value, 0.5e-3, value))
    return Source(
        "Spherical crank-rocker",
        "A bachelor's thesis on the motion of a spherical crank-rocker. It prints pictures; these speeds were "
        "recomputed from its corrected equations by another program (`spherical-crank-rocker`).",
        rows=tuple(rows),
    )
