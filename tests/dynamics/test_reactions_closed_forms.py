"""Reactions with a closed form, of statics and of a wheel; the six-bar press by its fifteen equations."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

import centrode as ct
from centrode.dynamics.reduction import Reducer
from mechanisms import EPS, link, point
from newton_euler import vector

Array = npt.NDArray[np.float64]
ROUNDINGS = 512
"""Roundings on the way from a description to one force, in units of the greatest force."""


def close(found: Any, wanted: Any, size: float, condition: float = 1.0) -> None:
    assert np.max(abs(np.asarray(found) - np.asarray(wanted))) <= ROUNDINGS * EPS * size * condition


def force(found: xr.Dataset, side: str) -> npt.NDArray[np.complex128]:
    return vector(found.joint_force.sel(side=side))


def test_a_beam_on_two_supports() -> None:
    """A beam of 3 m on a carriage, hinged at one end and on rollers at the other, with 60 N at 1 m."""
    beam = ct.Mechanism(
        frame={"points": {"O": [0, 0]}},
        links={
            "carriage": {"points": {"A": [0, 0]}},
            "beam": {"points": {"A": [0, 0], "P": [1, 0], "B": [3, 0]}},
        },
        guides=[
            {"point": "A", "on": "frame", "through": "O", "direction": [1, 0], "link": "carriage"},
            {"point": "B", "on": "carriage", "through": [0, 0], "direction": [1, 0]},
        ],
        drives=[{"guide": "A", "speed": 1.0}],
        loads=[{"kind": "force", "point": "P", "vector": [0, -60]}],
        assembly={"sides": {"B": "ahead"}},
    )
    found = ct.reactions(beam, 3, 0.0, 1.0)
    close(force(found, "A/beam"), 40j, 60)
    close(found.guide_normal.sel(guide="B"), 20.0, 60)
    close(found.guide_normal.sel(guide="A"), 60.0, 60)
    close(found.guide_moment.sel(guide="A"), 60.0, 60)  # 20 N at 3 m from A
    close(found.balancing, 0.0, 60)


def test_a_slider_crank_under_a_piston_force() -> None:
    r, length, push = 0.1, 0.35, -2000.0
    engine = ct.Mechanism(
        frame={"points": {"O": [0, 0]}},
        links={"OA": {"length": r}, "AB": {"length": length}, "piston": {"points": {"B": [0, 0]}}},
        guides=[{"point": "B", "on": "frame", "through": "O", "direction": [1, 0], "link": "piston"}],
        drives=[{"link": "OA", "speed": 100.0}],
        loads=[{"kind": "force", "guide": "B", "value": push}],
        assembly={"sides": {"B": "ahead"}},
    )
    found = ct.reactions(engine, 73)
    theta = found.drive_value.to_numpy()[:, 0]
    beta = np.arcsin(r / length * np.sin(theta))  # the rod's fall from A to B
    rod = push * (1.0 - 1j * np.tan(beta))  # what the rod passes on to the crank
    size = abs(push) * 1.1
    close(force(found, "A/OA"), rod, size)
    close(force(found, "A/AB"), -rod, size)
    close(force(found, "O/OA"), -rod, size)
    close(force(found, "O/frame"), rod, size)
    close(force(found, "B/piston"), -push * (1.0 - 1j * np.tan(beta)), size)
    close(found.guide_normal.sel(guide="B"), -push * np.tan(beta), size)
    close(found.guide_moment, 0.0, size)
    close(found.balancing[:, 0], push * r * np.sin(theta + beta) / np.cos(beta), size)


def test_a_parallelogram_with_a_weight_on_its_coupler() -> None:
    """The second crank is a bar with two hinges: it bears half the weight along itself."""
    weight, theta = 80.0, np.array([0.5, 1.2, 2.0, 2.9])
    parts: dict[str, Any] = {
        "frame": {"points": {"O": [0, 0], "D": [4, 0]}},
        "links": {
            "OA": {"length": 1},
            "AB": {"points": {"A": [0, 0], "S": [2, 0], "B": [4, 0]}},
            "DB": {"length": 1},
        },
        "drives": [{"link": "OA", "start": 1.0, "speed": 1.0}],
        "assembly": {"sides": {"B": "left"}},
        "gravity": [0, -10],
        "loads": [{"kind": "weight", "point": "S", "value": weight}],
    }
    found = ct.reactions(ct.Mechanism(**parts), at=theta)
    along = weight / (2 * np.sin(theta)) * np.exp(1j * theta)
    steep = 1.0 / np.sin(theta).min()
    close(force(found, "B/AB"), along, weight * steep, steep)
    close(force(found, "A/AB"), 1j * weight - along, weight * steep, steep)
    close(force(found, "D/frame"), -along, weight * steep, steep)
    close(found.balancing[:, 0], weight * np.cos(theta), weight * steep, steep)


def test_a_pair_of_gears() -> None:
    """Wheels of 40 and 20 teeth 0.3 m apart: radii 0.2 and 0.1 m; the bearings bear the force between the teeth."""
    pair = ct.Mechanism(
        frame={"points": {"O": [0, 0], "C": [0.3, 0]}},
        links={"one": {"points": {"O": [0, 0]}}, "two": {"points": {"C": [0, 0]}}},
        gears=[{"links": ["one", "two"], "ratio": -2.0}],
        drives=[{"link": "one", "speed": 1.0}],
        loads=[{"kind": "torque", "link": "two", "value": 7.0}],
    )
    found = ct.reactions(pair, 5)
    # the mesh holds the second wheel with -7 N m; its pitch point lies 0.1 m to the left of C
    close(found.gear_moment[:, 0], [[-14.0, -7.0, 21.0]] * 5, 21)
    close(vector(found.tooth_force.isel(gear=0)), 70j, 70)
    close(found.balancing[:, 0], 14.0, 14)
    close(force(found, "C/two"), -70j, 70)
    close(force(found, "O/one"), 70j, 70)
    close(found.frame_force, 0.0, 70)
    close(found.frame_moment, 7.0 - 7.0, 70)


def test_a_ring_gear_and_one_whose_radii_nothing_tells() -> None:
    """Inside a ring both wheels turn alike; without hinges in the carrier there are only moments."""
    ring = ct.Mechanism(
        frame={"points": {"O": [0, 0], "C": [0.3, 0]}},
        links={"ring": {"points": {"O": [0, 0]}}, "two": {"points": {"C": [0, 0]}}},
        gears=[{"links": ["ring", "two"], "ratio": 3.0}],
        drives=[{"link": "ring", "speed": 1.0}],
        loads=[{"kind": "torque", "link": "two", "value": 6.0}],
    )
    # radii 0.45 and 0.15 m: the pitch point is at x = 0.45
    found = ct.reactions(ring, 3)
    close(vector(found.tooth_force.isel(gear=0)), -40j, 40)
    close(found.balancing[:, 0], -18.0, 18)
    close(force(found, "C/two"), 40j, 40)
    belt = ct.Mechanism(
        frame={"points": {"O": [0, 0]}},
        links={"OA": {"length": 1.0}, "wheel": {"points": {"A": [0, 0]}}},
        gears=[{"links": ["OA", "wheel"], "ratio": 2.0}],
        drives=[{"link": "OA", "speed": 1.0}],
        loads=[{"kind": "torque", "link": "wheel", "value": 6.0}],
    )
    found = ct.reactions(belt, 3)
    assert np.isnan(found.tooth_force).all()
    close(found.gear_moment[:, 0], [[12.0, -6.0, -6.0]] * 3, 12)
    close(found.joint_force, 0.0, 12)


def test_a_wheel_that_is_driven_up_an_incline() -> None:
    weight, radius, slope = 50.0, 0.4, 0.3
    wheel = ct.Mechanism(
        gravity=[0, -10],
        frame={"points": {"O": [0, 0]}},
        links={"wheel": {"points": {"C": [0, 0]}, "mass": 5.0, "inertia": 0.2}},
        rolling=[
            {
                "link": "wheel",
                "centre": "C",
                "radius": radius,
                "along": {"through": [0, 0], "direction": [math.cos(slope), math.sin(slope)]},
            }
        ],
        drives=[{"link": "wheel", "law": "-0.5*t**2"}],
        study={"to": 2.0},
    )
    found = ct.reactions(wheel, 5)
    # rolling forwards, up the incline, with an acceleration of 1 rad/s^2 and 0.4 m/s^2
    normal = weight * math.cos(slope)
    up = weight * math.sin(slope) + 5.0 * radius
    close(found.rolling_normal[:, 0], normal, weight)
    close(found.rolling_tangential[:, 0], up, weight)
    close(vector(found.rolling_force.isel(rolling=0)), (up + 1j * normal) * np.exp(1j * slope), weight)
    close(found.balancing[:, 0], -(0.2 + up * radius), weight)


def test_a_cylinder_that_lifts_a_boom() -> None:
    """A boom of 4 m with 100 N at its end, held by a cylinder from 3 m below its hinge to its middle."""
    boom = ct.Mechanism(
        frame={"points": {"O": [0, 0], "C": [0, -3]}},
        links={"boom": {"points": {"O": [0, 0], "M": [2, 0], "E": [4, 0]}}},
        drives=[{"distance": ["C", "M"], "start": math.sqrt(13.0), "speed": 0.1}],
        loads=[{"kind": "force", "point": "E", "vector": [0, -100]}],
        assembly={"sides": {"M": "left"}},
    )
    found = ct.reactions(boom, at=[math.sqrt(13.0)])
    # moments about O: the cylinder's lever is 6 / sqrt(13) m
    push = 400.0 * math.sqrt(13.0) / 6.0
    way = (2 + 3j) / math.sqrt(13.0)
    close(found.balancing[:, 0], push, push)
    close(force(found, "M/boom"), push * way, push)
    close(force(found, "O/boom"), 100j - push * way, push)
    close(force(found, "C/frame"), -push * way, push)
    close(vector(found.frame_force), -100j, push)


def press_by_fifteen_equations(found: xr.Dataset, motion: xr.Dataset) -> Array:
    """Forces in O, A, B, C, D, H, normal force and moment of the guide, moment of the drive: three equations a link.

    Each force acts on the link that stands first in the joint table, and its reaction on the second.
    """
    joints = {"O": ("OA", None), "A": ("OA", "AB"), "B": ("AB", "CD"), "C": ("CD", None), "D": ("CD", "DH")}
    joints["H"] = ("DH", "slider")
    links = ["OA", "AB", "CD", "DH", "slider"]
    masses = {
        "AB": (9.0, 0.45, "S2"),
        "CD": (16.0, 0.55, "B"),
        "DH": (22.0, 1.61, "S4"),
        "slider": (3.5, 0.0, "H"),
    }
    at = {name: complex(point(motion, name)[0]) for name in motion.point.to_numpy()}
    matrix, right = np.zeros((15, 15)), np.zeros(15)
    for k, (name, pair) in enumerate(joints.items()):
        for sign, body in zip((1.0, -1.0), pair, strict=True):
            if body is not None:
                row = 3 * links.index(body)
                matrix[row, 2 * k] = matrix[row + 1, 2 * k + 1] = sign
                matrix[row + 2, 2 * k : 2 * k + 2] = -sign * at[name].imag, sign * at[name].real
    matrix[13, 12], matrix[14, 12], matrix[14, 13], matrix[2, 14] = 1.0, at["H"].real, 1.0, 1.0
    rate = -65 * 2 * math.pi / 60
    for body, (mass, inertia, centre) in masses.items():
        row = 3 * links.index(body)
        second = rate**2 * complex(point(motion, centre, "acceleration_coefficient")[0])
        turn = rate**2 * float(link(motion, body, "angular_acceleration_coefficient")[0])
        needed = mass * second + 10j * mass
        right[row : row + 2] = needed.real, needed.imag
        right[row + 2] = inertia * turn + (np.conj(at[centre]) * needed).imag
    # the slider moves to the right at 120 deg of a crank that turns backwards: the press resists
    right[12] += 9000.0
    right[14] += 0.0 - at["H"].imag * 9000.0
    return np.asarray(np.linalg.solve(matrix, right), dtype=np.float64)


def test_the_press_by_fifteen_equations() -> None:
    press = ct.example("six-bar-press")
    at = [math.radians(120.0)]
    found, motion = ct.reactions(press, at=at), ct.motion(press, at=at)
    wanted = press_by_fifteen_equations(found, motion)
    sides = ["O/OA", "A/OA", "B/AB", "C/CD", "D/CD"]
    size = float(abs(wanted).max()) * 10.0
    for k, side in enumerate(sides):
        close(force(found, side)[0], wanted[2 * k] + 1j * wanted[2 * k + 1], size)
    # the load acts on the pin H: the slider's side bears it in the fifteen equations, the rod's does not
    close(force(found, "H/DH")[0], wanted[10] + 1j * wanted[11], size)
    close(force(found, "H/slider")[0], -9000.0 - wanted[10] - 1j * wanted[11], size)
    close(found.guide_normal[0, 0], wanted[12], size)
    close(found.guide_moment[0, 0], wanted[13], size)
    close(found.balancing[0, 0], wanted[14], size)


def test_the_mean_of_the_balancing_moment_is_that_of_the_driving_moment() -> None:
    """Over a cycle inertia does no work: what is left balances the loads, as the machine's drive does."""
    press = ct.example("six-bar-press")
    start = math.radians(219.1)
    reducer = Reducer.of(press)
    cuts = np.unique([*np.linspace(start - 2 * np.pi, start, 13), *reducer.jumps(start - 2 * np.pi, start)])
    x, w = np.polynomial.legendre.leggauss(24)
    half, middle = np.diff(cuts) / 2, (cuts[1:] + cuts[:-1]) / 2
    places = (middle[:, None] + half[:, None] * x).ravel()
    found = ct.reactions(press, at=places)
    mean = float(np.sum((half[:, None] * w).ravel() * found.balancing.to_numpy()[:, 0])) / (2 * np.pi)
    assert abs(mean - ct.flywheel(press).driving_moment) <= len(places) * EPS * float(
        abs(found.balancing).max()
    )
