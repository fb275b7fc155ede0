"""Printed positions, velocities and analogs: the assignment, the excerpt, the coursework."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache

import numpy as np
import xarray as xr

import centrode as ct
from tools.validation.rows import Array, Column, Row, Source, column, printed

THOUSANDTH = 0.5e-3


def assignment() -> Source:
    """A course assignment: fifty rows of a slider between two cranks."""
    table = printed("planar-slider-rocker-table.csv")
    data = ct.motion(ct.example("slider-between-cranks"), len(table), start=0.0, stop=49 * 2 * np.pi / 100)
    of: dict[str, Array] = {}
    for letter, name in (("2", "AC"), ("3", "CB"), ("4", "BD")):
        of[f"phi{letter}_rad"] = data.angle.sel(link=name).to_numpy()
        of[f"omega{letter}_rad_s"] = data.angular_velocity.sel(link=name).to_numpy()
    of["v_C_m_s"] = data.velocity.sel(point="C", axis="x").to_numpy()
    columns = [Column("t_s", column(table, "t_s"), 0.5e-6, data.time.to_numpy())]
    columns += [Column(name, column(table, name), THOUSANDTH, found) for name, found in of.items()]
    return Source(
        "Slider between two cranks",
        "A course assignment on the kinematics of planar motion, worked example: a table by RK4 in MathCAD. Here by "
        "closed forms (`slider-between-cranks`).",
        columns=tuple(columns),
    )


def excerpt() -> Source:
    """Two pages of a teaching text: sixteen rows of a four-bar."""
    table = printed("four-bar-table.csv")
    data = ct.motion(ct.example("four-bar-excerpt-printed"), len(table), start=0.0, stop=1.8)
    columns = [Column("t_s", column(table, "t_s"), 0.5e-2, data.time.to_numpy())]
    for name, letter in (("OA", "phi1_rad"), ("DB", "phi2_rad"), ("BA", "phi3_rad")):
        columns.append(
            Column(letter, column(table, letter), THOUSANDTH, data.angle.sel(link=name).to_numpy())
        )
    return Source(
        "Four-bar linkage of an excerpt",
        "Two pages of a teaching text, with a printed MathCAD program (`four-bar-excerpt-printed`; the data it names "
        "are `four-bar-excerpt`, see [errata](errata.md)).",
        columns=tuple(columns),
    )


KINEMATIC = (
    "crank angle", "position", "distance", "angle", "velocity analog", "angular velocity analog",
    "acceleration analog", "angular acceleration analog",
)  # fmt: skip


def coursework() -> Source:
    """A coursework: positions and analogs of a six-bar press with the crank at 120 deg."""
    rows = [row for row in printed("six-bar-printed-values.csv") if row["quantity"] in KINEMATIC]
    return Source(
        "Six-bar press: positions and analogs",
        "A coursework in the theory of mechanisms and machines (a MathCAD sheet), crank at 120 deg. Analogs are "
        "derivatives by the crank's own angle (`six-bar-press`).",
        rows=tuple(
            Row(
                row["quantity"], row["symbol"], row["unit"], float(row["printed"]), float(row["half_unit"]),
                press_value(row["quantity"], row["symbol"]),
            )
            for row in rows
        ),
    )  # fmt: skip


@cache
def press() -> xr.Dataset:
    """The press at the printed instant; its crank turns at -1 rad/s, so that rates are the sheet's analogs."""
    return ct.motion(ct.example("six-bar-press"), at=[math.radians(120.0)])


ORDERS = {"velocity analog": "velocity", "acceleration analog": "acceleration"}
LINKS = {"phi1": "OA", "phi2": "AB", "phi3": "CD", "phi4": "DH"}
RATES = {"angular velocity analog": "angular_velocity", "angular acceleration analog": "angular_acceleration"}


def press_value(quantity: str, symbol: str) -> float:
    """A printed quantity as the motion gives it; angles in degrees, that of DH from H to D."""
    data = press()
    if symbol in TRIANGLES:
        return TRIANGLES[symbol](*(_place(name) for name in ("A", "B", "C", "D", "H")))
    if symbol[0] in "XY":
        axis = "x" if symbol[0] == "X" else "y"
        name = ORDERS.get(quantity, "position")
        return float(data[name].sel(point=symbol[1:], axis=axis)[0])
    if quantity in RATES:
        return float(data[RATES[quantity]].sel(link=LINKS[symbol])[0])
    degrees = math.degrees(float(data.angle.sel(link=LINKS[symbol])[0]))
    return degrees + 180.0 if symbol == "phi4" else degrees


def _place(name: str) -> complex:
    x, y = press().position.sel(point=name).to_numpy()[0]
    return complex(x, y)


TRIANGLES: dict[str, Callable[..., float]] = {
    "l_AC": lambda a, b, c, d, h: float(abs(a - c)),
    "delta1": lambda a, b, c, d, h: 180.0 - math.degrees(np.angle(a - c)),
    "delta2": lambda a, b, c, d, h: math.degrees(np.angle((a - c) / (b - c))),
    "delta3": lambda a, b, c, d, h: 180.0 - math.degrees(np.angle(d - h)),
}
"""The sheet's auxiliary quantities: the length AC, angles at C to it, the slope of DH."""
