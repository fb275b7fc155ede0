"""The steady motion of a machine as a labelled result: energies, the drive's speed, real velocities of everything."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field, replace
from math import tau
from typing import Literal, TypeAlias, get_args

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.dynamics.steady_motion.coursework_method import SpeedBySource, needed_by_source
from centrode.dynamics.steady_motion.cycle import (
    Array,
    Cycle,
    CycleReduction,
    MomentShape,
    check_drive,
    cycle_of,
    reduction_of,
)
from centrode.dynamics.steady_motion.speed import (
    MEANS,
    EnergyBalance,
    MeanSpeed,
    Speed,
    Tangents,
    balance_of,
    tangents,
    with_fluctuation,
    with_inertia,
)
from centrode.errors import InputError, MotionError
from centrode.kinematics.motion import dataset_of, vocabulary_variable
from centrode.kinematics.path import SampleGrid, places_of
from centrode.kinematics.preparation import Ready, ready
from centrode.kinematics.solve import DEFAULT_SAMPLES, solve
from centrode.locale import _, ngettext
from centrode.model import reading
from centrode.model.examples.catalogue import MechanismSource, mechanism_of
from centrode.model.mechanism import Mechanism, kept_by_mechanism
from centrode.model.settings import DRIVING_VARIABLES, Machine
from centrode.numerics.text_formula import compile_formula

# Fixed points of functions of many numbers: iteration that learns from its former steps.
#
# Source: D. G. Anderson, Iterative procedures for nonlinear integral equations, J. ACM 12 (1965) 547-560.

KEPT = 16
"""Former steps that the next one is made from."""
# Slider-cranks under loads up to the square of their speed settled in 8 to 14 rounds: none of their steps was
# dropped.


@dataclass
class Mixing:
    """Proposes arguments x for which f(x) = x, from those tried before."""

    arguments: list[Array] = field(default_factory=list)
    changes: list[Array] = field(default_factory=list)

    def following(self, argument: Array, value: Array) -> Array:
        """Next argument (n) after an argument (n) with its value (n): the combination whose change would be least."""
        # the latest steps only: old ones describe the function somewhere else
        self.arguments = [*self.arguments[-KEPT:], argument]
        self.changes = [*self.changes[-KEPT:], value - argument]
        if len(self.changes) == 1:
            return value
        steps = np.diff(np.stack(self.arguments), axis=0).T
        bends = np.diff(np.stack(self.changes), axis=0).T
        # the combination of former steps that would have left the least change, to rounding of their
        # differences
        shares = np.linalg.lstsq(bends, self.changes[-1], rcond=1e-12)[0]
        return np.asarray(value - (steps + bends) @ shares)


# The steady motion of a machine: cycle, energies, inertia that is needed, and speed, in every way it is
# computed.

MOST_ITERATIONS = 60
"""Rounds: four times what machines that settle were seen to take."""
SETTLED = 1e-13
"""Change of the resultant moment, over the greatest ones that it is the sum of, at which loads and speed agree."""


@dataclass(frozen=True)
class SteadySolution:
    """A machine in steady motion.

    Attributes
    ----------
    kind : "middle" or "time"
        What the mean speed is.
    balance : EnergyBalance
        With loads at the mean speed.
    present : float [kg m^2]
        Inertia of the shafts, reduced to the drive.
    by_source : SpeedBySource
    tangents : Tangents or None
        Wittenbauer's, with loads at the mean speed; None where no fluctuation is requested.
    needed : float or None [kg m^2]
        J_I for the fluctuation requested, exactly; negative where the links alone are enough.
    speed : Speed
        Exact, with the greater one of `needed` and `present`.
    iterations : int
        How often loads and speed were made to agree.
    """

    prepared: Ready
    machine: Machine
    kind: MeanSpeed
    balance: EnergyBalance
    present: float
    by_source: SpeedBySource
    tangents: Tangents | None
    needed: float | None
    speed: Speed
    iterations: int

    @property
    def cycle(self) -> Cycle:
        """The cycle with loads at the mean speed."""
        return self.balance.cycle


def solution_of(
    mechanism: Mechanism, kind: MeanSpeed = "middle", reduction: CycleReduction | None = None
) -> SteadySolution:
    """Solve the steady motion of a mechanism with `[machine]`.

    Raises
    ------
    InputError
        No machine, no drive that turns, nothing that moves or resists, loads that drive or do not repeat.
    MotionError
        The mechanism does not turn fully, or loads and speed do not settle.
    """
    _machine(mechanism)
    if kind not in MEANS:
        raise InputError(
            "mean",
            _("{kind} is not a mean speed").format(kind=f'"{kind}"'),
            _("use one of {known}").format(known=", ".join(MEANS)),
        )
    return _kept_solution(mechanism, kind) if reduction is None else _solve(mechanism, kind, reduction)


# A run asks for the steady motion of one mechanism a dozen times: for its flywheel, its forces, its balance.
@kept_by_mechanism(4)
def _kept_solution(mechanism: Mechanism, kind: MeanSpeed) -> SteadySolution:
    return _solve(mechanism, kind, None)


def _solve(mechanism: Mechanism, kind: MeanSpeed, reduction: CycleReduction | None) -> SteadySolution:
    machine = _machine(mechanism)
    prepared = ready(mechanism)
    check_drive(prepared)
    shape = (
        None
        if machine.driving is None
        else MomentShape(compile_formula(machine.driving, DRIVING_VARIABLES, ""))
    )
    mean = machine.mean_speed
    cycle = cycle_of(prepared, reduction or reduction_of(mechanism), shape, mean)
    nodes = cycle.panels.nodes
    balance = balance_of(cycle, shape, np.full(len(nodes), mean))
    _check_matter(balance)
    present = machine.inertia
    lines = None
    if machine.fluctuation is not None:
        spread = 0.5 * machine.fluctuation
        lines = tangents(balance, mean * (1 + spread), mean * (1 - spread))
    needed, speed, iterations = _settle(cycle, shape, machine, present, kind)
    return SteadySolution(
        prepared,
        machine,
        kind,
        balance,
        present,
        _by_source(balance, machine, present),
        lines,
        needed,
        speed,
        iterations,
    )


def in_other_mean(found: SteadySolution, kind: MeanSpeed) -> SteadySolution:
    """A machine in steady motion with another meaning of its mean speed."""
    shape = (
        None
        if found.machine.driving is None
        else MomentShape(compile_formula(found.machine.driving, DRIVING_VARIABLES, ""))
    )
    needed, speed, iterations = _settle(found.cycle, shape, found.machine, found.present, kind)
    return replace(found, kind=kind, needed=needed, speed=speed, iterations=iterations)


def _machine(mechanism: Mechanism) -> Machine:
    if mechanism.machine is None:
        raise InputError(
            "[machine]", _("it is missing"), _('give mean_speed = "65 rpm" and fluctuation = 0.05')
        )
    if not mechanism.runs_at_mean_speed:
        raise InputError("[machine]", _("mean_speed is missing"), _('give it, such as mean_speed = "65 rpm"'))
    return mechanism.machine


def _check_matter(balance: EnergyBalance) -> None:
    """Refuse a machine in which nothing has mass and nothing resists."""
    nodes = balance.cycle.panels.nodes
    if not balance.cycle.inertia.at(nodes).any() and not balance.cycle.moment.at(nodes).any():
        raise InputError(
            "[machine]",
            _("no link has a mass and no load acts: there is no energy to compute"),
            _("give masses, gravity or [[loads]]"),
        )


def _by_source(balance: EnergyBalance, machine: Machine, present: float) -> SpeedBySource:
    energies = balance.energy_extremes(machine.mean_speed**2)
    inertia = present
    if machine.fluctuation is not None:
        inertia = max(present, needed_by_source(energies, machine.mean_speed, machine.fluctuation))
    return SpeedBySource(balance, energies, machine.mean_speed, inertia)


def _settle(
    cycle: Cycle, shape: MomentShape | None, machine: Machine, present: float, kind: MeanSpeed
) -> tuple[float | None, Speed, int]:
    """Inertia needed and speed at which loads, drive and speed agree, and after how many rounds they do."""

    def as_asked(balance: EnergyBalance) -> tuple[float | None, Speed]:
        return _balance_speed(balance, machine, present, kind)

    def as_present(balance: EnergyBalance) -> tuple[float | None, Speed]:
        return None, with_inertia(balance, machine.mean_speed, present, kind)

    # as asked first; only where that does not settle the inertia that is there is tried
    settled = _iterate(cycle, shape, machine.mean_speed, as_asked)
    if settled is None and machine.fluctuation is not None:
        # loads that damp may keep the speed more even than asked, whatever the inertia: then none is needed
        with suppress(InputError):  # it stands still on the way to an answer
            settled = _iterate(cycle, shape, machine.mean_speed, as_present)
        if settled is not None:
            speed = settled[1]
            needed = with_fluctuation(speed.balance, machine.mean_speed, machine.fluctuation, kind)[0].inertia
            # the machine as it is keeps its speed even enough: the answer is that none is needed
            settled = (needed, speed, settled[2]) if needed <= present else None
    if settled is not None:
        return settled
    raise MotionError(
        "[machine]",
        _("speed-dependent loads and the speed do not converge in {count} iterations").format(
            count=MOST_ITERATIONS
        ),
        _("give more inertia, or a smaller fluctuation"),
    )


def _iterate(
    cycle: Cycle,
    shape: MomentShape | None,
    mean: float,
    speed_of: Callable[[EnergyBalance], tuple[float | None, Speed]],
) -> tuple[float | None, Speed, int] | None:
    """Fixed point of `speed_of`: loads and drive are those of the speed it gives; None if it is not reached."""
    nodes = cycle.panels.nodes
    speeds, mixing = np.full(len(nodes), mean), Mixing()
    for iteration in range(1, MOST_ITERATIONS + 1):
        balance = balance_of(cycle, shape, speeds)
        needed, speed = speed_of(balance)
        next_speeds = speed.at(nodes)
        if _agrees(balance, balance_of(cycle.at_speed(next_speeds), shape, next_speeds), nodes):
            return needed, speed, iteration
        mixed = mixing.following(speeds, next_speeds)
        # a speed that is not positive is no speed: then the plain step is taken
        speeds = mixed if mixed.min() > 0.0 else next_speeds
        cycle = cycle.at_speed(speeds)
    return None


def _balance_speed(
    balance: EnergyBalance, machine: Machine, present: float, kind: MeanSpeed
) -> tuple[float | None, Speed]:
    if machine.fluctuation is None:
        return None, with_inertia(balance, machine.mean_speed, present, kind)
    speed, _lines = with_fluctuation(balance, machine.mean_speed, machine.fluctuation, kind)
    if speed.inertia < present or speed.inertia <= 0.0:
        return speed.inertia, with_inertia(balance, machine.mean_speed, present, kind)
    return speed.inertia, speed


def _agrees(one: EnergyBalance, other: EnergyBalance, nodes: Array) -> bool:
    # what both agree on is the resultant, over what it is the difference of
    before, after = one.total.at(nodes), other.total.at(nodes)
    size = sum(float(np.max(np.abs(part.at(nodes)))) for part in (one.cycle.moment, one.driving))
    return bool(np.max(np.abs(after - before)) <= SETTLED * size)


Method: TypeAlias = Literal["exact", "first-order"]
METHODS = get_args(Method)


def steady_motion(
    mechanism: MechanismSource,
    samples: int | None = None,
    at: npt.ArrayLike | None = None,
    *,
    mean: MeanSpeed = "middle",
    method: Method = "exact",
) -> xr.Dataset:
    """A machine in steady motion: its energies over a cycle and the motion with the drive's real speed.

    Parameters
    ----------
    samples : int
        Evenly spaced over the cycle, both ends included; the description's own number, else 361.
    at : (n,) values of the drive [rad]
        Exactly these places instead; whole cycles are taken out of them.
    mean : "middle" or "time"
        What the mean speed is: half of greatest plus least, or the average over time.
    method : "exact" or "first-order"
        The speed by the energy equation, or by the coursework's first-order formula.

    Returns
    -------
    Dataset
        Everything of `motion`, with the real velocities and accelerations, and the moments, works, energies,
        speeds and accelerations of the drive (docs: flywheel). Moments, speeds and accelerations count along the
        coordinate of the drive, `turned` from the initial position in the sense in which it turns.

    Raises
    ------
    InputError, MotionError
        As `flywheel`; without `fluctuation` the machine has the inertia of its shafts alone.

    Examples
    --------
    >>> import centrode as ct
    >>> steady = ct.steady_motion(ct.example("six-bar-press"), 37)
    >>> print(ct.summary(steady).splitlines()[0])
    cycle                1 turn of the drive, 0.922005 s
    """
    mechanism = mechanism_of(mechanism)
    solution = solution_of(mechanism, mean)
    return steady_dataset(solution, turned_at(solution, samples, at), method)


def turned_at(found: SteadySolution, samples: int | None = None, at: npt.ArrayLike | None = None) -> Array:
    """Angles turned [rad] of evenly spaced samples, or of values of the drive."""
    cycle = found.cycle
    if at is None:
        asked = samples if samples is not None else found.prepared.mechanism.study.samples
        count = DEFAULT_SAMPLES if asked is None else asked
        if isinstance(count, bool) or not 1 <= count <= reading.SAMPLES:
            raise InputError(
                _("samples"),
                ngettext("{n} sample is given", "{n} samples are given", count).format(n=count),
                _("give 1 to {most}").format(most=reading.SAMPLES),
            )
        return np.linspace(0.0, cycle.period, count)
    values = places_of(found.prepared.parameter.instant, at)
    if values.ndim != 1 or not 1 <= len(values) <= reading.SAMPLES or not np.isfinite(values).all():
        raise InputError("at", _("it needs finite values of the drive, one or more, in one dimension"))
    turned = cycle.sense * (values - cycle.first)
    return np.asarray(turned - cycle.period * np.floor(turned / cycle.period))


def steady_dataset(found: SteadySolution, turned: Array, method: Method = "exact") -> xr.Dataset:
    """The labelled steady motion at angles turned [rad] within a cycle."""
    if method not in METHODS:
        raise InputError(
            "method",
            _("{name} is not a method of computing the speed").format(name=f'"{method}"'),
            _("use one of {known}").format(known=", ".join(METHODS)),
        )
    cycle = found.cycle
    speed = found.speed if method == "exact" else found.by_source
    rate, second = cycle.sense * speed.at(turned), cycle.sense * speed.acceleration(turned)
    span = SampleGrid(speed.time(turned), cycle.value(turned), rate, second)
    data = dataset_of(solve(found.prepared, span))
    with_energies = {
        name: vocabulary_variable(name, ("sample",), values)
        for name, values in _curves(found, turned).items()
    }
    return data.assign(with_energies).assign_attrs(_facts(found, method))


def _curves(found: SteadySolution, turned: Array) -> dict[str, Array]:
    """Curves of the drive over the cycle (n), by names of the vocabulary."""
    balance, cycle, square = found.speed.balance, found.cycle, found.machine.mean_speed**2
    # the cycle counts as the drive turns, what is shown along the coordinate, as every other result
    along = cycle.sense
    resisting, driving, total = balance.cycle.moment, balance.driving, balance.total
    return {
        "turned": turned,
        "moment_of_loads": along * resisting.at(turned),
        "driving_moment": along * driving.at(turned),
        "work_of_loads": resisting.integral(turned),
        "work_of_drive": driving.integral(turned),
        "work": total.integral(turned),
        "inertia_of_links": cycle.inertia.at(turned),
        "inertia_slope_of_links": along * cycle.slope.at(turned),
        "energy_of_links": 0.5 * square * cycle.inertia.at(turned),
        "energy_change": found.balance.energy_change(turned, square),
        "drive_speed": along * found.speed.at(turned),
        "drive_acceleration": along * found.speed.acceleration(turned),
        "drive_speed_first_order": along * found.by_source.at(turned),
        "drive_acceleration_first_order": along * found.by_source.acceleration(turned),
    }


def _facts(found: SteadySolution, method: Method) -> dict[str, float | str | list[float]]:
    """Attributes of the dataset: what holds for the whole cycle, in SI."""
    lines = found.tangents
    touching: dict[str, list[float]] = (
        {}
        if lines is None
        else {
            "tangent_slopes": [lines.lower_slope, lines.upper_slope],
            "tangent_intercepts": [lines.lower_intercept, lines.upper_intercept],
            "tangents_touch_at": [lines.lower_at, lines.upper_at],
        }
    )
    return {
        "topic": "flywheel",
        "speed_by": method,
        "mean": found.kind,
        "mean_speed": found.machine.mean_speed,
        "turns_of_cycle": found.cycle.period / tau,
        "inertia": found.speed.inertia,
        "inertia_first_order": found.by_source.inertia,
        **touching,
    }
