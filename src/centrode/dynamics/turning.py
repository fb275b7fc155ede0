"""What moments work along: the angle between two links, in the plane, in a hinge of the sphere, about an axis."""

from __future__ import annotations

from centrode.dynamics.coordinates import Coordinate, Spin, Turn
from centrode.errors import InputError
from centrode.locale import _
from centrode.model.loads import Load
from centrode.model.mechanism import FRAME, Mechanism


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
