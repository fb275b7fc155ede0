"""Second routes to the motion of a follower: the printed formulas, and integrals of its derivatives."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from centrode.cams.followers.motion import stretches
from centrode.locale import _
from centrode.report.chapters.followers.curves import CURVES, shares_of
from centrode.report.chapters.followers.parts import ROUNDED
from centrode.report.telling import measured

if TYPE_CHECKING:
    from centrode.cams.followers.motion import FollowerMotion
    from centrode.model.follower_cam import PlateCam
    from centrode.render.document.blocks import Check

INSIDE = np.linspace(0.0, 1.0, 99)[1:-1]
NODES, PARTS = 24, 8
"""Points of Gauss in each of so many parts of a stretch: formulas with waves of one turn are integrated to rounding."""


def proved(cam: PlateCam, motion: FollowerMotion) -> Iterator[Check]:
    """The formulas as they are printed against the motion that everything else is computed from."""
    worst, before = 0.0, 0.0
    for number, segment in enumerate(cam.segments):
        after = before if segment.to is None else segment.to
        if segment.curve in CURVES and after != before:
            start, stop = motion.joints[number : number + 2]
            rows = motion.lift(start + (stop - start) * INSIDE, 2)
            rows[0] -= before
            shares = shares_of(segment.curve, INSIDE)
            scale = (after - before) / (stop - start) ** np.arange(3)
            apart = np.abs(rows / scale[:, None] - shares).max(axis=1)
            worst = max(worst, float(np.max(apart / (1.0 + np.abs(shares).max(axis=1)))))
        before = after
    text = _(
        "The formulas, with numbers put in at 97 angles of each segment, give the motion to {share} of its size."
    )
    yield measured(text, worst, 1.0, ROUNDED)


def integrated(motion: FollowerMotion) -> Check:
    """Derivatives integrated over each stretch against what the lift and its derivatives change by."""
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
    share = float(np.max(apart / np.where(greatest > 0.0, greatest, 1.0)))
    text = _(
        "Velocity, acceleration and jerk, integrated by Gauss' rule over each segment, give back what lift, velocity"
        " and acceleration change by, to {share} of their greatest sizes."
    )
    return measured(text, share, 1.0, ROUNDED)
