"""Where circles and lines meet, in the plane or on the sphere, and how meeting points move.

The formulas hold over any algebra.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any, Protocol, TypeAlias

from centrode.geometry import sphere
from centrode.geometry.plane import (
    Line,
    PlaneCircle,
    Root,
    Vector,
    circle_meets_line,
    circles_meet,
    is_literal_zero,
    radicand_of_circle_and_line,
    radicand_of_circles,
)
from centrode.numerics.bends import Bent, Cells, VectorBend, least_bound, plus
from centrode.numerics.jets import Jet

# Points that move: what a locus says of a point's next coefficient, the ones before being known.
#
# What the k-th derivative of a locus says of the k-th coefficient of a point is linear in it, and the
# gradients are the same for all orders: those of the velocities. So no closed form needs to be
# differentiated, and derivatives of any order cost a third of what that would take. Textbook: Uicker,
# Pennock, Shigley, Theory of Machines and Mechanisms, the method of kinematic coefficients (loop equations
# differentiated); any order: Griewank and Walther, Evaluating Derivatives (2nd ed., 2008), chapters 13 and
# 15.

Number: TypeAlias = Any
Place: TypeAlias = Sequence[Number]


class MovingLocus(Protocol):
    """A locus that a moving point stays on."""

    @property
    def gradient(self) -> Place:
        """Gradient of the locus by the coordinates of the point, the factor of each of its coefficients."""

    def motion(self, hold: Hold) -> Number:
        """A number whose derivatives are those of the point, multiplied by the gradient; its value says nothing."""

    def next(self, k: int) -> Number:
        """The gradient multiplied by the point's k-th coefficient, those before being known."""

    def add(self, coefficient: Place, k: int) -> None:
        """Take the point's k-th coefficient."""

    def pull(self, cells: Cells) -> Pull:
        """Bound over cells of the gradient multiplied by the point's acceleration, its velocity being known."""

    def hold(self, pull: Pull, acceleration: Number, cells: Cells) -> tuple[Place, Number] | None:
        """Direction in which a locus that stands still holds the point, and the bound of its acceleration there."""

    def reach(self, cells: Cells) -> Number:
        """Bound of the gradient's length over cells."""


Pull: TypeAlias = tuple[Number, Number, Number]
"""Coefficients of a bound that grows with that of the point's acceleration, B: of 1, B and B^2."""


class AtDistance:
    """A point at a distance from a centre: arm . arm = distance^2, the arm from the centre to the point."""

    def __init__(self, centre: Place, squared: Number, place: Place) -> None:
        self.centre, self.squared = centre, squared
        self.arm = [apart(place, values(centre))]
        self.gradient = self.arm[0]

    def motion(self, hold: Hold) -> Number:
        # of arm . arm = distance^2: arm . dx = arm . dc + d(distance^2) / 2
        arm = tuple(map(hold, self.gradient))
        return total((dot(arm, values(self.centre)), times(0.5, value(self.squared))))

    def next(self, k: int) -> Number:
        # half the k-th coefficient of arm . arm: its outer terms are the gradient's, the inner ones are known
        known = dot(self.gradient, coefficients(self.centre, k))
        # gradient . x_k = gradient . c_k + ((r^2)_k - inner) / 2
        inner = total(dot(self.arm[i], self.arm[k - i]) for i in range(1, k))
        return total((known, times(0.5, less(coefficient(self.squared, k), inner))))

    def add(self, coefficient: Place, k: int) -> None:
        self.arm.append(apart(coefficient, coefficients(self.centre, k)))

    def pull(self, cells: Cells) -> Pull:
        """Of arm . (x'' - c'') = (r^2)''/2 - |x' - c'|^2."""
        moved = bend(self.centre, cells)
        carried, share = times(self.reach(cells), moved), 0.0
        vector = shared_bend(self.centre)
        if vector is not None and vector.direction is not None:
            # the arm turns within the cell, so the direction that the centre is held in lets through a little more
            turned = plus(times(cells.half, length(self.arm[1], cells)), times(cells.sagitta, moved))
            close = plus(project_acceleration(self.arm[0], vector, cells), times(turned, moved))
            closer = cells.m.less(close, carried)
            carried = cells.m.where(closer, close, carried)
            share = cells.m.where(closer, times(cells.sagitta, moved), 0.0)
        # |x' - c'| anywhere in the cell: at the centre, grown by half (A + C), with the part of A left to the
        # coefficients
        velocity = plus(length(self.arm[1], cells), times(cells.half, bend(self.centre, cells)))
        known = plus(plus(carried, times(0.5, bend((self.squared,), cells))), times(velocity, velocity))
        # of (v + half A)^2: v^2, 2 half v A and half^2 A^2
        return known, plus(share, times(2.0 * cells.half, velocity)), cells.half * cells.half

    def hold(self, pull: Pull, acceleration: Number, cells: Cells) -> tuple[Place, Number] | None:
        """How a fixed centre holds the point along the arm, a bound of its acceleration being known."""
        if any(isinstance(x, Jet) for x in (*self.centre, self.squared)):
            return None
        known, linear, squared = pull
        pulled = plus(known, plus(times(linear, acceleration), times(squared, acceleration * acceleration)))
        # arm . x'' is bounded with the arm as it lies anywhere in the cell, and wanted with the arm in the middle
        turned = plus(times(cells.half, length(self.arm[1], cells)), times(cells.sagitta, acceleration))
        size = length(self.arm[0], cells)
        direction = tuple(x / size for x in self.arm[0])
        return direction, plus(pulled, times(turned, acceleration)) / size

    def reach(self, cells: Cells) -> Number:
        # the arm is as long as the radius
        return cells.m.sqrt(self.squared.most if isinstance(self.squared, Bent) else self.squared)


class OnLine:
    """A point on a line in the plane: normal . arm = 0, the arm from a point of the line to the point."""

    def __init__(self, through: Place, direction: Place, place: Place) -> None:
        self.through, self.direction = through, direction
        self.arm = [apart(place, values(through))]
        self.gradient = self._normal(0)

    def motion(self, hold: Hold) -> Number:
        # of n . arm = 0: n . dx = n . dt - dn . arm
        normal, arm = tuple(map(hold, self.gradient)), tuple(map(hold, self.arm[0]))
        return less(dot(normal, values(self.through)), dot(self.gradient, arm))

    def next(self, k: int) -> Number:
        known = dot(self.gradient, coefficients(self.through, k))
        # the k-th coefficient of normal . arm, solved for that of the point
        return less(known, total(dot(self._normal(i), self.arm[k - i]) for i in range(1, k + 1)))

    def add(self, coefficient: Place, k: int) -> None:
        self.arm.append(apart(coefficient, coefficients(self.through, k)))

    def pull(self, cells: Cells) -> Pull:
        """Of n . (x'' - t'') = -2 n' . (x' - t') - n'' . (x - t)."""
        line, turn = bend(self.through, cells), bend(self.direction, cells)
        if all(not isinstance(x, Jet) for x in self.direction):
            # a direction that stands still has no rate: two terms vanish
            return line, 0.0, 0.0
        rate = plus(length(self._normal(1), cells), times(cells.half, turn))
        velocity = plus(length(self.arm[1], cells), times(cells.half, line))
        # how far the point is from the line's own point, anywhere in the cell
        away = plus(
            length(self.arm[0], cells),
            plus(times(cells.half, length(self.arm[1], cells)), times(cells.sagitta, line)),
        )
        known = plus(line, plus(times(2.0 * rate, velocity), times(turn, away)))
        return known, plus(times(2.0 * rate, cells.half), times(turn, cells.sagitta)), 0.0

    def hold(self, pull: Pull, acceleration: Number, cells: Cells) -> tuple[Place, Number] | None:
        """A line that stands still holds the point square to it altogether."""
        if any(isinstance(x, Jet) for x in (*self.through, *self.direction)):
            return None
        x, y = self.gradient
        return (x, y), 0.0

    def reach(self, cells: Cells) -> Number:
        return 1.0

    def _normal(self, k: int) -> Place:
        x, y = coefficients(self.direction, k)
        return less(0.0, y), x


def place_series(
    place: Place, loci: Sequence[MovingLocus], solved: Callable[[Sequence[Number]], Place], order: int
) -> tuple[Jet, ...]:
    """A place as series, one for each axis; `solved` gives the vector whose products with the gradients are known."""
    # every locus hands over its k-th equation, the point's coefficient answers, and each takes it for the
    # next order
    series = [tuple(place)]
    for k in range(1, order + 1):
        series.append(tuple(solved([locus.next(k) for locus in loci])))
        for locus in loci:
            locus.add(series[k], k)
    return tuple(Jet(axis) for axis in zip(*series, strict=True))


def bound_acceleration(
    place: Sequence[Jet],
    loci: Sequence[MovingLocus],
    ways: Sequence[Number],
    determinant: Number,
    cells: Cells,
) -> tuple[Bent, ...]:
    """A place that was followed, with a bound of its acceleration over cells.

    The acceleration is the sum of what the loci pull at it, each along its way: `ways` bound the lengths of these,
    `determinant` is what the determinant of the gradients does not fall below. A bound B of the acceleration is one of
    the velocity's change as well, on which the pulls depend: it is the least with B determinant = sum of all.
    """
    sums: list[Number] = [0.0, 0.0, 0.0]
    pulls = [locus.pull(cells) for locus in loci]
    for pull, way in zip(pulls, ways, strict=True):
        # ways times pulls, coefficient by coefficient: what does not depend on B, what B multiplies, and B^2
        sums = [plus(one, times(way, other)) for one, other in zip(sums, pull, strict=True)]
    known, linear, squared = sums
    # B determinant = known + linear B + squared B^2
    least = least_bound(known, determinant - linear, squared, cells.m)
    vector = _held_bend(loci, pulls, least, cells) if cells.holds else None
    return tuple(Bent(axis.coefficients[0], axis.coefficients[1], least, cells, vector) for axis in place)


def _held_bend(
    loci: Sequence[MovingLocus], pulls: Sequence[Pull], acceleration: Number, cells: Cells
) -> VectorBend:
    """What is known of a place's acceleration: what a fixed link holds stays held.

    Bounds of lengths alone would grow from group to group.
    """
    held = (locus.hold(pull, acceleration, cells) for locus, pull in zip(loci, pulls, strict=True))
    return VectorBend(acceleration, *next(filter(None, held), (None, None)))


def shared_bend(place: Place) -> VectorBend | None:
    """What is known of a place's acceleration as a whole, if its coordinates are numbers of one vector."""
    first = place[0]
    return first.vector if isinstance(first, Bent) else None


def project_acceleration(arm: Place, vector: VectorBend, cells: Cells) -> Number:
    """Bound of a plain vector's product with an acceleration that is bounded closer in one direction."""
    assert vector.direction is not None
    along = dot(arm, vector.direction)
    across = apart(arm, tuple(times(along, x) for x in vector.direction))
    return plus(times(cells.m.abs(along), vector.along), times(length(across, cells), vector.length))


def bend(place: Place, cells: Cells) -> Number:
    """Bound of a place's acceleration over cells."""
    vector = shared_bend(place)
    if vector is not None:
        return vector.length
    return length([x.bend for x in place if isinstance(x, Bent)], cells)


def length(place: Place, cells: Cells) -> Number:
    """Length of a vector of plain numbers; infinite numbers have infinite ones."""
    some = [x for x in place if not is_literal_zero(x)]
    if not some:
        return 0.0
    return cells.m.abs(some[0]) if len(some) == 1 else cells.m.sqrt(total(x * x for x in some))


def value(x: Number) -> Number:
    """A number without its derivatives."""
    return x.value if isinstance(x, Jet) else x


def values(place: Place) -> tuple[Number, ...]:
    """A place without its derivatives."""
    return tuple(value(x) for x in place)


def coefficient(x: Number, k: int) -> Number:
    """The k-th coefficient; plainly zero of what stands still."""
    if isinstance(x, Jet):
        return x.coefficients[k]
    return 0.0 if k else x


def coefficients(place: Place, k: int) -> tuple[Number, ...]:
    """The k-th coefficient of a place."""
    return tuple(coefficient(x, k) for x in place)


# arithmetic in which what is plainly zero costs nothing


def times(a: Number, b: Number) -> Number:
    """Product."""
    return 0.0 if is_literal_zero(a) or is_literal_zero(b) else a * b


def less(a: Number, b: Number) -> Number:
    """Difference."""
    if is_literal_zero(b):
        return a
    return -b if is_literal_zero(a) else a - b


def total(terms: Iterable[Number]) -> Number:
    """Sum."""
    summed: Number = 0.0
    for term in terms:
        summed = term if is_literal_zero(summed) else summed if is_literal_zero(term) else summed + term
    return summed


def dot(a: Place, b: Place) -> Number:
    """Scalar product."""
    return total(times(x, y) for x, y in zip(a, b, strict=True))


def apart(a: Place, b: Place) -> tuple[Number, ...]:
    """Vector from b to a."""
    return tuple(less(x, y) for x, y in zip(a, b, strict=True))


def meet_circles(one: PlaneCircle, other: PlaneCircle, root: Root) -> Vector:
    """Point where two circles meet, to the left of the way from centre to centre for a positive root."""
    radicand = radicand_of_circles(one, other)
    signed = root(radicand)
    if not isinstance(radicand, Jet):
        return circles_meet(one, other, signed)
    # the place is found from values alone; all derivatives follow from the linear equations
    place = circles_meet(_circle(one), _circle(other), value(signed))
    loci = [_moving_locus(locus, place) for locus in (one, other)]
    # the cross product of the arms is half the root
    inverse, gradients = 2.0 / value(signed), [locus.gradient for locus in loci]
    x, y = place_series(place, loci, lambda known: _in_plane(gradients, known, inverse), radicand.order)
    if isinstance(radicand, Bent):
        cells = radicand.cells
        # half the root at its least bounds the cross product of the arms
        x, y = bound_acceleration(
            (x, y), loci, _across(loci, cells), 0.5 * cells.m.sqrt(radicand.least), cells
        )
    return x, y


def meet_circle_and_line(one: PlaneCircle, other: Line, root: Root) -> Vector:
    """Point where a circle meets a line, ahead of the foot of its centre for a positive root."""
    radicand = radicand_of_circle_and_line(one, other)
    signed = root(radicand)
    if not isinstance(radicand, Jet):
        return circle_meets_line(one, other, signed)
    line = Line(_vector(other.through), _vector(other.direction))
    place = circle_meets_line(_circle(one), line, value(signed))
    loci = [_moving_locus(locus, place) for locus in (one, other)]
    # the cross product of the arm and the line's normal is the way from the foot
    inverse, gradients = 1.0 / value(signed), [locus.gradient for locus in loci]
    x, y = place_series(place, loci, lambda known: _in_plane(gradients, known, inverse), radicand.order)
    if isinstance(radicand, Bent):
        cells = radicand.cells
        x, y = bound_acceleration((x, y), loci, _across(loci, cells), cells.m.sqrt(radicand.least), cells)
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
    one, other = _about_chord(centre_1, half_1, place), _about_chord(centre_2, half_2, place)
    # the place stays a unit vector: the third equation
    unit = AtDistance((0.0, 0.0, 0.0), 1.0, place)
    # the triple product of both chords and the place is that of the three places: the root
    inverse, gradients = 1.0 / value(signed), (one.gradient, other.gradient)
    x, y, z = place_series(
        place, (one, other, unit), lambda known: _on_sphere(gradients, place, known, inverse), radicand.order
    )
    if isinstance(radicand, Bent):
        cells = radicand.cells
        across = _across((one, other), cells)
        # the third way is the product of both chords' lengths, as the place is a unit vector
        ways = (*across, across[0] * across[1])
        x, y, z = bound_acceleration((x, y, z), (one, other, unit), ways, cells.m.sqrt(radicand.least), cells)
    return x, y, z


# Meeting points as implicit functions of their loci: formulas that have the derivatives of a meeting point.
#
# What a locus says of the derivatives of a point is linear in them, and so is the answer: a way for each locus, times
# the motion of that. Ways are held, and what is left are a few products in place of the derivatives of the closed
# form. Griewank and Walther, Evaluating Derivatives (2nd ed., 2008), section 15.1.

Hold: TypeAlias = Callable[[Number], Number]
"""Gives a number as one without derivatives."""


def implied_meeting(
    one: PlaneCircle, other: PlaneCircle | Line, place: Vector, root: Number, hold: Hold
) -> Vector:
    """Where a circle meets another locus in the plane, as an implicit function of both; see `Space.implied_place`."""
    loci = [_moving_locus(locus, place) for locus in (one, other)]
    (a, b), (c, d) = (locus.gradient for locus in loci)
    # half the cross product of the gradients is the root of two circles, of a circle and a line it is the root itself
    inverse = (1.0 if isinstance(other, Line) else 2.0) / root
    ways = (
        (times(inverse, d), times(inverse, less(0.0, c))),
        (times(inverse, less(0.0, b)), times(inverse, a)),
    )
    x, y = _moved_place(place, loci, ways, hold)
    return x, y


def implied_meeting_on_sphere(
    circles: Sequence[tuple[sphere.Vector, sphere.HalfArc]], place: sphere.Vector, root: Number, hold: Hold
) -> sphere.Vector:
    """Where two circles meet on the sphere, as an implicit function of both; see `Space.implied_place`."""
    loci = [_about_chord(*circle, place) for circle in circles]
    # the third equation, that the place is a unit vector, depends on no locus
    longer = sphere.times(1.0 / root, place)
    a, b = (locus.gradient for locus in loci)
    x, y, z = _moved_place(place, loci, (sphere.cross(b, longer), sphere.cross(longer, a)), hold)
    return x, y, z


def _moved_place(
    place: Place, loci: Sequence[AtDistance | OnLine], ways: Sequence[Place], hold: Hold
) -> Place:
    """A number for each axis of a place, with its derivatives: along a way for each locus, by the motion of this."""
    moved = [hold(x) for x in place]
    for locus, way in zip(loci, ways, strict=True):
        motion = locus.motion(hold)
        moved = [x + hold(y) * motion for x, y in zip(moved, way, strict=True)]
    return moved


def _moving_locus(locus: PlaneCircle | Line, place: Place) -> AtDistance | OnLine:
    if isinstance(locus, Line):
        return OnLine(locus.through, locus.direction, place)
    return AtDistance(locus.centre, locus.radius * locus.radius, place)


def _about_chord(centre: sphere.Vector, half: sphere.HalfArc, place: Place) -> AtDistance:
    # chords are differences of places, so small linkages keep their relative accuracy
    return AtDistance(centre, 4.0 * half[0] * half[0], place)


def _across(loci: Sequence[AtDistance | OnLine], cells: Cells) -> tuple[Number, Number]:
    """Reach of each of two loci over a cell: bound on the shift it gives, by the length of the other's gradient."""
    one, other = (locus.reach(cells) for locus in loci)
    return other, one


def _in_plane(gradients: Sequence[Place], known: Sequence[Number], inverse: Number) -> Vector:
    """The vector whose products with two gradients are known; `inverse` is that of their cross product."""
    a, b = gradients
    of_first, of_second = (times(inverse, x) for x in known)
    return (
        # Cramer's rule for two products
        less(times(of_first, b[1]), times(of_second, a[1])),
        less(times(of_second, a[0]), times(of_first, b[0])),
    )


def _on_sphere(
    gradients: Sequence[Any], place: sphere.Vector, known: Sequence[Number], inverse: Number
) -> sphere.Vector:
    """The vector whose products with two gradients and the place are known; `inverse` of their triple product."""
    a, b = gradients
    towards = sphere.cross(b, place), sphere.cross(place, a), sphere.cross(a, b)
    shares = [times(inverse, x) for x in known]
    x, y, z = (
        total(times(share, way[axis]) for share, way in zip(shares, towards, strict=True))
        for axis in range(3)
    )
    return x, y, z


def _vector(vector: Vector) -> Vector:
    return value(vector[0]), value(vector[1])


def _circle(circle: PlaneCircle) -> PlaneCircle:
    return PlaneCircle(_vector(circle.centre), value(circle.radius))
