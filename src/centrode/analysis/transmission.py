"""Transmission and pressure angles of dyads over a motion.

The transmission angle of a group is the angle at which the two lines meet that its velocity diagram is drawn with:
for two links the angle between them at their common hinge (0 to 180 deg), otherwise the acute one. The pressure
angle, between the force on what is driven and its velocity, is what is left to a right angle: at a guide between
the link and the guide (RRP), at a rocking guide between the guide and the arm to its pivot (RPR), at two guides
between the normal of one and the other (PRP, RPP). Friction is left out.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import ceil, nan, pi
from typing import TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.analysis.instant_centres.bodies import TurningBodies, pole_of, turning_bodies_of
from centrode.analysis.rotatability.causes import least_of, transmission_at_ends, watched_dyads
from centrode.analysis.rotatability.tours import DriveSweep, MonitoredFunction, monitored_function
from centrode.errors import InputError
from centrode.kinematics.hinge_angles import HINGE_ANGLES
from centrode.kinematics.motion import dataset_of, vocabulary_variable
from centrode.kinematics.path import SampleGrid
from centrode.kinematics.preparation import Ready, ready
from centrode.kinematics.samples import MotionOnPath
from centrode.kinematics.solve import grid_of, solve
from centrode.locale import _
from centrode.model.examples.catalogue import MechanismSource, mechanism_of
from centrode.model.mechanism import FRAME, Mechanism
from centrode.model.values import unit_vector
from centrode.structure.dimensions import Dimensions
from centrode.structure.groups import (
    Aim,
    CylinderCircle,
    Group,
    Meet,
    Rail,
    Rod,
    Slot,
)

# Transmission angles on the sphere: between the arcs from a dyad's inner joint to the centres of its two
# circles.
#
# A link's centre is its other hinge, a guide's the pole of its circle; of a link that aims with its guide
# they are its pivot and that pole, seen from the point aimed at.

Array: TypeAlias = npt.NDArray[np.float64]


class ArcAngles:
    """Angles between arcs over one motion."""

    def __init__(self, data: xr.Dataset) -> None:
        self.bodies: TurningBodies = turning_bodies_of(data)

    def of(self, group: Group) -> Array | None:
        """Transmission angle of a group at every sample; None where it has none."""
        points = self.bodies.points
        if isinstance(group, Aim) and group.contact is None:
            # the circle of the guide is square to the arc to its pole, which stands for its normal
            target = points[group.target]
            return _acute_arc(_between(target, points[group.pivot], self._pole(group.guide)))
        if not isinstance(group, Meet) or len(group.points) != 1:
            return None
        centres = [self._centre(locus) for locus in group.loci if isinstance(locus, (Rod, Rail))]
        if len(centres) != 2:
            return None
        angle = _between(points[group.points[0]], centres[0], centres[1])
        # two links have a sense each, so 0 and 180 deg differ; the arc to a pole stands for a line, which has
        # none
        return angle if len(group.rods) == 2 else _acute_arc(angle)

    def _centre(self, locus: Rod | Rail) -> Array:
        return self.bodies.points[locus.centre] if isinstance(locus, Rod) else self._pole(locus.guide)

    def _pole(self, name: str) -> Array:
        """Where the pole of a guide's circle is."""
        guide = self.bodies.mechanism.guide(name)
        inside = np.array(unit_vector(pole_of(self.bodies.mechanism, guide)))
        return np.asarray(self.bodies.axes[:, self.bodies.number(guide.on)] @ inside)


def _between(at: Array, first: Array, second: Array) -> Array:
    """Angle in a place from the arc to one other place to the arc to another, in [0, pi]."""
    one, other = np.cross(at, first), np.cross(at, second)
    # the product of the two normals is square to both, so its length is the sine and no arc cosine loses
    # digits near 0
    sine = np.linalg.norm(np.cross(one, other), axis=-1)
    return np.asarray(np.arctan2(sine, np.sum(one * other, axis=-1)))


def _acute_arc(angle: Array) -> Array:
    return np.asarray(np.minimum(angle, np.pi - angle))


# Least and greatest transmission angles of dyads over the part of a motion that is reached, found as roots.
#
# An extreme lies where the angle's rate is zero, at an end of what is reached, where the dyad is flat (0), or
# where its lines stand square to each other (90 deg).

LEAST_NODES = 720


@dataclass(frozen=True)
class _Stretch(DriveSweep):
    """The part of a path between two values of its parameter, ends of a motion's samples or limits."""

    first: float = nan
    last: float = nan

    @property
    def span(self) -> tuple[float, float]:
        """Parameter at both ends of the stretch, first and last."""
        return self.first, self.last

    @property
    def comes_round(self) -> bool:
        """False: a stretch is looked at from end to end, even over whole turns."""
        return False

    def nodes(self) -> Array:
        """Values at least as close as the nodes of the mesh, denser towards the ends."""
        # cosine spacing is widest in the middle, by pi/2 of the even step: with so many nodes it is no wider
        # there than the mesh
        step = self.continuation.kinematics.path.step
        count = max(LEAST_NODES, ceil((self.last - self.first) / step * pi / 2))
        # half a node off the ends: at a limit the rates are infinite
        share = 0.5 - 0.5 * np.cos(pi * (np.arange(count) + 0.5) / count)
        return np.asarray(self.first + (self.last - self.first) * share)


def extreme_transmission_angles(ready: Ready, span: SampleGrid) -> dict[int, tuple[float, float]]:
    """Least and greatest acute transmission angle [rad] of each dyad, by the number of its group.

    They are those over all values between the least and the greatest parameter of the span that the mechanism
    reaches; NaN where it reaches none.
    """
    with np.errstate(all="ignore"):
        continuation = MotionOnPath.along(ready, ready.kinematics, span.parameter).continuation
        low, high = continuation.branches.reach(0)
        first, last = max(low, float(np.min(span.parameter))), min(high, float(np.max(span.parameter)))
        drive = ready.kinematics.path.driven[0].drive
        stretch = _Stretch(ready, drive, {}, continuation, low, high, last - first, first, last)
        dyads = watched_dyads(stretch, guides=True)
        if not first <= last:
            # nothing of the span is reached
            return {group: (nan, nan) for _one, group in dyads}
        course = monitored_function(stretch, [watched for watched, _group in dyads])
        return {group: _extremes(course, k, group) for k, (_one, group) in enumerate(dyads)}


def _extremes(course: MonitoredFunction, k: int, group: int) -> tuple[float, float]:
    places, reached = course.turned[k]
    turned = [
        (float(at), float(value)) for at, value in zip(places, _acute_between_lines(reached), strict=True)
    ]
    least = least_of(course, k, group, turned)[0]
    values = course.values[k][np.isfinite(course.values[k])]
    # flat between two nodes: the rate has no zero there, since an acute angle turns back with a corner
    if _passes(np.sin(values), np.cos(values)):
        least = 0.0
    # square between two nodes: nothing is greater, so the ends need not be looked at
    if _passes(np.cos(values), np.sin(values)):
        return least, pi / 2
    ends = [angle for angle, _at in transmission_at_ends(course, k)]
    return least, float(
        np.max(np.concatenate([_acute_between_lines(np.append(values, reached)), ends]), initial=least)
    )


def _acute_between_lines(angles: Array) -> Array:
    """Angles between lines, in [0, pi/2]."""
    return np.asarray(np.arctan2(np.abs(np.sin(angles)), np.abs(np.cos(angles))))


def _passes(number: Array, other: Array) -> bool:
    """Whether a sine (or a cosine) passes zero between nodes at which the other keeps its side."""
    # Between neighbouring nodes an angle turns by less than a quarter as a rule, so one of the two keeps its sign.
    # Where both change, the signs do not tell which of them was passed. Zero at a node counts; NaN compares false, so
    # nothing is passed beside a gap.
    return bool(((number[:-1] * number[1:] <= 0.0) & (other[:-1] * other[1:] > 0.0)).any())


Lines: TypeAlias = npt.NDArray[np.complex128]


def transmission_angles(
    mechanism: MechanismSource,
    samples: int | None = None,
    start: float | str | None = None,
    stop: float | str | None = None,
    at: npt.ArrayLike | None = None,
) -> xr.Dataset:
    """Transmission and pressure angles of every dyad over the motion.

    The arguments are those of `motion`. The result has the dimensions sample and group: `transmission_angle` and
    `pressure_angle` [rad] by the links of the groups, with time, status, events and values of the drives as in the
    motion. Accurate as the positions are; at a limit the transmission angle is 0 or 180 deg. Groups of higher class and
    gears have none. `least_transmission_angle` and `greatest_transmission_angle` [rad] (group) are the exact extremes
    of the acute angle over all that the mechanism reaches between the first and the last sample.

    On the sphere they are angles between arcs: of links, and from a point to the pole of its guide. There
    `hinge_angle` with two derivatives by time (sample, hinge) is the angle between the links at every moving hinge,
    with its sense and its turns.

    Raises InputError where no group has such an angle; else as `motion` does.

    Examples
    --------
    >>> import centrode as ct
    >>> print(ct.summary(ct.transmission_angles(ct.example("crank-rocker"), 73)))
    group  least transmission angle, deg  greatest transmission angle, deg  greatest pressure angle, deg
    AB-DB                        54.3147                           90.0000                       35.6853
    """
    mechanism = mechanism_of(mechanism)
    prepared = ready(mechanism)
    span = grid_of(prepared, samples, start, stop, at)
    data = dataset_of(solve(prepared, span))
    structure = prepared.structure
    by_group, numbered = {}, []
    arcs = ArcAngles(data) if mechanism.space == "sphere" else None
    for number, group in enumerate(structure.groups):
        angle = _angle(data, structure.dimensions, group) if arcs is None else arcs.of(group)
        if angle is not None:
            by_group["-".join(group.links or group.points)] = angle
            numbered.append(number)
    if not by_group:
        raise InputError(
            "[links]",
            _("no group of the mechanism has a transmission angle"),
            _("a transmission angle exists in a driven dyad: two links, or a link and a guide"),
        )
    angles = np.stack(list(by_group.values()), axis=1)
    extremes = extreme_transmission_angles(prepared, span)
    least, greatest = np.array([extremes[number] for number in numbered]).T
    variables = {
        "transmission_angle": vocabulary_variable("transmission_angle", ("sample", "group"), angles),
        "pressure_angle": vocabulary_variable(
            "pressure_angle", ("sample", "group"), np.abs(np.pi / 2 - angles)
        ),
        "least_transmission_angle": vocabulary_variable("least_transmission_angle", ("group",), least),
        "greatest_transmission_angle": vocabulary_variable(
            "greatest_transmission_angle", ("group",), greatest
        ),
        # on the sphere with the sense that the transmission angle has not
        **{name: data[name] for name in HINGE_ANGLES if name in data},
        **{name: data[name] for name in ("status", "event_value", "event_kind")},
    }
    coords = {"group": list(by_group), **{name: data[name] for name in ("time", "drive_value")}}
    attributes = {"topic": "angles", "title": mechanism.title, "mechanism": data.attrs["mechanism"]}
    return xr.Dataset(variables, coords, attrs=attributes)


@dataclass(frozen=True)
class TransmissionResults:
    """Transmission and pressure angles of a mechanism.

    Attributes
    ----------
    mechanism : Mechanism
    angles : the dataset of `transmission_angles`
    """

    mechanism: Mechanism
    angles: xr.Dataset


def transmission_results(mechanism: Mechanism, samples: int | None = None) -> TransmissionResults:
    """Transmission and pressure angles over the motion, with the mechanism; raises as `transmission_angles` does."""
    return TransmissionResults(mechanism, transmission_angles(mechanism, samples))


def _angle(data: xr.Dataset, numbers: Dimensions, group: Group) -> Array | None:
    """Transmission angle of a group at every sample; None where it has none."""
    if isinstance(group, Aim) and group.contact is None:
        # the arm's end moves square to it: that line and the guide are drawn in the velocity diagram
        arm = place(data, group.target) - place(data, group.pivot)
        return _acute(1j * arm, _guide_directions(data, numbers, group.link, group.guide))
    if not isinstance(group, Meet) or group.has_stop:
        return None
    directions = list(_directions(data, numbers, group))
    if len(directions) != 2:
        return None
    # between two arms the angle runs to 180 deg; lines, whose sense means nothing, go through the acute angle
    # below
    if group.circles == 2:
        return np.abs(np.angle(directions[1] * directions[0].conj()))
    return _acute(*directions)


def _directions(data: xr.Dataset, numbers: Dimensions, group: Meet) -> Iterator[Lines]:
    """Directions in which the loci let the group's vector move; of circles the arms towards their centres."""
    circles = group.circles == 2
    for locus in group.loci:
        if isinstance(locus, (Rod, CylinderCircle)):
            arm = place(data, locus.centre) - place(data, locus.point)
            yield arm if circles else 1j * arm
        elif isinstance(locus, Rail):
            yield _guide_directions(data, numbers, locus.on, locus.guide)
        elif isinstance(locus, Slot) and group.carriage is not None:
            yield _guide_directions(data, numbers, group.carriage, locus.guide)


def place(data: xr.Dataset, point: str) -> Lines:
    """Places of a point as complex numbers."""
    xy = data["position"].sel(point=point).values
    return np.asarray(xy[:, 0] + 1j * xy[:, 1])


def _guide_directions(data: xr.Dataset, numbers: Dimensions, link: str, guide: str) -> Lines:
    """Directions of a guide at every sample."""
    # the frame does not turn and is no link of the dataset
    turn = np.zeros(data.sizes["sample"]) if link == FRAME else data["angle"].sel(link=link).values
    return np.asarray(complex(*numbers.direction[guide]) * np.exp(1j * turn))


def _acute(first: Lines, second: Lines) -> Array:
    """The acute angle between two directions, in [0, pi/2]."""
    # no arc cosine: the ratio of both parts is exact near 0 and near a right angle alike
    turned = second * first.conj()
    return np.asarray(np.arctan2(np.abs(turned.imag), np.abs(turned.real)))
