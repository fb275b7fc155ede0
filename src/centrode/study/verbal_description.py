"""How a mechanism works, in words: what it is made of, how it moves, what comes of it."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field

import numpy as np

from centrode.errors import InputError, Status
from centrode.kinematics.motion import motion
from centrode.kinematics.preparation import Ready, ready
from centrode.locale import _, mark, ngettext
from centrode.model.mechanism import FRAME, Drive, Gear, Guide, Mechanism, Rolling
from centrode.model.reading import two_points
from centrode.quantities import display_unit, typeset_unit
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
from centrode.structure.rank import is_bare, slider_of
from centrode.study.rotation import rotation_of
from centrode.study.texts import value_text

# Names and lists of names as sentences have them.


def quote_word(name: str) -> str:
    """A link's name, in quotes where it is a word: crank OA, but crank "crank"."""
    if two_points(name) is not None or len(name) < 3:
        return name
    # Translators: a name in quotation marks
    return _('"{name}"').format(name=name)


def enumerate_names(names: Iterable[str]) -> str:
    """Names with commas and an "and" before the last."""
    every = list(names)
    if len(every) < 2:
        return "".join(every)
    # Translators: the last two of a list of names, such as "AC and CB"
    return _("{names} and {last}").format(names=", ".join(every[:-1]), last=every[-1])


def links_listed(names: Iterable[str]) -> str:
    """Names of links as a list."""
    return enumerate_names(map(quote_word, names))


# What each part of a mechanism does in its motion: which links turn fully, which swing and how far.

WHOLE = 1e-6
"""How near to a whole turn counts as one [rad]: joints of one turn close to rounding."""

SAMPLES = 1441
"""Four a degree: an extreme between two samples is missed by some 1e-6 of it, four digits are told."""


@dataclass(frozen=True)
class Roles:
    """Extents of a motion that gets everywhere; without one (it locks, or has no range) nothing is known of them.

    Attributes
    ----------
    swings : link -> angle between its extremes [rad]
    turned : link -> what it turns from the first sample to the last [rad]
    strokes : guide -> way between the extremes of its displacement [m, rad on the sphere]
    ways : guide -> how far its displacement is from first to last sample [m, rad]
    one_turn : whether the motion is one turn of the only drive
    """

    mechanism: Mechanism
    swings: Mapping[str, float] = field(default_factory=dict)
    turned: Mapping[str, float] = field(default_factory=dict)
    strokes: Mapping[str, float] = field(default_factory=dict)
    ways: Mapping[str, float] = field(default_factory=dict)
    one_turn: bool = False

    def pivot(self, link: str) -> str | None:
        """The fixed point about which a link turns."""
        points = self.mechanism.links[link].coordinates
        return next((point for point in points if point in self.mechanism.frame.points), None)

    def turns_fully(self, link: str) -> bool:
        """Whether a link goes all the way round."""
        return self.swings.get(link, 0.0) >= math.tau - WHOLE

    def comes_back(self, guide: str) -> bool:
        """Whether what moves along a guide ends nearer to where it began than its stroke is long."""
        return abs(self.ways[guide]) < (1 - WHOLE) * self.strokes[guide]

    def is_wheel(self, link: str) -> bool:
        """Whether a link is nothing but a wheel: nothing is hinged to it off its axis."""
        wheels = {one.link for one in self.mechanism.rolling}
        wheels.update(name for gear in self.mechanism.gears for name in gear.links)
        others = [other for name, other in self.mechanism.links.items() if name != link]
        joined = {point for other in others for point in other.coordinates}
        joined.update(guide.point for guide in self.mechanism.guides)
        points = set(self.mechanism.links[link].coordinates) - set(self.mechanism.frame.points)
        return link in wheels and not points & joined

    def angle_text(self, angle: float) -> str:
        """An angle as prose has it: in degrees, where the description does not ask for another unit."""
        unit = self.mechanism.display.angle
        if unit in ("deg", "rad"):
            return f"{math.degrees(angle):.3g}°"
        factor, shown = display_unit("rad", angle=str(unit))
        return f"{angle * factor:.3g} {shown}"

    def length_text(self, length: float) -> str:
        """A length in the description's unit; on the sphere an arc."""
        if self.mechanism.space == "sphere":
            return self.angle_text(length)
        factor, shown = display_unit("m", length=str(self.mechanism.display.length))
        return f"{length * factor:.4g} {shown}"


def roles_of(mechanism: Mechanism) -> Roles:
    """Extents over the range of the description, one turn of the drive if it names none."""
    try:
        data = motion(mechanism, SAMPLES)
    except InputError:
        return Roles(mechanism)
    if not np.isin(data["status"].to_numpy(), (Status.OK, Status.SINGULAR)).all():
        return Roles(mechanism)
    swings, turned, strokes, ways = {}, {}, {}, {}
    name = "angle" if "angle" in data else "joint_angle"
    labels = data["link" if name == "angle" else "joint"].to_numpy()
    for column, link in enumerate(labels):
        angles = data[name].to_numpy()[:, column]
        swings[str(link)], turned[str(link)] = float(np.ptp(angles)), float(angles[-1] - angles[0])
    for column, guide in enumerate(data["guide"].to_numpy()):
        slides = data["slide"].to_numpy()[:, column]
        strokes[str(guide)], ways[str(guide)] = float(np.ptp(slides)), float(slides[-1] - slides[0])
    value = data["drive_value"].to_numpy()[:, 0]
    one_turn = mechanism.motion_parameter.turns and abs(abs(value[-1] - value[0]) - math.tau) < WHOLE
    return Roles(mechanism, swings, turned, strokes, ways, one_turn)


# Sentences on what a mechanism is made of: links, hinges, guides, wheels, cylinders.

LEVEL = 1e-9
"""Directions of guides nearer than this to an axis are called horizontal and vertical [rad]."""

# Translators: {links} are names of links such as "AC and CB", {point} the name of a point; names do not change.
SLIDERS = {
    "horizontal": mark("A slider, hinged to {links} in {point}, moves along a fixed horizontal guide."),
    "vertical": mark("A slider, hinged to {links} in {point}, moves along a fixed vertical guide."),
    "inclined": mark(
        "A slider, hinged to {links} in {point}, moves along a fixed guide at {angle} to the horizontal."
    ),
    "circle": mark("A slider, hinged to {links} in {point}, moves along a fixed circle."),
}
LONE_SLIDERS = {
    "horizontal": mark("A slider in {point} moves along a fixed horizontal guide."),
    "vertical": mark("A slider in {point} moves along a fixed vertical guide."),
    "inclined": mark("A slider in {point} moves along a fixed guide at {angle} to the horizontal."),
    "circle": mark("A slider in {point} moves along a fixed circle."),
}
SLIDING_LINKS = {
    "horizontal": mark("Link {link} moves along a fixed horizontal guide without turning."),
    "vertical": mark("Link {link} moves along a fixed vertical guide without turning."),
    "inclined": mark("Link {link} moves along a fixed guide at {angle} to the horizontal without turning."),
    "circle": mark("Link {link} moves along a fixed circle without turning against it."),
}
ROLLING = {
    ("line", True): mark("Wheel {wheel} rolls without slip on a fixed straight track."),
    ("line", False): mark("Wheel {wheel} rolls without slip on a straight track of link {on}."),
    ("outside", True): mark("Wheel {wheel} rolls without slip on the outside of a fixed circle."),
    ("outside", False): mark("Wheel {wheel} rolls without slip on the outside of a circle of link {on}."),
    ("inside", True): mark("Wheel {wheel} rolls without slip inside a fixed circle."),
    ("inside", False): mark("Wheel {wheel} rolls without slip inside a circle of link {on}."),
}


def moving_parts(mechanism: Mechanism) -> list[str]:
    """Names of the moving links, sliders and cylinders included, as they are counted."""
    found = [
        *map(quote_word, mechanism.link_names),
        *(slider_of(guide) for guide in mechanism.guides if is_bare(guide)),
    ]
    for drive in mechanism.drives:
        if drive.kind == "distance":
            found.append(_("barrel of cylinder {name}").format(name=drive.id))
            found.append(_("rod of cylinder {name}").format(name=drive.id))
    return found


def sentences_on_joints(mechanism: Mechanism) -> Iterator[str]:
    """What the mechanism is made of, and how that is joined."""
    parts = moving_parts(mechanism)
    # Translators: {parts} is a list of names such as "OA, AC, slider C"
    yield ngettext(
        "Besides the frame the mechanism has {n} moving link: {parts}.",
        "Besides the frame the mechanism has {n} moving links: {parts}.",
        len(parts),
    ).format(n=len(parts), parts=", ".join(parts))
    yield from _on_hinges(mechanism)
    yield from _on_plates(mechanism)
    for guide in mechanism.guides:
        yield _on_guide(mechanism, guide)
    for gear in mechanism.gears:
        yield _on_gear(gear)
    for wheel in mechanism.rolling:
        yield _on_rolling(wheel)
    for drive in mechanism.drives:
        if drive.distance is not None:
            first, second = drive.distance
            yield _("A cylinder reaches from {first} to {second}.").format(first=first, second=second)


def links_at(mechanism: Mechanism, point: str) -> list[str]:
    """Links that have a point."""
    return [name for name, link in mechanism.links.items() if point in link.coordinates]


def _on_hinges(mechanism: Mechanism) -> Iterator[str]:
    """Fixed and moving hinges; those of sliders are told with their guides."""
    sliders = {guide.point for guide in mechanism.guides if is_bare(guide)}
    fixed, moving = [], []
    points = dict.fromkeys([*mechanism.frame.points, *mechanism.moving_points])
    for point in points:
        links = links_at(mechanism, point)
        if point in mechanism.frame.points and links:
            # Translators: an entry of the list "Hinged to the frame: ...", such as "OA in O"
            fixed.append(_("{links} in {point}").format(links=links_listed(links), point=point))
        elif len(links) > 1 and point not in sliders:
            moving.append(_("{links} in {point}").format(links=links_listed(links), point=point))
    if fixed:
        yield _("Hinged to the frame: {hinges}.").format(hinges=", ".join(fixed))
    if moving:
        yield _("Hinged to each other: {hinges}.").format(hinges=", ".join(moving))


def _on_plates(mechanism: Mechanism) -> Iterator[str]:
    for name, link in mechanism.links.items():
        if len(link.coordinates) > 2:
            points = enumerate_names(list(link.coordinates))
            yield _("Link {link} is one rigid piece with the points {points}.").format(
                link=quote_word(name), points=points
            )


def _on_guide(mechanism: Mechanism, guide: Guide) -> str:
    links = [name for name in links_at(mechanism, guide.point) if name != guide.on]
    own = None if guide.link is None else quote_word(guide.link)
    place = {"links": links_listed(links), "point": guide.point, "link": own, "on": quote_word(guide.on)}
    if guide.on == FRAME:
        way, place["angle"] = _way(mechanism, guide)
        sentences = SLIDING_LINKS if own is not None else SLIDERS if links else LONE_SLIDERS
        return _(sentences[way]).format(**place)
    if own is not None:
        return _("Link {link} slides along link {on} and does not turn against it.").format(**place)
    if links:
        return _("A slider, hinged to {links} in {point}, moves along link {on}.").format(**place)
    if guide.point in mechanism.frame.points:
        return _("A slider, hinged to the frame in {point}, moves along link {on}.").format(**place)
    return _("A slider in {point} moves along link {on}.").format(**place)


def _way(mechanism: Mechanism, guide: Guide) -> tuple[str, str]:
    """How a fixed guide lies, and its angle to the horizontal."""
    if mechanism.space == "sphere":
        return "circle", ""
    angle = math.remainder(guide.direction_angle, math.pi)
    if abs(angle) < LEVEL:
        return "horizontal", ""
    if abs(abs(angle) - math.pi / 2) < LEVEL:
        return "vertical", ""
    return "inclined", f"{math.degrees(angle):.3g}°"


def _on_gear(gear: Gear) -> str:
    one, other = gear.links
    place = {
        "one": quote_word(one),
        "other": quote_word(other),
        "carrier": quote_word(gear.carrier),
        "ratio": f"{abs(gear.ratio):.4g}",
    }
    if FRAME in gear.links:
        return _("Link {link} meshes with a fixed wheel; link {carrier} carries its axis.").format(
            link=place["other" if one == FRAME else "one"], carrier=place["carrier"]
        )
    if gear.carrier == FRAME:
        text = (
            _(
                "Links {one} and {other} are geared: {other} turns in the ratio {ratio} to {one},"
                " in the opposite sense."
            )
            if gear.ratio < 0
            else _(
                "Links {one} and {other} are geared: {other} turns in the ratio {ratio} to {one},"
                " in the same sense."
            )
        )
        return text.format(**place)
    text = (
        _(
            "Links {one} and {other} are geared: seen from link {carrier}, {other} turns in the ratio {ratio} to {one},"
            " in the opposite sense."
        )
        if gear.ratio < 0
        else _(
            "Links {one} and {other} are geared: seen from link {carrier}, {other} turns in the ratio {ratio} to {one},"
            " in the same sense."
        )
    )
    return text.format(**place)


def _on_rolling(wheel: Rolling) -> str:
    track = "line" if wheel.along.direction is not None else "inside" if wheel.along.inside else "outside"
    return _(ROLLING[track, wheel.on == FRAME]).format(wheel=quote_word(wheel.link), on=quote_word(wheel.on))


# Sentences on links that a slider or a wheel turns about their pivots.

# Translators: {link}, {block}, {wheel} are names of links, {pivot} and {point} of points; names do not change.
LEVERS = {
    "turns": mark("The slider in {point} moves along link {link} and turns it fully about {pivot}."),
    "swings": mark(
        "The slider in {point} moves along link {link} and swings it about {pivot} through {angle}."
    ),
    "moves": mark("The slider in {point} moves along link {link} and turns it about {pivot}."),
    "still": mark("The slider in {point} moves along link {link}, which does not turn."),
}
BLOCKS = {
    "turns": mark("Link {block} slides along link {link} and turns it fully about {pivot}."),
    "swings": mark("Link {block} slides along link {link} and swings it about {pivot} through {angle}."),
    "moves": mark("Link {block} slides along link {link} and turns it about {pivot}."),
    "still": mark("Link {block} slides along link {link}, which does not turn."),
}
RESTING = {
    "turns": mark("Link {link} rests on wheel {wheel} and is turned fully about {pivot}."),
    "swings": mark("Link {link} rests on wheel {wheel} and swings about {pivot} through {angle}."),
    "moves": mark("Link {link} rests on wheel {wheel} and turns about {pivot}."),
    "still": mark("Link {link} rests on wheel {wheel} and does not turn."),
}

STILL = 1e-9
"""A link that turns less than this does not turn [rad]."""


def extent(roles: Roles, link: str) -> tuple[str, str]:
    """How a link on a pivot moves, as a key of sentences, and its angle."""
    if link not in roles.swings:
        return "moves", ""
    if roles.swings[link] < STILL:
        return "still", ""
    if roles.turns_fully(link):
        return "turns", ""
    return "swings", roles.angle_text(roles.swings[link])


def on_lever(roles: Roles, group: Aim) -> str:
    """The sentence on a link that turns to a point, a slider or a wheel."""
    key, angle = extent(roles, group.link)
    place = {"link": quote_word(group.link), "pivot": group.pivot, "angle": angle}
    if group.contact is not None:
        return _(RESTING[key]).format(wheel=quote_word(group.contact.link), **place)
    block = group.block or roles.mechanism.guide(group.guide).link
    if block is not None:
        return _(BLOCKS[key]).format(block=quote_word(block), **place)
    return _(LEVERS[key]).format(point=group.target, **place)


# Sentences on what is driven, and how.

# Translators: {link} and {base} are names of links, {pivot} and {point} of points; names do not change.
DRIVEN = {
    ("crank", True): mark("Crank {link} is driven: it turns about {pivot} at a constant {speed}."),
    ("crank", False): mark("Crank {link} is driven: it turns about {pivot} by a given law."),
    ("link", True): mark("Link {link} is driven: it turns about {pivot} at a constant {speed}."),
    ("link", False): mark("Link {link} is driven: it turns about {pivot} by a given law."),
    ("free", True): mark("Link {link} is driven: its angle changes at a constant {speed}."),
    ("free", False): mark("Link {link} is driven: its angle follows a given law."),
    ("relative", True): mark("Link {link} is driven against link {base} at a constant {speed}."),
    ("relative", False): mark("Link {link} is driven against link {base} by a given law."),
    ("slider", True): mark("The slider in {point} is driven along its guide at a constant {speed}."),
    ("slider", False): mark("The slider in {point} is driven along its guide by a given law."),
    ("guided", True): mark("Link {link} is driven along its guide at a constant {speed}."),
    ("guided", False): mark("Link {link} is driven along its guide by a given law."),
    ("cylinder", True): mark("Cylinder {name} is driven: its length changes at a constant {speed}."),
    ("cylinder", False): mark("Cylinder {name} is driven: its length follows a given law."),
}

BY_CAM = {
    "link": mark("Link {link} is driven by a cam, which turns at a constant {speed}."),
    "slider": mark("The slider in {point} is driven by a cam, which turns at a constant {speed}."),
    "guided": mark("Link {link} is driven along its guide by a cam, which turns at a constant {speed}."),
}


def sentence_on_drive(drive: Drive, roles: Roles) -> str:
    """What a drive drives, at a constant speed or by a law."""
    mechanism = roles.mechanism
    if drive.turning is not None:
        return _sentence_on_cam(drive, mechanism)
    constant = drive.speed is not None
    unit = mechanism.motion_parameter.drive(drive.id).speed_unit
    speed = "" if drive.speed is None else _speed(mechanism, abs(drive.speed), unit)
    if drive.kind == "distance":
        return _(DRIVEN["cylinder", constant]).format(name=drive.id, speed=speed)
    if drive.guide is not None:
        guide = mechanism.guide(drive.guide)
        kind = "slider" if guide.link is None else "guided"
        return _(DRIVEN[kind, constant]).format(
            point=guide.point, link=quote_word(guide.link or ""), speed=speed
        )
    link = drive.link or ""
    pivot = roles.pivot(link)
    if drive.relative_to != FRAME:
        kind = "relative"
    elif pivot is None:
        kind = "free"
    else:
        kind = "crank" if roles.turns_fully(link) and not roles.is_wheel(link) else "link"
    return _(DRIVEN[kind, constant]).format(
        link=quote_word(link), pivot=pivot, base=quote_word(drive.relative_to), speed=speed
    )


def _sentence_on_cam(drive: Drive, mechanism: Mechanism) -> str:
    """What a cam drives, and how fast it turns."""
    speed = _speed(mechanism, drive.turning or 0.0, "rad/s")
    if drive.guide is None:
        return _(BY_CAM["link"]).format(link=quote_word(drive.link or ""), speed=speed)
    guide = mechanism.guide(drive.guide)
    kind = "slider" if guide.link is None else "guided"
    return _(BY_CAM[kind]).format(point=guide.point, link=quote_word(guide.link or ""), speed=speed)


def _speed(mechanism: Mechanism, speed: float, unit: str) -> str:
    display = mechanism.display
    factor, shown = display_unit(unit, str(display.length), str(display.angle))
    return f"{speed * factor:.4g} {typeset_unit(shown)}"


# Sentences on how a mechanism moves: what is driven, and what follows what, group by group of the plan.

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
        ).format(link=quote_word(group.link), first=group.first, second=group.second)


def _on_turned_link(roles: Roles, group: TurnedLink) -> Iterator[str]:
    turning, place = group.turning, {"link": quote_word(group.link), "point": group.pivot}
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
        yield _("Link {link} follows.").format(link=quote_word(rods[0].link))
    elif not is_input(group):
        yield _("The slider in {point} is led by both its guides.").format(point=group.points[0])


def _moved_by_cylinder(roles: Roles, cylinder: str, link: str) -> str:
    pivot = roles.pivot(link)
    key, angle = extent(roles, link)
    place = {"cylinder": cylinder, "link": quote_word(link), "pivot": pivot, "angle": angle}
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
            yield _("Links {links} carry link {link}.").format(
                links=links_listed(rods), link=quote_word(link)
            )
        else:
            yield _("Link {rod} carries link {link}.").format(rod=quote_word(rods[0]), link=quote_word(link))
        return
    guides = [guide for guide in roles.mechanism.guides if guide.link == link and guide.on == FRAME]
    if guides and guides[0].id in roles.strokes:
        text = (
            _("Link {link} moves to and fro along its guide; its stroke is {stroke}.")
            if roles.comes_back(guides[0].id)
            else _("Link {link} moves along its guide, by {stroke} in all.")
        )
        yield text.format(link=quote_word(link), stroke=roles.length_text(roles.strokes[guides[0].id]))
    elif guides:
        yield _("Link {link} moves along its guide.").format(link=quote_word(link))
    else:
        yield _("Link {link} follows without turning.").format(link=quote_word(link))


def _on_two_links(mechanism: Mechanism, roles: Roles, one: Rod, other: Rod) -> str:
    """A dyad of two links: a coupler and what it moves, or two links that join moving ones."""
    pivoted = [rod for rod in (one, other) if rod.centre in mechanism.frame.points]
    if len(pivoted) == 1:
        follower = pivoted[0]
        coupler = other if follower is one else one
        key, angle = extent(roles, follower.link)
        return _(FOLLOWERS[key]).format(
            coupler=quote_word(coupler.link),
            follower=quote_word(follower.link),
            pivot=follower.centre,
            angle=angle,
        )
    place = {
        "one": quote_word(one.link),
        "other": quote_word(other.link),
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
    place = {"coupler": quote_word(rod.link), "point": guide.point, "on": quote_word(rail.on)}
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


def describe(mechanism: Mechanism) -> str:
    """How a mechanism works, in the chosen language: paragraphs on its parts, on its motion, on what comes of it.

    Extents (strokes, angles of swing) are those over the description's own range, one turn of the drive if it names
    none, and are left out where the mechanism locks. Raises InputError as `check` does.
    """
    prepared = ready(mechanism)
    roles = roles_of(mechanism)
    paragraphs = (
        sentences_on_joints(mechanism),
        sentences_on_motion(prepared.structure, roles),
        _on_freedom(prepared, roles),
    )
    return "\n\n".join(" ".join(paragraph) for paragraph in paragraphs)


def _on_freedom(prepared: Ready, roles: Roles) -> Iterator[str]:
    """Mobility, repeated constraints, and whether the drive turns fully."""
    yield ngettext(
        "The mobility is {n}: one drive determines the place of every link.",
        "The mobility is {n}: {n} drives together determine the place of every link.",
        prepared.mobility,
    ).format(n=prepared.mobility)
    redundant = [constraint.label for constraint in prepared.structure.redundant]
    if redundant:
        yield _("Redundant constraints, which only have to fit: {constraints}.").format(
            constraints=", ".join(redundant)
        )
    rotation = rotation_of(prepared)
    if rotation.turns_fully:
        yield _("The drive can turn fully.")
    elif rotation.turns_fully is False and rotation.limit is not None:
        at = value_text(rotation.limit, rotation.unit, prepared.mechanism.display)
        # Translators: {cause} is a sentence without its full stop
        yield _("The drive cannot turn fully; it stops at {value}: {cause}.").format(
            value=at, cause=rotation.cause
        )
