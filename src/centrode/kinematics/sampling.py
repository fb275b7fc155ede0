"""Values and derivatives at samples of the path, with a status for each.

Arrays are ordered (derivative, column, lane, sample): what the columns hold, the layout says; lanes are the
mechanisms of a batch.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.jets import Jet
from centrode.algebra.rounding import SAFETY
from centrode.errors import Status
from centrode.kinematics.branches import Branches
from centrode.kinematics.continuation import Continuation, Smooth
from centrode.kinematics.evaluate import Kinematics
from centrode.kinematics.guards import guard_with_bound
from centrode.kinematics.higher_class.places import Judged
from centrode.kinematics.layout import Layout
from centrode.kinematics.paths import JETS
from centrode.structure.constraints import Positions

Array: TypeAlias = npt.NDArray[np.float64]
Lanes: TypeAlias = npt.NDArray[np.intp]
Mask: TypeAlias = npt.NDArray[np.bool_]
Number: TypeAlias = Any

ORDERS = 3
"""Value, first and second derivative."""
SUSPECT = 1e-8
"""Radicands below this fraction of their greatest value are compared with their rounding error."""


@dataclass
class Samples:
    """Columns with their derivatives by the path's parameter, angles likewise, and a status for each sample.

    `followed` names the links whose angles the plan gives with their turns; those of others follow from rotors.
    """

    layout: Layout
    columns: Array
    angles: Array
    status: npt.NDArray[np.int8]
    followed: set[str] = field(default_factory=set)

    def of(self, rows: slice) -> Samples:
        """A view of some mechanisms of the batch."""
        return Samples(self.layout, self.columns[:, :, rows], self.angles[:, :, rows], self.status[rows])

    @property
    def complete(self) -> Mask:
        """Where every number is finite (lanes, n)."""
        # one NaN or infinity makes the sum one, which is cheaper to find than a mask of every number
        with np.errstate(all="ignore"):
            complete: Mask = np.isfinite(self.columns.sum(axis=(0, 1)))
        return complete if complete.all() else np.asarray(np.isfinite(self.columns).all(axis=(0, 1)))


def evaluate_columns(
    continuation: Continuation, samples: Samples, parameter: Array, lanes: Lanes | None = None
) -> Judging:
    """Fill in columns and known angles; returns where groups are open, at a limit, or not converged.

    With `lanes` every parameter belongs to one mechanism of the batch: arrays have (k,) in place of (lanes, n).
    """
    along, layout = parameter if lanes is not None else parameter[None, :], samples.layout
    kinematics = continuation.kinematics if lanes is None else continuation.kinematics.taken(lanes)
    judging = Judging(continuation, along, samples.status.shape, lanes)
    with np.errstate(all="ignore"):
        at = kinematics.positions(JETS, Jet.variable(along, ORDERS - 1), judging)
        fill_columns(kinematics, layout, at, samples.columns)
    judging.opened |= kinematics.path.impossible(parameter)
    for k, link in enumerate(layout.angles):
        if layout.runs_on and link in at.angles:
            fill_number(samples.angles[:, k], at.angles[link])
            samples.followed.add(link)
    return judging


class Judging(Smooth):
    """Notes where groups are open, and where at zero of their radicand."""

    def __init__(
        self, continuation: Continuation, along: Array, shape: tuple[int, ...], lanes: Lanes | None = None
    ) -> None:
        super().__init__(continuation, JETS, along, lanes)
        self.shape = shape
        self.opened, self.zero = np.zeros(shape, dtype=bool), np.zeros(shape, dtype=bool)
        self.lost = np.zeros(shape, dtype=bool)
        self._judged: dict[int, tuple[Mask, Mask]] = {}

    def root(self, group: int, radicand: Number) -> Number:
        sign = self.continuation.branches.sign(group, self.parameter, self.lanes)
        if not isinstance(radicand, Jet):
            radicand = Jet((radicand, *[0.0] * (ORDERS - 1)))
        value = np.broadcast_to(radicand.value, self.shape)
        below = self._at_zero(group, value)
        if below is None:
            if self.continuation.windows_of(group) is None:
                np.logical_or(self.opened, value < 0.0, out=self.opened)
            else:
                self._judged[group] = (value < 0.0, np.zeros(self.shape, dtype=bool))
            return JETS.sqrt(radicand) * sign
        self._judged[group] = ((value < 0.0) & ~below, below)
        return JETS.sqrt(Jet((np.where(below, 0.0, value), *radicand.coefficients[1:]))) * sign

    def judge(self, group: int, judged: Judged) -> None:
        self.lost |= judged.lost
        self._judged[group] = (judged.opened, judged.limit)

    def after(self, group: int, at: Positions) -> None:
        mended = self.continuation.mend(group, at, self.parameter, self.lanes)
        for total, found in zip((self.opened, self.zero), self._judged.pop(group, ()), strict=False):
            for index in mended:
                found[index] = False  # there the motion goes on smoothly
            np.logical_or(total, found, out=total)

    def _at_zero(self, group: int, value: Array) -> Mask | None:
        """Where a radicand is zero within its rounding error; None if nowhere."""
        greatest = self.continuation.branches.largest[group]
        greatest = greatest[:, None] if self.lanes is None else greatest[self.lanes]
        suspects = np.nonzero(np.abs(value) <= SUSPECT * greatest)
        if not len(suspects[0]):
            return None
        if self.lanes is None:
            lanes, parameter = suspects[0], self.parameter[0, suspects[1]]
        else:
            lanes, parameter = self.lanes[suspects[0]], self.parameter[suspects[0]]
        _value, bound = guard_with_bound(self.continuation, group, lanes, parameter)
        zero = np.zeros(value.shape, dtype=bool)
        zero[suspects] = np.abs(value[suspects]) <= SAFETY * bound
        return zero if zero.any() else None


def fill_columns(kinematics: Kinematics, layout: Layout, at: Positions, columns: Array) -> None:
    """Values and derivatives of every column, from jets."""
    for k, number in enumerate(layout.numbers(JETS, kinematics.numbers, at)):
        fill_number(columns[:, k], number)


def fill_number(column: Array, number: Number) -> None:
    """A number with its derivatives (3, lanes, n)."""
    if isinstance(number, Jet):
        column[0], column[1] = number.coefficients[:2]
        np.multiply(number.coefficients[2], 2.0, out=column[2])  # Taylor coefficients are over k!
    else:
        column[0] = number
        column[1:] = 0.0


def sample(
    continuation: Continuation, parameter: Array, samples: Samples, lanes: Lanes | None = None
) -> None:
    """Fill in columns and statuses; with `lanes` as in `evaluate_columns`."""
    judged = evaluate_columns(continuation, samples, parameter, lanes)
    samples.status[judged.zero | ~samples.complete] = Status.SINGULAR
    samples.status[beyond_limits(continuation.branches, parameter, lanes)] = Status.CUT_OFF
    samples.status[judged.lost] = Status.UNCONVERGED
    samples.status[judged.opened] = Status.OPEN


def beyond_limits(branches: Branches, parameter: Array, lanes: Lanes | None = None) -> Mask:
    """Where a mechanism would have to pass a limit: (lanes, n), or (k,) with a lane for each parameter."""
    reach = branches.reaches()
    low, high = (reach[:, :1], reach[:, 1:]) if lanes is None else reach[lanes].T
    margin = 4.0 * np.spacing(np.abs(parameter))
    return np.asarray((parameter < low - margin) | (parameter > high + margin))


def settle(samples: Samples) -> None:
    """Absence is NaN: nothing stands in open samples, and no derivatives in singular ones."""
    if not samples.status.any():
        return  # incomplete samples have a status
    absent = (samples.status == Status.OPEN) | (samples.status == Status.UNCONVERGED)
    for numbers in (samples.columns, samples.angles):
        numbers[:, :, absent] = np.nan
        numbers[1:, :, samples.status == Status.SINGULAR] = np.nan
    samples.columns[~np.isfinite(samples.columns)] = np.nan
