"""The equations of motion and their exact derivatives by coordinates, speeds and numbers, at many states at once.

With M q'' = F(q, q') - G(q)' lambda and g(q) = 0, a small departure x from a state with constant speeds obeys

    M x'' + C x' + K x + G' y = 0,   G x = 0
    C = -dF/dq',   K = -d(F - G' lambda)/dq   (lambda held)

(P. C. Mueller and W. O. Schiehlen, Linear Vibrations, 1985, chapter 4.) All matrices are graphs: what moves a mechanism
is traced once and differentiated by the chain rule, so nothing is taken by differences.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.equilibria.controllers_at_rest import controls_at_rest
from centrode.dynamics.forward_dynamics.contacts import FREE, Contact, StopPush, stop_coordinate
from centrode.dynamics.forward_dynamics.controllers import states_of
from centrode.dynamics.forward_dynamics.equations_of_motion import EquationsOfMotion, KeptDrive, LoadAlong
from centrode.dynamics.forward_dynamics.free_loads import (
    coordinate_of_drive,
    dry_frictions_of,
    free_loads_of,
    has_sense,
    is_dry,
    shafts_of,
)
from centrode.dynamics.forward_dynamics.initial_position import (
    InitialPosition,
    equation_units,
    position_of_description,
    units_of,
)
from centrode.dynamics.forward_dynamics.initial_state import drive_values, initial_state
from centrode.dynamics.forward_dynamics.model_numbers import NumbersAsVariables
from centrode.dynamics.forward_dynamics.pressed_contacts import (
    pressed_contacts_of,
    refuse_undetermined_presses,
)
from centrode.dynamics.forward_dynamics.spanning_tree import JointCoordinate, spanning_tree_of
from centrode.dynamics.kinetostatics.friction import without_friction
from centrode.dynamics.loads import AppliedLoad, Constant, Friction, LoadTerm, MassesAndLoads, Situation
from centrode.dynamics.simulation.multibody_motion import driving_efforts
from centrode.errors import InputError, NotComputedYet
from centrode.kinematics.path import DrivenBy
from centrode.laws import Uniform
from centrode.locale import _
from centrode.model.mechanism import Mechanism
from centrode.model.reading import nearest
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.expressions import EXPRESSIONS, Node, as_node, variable
from centrode.numerics.graphs import Graph, directional_derivatives
from centrode.numerics.jets import Jet
from centrode.numerics.scans import evaluate
from centrode.structure.constraints import AngleDrive, DisplacementDrive, DistanceDrive, constraints_of

Array: TypeAlias = npt.NDArray[np.float64]
Number: TypeAlias = Any

TIME = "time"
CLOSED, OPEN = 1e-15, 1e-10
"""Positions are closed to this share of the lengths at best; what stays open by more than the second is none."""
CLOSING_STEPS = 25
RANK = 1e-9
"""A singular value of the closures below this share of the greatest counts as none."""


@dataclass(frozen=True)
class DryFriction:
    """Dry friction along a coordinate: up to this force it holds."""

    label: str
    term: LoadTerm


@dataclass(frozen=True)
class LinearEquations:
    """The equations at n states, for c coordinates and e closure equations; units are SI.

    Attributes
    ----------
    residual : (n, c) F - G' lambda, what is left to accelerate
    force : (n, c) F
    closures, rows : (n, e), (n, e, c) left sides of the closures, and G
    drift, bias : (n, e) derivatives of the left sides by time: the first, and of the second what speeds alone make
    mass, damping, stiffness : (n, c, c) M, C and K
    friction, along : (n, f), (n, f, c) greatest dry frictions, and the derivatives of what they act along
    output : (n, controllers) what controllers give

    Of a state of a controller force and residual are its rate, less how fast it changes.
    """

    residual: Array
    force: Array
    closures: Array
    rows: Array
    drift: Array
    bias: Array
    mass: Array
    damping: Array
    stiffness: Array
    friction: Array
    along: Array
    output: Array


@dataclass(frozen=True)
class LoadedMechanism:
    """A mechanism under its loads, ready to be held against them.

    Attributes
    ----------
    mechanism : the description
    equations : equations of motion with its numbers; drives that are held are kept in them
    position : coordinates of the initial position
    frictions : dry frictions, which the equations leave out
    """

    mechanism: Mechanism
    equations: EquationsOfMotion
    position: InitialPosition
    frictions: tuple[DryFriction, ...] = ()

    @property
    def coordinates(self) -> tuple[JointCoordinate, ...]:
        """Joint coordinates in order."""
        return self.equations.tree.coordinates

    @property
    def joints(self) -> int:
        """Number of joint coordinates."""
        return self.equations.size

    @cached_property
    def states(self) -> tuple[str, ...]:
        """Names of the states of controllers, which follow the joint coordinates."""
        return tuple(f"{one.label}: {name}" for one in self.equations.controls for name, _start in one.states)

    @property
    def size(self) -> int:
        """Number of coordinates, states of controllers among them."""
        return self.joints + len(self.states)

    @cached_property
    def start(self) -> Array:
        """Coordinates of the initial position, and states as they are then."""
        return np.append(self.position.coordinates, states_of(self.equations.controls))

    @cached_property
    def angles(self) -> npt.NDArray[np.bool_]:
        """Which coordinates are angles."""
        return np.array(
            [one.kind == "angle" for one in self.coordinates] + [False] * len(self.states), dtype=bool
        )

    @cached_property
    def units(self) -> Array:
        """What a change of each coordinate is compared with (coordinates): 1 rad, or the greatest length.

        States of controllers are compared with what changes their moments by as much as the loads are.
        """
        found = units_of(self.equations.tree, self.equations.numbers)
        if not self.states:
            return found
        here = self._evaluate(self.start[None], np.zeros((1, self.equations.equations)), None, None)
        moved = np.abs(here.stiffness[0, : self.joints, self.joints :] * found[:, None]).max(
            axis=0, initial=0.0
        )
        forces = np.abs(here.force[0, : self.joints] * found)
        bent = np.abs(here.stiffness[0, : self.joints, : self.joints] * np.outer(found, found))
        size = max(float(forces.max(initial=0.0)), float(bent.max(initial=0.0)))
        return np.append(
            found, np.where((moved > 0.0) & (size > 0.0), size / np.where(moved > 0.0, moved, 1.0), 1.0)
        )

    @cached_property
    def equation_units(self) -> Array:
        """What the left side of each closure is compared with (equations)."""
        return equation_units(self.equations.constraints, self.equations.numbers)

    @cached_property
    def traced_equations(self) -> NumbersAsVariables:
        """The equations with numbers as variables."""
        return NumbersAsVariables.of(self.equations)

    def numbers_of(self, equations: EquationsOfMotion) -> dict[str, float]:
        """Values of the variables that stand for numbers, in equations of the same structure."""
        values = self.traced_equations.values(equations)
        return dict(zip(self.traced_equations.parameters, values[:, 0].tolist(), strict=True))

    @cached_property
    def numbers(self) -> dict[str, float]:
        """Values of the variables that stand for numbers of this mechanism."""
        return self.numbers_of(self.equations)

    @cached_property
    def graph(self) -> Graph:
        """All of the linear equations, entry by entry; what is a plain zero is left out."""
        m, equations = EXPRESSIONS, self.traced_equations.equations
        every = [[variable(f"{name} {k}") for k in range(self.size)] for name in ("coordinate", "speed")]
        q, v = (one[: self.joints] for one in every)
        time = variable(TIME)
        values = equations.tree.values(m, q)
        terms = equations.terms(m, values, v, time, states=every[0][self.joints :])
        force = [as_node(terms.force.get(i, 0.0)) for i in range(self.joints)]
        # a state changes at its rate, so what is left of both is an equation like those of the forces
        force += [
            as_node(rate - own) for rate, own in zip(terms.state_rates, every[1][self.joints :], strict=True)
        ]
        residual: list[Any] = list(force)
        for k, row in enumerate(terms.rows):
            for i, x in row.items():
                residual[i] = residual[i] - x * variable(f"reaction {k}")
        left = [as_node(x) for x in residual]
        outputs: dict[str, Node] = {f"residual {i}": x for i, x in enumerate(left)}
        outputs |= {f"force {i}": x for i, x in enumerate(force)}
        outputs |= {f"closures {k}": as_node(x) for k, x in enumerate(terms.values)}
        outputs |= {f"drift {k}": as_node(x) for k, x in enumerate(terms.speeds)}
        outputs |= {f"bias {k}": as_node(x) for k, x in enumerate(terms.bias)}
        outputs |= {f"rows {k} {i}": as_node(x) for k, row in enumerate(terms.rows) for i, x in row.items()}
        for (i, j), x in terms.mass.items():
            outputs[f"mass {i} {j}"] = outputs[f"mass {j} {i}"] = as_node(x)
        outputs |= _matrix("stiffness", left, every[0])
        outputs |= _matrix("damping", force, every[1])
        outputs |= {f"output {k}": as_node(x) for k, x in enumerate(terms.outputs)}
        for number, friction in enumerate(self.frictions):
            state = equations.state(m, values, [Jet((x, y, 0.0)) for x, y in zip(q, v, strict=True)], time)
            coordinate = friction.term.coordinate
            now = Situation(time, state.parameter, coordinate.value(state), 0.0, 0.0, m)
            outputs[f"friction {number}"] = as_node(friction.term.amount(now))
            slope = as_node(coordinate.slope(state).value)
            for k, (x,) in enumerate(directional_derivatives([slope], [{one: 1.0} for one in v])):
                outputs[f"along {number} {k}"] = as_node(x)
        return Graph(outputs)

    def at(
        self,
        coordinates: Array,
        reactions: Array | None = None,
        speeds: Array | None = None,
        numbers: Mapping[str, Number] | None = None,
    ) -> LinearEquations:
        """The equations at n states.

        Parameters
        ----------
        coordinates : (n, coordinates) [rad or m]
        reactions : (n, equations), forces of the closures; the ones that hold best where they are left out
        speeds : (n, coordinates); none where they are left out
        numbers : values of `traced.parameters`, those of the mechanism where they are left out
        """
        count, e = len(coordinates), self.equations.equations
        if reactions is None:
            found = self._evaluate(coordinates, np.zeros((count, e)), speeds, numbers)
            if not e:
                return found
            reactions = self.reactions(found)
        return self._evaluate(coordinates, np.reshape(reactions, (count, e)), speeds, numbers)

    def _evaluate(
        self,
        coordinates: Array,
        reactions: Array,
        speeds: Array | None,
        numbers: Mapping[str, Number] | None,
    ) -> LinearEquations:
        count, e, c, f = len(coordinates), self.equations.equations, self.size, len(self.frictions)
        values: dict[str, Any] = {TIME: 0.0} | dict(self.numbers if numbers is None else numbers)
        values |= {f"coordinate {k}": coordinates[:, k] for k in range(c)}
        values |= {f"speed {k}": 0.0 if speeds is None else speeds[:, k] for k in range(c)}
        values |= {f"reaction {k}": reactions[:, k] for k in range(e)}
        found = evaluate(self.graph, values)
        shapes = {
            "residual": (c,), "force": (c,), "closures": (e,), "rows": (e, c), "drift": (e,), "bias": (e,),
            "mass": (c, c), "damping": (c, c), "stiffness": (c, c), "friction": (f,), "along": (f, c),
            "output": (len(self.equations.controls),),
        }  # fmt: skip
        arrays = {name: np.zeros((count, *shape)) for name, shape in shapes.items()}
        for name, x in found.items():
            kind, *places = name.split()
            at: tuple[Any, ...] = (slice(None), *map(int, places))
            arrays[kind][at] = x
        return LinearEquations(**arrays)

    def reactions(self, found: LinearEquations) -> Array:
        """Forces of the closures (n, equations) that leave least to accelerate."""
        return self.reactions_to(found.rows, found.force)

    def reactions_to(self, rows: Array, force: Array) -> Array:
        """Forces of closures with G (n, equations, coordinates) under forces (n, coordinates), as in `reactions`."""
        scaled = (rows * self.units).transpose(0, 2, 1)
        return np.asarray(np.einsum("nkc,nc->nk", np.linalg.pinv(scaled, RANK), force * self.units))

    @cached_property
    def graph_of_openings(self) -> Graph:
        """What friction by coefficients acts along, and what openings of its joints ask for."""
        return graph_of_openings(self.traced_equations.equations, len(self.states), TIME)

    @property
    def has_friction(self) -> bool:
        """Whether dry friction may hold it."""
        return bool(self.frictions or self.equations.contacts)

    def with_numbers_of(self, other: LoadedMechanism) -> EquationsOfMotion:
        """The equations of another mechanism of this structure, with wheels that mesh as they do here."""
        numbers = other.equations.numbers
        gearing = numbers.gearing.with_phases(self.equations.numbers.gearing.phase)
        return replace(other.equations, numbers=replace(numbers, gearing=gearing))

    @cached_property
    def _graph_by_numbers(self) -> Graph:
        """Derivatives of residual and closures, along a change of all numbers."""
        kept = ("residual", "closures")
        outputs = {name: x for name, x in self.graph.outputs.items() if name.startswith(kept)}
        change = {variable(name): variable(f"change of {name}") for name in self.traced_equations.parameters}
        (found,) = directional_derivatives(list(outputs.values()), [change])
        return Graph({name: as_node(x) for name, x in zip(outputs, found, strict=True)})

    def slopes_by_numbers(
        self, place: Array, reactions: Array, numbers: Mapping[str, float], changes: Mapping[str, float]
    ) -> tuple[Array, Array]:
        """How residual (coordinates) and closures (equations) change with the numbers, at one position at rest."""
        values: dict[str, Any] = {TIME: 0.0} | dict(numbers)
        values |= {f"change of {name}": changes[name] for name in self.traced_equations.parameters}
        values |= {f"coordinate {k}": x for k, x in enumerate(place)}
        values |= {f"speed {k}": 0.0 for k in range(self.size)}
        values |= {f"reaction {k}": x for k, x in enumerate(reactions)}
        found = evaluate(self._graph_by_numbers, values)
        return (
            np.array([float(found[f"residual {k}"]) for k in range(self.size)]),
            np.array([float(found[f"closures {k}"]) for k in range(self.equations.equations)]),
        )

    @cached_property
    def rank(self) -> int:
        """Number of closure equations that do not repeat others."""
        places = self._places_nearby()
        sizes = np.linalg.svd(
            self.scaled_rows(self.at(places, np.zeros((len(places), self.equations.equations))).rows),
            compute_uv=False,
        )
        if not sizes.size:
            return 0
        return int(np.max(np.sum(sizes > RANK * np.max(sizes, axis=1, initial=1.0)[:, None], axis=1)))

    @property
    def mobility(self) -> int:
        """Degrees of freedom, drives that are held taken off."""
        return self.joints - self.rank

    def _places_nearby(self) -> Array:
        """The initial position, and others that need not close: in general rows are as independent there."""
        generator = np.random.default_rng(3)
        here = self.start
        away = generator.uniform(-0.3, 0.3, (4, self.size)) * self.units
        return np.array([here, *(self.closed_coordinates(here + one) for one in away)])

    def scaled_rows(self, rows: Array) -> Array:
        """G (n, equations, coordinates) without units."""
        return np.asarray(rows * self.units / self.equation_units[:, None])

    def free_directions(self, rows: Array) -> Array:
        """Columns (n, coordinates, freedoms) along which the closures let it move, of unit length in the units.

        States of controllers are the last ones, each by itself.
        """
        count, joints, freedoms = len(rows), self.joints, self.size - self.rank
        found = np.zeros((count, self.size, freedoms))
        if rows.shape[1]:
            _left, _sizes, right = np.linalg.svd(self.scaled_rows(rows)[:, :, :joints])
            found[:, :joints, : self.mobility] = right[:, self.rank :, :].transpose(0, 2, 1)
        else:
            found[:, :joints, :joints] = np.eye(joints)
        found[:, joints:, self.mobility :] = np.eye(len(self.states))
        return np.asarray(found * self.units[None, :, None])

    def closed_coordinates(self, coordinates: Array, numbers: Mapping[str, Number] | None = None) -> Array:
        """Coordinates nearest to these (coordinates) or (n, coordinates) that close; NaN where none are found."""
        place = np.atleast_2d(np.array(coordinates, dtype=np.float64))
        if self.equations.equations:
            error = np.full(len(place), np.inf)
            open_ones = np.arange(len(place))
            for step in range(CLOSING_STEPS):
                left, rows = self.closures_at(place[open_ones], numbers)
                gap = np.max(np.abs(left) / self.equation_units, axis=1)
                # what no longer gets better has reached the rounding of its lengths
                better = gap < error[open_ones]
                error[open_ones] = np.fmin(error[open_ones], gap)
                going = (gap > CLOSED) & np.isfinite(gap) & (better | (gap > OPEN) | (step < 3))
                open_ones, left, rows = open_ones[going], left[going], rows[going]
                if not len(open_ones):
                    break
                inverse = np.linalg.pinv(self.scaled_rows(rows), 1e-10)
                shift = np.einsum("nck,nk->nc", inverse, left / self.equation_units)
                longest = np.max(np.abs(shift), axis=1, initial=1e-300)
                place[open_ones] -= shift * self.units * np.minimum(1.0, 0.5 / longest)[:, None]
            place[~(error < OPEN)] = np.nan
        return place[0] if np.ndim(coordinates) == 1 else place

    @cached_property
    def _closure_graph(self) -> Graph:
        kept = ("closures", "rows")
        return Graph({name: x for name, x in self.graph.outputs.items() if name.startswith(kept)})

    def closures_at(self, place: Array, numbers: Mapping[str, Number] | None = None) -> tuple[Array, Array]:
        """Left sides of the closures (n, equations) and G (n, equations, coordinates)."""
        values: dict[str, Any] = {TIME: 0.0} | dict(self.numbers if numbers is None else numbers)
        values |= {f"coordinate {k}": place[:, k] for k in range(self.size)}
        values |= {f"speed {k}": 0.0 for k in range(self.size)}
        found = evaluate(self._closure_graph, values)
        left: Any = np.zeros((len(place), self.equations.equations))
        rows: Any = np.zeros((len(place), self.equations.equations, self.size))
        for name, x in found.items():
            kind, *places = name.split()
            (left if kind == "closures" else rows)[(slice(None), *map(int, places))] = x
        return left, rows

    def drive_values(self, coordinates: Array) -> dict[str, float]:
        """Values of all drives [rad or m; on the sphere of guides rad] at joint coordinates."""
        return drive_values(self.equations, coordinates[: self.joints])


def _matrix(name: str, outputs: Sequence[Node], by: Sequence[Node]) -> dict[str, Node]:
    """Entries of minus the derivative of outputs by variables, without the plain zeros."""
    columns = directional_derivatives(outputs, [{one: 1.0} for one in by])
    return {
        f"{name} {i} {j}": as_node(-x)
        for j, column in enumerate(columns)
        for i, x in enumerate(column)
        if not (isinstance(x, float) and x == 0.0)
    }


def loaded_mechanism(
    mechanism: Mechanism,
    hold: Mapping[str, float] | None = None,
    speeds: Mapping[str, float] | None = None,
) -> LoadedMechanism:
    """A mechanism under its loads, all drives being free but those that are held or turn steadily.

    Parameters
    ----------
    hold : id of a drive -> value at which it is held [rad or m; on the sphere of guides rad]
    speeds : id of a drive -> constant speed that it keeps [rad/s or m/s], from its value in the initial position on

    Raises
    ------
    InputError
        It does not close, there is neither mass nor load, a drive is not known, or something depends on time.
    NotComputedYet
        A load with a force for each sense of a motion, a running belt, a plain sum of friction.
    """
    hold, speeds = hold or {}, speeds or {}
    for name in (*hold, *speeds):
        if name not in {drive.id for drive in mechanism.drives}:
            what = _("there is no drive {name}").format(name=f'"{name}"')
            raise InputError("[[drives]]", what, nearest(name, [drive.id for drive in mechanism.drives]))
    tree = spanning_tree_of(mechanism)
    position = position_of_description(mechanism, tree)
    pressed = pressed_contacts_of(mechanism)
    given = without_friction(mechanism)
    burden = MassesAndLoads.of(given)
    frictions = _dry_frictions(given, burden.loads)
    _check_belts(pressed)
    kept_names = (*hold, *speeds)
    motors = [one for one in driving_efforts(mechanism, "0") if one.drive not in kept_names]
    loads = free_loads_of(given, burden.loads, motors)
    _check_times(loads)
    loads = (*loads, *_stop_pushes(mechanism))
    equations = EquationsOfMotion(
        tree, position.numbers, burden.masses, loads, (), shafts=shafts_of(mechanism)
    )
    if hold:
        values = {f"drives.{name}": value for name, value in hold.items()}
        brought = initial_state(equations, position.coordinates, {}, values)
        position = InitialPosition(brought.coordinates, position.numbers)
    begin = drive_values(equations, position.coordinates)
    controls = controls_at_rest(mechanism, kept_names, _measured_values(mechanism, equations, position))
    kept = _kept_drives(mechanism, {name: (begin[name], speeds.get(name, 0.0)) for name in (*hold, *speeds)})
    equations = replace(equations, kept=kept, controls=controls)
    if pressed:
        contacts = (*dry_frictions_of(given, burden.loads), *pressed)
        equations = replace(equations, contacts=contacts)
        every = replace(equations, dependent=frozenset(range(equations.equations)))
        refuse_undetermined_presses(every, position.coordinates)
    return LoadedMechanism(mechanism, equations, position, frictions)


def _dry_frictions(mechanism: Mechanism, loads: Sequence[AppliedLoad]) -> tuple[DryFriction, ...]:
    """Dry frictions, by what they hold where they stick."""
    found = []
    for load, described in zip(loads, mechanism.loads, strict=False):
        for term in load.efforts:
            if has_sense(term):
                what = _("a load with a force for each sense of a motion has none at rest")
                raise NotComputedYet(load.where, what, _("give it one force"))
            if not is_dry(term):
                continue
            if getattr(described, "surface_speed", 0.0):
                what = _("a belt that runs goes on pushing: there is no rest")
                raise NotComputedYet(load.where, what, _("simulate it"))
            assert isinstance(term.amount, Friction)
            static = getattr(described, "static", None)
            held = term.amount.dry if static is None else Constant(static)
            found.append(DryFriction(load.label, replace(term, amount=held)))
    return tuple(found)


def _check_belts(pressed: Sequence[Contact]) -> None:
    for contact in pressed:
        if contact.drift:
            what = _("a belt that runs goes on pushing: there is no rest")
            raise NotComputedYet(f"[[loads]] {contact.label}", what, _("simulate it"))


def _stop_pushes(mechanism: Mechanism) -> Iterator[LoadAlong]:
    """Compliant stops as loads: they push wherever the coordinate is beyond their bounds."""
    for stop in mechanism.stops:
        if not stop.is_rigid:
            law = StopPush(stop.least, stop.most, stop.stiffness, stop.damping or 0.0)
            term = LoadTerm(stop_coordinate(mechanism, stop), law)  # type: ignore[arg-type]
            yield LoadAlong(stop.label, term)


def _measured_values(
    mechanism: Mechanism, equations: EquationsOfMotion, position: InitialPosition
) -> dict[str, float]:
    """Coordinates of all drives [rad or m], as controllers measure them."""
    if not mechanism.controllers:
        return {}
    jets = [Jet((x, 0.0, 0.0)) for x in position.coordinates]
    state = equations.state(ARRAYS, equations.tree.values(ARRAYS, list(position.coordinates)), jets, 0.0)
    return {one.id: float(coordinate_of_drive(mechanism, one).value(state)) for one in mechanism.drives}


def _kept_drives(mechanism: Mechanism, kept: Mapping[str, tuple[float, float]]) -> tuple[KeptDrive, ...]:
    """Drives that begin at a value and keep a speed, in the order of the constraints."""
    known = {drive.id: drive for drive in mechanism.drives}
    return tuple(
        KeptDrive(one, DrivenBy(known[one.drive], Uniform(kept[one.drive][1]), kept[one.drive][0]))
        for one in constraints_of(mechanism)
        if isinstance(one, AngleDrive | DisplacementDrive | DistanceDrive) and one.drive in kept
    )


def _check_times(loads: Sequence[LoadAlong]) -> None:
    for load in loads:
        if "t" in load.term.amount.uses:
            what = _("it depends on time, and at rest nothing may")
            raise InputError(load.label, what, _("write it as a function of the position"))


def graph_of_openings(equations: EquationsOfMotion, states: int, time: str) -> Graph:
    """Coordinates along which contacts act, and force, mass and rows of the openings of pressed joints.

    Parameters
    ----------
    equations : with numbers over expressions
    states : number of the states of controllers, which follow the joint coordinates
    time : name of its variable
    """
    q = [variable(f"coordinate {k}") for k in range(equations.size + states)]
    terms = equations.terms(
        EXPRESSIONS,
        equations.tree.values(EXPRESSIONS, q[: equations.size]),
        [0.0] * equations.size,
        variable(time),
        [FREE] * len(equations.contacts),
        q[equations.size :],
    )
    outputs: dict[str, Node] = {}
    for row, number in equations.contact_rows:
        outputs |= {f"along {number} {i}": as_node(x) for i, x in terms.rows[row].items()}
    for k, ways in terms.openings.items():
        for j, way in enumerate(ways):
            outputs[f"force {k} {j}"] = as_node(way.force)
            outputs |= {f"mass {k} {j} {i}": as_node(x) for i, x in way.mass.items()}
            outputs |= {
                f"rows {k} {j} {i}": as_node(x) for i, x in way.rows.items() if i < equations.equations
            }
            outputs |= {f"own {k} {j} {i}": as_node(x) for i, x in way.along.items()}
    return Graph(outputs)
