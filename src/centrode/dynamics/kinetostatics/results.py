"""Reactions of all joints from the solved equations, as plain arrays by the names of the dataset."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.kinetostatics.sides import Side, side_forces
from centrode.dynamics.kinetostatics.solution import Forces
from centrode.dynamics.kinetostatics.stacking import columns, tables
from centrode.dynamics.pulls import Pull, Vector
from centrode.structure.constraints import (
    FRAME,
    Constraint,
    Contact,
    GearRatio,
    NoSlip,
    NoTurning,
    PointOnGuide,
    is_drive,
)
from centrode.structure.gearing import Straight

Array: TypeAlias = npt.NDArray[np.float64]
Number: TypeAlias = Any


def reactions_of(forces: Forces, sides: Sequence[Side]) -> dict[str, Array]:
    """Every reaction, (samples, ...) as the dataset has it."""
    structure = forces.system.scheme.structure
    of_kind = {
        kind: [c for c in structure.constraints if isinstance(c, kind)]
        for kind in (PointOnGuide, GearRatio, Contact, NoSlip)
    }
    samples, axes = forces.system.shape[-1], len(forces.system.equilibrium.origin)
    drives = [_value(forces, c) for c in structure.constraints if is_drive(c)]
    found = {
        "joint_force": tables([*side_forces(forces, sides).values()], axes, samples),
        "balancing": columns(drives, samples),
    }
    if axes == 3:
        found["centre_force"] = tables([*centre_forces(forces).values()], axes, samples)
    if of_kind[PointOnGuide]:
        found |= _of_guides(forces, of_kind[PointOnGuide])
    if of_kind[GearRatio]:
        found |= _of_gears(forces, of_kind[GearRatio])
    if of_kind[Contact]:
        found |= _of_wheels(forces, of_kind[Contact], of_kind[NoSlip])
    return found


def centre_forces(forces: Forces) -> dict[str, Vector]:
    """On the sphere: force of its centre on each link, and on each pin of several links that loads act on."""
    found = {pull.body.name: pull.force for pull in forces.centre if pull.body.name != FRAME}
    for one in forces.pressing:
        if one.bearer == FRAME:
            known = found.get(f"pin {one.point}", forces.system.equilibrium.origin)
            found[f"pin {one.point}"] = tuple(x - y for x, y in zip(known, one.force, strict=True))
    return found


def _value(forces: Forces, constraint: Constraint | None) -> Number:
    """Multiplier of a constraint of one row; zero of one that repeats others, or that there is none of."""
    return 0.0 if constraint is None else forces.multipliers.get((constraint, 0), 0.0)


def _force_of(pulls: Iterable[Pull]) -> list[Number]:
    """The first of the forces that a constraint exerts: on the point, slider or wheel; carriers come after."""
    return next(list(pull.force) for pull in pulls if not isinstance(pull.force[0], float) or any(pull.force))


def _of_guides(forces: Forces, guides: Sequence[Constraint]) -> dict[str, Array]:
    turning = {c.guide: c for c in forces.system.scheme.structure.constraints if isinstance(c, NoTurning)}
    normal = [_value(forces, c) for c in guides]
    units = [_force_of(forces.system.pulls[c, 0]) for c in guides]
    vectors = [[value * x for x in unit] for value, unit in zip(normal, units, strict=True)]
    moments = [_value(forces, turning.get(c.guide)) for c in guides if isinstance(c, PointOnGuide)]
    samples, axes = forces.system.shape[-1], len(forces.system.equilibrium.origin)
    found = {"guide_force": tables(vectors, axes, samples), "guide_normal": columns(normal, samples)}
    # the guides of the sphere have no links of their own
    return found if axes == 3 else found | {"guide_moment": columns(moments, samples)}


def _of_gears(forces: Forces, gears: Sequence[Constraint]) -> dict[str, Array]:
    moments, teeth = [], []
    for gear in gears:
        assert isinstance(gear, GearRatio)
        value = _value(forces, gear)
        weights = gear.weights(forces.system.numbers)
        moments.append([value * weights[link] for link in gear.links])
        force = forces.system.pulls[gear, 0][0].force
        # of bevel wheels that turn alike the moment alone is known
        told = any(not isinstance(x, float) or x for x in force)
        known = told and gear.gear in forces.system.teeth.axes
        teeth.append([value * x if known else np.nan for x in force])
    samples, axes = forces.system.shape[-1], len(forces.system.equilibrium.origin)
    return {"gear_moment": tables(moments, 3, samples), "tooth_force": tables(teeth, axes, samples)}


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
    samples = forces.system.shape[-1]
    return {
        "rolling_force": tables(vectors, 2, samples),
        "rolling_normal": columns(normal, samples),
        "rolling_tangential": columns(along, samples),
    }
