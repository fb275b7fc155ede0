"""Numbers of all letters of a mechanism's equations at one position: places from its motion, rates from the systems.

The rates and accelerations are solved from the differentiated constraints, so that they are a second way to those that
the motion in closed form has.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.equations.derivation import Equations, equations
from centrode.equations.linear import GroupSolution, LinearSystem, Unknown
from centrode.equations.spelling import SymbolFormula
from centrode.equations.symbol_table import SymbolLine, SymbolRod, SymbolTable, lines_of, rods_of
from centrode.equations.symbols import Letter, Sum
from centrode.errors import InputError, Status
from centrode.kinematics.motion import motion
from centrode.locale import _
from centrode.model.labels import ROLLING
from centrode.model.mechanism import FRAME, Mechanism
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.jets import Jet, JetFunctions
from centrode.quantities import display_unit

if TYPE_CHECKING:
    import xarray as xr

# The letters that move, read off one sample of a motion: angles, bearings, lengths of cylinders,
# displacements.


@dataclass(frozen=True)
class NumericValues:
    """What moves, as it stands at a sample of a motion."""

    board: SymbolTable
    motion: xr.Dataset
    sample: int

    def values(self) -> dict[Letter, float]:
        """Number of every letter that moves [rad, m]."""
        lines = {line.name: line for line in lines_of(self.board.ready)}
        rods = {rod.name: rod for rod in rods_of(self.board.ready)}
        found = {}
        for letter in self.board.alphabet.rates:
            meaning = self.board.alphabet.meanings[letter]
            if meaning.kind == "link angle":
                found[letter] = self._angle(meaning.names[0])
            elif meaning.kind == "relative angle":
                found[letter] = self._angle(meaning.names[0]) - self._angle(meaning.names[1])
            elif meaning.kind in ("bearing", "cylinder"):
                found[letter] = float(np.angle(self._way(rods[meaning.names[0]])))
            elif meaning.kind == "stroke":
                found[letter] = abs(self._way(rods[meaning.names[0]]))
            else:
                found[letter] = self._slide(lines[meaning.names[0]])
        return found

    def _angle(self, link: str) -> float:
        return 0.0 if link == FRAME else float(self.motion["angle"].sel(link=link)[self.sample])

    def _at(self, point: str) -> complex:
        return complex(*self.motion["position"].sel(point=point).values[self.sample])

    def _world(self, body: str, local: tuple[float, float]) -> complex:
        if body == FRAME:
            return complex(*local)
        name, own = next(iter(self.board.local(body).items()))
        arm = complex(*local) - complex(*own)
        return self._at(name) + arm * complex(np.exp(1j * self._angle(body)))

    def _way(self, rod: SymbolRod) -> complex:
        first = self._at(rod.first) if isinstance(rod.first, str) else self._world(*rod.first)
        return self._at(rod.second) - first

    def _slide(self, line: SymbolLine) -> float:
        away = self._at(line.point) - self._world(line.on, line.through)
        heading = complex(*line.direction) * complex(np.exp(1j * self._angle(line.on)))
        return (away * heading.conjugate()).real


Array: TypeAlias = npt.NDArray[np.float64]

JETS = JetFunctions(ARRAYS)
CHANGE_POINT = 1
OPERATIONS = 256
"""Rounded operations between the places of a motion and a rate by either route, in mechanisms of the size of books'."""
MENDED = (1e-10, 1e-8)
"""Errors of velocities and accelerations about change points, where motions are interpolated."""


@dataclass(frozen=True)
class SolvedSystem:
    """A linear system as numbers, with its solution.

    Attributes
    ----------
    matrix, right : (n, n), (n)
    determinant, numerators : of Cramer's rule
    solution : (n), NaN where the determinant is zero
    condition : of the matrix with rows and columns of length one, which rounding is multiplied by
    """

    matrix: Array
    right: Array
    determinant: float
    numerators: Array
    solution: Array
    condition: float


@dataclass(frozen=True)
class Instant:
    """One position in the letters of the equations.

    Attributes
    ----------
    values : number of every letter that can be told [rad, lengths in their unit, and by seconds]
    length : how many of the unit of lengths make a metre
    velocities, accelerations : systems of the groups, in their order
    together : of all rates as one system, where the equations have it
    """

    values: Mapping[Letter, float]
    length: float
    velocities: tuple[SolvedSystem, ...]
    accelerations: tuple[SolvedSystem, ...]
    together: SolvedSystem | None

    def number(self, what: Sum | SymbolFormula) -> float:
        """The number that a sum or a formula is here."""
        total = what.total if isinstance(what, SymbolFormula) else what
        with np.errstate(all="ignore"):
            return float(total.value(np, self.values.__getitem__))


def instant_of(equations: Equations, dataset: xr.Dataset, sample: int, length: float = 1.0) -> Instant:
    """The letters at one sample of a motion, whose places are taken as they are; `length` units make a metre.

    Raises InputError on the sphere, where the letters have other places.
    """
    board = equations.board
    if not isinstance(board, SymbolTable):
        raise InputError("space", _("numerical values of symbols are given for planar mechanisms only"))
    meanings = board.alphabet.meanings
    units = {letter: length if one.unit == "m" else 1.0 for letter, one in meanings.items()}
    values = dict(board.alphabet.values) | NumericValues(board, dataset, sample).values()
    values = {letter: x * units[letter] for letter, x in values.items()}
    for one in equations.given.drives:
        driven = next(by for by in board.ready.kinematics.path.driven if by.drive.id == one.drive)
        jet = driven.value(JETS, Jet.variable(float(dataset["time"][sample]), 2))
        orders = [jet.derivative(k) for k in range(3)] if isinstance(jet, Jet) else [jet, 0.0, 0.0]
        letters = (one.letter, one.rate, one.second)
        values |= {each: float(x) * units[one.letter] for each, x in zip(letters, orders, strict=True)}
    for letter, other in equations.given.names.items():
        values[other] = values[letter]
    found: list[tuple[SolvedSystem, ...]] = []
    for solutions in (
        [group.velocities for group in equations.groups],
        [group.seconds for group in equations.groups],
    ):
        found.append(tuple(_solve(one, values) for one in solutions))
    together = None if equations.together is None else _solve(equations.together, values)
    return Instant(values, length, found[0], found[1], together)


@dataclass(frozen=True)
class Rate:
    """A first or second derivative of an unknown by two routes [rad or m, by s or s^2].

    `allowed` is what rounding, multiplied by the condition of the system, and the interpolation about change points
    (docs: conventions, paragraph 25) may make of their difference.
    """

    unknown: Unknown
    order: int
    solved: float
    closed: float
    allowed: float

    @property
    def agrees(self) -> bool:
        """Whether both are the same as far as they can be."""
        return abs(self.solved - self.closed) <= self.allowed


def rates_compared(equations: Equations, instant: Instant, dataset: xr.Dataset, sample: int) -> list[Rate]:
    """Derivatives of angles of links and of slides of guides, by the equations and by the motion in closed form."""
    found = list(_pairs(equations, instant, dataset, sample))
    condition = max((one.condition for one in instant.velocities), default=1.0)
    first = max((abs(x) for _one, order, *both in found for x in both if order == 1), default=0.0)
    first = max(first, *(abs(instant.values[one.rate]) for one in equations.given.drives))
    second = max((abs(x) for _one, order, *both in found for x in both if order == 2), default=0.0)
    mended = bool((dataset["event_kind"] == CHANGE_POINT).any())
    rates = []
    for one, order, solved, closed in found:
        size = first if order == 1 else max(second, first**2)
        allowed = OPERATIONS * float(np.finfo(float).eps) * condition**order * size
        allowed += MENDED[order - 1] * size if mended else 0.0
        rates.append(Rate(one, order, solved, closed, allowed))
    return rates


def _pairs(
    equations: Equations, instant: Instant, dataset: xr.Dataset, sample: int
) -> Iterator[tuple[Unknown, int, float, float]]:
    for one in equations.unknowns:
        kind, _dot, name = one.name.partition(".")
        for order, letter in ((1, one.rate), (2, one.second)):
            word = "velocity" if order == 1 else "acceleration"
            if kind == "angle" and name in dataset["link"].values:
                own = dataset[f"angular_{word}"].sel(link=name)[sample]
            elif kind == "slide" and name in dataset["guide"].values:
                own = dataset[f"slide_{word}"].sel(guide=name)[sample]
            else:
                continue
            size = instant.length if kind == "slide" else 1.0
            yield one, order, instant.values[letter] / size, float(own)


def _solve(solution: GroupSolution, values: dict[Letter, float]) -> SolvedSystem:
    """A system as numbers; its solution and its determinant are added to the values."""
    system: LinearSystem = solution.system
    matrix = np.array([[_value(entry, values) for entry in row] for row in system.matrix], dtype=np.float64)
    right = np.array([_value(entry, values) for entry in system.right], dtype=np.float64)
    with np.errstate(all="ignore"):  # a position that does not exist has no determinant
        determinant = float(np.linalg.det(matrix))
        numerators = np.array([_cramer_determinant(matrix, right, column) for column in range(len(right))])
    condition = _condition(matrix)
    regular = condition < 1 / np.finfo(float).eps
    found: Array = np.full(len(right), np.nan)
    if regular:
        found = np.asarray(np.linalg.solve(matrix, right), dtype=np.float64)
    values |= {letter: float(x) for letter, x in zip(system.unknowns, found, strict=True)}
    values[solution.under] = determinant
    return SolvedSystem(matrix, right, determinant, numerators, found, condition)


def _value(total: Sum, values: Mapping[Letter, float]) -> float:
    with np.errstate(all="ignore"):
        return float(total.value(np, values.__getitem__))


def _cramer_determinant(matrix: Array, right: Array, column: int) -> float:
    other = matrix.copy()
    other[:, column] = right
    return float(np.linalg.det(other))


def _condition(matrix: Array) -> float:
    """Condition of a matrix with columns and rows of length one, so that units do not count."""
    if not np.isfinite(matrix).all():
        return float("inf")
    with np.errstate(all="ignore"):
        columns = matrix / np.linalg.norm(matrix, axis=0)
        rows = columns / np.linalg.norm(columns, axis=1)[:, None]
    return float(np.linalg.cond(rows)) if np.isfinite(rows).all() else float("inf")


# The equations with the numbers of a motion: the constraints put to the test, the systems solved at instants.

EPS = float(np.finfo(float).eps)
TESTED = 12
"""Samples at which the constraints are put to the test."""


@dataclass(frozen=True)
class ConstraintCheck:
    """How well the places of a motion satisfy the constraints [m, rad].

    Attributes
    ----------
    samples : at how many positions
    greatest : greatest difference of both sides of a constraint
    allowed : what rounding makes of it
    """

    samples: int
    greatest: float
    allowed: float


@dataclass(frozen=True)
class NumbersAtInstant:
    """The letters at one instant, and its rates by two routes."""

    instant: Instant
    rates: tuple[Rate, ...]


@dataclass(frozen=True)
class PlacedEquations(Equations):
    """The equations of a mechanism with the numbers of its positions in closed form.

    Attributes
    ----------
    motion : at the instants
    place_values : letter -> number at each of them [SI]; None where the mechanism does not get there
    """

    motion: xr.Dataset
    place_values: tuple[Mapping[Letter, float] | None, ...]


@dataclass(frozen=True)
class NumberedEquations(PlacedEquations):
    """The equations of a planar mechanism with the numbers of its motion.

    Attributes
    ----------
    check : of the constraints over the motion; None where there are none, or no position is reached
    numbers : at each of them, lengths in the unit of the display; None where the mechanism does not get there
    """

    check: ConstraintCheck | None
    numbers: tuple[NumbersAtInstant | None, ...]


def equation_results(
    mechanism: Mechanism, points: Sequence[str] | None = None, instants: Sequence[float] | None = None
) -> Equations:
    """The equations of a mechanism, with their numbers at instants where these are given.

    Parameters
    ----------
    points : names of points, optional
        Whose velocities are written out.
    instants : values of the drive [rad or m], with a law or several drives times [s], optional

    Raises
    ------
    InputError
        As `equations` and `motion` do.
    """
    found = equations(mechanism, points)
    if instants is None:
        return found
    own = {field.name: getattr(found, field.name) for field in dataclasses.fields(found)}
    places = motion(mechanism, at=list(instants))
    place_values = tuple(
        position_values(found, places, sample) if status == Status.OK else None
        for sample, status in enumerate(places["status"].values.tolist())
    )
    if mechanism.space != "plane":
        return PlacedEquations(**own, motion=places, place_values=place_values)
    length, _unit = display_unit("m", str(mechanism.display.length))
    numbers = tuple(
        _numbers(found, places, sample, length) if status == Status.OK else None
        for sample, status in enumerate(places["status"].values.tolist())
    )
    return NumberedEquations(
        **own, motion=places, place_values=place_values, check=_check(found), numbers=numbers
    )


def _numbers(found: Equations, places: xr.Dataset, sample: int, length: float) -> NumbersAtInstant:
    instant = instant_of(found, places, sample, length)
    return NumbersAtInstant(instant, tuple(rates_compared(found, instant, places, sample)))


def _check(found: Equations) -> ConstraintCheck | None:
    """The constraints with the numbers of the motion put in: both sides agree to rounding."""
    conditions = [one for group in found.groups for one in group.conditions]
    if not conditions:
        return None
    dataset = motion(found.mechanism)
    reached = np.flatnonzero(dataset["status"].values == Status.OK)
    if not reached.size:
        return None
    chosen = np.unique(reached[np.linspace(0, reached.size - 1, TESTED).astype(int)])
    greatest, allowed = 0.0, 0.0
    for sample in chosen.tolist():
        instant = instant_of(found, dataset, sample)
        greatest = max(greatest, *(abs(instant.number(one.residual)) for one in conditions))
        allowed = max(allowed, 64 * EPS * _size(instant))
    return ConstraintCheck(len(chosen), greatest, allowed)


def _size(instant: Instant) -> float:
    """Size of what is added up in a constraint: lengths times angles, which carry a rounding of their own size."""
    sizes = [
        abs(value)
        for letter, value in instant.values.items()
        if np.isfinite(value) and not _is_rate(letter.name)
    ]
    return max(1.0, *sizes) ** 2


def _is_rate(name: str) -> bool:
    return name.startswith(("omega", "epsilon", "Delta")) or name.endswith(("_dot", "_ddot"))


# Positions in closed form with the numbers of one position: constants, drives and branches, letter by letter.


def position_values(equations: Equations, dataset: xr.Dataset, sample: int) -> dict[Letter, float]:
    """Number of every letter of the positions in closed form at a sample [SI].

    Of the motion nothing is taken but the drives, the branches, whole turns of angles, and what has no closed form.
    """
    functions, board = equations.position_functions, equations.board
    values = dict(board.alphabet.values)
    if isinstance(board, SymbolTable):
        values |= NumericValues(board, dataset, sample).values()
        values |= _bearings(equations, values)
    else:
        values |= {x: float(dataset["drive_value"].sel(drive=one)[sample]) for x, one in board.driven.items()}
    values |= _measured_coordinates(equations, dataset, sample)
    for branch in functions.branches:
        if branch.measure is not None:
            measure = _value(branch.measure, values)
        elif set(branch.places) <= {*dataset["point"].values.tolist()}:
            measure = float(np.linalg.det(dataset["position"].sel(point=list(branch.places)).values[sample]))
        else:  # a pole without a name that moves
            measure = branch.initial
        values[branch.letter] = 1.0 if measure >= 0.0 else -1.0
    return {letter: float(value) for letter, value in functions.values(values).items()}


def _bearings(equations: Equations, values: Mapping[Letter, float]) -> dict[Letter, float]:
    """Directions of wheels' centres with the whole turns that the angles of the wheels have."""
    found = {}
    meanings = equations.board.alphabet.meanings
    for condition in (one for group in equations.groups for one in group.conditions):
        residual = condition.residual
        for letter in residual.letters:
            if (
                condition.name.startswith(ROLLING)
                and letter in meanings
                and meanings[letter].kind == "bearing"
            ):
                slope = _value(residual.slope(letter), values)
                away = _value(residual, values) / slope
                found[letter] = values[letter] - math.tau * round(away / math.tau)
    return found


def _measured_coordinates(equations: Equations, dataset: xr.Dataset, sample: int) -> dict[Letter, float]:
    """Coordinates of points as the motion has them, by the letters that the measures of branches have."""
    found: dict[Letter, float] = {}
    if not isinstance(equations.board, SymbolTable):
        return found
    for point, place in equations.position_functions.places.items():
        at = dataset["position"].sel(point=point).values[sample]
        for axis, total, value in zip("xy", place, at.tolist(), strict=True):
            found[Letter(0, f"{axis}({point})")] = value
            found |= {letter: value for letter in total.letters if letter.name == f"{axis}_{point}"}
    return found
