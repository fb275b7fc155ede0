"""Rotors and angles of links that a drive, a guide, a gear or rolling turns, over any algebra."""

from __future__ import annotations

from typing import Any, TypeAlias

from centrode.geometry.plane import Vector, reversed_rotor, rotor_of, turned
from centrode.kinematics.wheels import Continued, followed
from centrode.structure.constraints import Positions
from centrode.structure.dimensions import Dimensions
from centrode.structure.groups import Following, Turning

Number: TypeAlias = Any
Namespace: TypeAlias = Any


def difference_of(turning: Turning, m: Namespace, numbers: Dimensions, at: Positions) -> Vector:
    """Rotor from the body that a turning is relative to, to its link."""
    if turning.drive is not None:
        return rotor_of(m, at.drives[turning.drive])
    return numbers.turn[turning.guide or ""]


def turn_link(
    turning: Turning | Following,
    link: str,
    m: Namespace,
    numbers: Dimensions,
    at: Positions,
    continued: Continued,
) -> Vector:
    """Rotor of a link whose angle follows, in the plane; the angle is added where it is known with its turns."""
    if isinstance(turning, Turning):
        add_angle(turning, link, numbers, at)
        return turning_rotor(turning, link, m, numbers, at)
    rotor, angle = followed(turning, link, m, numbers, at, continued)
    if angle is not None:
        at.angles[link] = angle
    return rotor


def add_angle(turning: Turning, link: str, numbers: Dimensions, at: Positions) -> None:
    """Add the angle of a driven link with its turns, if that of the other link is known."""
    if turning.drive is not None and numbers.reference(turning.link) is not None:
        # on the sphere the angle is that between the two links itself, and tells nothing of the other one's
        if link == turning.link:
            at.angles[link] = at.drives[turning.drive]
        return
    other = turning.relative_to if link == turning.link else turning.link
    if turning.drive is not None and other in at.angles:
        value = at.drives[turning.drive]
        at.angles[link] = value + at.angles[other] if link == turning.link else at.angles[other] - value


def turning_rotor(turning: Turning, link: str, m: Namespace, numbers: Dimensions, at: Positions) -> Vector:
    """Rotor of a link whose angle a drive or a guide gives against a body that is known, in the plane."""
    difference = difference_of(turning, m, numbers, at)
    if link == turning.link:
        return turned(at.poses[turning.relative_to].rotor, difference)
    return turned(at.poses[turning.link].rotor, reversed_rotor(difference))
