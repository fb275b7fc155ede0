"""How the instant centre of a body is located: the cases of the textbooks, recognised and named."""

from __future__ import annotations

from collections.abc import Mapping
from enum import IntEnum
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.analysis.instant_centres.bodies import ROUNDED, Array, Bodies, Pair, Places
from centrode.analysis.instant_centres.primary import joints_of, ordered, rolling_pairs
from centrode.locale import _, mark

Kinds: TypeAlias = npt.NDArray[np.int8]
Mask: TypeAlias = npt.NDArray[np.bool_]


class Case(IntEnum):
    """What the velocities of two points of a body, seen from another one, say of its instant centre."""

    ABSENT = 0
    REST = 1
    HINGE = 2
    ROLLING = 3
    DIRECTIONS = 4
    SAME_SENSE = 5
    OPPOSITE_SENSE = 6
    TRANSLATION = 7
    STANDSTILL = 8

    @property
    def word(self) -> str:
        """What tables call it, in English."""
        return _WORDS[self]

    @property
    def sentence(self) -> str:
        """The same in the chosen language."""
        return _(_WORDS[self])


_WORDS: Mapping[Case, str] = {
    Case.ABSENT: mark("no position"),
    Case.REST: mark("at rest against each other"),
    Case.HINGE: mark("common hinge"),
    Case.ROLLING: mark("rolling contact"),
    Case.DIRECTIONS: mark("two velocity directions"),
    Case.SAME_SENSE: mark("parallel velocities, same sense"),
    Case.OPPOSITE_SENSE: mark("parallel velocities, opposite sense"),
    Case.TRANSLATION: mark("equal velocities: translation"),
    Case.STANDSTILL: mark("a point that stands still"),
}


class Recogniser:
    """Names the cases of pairs of bodies over a motion."""

    def __init__(self, bodies: Bodies) -> None:
        self.bodies = bodies
        joints = joints_of(bodies.mechanism, bodies)
        self.hinged = {joint.pair for joint in joints if joint.kind == "hinge"}
        self.rolling = set(rolling_pairs(bodies.mechanism, bodies))

    def cases(self, pair: Pair) -> Kinds:
        """Case of a pair at every sample."""
        bodies = self.bodies
        moving, spin = bodies.relative(pair)
        slow = ROUNDED * bodies.rate
        still = np.abs(spin) * bodies.scale <= slow
        found = self._by_velocities(pair, moving, spin, slow)
        if ordered(pair) in self.rolling:
            found[:] = Case.ROLLING
        if ordered(pair) in self.hinged:
            found[:] = Case.HINGE
        found[still] = Case.TRANSLATION
        found[still & (np.abs(moving) <= slow)] = Case.REST
        found[~np.isfinite(np.abs(moving) + spin)] = Case.ABSENT
        return found

    def _by_velocities(self, pair: Pair, moving: Places, spin: Array, slow: Array) -> Kinds:
        """Cases told by the velocities of two points of the first body against the second."""
        bodies, first = self.bodies, pair[0]
        arm = bodies.second_place(first) - bodies.place[..., first]
        other = moving + 1j * spin * arm
        with np.errstate(invalid="ignore"):
            product = np.conj(moving) * other
            parallel = np.abs(product.imag) <= ROUNDED * np.abs(product)
        found = np.full(moving.shape, Case.DIRECTIONS, dtype=np.int8)
        found[parallel & (product.real > 0.0)] = Case.SAME_SENSE
        found[parallel & (product.real <= 0.0)] = Case.OPPOSITE_SENSE
        found[(np.abs(moving) <= slow) | (np.abs(other) <= slow)] = Case.STANDSTILL
        return found
