"""Random mechanisms, built as Assur taught: a crank, then one group after the other on what is already there.

Every group is placed first and measured afterwards, so the mechanism assembles by construction: the places and angles
drawn here are its initial position.
"""

from __future__ import annotations

import cmath
from dataclasses import dataclass, field
from typing import Any

import numpy as np

DYADS = ("RRR", "RRP", "RRP carriage", "RPR", "RPR block", "PRP", "RPP", "rigid point", "parallel link")
WHEELS = ("gear", "wheel on a line", "wheel on a circle")
KINDS = DYADS + WHEELS


@dataclass
class Growing:
    """A mechanism so far: places of points, angles and origins of bodies in the initial position."""

    random: np.random.Generator
    places: dict[str, complex] = field(default_factory=dict)
    poses: dict[str, tuple[complex, float]] = field(default_factory=lambda: {"frame": (0j, 0.0)})
    frame: dict[str, list[float]] = field(default_factory=dict)
    links: dict[str, dict[str, Any]] = field(default_factory=dict)
    guides: list[dict[str, Any]] = field(default_factory=list)
    gears: list[dict[str, Any]] = field(default_factory=list)
    rolling: list[dict[str, Any]] = field(default_factory=list)
    start: float = 0.0

    def place(self) -> complex:
        x, y = self.random.uniform(-2.0, 2.0, size=2)
        return complex(x, y)

    def angle(self) -> float:
        return float(self.random.uniform(-np.pi, np.pi))

    def known_point(self) -> str:
        """A point whose place is known: one there is, or a new one of the frame."""
        if self.random.random() < 0.4:
            return self.fixed_point(self.place())
        return str(
            self.random.choice([name for name in self.places if name not in self.frame] or list(self.places))
        )

    def known_points(self) -> tuple[str, str]:
        """Two known points, not the same."""
        first = self.known_point()
        return first, next(p for p in iter(self.known_point, None) if p != first)

    def fixed_point(self, at: complex) -> str:
        name = f"F{len(self.frame)}"
        self.frame[name] = [at.real, at.imag]
        self.places[name] = at
        return name

    def body(self, *but: str) -> str:
        return str(self.random.choice([name for name in self.poses if name not in but]))

    def local(self, body: str, at: complex) -> list[float]:
        origin, angle = self.poses[body]
        v = (at - origin) * cmath.exp(-1j * angle)
        return [v.real, v.imag]

    def link(self, points: dict[str, complex], angle: float | None = None) -> str:
        """A link through points at their places, its axes turned by an angle."""
        name = f"link{len(self.links)}"
        turn = self.angle() if angle is None else angle
        origin = next(iter(points.values()))
        self.poses[name] = (origin, turn)
        self.links[name] = {"points": {p: self.local(name, at) for p, at in points.items()}, "angle": turn}
        self.places.update(points)
        return name

    def guide(self, point: str, at: complex, on: str, heading: float, link: str | None = None) -> None:
        """A guide of a body through a place, with an absolute heading; the line's own point lies beside."""
        _origin, turn = self.poses[on]
        through = at - cmath.exp(1j * heading) * self.random.uniform(-1.0, 1.0)
        entry: dict[str, Any] = {
            "name": f"guide{len(self.guides)}", "point": point, "on": on,
            "through": self.local(on, through), "direction": heading - turn,
        }  # fmt: skip
        if link is not None:
            entry |= {"link": link, "angle": self.poses[link][1] - turn}
        self.guides.append(entry)

    def new(self) -> str:
        return f"P{len(self.places)}"

    def add(self, kind: str) -> None:
        getattr(self, "_" + kind.lower().replace(" ", "_"))()

    def _rrr(self) -> None:
        p, at = self.new(), self.place()
        for known in self.known_points():
            self.link({known: self.places[known], p: at})

    def _rrp(self) -> None:
        p, at, known = self.new(), self.place(), self.known_point()
        body = self.body()
        self.link({known: self.places[known], p: at})
        self.guide(p, at, body, self.angle())

    def _rrp_carriage(self) -> None:
        p, at, known, body = self.new(), self.place(), self.known_point(), self.body()
        self.link({known: self.places[known], p: at})
        slider = self.link({p: at, p + "'": at + self.place() / 4})
        self.guide(p + "'", self.places[p + "'"], body, self.angle(), slider)

    def _rpr(self) -> None:
        pivot, target = self.known_points()
        lever = self.link({pivot: self.places[pivot]})
        self.guide(target, self.places[target], lever, self.angle())

    def _rpr_block(self) -> None:
        pivot, target = self.known_points()
        lever = self.link({pivot: self.places[pivot]})
        at = self.places[target]
        slid = self.new()
        block = self.link({target: at, slid: at + self.place() / 4})
        self.guide(slid, self.places[slid], lever, self.angle(), block)

    def _prp(self) -> None:
        p, at, body = self.new(), self.place(), self.body()
        other = self.body(body)
        heading = self.angle()
        self.places[p] = at
        self.guide(p, at, body, heading)
        self.guide(p, at, other, heading + self.random.uniform(0.5, 2.5))

    def _rpp(self) -> None:
        p, at, target, body = self.new(), self.place(), self.known_point(), self.body()
        carriage = self.link({p: at})
        heading = self.angle()
        self.guide(p, at, body, heading, carriage)
        self.guide(target, self.places[target], carriage, heading + self.random.uniform(0.5, 2.5))

    def _rigid_point(self) -> None:
        body = self.body("frame")
        p, at = self.new(), self.place()
        self.links[body]["points"][p] = self.local(body, at)
        self.places[p] = at

    def _parallel_link(self) -> None:
        p, at, body = self.new(), self.place(), self.body()
        other = self.body(body)
        heading = self.angle()
        shoe = self.link({p: at, p + "'": self.place()})
        self.guide(p, at, body, heading, shoe)
        self.guide(p, at, other, heading + self.random.uniform(0.5, 2.5))

    def _gear(self) -> None:
        """A wheel on a known point, turned by any body against any other."""
        pivot = self.known_point()
        turning = self.body()
        carrier = self.body(turning)
        wheel = self.link({pivot: self.places[pivot]})
        ratio = float(self.random.choice([-1.0, 1.0]) * self.random.uniform(0.3, 2.0))
        self.gears.append({"links": [turning, wheel], "carrier": carrier, "ratio": ratio})

    def _wheel_on_a_line(self) -> None:
        """A wheel on a line of any body, its centre held by a rod."""
        p, at, known, body = self.new(), self.place(), self.known_point(), self.body()
        radius, heading = float(self.random.uniform(0.2, 0.8)), self.angle()
        self.link({known: self.places[known], p: at})
        along = cmath.exp(1j * heading)
        foot = at - 1j * radius * along + self.random.uniform(-1.0, 1.0) * along
        self._roll(
            p, radius, body, {"through": self.local(body, foot), "direction": heading - self.poses[body][1]}
        )

    def _wheel_on_a_circle(self) -> None:
        """A wheel outside or inside a circle of any body, its centre held by a rod."""
        p, at, known, body = self.new(), self.place(), self.known_point(), self.body()
        radius, circle = float(self.random.uniform(0.2, 0.8)), float(self.random.uniform(1.0, 2.0))
        inside = bool(self.random.random() < 0.5)
        self.link({known: self.places[known], p: at})
        reach = circle - radius if inside else circle + radius
        centre = at - reach * cmath.exp(1j * self.angle())
        self._roll(p, radius, body, {"centre": self.local(body, centre), "radius": circle, "inside": inside})

    def _roll(self, centre: str, radius: float, on: str, along: dict[str, Any]) -> None:
        wheel = self.link({centre: self.places[centre]})
        self.rolling.append({"link": wheel, "centre": centre, "radius": radius, "on": on, "along": along})

    def parts(self) -> dict[str, Any]:
        return {
            "frame": {"points": self.frame},
            "links": self.links,
            "guides": self.guides,
            "gears": self.gears,
            "rolling": self.rolling,
            "drives": [{"link": "link0", "start": self.start, "speed": 1.0}],
        }


def grown(kinds: list[str], seed: int, growing: Growing | None = None) -> dict[str, Any]:
    """The description of a crank with groups of these kinds on it."""
    growing = Growing(np.random.default_rng(seed)) if growing is None else growing
    pivot = growing.fixed_point(growing.place())
    growing.start = growing.angle()
    along = growing.random.uniform(0.3, 1.0) * cmath.exp(1j * growing.start)
    growing.link({pivot: growing.places[pivot], "A": growing.places[pivot] + along}, growing.start)
    for kind in kinds:
        growing.add(kind)
    return growing.parts()
