"""Which links turn with the crank and which swing, in closed form: where their angles stand, without a mesh.

As long as a dyad closes, its moving hinge keeps to one side of the line between its centres, or of the foot on a
guide. So the angle of each of its links stays within half a turn of the direction of that line, to one side. The
direction itself is a trigonometric polynomial of the crank's angle. Where one of its three coefficients is longer than
the others together it stays within a quarter of a turn of that coefficient: it swings if that is the constant one, and
turns with the crank or against it otherwise. Of a crank in the plane this is the distinction between rocker and crank.
Textbook: Dizioğlu, Getriebelehre (1965).
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.geometry.plane import rotate_vector
from centrode.geometry.plane import subtract as subtract_in_plane
from centrode.geometry.sphere import components, subtract, tangent
from centrode.kinematics.dyads import aim_curve
from centrode.kinematics.machine_code.trace import Traced
from centrode.kinematics.machine_code.variables import (
    AWAY,
    PARAMETER,
    TURN,
    Pass,
    centre_of,
    places_of,
    whole_turns,
    winding_of,
)
from centrode.kinematics.samples import ORDERS
from centrode.numerics.expressions import EXPRESSIONS, Node, Operand, as_node, variable
from centrode.numerics.rounding_bounds import SAFETY, UNIT_ROUNDOFF
from centrode.numerics.scans import Reduction
from centrode.numerics.trigonometric_polynomials import (
    TrigonometricPolynomial,
    half,
    length,
    minus,
    plus,
    polynomials_of,
    times,
)
from centrode.structure.groups import Aim, Meet, Rail, Rod

Array: TypeAlias = npt.NDArray[np.float64]
Mask: TypeAlias = npt.NDArray[np.bool_]
Place: TypeAlias = tuple[Any, ...]
Vector: TypeAlias = tuple[Operand, Operand]

m = EXPRESSIONS
RESERVE = 1e-8
"""Share by which a coefficient is longer than the others: the direction keeps 1e-4 rad from a quarter of a turn."""
QUARTER = math.pi / 2.0
MIDDLE, SENSE, INITIAL, SURE = "middle of", "sense of", "initial angle of", "sure of"


@dataclass(frozen=True)
class LinkHeading:
    """A direction, and an angle to add: a link's angle stays within a quarter of a turn of the sum."""

    along: Vector
    further: Operand


@dataclass(frozen=True)
class FoundRotation:
    """Of mechanisms (lanes,): of which all angles are told, and of these which begin near those of the description.

    `values` are centres and windings; the turns of an angle that begins half a turn off are counted by the arrays.
    """

    told: Mask
    near: Mask
    values: dict[str, Array]


@dataclass(frozen=True)
class LinkRotation:
    """Closed forms of where the angles of links stand.

    Attributes
    ----------
    headings : link -> X and Y of its direction as polynomials of the drive's angle, and the angle to add
    names : what may be known of mechanisms
    """

    traced: Traced
    headings: Mapping[str, tuple[TrigonometricPolynomial, TrigonometricPolynomial, Operand]]
    names: tuple[str, ...]

    @classmethod
    def of(cls, traced: Traced, links: tuple[str, ...], names: tuple[str, ...]) -> LinkRotation:
        """Those of the links whose direction is a polynomial of one wave."""
        path = traced.solved.ready.kinematics.path
        if path.by_time or traced.steps or path.driven[0].drive.kind != "angle":
            return cls(traced, {}, names)
        # the angle of what a crank carries along is told by its own cosine and sine
        known = {link: LinkHeading(traced.turning[link], 0.0) for link in links}
        known |= {link: heading for link, heading in _headings(traced) if link in links}
        nodes = [as_node(x) for heading in known.values() for x in heading.along]
        polynomials = polynomials_of(nodes, PARAMETER)
        found = {}
        for link, heading in known.items():
            x, y = (polynomials.get(as_node(x)) for x in heading.along)
            # the frequency is that of the drive: a link that a gear turns is not told
            if x is not None and y is not None and {*x.waves, *y.waves} <= {1.0}:
                found[link] = x, y, heading.further
        return cls(traced, found, names)

    def judge(self, values: Mapping[str, Array], kernels: str, threads: int) -> FoundRotation:
        """Judge mechanisms all of whose groups close."""
        lanes = len(next(iter(values.values())))
        told, near, further = np.ones(lanes, dtype=bool), np.ones(lanes, dtype=bool), dict[str, Array]()
        found = self._at_start.run(values, kernels, threads)
        drive = next(iter(self.traced.winders))
        for link in self.headings:
            start = self.traced.solved.ready.assembled.angles[link]
            off = start - found[f"{INITIAL} {link}"]
            whole = np.round(off / TURN)
            # moved by whole turns to where the initial position of the description has the angle
            further[centre_of(link)] = found[f"{MIDDLE} {link}"] + TURN * whole
            further[winding_of(link, drive)] = found[f"{SENSE} {link}"]
            told &= found[f"{SURE} {link}"] > 0.0
            near &= np.abs(off - TURN * whole) < np.pi - AWAY
        return FoundRotation(told, told & near, further)

    @cached_property
    def _at_start(self) -> Pass:
        state: dict[str, Node] = {}
        for link, (x, y, added) in self.headings.items():
            middle, sense, sure = _swing(x, y)
            middle = as_node(middle + added)
            cosine, sine = self.traced.turning[link]
            angle = m.atan2(sine, cosine)
            near = middle + sense * variable(PARAMETER)
            state[f"{MIDDLE} {link}"], state[f"{SENSE} {link}"] = middle, as_node(sense)
            state[f"{INITIAL} {link}"] = as_node(angle + TURN * whole_turns(near, angle))
            state[f"{SURE} {link}"] = as_node(sure)
        path = self.traced.solved.ready.kinematics.path
        places = places_of(path, np.array([path.initial]), ORDERS - 1)
        # whole turns hang on no last bit: centres are 1e-4 rad clear of where they would
        return Pass(Reduction(state, dict.fromkeys(state, 0.0)), self.names, places, compiled=True)


def _swing(x: TrigonometricPolynomial, y: TrigonometricPolynomial) -> tuple[Operand, Operand, Operand]:
    """Angle and sense of the longest coefficient of x + i y, and a number above zero where it outweighs the others.

    With e = exp(i q) the direction is c0 + c1 e + c2 / e.
    """
    (a, b), (c, d) = (p.waves.get(1.0, (0.0, 0.0)) for p in (x, y))
    coefficients = [
        (0.0, (x.constant, y.constant)),
        (1.0, (half(plus(a, d)), half(minus(c, b)))),
        (-1.0, (half(minus(a, d)), half(plus(b, c)))),
    ]
    sense: Operand
    (sense, longest), *others = coefficients
    most: Operand = length(*longest)
    whole = most
    for turn, vector in others:
        size = length(*vector)
        whole = plus(whole, size)
        longer = m.less(most, size)
        most, sense = m.where(longer, size, most), m.where(longer, turn, sense)
        longest = m.where(longer, vector[0], longest[0]), m.where(longer, vector[1], longest[1])
    error = times(SAFETY * UNIT_ROUNDOFF, plus(x.error, y.error))
    sure = minus(times(2.0 - RESERVE, most), plus(whole, error))
    return m.atan2(longest[1], longest[0]), sense, sure


def _headings(traced: Traced) -> Iterator[tuple[str, LinkHeading]]:
    """Links of dyads on known places, each with the direction that its angle keeps to one side of."""
    ready = traced.solved.ready
    signs = ready.assembled.signs
    for k, group in enumerate(ready.structure.groups):
        if isinstance(group, Meet) and group.carriage is None and len(group.points) == 1:
            if ready.kinematics.numbers.space.crosses_once:
                yield from _of_meeting_in_plane(traced, group, float(signs[k]) if k in signs else 0.0)
            elif k in signs:
                yield from _of_meeting_on_sphere(traced, group, float(signs[k]))
        elif isinstance(group, Aim) and k in signs and ready.kinematics.numbers.space.crosses_once:
            yield from _of_aim(traced, group, float(signs[k]))


def _of_meeting_in_plane(traced: Traced, group: Meet, sign: float) -> Iterator[tuple[str, LinkHeading]]:
    """RRR: the hinge lies to the left of the way from centre to centre for a positive sign; RRP: ahead of the foot."""
    numbers, at = traced.solved.ready.kinematics.numbers, traced.at
    one, other = group.loci
    if not sign or not isinstance(one, Rod):
        return
    if isinstance(other, Rod):
        for rod, far, side in ((one, other, sign), (other, one, -sign)):
            away = subtract_in_plane(at.points[far.centre], at.points[rod.centre])
            yield rod.link, LinkHeading(away, side * QUARTER - _inside(traced, rod))
    elif isinstance(other, Rail):
        guide = rotate_vector(numbers.direction[other.guide], at.poses[other.on].rotor)
        yield one.link, LinkHeading(guide, (0.0 if sign > 0.0 else math.pi) - _inside(traced, one))


def _of_meeting_on_sphere(traced: Traced, group: Meet, sign: float) -> Iterator[tuple[str, LinkHeading]]:
    """RRR on the sphere: as in the plane, angles being measured at a link's first point from its reference arc."""
    numbers, at = traced.solved.ready.kinematics.numbers, traced.at
    one, other = group.loci
    if not isinstance(one, Rod) or not isinstance(other, Rod):
        return
    for rod, far, side in ((one, other, sign), (other, one, -sign)):
        first, second = list(numbers.local[rod.link])[:2]
        if (first, second) != (rod.centre, rod.point) or not numbers.ends.get(rod.link):
            continue
        pivot, (end,) = at.points[rod.centre], numbers.ends[rod.link]
        zero = tangent(pivot, at.points[end])
        way = subtract(at.points[far.centre], pivot)
        yield rod.link, LinkHeading(components(way, zero, pivot), side * QUARTER)


def _of_aim(traced: Traced, group: Aim, sign: float) -> Iterator[tuple[str, LinkHeading]]:
    """RPR: for a positive sign the target lies ahead of the foot of the pivot on the guide."""
    numbers, at = traced.solved.ready.kinematics.numbers, traced.at
    away = subtract_in_plane(at.points[group.target], at.points[group.pivot])
    x, y = aim_curve(group, numbers)[1]
    further = (0.0 if sign > 0.0 else math.pi) - _direction(x, y)
    yield group.link, LinkHeading(away, further)
    if group.block is not None:
        x, y = numbers.turn[group.guide]
        yield group.block, LinkHeading(away, further + _direction(x, y))


def _inside(traced: Traced, rod: Rod) -> Operand:
    """Angle in the link's own axes of the way from the centre to the meeting point."""
    local = traced.solved.ready.kinematics.numbers.local[rod.link]
    x, y = subtract_in_plane(local[rod.point], local[rod.centre])
    return _direction(x, y)


def _direction(x: Operand, y: Operand) -> Operand:
    if isinstance(x, float) and isinstance(y, float):
        return math.atan2(y, x)
    return m.atan2(y, x)
