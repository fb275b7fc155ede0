"""The motion of a mechanism as plain arrays: events, samples, statuses, angles, residuals."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.kinematics.angles import angles_and_rates, node_angles
from centrode.kinematics.branches import Branches, Event
from centrode.kinematics.evaluate import Kinematics
from centrode.kinematics.events import Scan
from centrode.kinematics.patches import mend_change_points
from centrode.kinematics.paths import Path
from centrode.kinematics.ready import Ready
from centrode.kinematics.residuals import residuals
from centrode.kinematics.sampling import Layout, layout_of, sample, settle
from centrode.kinematics.spans import Span, span_of
from centrode.structure.dimensions import Dimensions

Array: TypeAlias = npt.NDArray[np.float64]
Number: TypeAlias = Any
Progress: TypeAlias = Callable[[int, int], None]

OFF_GRID = 0.37
"""Mesh nodes stand this share of a step away from the initial position: events like to lie at round values."""
CHUNK = 200_000
"""Mechanisms of a batch are solved together as long as mechanisms times samples stay below this."""
SEARCH = 4.0
"""How far the limits of a displacement drive are looked for, in units of the mechanism's greatest length."""


@dataclass(frozen=True)
class Solved:
    """Motion of a batch of mechanisms on one span of samples.

    Arrays hold value, first and second derivative by the path's parameter first: `points` (3, lanes, n,
    points, 2) [m], `angles` (3, lanes, n, links) [rad], `slides` (3, lanes, n, guides) [m]; `status` and
    `residual` (lanes, n).
    """

    ready: Ready
    span: Span
    layout: Layout
    branches: Branches
    points: Array
    angles: Array
    slides: Array
    status: npt.NDArray[np.int8]
    residual: Array
    worst_constraint: str

    def events(self, lane: int = 0) -> list[Event]:
        """Events between the ends of the span and the initial position, in the order of the path."""
        ends = [*self.span.parameter[[0, -1]], self.ready.kinematics.path.initial]
        if len(self.span.parameter) > 1:
            ends += [float(np.min(self.span.parameter)), float(np.max(self.span.parameter))]
        margin = 1e-9 * self.branches.unit
        inside = [e for e in self.branches.events if min(ends) - margin <= e.at <= max(ends) + margin]
        return sorted((e for e in inside if e.lane == lane), key=lambda e: e.at)


def solve(
    ready: Ready,
    samples: int,
    start: float | None = None,
    stop: float | None = None,
    numbers: Dimensions | None = None,
    lanes: int = 1,
    progress: Progress | None = None,
) -> Solved:
    """Motion at evenly spaced samples; `numbers` with one value a mechanism make it a batch of `lanes`."""
    kinematics = ready.kinematics if numbers is None else replace(ready.kinematics, numbers=_upright(numbers))
    reach = _reach_if_needed(ready, start, stop)
    span = span_of(kinematics.path, samples, start, stop, reach)
    size = max(1, CHUNK // max(samples, len(mesh_of(kinematics.path, span.parameter))))
    parts = []
    for first in range(0, lanes, size):
        count = min(size, lanes - first)
        part = kinematics if lanes == 1 else _lanes(kinematics, first, count)
        parts.append(_solve_part(ready, part, span, count))
        if progress is not None:
            progress(first + count, lanes)
    return parts[0] if len(parts) == 1 else _joined(parts)


def mesh_of(path: Path, parameter: Array) -> Array:
    """Nodes on which events are looked for: they belong to the mechanism, only their extent to the samples."""
    low = min(path.initial, float(np.min(parameter)))
    high = max(path.initial, float(np.max(parameter)))
    first = int(np.floor((low - path.initial) / path.step)) - 2
    last = int(np.ceil((high - path.initial) / path.step)) + 2
    nodes = np.arange(first, last + 1, dtype=np.float64)
    return path.initial + (nodes + OFF_GRID) * path.step


def branches_of(ready: Ready, lanes: int = 1) -> Branches:
    """Signs in the initial position, before any event is known."""
    path = ready.kinematics.path
    signs = {group: np.full(lanes, sign) for group, sign in ready.assembled.signs.items()}
    smooth = ready.mechanism.assembly.continuation == "smooth"
    return Branches(path.initial, path.forward, path.unit, lanes, signs, smooth)


def _reach_if_needed(ready: Ready, start: float | None, stop: float | None) -> tuple[float, float]:
    path = ready.kinematics.path
    if path.by_time or path.driven[0].drive.kind == "angle" or (start is not None and stop is not None):
        return -np.inf, np.inf
    ends = np.array([path.initial - SEARCH * path.unit, path.initial + SEARCH * path.unit])
    branches = branches_of(ready)
    Scan(ready.kinematics, branches, mesh_of(path, ends)).run()
    return branches.reach(0)


def _upright(numbers: Dimensions) -> Dimensions:
    """Arrays of a batch as columns, so that they meet samples in the last axis."""
    return numbers.mapped(lambda x: x if isinstance(x, float) else np.asarray(x, dtype=np.float64)[:, None])


def _lanes(kinematics: Kinematics, first: int, count: int) -> Kinematics:
    def cut(x: Number) -> Number:
        return x if isinstance(x, float) else x[first : first + count]

    return replace(kinematics, numbers=kinematics.numbers.mapped(cut))


def _solve_part(ready: Ready, kinematics: Kinematics, span: Span, lanes: int) -> Solved:
    layout = layout_of(kinematics)
    branches = branches_of(ready, lanes)
    mesh = mesh_of(kinematics.path, span.parameter)
    on_mesh = Scan(kinematics, branches, mesh).run()
    samples = sample(kinematics, layout, branches, span.parameter)
    mend_change_points(kinematics, branches, samples, span.parameter)
    settle(samples)
    residual, worst = residuals(kinematics, samples, span.parameter)
    points, rotors, slides = _split(layout, samples.columns)
    angles = _angles(ready, layout, on_mesh, mesh, rotors, span.parameter)
    return Solved(
        ready,
        span,
        layout,
        branches,
        np.moveaxis(points, (1, 2), (3, 4)),
        np.moveaxis(angles, 1, 3),
        np.moveaxis(slides, 1, 3),
        samples.status,
        residual,
        worst,
    )


def _split(layout: Layout, columns: Array) -> tuple[Array, Array, Array]:
    tail = columns.shape[2:]
    points = columns[:, : layout.first_rotor].reshape(3, len(layout.points), 2, *tail)
    rotors = columns[:, layout.first_rotor : layout.first_slide].reshape(3, len(layout.links), 2, *tail)
    return points, rotors, columns[:, layout.first_slide :]


def _angles(
    ready: Ready, layout: Layout, on_mesh: Any, mesh: Array, rotors: Array, parameter: Array
) -> Array:
    path = ready.kinematics.path
    start = int(np.argmin(np.abs(mesh - path.initial)))
    initial = np.array([ready.assembled.angles[link] for link in layout.links])
    nodes = node_angles(on_mesh, layout.links, initial, start, (rotors.shape[3], len(mesh)))
    nearest = np.clip(np.round((parameter - mesh[0]) / path.step).astype(np.intp), 0, len(mesh) - 1)
    return np.stack(angles_and_rates(rotors, nodes, nearest))


def _joined(parts: Sequence[Solved]) -> Solved:
    def joined(name: str, axis: int) -> Any:
        return np.concatenate([getattr(part, name) for part in parts], axis=axis)

    worst = max(parts, key=lambda part: float(np.nanmax(part.residual, initial=0.0)))
    branches = parts[0].branches
    lane = 0
    events: list[Event] = []
    for part in parts:
        events += [replace(event, lane=event.lane + lane) for event in part.branches.events]
        lane += part.branches.lanes
    signs: Mapping[int, Array] = {
        group: np.concatenate([part.branches.signs[group] for part in parts]) for group in branches.signs
    }
    return replace(
        parts[0],
        branches=replace(branches, lanes=lane, signs=dict(signs), events=events),
        points=joined("points", 1),
        angles=joined("angles", 1),
        slides=joined("slides", 1),
        status=joined("status", 0),
        residual=joined("residual", 0),
        worst_constraint=worst.worst_constraint,
    )
