"""The motion of a follower over the angle of its cam: lift and derivatives of any order, and what joints do to them."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from math import isclose
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.cams.nodes import mesh
from centrode.errors import InputError, Status
from centrode.kinematics.motion import Variable, labels_of, vocabulary_variable
from centrode.kinematics.sample_index import selectable
from centrode.laws import CURVES, LawSegment, SegmentedLaw
from centrode.laws.segments import INNER_JUMPS
from centrode.locale import _, mark
from centrode.model.cam_files import AnyCam, cam_text, with_follower
from centrode.model.follower_cam import PlateCam
from centrode.model.reading import nearest, value_text
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.jets import Jet, JetFunctions
from centrode.numerics.rounding_bounds import ROUNDED, SAFETY, Rounded
from centrode.numerics.search import Extremes, extremes
from centrode.quantities import QUANTITIES
from centrode.version import __version__

Array = npt.NDArray[np.float64]
JETS = JetFunctions(ARRAYS)
MOST_ORDER = 20


@dataclass(frozen=True)
class FollowerMotion:
    """Lift of a follower, periodic in the angle of its cam.

    Attributes
    ----------
    law : SegmentedLaw
        Lift over the angle of the cam; one turn is its period.
    swings : bool
        Whether the lift is an angle [rad], that of an oscillating follower, else a displacement [m].
    speed : float [rad/s] or None
        Of the cam.
    """

    law: SegmentedLaw
    swings: bool = False
    speed: float | None = None

    def lift(self, phi: npt.ArrayLike, order: int = 0) -> Array:
        """Lift and its derivatives by the angle of the cam.

        Parameters
        ----------
        phi : (...) angles [rad], of any turn
        order : highest derivative, 0 to 20

        Returns
        -------
        (order + 1, ...) [m/rad^k or rad/rad^k]
            Exact derivatives of the formulas. At a joint those of the segment that begins there.

        Raises
        ------
        InputError
            An order out of bounds.
        """
        if order not in range(MOST_ORDER + 1):
            raise InputError(
                "order", _("give an order of derivatives from 0 to {most}").format(most=MOST_ORDER)
            )
        places = np.asarray(phi, dtype=np.float64)
        jet = self.law.jet(JETS, Jet.variable(places, order))
        return np.stack([np.broadcast_to(jet.derivative(k), places.shape) for k in range(order + 1)])

    @property
    def period(self) -> float:
        """A turn [rad]."""
        return self.law.period

    @cached_property
    def joints(self) -> tuple[float, ...]:
        """Where segments begin, and the end of the turn: len + 1 angles [rad] from 0."""
        return (0.0, *self.law.ends)

    @cached_property
    def edges(self) -> tuple[float, ...]:
        """Angles [rad] from 0 to the end of the turn between which the lift is one analytic formula."""
        return self.law.whole.breaks

    @property
    def unit(self) -> str:
        """SI unit of the lift."""
        return "rad" if self.swings else "m"


def follower_motion(cam: AnyCam) -> FollowerMotion:
    """The motion of the follower of a cam's description.

    Parameters
    ----------
    cam : PlateCam

    Raises
    ------
    InputError
        A cam that is given by a curvature law.
    """
    plate = with_follower(cam)
    return FollowerMotion(plate.lift_law, plate.swings, plate.body.speed)


# What derivatives of the lift do where segments meet.

ORDER = 4
"""Highest derivative that is looked at."""
_BOUNDED = JetFunctions(ROUNDED)


@dataclass(frozen=True)
class LawJoint:
    """Where one segment ends and the next begins.

    Attributes
    ----------
    number : int
        Of the segment that ends, counted from 0.
    angle : float [rad]
        Of the cam; a turn for the end of the last segment, where the first one begins.
    before, after : tuple of float [m/rad^k or rad/rad^k]
        Lift and derivatives from both sides.
    jumps : tuple of float
        What they change by; exactly 0 where rounding explains the difference.
    """

    number: int
    angle: float
    before: tuple[float, ...]
    after: tuple[float, ...]
    jumps: tuple[float, ...]

    @property
    def first_jump(self) -> int | None:
        """The lowest derivative that jumps; None if all that were looked at are continuous."""
        return next((order for order, jump in enumerate(self.jumps) if jump), None)


def joints_of(motion: FollowerMotion, order: int = ORDER) -> tuple[LawJoint, ...]:
    """All joints of a turn, that of the last segment with the first at its end.

    Notes
    -----
    Both sides are computed with a bound of their rounding error, numbers of the description counting as rounded
    ones; what these bounds explain is no jump.
    """
    return tuple(_joint(motion, number, order) for number in range(len(motion.law.ends)))


def inner_joints_of(motion: FollowerMotion, order: int = ORDER) -> tuple[LawJoint, ...]:
    """Where formulas of one curve meet so that velocity, acceleration or jerk jumps, in the middle of a segment."""
    law, found = motion.law, []
    for number, (start, end) in enumerate(pairwise((0.0, *law.ends))):
        if INNER_JUMPS.get(law.segments[number].curve, ORDER) < ORDER:
            places = [place for place, angle in enumerate(law.whole.breaks) if start < angle < end]
            found += [_inner_joint(motion, number, place, order) for place in places]
    return tuple(joint for joint in found if joint.first_jump is not None)


def _inner_joint(motion: FollowerMotion, number: int, place: int, order: int) -> LawJoint:
    angle = motion.law.whole.breaks[place]
    at = Jet.variable(Rounded.of(np.float64(angle)), order)
    sides = [motion.law.whole.at_row(row, _BOUNDED, at) for row in (place, place + 1)]
    return _joint_between(number, angle, order, sides)


def _joint(motion: FollowerMotion, number: int, order: int) -> LawJoint:
    angle = motion.law.ends[number]
    place = Jet.variable(Rounded.of(np.float64(angle)), order)
    return _joint_between(number, angle, order, motion.law.at_joint(number, _BOUNDED, place))


def _joint_between(number: int, angle: float, order: int, sides: Sequence[Any]) -> LawJoint:
    """The joint of the formulas on its two sides."""
    before, after = ([Rounded.of(side.derivative(k)) for k in range(order + 1)] for side in sides)
    return LawJoint(
        number,
        angle,
        tuple(float(one.value) for one in before),
        tuple(float(one.value) for one in after),
        tuple(_jump(one, other) for one, other in zip(before, after, strict=True)),
    )


def _jump(before: Rounded, after: Rounded) -> float:
    jump = float(after.value) - float(before.value)
    return jump if abs(jump) > SAFETY * float(before.bound + after.bound) else 0.0


def first_jump(motion: FollowerMotion) -> int | None:
    """The lowest derivative, up to the fourth, that jumps anywhere in the turn; None if none does."""
    inside = [segment.inner_jump for segment in motion.law.segments]
    found = [joint.first_jump for joint in joints_of(motion)]
    known = [order for order in (*inside, *found) if order is not None and order <= ORDER]
    return min(known, default=None)


# The lift between breaks: one analytic formula on each closed stretch, and extremes of what is made of it.

SAME = 1e-12
"""Sizes that part by a smaller share are equal but for rounding."""
Made = Callable[[Array], tuple[Array, Array]]
"""A value and its slope from the derivatives (order + 1, n) of the lift."""


@dataclass(frozen=True)
class LiftStretch:
    """A part of the lift with one formula, at both ends its own."""

    law: SegmentedLaw
    number: int

    @property
    def ends(self) -> tuple[float, float]:
        """First and last angle [rad]."""
        first, last = self.law.whole.breaks[self.number : self.number + 2]
        return first, last

    def derivatives(self, phi: Array, order: int) -> Array:
        """Lift and derivatives (order + 1, n)."""
        jet = self.law.whole.at_row(self.number + 1, JETS, Jet.variable(phi, order))
        return np.stack([np.broadcast_to(jet.derivative(k), phi.shape) for k in range(order + 1)])

    def extremes(self, order: int, made: Made) -> Extremes:
        """Extremes of what is made of derivatives up to an order."""
        return extremes(
            lambda phi: made(self.derivatives(phi, order))[0],
            lambda phi: made(self.derivatives(phi, order))[1],
            mesh(*self.ends),
        )


def stretches(law: SegmentedLaw, segment: int | None = None) -> list[LiftStretch]:
    """The stretches of one segment, counted from 0, or of all."""
    edges = law.whole.breaks
    first, last = 0.0, edges[-1]
    if segment is not None:
        first, last = (0.0, *law.ends)[segment : segment + 2]
    return [
        LiftStretch(law, k) for k, (low, high) in enumerate(pairwise(edges)) if first <= low and high <= last
    ]


def extremes_of(law: SegmentedLaw, order: int, made: Made, segment: int | None = None) -> Extremes:
    """Extremes over a segment or the whole, limits from both sides of each break included.

    Of what is taken more than once the first place counts.
    """
    found = [stretch.extremes(order, made) for stretch in stretches(law, segment)]
    low = min(found, key=lambda one: (one.least, one.at_least))
    high = max(found, key=lambda one: (one.greatest, -one.at_greatest))
    return Extremes(low.least, low.at_least, high.greatest, high.at_greatest)


def derivative(order: int) -> Made:
    """The derivative of an order of the lift; ask for derivatives up to one more."""
    return lambda found: (found[order], found[order + 1])


def power(found: Array) -> tuple[Array, Array]:
    """First times second derivative: a mass's share in the torque of the camshaft; ask for derivatives up to 3."""
    return found[1] * found[2], found[2] ** 2 + found[1] * found[3]


def greatest_size(one: Extremes) -> tuple[float, float]:
    """The greatest size with its sign, and its place; of equal sizes the one that comes first."""
    up, down = (one.greatest, one.at_greatest), (one.least, one.at_least)
    if isclose(up[0], -down[0], rel_tol=SAME):
        return min(up, down, key=lambda size: size[1])
    return up if up[0] > -down[0] else down


# Laws of motion beside each other, for one rise: peaks, and the derivatives over the rise.

ORDERS = (1, 2, 3)
SAMPLES = 361
ITS_OWN = mark("its own")
"""Name of the description's own law beside the others, where it is none of them."""
NOTHING = 1e-9
"""A derivative that is a smaller share of rise over angle to its order is one of rounding."""


@dataclass(frozen=True)
class Peaks:
    """Coefficients of a rise h over an angle beta, none of which depends on h and beta.

    Attributes
    ----------
    coefficients : three floats
        Greatest sizes of s' beta/h, s'' beta^2/h, s''' beta^3/h, between the ends.
    torque : float
        Greatest size of s' s'' beta^3/h^2: what a mass asks of the camshaft.
    first_jump : int or None
        The lowest derivative that jumps inside, or at an end where a dwell follows; None if up to the fourth none does.
    """

    coefficients: tuple[float, float, float]
    torque: float
    first_jump: int | None


def peaks_of(law: SegmentedLaw, number: int = 0) -> Peaks:
    """Peaks of a segment of a law, counted from 0; of a dwell all are 0."""
    parts, segment = stretches(law, number), law.segments[number]
    (start, _end), (_start, end) = parts[0].ends, parts[-1].ends
    before = parts[0].derivatives(np.array([start]), ORDER)[:, 0]
    after = parts[-1].derivatives(np.array([end]), ORDER)[:, 0]
    rise, angle = float(after[0] - before[0]), end - start
    if segment.to is None or rise == 0:
        return Peaks((0.0, 0.0, 0.0), 0.0, segment.inner_jump)
    first, second, third = (
        abs(greatest_size(extremes_of(law, k + 1, derivative(k), number))[0] * angle**k / rise)
        for k in ORDERS
    )
    torque = abs(greatest_size(extremes_of(law, 3, power, number))[0]) * angle**3 / rise**2
    sizes = np.abs(np.stack([before, after])) * angle ** np.arange(ORDER + 1) / abs(rise)
    jumps = [order for order in range(1, ORDER + 1) if (sizes[:, order] > NOTHING).any()]
    jumps += [] if segment.inner_jump is None else [segment.inner_jump]
    least = min(jumps, default=ORDER + 1)
    return Peaks((first, second, third), torque, least if least <= ORDER else None)


def compare_laws(
    rise: float = 1.0,
    angle: float = 1.0,
    speed: float | None = None,
    curves: Sequence[str] = tuple(CURVES),
    own: LawSegment | None = None,
    samples: int = SAMPLES,
) -> xr.Dataset:
    """Laws of motion beside each other, for one rise.

    Parameters
    ----------
    rise : float [m or rad], not 0
    angle : float [rad], positive
        Of the cam meanwhile.
    speed : float [rad/s]
        Of the cam; with it the peaks are also told in time.
    curves : names of curves
    own : LawSegment
        A further law, from 0 to `rise` over `angle`.
    samples : int
        Of each curve.

    Returns
    -------
    Dataset
        Along `law`: `peak_coefficient` (order 1 to 3: velocity, acceleration, jerk; sizes, between the ends),
        `torque_coefficient`, `first_jump` (order of the lowest derivative that jumps, against dwells at the ends; 0
        if up to the fourth none does); along `sample` over `share` of the angle: `rise_share`, with derivatives along
        `derivative` (0 to 3), in shares of the rise. Attributes: rise, angle, speed.

    Raises
    ------
    InputError
        An unknown curve, or numbers that make no rise.
    """
    names = [*curves]
    for name in names:
        if name not in CURVES:
            raise InputError(
                "curves", _("there is no curve {name}").format(name=value_text(name)), nearest(name, CURVES)
            )
    if not (math.isfinite(rise) and rise and math.isfinite(angle) and angle > 0):
        raise InputError("", _("a rise needs a height that is not 0 and a positive angle"), _("correct them"))
    laws = {name: SegmentedLaw((LawSegment(1.0, 1.0, name),)) for name in names}
    if own is not None:
        laws[ITS_OWN] = SegmentedLaw((own,))
    return _motion_dataset(laws, rise, angle, speed, samples)


def _motion_dataset(
    laws: Mapping[str, SegmentedLaw], rise: float, angle: float, speed: float | None, samples: int
) -> xr.Dataset:
    if not laws:
        raise InputError("curves", _("no law is given"), _("name one or more"))
    share = np.linspace(0.0, 1.0, samples)
    peaks = [peaks_of(law) for law in laws.values()]
    curves = [_over(law, share, rise if name == ITS_OWN else 1.0) for name, law in laws.items()]
    drawn = _drawn_share(laws, share)
    lines = [_over(law, drawn, rise if name == ITS_OWN else 1.0) for name, law in laws.items()]
    data = {
        "peak_coefficient": vocabulary_variable(
            "peak_coefficient", ("law", "derivative"), [[np.nan, *one.coefficients] for one in peaks]
        ),
        "torque_coefficient": vocabulary_variable(
            "torque_coefficient", ("law",), [one.torque for one in peaks]
        ),
        "first_jump": vocabulary_variable("first_jump", ("law",), [one.first_jump or 0 for one in peaks]),
        "rise_share": vocabulary_variable("rise_share", ("law", "derivative", "sample"), np.stack(curves)),
        "drawn_share": vocabulary_variable("drawn_share", ("place",), drawn),
        "drawn_rise": vocabulary_variable("drawn_rise", ("law", "derivative", "place"), np.stack(lines)),
    }
    coordinates = {
        "law": labels_of(tuple(laws)),
        "derivative": [0, *ORDERS],
        "share": vocabulary_variable("share", ("sample",), share),
    }
    facts = {"rise": rise, "angle": angle, "version": __version__}
    return xr.Dataset(data, coords=coordinates, attrs=facts | ({} if speed is None else {"speed": speed}))


def _drawn_share(laws: Mapping[str, SegmentedLaw], share: Array) -> Array:
    """Shares at which laws are drawn: where a derivative of one of them jumps inside, both sides of the place."""
    inner = {
        place / law.period
        for law in laws.values()
        if INNER_JUMPS.get(law.segments[0].curve, ORDER) < ORDER
        for place in law.whole.breaks[1:-1]
    }
    places = np.array(sorted(inner))
    return np.sort(np.concatenate([np.setdiff1d(share, places), np.nextafter(places, 0.0), places]))


def _over(law: SegmentedLaw, share: Array, rise: float) -> Array:
    """Shares of the rise with three derivatives by the share of the angle."""
    angle = law.period
    jet = law.jet(JETS, Jet.variable(share * angle, ORDERS[-1]))
    found = [np.broadcast_to(jet.derivative(k), share.shape) * angle**k / rise for k in (0, *ORDERS)]
    return np.stack(found)


def first_rise(cam: AnyCam) -> int:
    """The first segment of a cam that moves its follower, counted from 0."""
    before = 0.0
    for number, segment in enumerate(with_follower(cam).segments):
        if segment.to is not None and segment.to != before:
            return number
        before = before if segment.to is None else segment.to
    what = _("every segment ends at the lift at which it begins: there is no rise for which to compare laws")
    raise InputError(
        "[[segments]]", what, _("omit --laws, or use centrode.cams.followers.motion.compare_laws")
    )


def cam_laws(cam: AnyCam, samples: int = SAMPLES) -> xr.Dataset:
    """Laws of motion beside each other for the first rise of a cam, with its own if it is none of them.

    Parameters
    ----------
    cam : PlateCam
    samples : int
        Of each curve.

    Raises
    ------
    InputError
        A cam that is given by a curvature law.
    """
    plate = with_follower(cam)
    segment = plate.segments[first_rise(plate)]
    own = None if segment.curve in CURVES else segment.law
    found = compare_laws(segment.to or 0.0, segment.angle, plate.body.speed, own=own, samples=samples)
    facts = {"topic": "motion-laws", "title": plate.title, "cam": cam_text(plate)}
    return found.assign_attrs(**facts, segment=first_rise(plate), curve=segment.curve)


# The motion of a follower as a labelled result.

BY_ANGLE = ("", "_slope", "_second", "_third", "_fourth")
IN_TIME = ("_velocity", "_acceleration", "_jerk")
WIDTH, LEAST_PLACES = math.radians(1.0), 9
"""A drawn curve has a place at least every degree, and so many in each stretch."""


def motion_names(swings: bool) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Names of the lift with its derivatives by the cam's angle, and of those by time."""
    front = "swing" if swings else "lift"
    return tuple(front + end for end in BY_ANGLE), tuple(front + end for end in IN_TIME)


def dataset_of_motion(cam: PlateCam, motion: FollowerMotion, phi: Array) -> xr.Dataset:
    """The labelled motion of a follower at angles of its cam [rad].

    Along `sample`, over `cam_angle`: the lift with four derivatives by the cam's angle; with a speed of the cam also
    velocity, acceleration and jerk in time. Along `joint`, at `joint_angle`: lift and derivatives before and after it.
    """
    by_angle, in_time = motion_names(motion.swings)
    values = motion.lift(phi, len(by_angle) - 1)
    data: dict[str, Variable] = {
        name: vocabulary_variable(name, ("sample",), one) for name, one in zip(by_angle, values, strict=True)
    }
    if motion.speed is not None:
        for order, name in enumerate(in_time, 1):
            data[name] = vocabulary_variable(name, ("sample",), values[order] * motion.speed**order)
    data["status"] = _all_right(len(phi))
    coordinates = {
        "cam_angle": vocabulary_variable("cam_angle", ("sample",), phi),
        "derivative": list(range(ORDER + 1)),
    }
    return selectable(
        xr.Dataset(data | _joints(motion) | _curve(motion), coords=coordinates, attrs=_facts(cam, motion))
    )


def _joints(motion: FollowerMotion) -> dict[str, Variable]:
    """Both sides of every joint, those of 0 deg at the end of the turn; each derivative in its own unit."""
    joints = joints_of(motion)
    units = {"units": ", ".join(QUANTITIES[name].unit for name in motion_names(motion.swings)[0])}
    sides = {"joint_before": [one.before for one in joints], "joint_after": [one.after for one in joints]}
    data = {
        name: (("joint", "derivative"), np.array(values), {**vocabulary_variable(name, (), None)[2], **units})
        for name, values in sides.items()
    }
    return {
        "joint_angle": vocabulary_variable("joint_angle", ("joint",), [one.angle for one in joints]),
        **data,
    }


def _curve(motion: FollowerMotion) -> dict[str, Variable]:
    """The motion as it is drawn whatever the samples: each stretch by its own formula, with both its ends."""
    angles, values = [], []
    for stretch in stretches(motion.law):
        low, high = stretch.ends
        phi = np.linspace(low, high, max(LEAST_PLACES, 1 + math.ceil((high - low) / WIDTH)))
        angles.append(phi)
        values.append(stretch.derivatives(phi, ORDER))
    units = {"units": ", ".join(QUANTITIES[name].unit for name in motion_names(motion.swings)[0])}
    drawn = np.concatenate(values, axis=1).T
    return {
        "drawn_angle": vocabulary_variable("drawn_angle", ("place",), np.concatenate(angles)),
        "drawn_motion": (
            ("place", "derivative"),
            drawn,
            {**vocabulary_variable("drawn_motion", (), None)[2], **units},
        ),
    }


def _all_right(count: int) -> Variable:
    dimensions, values, attributes = vocabulary_variable(
        "status", ("sample",), np.full(count, Status.OK, dtype=np.int8)
    )
    attributes["flag_values"] = np.array([s.value for s in Status], dtype=np.int8)
    attributes["flag_meanings"] = " ".join(s.name.lower() for s in Status)
    return dimensions, values, attributes


def _facts(cam: PlateCam, motion: FollowerMotion) -> dict[str, Any]:
    facts = {"topic": "follower-motion", "title": cam.title, "cam": cam_text(cam), "version": __version__}
    curves = {"curves": ", ".join(segment.curve for segment in cam.segments)}
    return facts | curves | ({} if motion.speed is None else {"speed": motion.speed})
