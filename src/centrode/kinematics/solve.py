"""The motion of a mechanism as plain arrays: events, samples, statuses, angles, residuals."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from numbers import Real
from typing import Any, TypeAlias, cast

import numpy as np
import numpy.typing as npt

from centrode.errors import InputError
from centrode.kinematics.assembly import with_phases
from centrode.kinematics.events import EventScan
from centrode.kinematics.mesh import mesh_of
from centrode.kinematics.path import SampleGrid, even_grid, grid_at, places_of
from centrode.kinematics.plan_evaluation import Branches, Kinematics, PlanLayout, RadicandZero, layout_of
from centrode.kinematics.preparation import Ready
from centrode.kinematics.samples import (
    Kept,
    MotionOnPath,
    ResultArrays,
    Samples,
    contacts_at,
    hinge_angles_at,
    start_of,
)
from centrode.locale import _
from centrode.model.motion_parameter import MotionVariable
from centrode.model.settings import REACHABLE
from centrode.numerics.rooms import GivenRoom
from centrode.structure.dimensions import Dimensions

Array: TypeAlias = npt.NDArray[np.float64]
Number: TypeAlias = Any
Progress: TypeAlias = Callable[[int, int], None]

CHUNK = 100_000
"""Mechanisms of a batch are solved together as long as mechanisms times samples stay below this."""
GREATEST_RESULT = 10_000_000
"""Coordinates in one result, samples and mechanisms together: with derivatives and labels some 1 GB."""
BYTES = 100
"""Memory of a coordinate at a sample, with its derivatives, its labels and what is needed on the way."""
DEFAULT_SAMPLES = 361
"""One a degree over a turn, both ends included."""
TURNS = 2.0
"""How far the limits of an angle are looked for on both sides: a motion through change points may need two turns."""
SEARCH = 4.0
"""How far the limits of a displacement drive are looked for, in units of the mechanism's greatest length."""


@dataclass(frozen=True)
class Solved:
    """Motion of a batch of mechanisms on one span of samples.

    Arrays hold value, first and second derivative by the path's parameter first: `points` (3, lanes, n,
    points, axes), `angles` (3, lanes, n, angles) [rad], `slides` (3, lanes, n, guides); `status` and `residual`
    (lanes, n). `all_points` has the frame's points before the moving ones. `spins` (2, lanes, n, links, 3) are
    rotation vectors [rad] by the parameter and their derivatives, `attitudes` (3, lanes, n, links, 3, 3) their axes in
    those of the frame; neither where angles say it all. `contacts`
    (lanes, n, rolling wheels, axes) are the places where wheels touch their tracks, `hinges` (lanes, n, hinges) the
    angles [rad] at the moving hinges on the sphere, with their turns; None where these are not counted.
    """

    ready: Ready
    span: SampleGrid
    layout: PlanLayout
    branches: Branches
    all_points: Array
    points: Array
    angles: Array
    slides: Array
    spins: Array | None
    attitudes: Array | None
    status: npt.NDArray[np.int8]
    residual: Array
    worst_constraint: Kept
    contacts: Array
    hinges: Array | None = None

    def events(self, lane: int = 0) -> list[RadicandZero]:
        """Events between the ends of the span and the initial position, in the order of the path."""
        initial = self.ready.kinematics.path.initial
        ends = [initial, float(np.min(self.span.parameter)), float(np.max(self.span.parameter))]
        # an event at an end of the span was found with an error of rounding
        margin = 1e-9 * self.branches.unit
        inside = [e for e in self.branches.events if min(ends) - margin <= e.at <= max(ends) + margin]
        return sorted((e for e in inside if e.lane == lane), key=lambda e: e.at)


def grid_of(
    ready: Ready,
    samples: int | None,
    start: float | str | None,
    stop: float | str | None,
    at: npt.ArrayLike | None,
) -> SampleGrid:
    """Evenly spaced samples, or exactly the places `at` where there are some; numbers in SI or texts with a unit."""
    if at is None:
        return requested_grid(ready, samples, start, stop)
    return grid_at(ready.kinematics.path, places_of(ready.parameter.instant, at))


def requested_grid(
    ready: Ready, samples: int | None, start: float | str | None, stop: float | str | None
) -> SampleGrid:
    """Evenly spaced samples; what is left out is what the description asks for."""
    study, instant = ready.mechanism.study, ready.parameter.instant
    start, stop = (_end(instant, end, name) for name, end in (("start", start), ("stop", stop)))
    start = study.start if start is None else start
    stop = study.stop if stop is None else stop
    # the description's number before the program's own
    count = samples if samples is not None else study.samples or DEFAULT_SAMPLES
    reachable = study.range == REACHABLE
    reach = _reach_if_needed(ready, start, stop, reachable)
    return even_grid(ready.kinematics.path, count, start, stop, reach, reachable)


def _end(instant: MotionVariable, end: Any, name: str) -> float | None:
    """An end of a range in SI; a number is looked at with the range, a text read."""
    return cast(float, end) if end is None or isinstance(end, Real) else instant.read(end, name)


def solve(
    ready: Ready,
    span: SampleGrid,
    numbers: Dimensions | None = None,
    lanes: int = 1,
    progress: Progress | None = None,
    given: GivenRoom | None = None,
) -> Solved:
    """Motion at the samples of a span; its arrays are fresh, or views of given room."""
    ready = fit_for(ready, span)
    kinematics = ready.kinematics if numbers is None else of_batch(ready.kinematics, numbers)
    samples = len(span.parameter)
    layout = layout_of(kinematics)
    check_size(layout, lanes, samples)
    size = lanes_at_once(kinematics, span)
    room = ResultArrays.of(layout, kinematics.numbers, lanes, samples, given)
    parts = []
    for first in range(0, lanes, size):
        rows = slice(first, min(first + size, lanes))
        # parts of a batch write into one room: nothing is joined afterwards
        part = kinematics if lanes == 1 else of_lanes(kinematics, rows)
        parts.append(_solve_part(ready, part, span, room.samples.of(rows)))
        if progress is not None:
            progress(rows.stop, lanes)
    room.fill_frame(kinematics.numbers)
    points = room.all_points
    return Solved(
        ready,
        span,
        layout,
        _join_branches([part.branches for part in parts]),
        points,
        points[:, :, :, len(kinematics.numbers.frame) :],
        room.all_angles,
        room.slides,
        room.spins,
        room.attitudes,
        room.status,
        np.concatenate([part.residual for part in parts]),
        # the first of equal parts: the same constraint whatever the parts
        max(parts, key=lambda part: float(np.nanmax(part.residual, initial=0.0))).worst_constraint,
        np.concatenate([part.contacts for part in parts]),
        None if parts[0].hinges is None else np.concatenate([part.hinges for part in parts]),
    )


def lanes_at_once(kinematics: Kinematics, span: SampleGrid) -> int:
    """Number of mechanisms of a batch that are solved together."""
    return max(1, CHUNK // max(len(span.parameter), len(mesh_of(kinematics.path, span.parameter))))


def size_of(layout: PlanLayout, lanes: int, samples: int) -> int:
    """Memory [bytes] that a result takes, on the way to it as well."""
    return BYTES * lanes * samples * max(layout.width, 1)


def check_size(layout: PlanLayout, lanes: int, samples: int) -> None:
    """Refuse a result that would not fit into the memory of an ordinary machine."""
    most = GREATEST_RESULT // max(layout.width, 1)
    if lanes * samples > most:
        raise InputError(
            _("samples"),
            _("{asked} positions would take {size:.3g} GB of memory").format(
                asked=lanes * samples, size=size_of(layout, lanes, samples) / 1e9
            ),
            _("give at most {most} at once, samples times mechanisms").format(most=most),
        )


def fit_for(ready: Ready, span: SampleGrid) -> Ready:
    """With several drives: the path's unit of time, by which groups of higher class are followed, fit for the span."""
    kinematics = ready.kinematics
    ends = np.append(span.parameter, kinematics.path.initial)
    # with the initial position, from which groups are followed
    path = kinematics.path.within(float(np.min(ends)), float(np.max(ends)))
    return replace(ready, kinematics=replace(kinematics, path=path))


def _reach_if_needed(
    ready: Ready, start: float | None, stop: float | None, reachable: bool
) -> tuple[float, float]:
    path = ready.kinematics.path
    if path.by_time or (path.turns and not reachable) or (start is not None and stop is not None):
        return -np.inf, np.inf
    extent = 2.0 * np.pi * TURNS if path.turns else SEARCH * path.unit
    # on both sides, as a drive may run either way
    ends = np.array([path.initial - extent, path.initial + extent])
    continuation = start_of(ready, ready.kinematics)
    EventScan(continuation, mesh_of(path, ends)).run()
    low, high = continuation.branches.reach(0)
    # a cylinder does not get shorter than zero
    return path.possible(low, high)


def of_batch(kinematics: Kinematics, numbers: Dimensions) -> Kinematics:
    """The plan with the numbers of a batch; wheels mesh as they do in the description."""
    phases = kinematics.numbers.gearing.phase
    return with_phases(replace(kinematics, numbers=_upright(numbers)), phases)


def _upright(numbers: Dimensions) -> Dimensions:
    """Arrays of a batch as columns, so that they meet samples in the last axis."""
    return numbers.map_numbers(
        lambda x: x if isinstance(x, float) else np.asarray(x, dtype=np.float64)[:, None]
    )


def of_lanes(kinematics: Kinematics, rows: slice | npt.NDArray[np.intp]) -> Kinematics:
    """The plan with the numbers of some mechanisms of a batch."""

    def cut(x: Number) -> Number:
        return x if isinstance(x, float) else x[rows]

    return replace(kinematics, numbers=kinematics.numbers.map_numbers(cut))


@dataclass(frozen=True)
class _Part:
    """Results of some mechanisms of a batch besides the samples."""

    branches: Branches
    residual: Array
    worst_constraint: Kept
    contacts: Array
    hinges: Array | None


def _solve_part(ready: Ready, kinematics: Kinematics, span: SampleGrid, samples: Samples) -> _Part:
    """Fill in the samples and angles of some mechanisms of a batch."""
    places = MotionOnPath.along(ready, kinematics, span.parameter, samples.status.shape[0])
    outcome = places.fill(span.parameter, samples)
    contacts = contacts_at(kinematics, outcome.at, samples)
    hinges = hinge_angles_at(places.course, outcome.at, samples, span.parameter)
    return _Part(places.continuation.branches, outcome.residual, outcome.worst_constraint, contacts, hinges)


def _join_branches(parts: Sequence[Branches]) -> Branches:
    """The branches of a batch from those of its parts: signs and events, which is what is requested afterwards."""
    if len(parts) == 1:
        return parts[0]
    lane = 0
    events: list[RadicandZero] = []
    for part in parts:
        events += [replace(event, lane=event.lane + lane) for event in part.events]
        lane += part.lanes
    signs = {group: np.concatenate([part.signs[group] for part in parts]) for group in parts[0].signs}
    return replace(parts[0], lanes=lane, signs=signs, events=events)
