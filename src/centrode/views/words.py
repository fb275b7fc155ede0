"""How a mechanism works, in words: what it is made of, how it moves, what bounds the motion."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

from centrode.model.reading import FRAME, two_points
from centrode.model.values import TurnsPerMinute
from centrode.sheets.sheet import Chapter, Paragraph, Section, Sheet
from centrode.sheets.texts import NOTHING, Counted, Joined, Name, Number, Sentence, Text
from centrode.structure.assur import assur_groups
from centrode.structure.groups import (
    Aim,
    CylinderCircle,
    Meet,
    Newton,
    Rail,
    RigidPoint,
    Train,
    TurnedLink,
    Turning,
    TwoPointLink,
)
from centrode.structure.rank import is_bare
from centrode.views.instants import place_number
from centrode.views.rotatability import cause_text

if TYPE_CHECKING:
    from centrode.analysis.operation import LinkRoles, PrincipleOfOperation
    from centrode.model.mechanism import Drive, Gear, Guide, Mechanism, Rolling
    from centrode.structure.groups import Group, Rod
    from centrode.structure.plan import Structure


def sheet(operation: PrincipleOfOperation) -> Sheet:
    """Paragraphs on the parts, on the motion and on what bounds it."""
    sentences = (
        _on_joints(operation.mechanism),
        _on_motion(operation.structure, operation.roles),
        _on_freedom(operation),
    )
    paragraphs = tuple(Paragraph(Joined(tuple(one), " ")) for one in sentences)
    chapter = Chapter(Sentence("How it works"), (Section(NOTHING, paragraphs),))
    return Sheet(printed=paragraphs, chapters={"words": chapter})


def _on_freedom(operation: PrincipleOfOperation) -> Iterator[Text]:
    """Mobility, redundant constraints, and whether the drive turns fully."""
    yield Counted(
        "The mobility is {n}: one drive determines the position of every link.",
        "The mobility is {n}: {n} drives together determine the position of every link.",
        operation.mobility,
    )
    redundant = [Name(constraint.label) for constraint in operation.structure.redundant]
    if redundant:
        yield Sentence(
            "Redundant constraints (their dimensions have to be consistent with the others): {constraints}.",
            constraints=Joined(redundant),
        )
    turning, limits = operation.rotatability, operation.first_limits
    if turning.turns_fully:
        yield Sentence("The drive can turn fully.")
    elif turning.turns_fully is False and limits:
        causes: list[Text] = []
        for limit in limits:
            cause = cause_text(limit.cause)
            causes += [] if cause in causes else [cause]
        # Translators: {cause} is a sentence without its full stop
        yield Sentence(
            "The drive cannot turn fully; it stops at {value}: {cause}.",
            value=place_number(limits[0].value, turning.one.unit),
            cause=Joined(causes, "; "),
        )


def _angle(mechanism: Mechanism, angle: float) -> Number:
    """An angle as prose has it: in degrees, where the description does not ask for another unit."""
    if str(mechanism.display.angle) in ("deg", "rad"):
        return Number(math.degrees(angle), "°", ".3g", unit_fixed=True)
    return Number(angle, "rad", ".3g")


def speed_as_given(speed: float, unit: str, digits: str = "") -> Number:
    """The size of a speed, in turns per minute where the description gives it so."""
    if isinstance(speed, TurnsPerMinute):
        return Number(abs(speed.rpm), "rpm", digits, unit_fixed=True)
    return Number(abs(speed), unit, digits)


def _length(mechanism: Mechanism, length: float) -> Number:
    """A length; on the sphere an arc."""
    return _angle(mechanism, length) if mechanism.space == "sphere" else Number(length, "m", ".4g")


def _ratio(ratio: float) -> Number:
    return Number(abs(ratio), digits=".4g")


# Names and lists of names as sentences have them.


def quoted_name(name: str) -> Text:
    """A link's name, in quotes where it is a word: crank OA, but crank "crank"."""
    if two_points(name) is not None or len(name) < 3:
        return Name(name)
    # Translators: a name in quotation marks
    return Sentence('"{name}"', name=Name(name))


def enumeration(names: Iterable[Text]) -> Text:
    """Names with commas and an "and" before the last."""
    every = list(names)
    if len(every) < 2:
        return Joined(every)
    # Translators: the last two of a list of names, such as "AC and CB"
    return Sentence("{names} and {last}", names=Joined(every[:-1]), last=every[-1])


def _links(names: Iterable[str]) -> Text:
    """Names of links as a list."""
    return enumeration(map(quoted_name, names))


# Sentences on what a mechanism is made of: links, hinges, guides, wheels, cylinders.

LEVEL = 1e-9
"""Directions of guides nearer than this to an axis are called horizontal and vertical [rad]."""

# Translators: {links} are names of links such as "AC and CB", {point} the name of a point; names do not change.
SLIDERS = {
    "horizontal": Sentence("A slider, hinged to {links} in {point}, moves along a fixed horizontal guide."),
    "vertical": Sentence("A slider, hinged to {links} in {point}, moves along a fixed vertical guide."),
    "inclined": Sentence(
        "A slider, hinged to {links} in {point}, moves along a fixed guide at {angle} to the horizontal."
    ),
    "circle": Sentence("A slider, hinged to {links} in {point}, moves along a fixed circle."),
}
LONE_SLIDERS = {
    "horizontal": Sentence("A slider in {point} moves along a fixed horizontal guide."),
    "vertical": Sentence("A slider in {point} moves along a fixed vertical guide."),
    "inclined": Sentence("A slider in {point} moves along a fixed guide at {angle} to the horizontal."),
    "circle": Sentence("A slider in {point} moves along a fixed circle."),
}
SLIDING_LINKS = {
    "horizontal": Sentence("Link {link} moves along a fixed horizontal guide without turning."),
    "vertical": Sentence("Link {link} moves along a fixed vertical guide without turning."),
    "inclined": Sentence(
        "Link {link} moves along a fixed guide at {angle} to the horizontal without turning."
    ),
    "circle": Sentence("Link {link} moves along a fixed circle without turning relative to it."),
}
ROLLING = {
    ("line", True): Sentence("Wheel {wheel} rolls without slip on a fixed straight track."),
    ("line", False): Sentence("Wheel {wheel} rolls without slip on a straight track of link {on}."),
    ("outside", True): Sentence("Wheel {wheel} rolls without slip on the outside of a fixed circle."),
    ("outside", False): Sentence("Wheel {wheel} rolls without slip on the outside of a circle of link {on}."),
    ("inside", True): Sentence("Wheel {wheel} rolls without slip inside a fixed circle."),
    ("inside", False): Sentence("Wheel {wheel} rolls without slip inside a circle of link {on}."),
}


def moving_parts(mechanism: Mechanism) -> list[Text]:
    """Names of the moving links, sliders and cylinders included, as they are counted."""
    sliders = [guide for guide in mechanism.guides if is_bare(guide)]
    parts = [
        *map(quoted_name, mechanism.link_names),
        *(Sentence("slider {point}", point=Name(guide.id)) for guide in sliders),
    ]
    for drive in mechanism.drives:
        if drive.kind == "distance":
            parts.append(Sentence("barrel of cylinder {name}", name=Name(drive.id)))
            parts.append(Sentence("rod of cylinder {name}", name=Name(drive.id)))
    return parts


def _on_joints(mechanism: Mechanism) -> Iterator[Text]:
    """What the mechanism is made of, and how that is joined."""
    parts = moving_parts(mechanism)
    # Translators: {parts} is a list of names such as "OA, AC, slider C"
    yield Counted(
        "The mechanism has {links} links: the frame and {n} moving link ({parts}).",
        "The mechanism has {links} links: the frame and {n} moving links ({parts}).",
        len(parts),
        links=Number(len(parts) + 1, digits="d"),
        parts=Joined(parts),
    )
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
            first, second = map(Name, drive.distance)
            yield Sentence("A cylinder reaches from {first} to {second}.", first=first, second=second)


def _links_at(mechanism: Mechanism, point: str) -> list[str]:
    """Links that have a point."""
    return [name for name, link in mechanism.links.items() if point in link.coordinates]


def _on_hinges(mechanism: Mechanism) -> Iterator[Text]:
    """Fixed and moving hinges; those of sliders stand with their guides."""
    sliders = {guide.point for guide in mechanism.guides if is_bare(guide)}
    fixed: list[Text] = []
    moving: list[Text] = []
    points = dict.fromkeys([*mechanism.frame.points, *mechanism.moving_points])
    for point in points:
        links = _links_at(mechanism, point)
        if point in mechanism.frame.points and links:
            # Translators: an entry of the list "Hinged to the frame: ...", such as "OA in O"
            fixed.append(Sentence("{links} in {point}", links=_links(links), point=Name(point)))
        elif len(links) > 1 and point not in sliders:
            moving.append(Sentence("{links} in {point}", links=_links(links), point=Name(point)))
    if fixed:
        yield Sentence("Hinged to the frame: {hinges}.", hinges=Joined(fixed))
    if moving:
        yield Sentence("Hinged to each other: {hinges}.", hinges=Joined(moving))


def _on_plates(mechanism: Mechanism) -> Iterator[Text]:
    for name, link in mechanism.links.items():
        if len(link.coordinates) > 2:
            points = enumeration(map(Name, link.coordinates))
            yield Sentence(
                "Link {link} is one rigid piece with the points {points}.",
                link=quoted_name(name),
                points=points,
            )


def _on_guide(mechanism: Mechanism, guide: Guide) -> Text:
    links = [name for name in _links_at(mechanism, guide.point) if name != guide.on]
    own = guide.link is not None
    place = {
        "links": _links(links),
        "point": Name(guide.point),
        "link": quoted_name(guide.link or ""),
        "on": quoted_name(guide.on),
    }
    if guide.on == FRAME:
        way, place["angle"] = _way(mechanism, guide)
        sentences = SLIDING_LINKS if own else SLIDERS if links else LONE_SLIDERS
        return sentences[way].fill(**place)
    if own:
        return Sentence("Link {link} slides along link {on} and does not turn relative to it.", **place)
    if links:
        return Sentence("A slider, hinged to {links} in {point}, moves along link {on}.", **place)
    if guide.point in mechanism.frame.points:
        return Sentence("A slider, hinged to the frame in {point}, moves along link {on}.", **place)
    return Sentence("A slider in {point} moves along link {on}.", **place)


def _way(mechanism: Mechanism, guide: Guide) -> tuple[str, Text]:
    """How a fixed guide lies, and its angle to the horizontal."""
    if mechanism.space == "sphere":
        return "circle", NOTHING
    angle = math.remainder(guide.direction_angle, math.pi)
    if abs(angle) < LEVEL:
        return "horizontal", NOTHING
    if abs(abs(angle) - math.pi / 2) < LEVEL:
        return "vertical", NOTHING
    return "inclined", Number(math.degrees(angle), "°", ".3g", unit_fixed=True)


def _on_gear(gear: Gear) -> Text:
    one, other = gear.links
    place = {
        "one": quoted_name(one),
        "other": quoted_name(other),
        "carrier": quoted_name(gear.carrier),
        "ratio": _ratio(gear.ratio),
    }
    if FRAME in gear.links:
        return Sentence(
            "Link {link} meshes with a fixed wheel; link {carrier} carries its axis.",
            link=place["other" if one == FRAME else "one"],
            carrier=place["carrier"],
        )
    if gear.carrier == FRAME:
        text = (
            Sentence(
                "Links {one} and {other} are geared: {other} turns in the ratio {ratio} to {one},"
                " in the opposite sense."
            )
            if gear.ratio < 0
            else Sentence(
                "Links {one} and {other} are geared: {other} turns in the ratio {ratio} to {one},"
                " in the same sense."
            )
        )
        return text.fill(**place)
    text = (
        Sentence(
            "Links {one} and {other} are geared: seen from link {carrier}, {other} turns in the ratio {ratio} to {one},"
            " in the opposite sense."
        )
        if gear.ratio < 0
        else Sentence(
            "Links {one} and {other} are geared: seen from link {carrier}, {other} turns in the ratio {ratio} to {one},"
            " in the same sense."
        )
    )
    return text.fill(**place)


def _on_rolling(wheel: Rolling) -> Text:
    track = "line" if wheel.along.direction is not None else "inside" if wheel.along.inside else "outside"
    return ROLLING[track, wheel.on == FRAME].fill(wheel=quoted_name(wheel.link), on=quoted_name(wheel.on))


# Sentences on links that a slider or a wheel turns about their pivots.

# Translators: {link}, {block}, {wheel} are names of links, {pivot} and {point} of points; names do not change.
LEVERS = {
    "turns": Sentence("The slider in {point} moves along link {link} and turns it fully about {pivot}."),
    "swings": Sentence(
        "The slider in {point} moves along link {link} and swings it about {pivot} through {angle}."
    ),
    "moves": Sentence("The slider in {point} moves along link {link} and turns it about {pivot}."),
    "still": Sentence("The slider in {point} moves along link {link}, which does not turn."),
}
BLOCKS = {
    "turns": Sentence("Link {block} slides along link {link} and turns it fully about {pivot}."),
    "swings": Sentence("Link {block} slides along link {link} and swings it about {pivot} through {angle}."),
    "moves": Sentence("Link {block} slides along link {link} and turns it about {pivot}."),
    "still": Sentence("Link {block} slides along link {link}, which does not turn."),
}
RESTING = {
    "turns": Sentence("Link {link} rests on wheel {wheel} and is turned fully about {pivot}."),
    "swings": Sentence("Link {link} rests on wheel {wheel} and swings about {pivot} through {angle}."),
    "moves": Sentence("Link {link} rests on wheel {wheel} and turns about {pivot}."),
    "still": Sentence("Link {link} rests on wheel {wheel} and does not turn."),
}


def _extent(roles: LinkRoles, link: str) -> tuple[str, Text]:
    """How a link on a pivot moves, as a key of sentences, and its angle."""
    if link not in roles.swings:
        return "moves", NOTHING
    if roles.stands_still(link):
        return "still", NOTHING
    if roles.turns_fully(link):
        return "turns", NOTHING
    return "swings", _angle(roles.mechanism, roles.swings[link])


def _on_lever(roles: LinkRoles, group: Aim) -> Text:
    """The sentence on a link that turns to a point, a slider or a wheel."""
    key, angle = _extent(roles, group.link)
    place = {"link": quoted_name(group.link), "pivot": Name(group.pivot), "angle": angle}
    if group.contact is not None:
        return RESTING[key].fill(wheel=quoted_name(group.contact.link), **place)
    block = group.block or roles.mechanism.guide(group.guide).link
    if block is not None:
        return BLOCKS[key].fill(block=quoted_name(block), **place)
    return LEVERS[key].fill(point=Name(group.target), **place)


# Sentences on what is driven, and how: at a constant speed, by a law, or at the mean speed of a machine.

CONSTANT, BY_LAW, MEAN = "constant", "by law", "mean"

# Translators: {link} and {base} are names of links, {pivot} and {point} of points; names do not change.
DRIVEN = {
    ("crank", CONSTANT): Sentence("Crank {link} is driven: it turns about {pivot} at a constant {speed}."),
    ("crank", BY_LAW): Sentence("Crank {link} is driven: it turns about {pivot} by a given law."),
    ("link", CONSTANT): Sentence("Link {link} is driven: it turns about {pivot} at a constant {speed}."),
    ("link", BY_LAW): Sentence("Link {link} is driven: it turns about {pivot} by a given law."),
    ("free", CONSTANT): Sentence("Link {link} is driven: its angle changes at a constant {speed}."),
    ("free", BY_LAW): Sentence("Link {link} is driven: its angle follows a given law."),
    ("relative", CONSTANT): Sentence("Link {link} is driven relative to link {base} at a constant {speed}."),
    ("relative", BY_LAW): Sentence("Link {link} is driven relative to link {base} by a given law."),
    ("slider", CONSTANT): Sentence("The slider in {point} is driven along its guide at a constant {speed}."),
    ("slider", BY_LAW): Sentence("The slider in {point} is driven along its guide by a given law."),
    ("guided", CONSTANT): Sentence("Link {link} is driven along its guide at a constant {speed}."),
    ("guided", BY_LAW): Sentence("Link {link} is driven along its guide by a given law."),
    ("crank", MEAN): Sentence("Crank {link} is driven: it turns about {pivot} at a mean speed of {speed}."),
    ("link", MEAN): Sentence("Link {link} is driven: it turns about {pivot} at a mean speed of {speed}."),
    ("free", MEAN): Sentence("Link {link} is driven: its angle changes at a mean speed of {speed}."),
    ("relative", MEAN): Sentence("Link {link} is driven relative to link {base} at a mean speed of {speed}."),
    ("cylinder", CONSTANT): Sentence("Cylinder {name} is driven: its length changes at a constant {speed}."),
    ("cylinder", BY_LAW): Sentence("Cylinder {name} is driven: its length follows a given law."),
}

BY_CAM = {
    "link": Sentence("Link {link} is driven by a cam, which turns at a constant {speed}."),
    "slider": Sentence("The slider in {point} is driven by a cam, which turns at a constant {speed}."),
    "guided": Sentence("Link {link} is driven along its guide by a cam, which turns at a constant {speed}."),
}


def _on_drive(drive: Drive, roles: LinkRoles) -> Text:
    """What a drive drives, at a constant speed, by a law, or in a machine."""
    mechanism = roles.mechanism
    if drive.turning is not None:
        return _on_cam(drive, mechanism)
    course, speed = _course(drive, mechanism)
    if drive.kind == "distance":
        return DRIVEN["cylinder", course].fill(name=Name(drive.id), speed=speed)
    if drive.guide is not None:
        guide = mechanism.guide(drive.guide)
        kind = "slider" if guide.link is None else "guided"
        return DRIVEN[kind, course].fill(
            point=Name(guide.point), link=quoted_name(guide.link or ""), speed=speed
        )
    link = drive.link or ""
    pivot = roles.pivot(link)
    if drive.relative_to != FRAME:
        kind = "relative"
    elif pivot is None:
        kind = "free"
    else:
        kind = "crank" if roles.turns_fully(link) and not roles.is_wheel(link) else "link"
    return DRIVEN[kind, course].fill(
        link=quoted_name(link), pivot=Name(pivot or ""), base=quoted_name(drive.relative_to), speed=speed
    )


def _course(drive: Drive, mechanism: Mechanism) -> tuple[str, Text]:
    """How a drive moves, as a key of sentences, and its speed; a machine runs at a speed of its own."""
    parameter = mechanism.motion_parameter.drive(drive.id)
    machine = mechanism.machine
    if machine is not None and mechanism.runs_at_mean_speed and parameter.unit == "rad":
        return MEAN, Number(30.0 * machine.mean_speed / math.pi, "rpm", ".4g", unit_fixed=True)
    if drive.speed is None:
        return BY_LAW, NOTHING
    return CONSTANT, speed_as_given(drive.speed, parameter.speed_unit, ".4g")


def _on_cam(drive: Drive, mechanism: Mechanism) -> Text:
    """What a cam drives, and how fast it turns."""
    speed = speed_as_given(drive.turning or 0.0, "rad/s", ".4g")
    if drive.guide is None:
        return BY_CAM["link"].fill(link=quoted_name(drive.link or ""), speed=speed)
    guide = mechanism.guide(drive.guide)
    kind = "slider" if guide.link is None else "guided"
    return BY_CAM[kind].fill(point=Name(guide.point), link=quoted_name(guide.link or ""), speed=speed)


# Sentences on how a mechanism moves: what is driven, and what follows what, group by group of the plan.

# Translators: {link}, {coupler}, {follower} are names of links, {pivot} and {point} of points; names do not change.
FOLLOWERS = {
    "turns": Sentence(
        "Coupler {coupler} passes the motion on to crank {follower}, which turns fully about {pivot}."
    ),
    "swings": Sentence(
        "Coupler {coupler} passes the motion on to rocker {follower}, which swings about {pivot} through {angle}."
    ),
    "moves": Sentence(
        "Coupler {coupler} passes the motion on to link {follower}, which turns about {pivot}."
    ),
    "still": Sentence("Coupler {coupler} is connected to link {follower}, which does not turn."),
}


def _on_motion(structure: Structure, roles: LinkRoles) -> Iterator[Text]:
    """What is driven, then what follows it, in the order of the plan."""
    named: set[str] = set()
    for drive in structure.mechanism.drives:
        yield _on_drive(drive, roles)
        named.update([drive.link] if drive.link else [])
    classes = {group.members: group.roman for group in assur_groups(structure)}
    for group in structure.groups:
        if isinstance(group, Newton):
            roman = next(
                (roman for members, roman in classes.items() if set(group.links) <= set(members)), ""
            )
            yield Sentence(
                "Links {links} form a group of class {roman}: their positions are found together.",
                links=_links(group.links),
                roman=Name(roman),
            )
        elif not isinstance(group, RigidPoint):
            yield from _on_group(structure, roles, group, named)
        named.update(group.links)


def _on_group(structure: Structure, roles: LinkRoles, group: Group, named: set[str]) -> Iterator[Text]:
    if isinstance(group, Aim):
        yield _on_lever(roles, group)
    elif isinstance(group, Meet):
        yield from _on_meeting(structure, roles, group)
    elif isinstance(group, Train):
        links = [link for link in group.links if link not in named]
        yield Sentence("The wheels turn links {links} together.", links=_links(links))
    elif isinstance(group, TurnedLink):
        yield from _on_turned_link(roles, group)
    elif isinstance(group, TwoPointLink):
        yield Sentence(
            "Link {link}, hinged in {first} and {second}, is passive: without it the motion is the same.",
            link=quoted_name(group.link),
            first=Name(group.first),
            second=Name(group.second),
        )


def _on_turned_link(roles: LinkRoles, group: TurnedLink) -> Iterator[Text]:
    turning, place = group.turning, {"link": quoted_name(group.link), "point": Name(group.pivot)}
    if isinstance(turning, Turning):
        # the link of a guide stands with what moves it along the guide
        if turning.guide is not None and roles.mechanism.guide(turning.guide).point != group.pivot:
            yield Sentence("Link {link} follows {point} without turning.", **place)
        return
    if not roles.one_turn:
        yield Sentence("Link {link} turns with the wheels about {point}.", **place)
        return
    turns = roles.turned[group.link] / math.tau
    drive = roles.mechanism.drives[0]
    opposite = turns * (drive.speed or 1.0) < 0
    text = (
        Sentence(
            "Link {link} turns with the wheels about {point}, in the ratio {ratio} to the drive, in the opposite sense."
        )
        if opposite
        else Sentence(
            "Link {link} turns with the wheels about {point}, in the ratio {ratio} to the drive, in the same sense."
        )
    )
    yield text.fill(ratio=_ratio(turns), **place)


def _on_meeting(structure: Structure, roles: LinkRoles, group: Meet) -> Iterator[Text]:
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
        yield Sentence("Link {link} follows.", link=quoted_name(rods[0].link))
    elif not group.is_input:
        yield Sentence(
            "Both guides determine the position of the slider in {point}.", point=Name(group.points[0])
        )


def _moved_by_cylinder(roles: LinkRoles, cylinder: str, link: str) -> Text:
    pivot = roles.pivot(link)
    key, angle = _extent(roles, link)
    place = {
        "cylinder": Name(cylinder),
        "link": quoted_name(link),
        "pivot": Name(pivot or ""),
        "angle": angle,
    }
    if pivot is None:
        return Sentence("Cylinder {cylinder} moves link {link}.", **place)
    if key == "swings":
        return Sentence("Cylinder {cylinder} swings link {link} about {pivot} through {angle}.", **place)
    return Sentence("Cylinder {cylinder} turns link {link} about {pivot}.", **place)


def _on_carriage(roles: LinkRoles, group: Meet) -> Iterator[Text]:
    """A link of known angle, which links or guides place."""
    link = str(group.carriage)
    if group.rods:
        rods = [rod.link for rod in group.rods]
        if len(rods) == 2:
            yield Sentence("Links {links} carry link {link}.", links=_links(rods), link=quoted_name(link))
        else:
            yield Sentence(
                "Link {rod} carries link {link}.", rod=quoted_name(rods[0]), link=quoted_name(link)
            )
        return
    guides = [guide for guide in roles.mechanism.guides if guide.link == link and guide.on == FRAME]
    if guides and guides[0].id in roles.strokes:
        text = (
            Sentence("Link {link} reciprocates along its guide; its stroke is {stroke}.")
            if roles.comes_back(guides[0].id)
            else Sentence("Link {link} moves along its guide by {stroke} in total.")
        )
        yield text.fill(link=quoted_name(link), stroke=_length(roles.mechanism, roles.strokes[guides[0].id]))
    elif guides:
        yield Sentence("Link {link} moves along its guide.", link=quoted_name(link))
    else:
        yield Sentence("Link {link} follows without turning.", link=quoted_name(link))


def _on_two_links(mechanism: Mechanism, roles: LinkRoles, one: Rod, other: Rod) -> Text:
    """A dyad of two links: a coupler and what it moves, or two links that join moving ones."""
    pivoted = [rod for rod in (one, other) if rod.centre in mechanism.frame.points]
    if len(pivoted) == 1:
        follower = pivoted[0]
        coupler = other if follower is one else one
        key, angle = _extent(roles, follower.link)
        return FOLLOWERS[key].fill(
            coupler=quoted_name(coupler.link),
            follower=quoted_name(follower.link),
            pivot=Name(follower.centre),
            angle=angle,
        )
    carriers = [_carriers(mechanism, rod) for rod in (one, other)]
    place = {
        "one": quoted_name(one.link),
        "other": quoted_name(other.link),
        "point": Name(one.point),
        "first": _links(carriers[0]),
        "first_point": Name(one.centre),
        "second": _links(carriers[1]),
        "second_point": Name(other.centre),
    }
    if not all(carriers):
        # what holds one of them is no link: the frame, or a slider
        return Sentence(
            "Links {one} and {other}, hinged to each other in {point}, follow {first_point} and {second_point}.",
            **place,
        )
    return Sentence(
        "Links {one} and {other}, hinged to each other in {point}, follow: {one} is hinged to {first} in {first_point},"
        " {other} to {second} in {second_point}.",
        **place,
    )


def _carriers(mechanism: Mechanism, rod: Rod) -> list[str]:
    """Links that hold the known end of a link."""
    return [name for name in _links_at(mechanism, rod.centre) if name != rod.link]


def _on_slider(roles: LinkRoles, rod: Rod, rail: Rail) -> Text:
    guide = roles.mechanism.guide(rail.guide)
    place = {"coupler": quoted_name(rod.link), "point": Name(guide.point), "on": quoted_name(rail.on)}
    if rail.on != FRAME:
        return Sentence("Link {coupler} moves the slider in {point} along link {on}.", **place)
    if guide.id not in roles.strokes:
        return Sentence("Coupler {coupler} moves the slider in {point} along its guide.", **place)
    text = (
        Sentence(
            "Coupler {coupler} reciprocates the slider in {point} along its guide; its stroke is {stroke}."
        )
        if roles.comes_back(guide.id)
        else Sentence("Coupler {coupler} moves the slider in {point} along its guide, by {stroke} in total.")
    )
    return text.fill(stroke=_length(roles.mechanism, roles.strokes[guide.id]), **place)
