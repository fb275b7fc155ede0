"""Mechanisms left to themselves whose motion is known: their descriptions, and tables of values.

They stand in tests/reference/dynamics; its README says how they were made.
"""

from __future__ import annotations

import csv
from functools import cache
from pathlib import Path

import numpy as np
import numpy.typing as npt

import centrode as ct
from centrode.model.files import with_values

TABLES = Path(__file__).parent / "reference" / "dynamics"
Array = npt.NDArray[np.float64]


def description(name: str) -> str:
    """The text of a mechanism that is left to itself."""
    return (TABLES / f"{name}.toml").read_text(encoding="utf-8")


DOUBLE_PENDULUM = description("double-pendulum")
FIVE_BAR = description("five-bar")
FOUR_BAR = description("four-bar-reactions")
DOUBLE_ROCKER = description("through-limits")
CHANGE_POINTS = description("change-points")
SPHERICAL_FOUR_BAR = description("spherical-four-bar-free")
PENDULUM = description("pendulum")
"""IFToMM's A01: a mass in one point on a massless bar, left from the horizontal."""


def squares(loops: int, *, speed: float = 1.0) -> str:
    """IFToMM's A02: loops of uniform bars of 1 m and 1 kg side by side, upright, the first joint at a speed."""
    names = [f"A{k} = [{k}, 0]" for k in range(loops + 1)]
    text = "gravity = [0, -9.81]\n[frame.points]\n" + "\n".join(names) + "\n"
    bar = 'length = 1\nmass = 1\nshape = "rod"\n'
    for k in range(loops + 1):
        text += f'[links.A{k}B{k}]\n{bar}angle = "90 deg"\n'
    for k in range(loops):
        text += f"[links.B{k}B{k + 1}]\n{bar}angle = 0\n"
    return f"{text}[simulation]\nduration = 20\n[simulation.speeds]\npoints.B0 = [{speed}, 0]\n"


def squeezer(start: float = -0.0617138900142764496358948458001) -> ct.Mechanism:
    """Andrews' mechanism with its spring and torque: the built-in geometry; its crank starts at an angle."""
    geometry = ct.example("andrews-squeezer")
    text = (
        ct.mechanism_text(geometry)
        + """
[[loads]]
kind = "spring"
points = ["D", "C"]
stiffness = 4530
free_length = 0.07785
[[loads]]
kind = "torque"
link = "OF"
value = 0.033
[simulation]
equations = "multibody"
duration = 0.05
"""
    )
    placed = ct.motion(geometry, at=[start])
    angles = {name: float(placed.angle.sel(link=name)[0]) for name in geometry.links if name != "OF"}
    values = {f"links.{name}.angle": angle for name, angle in angles.items()}
    return with_values(ct.parse_mechanism(text), {"drives.OF.start": start, **values})


@cache
def table(name: str) -> dict[str, Array]:
    """Columns of a reference table by their heads."""
    with (TABLES / f"{name}.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    return {head: np.array([float(row[head]) for row in rows]) for head in rows[0]}
