"""The plan as a structural formula: input links and Assur groups with class, order and kind.

Artobolevsky's classification: a dyad has class II and order 2; its five kinds are RRR, RRP, RPR, PRP and
RPP. A mechanism has the class of its highest group.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import assert_never

from centrode.locale import _, mark, ngettext
from centrode.model.mechanism import Mechanism
from centrode.structure.groups import (
    Aim,
    CylinderCircle,
    Group,
    GuideStop,
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
    Touch,
    Train,
    TurnedLink,
    TwoPointLink,
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
    contours = Contours()
    for link in group.links:
        for point in mechanism.links[link].coordinates:
            if point in group.points:
                contours.joints.setdefault(("hinge", point), []).append(link)
            elif _is_shared(mechanism, point, link):
                contours.outer += 1
    for guide in mechanism.guides:
        slider = guide.link or slider_of(guide)
        inside = [body for body in (guide.on, slider) if body in group.links]
        if guide.link is None and guide.point in group.points:
            contours.joints.setdefault(("hinge", guide.point), []).append(slider)
            inside.append(slider)
        # the slider's link is not written in the description, but it is a link of the group with an outer
        # hinge
        elif guide.link is None and guide.on in group.links:
            # a slider between the link and a known point belongs to the group as well
            inside.append(slider)
            contours.outer += 1
        if len(inside) == 2:
            contours.joints[("guide", guide.id)] = inside
        elif inside:
            contours.outer += 1
    return contours


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
    """Group that is one term of the structural formula.

    Attributes
    ----------
    roman : "I" for an input, "II" for a dyad, "III" and on for higher groups, "0" for a link that only follows
    order : number of outer joints, 0 where that says nothing
    kind : "RRR", ..., or what else it is, in English; views translate it
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
    groups: list[AssurGroup] = []
    taken: set[str] = set()
    for group in structure.groups:
        if isinstance(group, RigidPoint):
            continue
        own = _members(structure.mechanism, group)
        # a slider is named with the group that it slides in first, and counts there alone
        members = tuple(name for name in own if name not in taken)
        taken.update(members)
        if members:
            groups.append(_term(structure.mechanism, group, members))
    return tuple(groups)


def structural_formula(structure: Structure) -> str:
    """The order of formation: I(1) -> II(2, 3) -> II(4, 5)."""
    return " -> ".join(group.text for group in assur_groups(structure))


def _term(mechanism: Mechanism, group: Group, members: tuple[str, ...]) -> AssurGroup:
    if group.is_input:
        return AssurGroup("I", 1, group.kind, members)
    match group:
        case TurnedLink(turning=Meshed()):
            return AssurGroup("II", 2, mark("gear"), members)
        case TurnedLink(turning=Rolled()):
            return AssurGroup("II", 2, mark("rolling"), members)
        case Train():
            return AssurGroup("II", len(group.links), group.kind, members)
        case Meet() | Aim():
            return AssurGroup("II", 2, group.kind, members)
        case Newton():
            contours = contours_of(mechanism, group)
            return AssurGroup(roman(contours.highest), contours.outer, group.kind, members)
        case RigidPoint() | TwoPointLink() | TurnedLink():
            return AssurGroup("0", 0, group.kind, members)
        case _:
            assert_never(group)


def roman(number: int) -> str:
    """A small number in Roman figures."""
    # 9 and 4 are written by subtraction, so they stand among the figures
    figures = ((10, "X"), (9, "IX"), (5, "V"), (4, "IV"), (1, "I"))
    numeral = ""
    for value, figure in figures:
        while number >= value:
            numeral += figure
            number -= value
    return numeral


def _members(mechanism: Mechanism, group: Group) -> tuple[str, ...]:
    """Links of a group, with the sliders of its guides: a slider's own link belongs to the dyad it slides in."""
    names = list(group.links)
    match group:
        case Aim():
            if group.contact is not None:
                names.append(group.contact.link)
            elif group.block is None:
                names.append(slider_of(mechanism.guide(group.guide)))
        case Meet():
            for locus in group.loci:
                names += _members_of_locus(mechanism, locus, names)
        case Newton():
            bare = [guide for guide in mechanism.guides if is_bare(guide)]
            names += [slider_of(g) for g in bare if g.point in group.points or g.on in group.links]
        case RigidPoint() | TwoPointLink() | TurnedLink() | Train():
            pass
        case _:
            assert_never(group)
    # a dict keeps the first place of each name
    return tuple(dict.fromkeys(names))


def _members_of_locus(mechanism: Mechanism, locus: Locus, names: Sequence[str]) -> Iterator[str]:
    """A slider or a cylinder that draws a locus; links, which are in `names`, are counted already."""
    match locus:
        case Rail(guide=name) | Slot(guide=name) | GuideStop(guide=name):
            guide = mechanism.guide(name)
            # a guided link that belongs to the group is there already
            if is_bare(guide) or guide.link not in names:
                yield slider_of(guide)
        case CylinderCircle(drive=drive):
            yield _("cylinder {drive}").format(drive=drive)
        case Rod() | Touch() | Rolloff():
            pass
        case _:
            assert_never(locus)


def name_of(group: Group) -> str:
    """A group by its links and points, as messages and tables name it."""
    links = "-".join(group.links)
    count, points = len(group.points), ", ".join(group.points)
    if links and points:
        name = ngettext("group {links} (point {points})", "group {links} (points {points})", count)
        return name.format(links=links, points=points)
    return _("group {links}").format(links=links or points)
