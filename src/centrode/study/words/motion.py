"""Sentences on how a mechanism moves: what is driven, and what follows what, group by group of the plan."""

from __future__ import annotations

import math
from collections.abc import Iterator

from centrode.locale import _, mark
from centrode.model.mechanism import FRAME, Mechanism
from centrode.structure.assur import assur_groups, is_input
from centrode.structure.groups import (
    Aim,
    CylinderCircle,
    Group,
    Meet,
    Newton,
    Rail,
    RigidPoint,
    Rod,
    Train,
    TurnedLink,
    Turning,
    TwoPointLink,
    links_of,
)
from centrode.structure.plan import Structure
from centrode.study.words.drives import sentence_on_drive
from centrode.study.words.joints import links_at
from centrode.study.words.levers import extent, on_lever
from centrode.study.words.lists import called, links_listed
from centrode.study.words.roles import Roles

# Translators: {link}, {coupler}, {follower} are names of links, {pivot} and {point} of points; names do not change.
FOLLOWERS = {
    "turns": mark(
        "Coupler {coupler} passes the motion on to crank {follower}, which turns fully about {pivot}."
    ),
    "swings": mark(
        "Coupler {coupler} passes the motion on to rocker {follower}, which swings about {pivot} through {angle}."
    ),
    "moves": mark("Coupler {coupler} passes the motion on to link {follower}, which turns about {pivot}."),
    "still": mark("Coupler {coupler} leads to link {follower}, which does not turn."),
}


def sentences_on_motion(structure: Structure, roles: Roles) -> Iterator[str]:
    """What is driven, then what follows it, in the order of the plan."""
    told: set[str] = set()
    for drive in structure.mechanism.drives:
        yield sentence_on_drive(drive, roles)
        told.update([drive.link] if drive.link else [])
    classes = {group.members: group.roman for group in assur_groups(structure)}
    for group in structure.groups:
        if isinstance(group, Newton):
            roman = next(
                (roman for members, roman in classes.items() if set(group.links) <= set(members)), ""
            )
            yield _(
                "Links {links} form a group of class {roman}: none of them can be placed without the others."
            ).format(links=links_listed(group.links), roman=roman)
        elif not isinstance(group, RigidPoint):
            yield from _on_group(structure, roles, group, told)
        told.update(links_of(group))


def _on_group(structure: Structure, roles: Roles, group: Group, told: set[str]) -> Iterator[str]:
    if isinstance(group, Aim):
        yield on_lever(roles, group)
    elif isinstance(group, Meet):
        yield from _on_meeting(structure, roles, group)
    elif isinstance(group, Train):
        links = [link for link in group.links if link not in told]
        yield _("The wheels turn links {links} together.").format(links=links_listed(links))
    elif isinstance(group, TurnedLink):
        yield from _on_turned_link(roles, group)
    elif isinstance(group, TwoPointLink):
        yield _(
            "Link {link}, hinged in {first} and {second}, only follows: without it everything else moves the same."
        ).format(link=called(group.link), first=group.first, second=group.second)


def _on_turned_link(roles: Roles, group: TurnedLink) -> Iterator[str]:
    turning, place = group.turning, {"link": called(group.link), "point": group.pivot}
    if isinstance(turning, Turning):
        # the link of a guide is told with what moves it along the guide
        if turning.guide is not None and roles.mechanism.guide(turning.guide).point != group.pivot:
            yield _("Link {link} follows {point} without turning.").format(**place)
        return
    if not roles.one_turn:
        yield _("Link {link} turns with the wheels about {point}.").format(**place)
        return
    turns = roles.turned[group.link] / math.tau
    drive = roles.mechanism.drives[0]
    opposite = turns * (drive.speed or 1.0) < 0
    text = (
        _(
            "Link {link} turns with the wheels about {point}, in the ratio {ratio} to the drive, in the opposite sense."
        )
        if opposite
        else _(
            "Link {link} turns with the wheels about {point}, in the ratio {ratio} to the drive, in the same sense."
        )
    )
    yield text.format(ratio=f"{abs(turns):.4g}", **place)


def _on_meeting(structure: Structure, roles: Roles, group: Meet) -> Iterator[str]:
    rods, rails = group.rods, [locus for locus in group.loci if isinstance(locus, Rail)]
    strokes = [locus.drive for locus in group.loci if isinstance(locus, CylinderCircle)]
    if strokes:
        yield from (_moved_by_cylinder(roles, strokes[0], rod.link) for rod in rods)
    elif group.carriage is not None:
        yield from _on_carriage(roles, group)
    elif len(rods) == 2:
        yield _on_two_links(structure.mechanism, roles, *rods)
    elif rods and rails:
        yield _on_slider(roles, rods[0], rails[0])
    elif rods:
        yield _("Link {link} follows.").format(link=called(rods[0].link))
    elif not is_input(group):
        yield _("The slider in {point} is led by both its guides.").format(point=group.points[0])


def _moved_by_cylinder(roles: Roles, cylinder: str, link: str) -> str:
    pivot = roles.pivot(link)
    key, angle = extent(roles, link)
    place = {"cylinder": cylinder, "link": called(link), "pivot": pivot, "angle": angle}
    if pivot is None:
        return _("Cylinder {cylinder} moves link {link}.").format(**place)
    if key == "swings":
        return _("Cylinder {cylinder} swings link {link} about {pivot} through {angle}.").format(**place)
    return _("Cylinder {cylinder} turns link {link} about {pivot}.").format(**place)


def _on_carriage(roles: Roles, group: Meet) -> Iterator[str]:
    """A link of known angle, which links or guides place."""
    link = str(group.carriage)
    if group.rods:
        rods = [rod.link for rod in group.rods]
        if len(rods) == 2:
            yield _("Links {links} carry link {link}.").format(links=links_listed(rods), link=called(link))
        else:
            yield _("Link {rod} carries link {link}.").format(rod=called(rods[0]), link=called(link))
        return
    guides = [guide for guide in roles.mechanism.guides if guide.link == link and guide.on == FRAME]
    if guides and guides[0].id in roles.strokes:
        text = (
            _("Link {link} moves to and fro along its guide; its stroke is {stroke}.")
            if roles.comes_back(guides[0].id)
            else _("Link {link} moves along its guide, by {stroke} in all.")
        )
        yield text.format(link=called(link), stroke=roles.length_text(roles.strokes[guides[0].id]))
    elif guides:
        yield _("Link {link} moves along its guide.").format(link=called(link))
    else:
        yield _("Link {link} follows without turning.").format(link=called(link))


def _on_two_links(mechanism: Mechanism, roles: Roles, one: Rod, other: Rod) -> str:
    """A dyad of two links: a coupler and what it moves, or two links that join moving ones."""
    pivoted = [rod for rod in (one, other) if rod.centre in mechanism.frame.points]
    if len(pivoted) == 1:
        follower = pivoted[0]
        coupler = other if follower is one else one
        key, angle = extent(roles, follower.link)
        return _(FOLLOWERS[key]).format(
            coupler=called(coupler.link), follower=called(follower.link), pivot=follower.centre, angle=angle
        )
    place = {
        "one": called(one.link),
        "other": called(other.link),
        "point": one.point,
        "first": _carriers(mechanism, one),
        "first_point": one.centre,
        "second": _carriers(mechanism, other),
        "second_point": other.centre,
    }
    if not place["first"] or not place["second"]:
        # what holds one of them is no link: the frame, or a slider
        return _(
            "Links {one} and {other}, hinged to each other in {point}, follow {first_point} and {second_point}."
        ).format(**place)
    return _(
        "Links {one} and {other}, hinged to each other in {point}, follow: {one} is hinged to {first} in {first_point},"
        " {other} to {second} in {second_point}."
    ).format(**place)


def _carriers(mechanism: Mechanism, rod: Rod) -> str:
    """What holds the known end of a link."""
    return links_listed(name for name in links_at(mechanism, rod.centre) if name != rod.link)


def _on_slider(roles: Roles, rod: Rod, rail: Rail) -> str:
    guide = roles.mechanism.guide(rail.guide)
    place = {"coupler": called(rod.link), "point": guide.point, "on": called(rail.on)}
    if rail.on != FRAME:
        return _("Link {coupler} moves the slider in {point} along link {on}.").format(**place)
    if guide.id not in roles.strokes:
        return _("Coupler {coupler} moves the slider in {point} along its guide.").format(**place)
    text = (
        _("Coupler {coupler} moves the slider in {point} to and fro along its guide; its stroke is {stroke}.")
        if roles.comes_back(guide.id)
        else _("Coupler {coupler} moves the slider in {point} along its guide, by {stroke} in all.")
    )
    return text.format(stroke=roles.length_text(roles.strokes[guide.id]), **place)
