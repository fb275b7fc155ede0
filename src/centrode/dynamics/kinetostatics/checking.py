"""Three checks of solved reactions by other ways: equilibrium of every body, momentum, power."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.kinetostatics.finding import Found
from centrode.dynamics.kinetostatics.solution import Forces
from centrode.dynamics.kinetostatics.stacking import column
from centrode.dynamics.pulls import components, total
from centrode.errors import Status
from centrode.structure.constraints import Entity

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
    """What is missing to the equilibrium of every pin and link, moments about its first point; greatest force.

    The centre of a sphere bears what the forces on a link leave, so that there its moments alone tell.
    """
    system = forces.system
    samples = system.shape[-1]
    sums: dict[Entity, Sequence[Number]] = {entity: (0.0,) * 3 for entity in system.scheme.structure.unknowns}
    size: Number = 0.0
    for pull in forces.acting:
        if pull.body in sums:
            parts = system.on_link(pull.body.name, pull) if pull.body.kind == "link" else pull.force
            sums[pull.body] = tuple(x + y for x, y in zip(sums[pull.body], parts, strict=False))
        size = _greater(_greater(size, pull.force, 1.0), components(pull.moment), system.scale)
    missing: Number = 0.0
    for left in sums.values():
        missing = _greater(missing, left, 1.0)
    return column(missing, samples), column(size, samples)


def _greater(size: Number, parts: Sequence[Number], unit: float) -> Number:
    """The greatest of a size and of some numbers over their unit."""
    for part in parts:
        size = np.maximum(size, np.abs(part) / unit)
    return size


def _frame(found: Found) -> tuple[Array, Array]:
    """What the frame bears, less all loads and the inertia forces, which are minus the rate of momentum."""
    forces, scale = found.forces, found.forces.system.scale
    samples = forces.system.shape[-1]
    origin = forces.system.equilibrium.origin
    (borne, turned), (acting, turning) = total(forces.on_frame, origin), total(found.outer.pulls, origin)
    missing = _greater(0.0, [x - y for x, y in zip(borne, acting, strict=True)], 1.0)
    pairs = zip(components(turned), components(turning), strict=True)
    missing = _greater(missing, [x - y for x, y in pairs], scale)
    size: Number = 0.0
    for pull in [*forces.on_frame, *found.outer.pulls]:
        size = _greater(_greater(size, pull.force, 1.0), components(pull.moment_about(origin)), scale)
    return column(missing, samples), column(size, samples)


def _power(found: Found, rates: Array) -> tuple[Array, Array]:
    """Power of the drives, and of loads and inertia by virtual work; the greatest of the whole motion."""
    given = found.parts["balancing"] * rates
    taken = found.outer.moment[0] * found.pace.moving.rate
    good = found.status == Status.OK
    greatest = np.max((np.abs(given).sum(axis=-1) + np.abs(taken))[good], initial=0.0)
    return np.abs(given.sum(axis=-1) + taken), np.full(len(good), greatest)
