"""Mechanisms with random masses and loads, and their kinetic energy and power straight from a motion."""

from __future__ import annotations

import copy
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

import centrode as ct
from tools.campaigns.columns import link, point, slide

Array = npt.NDArray[np.float64]
Parts = dict[str, Any]
GRAVITY = (1.3, -9.7)


def burdened(parts: Parts, seed: int) -> Parts:
    """The description with a mass on most links and a load of every kind, drawn at random."""
    random = np.random.default_rng(seed)
    parts = copy.deepcopy(parts)
    for number, body in enumerate(parts["links"].values()):
        if number and random.random() < 0.3:
            continue
        body |= {
            "mass": float(random.uniform(0.5, 5.0)),
            "centre": random.uniform(-1.0, 1.0, 2).tolist(),
            "inertia": float(random.uniform(0.1, 2.0)),
        }
    points = [name for body in parts["links"].values() for name in body["points"]]
    moving = [name for name in dict.fromkeys(points) if name not in parts["frame"]["points"]]
    links = list(parts["links"])

    def some(names: list[str]) -> str:
        return str(random.choice(names))

    pair = random.choice([*moving, *parts["frame"]["points"]], 2, replace=False).tolist()
    other = [name for name in ["frame", *links] if name != links[0]]
    parts["loads"] = [
        {"kind": "force", "point": some(moving), "vector": random.uniform(-5.0, 5.0, 2).tolist()},
        {"kind": "force", "point": some(moving), "vector": [0.7, -1.1], "axes": some(links)},
        {"kind": "force", "point": some(moving), "vector": ["2*x - 0.3*v", "-0.4*v*abs(v) + sin(q)*t"]},
        {"kind": "force", "point": some(moving), "vector": [3.0, -2.0], "while_moving": [0.6, 0.8]},
        {"kind": "torque", "link": links[0], "value": "0.2*x - 0.1*v", "relative_to": some(other)},
        {"kind": "spring", "points": pair, "stiffness": 40.0, "free_length": 0.7},
        {"kind": "damper", "points": pair, "damping": 3.0},
        {"kind": "spring", "link": some(links), "stiffness": 2.0, "free_angle": 0.4},
        {"kind": "damper", "link": links[0], "damping": 0.8, "relative_to": some(other)},
        {"kind": "friction", "link": links[0], "relative_to": some(other), "value": 0.6, "quadratic": 0.1},
        {"kind": "weight", "point": some(moving), "value": 6.0},
        *[
            load
            for guide in parts["guides"][:1]
            for load in (
                {"kind": "force", "guide": guide["name"], "value": "1.5 - 0.5*x + 0.2*v"},
                {"kind": "friction", "guide": guide["name"], "value": 1.1, "viscous": 0.3},
            )
        ],
    ]
    parts["gravity"] = list(GRAVITY)
    return parts


def velocity_of_centre(mechanism: ct.Mechanism, data: xr.Dataset, name: str) -> Array:
    """Velocity of a link's centre of mass as complex numbers, by Euler's theorem from its first point."""
    body = mechanism.links[name]
    (first, local), *_more = body.coordinates.items()
    assert isinstance(body.centre, tuple)
    reach = complex(body.centre[0] - local[0], body.centre[1] - local[1])
    turn = np.exp(1j * link(data, name))
    omega = link(data, name, "angular_velocity")
    return np.asarray(point(data, first, "velocity") + 1j * omega * turn * reach)


def inertia_of(body: Any) -> float:
    """Moment of inertia of a link of the plane about its centre of mass [kg m^2]."""
    return float(body.inertia or 0.0)


def kinetic_energy(mechanism: ct.Mechanism, data: xr.Dataset) -> dict[str, Array]:
    """Kinetic energy of each link that has mass [J]."""
    found = {}
    for name, body in mechanism.links.items():
        if body.mass:
            speed = abs(velocity_of_centre(mechanism, data, name))
            omega = link(data, name, "angular_velocity")
            found[name] = 0.5 * body.mass * speed**2 + 0.5 * inertia_of(body) * omega**2
    return found


def powers(mechanism: ct.Mechanism, data: xr.Dataset) -> list[Array]:
    """Power of each load of the description, then of the weights of all links [W]."""
    with np.errstate(invalid="ignore"):  # samples that the mechanism does not reach
        found = [_power(load, data) for load in mechanism.loads]
    down = complex(*GRAVITY)
    for name, body in mechanism.links.items():
        if body.mass:
            found.append(dot(float(body.mass) * down, velocity_of_centre(mechanism, data, name)))
    return found


def dot(force: Any, velocity: Array) -> Array:
    """Scalar product of plane vectors as complex numbers."""
    return np.asarray((np.conj(force) * velocity).real)


def _power(load: Any, data: xr.Dataset) -> Array:
    if load.kind == "weight":
        unit = complex(*GRAVITY) / abs(complex(*GRAVITY))
        return dot(float(load.value) * unit, point(data, load.point, "velocity"))
    if hasattr(load, "guide"):
        x, v = slide(data, load.guide), slide(data, load.guide, "slide_velocity")
        if load.kind == "friction":
            return np.asarray(-1.1 * abs(v) - 0.3 * v**2)
        return np.asarray((1.5 - 0.5 * x + 0.2 * v) * v)
    if load.kind == "force":
        return _power_of_force(load, data)
    if hasattr(load, "points"):
        return _power_between(load, data)
    base = 0.0 if load.relative_to == "frame" else link(data, load.relative_to)
    slow = 0.0 if load.relative_to == "frame" else link(data, load.relative_to, "angular_velocity")
    x, v = link(data, load.link) - base, link(data, load.link, "angular_velocity") - slow
    moment = {
        "torque": 0.2 * x - 0.1 * v,
        "spring": -2.0 * (x - 0.4),
        "damper": -0.8 * v,
        "friction": -0.6 * np.sign(v) - 0.1 * v * abs(v),
    }[load.kind]
    return np.asarray(moment * v)


def _power_of_force(load: Any, data: xr.Dataset) -> Array:
    z, velocity = point(data, load.point), point(data, load.point, "velocity")
    q, t = data.drive_value.isel(drive=0).to_numpy(), data.time.to_numpy()
    if isinstance(load.vector[0], str):
        x, u, v = z.real, velocity.real, velocity.imag
        return np.asarray((2 * x - 0.3 * u) * u + (-0.4 * v * abs(v) + np.sin(q) * t) * v)
    force = complex(*load.vector)
    if load.while_moving is not None:
        return np.where(dot(complex(*load.while_moving), velocity) >= 0.0, dot(force, velocity), 0.0)
    turn = 1.0 if load.axes == "frame" else np.exp(1j * link(data, load.axes))
    return dot(force * turn, velocity)


def _power_between(load: Any, data: xr.Dataset) -> Array:
    first, second = load.points
    apart = point(data, second) - point(data, first)
    speed = dot(apart / abs(apart), point(data, second, "velocity") - point(data, first, "velocity"))
    pull = -40.0 * (abs(apart) - 0.7) if load.kind == "spring" else -3.0 * speed
    return np.asarray(pull * speed)
