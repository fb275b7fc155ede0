"""Why a group stops a mechanism, or lets its assemblies meet: what happens to it, and the condition in symbols."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from math import atan2, pi, remainder
from typing import Any, Literal, TypeAlias, assert_never

import numpy as np

from centrode.analysis.rotatability.tours import DriveSweep, MonitoredFunction, Pair, Watched
from centrode.geometry.plane import Vector, place, rotate_vector, subtract
from centrode.geometry.plane import cross as plane_cross
from centrode.geometry.plane import dot as plane_dot
from centrode.geometry.sphere import cross, dot, tangent
from centrode.kinematics.dyads import aim_curve, loci_of
from centrode.kinematics.path import JETS
from centrode.kinematics.plan_evaluation import FixedSigns, Kinematics, SideChoices
from centrode.model.mechanism import Mechanism
from centrode.numerics.arrays import ARRAYS
from centrode.structure.assur import name_of
from centrode.structure.constraints import Positions
from centrode.structure.dimensions import Dimensions
from centrode.structure.groups import (
    Aim,
    CylinderCircle,
    Group,
    GuideStop,
    Locus,
    Meet,
    Newton,
    Rail,
    RigidPoint,
    Rod,
    Rolloff,
    Slot,
    Touch,
    Train,
    TurnedLink,
    TwoPointLink,
)

# Conditions in symbols: the angle phi of each link by its number in the description, and what vanishes of
# them.

NOTHING = 1e-12
"""An angle [rad] below which a constant is not written down."""
HIGHER = "determinant = 0"
"""The condition of a group whose determinant has no short form."""


@dataclass(frozen=True)
class AngleSymbol:
    """The angle of a link by its number in the description (phi3), or of a cylinder by its points (psi_KA)."""

    letter: Literal["phi", "psi"]
    index: str

    def __str__(self) -> str:
        return f"phi{self.index}" if self.letter == "phi" else f"psi_{self.index}"


@dataclass(frozen=True)
class AngleCondition:
    """A sine or cosine of a sum of angles that is zero.

    Attributes
    ----------
    plus, minus : angles of the sum, by their signs
    constant : that is added [rad]
    """

    function: Literal["sin", "cos"]
    plus: tuple[AngleSymbol, ...]
    minus: tuple[AngleSymbol, ...]
    constant: float = 0.0

    def __str__(self) -> str:
        text = " + ".join(map(str, self.plus)) + "".join(f" - {angle}" for angle in self.minus)
        if self.constant:
            text += f" {'+' if self.constant > 0 else '-'} {abs(self.constant):.6g}"
        return f"{self.function}({text}) = 0"


@dataclass(frozen=True)
class SlideCondition:
    """The displacement along a guide at which the group locks [m]."""

    guide: str
    value: float

    def __str__(self) -> str:
        return f"s_{self.guide} = {f'{self.value:.6g} m' if self.value else 0}"


Condition: TypeAlias = AngleCondition | SlideCondition | str
"""What holds of the group's own geometry; a string is a condition without numbers, in names alone."""


@dataclass(frozen=True)
class PivotSymbol:
    """The direction of a line as a sum: symbols of angles, and a constant [rad]."""

    symbols: tuple[AngleSymbol, ...] = ()
    constant: float = 0.0


def symbol_of(mechanism: Mechanism, link: str) -> AngleSymbol:
    """Symbol of a link's angle: links count from 1, in the order of the description."""
    return AngleSymbol("phi", str(mechanism.link_names.index(link) + 1))


def bearing_of(mechanism: Mechanism, body: str, direction: Vector) -> PivotSymbol:
    """Bearing of a direction that is given in the axes of a link, or of the frame."""
    constant = atan2(float(direction[1]), float(direction[0]))
    symbols = (symbol_of(mechanism, body),) if body in mechanism.links else ()
    return PivotSymbol(symbols, constant)


def bearing_between(
    mechanism: Mechanism, numbers: Dimensions, link: str, first: str, last: str
) -> PivotSymbol:
    """Bearing of the line from one point of a link to another."""
    local = numbers.local[link]
    return bearing_of(mechanism, link, subtract(local[last], local[first]))


def parallel(one: PivotSymbol, other: PivotSymbol) -> Condition:
    """The condition that two lines have the same direction, or opposite ones."""
    return _vanishes(one, other, square=False)


def square(one: PivotSymbol, other: PivotSymbol) -> Condition:
    """The condition that two lines stand square to each other."""
    return _vanishes(one, other, square=True)


def _vanishes(one: PivotSymbol, other: PivotSymbol, *, square: bool) -> Condition:
    """The sine or cosine of the difference = 0; a quarter turn between the two changes one into the other."""
    # the angle of one link in both bearings cancels: what is left are the links between the two
    plus = tuple(angle for angle in one.symbols if angle not in other.symbols)
    minus = tuple(angle for angle in other.symbols if angle not in one.symbols)
    # all angles cancel where both lines are on one body: the short form says nothing
    if not plus and not minus:
        return HIGHER
    constant = one.constant - other.constant
    if not plus:
        # the sign of the whole does not matter for what is zero: a sum begins with a plus
        plus, minus, constant = minus, plus, -constant
    constant = remainder(constant, pi)  # half a turn changes the sign alone
    # sin(x + pi/2) = cos x: a quarter turn is not written down but changes the function
    if abs(abs(constant) - 0.5 * pi) <= NOTHING:
        constant, square = 0.0, not square
    return AngleCondition(
        "cos" if square else "sin", plus, minus, 0.0 if abs(constant) <= NOTHING else constant
    )


Number: TypeAlias = Any


class CauseKind(StrEnum):
    """Kind of event of a group at its limit, or at its change point."""

    TURNS_BACK = "its positions turn back"
    POSITIONS_MEET = "its positions meet"
    RODS_IN_LINE = "two rods fall in line"
    RODS_PARALLEL = "two rods with a body between them stand parallel"
    RODS_ON_GREAT_CIRCLE = "two arcs lie on one great circle"
    ROD_SQUARE = "a rod stands square to a line"
    ROD_ALONG = "a rod lies along a line"
    LINES_PARALLEL = "two lines are parallel"
    CIRCLES_TOUCH = "two circles touch"
    WHEEL_NEAREST = "a link comes no nearer to a wheel"
    ARC_SQUARE = "an arc stands square to a guide"
    PIN_AT_PIVOT = "a pin comes to a pivot"
    ARM_SQUARE = "an arm stands square to a guide"
    NO_LENGTH = "a cylinder has no length"


class Tracer(StrEnum):
    """Kind of body that moves a point along a locus."""

    LINK = "link"
    CYLINDER = "cylinder"
    GUIDE = "guide"
    WHEEL = "wheel"


@dataclass(frozen=True)
class Cause:
    """Why a group is at a limit or at a change point.

    Attributes
    ----------
    bodies : what draws the group's loci, each with its name; a wheel has none
    points : two centres of rods; of a link that aims with its guide the pivot and the target
    stretched : whether two rods are stretched out, not folded over each other; None of other groups
    distance : of the two points [m, on the sphere rad]; of an aiming link that of its guide from the pivot
    """

    kind: CauseKind
    bodies: tuple[tuple[Tracer, str], ...] = ()
    points: tuple[str, ...] = ()
    stretched: bool | None = None
    distance: float | None = None


def cause_of(
    tour: DriveSweep, group: Group, index: int, value: float, *, crossing: bool = False
) -> tuple[Cause, Condition]:
    """Why a group is at a limit, or at a change point (`crossing`), at a value of the drive, and what holds there."""
    mechanism, numbers = tour.prepared.mechanism, tour.continuation.kinematics.numbers
    place = _Place(tour, mechanism, numbers, index, value)
    match group:
        case Aim():
            return _cause_of_aim(place, group)
        case Meet(kind="RRR"):
            return _of_two_rods(place, group)
        case Meet(kind="RRP"):
            return _of_rod_and_line(place, group)
        case Meet():
            return _of_two_lines(place, group)
        case RigidPoint() | TwoPointLink() | TurnedLink() | Train() | Newton():
            return Cause(CauseKind.POSITIONS_MEET if crossing else CauseKind.TURNS_BACK), HIGHER
        case _:
            assert_never(group)


@dataclass(frozen=True)
class _Place:
    """A group's limit or change point: the mechanism with its dimensions, and the drive's value there."""

    tour: DriveSweep
    mechanism: Mechanism
    numbers: Dimensions
    index: int
    value: float

    @property
    def on_sphere(self) -> bool:
        return self.mechanism.space == "sphere"

    def length(self, value: float) -> float:
        """A length, on the sphere an arc; what is zero but for rounding as zero."""
        return 0.0 if abs(value) <= 1e-12 * float(self.numbers.scale) else value


def _as_float(x: Number) -> float:
    return float(np.reshape(x, -1)[0])


def body_of(locus: Locus) -> tuple[Tracer, str]:
    """A locus by what draws it: a link, a cylinder, a guide or a wheel."""
    match locus:
        case Rod(link=link):
            return Tracer.LINK, link
        case CylinderCircle(drive=drive):
            return Tracer.CYLINDER, drive
        case Rail(guide=guide) | Slot(guide=guide) | GuideStop(guide=guide):
            return Tracer.GUIDE, guide
        case Touch() | Rolloff():
            return Tracer.WHEEL, ""
        case _:
            assert_never(locus)


def bearing_of_locus(
    mechanism: Mechanism, numbers: Dimensions, locus: Locus, carriage: str
) -> PivotSymbol | None:
    """Bearing of a rod, or of a line on which a point moves; None where a wheel draws it."""
    match locus:
        case Rod():
            return bearing_between(mechanism, numbers, locus.link, locus.centre, locus.point)
        case CylinderCircle(drive=drive):
            return PivotSymbol((AngleSymbol("psi", drive.replace("-", "")),))
        case Rail():
            return bearing_of(mechanism, locus.on, numbers.direction[locus.guide])
        case Slot():
            return bearing_of(mechanism, carriage, numbers.direction[locus.guide])
        case GuideStop():
            x, y = numbers.direction[locus.guide]
            # a stop is the line across the guide at the displacement that a drive gives
            return bearing_of(mechanism, locus.on, (-y, x))
        case Touch() | Rolloff():
            return None
        case _:
            assert_never(locus)


def _bearings(place: _Place, group: Meet) -> tuple[PivotSymbol, PivotSymbol] | None:
    """Bearings of both lines of a group; None where a wheel draws one of them."""
    carriage = group.carriage or ""
    one, other = (bearing_of_locus(place.mechanism, place.numbers, locus, carriage) for locus in group.loci)
    return None if one is None or other is None else (one, other)


def _of_two_rods(place: _Place, group: Meet) -> tuple[Cause, Condition]:
    """The centres and the point where the rods meet lie on one line: stretched out, or folded."""
    stretched, apart = _circle_contact(place, group)
    first, second = (getattr(locus, "centre", "") for locus in group.loci)
    condition: Condition
    if place.on_sphere:
        kind = CauseKind.RODS_ON_GREAT_CIRCLE
        condition = f"sin(angle {first}-{group.points[0]}-{second}) = 0"
    else:
        kind = CauseKind.RODS_PARALLEL if group.carriage else CauseKind.RODS_IN_LINE
        bearings = _bearings(place, group)
        condition = HIGHER if bearings is None else parallel(*bearings)
    bodies = tuple(map(body_of, group.loci))
    if first and second and not group.carriage:
        return Cause(kind, bodies, (first, second), stretched, place.length(apart)), condition
    return Cause(kind, bodies, stretched=stretched), condition


def _circle_contact(place: _Place, group: Meet) -> tuple[bool, float]:
    """Whether two circles touch from outside, and how far apart their centres are."""
    at = place.tour.positions_at(place.value, ARRAYS)
    # both positions are one there: the sign zero takes the root out, which would be rounding
    choices = SideChoices(FixedSigns(ARRAYS, {place.index: 0.0}), place.index)
    space = place.numbers.space
    with np.errstate(all="ignore"):
        one, other = loci_of(group, ARRAYS, place.numbers, at, choices)
        apart = _as_float(space.distance(ARRAYS, one.centre, other.centre))
    radii = [_radius(circle) for circle in (one, other)]
    total, difference = sum(radii), abs(radii[0] - radii[1])
    # on the sphere arcs that together exceed pi touch beyond the far side
    total = min(total, 2.0 * np.pi - total) if place.on_sphere else total
    # rounding leaves either nearly true: whichever is nearer
    return abs(apart - total) <= abs(apart - difference), apart


def _radius(circle: Any) -> float:
    """Radius [m], on the sphere the arc [rad], of a circle."""
    # the half angle from both parts is exact for small arcs and for large ones
    if hasattr(circle, "half"):
        sine, cosine = (_as_float(x) for x in circle.half)
        return 2.0 * float(np.arctan2(abs(sine), abs(cosine)))
    return abs(_as_float(circle.radius))


def _of_rod_and_line(place: _Place, group: Meet) -> tuple[Cause, Condition]:
    """The rod stands square to the line on which its end moves."""
    rod, line = group.loci
    bodies = body_of(rod), body_of(line)
    if place.on_sphere:
        on = getattr(line, "guide", "")
        return Cause(CauseKind.ROD_SQUARE, bodies), f"cos(angle between {bodies[0][1]} and guide {on}) = 0"
    bearings = _bearings(place, group)
    kind = CauseKind.ROD_ALONG if isinstance(line, GuideStop) else CauseKind.ROD_SQUARE
    return Cause(kind, bodies), HIGHER if bearings is None else square(*bearings)


def _of_two_lines(place: _Place, group: Meet) -> tuple[Cause, Condition]:
    """Two lines are parallel: where they meet goes to infinity."""
    bodies = tuple(map(body_of, group.loci))
    # there are no parallels on the sphere: the two circles touch instead
    if place.on_sphere:
        return Cause(CauseKind.CIRCLES_TOUCH, bodies), HIGHER
    bearings = _bearings(place, group)
    return Cause(CauseKind.LINES_PARALLEL, bodies), HIGHER if bearings is None else parallel(*bearings)


def _cause_of_aim(place: _Place, group: Aim) -> tuple[Cause, Condition]:
    """The target is as near to the pivot as the line in the aimed link: the arm to it stands square to the line."""
    bodies = ((Tracer.LINK, group.link), (Tracer.GUIDE, group.guide))
    points = (group.pivot, group.target)
    if group.contact is not None:
        return Cause(CauseKind.WHEEL_NEAREST, bodies, points), HIGHER
    if place.on_sphere:
        condition = f"cos(angle between arc {group.pivot}-{group.target} and guide {group.guide}) = 0"
        return Cause(CauseKind.ARC_SQUARE, bodies, points), condition
    through, direction = aim_curve(group, place.numbers)
    to_pivot = subtract(place.numbers.local[group.link][group.pivot], through)
    # the displacement at which the target stands square before the pivot
    condition_of_slide = SlideCondition(group.guide, place.length(float(plane_dot(direction, to_pivot))))
    offset = place.length(abs(float(direction[0] * to_pivot[1] - direction[1] * to_pivot[0])))
    if not offset:
        return Cause(CauseKind.PIN_AT_PIVOT, bodies, points), condition_of_slide
    return Cause(CauseKind.ARM_SQUARE, bodies, points, distance=offset), condition_of_slide


# Transmission angles of the dyads: how well each passes motion on, from 0 (it locks) to a right angle.


@dataclass(frozen=True)
class Transmission:
    """Extremes of a dyad's transmission angle over a tour.

    Attributes
    ----------
    group : its name
    kind : "RRR", "RRP", "RPR"
    least, least_at : the least acute angle [rad] (between lines: 0 to pi/2), and the drive's value there
    extremes : (drive's value, angle [rad]) of its minima and maxima; two links: 0 to pi, otherwise acute
    """

    group: str
    kind: str
    least: float
    least_at: float
    extremes: tuple[tuple[float, float], ...]


def watched_dyads(tour: DriveSweep, guides: bool = False) -> list[tuple[Watched, int]]:
    """The transmission angles of a plan's dyads, each with the number of its group; on demand of two guides too."""
    kinematics = tour.continuation.kinematics
    dyads = []
    for index, group in enumerate(kinematics.structure.groups):
        watched = _watched_angle(kinematics, group)
        if watched is None and guides:
            watched = _watched_guides(kinematics, group)
        if watched is not None:
            dyads.append((watched, index))
    return dyads


def _watched_angle(kinematics: Kinematics, group: Group) -> Watched | None:
    """RRR: between the two rods; RRP: between the rod and the normal of the line; RPR: between arm and normal."""
    name = name_of(group)
    sphere = kinematics.numbers.space.name == "sphere"
    if isinstance(group, Aim) and group.contact is None:
        of_aim = _of_aim_on_sphere if sphere else _of_aim
        return Watched(name, "rad", lambda at: of_aim(kinematics, group, at))
    if not isinstance(group, Meet):
        return None
    centres = [locus for locus in group.loci if isinstance(locus, (Rod, CylinderCircle))]
    if len(centres) == 2:
        return Watched(name, "rad", lambda at: _between_rods(sphere, centres, at))
    line = next((locus for locus in group.loci if isinstance(locus, (Rail, Slot))), None)
    if len(centres) == 1 and isinstance(line, Rail) and sphere:
        return Watched(name, "rad", lambda at: _to_pole(kinematics, centres[0], line, at))
    if len(centres) == 1 and line is not None and not sphere:
        return Watched(name, "rad", lambda at: _to_normal(kinematics, centres[0], line, group.carriage, at))
    return None


def _watched_guides(kinematics: Kinematics, group: Group) -> Watched | None:
    """PRP, RPP: between the two guides, on the sphere between the arcs to the poles of both circles."""
    if not isinstance(group, Meet) or len(group.loci) != 2:
        return None
    lines = [locus for locus in group.loci if isinstance(locus, (Rail, Slot))]
    name = name_of(group)
    if len(lines) != 2:
        return None
    if kinematics.numbers.space.name != "sphere":
        return Watched(name, "rad", lambda at: _between_guides(kinematics, lines, group.carriage, at))
    rails = [line for line in lines if isinstance(line, Rail)]
    if len(rails) != 2 or len(group.points) != 1:
        return None
    return Watched(name, "rad", lambda at: _between_poles(kinematics, rails, group.points[0], at))


def _between_guides(
    kinematics: Kinematics, lines: list[Rail | Slot], carriage: str | None, at: Positions
) -> Pair:
    bodies = [line.on if isinstance(line, Rail) else carriage for line in lines]
    one, other = (
        rotate_vector(kinematics.numbers.direction[line.guide], at.poses[body or "frame"].rotor)
        for line, body in zip(lines, bodies, strict=True)
    )
    # rotors of two lines: their quotient has the cosine as the scalar and the sine as the vector product
    return plane_dot(one, other), plane_cross(one, other)


def _between_poles(kinematics: Kinematics, rails: list[Rail], point: str, at: Positions) -> Pair:
    space, numbers = kinematics.numbers.space, kinematics.numbers
    pin = at.points[point]
    one, other = (
        tangent(pin, space.place(JETS, at.poses[rail.on], numbers.through[rail.guide])) for rail in rails
    )
    # the tangents lie in the plane square to the pin: their product points along it, with the sine as its
    # length
    return dot(one, other), dot(pin, cross(one, other))


def _between_rods(sphere: bool, rods: list[Any], at: Positions) -> Pair:
    one, other = ((at.points[rod.point], at.points[rod.centre]) for rod in rods)
    if sphere:
        arc, next_arc = (tangent(pin, centre) for pin, centre in (one, other))
        return dot(arc, next_arc), dot(one[0], cross(arc, next_arc))
    line, next_line = (subtract(centre, pin) for pin, centre in (one, other))
    return plane_dot(line, next_line), plane_cross(line, next_line)


def _to_pole(kinematics: Kinematics, rod: Any, line: Rail, at: Positions) -> Pair:
    """Between the rod's arc and the arc to the pole of the guide's circle."""
    space, numbers = kinematics.numbers.space, kinematics.numbers
    pin, centre = at.points[rod.point], at.points[rod.centre]
    pole = space.place(JETS, at.poses[line.on], numbers.through[line.guide])
    arc, to_pole = tangent(pin, centre), tangent(pin, pole)
    return dot(arc, to_pole), dot(pin, cross(arc, to_pole))


def _of_aim_on_sphere(kinematics: Kinematics, group: Aim, at: Positions) -> Pair:
    """In the target, between the arcs to the pivot and to the pole of the guide's circle."""
    space, numbers = kinematics.numbers.space, kinematics.numbers
    target, pivot = at.points[group.target], at.points[group.pivot]
    pole = space.place(JETS, at.poses[group.link], numbers.through[group.guide])
    arc, to_pole = tangent(target, pivot), tangent(target, pole)
    return dot(arc, to_pole), dot(target, cross(arc, to_pole))


def _to_normal(kinematics: Kinematics, rod: Any, line: Locus, carriage: str | None, at: Positions) -> Pair:
    """The rod's share along the line is the sine; that along the normal the cosine."""
    assert isinstance(line, (Rail, Slot))
    body = line.on if isinstance(line, Rail) else carriage
    rotor = at.poses[body or "frame"].rotor
    direction = rotate_vector(kinematics.numbers.direction[line.guide], rotor)
    arm = subtract(at.points[rod.point], at.points[rod.centre])
    return plane_cross(direction, arm), plane_dot(direction, arm)


def _of_aim(kinematics: Kinematics, group: Aim, at: Positions) -> Pair:
    """The target's way along the line from the pivot's foot is the sine, the pivot's distance from it the cosine."""
    _through, direction = aim_curve(group, kinematics.numbers)
    pose = at.poses[group.link]
    pivot = place(pose, kinematics.numbers.local[group.link][group.pivot])
    along = rotate_vector(direction, pose.rotor)
    arm = subtract(at.points[group.target], pivot)
    return plane_cross(along, arm), plane_dot(along, arm)


def transmissions_of(course: MonitoredFunction, groups: list[int], first: int = 0) -> list[Transmission]:
    """Extremes of the watched transmission angles, from number `first` on."""
    transmissions = []
    for k, index in enumerate(groups, first):
        group = course.tour.prepared.structure.groups[index]
        fold = _between if group.kind == "RRR" else _acute  # two links have a sense each, a line has none
        extremes = [(float(at), fold(float(value))) for at, value in zip(*course.turned[k], strict=True)]
        least, at = least_of(course, k, index, extremes)
        transmissions.append(Transmission(course.watched[k].name, group.kind, least, at, tuple(extremes)))
    return transmissions


def _between(value: float) -> float:
    """An angle between two directions, in [0, pi]."""
    folded = abs(value) % (2.0 * pi)
    return min(folded, 2.0 * pi - folded)


def _acute(value: float) -> float:
    """An angle between two lines, in [0, pi/2]."""
    between = _between(value)
    return min(between, pi - between)


def least_of(
    course: MonitoredFunction, k: int, index: int, extremes: list[tuple[float, float]]
) -> tuple[float, float]:
    """The least acute angle; zero at the group's own limits and change points."""
    tour = course.tour
    # an aiming link may be stopped by its pin at the pivot, where no arm and so no angle is left
    if not isinstance(tour.prepared.structure.groups[index], Aim):
        for event in tour.events("limit") + tour.events("change point"):
            if event.group == index and (event.kind == "change point" or event.at in (tour.low, tour.high)):
                return 0.0, event.at
    acute = [(min(value, pi - value), at) for at, value in extremes]
    # a stretch with ends has its least angle there, unless it turns back in between
    if not acute or not tour.comes_round:
        acute += transmission_at_ends(course, k)
    if not acute:
        # neither turned back nor had ends: it keeps its value all over, whichever node says it
        sines = np.abs(np.sin(course.values[k]))
        node = int(np.nanargmin(sines))
        acute.append((float(np.arcsin(sines[node])), float(course.nodes[node])))
    return min(acute)


def transmission_at_ends(course: MonitoredFunction, k: int) -> list[tuple[float, float]]:
    """The acute angle at the ends of the stretch: the drive's limits, or the initial position."""
    angles = []
    for at in (end for end in course.tour.span if np.isfinite(end)):
        value = float(course.watched[k].value(course.tour.positions_at(at, ARRAYS), 1)[0])
        if np.isfinite(value):
            between = _between(value)
            angles.append((min(between, pi - between), at))
    return angles
