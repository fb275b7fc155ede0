"""Checks of what joins links besides hinges and guides: gears, rolling, cylinders."""

from __future__ import annotations

from collections.abc import Iterator

from centrode.locale import _
from centrode.model.description import Description, value_at_start
from centrode.model.driving import Drive
from centrode.model.known import is_link, known, link_known, points_on
from centrode.model.names import FRAME
from centrode.model.pairs import Gear, Rolling
from centrode.model.problems import Place, Problem, shown

SAME = 1e-9
"""Radii that differ by less than this part of the greater are equal, as a wheel that fills its ring."""


def joining_problems(mechanism: Description) -> Iterator[Problem]:
    """Problems of gears and rolling wheels."""
    identities: set[str] = set()
    for index, gear in enumerate(mechanism.gears):
        at: Place = ("gears", index)
        yield from _gear(mechanism, gear, at)
        yield from _once(gear.id, identities, at)
    for index, wheel in enumerate(mechanism.rolling):
        at = ("rolling", index)
        yield from _rolling(mechanism, wheel, at)
        yield from _once(wheel.id, identities, at)


def _once(identity: str, identities: set[str], at: Place) -> Iterator[Problem]:
    if identity in identities:
        what = _("there are two gears or rolling wheels {name}").format(name=shown(identity))
        yield Problem(what, _("give one of them a name of its own: name = ..."), at)
    identities.add(identity)


def _gear(mechanism: Description, gear: Gear, at: Place) -> Iterator[Problem]:
    if len(gear.links) != 2 or gear.links[0] == gear.links[-1]:
        yield Problem(_("a gear needs two different links"), _('name them: links = ["OA", "wheel"]'), at)
    elif FRAME in gear.links and gear.carrier == FRAME:
        what = _("a gear with the frame as one of its wheels needs a carrier that moves")
        yield Problem(what, _("name the link that holds both axes: carrier = ..."), at)
    elif gear.carrier in gear.links:
        what = _("link {link} cannot be a wheel and the carrier of one gear").format(link=gear.carrier)
        yield Problem(what, _("name the link that holds both axes: carrier = ..."), at)
    for name in gear.links:
        yield from link_known(mechanism, name, (*at, "links"))
    yield from link_known(mechanism, gear.carrier, (*at, "carrier"))


def _rolling(mechanism: Description, wheel: Rolling, at: Place) -> Iterator[Problem]:
    unknown = list(link_known(mechanism, wheel.link, (*at, "link"), moving=True))
    yield from unknown
    if not unknown:
        local = mechanism.links[wheel.link].coordinates
        yield from known(wheel.centre, local, "point", (*at, "centre"), wheel.link)
    yield from link_known(mechanism, wheel.on, (*at, "on"))
    if wheel.link == wheel.on:
        what = _("link {link} cannot roll on itself").format(link=wheel.link)
        yield Problem(what, _("name another link"), at)
    elif is_link(mechanism, wheel.on):
        yield from _on_track(mechanism, wheel, at)
    circle, inside = wheel.along.radius, wheel.along.inside
    if inside and circle is not None and abs(circle - wheel.radius) <= SAME * max(circle, wheel.radius):
        what = _("a wheel as large as the circle fills it and cannot roll inside")
        yield Problem(what, _("change one of the radii, or take inside out"), (*at, "radius"))


def _on_track(mechanism: Description, wheel: Rolling, at: Place) -> Iterator[Problem]:
    points = points_on(mechanism, wheel.on)
    if isinstance(wheel.along.centre, str):
        yield from known(wheel.along.centre, points, "point", (*at, "along", "centre"), wheel.on)
    if wheel.centre in points:
        what = _("point {point} is a point of {link} already, the wheel cannot roll on it")
        repair = _("take it out of the link, or let the wheel roll on another one")
        yield Problem(what.format(point=shown(wheel.centre), link=wheel.on), repair, at)


def cylinder_problems(mechanism: Description, drive: Drive, at: Place) -> Iterator[Problem]:
    """Problems of a driven distance between two known points: something has to be able to change it."""
    first, second = drive.distance or ("", "")
    for body in (FRAME, *mechanism.links):
        if {first, second} <= set(points_on(mechanism, body)):
            what = _("points {first} and {second} both belong to {link}: their distance cannot change")
            repair = _("name points of two different links")
            told = what.format(first=shown(first), second=shown(second), link=body)
            yield Problem(told, repair, (*at, "distance"))
    value = value_at_start(drive)
    if value is not None and value <= 0:
        what = _("a cylinder shorter than zero: its length at t = 0 is {value:g} m")
        yield Problem(what.format(value=value), _("give the distance of the points as start"), at)
