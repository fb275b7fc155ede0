"""How great a load is: constant, a formula, a spring, a damper, an indicator diagram."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.text import TextFormula, compile_formula
from centrode.errors import InputError
from centrode.locale import _
from centrode.model.loads import LOAD_VARIABLES

Array: TypeAlias = npt.NDArray[np.float64]
Number: TypeAlias = Any

SLACK = 1e-9
"""A stroke may leave its diagram by this share of the diagram's width: that much is rounding of printed rows."""


@dataclass(frozen=True)
class Situation:
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


class Amount(Protocol):
    """A force [N] or moment [N m] along its coordinate."""

    @property
    def uses(self) -> frozenset[str]:
        """Which of t, q, x, v it depends on."""

    @property
    def levels(self) -> tuple[float, ...]:
        """Values of the coordinate at which it has a kink."""

    @property
    def jumps(self) -> bool:
        """Whether it may jump where the coordinate turns round."""

    @property
    def sensed(self) -> bool:
        """Whether it asks which way the coordinate goes."""

    def __call__(self, now: Situation) -> Number:
        """Its value."""


@dataclass(frozen=True)
class Constant:
    """The same always."""

    value: Number
    uses: frozenset[str] = frozenset()
    levels: tuple[float, ...] = ()
    jumps: bool = False
    sensed: bool = False

    def __call__(self, now: Situation) -> Number:
        return self.value


@dataclass(frozen=True)
class Formula:
    """A text formula of time, drive, coordinate and speed."""

    formula: TextFormula
    levels: tuple[float, ...] = ()
    sensed: bool = False

    @classmethod
    def of(cls, text: str, where: str) -> Formula:
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
class TorsionSpring:
    """-k (x - free) along an angle."""

    stiffness: float
    free: float
    uses: frozenset[str] = frozenset("x")
    levels: tuple[float, ...] = ()
    jumps: bool = False
    sensed: bool = False

    def __call__(self, now: Situation) -> Number:
        return -self.stiffness * (now.x - self.free)


@dataclass(frozen=True)
class StraightSpring:
    """-k (l - free), given along half the squared distance: -k (1 - free/l)."""

    stiffness: float
    free: float
    uses: frozenset[str] = frozenset("x")
    levels: tuple[float, ...] = ()
    jumps: bool = False
    sensed: bool = False

    def __call__(self, now: Situation) -> Number:
        if self.free == 0.0:
            return -self.stiffness
        with np.errstate(all="ignore"):
            return -self.stiffness * (1.0 - self.free / now.m.sqrt(2.0 * now.x))


@dataclass(frozen=True)
class Damper:
    """-c v along its coordinate."""

    damping: float
    uses: frozenset[str] = frozenset("v")
    levels: tuple[float, ...] = ()
    jumps: bool = False
    sensed: bool = False

    def __call__(self, now: Situation) -> Number:
        return -self.damping * now.v


@dataclass(frozen=True)
class Friction:
    """Against the motion: a constant or a formula (Coulomb), and parts that grow with the speed and its square."""

    dry: Amount
    viscous: Number = 0.0
    quadratic: Number = 0.0
    levels: tuple[float, ...] = ()

    @property
    def uses(self) -> frozenset[str]:
        """Dry friction of a constant asks for the sense of the motion only."""
        return self.dry.uses | frozenset("v" if self.viscous or self.quadratic else "")

    @property
    def jumps(self) -> bool:
        """Dry friction changes its sense at once."""
        return self.sensed

    @property
    def sensed(self) -> bool:
        """Whether there is dry friction."""
        return not (isinstance(self.dry, Constant) and self.dry.value == 0.0)

    def __call__(self, now: Situation) -> Number:
        found = -self.viscous * now.v - self.quadratic * now.v * now.m.abs(now.v)
        return found - now.sense * self.dry(now) if self.sensed else found


@dataclass(frozen=True)
class Square:
    """-a v^2: what the plain sum of the source takes for friction, whichever way the joint turns."""

    quadratic: Number
    uses: frozenset[str] = frozenset("v")
    levels: tuple[float, ...] = ()
    jumps: bool = False
    sensed: bool = False

    def __call__(self, now: Situation) -> Number:
        return -self.quadratic * now.v * now.v


@dataclass(frozen=True)
class Diagram:
    """Straight lines between the rows of an indicator diagram; one column for each sense of motion, or for both."""

    label: str
    rows: tuple[tuple[float, ...], ...]

    @property
    def uses(self) -> frozenset[str]:
        """The displacement alone: of the speed only the sense counts."""
        return frozenset("x")

    @property
    def jumps(self) -> bool:
        """From one column to the other."""
        return len(self.rows[0]) > 2

    @property
    def sensed(self) -> bool:
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
