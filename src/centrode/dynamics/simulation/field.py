"""What moves a mechanism at a time, a value and a rate of its drive: its acceleration and the powers of what acts."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import isnan
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.text import SCALARS
from centrode.dynamics.amounts import Situation
from centrode.dynamics.simulation.driving import Driving
from centrode.dynamics.simulation.rows import (
    BACKWARDS,
    EACH,
    FORMULAS,
    FORWARDS,
    GATE,
    INERTIA,
    SLOPE,
    SPEED,
)
from centrode.dynamics.simulation.sorts import FRICTION, OTHER, SORTS, STORED, of_time
from centrode.dynamics.simulation.tracks import Tracks
from centrode.dynamics.steady_motion.quadrature import NODES
from centrode.errors import MotionError
from centrode.locale import _
from centrode.model.simulations import MOST_TURNS

Array: TypeAlias = npt.NDArray[np.float64]
Number: TypeAlias = Any

NAN = float("nan")
CREEP = 1e-200
"""Rate that stands for rest about to be left: formulas see its sign and nothing else."""
NUDGE = 1e-11
"""Distance from an end of a leg, over the value, that is rounding."""
_ORDERS = np.arange(NODES)


@dataclass(frozen=True)
class Forces:
    """At one instant or at many: inertia, its slope, moments by sort, that of the drive; all by the drive's value."""

    inertia: Number
    slope: Number
    stored: Number
    friction: Number
    other: Number
    driving: Number

    @property
    def row(self) -> tuple[Number, ...]:
        """All of them, in this order."""
        return self.inertia, self.slope, self.stored, self.friction, self.other, self.driving

    def acceleration(self, rate: Number) -> Number:
        """Second derivative of the drive's value by time."""
        moment = self.stored + self.friction + self.other + self.driving
        return (moment - 0.5 * self.slope * rate * rate) / self.inertia


@dataclass(frozen=True)
class Leg:
    """A range of the drive's value without jumps, passed in one sense or, where that does not matter, in both.

    Attributes
    ----------
    low, high : ends of the range
    sense : +1.0 or -1.0
    edges : of the panels there; values there are those of the drive plus `shift`
    powers : (panels, rows, NODES)
    grown : (rows)
        What coordinates have grown by in the periods before.
    gates : for each formula whether it acts
    senses : for each formula whether its coordinate grows (+1.0) or falls (-1.0)
    """

    low: float
    high: float
    sense: float
    edges: Sequence[float]
    powers: Array
    shift: float
    grown: Array | None
    gates: tuple[bool, ...] = ()
    senses: tuple[float, ...] = ()

    def rows(self, value: float) -> Array:
        """All rows at a value; beyond the ends those at the end."""
        inside = min(max(value, self.low), self.high) + self.shift
        edges = self.edges
        panel = min(max(bisect_right(edges, inside) - 1, 0), len(edges) - 2)
        low, high = edges[panel], edges[panel + 1]
        # a stretch that begins where the motion ends is empty
        share = (2.0 * inside - low - high) / (high - low) if high > low else 0.0
        found: Array = self.powers[panel] @ share**_ORDERS
        return found if self.grown is None else found + self.grown


class Field:
    """A mechanism with its drive, left to itself."""

    def __init__(self, tracks: Tracks, driving: Driving) -> None:
        self.tracks = tracks
        self.driving = driving
        self._last: Leg | None = None

    @cached_property
    def turns_count(self) -> bool:
        """Whether it matters in which sense the drive moves, so that a standstill is an event."""
        rows = self.tracks.rows
        return self.driving.of_speed or any(one.one_sided for one in rows.efforts)

    @cached_property
    def of_time(self) -> bool:
        """Whether anything depends on time."""
        return self.driving.of_time or of_time(self.tracks.rows.efforts)

    def is_too_far(self, value: float, start: float) -> bool:
        """Whether a value lies more turns from the start than one simulation makes."""
        return not abs(value - start) <= MOST_TURNS * self.tracks.length * (1.0 + 1e-12)

    def leg(self, value: float, sense: float) -> Leg:
        """The leg on which a value lies for a motion in one sense; at a jump the one that lies ahead."""
        tracks, upwards = self.tracks, sense > 0.0
        # a value at an end, but for rounding, lies on what is ahead
        ahead = value + sense * NUDGE * max(tracks.unit, abs(value))
        number, periods = tracks.place(ahead, upwards)
        stretch = tracks.stretch(number)
        shift = -periods * tracks.period
        low, high = float(stretch.edges[0]), float(stretch.edges[-1])
        ends = [low, *(float(x) for x in stretch.jumps if low < x < high), high]
        inside = ahead + shift
        k = bisect_right(ends, inside) - 1 if upwards else int(np.searchsorted(ends, inside)) - 1
        k = min(max(k, 0), len(ends) - 2)
        grown = tracks.grown(periods) if periods else None
        edges = [float(x) for x in stretch.edges]
        leg = Leg(ends[k] - shift, ends[k + 1] - shift, sense, edges, stretch.powers, shift, grown)
        middle = leg.rows(0.5 * (leg.low + leg.high))
        formulas = tracks.rows.formulas
        grows = [middle[FORMULAS + EACH * j :] * sense >= 0.0 for j in range(len(formulas))]
        gates = tuple(
            bool(up[GATE]) or one.effort.gate is None for up, one in zip(grows, formulas, strict=True)
        )
        return replace(leg, gates=gates, senses=tuple(1.0 if up[SPEED] else -1.0 for up in grows))

    def leg_at(self, value: float, sense: float) -> Leg:
        """The same, remembered as long as values stay on it."""
        last = self._last
        if last is None or last.sense != sense or not last.low <= value < last.high:
            last = self._last = self.leg(value, sense)
        return last

    def forces(self, leg: Leg, t: float, value: float, rate: float) -> Forces:
        """What acts at an instant; NaN where a formula has no value."""
        t, value, rate = (
            float(t),
            float(value),
            float(rate),
        )  # a plain number divided by zero is an error, no infinity
        rows = leg.rows(value)
        first = FORWARDS if leg.sense > 0.0 else BACKWARDS
        moments = dict(zip(SORTS, rows[first : first + len(SORTS)].tolist(), strict=True))
        for j, one in enumerate(self.tracks.rows.formulas):
            if not leg.gates[j]:
                continue
            x, slope, along = rows[FORMULAS + EACH * j : FORMULAS + EACH * j + GATE].tolist()
            if one.effort.works is not None:
                along *= leg.sense  # it resists the drive, whichever way
            now = Situation(t, value, x, slope * rate, leg.senses[j], SCALARS)
            try:
                moments[one.sort] += float(one.effort.amount(now)) * along
            except (ArithmeticError, ValueError):
                moments[one.sort] = NAN
        return Forces(
            float(rows[INERTIA]),
            float(rows[SLOPE]),
            moments[STORED],
            moments[FRICTION],
            moments[OTHER],
            self.driving.at(t, value, rate),
        )

    def leaving(self, t: float, value: float) -> float:
        """In which sense the drive leaves a standstill: +1.0, -1.0, or 0.0 where it sticks."""
        ahead = self.forces(self.leg(value, 1.0), t, value, CREEP).acceleration(0.0)
        behind = self.forces(self.leg(value, -1.0), t, value, -CREEP).acceleration(0.0)
        if ahead > 0.0 and not (behind < 0.0 and self.driving.sense < 0.0):
            return 1.0
        if behind < 0.0:
            return -1.0
        if isnan(ahead) or isnan(behind):
            raise without_value(t, value)
        return 0.0


def too_far(t: float) -> MotionError:
    """More turns than one simulation makes."""
    return MotionError(
        "[simulation]",
        _("it has made more than {most} turns at t = {time:.6g} s").format(most=MOST_TURNS, time=t),
        _("give a shorter duration, or a drive that does not run away; of fixed steps take more"),
    )


def without_value(t: float, value: float) -> MotionError:
    """Drive or loads have no finite value somewhere."""
    return MotionError(
        "[simulation]",
        _("drive or loads have no finite value at t = {time:.6g} s, drive at {value:.6g}").format(
            time=t, value=value
        ),
        _("correct their formulas"),
    )
