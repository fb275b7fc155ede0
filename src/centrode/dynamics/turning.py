"""What moments work along: the angle between two links, in the plane, in a hinge of the sphere, about an axis."""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot
from typing import Any, TypeAlias

from centrode.algebra.jets import Jet
from centrode.dynamics.coordinates import Coordinate, Turn, place_of
from centrode.dynamics.pulls import Pull, couple
from centrode.dynamics.states import Place, State
from centrode.errors import InputError
from centrode.locale import _
from centrode.model.loads import Load
from centrode.model.mechanism import FRAME, Mechanism

Number: TypeAlias = Any


@dataclass(frozen=True)
class Spin:
    """On the sphere: turning of a link against another about an axis, a hinge or a direction of the frame.

    Attributes
    ----------
    axis : a point's name, or components in the frame's axes
    joint : str or None
        The link whose joint angle this is, where one is measured in this hinge; `sense` tells which way.
    """

    link: str
    base: str
    axis: str | tuple[float, ...]
    joint: str | None = None
    sense: float = 1.0

    def value(self, state: State) -> Number:
        if self.joint is None:
            return float("nan")
        return self.sense * state.angle(self.joint).value

    def slope(self, state: State) -> Jet:
        along = [x.lowered() for x in self._axis(state)]
        pairs = zip(state.spin(self.link), state.spin(self.base), along, strict=True)
        parts = [(own - other) * axis for own, other, axis in pairs]
        return sum(parts[1:], parts[0])

    def pulls(self, state: State) -> tuple[Pull, ...]:
        axis = place_of(self._axis(state))
        return couple(self.link, axis), couple(self.base, tuple(-x for x in axis))

    def _axis(self, state: State) -> Place:
        if isinstance(self.axis, str):
            unit = 1.0 / state.mechanism.sphere_radius
            return tuple(x * unit for x in state.point(self.axis))
        size = hypot(*self.axis)
        return tuple(Jet((x / size, 0.0, 0.0)) for x in self.axis)


@dataclass(frozen=True)
class Travel:
    """How far the drive has gone, whichever way: what works along it resists the drive itself."""

    def value(self, state: State) -> Number:
        return float("nan")

    def slope(self, state: State) -> Jet:
        return Jet((state.m.base.sign(state.rate), 0.0))

    def pulls(self, state: State) -> tuple[Pull, ...]:
        raise NotImplementedError("no force on a link works along it")


def turning_of(mechanism: Mechanism, load: Load, where: str, measured: bool) -> Coordinate:
    """The turning of a load's link against another; `measured` where the load asks for the angle itself.

    Raises InputError on the sphere where nothing tells the axis, or nothing measures an angle that is asked for.
    """
    assert load.link is not None
    if mechanism.space != "sphere":
        return Turn(load.link, load.relative_to)
    axis = hinge_of(mechanism, load.link, load.relative_to, where) if load.axis is None else load.axis
    joint, sense = _joint(mechanism, load.link, load.relative_to, axis)
    if measured and joint is None:
        what = _("no angle is measured between {link} and {other} there, and the load depends on it")
        repair = _("let the first point of one of them be the hinge, and give it a reference on the other")
        raise InputError(where, what.format(link=load.link, other=load.relative_to), repair)
    return Spin(load.link, load.relative_to, axis, joint, sense)


def hinge_of(mechanism: Mechanism, link: str, other: str, where: str) -> str:
    """The point that two links share; raises InputError where there is none or more than one."""
    shared = [point for point in points_of(mechanism, link) if point in points_of(mechanism, other)]
    if len(shared) == 1:
        return shared[0]
    if shared:
        what = _("{link} and {other} share the points {points}")
        repair = _("say which: axis = a point")
        raise InputError(where, what.format(link=link, other=other, points=", ".join(shared)), repair)
    what = _("{link} and {other} have no hinge in common").format(link=link, other=other)
    repair = _("give relative_to, or axis: a point, or [x, y, z] in the axes of the frame")
    raise InputError(where, what, repair)


def points_of(mechanism: Mechanism, link: str) -> list[str]:
    """Names of the points of a link or of the frame."""
    return list(mechanism.frame.points if link == FRAME else mechanism.links[link].coordinates)


def _joint(
    mechanism: Mechanism, link: str, other: str, axis: str | tuple[float, ...]
) -> tuple[str | None, float]:
    """The link whose joint angle is that of one against the other about a point, and which way it counts."""
    for one, base, sense in ((link, other, 1.0), (other, link, -1.0)):
        reference = None if one == FRAME else mechanism.links[one].reference
        # a reference starts in the first point of its link, which is the axis of the angle
        if (
            reference is not None
            and reference[0] == axis
            and set(reference) <= set(points_of(mechanism, base))
        ):
            return one, sense
    return None, 1.0
