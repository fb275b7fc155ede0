"""The spanning tree of a mechanism: what each of its coordinates turns or moves, and which loops are cut.

From the frame outwards every link hangs in one hinge of a body that is placed already and has one coordinate: its
angle, in the plane against the frame, on the sphere against that body. A slider has the displacement along its guide;
what hangs on nothing has the coordinates of a point. Each constraint of the one list is kept by the tree or cuts a
loop; cut ones are the closures. (J. Wittenburg, Dynamics of Multibody Systems, 2nd ed., 2008, section 5.3.)
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal, TypeAlias

from centrode.errors import NotComputedYet
from centrode.geometry.plane import pose_with_point
from centrode.geometry.sphere import (
    attitude_on,
    length,
    rotate_tangent,
    tangent,
    tangent_inside,
    unit,
    unit_vector,
)
from centrode.locale import _
from centrode.model.mechanism import FRAME, Guide, Mechanism
from centrode.numerics.jets import Jet
from centrode.structure.constraints import (
    Constraint,
    Entity,
    NoTurning,
    PointInLink,
    PointOnGuide,
    Positions,
    constraints_of,
    is_drive,
)
from centrode.structure.dimensions import Dimensions
from centrode.structure.plan import refuse_what_the_space_lacks

Number: TypeAlias = Any
Namespace: TypeAlias = Any
Rotor: TypeAlias = tuple[Number, Number]
SPHERE = "sphere"


@dataclass(frozen=True)
class JointCoordinate:
    """A coordinate of the spanning tree.

    Attributes
    ----------
    kind : an angle of a link, a displacement along a guide, or a component of a point's place
    name : of the link, the guide or the point
    base : what an angle is measured against
    """

    kind: Literal["angle", "slide", "x", "y"]
    name: str
    base: str = FRAME

    @property
    def unit(self) -> str:
        """SI unit of its value."""
        return "rad" if self.kind == "angle" else "m"


@dataclass(frozen=True)
class JointValues:
    """Values of all coordinates over some algebra, with cosine and sine of those that are angles."""

    coordinates: Sequence[Number]
    rotors: Mapping[int, Rotor]


# What is placed one behind the other. Each answers which bodies it places, and what these depend on.


@dataclass(frozen=True)
class TreeLink:
    """A link that is hinged in a point whose place is known, turned by a coordinate.

    On the sphere the angle lies between its own arc from the hinge to `second` and the arc to `end` of the base;
    `measured` says whether that is the link's angle of the description.
    """

    link: str
    pivot: str
    number: int
    base: str
    second: str = ""
    end: str = ""
    measured: bool = True

    @property
    def places(self) -> Entity:
        return Entity("link", self.link)

    @property
    def needs(self) -> tuple[Entity, ...]:
        return (Entity("point", self.pivot), Entity("link", self.base))

    def put(self, m: Namespace, numbers: Dimensions, values: JointValues, at: Positions) -> None:
        local, place, rotor = numbers.local[self.link], at.points[self.pivot], values.rotors[self.number]
        if not self.end:
            at.poses[self.link] = pose_with_point(local[self.pivot], place, rotor)
            at.angles[self.link] = values.coordinates[self.number]
            return
        second = local[self.second] if self.second else _place_beside(local[self.pivot])
        inside = tangent_inside(m, local[self.pivot], second)
        there = _reference_place(m, numbers, self.base, self.end, at)
        towards = rotate_tangent(m, place, unit(m, tangent(place, there)), rotor)
        at.poses[self.link] = attitude_on(
            unit_vector(m, local[self.pivot]), inside, place, towards, length(m, inside)
        )
        if self.measured:
            at.angles[self.link] = values.coordinates[self.number]


def _place_beside(at: tuple[Number, Number]) -> tuple[Number, Number]:
    """A place of a link a quarter turn of longitude from its only point."""
    return at[0] + 1.0, at[1]


def _reference_place(m: Namespace, numbers: Dimensions, base: str, end: str, at: Positions) -> Any:
    if base == FRAME:
        return at.points[end]
    return numbers.space.place(m, at.poses[base], numbers.local[base][end])


@dataclass(frozen=True)
class CarriedLink:
    """A link that does not turn against the body of its guide, with a point whose place is known."""

    link: str
    pivot: str
    base: str
    guide: str

    @property
    def places(self) -> Entity:
        return Entity("link", self.link)

    @property
    def needs(self) -> tuple[Entity, ...]:
        return (Entity("point", self.pivot), Entity("link", self.base))

    def put(self, m: Namespace, numbers: Dimensions, values: JointValues, at: Positions) -> None:
        turn = numbers.turn[self.guide]
        local, base = numbers.local[self.link][self.pivot], at.poses[self.base]
        at.poses[self.link] = numbers.space.turned_pose(m, base, turn, local, at.points[self.pivot], None)
        angle = m.atan2(turn[1], turn[0])
        at.angles[self.link] = angle if self.base == FRAME else at.angles[self.base] + angle


@dataclass(frozen=True)
class CarriedPoint:
    """A point of a link that is placed."""

    point: str
    link: str

    @property
    def places(self) -> Entity:
        return Entity("point", self.point)

    @property
    def needs(self) -> tuple[Entity, ...]:
        return (Entity("link", self.link),)

    def put(self, m: Namespace, numbers: Dimensions, values: JointValues, at: Positions) -> None:
        at.points[self.point] = numbers.space.place(
            m, at.poses[self.link], numbers.local[self.link][self.point]
        )


@dataclass(frozen=True)
class SlidPoint:
    """A point moved along its guide by a coordinate."""

    point: str
    guide: str
    base: str
    number: int

    @property
    def places(self) -> Entity:
        return Entity("point", self.point)

    @property
    def needs(self) -> tuple[Entity, ...]:
        return (Entity("link", self.base),)

    def put(self, m: Namespace, numbers: Dimensions, values: JointValues, at: Positions) -> None:
        at.points[self.point] = numbers.space.place_at_slide(
            m, at.poses[self.base], numbers.curve(self.guide), values.coordinates[self.number]
        )


@dataclass(frozen=True)
class FreePoint:
    """A point whose place is two coordinates."""

    point: str
    first: int

    @property
    def places(self) -> Entity:
        return Entity("point", self.point)

    @property
    def needs(self) -> tuple[Entity, ...]:
        return ()

    def put(self, m: Namespace, numbers: Dimensions, values: JointValues, at: Positions) -> None:
        at.points[self.point] = values.coordinates[self.first], values.coordinates[self.first + 1]


Placing: TypeAlias = TreeLink | CarriedLink | CarriedPoint | SlidPoint | FreePoint


def numbers_of(step: Placing) -> tuple[int, ...]:
    """Numbers of the coordinates that a step takes."""
    if isinstance(step, FreePoint):
        return step.first, step.first + 1
    return (step.number,) if isinstance(step, TreeLink | SlidPoint) else ()


@dataclass(frozen=True)
class SpanningTree:
    """The coordinates of a mechanism, what they place, and the constraints that close its loops.

    Attributes
    ----------
    coordinates : tuple of JointCoordinate
    steps : what is placed, one behind the other
    closures : constraints that the tree does not keep
    depends : entity -> numbers of the coordinates on which its place depends
    """

    mechanism: Mechanism
    coordinates: tuple[JointCoordinate, ...]
    steps: tuple[Placing, ...]
    closures: tuple[Constraint, ...]
    depends: Mapping[Entity, frozenset[int]]

    @cached_property
    def pivots(self) -> Mapping[str, str]:
        """Link -> the point in which it hangs."""
        return {step.link: step.pivot for step in self.steps if isinstance(step, TreeLink | CarriedLink)}

    @property
    def angles(self) -> tuple[int, ...]:
        """Numbers of the coordinates that are angles."""
        return tuple(k for k, one in enumerate(self.coordinates) if one.kind == "angle")

    def values(self, m: Namespace, coordinates: Sequence[Number]) -> JointValues:
        """The values with cosine and sine of angles."""
        return JointValues(
            coordinates, {k: (m.cos(coordinates[k]), m.sin(coordinates[k])) for k in self.angles}
        )

    def positions(
        self, m: Namespace, numbers: Dimensions, values: JointValues, drives: Mapping[str, Number]
    ) -> Positions:
        """Places of everything at values of the coordinates."""
        at = Positions.of_frame(numbers, drives, m)
        for step in self.steps:
            step.put(m, numbers, values, at)
        return at

    def positions_along(
        self, m: Namespace, numbers: Dimensions, values: JointValues, at: Positions, number: int
    ) -> Positions:
        """Positions whose parts that depend on one coordinate are placed anew, the others being those of `at`."""
        moved = at.copy()
        for step in self.steps:
            if number in self.depends[step.places]:
                step.put(m, numbers, values, moved)
        return moved

    def dependence(self, constraint: Constraint) -> frozenset[int]:
        """Numbers of the coordinates that a constraint depends on."""
        return frozenset().union(*(self.depends.get(body, frozenset()) for body in constraint.bodies))


def spanning_tree_of(mechanism: Mechanism) -> SpanningTree:
    """The spanning tree of a mechanism, as low as it can be.

    Raises NotComputedYet for what has no coordinates: points of the sphere that hang on nothing, and what is not
    computed there.
    """
    refuse_what_the_space_lacks(mechanism)
    builder = _Builder(mechanism)
    builder.grow()
    constraints = [c for c in constraints_of(mechanism) if not is_drive(c)]
    closures = tuple(c for c in constraints if c not in builder.kept)
    steps = tuple(builder.steps)
    return SpanningTree(mechanism, tuple(builder.coordinates), steps, closures, _dependence(steps))


def _dependence(steps: Iterable[Placing]) -> dict[Entity, frozenset[int]]:
    depends: dict[Entity, frozenset[int]] = {}
    for step in steps:
        of_needs = (depends.get(entity, frozenset()) for entity in step.needs)
        depends[step.places] = frozenset(numbers_of(step)).union(*of_needs)
    return depends


class _Builder:
    def __init__(self, mechanism: Mechanism) -> None:
        self.mechanism = mechanism
        self.steps: list[Placing] = []
        self.coordinates: list[JointCoordinate] = []
        self.kept: list[Constraint] = []
        self.points: dict[str, str] = dict.fromkeys(mechanism.frame.points, FRAME)
        self.links: set[str] = {FRAME}
        self.guided: dict[str, Guide] = {}
        for guide in mechanism.guides:
            # of several guides of a link one says how it stands, the others are closures
            if guide.link is not None:
                self.guided.setdefault(guide.link, guide)

    @property
    def on_sphere(self) -> bool:
        return self.mechanism.space == SPHERE

    def grow(self) -> None:
        """Place everything: links in hinges first, layer by layer, then sliders, then what hangs on nothing."""
        while len(self.links) <= len(self.mechanism.links) or self._unplaced_points():
            if not (self._layer() or self._slide() or self._turn_guided() or self._release()):
                break

    def _unplaced_points(self) -> list[str]:
        return [point for point in self.mechanism.moving_points if point not in self.points]

    def _layer(self) -> bool:
        """Place all links that hang in points which are placed now."""
        known = set(self.points)
        placed = False
        for link in self.mechanism.links:
            pivots = [p for p in self.mechanism.links[link].coordinates if p in known]
            if link in self.links or not pivots:
                continue
            guide = self.guided.get(link)
            if guide is not None:
                if guide.on in self.links:
                    self._carry(link, guide, pivots[0])
                    placed = True
                continue
            self._turn(link, pivots)
            placed = True
        return placed

    def _turn_guided(self) -> bool:
        """Turn a link that hangs in a hinge and whose guide lies on a body that is not placed: that guide is cut."""
        for link in self.guided:
            pivots = [p for p in self.mechanism.links[link].coordinates if p in self.points]
            if link not in self.links and pivots:
                self._turn(link, pivots)
                return True
        return False

    def _turn(self, link: str, pivots: list[str]) -> None:
        number = len(self.coordinates)
        pivot = pivots[0]
        if not self.on_sphere:
            self.coordinates.append(JointCoordinate("angle", link))
            self.steps.append(TreeLink(link, pivot, number, FRAME))
        else:
            base, end, measured = self._reference(link, pivot)
            second = next((p for p in self.mechanism.links[link].coordinates if p != pivot), "")
            self.coordinates.append(JointCoordinate("angle", link, base))
            self.steps.append(TreeLink(link, pivot, number, base, second, end, measured))
        self._place(link, pivot)

    def _reference(self, link: str, pivot: str) -> tuple[str, str, bool]:
        """On the sphere: base and end of the arc that an angle is counted from; whether it is the described one."""
        reference = self.mechanism.links[link].reference
        if reference is not None and reference[0] == pivot:
            for base in self._bases(link):
                if {pivot, reference[1]} <= set(self._points_of(base)):
                    return base, reference[1], True
        base = self.points[pivot]
        for end in self._points_of(base):
            if end != pivot:
                return base, end, False
        # of a body with one point any other point of the frame will do
        for end in self.mechanism.frame.points:
            if end != pivot:
                return FRAME, end, False
        what = _("link {link} hangs on a body that has no other point").format(link=link)
        raise NotComputedYet(f"[links.{link}]", what, _("add a point to the frame"))

    def _bases(self, link: str) -> list[str]:
        driven = [d.relative_to for d in self.mechanism.drives if d.link == link]
        # in the order of the description: that of a set would be another in every process
        return [base for base in (*driven, FRAME, *self.mechanism.links) if base in self.links]

    def _points_of(self, body: str) -> list[str]:
        return list(self.mechanism.points_of(body))

    def _carry(self, link: str, guide: Guide, pivot: str) -> None:
        assert guide.link is not None
        self.steps.append(CarriedLink(link, pivot, guide.on, guide.id))
        self.kept.append(NoTurning(guide.link, guide.id, guide.on))
        self._place(link, pivot)

    def _place(self, link: str, pivot: str) -> None:
        self.links.add(link)
        self.kept.append(PointInLink(pivot, link))
        for point in self.mechanism.links[link].coordinates:
            if point not in self.points:
                self.points[point] = link
                self.steps.append(CarriedPoint(point, link))
                self.kept.append(PointInLink(point, link))

    def _slide(self) -> bool:
        for guide in self.mechanism.guides:
            if guide.point in self.points or guide.on not in self.links:
                continue
            self.steps.append(SlidPoint(guide.point, guide.id, guide.on, len(self.coordinates)))
            self.coordinates.append(JointCoordinate("slide", guide.id, guide.on))
            self.points[guide.point] = guide.on
            self.kept.append(PointOnGuide(guide.point, guide.id, guide.on))
            return True
        return False

    def _release(self) -> bool:
        """Give a point that hangs on nothing coordinates of its own."""
        for point in self._unplaced_points():
            if self.on_sphere:
                what = _("point {point} hangs on nothing").format(point=point)
                raise NotComputedYet(point, what, _("hinge its link to the frame or give it a guide"))
            self.steps.append(FreePoint(point, len(self.coordinates)))
            self.coordinates += [JointCoordinate("x", point), JointCoordinate("y", point)]
            self.points[point] = FRAME
            return True
        return False


# Values of coordinates as jets, with the rotors that belong to them.


def jets_along(tree: SpanningTree, values: JointValues, rates: Sequence[Number], order: int) -> JointValues:
    """The coordinates as jets that change by these rates: value, rate, and no more, up to an order."""
    jets = [
        Jet((value, rate, *([0.0] * order))[: order + 1])
        for value, rate in zip(values.coordinates, rates, strict=True)
    ]
    return JointValues(jets, {k: rotor_jets(values.rotors[k], jets[k]) for k in tree.angles})


def rotor_jets(rotor: Rotor, angle: Jet) -> Rotor:
    """Cosine and sine of an angle that is a jet, of which both are known."""
    cosine, sine = rotor
    rate = angle.coefficients[1]
    if isinstance(rate, float) and rate == 1.0:
        series = ((cosine, -sine, -0.5 * cosine), (sine, cosine, -0.5 * sine))
    elif isinstance(rate, float) and rate == 0.0:
        series = ((cosine, 0.0, 0.0), (sine, 0.0, 0.0))
    else:
        half = -0.5 * (rate * rate)
        series = ((cosine, -(rate * sine), half * cosine), (sine, rate * cosine, half * sine))
    end = angle.order + 1
    return Jet(series[0][:end]), Jet(series[1][:end])
