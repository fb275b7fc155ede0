"""Where two loci meet: places by closed forms, their derivatives by the linear equations of each order."""

from __future__ import annotations

from collections.abc import Sequence

from centrode.algebra.bends import Bent, Cells
from centrode.algebra.jets import Jet
from centrode.geometry import sphere
from centrode.geometry.moving import (
    AtDistance,
    Number,
    OnLine,
    Place,
    bent,
    followed,
    less,
    times,
    total,
    value,
    values,
)
from centrode.geometry.plane import (
    Circle,
    Line,
    Root,
    Vector,
    circle_meets_line,
    circles_meet,
    radicand_of_circle_and_line,
    radicand_of_circles,
)


def meet_circles(one: Circle, other: Circle, root: Root) -> Vector:
    """Point where two circles meet, to the left of the way from centre to centre for a positive root."""
    radicand = radicand_of_circles(one, other)
    signed = root(radicand)
    if not isinstance(radicand, Jet):
        return circles_meet(one, other, signed)
    place = circles_meet(_circle(one), _circle(other), value(signed))
    loci = [AtDistance(locus.centre, locus.radius * locus.radius, place) for locus in (one, other)]
    # the cross product of the arms is half the root
    inverse = 2.0 / value(signed)
    x, y = followed(place, loci, lambda known: _in_plane(loci, known, inverse), radicand.order)
    if isinstance(radicand, Bent):
        cells = radicand.cells
        x, y = bent((x, y), loci, _across(loci, cells), 0.5 * cells.m.sqrt(radicand.least), cells)
    return x, y


def meet_circle_and_line(one: Circle, other: Line, root: Root) -> Vector:
    """Point where a circle meets a line, ahead of the foot of its centre for a positive root."""
    radicand = radicand_of_circle_and_line(one, other)
    signed = root(radicand)
    if not isinstance(radicand, Jet):
        return circle_meets_line(one, other, signed)
    line = Line(_vector(other.through), _vector(other.direction))
    place = circle_meets_line(_circle(one), line, value(signed))
    loci = (
        AtDistance(one.centre, one.radius * one.radius, place), OnLine(other.through, other.direction, place)
    )  # fmt: skip
    # the cross product of the arm and the line's normal is the way from the foot
    inverse = 1.0 / value(signed)
    x, y = followed(place, loci, lambda known: _in_plane(loci, known, inverse), radicand.order)
    if isinstance(radicand, Bent):
        cells = radicand.cells
        x, y = bent((x, y), loci, _across(loci, cells), cells.m.sqrt(radicand.least), cells)
    return x, y


def meet_circles_on_sphere(
    centre_1: sphere.Vector,
    half_1: sphere.HalfArc,
    centre_2: sphere.Vector,
    half_2: sphere.HalfArc,
    root: Root,
) -> sphere.Vector:
    """Place where two circles meet, to the left of the arc centre_1 -> centre_2 for a positive root."""
    radicand = sphere.radicand_of_circles(centre_1, half_1, centre_2, half_2)
    signed = root(radicand)
    if not isinstance(radicand, Jet):
        return sphere.circles_meet(centre_1, half_1, centre_2, half_2, signed)
    (at_1, arc_1), (at_2, arc_2) = (
        (values(centre), values(half)) for centre, half in ((centre_1, half_1), (centre_2, half_2))
    )
    place = sphere.circles_meet(at_1, arc_1, at_2, arc_2, value(signed))
    # chords are differences of places, so small linkages keep their relative accuracy
    one, other = (
        AtDistance(centre, 4.0 * half[0] * half[0], place)
        for centre, half in ((centre_1, half_1), (centre_2, half_2))
    )
    unit = AtDistance((0.0, 0.0, 0.0), 1.0, place)
    # the triple product of both chords and the place is that of the three places: the root
    inverse = 1.0 / value(signed)
    towards = (
        sphere.cross(other.gradient, place),
        sphere.cross(place, one.gradient),
        sphere.cross(one.gradient, other.gradient),
    )

    def solved(known: Sequence[Number]) -> Place:
        shares = [times(inverse, x) for x in known]
        return [
            total(times(share, way[axis]) for share, way in zip(shares, towards, strict=True))
            for axis in range(3)
        ]

    x, y, z = followed(place, (one, other, unit), solved, radicand.order)
    if isinstance(radicand, Bent):
        cells = radicand.cells
        across = _across((one, other), cells)
        ways = (*across, across[0] * across[1])
        x, y, z = bent((x, y, z), (one, other, unit), ways, cells.m.sqrt(radicand.least), cells)
    return x, y, z


def _across(loci: Sequence[AtDistance | OnLine], cells: Cells) -> tuple[Number, Number]:
    """How far each of two loci can move the place it holds: by the length of the other's gradient."""
    one, other = (locus.reach(cells) for locus in loci)
    return other, one


def _in_plane(loci: Sequence[AtDistance | OnLine], known: Sequence[Number], inverse: Number) -> Vector:
    """The vector whose products with two gradients are known; `inverse` is that of their cross product."""
    a, b = (locus.gradient for locus in loci)
    of_first, of_second = (times(inverse, x) for x in known)
    return (
        less(times(of_first, b[1]), times(of_second, a[1])),
        less(times(of_second, a[0]), times(of_first, b[0])),
    )


def _vector(vector: Vector) -> Vector:
    return value(vector[0]), value(vector[1])


def _circle(circle: Circle) -> Circle:
    return Circle(_vector(circle.centre), value(circle.radius))
