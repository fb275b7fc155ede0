"""Free motion as an initial value problem: what is followed, how it is closed, how great an error counts.

Followed are coordinates, cosine and sine of the angles among them, speeds and works. The rotors are states like the
others, so no stage has a function of an angle; after each step that is taken they are computed anew from the angle.
There the coordinates and speeds are closed too, by one step of Newton's method of least change in the measure of the
masses.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

from centrode.dynamics.forward_dynamics.elimination import is_zero
from centrode.dynamics.forward_dynamics.equations_of_motion import EquationsOfMotion, Flags
from centrode.dynamics.forward_dynamics.spanning_tree import JointValues, Rotor
from centrode.dynamics.loads import EnergyClass
from centrode.numerics.expressions import EXPRESSIONS, Node, as_node, variable
from centrode.numerics.initial_value_problems import (
    BEFORE,
    END,
    OF_FIFTH,
    OF_THIRD,
    SMALLEST,
    STEP,
    TIME,
    InitialValueProblem,
)
from centrode.numerics.unit_rotors import without_unit_squares

Number: TypeAlias = Any
Namespace: TypeAlias = Any

TOLERANCE, RATE, LENGTH = "tolerance", "rate", "length"
INDEPENDENCE, AHEAD, LOOKED, LIMIT, GUARD = "independence", "ahead", "looked", "limit", "guard"
"""Carried beside: how independent closures are, the time until they are not, and what stops the steps there."""
FLOOR = 0.1
"""Share of what speeds are compared with that counts where they are zero."""
SHARE = 0.2
"""Of the tolerance that a step may err by its estimate: errors of many steps add up."""
NEAR, FAR = 0.25, 0.4
"""A change point is looked for where closures are no more independent than this, and the fastest link will turn by
less
than this until they lose rank."""
NEVER = 1e300
CONTROLS = (END, SMALLEST, TOLERANCE, RATE, LENGTH)
"""Parameters of a lane: its end, its least step, the error of a step, what speeds and lengths are compared with."""


@dataclass(frozen=True)
class MotionNames:
    """Names of what is followed, and of what stays as it is during a step."""

    coordinates: tuple[str, ...]
    cosines: tuple[str, ...]
    sines: tuple[str, ...]
    speeds: tuple[str, ...]
    works: tuple[str, ...]
    flags: tuple[str, ...]

    @classmethod
    def of(cls, equations: EquationsOfMotion) -> MotionNames:
        """Names by numbers of coordinates and equations."""
        size, angles = range(equations.size), equations.tree.angles
        return cls(
            tuple(f"coordinate {k}" for k in size),
            tuple(f"cosine {k}" for k in angles),
            tuple(f"sine {k}" for k in angles),
            tuple(f"speed {k}" for k in size),
            tuple(f"work {k}" for k in range(len(worked_loads(equations)) + len(equations.kept))),
            tuple(f"counts {row}" for row in sorted(equations.dependent)),
        )

    @property
    def unknowns(self) -> tuple[str, ...]:
        """All that is followed, in order."""
        return (*self.coordinates, *self.cosines, *self.sines, *self.speeds, *self.works)

    def part(self, names: Sequence[str]) -> slice:
        """Where some of them stand in a row that has all of them."""
        if not names:
            return slice(0, 0)
        first = self.unknowns.index(names[0])
        return slice(first, first + len(names))


def worked_loads(equations: EquationsOfMotion) -> tuple[int, ...]:
    """Numbers of the loads whose work is followed: those without a potential energy."""
    return tuple(
        k for k, load in enumerate(equations.loads) if load.term.amount.energy_class != EnergyClass.STORED
    )


@dataclass(frozen=True)
class Rates:
    """Derivatives by time at one state; `flags` say which dependent equations counted."""

    accelerations: Sequence[Number]
    powers: Sequence[Number]
    flags: Flags


def rates_of(
    m: Namespace,
    equations: EquationsOfMotion,
    values: JointValues,
    speeds: Sequence[Number],
    time: Number,
    flags: Flags | None = None,
) -> Rates:
    """Accelerations and powers."""
    terms = equations.terms(m, values, speeds, time)
    accelerations, forces, chosen = equations.accelerations(m, terms, flags)
    kept = forces[len(forces) - len(equations.kept) :] if equations.kept else []
    powers = [terms.powers[k] for k in worked_loads(equations)]
    # a drive's constraint is its value less the law: what moves the mechanism acts against the row
    powers += [-(force * rate) for force, rate in zip(kept, terms.rates, strict=True)]
    return Rates(accelerations, powers, chosen)


def turned_rotor(rotor: Rotor, by: Number) -> Rotor:
    """A rotor turned by a small angle, to the second order."""
    cosine, sine = rotor
    if is_zero(by):
        return rotor
    short = 1.0 - 0.5 * (by * by)
    return cosine * short - by * sine, sine * short + by * cosine


def motion_problem(equations: EquationsOfMotion, parameters: Sequence[str]) -> InitialValueProblem:
    """The initial value problem of equations whose numbers are variables."""
    m, names, tree = EXPRESSIONS, MotionNames.of(equations), equations.tree
    coordinates = [variable(name) for name in names.coordinates]
    speeds = [variable(name) for name in names.speeds]
    rotors = {
        k: (variable(cosine), variable(sine))
        for k, cosine, sine in zip(tree.angles, names.cosines, names.sines, strict=True)
    }
    rows = sorted(equations.dependent)
    flags = {row: m.less(0.5, variable(name)) for row, name in zip(rows, names.flags, strict=True)}
    time = variable(TIME)
    found = rates_of(m, equations, JointValues(coordinates, rotors), speeds, time, flags or None)
    rates: dict[str, Number] = dict(zip(names.coordinates, speeds, strict=True))
    rates |= {name: -(speeds[k] * rotors[k][1]) for k, name in zip(tree.angles, names.cosines, strict=True)}
    rates |= {name: speeds[k] * rotors[k][0] for k, name in zip(tree.angles, names.sines, strict=True)}
    rates |= dict(zip(names.speeds, found.accelerations, strict=True))
    rates |= dict(zip(names.works, found.powers, strict=True))
    closing = _closing(equations, names, coordinates, speeds, time)
    watched = GUARD in closing
    early = (*CONTROLS, *parameters)
    turned = [(as_node(m.cos(coordinates[k])), as_node(m.sin(coordinates[k]))) for k in tree.angles]
    return InitialValueProblem(
        early,
        without_unit_squares({name: as_node(x) for name, x in rates.items()}, list(rotors.values()), early),
        without_unit_squares(closing, turned, early),
        as_node(_error(equations, names)),
        LIMIT if watched else "",
        GUARD if watched else "",
    )


def _closing(
    equations: EquationsOfMotion,
    names: MotionNames,
    coordinates: Sequence[Node],
    speeds: Sequence[Node],
    time: Node,
) -> dict[str, Node]:
    m, tree = EXPRESSIONS, equations.tree
    values = tree.values(m, coordinates)
    q, w = list(coordinates), list(speeds)
    rotors = dict(values.rotors)
    counted: dict[str, Number] = {}
    if equations.equations:
        terms = equations.terms(m, values, speeds, time)
        system = equations.system(m, terms)
        shift = equations.shift_to_close(terms, system)
        q = [x if is_zero(shift.get(k, 0.0)) else x + shift[k] for k, x in enumerate(coordinates)]
        rotors = {k: turned_rotor(rotors[k], shift.get(k, 0.0)) for k in tree.angles}
        w = equations.consistent_speeds(m, JointValues(q, rotors), speeds, time, system)
        counted = {
            name: m.where(system.flags[row], 1.0, 0.0) if row in system.flags else 0.0
            for row, name in zip(sorted(equations.dependent), names.flags, strict=True)
        }
        counted |= _watch(equations, system.independence(m), w)
    closed: dict[str, Number] = dict(zip(names.coordinates, q, strict=True))
    closed |= {name: rotors[k][0] for k, name in zip(tree.angles, names.cosines, strict=True)}
    closed |= {name: rotors[k][1] for k, name in zip(tree.angles, names.sines, strict=True)}
    closed |= dict(zip(names.speeds, w, strict=True))
    return {name: as_node(x) for name, x in (closed | counted).items()}


def _watch(equations: EquationsOfMotion, independence: Number, speeds: Sequence[Number]) -> dict[str, Number]:
    """What tells of a change point ahead: when the closures lose rank if they go on to as they do."""
    m = EXPRESSIONS
    if isinstance(independence, float):
        return {}
    lost = (independence - variable(INDEPENDENCE)) / variable(STEP)
    falls = m.less(lost, 0.0)
    ahead = m.where(falls, independence / m.where(falls, -lost, 1.0), NEVER)
    fastest: Number = variable(RATE)
    for speed, coordinate in zip(speeds, equations.tree.coordinates, strict=True):
        size = m.abs(speed)
        fastest = m.max(fastest, size if coordinate.kind == "angle" else size / variable(LENGTH))
    # until it rises again a place that was looked at is looked at only when it is much nearer
    looked = m.where(falls, variable(LOOKED), NEAR)
    near = m.both(m.less(ahead * fastest, FAR), m.less(independence, looked))
    return {
        INDEPENDENCE: independence,
        AHEAD: ahead,
        LOOKED: looked,
        # independence grows as the angle from a change point does: a shorter step passes over none
        LIMIT: m.where(m.less(independence, NEAR), 0.5 * ahead, 0.5 * independence / fastest),
        GUARD: m.where(near, 1.0, 0.0),
    }


def _error(equations: EquationsOfMotion, names: MotionNames) -> Number:
    """Hairer's estimate: of angles in rad and displacements over the length, of speeds over what they reach."""
    m = EXPRESSIONS
    fifth: Number = 0.0
    third: Number = 0.0
    for k, coordinate in enumerate(equations.tree.coordinates):
        name, speed = names.coordinates[k], names.speeds[k]
        unit = 1.0 if coordinate.kind == "angle" else variable(LENGTH)
        reach = unit * FLOOR * variable(RATE) + m.max(m.abs(variable(BEFORE + speed)), m.abs(variable(speed)))
        for one, scale in ((name, unit), (speed, reach)):
            parts = [variable(prefix + one) for prefix in (OF_FIFTH, OF_THIRD)]
            if not isinstance(scale, float):
                inverse = 1.0 / scale
                parts = [part * inverse for part in parts]
            fifth, third = fifth + parts[0] * parts[0], third + parts[1] * parts[1]
    together = fifth + 0.01 * third
    size = m.abs(variable(STEP)) * fifth / m.sqrt(together * float(2 * equations.size))
    # nothing erred, or something has no value
    return m.where(m.less(0.0, together), size, together) / (SHARE * variable(TOLERANCE))
