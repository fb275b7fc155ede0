"""Equilibrium of every pin and link from plain Newton and Euler: reactions, loads and inertia put together anew.

Vectors are complex numbers; accelerations come from the motion, loads are those of `burdened`.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

import centrode as ct
from tools.campaigns.columns import EPS, link, point, slide
from tools.campaigns.reactions.burden import GRAVITY, inertia_of

Array = npt.NDArray[np.float64]
Complex = npt.NDArray[np.complex128]
FRAME = "frame"


@dataclass
class Balance:
    """Forces, with the places where they act and couples, on every body: "pin A", a link or the frame."""

    mechanism: ct.Mechanism
    motion: xr.Dataset
    found: xr.Dataset
    acting: dict[str, list[tuple[Complex, Complex, Array]]] = field(default_factory=dict)

    @classmethod
    def of(cls, mechanism: ct.Mechanism, motion: xr.Dataset, found: xr.Dataset) -> Balance:
        """Everything that acts, the reactions of a dataset among it."""
        new = cls.of_outer(mechanism, motion, found)
        new.joints()
        new.guides()
        new.gears()
        new.wheels()
        new.drives()
        return new

    @classmethod
    def of_outer(cls, mechanism: ct.Mechanism, motion: xr.Dataset, found: xr.Dataset) -> Balance:
        """Loads and inertia alone."""
        new = cls(mechanism, motion, found)
        new.inertia()
        for load in mechanism.loads:
            new.load(load)
        return new

    def add(self, body: str, force: Any, place: Any, couple: Any = 0.0) -> None:
        zero = np.zeros(self.motion.sizes["sample"])
        self.acting.setdefault(body, []).append((force + 0j * zero, place + 0j * zero, couple + zero))

    def pair(self, body: str, other: str, force: Any, place: Any, couple: Any = 0.0) -> None:
        """An action and its reaction."""
        self.add(body, force, place, couple)
        self.add(other, -force, place, -couple)

    def missing(self, body: str, about: Any = 0.0) -> tuple[Complex, Array]:
        """Sum of the forces on a body and of their moments about a place."""
        acting = self.acting[body]
        force = sum(f for f, _place, _couple in acting)
        moment = sum(dot(1j * (place - about), f) + couple for f, place, couple in acting)
        return np.asarray(force), np.asarray(moment)

    def greatest(self) -> Array:
        """Greatest force, and greatest moment over the greatest coordinate, at every sample."""
        found: Any = 0.0
        for acting in self.acting.values():
            for force, place, couple in acting:
                reach = np.maximum(1.0, abs(place))
                found = np.maximum(found, np.maximum(abs(force) * reach, abs(couple)))
        return np.asarray(found)

    def at(self, name: str) -> Complex:
        return np.asarray(point(self.motion, name))

    def bearer(self, name: str) -> str:
        """What a force on a point acts on: its pin, or the only body that has the point."""
        if name in self.found.side_point.to_numpy():
            return f"pin {name}"
        links = [body for body, one in self.mechanism.links.items() if name in one.coordinates]
        return links[0] if links else FRAME

    def turn(self, body: str) -> Complex:
        return np.asarray(1.0 + 0j if body == FRAME else np.exp(1j * link(self.motion, body)))

    def inertia(self) -> None:
        for name, body in self.mechanism.links.items():
            if not body.mass:
                continue
            (first, local), *_more = body.coordinates.items()
            assert isinstance(body.centre, tuple)
            arm = self.turn(name) * complex(body.centre[0] - local[0], body.centre[1] - local[1])
            omega, epsilon = (
                link(self.motion, name, f"angular_{which}") for which in ("velocity", "acceleration")
            )
            acceleration = point(self.motion, first, "acceleration") + (1j * epsilon - omega**2) * arm
            force = -body.mass * acceleration + body.mass * complex(*GRAVITY)
            self.add(name, force, self.at(first) + arm, -inertia_of(body) * epsilon)

    def load(self, load: Any) -> None:
        if load.kind == "weight":
            down = complex(*GRAVITY) / abs(complex(*GRAVITY))
            self.add(self.bearer(load.point), load.value * down, self.at(load.point))
        elif hasattr(load, "guide"):
            x, v = slide(self.motion, load.guide), slide(self.motion, load.guide, "slide_velocity")
            friction = -1.1 * sense(v) - 0.3 * v
            self.along_guide(load.guide, friction if load.kind == "friction" else 1.5 - 0.5 * x + 0.2 * v)
        elif load.kind == "force":
            self.add(self.bearer(load.point), self.force_of(load), self.at(load.point))
        elif hasattr(load, "points"):
            self.between(load)
        else:
            self.twist(load)

    def force_of(self, load: Any) -> Complex:
        z, velocity = self.at(load.point), point(self.motion, load.point, "velocity")
        q, t = self.motion.drive_value.isel(drive=0).to_numpy(), self.motion.time.to_numpy()
        if isinstance(load.vector[0], str):
            x, u, v = z.real, velocity.real, velocity.imag
            return np.asarray((2 * x - 0.3 * u) + 1j * (-0.4 * v * abs(v) + np.sin(q) * t))
        force = complex(*load.vector)
        if load.while_moving is not None:
            return np.where(dot(complex(*load.while_moving), velocity) >= 0.0, force, 0.0)
        return force * self.turn(load.axes)

    def between(self, load: Any) -> None:
        first, second = load.points
        apart = self.at(second) - self.at(first)
        unit = apart / abs(apart)
        speed = dot(unit, point(self.motion, second, "velocity") - point(self.motion, first, "velocity"))
        push = -40.0 * (abs(apart) - 0.7) if load.kind == "spring" else -3.0 * speed
        self.add(self.bearer(second), push * unit, self.at(second))
        self.add(self.bearer(first), -push * unit, self.at(first))

    def twist(self, load: Any) -> None:
        base: Any = 0.0
        slow: Any = 0.0
        if load.relative_to != FRAME:
            base, slow = (link(self.motion, load.relative_to, w) for w in ("angle", "angular_velocity"))
        x = link(self.motion, load.link) - base
        v = link(self.motion, load.link, "angular_velocity") - slow
        moment = {
            "torque": 0.2 * x - 0.1 * v,
            "spring": -2.0 * (x - 0.4),
            "damper": -0.8 * v,
            "friction": -0.6 * sense(v) - 0.1 * v * abs(v),
        }[load.kind]
        self.pair(load.link, load.relative_to, 0.0, 0.0, moment)

    def joints(self) -> None:
        for label in self.found.side.to_numpy():
            side = self.found.sel(side=label)
            name, body = str(side.side_point.to_numpy()), str(side.side_link.to_numpy())
            self.pair(body, f"pin {name}", vector(side.joint_force), self.at(name))

    def slider(self, guide: Any) -> str:
        return guide.link or self.bearer(guide.point)

    def along_guide(self, name: str, push: Any) -> None:
        guide = self.mechanism.guide(name)
        way = self.turn(guide.on) * complex(*guide.unit)
        self.pair(self.slider(guide), guide.on, push * way, self.at(guide.point))

    def guides(self) -> None:
        for guide in self.mechanism.guides:
            one = self.found.sel(guide=guide.id)
            normal = 1j * self.turn(guide.on) * complex(*guide.unit)
            force = vector(one.guide_force)
            assert np.allclose(force, one.guide_normal.to_numpy() * normal, atol=1e-9, equal_nan=True)
            self.pair(self.slider(guide), guide.on, force, self.at(guide.point))
            if guide.link is not None:
                self.pair(guide.link, guide.on, 0.0, 0.0, one.guide_moment.to_numpy())

    def gears(self) -> None:
        for gear in self.mechanism.gears:
            one = self.found.sel(gear=gear.id)
            moments = one.gear_moment.to_numpy()
            tooth = vector(one.tooth_force)
            if np.isnan(tooth).all():
                for body, moment in zip((*gear.links, gear.carrier), moments.T, strict=True):
                    self.add(body, 0.0, 0.0, moment)
                continue
            first, second = (self.at(name) for name in self.axes(gear))
            pitch = second + (first - second) / (1.0 - gear.ratio)
            assert np.allclose(dot(1j * (pitch - second), tooth), moments[:, 1], equal_nan=True)
            self.pair(gear.links[1], gear.links[0], tooth, pitch)

    def axes(self, gear: Any) -> list[str]:
        def points(body: str) -> set[str]:
            one = self.mechanism.frame.points if body == FRAME else self.mechanism.links[body].coordinates
            return set(one)

        return [min(points(wheel) & points(gear.carrier)) for wheel in gear.links]

    def wheels(self) -> None:
        for wheel in self.mechanism.rolling:
            xy = self.motion.contact.sel(rolling=wheel.id).to_numpy()
            force = vector(self.found.rolling_force.sel(rolling=wheel.id))
            self.parts_of_contact(wheel, force, xy[:, 0] + 1j * xy[:, 1])
            self.pair(wheel.link, wheel.on, force, xy[:, 0] + 1j * xy[:, 1])

    def parts_of_contact(self, wheel: Any, force: Complex, contact: Complex) -> None:
        """The track presses the rim towards the wheel's centre, or the inside of a ring away from it."""
        ring = wheel.along.inside and wheel.radius > wheel.along.radius
        inwards = (self.at(wheel.centre) - contact) / wheel.radius * (-1.0 if ring else 1.0)
        if wheel.along.radius is None:
            along = self.turn(wheel.on) * complex(*wheel.along.unit)
        else:
            # counter-clockwise about the circle's centre, which is on the other side of an outer wheel's rim
            along = 1j * (-inwards if wheel.along.inside else inwards)
        one = self.found.sel(rolling=wheel.id)
        size = 1e-9 * (1.0 + abs(force))
        assert not (abs(one.rolling_normal.to_numpy() - dot(inwards, force)) > size).any()
        assert not (abs(one.rolling_tangential.to_numpy() - dot(along, force)) > size).any()

    def drives(self) -> None:
        for drive in self.mechanism.drives:
            given = self.found.balancing.sel(drive=drive.id).to_numpy()
            if drive.kind == "angle":
                self.pair(drive.link or "", drive.relative_to, 0.0, 0.0, given)
            elif drive.distance is not None:
                first, second = drive.distance
                way = (self.at(second) - self.at(first)) / abs(self.at(second) - self.at(first))
                self.add(self.bearer(second), given * way, self.at(second))
                self.add(self.bearer(first), -given * way, self.at(first))
            else:
                self.along_guide(drive.guide or "", given)


def dot(one: Any, other: Any) -> Array:
    """Scalar product of plane vectors as complex numbers."""
    return np.asarray((np.conj(one) * other).real)


def vector(values: xr.DataArray) -> Complex:
    """A force over the samples as complex numbers."""
    xy = values.transpose(..., "axis").to_numpy()
    return np.asarray(xy[..., 0] + 1j * xy[..., 1])


def sense(v: Array) -> Array:
    """Which way a joint goes; none where it stands but for rounding."""
    return np.asarray(np.where(abs(v) <= 2**16 * EPS, 0.0, np.sign(v)))
