"""From integrated states to angles, places and displacements with their rates, as a motion has them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.equations.cauchy import CauchyForm
from centrode.equations.integration import Trajectory
from centrode.kinematics.prepared import Ready
from centrode.model.mechanism import FRAME, Mechanism
from centrode.structure.dimensions import Dimensions

Array: TypeAlias = npt.NDArray[np.float64]

STENCIL = np.array([-3.0, -2.0, -1.0, 1.0, 2.0, 3.0])
WEIGHTS = np.array([-1.0, 9.0, -45.0, 45.0, -9.0, 1.0]) / 60
STRIDE = 0.01
"""Step of the sixth-order differences along the rates [rad]: both errors stay near 1e-14 of a great value."""


@dataclass(frozen=True)
class Course:
    """Rows of an integrated motion.

    `angles` and `spins` (n, links), `points` and `velocities` (n, points, 2), `slides` and `slips` (n, guides);
    NaN where there is no state, or where the equations say nothing of a point.
    """

    angles: Array
    spins: Array
    points: Array
    velocities: Array
    slides: Array
    slips: Array


def course_of(prepared: Ready, closed: xr.Dataset, form: CauchyForm, found: Trajectory) -> Course:
    """Everything a state tells; names and their order are those of the motion in closed form."""
    times = closed["time"].to_numpy()
    angles, spins = (
        _turning(prepared.mechanism, form, columns, closed[name].to_numpy())
        for name, columns in (("angle", found.state), ("angular_velocity", found.rates))
    )
    names = [str(name) for name in closed["point"].to_numpy()]
    places = _places(form, names, prepared.kinematics.numbers)
    reached = np.isfinite(found.state).all(axis=1)
    points, velocities = np.full((2, len(times), len(names), 2), np.nan)
    if reached.any():
        points[reached] = places(times[reached], found.state[reached])
        rates = found.rates[reached]
        step = STRIDE / _pace(prepared, form, rates)
        velocities[reached] = _speeds(places, times[reached], found.state[reached], rates, step)
    seen = _Seen(prepared.mechanism, prepared.kinematics.numbers, names, angles, spins, points, velocities)
    slides, slips = np.full((2, len(times), len(prepared.mechanism.guides)), np.nan)
    for column, guide in enumerate(prepared.mechanism.guides):
        if f"slide.{guide.id}" in form.names:
            which = form.names.index(f"slide.{guide.id}")
            slides[:, column], slips[:, column] = found.state[:, which], found.rates[:, which]
        else:
            slides[:, column], slips[:, column] = seen.along(guide.id, guide.point)
    return Course(angles, spins, points, velocities, slides, slips)


def _turning(mechanism: Mechanism, form: CauchyForm, columns: Array, closed: Array) -> Array:
    """Angles of all links, or their rates.

    What is no unknown turns against another body as its drive says, or not at all: that difference is taken from the
    motion in closed form, where it is the law itself.
    """
    names = mechanism.link_names
    found: dict[str, Array] = {FRAME: np.zeros(len(columns))}
    reached = np.where(np.isfinite(columns).all(axis=1), 0.0, np.nan)

    def angle(link: str) -> Array:
        if link not in found:
            if f"angle.{link}" in form.names:
                found[link] = columns[:, form.names.index(f"angle.{link}")]
            else:
                base = base_of(mechanism, link)
                known = 0.0 if base == FRAME else closed[:, names.index(base)]
                found[link] = angle(base) + closed[:, names.index(link)] - known + reached
        return found[link]

    return np.stack([angle(link) for link in names], axis=1)


def base_of(mechanism: Mechanism, link: str) -> str:
    """The body against which a link's angle is given: by its drive, or by a guide that keeps it from turning."""
    for drive in mechanism.drives:
        if drive.link == link:
            return drive.relative_to
    return next((guide.on for guide in mechanism.guides if guide.link == link), FRAME)


Places: TypeAlias = Callable[[Array, Array], Array]


def _places(form: CauchyForm, names: list[str], numbers: Dimensions) -> Places:
    """Places of all points of states, in the order of the names; those of the frame stand still."""
    frame = {name: np.array(place) for name, place in numbers.frame.items()}
    nowhere = np.full(2, np.nan)

    def places(times: Array, states: Array) -> Array:
        known = form.positions(times, states)
        every = [known.get(name, frame.get(name, nowhere)) for name in names]
        return np.stack([np.broadcast_to(one, (len(times), 2)) for one in every], axis=1)

    return places


def _pace(prepared: Ready, form: CauchyForm, rates: Array) -> Array:
    """How fast the mechanism moves at rows of rates [rad/s, and parts of the greatest length]: (n,).

    A law of time may rest and yet turn within a second, so that with one a second is the longest time.
    """
    scale = float(prepared.kinematics.numbers.scale)
    sizes = np.array([scale if name.startswith("slide.") else 1.0 for name in form.names])
    speed, least = prepared.parameter.constant_speed, 1.0
    if speed:
        least = abs(speed) / (1.0 if prepared.parameter.turns else scale)
    return np.asarray(np.maximum(least, (np.abs(rates) / sizes).max(axis=1, initial=0.0)))


def _speeds(places: Places, times: Array, states: Array, rates: Array, step: Array) -> Array:
    """Velocities of all points: derivatives of their places along the rates, by steps of time."""
    moved = sum(
        weight * places(times + shift * step, states + (shift * step)[:, None] * rates)
        for shift, weight in zip(STENCIL, WEIGHTS, strict=True)
    )
    return np.asarray(moved / step[:, None, None])


@dataclass(frozen=True)
class _Seen:
    """What displacements along guides are measured by."""

    mechanism: Mechanism
    numbers: Dimensions
    names: list[str]
    angles: Array
    spins: Array
    points: Array
    velocities: Array

    def along(self, guide: str, point: str) -> tuple[Array, Array]:
        """Displacement and its rate of a point along the line of a guide."""
        body = self.numbers.bodies[guide]
        direction, through = np.array(self.numbers.direction[guide]), np.array(self.numbers.through[guide])
        at, velocity = self._point(point)
        if body == FRAME:
            return (at - through) @ direction, velocity @ direction
        link = self.mechanism.link_names.index(body)
        turn, spin = self.angles[:, link], self.spins[:, link]
        axis, across = _turned(turn, direction), _turned(turn, np.array([-direction[1], direction[0]]))
        pole, local = next(iter(self.numbers.local[body].items()))
        start, start_velocity = self._point(pole)
        arm = _turned(turn, through - np.array(local))
        away = at - start - arm
        away_velocity = velocity - start_velocity - spin[:, None] * np.stack([-arm[:, 1], arm[:, 0]], axis=1)
        slide = np.sum(away * axis, axis=1)
        return slide, np.sum(away_velocity * axis, axis=1) + spin * np.sum(away * across, axis=1)

    def _point(self, name: str) -> tuple[Array, Array]:
        column = self.names.index(name)
        return self.points[:, column], self.velocities[:, column]


def _turned(angles: Array, vector: Array) -> Array:
    """A vector turned by angles: (n, 2)."""
    cosine, sine = np.cos(angles), np.sin(angles)
    return np.stack([cosine * vector[0] - sine * vector[1], sine * vector[0] + cosine * vector[1]], axis=1)
