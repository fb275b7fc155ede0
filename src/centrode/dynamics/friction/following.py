"""How great friction is where it depends on reactions that depend on it: f = c |R(f)|, at many positions.

The reactions are straight in the sizes f of friction, R(f) = R_0 + G f. The solution that counts is the one that
grows out of no friction at all while every coefficient grows from 0 to its value: f = s c |R(f)|, s from 0 to 1.
Where all of c G is small there is no other; elsewhere it is followed. A branch that ends before s = 1, because it
goes to infinity or turns back, has no solution that motion without friction leads to: self-locking.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

Array: TypeAlias = npt.NDArray[np.float64]
Mask: TypeAlias = npt.NDArray[np.bool_]
Codes: TypeAlias = npt.NDArray[np.int8]

EPSILON = 2.0**-52
ROUNDING = 32.0
"""Roundings in one residual."""
TRIES, TRIES_ON_BRANCH = 40, 8
STRIDE, SHORTEST = 0.25, 2.0**-9
"""Greatest step of s: this part of the s at which sizes could feed on themselves at the earliest, but no less."""
LEAST_STEP = 2.0**-30
MOST_STEPS = 2000


class Rule(IntEnum):
    """What of two numbers counts for the size of friction."""

    LENGTH = 0
    GREATER = 1
    FIRST = 2


class Outcome(IntEnum):
    """What became of a position."""

    FOUND = 0
    LOCKED = 1
    LOST = 2


@dataclass(frozen=True)
class Law:
    """f_j = c_j m_j(base_j + gain_j f) at n positions, for m sizes.

    Attributes
    ----------
    factor : (n, m)
        c, with the sign of the motion in it.
    base : (n, m, 2)
        What friction depends on, without friction.
    gain : (n, m, 2, m)
        What each size adds to it.
    rules : (m)
        Which m_j: length of the two numbers, greater of their magnitudes, or the first with its sign.
    """

    factor: Array
    base: Array
    gain: Array
    rules: npt.NDArray[np.int8]

    def at(self, mask: Mask) -> Law:
        """The same at some of the positions."""
        return Law(self.factor[mask], self.base[mask], self.gain[mask], self.rules)

    def measures(self, sizes: Array) -> tuple[Array, Array]:
        """m_j (n, m) at sizes (n, m), and its derivatives by them (n, m, m); 0 where there is none."""
        parts = self.base + np.einsum("njak,nk->nja", self.gain, sizes)
        first, second = parts[..., 0], parts[..., 1]
        length = np.hypot(first, second)
        safe = np.where(length > 0.0, length, 1.0)
        larger = np.abs(first) >= np.abs(second)
        weights = np.empty_like(parts)
        by = (self.rules == Rule.LENGTH, self.rules == Rule.GREATER)
        weights[..., 0] = np.select(by, (first / safe, np.sign(first) * larger), 1.0)
        weights[..., 1] = np.select(by, (second / safe, np.sign(second) * ~larger), 0.0)
        found = np.select(by, (length, np.maximum(np.abs(first), np.abs(second))), first)
        return found, np.einsum("nja,njak->njk", weights, self.gain)

    @property
    def feedback(self) -> Array:
        """Spectral radius (n) of the greatest shares of sizes that sizes can add: below 1 there is one solution."""
        shares = np.abs(self.factor)[..., None] * np.linalg.norm(self.gain, axis=2)
        return np.asarray(np.abs(np.linalg.eigvals(shares)).max(axis=-1, initial=0.0))

    def residual(self, sizes: Array, share: Array) -> tuple[Array, Array, Array]:
        """What is missing, f - s c m(f) (n, m), its derivatives (n, m, m), and what rounding leaves of it (n, m)."""
        found, slopes = self.measures(sizes)
        factor = share[:, None] * self.factor
        parts = np.abs(self.base).max(axis=2) + np.einsum(
            "njk,nk->nj", np.abs(self.gain).max(axis=2), np.abs(sizes)
        )
        noise = ROUNDING * EPSILON * (np.abs(sizes) + np.abs(factor) * parts)
        return sizes - factor * found, np.eye(sizes.shape[1]) - factor[..., None] * slopes, noise


@dataclass(frozen=True)
class Followed:
    """Sizes of friction at n positions.

    Attributes
    ----------
    sizes : (n, m)
    outcome : (n) of Outcome
    share : (n)
        How far the coefficients could grow: 1 where there is a solution.
    residual : (n)
        Greatest |f - c m(f)| over the greatest of |f| and |c m(f)|.
    tries : int
        Most corrections at one position.
    """

    sizes: Array
    outcome: Codes
    share: Array
    residual: Array
    tries: int


def followed(law: Law) -> Followed:
    """Solve at every position; all numbers have to be finite."""
    count, width = law.factor.shape
    feedback, ones = law.feedback, np.ones(count)
    sizes, good, _slope, tries = _corrected(law, np.zeros((count, width)), ones, TRIES)
    good &= feedback < 1.0
    outcome = np.where(good, Outcome.FOUND, Outcome.LOST).astype(np.int8)
    share = np.where(good, 1.0, 0.0)
    if not good.all():
        rest = ~good
        sizes[rest], outcome[rest], share[rest], more = _along(law.at(rest), feedback[rest])
        tries = max(tries, more)
    missing = np.abs(law.residual(sizes, ones)[0])
    size = np.maximum(np.abs(sizes).max(axis=1, initial=0.0), np.finfo(np.float64).tiny)
    return Followed(sizes, outcome, share, missing.max(axis=1, initial=0.0) / size, tries)


def _corrected(law: Law, sizes: Array, share: Array, tries: int) -> tuple[Array, Mask, Array, int]:
    """Newton's method: sizes, where it converged, the determinants there, and how often it went on."""
    sizes = sizes.copy()
    open_, made = np.ones(len(sizes), dtype=bool), 0
    determinant = np.ones(len(sizes))
    while made < tries and open_.any():
        made += 1
        part = law.at(open_)
        with np.errstate(all="ignore"):
            residual, slopes, noise = part.residual(sizes[open_], share[open_])
            determinant[open_] = np.linalg.det(slopes)
            sizes[open_] -= _solved(slopes, residual)
            done = (np.abs(residual) <= noise).all(axis=1)
        open_[open_] = ~done & np.isfinite(sizes[open_]).all(axis=1)
    return sizes, ~open_ & np.isfinite(sizes).all(axis=1), determinant, made


def _solved(matrix: Array, right: Array) -> Array:
    """Solutions (n, m); NaN where a matrix is singular."""
    with np.errstate(all="ignore"):
        singular = ~(np.abs(np.linalg.det(matrix)) > 0.0)
    regular = np.where(singular[:, None, None], np.eye(matrix.shape[-1]), matrix)
    found = np.linalg.solve(regular, right[..., None])[..., 0]
    found[singular] = np.nan
    return np.asarray(found)


def _along(law: Law, feedback: Array) -> tuple[Array, Codes, Array, int]:
    """Follow the branch from no friction on, each position with steps of its own."""
    count, width = law.factor.shape
    sizes, share, tries = np.zeros((count, width)), np.zeros(count), 0
    longest = np.clip(STRIDE / np.maximum(feedback, STRIDE), SHORTEST, 1.0)
    step = longest.copy()
    for _step in range(MOST_STEPS):
        going = (share < 1.0) & (step >= LEAST_STEP)
        if not going.any():
            break
        part, here, aim = law.at(going), sizes[going], np.minimum(share[going] + step[going], 1.0)
        slopes = part.residual(here, share[going])[1]
        ahead = part.factor * part.measures(here)[0]
        guess = here + (aim - share[going])[:, None] * _solved(slopes, ahead)
        found, good, determinant, made = _corrected(part, guess, aim, TRIES_ON_BRANCH)
        # the determinant is 1 without friction and changes its sign where the branch ends
        good &= determinant > 0.0
        tries = max(tries, made)
        sizes[going] = np.where(good[:, None], found, here)
        share[going] = np.where(good, aim, share[going])
        step[going] = np.where(good, np.minimum(2.0 * step[going], longest[going]), 0.5 * step[going])
    locked = (share < 1.0) & (step < LEAST_STEP)
    outcome = np.select((share >= 1.0, locked), (Outcome.FOUND, Outcome.LOCKED), Outcome.LOST)
    return sizes, outcome.astype(np.int8), share, tries
