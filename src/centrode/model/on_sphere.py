"""Checks of what belongs to the sphere only, or to the plane only."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

from centrode.locale import _
from centrode.model.bodies import Link
from centrode.model.description import Description
from centrode.model.known import known, points_on, two_known_points
from centrode.model.names import FRAME
from centrode.model.problems import Place, Problem, shown
from centrode.model.sphere import makes_arc, unit_vector
from centrode.model.values import Placed, Vector

SPHERE_LINK_KEYS = ("reference", "centre_radius", "model")


def space_problems(mechanism: Description) -> Iterator[Problem]:
    """Keys of the other space, and what the sphere asks for."""
    if mechanism.space == "sphere":
        yield from _planar_keys(mechanism)
        yield from _angles(mechanism)
        return
    yield from _spherical_keys(mechanism)


def _spherical_keys(mechanism: Description) -> Iterator[Problem]:
    """Keys that mean something on the sphere only."""
    if mechanism.radius is not None:
        yield _spherical("radius", _("take it out"), ("radius",))
    for name, link in mechanism.links.items():
        for key in SPHERE_LINK_KEYS:
            if getattr(link, key) is not None:
                repair = _("take it out")
                if key == "reference":
                    repair = _("take it out; in the plane angles are measured from the x axis")
                yield _spherical(key, repair, ("links", name, key))
        if link.shape == "arc":
            yield _spherical("arc", _("write rod, disc or ring"), ("links", name, "shape"))
    for index, load in enumerate(mechanism.loads):
        if load.axis is not None:
            yield _spherical("axis", _("take it out"), ("loads", index, "axis"))


def _spherical(key: str, repair: str, at: Place) -> Problem:
    return Problem(_("{key} belongs to the sphere").format(key=key), repair, at)


def _planar_keys(mechanism: Description) -> Iterator[Problem]:
    """Keys that mean something in the plane only."""
    for name, link in mechanism.links.items():
        if link.shape == "rod":
            yield _planar("rod", _("write arc, disc or ring"), ("links", name, "shape"))
        if link.model is not None and link.shape is not None:
            what = _("shape and model are given together")
            yield Problem(what, _("keep one of them"), ("links", name))
        if link.model is not None and isinstance(link.inertia, tuple):
            what = _("a ring has one moment of inertia, about the axis through its centre")
            yield Problem(what, _("give one number"), ("links", name, "inertia"))
        if link.model is not None and link.centre_radius is not None:
            what = _("the mass of a ring and point mass lies on the sphere")
            yield Problem(what, _("take centre_radius out"), ("links", name, "centre_radius"))
    for index, guide in enumerate(mechanism.guides):
        if isinstance(guide.pole, Placed):
            what = _("a pole cannot be placed")
            repair = _("give its [longitude, latitude], or the name of a point")
            yield Problem(what, repair, ("guides", index, "pole"))
    for name, side in mechanism.assembly.sides.items():
        if side in ("ahead", "behind"):
            repair = _('write "left" or "right" of the arc between the two known points or poles')
            yield _planar(side, repair, ("assembly", "sides", name))
    for index, load in enumerate(mechanism.loads):
        if isinstance(load.axis, str):
            yield from known(load.axis, mechanism.points, "point", ("loads", index, "axis"))


def _planar(key: str, repair: str, at: Place) -> Problem:
    return Problem(_("{key} belongs to the plane").format(key=key), repair, at)


def _angles(mechanism: Description) -> Iterator[Problem]:
    """A link whose angle is given needs the arc that it is measured from."""
    driven = {drive.link: drive.relative_to for drive in mechanism.drives if drive.link}
    for name, link in mechanism.links.items():
        at: Place = ("links", name)
        if link.reference is not None:
            wrong = list(two_known_points(mechanism, link.reference, (*at, "reference")))
            yield from wrong or _reference(mechanism, link, driven.get(name, FRAME), (*at, "reference"))
        elif link.angle is not None or name in driven:
            first = shown(next(iter(link.coordinates), "A"))
            what = _("reference is missing: on the sphere the angle is measured from an arc")
            yield Problem(what, _("add reference = [{first}, ...]").format(first=first), at)


def _reference(mechanism: Description, link: Link, against: str, at: Place) -> Iterator[Problem]:
    points = tuple(link.coordinates)
    arcs = link.reference or ()
    if len(points) < 2:
        what = _("a link of one point has no angle on the sphere")
        yield Problem(what, _("name its second point, or take the reference out"), at)
    elif arcs[0] != points[0]:
        what = _("the reference starts at {point}, the link's first point is {first}")
        repair = _("a link's angle is measured in its first point: start the reference there")
        yield Problem(what.format(point=shown(arcs[0]), first=shown(points[0])), repair, at)
    else:
        yield from _lengths_of(mechanism, link, at)
        if against != FRAME and against in mechanism.links:
            yield from _carried(mechanism, arcs, against, at)


def _lengths_of(mechanism: Description, link: Link, at: Place) -> Iterator[Problem]:
    """An arc has a direction at its start unless its ends coincide or lie opposite."""
    ends = tuple(link.coordinates.values())[:2]
    known: list[tuple[Vector, ...]] = [ends] if link.length is None else []
    fixed = [mechanism.frame.points.get(point) for point in link.reference or ()]
    known.append(tuple(place for place in fixed if isinstance(place, tuple)))
    for places in known:
        for one, other in pairwise(places):
            if not makes_arc(unit_vector(one), unit_vector(other)):
                what = _("two points that coincide or lie opposite make no arc to measure an angle from")
                yield Problem(what, _("choose another second point"), at)


def _carried(mechanism: Description, arcs: tuple[str, ...], link: str, at: Place) -> Iterator[Problem]:
    missing = [point for point in arcs if point not in points_on(mechanism, link)]
    if missing:
        what = _("the drive is relative to {link}, but {point} of the reference is no point of it")
        repair = _("name two points of {link}").format(link=link)
        yield Problem(what.format(link=link, point=shown(missing[0])), repair, at)
