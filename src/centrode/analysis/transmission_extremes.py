"""Least and greatest transmission angles of dyads over the part of a motion that is reached, found as roots.

An extreme lies where the angle's rate is zero, at an end of what is reached, where the dyad is flat (0), or where
its lines stand square to each other (90 deg).
"""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil, nan, pi
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.analysis.turning.tours import Tour
from centrode.analysis.turning.transmission import least_of, transmission_at_ends, watched_dyads
from centrode.analysis.turning.watched import Course, course_of
from centrode.kinematics.path import SampleGrid
from centrode.kinematics.prepared import Ready
from centrode.kinematics.sampling import MotionOnPath

Array: TypeAlias = npt.NDArray[np.float64]

LEAST_NODES = 720


@dataclass(frozen=True)
class _Stretch(Tour):
    """The part of a path between two values of its parameter, ends of a motion's samples or limits."""

    first: float = nan
    last: float = nan

    @property
    def span(self) -> tuple[float, float]:
        """Its ends."""
        return self.first, self.last

    @property
    def comes_round(self) -> bool:
        """It is looked at from end to end."""
        return False

    def nodes(self) -> Array:
        """Values at least as close as the nodes of the mesh, denser towards the ends."""
        step = self.continuation.kinematics.path.step
        count = max(LEAST_NODES, ceil((self.last - self.first) / step * pi / 2))
        share = 0.5 - 0.5 * np.cos(pi * (np.arange(count) + 0.5) / count)
        return np.asarray(self.first + (self.last - self.first) * share)


def extreme_transmission_angles(ready: Ready, span: SampleGrid) -> dict[int, tuple[float, float]]:
    """Least and greatest acute transmission angle [rad] of each dyad, by the number of its group.

    They are those over all values between the least and the greatest parameter of the span that the mechanism
    reaches; NaN where it reaches none.
    """
    with np.errstate(all="ignore"):
        continuation = MotionOnPath.along(ready, ready.kinematics, span.parameter).continuation
        low, high = continuation.branches.reach(0)
        first, last = max(low, float(np.min(span.parameter))), min(high, float(np.max(span.parameter)))
        drive = ready.kinematics.path.driven[0].drive
        stretch = _Stretch(ready, drive, {}, continuation, low, high, last - first, first, last)
        dyads = watched_dyads(stretch, guides=True)
        if not first <= last:
            return {group: (nan, nan) for _one, group in dyads}
        course = course_of(stretch, [one for one, _group in dyads])
        return {group: _extremes(course, k, group) for k, (_one, group) in enumerate(dyads)}


def _extremes(course: Course, k: int, group: int) -> tuple[float, float]:
    places, reached = course.turned[k]
    turned = [(float(at), float(value)) for at, value in zip(places, _acute(reached), strict=True)]
    least = least_of(course, k, group, turned)[0]
    values = course.values[k][np.isfinite(course.values[k])]
    if _passes(np.sin(values), np.cos(values)):
        least = 0.0
    if _passes(np.cos(values), np.sin(values)):
        return least, pi / 2
    ends = [angle for angle, _at in transmission_at_ends(course, k)]
    return least, float(np.max(np.concatenate([_acute(np.append(values, reached)), ends]), initial=least))


def _acute(angles: Array) -> Array:
    """Angles between lines, in [0, pi/2]."""
    return np.asarray(np.arctan2(np.abs(np.sin(angles)), np.abs(np.cos(angles))))


def _passes(number: Array, other: Array) -> bool:
    """Whether a sine (or a cosine) passes zero between nodes at which the other keeps its side."""
    return bool(((number[:-1] * number[1:] <= 0.0) & (other[:-1] * other[1:] > 0.0)).any())
