"""Simulation by the equations of all links with their constraints: any number of degrees of freedom, as a dataset."""

from __future__ import annotations

import functools
import importlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.dynamics.forward_dynamics.contacts import FRICTION
from centrode.dynamics.forward_dynamics.free_loads import DriveEffort
from centrode.dynamics.forward_dynamics.free_motion import FreeMotion, free_motion_of
from centrode.dynamics.forward_dynamics.motion_steps import IMPACT, KINDS
from centrode.dynamics.forward_dynamics.trajectory import STATUSES, Trajectory
from centrode.dynamics.load_coordinates import is_angular
from centrode.dynamics.loads import EnergyClass
from centrode.dynamics.simulation.driving_law import Driving
from centrode.dynamics.simulation.routes import MULTIBODY
from centrode.dynamics.state import length_unit
from centrode.errors import STATUSES_OF_MOTION, InputError, Status
from centrode.kinematics.hinge_angles import spherical_coordinates
from centrode.kinematics.motion import labels_of, vocabulary_variable
from centrode.kinematics.path import path_of, places_of
from centrode.kinematics.sample_index import drive_coordinates, label_coordinates
from centrode.locale import _
from centrode.model.checks import simulation_problems
from centrode.model.files import mechanism_text
from centrode.model.mechanism import Mechanism, kept_by_mechanism
from centrode.model.motion_parameter import TIME
from centrode.model.reading import error_at_place
from centrode.model.simulation import DRIVING_LAW_VARIABLES, Simulation
from centrode.numerics.text_formula import compile_formula
from centrode.version import __version__

if TYPE_CHECKING:
    from centrode.kinematics.motion import Variable
    from centrode.model.motion_parameter import DriveCoordinate

Array: TypeAlias = npt.NDArray[np.float64]

# most motions are looked at without their reactions
_reactions = functools.partial(importlib.import_module, "centrode.dynamics.simulation.reactions_in_motion")

MOST_NUMBERS = 100_000_000
"""Numbers of a result: with eight bytes each some 0.8 GB."""
OCCASIONS = ("crossing", "near miss", "doubtful", *KINDS[2:])
"""What may happen on the way: change points, what passes near one, where nothing tells how it goes on; and events."""


# one mechanism is often simulated again, with other speeds and times: its equations are those that it had
@kept_by_mechanism(32)
def _prepared_motion(mechanism: Mechanism, keeps: tuple[str, ...], law: str) -> FreeMotion:
    """The equations of a mechanism with drives that keep their laws, and a moment or force along the first drive."""
    return free_motion_of(mechanism.with_drives_held(), keeps, driving_efforts(mechanism, law))


def driving_efforts(mechanism: Mechanism, law: str) -> tuple[DriveEffort, ...]:
    """What drives: a force by a formula along the first drive, and motors of drives."""
    motors = tuple(
        _effort_of(mechanism, [drive.id for drive in mechanism.drives].index(motor.drive), motor.law)
        for motor in mechanism.motors
    )
    if law == "0":
        return motors
    if not mechanism.drives:
        what = _("the coordinate along which the driving moment acts is not given")
        raise InputError("[simulation] driving", what, _("name a link, guide or distance in [[drives]]"))
    return (_effort_of(mechanism, 0, law), *motors)


def _effort_of(mechanism: Mechanism, number: int, law: str) -> DriveEffort:
    """A force or moment by a formula along a drive, positive in the sense of the drive."""
    driven = mechanism.motion_parameter.drives[number]
    driving = Driving(
        compile_formula(law, DRIVING_LAW_VARIABLES, "[simulation] driving"),
        _sense_of_drive(mechanism, number),
    )

    def along(m: Any, t: Any, measure: Any, rate: Any) -> Any:
        # the formula knows the coordinate, with the zero and the sense that its author may have chosen
        return driven.sense * driving.over(m, t, driven.value_of(measure), driven.sense * rate)

    return DriveEffort(driven.name, along, frozenset(driving.formula.used))


def _sense_of_drive(mechanism: Mechanism, number: int = 0) -> float:
    """Sense of a drive along its coordinate: +1.0 or -1.0, that in which its law sets out."""
    drive = mechanism.drives[number]
    if not drive.has_law:
        return mechanism.motion_parameter.drives[number].sense
    return float(path_of(mechanism.model_copy(update={"drives": (drive,)}), 1.0).forward)


@dataclass(frozen=True)
class MultibodySetting:
    """A mechanism and what its simulation asks for, checked: it starts, and its end is known."""

    mechanism: Mechanism
    settings: Simulation

    @cached_property
    def free(self) -> FreeMotion:
        """The mechanism prepared."""
        return _prepared_motion(self.mechanism, self.settings.keeps, self.settings.law)

    @property
    def coordinates(self) -> tuple[DriveCoordinate, ...]:
        """Coordinates of the drives, the first of them that to which speed, start and driving belong."""
        return self.mechanism.motion_parameter.drives

    @property
    def sense(self) -> float:
        """Sense of the first drive along its coordinate."""
        return _sense_of_drive(self.mechanism)

    @property
    def duration(self) -> float:
        """How long it runs [s]."""
        settings = self.settings
        if settings.turns is not None:
            what = _("turns end a simulation by the reduced equation alone")
            raise InputError("[simulation] turns", what, _("give duration, such as 10 s"))
        if settings.duration is None:
            what = _("the duration is not given")
            raise InputError("[simulation]", what, _("give duration, such as 10 s"))
        return settings.duration

    def instants(self, at: npt.ArrayLike | None) -> Array:
        """Instants of the result [s] within the duration."""
        if at is None and not self.settings.at:
            return np.linspace(0.0, self.duration, self.settings.samples)
        times = places_of(TIME, self.settings.at if at is None else at)
        if times.ndim != 1 or not len(times) or not np.isfinite(times).all() or (np.diff(times) <= 0.0).any():
            raise InputError("at", _("a one-dimensional array of finite, increasing times is required"))
        if times[0] < 0.0:
            raise InputError("at", _("times count from the start of the simulation, at 0 s"))
        if times[-1] > self.duration * (1.0 + 1e-12):
            what = _("the instant {time:.6g} s lies behind the end of the simulation at {end:.6g} s")
            raise InputError(
                "at", what.format(time=float(times[-1]), end=self.duration), _("give a longer duration")
            )
        return times.clip(max=self.duration)

    @property
    def speeds(self) -> dict[str, Any]:
        """Initial speeds by path; that of the first drive counts in its own sense."""
        settings, given = self.settings, dict(self.settings.speeds)
        if settings.speed:
            if not self.mechanism.drives:
                what = _("speed is that of the first drive, and there is none")
                raise InputError("[simulation] speed", what, _("name parts in [simulation.speeds]"))
            path = f"drives.{self.mechanism.drives[0].id}"
            if path in given:
                what = _("speed and {path} are given together").format(path=path)
                raise InputError("[simulation] speed", what, _("keep one of them"))
            given[path] = self.coordinates[0].sense * self.sense * settings.speed
        return given

    @property
    def start(self) -> dict[str, float]:
        """Values of drives at the start in place of those of the description."""
        if self.settings.start is None:
            return {}
        if not self.mechanism.drives:
            what = _("start is that of the first drive, and there is none")
            raise InputError("[simulation] start", what, _("give initial angles of links"))
        first = self.coordinates[0]
        return {f"drives.{first.name}": first.measure_at(self.settings.start)}

    def run(
        self,
        at: npt.ArrayLike | None = None,
        executor: str = "auto",
        progress: Callable[[float], None] | None = None,
        at_events: bool = False,
    ) -> Trajectory:
        """Integrate the motion; `progress` is called with the share that is done."""
        duration, instants = self.duration, self.instants(at)
        self._check_size(len(instants))
        start = self.free.initial(self.speeds, self.start)
        reached = None if progress is None else lambda time: progress(time / duration)
        return self.free.integrate(
            start,
            duration,
            self.settings.tolerance,
            at=instants,
            scheme=self.settings.scheme,
            executor=executor,
            progress=reached,
            at_events=at_events,
        )

    def _check_size(self, count: int) -> None:
        """Refuse a result that would not fit into the memory of an ordinary machine."""
        mechanism = self.mechanism
        each = 9 * len(mechanism.points) + 21 * len(mechanism.links) + 3 * len(mechanism.guides) + 20
        if count * each > MOST_NUMBERS:
            raise InputError(
                _("samples"),
                _("{asked} positions would take {size:.3g} GB of memory").format(
                    asked=count, size=8e-9 * count * each
                ),
                _("give at most {most} samples").format(most=MOST_NUMBERS // each),
            )


def multibody_setting(mechanism: Mechanism, settings: Simulation) -> MultibodySetting:
    """A simulation by all links; InputError where it names what is not there, or a scheme that is not known."""
    for problem in simulation_problems(mechanism, settings):
        raise error_at_place(problem, (), "")
    if settings.scheme == "runge-kutta-4":
        what = _("fixed steps are those of the reduced equation")
        raise InputError("[simulation] scheme", what, _('write scheme = "adaptive"'))
    return MultibodySetting(mechanism, settings)


def simulate_multibody(
    mechanism: Mechanism,
    settings: Simulation,
    at: npt.ArrayLike | None = None,
    executor: str = "auto",
    progress: Callable[[float], None] | None = None,
    reactions: bool = False,
    at_events: bool = False,
) -> xr.Dataset:
    """The labelled motion of a mechanism that is left to its loads, with any number of degrees of freedom."""
    setting = multibody_setting(mechanism, settings)
    return multibody_dataset(setting, setting.run(at, executor, progress, at_events), reactions)


# The result with names.


def multibody_dataset(setting: MultibodySetting, course: Trajectory, reactions: bool = False) -> xr.Dataset:
    """The labelled result of a course, with the reactions in its joints if they are requested."""
    variables = {
        **_coordinates_in_time(setting, course),
        **_drives_in_time(setting, course),
        **_links_and_points(setting, course),
        **_energies(setting, course),
        **_judgements(setting, course),
        **_contacts(setting, course),
        **_outputs(setting, course),
        **_occasions(course),
    }
    labels = _labels(setting, course)
    attributes = _attributes(setting, course, variables)
    if reactions:
        module = _reactions()
        found = module.reactions_in_motion(setting.free, course)
        more, further = module.reaction_variables(setting.free, found)
        variables, labels = variables | more, labels | further
        attributes["worst_imbalance"] = found.imbalance
    return xr.Dataset(variables, label_coordinates(labels), attributes)


def _labels(setting: MultibodySetting, course: Trajectory) -> dict[str, Any]:
    """Times, values of the drives, and names."""
    free, mechanism = setting.free, setting.mechanism
    units, values = mechanism.motion_parameter.units, _drive_values(setting, course)[0]
    drive_value = vocabulary_variable(
        "drive_value", ("sample", "drive"), values, units[0] if units else "rad"
    )
    if len(set(units)) > 1:
        drive_value[2]["units"] = " ".join(units)
    joints = {"joint": labels_of(free.links)} if mechanism.space == "sphere" else {}
    contacts = contact_labels(free)
    controlled = tuple(one.description.name for one in free.equations.controls)
    touched = {"contact": labels_of(contacts)} if contacts else {}
    return {
        **touched,
        **({"controller": labels_of(controlled)} if controlled else {}),
        "time": vocabulary_variable("time", ("sample",), course.time),
        "drive_value": drive_value,
        "point": labels_of(free.points),
        "link": labels_of(free.links),
        **joints,
        "guide": labels_of(free.guides),
        "drive": labels_of(free.drives),
        "axis": labels_of(("x", "y", "z")[: course.places.shape[-1]]),
        "coordinate": labels_of(coordinate_names(free)),
        "source": labels_of(tuple(course.works)),
        **drive_coordinates(free.drives, values, units),
    }


def _drive_values(setting: MultibodySetting, course: Trajectory) -> tuple[Array, Array, Array]:
    """Values, speeds and accelerations (n, d) of the coordinates of all drives, of which one alone may be chosen."""
    senses = np.array([one.sense for one in setting.coordinates])
    values = course.drives.copy()
    for number, one in enumerate(setting.coordinates):
        values[:, number] = one.value_of(values[:, number])
    return values, course.drive_speeds * senses, course.drive_accelerations * senses


def coordinate_names(free: FreeMotion) -> tuple[str, ...]:
    """Names of the generalised coordinates: a link for its angle, a guide, or a point with an axis."""
    return tuple(
        one.name if one.kind in ("angle", "slide") else f"{one.name}.{one.kind}" for one in free.coordinates
    )


def _coordinates_in_time(setting: MultibodySetting, course: Trajectory) -> dict[str, Variable]:
    return {
        name: coordinate_variable(setting.free, name, ("sample", "coordinate"), values, behind)
        for name, values, behind in (
            ("generalised_coordinate", course.coordinates, ""),
            ("generalised_velocity", course.speeds, "/s"),
            ("generalised_acceleration", course.accelerations, "/s^2"),
        )
    }


def coordinate_variable(
    free: FreeMotion, name: str, dimensions: tuple[str, ...], values: Array, behind: str
) -> Variable:
    """A variable of the generalised coordinates, the last dimension; `behind` follows their units."""
    variable = vocabulary_variable(name, dimensions, values)
    variable[2]["units"] = _joined_units([f"{one.unit}{behind}" for one in free.coordinates])
    return variable


def _joined_units(units: list[str]) -> str:
    """One unit for all, or all of them."""
    return units[0] if len(set(units)) == 1 else ", ".join(units) or "1"


def _drives_in_time(setting: MultibodySetting, course: Trajectory) -> dict[str, Variable]:
    found: dict[str, Variable] = {}
    units = setting.mechanism.motion_parameter.units
    if not units:
        return found
    _values, speeds, accelerations = _drive_values(setting, course)
    for name, values in (("drive_speed", speeds), ("drive_acceleration", accelerations)):
        variable = vocabulary_variable(name, ("sample", "drive"), values)
        variable[2]["units"] = _joined_units(
            [vocabulary_variable(name, (), 0.0, unit)[2]["units"] for unit in units]
        )
        found[name] = variable
    if course.kept_forces:
        absent = np.full(len(course.time), np.nan)
        values = np.column_stack([course.kept_forces.get(name, absent) for name in setting.free.drives])
        variable = vocabulary_variable("keeping_moment", ("sample", "drive"), values)
        variable[2]["units"] = _joined_units(
            [vocabulary_variable("keeping_moment", (), 0.0, unit)[2]["units"] for unit in units]
        )
        found["keeping_moment"] = variable
    return found


def _links_and_points(setting: MultibodySetting, course: Trajectory) -> dict[str, Variable]:
    unit = length_unit(setting.mechanism)
    on_sphere = setting.mechanism.space == "sphere"
    length = "1" if on_sphere else "m"
    orders: list[tuple[tuple[str, str, str], tuple[str, ...], tuple[Any, Any, Any], float]] = [
        (
            ("position", "velocity", "acceleration"),
            ("point", "axis"),
            (course.places, course.velocities, course.point_accelerations),
            unit,
        ),
        (
            ("slide", "slide_velocity", "slide_acceleration"),
            ("guide",),
            (course.slides, course.slide_speeds, course.slide_accelerations),
            unit,
        ),
    ]
    turning = (course.angles, course.angular_velocities, course.angular_accelerations)
    if on_sphere:
        orders.append((("joint_angle", "joint_velocity", "joint_acceleration"), ("joint",), turning, 1.0))
        assert course.spins is not None
        orders.append((("", "angular_velocity", ""), ("link", "axis"), (None, course.spins, None), 1.0))
    else:
        orders.append((("angle", "angular_velocity", "angular_acceleration"), ("link",), turning, 1.0))
    found = {
        name: vocabulary_variable(name, ("sample", *dimensions), values / by, length_unit=length)
        for names, dimensions, three, by in orders
        for name, values in zip(names, three, strict=True)
        if name
    }
    if on_sphere:
        for name, values in zip(
            ("polar_angle", "azimuth"), spherical_coordinates(course.places / unit), strict=True
        ):
            found[name] = vocabulary_variable(name, ("sample", "point"), values)
    return found


def work_sorts(free: FreeMotion) -> dict[str, str]:
    """Source of work -> "stored", "friction", "other" or "drive"."""
    sorts = {load.label: str(load.term.amount.energy_class) for load in free.equations.loads}
    for contact in free.equations.contacts:
        rubs = contact.kind == FRICTION
        sorts[contact.label] = str(EnergyClass.FRICTION if rubs else EnergyClass.OTHER)
    sorts |= {control.label: "drive" for control in free.equations.controls}
    driven = [label for label in sorts if label in {f"drive {name}" for name in free.drives}]
    return sorts | dict.fromkeys([*driven, *(f"drive {kept.name}" for kept in free.equations.kept)], "drive")


def _energies(setting: MultibodySetting, course: Trajectory) -> dict[str, Variable]:
    """Energies, works by sort and by source; weights and springs store what they do."""
    sorts, none = work_sorts(setting.free), np.zeros(len(course.time))

    def of(sort: str) -> Array:
        return sum((work for name, work in course.works.items() if sorts[name] == sort), none)

    values = {
        "work_of_drive": of("drive"),
        "work_of_friction": of(EnergyClass.FRICTION),
        "work_of_other_loads": of(EnergyClass.OTHER),
        "kinetic_energy": course.kinetic_energy,
        "potential_energy": course.potential_energy,
        "energy_residual": course.energy_residual,
    }
    found = {name: vocabulary_variable(name, ("sample",), each) for name, each in values.items()}
    works = np.column_stack([*course.works.values()]) if course.works else np.zeros((len(course.time), 0))
    return {**found, "work_part": vocabulary_variable("work_part", ("sample", "source"), works)}


def _judgements(setting: MultibodySetting, course: Trajectory) -> dict[str, Variable]:
    """Status and residuals of every sample: about a change point a sample is singular."""
    about = course.statuses != STATUSES.index("ok")
    status = np.where(about, Status.SINGULAR.value, Status.OK.value).astype(np.int8)
    dimensions, values, attributes = vocabulary_variable("status", ("sample",), status)
    attributes["flag_values"] = np.array([one.value for one in STATUSES_OF_MOTION], dtype=np.int8)
    attributes["flag_meanings"] = " ".join(one.name.lower() for one in STATUSES_OF_MOTION)
    scale = float(setting.free.equations.numbers.scale)
    return {
        "status": (dimensions, values, attributes),
        "residual": vocabulary_variable("residual", ("sample",), course.position_residual / scale),
        "velocity_residual": vocabulary_variable(
            "velocity_residual", ("sample",), course.velocity_residual / scale
        ),
    }


def contact_labels(free: FreeMotion) -> tuple[str, ...]:
    """Names of the stops, clamps and frictions of a motion."""
    return tuple(contact.label for contact in free.equations.contacts)


def _contacts(setting: MultibodySetting, course: Trajectory) -> dict[str, Variable]:
    """Forces and modes of stops, clamps and frictions."""
    contacts = setting.free.equations.contacts
    if not contacts:
        return {}
    force = vocabulary_variable("restraint_force", ("sample", "contact"), course.contact_forces)
    angular = [is_angular(contact.coordinate) for contact in contacts]
    force[2]["units"] = _joined_units(["N m" if turns else "N" for turns in angular])
    modes = course.contact_modes.astype(np.int8)
    return {
        "restraint_force": force,
        "contact_mode": vocabulary_variable("contact_mode", ("sample", "contact"), modes),
    }


def _outputs(setting: MultibodySetting, course: Trajectory) -> dict[str, Variable]:
    """Outputs of controllers."""
    if not setting.free.equations.controls:
        return {}
    name = "controller_output"
    return {name: vocabulary_variable(name, ("sample", "controller"), course.outputs)}


def _occasions(course: Trajectory) -> dict[str, Variable]:
    kinds = np.array([OCCASIONS.index(event.kind) for event in course.events], dtype=np.int8)
    dimensions, values, attributes = vocabulary_variable("occasion_kind", ("occasion",), kinds)
    attributes["flag_values"] = np.arange(len(OCCASIONS), dtype=np.int8)
    attributes["flag_meanings"] = " ".join(word.replace(" ", "_") for word in OCCASIONS)
    times = np.array([event.time for event in course.events], dtype=np.float64)
    return {
        "occasion_time": vocabulary_variable("occasion_time", ("occasion",), times),
        "occasion_kind": (dimensions, values, attributes),
        **_impacts(course),
    }


def _impacts(course: Trajectory) -> dict[str, Variable]:
    """The parts of events, impulses and lost energies of impacts."""
    parts = np.array([event.part for event in course.events], dtype=object)
    if not any(parts):
        return {}
    found = {"occasion_part": vocabulary_variable("occasion_part", ("occasion",), parts)}
    for name, numbers in (
        ("occasion_impulse", [event.impulse for event in course.events]),
        ("occasion_loss", [event.lost for event in course.events]),
    ):
        found[name] = vocabulary_variable(name, ("occasion",), np.array(numbers, dtype=np.float64))
    return found


def _rubs_at_impacts(setting: MultibodySetting, course: Trajectory) -> bool:
    """Whether there are impacts, and friction by coefficients, whose share in their impulses is left out."""
    presses = any(contact.pressing is not None for contact in setting.free.equations.contacts)
    return presses and any(event.kind == IMPACT for event in course.events)


def _attributes(
    setting: MultibodySetting, course: Trajectory, variables: Mapping[str, Variable]
) -> dict[str, Any]:
    """What holds for the whole course."""
    mechanism, settings = setting.mechanism, setting.settings
    given = mechanism.model_copy(update={"simulation": settings.model_copy(update={"equations": MULTIBODY})})
    return {
        "topic": "simulate",
        "title": mechanism.title,
        "mechanism": mechanism_text(given),
        "version": __version__,
        "equations": MULTIBODY,
        "mobility": setting.free.mobility,
        "redundant": int(setting.free.redundant),
        "ended": course.ended,
        "cause": course.cause or "",
        "scheme": course.scheme,
        "executor": course.executor,
        "steps": course.steps,
        "driving": settings.law,
        "conditions": "\n".join(one.label for one in setting.free.equations.conditions),
        **({"friction_at_impacts": "no impulse"} if _rubs_at_impacts(setting, course) else {}),
        "work_sorts": " ".join(work_sorts(setting.free)[name] for name in course.works),
        "worst_residual": float(np.max(variables["residual"][1], initial=0.0)),
        "worst_energy_residual": float(np.nanmax(np.abs(course.energy_residual), initial=0.0)),
    }
