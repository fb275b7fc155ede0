"""Equations of motion in joint coordinates: M a = F - G' lambda with G a + b = 0, over any algebra.

M is the sum over masses of the products of their Jacobian's columns, F the loads along theirs less what the motion
itself asks for, G and b come from the closures: all are jets of the one list of constraints and of the coordinates
that loads work along. The accelerations follow by a Schur complement (J. Wittenburg, Dynamics of Multibody Systems,
2nd ed., 2008, chapter 5; E. Hairer and G. Wanner, Solving Ordinary Differential Equations II, 2nd ed., 1996,
section VII.1 for the index-1 form):

    S = G M^-1 G',   S lambda = G M^-1 F + b,   a = M^-1 (F - G' lambda)

No coordinate is chosen to drive the others, so a limit position is an ordinary place. Where M itself has no inverse
because links are without mass, M + G' W G and F - G' W b take the places of M and F: on the constraints that changes
nothing but lambda, by W times what G a + b is.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, TypeAlias

from centrode.dynamics.forward_dynamics.contacts import (
    FRICTION,
    Condition,
    Contact,
    ContactMode,
    pressed_numbers,
    row_numbers,
)
from centrode.dynamics.forward_dynamics.controllers import Control, outputs_of, states_of
from centrode.dynamics.forward_dynamics.elimination import (
    Elimination,
    Entries,
    Vector,
    add_term,
    is_zero,
    times,
)
from centrode.dynamics.forward_dynamics.joint_openings import (
    JointOpening,
    OpenedState,
    Opening,
    closure_rows,
    host_positions,
    opened_positions,
    step_of,
    tooth_slope,
)
from centrode.dynamics.forward_dynamics.joint_state import JointState
from centrode.dynamics.forward_dynamics.reaction_friction import (
    Pair,
    PressedJoint,
    friction_forces,
    pressing_force,
)
from centrode.dynamics.forward_dynamics.spanning_tree import (
    JointValues,
    SpanningTree,
    jets_along,
    rotor_jets,
)
from centrode.dynamics.kinetostatics.equations import Teeth
from centrode.dynamics.load_coordinates import Coordinate, Spin, bodies_of, is_periodic
from centrode.dynamics.loads import LoadTerm, Situation
from centrode.dynamics.masses import coordinates_of
from centrode.dynamics.state import Mass, State
from centrode.kinematics.path import DrivenBy
from centrode.laws import Law
from centrode.model.mechanism import Drive
from centrode.numerics.jets import Jet, JetFunctions
from centrode.structure.constraints import Constraint, Entity, GearRatio, Positions
from centrode.structure.dimensions import Dimensions

Number: TypeAlias = Any
Namespace: TypeAlias = Any
Flags: TypeAlias = Mapping[int, Number]
"""Equation -> condition under which it counts."""

_NO_LAYOUT: Any = None
_NO_VALUE = float("nan")
DEPENDENT = 1e-5
"""An equation that others imply is left out where its pivot is below this share of its diagonal."""
IMPLIED = 1e-10
"""The same of a contact: what the closures hardly move must be held all the same, lest it creep."""


@dataclass(frozen=True)
class LoadAlong:
    """An effort with the name of the load that it belongs to."""

    label: str
    term: LoadTerm


@dataclass(frozen=True)
class KeptDrive:
    """A drive that keeps its law: the constraint, and its value as a function of time."""

    constraint: Constraint
    driven: DrivenBy

    @property
    def name(self) -> str:
        """Id of the drive."""
        return self.driven.drive.id

    @property
    def law(self) -> Law:
        return self.driven.law


@dataclass(frozen=True)
class DriveShaft:
    """Rotating masses or a flywheel that move as a drive does.

    Attributes
    ----------
    drive : what it turns or moves with
    coordinate : what the drive moves
    inertia : reduced to the drive [kg m^2 or kg]
    """

    drive: Drive
    coordinate: Coordinate
    inertia: Number


@dataclass(frozen=True)
class ContactMeasure:
    """The coordinate of a contact [rad or m], its speed, and the force of its mode along it [N or N m].

    `forwards` and `backwards` are the forces that it would have if it slipped.
    """

    value: Number
    speed: Number
    strength: Number
    forwards: Number = 0.0
    backwards: Number = 0.0


@dataclass(frozen=True)
class Terms:
    """The equations at values of the coordinates and their speeds.

    Attributes
    ----------
    mass : M, below and on its diagonal
    force : F
    rows : G, row by row
    values, speeds, bias : of every closure equation its value, its derivative by time and b
    powers : of every load [W]
    rates : of the value of every kept drive by time
    measures : of every contact its coordinate, its speed and the force of its mode along it
    conditions : of every user's event what passes zero
    outputs, output_powers, state_rates : of controllers
    modes : of every contact
    openings : number of a contact with friction by a coefficient -> those of its joint

    Rows, values, speeds and bias of contacts follow those of the closures, where modes are given.
    """

    size: int
    mass: Entries
    force: Vector
    rows: Sequence[Vector]
    values: Sequence[Number]
    speeds: Sequence[Number]
    bias: Sequence[Number]
    powers: Sequence[Number]
    rates: Sequence[Number]
    at: Positions
    measures: Sequence[ContactMeasure] = ()
    conditions: Sequence[Number] = ()
    outputs: Sequence[Number] = ()
    output_powers: Sequence[Number] = ()
    state_rates: Sequence[Number] = ()
    modes: Sequence[ContactMode] = ()
    openings: Mapping[int, Sequence[Opening]] = field(default_factory=dict)

    def without_contacts(self, equations: int) -> Terms:
        """The terms with the rows of the closures alone."""
        return replace(
            self,
            rows=self.rows[:equations],
            values=self.values[:equations],
            speeds=self.speeds[:equations],
            bias=self.bias[:equations],
        )


@dataclass
class _HeldRows:
    """What the motion has to hold, equation by equation: rows of G, values, speeds and bias (see `Terms`)."""

    rows: list[Vector]
    values: list[Number]
    speeds: list[Number]
    bias: list[Number]

    def add(self, row: Vector, value: Number, speed: Number, bias: Number) -> None:
        """One more equation."""
        self.rows.append(row)
        self.values.append(value)
        self.speeds.append(speed)
        self.bias.append(bias)


@dataclass(frozen=True)
class Motion:
    """Accelerations with the forces that belong to them.

    Attributes
    ----------
    accelerations, forces : by coordinates and by equations
    measures : of contacts, friction by coefficients included
    joints : number of a contact with such friction -> its joint
    reactions : number of such a contact -> reaction of its joint [N or N m]
    weights : number of such a contact -> weights of what presses
    unsettled : what is left of Newton's method for them [rad^2]
    """

    accelerations: Vector
    forces: Vector
    measures: Sequence[ContactMeasure]
    joints: Mapping[int, PressedJoint] = field(default_factory=dict)
    reactions: Mapping[int, tuple[Number, ...]] = field(default_factory=dict)
    weights: Mapping[int, Pair] = field(default_factory=dict)
    unsettled: Number = 0.0


@dataclass(frozen=True)
class EquationsOfMotion:
    """What moves a mechanism, with its numbers over any algebra.

    Attributes
    ----------
    tree : SpanningTree
    numbers : dimensions, with the constants of gears and rolling contacts
    masses : of links
    loads : efforts in the order of loads
    kept : drives that keep their laws
    shafts : masses that turn with drives
    weights : of equations where links have no mass: W; empty where M has an inverse
    dependent : equations of which some are implied by others everywhere
    references : of every equation the size that its diagonal in S has elsewhere; S itself where they are left out
    contacts : stops, clamps and dry friction
    conditions : user's events
    controls : controllers
    """

    tree: SpanningTree
    numbers: Dimensions
    masses: tuple[Mass, ...]
    loads: tuple[LoadAlong, ...]
    kept: tuple[KeptDrive, ...] = ()
    shafts: tuple[DriveShaft, ...] = ()
    weights: tuple[Number, ...] = ()
    dependent: frozenset[int] = frozenset()
    references: tuple[Number, ...] = ()
    contacts: tuple[Contact, ...] = ()
    conditions: tuple[Condition, ...] = ()
    controls: tuple[Control, ...] = ()

    @property
    def has_events(self) -> bool:
        """Whether something is watched: contacts or conditions."""
        return bool(self.contacts or self.conditions)

    @property
    def contact_rows(self) -> tuple[tuple[int, int], ...]:
        """(row, number of the contact) of the contacts that have a row, behind the closures."""
        return tuple(enumerate(row_numbers(self.contacts), self.equations))

    @property
    def flagged_rows(self) -> tuple[int, ...]:
        """Rows that may be left out: closures that others imply, and those of contacts."""
        return (*sorted(self.dependent), *(row for row, _number in self.contact_rows))

    @property
    def size(self) -> int:
        """Number of coordinates."""
        return len(self.tree.coordinates)

    @property
    def constraints(self) -> tuple[Constraint, ...]:
        """Closures, then the drives that keep their laws."""
        return (*self.tree.closures, *(kept.constraint for kept in self.kept))

    @property
    def equations(self) -> int:
        """Number of closure equations."""
        return sum(constraint.size for constraint in self.constraints)

    @cached_property
    def _centres(self) -> tuple[tuple[Mass, frozenset[int]], ...]:
        depends = self.tree.depends
        return tuple((mass, depends.get(Entity("link", mass.link), frozenset())) for mass in self.masses)

    def terms(
        self,
        m: Namespace,
        values: JointValues,
        speeds: Sequence[Number],
        time: Number,
        modes: Sequence[ContactMode] | None = None,
        states: Sequence[Number] | None = None,
    ) -> Terms:
        """The equations at one state; with `modes` the contacts have their rows and forces too.

        `states` are those of controllers, that of the start if left out.
        """
        jets = JetFunctions(m)
        laws = {kept.name: _law_jet(jets, kept, time) for kept in self.kept}
        plain = self.tree.positions(m, self.numbers, values, {k: law.value for k, law in laws.items()})
        moving = jets_along(self.tree, values, speeds, 2)
        in_time = self.tree.positions(jets, self.numbers, moving, laws)
        state = self._state(jets, in_time, time, 2)
        columns = [self._column(jets, values, plain, k, time) for k in range(self.size)]
        mass, force = self._inertia(state, columns)
        strengths = [load.term.strength(state) for load in self.loads]
        powers = self._add_loads(state, columns, force, strengths)
        outputs, output_powers, state_rates = self._add_controls(m, state, columns, force, states)
        held = self._closures(jets, in_time, columns)
        measures = self._add_contacts(m, state, columns, modes or (), held, force)
        acting = [(load.term.coordinate, x) for load, x in zip(self.loads, strengths, strict=True)]
        acting += [
            (control.drives, output)
            for control, output in zip(self.controls, outputs, strict=True)
            if control.drives is not None
        ]
        openings = {
            number: [
                self._opening(jets, values, plain, state, one, columns, acting, measures) for one in ways
            ]
            for number, ways in (self._joint_openings.items() if modes is not None else ())
        }
        return Terms(
            self.size,
            mass,
            force,
            held.rows,
            held.values,
            held.speeds,
            held.bias,
            powers,
            [law.coefficients[1] for law in laws.values()],
            plain,
            measures,
            [] if modes is None else [self._condition(one, state, time) for one in self.conditions],
            outputs,
            output_powers,
            state_rates,
            modes or (),
            openings,
        )

    def _add_contacts(
        self,
        m: Namespace,
        state: JointState,
        columns: Sequence[JointState],
        modes: Sequence[ContactMode],
        held: _HeldRows,
        force: Vector,
    ) -> list[ContactMeasure]:
        """What contacts measure in their modes; forces of these join the others, and rows those of the closures."""
        measures: list[ContactMeasure] = []
        for contact, mode in zip(self.contacts, modes, strict=False):
            slope = contact.coordinate.slope(state)
            own = self._measure(m, contact, mode, state, _value_of(contact, state), slope.value)
            measures.append(own)
            row: Vector = {}
            for k in self._reach(contact.coordinate):
                add_term(row, k, contact.coordinate.slope(columns[k]).value)
            for k, x in row.items():
                add_term(force, k, times(x, own.strength))
            if contact.has_row:
                gap = _gap(m, contact, own.value - mode.held - times(contact.drift, state.time))
                held.add(row, gap, own.speed - contact.drift, slope.derivative(1))
        return measures

    @cached_property
    def _joint_openings(self) -> dict[int, tuple[JointOpening, ...]]:
        """Number of a contact with friction by a coefficient -> ways in which its joint is opened."""
        pressed = [(k, self.contacts[k].pressing) for k in pressed_numbers(self.contacts)]
        return {k: pressing.openings for k, pressing in pressed if pressing is not None}

    def _opening(
        self,
        jets: JetFunctions,
        values: JointValues,
        plain: Positions,
        state: JointState,
        opening: JointOpening,
        columns: Sequence[JointState],
        acting: Sequence[tuple[Coordinate, Number]],
        measures: Sequence[ContactMeasure],
    ) -> Opening:
        """What an opening of a joint asks for: the row that it would have among the equations of motion."""
        number = step_of(self.tree, opening.constraint)
        if number is None:
            return Opening({}, 0.0, closure_rows(opening, self.constraints), {})
        at = opened_positions(self.tree, jets, self.numbers, values, plain, opening, number)
        opened = self._opened_state(jets, at, state.time)
        mass, force = self._opened_inertia(state, opened, columns)
        for coordinate, strength in acting:
            force = _plus(force, times(strength, coordinate.slope(opened).value))
        rows: Vector = {}
        for constraint in self.constraints:
            hosted = host_positions(self.tree.mechanism, self.numbers, at, constraint)
            first = sum(one.size for one in self.constraints[: self.constraints.index(constraint)])
            if isinstance(constraint, GearRatio) and constraint.gear in self._teeth.axes:
                add_term(rows, first, tooth_slope(self._teeth, self.numbers, plain, at, constraint))
                continue
            for k, x in enumerate(constraint.residual(jets, self.numbers, hosted)):
                add_term(rows, first + k, x.coefficients[1] if isinstance(x, Jet) else 0.0)
        along: Vector = {}
        behind = {contact: row for row, contact in self.contact_rows}
        for k, (contact, one) in enumerate(zip(self.contacts, measures, strict=True)):
            slope = contact.coordinate.slope(opened).value
            add_term(along, k, slope)
            force = _plus(force, times(slope, one.strength))
            if k in behind:
                add_term(rows, behind[k], slope)
        return Opening(mass, force, rows, along)

    @cached_property
    def _teeth(self) -> Teeth:
        return Teeth.of(self.tree.mechanism)

    def _opened_inertia(
        self, state: JointState, opened: JointState, columns: Sequence[JointState]
    ) -> tuple[Vector, Number]:
        """Masses along an opening by coordinates, and the force of the inertia that the motion itself asks for."""
        mass: Vector = {}
        force: Number = 0.0
        parts = [
            (coordinates_of(state, body), coordinates_of(opened, body), body, depends)
            for body, depends in self._centres
        ]
        for along, across, body, depends in parts:
            slopes = {k: coordinates_of(columns[k], body) for k in depends}
            for number, (factor, jet) in enumerate(along):
                own = across[number][1].coefficients[1]
                force = _plus(force, -times(factor, times(own, times(2.0, jet.coefficients[2]))))
                for k in sorted(slopes):
                    add_term(mass, k, times(factor, times(own, slopes[k][number][1].coefficients[1])))
        for shaft in self.shafts:
            own = opened.drive(shaft.drive).coefficients[1]
            bias = times(2.0, state.drive(shaft.drive).coefficients[2])
            force = _plus(force, -times(shaft.inertia, times(own, bias)))
            for k in self._reach(shaft.coordinate):
                slope = columns[k].drive(shaft.drive).coefficients[1]
                add_term(mass, k, times(shaft.inertia, times(own, slope)))
        return mass, force

    def _opened_state(self, jets: JetFunctions, at: Positions, time: Number) -> OpenedState:
        return OpenedState(
            self.tree.mechanism, _NO_LAYOUT, time, _NO_VALUE, 1.0, 0, 0.0, {}, jets,  # type: ignore[arg-type]
            order=1, at=at, numbers=self.numbers, pivots=self.tree.pivots,
        )  # fmt: skip

    def _add_controls(
        self,
        m: Namespace,
        state: JointState,
        columns: Sequence[JointState],
        force: Vector,
        states: Sequence[Number] | None,
    ) -> tuple[list[Number], list[Number], list[Number]]:
        """Add the forces of controllers; their outputs, powers, and the rates of their states."""
        if not self.controls:
            return [], [], []
        measured = [
            (0.0, 0.0)
            if control.measures is None
            else (control.measures.value(state), control.measures.slope(state).value)
            for control in self.controls
        ]
        known = states_of(self.controls) if states is None else states
        outputs, rates = outputs_of(m, self.controls, state.time, measured, known)
        powers: list[Number] = []
        for control, output in zip(self.controls, outputs, strict=True):
            if control.drives is None:
                powers.append(0.0)
                continue
            for k in self._reach(control.drives):
                add_term(force, k, times(control.drives.slope(columns[k]).value, output))
            powers.append(times(output, control.drives.slope(state).value))
        return outputs, powers, rates

    def _measure(
        self,
        m: Namespace,
        contact: Contact,
        mode: ContactMode,
        state: JointState,
        x: Number,
        v: Number,
    ) -> ContactMeasure:
        """A contact with the force of its mode: friction that slips, or the push of a compliant stop."""
        if contact.pressing is not None:
            # how great it is follows from the reaction of its joint
            return ContactMeasure(x, v, 0.0)
        if contact.kind == FRICTION:
            now = Situation(state.time, state.parameter, x, v - contact.drift, mode.sense, m)
            forwards, backwards = contact.forces(now)
            if contact.backwards is None:
                strength = times(mode.sense, forwards)
            else:
                strength = m.where(m.less(0.0, mode.sense), forwards, backwards)
                strength = m.where(m.less(0.0, m.abs(mode.sense)), strength, 0.0)
            return ContactMeasure(x, v, strength, forwards, backwards)
        if contact.has_row or is_zero(mode.active):
            return ContactMeasure(x, v, 0.0)
        bounds = [bound for bound in (contact.most, contact.least) if bound is not None]
        bound = bounds[0] if len(bounds) == 1 else m.where(m.less(0.0, mode.active), *bounds)
        # it pushes away from the bound and never pulls
        push = m.max(mode.active * (contact.stiffness * (x - bound) + contact.damping * v), 0.0)
        return ContactMeasure(x, v, -(mode.active * push))

    def _condition(self, condition: Condition, state: JointState, time: Number) -> Number:
        x: Number = 0.0
        v: Number = 0.0
        if condition.coordinate is not None:
            x, v = condition.coordinate.value(state), condition.coordinate.slope(state).value
        given = {"t": time, "x": x, "v": v}
        return condition.formula(state.m.base, **{name: given[name] for name in given})

    def _state(self, jets: JetFunctions, at: Positions, time: Number, order: int) -> JointState:
        mechanism = self.tree.mechanism
        # samples have a layout of columns; here positions take their place
        state = JointState(
            mechanism, _NO_LAYOUT, time, _NO_VALUE, 1.0, 0, 0.0, {}, jets,  # type: ignore[arg-type]
            order=order, at=at, numbers=self.numbers, pivots=self.tree.pivots,
        )  # fmt: skip
        if len(mechanism.drives) == 1 and self.loads_use_drive:
            value = state.drive(mechanism.drives[0]).value
            object.__setattr__(state, "parameter", value)
        return state

    @cached_property
    def loads_use_drive(self) -> bool:
        """Whether a load depends on the value of the one drive."""
        laws = [contact.kinetic for contact in self.contacts if contact.kinetic is not None]
        return any("q" in law.uses for law in [*(load.term.amount for load in self.loads), *laws])

    def _column(
        self, jets: JetFunctions, values: JointValues, plain: Positions, number: int, time: Number
    ) -> JointState:
        """The state that changes along one coordinate."""
        unit = Jet((values.coordinates[number], 1.0))
        coordinates = list(values.coordinates)
        coordinates[number] = unit
        rotors = dict(values.rotors)
        if number in rotors:
            rotors[number] = rotor_jets(rotors[number], unit)
        at = self.tree.positions_along(jets, self.numbers, JointValues(coordinates, rotors), plain, number)
        return self._state(jets, at, time, 1)

    def _inertia(self, state: JointState, columns: Sequence[JointState]) -> tuple[Entries, Vector]:
        mass: Entries = {}
        force: Vector = {}
        parts: list[tuple[Sequence[tuple[Number, Jet]], dict[int, Sequence[tuple[Number, Jet]]]]] = [
            (coordinates_of(state, body), {k: coordinates_of(columns[k], body) for k in depends})
            for body, depends in self._centres
        ]
        parts += [
            (
                [(shaft.inertia, state.drive(shaft.drive))],
                {k: [(shaft.inertia, columns[k].drive(shaft.drive))] for k in self._reach(shaft.coordinate)},
            )
            for shaft in self.shafts
        ]
        for along, slopes in parts:
            for number, (factor, jet) in enumerate(along):
                bias = times(2.0, jet.coefficients[2])
                share = {k: slopes[k][number][1].coefficients[1] for k in sorted(slopes)}
                for i, a in share.items():
                    add_term(force, i, -times(factor, times(a, bias)))
                    for j, b in share.items():
                        if j <= i:
                            add_term(mass, (i, j), times(factor, times(a, b)))
        return mass, force

    def _add_loads(
        self,
        state: JointState,
        columns: Sequence[JointState],
        force: Vector,
        strengths: Sequence[Number],
    ) -> list[Number]:
        powers = []
        for load, strength in zip(self.loads, strengths, strict=True):
            coordinate = load.term.coordinate
            for k in self._reach(coordinate):
                add_term(force, k, times(coordinate.slope(columns[k]).value, strength))
            powers.append(times(strength, coordinate.slope(state).value))
        return powers

    def _reach(self, coordinate: Coordinate) -> list[int]:
        """Numbers of the joint coordinates that what a load works along may depend on."""
        bodies = bodies_of(self.tree.mechanism, coordinate)
        depends = (self.tree.depends.get(body, frozenset()) for body in bodies)
        return sorted(frozenset[int]().union(*depends))

    def _closures(self, jets: JetFunctions, in_time: Positions, columns: Sequence[JointState]) -> _HeldRows:
        rows: list[Vector] = []
        residuals: list[Jet] = []
        for constraint in self.constraints:
            own = constraint.residual(jets, self.numbers, in_time)
            residuals += [_jet(x, 2) for x in own]
            first = len(rows)
            rows += [{} for _equation in own]
            for k in sorted(self.tree.dependence(constraint)):
                for number, x in enumerate(constraint.residual(jets, self.numbers, columns[k].at)):
                    slope = x.coefficients[1] if isinstance(x, Jet) else 0.0
                    add_term(rows[first + number], k, slope)
        return _HeldRows(
            rows,
            [jet.coefficients[0] for jet in residuals],
            [jet.coefficients[1] for jet in residuals],
            [times(2.0, jet.coefficients[2]) for jet in residuals],
        )

    # what follows from the terms

    def system(
        self, m: Namespace, terms: Terms, flags: Flags | None = None, active: Flags | None = None
    ) -> MassSystem:
        """The eliminations of M and S at one state.

        Parameters
        ----------
        flags : which of the equations that may be left out count; else it is decided by their pivots
        active : rows of contacts -> whether they are to count, as far as others do not imply them
        """
        mass, force = dict(terms.mass), dict(terms.force)
        for row, weight, bias in zip(terms.rows, self.weights, terms.bias, strict=False):
            for i, a in row.items():
                add_term(force, i, -times(weight, times(a, bias)))
                for j, b in row.items():
                    if j <= i:
                        add_term(mass, (i, j), times(weight, times(a, b)))
        of_mass = Elimination.of(self.size, mass)
        solved = [of_mass.forward(row) for row in terms.rows]
        schur: Entries = {}
        for i, one in enumerate(solved):
            for j in range(i + 1):
                add_term(schur, (i, j), of_mass.product(one, solved[j]))
        chosen: dict[int, Number] = {}
        own = [schur.get((i, i), 0.0) for i in range(len(solved))]
        behind = range(self.equations, len(solved))
        diagonal = [*(self.references or own[: self.equations]), *(own[i] for i in behind)]

        def reciprocal(row: int, pivot: Number) -> Number:
            if is_zero(pivot):
                # an equation that holds by itself
                return 0.0
            if row not in self.dependent and row not in behind:
                return 1.0 / pivot
            if flags is None:
                least = IMPLIED if row in behind else DEPENDENT
                chosen[row] = m.less(least * diagonal[row], pivot)
                if row in behind:
                    chosen[row] = m.both((active or {})[row], chosen[row])
            else:
                chosen[row] = flags[row]
            # what is left out is divided by one: no infinity comes near
            return m.where(chosen[row], 1.0 / m.where(chosen[row], pivot, 1.0), 0.0)

        of_closures = Elimination.of(len(terms.rows), schur, reciprocal, behind)
        return MassSystem(of_mass, of_closures, solved, force, diagonal, chosen, self.equations)

    def accelerations(
        self, m: Namespace, terms: Terms, flags: Flags | None = None, active: Flags | None = None
    ) -> tuple[list[Number], list[Number], Flags]:
        """Accelerations, the forces of the closures (as they act along their rows), and which equations counted."""
        system = self.system(m, terms, flags, active)
        found = self.motion(m, terms, system)
        a = [found.accelerations.get(k, 0.0) for k in range(self.size)]
        return a, [found.forces.get(i, 0.0) for i in range(len(terms.rows))], system.flags

    def motion(self, m: Namespace, terms: Terms, system: MassSystem) -> Motion:
        """Accelerations and forces, with friction as great as the reactions make it."""
        solution, forces = system.solve(system.force, terms.bias)
        if not terms.openings:
            return Motion(solution, forces, terms.measures)
        rows = {number: terms.rows[row] for row, number in self.contact_rows if row < len(terms.rows)}
        still = [0.0] * len(terms.rows)
        responses = {k: system.solve(rows[k], still) for k in terms.openings}
        joints = {
            k: PressedJoint(
                self.contacts[k],
                terms.modes[k],
                tuple(one.reaction(solution, forces) for one in ways),
                {i: tuple(one.response(i, *response) for one in ways) for i, response in responses.items()},
            )
            for k, ways in terms.openings.items()
        }
        sizes, reactions, weights, unsettled = friction_forces(m, joints)
        solution, forces, measures = dict(solution), dict(forces), list(terms.measures)
        for k, size in sizes.items():
            moved, borne = responses[k]
            for i, x in moved.items():
                add_term(solution, i, times(x, size))
            for i, x in borne.items():
                add_term(forces, i, times(x, size))
            contact = self.contacts[k]
            assert contact.pressing is not None
            kinetic = contact.pressing.kinetic
            presses = [
                kinetic * pressing_force(m, contact, *contact.pressing.parts(reactions[k], sense, kinetic))
                for sense in (1.0, -1.0)
            ]
            measures[k] = replace(measures[k], strength=size, forwards=-presses[0], backwards=presses[1])
        return Motion(solution, forces, measures, joints, reactions, weights, unsettled)

    def shift_to_close(self, terms: Terms, system: MassSystem) -> Vector:
        """Change of the coordinates by one step of Newton's method of least change in the measure of M."""
        return system.solve({}, terms.values)[0]

    def consistent_speeds(
        self,
        m: Namespace,
        values: JointValues,
        speeds: Sequence[Number],
        time: Number,
        system: MassSystem,
        with_contacts: bool = False,
    ) -> list[Number]:
        """Speeds that keep the closures at closed coordinates, changed least in the measure of M."""
        jets = JetFunctions(m)
        laws = {kept.name: _law_jet(jets, kept, time, 1) for kept in self.kept}
        moving = jets_along(self.tree, values, speeds, 1)
        at = self.tree.positions(jets, self.numbers, moving, laws)
        residuals = [
            x for constraint in self.constraints for x in constraint.residual(jets, self.numbers, at)
        ]
        errors = [x.coefficients[1] if isinstance(x, Jet) else 0.0 for x in residuals]
        if with_contacts:
            state = self._state(jets, at, time, 1)
            for _row, number in self.contact_rows:
                contact = self.contacts[number]
                errors.append(contact.coordinate.slope(state).value - contact.drift)
        # the elimination is that of the place before: what is left is of the second order
        change, _impulses = system.solve({}, errors)
        return [_plus(x, change.get(k, 0.0)) for k, x in enumerate(speeds)]

    def energies(
        self, m: Namespace, values: JointValues, speeds: Sequence[Number], time: Number
    ) -> tuple[Number, Number]:
        """Kinetic and potential energy [J]."""
        jets = JetFunctions(m)
        laws = {kept.name: _law_jet(jets, kept, time) for kept in self.kept}
        at = self.tree.positions(jets, self.numbers, jets_along(self.tree, values, speeds, 2), laws)
        state = self._state(jets, at, time, 2)
        return self.kinetic_energy(state), self.potential_energy(state)

    def kinetic_energy(self, state: JointState) -> Number:
        """Kinetic energy of a state along time [J]."""
        total: Number = 0.0
        parts = [part for mass in self.masses for part in coordinates_of(state, mass)]
        for factor, jet in [*parts, *((shaft.inertia, state.drive(shaft.drive)) for shaft in self.shafts)]:
            speed = jet.coefficients[1]
            total = total + times(0.5 * factor, times(speed, speed))
        return total

    def potential_energy(self, state: State) -> Number:
        """Potential energy of weights and springs [J]."""
        total: Number = 0.0
        for load in self.loads:
            energy = getattr(load.term.amount, "energy", None)
            if energy is not None:
                total = total + energy(load.term.coordinate.value(state))
        return total

    def state(self, m: Namespace, values: JointValues, rates: Sequence[Jet], time: Number) -> JointState:
        """The state along time where coordinates are jets with all derivatives that are known."""
        jets = JetFunctions(m)
        laws = {kept.name: _law_jet(jets, kept, time) for kept in self.kept}
        moving = JointValues(
            list(rates), {k: _rotor_of_jet(jets, values.rotors[k], rates[k]) for k in self.tree.angles}
        )
        return self._state(jets, self.tree.positions(jets, self.numbers, moving, laws), time, 2)


def _value_of(contact: Contact, state: JointState) -> Number:
    """The coordinate of a contact; zero of a turning that has no value, of which the speed alone is held."""
    if isinstance(contact.coordinate, Spin) and contact.coordinate.joint is None:
        return 0.0
    return contact.coordinate.value(state)


def _gap(m: Namespace, contact: Contact, apart: Number) -> Number:
    """By how much a contact is off the value that is held."""
    if is_periodic(contact.coordinate):
        return m.atan2(m.sin(apart), m.cos(apart))
    return apart


def _plus(x: Number, change: Number) -> Number:
    return x if is_zero(change) else x + change


def _rotor_of_jet(jets: JetFunctions, rotor: tuple[Number, Number], angle: Jet) -> tuple[Jet, Jet]:
    cosine, sine = rotor
    _value, rate, half = angle.coefficients
    square = 0.5 * (rate * rate)
    return (
        Jet((cosine, -(rate * sine), -(half * sine) - square * cosine)),
        Jet((sine, rate * cosine, half * cosine - square * sine)),
    )


def _jet(x: Number, order: int) -> Jet:
    return x if isinstance(x, Jet) else Jet((x, *([0.0] * order)))


def _law_jet(jets: JetFunctions, kept: KeptDrive, time: Number, order: int = 2) -> Jet:
    law = kept.driven.value(jets, Jet((time, 1.0, 0.0)[: order + 1]))
    return _jet(law, order)


@dataclass(frozen=True)
class MassSystem:
    """M and S = G M^-1 G' eliminated, with the rows of G solved forwards.

    `flags` are the conditions under which dependent equations count; rows from `equations` on are those of contacts.
    """

    mass: Elimination
    closures: Elimination
    rows: Sequence[Vector]
    force: Vector
    diagonal: Sequence[Number]
    flags: Mapping[int, Number] = field(default_factory=dict)
    equations: int = 0

    def independence(self, m: Namespace) -> Number:
        """The least root of a pivot over its usual size: zero where closures lose rank, as a distance is."""
        least: Number = 1.0
        for row, pivot in self.closures.pivots.items():
            if is_zero(pivot) or row >= self.equations:
                # a contact that is closed where others hold it already is no change point
                continue
            share = pivot / self.diagonal[row]
            if row in self.flags:
                share = m.where(self.flags[row], share, 1.0)
            least = m.min(least, share)
        return least if isinstance(least, float) else m.sqrt(m.max(least, 0.0))

    def solve(self, force: Mapping[int, Number], bias: Sequence[Number]) -> tuple[Vector, Vector]:
        """Solution x and l of M x + G' l = force with G x = -bias."""
        forward = self.mass.forward(force)
        right: Vector = {}
        for i, row in enumerate(self.rows):
            add_term(right, i, bias[i])
            add_term(right, i, self.mass.product(row, forward))
        forces = self.closures.solve(right)
        for i, size in forces.items():
            for k, x in self.rows[i].items():
                add_term(forward, k, -times(x, size))
        return self.mass.backward(forward), forces
