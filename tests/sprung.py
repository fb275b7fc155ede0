"""Mechanisms under springs and weights, for the tests of equilibria and modes."""

from __future__ import annotations

from typing import Any

import centrode as ct
from free_motions import FIVE_BAR

SPRUNG_FOUR_BAR = """\
gravity = [0, -9.81]
[frame.points]
A = [0, 0]
D = [0.9, 0]
F = [1.3, 1.1]
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
start = 1.0
[assembly]
sides = { C = "left" }
[[loads]]
name = "S"
kind = "spring"
points = ["C", "F"]
stiffness = 60
free_length = 0.3
[[loads]]
name = "C"
kind = "damper"
link = "DC"
damping = 0.05
"""
"""The four-bar of tests/reference/dynamics/README.md: rods of 1 kg/m, a spring and a damper."""

SPHERE = """\
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
[[loads]]
kind = "spring"
link = "AB"
relative_to = "frame"
axis = "A"
stiffness = 8
free_angle = 0.7
[[loads]]
kind = "damper"
link = "DC"
relative_to = "frame"
axis = "D"
damping = 0.3
"""

SLIDER = """\
gravity = [0, -9.81]
[frame.points]
A = [0, 0]
F = [1.4, 0.2]
[links.AB]
length = 0.2
mass = 0.4
shape = "rod"
[links.BC]
length = 0.5
mass = 0.7
shape = "rod"
[[guides]]
point = "C"
through = [0, 0.05]
direction = 0.2
[[drives]]
link = "AB"
start = 0.8
[assembly]
sides = { C = "ahead" }
[[loads]]
kind = "spring"
points = ["C", "F"]
stiffness = 50
free_length = 0.2
[[loads]]
kind = "torque"
link = "AB"
value = "0.4*sin(x) - 0.1*v"
"""


def five_bar() -> ct.Mechanism:
    """The five-bar of the reference, with two degrees of freedom."""
    return ct.parse_mechanism(FIVE_BAR)


def sprung_four_bar(**changes: Any) -> ct.Mechanism:
    """The four-bar with a spring and a damper."""
    return ct.parse_mechanism(SPRUNG_FOUR_BAR).model_copy(update=changes)


def pendulum(**loads: Any) -> ct.Mechanism:
    """A rod of 1 m and 1 kg that hangs in O, from the horizontal."""
    return ct.Mechanism(
        gravity=[0, -9.81],
        frame={"points": {"O": [0, 0]}},
        links={"OA": {"length": 1, "mass": 1, "shape": "rod", "angle": 0}},
        **loads,
    )
