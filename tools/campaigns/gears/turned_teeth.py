"""Teeth of wheels as half their angle over the radius, and how deep they enter each other while they turn.

Fillets are equidistants of the path of the rack's edge centre, flanks involutes. Nothing of the program is used.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

POINTS = 160
"""Places of a flank that are looked at."""


@dataclass(frozen=True)
class Tooth:
    """A tooth of a wheel of module one.

    Attributes
    ----------
    teeth : number of them
    inner, outer : radii between which the tooth has flanks; beyond one of them the wheel is solid
    internal : whether that is the outer one
    half : radius -> half of the angle that the tooth subtends
    """

    teeth: int
    inner: float
    outer: float
    internal: bool
    half: Callable[[Array], Array]

    def flank(self) -> Array:
        """Places (n) of both flanks and of the tip as complex numbers, the tooth about the real axis."""
        radii = np.linspace(self.inner, self.outer, POINTS)
        angles = self.half(radii)
        tip = self.inner if self.internal else self.outer
        end = angles[0] if self.internal else angles[-1]
        land = tip * np.exp(1j * np.linspace(-end, end, 9))
        return np.concatenate([radii * np.exp(1j * angles), radii * np.exp(-1j * angles), land])

    def depth(self, places: Array, turned: Array) -> float:
        """How deep places lie in the wheel whose tooth at the real axis has turned by an angle."""
        radii = np.abs(places)
        pitch = 2 * math.pi / self.teeth
        away = np.abs(np.mod(np.angle(places) - turned + pitch / 2, pitch) - pitch / 2)
        inside = (radii > self.inner) & (radii < self.outer)
        depth = np.where(inside, radii * (self.half(np.clip(radii, self.inner, self.outer)) - away), -1.0)
        solid = radii - self.outer if self.internal else self.inner - radii
        # Beside the flank a place may also be nearer to the tip circle.
        to_tip = radii - self.inner if self.internal else self.outer - radii
        return float(np.maximum(np.minimum(depth, to_tip), solid).max())


def involute(angle: Array | float) -> Array:
    """tan(a) - a."""
    return np.asarray(np.tan(angle) - angle)


def external_tooth(
    teeth: int, shift: float, tip: float, alpha: float, addendum: float, fillet: float
) -> Tooth:
    """A tooth that a rack with h_a* = addendum, c* = 0.25 cuts; lengths in modules."""
    radius, base = teeth / 2, teeth / 2 * math.cos(alpha)
    depth = addendum + 0.25 - shift - fillet
    across = math.pi / 4 - (addendum + 0.25 - fillet) * math.tan(alpha) - fillet / math.cos(alpha)
    # The normal of the path of the edge's centre passes through the pitch point.
    roll = (np.linspace(0.0, depth / math.tan(alpha), 4000) - across) / radius
    centre = (across + radius * roll + 1j * (radius - depth)) * np.exp(1j * roll)
    speed = np.exp(1j * roll) * (radius + 1j * (across + radius * roll + 1j * (radius - depth)))
    wall = centre - math.copysign(1.0, depth) * 1j * speed / np.abs(speed) * fillet
    radii, gap = np.abs(wall), np.pi / 2 - np.angle(wall)
    end = int(np.argmax(radii)) + 1
    radii, angles = radii[:end], math.pi / teeth - gap[:end]
    order = np.argsort(radii)
    radii, angles = radii[order], angles[order]
    own = (math.pi / 2 + 2 * shift * math.tan(alpha)) / teeth + float(involute(alpha))
    straight = addendum + 0.25 - fillet * (1 - math.sin(alpha)) - shift
    rolled = radius * math.sin(alpha) - straight / math.sin(alpha)

    def half(at: Array) -> Array:
        with np.errstate(invalid="ignore"):
            flank = own - involute(np.arccos(np.minimum(base / at, 1.0)))
        trochoid = np.interp(at, radii, angles)
        if rolled >= 0:
            return np.where(at < math.hypot(base, rolled), trochoid, flank)
        flank = np.where(at < base, np.inf, flank)
        return np.where(at > radii[-1], flank, np.minimum(flank, trochoid))

    return Tooth(teeth, float(radii[0]), tip, False, half)


def internal_tooth(teeth: int, shift: float, tip: float, root: float, alpha: float) -> Tooth:
    """A tooth that points inwards; its flank goes on to the root circle."""
    base = teeth / 2 * math.cos(alpha)
    own = (math.pi / 2 - 2 * shift * math.tan(alpha)) / teeth - float(involute(alpha))

    def half(at: Array) -> Array:
        return np.asarray(own + involute(np.arccos(np.minimum(base / at, 1.0))))

    return Tooth(teeth, tip, root, True, half)


def greatest_depth(first: Tooth, second: Tooth, distance: float, turns: int = 240) -> float:
    """How deep one wheel enters the other [modules] while they turn; negative or rounding where they only touch.

    The second wheel's centre lies at `distance` on the real axis, that of an internal one at the other side of the
    origin. At rest a tooth of the first lies in a gap of the second on the real axis.
    """
    ratio = second.teeth / first.teeth
    if second.internal:
        centre, sense, gap = -distance, 1.0, 0.0
        reach = (math.pi, math.pi)
    else:
        centre, sense, gap = distance, -1.0, math.pi
        # Teeth meet where the tip circles cross.
        reach = tuple(
            _crossing(own, other, distance) + math.pi / tooth.teeth
            for tooth, own, other in ((first, first.outer, second.outer), (second, second.outer, first.outer))
        )  # type: ignore[assignment]
    steps = turns * (4 if second.internal else 1)
    turned = np.linspace(-reach[0], reach[0], steps)[:, None]
    places = first.flank()[None, :] * np.exp(1j * turned) - centre
    half_pitch = math.pi / second.teeth
    deepest = second.depth(places, gap + sense * turned / ratio + half_pitch)
    turned = np.linspace(-reach[1], reach[1], steps)[:, None]
    # A tooth of the second at `gap` plus an angle: the first has turned so far that its tooth has left the real axis.
    places = second.flank()[None, :] * np.exp(1j * (gap + turned)) + centre
    own_turn = sense * ratio * (turned - half_pitch)
    return max(deepest, first.depth(places, own_turn))


def _crossing(own: float, other: float, distance: float) -> float:
    """Angle at a centre from the line of centres to where both tip circles cross."""
    cosine = (own**2 + distance**2 - other**2) / (2 * own * distance)
    return math.acos(min(1.0, max(-1.0, cosine)))
