"""Machines whose steady motion is known, or can be integrated."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

import centrode as ct

Array = npt.NDArray[np.float64]

CRANK = """\
[frame.points]
O = [0, 0]
[links.OA]
length = 1
mass = 3
centre = [0, 0]
inertia = 2
[[drives]]
link = "OA"
start = 0.3
speed = {speed}
[[loads]]
kind = "torque"
link = "OA"
value = "{load}"
[machine]
mean_speed = 10
fluctuation = {fluctuation}
"""

ENGINE = """\
title = "Compressor"
gravity = [0, -9.81]
[frame.points]
O = [0, 0]
[links.OA]
length = 0.2
mass = 4
centre = [0.05, 0]
inertia = 0.04
[links.AB]
length = 0.7
mass = 6
centre = [0.3, 0]
inertia = 0.3
[links.piston]
points = {{ B = [0, 0] }}
mass = 5
[[guides]]
point = "B"
through = [0, 0]
direction = [1, 0]
link = "piston"
[[drives]]
link = "OA"
start = 0.4
speed = {speed}
[[loads]]
kind = "force"
point = "B"
vector = [-2000, 0]
while_moving = [1, 0]
{more}
[machine]
mean_speed = 20
{machine}
[assembly]
sides = {{ B = "ahead" }}
"""
STROKE = 0.4

GAS_ENGINE = """\
gravity = [0, -9.81]
[frame.points]
O = [0, 0]
[links.OA]
length = 0.05
[links.AB]
length = 0.2
mass = 0.8
centre = [0.06, 0.01]
inertia = 0.004
[links.piston]
points = ["B"]
mass = 0.6
[[guides]]
point = "B"
on = "frame"
through = [0, 0.004]
direction = [1, 0]
link = "piston"
[[drives]]
link = "OA"
start = 0.2
speed = 100
[[loads]]
kind = "force"
guide = "B"
table = [[0.1, -1000, -4000], [0.2, -900, -500], [0.3, 2500, -200]]
[[loads]]
kind = "torque"
link = "OA"
value = "-40 - 0.1*v"
[machine]
mean_speed = 100
fluctuation = 0.02
shafts = [{ inertia = 0.02 }]
[assembly]
sides = { B = "ahead" }
"""

BACKWARD_ROCKER = """\
gravity = [0, -9.81]
[frame.points]
O = [0, 0]
C = [0.4, 0]
[links.OA]
length = 0.1
mass = 2
centre = [0.03, 0]
inertia = 0.01
[links.AB]
length = 0.4
mass = 3
centre = [0.2, 0.05]
inertia = 0.05
[links.CB]
length = 0.3
mass = 4
centre = [0.1, 0]
inertia = 0.06
[[drives]]
link = "OA"
start = 1
speed = -1
[[loads]]
kind = "torque"
link = "CB"
value = "-5*v"
[machine]
mean_speed = 12
fluctuation = 0.1
[assembly]
sides = { B = "left" }
"""


def crank(load: str, fluctuation: float = 0.1, speed: float = 1.0) -> ct.Mechanism:
    """A crank of inertia 2 kg m^2 about its bearing, resisted by a torque."""
    return ct.parse_mechanism(CRANK.format(load=load, fluctuation=fluctuation, speed=speed))


def engine(machine: str = "fluctuation = 0.05", more: str = "", speed: float = 1.0) -> ct.Mechanism:
    """A central slider-crank that is resisted on the way out only."""
    return ct.parse_mechanism(ENGINE.format(machine=machine, more=more, speed=speed))


def kinetic_energy(mechanism: ct.Mechanism, data: Any) -> Array:
    """Kinetic energy [J] of the links by their real velocities."""
    total = np.zeros(data.sizes["sample"])
    for name, link in mechanism.links.items():
        if link.mass is None:
            continue
        spin = data.angular_velocity.sel(link=name).values
        centre = centre_of(mechanism, data, name)
        start = data.velocity.sel(point=next(iter(link.coordinates))).values
        arm = centre - data.position.sel(point=next(iter(link.coordinates))).values
        velocity = start + spin[:, None] * np.stack([-arm[:, 1], arm[:, 0]], axis=-1)
        total += 0.5 * link.mass * (velocity**2).sum(axis=-1) + 0.5 * (link.inertia or 0.0) * spin**2
    return total


def centre_of(mechanism: ct.Mechanism, data: Any, name: str) -> Array:
    """Places (sample, axis) of the centre of mass of a link."""
    link = mechanism.links[name]
    if isinstance(link.centre, str):
        return np.asarray(data.position.sel(point=link.centre).values)
    first = next(iter(link.coordinates))
    angle = data.angle.sel(link=name).values
    x, y = link.centre or (0.0, 0.0)
    x0, y0 = link.coordinates[first] if not isinstance(link.points, tuple) else (0.0, 0.0)
    turned = np.stack(
        [
            (x - x0) * np.cos(angle) - (y - y0) * np.sin(angle),
            (x - x0) * np.sin(angle) + (y - y0) * np.cos(angle),
        ],
        axis=-1,
    )
    return np.asarray(data.position.sel(point=first).values + turned)
