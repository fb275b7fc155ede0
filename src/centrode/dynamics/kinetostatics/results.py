"""Reactions of all joints from the solved equations, as plain arrays by the names of the dataset."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.kinetostatics.sides import Side, side_forces
from centrode.dynamics.kinetostatics.solution import Forces
from centrode.dynamics.pulls import Pull
from centrode.structure.constraints import Constraint, NoTurning, PointOnGuide, is_drive
from centrode.structure.gearing import Straight
from centrode.structure.wheels import Contact, GearRatio, NoSlip

Array: TypeAlias = npt.NDArray[np.float64]
Number: TypeAlias = Any


def reactions_of(forces: Forces, sides: Sequence[Side]) -> dict[str, Array]:
    """Every reaction, (samples, ...) as the dataset has it."""
    structure = forces.system.scheme.structure
    of_kind = {
        kind: [c for c in structure.constraints if isinstance(c, kind)]
        for kind in (PointOnGuide, GearRatio, Contact, NoSlip)
    }
    found = {
        "joint_force": _stacked(forces, [list(pair) for pair in side_forces(forces, sides).values()]),
        "balancing": _stacked(forces, [_value(forces, c) for c in structure.constraints if is_drive(c)]),
    }
    if of_kind[PointOnGuide]:
        found |= _of_guides(forces, of_kind[PointOnGuide])
    if of_kind[GearRatio]:
        found |= _of_gears(forces, of_kind[GearRatio])
    if of_kind[Contact]:
        found |= _of_wheels(forces, of_kind[Contact], of_kind[NoSlip])
    return found


def _value(forces: Forces, constraint: Constraint | None) -> Number:
    """Multiplier of a constraint of one row; zero of one that repeats others, or that there is none of."""
    return 0.0 if constraint is None else forces.multipliers.get((constraint, 0), 0.0)


def _stacked(forces: Forces, values: Sequence[Any]) -> Array:
    """Nested lists of numbers over the samples as one array, samples first."""
    if values and isinstance(values[0], list):
        return np.stack([_stacked(forces, value) for value in values], axis=1)
    return np.stack([np.broadcast_to(value, forces.system.shape)[0] for value in values], axis=-1)


def _force_of(pulls: Iterable[Pull]) -> list[Number]:
    """The first of the forces that a constraint exerts: on the point, slider or wheel; carriers come after."""
    return next(list(pull.force) for pull in pulls if not isinstance(pull.force[0], float) or any(pull.force))


def _of_guides(forces: Forces, guides: Sequence[Constraint]) -> dict[str, Array]:
    turning = {c.guide: c for c in forces.system.scheme.structure.constraints if isinstance(c, NoTurning)}
    normal = [_value(forces, c) for c in guides]
    units = [_force_of(forces.system.pulls[c, 0]) for c in guides]
    vectors = [[value * x for x in unit] for value, unit in zip(normal, units, strict=True)]
    moments = [_value(forces, turning.get(c.guide)) for c in guides if isinstance(c, PointOnGuide)]
    return {
        "guide_force": _stacked(forces, vectors),
        "guide_normal": _stacked(forces, normal),
        "guide_moment": _stacked(forces, moments),
    }


def _of_gears(forces: Forces, gears: Sequence[Constraint]) -> dict[str, Array]:
    moments, teeth = [], []
    for gear in gears:
        assert isinstance(gear, GearRatio)
        value = _value(forces, gear)
        weights = gear.weights(forces.system.numbers)
        moments.append([value * weights[link] for link in gear.links])
        force = forces.system.pulls[gear, 0][0].force
        known = gear.gear in forces.system.teeth.axes
        teeth.append([value * x if known else np.nan for x in force])
    return {"gear_moment": _stacked(forces, moments), "tooth_force": _stacked(forces, teeth)}


def _of_wheels(
    forces: Forces, contacts: Sequence[Constraint], slips: Sequence[Constraint]
) -> dict[str, Array]:
    vectors, normal, along = [], [], []
    for contact, slip in zip(contacts, slips, strict=True):
        assert isinstance(contact, Contact)
        track = forces.system.numbers.gearing.track[contact.rolling]
        out = _force_of(forces.system.pulls[contact, 0])
        press, drag = _value(forces, contact), _value(forces, slip)
        grip = [drag * x for x in _force_of(forces.system.pulls[slip, 0])]
        vectors.append([press * x + y for x, y in zip(out, grip, strict=True)])
        # a wheel inside a circle, or a ring around a pin, is pressed towards the circle's centre
        normal.append(press if isinstance(track, Straight) or not track.inside else -press)
        way = (out[1], -out[0]) if isinstance(track, Straight) else (-out[1], out[0])
        along.append(grip[0] * way[0] + grip[1] * way[1])
    return {
        "rolling_force": _stacked(forces, vectors),
        "rolling_normal": _stacked(forces, normal),
        "rolling_tangential": _stacked(forces, along),
    }
