"""The steps of a plan in words: what is found, and from what."""

from __future__ import annotations

from centrode.locale import _, ngettext
from centrode.model.names import body_word
from centrode.structure.groups import (
    Aim,
    Group,
    Locus,
    Meet,
    Newton,
    Rail,
    RigidPoint,
    Rod,
    Slot,
    Stroke,
    TurnedLink,
    TwoPointLink,
    links_of,
    points_of,
)
from centrode.structure.wheel_groups import Meshed, Rolled, Rolloff, Touch, Train


def step_of(group: Group) -> str:
    """One line for one group of a plan."""
    if isinstance(group, RigidPoint):
        return _("point {point} of link {link}").format(point=group.point, link=group.link)
    if isinstance(group, TwoPointLink):
        return _("link {link} through {first} and {second}").format(
            link=group.link, first=group.first, second=group.second
        )
    if isinstance(group, Train):
        return _("gear train: links {links} turned together").format(links=", ".join(group.links))
    if isinstance(group, TurnedLink):
        if isinstance(group.turning, Meshed):
            return _("link {link} about {point}, turned by gear {gear}").format(
                link=group.link, point=group.pivot, gear=group.turning.gear.gear
            )
        if isinstance(group.turning, Rolled):
            return _("wheel {link} about {point}, turned by rolling on {on}").format(
                link=group.link, point=group.pivot, on=body_word(group.turning.rolling.on)
            )
        if group.turning.drive is not None:
            return _("link {link} about {point}, turned by its drive").format(
                link=group.link, point=group.pivot
            )
        return _("link {link} at {point}, kept from turning by guide {guide}").format(
            link=group.link, point=group.pivot, guide=group.turning.guide
        )
    if isinstance(group, Aim) and group.contact is not None:
        return _("RPR: link {link} about {point}, resting on wheel {wheel} about {target}").format(
            link=group.link, point=group.pivot, wheel=group.contact.rolling, target=group.target
        )
    if isinstance(group, Aim):
        return _("RPR: link {link} about {point}, its guide {guide} through {target}").format(
            link=group.link, point=group.pivot, guide=group.guide, target=group.target
        )
    if isinstance(group, Newton):
        return _("higher class: {names}").format(names=", ".join(group.points + group.links))
    return _meeting(group)


def _meeting(group: Meet) -> str:
    one, other = (_locus(locus) for locus in group.loci)
    if group.carriage is None:
        return _("{kind}: point {point}, where {one} meets {other}").format(
            kind=group.kind, point=group.points[0], one=one, other=other
        )
    return _("{kind}: link {link} of known angle, where {one} meets {other}").format(
        kind=group.kind, link=group.carriage, one=one, other=other
    )


def _locus(locus: Locus) -> str:
    if isinstance(locus, Rod):
        return _("the circle of {link} about {point}").format(link=locus.link, point=locus.centre)
    if isinstance(locus, Stroke):
        return _("the circle about {point} as large as the cylinder is long").format(point=locus.centre)
    if isinstance(locus, Rail):
        return _("the line of guide {guide}").format(guide=locus.guide)
    if isinstance(locus, Slot):
        return _("guide {guide} through {point}").format(guide=locus.guide, point=locus.point)
    if isinstance(locus, Touch):
        return (
            _("the line beside the track of wheel {wheel}").format(wheel=locus.contact.rolling)
            if locus.letter == "P"
            else _("the circle about the track of wheel {wheel}").format(wheel=locus.contact.rolling)
        )
    if isinstance(locus, Rolloff):
        return _("the place to which wheel {wheel} rolls").format(wheel=locus.rolling.rolling)
    return _("the stop that the drive of guide {guide} sets").format(guide=locus.guide)


def name_of(group: Group) -> str:
    """A group by its links and points, as messages and tables name it."""
    links = "-".join(links_of(group))
    count, points = len(points_of(group)), ", ".join(points_of(group))
    if links and points:
        name = ngettext("group {links} (point {points})", "group {links} (points {points})", count)
        return name.format(links=links, points=points)
    return _("group {links}").format(links=links or points)
