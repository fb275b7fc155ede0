"""Inertial effects of bodies on the frame and on the drive, as sums over bodies in plane motion.

Vectors of the plane are complex numbers x + i y. With momentum P and moment of momentum K of all bodies the force on
the frame is -dP/dt and the moment on it -dK/dt: the joints only hand on what the inertia asks for.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias, TypeVar

import numpy as np
import numpy.typing as npt

from centrode.algebra.jets import Jet
from centrode.dynamics.masses import Mass
from centrode.dynamics.states import Place, State

Array: TypeAlias = npt.NDArray[np.float64]
Complex: TypeAlias = npt.NDArray[np.complex128]
Numbers = TypeVar("Numbers", Array, Complex)


@dataclass(frozen=True)
class Pace:
    """How the path is run through at n samples: its parameter's first two derivatives by time, each (n)."""

    rate: Array
    second_rate: Array

    def second(self, orders: Numbers) -> Numbers:
        """Second derivatives by time of what has value and two derivatives by the parameter (3, ..., n)."""
        found: Numbers = orders[2] * self.rate**2 + orders[1] * self.second_rate
        return found


@dataclass(frozen=True)
class Tracks:
    """Where bodies are: `places` [m] and `angles` [rad] (3, bodies, n), with derivatives by the parameter."""

    places: Complex
    angles: Array


@dataclass(frozen=True)
class Effects:
    """What inertia does at n samples: force and moment on the frame [N, N m], and what the drive must give for it."""

    force: Complex
    moment: Array
    driving: Array

    def __add__(self, other: Effects) -> Effects:
        return Effects(self.force + other.force, self.moment + other.moment, self.driving + other.driving)

    def times(self, factors: Array) -> Effects:
        """Sum of rows (rows, n), each times a factor (rows)."""
        return Effects(factors @ self.force, factors @ self.moment, factors @ self.driving)


def tracks_of(state: State, masses: Sequence[Mass]) -> Tracks:
    """Centres of mass and angles of links."""
    count = len(state.parameter)
    return Tracks(
        np.array([track(state.centre(mass.centre), count) for mass in masses]).swapaxes(0, 1),
        np.array([orders(state.angle(mass.link), count) for mass in masses]).swapaxes(0, 1),
    )


def track(place: Place, count: int) -> Complex:
    """A place with two derivatives (3, n)."""
    return np.asarray(orders(place[0], count) + 1j * orders(place[1], count))


def orders(jet: Jet, count: int) -> Array:
    """A number with two derivatives (3, n)."""
    return np.array([np.broadcast_to(np.squeeze(jet.derivative(k)), (count,)) for k in range(3)])


def effects_of(tracks: Tracks, masses: Sequence[Mass], pace: Pace, about: complex) -> Effects:
    """Force, moment about a fixed place and driving moment that the inertia of links makes.

    With J the inertia reduced to the parameter q, the drive must give J q'' + (dJ/dq) q'^2 / 2.
    """
    mass = np.array([one.mass for one in masses])
    inertia = np.array([one.inertia for one in masses])
    (place, first, second), angles = tracks.places, tracks.angles
    acceleration = pace.second(tracks.places)
    turning = pace.second(angles)
    reduced = mass @ np.abs(first) ** 2 + inertia @ angles[1] ** 2
    slope = mass @ (np.conj(first) * second).real + inertia @ (angles[1] * angles[2])
    return Effects(
        -(mass @ acceleration),
        -(mass @ cross(place - about, acceleration) + inertia @ turning),
        reduced * pace.second_rate + slope * pace.rate**2,
    )


def sizes_of(tracks: Tracks, masses: Sequence[Mass], pace: Pace, about: complex) -> tuple[float, float]:
    """Greatest force and moment if no link took anything from another: what rounding is a share of."""
    mass = np.array([one.mass for one in masses])
    inertia = np.array([one.inertia for one in masses])
    acceleration = np.abs(pace.second(tracks.places))
    moment = mass @ (np.abs(tracks.places[0] - about) * acceleration)
    moment = moment + inertia @ np.abs(pace.second(tracks.angles))
    return float(np.nanmax(mass @ acceleration)), float(np.nanmax(moment))


def cross(a: Complex, b: Complex) -> Array:
    """The vector product's component across the plane."""
    return np.asarray((np.conj(a) * b).imag)
