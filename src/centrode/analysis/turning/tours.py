"""One drive moved as far as it goes while the others stand still: what questions about turning are asked of."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from math import isfinite, pi, tau
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.jets import Jet
from centrode.kinematics.change_points import BranchedPlan, Smooth
from centrode.kinematics.events import EventScan
from centrode.kinematics.mesh import mesh_of
from centrode.kinematics.path import JETS, OFF_GRID
from centrode.kinematics.plan_evaluation import Event
from centrode.kinematics.prepared import Ready
from centrode.kinematics.sampling import start_of
from centrode.kinematics.several_inputs.limits import check_closed, held_path, starting_at
from centrode.kinematics.solve import SEARCH, TURNS
from centrode.model.mechanism import Drive
from centrode.structure.constraints import Positions

Array: TypeAlias = npt.NDArray[np.float64]
Number: TypeAlias = Any
Namespace: TypeAlias = Any

NODES_PER_TURN = 720
BACK = 1e-6
"""A mechanism is back in its position if no point is further from it than this part of the greatest length."""

ULPS = 4.0
"""A value this many units of the last place from an event is at it."""


@dataclass(frozen=True)
class Tour:
    """The motion of one drive on both sides of the initial position, its events found.

    Attributes
    ----------
    held : values of the other drives [rad or m]
    low, high : nearest limits [rad or m], infinite where there is none within `extent`
    extent : how far they were looked for on both sides
    """

    prepared: Ready
    drive: Drive
    held: Mapping[str, float]
    continuation: BranchedPlan
    low: float
    high: float
    extent: float

    @property
    def initial(self) -> float:
        """The drive's value in the initial position."""
        return self.continuation.kinematics.path.initial

    @property
    def unit(self) -> str:
        """SI unit of the drive's value."""
        return self.prepared.parameter.drive(self.drive.id).unit

    @property
    def angular(self) -> bool:
        """Whether the drive is an angle, so that it could turn."""
        return self.drive.kind == "angle"

    @property
    def unlimited(self) -> bool:
        """Whether no limit was found on either side."""
        return not isfinite(self.low) and not isfinite(self.high)

    @cached_property
    def turns_fully(self) -> bool:
        """Whether the drive is an angle without limits, and every point has its place all over the stretch."""
        return self.angular and self.unlimited and bool(np.isfinite(self.places(self.nodes())).all())

    @cached_property
    def turns(self) -> int | None:
        """Turns of the drive after which every point is back; None where it is limited or not back after two."""
        if not (self.angular and self.unlimited):
            return None
        at = self.places(np.array([self.initial + tau * k for k in range(int(TURNS) + 1)]))
        scale = float(self.continuation.kinematics.numbers.scale)
        for k in range(1, int(TURNS) + 1):
            # a place that is not reached is no number, and not back
            if np.max(np.abs(at[:, k] - at[:, 0]), initial=0.0) <= BACK * scale:
                return k
        return None

    @property
    def span(self) -> tuple[float, float]:
        """The stretch that is looked at: whole turns in the drive's sense until it is back, or between the limits."""
        if self.angular and self.unlimited:
            way = tau * (self.turns or int(TURNS))
            backwards = self.continuation.kinematics.path.forward < 0.0
            return (self.initial - way, self.initial) if backwards else (self.initial, self.initial + way)
        return max(self.low, self.initial - self.extent), min(self.high, self.initial + self.extent)

    @property
    def comes_round(self) -> bool:
        """Whether the stretch ends where it begins."""
        return self.turns is not None and self.turns_fully

    def nodes(self) -> Array:
        """Values at which functions of the drive are looked at: even over turns, denser towards limits."""
        first, last = self.span
        if self.angular and self.unlimited:
            count = NODES_PER_TURN * round((last - first) / tau)
            return np.asarray(first + (np.arange(count + 1) + OFF_GRID) * ((last - first) / count))
        share = 0.5 - 0.5 * np.cos(pi * (np.arange(NODES_PER_TURN) + 0.5) / NODES_PER_TURN)
        return np.asarray(first + (last - first) * share)

    def at(self, values: Array, order: int) -> Positions:
        """Positions (1, n) at values (n,) of the drive, as jets of an order."""
        along = values[None, :]
        with np.errstate(all="ignore"):
            return self.continuation.kinematics.positions(
                JETS, Jet.variable(along, order), self.continuation.hooks(JETS, along, None)
            )

    def stopped(self, value: float, m: Namespace) -> Positions:
        """Positions (1, 1) at any value; of groups that have an event there, the root is zero and not its rounding."""
        along = np.array([[value]])
        margin = ULPS * float(np.spacing(abs(value) + self.continuation.branches.unit))
        zero = frozenset(e.group for e in self.continuation.branches.events if abs(e.at - value) <= margin)
        hooks = _Clamped(self.continuation, m, along, None)
        hooks.zero = zero
        with np.errstate(all="ignore"):
            return self.continuation.kinematics.positions(m, along, hooks)

    def places(self, values: Array) -> Array:
        """Coordinates of all moving points (points * axes, n) at values of the drive."""
        at = self.at(values, 0)
        moving = self.prepared.mechanism.moving_points
        found = [x.value if isinstance(x, Jet) else x for name in moving for x in at.points[name]]
        return np.array([np.broadcast_to(x, (1, len(values)))[0] for x in found])

    def events(self, kind: str) -> list[Event]:
        """Events of a kind within the stretch, each once, in the drive's order."""
        first, last = self.span
        found = [e for e in self.continuation.branches.events if e.kind == kind]
        margin = 1e-9 * self.continuation.branches.unit
        ends = last - margin if self.comes_round else last + margin
        return sorted((e for e in found if first - margin <= e.at <= ends), key=lambda e: (e.at, e.group))


class _Clamped(Smooth):
    """Radicands of groups that stand at an event are zero, and others that rounding makes negative as well."""

    zero: frozenset[int] = frozenset()

    def root(self, group: int, radicand: Number) -> Number:
        return super().root(group, 0.0 * radicand if group in self.zero else np.maximum(radicand, 0.0))


def tour_of(prepared: Ready, drive: str, held: Mapping[str, float]) -> Tour:
    """The tour of one drive about its initial value, the others at the values given.

    Limits are those of a motion to the last bit: they are the events of the same search.
    """
    only = len(prepared.mechanism.drives) == 1
    if only:
        continuation = start_of(prepared, prepared.kinematics)
    else:
        initial = float(prepared.assembled.positions.drives[drive])
        continuation = starting_at(prepared, held_path(prepared, drive, initial, held))
    path = continuation.kinematics.path
    chosen = next(one.drive for one in path.driven if one.drive.id == drive)
    extent = tau * TURNS if chosen.kind == "angle" else SEARCH * path.unit
    ends = np.array([path.initial - extent, path.initial + extent])
    EventScan(continuation, mesh_of(path, ends)).run()
    if not only:
        check_closed(continuation)
    low, high = continuation.branches.reach(0)
    if chosen.kind == "distance":
        low = max(low, 0.0)  # a cylinder is not shorter than zero, whatever its formulas say
    return Tour(prepared, chosen, dict(held), continuation, low, high, extent)
