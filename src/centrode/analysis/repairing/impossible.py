"""Inequalities that exclude a repair, whatever the numbers that may change become.

Only what follows for certain is said: the first dyad behind a crank, and the second dyad behind a slider-crank.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, degrees, sqrt

import numpy as np

from centrode.analysis.repairing.candidates import Candidates
from centrode.geometry.plane import cross, subtract
from centrode.kinematics.prepared import Ready
from centrode.locale import _
from centrode.model.mechanism import FRAME
from centrode.structure.groups import Meet, Rail, Rod, TurnedLink

MARGIN = 1e-12
"""Relative: an inequality between rounded numbers has to hold by more than this."""

TRIED = 0.37
"""A number that moves something moves it at this share of its greatest change, or at all of it."""


@dataclass(frozen=True)
class Range:
    """A length between its bounds."""

    low: float
    high: float


def impossible(candidates: Candidates, least_angle: float) -> str:
    """Why no change within the bounds makes it turn, with the inequality; empty where none of these says so."""
    prepared = candidates.prepared
    if prepared.mechanism.space != "plane":
        return ""
    lengths = _Lengths(candidates)
    crank = next(
        (g for g in prepared.structure.groups if isinstance(g, TurnedLink) and g.kind == "crank"), None
    )
    if crank is None or crank.pivot not in prepared.mechanism.frame.points:
        return ""
    for group in prepared.structure.groups:
        if isinstance(group, Meet) and group.carriage is None:
            reason = _behind_crank(lengths, crank.link, group, least_angle) or _behind_slider(
                prepared, lengths, crank.link, group, least_angle
            )
            if reason:
                return reason
    return ""


class _Lengths:
    """Lengths of links with two points, between the bounds of what varies."""

    def __init__(self, candidates: Candidates) -> None:
        self.candidates = candidates
        self.mechanism = candidates.prepared.mechanism
        self.bounds = {one.path: Range(one.low, one.high) for one in candidates.varying}

    def of(self, link: str) -> Range | None:
        length = self.mechanism.links[link].length
        return None if length is None else self.bounds.get(f"links.{link}.length", Range(length, length))


def _rods(group: Meet) -> list[Rod]:
    return [locus for locus in group.loci if isinstance(locus, Rod)]


def _on_crank(lengths: _Lengths, crank: str, point: str) -> bool:
    """Whether a point is the end of the crank: a link of two points, the other of which is the frame's."""
    link = lengths.mechanism.links[crank]
    return (
        link.length is not None and point in link.coordinates and point not in lengths.mechanism.frame.points
    )


def _behind_crank(lengths: _Lengths, crank: str, group: Meet, least_angle: float) -> str:
    """Crank, coupler and slider on a line of the frame: the pin's distance from the line reaches the crank's length."""
    rods, rails = _rods(group), [locus for locus in group.loci if isinstance(locus, Rail)]
    if (
        len(rods) != 1
        or len(rails) != 1
        or rails[0].on != FRAME
        or not _on_crank(lengths, crank, rods[0].centre)
    ):
        return ""
    short, rod = lengths.of(crank), lengths.of(rods[0].link)
    if short is None or rod is None:
        return ""
    reach, offset = rod.high * cos(least_angle), _offset(lengths.candidates, crank, rails[0])
    if short.low + offset <= reach * (1.0 + MARGIN):
        return ""
    left, most = (f"{crank} + e", _(" (e = {e:.6g} m, which nothing changes)").format(e=offset))
    if not offset:
        left, most = crank, ""
    return _(
        "{left} > {rod} cos {angle}: {low:.6g} m > {high:.6g} m{most}; over a turn the crank's pin comes so far from"
        " the guide, and {rod} does not reach so far"
    ).format(
        left=left,
        rod=rods[0].link,
        angle=_degrees(least_angle),
        low=short.low + offset,
        high=reach,
        most=most,
    )


def _offset(candidates: Candidates, crank: str, rail: Rail) -> float:
    """Distance of the crank's pivot from the guide, if no number that may change moves either; otherwise 0."""
    low, high = candidates.box()
    one_by_one = [np.diag(share * end) for end in (low, high) for share in (1.0, TRIED)]
    changes = np.vstack([np.zeros((1, len(low))), *one_by_one])
    numbers = candidates.batch(changes).kinematics.numbers
    pivot = next(p for p in candidates.prepared.mechanism.links[crank].coordinates if p in numbers.frame)
    through, direction = numbers.curve(rail.guide)
    offsets = np.broadcast_to(
        np.abs(cross(direction, subtract(numbers.frame[pivot], through))), (len(changes), 1)
    )
    first = float(offsets[0, 0])
    scale = float(candidates.prepared.kinematics.numbers.scale)
    return first if float(np.max(np.abs(offsets - first))) <= MARGIN * scale else 0.0


def _behind_slider(prepared: Ready, lengths: _Lengths, crank: str, group: Meet, least_angle: float) -> str:
    """A dyad whose end is carried by a slider-crank's slider: its stroke is at least twice the crank."""
    rods = _rods(group)
    if len(rods) != 2:
        return ""
    fixed = [rod for rod in rods if rod.centre in prepared.mechanism.frame.points]
    moving = [rod for rod in rods if rod.centre not in prepared.mechanism.frame.points]
    if len(fixed) != 1 or len(moving) != 1:
        return ""
    if not _is_slider(prepared, lengths, crank, moving[0].centre):
        return ""
    ranges = [lengths.of(rod.link) for rod in rods]
    short = lengths.of(crank)
    if short is None or None in ranges:
        return ""
    one, other = (one for one in ranges if one is not None)
    reach = 2.0 * sqrt(one.high * other.high * cos(least_angle))
    if short.low <= reach * (1.0 + MARGIN):
        return ""
    names = [rod.link for rod in rods]
    return _(
        "{crank} > 2 sqrt({one} {other} cos {angle}): {low:.6g} m > {high:.6g} m; the slider's stroke is at least"
        " twice the crank, and no way so long and straight lies between the least and the greatest reach of {one}"
        " and {other}"
    ).format(
        crank=crank, one=names[0], other=names[1], angle=_degrees(least_angle), low=short.low, high=reach
    )


def _is_slider(prepared: Ready, lengths: _Lengths, crank: str, point: str) -> bool:
    """Whether a point is the slider of a slider-crank of the crank on the frame."""
    for group in prepared.structure.groups:
        if isinstance(group, Meet) and group.points == (point,) and group.carriage is None:
            rods, rails = _rods(group), [locus for locus in group.loci if isinstance(locus, Rail)]
            on_frame = len(rails) == 1 and rails[0].on == FRAME
            return on_frame and len(rods) == 1 and _on_crank(lengths, crank, rods[0].centre)
    return False


def _degrees(angle: float) -> str:
    return f"{degrees(angle):.4g} deg"
