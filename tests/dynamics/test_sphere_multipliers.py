"""Rigid spherical bodies with multipliers, put together anew, against the reduction to one drive."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import pi
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

import centrode as ct
from centrode.dynamics.reduction import Reducer
from mechanisms import EPS
from spherical_bodies import drawn, place, rotation

Array = npt.NDArray[np.float64]


def friction(link: str, other: str, **amount: Any) -> dict[str, Any]:
    return {"kind": "friction", "link": link, "relative_to": other} | amount


@dataclass
class Bodies:
    """Rigid bodies about one centre with hinges, at one instant: velocities and accelerations by multipliers."""

    names: list[str]
    tensors: dict[str, Array]
    hinges: list[tuple[str, str, Array]] = field(default_factory=list)

    def rows(self) -> Array:
        """Two constraints a hinge: no relative turning square to its axis."""
        found = []
        for one, other, axis in self.hinges:
            for across in self.across(axis):
                row = np.zeros(3 * len(self.names))
                self._add(row, one, across)
                self._add(row, other, -across)
                found.append(row)
        return np.array(found)

    @staticmethod
    def across(axis: Array) -> tuple[Array, Array]:
        away = np.eye(3)[int(np.argmin(abs(axis)))]
        first = np.cross(axis, away)
        first /= np.linalg.norm(first)
        return first, np.cross(axis, first)

    def _add(self, row: Array, name: str, vector: Array) -> None:
        if name != "frame":
            k = 3 * self.names.index(name)
            row[k : k + 3] += vector

    def spins(self, drive: str, axis: Array, rate: float) -> dict[str, Array]:
        driven = np.zeros(3 * len(self.names))
        self._add(driven, drive, axis)
        matrix = np.vstack([self.rows(), driven])
        found = np.linalg.solve(matrix, np.append(np.zeros(len(matrix) - 1), rate))
        return {name: found[3 * k : 3 * k + 3] for k, name in enumerate(self.names)} | {"frame": np.zeros(3)}

    def accelerations(self, spins: dict[str, Array], torques: dict[str, Array]) -> dict[str, Array]:
        """Euler's equations of all bodies with the hinges' multipliers."""
        rows, count = self.rows(), 3 * len(self.names)
        matrix = np.zeros((count + len(rows), count + len(rows)))
        right = np.zeros(len(matrix))
        for k, name in enumerate(self.names):
            part = slice(3 * k, 3 * k + 3)
            matrix[part, part] = self.tensors[name]
            right[part] = torques[name] - np.cross(spins[name], self.tensors[name] @ spins[name])
        matrix[:count, count:], matrix[count:, :count] = rows.T, rows
        drift = []
        for one, other, axis in self.hinges:
            # the directions across are carried by the first body of the hinge
            apart = spins[one] - spins[other]
            drift += [-apart @ np.cross(spins[one], across) for across in self.across(axis)]
        right[count:] = drift
        found = np.linalg.solve(matrix, right)
        return {name: found[3 * k : 3 * k + 3] for k, name in enumerate(self.names)}


@pytest.mark.parametrize("seed", range(6))
def test_rigid_bodies_with_multipliers(seed: int) -> None:
    """The drive's acceleration by reduction is that of three bodies about the centre, with every kind of load."""
    random = np.random.default_rng(seed)
    gravity, radius, rate, moment = np.array([1.0, -9.0, 2.0]), 0.6, random.uniform(-3, 3), 2.5
    clouds = {name: drawn(random, radius) for name in ("AB", "BC", "DC")}
    arcs = {"AB": 0.3, "BC": 0.9, "DC": 1.2}
    loads: list[dict[str, Any]] = [
        friction("AB", "frame", value=0.2),
        friction("BC", "AB", viscous=0.4),
        friction("BC", "DC", quadratic=0.7),
        {"kind": "damper", "link": "DC", "damping": 0.5},
        {"kind": "force", "point": "C", "vector": [1.0, 2.0, -0.5]},
        {"kind": "force", "point": "B", "vector": [0.3, 0.1, 0.8], "axes": "BC"},
        {"kind": "torque", "link": "BC", "axis": [0.1, 0.5, -0.2], "value": 0.9},
        {"kind": "spring", "link": "DC", "stiffness": 1.7, "free_angle": 0.2},
        {"kind": "spring", "points": ["A", "C"], "stiffness": 30, "free_length": 0.3},
    ]
    linkage = ct.Mechanism(
        space="sphere",
        gravity=gravity.tolist(),
        radius=radius,
        frame={"points": {"A": [1, 0, 0], "D": [0.1, 1.4], "Z": [0, 0, 1]}},
        links={
            "AB": {"length": arcs["AB"], "reference": ["A", "D"]} | clouds["AB"].keys(),
            "BC": {"length": arcs["BC"]} | clouds["BC"].keys(),
            "DC": {"length": arcs["DC"], "reference": ["D", "Z"]} | clouds["DC"].keys(),
        },
        drives=[{"link": "AB", "start": 0.3, "speed": 1}],
        assembly={"sides": {"C": "left"}},
        loads=loads,
    )
    values = random.uniform(0.0, 2 * pi, 5)
    reducer = Reducer.of(linkage)
    reduced = reducer.at(values, rate=rate)
    second = (reduced.moment + moment - 0.5 * rate**2 * reduced.inertia_slope) / reduced.inertia
    data = ct.motion(linkage, at=values)
    turned = {name: rotation(linkage, data, name) for name in clouds}
    for n in range(len(values)):
        a, b, c, d = (place(data, name)[n] for name in "ABCD")
        bodies = Bodies(list(clouds), {})
        for name, cloud in clouds.items():
            r = cloud.places @ turned[name][n].T
            squares = np.einsum("p,pk,pk->", cloud.masses, r, r)
            bodies.tensors[name] = squares * np.eye(3) - np.einsum("p,pi,pj->ij", cloud.masses, r, r)
        bodies.hinges = [("AB", "frame", a), ("BC", "AB", b), ("BC", "DC", c), ("DC", "frame", d)]
        w = bodies.spins("AB", a, rate)
        torques = {
            name: np.cross(cloud.mass * (turned[name][n] @ cloud.centre), gravity)
            for name, cloud in clouds.items()
        }
        torques["AB"] += (moment - 0.2 * np.sign(w["AB"] @ a)) * a
        slip = (w["BC"] - w["AB"]) @ b
        torques["BC"] -= 0.4 * slip * b
        torques["AB"] += 0.4 * slip * b
        slip = (w["BC"] - w["DC"]) @ c
        torques["BC"] -= 0.7 * slip * abs(slip) * c
        torques["DC"] += 0.7 * slip * abs(slip) * c
        torques["DC"] -= 0.5 * (w["DC"] @ d) * d
        torques["DC"] += np.cross(radius * c, [1.0, 2.0, -0.5])
        torques["BC"] += np.cross(radius * b, turned["BC"][n] @ [0.3, 0.1, 0.8])
        torques["BC"] += 0.9 * np.array([0.1, 0.5, -0.2]) / np.linalg.norm([0.1, 0.5, -0.2])
        torques["DC"] -= 1.7 * (float(data.joint_angle.sel(joint="DC")[n]) - 0.2) * d
        apart = radius * (a - c)
        length = np.linalg.norm(apart)
        torques["DC"] += np.cross(radius * c, 30 * (length - 0.3) * apart / length)
        found = bodies.accelerations(w, torques)["AB"] @ a
        size = 1 + abs(found) + np.max(abs(reduced.moment_parts[:, n])) / reduced.inertia[n]
        assert abs(found - second[n]) <= 2**14 * EPS * size
