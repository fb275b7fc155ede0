"""What rounding may do to a construction: how much it answers to the positions that are measured in it."""

from __future__ import annotations

import cmath
from dataclasses import replace
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

import centrode as ct
from centrode.analysis.graphic.diagrams import Driven, drawing_of, driven_rates, stages
from centrode.analysis.graphic.stage import ConstructionStage, DrawingBoard, VectorDrawing
from centrode.geometry.plane import PlanePose
from centrode.kinematics.motion import dataset_of
from centrode.kinematics.path import grid_at
from centrode.kinematics.preparation import Ready, ready
from centrode.kinematics.solve import solve
from centrode.structure.constraints import Positions

Array: TypeAlias = npt.NDArray[np.float64]

EPS = 2.0**-52
STEP = 2.0**-30
OPERATIONS = 32.0
"""Rounding errors of each group, by construction and by motion, in units of those that rounded positions would make."""
FIRST = ("velocity", "angular_velocity")
SECOND = ("acceleration", "angular_acceleration")


def errors(mechanism: ct.Mechanism, at: float, tries: int = 4) -> tuple[Array, Array] | None:
    """What velocities and accelerations of a construction are off the motion's, and what rounding allows: (2,), (2,).

    None where the motion has no derivatives.
    """
    prepared = ready(mechanism)
    return errors_of(prepared, at, tries)


def errors_of(prepared: Ready, at: float, tries: int = 4) -> tuple[Array, Array] | None:
    span = grid_at(prepared.kinematics.path, np.array([at]))
    exact = dataset_of(solve(prepared, span))
    if int(exact["status"][0]) not in (ct.Status.OK, ct.Status.CUT_OFF):
        return None
    drawing, driven = drawing_of(prepared, exact, DrawingBoard()), driven_rates(prepared, span)
    found = numbers(stages(prepared.structure, drawing, driven))
    wanted = exact_numbers(exact, stages(prepared.structure, drawing, driven))
    condition = answers(prepared, drawing, driven, tries)
    apart = np.array([np.max(np.abs(f - w), initial=0.0) for f, w in zip(found, wanted, strict=True)])
    return apart, OPERATIONS * len(prepared.structure.groups) * EPS * condition


def answers(prepared: Ready, drawing: VectorDrawing, driven: Driven, tries: int) -> Array:
    """Greatest change of any rate over a relative change of the measured positions, at least its size: (2,)."""
    random = np.random.default_rng(11)
    exact = numbers(stages(prepared.structure, drawing, driven))
    most = np.array([np.max(np.abs(one), initial=1.0) for one in exact])
    for _try in range(tries):
        changed = numbers(stages(prepared.structure, nudged(drawing, random), driven))
        for k in (0, 1):
            change = np.max(np.abs(changed[k] - exact[k]), initial=0.0) / STEP
            most[k] = max(most[k], change)
    return most


def nudged(drawing: VectorDrawing, random: np.random.Generator) -> VectorDrawing:
    """The same drawing with every place and direction changed by up to `STEP` of its size."""
    scale = float(drawing.numbers.scale)

    def place(at: Any) -> tuple[float, float]:
        x, y = STEP * scale * random.uniform(-1.0, 1.0, size=2)
        return at[0] + x, at[1] + y

    def pose(link: str, own: PlanePose) -> PlanePose:
        if link == "frame":
            return own
        turned = complex(*own.rotor) * cmath.exp(1j * STEP * random.uniform(-1.0, 1.0))
        return PlanePose(place(own.origin), (turned.real, turned.imag))

    points = {name: place(at) for name, at in drawing.at.points.items()}
    poses = {name: pose(name, own) for name, own in drawing.at.poses.items()}
    return replace(drawing, at=Positions(points, poses, drawing.at.drives, drawing.at.angles))


def numbers(both: tuple[ConstructionStage, ConstructionStage]) -> tuple[Array, Array]:
    """All rates of both constructions as plain numbers, in the order of their names."""
    return _plain(both[0]), _plain(both[1])


def _plain(stage: ConstructionStage) -> Array:
    points = [part for name in sorted(stage.points) for part in _parts(stage.points[name])]
    return np.array([*points, *(stage.turns[name] for name in sorted(stage.turns))])


def _parts(rate: complex) -> tuple[float, float]:
    return rate.real, rate.imag


def exact_numbers(
    exact: xr.Dataset, both: tuple[ConstructionStage, ConstructionStage]
) -> tuple[Array, Array]:
    """The same from the motion."""
    found = []
    for stage, (moving, turning) in zip(both, (FIRST, SECOND), strict=True):
        points = [
            part
            for name in sorted(stage.points)
            for part in exact[moving].sel(point=name).to_numpy()[0].tolist()
        ]
        turns = [
            0.0 if name == "frame" else float(exact[turning].sel(link=name)[0])
            for name in sorted(stage.turns)
        ]
        found.append(np.array([*points, *turns]))
    return found[0], found[1]
