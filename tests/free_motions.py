"""Mechanisms left to themselves whose motion is known: descriptions, and tables of values by codes that share nothing.

The tables stand in tests/reference/dynamics; its README says how they were made.
"""

from __future__ import annotations

import csv
import math
from functools import cache
from pathlib import Path

import numpy as np
import numpy.typing as npt
import scipy.integrate

import centrode as ct
from centrode.model.files import with_values

TABLES = Path(__file__).parent / "reference" / "dynamics"
Array = npt.NDArray[np.float64]

DOUBLE_PENDULUM = """\
gravity = [0, -9.81]
[frame.points]
O = [0, 0]
[links.OA]
length = 1
mass = 1
shape = "rod"
angle = 0.0
[links.AB]
length = 1
mass = 1
shape = "rod"
angle = 0.0
[simulation]
duration = 5
"""

FIVE_BAR = """\
gravity = [0, -9.81]
[frame.points]
A = [0, 0]
E = [0.6, 0]
F = [0.3, 0.95]
[links.AB]
length = 0.25
mass = 0.25
shape = "rod"
[links.BC]
length = 0.5
mass = 0.5
shape = "rod"
[links.DC]
length = 0.45
mass = 0.45
shape = "rod"
[links.ED]
length = 0.3
mass = 0.3
shape = "rod"
[[drives]]
link = "AB"
start = 2.0
[[drives]]
link = "ED"
start = 0.7
[assembly]
sides = { C = "left" }
[[loads]]
kind = "spring"
points = ["C", "F"]
stiffness = 40
free_length = 0.3
[simulation]
duration = 5
"""

FOUR_BAR = """\
gravity = [0, -9.81]
[frame.points]
A = [0, 0]
D = [0.9, 0]
[links.AB]
length = 0.3
mass = 0.3
shape = "rod"
[links.BC]
length = 0.8
mass = 0.8
shape = "rod"
[links.DC]
length = 0.6
mass = 0.6
shape = "rod"
[[drives]]
link = "AB"
start = "60 deg"
[assembly]
sides = { C = "left" }
[[loads]]
kind = "torque"
link = "AB"
value = 0.1
[simulation]
speed = 10
duration = 10
"""

DOUBLE_ROCKER = """\
gravity = [0, -9.81]
[frame.points]
A = [0, 0]
D = [1, 0]
[links.AB]
length = 0.6
mass = 0.6
shape = "rod"
[links.BC]
length = 0.5
mass = 0.5
shape = "rod"
[links.DC]
length = 0.6
mass = 0.6
shape = "rod"
[[drives]]
link = "AB"
start = 1.2
[assembly]
sides = { C = "left" }
[simulation]
duration = 5
"""

CHANGE_POINTS = """\
gravity = [0, -9.81]
[frame.points]
A = [0, 0]
D = [0.6, 0]
[links.AB]
length = 0.3
mass = 0.3
shape = "rod"
[links.BC]
length = 0.8
mass = 0.8
shape = "rod"
[links.DC]
length = 0.5
mass = 0.5
shape = "rod"
[[drives]]
link = "AB"
start = 1.0
speed = 1
[assembly]
sides = { C = "left" }
[simulation]
equations = "multibody"
speed = 6.0
duration = 3.0
"""

SPHERICAL_FOUR_BAR = """\
space = "sphere"
gravity = [0, 0, -9.81]
[frame.points]
A = [1, 0, 0]
D = [0, 1, 0]
Z = [0, 0, 1]
[links.AB]
length = 0.3
reference = ["A", "D"]
mass = 0.5
shape = "arc"
[links.BC]
length = 0.9
mass = 0.8
shape = "arc"
[links.DC]
length = 1.2
reference = ["D", "Z"]
mass = 1.1
shape = "arc"
[[drives]]
link = "AB"
start = 0.5
[assembly]
sides = { C = "left" }
[simulation]
speed = 8.0
duration = 2.0
"""

PENDULUM = """\
gravity = [0, -9.81]
[frame.points]
O = [0, 0]
[links.OA]
length = 1
mass = 1
centre = "A"
inertia = 0
angle = "180 deg"
[simulation]
duration = 10
"""
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


def position_of_squares(loops: int, times: npt.ArrayLike) -> Array:
    """Where their first joint B0 is (times, 2): all uprights turn as one pendulum, whose equation SciPy solves."""
    instants = np.atleast_1d(np.asarray(times, dtype=np.float64))
    inertia, weight = (loops + 1) / 3 + loops, ((loops + 1) / 2 + loops) * 9.81
    angle = scipy.integrate.solve_ivp(
        lambda _t, y: [y[1], weight / inertia * math.sin(y[0])],
        (0.0, float(instants[-1])),
        [0.0, 1.0],
        method="DOP853",
        t_eval=instants,
        rtol=3e-14,
        atol=1e-15,
    ).y[0]
    return np.column_stack([np.sin(angle), np.cos(angle)])


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
