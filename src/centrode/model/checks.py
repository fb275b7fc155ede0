"""Checks of a description's parts against each other: every name is known, every link has its points."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from itertools import chain, islice, pairwise
from typing import TYPE_CHECKING

from centrode.locale import _
from centrode.model import reading
from centrode.model.description import Description, value_at_start
from centrode.model.drives import Drive
from centrode.model.gears import Gear
from centrode.model.links import Link, Rolling
from centrode.model.loads import AnyLoad, TurningLoad
from centrode.model.look_alikes import letters_note, look_alike
from centrode.model.reading import FRAME, Place, Problem, nearest, two_points, value_text
from centrode.model.settings import AGAINST, ALONG
from centrode.model.values import Placed, Vector, makes_arc, unit_vector

if TYPE_CHECKING:
    from centrode.model.follower_cam import PlateCam
    from centrode.model.simulation import Simulation

# Checks that a name in a description is one of something: a point, a link, a guide.


def unknown_name_problems(
    name: str, names: Iterable[str], kind: str, at: Place, link: str = ""
) -> Iterator[Problem]:
    """The problem, if any, of a name that is none of `names`; `link` is the one whose points they are."""
    candidates = list(names)
    if name in candidates:
        return
    no_point = _("the frame has no point {name}") if link == FRAME else _("{link} has no point {name}")
    sentences = {
        "point": no_point if link else _("unknown point {name}"),
        "link": _("unknown link {name}"),
        "guide": _("unknown guide {name}"),
        "point, link or guide": _("unknown point, link or guide {name}"),
    }
    yield Problem(sentences[kind].format(name=value_text(name), link=link), nearest(name, candidates), at)


def link_known(mechanism: Description, name: str, at: Place, moving: bool = False) -> Iterator[Problem]:
    """The problem, if any, of a link that is not there; the frame counts as one unless it has to move."""
    yield from unknown_name_problems(
        name, list(mechanism.links) if moving else [FRAME, *mechanism.links], "link", at
    )


def two_known_points(mechanism: Description, points: tuple[str, ...] | None, at: Place) -> Iterator[Problem]:
    """Problems of a pair of points, where one is given: they are known and differ."""
    if points is None:
        return
    if len(set(points)) != 2 or len(points) != 2:
        yield Problem(_('two different points are needed: ["A", "B"]'), "", at)
    for point in points:
        yield from unknown_name_problems(point, mechanism.points, "point", at)


def points_on(mechanism: Description, link: str) -> Iterable[str]:
    """Names of the points of a link, or of the frame."""
    return mechanism.frame.points if link == FRAME else mechanism.links[link].coordinates


def is_link(mechanism: Description, name: str) -> bool:
    """Whether a name is the frame's or a link's."""
    return name == FRAME or name in mechanism.links


# Checks of what joins links besides hinges and guides: gears, rolling, cylinders.

APART = 1e-3
"""So many modules may the centres of wheels differ from the distance of their pair: what printed distances round."""
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
        yield from _rolling_problems(mechanism, wheel, at)
        yield from _once(wheel.id, identities, at)


def _once(identity: str, identities: set[str], at: Place) -> Iterator[Problem]:
    if identity in identities:
        what = _("there are two gears or rolling wheels {name}").format(name=value_text(identity))
        yield Problem(what, _("give one of them a different name: name = ..."), at)
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
    if gear.pair is not None:
        yield from _pair_of_gear(mechanism, gear, at)


def _pair_of_gear(mechanism: Description, gear: Gear, at: Place) -> Iterator[Problem]:
    """A pair belongs to the plane, and its wheels stand as far apart on their carrier as they mesh."""
    assert gear.pair is not None
    if mechanism.space == "sphere":
        what = _("the wheels of a pair have parallel axes: there is none on the sphere")
        yield Problem(what, _("give the ratio"), (*at, "pair"))
        return
    bodies = (*gear.links, gear.carrier)
    if not all(is_link(mechanism, body) for body in bodies):
        return
    held = _coordinates(mechanism, gear.carrier)
    axes = [[point for point in points_on(mechanism, wheel) if point in held] for wheel in gear.links]
    if [len(points) for points in axes] != [1, 1]:
        return
    (x, y), (to_x, to_y) = (held[points[0]] for points in axes)
    apart, wanted = math.hypot(to_x - x, to_y - y), gear.pair.working_mesh()[1]
    if abs(apart - wanted) > APART * gear.pair.module:
        what = _("the centres are {apart:.9g} m apart, and the pair meshes at {wanted:.9g} m")
        said = what.format(apart=apart, wanted=wanted)
        yield Problem(said, _("move one of them, or change the shifts of the pair"), (*at, "pair"))


def _coordinates(mechanism: Description, body: str) -> Mapping[str, tuple[float, float]]:
    """Places of the points of a link or of the frame in its axes, those that are known."""
    places = mechanism.frame.points if body == FRAME else mechanism.links[body].coordinates
    return {
        name: (float(place[0]), float(place[1]))
        for name, place in places.items()
        if isinstance(place, tuple) and len(place) == 2
    }


def _rolling_problems(mechanism: Description, wheel: Rolling, at: Place) -> Iterator[Problem]:
    unknown = list(link_known(mechanism, wheel.link, (*at, "link"), moving=True))
    yield from unknown
    if not unknown:
        local = mechanism.links[wheel.link].coordinates
        yield from unknown_name_problems(wheel.centre, local, "point", (*at, "centre"), wheel.link)
    yield from link_known(mechanism, wheel.on, (*at, "on"))
    if wheel.link == wheel.on:
        what = _("link {link} cannot roll on itself").format(link=wheel.link)
        yield Problem(what, _("name another link"), at)
    elif is_link(mechanism, wheel.on):
        yield from _on_track(mechanism, wheel, at)
    circle, inside = wheel.along.radius, wheel.along.inside
    if inside and circle is not None and abs(circle - wheel.radius) <= SAME * max(circle, wheel.radius):
        what = _("a wheel as large as the circle fills it and cannot roll inside")
        yield Problem(what, _("change one of the radii, or remove inside"), (*at, "radius"))


def _on_track(mechanism: Description, wheel: Rolling, at: Place) -> Iterator[Problem]:
    points = points_on(mechanism, wheel.on)
    if isinstance(wheel.along.centre, str):
        yield from unknown_name_problems(
            wheel.along.centre, points, "point", (*at, "along", "centre"), wheel.on
        )
    if wheel.centre in points:
        what = _("point {point} already belongs to {link}, so the wheel cannot roll on this link")
        if wheel.on == FRAME:
            what = _("point {point} already belongs to the frame, so the wheel cannot roll on it")
        repair = _("remove it from the link, or let the wheel roll on another one")
        yield Problem(what.format(point=value_text(wheel.centre), link=wheel.on), repair, at)


def cylinder_problems(mechanism: Description, drive: Drive, at: Place) -> Iterator[Problem]:
    """Problems of a driven distance between two known points: something has to be able to change it."""
    first, second = drive.distance or ("", "")
    for body in (FRAME, *mechanism.links):
        if {first, second} <= set(points_on(mechanism, body)):
            what = _("points {first} and {second} both belong to {link}: their distance cannot change")
            if body == FRAME:
                what = _("points {first} and {second} both belong to the frame: their distance cannot change")
            repair = _("name points of two different links")
            told = what.format(first=value_text(first), second=value_text(second), link=body)
            yield Problem(told, repair, (*at, "distance"))
    value = value_at_start(drive)
    if value is not None and value <= 0:
        what = _("a cylinder shorter than zero: its length at t = 0 is {value:g} m")
        yield Problem(what.format(value=value), _("give the distance of the points as start"), at)


# Checks of what belongs to the sphere only, or to the plane only.

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
        yield _spherical("radius", _("remove it"), ("radius",))
    for name, link in mechanism.links.items():
        for key in SPHERE_LINK_KEYS:
            if getattr(link, key) is not None:
                repair = _("remove it")
                if key == "reference":
                    repair = _("remove it; in the plane angles are measured from the x axis")
                yield _spherical(key, repair, ("links", name, key))
        if link.shape == "arc":
            yield _spherical("arc", _("write rod, disc or ring"), ("links", name, "shape"))
    for index, load in enumerate(mechanism.loads):
        if isinstance(load, TurningLoad) and load.axis is not None:
            yield _spherical("axis", _("remove it"), ("loads", index, "axis"))


def _spherical(key: str, repair: str, at: Place) -> Problem:
    return Problem(_("{key} is used on the sphere only").format(key=key), repair, at)


def _planar_keys(mechanism: Description) -> Iterator[Problem]:
    """Keys that mean something in the plane only."""
    for name, link in mechanism.links.items():
        if link.masses:
            yield _planar(
                "masses", _("give mass, centre and inertia of the whole link"), ("links", name, "masses")
            )
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
            yield Problem(what, _("remove centre_radius"), ("links", name, "centre_radius"))
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
        if isinstance(load, TurningLoad) and isinstance(load.axis, str):
            yield from unknown_name_problems(load.axis, mechanism.points, "point", ("loads", index, "axis"))


def _planar(key: str, repair: str, at: Place) -> Problem:
    return Problem(_("{key} is used in the plane only").format(key=key), repair, at)


def _angles(mechanism: Description) -> Iterator[Problem]:
    """A link whose angle is given needs the arc that it is measured from."""
    driven = {drive.link: drive.relative_to for drive in mechanism.drives if drive.link}
    for name, link in mechanism.links.items():
        at: Place = ("links", name)
        if link.reference is not None:
            wrong = list(two_known_points(mechanism, link.reference, (*at, "reference")))
            yield from wrong or _reference(mechanism, link, driven.get(name, FRAME), (*at, "reference"))
        elif link.angle is not None or name in driven:
            first = value_text(next(iter(link.coordinates), "A"))
            what = _("reference is missing: on the sphere the angle is measured from an arc")
            yield Problem(what, _("add reference = [{first}, ...]").format(first=first), at)


def _reference(mechanism: Description, link: Link, against: str, at: Place) -> Iterator[Problem]:
    points = tuple(link.coordinates)
    arcs = link.reference or ()
    if len(points) < 2:
        what = _("a link of one point has no angle on the sphere")
        yield Problem(what, _("name its second point, or remove the reference"), at)
    elif arcs[0] != points[0]:
        what = _("the reference starts at {point}, the link's first point is {first}")
        repair = _("a link's angle is measured in its first point: start the reference there")
        yield Problem(what.format(point=value_text(arcs[0]), first=value_text(points[0])), repair, at)
    else:
        yield from _lengths_of(mechanism, link, at)
        if against != FRAME and against in mechanism.links:
            yield from _reference_problems(mechanism, arcs, against, at)


def _lengths_of(mechanism: Description, link: Link, at: Place) -> Iterator[Problem]:
    """An arc has a direction at its start unless its ends coincide or lie opposite."""
    ends = tuple(link.coordinates.values())[:2]
    known: list[tuple[Vector, ...]] = [ends] if link.length is None else []
    fixed = [mechanism.frame.points.get(point) for point in link.reference or ()]
    known.append(tuple(place for place in fixed if isinstance(place, tuple)))
    for places in known:
        for one, other in pairwise(places):
            if not makes_arc(unit_vector(one), unit_vector(other)):
                what = _(
                    "two points that coincide or are diametrically opposite define no arc from which to measure "
                    "an angle"
                )
                yield Problem(what, _("choose another second point"), at)


def _reference_problems(
    mechanism: Description, arcs: tuple[str, ...], link: str, at: Place
) -> Iterator[Problem]:
    missing = [point for point in arcs if point not in points_on(mechanism, link)]
    if missing:
        what = _("the drive is relative to {link}, but {point} of the reference is not a point of it")
        repair = _("name two points of {link}").format(link=link)
        yield Problem(what.format(link=link, point=value_text(missing[0])), repair, at)


# Checks of a cam's follower against the link that it is.

NEAR = 1e-9
"""Share of an arm by which its length may miss that of the cam's description."""


def pivot_of(mechanism: Description, link: str) -> str | None:
    """The point of the frame about which a link turns; None where it has none or several."""
    found = [name for name in mechanism.links[link].coordinates if name in mechanism.frame.points]
    return found[0] if len(found) == 1 else None


def follower_problems(mechanism: Description, drive: Drive, at: Place) -> Iterator[Problem]:
    """What is wrong with the point of a link that is said to touch the cam."""
    link = drive.link or ""
    if drive.cam is None or drive.cam_point is None or link not in mechanism.links:
        return
    points = mechanism.links[link].coordinates
    unknown = list(unknown_name_problems(drive.cam_point, points, "point", (*at, "cam_point"), link))
    pivot = pivot_of(mechanism, link)
    yield from unknown
    if unknown or pivot is None:
        return
    if pivot == drive.cam_point:
        what = _("{point} is the pivot of the follower").format(point=value_text(pivot))
        yield Problem(what, _("name the roller's centre, or the edge"), (*at, "cam_point"))
    elif not _fits(drive.cam, length := math.dist(points[pivot], points[drive.cam_point])):
        what = _("the cam's follower has an arm of {arm:.9g} m, but {point} is {length:.9g} m from its pivot")
        told = what.format(arm=drive.cam.follower.arm, point=value_text(drive.cam_point), length=length)
        yield Problem(told, _("correct one of them"), (*at, "cam_point"))


def _fits(cam: PlateCam, length: float) -> bool:
    arm = cam.follower.arm
    return arm is None or cam.follower.contact == "flat" or abs(length - arm) <= NEAR * arm


# Which parts of a mechanism hang together with the frame.

Node = tuple[str, str]
"""("link", name) or ("point", name)."""


@dataclass(frozen=True)
class LoosePart:
    """Links and points that hang together, but not with the frame."""

    links: tuple[str, ...]
    points: tuple[str, ...]

    def __str__(self) -> str:
        return ", ".join(self.links or self.points)


def joints(mechanism: Description) -> Iterator[tuple[Node, Node]]:
    """Pairs of links and points that touch: points in links, guides, gears, rolling, cylinders."""
    for point in mechanism.frame.points:
        yield ("link", FRAME), ("point", point)
    for name, link in mechanism.links.items():
        yield from ((("link", name), ("point", point)) for point in link.coordinates)
    for guide in mechanism.guides:
        yield ("point", guide.point), ("link", guide.on)
    for gear in mechanism.gears:
        yield from ((("link", name), ("link", gear.carrier)) for name in gear.links)
    for wheel in mechanism.rolling:
        yield ("link", wheel.link), ("link", wheel.on)
    for drive in mechanism.drives:
        if drive.distance:
            yield ("point", drive.distance[0]), ("point", drive.distance[1])


def disconnected_parts(mechanism: Description) -> tuple[LoosePart, ...]:
    """Parts that nothing joins to the frame, in description order; empty for a mechanism in one piece."""
    neighbours: dict[Node, set[Node]] = {("link", FRAME): set()}
    for name in mechanism.links:
        neighbours[("link", name)] = set()
    for one, other in joints(mechanism):
        neighbours.setdefault(one, set()).add(other)
        neighbours.setdefault(other, set()).add(one)
    reached = _connected_nodes(("link", FRAME), neighbours)
    parts = []
    for node in neighbours:
        if node not in reached:
            part = _connected_nodes(node, neighbours)
            reached |= part
            links = tuple(name for name in mechanism.links if ("link", name) in part)
            parts.append(
                LoosePart(links, tuple(name for name in mechanism.points if ("point", name) in part))
            )
    return tuple(parts)


def _connected_nodes(start: Node, neighbours: dict[Node, set[Node]]) -> set[Node]:
    reached, waiting = {start}, [start]
    while waiting:
        for node in neighbours[waiting.pop()]:
            if node not in reached:
                reached.add(node)
                waiting.append(node)
    return reached


def problems_of_parts(mechanism: Description) -> list[Problem]:
    """Everything wrong among the parts; the parts that do not hang together are told only if nothing else is."""
    checks = (_links, _guides, joining_problems, _drives, _coordinate, space_problems, _rest)
    found = chain.from_iterable(check(mechanism) for check in checks)
    return list(islice(found, reading.PROBLEMS_SOUGHT)) or list(_loose(mechanism))


def _links(mechanism: Description) -> Iterator[Problem]:
    if not mechanism.links:
        yield Problem(_("there are no links"), _("describe at least one, such as [links.OA] with a length"))
    for name, link in mechanism.links.items():
        yield from _link(name, link, ("links", name))
    if len(mechanism.points) > reading.POINTS:
        yield Problem(_("at most {most} points are allowed").format(most=reading.POINTS))
    for name, link in mechanism.links.items():
        if isinstance(link.centre, str):
            yield from unknown_name_problems(
                link.centre, link.coordinates, "point", ("links", name, "centre"), name
            )
        for number, part in enumerate(link.masses):
            if isinstance(part.at, str):
                at = ("links", name, "masses", number, "at")
                yield from unknown_name_problems(part.at, link.coordinates, "point", at, name)


def _link(name: str, link: Link, at: Place) -> Iterator[Problem]:
    if isinstance(link.points, Mapping):
        if not link.points:
            yield Problem(_("the link has no points"), _("name them: points = { A = [0, 0] }"), at)
        if link.length is not None:
            repair = _("remove the length")
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
        yield Problem(_("a link of one point has no length"), _("name its second point, or remove it"), at)


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
            what = _("there are two guides {name}").format(name=value_text(guide.id))
            yield Problem(what, _("give one of them a different name: name = ..."), at)
        identities.add(guide.id)
        yield from link_known(mechanism, guide.on, (*at, "on"))
        for key, line in (("through", guide.through), ("pole", guide.pole)):
            if isinstance(line, str) and is_link(mechanism, guide.on):
                yield from unknown_name_problems(
                    line, points_on(mechanism, guide.on), "point", (*at, key), guide.on
                )
        if guide.on in mechanism.links and guide.point in mechanism.links[guide.on].coordinates:
            what = _("point {point} already belongs to {link}, so it cannot slide on this link")
            repair = _("remove it from the link, or choose another point for the guide")
            yield Problem(what.format(point=value_text(guide.point), link=guide.on), repair, at)
        if guide.link is not None:
            yield from _guided_link(mechanism, guide.link, guide.point, guide.on, at)


def _guided_link(mechanism: Description, link: str, point: str, on: str, at: Place) -> Iterator[Problem]:
    unknown = list(link_known(mechanism, link, (*at, "link"), moving=True))
    yield from unknown
    if not unknown and point not in mechanism.links[link].coordinates:
        what = _("link {link} does not contain the guided point {point}").format(
            link=link, point=value_text(point)
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
                _("{name} has two drives").format(name=value_text(drive.id)), _("keep one of the drives"), at
            )
        identities.add(drive.id)
        if drive.link:
            yield from link_known(mechanism, drive.link, (*at, "link"), moving=True)
            yield from link_known(mechanism, drive.relative_to, (*at, "relative_to"))
        if drive.link and drive.link == drive.relative_to:
            yield Problem(_("a link cannot be driven relative to itself"), _("name another link"), at)
        if drive.guide:
            yield from unknown_name_problems(
                drive.guide, [guide.id for guide in mechanism.guides], "guide", (*at, "guide")
            )
        if drive.distance:
            wrong = list(two_known_points(mechanism, drive.distance, (*at, "distance")))
            yield from wrong or cylinder_problems(mechanism, drive, at)
        yield from follower_problems(mechanism, drive, at)


def _coordinate(mechanism: Description) -> Iterator[Problem]:
    """Problems of a coordinate that is chosen: it is that of the one drive, and its sense is one of its kind."""
    chosen, at = mechanism.study.coordinate, ("study", "coordinate")
    if chosen is None:
        return
    if len(mechanism.drives) != 1:
        what = _("a coordinate is chosen for a mechanism with one drive, and it has {n}")
        yield Problem(what.format(n=len(mechanism.drives)), _("remove the coordinate"), at)
        return
    drive = mechanism.drives[0]
    if chosen.link is not None and chosen.guide is not None:
        yield Problem(_("{names} are given together").format(names="link, guide"), _("keep one of them"), at)
    for key, name, driven, names in (
        ("link", chosen.link, drive.link, list(mechanism.links)),
        ("guide", chosen.guide, drive.guide, [guide.id for guide in mechanism.guides]),
    ):
        if name is None or name == driven:
            continue
        unknown = list(unknown_name_problems(name, names, key, (*at, key)))
        yield from unknown
        if not unknown:
            repair = _("the coordinate is that of the drive: name {name}").format(name=drive.id)
            yield Problem(_("{name} is not driven").format(name=value_text(name)), repair, (*at, key))
    senses = [each[0 if drive.kind == "angle" else 1] for each in (ALONG, AGAINST)]
    if chosen.sense is not None and chosen.sense not in senses:
        what = _("the sense {sense} does not fit what is driven").format(sense=value_text(chosen.sense))
        yield Problem(what, _("use one of {known}").format(known=", ".join(senses)), (*at, "sense"))


def _rest(mechanism: Description) -> Iterator[Problem]:
    names = [*mechanism.points, *mechanism.links, *(guide.id for guide in mechanism.guides)]
    for name in mechanism.assembly.sides:
        yield from unknown_name_problems(name, names, "point, link or guide", ("assembly", "sides", name))
    for index, load in enumerate(mechanism.loads):
        yield from _names_of_load(mechanism, load, ("loads", index))
    if mechanism.simulation is not None:
        yield from simulation_problems(mechanism, mechanism.simulation)
    for point in mechanism.report.points:
        yield from unknown_name_problems(point, mechanism.points, "point", ("report", "points"))


def simulation_problems(mechanism: Description, settings: Simulation) -> Iterator[Problem]:
    """Problems of what a simulation names: drives that keep their law, and parts that have an initial speed."""
    drives = {drive.id: drive for drive in mechanism.drives}
    for name in settings.keeps:
        at: Place = ("simulation", "keeps")
        if name not in drives:
            what = _("there is no drive {name}").format(name=value_text(name))
            yield Problem(what, nearest(name, drives), at)
        elif not drives[name].has_law:
            what = _("drive {name} has no law that it could keep").format(name=value_text(name))
            yield Problem(what, _("give it speed, law, table, segments or cam"), at)
    known = {
        "links": ("link", list(mechanism.links)),
        "guides": ("guide", [guide.id for guide in mechanism.guides]),
        "points": ("point", list(mechanism.moving_points)),
    }
    for path in settings.speeds:
        room, _dot, name = path.partition(".")
        at = ("simulation", "speeds", path)
        if room != "drives":
            yield from unknown_name_problems(name, known[room][1], known[room][0], at)
        elif name not in drives:
            what = _("there is no drive {name}").format(name=value_text(name))
            yield Problem(what, nearest(name, drives), at)
        elif name in settings.keeps:
            what = _("drive {name} keeps its law, which gives its speed").format(name=value_text(name))
            yield Problem(what, _("remove the speed, or remove the drive from keeps"), at)


def _names_of_load(mechanism: Description, load: AnyLoad, at: Place) -> Iterator[Problem]:
    """What the keys of a load name has to be there."""
    guides = [guide.id for guide in mechanism.guides]
    for key, field in load.keys().items():
        name = getattr(load, field)
        match key:
            case "point" if name:
                yield from unknown_name_problems(name, mechanism.points, "point", (*at, key))
            case "guide" if name:
                yield from unknown_name_problems(name, guides, "guide", (*at, key))
            case "link" if name:
                yield from link_known(mechanism, name, (*at, key), moving=True)
            case "pin" if name:
                yield from link_known(mechanism, name, (*at, key))
            case "axes" | "relative_to":
                yield from link_known(mechanism, name, (*at, key))
            case "points":
                yield from two_known_points(mechanism, name, (*at, key))


def _loose(mechanism: Description) -> Iterator[Problem]:
    for part in disconnected_parts(mechanism):
        at: Place = ("links", part.links[0]) if part.links else ()
        what = _("nothing connects {names} to the frame").format(names=part)
        repair = _("hinge it to a link that is connected, or give it a guide")
        yield Problem(what, _look_alikes(mechanism, part) or repair, at)


def _look_alikes(mechanism: Description, part: LoosePart) -> str:
    """In which letters the points of a loose part differ from others that look alike; empty where none do."""
    others = [point for point in mechanism.points if point not in part.points]
    pairs = [(point, other) for point in part.points if (other := look_alike(point, others)) is not None]
    return letters_note(str(part), pairs) if pairs else ""
