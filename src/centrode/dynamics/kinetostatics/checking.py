"""Three checks of solved reactions by other ways: equilibrium of every body, momentum, power."""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.kinetostatics.finding import Found
from centrode.dynamics.kinetostatics.solution import Forces
from centrode.dynamics.kinetostatics.stacking import column
from centrode.dynamics.pulls import Pull, total
from centrode.errors import Status
from centrode.structure.positions import Entity

Array: TypeAlias = npt.NDArray[np.float64]
Number: TypeAlias = Any


def checks_of(found: Found, rates: Array) -> dict[str, float]:
    """Worst residuals over all samples that are ok, each over the greatest force or moment of its sample, or power.

    `rates` (samples, drives) are the speeds of the drives.
    """
    return {
        "equilibrium_residual": _worst(found, *_equilibrium(found.forces)),
        "frame_residual": _worst(found, *_frame(found)),
        "power_residual": _worst(found, *_power(found, rates)),
    }


def _worst(found: Found, missing: Array, size: Array) -> float:
    good = found.status == Status.OK
    with np.errstate(all="ignore"):
        share = np.where(missing == 0.0, 0.0, missing / size)
    return float(np.max(share[good], initial=0.0))


def _equilibrium(forces: Forces) -> tuple[Array, Array]:
    """What is missing to the equilibrium of every pin and link, moments about its first point; greatest force."""
    system, mechanism = forces.system, forces.system.scheme.structure.mechanism
    samples = system.shape[-1]
    on: dict[Entity, list[Pull]] = {entity: [] for entity in system.scheme.structure.unknowns}
    size: Number = 0.0
    for pull in forces.all_pulls:
        if pull.body in on:
            on[pull.body].append(pull)
        size = np.maximum(size, np.maximum(np.abs(pull.force[0]), np.abs(pull.force[1])))
        size = np.maximum(size, np.abs(pull.moment) / system.scale)
    missing: Number = 0.0
    for entity, pulls in on.items():
        point = next(iter(mechanism.links[entity.name].coordinates)) if entity.kind == "link" else entity.name
        x, y, moment = total(pulls, system.at.points[point])
        missing = np.maximum(missing, np.maximum(np.abs(x), np.abs(y)))
        missing = np.maximum(missing, np.abs(moment) / system.scale) if entity.kind == "link" else missing
    return column(missing, samples), column(size, samples)


def _frame(found: Found) -> tuple[Array, Array]:
    """What the frame bears, less all loads and the inertia forces, which are minus the rate of momentum."""
    forces, scale = found.forces, found.forces.system.scale
    samples = forces.system.shape[-1]
    borne, acting = total(forces.on_frame), total(found.outer.pulls)
    missing: Number = 0.0
    size: Number = 0.0
    for k, unit in enumerate((1.0, 1.0, scale)):
        missing = np.maximum(missing, np.abs(borne[k] - acting[k]) / unit)
    for pull in [*forces.on_frame, *found.outer.pulls]:
        size = np.maximum(size, np.maximum(np.abs(pull.force[0]), np.abs(pull.force[1])))
        size = np.maximum(size, np.abs(pull.moment_about((0.0, 0.0))) / scale)
    return column(missing, samples), column(size, samples)


def _power(found: Found, rates: Array) -> tuple[Array, Array]:
    """Power of the drives, and of loads and inertia by virtual work; the greatest of the whole motion."""
    given = found.parts["balancing"] * rates
    taken = found.outer.moment[0] * found.pace.moving.rate
    good = found.status == Status.OK
    greatest = np.max((np.abs(given).sum(axis=-1) + np.abs(taken))[good], initial=0.0)
    return np.abs(given.sum(axis=-1) + taken), np.full(len(good), greatest)
