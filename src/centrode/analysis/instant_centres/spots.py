"""Where a construction of instant centres has its places: in the plane, or on the sphere.

Both are places of the projective plane (see `projective`): a place of the plane with a weight, an axis through the
centre of the sphere. Places of the sphere are seen along the direction of their middle and enlarged by the size of
the mechanism, which keeps great circles lines, so that small linkages keep their accuracy.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol, TypeAlias

import numpy as np

from centrode.analysis.instant_centres.bodies import Array, Bodies, Named, Pair
from centrode.analysis.instant_centres.centres import upward
from centrode.analysis.instant_centres.primary import Gearing, Joint, place_of
from centrode.analysis.instant_centres.projective import EPS, Spot, Triple, spot
from centrode.analysis.instant_centres.turning_bodies import TurningBodies, pole_of
from centrode.model.sphere import unit_vector

Where: TypeAlias = tuple[float, ...]
SMALLEST = 16.0 * EPS


class Spots(Protocol):
    """Places of one position as spots, and back."""

    @property
    def bodies(self) -> Named:
        """The bodies at this position."""

    def shown(self, joint: Joint, error: float) -> tuple[Spot, Where | None]:
        """The centre that a joint shows, and its place where that is not to be read off the spot."""

    def read(self, where: Spot) -> tuple[Where | None, Where | None]:
        """Place of a spot, or the direction in which it lies at infinity."""

    def geared(self, gear: Gearing, wanted: str, known: Sequence[Spot]) -> Spot | None:
        """The third centre of a gear: of the "first" or the "second" wheel against the carrier, or where they "mesh".

        The two others stand in this order; nothing where they do not tell it.
        """

    def pole(self, pair: Pair) -> Triple:
        """The velocity field of a pair as a place times its spin, in the greatest velocity."""


@dataclass(frozen=True)
class PlaneSpots:
    """Places of the plane about their middle, in the size of the mechanism."""

    bodies: Bodies

    @cached_property
    def middle(self) -> complex:
        """Middle of the bodies' places."""
        return complex(np.mean(self.bodies.place))

    @cached_property
    def size(self) -> float:
        """What distances are measured by."""
        return max(self.bodies.scale, float(np.max(np.abs(self.bodies.place - self.middle))))

    def shown(self, joint: Joint, error: float) -> tuple[Spot, Where | None]:
        place, at_infinity = place_of(joint, self.bodies)
        if at_infinity:
            return spot(place, 0.0, error), None
        return spot((place - self.middle) / self.size, 1.0, error), (place.real, place.imag)

    def read(self, where: Spot) -> tuple[Where | None, Where | None]:
        x, w = complex(where.vector[0], where.vector[1]), where.vector[2]
        if where.at_infinity:
            towards = complex(upward(np.array(x / abs(x))))
            return None, (towards.real, towards.imag)
        at = self.middle + self.size * x / w
        return (at.real, at.imag), None

    def geared(self, gear: Gearing, wanted: str, known: Sequence[Spot]) -> Spot | None:
        """With A, B of the wheels on the carrier, P - A = i (P - B)."""
        if any(one.at_infinity for one in known):
            return None
        a, b = (complex(one.vector[0], one.vector[1]) / one.vector[2] for one in known)
        ratio = gear.ratio
        x, w = {
            "first": (ratio * a + (1.0 - ratio) * b, 1.0),
            "second": (a - (1.0 - ratio) * b, ratio),
            "mesh": (a - ratio * b, 1.0 - ratio),
        }[wanted]
        error = _geared_error(gear, known)
        if abs(x) <= error and abs(w) <= EPS * abs(ratio):
            return None  # equal turns about one axis: at rest
        return spot(x, w, error)

    def pole(self, pair: Pair) -> Triple:
        moving, spin = self.bodies.relative(pair)
        rate = float(self.bodies.rate) or 1.0
        turning = float(spin) * self.size / rate
        arm = (complex(self.bodies.place[pair[0]]) - self.middle) / self.size
        x = turning * arm + 1j * complex(moving) / rate
        return x.real, x.imag, turning


@dataclass(frozen=True)
class SphereSpots:
    """Axes through the centre of the sphere."""

    bodies: TurningBodies

    @cached_property
    def chart(self) -> Array:
        """Matrix that gives the coordinates of a spot: two enlarged across the middle, one along it."""
        places = np.array([place for place in self.bodies.points.values() if np.isfinite(place).all()])
        middle = places.mean(axis=0) if len(places) else np.array([0.0, 0.0, 1.0])
        apart = float(np.linalg.norm(middle))
        along = middle / apart if apart > SMALLEST else np.array([0.0, 0.0, 1.0])
        across = np.cross(along, np.eye(3)[int(np.argmin(np.abs(along)))])
        across /= np.linalg.norm(across)
        size = float(np.max(np.linalg.norm(places - middle, axis=1), initial=0.0)) if len(places) else 1.0
        size = min(1.0, size) if size > SMALLEST else 1.0
        return np.stack([across / size, np.cross(along, across) / size, along])

    @cached_property
    def rate(self) -> float:
        """Greatest angular velocity of a body as a spot."""
        return float(np.max(np.linalg.norm(self.bodies.spin @ self.chart.T, axis=-1))) or 1.0

    def shown(self, joint: Joint, error: float) -> tuple[Spot, Where | None]:
        bodies = self.bodies
        if joint.kind == "hinge":
            place = bodies.points[joint.name]
        else:
            guide = bodies.mechanism.guide(joint.name)
            inside = np.array(unit_vector(pole_of(bodies.mechanism, guide)))
            place = bodies.axes[bodies.number(guide.on)] @ inside
        x, y, w = self.chart @ place
        return spot(complex(x, y), float(w), error), tuple(map(float, place))

    def read(self, where: Spot) -> tuple[Where | None, Where | None]:
        vector = np.linalg.solve(self.chart, np.array(where.vector))
        # of the two ends the one on the side of the mechanism
        vector *= (1.0 if where.vector[2] >= 0.0 else -1.0) / np.linalg.norm(vector)
        return tuple(map(float, vector)), None

    def geared(self, gear: Gearing, wanted: str, known: Sequence[Spot]) -> Spot | None:
        """With A, B where the wheels are hinged to the carrier, the wheels turn about A - i B against each other."""
        pivots = [_hinge(self.bodies, wheel, gear.carrier) for wheel in (gear.first, gear.second)]
        if wanted != "mesh" or None in pivots:
            return None
        a, b = (self.bodies.points[pivot] for pivot in pivots if pivot is not None)
        axis = a - gear.ratio * b
        error = _geared_error(gear, known)
        if np.linalg.norm(axis) <= error:
            return None  # equal turns about one axis: at rest
        x, y, w = self.chart @ axis
        return spot(complex(x, y), float(w), error)

    def pole(self, pair: Pair) -> Triple:
        x, y, w = self.chart @ self.bodies.relative(pair) / self.rate
        return float(x), float(y), float(w)


def _geared_error(gear: Gearing, known: Sequence[Spot]) -> float:
    return sum(one.error for one in known) * (1.0 + abs(gear.ratio)) * 4.0


def _hinge(bodies: TurningBodies, wheel: int, carrier: int) -> str | None:
    """The point in which a wheel is hinged to its carrier."""
    own, held = (bodies.mechanism.points_of(bodies.names[number]) for number in (wheel, carrier))
    return next((name for name in own if name in held), None)


def spots_of(bodies: Named) -> Spots:
    """The places of one position of a planar or a spherical motion."""
    if isinstance(bodies, TurningBodies):
        return SphereSpots(bodies)
    assert isinstance(bodies, Bodies)
    return PlaneSpots(bodies)
