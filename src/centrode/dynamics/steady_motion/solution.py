"""The steady motion of a machine: cycle, energies, inertia that is needed, and speed, in every way it is computed."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np

from centrode.algebra.text import compile_formula
from centrode.dynamics.steady_motion.balance import MEANS, Balance, Mean, balance_of
from centrode.dynamics.steady_motion.by_source import SpeedBySource, needed_by_source
from centrode.dynamics.steady_motion.cycle import Cycle, Reduction, check_drive, cycle_of
from centrode.dynamics.steady_motion.driving import Shape
from centrode.dynamics.steady_motion.mixing import Mixing
from centrode.dynamics.steady_motion.quadrature import Array
from centrode.dynamics.steady_motion.reducing import reduction_of
from centrode.dynamics.steady_motion.speeds import Speed, Tangents, tangents, with_fluctuation, with_inertia
from centrode.errors import InputError, MotionError
from centrode.kinematics.ready import Ready, ready
from centrode.locale import _
from centrode.model.machines import DRIVING_VARIABLES, Machine
from centrode.model.mechanism import Mechanism

MOST_ITERATIONS = 60
SETTLED = 1e-13
"""Change of the resultant moment, over the greatest ones that it is the sum of, at which loads and speed agree."""


@dataclass(frozen=True)
class Solution:
    """A machine in steady motion.

    Attributes
    ----------
    kind : "middle" or "time"
        What the mean speed is.
    balance : Balance
        With loads at the mean speed.
    present : float [kg m^2]
        Inertia of the shafts, reduced to the drive.
    by_source : SpeedBySource
    tangents : Tangents or None
        Wittenbauer's, with loads at the mean speed; None where no fluctuation is asked for.
    needed : float or None [kg m^2]
        J_I for the fluctuation asked for, exactly; negative where the links alone are enough.
    speed : Speed
        Exact, with the greater one of `needed` and `present`.
    iterations : int
        How often loads and speed were made to agree.
    """

    prepared: Ready
    machine: Machine
    kind: Mean
    balance: Balance
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


def solution_of(mechanism: Mechanism, kind: Mean = "middle", reduction: Reduction | None = None) -> Solution:
    """Solve the steady motion of a mechanism with `[machine]`.

    Raises
    ------
    InputError
        No machine, no drive that turns, nothing that moves or resists, loads that drive or do not repeat.
    MotionError
        The mechanism does not turn fully, or loads and speed do not settle.
    """
    machine = _machine(mechanism)
    if kind not in MEANS:
        raise InputError(
            "mean",
            _("{kind} is not a mean speed").format(kind=f'"{kind}"'),
            _("use one of {known}").format(known=", ".join(MEANS)),
        )
    prepared = ready(mechanism)
    check_drive(prepared)
    shape = (
        None if machine.driving is None else Shape(compile_formula(machine.driving, DRIVING_VARIABLES, ""))
    )
    mean = machine.mean_speed
    cycle = cycle_of(prepared, reduction or reduction_of(mechanism), shape, mean)
    nodes = cycle.panels.nodes
    balance = balance_of(cycle, shape, np.full(len(nodes), mean))
    _check_matter(balance)
    present = sum(shaft.inertia * shaft.ratio**2 for shaft in machine.shafts)
    lines = None
    if machine.fluctuation is not None:
        spread = 0.5 * machine.fluctuation
        lines = tangents(balance, mean * (1 + spread), mean * (1 - spread))
    needed, speed, iterations = _settled(cycle, shape, machine, present, kind)
    return Solution(
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


def in_other_mean(found: Solution, kind: Mean) -> Solution:
    """The same machine with another meaning of its mean speed."""
    shape = (
        None
        if found.machine.driving is None
        else Shape(compile_formula(found.machine.driving, DRIVING_VARIABLES, ""))
    )
    needed, speed, iterations = _settled(found.cycle, shape, found.machine, found.present, kind)
    return replace(found, kind=kind, needed=needed, speed=speed, iterations=iterations)


def _machine(mechanism: Mechanism) -> Machine:
    if mechanism.machine is None:
        raise InputError(
            "[machine]", _("it is missing"), _('give mean_speed = "65 rpm" and fluctuation = 0.05')
        )
    return mechanism.machine


def _check_matter(balance: Balance) -> None:
    """Refuse a machine in which nothing has mass and nothing resists."""
    nodes = balance.cycle.panels.nodes
    if not balance.cycle.inertia.at(nodes).any() and not balance.cycle.moment.at(nodes).any():
        raise InputError(
            "[machine]",
            _("no link has a mass and no load acts: there is no energy to compute"),
            _("give masses, gravity or [[loads]]"),
        )


def _by_source(balance: Balance, machine: Machine, present: float) -> SpeedBySource:
    energies = balance.energy_extremes(machine.mean_speed**2)
    inertia = present
    if machine.fluctuation is not None:
        inertia = max(present, needed_by_source(energies, machine.mean_speed, machine.fluctuation))
    return SpeedBySource(balance, energies, machine.mean_speed, inertia)


def _settled(
    cycle: Cycle, shape: Shape | None, machine: Machine, present: float, kind: Mean
) -> tuple[float | None, Speed, int]:
    """Inertia needed and speed at which loads, drive and speed agree, and after how many rounds they do."""

    def as_asked(balance: Balance) -> tuple[float | None, Speed]:
        return _speed(balance, machine, present, kind)

    def as_present(balance: Balance) -> tuple[float | None, Speed]:
        return None, with_inertia(balance, machine.mean_speed, present, kind)

    found = _iterated(cycle, shape, machine.mean_speed, as_asked)
    if found is None and machine.fluctuation is not None:
        # loads that damp may keep the speed more even than asked, whatever the inertia: then none is needed
        with suppress(InputError):  # it stands still on the way to an answer
            found = _iterated(cycle, shape, machine.mean_speed, as_present)
        if found is not None:
            speed = found[1]
            needed = with_fluctuation(speed.balance, machine.mean_speed, machine.fluctuation, kind)[0].inertia
            found = (needed, speed, found[2]) if needed <= present else None
    if found is not None:
        return found
    raise MotionError(
        "[machine]",
        _("loads that depend on the speed and the speed itself do not settle after {count} rounds").format(
            count=MOST_ITERATIONS
        ),
        _("give more inertia, or a smaller fluctuation"),
    )


def _iterated(
    cycle: Cycle, shape: Shape | None, mean: float, speed_of: Callable[[Balance], tuple[float | None, Speed]]
) -> tuple[float | None, Speed, int] | None:
    """What `speed_of` finds when loads and drive are those of the speed it finds; None where they never are."""
    nodes = cycle.panels.nodes
    speeds, mixing = np.full(len(nodes), mean), Mixing()
    for iteration in range(1, MOST_ITERATIONS + 1):
        balance = balance_of(cycle, shape, speeds)
        needed, speed = speed_of(balance)
        found = speed.at(nodes)
        if _agrees(balance, balance_of(cycle.at_speed(found), shape, found), nodes):
            return needed, speed, iteration
        mixed = mixing.following(speeds, found)
        speeds = mixed if mixed.min() > 0.0 else found
        cycle = cycle.at_speed(speeds)
    return None


def _speed(balance: Balance, machine: Machine, present: float, kind: Mean) -> tuple[float | None, Speed]:
    if machine.fluctuation is None:
        return None, with_inertia(balance, machine.mean_speed, present, kind)
    speed, _lines = with_fluctuation(balance, machine.mean_speed, machine.fluctuation, kind)
    if speed.inertia < present or speed.inertia <= 0.0:
        return speed.inertia, with_inertia(balance, machine.mean_speed, present, kind)
    return speed.inertia, speed


def _agrees(one: Balance, other: Balance, nodes: Array) -> bool:
    before, after = one.total.at(nodes), other.total.at(nodes)
    size = sum(float(np.max(np.abs(part.at(nodes)))) for part in (one.cycle.moment, one.driving))
    return bool(np.max(np.abs(after - before)) <= SETTLED * size)
