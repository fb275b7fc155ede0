"""A mechanism on the way: its motion for a player, and the drive's value that brings a dragged point to the cursor."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.app.documents import Document
from centrode.app.sketch import SketchParts, Vector
from centrode.errors import CentrodeError, InputError, Status
from centrode.kinematics.motion import motion
from centrode.kinematics.path import even_grid
from centrode.kinematics.preparation import Ready
from centrode.kinematics.samples import MotionOnPath
from centrode.kinematics.solve import SEARCH, TURNS, fit_for, requested_grid
from centrode.locale import _
from centrode.model.mechanism import Mechanism
from centrode.model.settings import shown_as
from centrode.scenes.driving_cams import driving_cams

Array = npt.NDArray[np.float64]

MOST_SAMPLES = 1441
"""Samples of one motion for the page: a quarter of a degree of a turn."""
TABLE = 721
"""Places of the way that are known before a drag."""
REACH = 0.12
"""How far along the way [of its extent] a step looks around the present place."""
NEWTON_STEPS = 6
"""Steps of Newton's method between two places of the table."""


@dataclass(frozen=True)
class DragWay:
    """The way of a mechanism by its parameter: one that a drag follows.

    Attributes
    ----------
    places : parameter at the nodes of the table
    points, slopes, bends : (nodes, points, axes) [m], and derivatives by the parameter; NaN where it is not reached
    closes : whether the last node is the first one again
    """

    ready: Ready
    on_path: MotionOnPath
    places: Array
    points: Array
    slopes: Array
    bends: Array
    reached: npt.NDArray[np.bool_]
    closes: bool
    names: tuple[str, ...]

    def at(self, parameter: float) -> tuple[Array, Array, int]:
        """Points of the frame and others (points, axes), angles of links, and the status at a parameter."""
        samples = self.on_path.at(np.array([parameter]))
        layout = samples.layout
        axes = layout.axes
        moving = samples.columns[0, : layout.first_attitude, 0, 0].reshape(-1, axes)
        fixed = np.array([list(place) for place in _frame_points(self.ready).values()], dtype=float).reshape(
            -1, axes
        )
        return np.concatenate([fixed, moving]), samples.angles[0, :, 0, 0], int(samples.status[0, 0])


def _frame_points(ready: Ready) -> Mapping[str, Vector]:
    """Points of the frame in the initial position."""
    at = ready.assembled.positions.points
    return {name: at[name] for name in ready.structure.dimensions.frame}


@dataclass(frozen=True)
class _ById:
    """A prepared mechanism as a key: it is itself kept with its document."""

    prepared: Ready

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _ById) and self.prepared is other.prepared

    def __hash__(self) -> int:
        return id(self.prepared)


def way_of(document: Document) -> DragWay:
    """The way of a mechanism; InputError where it does not move."""
    return _kept_way(_ById(document.require_prepared()))


@lru_cache(maxsize=8)
def _kept_way(key: _ById) -> DragWay:
    prepared = key.prepared
    path = prepared.kinematics.path
    if path.parameter.is_uniform:
        initial, turn = float(path.initial), 2.0 * math.pi
        extent = turn * TURNS if path.turns else SEARCH * path.unit
        ends = np.array([initial - extent, initial + extent])
        looked = MotionOnPath.along(prepared, prepared.kinematics, ends)
        low, high = path.possible(*looked.continuation.branches.reach(0))
        closes = path.turns and high - low >= turn
        if closes:
            low, high = initial, initial + turn
        low, high = max(low, initial - extent), min(high, initial + extent)
        grid = even_grid(path, TABLE, low, high, (-np.inf, np.inf))
    else:
        closes = False
        grid = requested_grid(prepared, TABLE, None, None)
    fitted = fit_for(prepared, grid)
    on_path = MotionOnPath.along(fitted, fitted.kinematics, grid.parameter)
    samples = on_path.at(grid.parameter)
    layout = samples.layout
    moving = samples.columns[:, : layout.first_attitude, 0].reshape(3, -1, layout.axes, TABLE)
    points, slopes, bends = np.moveaxis(moving, 3, 1)
    reached = np.isfinite(points).all(axis=(1, 2)) & (samples.status[0] != Status.CUT_OFF)
    return DragWay(
        fitted, on_path, grid.parameter, points, slopes, bends, reached, closes, tuple(layout.points)
    )


def move_refusal(sketch: SketchParts, name: str) -> str:
    """Why a point cannot be dragged to move the mechanism; empty where it can."""
    if name in sketch.frame_points:
        return _("a point of the frame does not move")
    if sketch.document.position is None:
        return _("the mechanism cannot move yet")
    return ""


def place_on_way(way: DragWay, point: str, to: Array, present: float | None) -> float:
    """The parameter that brings a point nearest to a place, sought along the way from the present one."""
    if point not in way.names:
        raise InputError(point, _("this point does not move"))
    track = way.points[:, way.names.index(point)]
    away = np.where(way.reached, np.sum((track - to) ** 2, axis=1), np.inf)
    initial = float(way.ready.kinematics.path.initial) if present is None else present
    count = len(way.places)
    turns = 0.0
    if way.closes:
        span = way.places[-1] - way.places[0]
        turns = math.floor((initial - way.places[0]) / span) * span
    node = int(np.argmin(np.abs(way.places + turns - initial)))
    reach = max(2, round(REACH * count))
    best = _nearest_node(away, node, reach, way.closes)
    return _refine_parameter(way, point, to, best) + _same_turn(way, best, node, turns)


def _nearest_node(away: Array, node: int, reach: int, closes: bool) -> int:
    """The best node that is reached from a node without passing one that is not reached, window by window."""
    count = len(away)
    while True:
        best = node
        for step in (1, -1):
            k = node
            for _step in range(reach):
                k += step
                if closes:
                    k %= count - 1
                elif not 0 <= k < count:
                    break
                if not np.isfinite(away[k]):
                    break
                if away[k] < away[best]:
                    best = k
        if best == node:
            return node
        node = best


def _same_turn(way: DragWay, best: int, node: int, turns: float) -> float:
    """What to add to the place of a node of the table so that it lies beside the present place."""
    if not way.closes:
        return 0.0
    count = len(way.places) - 1
    span = float(way.places[-1] - way.places[0])
    if best - node > count / 2:
        return turns - span
    if node - best > count / 2:
        return turns + span
    return turns


def _refine_parameter(way: DragWay, point: str, to: Array, node: int) -> float:
    """The parameter of the least distance beside a node, by the Taylor polynomial of second degree about it."""
    k = way.names.index(point)
    step = float(np.abs(way.places[1] - way.places[0])) if len(way.places) > 1 else 0.0
    gap, slope, bend = way.points[node, k] - to, way.slopes[node, k], way.bends[node, k]
    if not (np.isfinite(slope).all() and np.isfinite(bend).all()):
        return float(way.places[node])
    shift = 0.0
    for _iteration in range(NEWTON_STEPS):
        place, speed = gap + shift * (slope + 0.5 * shift * bend), slope + shift * bend
        first, second = float(place @ speed), float(speed @ speed + place @ bend)
        if second <= 0.0:
            break
        shift = min(max(shift - first / second, -step), step)
    low, high = float(np.min(way.places)), float(np.max(way.places))
    found = float(way.places[node]) + shift
    return found if way.closes else min(max(found, low), high)


# The motion for a player.

STATUS_WORDS = tuple(Status)[:5]


def motion_answer(mechanism: Mechanism, samples: int | None) -> tuple[dict[str, Any], dict[str, Any]]:
    """Header and arrays of the motion of a mechanism over its range."""
    count = min(max(samples or mechanism.study.samples or 361, 2), MOST_SAMPLES)
    data = motion(mechanism, count)
    parameter = mechanism.motion_parameter
    variable = parameter.variable
    factor, unit = shown_as(variable.unit, mechanism.display)
    instants = np.asarray(parameter.instants(data), dtype=float)
    kinds = {"rad": "angle", "m": "length", "s": "time"}
    header = {
        "points": data["point"].to_numpy().tolist(),
        "links": data["link"].to_numpy().tolist(),
        "samples": count,
        "kind": kinds.get(variable.unit, "time"),
        "unit": unit,
        "factor": factor,
        "status_words": {str(int(status)): _(status.word) for status in STATUS_WORDS},
        "reached": {str(int(status)): status in (Status.OK, Status.SINGULAR) for status in STATUS_WORDS},
        "events": [
            {
                "drive": float(at),
                "kind": ("limit", "change point")[int(kind)],
                "text": _(("limit", "change point")[int(kind)]),
                "group": str(group),
            }
            for at, kind, group in zip(
                data["event_value"].to_numpy(),
                data["event_kind"].to_numpy(),
                data["event_group"].to_numpy(),
                strict=True,
            )
        ],
    }
    arrays = {
        "drive": instants,
        "time": data["time"].to_numpy(),
        "points": data["position"].to_numpy(),
        "velocities": data["velocity"].to_numpy(),
        "accelerations": data["acceleration"].to_numpy(),
        "status": data["status"].to_numpy(),
    }
    for name, key in (
        ("angles", "angle"),
        ("angular_velocities", "angular_velocity"),
        ("angular_accelerations", "angular_acceleration"),
    ):
        if key in data:
            arrays[name] = data[key].to_numpy()
    header["cams"] = _add_cams(mechanism, data, arrays)
    return header, arrays


def _add_cams(mechanism: Mechanism, data: xr.Dataset, arrays: dict[str, Any]) -> list[dict[str, Any]]:
    """Cams that drive, as they stand at the first sample, and what follows each of them at every sample."""
    try:
        cams = driving_cams(mechanism, data, 1.0)
    except CentrodeError:
        return []
    found = []
    for k, cam in enumerate(cams):
        samples = range(len(cam.angles))
        rollers = [cam.roller(sample) for sample in samples]
        lines = [np.array(cam.lines(sample)).reshape(-1) for sample in samples]
        turned = cam.angles - cam.angles[0]
        arrays[f"cam_turns_{k}"] = turned if cam.forward else -turned
        arrays[f"cam_lines_{k}"] = np.array(lines)
        if rollers[0] is not None:
            arrays[f"cam_rollers_{k}"] = np.array([roller[0] for roller in rollers if roller is not None])
        found.append(
            {
                "centre": cam.hub.tolist(),
                "outline": cam.outline(0).tolist(),
                "mark": cam.mark(0).tolist(),
                "roller": None if rollers[0] is None else rollers[0][1],
            }
        )
    return found
