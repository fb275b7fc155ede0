"""Checks of a description's parts against each other: every name is known, every link has its points."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import chain, islice

from centrode.locale import _
from centrode.model import limits
from centrode.model.bodies import Link
from centrode.model.cam_driving import follower_problems
from centrode.model.connection import disconnected_parts
from centrode.model.description import Description
from centrode.model.joining import cylinder_problems, joining_problems
from centrode.model.known import is_link, known, link_known, points_on, two_known_points
from centrode.model.names import two_points
from centrode.model.on_sphere import space_problems
from centrode.model.problems import Place, Problem, nearest, shown


def problems_of_parts(mechanism: Description) -> list[Problem]:
    """Everything wrong among the parts; the parts that do not hang together are told only if nothing else is."""
    checks = (_links, _guides, joining_problems, _drives, space_problems, _rest)
    found = chain.from_iterable(check(mechanism) for check in checks)
    return list(islice(found, limits.PROBLEMS_SOUGHT)) or list(_loose(mechanism))


def _links(mechanism: Description) -> Iterator[Problem]:
    if not mechanism.links:
        yield Problem(_("there are no links"), _("describe at least one, such as [links.OA] with a length"))
    for name, link in mechanism.links.items():
        yield from _link(name, link, ("links", name))
    if len(mechanism.points) > limits.POINTS:
        yield Problem(_("at most {most} points are allowed").format(most=limits.POINTS))
    for name, link in mechanism.links.items():
        if isinstance(link.centre, str):
            yield from known(link.centre, link.coordinates, "point", ("links", name, "centre"), name)


def _link(name: str, link: Link, at: Place) -> Iterator[Problem]:
    if isinstance(link.points, Mapping):
        if not link.points:
            yield Problem(_("the link has no points"), _("name them: points = { A = [0, 0] }"), at)
        if link.length is not None:
            repair = _("take the length out")
            yield Problem(_("a link whose points have coordinates has no length of its own"), repair, at)
        return
    if not link.points:
        yield Problem(*_without_points(name, link), at)
        return
    if len(set(link.points)) < len(link.points):
        yield Problem(_("a point is named twice"), _("name each point once"), at)
    if len(link.points) > 2:
        repair = _("give them: points = { A = [0, 0], B = [1, 0], ... }")
        yield Problem(_("three or more points need coordinates"), repair, at)
    elif len(link.points) == 2 and link.length is None:
        yield Problem(_("length is missing"), _("give the distance of its points"), at)
    elif len(link.points) == 1 and link.length is not None:
        yield Problem(_("a link of one point has no length"), _("name its second point, or take it out"), at)


def _without_points(name: str, link: Link) -> tuple[str, str]:
    points = two_points(name)
    if points:
        what = _("length is missing")
        return what, _("give the distance of {first} and {second}, or points").format(
            first=points[0], second=points[1]
        )
    return _("points are missing"), _('name them: points = ["A", "B"]')


def _guides(mechanism: Description) -> Iterator[Problem]:
    identities: set[str] = set()
    for index, guide in enumerate(mechanism.guides):
        at: Place = ("guides", index)
        if guide.id in identities:
            what = _("there are two guides {name}").format(name=shown(guide.id))
            yield Problem(what, _("give one of them a name of its own: name = ..."), at)
        identities.add(guide.id)
        yield from link_known(mechanism, guide.on, (*at, "on"))
        for key, line in (("through", guide.through), ("pole", guide.pole)):
            if isinstance(line, str) and is_link(mechanism, guide.on):
                yield from known(line, points_on(mechanism, guide.on), "point", (*at, key), guide.on)
        if guide.on in mechanism.links and guide.point in mechanism.links[guide.on].coordinates:
            what = _("point {point} is a point of {link} already, it cannot slide on it")
            repair = _("take it out of the link, or guide another point")
            yield Problem(what.format(point=shown(guide.point), link=guide.on), repair, at)
        if guide.link is not None:
            yield from _guided_link(mechanism, guide.link, guide.point, guide.on, at)


def _guided_link(mechanism: Description, link: str, point: str, on: str, at: Place) -> Iterator[Problem]:
    unknown = list(link_known(mechanism, link, (*at, "link"), moving=True))
    yield from unknown
    if not unknown and point not in mechanism.links[link].coordinates:
        what = _("link {link} does not contain the guided point {point}").format(
            link=link, point=shown(point)
        )
        yield Problem(what, nearest(point, mechanism.links[link].coordinates), at)
    if link == on:
        yield Problem(
            _("link {link} cannot be guided on itself").format(link=link), _("name another link"), at
        )


def _drives(mechanism: Description) -> Iterator[Problem]:
    identities: set[str] = set()
    for index, drive in enumerate(mechanism.drives):
        at: Place = ("drives", index)
        if drive.id in identities:
            yield Problem(
                _("{name} is driven twice").format(name=shown(drive.id)), _("keep one of the drives"), at
            )
        identities.add(drive.id)
        if drive.link:
            yield from link_known(mechanism, drive.link, (*at, "link"), moving=True)
            yield from link_known(mechanism, drive.relative_to, (*at, "relative_to"))
        if drive.link and drive.link == drive.relative_to:
            yield Problem(_("a link cannot be driven relative to itself"), _("name another link"), at)
        if drive.guide:
            yield from known(drive.guide, [guide.id for guide in mechanism.guides], "guide", (*at, "guide"))
        if drive.distance:
            wrong = list(two_known_points(mechanism, drive.distance, (*at, "distance")))
            yield from wrong or cylinder_problems(mechanism, drive, at)
        yield from follower_problems(mechanism, drive, at)


def _rest(mechanism: Description) -> Iterator[Problem]:
    names = [*mechanism.points, *mechanism.links, *(guide.id for guide in mechanism.guides)]
    for name in mechanism.assembly.sides:
        yield from known(name, names, "point, link or guide", ("assembly", "sides", name))
    for index, load in enumerate(mechanism.loads):
        at: Place = ("loads", index)
        if load.point:
            yield from known(load.point, mechanism.points, "point", (*at, "point"))
        if load.link:
            yield from link_known(mechanism, load.link, (*at, "link"), moving=True)
        if load.guide:
            yield from known(load.guide, [guide.id for guide in mechanism.guides], "guide", (*at, "guide"))
        if load.pin:
            yield from link_known(mechanism, load.pin, (*at, "pin"))
        yield from two_known_points(mechanism, load.points, (*at, "points"))
        yield from link_known(mechanism, load.axes, (*at, "axes"))
        yield from link_known(mechanism, load.relative_to, (*at, "relative_to"))
    for point in mechanism.report.points:
        yield from known(point, mechanism.points, "point", ("report", "points"))


def _loose(mechanism: Description) -> Iterator[Problem]:
    for part in disconnected_parts(mechanism):
        at: Place = ("links", part.links[0]) if part.links else ()
        what = _("nothing connects {names} to the frame").format(names=part)
        yield Problem(what, _("hinge it to a link that is connected, or give it a guide"), at)
