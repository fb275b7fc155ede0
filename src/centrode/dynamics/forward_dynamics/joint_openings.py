"""Joints that are opened in thought: what holds them closed is their reaction.

A joint that the spanning tree keeps has no multiplier. By d'Alembert's principle its reaction along an opening s, a
displacement of all that the tree places behind it, is r = M_s a - F_s + G_s' lambda: the equation of motion of a
coordinate that is never moved. (J. Wittenburg, Dynamics of Multibody Systems, 2nd ed., 2008, section 5.6.) A closure
has a multiplier, which is its reaction.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal, TypeAlias

from centrode.dynamics.forward_dynamics.elimination import Vector, times
from centrode.dynamics.forward_dynamics.joint_state import JointState
from centrode.dynamics.forward_dynamics.spanning_tree import (
    CarriedLink,
    CarriedPoint,
    JointValues,
    SlidPoint,
    SpanningTree,
    TreeLink,
)
from centrode.dynamics.kinetostatics.equations import Teeth
from centrode.dynamics.state import Centre, Radial
from centrode.geometry.plane import PlanePose, place, reversed_rotor, rotate_vector, subtract
from centrode.model.mechanism import Mechanism
from centrode.numerics.jets import Jet
from centrode.structure.constraints import (
    Constraint,
    DisplacementDrive,
    GearRatio,
    NoSlip,
    NoTurning,
    PointInLink,
    PointOnGuide,
    Positions,
    TrackContact,
)
from centrode.structure.dimensions import Dimensions

Number: TypeAlias = Any
Namespace: TypeAlias = Any
Way: TypeAlias = Literal["x", "y", "across", "turn"]


@dataclass(frozen=True)
class JointOpening:
    """A way in which a joint of the plane is opened.

    Attributes
    ----------
    constraint : what the joint keeps: a point in a link, a point on a guide, or no turning against it
    way : along an axis of the frame, across the guide (its left normal), or turning
    """

    constraint: Constraint
    way: Way


@dataclass(frozen=True)
class Opening:
    """What an opening asks for at one state: r = mass a - force + rows' lambda.

    Attributes
    ----------
    mass : by coordinates
    force : of loads, less what the motion itself asks for
    rows : by equations, those of contacts behind the closures
    along : by contacts, what a unit of their force gives
    """

    mass: Vector
    force: Number
    rows: Vector
    along: Vector

    def reaction(self, accelerations: Mapping[int, Number], forces: Mapping[int, Number]) -> Number:
        """The reaction [N or N m] at accelerations and multipliers, without friction by coefficients."""
        found: Number = -self.force if not _is_plain_zero(self.force) else 0.0
        return found + _product(self.mass, accelerations) + _product(self.rows, forces)

    def size(self, m: Namespace, accelerations: Mapping[int, Number], forces: Mapping[int, Number]) -> Number:
        """The sum of the sizes of what makes the reaction: rounding is a share of it."""
        found: Number = m.abs(self.force)
        for one, other in ((self.mass, accelerations), (self.rows, forces)):
            for k, x in one.items():
                if k in other:
                    found = found + m.abs(x * other[k])
        return found

    def response(
        self, number: int, accelerations: Mapping[int, Number], forces: Mapping[int, Number]
    ) -> Number:
        """What a unit of the force of a contact adds to it, by what that adds to the others."""
        own = self.along.get(number, 0.0)
        found: Number = -own if not _is_plain_zero(own) else 0.0
        return found + _product(self.mass, accelerations) + _product(self.rows, forces)


def _is_plain_zero(x: Number) -> bool:
    return type(x) is float and x == 0.0


def _product(one: Mapping[int, Number], other: Mapping[int, Number]) -> Number:
    total: Number = 0.0
    for k, x in one.items():
        if k in other:
            term = times(x, other[k])
            total = term if _is_plain_zero(total) else total + term
    return total


@dataclass(frozen=True)
class OpenedState(JointState):
    """The state along an opening: what is fixed in a link goes with the link, and not with the pin that it left."""

    opened: Mapping[str, Any] = field(default_factory=dict)

    def centre(self, centre: Centre | Radial) -> tuple[Jet, ...]:
        """Centre of mass of a link [m], by the pose of the link."""
        assert isinstance(centre, Centre) and self.numbers is not None
        u, v = self.numbers.local[centre.link][centre.base]
        at = place(self.at.poses[centre.link], (u + centre.along, v + centre.across))
        return tuple(map(self.as_jet, at))

    def slide(self, guide: str) -> Jet:
        """Displacement along a guide [m], that of the slider where it is a link."""
        described = self.mechanism.guide(guide)
        if described.link is None:
            return super().slide(guide)
        assert self.numbers is not None
        point = _place_in(self.numbers, self.at, described.link, described.point)
        slid = self.numbers.space.slide(self.m, point, self.at.poses[described.on], self.numbers.curve(guide))
        return self.as_jet(slid)


def _place_in(numbers: Dimensions, at: Positions, link: str, point: str) -> Any:
    return place(at.poses[link], numbers.local[link][point])


def host_positions(
    mechanism: Mechanism, numbers: Dimensions, at: Positions, constraint: Constraint
) -> Positions:
    """Positions in which the point of a constraint is that of the link that bears what the constraint exerts."""
    point, link = "", None
    if isinstance(constraint, PointOnGuide | DisplacementDrive):
        point, link = constraint.point, mechanism.guide(constraint.guide).link
    elif isinstance(constraint, TrackContact | NoSlip):
        point, link = constraint.centre, constraint.link
    if link is None:
        return at
    moved = at.copy()
    moved.points[point] = _place_in(numbers, at, link, point)
    return moved


def tooth_slope(
    teeth: Teeth, numbers: Dimensions, plain: Positions, at: Positions, gear: GearRatio
) -> Number:
    """Work along an opening of the force between the teeth of a gear, of which its equation is a unit.

    The equation speaks of angles alone; the force acts where the wheels mesh.
    """
    total: Number = 0.0
    for wrench in teeth.pulls(gear, plain, numbers):
        pose, moved = plain.poses[wrench.body.name], at.poses[wrench.body.name]
        arm = rotate_vector(subtract((wrench.at[0], wrench.at[1]), pose[0]), reversed_rotor(pose[1]))
        shifted = place(moved, arm)
        for force, x in zip(wrench.force, shifted, strict=True):
            term = times(force, x.coefficients[1] if isinstance(x, Jet) else 0.0)
            total = term if _is_plain_zero(total) else total if _is_plain_zero(term) else total + term
    return total


def step_of(tree: SpanningTree, constraint: Constraint) -> int | None:
    """Number of the step of the tree that keeps a constraint; None of a closure."""
    for number, step in enumerate(tree.steps):
        match constraint:
            case PointInLink(point=point, link=link):
                hangs = isinstance(step, TreeLink | CarriedLink) and (step.link, step.pivot) == (
                    link,
                    point,
                )
                carried = isinstance(step, CarriedPoint) and (step.link, step.point) == (link, point)
                if hangs or carried:
                    return number
            case PointOnGuide(guide=guide):
                if isinstance(step, SlidPoint) and step.guide == guide:
                    return number
            case NoTurning(link=link, guide=guide):
                if isinstance(step, CarriedLink) and (step.link, step.guide) == (link, guide):
                    return number
    return None


def opened_positions(
    tree: SpanningTree,
    m: Namespace,
    numbers: Dimensions,
    values: JointValues,
    at: Positions,
    opening: JointOpening,
    number: int,
) -> Positions:
    """Positions as jets along an opening of the joint that a step of the tree keeps."""
    moved, first = at.copy(), tree.steps[number]
    if opening.way == "turn":
        assert isinstance(first, CarriedLink)
        cosine, sine = numbers.turn[first.guide]
        turn = (Jet((cosine, -sine)), Jet((sine, cosine)))
        local, base = numbers.local[first.link][first.pivot], at.poses[first.base]
        moved.poses[first.link] = numbers.space.turned_pose(
            m, base, turn, local, at.points[first.pivot], None
        )
        moved.angles[first.link] = Jet((at.angles[first.link], 1.0))
    else:
        x, y = _direction(numbers, at, opening)
        if first.places.kind == "point":
            u, v = at.points[first.places.name]
            moved.points[first.places.name] = (Jet((u, x)), Jet((v, y)))
        else:
            pose = at.poses[first.places.name]
            u, v = pose[0]
            moved.poses[first.places.name] = PlanePose((Jet((u, x)), Jet((v, y))), pose[1])
    changed = {first.places}
    for step in tree.steps[number + 1 :]:
        if changed & set(step.needs):
            step.put(m, numbers, values, moved)
            changed.add(step.places)
    return moved


def _direction(numbers: Dimensions, at: Positions, opening: JointOpening) -> tuple[Number, Number]:
    if opening.way == "across":
        assert isinstance(opening.constraint, PointOnGuide)
        x, y = rotate_vector(
            numbers.direction[opening.constraint.guide], at.poses[opening.constraint.on].rotor
        )
        return -y, x
    return (1.0, 0.0) if opening.way == "x" else (0.0, 1.0)


def closure_rows(opening: JointOpening, constraints: Sequence[Constraint]) -> Vector:
    """What of the multipliers of a closure is its reaction, by the numbers of its equations."""
    first = 0
    for constraint in constraints:
        if constraint == opening.constraint:
            break
        first += constraint.size
    # a multiplier acts against its equation, whose derivative along the opening is 1: the residual of a point in a
    # link is the place of the point along the frame's axes, the others are a distance or an angle themselves
    return {first + (1 if opening.way == "y" else 0): -1.0}
