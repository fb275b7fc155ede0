"""Loads of a mechanism as efforts, from what the description gives."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from functools import partial
from importlib import import_module
from math import ceil, floor, hypot, tau
from typing import Any, ClassVar, NamedTuple, TypeAlias, assert_never

import numpy as np
import numpy.typing as npt

from centrode.dynamics.load_coordinates import (
    Component,
    Coordinate,
    Distance,
    HalfSquare,
    Slide,
    Travel,
    turning_of,
)
from centrode.dynamics.masses import centre_of, masses_of
from centrode.dynamics.state import Given, Mass, State, is_none
from centrode.dynamics.wrenches import Wrench
from centrode.errors import InputError, NotComputedYet
from centrode.kinematics.path import JETS
from centrode.locale import _
from centrode.model.loads import (
    DRIVE,
    GREATEST,
    LOAD_VARIABLES,
    PLAIN_SUM,
    STROKE,
    TIME,
    AnyLoad,
    BearingFriction,
    CoefficientFriction,
    GuideForce,
    GuideFriction,
    HingeDamper,
    HingeFriction,
    HingeSpring,
    LinkWeight,
    PointDamper,
    PointForce,
    PointSpring,
    PointWeight,
    SliderFriction,
    Torque,
    numbered_names,
)
from centrode.model.mechanism import FRAME, Mechanism
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.text_formula import TextFormula, compile_formula

# How great a load is: constant, a formula, a spring, a damper, an indicator diagram.

Array: TypeAlias = npt.NDArray[np.float64]
Number: TypeAlias = Any

# most loads have no diagram over a stroke, whose ends need the motion
_strokes = partial(import_module, "centrode.dynamics.strokes")

SLACK = 1e-9
"""A stroke may leave its diagram by this share of the diagram's width: that much is rounding of printed rows."""


class Situation(NamedTuple):
    """What a load may depend on: time, the drive's value, the load's coordinate and its speed.

    `sense` is 1 where the coordinate grows in time, -1 where it falls, 0 where nothing moves. With several drives q
    has no value. `m` has the functions.
    """

    t: Number
    q: Number
    x: Number
    v: Number
    sense: Number
    m: Any


# A law is a force [N] or moment [N m] along its coordinate, and answers for itself: `uses` is which of t, q, x, v it
# depends on; `levels` the values of the coordinate at which it has a kink; `jumps` whether it may jump where the
# coordinate turns round; `depends_on_sense` whether it depends on which way the coordinate goes; `by_place` whether it
# can be represented by the value of the drive, once for each sense; `energy_class` what becomes of its work, and of
# what is stored `energy` how much that is.


class EnergyClass(StrEnum):
    """What becomes of the work of a load."""

    STORED = "stored"
    FRICTION = "friction"
    OTHER = "other"


class ContinuousLaw:
    """A law that never jumps, is the same whichever way its coordinate goes, and has no kink at a value of it.

    The value of the drive does not represent it, as it may depend on time, on the coordinate or on its speed.
    """

    levels: ClassVar[tuple[float, ...]] = ()
    jumps: ClassVar[bool] = False
    depends_on_sense: ClassVar[bool] = False
    by_place: ClassVar[bool] = False


@dataclass(frozen=True)
class Constant(ContinuousLaw):
    """The same always."""

    value: Number
    uses: ClassVar[frozenset[str]] = frozenset()
    energy_class = EnergyClass.OTHER
    by_place = True

    def __call__(self, now: Situation) -> Number:
        return self.value


@dataclass(frozen=True)
class Weight(Constant):
    """A constant force whose work is stored."""

    energy_class = EnergyClass.STORED

    def energy(self, x: Number) -> Number:
        """Potential energy [J] at a value of its coordinate."""
        # a constant force along x has the potential -F x
        return -self.value * x


@dataclass(frozen=True)
class LoadFormula:
    """A text formula of time, drive, coordinate and speed."""

    formula: TextFormula
    levels: tuple[float, ...] = ()
    depends_on_sense: bool = False
    energy_class = EnergyClass.OTHER
    by_place = False

    @classmethod
    def of(cls, text: str, where: str) -> LoadFormula:
        """The formula of a text."""
        return cls(compile_formula(text, LOAD_VARIABLES, where))

    @property
    def uses(self) -> frozenset[str]:
        """Which of t, q, x, v it depends on."""
        return self.formula.used

    @property
    def jumps(self) -> bool:
        """Where its speed changes sign it may."""
        return "v" in self.formula.used

    def __call__(self, now: Situation) -> Number:
        with np.errstate(all="ignore"):
            return self.formula(now.m, t=now.t, q=now.q, x=now.x, v=now.v)


@dataclass(frozen=True)
class TorsionSpring(ContinuousLaw):
    """-k (x - free) along an angle."""

    stiffness: float
    free: float
    uses = frozenset("x")
    energy_class = EnergyClass.STORED

    def energy(self, x: Number) -> Number:
        """Potential energy [J] at a value of its coordinate."""
        return 0.5 * self.stiffness * (x - self.free) ** 2

    def __call__(self, now: Situation) -> Number:
        return -self.stiffness * (now.x - self.free)


@dataclass(frozen=True)
class StraightSpring(ContinuousLaw):
    """-k (l - free), given along half the squared distance: -k (1 - free/l)."""

    stiffness: float
    free: float
    uses = frozenset("x")
    energy_class = EnergyClass.STORED
    by_place = True

    def energy(self, x: Number) -> Number:
        """Potential energy [J] at a value of its coordinate."""
        # the coordinate is half the squared distance, so that it is smooth at length zero
        return 0.5 * self.stiffness * (np.sqrt(2.0 * x) - self.free) ** 2

    def __call__(self, now: Situation) -> Number:
        if self.free == 0.0:
            return -self.stiffness
        with np.errstate(all="ignore"):
            return -self.stiffness * (1.0 - self.free / now.m.sqrt(2.0 * now.x))


@dataclass(frozen=True)
class Damper(ContinuousLaw):
    """-c v along its coordinate."""

    damping: float
    uses = frozenset("v")
    energy_class = EnergyClass.FRICTION

    def __call__(self, now: Situation) -> Number:
        return -self.damping * now.v


@dataclass(frozen=True)
class Friction:
    """Against the motion: a constant or a formula (Coulomb), and parts that grow with the speed and its square."""

    dry: LoadLaw
    viscous: Number = 0.0
    quadratic: Number = 0.0
    levels: tuple[float, ...] = ()
    energy_class = EnergyClass.FRICTION
    by_place = False

    @property
    def uses(self) -> frozenset[str]:
        """Dry friction of a constant asks for the sense of the motion only."""
        none = is_none(self.viscous) and is_none(self.quadratic)
        return self.dry.uses | frozenset("" if none else "v")

    @property
    def jumps(self) -> bool:
        """Dry friction changes its sense at once."""
        return self.depends_on_sense

    @property
    def depends_on_sense(self) -> bool:
        """Whether there is dry friction."""
        return not (isinstance(self.dry, Constant) and self.dry.value == 0.0)

    def __call__(self, now: Situation) -> Number:
        found = -self.viscous * now.v - self.quadratic * now.v * now.m.abs(now.v)
        return found - now.sense * self.dry(now) if self.depends_on_sense else found


@dataclass(frozen=True)
class Square(ContinuousLaw):
    """-a v^2: what the plain sum of the source takes for friction, whichever way the joint turns."""

    quadratic: Number
    uses = frozenset("v")
    energy_class = EnergyClass.FRICTION

    def __call__(self, now: Situation) -> Number:
        return -self.quadratic * now.v * now.v


@dataclass(frozen=True)
class LoadDiagram:
    """Straight lines between the rows of an indicator diagram; one column for each sense of motion, or for both."""

    label: str
    rows: tuple[tuple[float, ...], ...]
    energy_class = EnergyClass.OTHER
    by_place = True

    @property
    def uses(self) -> frozenset[str]:
        """The displacement alone: of the speed only the sense counts."""
        return frozenset("x")

    @property
    def jumps(self) -> bool:
        """From one column to the other."""
        return len(self.rows[0]) > 2

    @property
    def depends_on_sense(self) -> bool:
        """Whether the way back has a column of its own."""
        return len(self.rows[0]) > 2

    @property
    def levels(self) -> tuple[float, ...]:
        """Displacements of its inner rows."""
        return tuple(row[0] for row in self.rows[1:-1])

    def __call__(self, now: Situation) -> Number:
        at, *forces = np.array(self.rows).T
        inside = self._inside(np.asarray(now.x))
        there = np.where(inside, np.interp(now.x, at, forces[0]), np.nan)
        if len(forces) == 1:
            return there
        return np.where(
            np.asarray(now.sense) >= 0.0, there, np.where(inside, np.interp(now.x, at, forces[1]), np.nan)
        )

    def _inside(self, x: Array) -> npt.NDArray[np.bool_]:
        """Where a displacement lies on the diagram; that of an absent position does not."""
        low, high = self.rows[0][0], self.rows[-1][0]
        slack = SLACK * (high - low)
        return np.asarray((x >= low - slack) & (x <= high + slack))

    def refusal(self, x: float) -> InputError:
        """What is said of a displacement beside the diagram."""
        what = _(
            "the stroke reaches {value:.6g} m, and the diagram lies between {low:.6g} m and {high:.6g} m"
        )
        text = what.format(value=x, low=self.rows[0][0], high=self.rows[-1][0])
        return InputError(self.label, text, _("add rows up to the ends of the stroke"))


@dataclass(frozen=True)
class LoadTable(ContinuousLaw):
    """Straight lines between the rows of a table over the value of the drive or over time.

    Attributes
    ----------
    label : of the load, for messages
    rows : (value of the drive [rad or m] or time [s], force [N] or moment [N m])
    of : "q" or "t"
    period : change of the drive's value after which the rows repeat; 0 where they do not
    """

    label: str
    rows: tuple[tuple[float, ...], ...]
    of: str
    period: float = 0.0
    energy_class = EnergyClass.OTHER

    @classmethod
    def over(
        cls, mechanism: Mechanism, label: str, rows: tuple[tuple[float, ...], ...], over: str | None
    ) -> LoadTable:
        """The table of a load; InputError over the drive of a mechanism that has several.

        A table over one or more whole turns of the drive repeats.
        """
        if over == TIME:
            return cls(label, rows, "t")
        drives = mechanism.motion_parameter.drives
        if len(drives) != 1:
            what = _("a table over the drive needs a mechanism with one drive")
            raise InputError(label, what, _("give the force over the displacement or over time"))
        turns = (rows[-1][0] - rows[0][0]) / tau
        whole = drives[0].turns and round(turns) >= 1 and abs(turns - round(turns)) <= SLACK
        return cls(label, rows, "q", round(turns) * tau if whole else 0.0)

    @property
    def uses(self) -> frozenset[str]:
        """The value of the drive, or time."""
        return frozenset(self.of)

    def kinks(self, first: float, last: float) -> list[float]:
        """Values of the drive at the rows of the table, strictly between two; none over time."""
        if self.of != "q":
            return []
        low, high = sorted((first, last))
        places = [row[0] for row in self.rows]
        if self.period:
            numbers = range(
                floor((low - places[-1]) / self.period), ceil((high - places[0]) / self.period) + 1
            )
            places = [place + number * self.period for number in numbers for place in places]
        return [place for place in places if low < place < high]

    def __call__(self, now: Situation) -> Number:
        at, force = np.array(self.rows).T
        place = np.asarray(now.q if self.of == "q" else now.t, dtype=np.float64)
        if self.period:
            place = at[0] + np.mod(place - at[0], self.period)
            return np.interp(place, at, force)
        slack = SLACK * (at[-1] - at[0])
        inside = (place >= at[0] - slack) & (place <= at[-1] + slack)
        return np.where(inside, np.interp(place, at, force), np.nan)

    def refusal(self, place: float) -> InputError:
        """The error at a value of the drive, or at a time, beyond the table."""
        what = _("its table lies between {low:.6g} and {high:.6g}, and its load is needed at {value:.6g}")
        text = what.format(value=place, low=self.rows[0][0], high=self.rows[-1][0])
        return InputError(self.label, text, _("add rows, or choose a shorter range; a whole turn repeats"))


StoredLaw: TypeAlias = Weight | TorsionSpring | StraightSpring
"""What has a potential energy."""
LoadLaw: TypeAlias = StoredLaw | Constant | LoadFormula | Damper | Friction | Square | LoadDiagram | LoadTable


# Loads as efforts: amounts along coordinates, and how great they are in a state.

REST = 64.0 * 2.0**-52
"""A speed counts as zero within this share of what rounding can make of it."""


@dataclass(frozen=True)
class LoadTerm:
    """A load's amount along a coordinate; with a `gate` only where that coordinate grows in time.

    It `works` along another coordinate where the source of a formula has it so, against virtual work.
    """

    coordinate: Coordinate
    amount: LoadLaw
    gate: Coordinate | None = None
    works: Coordinate | None = None

    def strength(self, state: State) -> Number:
        """The force [N] or moment [N m] itself."""
        amount = self.amount(self._situation(state))
        if self.gate is None:
            return amount
        if state.m is JETS:
            return np.where(grows(self.gate, state), amount, 0.0)
        speed = _speed_of_nodes(self.gate, state)
        return state.m.base.where(state.m.base.less(speed, 0.0), 0.0, amount)

    def _situation(self, state: State) -> Situation:
        """What the amount depends on; the coordinate and its speed are not computed, and zero, where it does not."""
        uses = self.amount.uses
        q = np.nan if len(state.mechanism.drives) > 1 else state.parameter
        x = self.coordinate.value(state) if "x" in uses else 0.0
        v = self.coordinate.slope(state).value * state.rate if "v" in uses else 0.0
        sense = self._sense(state) if self.amount.depends_on_sense else 0.0
        return Situation(state.time, q, x, v, sense, state.m.base)

    @property
    def switches(self) -> tuple[Coordinate, ...]:
        """Coordinates at whose turning points the amount may jump."""
        found = (self.gate,) if self.gate is not None else ()
        return (*found, self.coordinate) if self.amount.jumps else found

    @property
    def needs_law(self) -> bool:
        """Whether it depends on how the drive moves in time, and not only on the sense of that."""
        return bool(self.amount.uses & {"t", "v"})

    def along(self, state: State) -> Number:
        """Derivative by the parameter of what it works along."""
        return (self.coordinate if self.works is None else self.works).slope(state).value

    def pulls(self, state: State) -> tuple[Wrench, ...]:
        """What one unit of it does to points and links."""
        return (self.coordinate if self.works is None else self.works).pulls(state)

    def _sense(self, state: State) -> Number:
        if state.m is not JETS:
            return state.m.base.sign(_speed_of_nodes(self.coordinate, state))
        return np.sign(_sign_of_speed(self.coordinate, state))


def grows(coordinate: Coordinate, state: State) -> Number:
    """Where a coordinate grows in time; where it turns, `state.side` decides."""
    return _sign_of_speed(coordinate, state) >= 0.0


def _sign_of_speed(coordinate: Coordinate, state: State) -> Number:
    """A number with the sign of a coordinate's speed; where it turns that on `state.side`, zero at the place itself."""
    slope = coordinate.slope(state)
    speed, bend = slope.value * state.rate, slope.derivative(1) * state.rate
    reach = np.maximum(1.0, np.abs(state.parameter))
    with np.errstate(invalid="ignore"):
        rest = np.abs(slope.value) <= REST * (np.abs(slope.derivative(1)) * reach + state.scale)
    return np.where(rest, bend * state.side, speed)


def _speed_of_nodes(coordinate: Coordinate, state: State) -> Number:
    """The same over expressions, at a place itself: zero where a coordinate turns."""
    m, slope = state.m.base, coordinate.slope(state)
    reach = m.max(1.0, abs(state.parameter))
    rest = abs(slope.value) <= REST * (abs(slope.derivative(1)) * reach + state.scale)
    # of plain numbers the comparison is a plain truth
    speed = slope.value * state.rate
    return (0.0 if rest else speed) if isinstance(rest, bool | np.bool_) else m.where(rest, 0.0, speed)


@dataclass(frozen=True)
class AppliedLoad:
    """A load with the efforts it is made of."""

    label: str
    efforts: tuple[LoadTerm, ...]
    where: str = field(default="", compare=False)

    def moment(self, state: State, known: Number) -> Number:
        """Its reduced moment, or generalised force, by the parameter of the state.

        Raises InputError where it has no finite amount although the positions are `known`.
        """
        return self.along(state, self.strengths(state, known))

    def strengths(self, state: State, known: Number) -> list[Number]:
        """How great each effort is [N or N m]; raises InputError as `moment` does."""
        found = [effort.strength(state) for effort in self.efforts]
        for effort, strength in zip(self.efforts, found, strict=True):
            lacking = known & ~np.isfinite(strength)
            if np.any(lacking):
                raise self._refusal(effort, state, lacking)
        return found

    def _refusal(self, effort: LoadTerm, state: State, lacking: Number) -> InputError:
        """Why an effort has no amount at the first of the samples that lack one."""

        def first(values: Number) -> float:
            return float(np.broadcast_to(values, lacking.shape)[lacking].flat[0])

        if isinstance(effort.amount, LoadDiagram):
            return effort.amount.refusal(first(effort.coordinate.value(state)))
        if isinstance(effort.amount, LoadTable):
            return effort.amount.refusal(first(state.parameter if effort.amount.of == "q" else state.time))
        what = _("it has no finite value at {value:.6g}").format(value=first(state.parameter))
        return InputError(self.where, what, _("correct its formula"))

    def along(self, state: State, strengths: Sequence[Number]) -> Number:
        """What efforts of these strengths do along the parameter of a state: the sum of strength times slope."""
        pairs = zip(self.efforts, strengths, strict=True)
        return sum(strength * effort.along(state) for effort, strength in pairs)


Namespace: TypeAlias = Any


def loads_of(
    mechanism: Mechanism,
    masses: Sequence[Mass],
    given: Given | None = None,
    m: Namespace = ARRAYS,
    described: Sequence[AnyLoad] | None = None,
) -> tuple[AppliedLoad, ...]:
    """Loads of the description, or some of them, then the weights that gravity adds; each with a label of its own.

    Raises
    ------
    InputError
        A weight without direction or amount.
    NotComputedYet
        Coulomb friction.
    """
    loads = mechanism.loads if described is None else described
    labels = _labels(loads, mechanism, masses)
    found = [
        AppliedLoad(label, tuple(_terms_of_load(mechanism, load, masses, where, given, m)), where)
        for label, load in zip(labels, loads, strict=False)
        for where in [f"[[loads]] {label}"]
    ]
    weights = [
        AppliedLoad(
            label, (_weight(mechanism, mass, mass.mass * _strength(mechanism)),), f"[links.{mass.link}]"
        )
        for label, mass in zip(labels[len(loads) :], _masses_with_weight(mechanism, masses), strict=True)
    ]
    return (*found, *weights)


def _masses_with_weight(mechanism: Mechanism, masses: Iterable[Mass]) -> list[Mass]:
    """Links that gravity acts on and whose weight the description does not give itself."""
    if not mechanism.gravity or not _strength(mechanism):
        return []
    given = {load.link for load in mechanism.loads if isinstance(load, LinkWeight)}
    return [mass for mass in masses if mass.weighs and mass.link not in given]


def _labels(loads: Sequence[AnyLoad], mechanism: Mechanism, masses: Iterable[Mass]) -> list[str]:
    weights = [f"weight {mass.link}" for mass in _masses_with_weight(mechanism, masses)]
    return numbered_names([*(load.label for load in loads), *weights])


def _terms_of_load(
    mechanism: Mechanism,
    load: AnyLoad,
    masses: Sequence[Mass],
    where: str,
    given: Given | None,
    m: Namespace,
) -> Iterable[LoadTerm]:
    match load:
        case PointForce():
            return _force(load, where)
        case GuideForce(guide=guide):
            return [LoadTerm(Slide(guide), _amount_along_guide(mechanism, load, where, given))]
        case Torque(value=value, table=rows):
            if rows is not None:
                table = LoadTable.over(mechanism, where, rows, load.over or DRIVE)
                return [LoadTerm(turning_of(mechanism, load, where, measured=False), table)]
            amount = _amount(value, where)
            return [LoadTerm(turning_of(mechanism, load, where, "x" in amount.uses), amount)]
        case PointSpring(stiffness=stiffness, free_length=free):
            first, second = load.points
            return [LoadTerm(HalfSquare(first, second), StraightSpring(stiffness, free or 0.0))]
        case HingeSpring(stiffness=stiffness, free_angle=free):
            turn = turning_of(mechanism, load, where, measured=True)
            return [LoadTerm(turn, TorsionSpring(stiffness, free or 0.0))]
        case PointDamper(damping=damping):
            first, second = load.points
            return [LoadTerm(Distance(first, second), Damper(damping))]
        case HingeDamper(damping=damping):
            return [LoadTerm(turning_of(mechanism, load, where, measured=False), Damper(damping))]
        case LinkWeight():
            return [_weight_of_link(mechanism, load, masses, where, given, m)]
        case PointWeight():
            return [_weight_in_point(mechanism, load, where)]
        case HingeFriction():
            return [_friction_in_hinge(mechanism, load, where)]
        case GuideFriction(guide=guide, value=value, viscous=viscous, quadratic=quadratic):
            dry = _amount(value, where)
            return [LoadTerm(Slide(guide), Friction(dry, viscous or 0.0, quadratic or 0.0))]
        case BearingFriction() | SliderFriction():
            what = _("Coulomb friction needs the reactions")
            repair = _(
                "compute the reactions (ct.reactions, centrode reactions), or give the friction by its value"
            )
            raise NotComputedYet(where, what, repair)
        case _:
            assert_never(load)


def _force(load: PointForce, where: str) -> list[LoadTerm]:
    point, axes = load.point, load.axes
    gate = None if load.while_moving is None else Component(point, load.while_moving, axes)
    if all(isinstance(value, float) for value in load.vector):
        vector = tuple(float(value) for value in load.vector)
        size = hypot(*vector)
        return [LoadTerm(Component(point, vector, axes), Constant(size), gate)] if size else []
    count = len(load.vector)
    units = [tuple(float(i == k) for i in range(count)) for k in range(count)]
    return [
        LoadTerm(Component(point, unit, axes), _amount(value, where), gate)
        for unit, value in zip(units, load.vector, strict=True)
        if value != 0.0
    ]


def _amount_along_guide(
    mechanism: Mechanism, load: GuideForce, where: str, given: Given | None
) -> Constant | LoadFormula | LoadDiagram | LoadTable:
    """A value, an indicator diagram over the displacement or the stroke, or a table over the drive or time."""
    if load.table is None:
        return _amount(load.value, where)
    factor = load.factor
    rows = load.table if factor == 1.0 else tuple((at, *(x * factor for x in row)) for at, *row in load.table)
    if load.over in (DRIVE, TIME):
        return LoadTable.over(mechanism, where, rows, load.over)
    if load.over != STROKE:
        return LoadDiagram(where, rows)
    if given:
        what = _("a table over the stroke is not computed where dimensions vary")
        raise NotComputedYet(where, what, _("give the table over the displacement"))
    least, greatest = _strokes().ends_of_stroke(mechanism, load.guide, where)
    stroke = greatest - least
    if load.measured_from == GREATEST:
        # seen from there the displacement grows on the way back: rows and columns change places
        return LoadDiagram(
            where, tuple((greatest - at * stroke, *reversed(row)) for at, *row in reversed(rows))
        )
    return LoadDiagram(where, tuple((least + at * stroke, *row) for at, *row in rows))


def _friction_in_hinge(mechanism: Mechanism, load: HingeFriction, where: str) -> LoadTerm:
    """Friction of a given size: dry, and parts that grow with the speed and its square."""
    dry = _amount(load.value, where)
    turn = turning_of(mechanism, load, where, "x" in dry.uses)
    if load.form == PLAIN_SUM:
        if len(mechanism.drives) > 1:
            what = _("a plain sum is used for mechanisms with one drive only")
            raise InputError(where, what, _("remove form: virtual work applies to any number of drives"))
        return LoadTerm(turn, Square(load.quadratic or 0.0), works=Travel())
    return LoadTerm(turn, Friction(dry, load.viscous or 0.0, load.quadratic or 0.0))


def _amount(value: float | str | None, where: str) -> Constant | LoadFormula:
    return LoadFormula.of(value, where) if isinstance(value, str) else Constant(value or 0.0)


def _weight_law(value: float | str, where: str) -> Weight | LoadFormula:
    return LoadFormula.of(value, where) if isinstance(value, str) else Weight(value)


def _strength(mechanism: Mechanism) -> float:
    return hypot(*mechanism.gravity) if mechanism.gravity else 0.0


def _down(mechanism: Mechanism, where: str) -> tuple[float, ...]:
    if mechanism.gravity is None or not _strength(mechanism):
        what = _("a weight has no direction without gravity")
        example = "[0, 0, -9.81]" if mechanism.space == "sphere" else "[0, -9.81]"
        raise InputError(where, what, _("give gravity, such as gravity = {example}").format(example=example))
    return mechanism.gravity


def _weight(mechanism: Mechanism, mass: Mass, size: Number) -> LoadTerm:
    return LoadTerm(Component(mass.centre, _down(mechanism, mass.link)), Weight(size))


def _weight_in_point(mechanism: Mechanism, load: PointWeight, where: str) -> LoadTerm:
    down = _down(mechanism, where)
    if load.value is None:
        what = _("a point has no mass of its own")
        raise InputError(where, what, _("give the weight's value, or name a link that has a mass"))
    return LoadTerm(Component(load.point, down, FRAME), _weight_law(load.value, where))


def _weight_of_link(
    mechanism: Mechanism,
    load: LinkWeight,
    masses: Sequence[Mass],
    where: str,
    given: Given | None,
    m: Namespace,
) -> LoadTerm:
    """A weight of its own value, or of mass times gravity, at a link's centre of mass."""
    down = _down(mechanism, where)
    mass = next((mass for mass in masses if mass.link == load.link and mass.weighs), None)
    if load.value is not None:
        at = centre_of(mechanism, load.link, given, m) if mass is None else mass.centre
        return LoadTerm(Component(at, down, FRAME), _weight_law(load.value, where))
    if mass is None:
        what = _("link {link} has no mass").format(link=load.link)
        raise InputError(where, what, _("give its mass, or the weight's value"))
    return _weight(mechanism, mass, mass.mass * _strength(mechanism))


# Masses and loads of a mechanism together: what everything about forces starts from.


@dataclass(frozen=True)
class MassesAndLoads:
    """Masses and loads of a mechanism."""

    masses: tuple[Mass, ...]
    loads: tuple[AppliedLoad, ...]

    @classmethod
    def of(cls, mechanism: Mechanism, given: Given | None = None, m: Namespace = ARRAYS) -> MassesAndLoads:
        """What the description gives; `given` are numbers by their paths in place of its own, `m` has their functions.

        Raises
        ------
        InputError
            Neither masses nor loads, or some that are not complete.
        NotComputedYet
            Coulomb friction.
        """
        return cls._of(mechanism, given, m, mechanism.loads)

    @classmethod
    def for_reactions(
        cls, mechanism: Mechanism, given: Given | None = None, m: Namespace = ARRAYS
    ) -> MassesAndLoads:
        """The same without friction by coefficients, as forces on points and links; InputError for what is no force."""
        loads = [load for load in mechanism.loads if not isinstance(load, CoefficientFriction)]
        return cls._of(mechanism, given, m, loads)._as_forces()

    @classmethod
    def _of(
        cls, mechanism: Mechanism, given: Given | None, m: Namespace, described: Sequence[AnyLoad]
    ) -> MassesAndLoads:
        masses = masses_of(mechanism, given, m)
        loads = loads_of(mechanism, masses, given, m, described)
        if not masses and not loads:
            what = _("there are neither masses nor loads")
            raise InputError("", what, _("give links a mass, or [[loads]]"))
        return cls(masses, loads)

    @classmethod
    def in_plane(cls, mechanism: Mechanism) -> MassesAndLoads:
        """The same as forces on links of the plane; NotComputedYet on the sphere, InputError for what is no force."""
        if mechanism.space == "sphere":
            what = _("force polygons on the sphere are not computed yet")
            raise NotComputedYet("space", what, _("describe a planar mechanism"))
        return cls.of(mechanism)._as_forces()

    def _as_forces(self) -> MassesAndLoads:
        for load in self.loads:
            if any(effort.works is not None for effort in load.efforts):
                what = _("a plain sum is not a moment in a hinge and gives no reactions")
                raise InputError(load.where, what, _("remove form"))
        return self

    @property
    def links(self) -> tuple[str, ...]:
        """Links that have mass or inertia."""
        return tuple(mass.link for mass in self.masses)

    @property
    def labels(self) -> tuple[str, ...]:
        """Names of the loads, weights at the end."""
        return tuple(load.label for load in self.loads)

    @property
    def needs_law(self) -> bool:
        """Whether a load depends on time or on speeds, so that it matters how the drive moves."""
        return any(effort.needs_law for load in self.loads for effort in load.efforts)
