"""Which parts of a mechanism hang together with the frame."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from centrode.model.description import Description
from centrode.model.names import FRAME

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
    reached = _reached(("link", FRAME), neighbours)
    parts = []
    for node in neighbours:
        if node not in reached:
            part = _reached(node, neighbours)
            reached |= part
            links = tuple(name for name in mechanism.links if ("link", name) in part)
            parts.append(
                LoosePart(links, tuple(name for name in mechanism.points if ("point", name) in part))
            )
    return tuple(parts)


def _reached(start: Node, neighbours: dict[Node, set[Node]]) -> set[Node]:
    reached, waiting = {start}, [start]
    while waiting:
        for node in neighbours[waiting.pop()]:
            if node not in reached:
                reached.add(node)
                waiting.append(node)
    return reached
