"""The flywheel of a machine: how much inertia keeps its speed as even as asked, and how great a wheel that is."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

from centrode.dynamics.steady_motion.coursework_method import needed_by_source
from centrode.dynamics.steady_motion.speed import MeanSpeed, Tangents, with_inertia
from centrode.dynamics.steady_motion.steady import SteadySolution, in_other_mean, solution_of
from centrode.errors import InputError
from centrode.locale import _
from centrode.model.examples.catalogue import MechanismSource, mechanism_of
from centrode.model.mechanism import Mechanism
from centrode.model.settings import FlywheelShape
from centrode.printed_results import PrintsSummary

# Sizes of flywheels of a given moment of inertia: a rim on thin spokes, a disc.
#
# With D the outer diameter, d = psi_h D the inner one (0 of a disc), b = psi_b D the width and rho the
# density, J = pi rho b (D^4 - d^4) / 32 and m = pi rho b (D^2 - d^2) / 4; spokes and hub are left out.

SOURCE_DENSITY, SOURCE_WIDTH, SOURCE_INNER = 7800.0, 0.2, 0.8
"""Density [kg/m^3], width and inner diameter over the outer one, of the coursework (docs: flywheel)."""
SOURCE_RIM, SOURCE_DISC = 0.437, 0.366
"""Coefficients of J^(1/5) in the coursework; the one of the rim does not fit the data given there."""
SOURCE_RIM_MASS, SOURCE_DISC_MASS = 6123.0, 1230.0


@dataclass(frozen=True)
class Wheel:
    """A flywheel of one shape.

    Attributes
    ----------
    outer, inner, width : float [m]
    mass : float [kg]
    inertia : float [kg m^2]
    rim_speed : float [m/s]
        Of the outer edge at the greatest speed of its shaft.
    bounded : bool
        The admissible rim speed bounds the diameter; the width follows, not the proportion.
    """

    outer: float
    inner: float
    width: float
    mass: float
    inertia: float
    rim_speed: float
    bounded: bool = False


def inertia_of(outer: float, inner: float, width: float, density: float) -> float:
    """Moment of inertia [kg m^2] of a ring about its axis; lengths [m], density [kg/m^3]."""
    return math.pi * density * width * (outer**4 - inner**4) / 32


def mass_of(outer: float, inner: float, width: float, density: float) -> float:
    """Mass [kg] of a ring."""
    return math.pi * density * width * (outer**2 - inner**2) / 4


def wheel(
    inertia: float,
    density: float,
    width: float,
    inner: float,
    speed: float,
    rim_speed: float | None = None,
) -> Wheel:
    """The flywheel of a moment of inertia [kg m^2], exactly.

    Parameters
    ----------
    density : float [kg/m^3]
    width, inner : float
        Width and inner diameter over the outer one; 0 inside is a disc.
    speed : float [rad/s]
        Greatest speed of its shaft.
    rim_speed : float [m/s], optional
        Greatest admissible one: bounds the diameter; then the width follows from the inertia.
    """
    # from J = pi rho psi_b (1 - psi_h^4) D^5 / 32
    outer = (32 * inertia / (math.pi * density * width * (1 - inner**4))) ** 0.2
    broad, bounded = width * outer, False
    if rim_speed is not None and 0.5 * speed * outer > rim_speed:
        outer, bounded = 2 * rim_speed / speed, True
        # inertia is proportional to the width, so that of unit width gives it by division
        broad = inertia / inertia_of(outer, inner * outer, 1.0, density)
    hole = inner * outer
    mass = mass_of(outer, hole, broad, density)
    return Wheel(
        outer, hole, broad, mass, inertia_of(outer, hole, broad, density), 0.5 * speed * outer, bounded
    )


def by_source(inertia: float, speed: float, *, rim: bool) -> Wheel:
    """The flywheel by the coefficients of the coursework; `inertia` of the result is what these sizes really have."""
    coefficient, hole = (SOURCE_RIM, SOURCE_INNER) if rim else (SOURCE_DISC, 0.0)
    outer = coefficient * inertia**0.2
    inner, width = hole * outer, SOURCE_WIDTH * outer
    mass = SOURCE_RIM_MASS * (outer**2 - inner**2) * width if rim else SOURCE_DISC_MASS * outer**3
    real = inertia_of(outer, inner, width, SOURCE_DENSITY)
    return Wheel(outer, inner, width, mass, real, 0.5 * speed * outer)


@dataclass(frozen=True, repr=False)
class Flywheel(PrintsSummary):
    """A machine's energies over a cycle and the flywheel it needs; what is None belongs to a fluctuation not given.

    Angles turned [rad] count from the initial position in the sense in which the drive turns, speeds are magnitudes.

    Attributes
    ----------
    mechanism : the machine
    mean : "middle" or "time"
        What the mean speed is: half of greatest plus least, or the average over time.
    mean_speed, fluctuation : float [rad/s], [1]
    turns : int
        Of the drive in a cycle.
    work_of_loads, driving_moment : float [J], [N m]
        Over the cycle; mean over the cycle, along the coordinate of the drive.
    error : float [J]
        Bound of the error of the works.
    energy_greatest, energy_least : float [J]
        Of the change of energy of group I, at the angles `greatest_at` and `least_at` [rad].
    inertia_first_order, inertia_by_tangents, inertia : float [kg m^2]
        J_I that is needed: to first order, by Wittenbauer's diagram, exactly for `mean`.
    inertia_in_time : float [kg m^2]
        Exactly where the mean speed is the one in time.
    present : float [kg m^2]
        Of the shafts, reduced to the drive.
    added : float [kg m^2]
        Of the flywheel on its own shaft, exactly; 0 where none is needed.
    added_first_order : float [kg m^2]
        The same by `inertia_first_order`.
    least_speed, greatest_speed, time_of_cycle : float [rad/s], [rad/s], [s]
        With the flywheel, exactly.
    obtained : float
        Coefficient of fluctuation that the energy equation gives with this inertia: a route of its own.
    tangents : Tangents
    rim, disc : Wheel or None
        Of `added`; None where no flywheel is needed.
    source_rim, source_disc : Wheel or None
        Of `added_first_order` by the coursework's coefficients, where material and proportions are its own; their
        `inertia` is what these sizes really have.
    """

    mechanism: Mechanism = field(repr=False, compare=False)
    mean: MeanSpeed
    mean_speed: float
    fluctuation: float | None
    turns: int
    work_of_loads: float
    driving_moment: float
    error: float
    energy_greatest: float
    greatest_at: float
    energy_least: float
    least_at: float
    present: float
    least_speed: float
    greatest_speed: float
    time_of_cycle: float
    obtained: float
    inertia_first_order: float | None = None
    inertia_by_tangents: float | None = None
    inertia: float | None = None
    inertia_in_time: float | None = None
    added: float | None = None
    added_first_order: float | None = None
    tangents: Tangents | None = None
    rim: Wheel | None = None
    disc: Wheel | None = None
    source_rim: Wheel | None = None
    source_disc: Wheel | None = None


def flywheel(mechanism: MechanismSource, mean: MeanSpeed = "middle") -> Flywheel:
    """The flywheel that gives a machine the fluctuation its `[machine]` requires.

    Parameters
    ----------
    mean : "middle" or "time"
        What `mean_speed` is: half of greatest plus least speed, or the average over time.

    Returns
    -------
    Flywheel
        The inertia needed in the coursework's way, by Wittenbauer's diagram and exactly, what it is taken from,
        and sizes.

    Raises
    ------
    InputError
        No machine or no fluctuation, no drive that turns, nothing that moves or resists, loads that drive.
    MotionError
        The mechanism does not turn fully.

    Notes
    -----
    Works are exact to `error`; the exact speed has the fluctuation and the mean to rounding, some 1e-14.

    Examples
    --------
    >>> import centrode as ct
    >>> round(ct.flywheel(ct.example("six-bar-press")).added, 2)
    1456.73
    """
    mechanism = mechanism_of(mechanism)
    need_fluctuation(mechanism)
    return flywheel_of(solution_of(mechanism, mean))


def need_fluctuation(mechanism: Mechanism, **_arguments: object) -> None:
    """Raise InputError for a machine without a fluctuation that is allowed, and without a flywheel that is there."""
    machine = mechanism.machine
    if machine is not None and machine.fluctuation is None and machine.flywheel.inertia is None:
        raise InputError(
            "[machine]",
            _("fluctuation is missing"),
            _(
                "give the one that is allowed, such as fluctuation = 0.05, or the inertia of [machine.flywheel]"
            ),
        )


def flywheel_of(found: SteadySolution) -> Flywheel:
    """Energies and flywheel of a solution; what needs a fluctuation is None without one."""
    machine, energies = found.machine, found.by_source.energies
    ends = found.speed.extremes()
    # by the energy equation for this inertia alone, not by the tangents that gave it
    checked = with_inertia(found.speed.balance, machine.mean_speed, found.speed.inertia, found.kind)
    common = Flywheel(
        mechanism=found.prepared.mechanism,
        mean=found.kind,
        mean_speed=machine.mean_speed,
        fluctuation=machine.fluctuation,
        turns=found.cycle.turns,
        work_of_loads=found.speed.balance.work_of_loads,
        driving_moment=found.cycle.sense * found.speed.balance.driving_moment,
        error=found.speed.balance.error,
        energy_greatest=energies.greatest,
        greatest_at=energies.at_greatest,
        energy_least=energies.least,
        least_at=energies.at_least,
        present=found.present,
        least_speed=ends.least,
        greatest_speed=ends.greatest,
        time_of_cycle=found.cycle.period / found.speed.mean("time"),
        obtained=checked.extremes().range / machine.mean_speed,
    )
    if machine.fluctuation is None or found.needed is None or found.tangents is None:
        return _with_sizes(common, machine.flywheel)
    by_source = needed_by_source(energies, machine.mean_speed, machine.fluctuation)
    # both meanings of the mean speed are reported, whichever was requested
    in_time = found if found.kind == "time" else in_other_mean(found, "time")
    shape = machine.flywheel
    added, added_first_order = (
        # on a shaft of another speed inertia counts by the square of the ratio
        max(0.0, (inertia - found.present) / shape.ratio**2)
        for inertia in (found.needed, by_source)
    )
    speed = abs(shape.ratio) * ends.greatest
    rim, disc = (_size_wheel(added, shape, inner, speed) for inner in (shape.inner, 0.0))
    source_rim, source_disc = (_by_source(added_first_order, shape, speed, rim=rim) for rim in (True, False))
    return replace(
        common,
        inertia_first_order=by_source,
        inertia_by_tangents=found.tangents.inertia,
        inertia=found.needed,
        inertia_in_time=in_time.needed,
        added=added,
        added_first_order=added_first_order,
        tangents=found.tangents,
        rim=rim,
        disc=disc,
        source_rim=source_rim,
        source_disc=source_disc,
    )


def _with_sizes(found: Flywheel, shape: FlywheelShape) -> Flywheel:
    """With the sizes of a wheel whose inertia is given, where one is."""
    if shape.inertia is None:
        return found
    speed = abs(shape.ratio) * found.greatest_speed
    rim, disc = (_size_wheel(shape.inertia, shape, inner, speed) for inner in (shape.inner, 0.0))
    return replace(found, rim=rim, disc=disc)


def _size_wheel(inertia: float, shape: FlywheelShape, inner: float, speed: float) -> Wheel | None:
    if inertia <= 0.0:
        return None
    return wheel(inertia, shape.density, shape.width, inner, speed, shape.rim_speed)


def _by_source(inertia: float, shape: FlywheelShape, speed: float, *, rim: bool) -> Wheel | None:
    """By the coursework's coefficients, which belong to its own density and proportions."""
    its_own = (shape.density, shape.width) == (SOURCE_DENSITY, SOURCE_WIDTH)
    if inertia <= 0.0 or not its_own or (rim and shape.inner != SOURCE_INNER):
        return None
    return by_source(inertia, speed, rim=rim)
