"""Values and derivatives at samples of the path, with a status for each.

Arrays are ordered (derivative, column, lane, sample): what the columns hold, the layout says; lanes are the
mechanisms of a batch.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import cached_property, partial
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.errors import Status
from centrode.kinematics.angular_velocity import (
    NodeTurns,
    angle_and_rates,
    attitudes_of,
    node_turns,
    spins_of,
)
from centrode.kinematics.change_points import BranchedPlan, Smooth
from centrode.kinematics.events import EventScan, guard_with_bound
from centrode.kinematics.higher_class.evaluation import ConvergedPlaces
from centrode.kinematics.hinge_angles import moving_hinges, rotor_of_hinge
from centrode.kinematics.mesh import mesh_of
from centrode.kinematics.path import JETS, nearest_node
from centrode.kinematics.plan_evaluation import (
    Branches,
    Kinematics,
    PlanLayout,
    branches_at_start,
    layout_of,
    positions_from,
    rotor_of_angle,
    slide_of,
)
from centrode.kinematics.preparation import Ready
from centrode.kinematics.quick_turns import QuickTurns
from centrode.locale import _
from centrode.numerics.arrays import ARRAYS, of_shape
from centrode.numerics.jets import Jet
from centrode.numerics.rooms import GivenRoom
from centrode.numerics.rounding_bounds import SAFETY
from centrode.structure.constraints import Constraint, PointInLink, Positions, TrackContact, contact_point
from centrode.structure.dimensions import Dimensions

Array: TypeAlias = npt.NDArray[np.float64]
Lanes: TypeAlias = npt.NDArray[np.intp]
Mask: TypeAlias = npt.NDArray[np.bool_]
Number: TypeAlias = Any

ORDERS = 3
"""Value, first and second derivative."""
SUSPECT = 1e-8
"""Radicands below this fraction of their greatest value are compared with their rounding error."""


@dataclass
class Samples:
    """Columns with their derivatives by the path's parameter, angles likewise, and a status for each sample.

    `followed` names the links whose angles the plan gives with their turns; those of others follow from rotors.
    """

    layout: PlanLayout
    columns: Array
    angles: Array
    status: npt.NDArray[np.int8]
    followed: set[str] = field(default_factory=set)

    def of(self, rows: slice) -> Samples:
        """A view of some mechanisms of the batch."""
        return Samples(self.layout, self.columns[:, :, rows], self.angles[:, :, rows], self.status[rows])

    @property
    def complete(self) -> Mask:
        """Where every number is finite (lanes, n)."""
        # one NaN or infinity makes the sum one, which is cheaper to find than a mask of every number
        with np.errstate(all="ignore"):
            complete: Mask = np.isfinite(self.columns.sum(axis=(0, 1)))
        return complete if complete.all() else np.asarray(np.isfinite(self.columns).all(axis=(0, 1)))


def evaluate_columns(
    continuation: BranchedPlan, samples: Samples, parameter: Array, lanes: Lanes | None = None
) -> SampleJudging:
    """Fill in columns and known angles; returns where groups are open, at a limit, or not converged.

    With `lanes` every parameter belongs to one mechanism of the batch: arrays have (k,) in place of (lanes, n).
    """
    along, layout = parameter if lanes is not None else parameter[None, :], samples.layout
    kinematics = continuation.kinematics if lanes is None else continuation.kinematics.take(lanes)
    judging = SampleJudging(continuation, along, samples.status.shape, lanes)
    with np.errstate(all="ignore"):
        at = kinematics.positions(JETS, Jet.variable(along, ORDERS - 1), judging)
        fill_columns(kinematics, layout, at, samples.columns)
    judging.opened |= kinematics.path.impossible(parameter)
    for k, link in enumerate(layout.angles):
        if layout.runs_on and link in at.angles:
            fill_number(samples.angles[:, k], at.angles[link])
            samples.followed.add(link)
    return judging


class SampleJudging(Smooth):
    """Notes where groups are open, and where at zero of their radicand."""

    def __init__(
        self, continuation: BranchedPlan, along: Array, shape: tuple[int, ...], lanes: Lanes | None = None
    ) -> None:
        super().__init__(continuation, JETS, along, lanes)
        self.shape = shape
        self.opened, self.zero = np.zeros(shape, dtype=bool), np.zeros(shape, dtype=bool)
        self.lost = np.zeros(shape, dtype=bool)
        self._judged: dict[int, tuple[Mask, Mask]] = {}

    def root(self, group: int, radicand: Number) -> Number:
        sign = self.continuation.branches.sign(group, self.parameter, self.lanes)
        # a radicand that does not move has derivatives that are zero: groups behind need jets
        if not isinstance(radicand, Jet):
            radicand = Jet((radicand, *[0.0] * (ORDERS - 1)))
        value = of_shape(radicand.value, self.shape)
        below = self._at_zero(group, value)
        if below is None:
            # without power series a negative radicand opens at once; with one, `after` may take that back
            if self.continuation.windows_of(group) is None:
                np.logical_or(self.opened, value < 0.0, out=self.opened)
            else:
                self._judged[group] = (value < 0.0, np.zeros(self.shape, dtype=bool))
            return JETS.sqrt(radicand) * sign
        self._judged[group] = ((value < 0.0) & ~below, below)
        # a root of rounding would move the point: at zero it is zero exactly, and its derivatives infinite
        return JETS.sqrt(Jet((np.where(below, 0.0, value), *radicand.coefficients[1:]))) * sign

    def judge(self, group: int, judged: ConvergedPlaces) -> None:
        self.lost |= judged.lost
        self._judged[group] = (judged.opened, judged.limit)

    def after(self, group: int, at: Positions) -> None:
        mended = self.continuation.mend(group, at, self.parameter, self.lanes)
        for total, mask in zip((self.opened, self.zero), self._judged.pop(group, ()), strict=False):
            for index in mended:
                mask[index] = False  # there the motion goes on smoothly
            np.logical_or(total, mask, out=total)

    def _at_zero(self, group: int, value: Array) -> Mask | None:
        """Where a radicand is zero within its rounding error; None if nowhere."""
        greatest = self.continuation.branches.largest[group]
        greatest = greatest[:, None] if self.lanes is None else greatest[self.lanes]
        # rounding bounds cost some ten times the value, so they are computed for radicands near zero alone
        suspects = np.nonzero(np.abs(value) <= SUSPECT * greatest)
        if not len(suspects[0]):
            return None
        if self.lanes is None:
            lanes, parameter = suspects[0], self.parameter[0, suspects[1]]
        else:
            lanes, parameter = self.lanes[suspects[0]], self.parameter[suspects[0]]
        _value, bound = guard_with_bound(self.continuation, group, lanes, parameter)
        zero = np.zeros(value.shape, dtype=bool)
        zero[suspects] = np.abs(value[suspects]) <= SAFETY * bound
        return zero if zero.any() else None


def fill_columns(kinematics: Kinematics, layout: PlanLayout, at: Positions, columns: Array) -> None:
    """Values and derivatives of every column, from jets."""
    for k, number in enumerate(layout.numbers(JETS, kinematics.numbers, at)):
        fill_number(columns[:, k], number)


def fill_number(column: Array, number: Number) -> None:
    """A number with its derivatives (3, lanes, n)."""
    if isinstance(number, Jet):
        column[0], column[1] = number.coefficients[:2]
        np.multiply(number.coefficients[2], 2.0, out=column[2])  # Taylor coefficients are over k!
    else:
        column[0] = number
        column[1:] = 0.0


def sample(
    continuation: BranchedPlan, parameter: Array, samples: Samples, lanes: Lanes | None = None
) -> None:
    """Fill in columns and statuses; with `lanes` as in `evaluate_columns`."""
    judged = evaluate_columns(continuation, samples, parameter, lanes)
    # in this order: later statuses are stronger, and overwrite
    samples.status[judged.zero | ~samples.complete] = Status.SINGULAR
    samples.status[beyond_limits(continuation.branches, parameter, lanes)] = Status.CUT_OFF
    samples.status[judged.lost] = Status.UNCONVERGED
    samples.status[judged.opened] = Status.OPEN


def beyond_limits(branches: Branches, parameter: Array, lanes: Lanes | None = None) -> Mask:
    """Where a mechanism would have to pass a limit: (lanes, n), or (k,) with a lane for each parameter."""
    reach = branches.reaches()
    low, high = (reach[:, :1], reach[:, 1:]) if lanes is None else reach[lanes].T
    # a sample at the limit itself, but for rounding, is not beyond it
    margin = 4.0 * np.spacing(np.abs(parameter))
    return np.asarray((parameter < low - margin) | (parameter > high + margin))


def settle(samples: Samples) -> None:
    """Absence is NaN: nothing stands in open samples, and no derivatives in singular ones."""
    if not samples.status.any():
        return  # incomplete samples have a status
    absent = (samples.status == Status.OPEN) | (samples.status == Status.UNCONVERGED)
    # both arrays: columns are what is computed, angles what follows from them
    for numbers in (samples.columns, samples.angles):
        numbers[:, :, absent] = np.nan
        numbers[1:, :, samples.status == Status.SINGULAR] = np.nan
    # infinities, of groups that go to infinity, are absent too
    samples.columns[~np.isfinite(samples.columns)] = np.nan


# Everything of some motions that depends on the samples, in one room, so that what is big is written once.


@dataclass(frozen=True)
class ResultArrays:
    """Arrays of so many motions at so many samples, not yet filled; statuses are ok.

    Attributes
    ----------
    columns : (3, columns of the frame and of the layout, lanes, n)
    angles : (3, angles, lanes, n)
    """

    layout: PlanLayout
    frame: int
    columns: Array
    angles: Array
    status: npt.NDArray[np.int8]

    @classmethod
    def of(
        cls,
        layout: PlanLayout,
        numbers: Dimensions,
        lanes: int,
        samples: int,
        given: GivenRoom | None = None,
    ) -> ResultArrays:
        """The room for mechanisms with as many points of the frame as these dimensions have."""
        frame = layout.axes * len(numbers.frame)
        room = GivenRoom(None) if given is None else given
        return cls(
            layout,
            frame,
            room.take((ORDERS, frame + layout.width, lanes, samples)),
            room.take((ORDERS, len(layout.angles), lanes, samples)),
            np.zeros((lanes, samples), dtype=np.int8),
        )

    @cached_property
    def samples(self) -> Samples:
        """The room without the frame's part."""
        return Samples(self.layout, self.columns[:, self.frame :], self.angles, self.status)

    def fill_frame(self, numbers: Dimensions) -> None:
        """Points of the frame: their places are constant, absent where the motion is."""
        columns = self.columns[:, : self.frame]
        columns[1:] = 0.0
        fixed = Positions.of_frame(numbers, {}, ARRAYS).points
        for k, place in enumerate(x for at in fixed.values() for x in at):
            columns[0, k] = place
        opened = self.status == Status.OPEN
        if opened.any():
            # what does not close has no frame either, so that a picture of the sample is empty
            columns[:, :, opened] = np.nan

    @property
    def all_points(self) -> Array:
        """Points (3, lanes, n, points, axes), the frame's first."""
        points = self.columns[:, : self.frame + self.layout.first_attitude]
        return np.moveaxis(points.reshape(ORDERS, -1, self.layout.axes, *self.status.shape), (1, 2), (3, 4))

    @property
    def all_angles(self) -> Array:
        """Angles (3, lanes, n, angles)."""
        return np.moveaxis(self.angles, 1, 3)

    @property
    def slides(self) -> Array:
        """Displacements (3, lanes, n, guides)."""
        layout = self.layout
        return np.moveaxis(self.samples.columns[:, layout.first_slide : layout.first_rotor], 1, 3)

    @property
    def spins(self) -> Array | None:
        """Rotation vectors of links and their derivatives (2, lanes, n, links, 3); None in the plane."""
        return spins_of(self.layout, self.samples.columns)

    @property
    def attitudes(self) -> Array | None:
        """Axes of the links (3, lanes, n, links, 3, 3); none in the plane."""
        return attitudes_of(self.layout, self.samples.columns)


# Angles and displacements that run on over turns: filled in for samples by way of the mesh of the path.

TURN = 2.0 * np.pi


@dataclass(frozen=True)
class UnwoundAngle:
    """Positions of some mechanisms of a batch on the mesh, from the initial one outwards."""

    ready: Ready
    numbers: Dimensions
    on_mesh: Positions
    mesh: Array
    quick: QuickTurns

    def turns(
        self, rotor: Callable[[Dimensions, Positions], tuple[Number, Number]], initial: float
    ) -> NodeTurns:
        """Turns along the mesh of what a rotor shows; `initial` [rad] is its angle in the initial position."""
        start = int(np.argmin(np.abs(self.mesh - self.ready.kinematics.path.initial)))
        quick = self.quick.measure(lambda numbers, at: _angle_of(rotor(numbers, at)))
        # where a mechanism of the batch has no position, a link may have no direction either
        with np.errstate(all="ignore"):
            directions = rotor(self.numbers, self.on_mesh)
        return node_turns(directions, initial, start, len(self.mesh), quick)

    def nearest(self, parameter: Array) -> npt.NDArray[np.intp]:
        """The node nearest to each parameter."""
        return nearest_node(self.mesh, parameter)


def _angle_of(rotor: tuple[Number, Number]) -> Number:
    cosine, sine = rotor
    return np.arctan2(sine, cosine)


def fill_angles(course: UnwoundAngle, samples: Samples, parameter: Array) -> None:
    """Fill in the angles that are measured and that the plan itself does not give with their turns."""
    # one node for each sample, the same for all links
    nearest = course.nearest(parameter)
    for k, link in enumerate(samples.layout.angles):
        if link in samples.followed:
            continue
        nodes = course.turns(partial(_rotor, link), course.ready.assembled.angles[link])
        rotor = samples.columns[:, samples.layout.rotor(link)]
        angle_and_rates(rotor, nodes.at(nearest, rotor[0, 0], rotor[0, 1], parameter), samples.angles[:, k])


def fill_slides(course: UnwoundAngle, samples: Samples, parameter: Array) -> None:
    """Add its rounds to the displacement along a guide that closes."""
    space, layout = course.numbers.space, samples.layout
    for k, (guide, point) in enumerate(zip(layout.guides, layout.guided, strict=True)):
        period = space.period(ARRAYS, course.numbers.curve(guide))
        if period is None:
            continue
        nodes = course.turns(partial(_rotor_of_slide, guide, point), _initial(course, guide, point))
        slide = samples.columns[0, layout.first_slide + k]
        # a displacement along a closed guide is an angle about its pole, and counted like one
        angle = slide * (TURN / period)
        slide += period * nodes.at(course.nearest(parameter), np.cos(angle), np.sin(angle), parameter)


def _rotor(link: str, numbers: Dimensions, at: Positions) -> tuple[Number, Number]:
    """Cosine and sine of a link's angle."""
    return rotor_of_angle(ARRAYS, numbers, at, link)


def _rotor_of_slide(guide: str, point: str, numbers: Dimensions, at: Positions) -> tuple[Number, Number]:
    """Cosine and sine of the angle about a guide's pole."""
    period: Number = numbers.space.period(ARRAYS, numbers.curve(guide))
    angle = slide_of(ARRAYS, numbers, at, guide, point) * (TURN / period)
    return np.cos(angle), np.sin(angle)


def _initial(course: UnwoundAngle, guide: str, point: str) -> float:
    """Angle about the pole [rad] in the initial position: the drive's where one drives it, else in (-pi, pi]."""
    at, numbers = course.ready.assembled.positions, course.ready.kinematics.numbers
    slide = at.drives.get(guide, slide_of(ARRAYS, numbers, at, guide, point))
    return float(slide * TURN / numbers.space.period(ARRAYS, numbers.curve(guide)))


def hinge_angles_at(course: UnwoundAngle, at: Positions, samples: Samples, parameter: Array) -> Array | None:
    """Angles (lanes, n, hinges) [rad] at the moving hinges of a linkage on the sphere; None in the plane.

    In the initial position they lie in (-pi, pi].
    """
    if samples.layout.runs_on:
        return None
    hinges = moving_hinges(course.ready.mechanism)
    angles, nearest, start = (
        np.empty((*samples.status.shape, len(hinges))),
        course.nearest(parameter),
        course.ready.assembled.positions,
    )
    for k, hinge in enumerate(hinges):
        rotor = partial(rotor_of_hinge, hinge)
        initial = float(_angle_of(rotor(course.ready.kinematics.numbers, start)))
        cosine, sine = np.broadcast_arrays(*rotor(course.numbers, at))
        turns = course.turns(rotor, initial).at(nearest, cosine, sine, parameter)
        angles[..., k] = np.arctan2(sine, cosine) + TURN * turns
    return angles


# Where rolling wheels touch their tracks: the instant centre of each wheel against the body it rolls on.


def contacts_at(kinematics: Kinematics, at: Positions, samples: Samples) -> Array:
    """Contact points (lanes, n, rolling wheels, 2) [m] in description order; NaN where there is no position."""
    wheels = [c for c in kinematics.structure.constraints if isinstance(c, TrackContact)]
    # in the order of the description, as its constraints are
    contacts = np.empty((*samples.status.shape, len(wheels), 2))
    for k, contact in enumerate(wheels):
        for axis, x in enumerate(contact_point(contact, ARRAYS, kinematics.numbers, at)):
            contacts[..., k, axis] = x
    contacts[~np.isfinite(samples.columns[0]).all(axis=0)] = np.nan
    return contacts


# How well every constraint holds at every sample, redundant constraints and the unit length of axes included.

Namespace: TypeAlias = Any


CLOSED = 1e-7
"""Greatest residual of a position: far above rounding, even next to limits and change points."""


@dataclass(frozen=True)
class UnitLength:
    """Constraint that a link's axes keep their unit length, that is, the distances within the link."""

    link: str

    @property
    def label(self) -> str:
        """Name for messages."""
        return _("length of link {link}").format(link=self.link)


Kept: TypeAlias = Constraint | UnitLength


def residuals(kinematics: Kinematics, samples: Samples, at: Positions) -> tuple[Array, Kept]:
    """Greatest residual at each sample (lanes, n), from its positions, and the constraint that is worst of all.

    Lengths are measured in the mechanism's greatest length, angles in rad; NaN where there is no position.
    """
    worst = np.zeros(samples.status.shape)
    greatest: dict[Kept, float] = {}
    with np.errstate(all="ignore"):
        for kept, size, angular in each_residual(kinematics, ARRAYS, at):
            relative = size / (1.0 if angular else kinematics.numbers.scale)
            # maximum lets NaN win: a constraint without a value leaves the sample without a residual
            worst = np.maximum(worst, relative)
            # fmax lets it lose
            greatest[kept] = float(np.fmax.reduce(relative, axis=None, initial=0.0))
    if samples.status.any():
        worst[~np.isfinite(samples.columns[0]).all(axis=0)] = np.nan
    return worst, max(greatest, key=greatest.__getitem__)


def each_residual(kinematics: Kinematics, m: Namespace, at: Positions) -> Iterator[tuple[Kept, Number, bool]]:
    """Every constraint, drives included, with the size of its residual over any algebra, and whether it has no unit."""
    numbers, space = kinematics.numbers, kinematics.numbers.space
    for constraint in kinematics.structure.constraints:
        # hinges by the distance of the two places, which does not depend on the axes
        left = constraint.apart if isinstance(constraint, PointInLink) else constraint.residual
        size = [m.abs(r) for r in left(m, numbers, at)]
        yield constraint, functools.reduce(m.max, size), constraint.angular
    for link in kinematics.structure.mechanism.links:
        stretch = [m.abs(x) for x in space.stretch(space.attitude(at.poses[link]))]
        yield UnitLength(link), functools.reduce(m.max, stretch), True


def open_what_does_not_close(samples: Samples, residual: Array) -> None:
    """A sample at which a constraint does not hold is open: a redundant link of a batch may not fit everywhere."""
    with np.errstate(invalid="ignore"):
        broken = residual > CLOSED
    if broken.any():
        samples.status[broken] = Status.OPEN
        residual[broken] = np.nan
        # what was opened is taken out of the arrays
        settle(samples)


# Positions anywhere on a path whose events have been looked for once.


@dataclass(frozen=True)
class Filled:
    """Results at samples besides their columns: positions as plain arrays, residuals, the worst constraint."""

    at: Positions
    residual: Array
    worst_constraint: Kept


@dataclass(frozen=True)
class MotionOnPath:
    """A plan with everything that happens along a stretch of its path.

    Attributes
    ----------
    continuation : the plan with its events
    course : angles and displacements that run on over turns
    """

    continuation: BranchedPlan
    course: UnwoundAngle

    @classmethod
    def along(cls, ready: Ready, kinematics: Kinematics, parameter: Array, lanes: int = 1) -> MotionOnPath:
        """Search the path between the initial position and all values of the parameter."""
        continuation = start_of(ready, kinematics, lanes)
        mesh = mesh_of(kinematics.path, parameter)
        on_mesh = EventScan(continuation, mesh).run()
        quick = QuickTurns(continuation, mesh, len(kinematics.structure.groups))
        return cls(continuation, UnwoundAngle(ready, kinematics.numbers, on_mesh, mesh, quick))

    @property
    def mesh(self) -> Array:
        """The nodes on which events were looked for."""
        return self.course.mesh

    def fill(self, parameter: Array, samples: Samples) -> Filled:
        """Fill in columns, angles and statuses at values of the parameter on the stretch."""
        kinematics = self.continuation.kinematics
        sample(self.continuation, parameter, samples)
        settle(samples)
        fill_angles(self.course, samples, parameter)
        at = positions_from(kinematics, samples.layout, samples.columns[0], samples.angles[0], parameter)
        residual, worst = residuals(kinematics, samples, at)
        # slides after residuals: constraints know no rounds along a guide
        open_what_does_not_close(samples, residual)
        fill_slides(self.course, samples, parameter)
        return Filled(at, residual, worst)

    def at(self, parameter: Array) -> Samples:
        """Columns, angles and statuses at values of the parameter on the stretch."""
        layout = layout_of(self.continuation.kinematics)
        samples = blank(layout, self.continuation.branches.lanes, len(parameter))
        self.fill(parameter, samples)
        return samples


def blank(layout: PlanLayout, lanes: int, count: int) -> Samples:
    """Room for samples."""
    columns = np.empty((ORDERS, layout.width, lanes, count))
    angles = np.empty((ORDERS, len(layout.angles), lanes, count))
    return Samples(layout, columns, angles, np.zeros((lanes, count), dtype=np.int8))


def start_of(ready: Ready, kinematics: Kinematics, lanes: int = 1) -> BranchedPlan:
    """A plan with the signs of the initial position, before any event is known."""
    smooth = ready.mechanism.assembly.continuation == "smooth"
    start = ready.assembled
    branches = branches_at_start(kinematics.path, start.signs, start.angles, smooth, lanes)
    return BranchedPlan(kinematics, branches, start.positions, ready.kinematics.numbers)
