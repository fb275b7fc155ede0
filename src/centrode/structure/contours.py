"""Class and order of groups that are solved as a whole, by their inner contours.

A group's class is that of its highest contour: a link with three inner joints is a contour of class III, a closed
chain of k inner joints one of class k; its order is the number of outer joints (Artobolevsky, Theory of Mechanisms
and Machines, section 14).
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field

from centrode.model.mechanism import Mechanism
from centrode.structure.groups import Newton
from centrode.structure.mobility import slider_of

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
    waiting = deque([link])
    while waiting:
        here = waiting.popleft()
        for step in sides[here]:
            if step == joint:
                continue
            for other in inner[step]:
                if other not in distance:
                    distance[other] = distance[here] + 1
                    if other in inner[joint]:
                        return distance[other]
                    waiting.append(other)
    return 0
