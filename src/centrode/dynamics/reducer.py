"""Masses and loads of a mechanism with one drive, reduced to it at any value of the drive."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import copysign
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.burden import Burden
from centrode.dynamics.inertia import shares
from centrode.dynamics.jumps import jumps_of
from centrode.dynamics.loads import Acting
from centrode.dynamics.states import Moving, State
from centrode.errors import InputError
from centrode.kinematics.branches import Event
from centrode.kinematics.places import Places
from centrode.kinematics.ready import Ready, ready
from centrode.locale import _
from centrode.model.mechanism import Mechanism

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

    def __init__(self, ready: Ready, burden: Burden) -> None:
        if len(ready.mechanism.drives) != 1:
            what = _("it has {n} drives").format(n=len(ready.mechanism.drives))
            raise InputError(
                "[[drives]]", what, _("use ct.reduce, which gives the inertia matrix of several")
            )
        self.ready = ready
        self.burden = burden
        self._places: Places | None = None

    @classmethod
    def of(cls, mechanism: Mechanism) -> Reducer:
        """The reducer of a description with one drive; raises as `ready` and `Burden.of` do."""
        return cls(ready(mechanism), Burden.of(mechanism))

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
        return reduced(self.burden, *self._state(values, self.moving(values, rate, time), side))

    def jumps(self, first: float, last: float, loads: Sequence[Acting] | None = None) -> Array:
        """Values of the drive, in increasing order, at which loads jump or have a kink, between two values.

        Of all loads where none are given.
        """
        low, high = min(first, last), max(first, last)
        if not np.isfinite([low, high]).all():
            raise InputError("jumps", _("the range must be finite"))
        mesh = self._along(np.array([low, high])).mesh
        inner = mesh[(mesh > low) & (mesh < high)]
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
        if mechanism.machine is not None:
            mean = mechanism.machine.mean_speed
            if mean == 0.0:
                raise InputError("[machine] mean_speed", _("its speed is zero"), _("give the mean speed"))
            return copysign(mean, path.forward)
        return path.parameter.constant_speed

    def moving(
        self, values: Array, rate: npt.ArrayLike | None = None, time: npt.ArrayLike | None = None
    ) -> Moving:
        """How the drive passes values, as `at` takes it."""
        path = self.ready.kinematics.path
        speed = self.default_rate if rate is None else np.asarray(rate, dtype=np.float64)
        if speed is None:
            if self.burden.needs_law:
                what = _("loads depend on time or speeds, and the drive is a law of time")
                raise InputError("rate", what, _("give the speed of the drive, or [machine] mean_speed"))
            speed = path.forward
        with np.errstate(all="ignore"):
            elapsed = (values - path.driven[0].start) / speed if time is None else time
        return Moving(
            np.broadcast_to(np.asarray(elapsed, dtype=np.float64), values.shape),
            values,
            np.broadcast_to(np.asarray(speed, dtype=np.float64), values.shape),
        )

    def state(self, values: Array, moving: Moving, side: int = 0) -> tuple[State, npt.NDArray[np.int8]]:
        """Positions with their derivatives at values of the drive, and their statuses (n)."""
        return self._state(values, moving, side)

    def reach(self, first: float, last: float) -> tuple[float, float]:
        """Nearest limits on both sides of the initial position; infinite where none lies between two values."""
        return self._along(np.array([first, last])).continuation.branches.reach(0)

    def events(self, first: float, last: float) -> list[Event]:
        """Limits and change points between two values of the drive."""
        found = self._along(np.array([first, last])).continuation.branches.events
        return [event for event in found if first <= event.at <= last]

    def _along(self, values: Array) -> Places:
        """Places on a stretch of the path with all these values, whose events are known."""
        places = self._places
        if places is None or not (places.mesh[0] <= np.min(values) and np.max(values) <= places.mesh[-1]):
            reach = values if places is None else np.append(values, places.mesh[[0, -1]])
            places = Places.along(self.ready, self.ready.kinematics, reach)
            self._places = places
        return places

    def _state(self, values: Array, moving: Moving, side: int) -> tuple[State, npt.NDArray[np.int8]]:
        samples = self._along(values).at(values)
        path = self.ready.kinematics.path
        state = State.of_samples(self.ready.mechanism, samples, moving, path.scale, side)
        return state, samples.status[0]


def _sense_only(reducer: Reducer, values: Array) -> Moving:
    """Any motion in the sense of the drive: jumps do not depend on how fast it is."""
    ones = np.ones(values.shape)
    return Moving(0.0 * ones, values, reducer.ready.kinematics.path.forward * ones)


def reduced(burden: Burden, state: State, status: npt.NDArray[np.int8]) -> Reduced:
    """A state of one mechanism reduced; InputError for a load without a finite value."""
    count = len(state.parameter)
    inertia, slope = shares(state, burden.masses, (1, count))
    moments = np.empty((len(burden.loads), 1, count))
    # where derivatives exist: nothing is reduced at limits
    known = state.exists
    for k, load in enumerate(burden.loads):
        moments[k] = load.moment(state, known)
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
