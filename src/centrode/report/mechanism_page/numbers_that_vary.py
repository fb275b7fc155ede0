"""What a page lets its reader change by default: lengths of links, places of joints in links and in the frame."""

from __future__ import annotations

import math
from collections.abc import Iterator

from centrode.kinematics.preparation import ready
from centrode.locale import _
from centrode.model.files import value_at
from centrode.model.mechanism import FRAME, Mechanism
from centrode.model.values import Vector

STRETCH = 2.0
"""A length goes from a half to the double."""
AROUND = 0.5
"""A coordinate goes as far on both sides, in the greatest length."""
FLAT = 1e-12
"""A coordinate below this part of the greatest length is zero: the joint lies on its link's own axis."""

Ranges = dict[str, tuple[float, float]]


def ranges_of(mechanism: Mechanism) -> Ranges:
    """Path of a number -> its range [SI], in the order of the description.

    A joint at the origin of its link stays there, and one on an axis of its link stays on it; a point where nothing is
    hinged, as a centre of mass, stays where it is.
    """
    scale = float(ready(mechanism).kinematics.numbers.scale)
    found: Ranges = {}
    for path, is_size in _paths(mechanism, FLAT * scale):
        value = value_at(mechanism, path)
        if is_size:
            ends = sorted((value / STRETCH, value * STRETCH))
        else:
            ends = [value - AROUND * scale, value + AROUND * scale]
        if mechanism.space == "sphere" and is_size:
            ends[1] = min(ends[1], 0.99 * math.pi)
        found[path] = (ends[0], ends[1])
    return found


def _paths(mechanism: Mechanism, flat: float) -> Iterator[tuple[str, bool]]:
    """Paths, and whether the number is a length, which keeps its sign."""
    joints = joints_of(mechanism)
    for name, link in mechanism.links.items():
        if link.length is not None:
            yield f"links.{name}.length", True
        elif mechanism.space == "plane":
            for point, place in link.coordinates.items():
                if point in joints:
                    yield from _coordinates(f"links.{name}.points.{point}", place, flat)
    axes = ("longitude", "latitude") if mechanism.space == "sphere" else ("x", "y")
    for name in mechanism.frame.points:
        if name not in joints:  # it only tells where angles are measured from
            continue
        yield from ((f"frame.points.{name}.{axis}", False) for axis in axes)
    if mechanism.space == "plane":
        yield from ((path, False) for path in _lines(mechanism))


def _coordinates(path: str, place: Vector, flat: float) -> Iterator[tuple[str, bool]]:
    sizes = [abs(value) > flat for value in place]
    on_axis = sum(sizes) == 1
    for axis, stands_off in zip("xy", sizes, strict=True):
        if stands_off:
            yield f"{path}.{axis}", on_axis


def _lines(mechanism: Mechanism) -> Iterator[str]:
    """How far the lines of the frame's guides stand off, along the axis that they cross."""
    for guide in mechanism.guides:
        if guide.on == FRAME and isinstance(guide.through, tuple):
            x, y = guide.unit
            yield f"guides.{guide.id}.through.{'y' if abs(x) >= abs(y) else 'x'}"


def joints_of(mechanism: Mechanism) -> set[str]:
    """Points where something is hinged or guided, and those that lines and circles pass through or turn about."""
    fixed = set(mechanism.frame.points)
    owners: dict[str, int] = {}
    for link in mechanism.links.values():
        for point in link.coordinates:
            owners[point] = owners.get(point, 0) + 1
    guided = {guide.point for guide in mechanism.guides}
    guided |= {end for drive in mechanism.drives for end in drive.distance or ()}
    guided |= {wheel.centre for wheel in mechanism.rolling}
    named = [place for guide in mechanism.guides for place in (guide.through, guide.pole)]
    named += [wheel.along.centre for wheel in mechanism.rolling]
    guided |= {place for place in named if isinstance(place, str)}
    return guided | {point for point, count in owners.items() if count > 1 or point in fixed}


def name_of(mechanism: Mechanism, path: str) -> str:
    """What a reader calls a number: "AB" of a length, "C: x" of a coordinate; its path where it is something else."""
    words = path.split(".")
    axis = {"longitude": _("longitude"), "latitude": _("latitude")}.get(words[-1], words[-1])
    if words[0] == "links" and words[-1] == "length":
        return ".".join(words[1:-1])
    if words[0] == "links" and len(words) == 5 and words[2] == "points":
        return f"{words[1]}: {words[3]} {axis}"
    if words[0] == "frame" and len(words) == 4:
        return f"{words[2]}: {axis}"
    if words[0] == "guides" and words[-2] == "through":
        return f"{'.'.join(words[1:-2])}: {axis}"
    return path
