"""Free motion as an initial value problem: what is followed, how it is closed, how great an error counts.

Followed are coordinates, cosine and sine of the angles among them, speeds and works. The rotors are states like the
others, so no stage has a function of an angle; after each step that is taken they are computed anew from the angle.
There the coordinates and speeds are closed too, by one step of Newton's method of least change in the measure of the
masses.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple, TypeAlias

from centrode.dynamics.forward_dynamics.contacts import (
    AT_LEAST,
    AT_MOST,
    FRICTION,
    STOP,
    ContactMode,
    pressed_numbers,
)
from centrode.dynamics.forward_dynamics.controllers import states_of
from centrode.dynamics.forward_dynamics.elimination import is_zero, times
from centrode.dynamics.forward_dynamics.equations_of_motion import (
    EquationsOfMotion,
    Flags,
    MassSystem,
    Motion,
    Terms,
)
from centrode.dynamics.forward_dynamics.reaction_friction import (
    UNSETTLED,
    greatest_press,
    mode_margin,
    uniqueness,
)
from centrode.dynamics.forward_dynamics.spanning_tree import JointValues, Rotor
from centrode.dynamics.load_coordinates import is_angular
from centrode.dynamics.loads import EnergyClass
from centrode.dynamics.state import length_unit
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
CONDITION = "condition"
PRESSES, UNIQUE = "presses", "unique"
"""Guards of friction by coefficients: what presses a slider is the same, and there is one solution."""
PASSED = 2.0
"""Value of what stops the steps where a guard has passed zero; added to that of a change point."""
LEAST_GAP = 1e-15
"""Share of the greatest length that two digits of a place are apart."""
ROUNDING = 1e-13
"""Share of lengths, speeds and accelerations below which a guard is taken for zero."""
PRESS_ROUNDING = 1e-13
"""Share of the forces that make a reaction below which what presses is taken for the same."""
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
    active: tuple[str, ...] = ()
    senses: tuple[str, ...] = ()
    held: tuple[str, ...] = ()
    first: tuple[str, ...] = ()
    second: tuple[str, ...] = ()
    guards: tuple[str, ...] = ()
    sides: tuple[str, ...] = ()
    states: tuple[str, ...] = ()

    @classmethod
    def of(cls, equations: EquationsOfMotion) -> MotionNames:
        """Names by numbers of coordinates and equations."""
        size, angles = range(equations.size), equations.tree.angles
        return cls(
            tuple(f"coordinate {k}" for k in size),
            tuple(f"cosine {k}" for k in angles),
            tuple(f"sine {k}" for k in angles),
            tuple(f"speed {k}" for k in size),
            tuple(
                f"work {k}"
                for k in range(
                    len(worked_loads(equations))
                    + len(equations.kept)
                    + len(equations.controls)
                    + len(equations.contacts)
                )
            ),
            tuple(f"counts {row}" for row in equations.flagged_rows),
            tuple(f"active {k}" for k in range(len(equations.contacts))),
            tuple(f"sense {k}" for k in range(len(equations.contacts))),
            tuple(f"held {k}" for k in range(len(equations.contacts))),
            tuple(f"first {k}" for k in pressed_numbers(equations.contacts)),
            tuple(f"second {k}" for k in pressed_numbers(equations.contacts)),
            tuple(f"guard {k}" for k in range(len(guards_of(equations)))),
            tuple(f"side {k}" for k in range(len(equations.conditions))),
            tuple(f"state {k}" for k in range(len(states_of(equations.controls)))),
        )

    @property
    def modes(self) -> tuple[str, ...]:
        """What stays as it is between events."""
        return (*self.active, *self.senses, *self.held, *self.first, *self.second, *self.sides)

    @property
    def unknowns(self) -> tuple[str, ...]:
        """All that is followed, in order."""
        return (
            *self.coordinates,
            *self.cosines,
            *self.sines,
            *self.speeds,
            *self.works,
            *self.states,
        )

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


class Guard(NamedTuple):
    """What passes zero downwards at an event.

    Attributes
    ----------
    kind : "stop", "friction", "presses", "unique" or "condition"
    number : of the contact or the condition; that of the first contact where all are meant
    bound : -1 or +1 of a stop
    """

    kind: str
    number: int
    bound: float = 0.0


def guards_of(equations: EquationsOfMotion) -> tuple[Guard, ...]:
    """Guards of a motion: of each bound of a stop, of each friction and of each condition."""
    found = []
    for k, contact in enumerate(equations.contacts):
        if contact.kind == FRICTION:
            found.append(Guard(FRICTION, k))
        if contact.pressing is not None and not contact.pressing.is_round:
            found.append(Guard(PRESSES, k))
        for bound, value in ((AT_LEAST, contact.least), (AT_MOST, contact.most)):
            if value is not None:
                found.append(Guard(STOP, k, bound))
    found += [Guard(UNIQUE, k) for k in pressed_numbers(equations.contacts)[:1]]
    return (*found, *(Guard(CONDITION, k) for k in range(len(equations.conditions))))


def modes_of(names: MotionNames, get: Callable[[str], Number]) -> list[ContactMode] | None:
    """Modes of all contacts by a function of their names; None where nothing is watched."""
    if not (names.active or names.sides):
        return None
    found = []
    for k, row in enumerate(zip(names.active, names.senses, names.held, strict=True)):
        weights = [
            f"{name} {k}" for name in ("first", "second") if f"{name} {k}" in (*names.first, *names.second)
        ]
        found.append(ContactMode(*map(get, (*row, *weights))))
    return found


@dataclass(frozen=True)
class Rates:
    """Derivatives by time at one state; `flags` say which dependent equations counted."""

    accelerations: Sequence[Number]
    powers: Sequence[Number]
    flags: Flags
    states: Sequence[Number] = ()


def rates_of(
    m: Namespace,
    equations: EquationsOfMotion,
    values: JointValues,
    speeds: Sequence[Number],
    time: Number,
    flags: Flags | None = None,
    modes: Sequence[ContactMode] | None = None,
    states: Sequence[Number] | None = None,
) -> Rates:
    """Accelerations and powers."""
    terms = equations.terms(m, values, speeds, time, modes, states)
    system = equations.system(m, terms, flags)
    moved = equations.motion(m, terms, system)
    accelerations = [moved.accelerations.get(k, 0.0) for k in range(equations.size)]
    forces = [moved.forces.get(i, 0.0) for i in range(len(terms.rows))]
    kept = forces[equations.equations - len(equations.kept) : equations.equations]
    powers = [terms.powers[k] for k in worked_loads(equations)]
    # a drive's constraint is its value less the law: what moves the mechanism acts against the row
    powers += [-(force * rate) for force, rate in zip(kept, terms.rates, strict=True)]
    powers += terms.output_powers
    behind = dict((number, forces[row]) for row, number in equations.contact_rows if row < len(forces))
    for number, (contact, one) in enumerate(zip(equations.contacts, moved.measures, strict=False)):
        # a belt works on what sticks to it; stops and clamps do not move
        carried = times(-behind[number], contact.drift) if contact.kind == FRICTION else 0.0
        powers.append(times(one.strength, one.speed) + carried)
    return Rates(accelerations, powers, system.flags, terms.state_rates)


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
    rows = equations.flagged_rows
    modes = modes_of(names, variable)
    states = [variable(name) for name in names.states]
    flags = {row: m.less(0.5, variable(name)) for row, name in zip(rows, names.flags, strict=True)}
    time = variable(TIME)
    found = rates_of(
        m, equations, JointValues(coordinates, rotors), speeds, time, flags or None, modes, states
    )
    rates: dict[str, Number] = dict(zip(names.coordinates, speeds, strict=True))
    rates |= {name: -(speeds[k] * rotors[k][1]) for k, name in zip(tree.angles, names.cosines, strict=True)}
    rates |= {name: speeds[k] * rotors[k][0] for k, name in zip(tree.angles, names.sines, strict=True)}
    rates |= dict(zip(names.speeds, found.accelerations, strict=True))
    rates |= dict(zip(names.works, found.powers, strict=True))
    rates |= dict(zip(names.states, found.states, strict=True))
    closing = _closing(equations, names, coordinates, speeds, time)
    watched = LIMIT in closing
    early = (*CONTROLS, *parameters)
    turned = [(as_node(m.cos(coordinates[k])), as_node(m.sin(coordinates[k]))) for k in tree.angles]
    return InitialValueProblem(
        early,
        without_unit_squares({name: as_node(x) for name, x in rates.items()}, list(rotors.values()), early),
        without_unit_squares(closing, turned, early),
        as_node(_error(equations, names)),
        LIMIT if watched else "",
        GUARD if GUARD in closing else "",
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
    modes = modes_of(names, variable)
    if equations.equations or equations.contact_rows:
        active = {
            row: m.less(0.5, m.abs(variable(names.active[number]))) for row, number in equations.contact_rows
        }
        states = [variable(name) for name in names.states]
        terms = equations.terms(m, values, speeds, time, modes, states)
        system = equations.system(m, terms, active=active)
        shift = equations.shift_to_close(terms, system)
        q = [x if is_zero(shift.get(k, 0.0)) else x + shift[k] for k, x in enumerate(coordinates)]
        rotors = {k: turned_rotor(rotors[k], shift.get(k, 0.0)) for k in tree.angles}
        w = equations.consistent_speeds(
            m, JointValues(q, rotors), speeds, time, system, bool(equations.contacts)
        )
        counted = {
            name: m.where(system.flags[row], 1.0, 0.0) if row in system.flags else 0.0
            for row, name in zip(equations.flagged_rows, names.flags, strict=True)
        }
        counted |= _watch(equations, system.independence(m), w)
    if equations.has_events:
        chosen = {
            row: m.less(0.5, counted[name])
            for row, name in zip(equations.flagged_rows, names.flags, strict=True)
            if not isinstance(counted[name], float)
        }
        counted |= {name: variable(name) for name in names.modes}
        watched = _guards(equations, names, JointValues(q, rotors), w, time, chosen, modes or [])
        counted |= watched[0]
        counted[GUARD] = counted.get(GUARD, 0.0) + (
            0.0 if watched[1] is None else m.where(watched[1], PASSED, 0.0)
        )
    closed: dict[str, Number] = dict(zip(names.coordinates, q, strict=True))
    closed |= {name: rotors[k][0] for k, name in zip(tree.angles, names.cosines, strict=True)}
    closed |= {name: rotors[k][1] for k, name in zip(tree.angles, names.sines, strict=True)}
    closed |= dict(zip(names.speeds, w, strict=True))
    return {name: as_node(x) for name, x in (closed | counted).items()}


def _guards(
    equations: EquationsOfMotion,
    names: MotionNames,
    values: JointValues,
    speeds: Sequence[Number],
    time: Number,
    flags: Flags,
    modes: Sequence[ContactMode],
) -> tuple[dict[str, Number], Number]:
    """Values of all guards behind a step, and whether one has passed zero; directions of what presses."""
    m = EXPRESSIONS
    states = [variable(name) for name in names.states]
    terms = equations.terms(m, values, speeds, time, modes, states)
    system = equations.system(m, terms, flags)
    moved = equations.motion(m, terms, system)
    found: dict[str, Number] = {}
    passed: Number = None
    for name, guard in zip(names.guards, guards_of(equations), strict=True):
        if guard.kind == CONDITION:
            value, floor = variable(names.sides[guard.number]) * terms.conditions[guard.number], ROUNDING
        elif guard.kind == UNIQUE:
            found_at = m.less(moved.unsettled, UNSETTLED)
            value, floor = m.where(found_at, uniqueness(m, moved.joints), -1.0), 0.0
        elif guard.kind == PRESSES:
            value, floor = _guard_of_press(guard.number, terms, moved)
        else:
            value, floor = _guard_of_contact(equations, guard, terms, system, moved)
        below = m.less(value + floor, 0.0)
        # below zero by rounding alone is zero
        found[name] = m.where(below, value, m.max(value, 0.0))
        passed = below if passed is None else m.either(passed, below)
    for number, pair in moved.weights.items():
        pressing = equations.contacts[number].pressing
        if pressing is not None and pressing.is_round:
            found |= dict(zip((f"first {number}", f"second {number}"), pair, strict=True))
    return found, passed


def _guard_of_press(number: int, terms: Terms, moved: Motion) -> tuple[Number, Number]:
    """Whether what presses a slider that slips is still the same."""
    m, joint = EXPRESSIONS, moved.joints[number]
    reaction = moved.reactions[number]
    slips = m.less(0.5, m.abs(joint.mode.sense))
    size: Number = 0.0
    for one in terms.openings[number][:1]:
        size = one.size(m, moved.accelerations, moved.forces)
    # what sticks is held by any of them
    return m.where(slips, mode_margin(m, joint, reaction), 1.0), PRESS_ROUNDING * size


def _guard_of_contact(
    equations: EquationsOfMotion, guard: Guard, terms: Terms, system: MassSystem, moved: Motion
) -> tuple[Number, Number]:
    """Gap or force of a stop, relative speed or spare force of friction; and what of it is rounding."""
    m = EXPRESSIONS
    contact, mode = equations.contacts[guard.number], terms.modes[guard.number]
    one = moved.measures[guard.number]
    unit = 1.0 if is_angular(contact.coordinate) else _length_unit(equations)
    force: Number = 0.0
    weak: Number = 0.0
    row = {number: row for row, number in equations.contact_rows}.get(guard.number)
    if row is not None:
        force = moved.forces.get(row, 0.0)
        # what the inertia along the row would ask for at accelerations of rounding
        size = system.diagonal[row]
        weak = ROUNDING * unit * variable(RATE) ** 2 / m.where(m.less(0.0, size), size, 1.0)
    if guard.kind == FRICTION:
        slips = mode.sense * (one.speed - contact.drift)
        most = m.max(one.forwards, one.backwards)
        least = m.min(one.forwards, one.backwards)
        if contact.pressing is not None:
            reaction = moved.reactions[guard.number]
            most = m.max(greatest_press(m, contact, reaction, -1.0), most)
            least = m.min(-greatest_press(m, contact, reaction, 1.0), least)
        elif contact.static is not None:
            most, least = m.max(contact.static, most), m.min(-contact.static, least)
        sticks = m.less(0.5, mode.active)
        # what holds acts against its row
        value = m.where(sticks, m.min(most + force, -force - least), slips)
        return value, m.where(sticks, weak, ROUNDING * unit * variable(RATE))
    bound = contact.least if guard.bound < 0.0 else contact.most
    gap = guard.bound * (bound - one.value)
    here = m.less(0.5, guard.bound * mode.active)
    there = m.less(0.5, -guard.bound * mode.active)
    if contact.has_row:
        value = m.where(here, guard.bound * force, m.where(there, unit, gap))
        return value, m.where(here, weak, LEAST_GAP * unit)
    return m.where(here, -gap, m.where(there, unit, gap)), LEAST_GAP * unit


def _length_unit(equations: EquationsOfMotion) -> Number:
    """The greatest length [m]; on the sphere lengths are arcs, and the radius makes metres of them."""
    unit = length_unit(equations.tree.mechanism)
    return variable(LENGTH) if unit == 1.0 else variable(LENGTH) * unit


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
        reach: Number = unit * FLOOR * variable(RATE) + m.max(
            m.abs(variable(BEFORE + speed)), m.abs(variable(speed))
        )
        for one, scale in ((name, unit), (speed, reach)):
            parts = [variable(prefix + one) for prefix in (OF_FIFTH, OF_THIRD)]
            if not isinstance(scale, float):
                inverse = 1.0 / scale
                parts = [part * inverse for part in parts]
            fifth, third = fifth + parts[0] * parts[0], third + parts[1] * parts[1]
    for name in names.states:
        # a state has no unit to be compared with: its own size, or one
        greatest = m.max(m.max(m.abs(variable(BEFORE + name)), m.abs(variable(name))), 1.0)
        parts = [variable(prefix + name) / greatest for prefix in (OF_FIFTH, OF_THIRD)]
        fifth, third = fifth + parts[0] * parts[0], third + parts[1] * parts[1]
    together = fifth + 0.01 * third
    count = 2 * equations.size + len(names.states)
    size = m.abs(variable(STEP)) * fifth / m.sqrt(together * float(count))
    # nothing erred, or something has no value
    return m.where(m.less(0.0, together), size, together) / (SHARE * variable(TOLERANCE))
