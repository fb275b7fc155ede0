"""From a spherical mechanism to its unknowns and constraints in symbols: the closures of its dyads in arcs.

The new point R of a dyad is carried on a circle about S by an arc or by a guide, and held by an arc from O. The first
closure is cos OR by the places of both, the second the law of cosines in the triangle S, R, O.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from centrode.equations.linear import Draft, LinearConstraint
from centrode.equations.symbol_table import Lettering
from centrode.equations.symbols import (
    BEARING,
    ROUNDING,
    SIMPLE,
    TURN,
    ZERO,
    Angle,
    Letter,
    Sum,
    merge_waves,
    quarters_of,
)
from centrode.errors import InputError
from centrode.kinematics.preparation import Ready
from centrode.locale import _
from centrode.model.values import makes_arc, unit_vector
from centrode.structure.constraints import FRAME
from centrode.structure.groups import Group, Meet, Rail, RigidPoint, Rod, TurnedLink, Turning, TwoPointLink

# Attitudes on the sphere in symbols: three axes, turned about the first by angles and about the third by
# arcs.


class SpherePlace(NamedTuple):
    """A place on the unit sphere: its coordinates, each a sum."""

    x: Sum
    y: Sum
    z: Sum

    def dot(self, other: SpherePlace) -> Sum:
        """Cosine of the arc to another place."""
        return merge_waves(self.x * other.x + self.y * other.y + self.z * other.z)


class Axes(NamedTuple):
    """A place, the direction of an arc that starts there, and the one to the left of it, seen from outside."""

    at: SpherePlace
    along: SpherePlace
    left: SpherePlace

    def turned_by(self, angle: Angle) -> Axes:
        """Turned in its place, counter-clockwise seen from outside."""
        cosine, sine = Sum.wave("cos", angle), Sum.wave("sin", angle)
        return Axes(
            self.at,
            _combine_places(cosine, self.along, sine, self.left),
            _combine_places(-sine, self.along, cosine, self.left),
        )

    def move(self, arc: Angle) -> Axes:
        """Moved on along the arc."""
        cosine, sine = Sum.wave("cos", arc), Sum.wave("sin", arc)
        return Axes(
            _combine_places(cosine, self.at, sine, self.along),
            _combine_places(-sine, self.at, cosine, self.along),
            self.left,
        )

    def leaning(self, angle: Angle, side: int) -> Axes:
        """Directed to where it came from, then turned to the side by a right angle less `angle`."""
        cosine, sine = Sum.wave("cos", angle).scale(side), Sum.wave("sin", angle)
        return Axes(
            self.at,
            _combine_places(-sine, self.along, cosine, self.left),
            _combine_places(-cosine, self.along, -sine, self.left),
        )


def _combine_places(a: Sum, one: SpherePlace, b: Sum, other: SpherePlace) -> SpherePlace:
    return SpherePlace(*(merge_waves(a * x + b * y) for x, y in zip(one, other, strict=True)))


NOUGHT, UNIT = ZERO, Sum.number(1)
AXES = Axes(
    SpherePlace(UNIT, NOUGHT, NOUGHT), SpherePlace(NOUGHT, UNIT, NOUGHT), SpherePlace(NOUGHT, NOUGHT, UNIT)
)
"""Those in which everything is written."""
BACK = Angle((), 2)


class SphereClosure(NamedTuple):
    """A dyad that is solved: the angles that its two conditions give, and the triangle that decides between answers.

    Attributes
    ----------
    plan : number of the group
    turn, lean : letters of the angle about the carrying centre and of that to the path
    closing, leaning : their conditions
    places : the carrying centre, the holding one, and the new point
    label : what the group of the second angle is called
    """

    plan: int
    turn: Letter
    closing: LinearConstraint
    lean: Letter
    leaning: LinearConstraint
    places: tuple[str, str, str]
    label: str


# The board of the sphere: bodies by arcs from their first point, turned in it by angles.

Vector = npt.NDArray[np.float64]

ARC = -500_000
"""Arcs stand before the angles of links."""
LONGEST = 16
"""Terms of the longest coordinate of a place on which anything more is laid."""


class SphereBoard(Lettering):
    """Symbols of everything that is known so far on the sphere.

    Everything is written in axes of the frame: the first through its first pivot, the second in the half-plane of
    the arc from there to its second pivot, the third square to both.
    """

    def __init__(self, ready: Ready, pivots: list[str]) -> None:
        super().__init__(ready)
        self.axes: dict[str, Axes] = {}
        """Of every placed body, in its first point along the arc to its second."""
        self.firsts: dict[str, tuple[str, str]] = {}
        self.points: dict[str, SpherePlace] = {}
        self.inside = {
            body: {name: np.array(unit_vector((float(a), float(b)))) for name, (a, b) in points.items()}
            for body, points in {FRAME: self.numbers.frame, **self.numbers.local}.items()
        }
        self.poles = {guide: self._pole(guide, body) for guide, body in self.numbers.bodies.items()}
        """Of every guide the point about which its circle runs."""
        self.closures: list[SphereClosure] = []
        """Of every dyad, in the order of the plan."""
        self._begin(pivots)

    def _pole(self, guide: str, body: str) -> str:
        """The point of a body in the pole of a guide; a name for the pole where there is none."""
        a, b = self.numbers.through[guide]
        at = np.array(unit_vector((float(a), float(b))))
        same = [name for name, place in self.inside[body].items() if np.array_equal(place, at)]
        name = same[0] if same else f"pole-{guide}"
        self.inside[body][name] = at
        return name

    def _begin(self, pivots: list[str]) -> None:
        """The axes of the frame: through two of its points that make an arc, pivots first."""
        at = self.inside[FRAME]
        names = [*pivots, *(name for name in at if name not in pivots)]
        for second in names[1:]:
            if makes_arc(tuple(at[names[0]].tolist()), tuple(at[second].tolist())):
                self.place(FRAME, names[0], second, AXES)
                return
        raise unwritten()

    @property
    def axes_through(self) -> tuple[str, str] | None:
        first, second = (self.inside[FRAME][name] for name in self.firsts[FRAME])
        own = abs(first[0] - 1.0) < ROUNDING and abs(second[2]) < ROUNDING and second[1] > 0
        return None if own else self.firsts[FRAME]

    # numbers of the initial position

    def at(self, point: str) -> Vector:
        """Where a point lies in the initial position."""
        return np.array([float(x) for x in self.ready.assembled.positions.points[point]])

    def initial_place(self, body: str, inside: Vector) -> Vector:
        """Where a place of a body lies in the initial position."""
        pose = self.ready.assembled.positions.poses[body]
        axes = np.array([[float(x) for x in axis] for axis in pose])
        return np.asarray(inside @ axes)

    # constants

    def arc(self, body: str, *points: str) -> Angle:
        """An arc between two points of a body, AB; right angles as such."""
        first, second = sorted(points, key=list(self.inside[body]).index)
        a, b = self.inside[body][first], self.inside[body][second]
        plain = SIMPLE.fullmatch(first) and SIMPLE.fullmatch(second)
        name = f"{first}{second}" if plain else f"l_{first}-{second}"
        size = float(np.linalg.norm(np.cross(a, b)))
        return self.constant(name, "arc", (first, second), (float(a @ b), size))

    def constant(self, name: str, kind: str, names: tuple[str, ...], direction: tuple[float, float]) -> Angle:
        """A constant arc or angle by its cosine and sine: right angles as such, another one by a letter."""
        quarters = quarters_of(direction)
        if quarters is not None:
            return Angle((), quarters)
        value = math.atan2(direction[1], direction[0])
        return Angle.of(self.alphabet.letter(ARC, name, kind, names, value, "rad"))

    def between(self, pivot: str, start: str, end: str, at: tuple[Vector, Vector, Vector]) -> Angle:
        """The constant angle in a point from one arc to another of the same body."""
        if start == end:
            return Angle()
        place, a, b = at
        first, second = np.cross(place, a), np.cross(place, b)
        direction = (float(first @ second), float(place @ np.cross(first, second)))
        return self.constant(f"kappa_{start}{pivot}{end}", "corner", (start, pivot, end), direction)

    # letters that move

    def turn(self, link: str, of: tuple[str, str, float], draft: Draft, drive: str | None) -> Angle:
        """The angle of a link in a point from an arc: phi3, with its initial value."""
        number = self.order[link]
        pivot, towards, value = of
        letter = self.alphabet.moving(
            number, f"phi{number}", "angle from arc", (link, pivot, towards), value, "rad", f"omega{number}"
        )
        self.sort_in(letter, f"angle.{link}", draft, drive)
        return Angle.of(letter)

    def bearing(self, guide: str, of: tuple[str, str, float], draft: Draft) -> Angle:
        """Where a point is on the circle of a guide: the angle in its pole."""
        rank = BEARING + len(self.alphabet.meanings)
        pole, towards, value = of
        letter = self.alphabet.moving(
            rank, f"psi_{guide}", "angle on circle", (guide, pole, towards), value, "rad", f"omega_{guide}"
        )
        self.sort_in(letter, f"bearing.{guide}", draft, None)
        return Angle.of(letter)

    def lean(self, link: str, point: str, guide: str, value: float, draft: Draft) -> Angle:
        """The angle of a link in a point against the circle on which another link carries it: gamma2."""
        number = self.order[link]
        letter = self.alphabet.moving(
            TURN + number, f"gamma{number}", "angle to path", (link, point, guide), value, "rad",
            f"gamma{number}_dot",
        )  # fmt: skip
        self.sort_in(letter, f"lean.{link}", draft, None)
        return Angle.of(letter)

    # bodies

    def place(self, body: str, first: str, second: str, axes: Axes) -> None:
        """Note how a body stands: its axes in one point along the arc to another; places of all its points."""
        self.axes[body], self.firsts[body] = axes, (first, second)
        if max(len(total.terms) for axis in axes for total in axis) > LONGEST:
            raise InputError(
                body,
                _("its symbolic expression has too many terms to read"),
                _("compute the motion: centrode run"),
            )
        for name in self.inside[body]:
            if name not in self.points:
                self.points[name] = self.seen_from(body, name).at
                if body != FRAME and name in self.numbers.local[body]:
                    self.moving.append(name)

    def seen_from(self, body: str, point: str) -> Axes:
        """Axes in a point of a placed body: along the arc on from its first point."""
        inside = self.inside[body]
        first, second = self.firsts[body]
        if point == first:
            return self.axes[body]
        arc = self.arc(body, first, point)
        corner = self.between(first, second, point, (inside[first], inside[second], inside[point]))
        return self.axes[body].turned_by(corner).move(arc)

    def towards(self, body: str, pivot: str, end: str | None) -> tuple[Axes, str]:
        """Axes in a point of a placed body along the arc to another of its points, and the name of that one.

        Where none is named, the body's first point is taken, or its second from the first.
        """
        inside = self.inside[body]
        first, second = self.firsts[body]
        axes = self.seen_from(body, pivot)
        if pivot != first:
            axes = axes.turned_by(BACK)
        own = second if pivot == first else first
        if end is None or end == own:
            return axes, own
        return axes.turned_by(self.between(pivot, own, end, (inside[pivot], inside[own], inside[end]))), end

    def body_of(self, point: str) -> str:
        """A placed body that has a point: the frame before others."""
        return next(body for body in (FRAME, *self.axes) if body in self.axes and point in self.inside[body])


def unwritten() -> InputError:
    """What is told of a group that is not written in symbols on the sphere."""
    return InputError(
        "",
        _("on the sphere equations in symbols are written for driven links and dyads of arcs and circles"),
        _("compute the motion: centrode run"),
    )


@dataclass(frozen=True)
class Carrier:
    """What carries the new point on a circle: `axes` in its centre along the arc to `towards`, and the circle's arc."""

    centre: str
    axes: Axes
    towards: Vector
    end: str
    at: Vector
    arc: Angle
    link: str | None
    guide: str | None


def laid_on_sphere(ready: Ready) -> tuple[SphereBoard, tuple[Draft, ...]]:
    """All closures of a spherical mechanism, and the groups that have unknowns.

    Raises InputError for other groups than driven links and dyads of arcs and circles.
    """
    board = SphereBoard(ready, _pivots(ready))
    groups: list[Draft] = []
    for number, group in enumerate(ready.structure.groups):
        groups += _assemble_group(board, group, number)
    return board, tuple(groups)


def _pivots(ready: Ready) -> list[str]:
    """Fixed points about which something turns, in the order of the plan."""
    found: list[str] = []
    for group in ready.structure.groups:
        if isinstance(group, TurnedLink):
            found.append(group.pivot)
        if isinstance(group, Meet):
            found += [rod.centre for rod in group.rods]
            guides = [locus.guide for locus in group.loci if isinstance(locus, Rail)]
            found += [
                one.pole for one in ready.mechanism.guides if one.id in guides and isinstance(one.pole, str)
            ]
    fixed = [name for name in dict.fromkeys(found) if name in ready.kinematics.numbers.frame]
    return fixed or list(ready.kinematics.numbers.frame)[:1]


def _assemble_group(board: SphereBoard, group: Group, number: int) -> list[Draft]:
    if isinstance(group, TurnedLink) and isinstance(group.turning, Turning) and group.turning.drive:
        _drive(board, group.link, group.turning)
        return []
    if isinstance(group, RigidPoint) or (isinstance(group, TwoPointLink) and group.link in board.axes):
        return []
    if isinstance(group, Meet) and len(group.points) == 1 and len(group.rods) >= 1:
        return _dyad(board, group, number)
    raise unwritten()


def _drive(board: SphereBoard, link: str, turning: Turning) -> None:
    """Place a link that a drive turns against a body that is placed."""
    drive, base = turning.drive or "", turning.relative_to
    if link != turning.link or base not in board.axes:
        raise unwritten()
    pivot, second = list(board.inside[link])[:2]
    end = board.numbers.ends[link][0]
    axes, end = board.towards(base, pivot, end)
    turn = board.turn(link, (pivot, end, board.drive_value(drive)), Draft(), drive)
    board.place(link, pivot, second, axes.turned_by(turn))


def _dyad(board: SphereBoard, group: Meet, number: int) -> list[Draft]:
    """Both closures of a dyad, each with its unknown."""
    carrier, rod = _carrier(board, group)
    point = group.points[0]
    draft = Draft(list({rod.link, carrier.link or rod.link}), [point], [number])
    held = board.arc(rod.link, rod.centre, point)
    value = _angle(carrier.at, carrier.towards, board.at(point))
    if carrier.link is not None:
        value = _initial_angle(board, carrier.link, value)
        turn = board.turn(carrier.link, (carrier.centre, carrier.end, value), draft, None)
    else:
        turn = board.bearing(carrier.guide or "", (carrier.centre, carrier.end, value), draft)
    out = carrier.axes.turned_by(turn)
    there = out.move(carrier.arc)
    if carrier.link is not None:
        board.place(carrier.link, carrier.centre, point, out)
    board.points[point] = there.at
    board.moving.append(point)
    far = board.points[rod.centre]
    left = Sum.wave("cos", held)
    draft.conditions.append(LinearConstraint(f"cos {rod.centre}{point}", left, left, far.dot(there.at)))
    leaning, angle, side = _leaning_angle(board, carrier, rod, point, held)
    board.place(rod.link, point, rod.centre, there.leaning(angle, side))
    letters = (turn.parts[0][0], angle.parts[0][0])
    places = (carrier.centre, rod.centre, point)
    board.closures.append(
        SphereClosure(
            number, letters[0], draft.conditions[0], letters[1], leaning.conditions[0], places, leaning.label
        )
    )
    return [draft, leaning]


def _leaning_angle(
    board: SphereBoard, carrier: Carrier, rod: Rod, point: str, held: Angle
) -> tuple[Draft, Angle, int]:
    """The angle of the holding link to the path of the point, by the law of cosines; and the side it is on."""
    corner = _angle(board.at(point), carrier.at, board.at(rod.centre))
    side = -1 if corner > 0 else 1
    draft = Draft([rod.link], [], [], label=_("{link} in {point}").format(link=rod.link, point=point))
    angle = board.lean(rod.link, point, carrier.centre, math.pi / 2 - abs(corner), draft)
    left = Sum.wave("sin", held) * Sum.wave("sin", carrier.arc) * Sum.wave("sin", angle)
    left += Sum.wave("cos", held) * Sum.wave("cos", carrier.arc)
    right = carrier.axes.at.dot(board.points[rod.centre])
    draft.conditions.append(LinearConstraint(f"cos {carrier.centre}{rod.centre}", left, left, right))
    return draft, angle, side


def _carrier(board: SphereBoard, group: Meet) -> tuple[Carrier, Rod]:
    """Which side of a dyad carries the point: a guide, or the link whose other end is fixed."""
    first, second = group.loci
    for one, other in ((first, second), (second, first)):
        if isinstance(one, Rail) and isinstance(other, Rod):
            return _circle(board, one), other
    if not (isinstance(first, Rod) and isinstance(second, Rod)):
        raise unwritten()
    fixed = [rod.centre in board.inside[FRAME] for rod in (first, second)]
    swinging, other = (first, second) if fixed[0] and not fixed[1] else (second, first)
    base = board.body_of(swinging.centre)
    link = board.mechanism.links[swinging.link]
    named = link.reference[1] if link.reference and link.reference[0] == swinging.centre else None
    axes, end = board.towards(base, swinging.centre, named if named in board.inside[base] else None)
    point = group.points[0]
    arc = board.arc(swinging.link, swinging.centre, point)
    at, towards = board.at(swinging.centre), board.initial_place(base, board.inside[base][end])
    return Carrier(swinging.centre, axes, towards, end, at, arc, swinging.link, None), other


def _circle(board: SphereBoard, rail: Rail) -> Carrier:
    """The circle of a guide about a point of a body that is placed."""
    if rail.on not in board.axes:
        raise unwritten()
    name, radius = board.poles[rail.guide], board.numbers.direction[rail.guide][0]
    axes, end = board.towards(rail.on, name, None)
    direction = (math.cos(float(radius)), math.sin(float(radius)))
    arc = board.constant(f"r_{rail.guide}", "arc of circle", (rail.guide,), direction)
    at, towards = (board.initial_place(rail.on, board.inside[rail.on][one]) for one in (name, end))
    return Carrier(name, axes, towards, end, at, arc, None, rail.guide)


def _angle(pivot: Vector, start: Vector, end: Vector) -> float:
    """Angle in a place from one arc to another, counter-clockwise seen from outside."""
    first, second = np.cross(pivot, start), np.cross(pivot, end)
    return float(np.arctan2(pivot @ np.cross(first, second), first @ second))


def _initial_angle(board: SphereBoard, link: str, value: float) -> float:
    """The angle with the turns that the motion gives it."""
    known = board.ready.assembled.angles.get(link)
    if known is None:
        return value
    return value + math.tau * round((float(known) - value) / math.tau)
