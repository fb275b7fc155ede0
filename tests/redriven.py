"""One mechanism driven from different links: what a drive of class II tells of the same motion under another drive."""

from __future__ import annotations

import copy
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

import centrode as ct
from centrode.kinematics.path import grid_at
from centrode.kinematics.preparation import Ready, ready
from centrode.kinematics.solve import Solved, solve
from centrode.structure.dimensions import Dimensions
from mechanisms import STEP, Parts, nudged, parts_of

Array = npt.NDArray[np.float64]
PARTS = 64
"""Into how many pieces a stretch is cut at once: places cost little beside the search for events of each call."""


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

    @cached_property
    def _prepared(self) -> Ready:
        return ready(self.by_dyads)

    def angle(self, base: npt.ArrayLike) -> tuple[Array, Array, Array]:
        """The new drive's value with two derivatives at values of the first drive."""
        return _angles(self._prepared, self.link, np.atleast_1d(np.asarray(base, dtype=float)))

    def bases(self, values: Array) -> Array:
        """Values of the first drive at values of the new one, by ever shorter pieces of the stretch, then Newton."""
        low, high = (np.full(len(values), end) for end in self.stretch)
        first, last = self.angle(self.stretch)[0]
        rising = last > first
        rows, shares = np.arange(len(values)), np.linspace(0.0, 1.0, PARTS + 1)
        for _cut in range(5):
            nodes = low[:, None] + (high - low)[:, None] * shares
            found = self.angle(nodes[:, 1:-1].ravel())[0].reshape(len(values), -1)
            passed = ((found < values[:, None]) == rising).sum(axis=1)
            low, high = nodes[rows, passed], nodes[rows, passed + 1]
        base = 0.5 * (low + high)
        for _step in range(4):
            value, slope, _bend = self.angle(base)
            base = np.clip(base - (value - values) / slope, low - 1e-6, high + 1e-6)
        return base


def _angles(prepared: Ready, link: str, base: Array) -> tuple[Array, Array, Array]:
    solved = solve(prepared, grid_at(prepared.kinematics.path, base))
    angles = solved.angles[:, 0, :, solved.layout.links.index(link)]
    return angles[0], angles[1], angles[2]


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
    """Nearest extremes of a link's angle on both sides of a value of the drive, by ever shorter pieces of a turn."""
    prepared = ready(mechanism)
    values = base + np.linspace(-np.pi, np.pi, 721)
    solved = solve(prepared, grid_at(prepared.kinematics.path, values))
    slope = solved.angles[1, 0, :, solved.layout.links.index(link)]
    sense = np.sign(slope[360])
    ends = []
    for way in (-1, 1):
        k = 360
        while 0 < k < 720 and np.sign(slope[k + way]) == sense and solved.status[0, k + way] == ct.Status.OK:
            k += way
        ends.append((values[k], values[min(max(k + way, 0), 720)]))
    shares = np.linspace(0.0, 1.0, PARTS + 1)
    for _cut in range(10):
        nodes = np.array([inside + (outside - inside) * shares for inside, outside in ends])
        there = np.sign(_angles(prepared, link, nodes[:, 1:-1].ravel())[1]).reshape(2, -1)
        kept = [int(np.argmin([*(row == sense), False])) for row in there]
        ends = [(float(row[k]), float(row[k + 1])) for row, k in zip(nodes, kept, strict=True)]
    return ends[0][0], ends[1][0]


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
    exact = _columns(solve(prepared, grid_at(path, values)), 0)
    found = np.zeros((3, len(values)))
    changed: dict[float, list[Dimensions]] = {}
    for _ in range(tries):
        one = nudged(numbers, random)
        changed.setdefault(float(random.choice([-1.0, 1.0])), []).append(one)
    for sense, some in changed.items():
        step = STEP * sense * np.maximum(np.abs(values), path.unit)
        # mechanisms of a batch do not know of each other, so all with one step are solved together
        near = solve(prepared, grid_at(path, values + step), _together(some), len(some))
        for lane in range(len(some)):
            found = np.fmax(found, np.max(np.abs(_columns(near, lane) - exact), axis=2) / STEP)
    return np.maximum(found, 1.0)


def _together(some: list[Dimensions]) -> Dimensions:
    """Numbers of several mechanisms of one structure as those of a batch."""
    rows: list[list[float]] = []
    for one in some:
        row: list[float] = []
        one.map_numbers(row.append)
        rows.append(row)
    columns = iter(np.array(rows).T)
    return some[0].map_numbers(lambda _number: next(columns))


def _columns(solved: Solved, lane: int) -> Array:
    """Places in the greatest length, and angles: (3, samples, columns)."""
    scale = float(np.max(solved.ready.kinematics.numbers.scale))
    places = solved.points[:, lane].reshape(3, len(solved.span.parameter), -1) / scale
    return np.concatenate([places, solved.angles[:, lane]], axis=2)
