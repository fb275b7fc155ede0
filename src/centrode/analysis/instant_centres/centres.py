"""Instant centres from the relative velocity field, for every pair of bodies and every sample of a motion."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from enum import IntEnum
from itertools import combinations
from typing import Literal, TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.analysis.instant_centres.bodies import (
    ROUNDED,
    Array,
    BodyMotions,
    Named,
    Pair,
    Places,
    TurningBodies,
    bodies_of,
    is_spherical,
    turning_bodies_of,
    vectors,
)
from centrode.errors import InputError
from centrode.kinematics.motion import labels_of, vocabulary_variable
from centrode.kinematics.solve import GREATEST_RESULT
from centrode.locale import _, mark
from centrode.model.mechanism import FRAME, Guide, Mechanism, Rolling

# Primary instant centres: those that a joint shows, without any construction.

Kind: TypeAlias = Literal["hinge", "guide", "rolling"]


@dataclass(frozen=True)
class PrimaryJoint:
    """Two bodies joined so that their centre is seen: in a hinge, square to a guide, where a wheel touches."""

    kind: Kind
    name: str
    pair: Pair


@dataclass(frozen=True)
class PrimaryGearing:
    """A gear ties three centres: with two of those of its wheels and its carrier the third is known."""

    name: str
    first: int
    second: int
    carrier: int
    ratio: float


def joints_of(mechanism: Mechanism, bodies: Named) -> tuple[PrimaryJoint, ...]:
    """Hinges, guides and rolling wheels, in the order of the points, the guides and the wheels."""
    joints: list[PrimaryJoint] = []
    for point in mechanism.points:
        joints += [
            # what is hinged at one point is hinged pair by pair: of n bodies n (n - 1) / 2 centres lie there
            PrimaryJoint("hinge", point, order_pair(pair))
            for pair in combinations(carriers(bodies, point), 2)
        ]
    for guide in mechanism.guides:
        slid = guide.link if guide.link is not None else slider_of(bodies, guide)
        joints.append(
            PrimaryJoint("guide", guide.id, order_pair((bodies.number(slid), bodies.number(guide.on))))
        )
    for wheel in mechanism.rolling:
        pair = order_pair((bodies.number(wheel.link), bodies.number(wheel.on)))
        joints.append(PrimaryJoint("rolling", wheel.id, pair))
    return tuple(joints)


def gearings_of(mechanism: Mechanism, bodies: Named) -> tuple[PrimaryGearing, ...]:
    """Gears as ties between centres."""
    return tuple(
        PrimaryGearing(
            gear.id,
            bodies.number(gear.links[0]),
            bodies.number(gear.links[1]),
            bodies.number(gear.carrier),
            gear.ratio,
        )
        for gear in mechanism.gears
    )


def order_pair(pair: Pair) -> Pair:
    """A pair as it is named: the later body against the earlier one."""
    return max(pair), min(pair)


def carriers(bodies: Named, point: str) -> list[int]:
    """Bodies that are hinged at a point: links and the frame that name it, and its sliders."""
    mechanism = bodies.mechanism
    names = [FRAME] if point in mechanism.frame.points else []
    names += [name for name, link in mechanism.links.items() if point in link.coordinates]
    names += [name for name, guide in bodies.sliders.items() if guide.point == point]
    return [bodies.number(name) for name in names]


def slider_of(bodies: Named, guide: Guide) -> str:
    """Name of the slider of a guide."""
    return next(name for name, own in bodies.sliders.items() if own.id == guide.id)


def place_of(joint: PrimaryJoint, bodies: BodyMotions) -> tuple[complex, bool]:
    """Where a primary centre is at one sample, or its direction if it is at infinity (then True)."""
    if joint.kind == "hinge":
        return point_at(bodies, joint.name), False
    if joint.kind == "guide":
        guide = bodies.mechanism.guide(joint.name)
        along = complex(*guide.unit) * np.exp(1j * bodies.turn[bodies.number(guide.on)])
        return complex(1j * along), True
    wheel = next(wheel for wheel in bodies.mechanism.rolling if wheel.id == joint.name)
    return contact_of(wheel, bodies), False


def point_at(bodies: BodyMotions, point: str) -> complex:
    """Place of a named point at one sample."""
    mechanism = bodies.mechanism
    # a point of the frame, or of a slider, has a place without any link: its owner is looked for only after
    # these
    if point in mechanism.frame.points:
        return complex(*mechanism.frame.coordinates[point])
    for name, guide in bodies.sliders.items():
        if guide.point == point:
            return complex(bodies.place[bodies.number(name)])
    owner = next(name for name, link in mechanism.links.items() if point in link.coordinates)
    return bodies.place_in_frame(bodies.number(owner), mechanism.links[owner].coordinates[point])


def contact_of(wheel: Rolling, bodies: BodyMotions) -> complex:
    """Where a wheel touches its track at one sample: the foot of its centre on it."""
    mechanism, on = bodies.mechanism, bodies.number(wheel.on)
    centre, track = point_at(bodies, wheel.centre), wheel.along
    if track.through is not None:
        along = complex(*track.unit) * np.exp(1j * bodies.turn[on])
        start = bodies.place_in_frame(on, track.through)
        return start + complex(((centre - start) * np.conj(along)).real * along)
    own = track.centre
    local = mechanism.points_of(wheel.on)[own] if isinstance(own, str) else own
    middle = bodies.place_in_frame(on, local or (0.0, 0.0))
    radius = track.radius or 0.0
    # a ring around its pin touches on the far side of the pin
    far = -1.0 if track.inside and wheel.radius > radius else 1.0
    return middle + far * radius * (centre - middle) / abs(centre - middle)


def rolling_pairs(mechanism: Mechanism, bodies: Named) -> Iterator[Pair]:
    """Pairs that roll on each other: wheels on their tracks, and geared links on their pitch circles."""
    for wheel in mechanism.rolling:
        yield order_pair((bodies.number(wheel.link), bodies.number(wheel.on)))
    for gear in mechanism.gears:
        yield order_pair((bodies.number(gear.links[0]), bodies.number(gear.links[1])))


# How the instant centre of a body is located: the cases of the textbooks, recognised and named.

Kinds: TypeAlias = npt.NDArray[np.int8]
Mask: TypeAlias = npt.NDArray[np.bool_]


class Case(IntEnum):
    """Case of an instant centre by the velocities of two points of a body, seen from another one."""

    ABSENT = 0
    REST = 1
    HINGE = 2
    ROLLING = 3
    DIRECTIONS = 4
    SAME_SENSE = 5
    OPPOSITE_SENSE = 6
    TRANSLATION = 7
    STANDSTILL = 8

    @property
    def word(self) -> str:
        """Name of the case in tables, in English."""
        return _WORDS[self]

    @property
    def sentence(self) -> str:
        """Name of the case in tables, in the chosen language."""
        return _(_WORDS[self])


_WORDS: Mapping[Case, str] = {
    Case.ABSENT: mark("no position"),
    Case.REST: mark("at rest relative to each other"),
    Case.HINGE: mark("common hinge"),
    Case.ROLLING: mark("rolling contact"),
    Case.DIRECTIONS: mark("two velocity directions"),
    Case.SAME_SENSE: mark("parallel velocities, same sense"),
    Case.OPPOSITE_SENSE: mark("parallel velocities, opposite sense"),
    Case.TRANSLATION: mark("equal velocities: translation"),
    Case.STANDSTILL: mark("a point at rest"),
}


class Recogniser:
    """Names the cases of pairs of bodies over a motion."""

    def __init__(self, bodies: BodyMotions) -> None:
        self.bodies = bodies
        joints = joints_of(bodies.mechanism, bodies)
        self.hinged = {joint.pair for joint in joints if joint.kind == "hinge"}
        self.rolling = set(rolling_pairs(bodies.mechanism, bodies))

    def cases(self, pair: Pair) -> Kinds:
        """Case of a pair at every sample."""
        bodies = self.bodies
        moving, spin = bodies.relative(pair)
        slow = ROUNDED * bodies.rate
        still = np.abs(spin) * bodies.scale <= slow
        cases = self._by_velocities(pair, moving, spin, slow)
        # from weaker to stronger: what a joint shows overrides what velocities show, rest overrides both, and
        # where nothing is there no case holds
        if order_pair(pair) in self.rolling:
            cases[:] = Case.ROLLING
        if order_pair(pair) in self.hinged:
            cases[:] = Case.HINGE
        cases[still] = Case.TRANSLATION
        cases[still & (np.abs(moving) <= slow)] = Case.REST
        cases[~np.isfinite(np.abs(moving) + spin)] = Case.ABSENT
        return cases

    def _by_velocities(self, pair: Pair, moving: Places, spin: Array, slow: Array) -> Kinds:
        """Cases by the velocities of two points of the first body against the second."""
        bodies, first = self.bodies, pair[0]
        arm = bodies.second_place(first) - bodies.place[..., first]
        other = moving + 1j * spin * arm
        with np.errstate(invalid="ignore"):
            product = np.conj(moving) * other
            parallel = np.abs(product.imag) <= ROUNDED * np.abs(product)
        # perpendiculars to parallel velocities coincide: the line through the arrowheads cuts them in the
        # centre
        cases = np.full(moving.shape, Case.DIRECTIONS, dtype=np.int8)
        cases[parallel & (product.real > 0.0)] = Case.SAME_SENSE
        cases[parallel & (product.real <= 0.0)] = Case.OPPOSITE_SENSE
        cases[(np.abs(moving) <= slow) | (np.abs(other) <= slow)] = Case.STANDSTILL
        return cases


# Instantaneous axes of bodies that turn about the centre of a sphere, and how they are located.
#
# Where the axis of a relative rotation meets the sphere, two opposite places stand still: they are the
# instant centres of the sphere. The one about which the body turns counter-clockwise, seen from outside, is
# given.


def axis_of(bodies: TurningBodies, pair: Pair) -> Array:
    """End of the axis of a pair (..., samples, 3), a unit vector; NaN where nothing turns."""
    # the end about which the turn is counter-clockwise is the one the angular velocity points to
    spin = bodies.relative(pair)
    size = np.linalg.norm(spin, axis=-1)
    return np.asarray(spin / np.where(at_rest(bodies, pair), np.nan, size)[..., None])


def axis_speed(bodies: TurningBodies, pair: Pair, axis: Array) -> Array:
    """Relative angular velocity [rad/s] about the end of the axis that is given; zero where nothing turns."""
    speed = bodies.speed[..., pair[0], :] - bodies.speed[..., pair[1], :]
    about_axis = np.sum(speed * axis, axis=-1)
    # at rest there is no axis to project on: what is left is rounding, said as it is
    return np.asarray(np.where(at_rest(bodies, pair), np.linalg.norm(speed, axis=-1), about_axis))


def at_rest(bodies: TurningBodies, pair: Pair) -> Mask:
    """Whether two bodies do not move against each other, but for rounding."""
    size = np.linalg.norm(bodies.relative(pair), axis=-1)
    return np.asarray(size <= ROUNDED * bodies.rate)


def axis_cases(bodies: TurningBodies, pair: Pair) -> Kinds:
    """Case of a pair at every sample: the velocities of two places of the first body, seen from the second."""
    spin = bodies.relative(pair)
    slow = ROUNDED * bodies.rate
    one, other = (np.cross(spin, place) for place in bodies.two_places(pair[0]))
    sizes = [np.linalg.norm(velocity, axis=-1) for velocity in (one, other)]
    product = np.sum(one * other, axis=-1)
    # both square to one great circle: the axis lies on it, beyond or between the places
    parallel = np.linalg.norm(np.cross(one, other), axis=-1) <= ROUNDED * sizes[0] * sizes[1]
    cases = np.full(slow.shape, Case.DIRECTIONS, dtype=np.int8)
    cases[parallel & (product > 0.0)] = Case.SAME_SENSE
    cases[parallel & (product <= 0.0)] = Case.OPPOSITE_SENSE
    cases[(sizes[0] <= slow) | (sizes[1] <= slow)] = Case.STANDSTILL
    mechanism = bodies.mechanism
    if order_pair(pair) in set(rolling_pairs(mechanism, bodies)):
        cases[:] = Case.ROLLING
    if order_pair(pair) in {
        joint.pair for joint in joints_of(mechanism, bodies)
    }:  # a guide's pole is a hinge too
        cases[:] = Case.HINGE
    cases[at_rest(bodies, pair)] = Case.REST
    cases[~np.isfinite(spin).all(axis=-1)] = Case.ABSENT
    return cases


NUMBERS = 5
"""Numbers of a result for each pair and sample."""


def instant_centres(motion: xr.Dataset, pairs: Sequence[tuple[str, str]] | None = None) -> xr.Dataset:
    """Instant centres of velocity of pairs of bodies at the samples of a motion.

    Parameters
    ----------
    motion : Dataset
        As `motion` returns it; a batch too.
    pairs : sequence of (body, body), optional
        Names of links, "frame", or sliders ("slider C": a point on a guide without a link of its own). All
        pairs by default, each the later body against the earlier one.

    Returns
    -------
    Dataset
        `centre` (sample, pair, axis) [m], NaN where it lies at infinity; `centre_direction` (sample, pair,
        axis), there the unit vector towards it; `centre_case` (sample, pair), the number of a `Case`. A pair
        is named "AC,frame". On the sphere `centre` is the end of the instantaneous axis (a unit vector) about
        which the first body turns counter-clockwise, seen from outside, as the drive's value (or time) grows;
        `relative_speed` (sample, pair) [rad/s] is how fast it does.

    Raises
    ------
    InputError
        Unknown or equal bodies, more than fits into memory.

    Notes
    -----
    A relative spin below eps^(2/3) of the motion's greatest velocity over its greatest length is none: the
    centre is then at infinity. A centre is as exact as the velocities over the relative spin.

    Examples
    --------
    >>> import centrode as ct
    >>> motion = ct.motion(ct.example("crank-rocker"), at=[1.0])
    >>> centres = ct.instant_centres(motion, [("AB", "frame")])
    >>> centres.centre.values.round(3).tolist()
    [[[2.972, 4.629]]]
    """
    bodies = turning_bodies_of(motion) if is_spherical(motion) else bodies_of(motion)
    numbers = number_pairs(bodies, pairs)
    _check_size(bodies, len(numbers))
    spherical = isinstance(bodies, TurningBodies)
    located = _axes(bodies, numbers) if isinstance(bodies, TurningBodies) else _centres(bodies, numbers)
    front = tuple(map(str, motion["status"].dims))
    labels = [f"{bodies.names[first]},{bodies.names[second]}" for first, second in numbers]
    variables = {
        name: vocabulary_variable(
            name, (*front, "pair", "axis")[: values.ndim], values, length_unit="rad" if spherical else "m"
        )
        for name, values in located.items()
    }
    variables["centre_case"][2]["flag_values"] = np.array([case.value for case in Case], dtype=np.int8)
    variables["centre_case"][2]["flag_meanings"] = " ".join(case.name.lower() for case in Case)
    kept = motion[["status"]].assign_coords(drive_value=motion["drive_value"], axis=motion["axis"])
    centres = kept.assign_coords(pair=labels_of(tuple(labels))).assign(variables)
    # places of several mechanisms have no sheet
    return centres.assign_attrs(topic="centres") if centres["status"].dims == ("sample",) else centres


def _centres(bodies: BodyMotions, numbers: Sequence[Pair]) -> dict[str, Array]:
    """Centres of a planar motion: places, directions of those at infinity, cases."""
    recogniser = Recogniser(bodies)
    shape = (*bodies.rate.shape, len(numbers))
    centre, direction = np.full((*shape, 2), np.nan), np.full((*shape, 2), np.nan)
    cases = np.zeros(shape, dtype=np.int8)
    for column, pair in enumerate(numbers):
        cases[..., column] = recogniser.cases(pair)
        centre[..., column, :], direction[..., column, :] = _locate_centres(bodies, pair, cases[..., column])
    return {"centre": centre, "centre_direction": direction, "centre_case": cases}


def _axes(bodies: TurningBodies, numbers: Sequence[Pair]) -> dict[str, Array]:
    """Axes of a motion on the sphere: their ends, cases, relative speeds."""
    axes = [axis_of(bodies, pair) for pair in numbers]
    return {
        "centre": np.stack(axes, axis=-2),
        "centre_case": np.stack([axis_cases(bodies, pair) for pair in numbers], axis=-1),
        "relative_speed": np.stack(
            [axis_speed(bodies, pair, axis) for pair, axis in zip(numbers, axes, strict=True)], axis=-1
        ),
    }


def _locate_centres(bodies: BodyMotions, pair: Pair, cases: Array) -> tuple[Array, Array]:
    """Places of centres, and directions of those at infinity."""
    moving, spin = bodies.relative(pair)
    # in a translation the centre is at infinity, at rest any place is one
    finite = (cases != Case.ABSENT) & (cases != Case.REST) & (cases != Case.TRANSLATION)
    with np.errstate(divide="ignore", invalid="ignore"):
        place = bodies.place[..., pair[0]] + 1j * moving / spin
        towards = upward(1j * moving / np.abs(moving))
    return (
        vectors(np.where(finite, place, np.nan)),
        vectors(np.where(cases == Case.TRANSLATION, towards, np.nan)),
    )


def upward(direction: Places) -> Places:
    """Of the two senses of a direction the one that points up, or to the right."""
    # -0.0 points neither up nor down: the real part decides
    down = (direction.imag < 0.0) | ((direction.imag == 0.0) & (direction.real < 0.0))
    return np.asarray(np.where(down, -direction, direction))


def line_direction(direction: Sequence[float]) -> float:
    """Angle [deg] of the line in a direction, at least 0 and less than 180; rounding is taken off."""
    angle = float(np.degrees(np.arctan2(direction[1], direction[0]))) % 180.0
    return 0.0 if min(angle, 180.0 - angle) < 1e-9 else angle


def number_pairs(bodies: Named, pairs: Sequence[tuple[str, str]] | None) -> list[Pair]:
    """Pairs by the numbers of their bodies; all of them, the later body against the earlier one, if left out."""
    if pairs is None:
        return [(second, first) for first, second in combinations(range(len(bodies.names)), 2)]
    numbers = []
    for first, second in pairs:
        pair = bodies.number(first), bodies.number(second)
        if pair[0] == pair[1]:
            what = _("{name} has no centre relative to itself")
            if first == FRAME:
                what = _("the frame has no centre relative to itself")
            raise InputError("pair", what.format(name=first), _("name two bodies"))
        numbers.append(pair)
    return numbers


def _check_size(bodies: Named, pairs: int) -> None:
    samples = int(bodies.rate.size)
    if NUMBERS * pairs * samples > GREATEST_RESULT:
        raise InputError(
            "pairs",
            _("{pairs} pairs at {samples} samples are more than fits into memory").format(
                pairs=pairs, samples=samples
            ),
            _('name the pairs that matter, as in pairs=[("AC", "frame")], or choose fewer samples'),
        )
