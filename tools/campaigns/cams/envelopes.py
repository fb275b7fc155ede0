"""The profile of a cam as the envelope of its follower's places, at many digits, by difference quotients."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import mpmath

DIGITS = 60
STEP = mpmath.mpf(10) ** -14
Lift = Callable[[Any], Any]


@dataclass(frozen=True)
class Layout:
    """A follower: how it is led and what touches the cam; lengths of the description, and the sense of the cam."""

    kind: str
    contact: str
    base: float
    sense: float
    roller: float = 0.0
    offset: float = 0.0
    arm: float = 0.0
    distance: float = 0.0
    face_offset: float = 0.0

    def swing(self, lift: Any) -> Any:
        """Angle of an oscillating follower from the line towards the cam's centre."""
        base, d = mpmath.mpf(self.base), mpmath.mpf(self.distance)
        if self.contact == "flat":
            return mpmath.asin((base + mpmath.mpf(self.face_offset)) / d) + lift
        arm = mpmath.mpf(self.arm)
        reach = base + mpmath.mpf(self.roller)
        return mpmath.acos((arm**2 + d**2 - reach**2) / (2 * arm * d)) + lift

    def in_cam(self, vector: Any, phi: Any) -> Any:
        """A direction or place of the frame in the axes of the cam, turned by phi."""
        return vector * mpmath.expj(-self.sense * phi)

    def centre(self, lift: Any, phi: Any) -> Any:
        """Centre of the roller, or the edge, in the cam's axes."""
        if self.kind == "translating":
            reach = mpmath.mpf(self.base) + mpmath.mpf(self.roller)
            height = mpmath.sqrt(reach**2 - mpmath.mpf(self.offset) ** 2) + lift
            return self.in_cam(mpmath.mpc(self.offset, height), phi)
        psi = self.swing(lift)
        arm = mpmath.mpf(self.arm)
        return self.in_cam(mpmath.mpf(self.distance) - arm * mpmath.expj(-psi), phi)

    def way(self, lift: Any, phi: Any) -> Any:
        """Unit direction in which the follower goes as its lift grows, in the cam's axes."""
        if self.kind == "translating":
            return self.in_cam(mpmath.mpc(0, 1), phi)
        return self.in_cam(mpmath.mpc(0, 1) * mpmath.expj(-self.swing(lift)), phi)

    def support(self, lift: Any) -> Any:
        """Distance of a flat face from the cam's centre."""
        if self.kind == "translating":
            return mpmath.mpf(self.base) + lift
        return mpmath.mpf(self.distance) * mpmath.sin(self.swing(lift)) - mpmath.mpf(self.face_offset)


@dataclass(frozen=True)
class Touch:
    """Where the follower touches: place, outward normal, radius of curvature, whether the profile runs back there."""

    place: Any
    normal: Any
    radius: Any
    back: bool


def touch(layout: Layout, lift: Lift, phi: Any) -> Touch:
    """The contact at an angle of the cam, from the lift as a function of it."""
    places = [_placed(layout, lift, phi + k * STEP) for k in (-1, 0, 1)]
    moved = (places[2][0] - places[0][0]) / (2 * STEP)
    turned = (places[2][1] - places[0][1]) / (2 * STEP)
    normal = places[1][1]
    # a place moves along with the normal where the profile bulges
    square = abs(turned) ** 2
    radius = _dot(moved, turned) / square if square else mpmath.inf
    if layout.contact == "flat":
        back = radius <= 0
    else:
        carried = (
            layout.centre(lift(phi + STEP), phi + STEP) - layout.centre(lift(phi - STEP), phi - STEP)
        ) / (2 * STEP)
        back = _dot(moved, carried) <= 0
    return Touch(places[1][0], normal, radius, bool(back))


def _placed(layout: Layout, lift: Lift, phi: Any) -> tuple[Any, Any]:
    """Place of the contact and outward normal."""
    step = STEP / 1000
    if layout.contact == "flat":
        normal = layout.way(lift(phi), phi)
        turned = (layout.way(lift(phi + step), phi + step) - layout.way(lift(phi - step), phi - step)) / (
            2 * step
        )
        rate = (layout.support(lift(phi + step)) - layout.support(lift(phi - step))) / (2 * step)
        # on the face, and on its neighbours: x n = p and x n' = p', n' square to n
        return normal * layout.support(lift(phi)) + turned / abs(turned) ** 2 * rate, normal
    carried = layout.centre(lift(phi + step), phi + step) - layout.centre(lift(phi - step), phi - step)
    normal = mpmath.mpc(0, 1) * carried / abs(carried)
    if _dot(normal, layout.way(lift(phi), phi)) < 0:
        normal = -normal
    return layout.centre(lift(phi), phi) - mpmath.mpf(layout.roller) * normal, normal


def _dot(one: Any, other: Any) -> Any:
    return mpmath.re(mpmath.conj(one) * other)
