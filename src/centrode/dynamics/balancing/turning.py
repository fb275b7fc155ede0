"""A whole cycle of a mechanism: what its inertia does at any value of the drive, and how great that gets."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import tau
from typing import TypeAlias

import numpy as np

from centrode.dynamics.balancing.inertial import (
    Array,
    Effects,
    Tracks,
    effects_of,
    sizes_of,
    tracks_of,
)
from centrode.dynamics.balancing.instants import Instants, Speed, does_not_turn, turns_of_cycle
from centrode.dynamics.masses import Mass, masses_of
from centrode.dynamics.states import State
from centrode.errors import InputError
from centrode.locale import _
from centrode.model.mechanism import Mechanism
from centrode.numerics.search import tops

Curve: TypeAlias = Callable[[Array], Array]

NODES_PER_TURN = 360
NEAR = 0.02
"""Share of the greatest value at the nodes within which another top may be the greater one between them."""
MOST_TOPS = 40


@dataclass(frozen=True)
class Turning:
    """A cycle of a mechanism with masses.

    Attributes
    ----------
    turns : int
        Whole turns of the drive until everything repeats.
    about : complex [m]
        The place that moments are taken about.
    """

    instants: Instants
    masses: tuple[Mass, ...]
    turns: int
    about: complex

    @classmethod
    def of(
        cls,
        mechanism: Mechanism,
        about: complex,
        speed: Speed = "mean",
        carriers: Sequence[tuple[str, str]] = (),
    ) -> Turning:
        """The cycle of a mechanism, and of what stands on carriers; raises as `Instants.of` and `turns_of_cycle`."""
        masses = heavy(mechanism)
        instants = Instants.of(mechanism, speed)
        return cls(instants, masses, turns_of_cycle(instants, masses, carriers), about)

    @property
    def first(self) -> float:
        """The drive's value at the beginning [rad]."""
        return self.instants.ready.kinematics.path.initial

    @property
    def period(self) -> float:
        """Angle of the drive in a cycle, with the sign in which it turns [rad]."""
        return self.instants.ready.kinematics.path.forward * tau * self.turns

    def values(self, count: int) -> Array:
        """Values of the drive evenly over the cycle; the end, which is the beginning again, is left out."""
        return self.first + self.period * np.arange(count) / count

    @property
    def nodes(self) -> Array:
        """Values of the drive at which a first look is taken."""
        return self.values(NODES_PER_TURN * self.turns)

    @cached_property
    def sizes(self) -> tuple[float, float]:
        """Greatest force [N] and moment [N m] if no link took anything from another."""
        _state, tracks = self.at(self.nodes)
        return sizes_of(tracks, self.masses, self.instants.pace(self.nodes), self.about)

    def at(self, values: Array) -> tuple[State, Tracks]:
        """Where the masses are at values of the drive; MotionError where the mechanism has no motion."""
        state = self.instants.state(values)
        tracks = tracks_of(state, self.masses)
        missing = ~np.isfinite(tracks.places.sum(axis=(0, 1)) + tracks.angles.sum(axis=(0, 1)))
        if missing.any():
            raise does_not_turn(float(values[missing][0]))
        return state, tracks

    def effects(self, values: Array) -> Effects:
        """What the inertia does at values of the drive; raises as `at`."""
        _state, tracks = self.at(values)
        return effects_of(tracks, self.masses, self.instants.pace(values), self.about)


@dataclass(frozen=True)
class Top:
    """The greatest value of a curve over a cycle, and the drive's value there [rad]."""

    value: float
    at: float


def heavy(mechanism: Mechanism) -> tuple[Mass, ...]:
    """Links with mass or inertia; InputError where there are none."""
    masses = masses_of(mechanism)
    if not masses:
        what = _("no link has a mass, so there is no inertia force")
        raise InputError("[links]", what, _("give links a mass, with centre and inertia"))
    return masses


def tops_of(curve: Curve, nodes: Array) -> tuple[Array, Array]:
    """Places and values of the tops of a periodic curve that come near its greatest value.

    `nodes` are evenly over a cycle. Two tops between neighbouring nodes are missed.
    """
    return tops(curve, nodes, near=NEAR, most=MOST_TOPS, period=True)


def top(curve: Curve, nodes: Array) -> Top:
    """The greatest value of a periodic curve: exact to rounding, its place to some 1e-8 of a turn."""
    places, values = tops_of(curve, nodes)
    best = int(np.argmax(values))
    return Top(float(values[best]), float(places[best]))
