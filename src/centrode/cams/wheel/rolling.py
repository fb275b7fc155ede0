"""A walking wheel proved: its shoes are put on the ground as curves, by the paper's formulas, and looked at.

Nothing here uses the support function by which the shoes are made (`shoe`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import legendre

from centrode.cams.frames import Array
from centrode.cams.wheel.walking import Mover, quadrature_panels
from centrode.dynamics.steady_motion.cycle import NODES
from centrode.numerics.search import maxima_between

SAMPLES = 181
SEARCH = 401
"""Points of a shoe among which its lowest is looked for first."""
RETURNING = 721


@dataclass(frozen=True)
class Rolling:
    """What was found.

    Attributes
    ----------
    level : float [m]
        Greatest departure of the hub from its height where the shoe's lowest point lies on the ground.
    slip : float
        Greatest speed of the shoe's point at the contact over the speed of the hub.
    shoe_arc, ground : float [m]
        Arc of the shoe, and what the contact travels while it rolls from end to end.
    joint : float [m/rad]
        Jump of the hub's dX/dphi where one leg takes over from another.
    clearance, clearance_at : float [m], [rad]
        Least height over the ground of a shoe that does not stand, and the leg's angle. It is zero where the leg
        leaves the ground; negative where a shoe would dig in.
    room, room_at : float [m], [rad]
        Least room between the rollers of neighbouring legs, and the angle of the first leg; negative where they
        would overlap.
    """

    level: float
    slip: float
    shoe_arc: float
    ground: float
    joint: float
    clearance: float
    clearance_at: float
    room: float
    room_at: float


def rolling(mover: Mover) -> Rolling:
    """Prove a walking wheel at 181 angles of a working leg, and 721 of one that returns or goes round."""
    phi = np.linspace(-mover.half, mover.half, SAMPLES)
    ends = mover.rate(np.array([-mover.half, mover.half]))
    arc, ground = _lengths(mover)
    clearance, at = _clearance(mover)
    return Rolling(
        float(np.max(np.abs(_heights(mover, phi) - mover.height))),
        float(np.max(_contact_speed(mover, phi) / mover.rate(phi))),
        arc,
        ground,
        float(ends[0] - ends[1]),
        clearance,
        at,
        *_room(mover),
    )


def profile_by_parts(mover: Mover, phi: Array) -> Array:
    """Points of the shoe (n, 2) [m] in the leg's axes by the paper's (8)."""
    first, second = mover.shoe.parts(phi)
    return np.stack([second * np.sin(phi), first + second * np.cos(phi)], axis=-1)


def _heights(mover: Mover, phi: Array) -> Array:
    """Height of the hub over the lowest point of the standing shoe, by a search among its points."""
    radius = mover.shoe.arc.curve.radius(phi)[0]

    def below(u: Array) -> Array:
        x, y = np.moveaxis(profile_by_parts(mover, u.reshape(-1)).reshape(*u.shape, 2), -1, 0)
        shape = (-1,) + (1,) * (u.ndim - 1)
        lever = radius.reshape(shape) + y
        return np.asarray(lever * np.cos(phi).reshape(shape) + x * np.sin(phi).reshape(shape))

    points = np.linspace(-mover.half, mover.half, SEARCH)
    best = np.argmax(below(np.broadcast_to(points, (len(phi), SEARCH))), axis=1)
    low, high = points[np.maximum(best - 1, 0)], points[np.minimum(best + 1, SEARCH - 1)]
    _places, lowest = maxima_between(below, low, high)
    return np.maximum(lowest, below(points[best]))


def _contact_speed(mover: Mover, phi: Array) -> Array:
    """Speed [m/rad] of the leg's point that is at the contact: hub, turning leg, roller that goes along it."""
    radius, slope = mover.shoe.arc.curve.radius(phi, 1)
    first, second = mover.shoe.parts(phi)
    x, y = profile_by_parts(mover, phi).T
    sine, cosine = np.sin(phi), np.cos(phi)
    hub = slope * sine + (radius + first) * cosine + second  # (3)
    forwards = hub - (slope + x) * sine - (radius + y) * cosine
    upwards = -(slope + x) * cosine + (radius + y) * sine
    return np.asarray(np.hypot(forwards, upwards))


def _lengths(mover: Mover) -> tuple[float, float]:
    """Arc of the shoe, from its points alone; and travel of the contact."""
    panels = quadrature_panels(mover.shoe.arc)
    points = profile_by_parts(mover, panels.nodes)
    widths = np.diff(panels.edges)[:, None]
    inner = legendre.leggauss(NODES)[0]
    rates = []
    for column in points.T:
        coefficients = panels.series(column).coefficients
        slopes = legendre.legder(coefficients, axis=1) * (2.0 / widths)
        rates.append(legendre.legval(inner, slopes.T))
    arc = float(np.sum(panels.weights * np.hypot(*rates).reshape(-1)))
    ends = np.array([-mover.half, mover.half])
    return arc, float(np.diff(mover.travel(ends) + mover.touch(ends))[0])


def _clearance(mover: Mover) -> tuple[float, float]:
    """Least height of the returning shoes over the ground, and the leg's angle."""
    phi = np.linspace(mover.half, math.tau - mover.half, RETURNING)
    x, y = profile_by_parts(mover, np.linspace(-mover.half, mover.half, SEARCH)).T
    radius = mover.closed.radius(phi)[0]
    levers = (radius[:, None] + y) * np.cos(phi)[:, None] + x * np.sin(phi)[:, None]
    lowest = mover.height - levers.max(axis=1)
    worst = int(np.argmin(lowest))
    return float(lowest[worst]), float(phi[worst])


def _room(mover: Mover) -> tuple[float, float]:
    """Least room between neighbouring rollers, and the angle of the first one's leg."""
    phi, pitch = np.linspace(-math.pi, math.pi, RETURNING), math.tau / mover.legs
    one, two = mover.closed.radius(phi)[0], mover.closed.radius(phi + pitch)[0]
    apart = np.hypot(two * math.cos(pitch) - one, two * math.sin(pitch))
    worst = int(np.argmin(apart))
    return float(apart[worst]) - 2.0 * mover.roller, float(phi[worst])
