"""Random spherical mechanisms, grown group by group: every group is placed first and measured afterwards."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

Vector = npt.NDArray[np.float64]
KINDS = ("RRR", "RRP", "RPR", "PRP", "rigid point", "turned link")


def coordinates(v: Vector) -> list[float]:
    """[longitude, latitude] of a vector."""
    return [float(np.arctan2(v[1], v[0])), float(np.arctan2(v[2], np.hypot(v[0], v[1])))]


def arc(a: Vector, b: Vector) -> float:
    return float(np.arctan2(np.linalg.norm(np.cross(a, b)), a @ b))


def angle_at(pivot: Vector, start: Vector, end: Vector) -> float:
    """Angle in a place from one arc to another, counter-clockwise seen from outside."""
    first, second = np.cross(pivot, start), np.cross(pivot, end)
    return float(np.arctan2(pivot @ np.cross(first, second), first @ second))


@dataclass
class Growing:
    """A mechanism so far: places of points and axes of bodies (as columns) in the initial position."""

    random: np.random.Generator
    spread: float
    places: dict[str, Vector] = field(default_factory=dict)
    axes: dict[str, Vector] = field(default_factory=lambda: {"frame": np.eye(3)})
    frame: dict[str, list[float]] = field(default_factory=dict)
    links: dict[str, dict[str, Any]] = field(default_factory=dict)
    guides: list[dict[str, Any]] = field(default_factory=list)
    drives: list[dict[str, Any]] = field(default_factory=list)
    sides: dict[str, str] = field(default_factory=dict)

    def place(self) -> Vector:
        """A place about the x axis, as far from it as the spread lets it be."""
        v = np.array([1.0, *(self.spread * self.random.normal(size=2))])
        return np.asarray(v / np.linalg.norm(v))

    def fixed(self, at: Vector) -> str:
        name = f"F{len(self.frame)}"
        self.frame[name] = coordinates(at)
        self.places[name] = at
        return name

    def known(self, *but: str) -> str:
        if self.random.random() < 0.4:
            return self.fixed(self.place())
        names = [name for name in self.places if name not in but]
        return str(self.random.choice(names)) if names else self.fixed(self.place())

    def body(self, *but: str) -> str:
        return str(self.random.choice([name for name in self.axes if name not in but]))

    def local(self, body: str, at: Vector) -> list[float]:
        return coordinates(self.axes[body].T @ at)

    def link(self, *points: str) -> str:
        """A link through points that have places: a two-point link by its arc, or one with coordinates."""
        name = f"link{len(self.links)}"
        if len(points) == 2 and self.random.random() < 0.5:
            first, second = (self.places[p] for p in points)
            towards = second - first * (first @ second)
            towards /= np.linalg.norm(towards)
            self.axes[name] = np.column_stack([first, towards, np.cross(first, towards)])
            self.links[name] = {"points": list(points), "length": arc(first, second)}
        else:
            self.axes[name] = np.linalg.qr(self.random.normal(size=(3, 3)))[0]
            self.axes[name] *= np.sign(np.linalg.det(self.axes[name]))
            self.links[name] = {"points": {p: self.local(name, self.places[p]) for p in points}}
        return name

    def measured(self, link: str, towards: str) -> str:
        """The same link with an initial angle from an arc; it must have two points."""
        first, second = list(self.links[link]["points"])[:2]
        angle = angle_at(self.places[first], self.places[towards], self.places[second])
        self.links[link] |= {"reference": [first, towards], "angle": angle}
        return link

    def guide(self, point: str, on: str) -> None:
        pole = self.place() if self.random.random() < 0.5 else self.random.normal(size=3)
        pole = pole / np.linalg.norm(pole)
        self.guides.append(
            {"name": f"guide{len(self.guides)}", "point": point, "on": on, "pole": self.local(on, pole),
             "radius": arc(pole, self.places[point])}
        )  # fmt: skip

    def new(self) -> str:
        name = f"P{len(self.places)}"
        self.places[name] = self.place()
        return name

    def drive(self, link: str, against: str = "frame") -> None:
        self.drives.append(
            {"link": link, "relative_to": against, "start": self.links[link].pop("angle"), "speed": 1.0}
        )

    def add(self, kind: str) -> None:
        getattr(self, "_" + kind.lower().replace(" ", "_"))()

    def _rrr(self) -> None:
        one = self.known()
        other = self.known(one)
        p = self.new()
        self.measured(self.link(one, p), other)
        self.link(other, p)

    def _rrp(self) -> None:
        known, body = self.known(), self.body()
        away = self.fixed(self.place())
        p = self.new()
        self.measured(self.link(known, p), away)
        self.guide(p, body)

    def _rpr(self) -> None:
        pivot = self.known()
        # a side stated for a point would be taken for that of the guide it slides in as well
        target = self.known(pivot, *self.sides)
        away = self.fixed(self.place())
        tip = self.new()
        lever = self.measured(self.link(pivot, tip), away)
        self.guide(target, lever)

    def _prp(self) -> None:
        body = self.body()
        other = self.body(body)
        p = self.new()
        self.guide(p, body)
        self.guide(p, other)
        self.sides[p] = self._side_of_guides(p)

    def _side_of_guides(self, p: str) -> str:
        one, other = (self.axes[g["on"]] @ unit(g["pole"]) for g in self.guides[-2:])
        return "left" if np.linalg.det([one, other, self.places[p]]) > 0 else "right"

    def _rigid_point(self) -> None:
        bodies = [name for name, link in self.links.items() if isinstance(link["points"], dict)]
        if bodies:
            body, p = str(self.random.choice(bodies)), self.new()
            self.links[body]["points"][p] = self.local(body, self.places[p])

    def _turned_link(self) -> None:
        """A link that a second drive turns against the one it is hinged to."""
        base = self.body("frame")
        pivot, towards = self.random.permutation(list(self.links[base]["points"]))[:2]
        tip = self.new()
        self.drive(self.measured(self.link(str(pivot), tip), str(towards)), base)

    def parts(self) -> dict[str, Any]:
        return {
            "space": "sphere",
            "frame": {"points": self.frame},
            "links": self.links,
            "guides": self.guides,
            "drives": self.drives,
            "assembly": {"sides": self.sides},
        }


def unit(at: list[float]) -> Vector:
    return np.array([np.cos(at[1]) * np.cos(at[0]), np.cos(at[1]) * np.sin(at[0]), np.sin(at[1])])


def grown(kinds: list[str], seed: int, spread: float = 0.7) -> Growing:
    """A crank with groups of these kinds on it."""
    growing = Growing(np.random.default_rng(seed), spread)
    pivot, towards = growing.fixed(growing.place()), growing.fixed(growing.place())
    tip = growing.new()
    growing.drive(growing.measured(growing.link(pivot, tip), towards))
    for kind in kinds:
        growing.add(kind)
    return growing
