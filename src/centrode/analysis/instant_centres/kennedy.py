"""Instant centres constructed at one position: joints first, then Aronhold's and Kennedy's theorem.

Of three bodies in relative motion the three instant centres lie on one line (Aronhold 1872, Kennedy 1886). A
centre is where two such lines meet. The circle diagram has the bodies on a circle and a chord for each known
centre: a chord that closes two triangles is found.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import combinations
from math import sqrt
from typing import Literal, Protocol, TypeAlias

import numpy as np
import xarray as xr

from centrode.analysis.instant_centres.bodies import (
    ROUNDED,
    Array,
    BodyMotions,
    Named,
    Pair,
    TurningBodies,
    bodies_of,
    is_spherical,
    pole_of,
    refuse_batch,
    turning_bodies_of,
)
from centrode.analysis.instant_centres.centres import (
    PrimaryGearing,
    PrimaryJoint,
    gearings_of,
    joints_of,
    number_pairs,
    order_pair,
    place_of,
    upward,
)
from centrode.errors import InputError
from centrode.locale import _
from centrode.model.values import unit_vector

# What a construction of instant centres gives: its steps in their order.

How: TypeAlias = Literal["hinge", "guide", "rolling", "gear", "kennedy", "together", "rest", "field"]


@dataclass(frozen=True)
class KennedyStep:
    """Step of the construction that gives one centre.

    Attributes
    ----------
    pair : numbers of the two bodies, the later first
    how : "hinge", "guide" (at infinity square to it, on the sphere its pole), "rolling" (contact), "gear",
        "kennedy" (two lines), "together" (its two neighbours lie in one place), "rest" (no relative motion),
        "field" (the velocity field, where Kennedy's theorem is not enough)
    name : of the hinge, guide, wheel or gear
    by : numbers of the bodies whose lines meet, or by whose centres the step was made
    place : (x, y) [m], None at infinity and at rest; on the sphere (x, y, z) of one end of the axis
    direction : unit vector towards a centre at infinity, else None
    error : bound on rounding, as an angle between places seen from the mechanism's size
    """

    pair: Pair
    how: How
    name: str
    by: tuple[int, ...]
    place: tuple[float, ...] | None
    direction: tuple[float, ...] | None
    error: float


@dataclass(frozen=True)
class CentreConstruction:
    """Constructed centres of one position: `bodies` by number, `steps` in the order they were found.

    `mismatch` of a pair is the relative velocity left at its constructed centre, in the greatest velocity of
    the motion: zero to rounding.
    """

    bodies: tuple[str, ...]
    steps: tuple[KennedyStep, ...]
    mismatch: Mapping[Pair, float]

    def step(self, first: str, second: str) -> KennedyStep:
        """The step that found the centre of two bodies; raises InputError where there is none."""
        for step in self.steps:
            if {first, second} == {self.bodies[number] for number in step.pair}:
                return step
        raise InputError(
            "pair",
            _("there is no constructed centre of {first} and {second}").format(first=first, second=second),
        )

    def needed_steps(self, pairs: Sequence[Pair]) -> CentreConstruction:
        """The construction with those steps alone that lead to the centres of some pairs."""
        wanted: set[Pair] = {order_pair(pair) for pair in pairs}
        kept: list[KennedyStep] = []
        # backwards: a step leans on earlier ones only, so one pass meets all that are needed
        for step in reversed(self.steps):
            if step.pair in wanted:
                kept.append(step)
                wanted.update(order_pair((body, by)) for by in step.by for body in step.pair)
        steps = tuple(reversed(kept))
        return replace(self, steps=steps, mismatch={step.pair: self.mismatch[step.pair] for step in steps})


# Places and lines of the plane with its points at infinity, each with a bound on its rounding error.
#
# A place is a unit vector (x, y, w) in coordinates of the order of one, a line one with the places on it
# square to it. Errors are angles between unit vectors [rad]: the same for near places and for those at
# infinity.

Triple: TypeAlias = tuple[float, float, float]
EPS = sys.float_info.epsilon


@dataclass(frozen=True, slots=True)
class ProjectivePoint:
    """A place, perhaps at infinity, or a line, and a bound on its error."""

    vector: Triple
    error: float

    @property
    def at_infinity(self) -> bool:
        """Whether it cannot be distinguished from a place at infinity."""
        return abs(self.vector[2]) <= self.error


def spot(x: complex, w: float, error: float) -> ProjectivePoint:
    """A place x / w, or with w = 0 the place at infinity in a direction; the error is that of (x, w)."""
    length = sqrt(x.real * x.real + x.imag * x.imag + w * w)
    return ProjectivePoint((x.real / length, x.imag / length, w / length), error / length)


def cross(a: Triple, b: Triple) -> Triple:
    """Vector square to two others."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def dot(a: Triple, b: Triple) -> float:
    """Scalar product: zero where a place lies on a line."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def length(a: Triple) -> float:
    """Length of a vector."""
    return sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2])


def join_or_meet(first: ProjectivePoint, second: ProjectivePoint) -> ProjectivePoint | None:
    """The line through two places, or the place where two lines meet; None if they coincide within their errors."""
    normal = cross(first.vector, second.vector)
    sine = length(normal)
    # an error at least of one rounding, so that exact places do not seem to lie apart by their rounding
    unsure = first.error + second.error + EPS
    if sine <= unsure:
        return None
    # the product is off by what both are off, and scaling it up to length one scales that too
    return ProjectivePoint((normal[0] / sine, normal[1] / sine, normal[2] / sine), unsure / sine)


def differ(first: ProjectivePoint, second: ProjectivePoint) -> bool:
    """Whether two places lie further apart than their errors."""
    return join_or_meet(first, second) is not None


def best_crossing(
    lines: Sequence[tuple[ProjectivePoint, int]], worst: float
) -> tuple[ProjectivePoint, tuple[int, int]] | None:
    """Where the two lines meet that tell the place best, and which they are; nothing if it may be off by `worst`."""
    best: tuple[ProjectivePoint, tuple[int, int]] | None = None
    for (one, first), (other, second) in combinations(lines, 2):
        place = join_or_meet(one, other)
        # a step may use any two lines: the pair with the smallest error is taken, as a person takes the
        # steepest crossing
        if place is not None and place.error < (worst if best is None else best[0].error):
            best = place, (first, second)
    return best


# Where a construction of instant centres has its places: in the plane, or on the sphere.
#
# Both are places of the projective plane (see `projective`): a place of the plane with a weight, an axis
# through the centre of the sphere. Places of the sphere are seen along the direction of their middle and
# enlarged by the size of the mechanism, which keeps great circles lines, so that small linkages keep their
# accuracy.

Where: TypeAlias = tuple[float, ...]
SMALLEST = 16.0 * EPS


class Spots(Protocol):
    """Places of one position as spots, and back."""

    @property
    def bodies(self) -> Named:
        """The bodies at this position."""

    def shown(self, joint: PrimaryJoint, error: float) -> tuple[ProjectivePoint, Where | None]:
        """The centre that a joint shows, and its place where that is not to be read off the spot."""

    def read(self, where: ProjectivePoint) -> tuple[Where | None, Where | None]:
        """Place of a spot, or the direction in which it lies at infinity."""

    def gear_centre(
        self, gear: PrimaryGearing, wanted: str, known: Sequence[ProjectivePoint]
    ) -> ProjectivePoint | None:
        """The third centre of a gear: of the "first" or the "second" wheel against the carrier, or where they "mesh".

        The two others stand in this order; None where they do not determine it.
        """

    def pole(self, pair: Pair) -> Triple:
        """The velocity field of a pair as a place times its spin, in the greatest velocity."""


@dataclass(frozen=True)
class PlaneSpots:
    """Places of the plane about their middle, in the size of the mechanism."""

    bodies: BodyMotions

    @cached_property
    def middle(self) -> complex:
        """Middle of the bodies' places."""
        return complex(np.mean(self.bodies.place))

    @cached_property
    def size(self) -> float:
        """Unit of distances [m]: the mechanism's length, or the farthest body from the middle."""
        return max(self.bodies.scale, float(np.max(np.abs(self.bodies.place - self.middle))))

    def shown(self, joint: PrimaryJoint, error: float) -> tuple[ProjectivePoint, Where | None]:
        # places are measured from the middle: far from the origin of the axes the error would be that of the
        # distance
        place, at_infinity = place_of(joint, self.bodies)
        if at_infinity:
            return spot(place, 0.0, error), None
        return spot((place - self.middle) / self.size, 1.0, error), (place.real, place.imag)

    def read(self, where: ProjectivePoint) -> tuple[Where | None, Where | None]:
        x, w = complex(where.vector[0], where.vector[1]), where.vector[2]
        if where.at_infinity:
            towards = complex(upward(np.array(x / abs(x))))
            return None, (towards.real, towards.imag)
        at = self.middle + self.size * x / w
        return (at.real, at.imag), None

    def gear_centre(
        self, gear: PrimaryGearing, wanted: str, known: Sequence[ProjectivePoint]
    ) -> ProjectivePoint | None:
        """With A, B of the wheels on the carrier, P - A = i (P - B)."""
        # ratios of distances mean nothing with a centre at infinity
        if any(centre.at_infinity for centre in known):
            return None
        a, b = (complex(centre.vector[0], centre.vector[1]) / centre.vector[2] for centre in known)
        ratio = gear.ratio
        # where they mesh both wheels have one velocity against the carrier: w1 (P - A) = w2 (P - B), and w2 =
        # i w1
        x, w = {
            "first": (ratio * a + (1.0 - ratio) * b, 1.0),
            "second": (a - (1.0 - ratio) * b, ratio),
            "mesh": (a - ratio * b, 1.0 - ratio),
        }[wanted]
        # from places with weights to coordinates and back, and by the weights of a and b: errors grow by the
        # ratio
        error = _geared_error(gear, known)
        if abs(x) <= error and abs(w) <= EPS * abs(ratio):
            return None  # equal turns about one axis: at rest
        return spot(x, w, error)

    def pole(self, pair: Pair) -> Triple:
        moving, spin = self.bodies.relative(pair)
        rate = float(self.bodies.rate) or 1.0
        # scaled by the greatest velocity, so that one threshold serves all pairs
        turning = float(spin) * self.size / rate
        arm = (complex(self.bodies.place[pair[0]]) - self.middle) / self.size
        x = turning * arm + 1j * complex(moving) / rate
        return x.real, x.imag, turning


@dataclass(frozen=True)
class SphereSpots:
    """Axes through the centre of the sphere."""

    bodies: TurningBodies

    @cached_property
    def chart(self) -> Array:
        """Matrix that gives the coordinates of a spot: two enlarged across the middle, one along it."""
        # points of a position only in part reached are left out
        places = np.array([place for place in self.bodies.points.values() if np.isfinite(place).all()])
        middle = places.mean(axis=0) if len(places) else np.array([0.0, 0.0, 1.0])
        apart = float(np.linalg.norm(middle))
        along = middle / apart if apart > SMALLEST else np.array([0.0, 0.0, 1.0])
        # the axis of least share is farthest from parallel
        across = np.cross(along, np.eye(3)[int(np.argmin(np.abs(along)))])
        across /= np.linalg.norm(across)
        size = float(np.max(np.linalg.norm(places - middle, axis=1), initial=0.0)) if len(places) else 1.0
        # a mechanism over half the sphere is seen as it is; a small one is enlarged to the size of one
        size = min(1.0, size) if size > SMALLEST else 1.0
        return np.stack([across / size, np.cross(along, across) / size, along])

    @cached_property
    def rate(self) -> float:
        """Greatest angular velocity of a body as a spot."""
        return float(np.max(np.linalg.norm(self.bodies.spin @ self.chart.T, axis=-1))) or 1.0

    def shown(self, joint: PrimaryJoint, error: float) -> tuple[ProjectivePoint, Where | None]:
        bodies = self.bodies
        if joint.kind == "hinge":
            place = bodies.points[joint.name]
        else:
            guide = bodies.mechanism.guide(joint.name)
            inside = np.array(unit_vector(pole_of(bodies.mechanism, guide)))
            place = bodies.axes[bodies.number(guide.on)] @ inside
        x, y, w = self.chart @ place
        return spot(complex(x, y), float(w), error), tuple(map(float, place))

    def read(self, where: ProjectivePoint) -> tuple[Where | None, Where | None]:
        vector = np.linalg.solve(self.chart, np.array(where.vector))
        # of the two ends the one on the side of the mechanism
        vector *= (1.0 if where.vector[2] >= 0.0 else -1.0) / np.linalg.norm(vector)
        return tuple(map(float, vector)), None

    def gear_centre(
        self, gear: PrimaryGearing, wanted: str, known: Sequence[ProjectivePoint]
    ) -> ProjectivePoint | None:
        """With A, B where the wheels are hinged to the carrier, the wheels turn about A - i B against each other."""
        # the equation is between vectors: a centre is a line through the middle of the sphere, whose sense
        # only a hinge tells
        pivots = [_hinge(self.bodies, wheel, gear.carrier) for wheel in (gear.first, gear.second)]
        if wanted != "mesh" or None in pivots:
            return None
        a, b = (self.bodies.points[pivot] for pivot in pivots if pivot is not None)
        axis = a - gear.ratio * b
        error = _geared_error(gear, known)
        if np.linalg.norm(axis) <= error:
            return None  # equal turns about one axis: at rest
        x, y, w = self.chart @ axis
        return spot(complex(x, y), float(w), error)

    def pole(self, pair: Pair) -> Triple:
        x, y, w = self.chart @ self.bodies.relative(pair) / self.rate
        return float(x), float(y), float(w)


def _geared_error(gear: PrimaryGearing, known: Sequence[ProjectivePoint]) -> float:
    # The weights of both pivots are at most 1 + |ratio|. A unit vector that is off by e gives a place a that is off by
    # (1 + |a|^2) e: 2 e at the rim of the mechanism, 4 e at 1.7 of its sizes from its middle. Greatest error of 60 000
    # random cases over this without its 4: 1.9 within one size, 3.6 within 1.7, 9.3 within three, where pivots are not
    # expected.
    return sum(centre.error for centre in known) * (1.0 + abs(gear.ratio)) * 4.0


def _hinge(bodies: TurningBodies, wheel: int, carrier: int) -> str | None:
    """The point in which a wheel is hinged to its carrier."""
    # hinged to each other, both name the point
    own, held = (bodies.mechanism.points_of(bodies.names[number]) for number in (wheel, carrier))
    return next((name for name in own if name in held), None)


def spots_of(bodies: Named) -> Spots:
    """The places of one position of a planar or a spherical motion."""
    if isinstance(bodies, TurningBodies):
        return SphereSpots(bodies)
    assert isinstance(bodies, BodyMotions)
    return PlaneSpots(bodies)


Derived: TypeAlias = "tuple[Pair, ProjectivePoint | None, How, str, tuple[int, ...]]"

MOST_BODIES = 40
"""Bodies of one construction: its work grows as their cube."""
ROUNDINGS = 16.0 * EPS
"""Error of a place of the motion, in the size of the mechanism, besides its residual."""
UNSURE = 1e-6
"""A crossing that may be off by more is not used: its lines all but coincide in this position."""


def construct_centres(
    motion: xr.Dataset, sample: int = 0, pairs: Sequence[tuple[str, str]] | None = None
) -> CentreConstruction:
    """Construct the instant centres at one sample of a motion, as on paper.

    Joints show the primary centres; the others follow from Aronhold's and Kennedy's theorem. Places only are
    used, no velocities, so that it is independent of `instant_centres`. Where the theorem is not enough (groups
    of higher class, several drives, positions in which the lines coincide) the velocity field gives one
    centre, which the step says, and the construction goes on with it.

    Parameters
    ----------
    motion : Dataset
        As `motion` returns it; of a batch, one mechanism.
    pairs : sequence of (body, body), optional
        Only the steps that lead to these; all if left out.

    Raises
    ------
    InputError
        No position at the sample, more than 40 bodies, an unknown body.

    Notes
    -----
    On the sphere a centre is an axis through the centre of the sphere, and the three axes of three bodies lie in
    one plane: they meet the sphere on one great circle. `place` of a step is one of its two ends.
    """
    refuse_batch(motion)
    everything = turning_bodies_of(motion) if is_spherical(motion) else bodies_of(motion)
    wanted = None if pairs is None else number_pairs(everything, pairs)
    if len(everything.names) > MOST_BODIES:
        raise InputError(
            "pair",
            _("the construction handles at most {most} bodies, this mechanism has {count}").format(
                most=MOST_BODIES, count=len(everything.names)
            ),
            _("use the centres from the velocity field, which are given for any pair"),
        )
    if not -len(everything.rate) <= sample < len(everything.rate):
        raise InputError("sample", _("there is no sample {sample}").format(sample=sample))
    if not np.isfinite(everything.rate[sample]):
        raise InputError(
            "at", _("the mechanism has no position with velocities there"), _("choose another sample")
        )
    residual = float(motion["residual"][sample])
    construction = _Constructing(spots_of(everything.sample(sample)), residual).run()
    return construction if wanted is None else construction.needed_steps(wanted)


class _Constructing:
    """Centres known so far at one position."""

    def __init__(self, spots: Spots, residual: float) -> None:
        self.spots = spots
        self.bodies = spots.bodies
        # the residual of the position is an error of its places
        self.start = ROUNDINGS + residual
        self.gears = gearings_of(self.bodies.mechanism, self.bodies)
        self.known: dict[Pair, ProjectivePoint | None] = {}  # None: at rest against each other
        self.steps: list[KennedyStep] = []

    def run(self) -> CentreConstruction:
        """Find all centres."""
        for joint in joints_of(self.bodies.mechanism, self.bodies):
            self._see(joint)
        self._lock()
        everything = [order_pair(pair) for pair in combinations(range(len(self.bodies.names)), 2)]
        unknown = [pair for pair in everything if pair not in self.known]
        while unknown:
            # all of a round before any is noted: no step leans on one of its own round, as in the circle
            # diagram
            derived = [step for step in map(self._derive_centre, unknown) if step is not None]
            # one centre of the velocity field at a time: it may be all that Kennedy's theorem lacked
            for pair, where, how, name, by in derived or [self._centre_of_velocities(unknown)]:
                if where is None:
                    self._rest(pair, by)
                else:
                    self._note(pair, where, how, name, by)
            unknown = [pair for pair in unknown if pair not in self.known]
        mismatch = {step.pair: self._mismatch(step.pair) for step in self.steps}
        return CentreConstruction(self.bodies.names, tuple(self.steps), mismatch)

    def _see(self, joint: PrimaryJoint) -> None:
        """Take in the centre that a joint shows."""
        where, place = self.spots.shown(joint, self.start)
        before = self.known.get(joint.pair)
        if joint.pair not in self.known:
            self._note(joint.pair, where, joint.kind, joint.name, at=place)
        # two hinges in two places
        elif before is not None and differ(before, where):
            self._rest(joint.pair, ())  # joined twice, the bodies cannot move against each other

    def _lock(self) -> None:
        """Three bodies whose joints show centres that are not on a line cannot move against each other."""
        rigid: set[Pair] = set()
        for triple in combinations(range(len(self.bodies.names)), 3):
            pairs = [order_pair(pair) for pair in combinations(triple, 2)]
            one, other, third = (self.known.get(pair) for pair in pairs)
            if one is None or other is None or third is None:
                continue
            # the centres are coplanar as vectors where they are on a line: the product of all three is then
            # zero
            volume = abs(dot(cross(one.vector, other.vector), third.vector))
            if volume > one.error + other.error + third.error + EPS:
                rigid.update(pairs)
        for pair in sorted(rigid):
            self._rest(pair, ())

    def _note(
        self,
        pair: Pair,
        where: ProjectivePoint,
        how: How,
        name: str = "",
        by: tuple[int, ...] = (),
        at: Where | None = None,
    ) -> None:
        self.known[pair] = where
        place, direction = self.spots.read(where)
        place = place if at is None else at
        self.steps.append(KennedyStep(pair, how, name, by, place, direction, where.error))

    def _rest(self, pair: Pair, by: tuple[int, ...]) -> None:
        self.known[pair] = None
        # a later finding overrides: the earlier step of the pair is taken out
        self.steps = [step for step in self.steps if step.pair != pair]
        self.steps.append(KennedyStep(pair, "rest", "", by, None, None, self.start))

    def _derive_centre(self, pair: Pair) -> Derived | None:
        """A centre from what is known: a gear, a body at rest against one of the two, lines that meet."""
        for gear in self.gears:
            where, third = self._by_gear(gear, pair)
            if where is not None:
                return pair, where, "gear", gear.name, (third,)
        lines: list[tuple[ProjectivePoint, int]] = []
        together: list[tuple[ProjectivePoint, int]] = []
        for third, one, other in self._thirds(pair):
            if one is None or other is None:
                # a body at rest against one of the pair moves as that one does: its centre with the other is
                # the pair's
                moving = other if one is None else one
                return pair, moving, "together" if moving is not None else "rest", "", (third,)
            line = join_or_meet(one, other)
            if line is None:
                # both centres with the third in one place: all three are there, the line through them has no
                # direction
                together.append((min(one, other, key=lambda s: s.error), third))
            else:
                lines.append((line, third))
        # two places that both stand still against each other leave no relative motion
        if len(together) > 1 and differ(together[0][0], together[1][0]):
            return pair, None, "rest", "", tuple(third for _place, third in together[:2])
        if together:
            return pair, together[0][0], "together", "", (together[0][1],)
        best = best_crossing(lines, UNSURE)
        return None if best is None else (pair, best[0], "kennedy", "", best[1])

    def _thirds(self, pair: Pair) -> Iterator[tuple[int, ProjectivePoint | None, ProjectivePoint | None]]:
        """Bodies whose centres with both of a pair are known."""
        for third in range(len(self.bodies.names)):
            if third in pair:
                continue
            legs = [order_pair((body, third)) for body in pair]
            if all(leg in self.known for leg in legs):
                yield third, self.known[legs[0]], self.known[legs[1]]

    def _by_gear(self, gear: PrimaryGearing, pair: Pair) -> tuple[ProjectivePoint | None, int]:
        """The third centre of a gear, from those of the other two pairs."""
        legs = {
            "first": order_pair((gear.first, gear.carrier)),
            "second": order_pair((gear.second, gear.carrier)),
            "mesh": order_pair((gear.first, gear.second)),
        }
        wanted = next((name for name, leg in legs.items() if leg == pair), None)
        # the step leans on the centres of the third wheel or carrier with both of the pair
        third = next((n for n in (gear.first, gear.second, gear.carrier) if n not in pair), gear.carrier)
        others = [self.known.get(leg) for name, leg in legs.items() if name != wanted]
        known = [centre for centre in others if centre is not None]
        if wanted is None or len(known) < 2:
            return None, third
        return self.spots.gear_centre(gear, wanted, known), third

    def _centre_of_velocities(self, unknown: Sequence[Pair]) -> Derived:
        """A centre from the velocity field, the frame's first, where one line is known already if there is such."""
        lines = {pair: sum(1 for _third in self._thirds(pair)) for pair in unknown}
        pair = min(unknown, key=lambda pair: (pair[1] != 0, lines[pair] == 0, pair))
        pole = self.spots.pole(pair)
        if length(pole) <= ROUNDED:
            return pair, None, "rest", "", ()
        return pair, spot(complex(pole[0], pole[1]), pole[2], self.start), "field", "", ()

    def _mismatch(self, pair: Pair) -> float:
        """Relative velocity at the constructed centre, in the greatest of the motion."""
        pole, where = self.spots.pole(pair), self.known[pair]
        return length(pole if where is None else cross(pole, where.vector))
