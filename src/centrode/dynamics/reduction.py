"""Masses and loads reduced to the drive, as a labelled result."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product
from math import copysign
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.dynamics.load_discontinuities import jumps_of
from centrode.dynamics.loads import AppliedLoad, LoadDiagram, LoadTable, MassesAndLoads
from centrode.dynamics.masses import coordinates_of as speeds_of
from centrode.dynamics.masses import share, shares
from centrode.dynamics.state import About, DriveMotion, State, getters_of
from centrode.errors import InputError
from centrode.kinematics.machine_code.trace import Untraceable
from centrode.kinematics.motion import (
    Variable,
    attributes_of,
    coordinates_along,
    judgements_of,
    labels_of,
    vocabulary_variable,
)
from centrode.kinematics.plan_evaluation import RadicandZero
from centrode.kinematics.preparation import Ready, ready
from centrode.kinematics.sample_index import selectable
from centrode.kinematics.samples import MotionOnPath
from centrode.kinematics.several_inputs.coefficients import Partials, partials
from centrode.kinematics.solve import GREATEST_RESULT, Solved, grid_of, solve
from centrode.locale import _, mark
from centrode.model.examples.catalogue import MechanismSource, mechanism_of
from centrode.model.mechanism import Mechanism
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.expressions import EXPRESSIONS
from centrode.numerics.jets import JetFunctions

# Masses and loads of a mechanism with one drive, reduced to it at any value of the drive.

Array: TypeAlias = npt.NDArray[np.float64]
Namespace: TypeAlias = Any


@dataclass(frozen=True)
class Reduced:
    """A mechanism reduced to its drive at n values of it; NaN where the motion does not exist.

    Attributes
    ----------
    values : (n) [rad or m]
    inertia : (n) [kg m^2, or kg of a displacement]
        Twice the kinetic energy at unit speed of the drive.
    inertia_slope : (n)
        Its derivative by the drive's value.
    moment : (n) [N m or N]
        Of all loads and weights; inertia is not in it.
    inertia_parts, inertia_slope_parts : (links, n)
    moment_parts : (loads, n)
    status : (n)
    """

    values: Array
    inertia: Array
    inertia_slope: Array
    moment: Array
    inertia_parts: Array
    inertia_slope_parts: Array
    moment_parts: Array
    status: npt.NDArray[np.int8]


class Reducer:
    """Reduces a mechanism to its only drive at any values; events are looked for once, and farther when needed.

    Attributes
    ----------
    ready : the mechanism with its plan
    burden : its masses and loads
    """

    def __init__(self, ready: Ready, burden: MassesAndLoads) -> None:
        if len(ready.mechanism.drives) != 1:
            what = _("it has {n} drives").format(n=len(ready.mechanism.drives))
            raise InputError(
                "[[drives]]", what, _("use ct.reduce, which gives the inertia matrix of several")
            )
        self.ready = ready
        self.burden = burden
        self._places: MotionOnPath | None = None

    @classmethod
    def of(cls, mechanism: Mechanism) -> Reducer:
        """The reducer of a description with one drive; raises as `ready` and `MassesAndLoads.of` do."""
        return cls(ready(mechanism), MassesAndLoads.of(mechanism))

    @property
    def links(self) -> tuple[str, ...]:
        """Links of `inertia_parts`."""
        return self.burden.links

    @property
    def loads(self) -> tuple[str, ...]:
        """Loads of `moment_parts`."""
        return self.burden.labels

    def at(
        self,
        values: npt.ArrayLike,
        rate: npt.ArrayLike | None = None,
        side: int = 0,
        time: npt.ArrayLike | None = None,
    ) -> Reduced:
        """Reduced inertia and moment at values of the drive.

        Parameters
        ----------
        values : (n) [rad or m]
        rate : (n) or one [rad/s or m/s]
            Speed of the drive, for loads that depend on speeds, and the sense for one-sided ones; that of
            `default_rate` if left out.
        side : -1, 0 or 1
            At values where a load jumps: what holds below them, where it acts, or above them.
        time : (n) or one [s]
            For loads that depend on time; left out, that of the rate from the start of the drive.

        Raises InputError for a load without a value, or that needs a rate or a time which nothing tells.
        """
        values = np.atleast_1d(np.asarray(values, dtype=np.float64))
        return reduce_state(self.burden, *self._state(values, self.moving(values, rate, time), side))

    def jumps(self, first: float, last: float, loads: Sequence[AppliedLoad] | None = None) -> Array:
        """Values of the drive, in increasing order, at which loads jump or have a kink, between two values.

        Of all loads where none are given.
        """
        low, high = min(first, last), max(first, last)
        if not np.isfinite([low, high]).all():
            raise InputError("jumps", _("the range must be finite"))
        mesh = self._along(np.array([low, high])).mesh
        inner = mesh[(mesh > low) & (mesh < high)]
        # the nodes of the motion itself, so that jumps are the same whatever range is asked about
        nodes = np.concatenate([[low], inner, [high]]) if high > low else np.array([low])
        return jumps_of(
            self.burden.loads if loads is None else loads,
            lambda x: self._state(x, _sense_only(self, x), 0)[0],
            nodes,
        )

    @property
    def default_rate(self) -> float | None:
        """Speed of the drive [rad/s or m/s]: the machine's mean speed in the drive's sense, else the drive's own."""
        mechanism, path = self.ready.mechanism, self.ready.kinematics.path
        if mechanism.machine is not None and mechanism.runs_at_mean_speed:
            return copysign(mechanism.machine.mean_speed, path.forward)
        return path.parameter.constant_speed

    def moving(
        self, values: Array, rate: npt.ArrayLike | None = None, time: npt.ArrayLike | None = None
    ) -> DriveMotion:
        """Motion of the drive at values (n), with speed and time as `at` takes them."""
        path = self.ready.kinematics.path
        speed = self.default_rate if rate is None else np.asarray(rate, dtype=np.float64)
        if speed is None:
            if self.burden.needs_law:
                what = _("loads depend on time or speeds, and the drive is a law of time")
                raise InputError("rate", what, _("give the speed of the drive, or [machine] mean_speed"))
            speed = path.forward
        # a time follows from constant speed; at speed zero it is infinite, and only loads of time would see
        # that
        with np.errstate(all="ignore"):
            elapsed = (values - path.start) / speed if time is None else time
        return DriveMotion(
            np.broadcast_to(np.asarray(elapsed, dtype=np.float64), values.shape),
            values,
            np.broadcast_to(np.asarray(speed, dtype=np.float64), values.shape),
        )

    def state(self, values: Array, moving: DriveMotion, side: int = 0) -> tuple[State, npt.NDArray[np.int8]]:
        """Positions with their derivatives at values of the drive, and their statuses (n)."""
        return self._state(values, moving, side)

    def reach(self, first: float, last: float) -> tuple[float, float]:
        """Nearest limits on both sides of the initial position; infinite where none lies between two values."""
        return self._along(np.array([first, last])).continuation.branches.reach(0)

    def events(self, first: float, last: float) -> list[RadicandZero]:
        """Limits and change points between two values of the drive."""
        events = self._along(np.array([first, last])).continuation.branches.events
        return [event for event in events if first <= event.at <= last]

    def _along(self, values: Array) -> MotionOnPath:
        """Places on a stretch of the path with all these values, whose events are known."""
        places = self._places
        # the new stretch holds the old one, so that places requested before stay known
        if places is None or not (places.mesh[0] <= np.min(values) and np.max(values) <= places.mesh[-1]):
            reach = values if places is None else np.append(values, places.mesh[[0, -1]])
            places = MotionOnPath.along(self.ready, self.ready.kinematics, reach)
            self._places = places
        return places

    def _state(self, values: Array, moving: DriveMotion, side: int) -> tuple[State, npt.NDArray[np.int8]]:
        samples = self._along(values).at(values)
        path = self.ready.kinematics.path
        state = State.of_samples(self.ready.mechanism, samples, moving, path.scale, side)
        return state, samples.status[0]


def _sense_only(reducer: Reducer, values: Array) -> DriveMotion:
    """Any motion in the sense of the drive: jumps do not depend on how fast it is."""
    ones = np.ones(values.shape)
    return DriveMotion(0.0 * ones, values, reducer.ready.kinematics.path.forward * ones)


def reduce_state(burden: MassesAndLoads, state: State, status: npt.NDArray[np.int8]) -> Reduced:
    """A state of one mechanism reduced; InputError for a load without a finite value."""
    count = len(state.parameter)
    # in parts first: sums and parts of a result agree to the last bit
    inertia, slope = shares(state, burden.masses, (1, count))
    moments = np.empty((len(burden.loads), 1, count))
    # where derivatives exist: nothing is reduced at limits
    known = state.exists
    for k, load in enumerate(burden.loads):
        moments[k] = load.moment(state, known)
    # added to sums and parts alike: one absent number makes them absent
    absent = np.where(known, 0.0, np.nan)
    return Reduced(
        state.parameter,
        (inertia.sum(axis=0) + absent)[0],
        (slope.sum(axis=0) + absent)[0],
        (moments.sum(axis=0) + absent)[0],
        (inertia + absent)[:, 0],
        (slope + absent)[:, 0],
        (moments + absent)[:, 0],
        status,
    )


# Masses and loads of a mechanism with several drives: inertia matrix, Christoffel terms, generalised forces.


def reduced_to_several(solved: Solved, burden: MassesAndLoads) -> xr.Dataset:
    """Inertia matrix, Christoffel terms of the first kind and generalised forces at the samples of a motion.

    M_ij = sum m r_i . r_j + I phi_i phi_j with partial derivatives by the drives, [ij, k] = sum m r_ij . r_k + I
    phi_ij phi_k, Q_i = sum F . r_i. Raises InputError for a load whose formula names the drive's value.
    """
    refuse_drive_in_formulas(burden)
    _refuse_rings(burden)
    _check_size(solved, burden)
    coefficients = partials(solved)
    directions = _Directions.of(coefficients, solved)
    matrix, christoffel = _inertia(directions, burden)
    forces = _forces(directions, solved, burden)
    units = solved.ready.parameter.units
    variables = {
        "inertia_matrix": _variable_of_units(
            "inertia_matrix", ("drive", "drive_2"), matrix.sum(axis=1), units
        ),
        "inertia_matrix_part": _variable_of_units(
            "inertia_matrix_part", ("link", "drive", "drive_2"), matrix, units
        ),
        "christoffel": _variable_of_units("christoffel", ("drive", "drive_2", "drive_3"), christoffel, units),
        "generalised_force": _variable_of_units("generalised_force", ("drive",), forces.sum(axis=1), units),
        "generalised_force_part": _variable_of_units(
            "generalised_force_part", ("load", "drive"), forces, units
        ),
        "status": judgements_of(coefficients.solved, ())["status"],
    }
    coordinates = coordinates_along(solved)
    names = labels_of(tuple(coefficients.units))
    coordinates |= {"drive_2": names, "drive_3": names}
    coordinates |= {"link": labels_of(burden.links), "load": labels_of(burden.labels)}
    return selectable(xr.Dataset(variables, coords=coordinates, attrs=attributes_of(solved, "reduce")))


def refuse_drive_in_formulas(burden: MassesAndLoads) -> None:
    """Raise InputError for a load whose formula names the drive's value, where there are several drives."""
    for load in burden.loads:
        if any("q" in effort.amount.uses for effort in load.efforts):
            what = _("its formula names q, and there are several drives")
            raise InputError(load.where, what, _("write it with t, x and v"))


def _refuse_rings(burden: MassesAndLoads) -> None:
    for mass in burden.masses:
        if isinstance(mass.inertia, tuple) and any(isinstance(part, About) for part in mass.inertia):
            what = _("a ring and point mass is used in mechanisms with one drive only")
            raise InputError(f"[links.{mass.link}] model", what, _("give the link's tensor of inertia"))


def _check_size(solved: Solved, burden: MassesAndLoads) -> None:
    drives, samples = len(solved.ready.mechanism.drives), solved.status.size
    # the greatest of the arrays on the way: partial derivatives of columns, Christoffel terms, forces by load
    most = GREATEST_RESULT // max(solved.layout.width * drives**2, drives**3, len(burden.loads) * drives)
    if samples > most:
        what = _("{asked} positions are given").format(asked=samples)
        repair = _("give at most {most} at once, samples times mechanisms").format(most=most)
        raise InputError(_("samples"), what, repair)


@dataclass(frozen=True)
class _Directions:
    """States differentiated along each drive and each pair of drives, and the lengths of these directions."""

    along: dict[tuple[int, int], State]
    units: tuple[float, ...]
    shape: tuple[int, ...]

    @classmethod
    def of(cls, found: Partials, solved: Solved) -> _Directions:
        """States of all directions of a motion."""
        moving = DriveMotion(solved.span.time, solved.span.parameter, solved.span.rate)
        along = {}
        for pair, one in found.along.items():
            # directions carry derivatives of angles only, the angles themselves are those of the motion
            angles = np.concatenate([solved.angles[:1], one.angles[1:]])
            along[pair] = State.of(replace(one, angles=angles), moving)
        return cls(along, tuple(found.units.values()), solved.status.shape)


def _inertia(directions: _Directions, burden: MassesAndLoads) -> tuple[Array, Array]:
    """Inertia matrix by link (n, links, i, j) and Christoffel terms (n, i, j, k)."""
    units, along = directions.units, directions.along
    size, count = len(units), directions.shape[-1]
    matrix = np.zeros((len(burden.masses), size, size, count))
    christoffel = np.zeros((size, size, size, count))
    for link, mass in enumerate(burden.masses):
        jets = {pair: speeds_of(state, mass) for pair, state in along.items()}
        for number, (factor, _one) in enumerate(jets[0, 0]):
            # directions have the length of the drive's unit, which is divided out
            first = [jets[i, i][number][1].derivative(1) / units[i] for i in range(size)]
            for i, j in product(range(size), repeat=2):
                matrix[link, i, j] += np.reshape(factor * first[i] * first[j], -1)
                pair = (i, j) if i <= j else (j, i)
                second = jets[pair][number][1].derivative(2)
                if i == j:
                    second = second / units[i] ** 2
                # jets along e_i + e_j hold D_ii + 2 D_ij + D_jj: what both drives do alone is taken off
                else:
                    straight = [jets[k, k][number][1].derivative(2) for k in pair]
                    second = (second - straight[0] - straight[1]) / (2.0 * units[i] * units[j])
                for k in range(size):
                    christoffel[i, j, k] += np.reshape(factor * second * first[k], -1)
    return np.moveaxis(matrix, -1, 0), np.moveaxis(christoffel, -1, 0)


def _forces(directions: _Directions, solved: Solved, burden: MassesAndLoads) -> Array:
    """Generalised forces by load (n, loads, i): how great loads are the motion says, along what the directions."""
    state = State.of(solved, DriveMotion(solved.span.time, solved.span.parameter, solved.span.rate))
    known = state.exists
    forces = np.empty((len(burden.loads), len(directions.units), directions.shape[-1]))
    for number, load in enumerate(burden.loads):
        # how great a load is follows from the motion as it is; its work is that along each drive alone
        strengths = load.strengths(state, known)
        for i, unit in enumerate(directions.units):
            forces[number, i] = np.reshape(
                np.broadcast_to(load.along(directions.along[i, i], strengths) / unit, directions.shape), -1
            )
    absent = ~directions.along[0, 0].exists[0]
    forces[..., absent] = np.nan
    return np.moveaxis(forces, -1, 0)


def _variable_of_units(name: str, dimensions: Sequence[str], values: Array, units: Sequence[str]) -> Variable:
    """A variable with one unit, or with one for each combination of drives in the order of the array."""
    variable = vocabulary_variable(name, ("sample", *dimensions), values)
    drives = sum(dimension.startswith("drive") for dimension in dimensions)
    head = "N" if "force" in name else "kg"
    least = 1 if head == "N" else 2
    # a drive in metres takes the place of one in radians, and a metre out of the unit
    each = [_unit(head, least - sum(unit != "rad" for unit in of)) for of in product(units, repeat=drives)]
    variable[2]["units"] = each[0] if len(set(each)) == 1 else ", ".join(each)
    return variable


def _unit(head: str, metres: int) -> str:
    """A unit with so many metres in it: "kg m^2" with 2, "kg/m" with -1."""
    if metres == 0:
        return head
    power = "" if abs(metres) == 1 else f"^{abs(metres)}"
    return f"{head} m{power}" if metres > 0 else f"{head}/m{power}"


def reduce(
    mechanism: MechanismSource,
    samples: int | None = None,
    start: float | str | None = None,
    stop: float | str | None = None,
    at: npt.ArrayLike | None = None,
) -> xr.Dataset:
    """Masses and loads reduced to the drive, or to several drives, at the samples of a motion.

    Parameters
    ----------
    samples, start, stop, at
        As for `motion`.

    Returns
    -------
    Dataset
        One drive: `reduced_inertia`, its derivative `reduced_inertia_slope` and `reduced_moment` (sample), by link
        and by load in `..._part`; `jumps`, values of the drive at which loads jump. Several drives:
        `inertia_matrix`, `christoffel`, `generalised_force` (docs: dynamics).

    Raises
    ------
    InputError
        As `motion` does; masses or loads that are not complete, or none; a formula without a value.
    NotComputedYet
        Coulomb friction.

    Examples
    --------
    >>> import centrode as ct
    >>> reduced = ct.reduce(ct.example("six-bar-press"), 37)
    >>> print(ct.summary(reduced).splitlines()[3])
    loads                  force H, weight AB, weight CD, weight DH, weight slider
    """
    mechanism = mechanism_of(mechanism)
    prepared = ready(mechanism)
    burden = MassesAndLoads.of(mechanism)
    span = grid_of(prepared, samples, start, stop, at)
    return reduction_of(solve(prepared, span), burden)


def reduction_of(solved: Solved, burden: MassesAndLoads | None = None) -> xr.Dataset:
    """Masses and loads reduced to the drives at the samples of a solved motion of one mechanism; see `reduce`."""
    burden = MassesAndLoads.of(solved.ready.mechanism) if burden is None else burden
    if solved.ready.kinematics.path.by_time:
        return reduced_to_several(solved, burden)
    reducer = Reducer(solved.ready, burden)
    moving = motion_of_loads(solved, burden)
    reduction = reduce_state(burden, State.of(solved, moving), solved.status[0])
    first, last = np.min(solved.span.parameter), np.max(solved.span.parameter)
    variables = _variables(reduction, solved.ready.parameter.units[0])
    unit = solved.ready.parameter.units[0]
    variables["drive_rate"] = vocabulary_variable("drive_rate", ("sample",), moving.rate.copy(), unit)
    variables["jumps"] = vocabulary_variable(
        "jumps", ("jump",), reducer.jumps(float(first), float(last)), unit
    )
    variables["status"] = judgements_of(solved, ())["status"]
    along = coordinates_along(solved)
    coordinates = {name: along.pop(name) for name in ("time", "drive", "drive_value")}
    coordinates |= {**along, "link": labels_of(burden.links), "load": labels_of(burden.labels)}
    attributes = attributes_of(solved, "reduce") | {"rate_from": "drive" if _by_drive(solved) else "machine"}
    return selectable(xr.Dataset(variables, coords=coordinates, attrs=attributes))


def _by_drive(solved: Solved) -> bool:
    """Whether loads are taken at the speed of the drive, and not at the machine's mean speed."""
    ready = solved.ready
    return not ready.mechanism.runs_at_mean_speed or not ready.parameter.is_uniform


def motion_of_loads(solved: Solved, burden: MassesAndLoads) -> DriveMotion:
    """The speed that loads see: of a drive of constant speed the machine's, if there is one; else the drive's own."""
    span = solved.span
    if _by_drive(solved):
        return DriveMotion(span.time, span.parameter, span.rate)
    return Reducer(solved.ready, burden).moving(span.parameter)


def _variables(found: Reduced, unit: str) -> dict[str, Variable]:
    by_link, by_load = ("sample", "link"), ("sample", "load")
    return {
        "reduced_inertia": vocabulary_variable("reduced_inertia", ("sample",), found.inertia, unit),
        "reduced_inertia_slope": vocabulary_variable(
            "reduced_inertia_slope", ("sample",), found.inertia_slope, unit
        ),
        "reduced_moment": vocabulary_variable("reduced_moment", ("sample",), found.moment, unit),
        "reduced_inertia_part": vocabulary_variable(
            "reduced_inertia_part", by_link, found.inertia_parts.T, unit
        ),
        "reduced_inertia_slope_part": vocabulary_variable(
            "reduced_inertia_slope_part", by_link, found.inertia_slope_parts.T, unit
        ),
        "reduced_moment_part": vocabulary_variable(
            "reduced_moment_part", by_load, found.moment_parts.T, unit
        ),
    }


# Reduced inertia and moment of many mechanisms at once, over arrays or expressions.

AnyArray: TypeAlias = npt.NDArray[Any]
Number: TypeAlias = Any
Values: TypeAlias = Mapping[str, npt.ArrayLike]

REDUCED = ("reduced_inertia", "reduced_inertia_slope", "reduced_moment")
NODE_JETS = JetFunctions(EXPRESSIONS)


def check_reducible(solved: Solved) -> None:
    """Raise InputError for several drives, and for masses and loads that are not complete."""
    if solved.ready.kinematics.path.by_time:
        what = _("a sweep reduces masses and loads to one drive, and there are several")
        raise InputError("outputs", what, _("omit the reduced quantities"))
    MassesAndLoads.of(solved.ready.mechanism)


def reduced_number(name: str, solved: Solved, values: Values) -> AnyArray:
    """One of REDUCED for every mechanism and sample (lanes, n); of expressions one node in a box (1, 1).

    `values` are those that vary, by their paths, one a mechanism. Raises Untraceable for what expressions cannot
    say; without a finite load there is NaN.
    """
    expressed = solved.points.dtype == object
    given = {
        # arrays of a batch meet samples in the last axis; a node stands for all of them
        path: np.asarray(x).item() if expressed else np.asarray(x)[:, None]
        for path, x in values.items()
    }
    burden = MassesAndLoads.of(solved.ready.mechanism, given, EXPRESSIONS if expressed else ARRAYS)
    state = (
        _state_of_nodes(solved, burden) if expressed else State.of(solved, motion_of_batch(solved, burden))
    )
    state.know_varied_frame(solved, values)
    if name == "reduced_moment":
        total: Number = 0.0
        for load in burden.loads:
            total = total + load.along(state, [effort.strength(state) for effort in load.efforts])
    else:
        # the names stand in the order in which `share` gives the two
        which = REDUCED.index(name)
        total = sum((share(state, mass)[which] for mass in burden.masses), 0.0)
    if expressed:
        box = np.empty((1, 1), dtype=object)
        box[0, 0] = total
        return box
    # nothing is reduced where the motion has no derivatives
    known = np.where(state.exists, 0.0, np.nan)
    return np.asarray(np.broadcast_to(total, solved.status.shape) + known)


def balancing_number(solved: Solved, values: Values) -> AnyArray:
    """What the drive gives so that the motion is as it is, for every mechanism and sample, as `reduced_number` has it.

    J q'' + J' q'^2 / 2 less the reduced moment, at the speed that loads see.
    """
    inertia, slope, moment = (reduced_number(name, solved, values) for name in REDUCED)
    rate = motion_of_batch(solved, MassesAndLoads.of(solved.ready.mechanism)).rate
    balancing = 0.5 * slope * (rate * rate) - moment
    # at the mean speed of a machine the drive has no acceleration
    if _by_drive(solved) and solved.span.accelerates:
        balancing = balancing + inertia * solved.span.second_rate
    return np.asarray(balancing)


def motion_of_batch(solved: Solved, burden: MassesAndLoads) -> DriveMotion:
    """The speed that loads see, as `reduction_of` has it."""
    span, ready = solved.span, solved.ready
    if not ready.mechanism.runs_at_mean_speed or not ready.parameter.is_uniform:
        return DriveMotion(span.time, span.parameter, span.rate)
    speed = Reducer(ready, burden).default_rate
    assert speed is not None
    start = ready.kinematics.path.start
    return DriveMotion(
        ready.parameter.times(span.parameter, start, speed),
        span.parameter,
        speed * np.ones(len(span.parameter)),
    )


def _state_of_nodes(solved: Solved, burden: MassesAndLoads) -> State:
    """The state at the one sample of a traced motion."""
    boxes = motion_of_batch(solved, burden)
    moving = DriveMotion(*(np.asarray(x).ravel()[0] for x in (boxes.time, boxes.parameter, boxes.rate)))
    return state_of_nodes(solved, burden, moving)


def state_of_nodes(solved: Solved, burden: MassesAndLoads, moving: DriveMotion) -> State:
    """The state at the one sample of a traced motion, with time [s], parameter and rate as given."""
    if any(
        isinstance(effort.amount, LoadDiagram | LoadTable) for load in burden.loads for effort in load.efforts
    ):
        raise Untraceable(mark("indicator diagrams"))
    path, mechanism = solved.ready.kinematics.path, solved.ready.mechanism
    return State(
        mechanism,
        solved.layout,
        moving.time,
        moving.parameter,
        moving.rate,
        0,
        path.scale,
        getters_of(solved, lambda array: array[:, 0, 0]),
        m=NODE_JETS,
    )
