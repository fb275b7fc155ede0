"""What a simulation found, as a labelled result."""

from __future__ import annotations

from dataclasses import fields
from typing import TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.dynamics.simulation.course import (
    OCCASIONS,
    OF_DRIVE,
    OF_FRICTION,
    OF_OTHERS,
    RATE,
    VALUE,
    Course,
)
from centrode.dynamics.simulation.field import CREEP, Forces
from centrode.dynamics.simulation.setting import Setting
from centrode.kinematics.dataset import (
    attributes_of,
    coordinates_of,
    dataset_of,
    judgements_of,
    named,
)
from centrode.kinematics.solve import Solved, solve
from centrode.kinematics.spans import Span
from centrode.model.files import mechanism_text

Array: TypeAlias = npt.NDArray[np.float64]


def simulation_dataset(setting: Setting, course: Course, times: Array, *, motion: bool = False) -> xr.Dataset:
    """The labelled course at times [s] within it."""
    states, senses = course.at(times)
    forces = _forces(setting, times, states, senses)
    moving = senses != 0.0
    acceleration = np.where(moving, forces.acceleration(states[RATE]), 0.0)
    solved = solve(setting.prepared, Span(times, states[VALUE], states[RATE], acceleration))
    unit = solved.ready.parameter.units[0]
    curves = _curves(setting, states, forces, acceleration, moving)
    curves_named = {name: named(name, ("sample",), values, unit) for name, values in curves.items()}
    occasions = _occasions(course, unit)
    facts = _facts(setting, course, curves)
    if motion:
        return dataset_of(solved).assign(curves_named | occasions).assign_attrs(facts)
    variables = {**curves_named, **occasions, **judgements_of(solved, ())}
    return xr.Dataset(variables, _coordinates(solved), attributes_of(solved) | facts)


def _coordinates(solved: Solved) -> dict[str, object]:
    known = coordinates_of(solved)
    return {name: known[name] for name in ("time", "drive_value", "drive")}


def _forces(setting: Setting, times: Array, states: Array, senses: Array) -> Forces:
    """What acts at every instant; at rest as if it were about to go on in the sense of the drive."""
    field, found = setting.field, np.empty((len(times), len(fields(Forces))))
    rows = zip(times, states[VALUE], states[RATE], senses, strict=True)
    for k, (t, value, rate, sense) in enumerate(rows):
        way = (1.0 if rate > 0.0 else -1.0) if rate else sense or setting.rows.sense
        leg = field.leg_at(float(value), way)
        found[k] = field.forces(leg, float(t), float(value), float(rate) or way * CREEP).row
    return Forces(*found.T)


def _curves(
    setting: Setting, states: Array, forces: Forces, acceleration: Array, moving: npt.NDArray[np.bool_]
) -> dict[str, Array]:
    """Everything over time by the names of the vocabulary; moments, speeds and works in the sense of the drive."""
    sense = setting.rows.sense
    rate = states[RATE]
    inertia, driving = forces.inertia, forces.driving
    parts = {name: getattr(forces, name) for name in ("stored", "friction", "other")}
    # friction that holds is what is needed to hold
    parts["friction"] = np.where(moving, parts["friction"], -(driving + parts["stored"] + parts["other"]))
    loads = parts["stored"] + parts["friction"] + parts["other"]
    kinetic = 0.5 * inertia * rate**2
    potential = setting.rows.energy(states[VALUE])
    began = 0.5 * inertia_at(setting, setting.start) * setting.rate**2
    before = float(setting.rows.energy(np.array([setting.start]))[0])
    works = states[[OF_DRIVE, OF_FRICTION, OF_OTHERS]]
    return {
        # adding zero leaves no negative one
        "turned": sense * (states[VALUE] - setting.start) + 0.0,
        "drive_speed": sense * rate + 0.0,
        "drive_acceleration": sense * acceleration + 0.0,
        "inertia": inertia,
        "driving_moment": sense * driving + 0.0,
        "moment_of_loads": sense * loads + 0.0,
        "moment_of_friction": sense * parts["friction"] + 0.0,
        "power_of_drive": driving * rate + 0.0,
        "power_of_loads": loads * rate + 0.0,
        "work_of_drive": works[0],
        "work_of_friction": works[1],
        "work_of_other_loads": works[2],
        "kinetic_energy": kinetic,
        "potential_energy": potential,
        "energy_residual": (kinetic - began) + (potential - before) - works.sum(axis=0),
    }


def inertia_at(setting: Setting, value: float) -> float:
    """Inertia of everything at a value of the drive, reduced to it."""
    return float(setting.rows.at(np.array([value]))[0, 0])


def _occasions(course: Course, unit: str) -> dict[str, object]:
    found = course.occasions
    kinds = np.array([OCCASIONS.index(one.kind) for one in found], dtype=np.int8)
    dimensions, values, attributes = named("occasion_kind", ("occasion",), kinds)
    attributes["flag_values"] = np.arange(len(OCCASIONS), dtype=np.int8)
    attributes["flag_meanings"] = " ".join(word.replace(" ", "_") for word in OCCASIONS)
    return {
        "occasion_time": named("occasion_time", ("occasion",), np.array([one.time for one in found])),
        "occasion_value": named(
            "occasion_value", ("occasion",), np.array([one.value for one in found]), unit
        ),
        "occasion_kind": (dimensions, values, attributes),
    }


def _facts(setting: Setting, course: Course, curves: dict[str, Array]) -> dict[str, float | str]:
    """Attributes: what holds for the whole course."""
    return {
        "ended": course.ended,
        "scheme": course.scheme,
        "executor": course.executor,
        "evaluations": course.evaluations,
        "driving": setting.settings.law,
        "speed_at_start": setting.settings.speed,
        "mechanism": mechanism_text(setting.mechanism),
        "worst_energy_residual": float(np.nanmax(np.abs(curves["energy_residual"]), initial=0.0)),
        "representation_error": setting.field.tracks.error,
    }
