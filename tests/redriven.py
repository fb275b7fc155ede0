"""One mechanism driven from different links: what a drive of class II tells of the same motion under another drive."""

from __future__ import annotations

import copy
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

import centrode as ct
from centrode.kinematics.ready import ready
from centrode.kinematics.solve import Solved, solve
from centrode.kinematics.spans import span_at
from mechanisms import STEP, Parts, nudged, parts_of

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Redriven:
    """A motion by dyads, and the same mechanism driven by the angle of another link.

    `by_dyads` has the drive of class II, `other` the new one; `stretch` are the values of the first drive between
    which the new drive's angle runs one way, with the initial position `base` inside.
    """

    by_dyads: ct.Mechanism
    other: ct.Mechanism
    link: str
    base: float
    stretch: tuple[float, float]

    def angle(self, base: npt.ArrayLike) -> tuple[Array, Array, Array]:
        """The new drive's value with two derivatives at values of the first drive."""
        data = ct.motion(self.by_dyads, at=np.atleast_1d(np.asarray(base, dtype=float)))
        return _angle(data, self.link)

    def bases(self, values: Array) -> Array:
        """Values of the first drive at values of the new one, inside the stretch (bisection, then Newton)."""
        low, high = (np.full(len(values), end) for end in self.stretch)
        rising = self.angle(high[:1])[0] > self.angle(low[:1])[0]
        for _halving in range(30):
            middle = 0.5 * (low + high)
            short = (self.angle(middle)[0] < values) == rising
            low, high = np.where(short, middle, low), np.where(short, high, middle)
        base = 0.5 * (low + high)
        for _step in range(4):
            value, slope, _bend = self.angle(base)
            base = np.clip(base - (value - values) / slope, low - 1e-6, high + 1e-6)
        return base


def _angle(data: xr.Dataset, link: str) -> tuple[Array, Array, Array]:
    names = ("angle", "angular_velocity_coefficient", "angular_acceleration_coefficient")
    return tuple(data[name].sel(link=link).to_numpy() for name in names)  # type: ignore[return-value]


def redriven(mechanism: ct.Mechanism, link: str, base: float, digits: int = 3) -> Redriven:
    """The mechanism with the angle of another link given, from the position at a value of its own drive.

    The initial angles are rounded to so many digits [rad]; the drive starts at the exact one.
    """
    start = ct.motion(mechanism, at=[base])
    parts = parts_of(mechanism)
    parts.pop("assembly", None)
    parts.pop("study", None)
    new = driven_by(parts, {"link": link, "start": float(start.angle.sel(link=link)[0]), "speed": 1.0})
    for name, entry in new["links"].items():
        entry["angle"] = round(float(start.angle.sel(link=name)[0]), digits)
    new["links"][link].pop("angle")
    return Redriven(mechanism, ct.Mechanism(**new), link, base, _stretch(mechanism, link, base))


def driven_by(parts: Parts, drive: dict[str, Any]) -> Parts:
    """The same description with one other drive."""
    new = copy.deepcopy(parts)
    new["drives"] = [drive]
    return new


def _stretch(mechanism: ct.Mechanism, link: str, base: float) -> tuple[float, float]:
    """Nearest extremes of a link's angle on both sides of a value of the drive, within a turn (bisection)."""
    values = base + np.linspace(-np.pi, np.pi, 721)
    data = ct.motion(mechanism, at=values)
    slope = _angle(data, link)[1]
    sense = np.sign(slope[360])
    found = []
    for way in (-1, 1):
        k = 360
        while 0 < k < 720 and np.sign(slope[k + way]) == sense and data.status[k + way] == ct.Status.OK:
            k += way
        inside, outside = values[k], values[min(max(k + way, 0), 720)]
        for _halving in range(60):
            middle = 0.5 * (inside + outside)
            there = np.sign(_angle(ct.motion(mechanism, at=[middle]), link)[1][0])
            inside, outside = (middle, outside) if there == sense else (inside, middle)
        found.append(float(inside))
    return found[0], found[1]


def reach_of(case: Redriven) -> tuple[float, float]:
    """Least and greatest value of the new drive on the stretch."""
    low, high = sorted(case.angle(case.stretch)[0])
    return float(low), float(high)


def by_chain_rule(case: Redriven, values: Array) -> Array:
    """Positions with two derivatives by the new drive, from the motion by dyads: (3, samples, points, 2)."""
    base = case.bases(values)
    data = ct.motion(case.by_dyads, at=base)
    _value, slope, bend = (x[:, None, None] for x in case.angle(base))
    speed, turn = (data[name].to_numpy() for name in ("velocity_coefficient", "acceleration_coefficient"))
    rate = speed / slope
    return np.stack([data.position.to_numpy(), rate, (turn - rate * bend) / slope**2])


def by_newton(case: Redriven, values: Array) -> tuple[xr.Dataset, Array]:
    """The same by the new drive itself."""
    data = ct.motion(case.other, at=values)
    names = ("position", "velocity_coefficient", "acceleration_coefficient")
    return data, np.stack([data[name].to_numpy() for name in names])


def answer(mechanism: ct.Mechanism, values: Array, tries: int = 4) -> Array:
    """How much positions and derivatives answer to dimensions: (3, samples), as `conditioning` does for dyads."""
    prepared = ready(mechanism)
    numbers, path = prepared.kinematics.numbers, prepared.kinematics.path
    random = np.random.default_rng(11)
    exact = _columns(solve(prepared, span_at(path, values)))
    found = np.zeros((3, len(values)))
    for _ in range(tries):
        changed = nudged(numbers, random).mapped(lambda x: np.array([x]))
        step = STEP * random.choice([-1.0, 1.0]) * np.maximum(np.abs(values), path.unit)
        near = _columns(solve(prepared, span_at(path, values + step), changed, 1))
        found = np.fmax(found, np.max(np.abs(near - exact), axis=2) / STEP)
    return np.maximum(found, 1.0)


def _columns(solved: Solved) -> Array:
    """Places in the greatest length, and angles: (3, samples, columns)."""
    scale = float(np.max(solved.ready.kinematics.numbers.scale))
    places = solved.points[:, 0].reshape(3, len(solved.span.parameter), -1) / scale
    return np.concatenate([places, solved.angles[:, 0]], axis=2)
