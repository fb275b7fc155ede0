"""By how much a group of class II falls short of closing, in words a designer can act on."""

from __future__ import annotations

from math import hypot
from typing import cast

from centrode.algebra.arrays import ARRAYS
from centrode.geometry.plane import cross, subtract
from centrode.kinematics.groups import Circle, Line, aim_line, loci_of
from centrode.locale import _
from centrode.structure.dimensions import Dimensions
from centrode.structure.groups import Aim, Group, Meet
from centrode.structure.positions import Positions


def shortfall(group: Group, numbers: Dimensions, at: Positions) -> str:
    """The sentence that says what is too short or too long, and by how much [m]."""
    if isinstance(group, Aim):
        pivot = numbers.local[group.link][group.pivot]
        through, direction = aim_line(group, numbers)
        offset = abs(float(cross(direction, subtract(through, pivot))))
        reach = hypot(*subtract(at.points[group.target], at.points[group.pivot]))
        return _("the offset of guide {guide} exceeds the distance {a}-{b} by {by:.4g} m").format(
            guide=group.guide, a=group.pivot, b=group.target, by=offset - reach
        )
    assert isinstance(group, Meet)
    one, other = loci_of(group, ARRAYS, numbers, at)
    first = group.rods[0]
    if isinstance(one, Circle) and isinstance(other, Circle):
        second = group.rods[1]
        apart = hypot(*subtract(one.centre, other.centre))
        radii = abs(float(one.radius)), abs(float(other.radius))
        if apart > sum(radii):
            return _("links {a} and {b} together are too short by {by:.4g} m").format(
                a=first.link, b=second.link, by=apart - sum(radii)
            )
        longer, shorter = (first, second) if radii[0] > radii[1] else (second, first)
        return _("link {a} is too long for link {b} by {by:.4g} m").format(
            a=longer.link, b=shorter.link, by=abs(radii[0] - radii[1]) - apart
        )
    circle, line = cast(Circle, one), cast(Line, other)
    offset = abs(float(cross(line.direction, subtract(circle.centre, line.through))))
    return _("link {a} is too short to reach its guide by {by:.4g} m").format(
        a=first.link, by=offset - abs(float(circle.radius))
    )
