"""Simulation by the reduced equation: one degree of freedom, moved along its drive, as a dataset."""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cached_property
from math import inf, tau
from typing import TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.dynamics.loads import MassesAndLoads
from centrode.dynamics.reduction import Reducer
from centrode.dynamics.simulation.driving_law import Driving
from centrode.dynamics.simulation.equation_of_motion import (
    CREEP,
    NEAR_LIMIT,
    OCCASIONS,
    OF_DRIVE,
    OF_FRICTION,
    OF_OTHERS,
    RATE,
    STORED,
    VALUE,
    DriveForces,
    Field,
    PanelTracks,
    ReducedFunctions,
    ReducedTrajectory,
    of_time,
)
from centrode.dynamics.simulation.fixed_steps import even_times, fixed_steps
from centrode.dynamics.simulation.integrator import Stepper, Until
from centrode.dynamics.simulation.routes import Tell, no_settings
from centrode.errors import InputError, MotionError
from centrode.kinematics.motion import (
    attributes_of,
    coordinates_along,
    dataset_of,
    joints_of,
    judgements_of,
    spherical_variables,
    vocabulary_variable,
)
from centrode.kinematics.path import SampleGrid, places_of
from centrode.kinematics.plan_evaluation import layout_of
from centrode.kinematics.preparation import Ready, ready
from centrode.kinematics.sample_index import selectable
from centrode.kinematics.solve import check_size, solve
from centrode.locale import _
from centrode.model.contact_checks import needs_events
from centrode.model.files import mechanism_text
from centrode.model.mechanism import Mechanism
from centrode.model.motion_parameter import TIME
from centrode.model.simulation import MOST_TURNS, Simulation

# A mechanism and what its description asks of a simulation, made ready and checked.


@dataclass(frozen=True)
class ReducedSetting:
    """Mechanism, loads and drive of a simulation, checked.

    Attributes
    ----------
    mechanism : as described
    settings : Simulation
    rows : ReducedFunctions
    driving : Driving
    start : value of the drive [rad or m] at time zero
    rate : its derivative by time
    """

    mechanism: Mechanism
    settings: Simulation
    rows: ReducedFunctions
    driving: Driving
    start: float
    rate: float

    @property
    def prepared_mechanism(self) -> Ready:
        """The mechanism with its plan; one that keeps its assembly is prepared as one that passes change points."""
        return self.rows.reducer.ready

    @cached_property
    def field(self) -> Field:
        """Equation of motion; the start is checked."""
        # the tracks are built once: the check of the start and the integration use the same
        field = Field(PanelTracks(self.rows), self.driving)
        self._check_start(field.tracks)
        return field

    @property
    def is_conservative(self) -> bool:
        """Whether nothing drives it but weights and springs, and nothing takes energy."""
        undriven = not self.driving.formula.used and self.driving.at(0.0, 0.0, 0.0) == 0.0
        return undriven and all(term.sort == STORED for term in self.rows.efforts)

    @property
    def until(self) -> Until:
        """When it ends."""
        settings = self.settings
        if settings.duration is None and settings.turns is None:
            raise InputError(
                "[simulation]",
                _("the duration is not given"),
                _("give duration, such as 10 s, or turns of the drive"),
            )
        self._check_turns()
        way = None if settings.turns is None else settings.turns * tau * self._unit
        time = inf if settings.duration is None else settings.duration
        if time == inf and (self.driving.of_time or of_time(self.rows.efforts)):
            raise InputError(
                "[simulation]",
                _("drive or loads depend on time, and only turns are given"),
                _("give duration too"),
            )
        return Until(time, way)

    @property
    def turns_at_start(self) -> float | None:
        """Turns that the speed at the start makes in the duration; None without one."""
        duration = self.settings.duration
        return None if duration is None else abs(self.rate) * duration / (tau * self._unit)

    def _check_turns(self) -> None:
        """Refuse what at its speed at the start would be too long, before anything is integrated."""
        turns = self.turns_at_start
        if self.settings.turns is None and turns is not None and turns > MOST_TURNS:
            raise InputError(
                "[simulation]",
                _(
                    "at its speed at the start it makes {turns:.3g} turns in {time:.6g} s, "
                    "and at most {most} are integrated"
                ).format(turns=turns, time=self.settings.duration, most=MOST_TURNS),
                _("give a shorter duration, or turns, after which it ends"),
            )

    @property
    def _unit(self) -> float:
        return self.prepared_mechanism.kinematics.path.unit

    def _check_start(self, tracks: PanelTracks) -> None:
        """Refuse a start at a dead point, or where the mechanism does not get to."""
        tracks.stretch(tracks.place(self.start, self.rate * self.rows.sense >= 0.0)[0])
        known = self.rows.state(np.array([self.start]))[1][0]
        if known and (tracks.low < self.start < tracks.high or tracks.is_change_point(self.start)):
            return
        near = (
            min(abs(self.start - end) for end in (tracks.low, tracks.high)) <= 2.0 * NEAR_LIMIT * tracks.unit
        )
        what = (
            _(
                "the motion starts in a dead position, with the drive at {value:.9g}: there the drive moves nothing"
            )
            if near or not known
            else _("the motion starts at {value:.9g}, a position that the mechanism does not reach")
        )
        raise InputError(
            "[simulation] start",
            what.format(value=self.start),
            _("start between the limits (see centrode limits)"),
        )


def reduced_setting(mechanism: Mechanism, settings: Simulation | None = None) -> ReducedSetting:
    """Simulation that a description describes, or with settings in place of its own.

    Raises
    ------
    InputError
        No `[simulation]`, several drives, nothing that has mass.
    """
    settings = settings or mechanism.simulation
    if settings is None:
        raise no_settings()
    if needs_events(mechanism):
        raise InputError(
            "[simulation] equations",
            _("stops, clamps, events, belts and static friction are computed by the equations of all links"),
            _('remove equations = "reduced"'),
        )
    if len(mechanism.drives) != 1:
        raise InputError(
            "[[drives]]",
            _("a simulation needs one drive, the mechanism has {count}").format(count=len(mechanism.drives)),
            _('tie the drives by a gear, or write equations = "multibody" in [simulation]'),
        )
    if settings.turns is not None and mechanism.drives[0].kind != "angle":
        raise InputError("[simulation] turns", _("the drive does not turn"), _("give duration"))
    if settings.motor is not None and mechanism.drives[0].kind != "angle":
        raise InputError("[simulation] motor", _("the drive does not turn"), _("give driving, a force"))
    # up to the next change point both continuations are one motion, and the smooth one keeps its digits there
    kept = mechanism.assembly.continuation == "keep"
    passing = mechanism.assembly.model_copy(update={"continuation": "smooth"})
    smooth = mechanism.model_copy(update={"assembly": passing}) if kept else mechanism
    reducer = Reducer(ready(smooth), MassesAndLoads.of(smooth))
    added = 0.0 if mechanism.machine is None else mechanism.machine.inertia
    # shafts turn at a constant ratio: their inertia is a constant of the drive
    rows = ReducedFunctions(reducer, added, kept)
    if not reducer.burden.masses and not rows.added:
        raise InputError(
            "[links]", _("no link has a mass: the equation of motion has no inertia"), _("give links a mass")
        )
    path = reducer.ready.kinematics.path
    driving = Driving.of(settings, path.forward)
    start = path.initial if settings.start is None else settings.start
    return ReducedSetting(mechanism, settings, rows, driving, start, path.forward * settings.speed)


# What a simulation found, as a labelled result.

Array: TypeAlias = npt.NDArray[np.float64]


def reduced_dataset(
    setting: ReducedSetting, course: ReducedTrajectory, times: Array, *, motion: bool = False
) -> xr.Dataset:
    """The labelled course at times [s] within it."""
    states, senses = course.at(times)
    forces = _forces(setting, times, states, senses)
    moving = senses != 0.0
    # at rest acceleration is zero, whatever forces would ask for: friction holds
    acceleration = np.where(moving, forces.acceleration(states[RATE]), 0.0)
    solved = solve(setting.prepared_mechanism, SampleGrid(times, states[VALUE], states[RATE], acceleration))
    unit = solved.ready.parameter.units[0]
    curves = _curves(setting, states, forces, acceleration, moving)
    curves_named = {
        name: vocabulary_variable(name, ("sample",), values, unit) for name, values in curves.items()
    }
    occasions = _occasions(course, unit)
    facts = _facts(setting, course, curves)
    if motion:
        return dataset_of(solved).assign(curves_named | occasions).assign_attrs(facts)
    variables = {**curves_named, **occasions, **judgements_of(solved, ())}
    coordinates = coordinates_along(solved)
    if solved.spins is not None:
        # angles say on the sphere what the links do, and are few
        joints = vocabulary_variable("joint_angle", ("sample", "joint"), solved.angles[0][0])
        variables |= {"joint_angle": joints, **spherical_variables(solved, coordinates=False)}
        coordinates |= joints_of(solved)
    return selectable(xr.Dataset(variables, coordinates, attributes_of(solved) | facts))


def _forces(setting: ReducedSetting, times: Array, states: Array, senses: Array) -> DriveForces:
    """Inertia and moments at every instant (n); at rest as if it were about to go on in the sense of the drive."""
    field, forces = setting.field, np.empty((len(times), len(fields(DriveForces))))
    rows = zip(times, states[VALUE], states[RATE], senses, strict=True)
    for k, (t, value, rate, sense) in enumerate(rows):
        # at rest in the sense in which it would go on
        way = (1.0 if rate > 0.0 else -1.0) if rate else sense or setting.rows.sense
        leg = field.leg_at(float(value), way)
        # a creeping speed in place of zero: what acts against the motion needs its sense
        forces[k] = field.forces(leg, float(t), float(value), float(rate) or way * CREEP).row
    return DriveForces(*forces.T)


def _curves(
    setting: ReducedSetting,
    states: Array,
    forces: DriveForces,
    acceleration: Array,
    moving: npt.NDArray[np.bool_],
) -> dict[str, Array]:
    """Curves over time (n) by names of the vocabulary; moments and speeds along the coordinate of the drive."""
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
    # energies are counted from the start, so that the balance is zero there
    works = states[[OF_DRIVE, OF_FRICTION, OF_OTHERS]]
    return {
        # adding zero leaves no negative one
        "turned": setting.rows.sense * (states[VALUE] - setting.start) + 0.0,
        "drive_speed": rate + 0.0,
        "drive_acceleration": acceleration + 0.0,
        "inertia": inertia,
        "driving_moment": driving + 0.0,
        "moment_of_loads": loads + 0.0,
        "moment_of_friction": parts["friction"] + 0.0,
        "power_of_drive": driving * rate + 0.0,
        "power_of_loads": loads * rate + 0.0,
        "work_of_drive": works[0],
        "work_of_friction": works[1],
        "work_of_other_loads": works[2],
        "kinetic_energy": kinetic,
        "potential_energy": potential,
        "energy_residual": (kinetic - began) + (potential - before) - works.sum(axis=0),
    }


def inertia_at(setting: ReducedSetting, value: float) -> float:
    """Inertia of everything at a value of the drive, reduced to it."""
    return float(setting.rows.at(np.array([value]))[0, 0])


def _occasions(course: ReducedTrajectory, unit: str) -> dict[str, object]:
    occasions = course.occasions
    kinds = np.array([OCCASIONS.index(occasion.kind) for occasion in occasions], dtype=np.int8)
    dimensions, values, attributes = vocabulary_variable("occasion_kind", ("occasion",), kinds)
    attributes["flag_values"] = np.arange(len(OCCASIONS), dtype=np.int8)
    attributes["flag_meanings"] = " ".join(word.replace(" ", "_") for word in OCCASIONS)
    return {
        "occasion_time": vocabulary_variable(
            "occasion_time", ("occasion",), np.array([occasion.time for occasion in occasions])
        ),
        "occasion_value": vocabulary_variable(
            "occasion_value", ("occasion",), np.array([occasion.value for occasion in occasions]), unit
        ),
        "occasion_kind": (dimensions, values, attributes),
    }


def _facts(
    setting: ReducedSetting, course: ReducedTrajectory, curves: dict[str, Array]
) -> dict[str, float | str]:
    """Attributes: what holds for the whole course."""
    return {
        "topic": "simulate",
        "ended": course.ended,
        "scheme": course.scheme,
        "executor": course.executor,
        "evaluations": course.evaluations,
        "driving": setting.settings.law,
        "speed_at_start": setting.settings.speed,
        # with the settings that it ran by: what is read back says how it was driven
        "mechanism": mechanism_text(setting.mechanism.model_copy(update={"simulation": setting.settings})),
        "worst_energy_residual": float(np.nanmax(np.abs(curves["energy_residual"]), initial=0.0)),
        "representation_error": setting.field.tracks.error,
    }


def simulate_reduced(
    mechanism: Mechanism,
    settings: Simulation | None = None,
    at: npt.ArrayLike | None = None,
    progress: Tell | None = None,
    *,
    motion: bool = False,
) -> xr.Dataset:
    """The labelled motion of a mechanism with one degree of freedom that is left to its loads."""
    setting = reduced_setting(mechanism, settings)
    if at is None and setting.settings.at:
        at = setting.settings.at
    count = setting.settings.samples if at is None else np.size(at)
    check_size(layout_of(setting.prepared_mechanism.kinematics), 1, count)
    course = reduced_trajectory(setting, progress)
    return reduced_dataset(setting, course, _times(setting, course, at), motion=motion)


def reduced_trajectory(setting: ReducedSetting, progress: Tell | None = None) -> ReducedTrajectory:
    """Integrate by the scheme that is requested."""
    settings, until = setting.settings, setting.until
    if settings.scheme != "runge-kutta-4":
        stepper = Stepper(setting.field, until, settings.tolerance, settings.scheme == "stiff", progress)
        course = stepper.run(setting.start, setting.rate)
    else:
        course = _by_fixed_steps(setting, progress)
    if course.ended == "change point" and not course.pieces:
        raise MotionError(
            "[simulation]",
            _("it starts at the change point at {value:.9g}, where its path ends").format(
                value=setting.start
            ),
            _(
                'start elsewhere, let it move away from there, or choose continuation = "smooth" in [assembly]'
            ),
        )
    if not course.last > course.first:
        raise MotionError(
            "[simulation]",
            _("no force sets the mechanism in motion at {value:.6g}").format(value=setting.start),
            _("give it a speed, a larger driving moment, or another start"),
        )
    return course


def _by_fixed_steps(setting: ReducedSetting, progress: Tell | None) -> ReducedTrajectory:
    settings = setting.settings
    if settings.duration is None or settings.turns is not None:
        raise InputError(
            "[simulation]",
            _("a scheme of fixed steps needs a duration, and no turns"),
            _('give duration, or scheme = "adaptive"'),
        )
    return fixed_steps(
        setting.field, setting.start, setting.rate, settings.duration, settings.steps, progress
    )


def _times(setting: ReducedSetting, course: ReducedTrajectory, at: npt.ArrayLike | None) -> Array:
    """The instants of the result, no later than the end."""
    if at is not None:
        times = places_of(TIME, at)
        if times.ndim != 1 or not len(times) or not np.isfinite(times).all() or (np.diff(times) <= 0.0).any():
            raise InputError("at", _("a one-dimensional array of finite, increasing times is required"))
        if times[0] < 0.0:
            raise InputError("at", _("times count from the start of the simulation, at 0 s"))
        return times[times <= course.last * (1.0 + 1e-12)].clip(max=course.last)
    settings = setting.settings
    if settings.scheme == "runge-kutta-4":
        assert settings.duration is not None
        return even_times(course, settings.duration / settings.steps, settings.samples)
    return np.linspace(course.first, course.last, settings.samples)
