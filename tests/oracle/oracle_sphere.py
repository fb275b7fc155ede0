"""Equations of any spherical mechanism in the unit vectors of its points, apart from the formulas of centrode.

Unknowns are the vectors of the moving points and the angles of the links that have a reference arc. So angles run on
over turns by themselves.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from oracle_fields import Field

Vector = tuple[Any, Any, Any]


def dot(a: Vector, b: Vector) -> Any:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vector, b: Vector) -> Vector:
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def scaled(a: Vector, by: Any) -> Vector:
    return (a[0] * by, a[1] * by, a[2] * by)


def added(a: Vector, b: Vector) -> Vector:
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


class Sphere:
    """The equations of a description on the unit sphere."""

    meshes: tuple[str, ...] = ()

    def __init__(self, parts: Mapping[str, Any], field: Field) -> None:
        self.field, self.parts = field, parts
        self.frame = {name: self.vector(v) for name, v in parts["frame"]["points"].items()}
        self.local = {name: self._local(name, link) for name, link in parts["links"].items()}
        names = dict.fromkeys(point for points in self.local.values() for point in points)
        self.moving = [name for name in names if name not in self.frame]
        self.turning = [name for name, link in parts["links"].items() if "reference" in link]
        self.size = 3 * len(self.moving) + len(self.turning)

    def vector(self, v: Sequence[Any]) -> Vector:
        """The unit vector of (longitude, latitude), or along three components."""
        n = [self.field.number(c) for c in v]
        if len(n) == 3:
            return scaled((n[0], n[1], n[2]), 1 / self.field.sqrt(n[0] ** 2 + n[1] ** 2 + n[2] ** 2))
        c, s = self.field.cos(n[1]), self.field.sin(n[1])
        return (c * self.field.cos(n[0]), c * self.field.sin(n[0]), s)

    def _local(self, name: str, link: Mapping[str, Any]) -> dict[str, Vector]:
        points = link.get("points", list(name))
        if isinstance(points, Mapping):
            return {point: self.vector(v) for point, v in points.items()}
        return {points[0]: self.vector((0, 0)), points[1]: self.vector((link["length"], 0))}

    def places(self, x: Sequence[Any]) -> dict[str, Vector]:
        """Every point as a unit vector."""
        found = dict(self.frame)
        for i, name in enumerate(self.moving):
            found[name] = (x[3 * i], x[3 * i + 1], x[3 * i + 2])
        return found

    def _carried(self, link: str, local: Vector, places: Mapping[str, Vector]) -> Vector:
        """Where a vector in the axes of a link stands, from the first two points of the link."""
        one, two, *_ = self.local[link]
        p, q = self.local[link][one], self.local[link][two]
        n, c = cross(p, q), dot(p, q)
        a, b = dot(p, local), dot(q, local)
        along_one, along_two = (a - b * c) / (1 - c * c), (b - a * c) / (1 - c * c)
        up = dot(n, local) / (1 - c * c)
        flat = added(scaled(places[one], along_one), scaled(places[two], along_two))
        return added(flat, scaled(cross(places[one], places[two]), up))

    def equations(self, values: Sequence[Any], x: Sequence[Any], phases: Mapping[str, Any]) -> list[Any]:
        """What vanishes where the drives have the values."""
        places, wrong, carried = self.places(x), [], set()
        for link, local in self.local.items():
            one, two, *others = local
            wrong.append(dot(places[one], places[two]) - dot(local[one], local[two]))
            for point in others:
                carried.add(point)
                gap = added(self._carried(link, local[point], places), scaled(places[point], -1))
                wrong += list(gap)
        wrong += [dot(places[p], places[p]) - 1 for p in self.moving if p not in carried]
        wrong += [self._guided(guide, places) for guide in self.parts.get("guides", ())]
        angles = dict(zip(self.turning, x[3 * len(self.moving) :], strict=True))
        wrong += [self._turned(link, angle, places) for link, angle in angles.items()]
        drives = zip(self.parts["drives"], values, strict=True)
        # a reference on a moving link makes an angle relative by itself
        return wrong + [angles[drive["link"]] - value for drive, value in drives]

    def _guided(self, guide: Mapping[str, Any], places: Mapping[str, Vector]) -> Any:
        on, pole = guide.get("on", "frame"), guide["pole"]
        if isinstance(pole, str):
            at = places[pole]
        else:
            at = self.vector(pole) if on == "frame" else self._carried(on, self.vector(pole), places)
        height = self.field.cos(self.field.number(guide["radius"])) if "radius" in guide else 0
        return dot(at, places[guide["point"]]) - height

    def _turned(self, link: str, angle: Any, places: Mapping[str, Vector]) -> Any:
        """The arc of a link stands at an angle, counter-clockwise seen from outside, from its reference arc."""
        first, second = self.parts["links"][link]["reference"]
        pivot, mark = places[first], places[second]
        end = places[list(self.local[link])[1]]
        towards = added(mark, scaled(pivot, -dot(pivot, mark)))
        across = cross(pivot, mark)
        length = self.field.sqrt(dot(across, across))
        turn = self.field.cos(angle) * dot(across, end) - self.field.sin(angle) * dot(towards, end)
        return turn / length

    def constants(self, x: Sequence[Any]) -> dict[str, Any]:
        """Gears and wheels are of the plane."""
        return {}

    def outputs(self, x: Sequence[Any]) -> dict[str, Any]:
        """Coordinates of moving points, and angles of the links that have a reference arc."""
        found = {}
        for i, name in enumerate(self.moving):
            found.update({f"{axis}:{name}": x[3 * i + k] for k, axis in enumerate("xyz")})
        first = 3 * len(self.moving)
        found.update({f"angle:{name}": x[first + i] for i, name in enumerate(self.turning)})
        return found

    def guess(self, points: Mapping[str, Sequence[float]], angles: Mapping[str, float]) -> list[Any]:
        """Unknowns from rough places of points, and angles of links where they are not those in (-pi, pi]."""
        at = {**self.frame, **{name: self.vector(points[name]) for name in self.moving}}
        found = [angles.get(link, self.roughly(link, at)) for link in self.turning]
        return [c for name in self.moving for c in at[name]] + [self.field.number(a) for a in found]

    def roughly(self, link: str, places: Mapping[str, Vector]) -> float:
        """Angle of a link between places, in (-pi, pi]."""
        pivot, mark = (places[point] for point in self.parts["links"][link]["reference"])
        end = places[list(self.local[link])[1]]
        towards = added(mark, scaled(pivot, -dot(pivot, mark)))
        return math.atan2(float(dot(cross(pivot, mark), end)), float(dot(towards, end)))
