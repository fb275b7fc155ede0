"""Equilibrium of spherical bodies from plain Newton and Euler: reactions, loads and inertia put together anew.

Links are clouds of mass points whose accelerations come from the motion; vectors are (n, 3).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

import centrode as ct
from growing_sphere import Growing, unit
from mechanisms import EPS
from spherical_bodies import Cloud, dot, drawn, place, rotation, spin, velocities

Array = npt.NDArray[np.float64]
FRAME = "frame"
GRAVITY = [1.3, -9.7, 2.1]
STIFFNESS, FREE, PUSH, RUB = 40.0, 0.1, 6.0, 2.0


def loaded(growing: Growing, seed: int, radius: float) -> tuple[dict[str, Any], dict[str, Cloud]]:
    """The description with a cloud on each link, and loads on points, links, hinges and guides."""
    random = np.random.default_rng(seed)
    parts = growing.parts() | {"gravity": GRAVITY, "radius": radius}
    clouds = {name: drawn(random, radius) for name in parts["links"]}
    for name, cloud in clouds.items():
        parts["links"][name] |= cloud.keys()
    moving = [name for name in growing.places if name not in growing.frame]
    links = list(parts["links"])
    link = str(random.choice(links))
    other = str(random.choice([name for name in [FRAME, *links] if name != link]))
    axis = random.normal(size=3).tolist()
    parts["loads"] = [
        {"kind": "force", "point": str(random.choice(moving)), "vector": [2.0, -1.0, 0.5]},
        {"kind": "force", "point": str(random.choice(moving)), "vector": [0.7, -1.1, 3.0], "axes": link},
        {"kind": "torque", "link": link, "relative_to": other, "axis": axis, "value": "1.5 - 0.2*v"},
        {"kind": "torque", "link": "link0", "value": 0.4},
        {"kind": "spring", "points": random.choice(list(growing.places), 2, replace=False).tolist(),
         "stiffness": STIFFNESS, "free_length": FREE},
        {"kind": "weight", "point": str(random.choice(moving)), "value": PUSH},
        *[{"kind": "friction", "guide": guide["name"], "value": RUB} for guide in parts["guides"][:1]],
    ]  # fmt: skip
    return parts, clouds


@dataclass
class Balance:
    """Forces, with the places where they act and couples, on every body: "pin A", a link or the frame."""

    mechanism: ct.Mechanism
    motion: xr.Dataset
    clouds: dict[str, Cloud]
    acting: dict[str, list[tuple[Array, Array, Array]]] = field(default_factory=dict)

    @property
    def radius(self) -> float:
        return self.mechanism.sphere_radius

    def add(self, body: str, force: Any, place: Any = 0.0, couple: Any = 0.0) -> None:
        zero = np.zeros((self.motion.sizes["sample"], 3))
        self.acting.setdefault(body, []).append((force + zero, place + zero, couple + zero))

    def pair(self, body: str, other: str, force: Any, place: Any = 0.0, couple: Any = 0.0) -> None:
        """An action and its reaction."""
        self.add(body, force, place, couple)
        self.add(other, -force, place, -couple)

    def at(self, point: str) -> Array:
        return self.radius * place(self.motion, point)

    def bearer(self, point: str, hinges: set[str]) -> str:
        """What a load on a point acts on: the only body that has it, else the pin."""
        links = [name for name, link in self.mechanism.links.items() if point in link.coordinates]
        if point in hinges or (not links and point in self.mechanism.moving_points):
            return f"pin {point}"
        return links[0] if links else FRAME

    def loads(self, hinges: set[str]) -> None:
        for load in self.mechanism.loads:
            if load.kind == "spring":
                first, second = load.points
                apart = self.at(second) - self.at(first)
                length = np.linalg.norm(apart, axis=-1, keepdims=True)
                pull = STIFFNESS * (length - FREE) * apart / length
                self.add(self.bearer(first, hinges), pull, self.at(first))
                self.add(self.bearer(second, hinges), -pull, self.at(second))
            elif load.kind == "friction":
                self.friction(load.guide, hinges)
            elif load.kind == "torque":
                self.torque(load)
            else:
                point = load.point
                force = np.asarray(load.vector if load.kind == "force" else down() * PUSH, dtype=np.float64)
                axes = getattr(load, "axes", FRAME)
                turned = rotation(self.mechanism, self.motion, axes) @ force if axes != FRAME else force
                self.add(self.bearer(point, hinges), turned, self.at(point))

    def torque(self, load: Any) -> None:
        if load.axis is None:
            first = next(iter(self.mechanism.links["link0"].coordinates))
            return self.pair("link0", FRAME, 0.0, 0.0, 0.4 * place(self.motion, first))
        axis = np.asarray(load.axis) / np.linalg.norm(load.axis)
        v = dot(spin(self.motion, load.link) - spin(self.motion, load.relative_to), axis)
        return self.pair(load.link, load.relative_to, 0.0, 0.0, (1.5 - 0.2 * v)[:, None] * axis)

    def friction(self, name: str, hinges: set[str]) -> None:
        guide = self.mechanism.guide(name)
        pole = unit(list(guide.pole))  # type: ignore[arg-type]
        if guide.on != FRAME:
            pole = rotation(self.mechanism, self.motion, guide.on) @ pole
        along = np.cross(pole + 0 * self.at(guide.point), self.at(guide.point))
        along /= np.linalg.norm(along, axis=-1, keepdims=True)
        speed = self.motion.slide_velocity.sel(guide=name).to_numpy()
        rest = 256 * EPS * float(np.nanmax(abs(self.motion.angular_velocity)))
        sense = np.where(abs(speed) <= rest, 0.0, np.sign(speed))[:, None]
        self.pair(self.bearer(guide.point, hinges), guide.on, -RUB * sense * along, self.at(guide.point))

    def inertia(self) -> None:
        for name, cloud in self.clouds.items():
            places = np.einsum("nij,pj->npi", rotation(self.mechanism, self.motion, name), cloud.places)
            bend = velocities(self.mechanism, self.motion, name, cloud)[1]
            for k, mass in enumerate(cloud.masses):
                self.add(name, mass * (np.array(GRAVITY) - bend[:, k]), places[:, k])

    def reactions(self, found: xr.Dataset) -> None:
        for k, point in enumerate(found.side_point.to_numpy()):
            self.pair(
                str(found.side_link[k].item()),
                f"pin {point}",
                found.joint_force[:, k].to_numpy(),
                self.at(point),
            )
        for k, body in enumerate(found.held.to_numpy()):
            self.pair(str(body), FRAME, found.centre_force[:, k].to_numpy())
        hinges = set(found.side_point.to_numpy().tolist())
        for guide in self.mechanism.guides:
            force = found.guide_force.sel(guide=guide.id).to_numpy()
            self.pair(self.bearer(guide.point, hinges), guide.on, force, self.at(guide.point))
        for drive in self.mechanism.drives:
            axis = place(self.motion, next(iter(self.mechanism.links[drive.link or ""].coordinates)))
            given = found.balancing.sel(drive=drive.id).to_numpy()[:, None]
            self.pair(drive.link or "", drive.relative_to, 0.0, 0.0, given * axis)

    def missing(self, body: str) -> tuple[Array, Array]:
        """Sum of the forces on a body and of their moments about the centre."""
        acting = self.acting.get(body, [])
        zero = np.zeros((self.motion.sizes["sample"], 3))
        force = sum((f for f, _place, _couple in acting), zero)
        moment = sum((np.cross(at, f) + couple for f, at, couple in acting), zero)
        return force, moment

    def size(self) -> Array:
        """Sum of the sizes of all forces and moments, at every sample."""
        found = np.zeros(self.motion.sizes["sample"])
        for acting in self.acting.values():
            for force, at, couple in acting:
                size = np.linalg.norm(force, axis=-1)
                found = found + size * (1.0 + np.linalg.norm(at, axis=-1)) + np.linalg.norm(couple, axis=-1)
        return found


def down() -> Array:
    return np.asarray(np.array(GRAVITY) / np.linalg.norm(GRAVITY))


def rounding(growing: Growing, motion: xr.Dataset) -> float:
    """What the axes of a link lose that here come from two of its points, and accelerations from few numbers."""
    pairs = [[growing.places[p] for p in list(body["points"])[:2]] for body in growing.links.values()]
    nearest = min(np.linalg.norm(np.cross(one, other)) for one, other in pairs)
    fast = 1.0 + float(np.nanmax(abs(motion.angular_velocity))) ** 2
    fast += float(np.nanmax(abs(motion.angular_acceleration)))
    return 256 * EPS * fast / min(float(nearest), 1.0)
