"""Points and guides that stand where the chain puts them in the initial position."""

from __future__ import annotations

import math
from functools import cached_property
from typing import TypeVar

from centrode.locale import _
from centrode.model.description import Description
from centrode.model.links import Frame, Guide
from centrode.model.look_alikes import look_alike
from centrode.model.reading import (
    FRAME,
    FrozenMap,
    Place,
    Problem,
    Problems,
    error_at_place,
    likely,
    value_text,
)
from centrode.model.values import (
    Placed,
    Vector,
    axes,
    longitude_latitude,
    makes_arc,
    tangent_towards,
    transfer_vector,
    turned_about,
    unit_vector,
)

# Positions that follow from the fixed points and the links' initial angles, link by link.


def chain_of(mechanism: Description) -> InitialChain:
    """The chain of a mechanism in its space."""
    return SphericalChain(mechanism) if mechanism.space == "sphere" else InitialChain(mechanism)


class InitialChain:
    """Positions that follow from the fixed points and the initial angles, link by link in description order."""

    def __init__(self, mechanism: Description) -> None:
        self.mechanism = mechanism
        self.points: dict[str, Vector] = {}
        self.poses: dict[str, tuple[Vector, float]] = {}
        for name, position in mechanism.frame.points.items():
            at = position.at if isinstance(position, Placed) else position
            if at is not None:
                self.points[name] = at
        self.fixed = tuple(self.points)
        while any([self._pose(name) for name in mechanism.links if name not in self.poses]):
            pass

    def _pose(self, name: str) -> bool:
        """Pose a link that has an initial angle and a known point, and with it all its points."""
        local = self.mechanism.links[name].coordinates
        angle = self.mechanism.initial_angle(name)
        known = next((point for point in local if point in self.points), None)
        if angle is None or known is None:
            return False
        x, y = rotate_vector(local[known], angle)
        origin = self.points[known][0] - x, self.points[known][1] - y
        self.poses[name] = origin, angle
        for point, coordinates in local.items():
            dx, dy = rotate_vector(coordinates, angle)
            self.points.setdefault(point, (origin[0] + dx, origin[1] + dy))
        return True

    def local(self, link: str, position: Vector) -> Vector:
        """A position in the axes of a link that is posed, or of the frame."""
        if link == FRAME:
            return position
        (x, y), angle = self.poses[link]
        return rotate_vector((position[0] - x, position[1] - y), -angle)

    def problem(self, point: str, at: Place, link: str = "") -> Problem:
        """That the chain does not reach a point, naming the links on its shortest way that lack an angle."""
        way = [*self._ways.get(point, ()), *([link] if link else [])]
        missing = [name for name in dict.fromkeys(way) if self.mechanism.initial_angle(name) is None]
        what = _("{point} cannot be placed: no chain of links connects it to the frame").format(
            point=value_text(point)
        )
        if not missing:
            names = [name for name in self.mechanism.points if name != point]
            mistyped = look_alike(point, names) is not None
            return Problem(what, likely(point, names) if mistyped else _("give its coordinates"), at)
        return Problem(what, _("give the initial angle of {links}").format(links=", ".join(missing)), at)

    @cached_property
    def _ways(self) -> dict[str, tuple[str, ...]]:
        """Links on the shortest way from the fixed points to every point that can be reached."""
        ways: dict[str, tuple[str, ...]] = dict.fromkeys(self.fixed, ())
        waiting = list(self.fixed)
        for point in waiting:
            for name, link in self.mechanism.links.items():
                if point in link.coordinates:
                    for other in link.coordinates:
                        if other not in ways:
                            ways[other] = (*ways[point], name)
                            waiting.append(other)
        return ways


class SphericalChain(InitialChain):
    """The same on the unit sphere, in longitudes and latitudes [rad]."""

    def _pose(self, name: str) -> bool:
        """Put the points of a link whose first point, reference and initial angle are known."""
        link, angle = self.mechanism.links[name], self.mechanism.initial_angle(name)
        points, reference = list(link.coordinates), link.reference or ()
        if angle is None or len(points) < 2 or not reference or not {*reference} <= self.points.keys():
            return False
        pivot, towards = (unit_vector(self.points[point]) for point in reference)
        local = [unit_vector(place) for place in link.coordinates.values()]
        if not (makes_arc(pivot, towards) and makes_arc(local[0], local[1])):
            return False
        forward = turned_about(pivot, tangent_towards(pivot, towards), angle)
        mine, theirs = axes(local[0], tangent_towards(local[0], local[1])), axes(pivot, forward)
        for point, place in zip(points, local, strict=True):
            self.points.setdefault(point, longitude_latitude(transfer_vector(place, mine, theirs)))
        self.poses[name] = self.points[points[0]], angle
        return True


def rotate_vector(vector: Vector, angle: float) -> Vector:
    """A vector turned by an angle [rad]."""
    cosine, sine = math.cos(angle), math.sin(angle)
    return vector[0] * cosine - vector[1] * sine, vector[0] * sine + vector[1] * cosine


M = TypeVar("M", bound=Description)


def place(mechanism: M) -> M:
    """The mechanism with what is still to be placed put where the chain of initial angles puts it.

    Raises
    ------
    InputError
        The chain does not reach it; the message names the link whose initial angle is missing.
    """
    try:
        frame, guides = resolve_placement(mechanism)
    except Problems as error:
        raise error_at_place(error.problems[0], (), "") from None
    if frame == mechanism.frame and guides == mechanism.guides:
        return mechanism
    return mechanism.model_copy(update={"frame": frame, "guides": guides})


def replace_placed(mechanism: M) -> M:
    """The mechanism with everything `placed` put anew, by the links' lengths and initial angles as they are now."""
    points = {
        name: Placed() if isinstance(position, Placed) else position
        for name, position in mechanism.frame.points.items()
    }
    guides = tuple(_forget_line(guide) for guide in mechanism.guides)
    update = {"frame": Frame(points=points), "guides": guides}
    return place(mechanism.model_copy(update=update))


def _forget_line(guide: Guide) -> Guide:
    if not isinstance(guide.through, Placed):
        return guide
    return guide.model_copy(update={"through": Placed()})


def resolve_placement(mechanism: Description) -> tuple[Frame, tuple[Guide, ...]]:
    """Frame and guides with nothing left to place; raises Problems that name the missing angles."""
    points = mechanism.frame.points
    open_points = [name for name, position in points.items() if position == Placed()]
    open_guides = [index for index, guide in enumerate(mechanism.guides) if guide.needs_place]
    if not (open_points or open_guides):
        return mechanism.frame, mechanism.guides
    chain = chain_of(mechanism)
    problems = [
        chain.problem(name, ("frame", "points", name)) for name in open_points if name not in chain.points
    ]
    lines: dict[int, Vector] = {}
    for index in open_guides:
        guide = mechanism.guides[index]
        at: Place = ("guides", index, "through")
        if guide.on != FRAME and guide.on not in chain.poses:
            problems.append(chain.problem(next(iter(mechanism.links[guide.on].coordinates)), at, guide.on))
        elif guide.point not in chain.points:
            problems.append(chain.problem(guide.point, at))
        else:
            lines[index] = chain.local(guide.on, chain.points[guide.point])
    if problems:
        raise Problems(problems)
    frame = {name: Placed(chain.points[name]) if name in open_points else points[name] for name in points}
    guides = tuple(
        guide.model_copy(update={"through": Placed(lines[index])}) if index in lines else guide
        for index, guide in enumerate(mechanism.guides)
    )
    return mechanism.frame.model_copy(update={"points": FrozenMap(frame)}), guides
