"""Names, units and statuses around the arrays of kinetostatics."""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.dynamics.burden import Burden
from centrode.dynamics.friction.labelled import (
    friction_attributes,
    friction_coordinates,
    friction_variables,
)
from centrode.dynamics.kinetostatics.checking import checks_of
from centrode.dynamics.kinetostatics.finding import Found
from centrode.dynamics.kinetostatics.moving import rates_of
from centrode.dynamics.kinetostatics.results import centre_forces
from centrode.dynamics.kinetostatics.totals import joint_moments, totals_of
from centrode.errors import Status
from centrode.kinematics.dataset import (
    Variable,
    attributes_of,
    coordinates_of,
    judgements_of,
    labels_of,
    named,
)
from centrode.kinematics.solve import Solved
from centrode.model.mechanism import Mechanism

Array: TypeAlias = npt.NDArray[np.float64]
SPATIAL = ("inertia_moment", "frame_moment", "shaking_moment")
"""Moments that have components on the sphere."""
GEAR_BODIES = ("first", "second", "carrier")
DIMENSIONS = {
    "joint_force": ("side", "axis"),
    "joint_moment": ("side", "axis"),
    "centre_force": ("held", "axis"),
    "guide_force": ("guide", "axis"),
    "guide_normal": ("guide",),
    "guide_moment": ("guide",),
    "gear_moment": ("gear", "gear_body"),
    "tooth_force": ("gear", "axis"),
    "rolling_force": ("rolling", "axis"),
    "rolling_normal": ("rolling",),
    "rolling_tangential": ("rolling",),
    "friction_moment": ("bearing",),
    "friction_force": ("guide",),
    "friction_power": ("friction",),
    "efficiency": (),
    "balancing": ("drive",),
    "inertia_force": ("link", "axis"),
    "inertia_moment": ("link",),
    "frame_force": ("axis",),
    "frame_moment": (),
    "shaking_force": ("axis",),
    "shaking_moment": (),
}


def labelled(solved: Solved, burden: Burden, found: Found, whole: bool) -> xr.Dataset:
    """The dataset of `reactions`; `whole` where the samples are a range, and works over it have a sense."""
    parts = found.parts | totals_of(found)
    checks = checks_of(found, rates_of(solved, found.pace))
    # absence is NaN: nothing where the equations are singular, or where the motion itself has no derivatives
    absent = (found.status != Status.OK) & (found.status != Status.CUT_OFF)
    undetermined = _masked(parts, found)
    if "centre_force" in parts:
        parts["joint_moment"] = joint_moments(found, parts["joint_force"])
    for values in parts.values():
        values[absent] = np.nan
    units = solved.ready.parameter.units
    variables = {
        name: named(name, ("sample", *_dimensions(name, values)), values, units[0])
        for name, values in parts.items()
    }
    if len(set(units)) > 1:
        variables["balancing"][2]["units"] = ", ".join(
            one.force_unit for one in solved.ready.parameter.drives
        )
    if not solved.ready.kinematics.path.by_time:
        variables["drive_rate"] = named("drive_rate", ("sample",), found.pace.moving.rate.copy(), units[0])
    variables |= _statuses(solved, found)
    sides = np.array([side.label not in undetermined for side in found.sides], dtype=np.int8)
    variables["determined"] = named("determined", ("side",), sides)
    attributes = attributes_of(solved) | checks
    attributes |= {"rate_from": found.pace.source, "undetermined": "; ".join(undetermined)}
    coordinates = _coordinates(solved, burden, found)
    if found.friction is not None:
        rubbed, powers = found.friction.rubbed, found.friction.powers
        variables |= friction_variables(solved, rubbed, powers, whole)
        coordinates |= friction_coordinates(rubbed.contacts)
        attributes |= friction_attributes(solved, rubbed, powers, whole)
    return xr.Dataset(variables, coords=coordinates, attrs=attributes)


def _dimensions(name: str, values: Array) -> tuple[str, ...]:
    known = DIMENSIONS[name]
    return (*known, "axis") if name in SPATIAL and values.ndim > 1 + len(known) else known


def _statuses(solved: Solved, found: Found) -> dict[str, Variable]:
    motion = judgements_of(solved, ())["status"]
    flags = {
        "flag_values": np.array(list(Status), dtype=np.int8),
        "flag_meanings": " ".join(status.name.lower() for status in Status),
    }
    dimensions, values, attributes = named("reaction_status", ("sample",), found.status)
    loss = found.forces.system.inverse.loss[0]
    return {
        "status": motion,
        "reaction_status": (dimensions, values, attributes | flags),
        "reaction_loss": named("reaction_loss", ("sample",), np.minimum(loss, 1.0)),
    }


def _coordinates(solved: Solved, burden: Burden, found: Found) -> dict[str, Any]:
    known, mechanism = coordinates_of(solved), solved.ready.mechanism
    wanted = ("time", "drive_value", "drive", "axis", "guide", "rolling")
    coordinates = {
        name: known[name] for name in wanted if name in known and (name != "guide" or mechanism.guides)
    }
    coordinates["link"] = labels_of(burden.links)
    coordinates["side"] = labels_of(tuple(side.label for side in found.sides))
    coordinates["side_point"] = (("side",), np.array([side.point for side in found.sides], dtype=str))
    coordinates["side_link"] = (("side",), np.array([side.body for side in found.sides], dtype=str))
    if "centre_force" in found.parts:
        coordinates["held"] = labels_of(tuple(centre_forces(found.forces)))
    if mechanism.gears:
        coordinates["gear"] = labels_of(tuple(gear.id for gear in mechanism.gears))
        coordinates["gear_body"] = labels_of(GEAR_BODIES)
    return coordinates


def _masked(parts: dict[str, Array], found: Found) -> list[str]:
    """Put NaN where nothing determines a reaction; the names of these."""
    names = _names(found)
    said: list[str] = []
    for part, felt in found.undetermined.items():
        if part == "balancing":
            continue  # work tells it, whatever the state of stress
        for k, mask in enumerate(felt):
            if np.any(mask):
                parts[part][:, k] = np.nan
                said.append(names[part][k])
    return list(dict.fromkeys(said))


def _names(found: Found) -> dict[str, list[str]]:
    mechanism: Mechanism = found.forces.system.scheme.structure.mechanism
    guides = [guide.id for guide in mechanism.guides]
    gears = [f"gear {gear.id}" for gear in mechanism.gears]
    wheels = [f"rolling {wheel.id}" for wheel in mechanism.rolling]
    return {
        "joint_force": [side.label for side in found.sides],
        "centre_force": [f"centre on {name}" for name in centre_forces(found.forces)],
        "guide_force": [f"guide {guide}" for guide in guides],
        "guide_normal": [f"guide {guide}" for guide in guides],
        "guide_moment": [f"moment of guide {guide}" for guide in guides],
        "gear_moment": gears,
        "tooth_force": gears,
        "rolling_force": wheels,
        "rolling_normal": wheels,
        "rolling_tangential": wheels,
    }
