"""By how much a group of class II falls short of closing, in words a designer can act on."""

from __future__ import annotations

from centrode.algebra.arrays import ARRAYS
from centrode.kinematics.evaluate import Choices, Hooks
from centrode.kinematics.groups import aim_curve, loci_of
from centrode.locale import _
from centrode.structure.constraints import Positions
from centrode.structure.dimensions import Dimensions
from centrode.structure.groups import Aim, Group, Locus, Meet, Rail, Rod, Stroke, Touch


def shortfall(group: Group, numbers: Dimensions, at: Positions) -> str:
    """The sentence that says what is too short or too long, and by how much."""
    if isinstance(group, Aim):
        return _of_aim(group, numbers, at)
    assert isinstance(group, Meet)
    one, other = loci_of(group, ARRAYS, numbers, at, Choices(Hooks(), 0))
    lack = numbers.space.lack(ARRAYS, one, other)
    by = f"{max(lack):.4g} {numbers.space.unit}"
    reason = lack.index(max(lack))
    links = [rod.link for rod in group.rods]
    if len(links) == 2:
        return _of_two_links(reason, (links[0], links[1]), by)
    if group.circles > len(links):
        return _of_circles(reason, [circle_name(locus) for locus in group.loci], by)
    if len(links) == 1:
        if reason in (1, 3):
            return _("link {a} is too long for its guide by {by}").format(a=links[0], by=by)
        return _("link {a} is too short to reach its guide by {by}").format(a=links[0], by=by)
    guides = [locus.guide for locus in group.loci if isinstance(locus, Rail)]
    return _("guides {names} do not meet by {by}").format(names=_(" and ").join(guides), by=by)


def _of_aim(group: Aim, numbers: Dimensions, at: Positions) -> str:
    space = numbers.space
    pivot = space.place(ARRAYS, space.at_rest, numbers.local[group.link][group.pivot])
    offset = space.reach(ARRAYS, aim_curve(group, numbers), pivot)
    by = float(offset - space.distance(ARRAYS, at.points[group.target], at.points[group.pivot]))
    if by <= 0.0:  # only circles can be too near as well
        return _("{line} does not reach as far as {b}").format(line=line_name(group), b=group.target)
    return _("the offset of {line} exceeds the distance {a}-{b} by {by}").format(
        line=line_name(group), a=group.pivot, b=group.target, by=f"{by:.4g} {space.unit}"
    )


def _of_two_links(reason: int, links: tuple[str, str], by: str) -> str:
    first, second = links
    if reason == 0:
        return _("links {a} and {b} together are too short by {by}").format(a=first, b=second, by=by)
    if reason == 3:
        return _("links {a} and {b} together are too long by {by}").format(a=first, b=second, by=by)
    longer, shorter = (first, second) if reason == 1 else (second, first)
    return _("link {a} is too long for link {b} by {by}").format(a=longer, b=shorter, by=by)


def _of_circles(reason: int, names: list[str], by: str) -> str:
    """Circles of which at least one is that of a cylinder or of a wheel; the other may be a line."""
    first, second = names
    if not second:
        return _("{a} is too short to reach its line by {by}").format(a=first, by=by)
    if reason == 0:
        return _("{a} and {b} together are too short by {by}").format(a=first, b=second, by=by)
    longer, shorter = (first, second) if reason == 1 else (second, first)
    return _("{a} is too long for {b} by {by}").format(a=longer, b=shorter, by=by)


def circle_name(locus: Locus) -> str:
    """What draws the circle of a locus; nothing for a line."""
    if isinstance(locus, Rod):
        return _("link {link}").format(link=locus.link)
    if isinstance(locus, Stroke):
        return _("cylinder {drive}").format(drive=locus.drive)
    if isinstance(locus, Touch) and locus.letter == "R":
        return _("wheel {wheel}").format(wheel=locus.contact.rolling)
    return ""


def line_name(group: Aim) -> str:
    """What an aimed link passes its target with."""
    if group.contact is not None:
        return _("wheel {wheel}").format(wheel=group.contact.rolling)
    return _("guide {guide}").format(guide=group.guide)
