"""Small machines that are simulated in several tests."""

from __future__ import annotations

import math

import centrode as ct

PENDULUM = """\
gravity = [0, -9.81]
[frame.points]
O = [0, 0]
[links.OA]
points = { O = [0, 0], A = [0.7, 0] }
mass = 2
centre = "A"
inertia = 0
[[drives]]
link = "OA"
start = "0 deg"
speed = 1
"""

ROTOR = """\
[frame.points]
O = [0, 0]
[links.OA]
points = { O = [0, 0], A = [0.7, 0] }
inertia = 0.5
[[drives]]
link = "OA"
speed = SENSE
LOADS
"""

SLEDGE = """\
[frame.points]
O = [0, 0]
[links.sledge]
points = { P = [0, 0] }
mass = 2
[[guides]]
name = "rail"
point = "P"
on = "frame"
through = "O"
direction = [1, 0]
link = "sledge"
[[drives]]
guide = "rail"
speed = 1
[[loads]]
kind = "friction"
guide = "rail"
value = 3
LOADS
"""

CRANK_ROCKER = """\
gravity = [0, -9.81]
[frame.points]
O = [0, 0]
D = [4, 0]
[links.OA]
length = 1
mass = 3
shape = "rod"
[links.AB]
length = 3.5
mass = 5
shape = "rod"
[links.DB]
length = CRANK
mass = 4
shape = "rod"
[[drives]]
link = "OA"
start = "20 deg"
speed = 1
[assembly]
sides = { B = "left" }
LOADS
"""

SPHERICAL = """\
space = "sphere"
[frame.points]
A = [1, 0, 0]
D = [0, 1, 0]
Z = [0, 0, 1]
[links.AB]
length = "CRANK rad"
reference = ["A", "D"]
model = "ring and point mass"
centre = "A"
inertia = "1 - cos(CRANK) kg*m^2"
[links.BC]
length = "COUPLER rad"
model = "ring and point mass"
centre = "C"
mass = 1
inertia = "1 - cos(COUPLER) kg*m^2"
[links.DC]
length = "90 deg"
reference = ["D", "Z"]
angle = "PSI rad"
model = "ring and point mass"
centre = "D"
inertia = 1
[[drives]]
link = "AB"
start = 0.0
speed = 1
[assembly]
sides = { C = "left" }
"""
JOINT = """\
[[loads]]
kind = "friction"
name = "friction LINK"
link = "LINK"
relative_to = "BASE"
quadratic = 0.1
form = "plain sum"
"""


def pendulum() -> ct.Mechanism:
    return ct.parse_mechanism(PENDULUM)


def rotor(loads: str = "", sense: float = 1.0) -> ct.Mechanism:
    """A disc of 0.5 kg m^2."""
    return ct.parse_mechanism(ROTOR.replace("LOADS", loads).replace("SENSE", str(sense)))


def sledge(loads: str = "") -> ct.Mechanism:
    """2 kg on a rail, with friction of 3 N."""
    return ct.parse_mechanism(SLEDGE.replace("LOADS", loads))


def crank_rocker(loads: str = "", rocker: float = 3.0) -> ct.Mechanism:
    return ct.parse_mechanism(CRANK_ROCKER.replace("LOADS", loads).replace("CRANK", str(rocker)))


def spherical(crank: float, coupler: float) -> ct.Mechanism:
    """The thesis's crank-rocker with its masses and its friction."""
    psi = math.asin(math.cos(coupler) / math.cos(crank))
    text = SPHERICAL.replace("PSI", repr(psi)).replace("COUPLER", repr(coupler)).replace("CRANK", repr(crank))
    for link, base in (("AB", "frame"), ("BC", "DC"), ("DC", "frame")):
        text += JOINT.replace("LINK", link).replace("BASE", base)
    return ct.parse_mechanism(text)
