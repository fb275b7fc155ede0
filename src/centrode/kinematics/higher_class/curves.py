"""The curve that a group of higher class follows over the path, by its own arc.

State and parameter are found together on a plane square to the curve (Keller, Numerical Solution of Bifurcation
and Nonlinear Eigenvalue Problems, 1977), so limits are ordinary places: there the parameter turns back. The
curve's coordinates are the free coordinates of the group and, last, the parameter in the path's unit.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.jets import Jet
from centrode.kinematics.higher_class.bordering import Shifts, bordered, motion_along
from centrode.kinematics.higher_class.newton import settled, size_of
from centrode.kinematics.higher_class.reduction import Linear, solved
from centrode.kinematics.higher_class.surroundings import Surroundings
from centrode.kinematics.higher_class.system import Motion, total
from centrode.kinematics.paths import JETS

Array: TypeAlias = npt.NDArray[np.float64]
Lanes: TypeAlias = npt.NDArray[np.intp]
Mask: TypeAlias = npt.NDArray[np.bool_]

STEPS = 7
"""Newton steps onto a plane."""
ENOUGH = 1e-9
"""What part of a step along the curve the next Newton step onto a plane may be."""
FAR = 3e-4
"""The first step counts as one after a step this great: the curve may bend so sharply that only a second one tells."""
CONTRACTION = 0.2
"""By how much every Newton step must be smaller than the one before, but for rounding."""


@dataclass
class Places:
    """Places on curves, one lane each; all arrays have one row a place.

    `numbers` (k, width + 1) are state and parameter, `first` their derivatives by the curve's arc; `along` is the
    curve's unit vector (k, free + 1), `size` the determinant of the equations bordered by it. `second` are second
    Taylor coefficients by the distance of `numbers` along `first`, which to begin with is the arc. Distances count
    every number in its own measure, `weight` (k, width + 1): they are the same in metres and in millimetres.
    """

    numbers: Array
    first: Array
    second: Array
    along: Array
    size: Array
    weight: Array

    @property
    def state(self) -> Array:
        return self.numbers[:, :-1]

    @property
    def parameter(self) -> Array:
        return self.numbers[:, -1]

    def of(self, which: Lanes | Mask) -> Places:
        """Some of the places."""
        return Places(*(getattr(self, f.name)[which] for f in fields(self)))

    def put(self, which: Lanes | Mask, others: Places) -> None:
        """Put others in some of the places."""
        for f in fields(self):
            getattr(self, f.name)[which] = getattr(others, f.name)

    def distance(self, numbers: Array) -> Array:
        """Distance of numbers (k, width + 1) along the curve's direction here."""
        own = self.first * self.weight**2
        return total(own * numbers) / total(own * self.first)


@dataclass(frozen=True)
class Reached:
    """Places found on planes square to curves at their bases.

    `arc` is their distance along the bases' directions, `first` and `second` are Taylor coefficients of numbers
    by it; `wrong` is by how much the foretold place was off.
    """

    places: Places
    arc: Array
    first: Array
    second: Array
    wrong: Array
    found: Mask

    def of(self, which: Lanes | Mask) -> Reached:
        """Some of the places."""
        return Reached(
            self.places.of(which), self.arc[which], self.first[which], self.second[which], self.wrong[which],
            self.found[which],
        )  # fmt: skip


def reach(
    around: Surroundings,
    lanes: Lanes,
    base: Places,
    along: Array,
    parameter: Array,
    state: Array,
    stride: Array | None = None,
) -> Reached:
    """Where curves pass planes square to `along` through foretold places.

    They are as good as it takes to foretell others at such strides; without these, to the last digit.
    """
    count, free = len(parameter), along.shape[1] - 1
    found, active = np.zeros(count, dtype=bool), np.isfinite(state).all(axis=1)
    last, wrong = np.full(count, FAR), np.full(count, np.nan)
    for k in range(STEPS):
        system, linear, moved, rest, follow, matrix = bordered(around, lanes, parameter, state, along)
        right = np.concatenate([rest, np.zeros((count, 1))], axis=1)
        step = solved(matrix, right[:, :, None])[:, :, 0]
        motion = motion_along(linear, moved, follow, step)
        size = size_of(system, moved, step)
        if k == 0:
            wrong = size
        good = active & np.isfinite(size) & (size < 1.0)
        state = np.where(good[:, None], system.moved(state, motion), state)
        parameter = np.where(good, parameter + around.unit * step[:, -1], parameter)
        with np.errstate(all="ignore"):
            enough = settled(last, size) if stride is None else size * (size / last) ** 2 <= ENOUGH * stride
        done = good & enough
        found |= done
        active = good & ~done & ((k == 0) | (size <= np.maximum(CONTRACTION * last, 1e-9)))
        last = size
        if not active.any():
            break
    system, linear, _moved, _rest, follow, matrix = bordered(around, lanes, parameter, state, along)
    ahead = np.zeros((count, free + 1, 1))
    ahead[:, -1] = 1.0
    slope = solved(matrix, ahead)[:, :, 0]
    first, second = _coefficients(around, lanes, parameter, state, slope, linear, follow, matrix)
    numbers = np.concatenate([state, parameter[:, None]], axis=1)
    with np.errstate(all="ignore"):
        length = np.sqrt(total(slope * slope))
        # the determinant bordered by the curve's own direction is that by the plane's, times their cosine
        size = np.linalg.det(matrix) * length
        places = Places(numbers, first / length[:, None], second, slope / length[:, None], size, base.weight)
        _rate, places.second = _by_distance(places, first, second)
        inward = _by_distance(base, first, second)
    found &= np.isfinite(inward[1]).all(axis=1)
    return Reached(places, base.distance(numbers - base.numbers), *inward, wrong, found)


def _by_distance(base: Places, first: Array, second: Array) -> tuple[Array, Array]:
    """Taylor coefficients by the distance along a base's direction, from those by any other variable."""
    rate, bend = base.distance(first)[:, None], base.distance(second)[:, None]
    return first / rate, second / rate**2 - first * bend / rate**3


def _coefficients(
    around: Surroundings,
    lanes: Lanes,
    parameter: Array,
    state: Array,
    slope: Array,
    linear: Linear,
    follow: Shifts,
    matrix: Array,
) -> tuple[Array, Array]:
    """First and second Taylor coefficients of numbers by the distance from the plane."""
    ahead = Jet((parameter, around.unit * slope[:, -1], np.zeros(len(parameter))))
    known = around.known(ahead, lanes)
    system = around.system(known, lanes)
    still = {entity: (0.0,) * entity.unknowns for entity in follow}
    one = motion_along(linear, still, follow, slope)
    zero = np.zeros(len(parameter))
    straight = Motion(
        {e: tuple(Jet((zero, x, zero)) for x in shift) for e, shift in one.shifts.items()},
        [Jet((zero, x, zero)) for x in one.free],
    )
    values = system.residual(JETS, system.at(JETS, known, state, straight))
    moved, rest = linear.reduced([-x.coefficients[2] if isinstance(x, Jet) else 0.0 for x in values])
    right = np.concatenate([system.stacked(rest), zero[:, None]], axis=1)
    bend = solved(matrix, right[:, :, None])[:, :, 0]
    two = motion_along(linear, moved, follow, bend)
    curved = Motion(
        {
            e: tuple(Jet((zero, x, y)) for x, y in zip(one.shifts[e], two.shifts[e], strict=True))
            for e in one.shifts
        },
        [Jet((zero, x, y)) for x, y in zip(one.free, two.free, strict=True)],
    )
    at = system.at(JETS, known, state, curved)
    jets = system.numbers_of(at)
    first = [x.coefficients[1] for x in jets] + [around.unit * slope[:, -1]]
    second = [x.coefficients[2] for x in jets] + [around.unit * bend[:, -1]]
    return system.stacked(first), system.stacked(second)


def quintic(base: Places, reached: Reached) -> Array:
    """Polynomials (k, 6, width + 1) through two places each, in the share of the arc between them.

    Values, first and second derivatives agree at both ends; the parameter is that beyond the base.
    """
    arc = reached.arc[:, None]
    c1, c2 = base.first * arc, base.second * arc**2
    d, e = reached.first * arc, 2.0 * reached.second * arc**2
    a = reached.places.numbers - base.numbers - c1 - c2
    b, c = d - c1 - 2.0 * c2, e - 2.0 * c2
    c3, c4, c5 = 10.0 * a - 4.0 * b + 0.5 * c, -15.0 * a + 7.0 * b - c, 6.0 * a - 3.0 * b + 0.5 * c
    start = base.numbers.copy()
    start[:, -1] = 0.0
    return np.stack([start, c1, c2, c3, c4, c5], axis=1)
