"""An instant of a motion as a drawing: positions to measure in, rates of the drives, and both constructions."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
import xarray as xr

from centrode.algebra.arrays import ARRAYS
from centrode.algebra.jets import Jet
from centrode.analysis.graphic.board import Board
from centrode.analysis.graphic.construction import construct
from centrode.analysis.graphic.stage import Drawing, Stage
from centrode.geometry.plane import pose_with_point
from centrode.kinematics.path import JETS, SampleGrid
from centrode.kinematics.prepared import Ready
from centrode.structure.constraints import Positions
from centrode.structure.plan import Structure

Driven: TypeAlias = tuple[dict[str, float], dict[str, float]]


def stages(
    structure: Structure, drawing: Drawing, driven: Driven, grains: tuple[float, float] = (0.0, 0.0)
) -> tuple[Stage, Stage]:
    """Velocities and accelerations constructed; lengths of edges are read to the grains [m/s] and [m/s^2]."""
    velocity = Stage(drawing, driven[0], grain=grains[0])
    velocity.points |= dict.fromkeys(drawing.numbers.frame, 0j)
    construct(structure, velocity)
    acceleration = Stage(drawing, driven[1], before=velocity, grain=grains[1])
    acceleration.points |= dict.fromkeys(drawing.numbers.frame, 0j)
    construct(structure, acceleration)
    return velocity, acceleration


def drawing_of(prepared: Ready, exact: xr.Dataset, board: Board) -> Drawing:
    """The mechanism as it stands at the only sample of a motion."""
    return Drawing(prepared.kinematics.numbers, positions_at(prepared, exact), board)


def positions_at(prepared: Ready, exact: xr.Dataset) -> Positions:
    """The mechanism as it is drawn: places and poses at the only sample."""
    numbers = prepared.kinematics.numbers
    at = Positions.of_frame(numbers, {}, ARRAYS)
    for name in exact["point"].to_numpy().tolist():
        x, y = exact["position"].sel(point=name).to_numpy()[0].tolist()
        at.points[name] = (x, y)
    for name in exact["link"].to_numpy().tolist():
        angle = float(exact["angle"].sel(link=name)[0])
        point, local = next(iter(numbers.local[name].items()))
        at.poses[name] = pose_with_point(local, at.points[point], (np.cos(angle), np.sin(angle)))
        at.angles[name] = angle
    return at


def driven_rates(prepared: Ready, span: SampleGrid) -> tuple[dict[str, float], dict[str, float]]:
    """First and second derivatives by time of every drive's value."""
    path = prepared.kinematics.path
    if not path.by_time:
        drive = path.driven[0].drive.id
        return {drive: float(span.rate[0])}, {drive: float(span.second_rate[0])}
    first, second = {}, {}
    for one in path.driven:
        value = one.value(JETS, Jet.variable(span.time, 2))
        value = value if isinstance(value, Jet) else Jet((value, 0.0, 0.0))
        first[one.drive.id], second[one.drive.id] = (
            float(np.broadcast_to(value.derivative(k), (1,))[0]) for k in (1, 2)
        )
    return first, second
