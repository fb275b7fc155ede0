"""The bodies that forces act on at an instant, their numbers, and who carries the pin of each hinge.

Places and forces are complex numbers x + i y. A point on a guide without a link of its own is a slider, as for
instant centres. The pin of a hinge belongs to one of the bodies that meet there; the others are hinged to that one,
so a hinge of k bodies is k - 1 hinges.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

from centrode.analysis.instant_centres.bodies import sliders_of
from centrode.locale import _
from centrode.model.mechanism import FRAME, Guide, Mechanism
from centrode.structure.groups import Group, TurnedLink, Turning, links_of, points_of
from centrode.structure.plan import Structure

MOST_DIGITS = 10
"""With more bodies the two numbers of a reaction are parted by a comma."""


@dataclass(frozen=True)
class Bodies:
    """Frame, links, sliders and bare pins.

    Attributes
    ----------
    names : by number, the frame first; links and sliders as for instant centres, then pins that no body has
    sliders : slider -> its guide
    pins : pin -> the point
    order : body -> its place in the plan, -1 of the frame
    """

    mechanism: Mechanism
    names: tuple[str, ...]
    sliders: Mapping[str, Guide]
    pins: Mapping[str, str]
    order: Mapping[str, int]

    @classmethod
    def of(cls, structure: Structure) -> Bodies:
        """The bodies of a planar mechanism."""
        mechanism = structure.mechanism
        sliders = sliders_of(mechanism)
        order = {FRAME: -1}
        of_point: dict[str, int] = dict.fromkeys(mechanism.frame.points, -1)
        for number, group in enumerate(structure.groups):
            first = _with_its_point(group, number, of_point, order)
            order |= {link: first for link in links_of(group) if link not in order}
            of_point |= {point: number for point in points_of(group) if point not in of_point}
        for name, guide in sliders.items():
            order[name] = max(of_point.get(guide.point, -1), order[guide.on])
        carried = {point for link in mechanism.links.values() for point in link.coordinates}
        carried |= {guide.point for guide in sliders.values()} | set(mechanism.frame.points)
        pins = {
            _("pin {point}").format(point=point): point
            for point in mechanism.moving_points
            if point not in carried
        }
        order |= {name: of_point.get(point, 0) for name, point in pins.items()}
        return cls(mechanism, (FRAME, *mechanism.link_names, *sliders, *pins), sliders, pins, order)

    def number(self, body: str) -> int:
        """Number of a body, 0 of the frame."""
        return self.names.index(body)

    def pair(self, first: str, second: str) -> str:
        """Both numbers, as they stand at a reaction of the first on the second."""
        comma = "," if len(self.names) > MOST_DIGITS else ""
        return f"{self.number(first)}{comma}{self.number(second)}"

    def carrier(self, guide: Guide) -> str:
        """What slides on a guide: its link, or the slider that is understood."""
        if guide.link is not None:
            return guide.link
        return next(name for name, own in self.sliders.items() if own is guide)

    @cached_property
    def at_point(self) -> Mapping[str, tuple[str, ...]]:
        """Point -> the bodies that have it, the one that carries its pin first.

        That is the body that is found first in the plan; within a group a slider, then a link that a guide guides
        there, then description order.
        """
        found: dict[str, list[str]] = {point: [FRAME] for point in self.mechanism.frame.points}
        for name, guide in self.sliders.items():
            found.setdefault(guide.point, []).append(name)
        for name, link in self.mechanism.links.items():
            for point in link.coordinates:
                found.setdefault(point, []).append(name)
        for name, point in self.pins.items():
            found.setdefault(point, []).append(name)
        return {point: tuple(sorted(names, key=self._rank(point))) for point, names in found.items()}

    def _rank(self, point: str) -> Rank:
        guided = {guide.link for guide in self.mechanism.guides if guide.point == point}
        return Rank(self.order, set(self.sliders), guided)

    def host(self, point: str) -> str:
        """The body that carries the pin of a point; loads on the point act on it."""
        return self.at_point[point][0]


def _with_its_point(group: Group, number: int, points: Mapping[str, int], links: Mapping[str, int]) -> int:
    """Place of a group's links in the plan: a link that does not turn belongs to the group that gives its point."""
    if isinstance(group, TurnedLink) and isinstance(group.turning, Turning) and group.turning.drive is None:
        bases = {group.turning.link, group.turning.relative_to} - {group.link}
        return max(points.get(group.pivot, number), *(links.get(base, number) for base in bases))
    return number


@dataclass(frozen=True)
class Rank:
    """Sorting key of the bodies at a point."""

    order: Mapping[str, int]
    sliders: set[str]
    guided: set[str | None]

    def __call__(self, body: str) -> tuple[int, int]:
        special = 0 if body in self.sliders else 1 if body in self.guided else 2
        return self.order[body], special
