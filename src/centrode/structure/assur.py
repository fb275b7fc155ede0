"""The plan as a structural formula: input links and Assur groups with class, order and kind.

Artobolevsky's classification: a dyad has class II and order 2; its five kinds are RRR, RRP, RPR, PRP and
RPP. A mechanism has the class of its highest group.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field

from centrode.locale import _, ngettext
from centrode.model.mechanism import Mechanism
from centrode.model.reading import body_word
from centrode.structure.groups import (
    Aim,
    AngleGiven,
    CylinderCircle,
    Group,
    Locus,
    Meet,
    Meshed,
    Newton,
    Rail,
    RigidPoint,
    Rod,
    Rolled,
    Rolloff,
    Slot,
    Stop,
    Touch,
    Train,
    TurnedLink,
    Turning,
    TwoPointLink,
    links_of,
    points_of,
)
from centrode.structure.plan import Structure
from centrode.structure.rank import is_bare, slider_of

# Class and order of groups that are solved as a whole, by their inner contours.
#
# A group's class is that of its highest contour: a link with three inner joints is a contour of class III, a
# closed chain of k inner joints one of class k; its order is the number of outer joints (Artobolevsky, Theory
# of Mechanisms and Machines, section 14).

Joint = tuple[str, str]


@dataclass
class Contours:
    """Links of a group and the joints between them; `outer` counts the joints to what is known before it."""

    joints: dict[Joint, list[str]] = field(default_factory=dict)
    outer: int = 0

    @property
    def highest(self) -> int:
        """Number of the highest class of a contour; 2 where there is none."""
        inner = {joint: links for joint, links in self.joints.items() if len(links) > 1}
        sides: dict[str, list[Joint]] = {}
        for joint, links in inner.items():
            for link in links:
                sides.setdefault(link, []).append(joint)
        # three inner joints or more make a link a rigid contour; two make it a side of one
        rigid = max((3 for joints in sides.values() if len(joints) > 2), default=2)
        loops = [
            _shortest_loop(inner, sides, joint, link) for joint, links in inner.items() for link in links
        ]
        return max([rigid, *loops])


def contours_of(mechanism: Mechanism, group: Newton) -> Contours:
    """Joints inside a group and towards what is known before it."""
    found = Contours()
    for link in group.links:
        for point in mechanism.links[link].coordinates:
            if point in group.points:
                found.joints.setdefault(("hinge", point), []).append(link)
            elif _is_shared(mechanism, point, link):
                found.outer += 1
    for guide in mechanism.guides:
        slider = guide.link or slider_of(guide)
        inside = [body for body in (guide.on, slider) if body in group.links]
        if guide.link is None and guide.point in group.points:
            found.joints.setdefault(("hinge", guide.point), []).append(slider)
            inside.append(slider)
        # the slider's link is not written in the description, but it is a link of the group with an outer
        # hinge
        elif guide.link is None and guide.on in group.links:
            # a slider between the link and a known point belongs to the group as well
            inside.append(slider)
            found.outer += 1
        if len(inside) == 2:
            found.joints[("guide", guide.id)] = inside
        elif inside:
            found.outer += 1
    return found


def _is_shared(mechanism: Mechanism, point: str, link: str) -> bool:
    """Whether a known point of a link is a joint: of the frame, or of another link."""
    others = [name for name, other in mechanism.links.items() if name != link and point in other.coordinates]
    return bool(others) or point in mechanism.frame.points


def _shortest_loop(
    inner: dict[Joint, list[str]], sides: dict[str, list[Joint]], joint: Joint, link: str
) -> int:
    """Joints in the shortest closed chain that passes a link at a joint; 0 if there is none."""
    # from the link, not over the joint, back to another link of the joint
    distance = {link: 1}
    # breadth first, so that the first way back is the shortest
    waiting = deque([link])
    while waiting:
        here = waiting.popleft()
        for step in sides[here]:
            # going back over the joint itself would close nothing
            if step == joint:
                continue
            for other in inner[step]:
                if other not in distance:
                    distance[other] = distance[here] + 1
                    if other in inner[joint]:
                        return distance[other]
                    waiting.append(other)
    return 0


@dataclass(frozen=True)
class AssurGroup:
    """One term of the structural formula.

    Attributes
    ----------
    roman : "I" for an input, "II" for a dyad, "III" and on for higher groups, "0" for a link that only follows
    order : number of outer joints, 0 where that says nothing
    kind : "RRR", ..., or what else it is
    members : links, sliders that are understood included
    """

    roman: str
    order: int
    kind: str
    members: tuple[str, ...]

    @property
    def text(self) -> str:
        """The term as the formula shows it: II(2, 3)."""
        return f"{self.roman}({', '.join(self.members)})"


def assur_groups(structure: Structure) -> tuple[AssurGroup, ...]:
    """Inputs and groups in the order of the plan."""
    found: list[AssurGroup] = []
    taken: set[str] = set()
    for group in structure.groups:
        if isinstance(group, RigidPoint):
            continue
        own = _members(structure.mechanism, group)
        # a slider is named with the group that it slides in first, and counts there alone
        members = tuple(name for name in own if name not in taken)
        taken.update(members)
        if members:
            found.append(_term(structure.mechanism, group, members))
    return tuple(found)


def structural_formula(structure: Structure) -> str:
    """The order of formation: I(1) -> II(2, 3) -> II(4, 5)."""
    return " -> ".join(group.text for group in assur_groups(structure))


def _term(mechanism: Mechanism, group: Group, members: tuple[str, ...]) -> AssurGroup:
    if is_input(group):
        return AssurGroup("I", 1, group.kind, members)
    if isinstance(group, TurnedLink) and not isinstance(group.turning, Turning):
        return AssurGroup("II", 2, _("gear") if isinstance(group.turning, Meshed) else _("rolling"), members)
    if isinstance(group, Train):
        return AssurGroup("II", len(group.links), _("gear train"), members)
    if isinstance(group, (Meet, Aim)):
        return AssurGroup("II", 2, group.kind, members)
    if isinstance(group, Newton):
        contours = contours_of(mechanism, group)
        return AssurGroup(roman(contours.highest), contours.outer, _("higher class"), members)
    return AssurGroup("0", 0, group.kind, members)


def roman(number: int) -> str:
    """A small number in Roman figures."""
    # 9 and 4 are written by subtraction, so they stand among the figures
    figures = ((10, "X"), (9, "IX"), (5, "V"), (4, "IV"), (1, "I"))
    found = ""
    for value, figure in figures:
        while number >= value:
            found += figure
            number -= value
    return found


def is_input(group: Group) -> bool:
    """Whether a drive acts inside the group."""
    if isinstance(group, TurnedLink):
        return isinstance(group.turning, Turning) and group.turning.drive is not None
    if isinstance(group, Train):
        return any(isinstance(e, AngleGiven) and e.drive is not None for e in group.equations)
    if isinstance(group, Meet):
        driven = isinstance(group.turning, Turning) and group.turning.drive is not None
        return driven or any(isinstance(locus, (Stop, CylinderCircle)) for locus in group.loci)
    return False


def _members(mechanism: Mechanism, group: Group) -> tuple[str, ...]:
    """Links of a group, with the sliders of its guides: a slider's own link belongs to the dyad it slides in."""
    names = list(links_of(group))
    if isinstance(group, Aim) and group.contact is not None:
        names.append(group.contact.link)
    elif isinstance(group, Aim) and group.block is None:
        guide = mechanism.guide(group.guide)
        names.append(slider_of(guide))
    if isinstance(group, Meet):
        for locus in group.loci:
            if isinstance(locus, (Rail, Slot, Stop)):
                guide = mechanism.guide(locus.guide)
                # a guided link that belongs to the group is there already
                if is_bare(guide) or guide.link not in names:
                    names.append(slider_of(guide))
            if isinstance(locus, CylinderCircle):
                names.append(_("cylinder {drive}").format(drive=locus.drive))
    if isinstance(group, Newton):
        bare = [guide for guide in mechanism.guides if is_bare(guide)]
        names += [slider_of(g) for g in bare if g.point in group.points or g.on in group.links]
    # a dict keeps the first place of each name
    return tuple(dict.fromkeys(names))


# The steps of a plan in words: what is found, and from what.


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
    return _meeting_text(group)


def _meeting_text(group: Meet) -> str:
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
    if isinstance(locus, CylinderCircle):
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
