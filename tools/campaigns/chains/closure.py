"""Closure equations of a grown chain, in the coordinates of its links: no dyads, no branches, no order of groups.

Unknowns are origin and angle of every link, places of guided points that no link carries, and the direction of every
wheel's centre that rolls on a circle.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import mpmath
import numpy as np

from tools.campaigns.closure.equations import ARRAYS, EXACT, Array, Equations, Functions
from tools.campaigns.grown.plane import Growing

Pair = tuple[Any, Any]


class Closure(Equations):
    """The equations of a grown chain."""

    def __init__(self, growing: Growing) -> None:
        self.growing = growing
        self.links = list(growing.links)
        self.carriers: dict[str, list[str]] = {name: ["frame"] for name in growing.frame}
        for name, link in growing.links.items():
            for point in link["points"]:
                self.carriers.setdefault(point, []).append(name)
        self.loose = [p for p in dict.fromkeys(g["point"] for g in growing.guides) if p not in self.carriers]
        self.circles = [w for w in growing.rolling if "radius" in w["along"]]
        self.points = [*self.carriers, *self.loose]
        self.start, self.begun = self._start(), growing.start
        self.constants = [0.0] * (len(growing.gears) + len(growing.rolling))
        self.constants = [float(x) for x in self._kept(list(self.start), ARRAYS)]
        ends = [growing.places[name] for name in self.points]
        self.length = max(abs(a - b) for a in ends for b in ends)

    def _start(self) -> Array:
        found: list[float] = []
        for name in self.links:
            origin, angle = self.growing.poses[name]
            found += [origin.real, origin.imag, angle]
        for point in self.loose:
            found += [self.growing.places[point].real, self.growing.places[point].imag]
        for wheel in self.circles:
            body, turn = self.growing.poses[wheel["on"]]
            centre = body + complex(*wheel["along"]["centre"]) * np.exp(1j * turn)
            found.append(float(np.angle(self.growing.places[wheel["centre"]] - centre)))
        return np.array(found)

    def _pose(self, x: Sequence[Any], body: str) -> tuple[Any, Any, Any]:
        if body == "frame":
            return 0.0, 0.0, 0.0
        k = 3 * self.links.index(body)
        return x[k], x[k + 1], x[k + 2]

    def _carried(self, x: Sequence[Any], body: str, local: Sequence[float], m: Functions) -> Pair:
        px, py, angle = self._pose(x, body)
        if body == "frame":
            return local[0], local[1]
        c, s = m.cos(angle), m.sin(angle)
        return px + c * local[0] - s * local[1], py + s * local[0] + c * local[1]

    def place(self, x: Sequence[Any], point: str, m: Functions) -> Pair:
        """Where a point is."""
        if point in self.loose:
            k = 3 * len(self.links) + 2 * self.loose.index(point)
            return x[k], x[k + 1]
        body = self.carriers[point][0]
        local = self.growing.frame[point] if body == "frame" else self.growing.links[body]["points"][point]
        return self._carried(x, body, local, m)

    def places(self, x: Sequence[Any], q: Any, m: Functions) -> list[Any]:
        """Coordinates of all points, one after the other."""
        return [u for point in self.points for u in self.place(x, point, m)]

    def residual(self, x: Sequence[Any], q: Any, m: Functions) -> list[Any]:
        """What vanishes where the crank stands at q."""
        found = []
        for point, bodies in self.carriers.items():
            here = self.place(x, point, m)
            for body in bodies[1:]:
                there = self._carried(x, body, self.growing.links[body]["points"][point], m)
                found += [there[0] - here[0], there[1] - here[1]]
        for guide in self.growing.guides:
            turn = self._pose(x, guide["on"])[2]
            line = guide["through"], guide["direction"]
            found.append(self._off(x, guide["on"], *line, guide["point"], m)[1])
            if "link" in guide:
                found.append(self._pose(x, guide["link"])[2] - turn - guide["angle"])
        found += [a - b for a, b in zip(self._kept(x, m), self.constants, strict=True)]
        slot = self.size - len(self.circles)
        for wheel in self.growing.rolling:
            track, on = wheel["along"], wheel["on"]
            if "radius" not in track:
                left = self._off(x, on, track["through"], track["direction"], wheel["centre"], m)[1]
                found.append(left - wheel["radius"])
                continue
            reach = track["radius"] + (-wheel["radius"] if track["inside"] else wheel["radius"])
            centre, at = self._carried(x, on, track["centre"], m), self.place(x, wheel["centre"], m)
            found += [at[0] - centre[0] - reach * m.cos(x[slot]), at[1] - centre[1] - reach * m.sin(x[slot])]
            slot += 1
        return [*found, self._pose(x, "link0")[2] - q]

    def _off(
        self, x: Sequence[Any], on: str, through: Sequence[float], direction: float, point: str, m: Functions
    ) -> Pair:
        """How far a point is along a line of a body, and left of it."""
        foot, at = self._carried(x, on, through, m), self.place(x, point, m)
        angle = self._pose(x, on)[2] + (mpmath.mpf(direction) if m is EXACT else direction)
        c, s = m.cos(angle), m.sin(angle)
        u, v = at[0] - foot[0], at[1] - foot[1]
        return c * u + s * v, c * v - s * u

    def _kept(self, x: Sequence[Any], m: Functions) -> list[Any]:
        """What gears and wheels that do not slip keep constant."""
        found = []
        for gear in self.growing.gears:
            first, second, carrier = (self._pose(x, body)[2] for body in (*gear["links"], gear["carrier"]))
            found.append(second - carrier - gear["ratio"] * (first - carrier))
        slot = self.size - len(self.circles)
        for wheel in self.growing.rolling:
            track, r = wheel["along"], wheel["radius"]
            turn = self._pose(x, wheel["link"])[2] - self._pose(x, wheel["on"])[2]
            if "radius" not in track:
                way = self._off(x, wheel["on"], track["through"], track["direction"], wheel["centre"], m)[0]
                found.append(turn + way / r)
            else:
                ratio = -(track["radius"] - r) / r if track["inside"] else (track["radius"] + r) / r
                found.append(turn - ratio * (x[slot] - self._pose(x, wheel["on"])[2]))
                slot += 1
        return found

    def far(self, x: Array) -> float:
        """How far away the farthest link is; angles may grow."""
        return float(np.max(abs(x.reshape(-1)[: 3 * len(self.links)].reshape(-1, 3)[:, :2])))
