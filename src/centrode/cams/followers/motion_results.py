"""The motion of a cam's follower with all that is known of it; the laws of motion compared for its first rise."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.cams.followers.curve_formulas import CURVES, PEAKS, shares_of
from centrode.cams.followers.motion import (
    FollowerMotion,
    LawJoint,
    Peaks,
    cam_laws,
    dataset_of_motion,
    derivative,
    extremes_of,
    first_jump,
    follower_motion,
    greatest_size,
    inner_joints_of,
    joints_of,
    peaks_of,
    stretches,
)
from centrode.cams.roller_path import FEWEST, angles_of
from centrode.model.cam_files import AnyCam, with_follower
from centrode.model.follower_cam import PlateCam
from centrode.numerics.search import Extremes

Array = npt.NDArray[np.float64]

ORDERS = (1, 2, 3)
ROUNDING = 1e-12
"""Share of the greatest value, of the lift or a derivative, that rounding may leave of a zero."""
ROUNDED = float(np.finfo(float).eps) * (1 << 12)
"""What rounding may leave, in parts of a size: some dozens of operations, and a few angles in between."""
FOUND = 1e-12
"""What is allowed between a coefficient found by search and its closed form: jets of degree 7."""
INSIDE = np.linspace(0.0, 1.0, 99)[1:-1]
"""Shares of a segment's angle at which the formulas are evaluated."""
NODES, PARTS = 24, 8
"""Points of Gauss in each of so many parts of a stretch: formulas with waves of one turn are integrated to rounding."""


@dataclass(frozen=True)
class FollowerMotionResults:
    """The motion of a follower over a turn of its cam.

    Attributes
    ----------
    cam : PlateCam
    motion : FollowerMotion
    dataset : the labelled motion over a turn
    lift : extremes of the lift [m or rad]
    greatest : greatest velocity, acceleration and jerk by the angle of the cam, with sign, each with its place [rad]
    joints : where segments meet
    inner_joints : where formulas of one curve meet so that velocity, acceleration or jerk jumps
    first_jump : the lowest derivative that jumps; None if up to the fourth none does
    peaks : coefficients of each segment
    instants : chosen angles of the cam [rad]
    at_instants : (4, instants) lift and three derivatives there, without what rounding leaves of zero
    """

    cam: PlateCam
    motion: FollowerMotion
    dataset: xr.Dataset
    lift: Extremes
    greatest: tuple[tuple[float, float], ...]
    joints: tuple[LawJoint, ...]
    inner_joints: tuple[LawJoint, ...]
    first_jump: int | None
    peaks: tuple[Peaks, ...]
    instants: Array
    at_instants: Array

    @property
    def rises(self) -> list[tuple[float, float]]:
        """Lift [m or rad] before and after each segment."""
        ends = [0.0]
        for segment in self.cam.segments:
            ends.append(ends[-1] if segment.to is None else segment.to)
        return list(pairwise(ends))


def follower_motion_results(
    cam: AnyCam, samples: int | None = None, *, instants: Sequence[float] | None = None
) -> FollowerMotionResults:
    """The motion of a follower with its extremes, its joints, the coefficients of its segments.

    Parameters
    ----------
    cam : PlateCam
    samples : int
        Evenly spaced over the turn; the description's own number, else 361.
    instants : angles [rad]
        Those of the description if left out.

    Raises
    ------
    InputError
        A cam that is given by a curvature law; a number of samples out of bounds.
    """
    plate = with_follower(cam)
    motion = follower_motion(plate)
    phi = np.array(plate.study.instants if instants is None else instants, dtype=np.float64)
    lift = extremes_of(motion.law, 1, derivative(0))
    greatest = tuple(greatest_size(extremes_of(motion.law, k + 1, derivative(k))) for k in ORDERS)
    at_instants = motion.lift(phi, ORDERS[-1])
    sizes = np.abs([greatest_size(lift)[0], *(size for size, _at in greatest)])
    at_instants[np.abs(at_instants) <= ROUNDING * sizes[:, None]] = 0.0
    return FollowerMotionResults(
        plate,
        motion,
        dataset_of_motion(plate, motion, angles_of(plate, samples)),
        lift,
        greatest,
        joints_of(motion),
        inner_joints_of(motion),
        first_jump(motion),
        tuple(peaks_of(motion.law, number) for number in range(len(plate.segments))),
        phi,
        at_instants,
    )


def results_of_follower_motion(cam: PlateCam, dataset: xr.Dataset) -> FollowerMotionResults:
    """A dataset of the motion of a follower with the extremes and the joints of its cam."""
    return replace(follower_motion_results(cam, FEWEST), dataset=dataset)


def formulas_difference(results: FollowerMotionResults) -> float:
    """By which share of its size the formulas of the curves differ from the motion, at `INSIDE` of each segment."""
    worst, motion = 0.0, results.motion
    for number, (segment, (before, after)) in enumerate(
        zip(results.cam.segments, results.rises, strict=True)
    ):
        if segment.curve in CURVES and after != before:
            start, stop = motion.joints[number : number + 2]
            rows = motion.lift(start + (stop - start) * INSIDE, 2)
            rows[0] -= before
            shares = shares_of(segment.curve, INSIDE)
            scale = (after - before) / (stop - start) ** np.arange(3)
            apart = np.abs(rows / scale[:, None] - shares).max(axis=1)
            worst = max(worst, float(np.max(apart / (1.0 + np.abs(shares).max(axis=1)))))
    return worst


def integrals_difference(motion: FollowerMotion) -> float:
    """By which share of their sizes integrals of three derivatives differ from what lift and derivatives change by."""
    x, weights = np.polynomial.legendre.leggauss(NODES)
    apart, greatest = np.zeros(3), np.zeros(3)
    for one in stretches(motion.law):
        edges = np.linspace(*one.ends, PARTS + 1)
        half = 0.5 * np.diff(edges)
        phi = (edges[:-1, None] + half[:, None] * (1.0 + x)).ravel()
        found = one.derivatives(phi, 3)
        by_gauss = (found[1:] * np.outer(half, weights).ravel()).sum(axis=1)
        ends = one.derivatives(np.array(one.ends), 2)
        apart = np.maximum(apart, np.abs(by_gauss - (ends[:, 1] - ends[:, 0])))
        greatest = np.maximum(greatest, np.abs(found[:3]).max(axis=1))
    return float(np.max(apart / np.where(greatest > 0.0, greatest, 1.0)))


@dataclass(frozen=True)
class MotionLawResults:
    """Laws of motion beside each other for the first rise of a cam.

    Attributes
    ----------
    cam : PlateCam
    dataset : as of `cam_laws`
    """

    cam: PlateCam
    dataset: xr.Dataset

    @property
    def names(self) -> list[str]:
        """Names of the laws."""
        return list(map(str, self.dataset["law"].values.tolist()))

    @property
    def closed_forms_difference(self) -> float:
        """By which share coefficients that were searched for differ from their closed forms."""
        worst = 0.0
        for name in self.names:
            if name in PEAKS:
                closed = np.array(PEAKS[name][1])
                found = self.dataset["peak_coefficient"].sel(law=name).values[1:]
                worst = max(worst, float(np.max(np.abs(found - closed) / np.where(closed > 0, closed, 1.0))))
        return worst


def motion_law_results(
    cam: AnyCam, samples: int | None = None, *, instants: Sequence[float] | None = None
) -> MotionLawResults:
    """Laws of motion beside each other for the first rise of a cam.

    `samples` and `instants` are those of the turn, as of every topic of a cam: over the rise each law has 361 places.

    Raises
    ------
    InputError
        A cam that is given by a curvature law, or without a rise.
    """
    del samples, instants
    return MotionLawResults(with_follower(cam), cam_laws(cam))


def has_rise(cam: AnyCam) -> bool:
    """Whether a cam is one with a follower that a segment moves."""
    return isinstance(cam, PlateCam) and any(segment.to for segment in cam.segments)
