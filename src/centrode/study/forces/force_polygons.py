"""Force polygons in words and tables: numbers of the bodies, loads, steps, every force with its length on paper."""

from __future__ import annotations

import cmath
import math
from typing import TYPE_CHECKING, TypeAlias

from centrode.locale import _
from centrode.model.labels import body_name, load_name

if TYPE_CHECKING:
    from centrode.dynamics.force_polygons.polygons import (
        ForcePolygons,
        GroupForces,
        Lever,
        Polygon,
        PolygonVector,
    )

Rows: TypeAlias = list[tuple[str, ...]]
NONE = 1e-13
"""What is smaller than this part of the greatest force is rounding of what is nothing."""
HEADS = (
    "polygon,bodies,order,name,on,source,label,force_x,force_y,force,direction,length_mm,"
    "start_x,start_y,end_x,end_y,place_x,place_y"
)


def polygon_about(found: ForcePolygons) -> list[tuple[str, str]]:
    """Numbers of the bodies, the speed, what F1 and M1 stand for."""
    said = [body_name(found.mechanism, name) for name in found.names]
    numbers = ", ".join(f"{number} {name}" for number, name in enumerate(said))
    loads = {
        one.symbol.partition("(")[0]: load_name(found.mechanism, one.label)
        for one in found.outer
        if one.source != "inertia"
    }
    return [
        (_("bodies"), numbers),
        (_("speed of the drive"), _speed(found)),
        (_("loads"), ", ".join(f"{symbol} {label}" for symbol, label in loads.items()) or _("none")),
    ]


def _speed(found: ForcePolygons) -> str:
    texts = []
    for drive in found.mechanism.drives:
        rate = found.speed[drive.id]
        unit = found.mechanism.motion_parameter.drive(drive.id).speed_unit
        texts.append(_("as the drive moves") if math.isnan(rate) else f"{rate:.6g} {unit}")
    text = ", ".join(texts)
    return (
        _("{speed}, the mean speed of the machine").format(speed=text)
        if found.speed_from == "machine"
        else text
    )


def group_title(group: GroupForces) -> str:
    """What a group is: "Group 4, 5 (RRP): DH, slider"."""
    numbers, names = ", ".join(map(str, group.numbers)), ", ".join(group.bodies)
    if group.kind == "input":
        return _("Input link {numbers}: {names}").format(numbers=numbers, names=names)
    if group.kind == "single":
        return _("Link {numbers} by itself: {names}").format(numbers=numbers, names=names)
    kind = {"together": _("solved together"), "triad": _("triad, by an Assur point")}.get(
        group.kind, group.kind
    )
    return _("Group {numbers} ({kind}): {names}").format(numbers=numbers, kind=kind, names=names)


def polygon_steps(found: ForcePolygons) -> list[str]:
    """What was done, group by group."""
    lines: list[str] = []
    for group in found.groups:
        lines += ["", group_title(group), *(f"  {line}" for line in group.steps)]
    return lines[1:]


def force_text(value: float) -> str:
    """A force as it is shown."""
    return f"{value:.6g}"


def polygon_rows(found: ForcePolygons) -> Rows:
    """Every vector of the polygons, heads first: polygon, force, N, direction, mm on paper."""
    heads = (_("polygon"), _("force"), "N", _("direction, deg"), "mm", "μ_F, N/mm")
    rows: Rows = [heads]
    for group in found.groups:
        for polygon in drawn_polygons(group):
            rows += _rows(found, polygon)
    return rows


def drawn_polygons(group: GroupForces) -> tuple[Polygon, ...]:
    """The polygon of a group; of one solved together those of its links."""
    return group.link_polygons if group.kind == "together" else (group.polygon,)


def _rows(found: ForcePolygons, polygon: Polygon) -> Rows:
    numbers = ", ".join(str(found.names.index(body)) for body in polygon.bodies)
    vectors = (*polygon.vectors, *polygon.sums, *polygon.chords)
    greatest = max((abs(vector.force) for vector in vectors), default=0.0)
    return [
        (
            numbers,
            vector.name,
            *_numbers(vector, greatest),
            f"{polygon.length(vector):.1f}",
            f"{polygon.scale:g}",
        )
        for vector in vectors
    ]


def _numbers(vector: PolygonVector, greatest: float) -> tuple[str, str]:
    size = abs(vector.force)
    if size <= NONE * greatest:
        return "0", "-"
    return force_text(size), f"{math.degrees(cmath.phase(vector.force)) + 0.0:.2f}"


def polygon_balance_rows(found: ForcePolygons) -> Rows:
    """The balancing moment or force of each drive by three routes, heads first."""
    heads = (
        _("drive"),
        _("unit"),
        _("force polygons"),
        _("Zhukovsky's lever"),
        _("virtual work"),
        _("apart"),
    )
    rows: Rows = [heads]
    levers = {lever.drive: lever.balancing for lever in found.levers}
    size = max((abs(force) for force in found.reactions.values()), default=0.0)
    for drive in found.mechanism.drives:
        routes = [found.balancing[drive.id], levers.get(drive.id), found.work.get(drive.id)]
        known = [value for value in routes if value is not None]
        apart = max(known) - min(known)
        none = NONE * max(size, *map(abs, known))
        shown = ["-" if value is None else _moment(value, none) for value in routes]
        unit = found.mechanism.motion_parameter.drive(drive.id).force_unit
        rows.append((drive.id, unit, *shown, "0" if apart == 0.0 else f"{apart:.1e}"))
    return rows


def _moment(value: float, none: float) -> str:
    return f"{value:.9g}" if abs(value) > none else "0"


def lever_lines(found: ForcePolygons, lever: Lever) -> list[str]:
    """Moments about the pole, force by force, and what balances them."""
    greatest = max((abs(one.moment) for one in lever.forces), default=0.0)
    lines = [
        f"{one.name}: {one.moment:.6g} {lever.unit}"
        for one in lever.forces
        if abs(one.moment) > NONE * greatest
    ]
    symbol = "Mb" if lever.unit == "N m" else "Fb"
    title = _("moments about the pole, per unit rate of drive {drive}").format(drive=lever.drive)
    balance = f"{symbol} = −Σ = {lever.balancing + 0.0:.6g} {lever.unit}"
    return [title, "", *lines, "", balance]


def polygon_csv(found: ForcePolygons) -> str:
    """Every vector as CSV in SI, every number in full: of groups ("group"), their inner reactions, and of links."""
    lines = [HEADS]
    for group in found.groups:
        lines += _lines("group", group.polygon, group.polygon.vectors)
        lines += _lines("sum", group.polygon, group.polygon.sums)
        lines += _lines("inner", group.polygon, group.polygon.chords)
        for polygon in group.link_polygons:
            lines += _lines("link", polygon, polygon.vectors)
    return "\n".join(lines) + "\n"


def _lines(kind: str, polygon: Polygon, vectors: tuple[PolygonVector, ...]) -> list[str]:
    found = []
    for order, one in enumerate(vectors, start=1):
        texts = [kind, "; ".join(polygon.bodies), str(order), one.name, one.body, one.source, one.label]
        numbers = [
            *(one.force.real, one.force.imag, abs(one.force)),
            *(cmath.phase(one.force), polygon.length(one)),
            *(one.start.real, one.start.imag, one.end.real, one.end.imag),
            *(one.place.real, one.place.imag),
        ]
        found.append(",".join([*map(_quoted, texts), *(repr(float(number)) for number in numbers)]))
    return found


def _quoted(text: str) -> str:
    return f'"{text}"' if "," in text else text
