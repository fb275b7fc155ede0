"""The numbers of a description: what varies in sweeps while the structure stays."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from math import hypot
from typing import Any, TypeAlias

from centrode.errors import InputError
from centrode.geometry.plane import Vector
from centrode.locale import _
from centrode.model.mechanism import FRAME, Guide, Link, Mechanism

Number: TypeAlias = Any
Namespace: TypeAlias = Any


@dataclass(frozen=True)
class Dimensions:
    """Lengths, coordinates and directions of one mechanism, or of a batch of mechanisms of one structure.

    Every number is a float [m, or the components of a unit vector], or an array with one value a mechanism.

    Attributes
    ----------
    frame : point -> coordinates of the fixed points
    local : link -> point -> coordinates in the link's axes
    through, direction : guide -> point and unit vector of its line, in the axes of the body that carries it
    turn : guide -> rotor of the constant angle from that body to the guided link
    bodies : guide -> the body that carries it
    """

    frame: Mapping[str, Vector]
    local: Mapping[str, Mapping[str, Vector]]
    through: Mapping[str, Vector]
    direction: Mapping[str, Vector]
    turn: Mapping[str, Vector]
    bodies: Mapping[str, str]

    def mapped(self, function: Callable[[Number], Number]) -> Dimensions:
        """The same dimensions with every number replaced by function(number)."""

        def vectors(pairs: Mapping[str, Vector]) -> dict[str, Vector]:
            return {name: (function(v[0]), function(v[1])) for name, v in pairs.items()}

        return Dimensions(
            vectors(self.frame),
            {link: vectors(points) for link, points in self.local.items()},
            vectors(self.through),
            vectors(self.direction),
            vectors(self.turn),
            self.bodies,
        )

    @cached_property
    def scale(self) -> Number:
        """Greatest length in the mechanism [m]: what lengths and residuals are compared with.

        Distances within links and within the frame count, and those of guide lines from their bodies; where the
        origin lies does not.
        """
        longest: Number = 0.0
        for points in (self.frame, *self.local.values()):
            first = next(iter(points.values()), None)
            for x, y in points.values():
                if first is not None:
                    longest = _larger(longest, _size(x - first[0], y - first[1]))
        for guide, on in self.bodies.items():
            points = self.frame if on == FRAME else self.local[on]
            through, direction = self.through[guide], self.direction[guide]
            for x, y in list(points.values())[:1]:
                offset = direction[0] * (through[1] - y) - direction[1] * (through[0] - x)
                longest = _larger(longest, _size(offset, 0.0))
        # sliders alone have no length of their own
        return 1.0 if isinstance(longest, float) and longest == 0.0 else longest


def _size(x: Number, y: Number) -> Number:
    return hypot(x, y) if isinstance(x, float) and isinstance(y, float) else (x * x + y * y) ** 0.5


def _larger(a: Number, b: Number) -> Number:
    if isinstance(a, float) and isinstance(b, float):
        return max(a, b)
    return 0.5 * (a + b + abs(a - b))


def dimensions_of(
    mechanism: Mechanism, varied: Mapping[str, Number] | None = None, m: Namespace = math
) -> Dimensions:
    """Numbers of a description, those named in `varied` replaced.

    `varied` maps paths ("links.AC.length", "links.K.points.P.y", "frame.points.D.x", "guides.C.through.y",
    "guides.C.direction") to floats, or with a namespace `m` of arrays to arrays, one value a mechanism
    [m or rad].

    Raises InputError if a guide goes through a point that is not on its body, or a path names no dimension.
    """
    values = _Values(dict(varied or {}), m)
    frame = {name: values.vector(f"frame.points.{name}", at) for name, at in mechanism.frame.points.items()}
    local = {name: _local(name, link, values) for name, link in mechanism.links.items()}
    through, direction, turn = {}, {}, {}
    for guide in mechanism.guides:
        places = frame if guide.on == FRAME else local[guide.on]
        through[guide.id] = _through(guide, places, values)
        direction[guide.id] = values.direction(f"guides.{guide.id}.direction", guide.unit)
        angle = mechanism.guide_turn(guide)
        turn[guide.id] = (math.cos(angle), math.sin(angle)) if angle else (1.0, 0.0)
    values.refuse_the_rest()
    bodies = {guide.id: guide.on for guide in mechanism.guides}
    return Dimensions(frame, local, through, direction, turn, bodies)


def _local(name: str, link: Link, values: _Values) -> dict[str, Vector]:
    if link.length is None:
        return {
            point: values.vector(f"links.{name}.points.{point}", at) for point, at in link.coordinates.items()
        }
    first, second = link.coordinates
    return {first: (0.0, 0.0), second: (values.length(f"links.{name}.length", link.length), 0.0)}


def _through(guide: Guide, places: Mapping[str, Vector], values: _Values) -> Vector:
    if not isinstance(guide.through, str):
        return values.vector(f"guides.{guide.id}.through", guide.through)
    if guide.through not in places:
        raise InputError(
            _("guide {guide}").format(guide=guide.id),
            _("point {point} does not lie on {body}").format(point=guide.through, body=guide.on),
            _("give coordinates, or a point of {body}").format(body=guide.on),
        )
    return places[guide.through]


class _Values:
    """Numbers by path: the varied one where there is one, else the description's own."""

    def __init__(self, varied: dict[str, Number], m: Namespace) -> None:
        self.varied = varied
        self.m = m
        self.used: set[str] = set()

    def number(self, path: str, own: float) -> Number:
        self.used.add(path)
        return self.varied.get(path, float(own))

    def length(self, path: str, own: float) -> Number:
        value = self.number(path, own)
        least = value if isinstance(value, float) else value.min()
        if not least > 0.0:
            raise InputError(path, _("length must be positive, got {value:g}").format(value=least))
        return value

    def vector(self, path: str, own: Any) -> Vector:
        # a point that the description places carries its resolved coordinates
        x, y = getattr(own, "at", own)
        return self.number(f"{path}.x", x), self.number(f"{path}.y", y)

    def direction(self, path: str, own: Vector) -> Vector:
        self.used.add(path)
        angle = self.varied.get(path)
        return own if angle is None else (self.m.cos(angle), self.m.sin(angle))

    def refuse_the_rest(self) -> None:
        for path in self.varied:
            if path not in self.used:
                raise InputError(
                    path,
                    _("it names no dimension of the mechanism"),
                    _("one of: {paths}").format(paths=", ".join(sorted(self.used)[:12])),
                )
