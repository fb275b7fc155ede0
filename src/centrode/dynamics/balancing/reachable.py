"""Which links hinges alone join to the frame, and where counterweights on them are measured from.

By the theorem of contours a linkage can be balanced fully by counterweights only if every link is reached from the
frame by a way through hinges alone (F. R. Tepper, G. G. Lowen, Journal of Engineering for Industry 94, 1972, 789-796).
"""

from __future__ import annotations

from collections.abc import Mapping

from centrode.model.mechanism import Mechanism


def hinged_from(mechanism: Mechanism) -> Mapping[str, str]:
    """Links reached by hinges alone, nearest to the frame first, each with the point by which it is reached."""
    bodies = {name: tuple(link.coordinates) for name, link in mechanism.links.items()}
    known = set(mechanism.frame.points)
    reached: dict[str, str] = {}
    while True:
        found = {
            name: next(point for point in points if point in known)
            for name, points in bodies.items()
            if name not in reached and known & set(points)
        }
        if not found:
            return reached
        reached |= found
        known |= {point for name in found for point in bodies[name]}


def base_of(mechanism: Mechanism, link: str) -> str:
    """The point that the radius of a counterweight is measured from, where nothing else is said."""
    return hinged_from(mechanism).get(link) or next(iter(mechanism.links[link].coordinates))


def on_frame(mechanism: Mechanism) -> list[str]:
    """Links that are hinged to the frame."""
    return [name for name, base in hinged_from(mechanism).items() if base in mechanism.frame.points]
