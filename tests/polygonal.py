"""Loaded examples for forces by hand, and what rounding may leave of their equations."""

from __future__ import annotations

import centrode as ct
from burdened import burdened
from centrode.dynamics.force_polygons.polygons import ForcePolygons
from centrode.kinematics.preparation import ready
from centrode.structure.dimensions import dimensions_of
from mechanisms import EPS, parts_of

OPERATIONS = 64
"""Roundings in a row between a force and the balancing moment."""
TYPICAL = ("RRR", "RRP", "RPR", "PRP", "RPP", "triad", "together", "single", "input")
PLANE = [name for name in ct.example_names() if ct.example(name).space == "plane"]


def loaded(name: str) -> ct.Mechanism:
    """An example with random masses and loads of every kind."""
    example = ct.example(name)
    parts = parts_of(example)
    for part in ("machine", "study", "display"):
        parts.pop(part, None)
    parts.setdefault("frame", {}).setdefault("points", {})
    for guide in parts.setdefault("guides", []):
        guide.setdefault("name", guide["point"])
    for link, body in parts["links"].items():
        body["points"] = {point: list(at) for point, at in example.links[link].coordinates.items()}
        for key in ("length", "shape", "radius", "mass", "centre", "inertia"):
            body.pop(key, None)
    parts = burdened(parts, 1)
    if len(example.drives) > 1:
        for load in parts["loads"]:
            if isinstance(load.get("vector", [0])[0], str):
                load["vector"] = ["2*x", "-v"]  # the drive's value has no single meaning
    return ct.Mechanism(**parts)


def an_instant(mechanism: ct.Mechanism) -> float:
    """A value of the drive, or a time, a little beyond the initial position."""
    path = ready(mechanism).kinematics.path
    if path.by_time or mechanism.drives[0].speed is None:
        return 0.7
    return path.initial + path.forward * path.unit * (0.3 if mechanism.drives[0].kind == "angle" else 0.06)


def size_of(found: ForcePolygons) -> tuple[float, float]:
    """What rounding of forces [N] and of moments [N m] is measured by."""
    outer = sum(abs(one.force) for one in found.outer)
    forces = outer + sum(map(abs, found.reactions.values()))
    reach = float(dimensions_of(found.mechanism).scale)
    reach = max(reach, *(abs(a - b) for a in found.places.values() for b in found.places.values()))
    turning = sum(abs(one.moment) for one in found.outer) + sum(map(abs, found.moments.values()))
    return forces, forces * reach + turning


def assert_routes_agree(found: ForcePolygons) -> None:
    forces, moments = size_of(found)
    for drive in found.mechanism.drives:
        size = moments if drive.kind == "angle" else moments / float(dimensions_of(found.mechanism).scale)
        routes = [lever.balancing for lever in found.levers if lever.drive == drive.id]
        routes += [found.work[drive.id]] if drive.id in found.work else []
        for value in routes:
            assert abs(value - found.balancing[drive.id]) <= OPERATIONS * EPS * max(size, forces)


def assert_closed(found: ForcePolygons) -> None:
    forces, _moments = size_of(found)
    for group in found.groups:
        for polygon in (group.polygon, *group.link_polygons):
            assert abs(polygon.gap) <= OPERATIONS * EPS * forces
