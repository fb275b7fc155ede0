"""The numbers of a description: what varies in sweeps while the structure stays."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, TypeAlias

from centrode.errors import InputError
from centrode.geometry.in_plane import PLANE
from centrode.geometry.on_sphere import SPHERE
from centrode.geometry.plane import Vector
from centrode.geometry.space import Curve, Place, Reference, Space
from centrode.locale import _
from centrode.model.mechanism import FRAME, Guide, Link, Mechanism
from centrode.numerics.operations import PLAIN
from centrode.structure.gearing import Gearing, Round, gearing_of, measured_on, shares_of

# Where the angles of spherical links are measured: between the link's own arc and its reference arc.

Local: TypeAlias = Mapping[str, tuple[Any, Any]]


def ends_of(mechanism: Mechanism) -> dict[str, tuple[str, ...]]:
    """End of the reference arc of every link that has one; it starts at the link's first point."""
    return {name: link.reference[1:] for name, link in mechanism.links.items() if link.reference is not None}


def references_of(
    mechanism: Mechanism,
    frame: Local,
    local: Mapping[str, Local],
    ends: Mapping[str, tuple[str, ...]],
) -> dict[str, tuple[Any, ...]]:
    """Of driven links and those of gears: ends of the own arc, and of the reference arc in the base's axes."""
    references = {
        link: reference_arcs(link, body, frame, local, ends) for link, body in measured_on(mechanism).items()
    }
    for drive in mechanism.drives:
        if drive.link is None:
            continue
        pivot, second = list(local[drive.link])[:2]
        (towards,) = ends[drive.link]
        base = frame if drive.relative_to == FRAME else local[drive.relative_to]
        missing = [point for point in (pivot, towards) if point not in base]
        if missing:
            what = _("its reference arc has to lie on {body}, but {point} is not a point of {body}")
            if drive.relative_to == FRAME:
                what = _("its reference arc has to lie on the frame, but {point} is not a point of it")
            raise InputError(
                _("drive of link {link}").format(link=drive.link),
                what.format(body=drive.relative_to, point=missing[0]),
                _("drive it relative to the link that has both points, or choose other points"),
            )
        own = local[drive.link]
        references[drive.link] = (own[pivot], own[second], base[pivot], base[towards])
    return references


def reference_arcs(
    link: str, body: str, frame: Local, local: Mapping[str, Local], ends: Mapping[str, tuple[str, ...]]
) -> tuple[Any, ...]:
    """Ends of a link's own arc in its axes, and of its reference arc in the axes of the body that carries it."""
    # the angle lies between the own arc and the arc from the same pivot to the end of the reference
    pivot, second = list(local[link])[:2]
    base = frame if body == FRAME else local[body]
    return local[link][pivot], local[link][second], base[pivot], base[ends[link][0]]


Number: TypeAlias = Any
Namespace: TypeAlias = Any
SPACES: Mapping[str, Space] = {space.name: space for space in (PLANE, SPHERE)}
QUARTER = math.pi / 2
"""Arc of a guide's circle where none is given: a great circle."""


@dataclass(frozen=True)
class Dimensions:
    """Lengths, coordinates and directions of one mechanism, or of a batch of mechanisms of one structure.

    Every number is a float [m, or the components of a unit vector; on the sphere rad], or an array with one
    value a mechanism.

    Attributes
    ----------
    frame : point -> coordinates of the fixed points
    local : link -> point -> coordinates in the link's axes
    through, direction : guide -> its curve in the axes of the body that carries it: point and unit vector of
        a line, on the sphere pole and (arc,) of a circle
    turn : guide -> rotor of the constant angle from that body to the guided link
    bodies : guide -> the body that carries it
    space : the geometry, chosen here and nowhere else
    ends : link whose angle is measured -> what it is measured from: on the sphere the end of the reference arc,
        which starts at the link's first point; in the plane no point
    references : driven link -> on the sphere the ends of its own arc and of the reference arc, each in the
        axes of its body
    gearing : numbers of gears and rolling wheels
    """

    frame: Mapping[str, Vector]
    local: Mapping[str, Mapping[str, Vector]]
    through: Mapping[str, Vector]
    direction: Mapping[str, Vector]
    turn: Mapping[str, Vector]
    bodies: Mapping[str, str]
    space: Space = PLANE
    ends: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    references: Mapping[str, tuple[Vector, ...]] = field(default_factory=dict)
    gearing: Gearing = field(default_factory=Gearing)

    def map_numbers(self, function: Callable[[Number], Number]) -> Dimensions:
        """Dimensions whose every number is function(number) of these."""

        def vectors(pairs: Mapping[str, Vector]) -> dict[str, Vector]:
            return {name: tuple(map(function, v)) for name, v in pairs.items()}

        return replace(
            self,
            frame=vectors(self.frame),
            local={link: vectors(points) for link, points in self.local.items()},
            through=vectors(self.through),
            direction=vectors(self.direction),
            turn=vectors(self.turn),
            references={
                link: tuple((function(x), function(y)) for x, y in arcs)
                for link, arcs in self.references.items()
            },
            gearing=self.gearing.map_numbers(function),
        )

    @cached_property
    def alone(self) -> bool:
        """Whether these are the dimensions of one mechanism: plain numbers, and no arrays."""
        plain = True

        def look(x: Number) -> Number:
            nonlocal plain
            plain = plain and isinstance(x, float)
            return x

        self.map_numbers(look)
        return plain

    def curve(self, guide: str) -> Curve:
        """Where a guide's point can be, in the axes of the body that carries it."""
        return self.through[guide], self.direction[guide]

    def reference(self, link: str) -> Reference:
        """Vectors between which a driven link's angle is measured; None where these are its axes."""
        return self.references.get(link)

    @cached_property
    def scale(self) -> Number:
        """Greatest length in the mechanism [m, rad on the sphere]: what lengths and residuals are compared with.

        Distances within links and within the frame count, and those of guides from their bodies; where the
        origin lies does not.
        """
        longest: Number = 0.0
        for points in (self.frame, *self.local.values()):
            places = [self._inside(at) for at in points.values()]
            for at in places:
                # from the first point only: within a factor of two the greatest distance, and one pass
                longest = _larger(longest, self.space.distance(PLAIN, at, places[0]))
        for guide, on in self.bodies.items():
            points = self.frame if on == FRAME else self.local[on]
            # a guide's distance from one point of its body, as the point it goes through may lie anywhere
            # along it
            for at in list(points.values())[:1]:
                reach = self.space.reach(PLAIN, self.curve(guide), self._inside(at))
                longest = _larger(longest, reach)
        for radius in self.gearing.radius.values():
            longest = _larger(longest, radius)
        for track in self.gearing.track.values():
            longest = _larger(longest, track.radius) if isinstance(track, Round) else longest
        # sliders alone have no length of their own
        return 1.0 if isinstance(longest, float) and longest == 0.0 else longest

    def _inside(self, local: Vector) -> Place:
        """Place of a point as its own body sees it."""
        return self.space.place(PLAIN, self.space.at_rest, local)


def _larger(a: Number, b: Number) -> Number:
    if isinstance(a, float) and isinstance(b, float):
        return max(a, b)
    # the greater of two arrays without an array library: (a + b + |a - b|) / 2
    return 0.5 * (a + b + abs(a - b))


def dimensions_of(
    mechanism: Mechanism, varied: Mapping[str, Number] | None = None, m: Namespace = math
) -> Dimensions:
    """Numbers of a description, those named in `varied` replaced.

    `varied` maps paths ("links.AC.length", "links.K.points.P.y", "frame.points.D.x", "guides.C.through.y",
    "guides.C.direction"; on the sphere "frame.points.D.longitude", "guides.C.pole.latitude",
    "guides.C.radius") to floats, or with a namespace `m` of arrays to arrays, one value a mechanism [m or rad].

    Raises InputError if a guide goes through a point that is not on its body, a driven link has no reference
    arc, or a path names no dimension.
    """
    space = SPACES[mechanism.space]
    values = _Values(dict(varied or {}), m, space)
    frame = {name: values.vector(f"frame.points.{name}", at) for name, at in mechanism.frame.points.items()}
    local = {name: _local(name, link, values) for name, link in mechanism.links.items()}
    through, direction, turn = {}, {}, {}
    for guide in mechanism.guides:
        places = frame if guide.on == FRAME else local[guide.on]
        curve = _circle if space is SPHERE else _line
        through[guide.id], direction[guide.id] = curve(guide, places, values)
        angle = mechanism.guide_turn(guide)
        # an angle of zero gives exact numbers, and literal zeros cost nothing in formulas
        turn[guide.id] = (math.cos(angle), math.sin(angle)) if angle else (1.0, 0.0)
    gearing = gearing_of(mechanism, lambda body: frame if body == FRAME else local[body], values)
    # masses may vary too, and no dimension is missing because a motion does not need them
    values.used |= _paths_of_masses(mechanism)
    values.refuse_the_rest()
    bodies = {guide.id: guide.on for guide in mechanism.guides}
    ends: dict[str, tuple[str, ...]] = {name: () for name in mechanism.links}
    references = {}
    if space is SPHERE:
        ends = ends_of(mechanism)
        references = references_of(mechanism, frame, local, ends)
        shares = {gear.id: shares_of(mechanism, gear.id) for gear in mechanism.gears}
        gearing = replace(gearing, shares=shares, measured=measured_on(mechanism))
    return Dimensions(frame, local, through, direction, turn, bodies, space, ends, references, gearing)


def _paths_of_masses(mechanism: Mechanism) -> set[str]:
    """Paths of numbers that a motion does not depend on."""
    axes = SPHERE.coordinates if mechanism.space == SPHERE.name else ("x", "y")
    keys = ("mass", "inertia", "radius", "centre_radius", *(f"centre.{axis}" for axis in axes))
    return {f"links.{name}.{key}" for name in mechanism.links for key in keys}


def _local(name: str, link: Link, values: _Values) -> dict[str, Vector]:
    # a plate has points of its own; a link of two points lies along its first axis
    if link.length is None:
        return {
            point: values.vector(f"links.{name}.points.{point}", at) for point, at in link.coordinates.items()
        }
    first, second = link.coordinates
    return {first: (0.0, 0.0), second: (values.length(f"links.{name}.length", link.length), 0.0)}


def _line(guide: Guide, places: Mapping[str, Vector], values: _Values) -> Curve:
    return (
        _spot(guide, "through", guide.through, places, values),
        values.direction(f"guides.{guide.id}.direction", guide.unit),
    )


def _circle(guide: Guide, places: Mapping[str, Vector], values: _Values) -> Curve:
    arc = values.length(f"guides.{guide.id}.radius", QUARTER if guide.radius is None else guide.radius)
    return _spot(guide, "pole", guide.pole, places, values), (arc,)


def _spot(guide: Guide, key: str, spot: Any, places: Mapping[str, Vector], values: _Values) -> Vector:
    """A point that tells where a guide lies: coordinates, or a point of the body that carries it."""
    if not isinstance(spot, str):
        return values.vector(f"guides.{guide.id}.{key}", spot)
    if spot not in places:
        what, repair = _("point {point} does not lie on {body}"), _("give coordinates, or a point of {body}")
        if guide.on == FRAME:
            what = _("point {point} does not lie on the frame")
            repair = _("give coordinates, or a point of the frame")
        raise InputError(
            _("guide {guide}").format(guide=guide.id),
            what.format(point=spot, body=guide.on),
            repair.format(body=guide.on),
        )
    return places[spot]


class _Values:
    """Numbers by path: the varied one where there is one, else the description's own."""

    def __init__(self, varied: dict[str, Number], m: Namespace, space: Space) -> None:
        self.varied = varied
        self.m = m
        self.space = space
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
        first, second = self.space.coordinates
        return self.number(f"{path}.{first}", x), self.number(f"{path}.{second}", y)

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
