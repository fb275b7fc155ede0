"""Equidistants of a roller's path: the cam's profile one radius inside, the wall of a groove one radius outside.

A point of the equidistant at distance d along the outward normal has the curvature K/(1 + d K), K that of the path.
Where 1 + d K is not positive the equidistant runs back on itself: the profile is undercut, the roller's own circle
cuts it away. Towards the inside (d = -r) this happens on convex stretches, towards the outside (d = r) in hollows.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal, TypeAlias

import numpy as np

from centrode.cams.frames import Array, Frames, PolarCurve, frames
from centrode.cams.nodes import mesh, nodes_of
from centrode.errors import InputError
from centrode.locale import _
from centrode.numerics.search import extremes, roots

Side: TypeAlias = Literal["inner", "outer"]


@dataclass(frozen=True)
class Equidistant:
    """A curve at a constant distance from another, at the angles of that one's frames.

    Attributes
    ----------
    place : (n, 2) [m]
    polar_radius, polar_angle : (n) [m], [rad]
        The angle counted as phi is, without jumps between neighbours.
    curvature : (n) [1/m]
        Positive where it bends towards the cam's centre; infinite at a cusp.
    bend : (n) [m]
        Radius of curvature 1/K + d with its sign; infinite where the path is straight.
    speed : (n) [m/rad]
        ds/dphi; negative where it runs back.
    """

    place: Array
    polar_radius: Array
    polar_angle: Array
    curvature: Array
    bend: Array
    speed: Array


@dataclass(frozen=True)
class Undercut:
    """A stretch [rad] of the path whose equidistant runs back; its ends are cusps unless the path ends there."""

    start: float
    stop: float


def signed(radius: float, side: Side) -> float:
    """The distance along the outward normal: -radius inside, radius outside."""
    if not (math.isfinite(radius) and radius > 0):
        raise InputError("[roller] radius", _("it has to be positive and finite"), _("correct it"))
    return -radius if side == "inner" else radius


def equidistant(frame: Frames, distance: float) -> Equidistant:
    """The curve at a distance [m] along the outward normals."""
    place = frame.place + distance * frame.normal
    stretch = 1.0 + distance * frame.curvature
    with np.errstate(divide="ignore", invalid="ignore"):
        curvature, bend = frame.curvature / stretch, 1.0 / frame.curvature + distance
    # the angle between a path's point and its equidistant's is less than half a turn as long as the centre is inside
    across = np.sum(place * np.stack([np.cos(frame.phi), -np.sin(frame.phi)], axis=-1), axis=-1)
    along = np.sum(place * np.stack([np.sin(frame.phi), np.cos(frame.phi)], axis=-1), axis=-1)
    angle = frame.phi + np.arctan2(across, along)
    return Equidistant(
        place, np.hypot(place[:, 0], place[:, 1]), angle, curvature, bend, frame.speed * stretch
    )


def undercut(
    curve: PolarCurve, edges: Sequence[float], radius: float, side: Side = "inner"
) -> list[Undercut]:
    """Stretches on which the equidistant of a curve at the roller's radius runs back.

    Parameters
    ----------
    edges : sequence of float [rad]
        Ends and breaks of the curve, growing.
    radius : float [m]
        Of the roller.

    Returns
    -------
    list of Undercut
        Growing, exact to rounding; one that goes over the end of a closed path is told in one piece. A stretch
        narrower than a hundredth of a radian may be missed.
    """
    distance = signed(radius, side)

    def stretch(phi: Array) -> Array:
        return 1.0 + distance * frames(curve, phi).curvature

    cuts = [edges[0], *roots(stretch, nodes_of(edges)).tolist(), edges[-1]]
    found: list[Undercut] = []
    for start, stop in pairwise(cuts):
        if stop <= start or float(np.median(stretch(mesh(start, stop)[1:-1]))) > 0.0:
            continue
        if found and found[-1].stop == start:
            found[-1] = Undercut(found[-1].start, stop)
        else:
            found.append(Undercut(start, stop))
    if len(found) > 1 and found[0].start == edges[0] and _is_turn(edges) and found[-1].stop == edges[-1]:
        found[-1] = Undercut(found[-1].start, found.pop(0).stop + math.tau)
    return found


def greatest_roller(curve: PolarCurve, edges: Sequence[float], side: Side = "inner") -> tuple[float, float]:
    """The radius [m] that a roller has to stay below, and where [rad] it is decided; infinite if nothing bounds it.

    It is the least radius of curvature of the path's convex stretches for the inner side, of its hollows for the
    outer one. Exact to rounding.
    """
    sign = 1.0 if side == "inner" else -1.0
    found = extremes(
        lambda phi: sign * frames(curve, phi).curvature,
        lambda phi: sign * frames(curve, phi).curvature_slope,
        nodes_of(edges),
    )
    if found.greatest <= 0.0:
        return math.inf, found.at_greatest
    return 1.0 / found.greatest, found.at_greatest


def fitting(curve: PolarCurve, edges: Sequence[float], radius: float, side: Side) -> None:
    """Raise InputError where a roller is too large for the path's curvature on one side: for its hollows outside.

    The message gives the greatest radius that fits and where.
    """
    signed(radius, side)
    most, at = greatest_roller(curve, edges, side)
    if radius < most:
        return
    text = {
        "inner": _("a roller of {radius:.6g} mm undercuts the profile at {at:.6g} deg"),
        "outer": _("a roller of {radius:.6g} mm is larger than the hollow at {at:.6g} deg"),
    }[side]
    raise InputError(
        "[roller] radius",
        text.format(radius=1e3 * radius, at=math.degrees(at)),
        _("stay below {most:.6g} mm").format(most=1e3 * most),
    )


def _is_turn(edges: Sequence[float]) -> bool:
    return abs(edges[-1] - edges[0] - math.tau) < 1e-9
