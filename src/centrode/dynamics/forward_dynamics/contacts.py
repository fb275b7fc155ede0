"""Contacts of a free motion: stops, clamps and dry friction as rows of the equations that count or do not.

A contact that is closed, sticks or holds is one more constraint: the derivative of its coordinate by the joint
coordinates is a row, and a flag says whether it counts. So all modes of a motion share one set of equations. (F.
Pfeiffer and C. Glocker, Multibody Dynamics with Unilateral Contacts, 1996, chapters 4 to 6.)
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from math import hypot
from typing import Any, TypeAlias

import numpy as np

from centrode.dynamics.forward_dynamics.broken_lines import BrokenLine
from centrode.dynamics.forward_dynamics.joint_openings import JointOpening
from centrode.dynamics.load_coordinates import (
    AngularDistance,
    Component,
    Coordinate,
    Distance,
    GuideArc,
    HingeTurn,
    Slide,
    Spin,
    Turn,
    hinge_of,
    joint_of_hinge,
    points_of,
)
from centrode.dynamics.loads import (
    Constant,
    ContinuousLaw,
    EnergyClass,
    Friction,
    LoadDiagram,
    LoadLaw,
    LoadTerm,
    Situation,
)
from centrode.dynamics.state import is_none
from centrode.errors import InputError, NotComputedYet
from centrode.locale import _
from centrode.model.contacts import MEASURED, MeasuredPart, Stop
from centrode.model.loads import GuideFriction, HingeFriction
from centrode.model.mechanism import Mechanism
from centrode.numerics.text_formula import TextFormula, compile_formula

Number: TypeAlias = Any

STOP, FRICTION, CLAMP, COMPLIANT = "stop", "friction", "clamp", "compliant stop"
"""Kinds of contacts."""
AT_LEAST, OPEN, AT_MOST = -1.0, 0.0, 1.0
"""Modes of a stop: closed at the bound below, open, closed at the bound above; what sticks or holds has mode 1."""


@dataclass(frozen=True)
class JointPressing:
    """How the reaction of a joint makes the size of friction by a coefficient.

    Attributes
    ----------
    openings : what the joint exerts: both components of the force of a pin, or the normal force of a guide and the
        moment on its slider; of what cannot tilt the normal force alone
    kinetic, static : coefficients, in hinges times the radius of the pin and the factor of the fit [1 or m]
    length, height : of a slider along and across its guide [m]; 0 where they do not matter
    """

    openings: tuple[JointOpening, ...]
    kinetic: Number
    static: Number
    length: Number = 0.0
    height: Number = 0.0

    @property
    def is_round(self) -> bool:
        """Whether the size goes with the length of a force, as in hinges; else with the greater of two numbers."""
        return len(self.openings) == 2 and self.openings[0].way == "x"

    def parts(self, reaction: Sequence[Number], sense: Number, coefficient: Number) -> tuple[Number, Number]:
        """The two numbers [N] whose length, or whose greater one, presses, by the reaction and the sense of the motion.

        The ends of a slider press with N/2 -+ M/l, of which the moment of friction on its faces is a part.
        """
        if len(reaction) == 1:
            return reaction[0], 0.0
        first, second = reaction
        if self.is_round:
            return first, second
        tilt = second * (2.0 / self.length)
        if is_none(self.height):
            return first, tilt
        return first, tilt + (sense * coefficient * self.height / self.length) * first


@dataclass(frozen=True)
class Contact:
    """Something that a coordinate may meet, rub against or be held by.

    Attributes
    ----------
    kind : `STOP`, `FRICTION`, `CLAMP` or `COMPLIANT`
    label : of results; the friction of a load has that of the load
    coordinate : along which it works
    least, most : bounds of a stop [rad or m], or None
    restitution : of a rigid stop
    stiffness, damping : of a compliant one
    kinetic : friction while it slips, against the motion [N or N m]; of a load with a sense its force forwards
    backwards : its force backwards; None of friction
    static : the greatest force by which it holds what sticks; None where it is the kinetic one
    drift : speed of the surface along the coordinate [rad/s or m/s]
    until : when a clamp lets go: a time [s], the name of an event, or None
    pressing : of friction by a coefficient, in place of a kinetic law; None of all else
    """

    kind: str
    label: str
    coordinate: Coordinate
    least: Number | None = None
    most: Number | None = None
    restitution: float = 0.0
    stiffness: Number = 0.0
    damping: Number = 0.0
    kinetic: LoadLaw | BrokenLine | None = None
    backwards: LoadLaw | BrokenLine | None = None
    static: Number | None = None
    drift: Number = 0.0
    until: float | str | None = None
    pressing: JointPressing | None = None

    def forces(self, now: Situation) -> tuple[Number, Number]:
        """Force along the coordinate while it slips forwards, and while it slips backwards; by a law of its own."""
        assert self.kinetic is not None
        forwards = self.kinetic(now)
        if self.backwards is None:
            return -forwards, forwards
        return forwards, self.backwards(now)

    @property
    def has_row(self) -> bool:
        """Whether it becomes a constraint; a compliant stop is a force in each of its modes."""
        return self.kind != COMPLIANT


@dataclass(frozen=True)
class Condition:
    """A user's event: a formula of time, a coordinate and its speed that passes zero.

    Attributes
    ----------
    coordinate : None of a formula of time alone
    ends : whether it ends the motion
    """

    label: str
    coordinate: Coordinate | None
    formula: TextFormula
    ends: bool


@dataclass(frozen=True)
class ContactMode:
    """The mode of a contact as numbers over any algebra.

    Attributes
    ----------
    active : of a stop -1, 0 or 1; of friction and clamps 1 while they hold
    sense : of friction the sense in which it slips; 0 while it sticks
    held : value of the coordinate less the drift's way at which it holds [rad or m]
    first, second : of friction by a coefficient the weights of the two numbers of its reaction in what presses
    """

    active: Number
    sense: Number
    held: Number
    first: Number = 0.0
    second: Number = 0.0


FREE = ContactMode(0.0, 0.0, 0.0)


def coordinate_of_part(mechanism: Mechanism, part: MeasuredPart, where: str) -> Coordinate:
    """What a stop, a clamp or an event measures.

    Raises InputError on the sphere where two links have no hinge in common whose angle is measured.
    """
    on_sphere = mechanism.space == "sphere"
    if part.link is not None:
        if on_sphere:
            return _joint_angle(mechanism, part.link, part.relative_to, where)
        return Turn(part.link, part.relative_to)
    if part.guide is not None:
        return GuideArc(part.guide) if on_sphere else Slide(part.guide)
    if part.point is not None:
        return Component(part.point, part.direction or (1.0, 0.0))
    first, second = part.points or ("", "")
    return AngularDistance(first, second) if on_sphere else Distance(first, second)


def stop_coordinate(mechanism: Mechanism, stop: Stop) -> Coordinate:
    """What a stop bounds."""
    return coordinate_of_part(mechanism, stop, f"[[stops]] {stop.label}")


def _joint_angle(mechanism: Mechanism, link: str, other: str, where: str) -> Turn | Spin:
    hinge = hinge_of(
        mechanism, link, other, where, _("give relative_to: the link at the other side of its hinge")
    )
    joint, sense = joint_of_hinge(mechanism, link, other, hinge)
    if joint is None:
        what = _("the angle between {link} and {other} is not measured there")
        repair = _("let the first point of one of them be the hinge, and give it a reference on the other")
        raise InputError(where, what.format(link=link, other=other), repair)
    return Turn(joint) if sense > 0.0 else Spin(link, other, hinge, joint, sense)


def rubbing_coordinate(mechanism: Mechanism, coordinate: Coordinate) -> Coordinate:
    """What the friction of a load works along: on the sphere the turning in a hinge has a value, to hold what sticks.

    A turning about an axis that is no hinge has none.
    """
    if not isinstance(coordinate, Spin) or coordinate.joint is not None:
        return coordinate
    axis = coordinate.axis
    beside = [
        [name for name in points_of(mechanism, body) if name != axis]
        for body in (coordinate.link, coordinate.base)
        if axis in points_of(mechanism, body)
    ]
    if len(beside) < 2 or not all(beside):
        return coordinate
    own, other = (names[0] for names in beside)
    return HingeTurn(coordinate, own, other)


def contacts_of(mechanism: Mechanism, frictions: Iterable[Contact] = ()) -> tuple[Contact, ...]:
    """Stops, then clamps of a description, then the friction of its loads."""
    found = [
        Contact(
            STOP if stop.is_rigid else COMPLIANT,
            stop.label,
            stop_coordinate(mechanism, stop),
            stop.least,
            stop.most,
            stop.restitution or 0.0,
            stop.stiffness or 0.0,
            stop.damping or 0.0,
        )
        for stop in mechanism.stops
    ]
    found += [
        Contact(
            CLAMP,
            clamp.label,
            coordinate_of_part(mechanism, clamp, f"[[clamps]] {clamp.label}"),
            until=clamp.until,
        )
        for clamp in mechanism.clamps
    ]
    return (*found, *frictions)


def conditions_of(mechanism: Mechanism) -> tuple[Condition, ...]:
    """The user's events of a description."""
    found = []
    for event in mechanism.events:
        where = f"[[events]] {event.label}"
        formula = compile_formula(event.when, ("t", "x", "v"), where)
        measured = any(getattr(event, key) is not None for key in MEASURED)
        coordinate = coordinate_of_part(mechanism, event, where) if measured else None
        found.append(Condition(event.label, coordinate, formula, event.do == "end"))
    return tuple(found)


def friction_contact(
    load: HingeFriction | GuideFriction, label: str, law: Friction, along: Coordinate
) -> Contact:
    """The dry part of a friction as a contact.

    Raises InputError for a static value below a kinetic one that is a number; formulas are compared on the way.
    """
    static = load.static
    if static is not None and isinstance(law.dry, Constant) and static < law.dry.value:
        what = _("static ({static:.9g}) is at least the value ({value:.9g}): what sticks holds more")
        raise InputError(
            f"[[loads]] {label}",
            what.format(static=static, value=law.dry.value),
            _("exchange or correct them"),
        )
    return Contact(FRICTION, label, along, kinetic=law.dry, static=static, drift=load.surface_speed)


def sensed_contact(term: LoadTerm, label: str, where: str) -> Contact:
    """A load with a force for each sense of a motion: it rubs where that resists, and never sticks where it drives.

    Raises NotComputedYet where it acts along another way than that whose sense counts.
    """
    law = term.amount
    if isinstance(law, LoadDiagram):
        forwards, backwards = (
            BrokenLine(tuple((float(row[0]), float(row[column])) for row in law.rows), "x")
            for column in (1, 2)
        )
        return Contact(FRICTION, label, term.coordinate, kinetic=forwards, backwards=backwards)
    force, gate = term.coordinate, term.gate
    if isinstance(force, Component) and isinstance(gate, Component) and isinstance(law, Constant):
        (x, y), (u, v) = force.direction[:2], gate.direction[:2]
        along = (x * u + y * v) / (hypot(x, y) * hypot(u, v))
        if force.at == gate.at and force.axes == gate.axes and abs(abs(along) - 1.0) < PARALLEL:
            size = Constant(law.value * (1.0 if along > 0.0 else -1.0))
            return Contact(FRICTION, label, gate, kinetic=size, backwards=Constant(0.0))
    what = _(
        "a load that acts while a point moves in one sense, across its own line, is not computed by all coordinates"
    )
    repair = _("let it act along while_moving with a constant size, or use the reduced equation")
    raise NotComputedYet(where, what, repair)


PARALLEL = 1e-9
"""Two directions are one where their cosine misses 1 by less."""


@dataclass(frozen=True)
class SmoothFriction(ContinuousLaw):
    """What of a friction grows with the relative speed: -b (v - s) - c (v - s) |v - s|."""

    viscous: Number
    quadratic: Number
    drift: Number
    uses = frozenset("v")
    energy_class = Friction.energy_class

    def __call__(self, now: Any) -> Number:
        slip = now.v if isinstance(self.drift, float) and self.drift == 0.0 else now.v - self.drift
        return -self.viscous * slip - self.quadratic * slip * now.m.abs(slip)


@dataclass(frozen=True)
class StopPush(ContinuousLaw):
    """What a compliant stop exerts along its coordinate, whether it is closed or not: it pushes and never pulls."""

    least: Number | None
    most: Number | None
    stiffness: Number
    damping: Number
    uses = frozenset("xv")
    energy_class = EnergyClass.STORED

    def energy(self, x: Number) -> Number:
        """Potential energy of its spring [J] at a value of its coordinate."""
        found: Number = 0.0
        if self.most is not None:
            found = found + 0.5 * self.stiffness * np.maximum(x - self.most, 0.0) ** 2
        if self.least is not None:
            found = found + 0.5 * self.stiffness * np.maximum(self.least - x, 0.0) ** 2
        return found

    def __call__(self, now: Any) -> Number:
        found: Number = 0.0
        for bound, side in ((self.most, 1.0), (self.least, -1.0)):
            if bound is None:
                continue
            beyond = side * (now.x - bound)
            push = now.m.max(self.stiffness * beyond + self.damping * (side * now.v), 0.0)
            # what is open does not damp
            found = found - side * now.m.where(now.m.less(0.0, beyond), push, 0.0)
        return found


def row_numbers(contacts: Sequence[Contact]) -> tuple[int, ...]:
    """Numbers of the contacts that have a row, in the order of their rows."""
    return tuple(k for k, contact in enumerate(contacts) if contact.has_row)


def pressed_numbers(contacts: Sequence[Contact]) -> tuple[int, ...]:
    """Numbers of the contacts whose friction goes with a reaction."""
    return tuple(k for k, contact in enumerate(contacts) if contact.pressing is not None)
