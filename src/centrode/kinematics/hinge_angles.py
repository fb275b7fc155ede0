"""Angles between links at their moving hinges on the sphere, and spherical coordinates of points."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.model.mechanism import Mechanism
from centrode.structure.constraints import Positions
from centrode.structure.dimensions import Dimensions

Array: TypeAlias = npt.NDArray[np.float64]
Number: TypeAlias = Any

HINGE_ANGLES = ("hinge_angle", "hinge_velocity", "hinge_acceleration")
"""Of all moving hinges of a linkage on the sphere, dyads or not: the angle and two derivatives by time."""


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


def rotor_of_hinge(hinge: MovingHinge, _numbers: Dimensions, at: Positions) -> tuple[Number, Number]:
    """Cosine and sine of the angle of a hinge, over any algebra, times a positive number that stays the same.

    Counter-clockwise seen from outside, from the arc of the first link to that of the second.
    """
    (x, y, z), (a, b, c), (d, e, f) = (at.points[name] for name in (hinge.point, *hinge.ends))
    sine = x * (b * f - c * e) + y * (c * d - a * f) + z * (a * e - b * d)
    cosine = (a * d + b * e + c * f) - (x * a + y * b + z * c) * (x * d + y * e + z * f)
    return cosine, sine


def hinge_rates(
    hinges: Sequence[MovingHinge], points: Sequence[str], places: Array, links: Sequence[str], spins: Array
) -> tuple[Array, Array]:
    """Two derivatives (lanes, n, hinges) of the angle of each hinge by the path's parameter.

    Parameters
    ----------
    points, places : their names, and where they stand (lanes, n, points, 3)
    links, spins : their names, and rotation vectors and their derivatives (2, lanes, n, links, 3) [rad]

    Notes
    -----
    The relative angular velocity of two hinged links lies along the hinge, and so does the part of its derivative
    that counts: what is square to the hinge only turns it.
    """
    at = places[:, :, [points.index(hinge.point) for hinge in hinges]]
    first, second = ([links.index(hinge.links[k]) for hinge in hinges] for k in (0, 1))
    with np.errstate(invalid="ignore"):
        one, two = (np.einsum("...i,...i", at, spin[:, :, second] - spin[:, :, first]) for spin in spins)
    return one, two


def spherical_coordinates(places: Array) -> tuple[Array, Array]:
    """Polar angle from z in [0, pi] and azimuth from x towards y in (-pi, pi] of places (..., 3) [rad]."""
    x, y, z = np.moveaxis(places, -1, 0)
    with np.errstate(invalid="ignore"):
        return np.arctan2(np.hypot(x, y), z), np.arctan2(y, x)
