"""Angles between links at their moving hinges on the sphere, and spherical coordinates of points."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.kinematics.solve import Solved
from centrode.model.mechanism import Mechanism

Array: TypeAlias = npt.NDArray[np.float64]


@dataclass(frozen=True)
class MovingHinge:
    """Two links that are hinged in a moving point.

    Attributes
    ----------
    point : of the hinge
    links : their names; the angle runs from the arc of the first to that of the second
    ends : the point of each link by which its arc is drawn from the hinge
    """

    point: str
    links: tuple[str, str]
    ends: tuple[str, str]

    @property
    def label(self) -> str:
        """What results call it: "AB-BC"."""
        return "-".join(self.links)


def moving_hinges(mechanism: Mechanism) -> tuple[MovingHinge, ...]:
    """The hinges between moving links, in the order of the links; of several links in one point each with the first.

    A link of one point has no arc, so its hinges have no angle.
    """
    at: dict[str, list[tuple[str, str]]] = {}
    for name, link in mechanism.links.items():
        points = tuple(link.points)
        for point in points:
            other = next((one for one in points if one != point), None)
            if point not in mechanism.frame.points and other is not None:
                at.setdefault(point, []).append((name, other))
    return tuple(
        MovingHinge(point, (first, second), (one, other))
        for point, ((first, one), *rest) in at.items()
        for second, other in rest
    )


def hinge_orders(solved: Solved, hinges: tuple[MovingHinge, ...]) -> tuple[Array, Array, Array]:
    """Angle (lanes, n, hinges) [rad] of each hinge with two derivatives by the path's parameter.

    Counter-clockwise seen from outside, from the arc of the first link to that of the second. The turns of a link that
    goes on turning against another are counted from sample to sample.

    Notes
    -----
    The relative angular velocity of two hinged links lies along the hinge, and so does the part of its derivative
    that counts: what is square to the hinge only turns it.
    """
    assert solved.spins is not None
    points = {
        name: k for k, name in enumerate((*solved.ready.structure.dimensions.frame, *solved.layout.points))
    }
    links = {name: k for k, name in enumerate(solved.layout.links)}
    places = solved.all_points[0]
    at = places[:, :, [points[hinge.point] for hinge in hinges]]
    one, other = (places[:, :, [points[hinge.ends[k]] for hinge in hinges]] for k in (0, 1))
    with np.errstate(invalid="ignore"):
        sine = np.einsum("...i,...i", at, np.cross(one, other))
        cosine = np.einsum("...i,...i", one, other) - np.einsum("...i,...i", at, one) * np.einsum(
            "...i,...i", at, other
        )
        first, second = ([links[hinge.links[k]] for hinge in hinges] for k in (0, 1))
        rates = [
            np.einsum("...i,...i", at, spin[:, :, second] - spin[:, :, first])
            for spin in (*solved.spins[:2],)
        ]
    return (
        _with_turns(np.arctan2(sine, cosine), rates[0], rates[1], solved.span.parameter),
        rates[0],
        rates[1],
    )


def _with_turns(angles: Array, rates: Array, slopes: Array, parameter: Array) -> Array:
    """Angles with whole turns such that from sample to sample they grow as their two derivatives say."""
    if angles.shape[1] < 2:
        return angles
    step = np.diff(parameter)[:, None]
    with np.errstate(invalid="ignore"):
        # by both derivatives at both ends, to the fifth order of the step
        grown = step * (rates[:, :-1] + rates[:, 1:]) / 2 + step**2 * (slopes[:, :-1] - slopes[:, 1:]) / 12
        turns = np.round((grown - np.diff(angles, axis=1)) / (2.0 * np.pi))
    # behind a gap counting begins anew
    counted = np.cumsum(np.where(np.isfinite(turns), turns, 0.0), axis=1)
    return np.concatenate([angles[:, :1], angles[:, 1:] + 2.0 * np.pi * counted], axis=1)


def spherical_coordinates(places: Array) -> tuple[Array, Array]:
    """Polar angle from z in [0, pi] and azimuth from x towards y in (-pi, pi] of places (..., 3) [rad]."""
    x, y, z = np.moveaxis(places, -1, 0)
    with np.errstate(invalid="ignore"):
        return np.arctan2(np.hypot(x, y), z), np.arctan2(y, x)
