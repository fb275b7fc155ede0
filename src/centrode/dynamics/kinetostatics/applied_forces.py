"""What acts on a mechanism in motion: its loads, and the inertia of its links."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal, TypeAlias, get_args

import numpy as np
import numpy.typing as npt

from centrode.dynamics.load_coordinates import place_of
from centrode.dynamics.loads import AppliedLoad, MassesAndLoads
from centrode.dynamics.masses import shares
from centrode.dynamics.reduction import Reducer, refuse_drive_in_formulas
from centrode.dynamics.state import About, DriveMotion, Mass, Spread, State, Vector3
from centrode.dynamics.steady_motion.steady import SETTLED, SteadySolution, solution_of, turned_at
from centrode.dynamics.wrenches import Moment, Vector, Wrench, couple, on_link
from centrode.errors import InputError
from centrode.geometry.sphere import add, cross, dot, times
from centrode.kinematics.path import JETS, SampleGrid
from centrode.kinematics.preparation import Ready
from centrode.kinematics.solve import Solved
from centrode.locale import _
from centrode.model.mechanism import Mechanism
from centrode.model.reading import Problem
from centrode.model.segments import rate as derivative_by_time
from centrode.model.units import read_quantity
from centrode.numerics.jets import Jet

Array: TypeAlias = npt.NDArray[np.float64]
Number: TypeAlias = Any


@dataclass(frozen=True)
class InertiaForce:
    """Inertia force -m a [N] in the centre of mass, and inertia moment [N m] about it, of one link.

    The moment is -I alpha, on the sphere minus the rate of the moment of momentum about the centre of mass.
    """

    link: str
    force: Vector
    at: Vector
    moment: Moment

    @property
    def pulls(self) -> tuple[Wrench, ...]:
        """Inertia force and inertia moment as wrenches on the link."""
        return on_link(self.link, self.force, self.at), couple(self.link, self.moment)


@dataclass(frozen=True)
class Outer:
    """Loads and inertia at the positions of a state.

    Attributes
    ----------
    loads : forces and moments of all loads
    inertia : of each link that has mass
    moment : (1, n)
        What both do along the path's parameter, by virtual work: power over its rate.
    shares : (loads, 1, n)
        What each load does.
    """

    loads: tuple[Wrench, ...]
    inertia: tuple[InertiaForce, ...]
    moment: Array
    shares: Array

    @property
    def pulls(self) -> tuple[Wrench, ...]:
        """Wrenches of loads and inertia."""
        return (*self.loads, *(pull for action in self.inertia for pull in action.pulls))


def outer_of(state: State, burden: MassesAndLoads, acceleration: Array, known: Any) -> Outer:
    """Loads and inertia forces of a mechanism; `acceleration` (n) is that of the path's parameter.

    Raises InputError for a load without a finite amount although the positions are `known`.
    """
    pulls, by_load = _loads(state, burden.loads, known)
    inertia, slope = (part.sum(axis=0) for part in shares(state, burden.masses, by_load.shape[1:]))
    # by virtual work: loads less J q'' + J' q'^2 / 2
    moment = by_load.sum(axis=0) - inertia * acceleration - 0.5 * slope * state.rate**2
    # without acceleration the products with it are left out
    inertia_forces = inertia_forces_of(state, burden.masses, acceleration if acceleration.any() else None)
    return Outer(tuple(pulls), inertia_forces, moment, by_load)


def _loads(state: State, loads: Sequence[AppliedLoad], known: Any) -> tuple[list[Wrench], Array]:
    pulls: list[Wrench] = []
    done = np.zeros((len(loads), 1, len(state.parameter)))
    with np.errstate(all="ignore"):
        for k, load in enumerate(loads):
            strengths = load.strengths(state, known)
            done[k] = load.along(state, strengths)
            for effort, strength in zip(load.efforts, strengths, strict=True):
                pulls += [pull.times(strength) for pull in effort.pulls(state)]
    return pulls, done


def inertia_forces_of(
    state: State, masses: Sequence[Mass], acceleration: Number | None
) -> tuple[InertiaForce, ...]:
    """Inertia forces of links; `acceleration` is that of the path's parameter, None where there is none."""
    inertial = _Inertial(state, acceleration)
    return tuple(inertial.of(mass) for mass in masses)


@dataclass(frozen=True)
class _Inertial:
    """Inertia forces in a state; `acceleration` is that of the parameter, None where there is none."""

    state: State
    acceleration: Number | None

    def of(self, mass: Mass) -> InertiaForce:
        centre = self.state.centre(mass.centre)
        force = tuple(-mass.mass * self._second(x) if mass.weighs else 0.0 for x in centre)
        return InertiaForce(mass.link, force, place_of(centre), self._moment(mass))

    def _moment(self, mass: Mass) -> Moment:
        if not isinstance(mass.inertia, tuple):
            inertia, angle = mass.moment_of_inertia, mass.link
            return -inertia * self._second(self.state.angle(angle)) if mass.resists else 0.0
        moment: Vector3 = (0.0, 0.0, 0.0)
        for part in mass.inertia:
            rate = (
                self._of_spread(mass.link, part)
                if isinstance(part, Spread)
                else self._of_ring(mass.link, part)
            )
            moment = add(moment, times(-part.moment, rate))
        return moment

    def _of_spread(self, link: str, part: Spread) -> Vector3:
        """Mass spread along u has the moment of momentum u x u', whose rate is u x u''."""
        x, y, z = self.state.heading(link, part.direction)
        return cross((x.value, y.value, z.value), (self._second(x), self._second(y), self._second(z)))

    def _of_ring(self, link: str, part: About) -> Vector3:
        """A ring has the moment of momentum (omega . e) e."""
        x, y, z = (axis.lower_order() for axis in self.state.heading(link, part.direction))
        u, v, w = self.state.spin(link)
        along = dot((u, v, w), (x, y, z))
        return self._first(along * x), self._first(along * y), self._first(along * z)

    def _second(self, jet: Jet) -> Number:
        """Second derivative by time."""
        straight = jet.derivative(2) * self.state.rate**2
        return straight if self.acceleration is None else straight + jet.derivative(1) * self.acceleration

    def _first(self, jet: Jet) -> Number:
        """Derivative by time of what is itself a derivative by the parameter."""
        straight = jet.derivative(1) * self.state.rate**2
        return straight if self.acceleration is None else straight + jet.value * self.acceleration


# How the drive moves while reactions are requested.

MotionOfDrive: TypeAlias = Literal["mean", "real"]
"""The motion at which forces are computed: at the speed of `reduce`, or the real one of a machine."""
MOTIONS = get_args(MotionOfDrive)
ROUNDINGS = 16
"""Times `SETTLED`, by which loads, speed and acceleration of a steady motion may disagree."""


def check_motion(motion: str) -> None:
    """Raise InputError for a motion that is none."""
    if motion not in MOTIONS:
        what = _("{name} is not a motion of the drive").format(name=f'"{motion}"')
        raise InputError("motion", what, _("use one of {known}").format(known=", ".join(MOTIONS)))


@dataclass(frozen=True)
class DriveGroup:
    """Group I of a machine in its real motion, at samples: what turns with the drive, and the moment that drives it.

    Attributes
    ----------
    inertia : float [kg m^2]
        J_I, of flywheel and shafts, reduced to the drive.
    acceleration : (n) [rad/s^2]
        Of the drive, along its coordinate.
    driving : (n) [N m]
        Driving moment of the energy equation, along the same.
    size, error : (n) [N m]
        Sum of the sizes of all terms of the equation of motion, and what the acceleration may leave of it.
    """

    inertia: float
    acceleration: Array
    driving: Array
    size: Array
    error: Array

    @classmethod
    def of(cls, solution: SteadySolution, turned: Array) -> DriveGroup:
        """Group I of a machine in steady motion at angles turned [rad]."""
        speed, balance, loads = solution.speed, solution.speed.balance, solution.speed.balance.cycle
        acceleration, half_square = speed.acceleration(turned), 0.5 * speed.square(turned)
        moments = (balance.driving.at(turned), loads.moment.at(turned), half_square * loads.slope.at(turned))
        carried = (speed.inertia + loads.inertia.at(turned)) * acceleration
        size = sum((np.abs(one) for one in moments), np.abs(carried))
        # of the series that acceleration and driving moment come from
        left_out = (
            balance.total.error_at(turned)
            + half_square * loads.slope.error_at(turned)
            + np.abs(acceleration) * loads.inertia.error_at(turned)
        )
        # loads and speed were made to agree, to SETTLED, and nothing is known better than its rounding
        error = left_out + ROUNDINGS * SETTLED * size
        along = loads.sense
        return cls(speed.inertia, along * acceleration, along * moments[0], size, error)

    @property
    def inertia_moment(self) -> Array:
        """-J_I epsilon (n) [N m]."""
        return -self.inertia * self.acceleration


@dataclass(frozen=True)
class InputMotion:
    """Speed and acceleration of the path's parameter at samples, and whose they are.

    Attributes
    ----------
    acceleration : (n)
    source : "drive", "machine", "steady" or "given"
    group : group I of a machine in its real motion; None otherwise
    """

    moving: DriveMotion
    acceleration: Array
    source: str
    group: DriveGroup | None = None


def input_motion_of(solved: Solved, burden: MassesAndLoads) -> InputMotion:
    """Motion of the input as in `reduce`: a machine's mean speed if the drive's is constant, else the drive's."""
    span, prepared = solved.span, solved.ready
    path = prepared.kinematics.path
    if path.by_time:
        refuse_drive_in_formulas(burden)
    if path.by_time or not prepared.mechanism.runs_at_mean_speed or not path.parameter.is_uniform:
        return _along(span, "drive")
    moving = Reducer(prepared, burden).moving(span.parameter)
    return InputMotion(moving, np.zeros(len(span.parameter)), "machine")


def given_motion(solved: Solved, speed: float | str, acceleration: float | str | None) -> InputMotion:
    """The drive at a speed and an acceleration that are given, both in its own sense, at the places of a motion.

    Numbers are in SI, texts have units ("65 rpm", "-2.77 rad/s^2"). The time in formulas of loads runs at this speed;
    at rest it is 0.

    Raises
    ------
    InputError
        Several drives; a text that is no speed or no acceleration.
    """
    prepared = solved.ready
    if len(prepared.mechanism.drives) != 1:
        what = _("one speed is given, and there are several drives")
        raise InputError("speed", what, _("give each drive its speed in the description"))
    drive, path = prepared.parameter.drives[0], prepared.kinematics.path
    # with zero added: at rest no sense is left
    rate = path.forward * read_quantity(speed, drive.speed_kind, "speed") + 0.0
    second = 0.0 if acceleration is None else path.forward * _acceleration(acceleration, drive.kind)
    values = solved.span.parameter
    ones = np.ones(len(values))
    elapsed = (values - path.start) / rate if rate else 0.0 * ones
    return InputMotion(DriveMotion(elapsed, values, rate * ones), second * ones, "given")


def _acceleration(given: float | str, kind: str) -> float:
    """An acceleration of a drive [rad/s^2 or m/s^2]; InputError for a text that is none."""
    try:
        return float(derivative_by_time(given, kind, 2))
    except Problem as problem:
        raise InputError("acceleration", problem.what, problem.repair) from None


def steady_grid(
    mechanism: Mechanism, samples: int | None, at: npt.ArrayLike | None
) -> tuple[Ready, SampleGrid, InputMotion]:
    """Samples of a machine in steady motion, with the real speed of its drive; raises as `steady_motion` does."""
    solution = solution_of(mechanism)
    turned, cycle, speed = turned_at(solution, samples, at), solution.cycle, solution.speed
    span = SampleGrid(
        speed.time(turned),
        cycle.value(turned),
        cycle.sense * speed.at(turned),
        cycle.sense * speed.acceleration(turned),
        # the speed of the steady motion is the sample grid's own
    )
    # as in the energies: the time in formulas of loads runs as at the mean speed
    moving = DriveMotion(turned / solution.machine.mean_speed, span.parameter, span.rate)
    pace = InputMotion(moving, span.second_rate, "steady", DriveGroup.of(solution, turned))
    return solution.prepared, span, pace


def rates_of(solved: Solved, pace: InputMotion) -> Array:
    """Speeds of the drives (samples, drives)."""
    path = solved.ready.kinematics.path
    if not path.by_time:
        return pace.moving.rate[:, None]
    time = Jet.variable(solved.span.time, 1)
    values = path.drive_values(JETS, time).values()
    speeds = [value.derivative(1) if isinstance(value, Jet) else 0.0 for value in values]
    return np.stack([np.broadcast_to(speed, solved.span.time.shape) for speed in speeds], axis=-1)


def _along(span: SampleGrid, source: str) -> InputMotion:
    return InputMotion(DriveMotion(span.time, span.parameter, span.rate), span.second_rate, source)
