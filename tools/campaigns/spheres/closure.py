"""Closure equations of a grown spherical chain: unit vectors of the points that move, cosines of arcs between them.

The crank's tip is a formula of its angle, points that are rigid with others are sums of these; every other moving point
has three unknown coordinates, the unit of its length, and the two arcs that hold it.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import mpmath
import numpy as np

from tools.campaigns.closure.equations import EXACT, Equations, Functions
from tools.campaigns.grown.sphere import Growing

Vector = tuple[Any, Any, Any]


class Closure(Equations):
    """The equations of a grown spherical chain that one crank drives."""

    def __init__(self, growing: Growing) -> None:
        self.growing = growing
        self.drive = growing.drives[0]
        self.begun = float(self.drive["start"])
        self.crank = growing.links[self.drive["link"]]
        self.tip = list(self.crank["points"])[1]
        self.rigid: dict[str, tuple[str, Any]] = {}
        for name, link in growing.links.items():
            for point in list(link["points"])[2:]:
                self.rigid[point] = (name, link["points"][point])
        known = {*growing.frame, self.tip, *self.rigid}
        self.free = [point for point in growing.places if point not in known]
        self.points = [*growing.frame, self.tip, *self.rigid, *self.free]
        self.start = np.concatenate([growing.places[point] for point in self.free] or [np.zeros(0)])
        self.length = 1.0

    def places(self, x: Sequence[Any], q: Any, m: Functions) -> list[Any]:
        """Coordinates of all points, one after the other."""
        found = self._places(x, q, m)
        return [u for point in self.points for u in found[point]]

    def residual(self, x: Sequence[Any], q: Any, m: Functions) -> list[Any]:
        """What vanishes where the crank stands at q."""
        at = self._places(x, q, m)
        found = [dot(at[point], at[point]) - 1 for point in self.free]
        for name, link in self.growing.links.items():
            if name != self.drive["link"]:
                first, second = list(link["points"])[:2]
                found.append(dot(at[first], at[second]) - self._cosine(link, m))
        for guide in self.growing.guides:
            pole = self._carried(at, guide["on"], guide["pole"], m)
            found.append(dot(pole, at[guide["point"]]) - m.cos(number(guide["radius"], m)))
        return found

    def _cosine(self, link: dict[str, Any], m: Functions) -> Any:
        """Cosine of the arc between the first two points of a link."""
        if "length" in link:
            return m.cos(number(link["length"], m))
        first, second = list(link["points"])[:2]
        return dot(vector(link["points"][first], m), vector(link["points"][second], m))

    def _places(self, x: Sequence[Any], q: Any, m: Functions) -> dict[str, Vector]:
        found = {name: vector(at, m) for name, at in self.growing.frame.items()}
        found |= {name: (x[3 * k], x[3 * k + 1], x[3 * k + 2]) for k, name in enumerate(self.free)}
        pivot, towards = (found[name] for name in self.crank["reference"])
        cosine = self._cosine(self.crank, m)
        sine = m.sqrt(1 - cosine * cosine)
        tangent = along(pivot, towards, m)
        square, c, s = cross(pivot, tangent), m.cos(q), m.sin(q)
        found[self.tip] = added((cosine, pivot), (sine * c, tangent), (sine * s, square))
        left = dict(self.rigid)
        while left:
            for name, (body, local) in list(left.items()):
                if all(point in found for point in list(self.growing.links[body]["points"])[:2]):
                    found[name] = self._carried(found, body, local, m)
                    del left[name]
        return found

    def _carried(self, at: dict[str, Vector], body: str, local: Sequence[float], m: Functions) -> Vector:
        """A place of a body, from where its first two points are."""
        if body == "frame":
            return vector(local, m)
        link = self.growing.links[body]
        first, second = list(link["points"])[:2]
        if isinstance(link["points"], dict):
            one, other = (vector(link["points"][name], m) for name in (first, second))
        else:
            arc = number(link["length"], m)
            one, other = (1, 0, 0), (m.cos(arc), m.sin(arc), 0)
        axes = (one, along(one, other, m), cross(one, along(one, other, m)))
        tangent = along(at[first], at[second], m)
        here = (at[first], tangent, cross(at[first], tangent))
        place = vector(local, m)
        return added(*((dot(place, axis), now) for axis, now in zip(axes, here, strict=True)))


def number(x: float, m: Functions) -> Any:
    """A double as a number of a kind."""
    return mpmath.mpf(x) if m is EXACT else x


def vector(at: Sequence[float], m: Functions) -> Vector:
    """The unit vector of a longitude and a latitude."""
    longitude, latitude = (number(u, m) for u in at)
    c = m.cos(latitude)
    return c * m.cos(longitude), c * m.sin(longitude), m.sin(latitude)


def dot(u: Vector, v: Vector) -> Any:
    """Scalar product."""
    return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]


def cross(u: Vector, v: Vector) -> Vector:
    """Vector product."""
    return u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]


def added(*terms: tuple[Any, Vector]) -> Vector:
    """A sum of multiples of vectors."""
    x, y, z = (sum(factor * v[k] for factor, v in terms) for k in range(3))
    return x, y, z


def along(u: Vector, v: Vector, m: Functions) -> Vector:
    """The unit tangent in u of the arc towards v."""
    apart = dot(u, v)
    rest = added((1, v), (-apart, u))
    length = m.sqrt(dot(rest, rest))
    return rest[0] / length, rest[1] / length, rest[2] / length
